#!/bin/sh
# SPDX-License-Identifier: MIT
# Cross-builds dynslam for a 64-bit Raspberry Pi from a Debian of the same release, and tests it under emulation.
# The sysroot holds the libraries of this machine's own release, as its cross compiler does.
set -eu

usage() {
  echo "usage: toolchain/pi.sh build | test" >&2
  exit 2
}
[ $# = 1 ] || usage
case $1 in build | test) ;; *) usage ;; esac

root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build/arm64
sysroot=$root/build/sysroot-arm64
packages=$(grep -e '-dev$' "$root/toolchain/packages.txt" | paste -sd,),libblas-dev,liblapack-dev
export CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}"
export CTEST_PARALLEL_LEVEL="${CTEST_PARALLEL_LEVEL:-$CMAKE_BUILD_PARALLEL_LEVEL}"
# shellcheck source=toolchain/quiet.sh
. "$root/toolchain/quiet.sh"

"$root/toolchain/install.sh" cmake ninja-build nodejs npm pkg-config crossbuild-essential-arm64 mmdebstrap qemu-user-static

# Made anew when the list of libraries changes; complete once its list is written.
if [ "$(cat "$sysroot/packages" 2>/dev/null)" != "$packages" ]; then
  say "making a sysroot"
  rm -rf --one-file-system "$sysroot"
  mkdir -p "$sysroot"
  # shellcheck source=/dev/null
  suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
  quietly mmdebstrap --variant=extract --architectures=arm64 --hook-dir=/usr/share/mmdebstrap/hooks/merged-usr \
    --include="$packages" "$suite" "$sysroot" "$("$root/toolchain/mirror.sh")"
  # Links to /lib/... would lead to this machine's own libraries.
  find "$sysroot/usr/lib/aarch64-linux-gnu" -lname '/*' | while read -r link; do
    ln -sfn --relative "$sysroot$(readlink "$link")" "$link"
  done
  # What installing would have linked as an alternative.
  for library in "$sysroot"/usr/lib/aarch64-linux-gnu/blas/*.so* "$sysroot"/usr/lib/aarch64-linux-gnu/lapack/*.so*; do
    [ ! -e "$library" ] || ln -sf --relative "$library" "$sysroot/usr/lib/aarch64-linux-gnu/"
  done
  # Ceres names libraries by their whole path.
  find "$sysroot/usr/lib/aarch64-linux-gnu/cmake" -name '*Targets*.cmake' -exec \
    sed -i "/INTERFACE_LINK_LIBRARIES/ s#\([;\"]\)/usr/lib/#\1$sysroot/usr/lib/#g" {} +
  echo "$packages" >"$sysroot/packages"
fi

say "building for arm64"
quietly cmake -S "$root" -B "$build" -G Ninja --toolchain "$root/toolchain/arm64.cmake" \
  -DCMAKE_BUILD_TYPE=Release -DDYNSLAM_WERROR=ON -DDYNSLAM_WEB=ON
quietly cmake --build "$build"
if [ "$1" = test ]; then
  say "testing under emulation"
  run_tests "$build"
fi
