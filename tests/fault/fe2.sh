#!/usr/bin/env bash
# Macroscale runs that are killed go on to the same results: some instants; fe2_all.sh has more.
. "$(dirname "$0")/../cli/common.sh"
/usr/bin/python3 -c 'import h5py, numpy' 2>/dev/null || exit 77
command -v mpirun >/dev/null || exit 77
/usr/bin/python3 "$source/tests/fault/fe2.py" "$lamella" 2 ${LAMELLA_SEED:-1}
