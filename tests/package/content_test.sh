#!/bin/bash
# SPDX-License-Identifier: MIT
# Looks at a package from outside: its size, what it depends on, its units, and what lintian says.
# Usage: tests/package/content_test.sh DEB
set -euo pipefail
deb=$1
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
dpkg-deb --extract "$deb" "$tree"
fail() {
  echo "not so: $*" >&2
  exit 1
}
size=$(stat -c %s "$deb")
echo "$(basename "$deb"): $size bytes, $(dpkg-deb --field "$deb" Installed-Size) KiB installed"
echo "depends on $(dpkg-deb --field "$deb" Depends)"
((size < 8000000)) || fail "it is smaller than 8 MB"
(($(dpkg-deb --field "$deb" Installed-Size) < 8000)) || fail "it takes less than 8 MB"
! readelf -S --wide "$tree/usr/bin/dynslam" | grep -qE '\.(symtab|debug_info)' || fail "it is stripped"
symbols=dynslam-dbgsym_${deb##*/dynslam_}
[[ -s $(dirname "$deb")/${symbols%deb}ddeb ]] || fail "the debugger's symbols are beside it"
dpkg-deb --field "$deb" Depends | grep -q 'libc6.*libstdc++6' || fail "it depends on the libraries that it is linked with"
[[ -s $tree/usr/lib/dynslam/camera.so ]] || fail "the part for cameras is in it"
dpkg-deb --field "$deb" Depends | grep -q libcamera || fail "it depends on that part's libraries"
! strings "$tree/usr/bin/dynslam" "$tree/usr/lib/dynslam/camera.so" | grep -F "$PWD/" || fail "it does not say where it was built"
for unit in dynslam dynslam-tls; do
  exposure=$(systemd-analyze security --offline=true --no-pager "$tree/usr/lib/systemd/system/$unit.service" 2>/dev/null |
    sed -n 's/.*exposure level for .*: \([0-9.]*\) .*/\1/p')
  echo "$unit.service: exposure $exposure"
  awk "BEGIN { exit !(\"$exposure\" != \"\" && $exposure + 0 < 2) }" || fail "its exposure is less than 2"
done
# Named exceptions alone, in package/lintian-overrides.
lintian --fail-on error,warning --tag-display-limit 0 "$deb" 2>&1 | grep -v 'root privileges' || [[ ${PIPESTATUS[0]} == 0 ]] ||
  fail "lintian has nothing to say"
echo "ok: what is in it"
