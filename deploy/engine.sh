#!/bin/sh
# Ensures that a Docker engine runs: where none answers, it starts the one that `make containers` installs (as root).
# It prints the pid of an engine that it has started, so that the caller can stop only that one: `engine.sh stop PID`.
# That command returns when the engine has ended, since an engine that is still ending prevents the next from starting.
set -eu
log=${TMPDIR:-/tmp}/tms-dockerd.log
ended() { # a process; or it is a zombie that its parent has not collected yet
  case $(cut -d" " -f3 "/proc/$1/stat" 2>/dev/null) in "" | Z) ;; *) return 1 ;; esac
}
wait_for() {
  for _ in $(seq 100); do
    ! ended "$1" || return 0
    sleep 0.3
  done
  echo "$2 (process $1) does not end" >&2
  exit 1
}
if [ "${1:-start}" = stop ]; then
  if ended "$2"; then
    echo "dockerd (process $2) has ended by itself; $log tells:" >&2
    grep -m 1 -A 15 -E '^(unexpected|panic|fatal error|SIG)' "$log" >&2 || tail -n 15 "$log" >&2
    if [ "$(cat /var/run/docker.pid 2>/dev/null)" = "$2" ]; then # what it has left prevents the next from starting
      below=/var/run/docker/containerd/containerd.pid
      [ ! -s "$below" ] || wait_for "$(cat "$below")" containerd
      rm -f "$below" /var/run/docker.pid
    fi
  else
    kill "$2"
    wait_for "$2" dockerd
  fi
  exit 0
fi
docker=${DOCKER:-docker}
"$docker" info >/dev/null 2>&1 && exit 0
[ "$(id -u)" = 0 ] || { echo "no Docker engine answers: start it, or add yourself to the group docker" >&2; exit 1; }
setsid dockerd >"$log" 2>&1 &
pid=$!
for _ in $(seq 100); do
  "$docker" info >/dev/null 2>&1 && { echo "$pid"; exit 0; }
  kill -0 "$pid" 2>/dev/null || { echo "dockerd ended, see $log" >&2; exit 1; }
  sleep 0.3
done
echo "dockerd does not start, see $log" >&2
kill "$pid"
exit 1
