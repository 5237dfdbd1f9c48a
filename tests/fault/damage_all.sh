#!/usr/bin/env bash
# slow: files that are cut or in which bits flip are told, and give back what is sound: 200 cases. Prints figures.
shim=$(realpath "$3")
. "$(dirname "$0")/../cli/common.sh"
/usr/bin/python3 -c 'import h5py' 2>/dev/null || exit 77
/usr/bin/python3 "$source/tests/fault/damage.py" "$lamella" "$shim" 200 ${LAMELLA_SEED:-$RANDOM}
