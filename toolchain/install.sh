#!/bin/sh
# SPDX-License-Identifier: MIT
# Installs those of the named Debian packages that are missing; asks apt for nothing when all are there.
set -eu

missing=
for package; do
  # Node.js from elsewhere is as good, and Debian's cannot be put beside it.
  case $package in
    nodejs) ! command -v node >/dev/null || continue ;;
    npm) ! command -v npm >/dev/null || continue ;;
  esac
  status=$(dpkg-query --show --showformat '${db:Status-Status}' "$package" 2>/dev/null) || status=unknown
  [ "$status" = installed ] || missing="$missing $package"
done
[ "$missing" ] || exit 0

as_root=
[ "$(id -u)" = 0 ] || as_root=sudo
echo "installing$missing" >&2
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() {
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300 "$@" >"$log" 2>&1 </dev/null && return
  echo "apt-get $* failed:" >&2
  cat "$log" >&2
  exit 1
}
apt update
# shellcheck disable=SC2086 # one word a package
apt install --no-install-recommends $missing
