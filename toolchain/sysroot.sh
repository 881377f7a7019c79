#!/bin/sh
# SPDX-License-Identifier: MIT
# Makes a folder with the libraries that dynslam for arm64 is linked with, and the package database that says which
# packages they are of: of a Debian release, or those of a Raspberry Pi or a copy of its card. It is made anew when what
# it is to be made of changes.
set -eu

if [ $# != 2 ]; then
  echo "usage: toolchain/sysroot.sh DIR 12 | 13 | USER@HOST: | FOLDER" >&2
  exit 2
fi
root=$(cd "$(dirname "$0")/.." && pwd)
# shellcheck source=toolchain/quiet.sh
. "$root/toolchain/quiet.sh"
mkdir -p "$1"
sysroot=$(cd "$1" && pwd)
from=$2
packages=$(grep -e '-dev$' "$root/toolchain/packages.txt" | paste -sd,),libblas-dev,liblapack-dev
libraries=usr/lib/aarch64-linux-gnu
database=$sysroot/var/lib/dpkg

# dpkg-shlibdeps asks for files where they lie here.
move_lists() { sed -i -e 's#^\.##' -e 's#/$##' -e '/^$/d' -e 's#^/lib/#/usr/lib/#' -e "s#^/#$sysroot/#" "$database/info/"*.list; }

# What is extracted only, dpkg knows nothing of; $1 has the packages.
record_packages() {
  echo 1 >"$database/info/format"
  for deb in "$1"/*.deb; do
    package=$(dpkg-deb --field "$deb" Package)
    info=$database/info/$package
    [ "$(dpkg-deb --field "$deb" Multi-Arch)" != same ] || info=$info:arm64
    dpkg-deb --fsys-tarfile "$deb" | tar -t >"$info.list"
    control=$(mktemp -d)
    dpkg-deb --control "$deb" "$control"
    for kind in symbols shlibs; do
      [ ! -e "$control/$kind" ] || cp "$control/$kind" "$info.$kind"
    done
    { cat "$control/control" && printf 'Status: install ok installed\n\n'; } >>"$database/status"
    rm -r "$control"
  done
}

copy_debian() {
  case $from in
    12) suite=bookworm ;;
    13) suite=trixie ;;
  esac
  packed=$(mktemp -d)
  # shellcheck disable=SC2016 # for mmdebstrap's shell
  keep='cp "$1"/var/cache/apt/archives/*.deb '"$packed"
  quietly mmdebstrap --variant=extract --architectures=arm64 --hook-dir=/usr/share/mmdebstrap/hooks/merged-usr \
    --include="$packages" --extract-hook="$keep" "$suite" "$sysroot" "$("$root/toolchain/mirror.sh")"
  record_packages "$packed"
  rm -r "$packed"
  echo "$from" >"$sysroot/release"
}

copy_pi() {
  set --
  for path in "$libraries" usr/lib/ld-linux-aarch64.so.1 usr/lib/cmake usr/lib/os-release usr/include usr/share/cmake \
    usr/share/eigen3 usr/share/pkgconfig var/lib/dpkg/info var/lib/dpkg/status; do
    set -- "$@" "$from/./$path"
  done
  # What this Pi has not, the build will miss by name.
  rsync --archive --relative --no-owner --no-group --ignore-missing-args "$@" "$sysroot"
  ln -s usr/lib "$sysroot/lib"
  sed -n 's/^VERSION_ID="\(.*\)"/\1/p' "$sysroot/usr/lib/os-release" >"$sysroot/release"
}

[ "$(cat "$sysroot/made_of" 2>/dev/null)" != "$from $packages" ] || exit 0
say "making a sysroot of $from"
rm -rf --one-file-system "$sysroot"
mkdir -p "$sysroot"
case $from in
  12 | 13) copy_debian ;;
  *) copy_pi ;;
esac
# An emulated program would take these for its devices.
rm -rf --one-file-system "${sysroot:?}/dev"
move_lists
# Links to /lib/... would lead to this machine's own libraries.
find "$sysroot/$libraries" -lname '/*' | while read -r link; do
  ln -sfn --relative "$sysroot$(readlink "$link")" "$link"
done
# What installing would have linked as an alternative.
for library in "$sysroot/$libraries"/blas/*.so* "$sysroot/$libraries"/lapack/*.so*; do
  [ ! -e "$library" ] || ln -sf --relative "$library" "$sysroot/$libraries/"
done
# Ceres names libraries by their whole path.
find "$sysroot/$libraries/cmake" -name '*Targets*.cmake' -exec \
  sed -i "/INTERFACE_LINK_LIBRARIES/ s#\([;\"]\)/usr/lib/#\1$sysroot/usr/lib/#g" {} +
echo "$from $packages" >"$sysroot/made_of"
