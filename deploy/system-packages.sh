#!/bin/sh
# Prints the command that installs the missing system packages; as root, installs them.
# Arguments are groups: setup (when there is none), python, test, containers, chromium, japanese, spin, debootstrap.
set -eu
PATH=$PATH:${SBIN:-/usr/local/sbin:/usr/sbin:/sbin} # folders of nft and others, only in root's PATH
missing=""
has() { command -v "$1" >/dev/null; }
lacks() { case " $missing " in *" $1 "*) ;; *) missing="$missing $1" ;; esac; }
need() { # PACKAGE COMMAND...: the package is missing unless one of the commands exists
  package=$1
  shift
  for name in "$@"; do
    if has "$name"; then return; fi
  done
  lacks "$package"
}

python() {
  python=$(command -v "${PYTHON:-python3}" || true)
  if [ -z "$python" ]; then
    for package in python3 python3-venv; do lacks $package; done
  else
    "$python" -c 'import sys; sys.exit(sys.version_info < (3, 10))' || {
      echo "Python 3.10 or newer is needed, $python is $("$python" -V 2>&1): set PYTHON=python3.x" >&2; exit 1; }
    "$python" -c 'import ensurepip, venv' 2>/dev/null || lacks python3-venv
  fi
}

setup() { # and what builds the interface packages
  python
  if [ -z "$python" ]; then
    lacks python3-dev
  else
    "$python" -c 'import sys, sysconfig, pathlib
sys.exit(not pathlib.Path(sysconfig.get_path("include"), "Python.h").exists())' || lacks python3-dev
  fi
  need gcc gcc
  need g++ g++
  [ -d /etc/ssl/certs ] && [ -n "$(ls -A /etc/ssl/certs 2>/dev/null)" ] || lacks ca-certificates
}

browser() { need chromium chromium chromium-browser; }

letters() { # a font for Japanese: a browser without one shows boxes
  need fontconfig fc-list
  [ -n "$(fc-list :lang=ja 2>/dev/null)" ] || lacks fonts-ipafont-gothic
}

compose() { # Compose: a plugin of the client, or a program of its own
  client=${DOCKER:-docker}
  [ -n "${DOCKER:-}" ] || [ ! -x /usr/bin/docker ] || client=/usr/bin/docker
  "$client" compose version >/dev/null 2>&1 || need docker-compose docker-compose
}

shared() { # commands that both kinds of tests call
  need prometheus promtool
  need prometheus prometheus
  need nftables nft
  need iproute2 ip
  compose
}

tests() {
  shared
  browser
  need prometheus-alertmanager amtool
  need openssl openssl
  need e2fsprogs mkfs.ext4
  need git git
  need spin spin
}

containers() {
  shared
  need debootstrap debootstrap
  need iptables iptables
  "$client" info >/dev/null 2>&1 || need docker.io dockerd # an engine that answers may be another package's
}

[ $# -gt 0 ] || set -- setup
for group in "$@"; do
  case $group in
    test) tests ;;
    chromium) browser ;;
    japanese) letters ;;
    spin) need spin spin ;;
    debootstrap) need debootstrap debootstrap ;;
    setup | python | containers) "$group" ;;
    *) echo "no group of system packages: $group" >&2; exit 2 ;;
  esac
done
[ -n "$missing" ] || exit 0
root=$([ "$(id -u)" != 0 ] || command -v apt-get || true)
[ -z "$root" ] || apt-get update -qq >/dev/null
case "$missing " in
  *" docker.io "*) # newer distributions have packages of their own for client and builder
    for package in docker-cli docker-buildx; do
      if apt-cache show $package >/dev/null 2>&1; then lacks $package; fi
    done ;;
esac
if [ -n "$root" ]; then
  echo "installing system packages:$missing"
  # RUNLEVEL=1: the installation does not start services.
  # shellcheck disable=SC2086  # a list of words
  RUNLEVEL=1 DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
else
  echo "system packages are missing. Run:  sudo apt-get install -y --no-install-recommends$missing" >&2
  exit 1
fi
