#!/bin/sh
# Makes sure that a Docker engine answers: installs Debian's and starts it, as root and where there is none.
# Prints the pid of an engine that it started, so that whoever called can stop just that one.
set -eu
docker=${DOCKER:-docker}
"$docker" info >/dev/null 2>&1 && exit 0
[ "$(id -u)" = 0 ] || { echo "no Docker engine answers: start it, or add yourself to the group docker" >&2; exit 1; }
if ! command -v dockerd >/dev/null; then
  apt-get update -qq >&2
  RUNLEVEL=1 DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends docker.io iptables >&2
fi
log=${TMPDIR:-/tmp}/tms-dockerd.log
setsid dockerd >"$log" 2>&1 &
pid=$!
for _ in $(seq 100); do
  "$docker" info >/dev/null 2>&1 && { echo "$pid"; exit 0; }
  sleep 0.3
done
echo "dockerd does not start, see $log" >&2
kill "$pid"
exit 1
