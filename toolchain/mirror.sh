#!/bin/sh
# SPDX-License-Identifier: MIT
# Prints the Debian mirror that this machine uses.
set -eu
# shellcheck disable=SC2016 # the fields are for apt
mirror=$(apt-get indextargets --format '$(SITE) $(ORIGIN) $(LABEL)' 'Created-By: Packages' 2>/dev/null |
  awk '$2 == "Debian" && $3 == "Debian" { print $1; exit }')
echo "${mirror:-http://deb.debian.org/debian}"
