#!/bin/bash
# SPDX-License-Identifier: MIT
# Whether two machines made the same of a recording: every pose within 1 cm and 0.1 degree, 99.5 % of the map's
# cells the same. Usage: tests/package/same_result_test.sh FOLDER OTHER_FOLDER, each as `dynslam replay --out` wrote it.
set -euo pipefail
one=$1 other=$2
fail() {
  echo "not so: $*" >&2
  exit 1
}

# Turns about z alone: yaw is twice the arc tangent of z over w.
paste "$one/trajectory.tum" "$other/trajectory.tum" | awk '
  /^#/ { next }
  NF != 16 || $1 != $9 { print "pose " NR ": not at the same time"; failed = 1; exit }
  {
    m = sqrt(($2 - $10) ^ 2 + ($3 - $11) ^ 2)
    degrees = 2 * (atan2($7, $8) - atan2($15, $16)) * 45 / atan2(1, 1)
    degrees -= 360 * int(degrees / 360 + (degrees < 0 ? -0.5 : 0.5))
    if (degrees < 0) degrees = -degrees
    if (m > most_m) most_m = m
    if (degrees > most_degrees) most_degrees = degrees
    poses++
  }
  END {
    printf "%d poses, off by at most %.2g m and %.2g degrees\n", poses, most_m, most_degrees
    exit failed || poses == 0 || most_m > 0.01 || most_degrees > 0.1
  }' || fail "the trajectories agree"

cells=$(stat -c %s "$one/map.pgm")
[[ $cells == "$(stat -c %s "$other/map.pgm")" ]] || fail "the maps are of one size"
differ=$(cmp -l "$one/map.pgm" "$other/map.pgm" | wc -l || true)
echo "$differ of $cells bytes of the map differ"
((differ * 200 <= cells)) || fail "99.5 % of the map's cells agree"
