#!/bin/sh
# MongoDB as a replica set of one: writes survive a crash of the server, and a second member can join later.
set -eu
install -m 0400 -o mongodb -g mongodb /run/secrets/mongodb_key /tmp/key # mongod wants it to be its own, mode 0400
exec docker-entrypoint.sh mongod --replSet rs0 --keyFile /tmp/key --bind_ip_all
