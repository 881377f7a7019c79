# shellcheck shell=bash
# SPDX-License-Identifier: MIT
# The steps of .ci/full. Each runs in its own shell at the top of the tree with `set -e`, and installs what it needs.

# shellcheck source=toolchain/quiet.sh
source toolchain/quiet.sh

logs=$PWD/build/ci
skipped=77
recording=tests/data/mit-csail.clf.gz
CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}
CTEST_PARALLEL_LEVEL=$CMAKE_BUILD_PARALLEL_LEVEL
# What was compiled in one checkout serves in another, whatever language the compiler speaks there.
CCACHE_BASEDIR=$PWD
CCACHE_SLOPPINESS='locale'
CCACHE_NOHASHDIR=1
CCACHE_IGNOREOPTIONS='-ffile-prefix-map=*'
export CMAKE_BUILD_PARALLEL_LEVEL CTEST_PARALLEL_LEVEL CCACHE_BASEDIR CCACHE_SLOPPINESS CCACHE_NOHASHDIR CCACHE_IGNOREOPTIONS

need() { toolchain/install.sh "$@"; }

need_to_build() {
  # shellcheck disable=SC2046 # one word a package
  need ccache $(grep -v '^#' toolchain/packages.txt) "$@"
}

skip() {
  echo "skipped: $*"
  exit $skipped
}

build() {
  echo "building with preset $1"
  quietly cmake --preset "$1"
  quietly cmake --build --preset "$1"
}

# For comparing what machines and compilers make of the recording.
fingerprint() {
  echo "fingerprint: trajectories $(cat "$1"/trajectory*.tum | sha256sum | cut -c-8), map $(sha256sum "$1/map.pgm" | cut -c-8)"
}

step_host() {
  need ccache
  toolchain/host.sh test
}

# Runs dynslam twice with the same arguments; all files are there, and all but the report are the same.
twice_the_same() {
  local name files=(map.png map.pgm map.yaml trajectory.tum trajectory_live.tum graph.svg report.json)
  [[ $1 != sim ]] || files+=(truth.tum recording.mcap)
  first=$(mktemp -d) second=$(mktemp -d)
  trap 'rm -rf "$first" "$second"' EXIT
  toolchain/host.sh run "$@" --out "$first"
  toolchain/host.sh run "$@" --out "$second"
  for name in "${files[@]}"; do
    [[ -s $first/$name ]] || { echo "$name was not written" && return 1; }
    [[ $name == report.json ]] || cmp "$first/$name" "$second/$name"
  done
  echo "all ${#files[@]} files are there; a second run gave the same"
  fingerprint "$first"
}

step_replay() { twice_the_same replay "$recording" --set slam.trusted_range_m=30; }

step_sim() {
  toolchain/host.sh run sim --headless --speed 0 --out out
  [[ -s out/map.png ]]
  twice_the_same sim --headless --speed 0 --duration 60 --seed 7 --world clutter
  toolchain/host.sh run replay "$first/recording.mcap" --out "$second" --quiet
  cmp "$first/trajectory.tum" "$second/trajectory.tum"
  echo "its recording gave the same trajectory"
}

# What leaves the robot, read with the packages that others read it with.
need_npm() {
  need nodejs npm
  # Not anew each time: another step may be using them.
  [[ tests/web/node_modules/.package-lock.json -nt tests/web/package-lock.json ]] ||
    quietly npm --prefix tests/web ci --no-audit --no-fund
}

need_browser() {
  need_npm
  command -v chromium >/dev/null || need chromium fonts-dejavu-core
}

step_web() {
  need ccache
  toolchain/host.sh build
  need_npm
  npm --prefix tests/web run --silent recording
  npm --prefix tests/web run --silent server
}

# The page: its types, its style, its pure code, and that somebody can drive with it.
step_page() {
  need ccache
  toolchain/host.sh build
  need nodejs npm
  quietly npm --prefix web ci --no-audit --no-fund
  quietly npm --prefix web run check
  npm --prefix web run --silent lint
  npm --prefix web run --silent test
  need_browser
  npm --prefix tests/web run --silent drive
}

step_browser() {
  need ccache
  toolchain/host.sh build
  need_browser
  PICTURES=$PWD/build/pictures npm --prefix tests/web run --silent page
}

step_asan() {
  need_to_build
  build asan
  run_tests build/asan
  out=$(mktemp -d)
  trap 'rm -rf "$out"' EXIT
  build/asan/src/dynslam replay "$recording" --set slam.trusted_range_m=30 --out "$out" --quiet
}

