#!/bin/bash
# SPDX-License-Identifier: MIT
# Boots a Debian that a package lies in, in a container, looks at its page over HTTPS with a real browser, and starts,
# kills, hangs and upgrades the service. Takes root.
# Usage: tests/package/boot_test.sh ROOT DEB, DEB within ROOT's /tmp beside newer.deb
# shellcheck disable=SC2016 # for the inner shells
set -euo pipefail
root=$1 name=$2
unit=dynslam.service

cp "$root/tmp/$name" "$root/tmp/newer.deb" "$root/root/"
# The tree may have been given the name of the machine that it was made on.
echo rover >"$root/etc/hostname"
# Its /run is the container's, as systemd-nspawn leaves traces in it.
unshare --mount sh -c 'mount -t tmpfs tmpfs /run && exec systemd-nspawn --quiet --directory "$1" --boot --hostname=rover \
  --private-network --register=no --keep-unit --console=pipe --link-journal=no' sh "$root" </dev/null >"$root.console" 2>&1 &
container=$!
leader=
finish() {
  [[ ! $leader ]] || nsenter -t "$leader" -a systemctl poweroff --no-wall >/dev/null 2>&1 || true
  timeout 30 tail --pid=$container -f /dev/null || kill -KILL $container
  rm -rf "$root.console" "$root.home"
}
trap finish EXIT
trap 'echo "failed in line $LINENO" >&2' ERR

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
not() { ! "$@"; }
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

# A browser that trusts the robot's authority, and where a name is looked up that only the local network would know.
browse() {
  nsenter -t "$leader" -n env HOME="$root.home" chromium --headless=new --no-sandbox --disable-gpu \
    --host-resolver-rules='MAP rover.local 127.0.0.1' --dump-dom "$1" | grep -q '<title>dynslam'
}
test_https() {
  inside systemctl start dynslam-tls.service
  inside systemd-run --quiet --unit=page dynslam sim --port 8080
  within 20 "the simulated robot serves its page" nsenter -t "$leader" -n curl -s http://127.0.0.1:8080/
  mkdir -p "$root.home/.pki/nssdb"
  certutil -d "sql:$root.home/.pki/nssdb" -N --empty-password
  check "a browser does not trust an authority that it does not know" not browse https://rover.local/
  certutil -d "sql:$root.home/.pki/nssdb" -A -t C,, -n rover -i "$root/var/lib/private/dynslam-tls/rover.pem"
  within 20 "then it shows the page by the robot's name" browse https://rover.local/
  check "and by its address" browse https://127.0.0.1/
  inside systemctl reload dynslam-tls.service
  check "and after a new certificate" browse https://rover.local/
  inside systemctl stop page.service dynslam-tls.service
}

inside dpkg -i "/root/$name" >/dev/null
test_https
if ! inside dynslam --help | grep -q '^  run '; then
  echo "skipped: this dynslam has no 'run' for the service to start"
  exit 0
fi
inside systemctl enable --quiet $unit
inside systemctl start $unit || true
within 60 "the service says that it is ready" is ActiveState active
pid=$(value MainPID)
# Machines that are themselves within another may not be allowed to allow this.
if prlimit --rtprio=50 true 2>/dev/null; then
  check "one thread is a real-time one" real_time_threads 1
else
  echo "skipped: real-time scheduling, which this machine does not allow"
fi
# Flash wears out.
written() { inside sh -c 'grep ^write_bytes "/proc/$1/io"; find /var/lib/dynslam -printf "%p %s %T@ %C@\n"' sh "$pid"; }
sleep 2
before=$(written)
sleep 20
check "it writes nothing while nobody asks for anything" test "$(written)" == "$before"
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
