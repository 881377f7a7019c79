#!/bin/bash
# SPDX-License-Identifier: MIT
# Boots a Debian that a package lies in, in a container, and starts, kills, hangs and upgrades the service. Takes root.
# Usage: tests/package/boot_test.sh ROOT DEB, DEB within ROOT's /tmp beside newer.deb
# shellcheck disable=SC2016 # for the inner shells
set -euo pipefail
root=$1 name=$2
unit=dynslam.service

# Its /run is the container's, as systemd-nspawn leaves traces in it.
cp "$root/tmp/$name" "$root/tmp/newer.deb" "$root/root/"
unshare --mount sh -c 'mount -t tmpfs tmpfs /run && exec systemd-nspawn --quiet --directory "$1" --boot \
  --private-network --register=no --keep-unit --console=pipe --link-journal=no' sh "$root" </dev/null >"$root.console" 2>&1 &
container=$!
leader=
finish() {
  [[ ! $leader ]] || nsenter -t "$leader" -a systemctl poweroff --no-wall >/dev/null 2>&1 || true
  timeout 30 tail --pid=$container -f /dev/null || kill -KILL $container
  rm -f "$root.console"
}
trap finish EXIT

inside() { nsenter -t "$leader" -a env -i LC_ALL=C DEBIAN_FRONTEND=noninteractive PATH=/usr/sbin:/usr/bin:/sbin:/bin "$@"; }
value() { inside systemctl show --property "$1" --value $unit; }
# What must be true now, in words, and the command that says so.
check() { within 0 "$@"; }
# Waits until a command succeeds, so many seconds at most.
within() {
  local seconds=$1 what=$2 end
  shift 2
  end=$((SECONDS + seconds))
  until "$@" >/dev/null 2>&1; do
    if ((SECONDS >= end)); then
      echo "not so: $what" >&2
      inside journalctl --no-pager -u $unit | tail -n 40 >&2
      exit 1
    fi
    sleep 0.5
  done
  echo "ok: $what"
}
is() { [[ $(value "$1") == "$2" ]]; }
real_time_threads() {
  [[ $(inside sh -c 'for task in /proc/'"$pid"'/task/*; do chrt --pid "${task##*/}"; done' | grep -c SCHED_FIFO) == "$1" ]]
}
other_process() { is ActiveState active && ! is MainPID "$pid"; }

booted() {
  leader=$(pgrep -P $container | head -1)
  [[ $leader ]] && inside systemctl is-system-running --wait | grep -Eq 'running|degraded'
}
end=$((SECONDS + 120))
until booted; do
  ((SECONDS < end)) || { cat "$root.console" >&2 && exit 1; }
  sleep 1
done

inside dpkg -i "/root/$name" >/dev/null
if ! inside dynslam run --help >/dev/null 2>&1; then
  echo "skipped: this dynslam has no 'run' for the service to start"
  exit 0
fi
inside systemctl enable --now --quiet $unit
within 60 "the service says that it is ready" is ActiveState active
pid=$(value MainPID)
# Machines that are themselves within another may not be allowed to allow this.
if prlimit --rtprio=50 true 2>/dev/null; then
  check "one thread is a real-time one" real_time_threads 1
else
  echo "skipped: real-time scheduling, which this machine does not allow"
fi
inside systemctl kill --signal=KILL $unit
within 60 "killed, it comes back" other_process
pid=$(value MainPID)
inside systemctl kill --signal=STOP $unit
within 60 "hung, the watchdog ends it and it comes back" other_process
pid=$(value MainPID)
inside dpkg -i --force-confdef --force-confold /root/newer.deb >/dev/null 2>&1
within 60 "upgraded while it runs, it comes back" other_process
inside systemctl stop $unit
check "it ends well when asked to" is Result success
check "it writes to its own folders alone" inside sh -c '! find /etc /usr /home /root /srv /var -xdev -newer /root/newer.deb \
  -user dynslam ! -path "/var/lib/dynslam*" | grep .'
