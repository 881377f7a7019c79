#!/bin/sh
# SPDX-License-Identifier: MIT
# Builds dynslam on this machine (Debian 12 or later), installing what that takes, and runs or tests it.
set -eu

usage() {
  echo "usage: toolchain/host.sh build | test | run [ARGUMENTS OF dynslam]" >&2
  echo "       run alone serves a simulated robot in a flat, until Ctrl-C" >&2
  exit 2
}
case ${1-} in
  build | test) [ $# = 1 ] || usage ;;
  run) ;;
  *) usage ;;
esac
job=$1
shift

root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build/release
dynslam=$build/src/dynslam
export CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}"
export CTEST_PARALLEL_LEVEL="${CTEST_PARALLEL_LEVEL:-$CMAKE_BUILD_PARALLEL_LEVEL}"

# shellcheck source=toolchain/quiet.sh
. "$root/toolchain/quiet.sh"

# shellcheck disable=SC2046 # one word a package
"$root/toolchain/install.sh" $(grep -v '^#' "$root/toolchain/packages.txt")

say "configuring build/release"
quietly cmake -S "$root" --preset release -DDYNSLAM_BENCH=OFF
say "building"
if [ "$job" = test ]; then
  quietly cmake --build "$build"
else
  quietly cmake --build "$build" --target dynslam
fi

case $job in
  test)
    say "testing"
    run_tests "$build"
    ;;
  run)
    [ $# = 0 ] || exec "$dynslam" "$@"
    say "a simulated robot in a furnished flat, until Ctrl-C; open in a browser:"
    exec "$dynslam" sim
    ;;
esac
