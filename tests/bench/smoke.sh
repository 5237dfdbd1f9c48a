#!/usr/bin/env bash
# bash smoke.sh PROGRAM [ARGUMENT...]: a bench program starts and runs for a second, or to its end with status 0
status=0
timeout 1 "$@" >/dev/null || status=$?
[ $status = 0 ] || [ $status = 124 ] || { echo "$* ends with status $status" >&2; exit 1; }
