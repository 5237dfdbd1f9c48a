#!/usr/bin/env bash
# names.sh HEADER FILES...: writes new names of all that the files define, for a second copy of it beside the first.
sed -nE 's/^[A-Za-z][A-Za-z0-9_ *]*[ *]Lam([A-Za-z0-9]+)(\(| = |\[).*/#define Lam\1 EXTENDED(\1)/p' "${@:2}" | sort -u >"$1"
