#!/bin/sh
# Makes the passwords of the cps PC, once, readable by you only. They are never in git, an image or a log.
set -eu
umask 077
folder=$(dirname "$0")/secrets
mkdir -p "$folder"
random() { head -c "$1" /dev/urandom | base64 | tr -d '\n=+/'; }
[ -e "$folder/mongodb_password" ] || random 24 >"$folder/mongodb_password"
[ -e "$folder/mongodb_key" ] || random 512 >"$folder/mongodb_key"
[ -e "$folder/grafana_password" ] || random 24 >"$folder/grafana_password"
[ -e "$folder/mongodb_uri" ] || printf 'mongodb://tms:%s@127.0.0.1:27017/?replicaSet=rs0&authSource=admin' \
  "$(cat "$folder/mongodb_password")" >"$folder/mongodb_uri"
# Containers read them as users of their own, each bound by itself; the folder keeps everybody else here out.
chmod 0444 "$folder"/*
chmod 0700 "$folder"
echo "secrets are in $folder"
