#!/bin/sh
# Ensures that a Docker engine runs: where none answers, it starts the one that `make containers` installs (as root).
# It prints the pid of an engine that it has started, so that the caller can stop only that one: `engine.sh stop PID`.
# That command returns when the engine has ended, since an engine that is still ending prevents the next from starting.
set -eu
log=${TMPDIR:-/tmp}/tms-dockerd.log
if [ "${1:-start}" = stop ]; then
  case $(cut -d" " -f3 "/proc/$2/stat" 2>/dev/null) in "" | Z)
    echo "dockerd (process $2) has ended by itself; $log tells:" >&2
    grep -E '^(panic|fatal|SIG|runtime)|level=(error|fatal)' "$log" | tail -n 15 >&2
    tail -n 15 "$log" >&2
    exit 0 ;;
  esac
  kill "$2"
  for _ in $(seq 100); do
    # The process has ended, or is a zombie that its parent has not collected yet.
    case $(cut -d" " -f3 "/proc/$2/stat" 2>/dev/null) in "" | Z) exit 0 ;; esac
    sleep 0.3
  done
  echo "dockerd (process $2) does not end" >&2
  exit 1
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
