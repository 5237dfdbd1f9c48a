#!/usr/bin/env bash
# Builds on disks that are full or fail: some cases; disk_all.sh has all of them.
shim=$(realpath "$3")
. "$(dirname "$0")/../cli/common.sh"
/usr/bin/python3 -c 'import h5py' 2>/dev/null || exit 77
LD_PRELOAD=$shim "$lamella" --version >out.txt 2>&1 || exit 77 # sanitizers want to be loaded first
# file systems are mounted in a space of names of our own, where the system lets us have one
for space in "unshare -m" "unshare -rm" ""; do $space true 2>/dev/null && break; done
$space /usr/bin/python3 "$source/tests/fault/disk.py" "$lamella" "$shim" 1 60 ${LAMELLA_SEED:-1}
