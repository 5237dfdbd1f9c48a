#!/usr/bin/env bash
# slow: builds that are killed lose nothing: every system call of a build, 200 random instants. Prints figures.
shim=$(realpath "$3")
. "$(dirname "$0")/../cli/common.sh"
/usr/bin/python3 -c 'import h5py' 2>/dev/null || exit 77
LD_PRELOAD=$shim "$lamella" --version >out.txt 2>&1 || exit 77 # sanitizers want to be loaded first
/usr/bin/python3 "$source/tests/fault/kill.py" "$lamella" "$shim" 200 1 ${LAMELLA_SEED:-$RANDOM}
