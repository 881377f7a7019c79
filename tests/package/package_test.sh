#!/bin/bash
# SPDX-License-Identifier: MIT
# Installs, upgrades, removes and purges a package in a new Debian, and looks at what is there each time; boots it, too,
# and kills and hangs the service. Takes root.
# Usage: tests/package/package_test.sh DEB [SUITE]
# shellcheck disable=SC2016 # for the inner shells
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
# shellcheck source=toolchain/quiet.sh
source "$top/toolchain/quiet.sh"
deb=$(realpath "$1")
suite=${2:-bookworm}
name=$(basename "$deb")
root=/var/tmp/dynslam-package-$$
trap 'rm -rf --one-file-system "$root"' EXIT

inside() {
  unshare --mount --pid --fork --kill-child --root "$root" --mount-proc env -i \
    DEBIAN_FRONTEND=noninteractive HOME=/root LC_ALL=C PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"
}
fail() {
  echo "not so: $*" >&2
  exit 1
}
# What must be true, in words, and the command that says so.
check() {
  local what=$1
  shift
  "$@" >"$root/tmp/said" 2>&1 || { cat "$root/tmp/said" >&2 && fail "$what"; }
  echo "ok: $what"
}
check_not() {
  local what=$1
  shift
  ! "$@" >/dev/null 2>&1 || fail "$what"
  echo "ok: $what"
}
owned() { [[ $(inside stat -c '%U:%G %a' "$2") == "$1" ]]; }

# The same package, as a later version with another default.
make_newer() {
  local tree
  tree=$(mktemp -d)
  dpkg-deb --raw-extract "$deb" "$tree"
  sed -i '/^Version:/s/$/.1/' "$tree/DEBIAN/control"
  echo '# of the newer version' >>"$tree/etc/dynslam/dynslam.toml"
  quietly dpkg-deb --root-owner-group --build "$tree" "$root/tmp/newer.deb"
  rm -r "$tree"
}

test_install() {
  quietly mmdebstrap --variant=minbase --include=systemd-sysv,udev,stunnel4 "$suite" "$root" "$("$top/toolchain/mirror.sh")"
  cp "$deb" "$root/tmp/$name"
  make_newer
  quietly inside apt-get update
  quietly inside apt-get install -y --no-install-recommends "/tmp/$name"
  check "all files are root's, and nobody else may write to them" \
    inside sh -c 'test -z "$(dpkg -L dynslam | xargs -d "\n" -I{} find {} -maxdepth 0 \( ! -user root -o ! -type l -perm /022 \))"'
  check "the program runs" inside dynslam --version
  check "its part for cameras can be loaded" inside sh -c \
    "dynslam probe | grep -q '^camera .*there is none: is its cable'"
  check "its settings are in order" inside dynslam check-config /etc/dynslam/dynslam.toml
  for group in dialout gpio i2c video; do
    check "dynslam is in the group $group" inside sh -c "id -nG dynslam | grep -qw $group"
  done
  check "its state belongs to dynslam alone" owned 'dynslam:dynslam 750' /var/lib/dynslam
  check "systemd understands the unit, and all of it" \
    inside sh -c '! systemd-analyze verify --man=no dynslam.service 2>&1 | grep .'
  check_not "the service is not enabled on a PC" inside systemctl is-enabled dynslam.service
}

# Every option that the program tells of is in its manual.
test_manual() {
  local manual command option
  manual=$(gzip -dc "$root/usr/share/man/man1/dynslam.1.gz")
  for command in $(inside dynslam --help | sed '1,/^Subcommands:/d' | awk '/^  [a-z]/ {print $1}'); do
    grep -q "^\.It Cm $command\$" <<<"$manual" || fail "the manual knows $command"
    for option in $(inside dynslam "$command" --help | grep -oE -- '--[a-z-]+' | sort -u); do
      grep -qE "Fl ([a-z] , )?-?${option#-}( |\$)" <<<"$manual" || fail "the manual knows $option of $command"
    done
  done
  echo "ok: the manual knows all commands and options"
}

# What a robot's own dpkg says of its architecture.
configure_as_robot() {
  inside env DPKG_MAINTSCRIPT_ARCH=arm64 DPKG_MAINTSCRIPT_PACKAGE=dynslam /var/lib/dpkg/info/dynslam.postinst configure "$@"
}

test_upgrade() {
  # As if it had not been on this machine before.
  inside env DPKG_MAINTSCRIPT_PACKAGE=dynslam deb-systemd-helper purge dynslam.service
  configure_as_robot
  check "the service is enabled on a robot" inside systemctl is-enabled dynslam.service
  inside systemctl disable --quiet dynslam.service
  configure_as_robot 0.0.1
  check_not "disabled, it stays so" inside systemctl is-enabled dynslam.service
  inside systemctl enable --quiet dynslam.service
  sed -i 's/^#name = .*/name = "Rob"/' "$root/etc/dynslam/dynslam.toml"
  inside install -o dynslam -g dynslam /dev/null /var/lib/dynslam/kept
  quietly inside dpkg -i --force-confdef --force-confold /tmp/newer.deb
  check "an upgrade keeps changed settings" grep -q 'name = "Rob"' "$root/etc/dynslam/dynslam.toml"
  check "an upgrade keeps state" test -e "$root/var/lib/dynslam/kept"
  check "an upgrade leaves it enabled" inside systemctl is-enabled dynslam.service
  quietly inside dpkg -i --force-confdef --force-confold "/tmp/$name"
  check "so does going back" inside systemctl is-enabled dynslam.service
}

test_removal() {
  quietly inside dpkg --remove dynslam
  check_not "removed, the program is gone" test -e "$root/usr/bin/dynslam"
  check "removed, the settings are kept" grep -q 'name = "Rob"' "$root/etc/dynslam/dynslam.toml"
  check "removed, the state is kept" test -e "$root/var/lib/dynslam/kept"
  quietly inside dpkg -i "/tmp/$name"
  check "put back, it has its settings" grep -q 'name = "Rob"' "$root/etc/dynslam/dynslam.toml"
  quietly inside dpkg --purge dynslam
  local path
  for path in /etc/dynslam /var/lib/dynslam /etc/avahi/services/dynslam.service \
    /etc/systemd/system/multi-user.target.wants/dynslam.service /usr/lib/dynslam; do
    check_not "purged, $path is gone" test -e "$root$path" -o -L "$root$path"
  done
  check "and no file of dynslam is left" inside sh -c \
    'test -z "$(find / -xdev \( -user dynslam -o -group dynslam \) 2>/dev/null)"'
}

"$top/tests/package/content_test.sh" "$deb"
test_install
test_manual
test_upgrade
test_removal
"$top/tests/package/boot_test.sh" "$root" "$name"
