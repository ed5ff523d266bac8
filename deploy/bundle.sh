#!/bin/sh
# Packs what PCs without internet need: `bundle.sh VENV FOLDER`. It holds this checkout, the wheels of its locks, the
# interface packages and the console as built here, and runs where `make setup` was done. There, `make setup` is all.
# STORE=1: the embedded store as well, which is GPL. IMAGE=name: this image of containers as well.
set -eu
cd "$(dirname "$0")/.."
python=$1/bin/python folder=$2
name=ros2-tms-$("$python" -c 'import platform, sys, tms_runtime.version as v
print(v.version(), f"python{sys.version_info.major}.{sys.version_info.minor}", platform.machine(), sep="-")')
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
tree=$stage/$name
mkdir -p "$tree/wheels" "$folder"
fetch() { "$python" -m pip --disable-pip-version-check download -q -d "$tree/wheels" "$@"; }

git ls-files -z -- . ':!tests' | tar --null --files-from - --create | tar --extract --directory "$tree"
cp -R services/tms_ur/built "$tree/services/tms_ur/built"
cp "$1"/interfaces/tms_interfaces-*.whl "$tree/wheels"
echo "fetching wheels" >&2
fetch --no-deps --require-hashes -r deploy/requirements/requirements.lock
[ -z "${STORE:-}" ] || fetch --no-deps --require-hashes -r deploy/requirements/requirements-store.lock
fetch -c deploy/requirements/build.lock hatchling editables "$UV_PACKAGE"
if [ -n "${IMAGE:-}" ]; then
  echo "adding the image $IMAGE" >&2
  "${DOCKER:-docker}" save -o "$tree/image.tar" "$IMAGE"
fi
tar --create --file "$folder/$name.tar" --directory "$stage" "$name"
(cd "$folder" && sha256sum "$name.tar" >"$name.tar.sha256")
echo "$folder/$name.tar"
