#!/bin/sh
# Names the system packages that are missing with the one command that installs them; as root, installs them.
# `system-packages.sh chromium` looks for the browser of the tests, too.
set -eu
missing=""
python=$(command -v "${PYTHON:-python3}" || true)
if [ -z "$python" ]; then
  missing="$missing python3 python3-venv python3-dev"
else
  "$python" -c 'import sys; sys.exit(sys.version_info < (3, 10))' || {
    echo "Python 3.10 or newer is needed, $python is $("$python" -V 2>&1): set PYTHON=python3.x" >&2; exit 1; }
  "$python" -c 'import ensurepip, venv' 2>/dev/null || missing="$missing python3-venv"
  "$python" -c 'import sys, sysconfig, pathlib
sys.exit(not pathlib.Path(sysconfig.get_path("include"), "Python.h").exists())' || missing="$missing python3-dev"
fi
command -v gcc >/dev/null || missing="$missing gcc"
command -v g++ >/dev/null || missing="$missing g++"
[ -d /etc/ssl/certs ] && [ -n "$(ls -A /etc/ssl/certs 2>/dev/null)" ] || missing="$missing ca-certificates"
if [ "${1:-}" = chromium ]; then
  command -v chromium >/dev/null || command -v chromium-browser >/dev/null || missing="$missing chromium"
fi
[ -z "$missing" ] && exit 0
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
  echo "installing system packages:$missing"
  apt-get update -qq
  # shellcheck disable=SC2086  # a list of words
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
else
  echo "system packages are missing. Run:  sudo apt-get install -y$missing" >&2
  exit 1
fi