# Hours of robots' lives, step by step, and half an hour of attacks on a server: memory must not grow. With sanitizers it
# is faults and leaks that are looked for, as they keep and pad what they hand out; what the program itself holds is
# watched without.
prepare_soak() {
  need_to_build
  quietly cmake --preset asan
  quietly cmake --build --preset asan --target dynslam_soak dynslam
  quietly cmake --preset release -DDYNSLAM_BENCH=OFF
  quietly cmake --build --preset release --target dynslam_soak
  need_npm
  toolchain/host.sh build
}
step_soak() {
  # How many local maps it takes to know a flat settles within half an hour, and goes up and down a little after that.
  build/release/tests/tools/soak/dynslam_soak --minutes 60 --drives 5 --most-growth 10
  build/asan/tests/tools/soak/dynslam_soak --minutes 20 --most-growth 50
  local seconds=${SOAK_SECONDS:-1800} sanitized
  DYNSLAM=$PWD/build/asan/src/dynslam ASAN_OPTIONS=quarantine_size_mb=16 \
    node tests/web/server/soak.mjs "$seconds" 1024 >"$logs/soak_asan" 2>&1 &
  sanitized=$!
  node tests/web/server/soak.mjs "$seconds" 8
  wait $sanitized || { tail -n 60 "$logs/soak_asan" && return 1; }
}

step_format() {
  # Another release of clang-format would lay out some lines in another way.
  need clang-format-14 || skip "clang-format 14 is to be had on Debian 12"
  local file failed=0
  while read -r file; do
    clang-format-14 --dry-run -Werror "$file" >"$logs/clang-format" 2>&1 && continue
    echo "$file: $(grep -c 'error:' "$logs/clang-format") places; clang-format-14 -i mends them"
    failed=1
  done < <(git ls-files '*.h' '*.cpp')
  return $failed
}

step_scripts() {
  need shellcheck
  git grep -lz -E '^#!/bin/(ba)?sh' -- .ci package systemd tests toolchain | xargs -0 shellcheck --external-sources
}

step_tsan() {
  need_to_build
  build tsan
  # Its shadow memory leaves no room for addresses as random as some kernels make them.
  run_tests build/tsan setarch --addr-no-randomize
  setarch --addr-no-randomize build/tsan/src/dynslam sim --headless --duration 120
  need_npm
  DYNSLAM=$PWD/build/tsan/src/dynslam setarch --addr-no-randomize node tests/web/server/soak.mjs 120 256
}

# With clang as well, which counts what the tests reach; and each file by itself, to find what it does not include.
step_coverage() {
  need_to_build clang llvm jq
  build clang
  local counts=build/clang/counts folder lines failed=0
  rm -rf $counts
  LLVM_PROFILE_FILE=$PWD/$counts/%m.profraw run_tests build/clang
  llvm-profdata-14 merge -sparse $counts/*.profraw -o $counts/all
  find build/clang/src build/clang/tests -type f -executable -printf '-object\n%p\n' |
    xargs llvm-cov-14 export -summary-only -instr-profile $counts/all >"$logs/lines.json" 2>"$logs/llvm-cov"
  for folder in base grid pipe plan io slam drive autopilot sim robot server; do
    # With ccache their paths are those from the build's folder.
    lines=$(jq --arg in "/src/$folder/" '[.data[0].files[] | select(.filename | contains($in)) | .summary.lines] |
      100 * (map(.covered) | add) / (map(.count) | add)' "$logs/lines.json")
    printf 'src/%-9s %.1f %% of the lines\n' $folder "$lines"
    [[ ${lines%.*} -ge 90 ]] || failed=1
  done
  return $failed
}

# What was found to be in order is not looked at again until it, something it includes, or the rules change. Many files at
# once, as most of the time goes into what they include.
step_tidy() {
  need_to_build clang clang-tidy-14 jq || skip "clang-tidy 14 is to be had on Debian 12"
  quietly cmake --preset clang -B build/tidy -DCMAKE_UNITY_BUILD=ON -DDYNSLAM_BENCH=ON
  tidied=${XDG_CACHE_HOME:-$HOME/.cache}/dynslam-tidy
  mkdir -p "$tidied"
  find "$tidied" -type f -mtime +60 -delete
  export tidied
  export -f tidy
  jq -r --arg top "$PWD" '.[] | select(.file | test("^" + $top + "/(src|build/tidy/src/.*/Unity)/")) |
    .file, .directory, .command' build/tidy/compile_commands.json |
    tr '\n' '\0' | xargs -0 -n 3 -P "$CMAKE_BUILD_PARALLEL_LEVEL" bash -c 'tidy "$@"' tidy
}

# FILE DIRECTORY COMMAND: how it is compiled.
tidy() {
  local text mark top=$PWD
  text=$(cd "$2" && eval "$(sed -E 's/ -o [^ ]+//; s/ -c / -E /' <<<"$3")" | sed "s,$top/,,g") || return 1
  mark=$tidied/$({ clang-tidy-14 --version && cat .clang-tidy && echo "$text"; } | sha256sum | cut -d' ' -f1)
  [[ -e $mark ]] || { clang-tidy-14 --quiet --checks=-bugprone-suspicious-include -p build/tidy "$1" 2>/dev/null && touch "$mark"; }
}

step_fuzz() {
  need_to_build clang libclang-rt-dev
  build fuzz
  rm -f "$logs"/fuzz_*
  export -f fuzz
  export logs
  find build/fuzz/tests/fuzz -name 'fuzz_*' -type f -executable -print0 | sort -z |
    xargs -0 --no-run-if-empty -I{} -P "$CMAKE_BUILD_PARALLEL_LEVEL" bash -c 'fuzz {}'
  grep -q '^Done' "$logs"/fuzz_*
}

