#!/usr/bin/env bash
# A test of tests/CMakeLists.txt: run.sh LAMELLA SOURCE_DIR SHIM NAME ARGUMENTS... runs NAME.py; NAME_all from a random seed.
shim=$(realpath "$3")
. "$(dirname "$0")/../cli/common.sh"
/usr/bin/python3 -c 'import h5py, numpy' 2>/dev/null && command -v mpirun >/dev/null || exit 77
seed=${LAMELLA_SEED:-1} name=${4%_all} space=
[ "$name" = "$4" ] || seed=${LAMELLA_SEED:-$RANDOM}
case $name in
kill | disk) LD_PRELOAD=$shim "$lamella" --version >out.txt 2>&1 || exit 77 ;; # sanitizers want to be loaded first
esac
# file systems are mounted in a space of names of our own, where the system lets us have one
[ $name != disk ] || for space in "unshare -m" "unshare -rm" ""; do $space true 2>/dev/null && break; done
$space /usr/bin/python3 "$source/tests/fault/$name.py" "$lamella" "$shim" "${@:5}" "$seed"
