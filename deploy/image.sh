#!/bin/sh
# Builds the image of this checkout and prints its id: `image.sh NAME [TARGET]` (site by default; demo has the embedded
# store). BASE_IMAGE chooses the base; where no registry is reached, base-image.sh makes one.
set -eu
cd "$(dirname "$0")/.."
docker=${DOCKER:-docker}
base=$(DOCKER=$docker sh deploy/base-image.sh)
set -- --target "${2:-site}" --tag "$1"
certificates=/etc/ssl/certs/ca-certificates.crt # includes those of an inspecting proxy, where this PC has one
[ ! -s "$certificates" ] || set -- "$@" --secret "id=ca,src=$certificates"
DOCKER_BUILDKIT=1 exec "$docker" build --quiet --network host --file deploy/Dockerfile --build-arg "BASE_IMAGE=$base" "$@" .
