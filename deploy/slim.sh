#!/bin/sh
# Removes from a virtual environment what only building and debugging need, and replaces copies of libraries by links.
set -eu
venv=$1
packages=$(echo "$venv"/lib/python3*/site-packages)
rm -rf "$venv"/bin/uv* "$venv"/include "$venv"/interfaces "$venv"/lib/cmake "$packages"/include
for tool in Cython _distutils_hack distutils-precedence.pth pip pyximport setuptools uv; do rm -rf "${packages:?}/$tool"; done
find "$venv" -name __pycache__ -prune -exec rm -rf {} +
find "$venv" -type f \( -name '*.a' -o -name '*.c' -o -name '*.cmake' -o -name '*.cpp' -o -name '*.h' -o -name '*.hpp' \
  -o -name '*.pxd' -o -name '*.pyi' -o -name '*.pyx' \) -delete
find "$packages"/numpy "$packages"/lxml -name tests -prune -exec rm -rf {} +
# Numbers and dates of a thousand regions: only the two languages of the texts are read.
find "$packages"/babel/locale-data -name '*.dat' ! -name root.dat ! -name 'en*' ! -name 'ja*' -delete
# Not those in *.libs: patchelf has moved their segments, and the loader refuses them after strip.
find "$packages" "$venv"/lib -maxdepth 3 -name '*.so*' -type f -not -path '*.libs/*' -exec strip --strip-debug {} +
linked() { # COPY FILE TARGET: as a link, if they are the same
  if [ -f "$1" ] && [ ! -L "$1" ] && cmp -s "$1" "$2"; then ln -sf "$3" "$1"; fi
}
for real in "$venv"/lib/lib*.so.*.*.*; do
  for copy in "${real%.*.*.*}" "${real%.*.*}" "${real%.*}"; do linked "$copy" "$real" "$(basename "$real")"; done
done
for copy in "$packages"/ros_*.libs/*.so*; do # each package of ROS brings its own
  first=$(find "$packages"/ros_*.libs -name "$(basename "$copy")" | sort | head -n 1)
  [ "$copy" = "$first" ] || linked "$copy" "$first" "../${first#"$packages"/}"
done
