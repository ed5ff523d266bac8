#!/bin/sh
# Prints the name of a base image for the Dockerfile: pulled where a registry is reached, else made with debootstrap.
set -eu
docker=${DOCKER:-docker}
wanted=${BASE_IMAGE:-debian:bookworm-slim}
made=tms-base:bookworm
for image in "$wanted" "$made"; do
  "$docker" image inspect "$image" >/dev/null 2>&1 && { echo "$image"; exit 0; }
done
timeout 60 "$docker" pull -q "$wanted" >/dev/null 2>&1 && { echo "$wanted"; exit 0; }
[ "$(id -u)" = 0 ] || { echo "$wanted cannot be pulled; set BASE_IMAGE, or run this as root to make one" >&2; exit 1; }
sh "$(dirname "$0")/system-packages.sh" debootstrap >&2
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
debootstrap --variant=minbase --include=ca-certificates,python3 bookworm "$root" >&2
rm -rf "$root"/var/lib/apt/lists/* "$root"/var/cache/apt/* "$root"/usr/share/locale/* "$root"/usr/share/man/* "$root"/usr/share/info/*
find "$root"/usr/share/doc -type f ! -name copyright -delete # keeps the licences
tar -C "$root" -c . | "$docker" import - "$made" >/dev/null
echo "$made"
