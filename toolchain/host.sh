#!/bin/sh
# SPDX-License-Identifier: MIT
# Builds dynslam on this machine (Debian 12 or later), installing what that takes, and runs or tests it.
set -eu

usage() {
  echo "usage: toolchain/host.sh build | test | run [ARGUMENTS OF dynslam]" >&2
  echo "       run alone replays the recording in tests/data into out/" >&2
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

say() { echo "$*" >&2; }

# Shows what a command printed only if it failed, without ninja's lines of progress.
quietly() {
  "$@" >"$build/host.log" 2>&1 </dev/null && return
  grep -v '^\[[0-9]*/[0-9]*\] ' "$build/host.log" >&2
  exit 1
}

# shellcheck disable=SC2046 # one word a package
"$root/toolchain/install.sh" $(grep -v '^#' "$root/toolchain/packages.txt")

mkdir -p "$build"
say "configuring build/release"
quietly cmake -S "$root" --preset release
say "building"
quietly cmake --build "$build"

case $job in
  test)
    say "testing"
    log=$build/host-test.log
    if ctest --test-dir "$build" --output-on-failure --no-tests=error --timeout 300 >"$log" 2>&1 </dev/null; then
      sed -n '/tests passed/,$p' "$log"
    else
      grep -v -e ' Passed ' -e '^ *Start ' "$log"
      exit 1
    fi
    ;;
  run)
    [ $# = 0 ] || exec "$dynslam" "$@"
    say "replaying tests/data/mit-csail.clf.gz"
    "$dynslam" replay "$root/tests/data/mit-csail.clf.gz" --set slam.trusted_range_m=30 --out "$root/out"
    echo "the map is in $root/out/map.png"
    ;;
esac
