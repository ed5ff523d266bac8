#!/bin/sh
# As root, gives sockets of this PC the room of network/sockets.conf until it starts anew. Where that is not allowed, prints
# the command (unless the argument is `quiet`).
set -eu
kernel=${KERNEL:-/proc/sys}
small=""
while read -r name _ wanted; do
  case $name in
    net.*) ;;
    *) continue ;;
  esac
  file=$kernel/$(echo "$name" | tr . /)
  [ -r "$file" ] || continue # a container is not shown it; its host's counts
  [ "$(cat "$file")" -lt "$wanted" ] || continue
  if { [ -w "$file" ] && echo "$wanted" >"$file"; } 2>/dev/null; then
    echo "until this PC starts anew: $name=$wanted"
  else
    small="$small $name=$wanted"
  fi
done <"$(dirname "$0")/network/sockets.conf"
if [ -n "$small" ] && [ "${1:-}" != quiet ]; then
  echo "forty processes start in three times the processor time here, unless:  sudo sysctl -w$small" >&2
fi
