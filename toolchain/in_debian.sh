#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs a command in a tree of another Debian release that has what cross-building takes, with this checkout where it is.
set -eu

if [ $# -lt 2 ]; then
  echo "usage: toolchain/in_debian.sh 12 | 13 COMMAND [ARGUMENT...]" >&2
  exit 2
fi
release=$1
shift
case $release in
  12) suite=bookworm ;;
  13) suite=trixie ;;
esac
root=$(cd "$(dirname "$0")/.." && pwd)
tree=$root/build/debian-$release
as_root=
[ "$(id -u)" = 0 ] || as_root=sudo
# shellcheck source=toolchain/quiet.sh
. "$root/toolchain/quiet.sh"

if [ ! -e "$tree/complete" ]; then
  say "making a tree of Debian $release"
  $as_root rm -rf --one-file-system "$tree"
  quietly $as_root mmdebstrap --variant=minbase \
    --include=cmake,ninja-build,pkg-config,crossbuild-essential-arm64,nodejs,ccache,dpkg-dev,file \
    "$suite" "$tree" "$("$root/toolchain/mirror.sh")"
  $as_root mkdir -p "$tree$root"
  $as_root cp /usr/bin/qemu-aarch64-static "$tree/usr/bin/"
  $as_root touch "$tree/complete"
fi
# The page's packages are fetched outside, by npm, which is large.
lock=$root/web/package-lock.json
fetched=$root/web/node_modules/.package-lock.json
if [ ! -e "$fetched" ] || [ "$(find "$lock" -newer "$fetched")" ]; then
  quietly npm --prefix "$root/web" ci --omit=dev --no-audit --no-fund --loglevel=error
fi
# shellcheck disable=SC2016 # for the inner shell
exec $as_root unshare --mount sh -c '
  mount --bind "$1" "$2$1"
  mount -t proc proc "$2/proc"
  tree=$2
  shift 2
  exec chroot "$tree" "$@"' sh "$root" "$tree" env "CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" \
  "CCACHE_DIR=$root/build/ccache-$release" "CCACHE_BASEDIR=$root" CCACHE_NOHASHDIR=1 "$@"
