#!/bin/bash
# SPDX-License-Identifier: MIT
# What dynslam's work takes of a core on Raspberry Pis that are not at hand: an estimate.
#
#   tests/bench/pi_cost.sh [DYNSLAM [SECONDS]]      a release build's program, how long it drives (20)
#
# callgrind counts the instructions and cache misses of `dynslam bench`, the simulator left out, with the caches of each
# core, on this machine (x86-64, its vectors 16 bytes wide as NEON's are). Time is then
#
#   instructions / (instructions a cycle * clock) + exposed * (misses of L1 * latency of L2 + misses of L2 * latency of RAM)
#
# Clocks and latencies are what sbc-bench measured on these boards (github.com/ThomasKaiser/sbc-bench, results/3E85, 1isD,
# 3OBF and 8-NK.txt: tinymembench, single random reads of the size of L2, of L3 on the Pi 5, and of 8 MiB). Instructions a
# cycle: 7-zip's decompression, of which callgrind counts 1.06 x86 instructions for each of its "MIPS", gets to 1.1 on the
# A53, 1.1 on the A72 and 1.5 on the A76 in those results; less is taken for the A53, which needs two cycles for most vectors
# and waits for its loads. It overlaps no misses here; the others hide half of them. Prefetching is not counted, nor what the
# kernel, drivers and sockets take.
set -euo pipefail

program=${1:-build/release/src/dynslam}
seconds=${2:-20}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export JSIMD_FORCESSE2=1 # or the JPEG encoder would use vectors that no Pi has

# count CORE I1 D1 LL: events of each part into a file, one part a line.
count() {
  valgrind --tool=callgrind --cache-sim=yes --I1="$2" --D1="$3" --LL="$4" --callgrind-out-file="$folder/$1.out" \
    --collect-atstart=no --toggle-collect='dynslam::Robot::step()' --toggle-collect='dynslam::StateChannel::next*' \
    --toggle-collect='dynslam::MapChannel::next*' --toggle-collect='dynslam::encode_jpeg*' \
    "$program" bench --duration "$seconds" > "$folder/$1.txt" 2> "$folder/$1.err" || { cat "$folder/$1.err" >&2; exit 1; }
  callgrind_annotate --inclusive=yes --threshold=100 --auto=no --show-percs=no \
    --show=Ir,I1mr,D1mr,D1mw,ILmr,DLmr,DLmw "$folder/$1.out" > "$folder/$1.costs"
}
# figure NAME FILE: of the line that bench prints.
figure() { sed -nE "s/^dynslam-bench:.* $1=([0-9.]+).*/\1/p" "$2"; }

count a53 32768,2,64 32768,4,64 524288,16,64 &
count a72 49152,3,64 32768,2,64 1048576,16,64 &
count a76 65536,4,64 65536,4,64 2097152,16,64 &
for job in $(jobs -p); do wait "$job"; done

# table BOARD CORE GHZ INSTRUCTIONS_A_CYCLE EXPOSED L2_NS RAM_NS
table() {
  awk -v board="$1" -v ghz="$3" -v ipc="$4" -v exposed="$5" -v l2="$6" -v ram="$7" \
    -v scans="$(figure scans "$folder/$2.txt")" -v drive_s="$(figure drive_s "$folder/$2.txt")" '
    function part(name) {
      for (p in is) if (index($0, is[p])) return p
      return ""
    }
    BEGIN {
      is["step"] = "dynslam::Robot::step()"; is["map"] = "dynslam::SlamStage::turn()"; is["loops"] = "dynslam::Slam::work_off("
      is["plan"] = "dynslam::AutopilotStage::plan_turn()"; is["pilot"] = "dynslam::AutopilotStage::pilot_turn()"
      is["control"] = "dynslam::ControlStage::turn()"; is["state"] = "dynslam::StateChannel::next("
      is["chunks"] = "dynslam::MapChannel::next("; is["jpeg"] = "dynslam::encode_jpeg("
    }
    (p = part()) != "" && $1 ~ /^[0-9]/ && !(p in s) {
      for (i = 1; i <= 7; i++) { gsub(",", "", $i); if ($i == ".") $i = 0 }
      ir[p] = $1; m1[p] = $2 + $3 + $4; m2[p] = $5 + $6 + $7
      s[p] = 1e-9 * ($1 / (ipc * ghz) + exposed * (m1[p] * l2 + m2[p] * ram))
    }
    END {
      sense = s["step"] - s["map"] - s["plan"] - s["pilot"] - s["control"]
      a_scan = 12.5 / scans * 100; a_second = 100 / drive_s
      map = (s["map"] + sense) * a_scan; drive = (s["plan"] + s["pilot"] + s["control"]) * a_second
      client = (s["state"] + s["chunks"]) * a_scan
      printf "| %s | %.1f ms | %.1f %% | %.1f %% | %.1f %% | **%.0f %%** | +%.0f %% |\n", board, 1e3 * s["map"] / scans, map, drive, client,
        map + drive + client, s["jpeg"] / drive_s * 100 * 20
      printf "%s: a scan %.2f million instructions (loops %.2f of them), %.0f misses of L1, %.0f of L2\n", board,
        1e-6 * ir["map"] / scans, 1e-6 * ir["loops"] / scans, m1["map"] / scans, m2["map"] / scans > "/dev/stderr"
    }' "$folder/$2.costs"
}

echo '| board | a scan | mapping at 12.5 Hz | driving by itself | one client | together, of one core | while video is watched |'
echo '| --- | --- | --- | --- | --- | --- | --- |'
table 'Zero 2 W (A53, 1.0 GHz)' a53 1.0 0.7 1.0 12.9 157
table '3B+ (A53, 1.4 GHz)' a53 1.4 0.7 1.0 12.1 164
table '4 (A72, 1.8 GHz)' a72 1.8 1.0 0.5 11.9 126
table '5 (A76, 2.4 GHz)' a76 2.4 1.5 0.5 16.3 80
