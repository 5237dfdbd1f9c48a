#!/usr/bin/env bash
# Files that are cut or in which bits flip are told, and give back what is sound: some cases; damage_all.sh has many.
shim=$(realpath "$3")
. "$(dirname "$0")/../cli/common.sh"
/usr/bin/python3 -c 'import h5py' 2>/dev/null || exit 77
/usr/bin/python3 "$source/tests/fault/damage.py" "$lamella" "$shim" 6 ${LAMELLA_SEED:-1}
