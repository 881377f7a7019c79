#!/bin/sh
# SPDX-License-Identifier: MIT
# Cross-builds dynslam for a 64-bit Raspberry Pi and makes its package, or tests it under emulation. Each release of
# Debian is built for by its own compiler; where that is not this machine's, in a tree of that release, which takes root.
set -eu

usage() {
  cat >&2 <<END
usage: toolchain/pi.sh build | test | package [OPTION...]
  --debian 12|13     of Raspberry Pi OS; without it, that of this machine
  --sysroot DIR      build against the libraries in a copy of a Pi's card
  --from USER@HOST   or against those of a Pi, by rsync
  --cpu a53|a72|a76  for one kind of core: a53 Zero 2 W and 3, a72 Pi 4, a76 Pi 5; without it, for all of them
END
  exit 2
}
refuse() {
  echo "$*" >&2
  exit 2
}
job=${1-}
case $job in build | test | package) shift ;; *) usage ;; esac
# shellcheck source=/dev/null
here=$(. /etc/os-release && echo "${VERSION_ID-}")
debian=$here
from=
cpu=
while [ $# -gt 0 ]; do
  [ $# -ge 2 ] || usage
  case $1 in
    --debian) debian=$2 ;;
    --sysroot) from=$(cd "$2" 2>/dev/null && pwd) || refuse "there is no folder $2" ;;
    --from) from=$2: ;;
    --cpu) cpu=$2 ;;
    *) usage ;;
  esac
  shift 2
done
from=${from:-$debian}
case $debian in 12 | 13) ;; *) refuse "dynslam is built for Debian 12 and 13, not '$debian'; --debian says which" ;; esac
case $cpu in
  '' | a53 | a72 | a76) ;;
  arm11* | armv6* | armv7* | armhf | a7) refuse "dynslam needs 64 bits: no Pi 1, no first Zero, and no 32-bit system" ;;
  *) usage ;;
esac

root=$(cd "$(dirname "$0")/.." && pwd)
export CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}"
export CTEST_PARALLEL_LEVEL="${CTEST_PARALLEL_LEVEL:-$CMAKE_BUILD_PARALLEL_LEVEL}"
# shellcheck source=toolchain/quiet.sh
. "$root/toolchain/quiet.sh"

"$root/toolchain/install.sh" cmake ninja-build nodejs npm pkg-config crossbuild-essential-arm64 dpkg-dev file \
  mmdebstrap qemu-user-static
of=$from
case $from in
  12 | 13) ;;
  *)
    "$root/toolchain/install.sh" rsync openssh-client
    of=pi
    ;;
esac
sysroot=$root/build/sysroot-arm64-$of
build=$root/build/arm64-$of${cpu:+-$cpu}
"$root/toolchain/sysroot.sh" "$sysroot" "$from"
[ -e "$sysroot/usr/lib/ld-linux-aarch64.so.1" ] || refuse "$from has no 64-bit system; dynslam does not run on a 32-bit one"
debian=$(cat "$sysroot/release")

# Runs a command where that release's compiler is.
there() {
  if [ "$debian" = "$here" ]; then
    "$@"
  else
    "$root/toolchain/in_debian.sh" "$debian" "$@"
  fi
}

say "building for arm64, Debian $debian${cpu:+, Cortex-$cpu}"
# npm is there where it is needed: in a tree of another release, the page's packages are already.
quietly there cmake -S "$root" -B "$build" -G Ninja --toolchain "$root/toolchain/arm64.cmake" \
  "-DDYNSLAM_SYSROOT=$sysroot" "-DDYNSLAM_CPU=$cpu" "-DDYNSLAM_DEBIAN=$debian" -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
  -DDYNSLAM_WERROR=ON -DDYNSLAM_WEB=ON -DNPM=npm "-DDYNSLAM_TESTS=$([ "$job" = package ] && echo OFF || echo ON)"
quietly there cmake --build "$build"
case $job in
  test)
    say "testing under emulation"
    run_tests "$build"
    ;;
  package)
    quietly there env DEB_HOST_ARCH=arm64 "DYNSLAM_SYSROOT=$sysroot" "PATH=$root/toolchain/cross:$PATH" \
      cmake --build "$build" --target package
    ls "$build"/dynslam*_arm64.*deb
    ;;
esac
