#!/bin/sh
# Removes from a virtual environment the files that only building needs, and replaces copies of libraries by links.
set -eu
venv=$1
packages=$(echo "$venv"/lib/python3*/site-packages)
rm -rf "$venv"/bin/uv* "$venv"/include "$packages"/pip "$packages"/uv "$packages"/Cython "$packages"/pyximport
find "$venv" -name '*.a' -delete
find "$venv" -name __pycache__ -prune -exec rm -rf {} +
find "$packages"/numpy "$packages"/lxml -name tests -prune -exec rm -rf {} +
for real in "$venv"/lib/lib*.so.*.*.*; do
  for copy in "${real%.*.*.*}" "${real%.*.*}" "${real%.*}"; do
    if [ -f "$copy" ] && [ ! -L "$copy" ] && cmp -s "$real" "$copy"; then ln -sf "$(basename "$real")" "$copy"; fi
  done
done