# One target, which must be done with its time and have found nothing.
fuzz() {
  local name=${1##*/fuzz_} found=build/fuzz/found
  mkdir -p "build/fuzz/corpus/$name" $found
  "$1" -max_total_time="${FUZZ_SECONDS:-60}" -timeout=10 -rss_limit_mb=2048 -artifact_prefix=$found/ \
    "build/fuzz/corpus/$name" "tests/fuzz/corpus/$name" >"$logs/fuzz_$name" 2>&1 ||
    { tail -n 60 "$logs/fuzz_$name" && return 1; }
  echo "$name: $(grep '^Done' "$logs/fuzz_$name")"
}

# Runs and tests a clean clone of the last commit in a new Debian. Nothing is taken along but what was compiled before
# in that release, as ccache has it: the same compiler, headers and code.
fresh_debian() {
  local job began cache=$PWD/build/ccache-$1
  need ccache
  [[ $1 != "$(. /etc/os-release && echo "$VERSION_CODENAME")" ]] || cache=$(ccache --get-config cache_dir)
  root=/var/tmp/dynslam-$1-$$
  [[ $(id -u) == 0 ]] || skip "making a Debian root and entering it takes root"
  need mmdebstrap git
  trap 'rm -rf --one-file-system "$root"' EXIT
  echo "making a Debian $1"
  quietly mmdebstrap --variant=minbase --include=ccache "$1" "$root" "$(toolchain/mirror.sh)"
  git clone --quiet --no-hardlinks . "$root/root/dynslam"
  mkdir -p "$cache" "$root/root/ccache"
  # npm's registry may be reached over a certificate that only this machine knows.
  cp /etc/ssl/certs/ca-certificates.crt "$root/root/as-outside.crt"
  echo "commit $(git log -1 --format='%h %s')$(git diff --quiet HEAD || echo ', without what is not committed')"
  for job in "run sim --headless --speed 0 --out /root/dynslam/out" test; do
    began=$SECONDS
    # shellcheck disable=SC2016 # for the inner shell
    unshare --mount --pid --fork --kill-child bash -c '
      mount --bind "$1" "$2/root/ccache" && mount -t proc proc "$2/proc" &&
        mount -t devpts -o newinstance,ptmxmode=0666 devpts "$2/dev/pts" && mount --bind "$2/dev/pts/ptmx" "$2/dev/ptmx" &&
        shift && exec chroot "$@"' enter \
      "$cache" "$root" /usr/bin/env -i NODE_EXTRA_CA_CERTS=/root/as-outside.crt HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin \
      CCACHE_DIR=/root/ccache CCACHE_BASEDIR=/root/dynslam CCACHE_NOHASHDIR=1 CCACHE_IGNOREOPTIONS="$CCACHE_IGNOREOPTIONS" \
      CCACHE_SLOPPINESS="$CCACHE_SLOPPINESS" CMAKE_BUILD_PARALLEL_LEVEL="$CMAKE_BUILD_PARALLEL_LEVEL" \
      bash -c "/root/dynslam/toolchain/host.sh $job"
    echo "host.sh $job took $((SECONDS - began)) s"
  done
  [[ -s $root/root/dynslam/out/map.png ]]
  fingerprint "$root/root/dynslam/out"
}
step_debian12() { fresh_debian bookworm; }
step_debian13() { fresh_debian trixie; }

step_package() {
  [[ $(id -u) == 0 ]] || skip "making a Debian root and entering it takes root"
  need ccache dpkg-dev file mmdebstrap systemd-container lintian libnss3-tools
  command -v chromium >/dev/null || need chromium fonts-dejavu-core
  toolchain/host.sh build
  quietly cmake --build build/release --target package
  tests/package/package_test.sh build/release/dynslam_*.deb
}

step_arm64() {
  need_to_build
  toolchain/pi.sh test
  local debian build
  debian=$(. /etc/os-release && echo "$VERSION_ID")
  build=build/arm64-$debian
  here=$(mktemp -d) there=$(mktemp -d)
  trap 'rm -rf "$here" "$there"' EXIT
  toolchain/host.sh run replay "$recording" --set slam.trusted_range_m=30 --out "$here" --quiet
  qemu-aarch64-static -L "build/sysroot-arm64-$debian" "$build/src/dynslam" replay "$recording" \
    --set slam.trusted_range_m=30 --out "$there" --quiet
  fingerprint "$there"
  tests/package/same_result_test.sh "$here" "$there"
  toolchain/pi.sh package
  tests/package/content_test.sh "$build"/dynslam_*.deb
}

step_arm64d13() {
  [[ $(id -u) == 0 ]] || skip "making a Debian root and entering it takes root"
  need ccache
  toolchain/pi.sh package --debian 13
  tests/package/content_test.sh build/arm64-13/dynslam_*.deb
}
