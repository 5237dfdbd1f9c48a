#!/usr/bin/env bash
# slow: macroscale runs that are killed, at 40 random instants
. "$(dirname "$0")/../cli/common.sh"
/usr/bin/python3 -c 'import h5py, numpy' 2>/dev/null || exit 77
command -v mpirun >/dev/null || exit 77
/usr/bin/python3 "$source/tests/fault/fe2.py" "$lamella" 40 ${LAMELLA_SEED:-$RANDOM}
