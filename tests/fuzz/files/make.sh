#!/usr/bin/env bash
# Makes the sound files anew, after the members of responses have changed: bash tests/fuzz/files/make.sh PROGRAM
# Needs root, as the files are to tell no machine's name.
set -euo pipefail
lamella=$(realpath "$1")
cd "$(dirname "$0")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp ./*.yaml "$work"
ln -s "$lamella" "$work/lamella"
cd "$work"
unshare -u bash -c '
  hostname host
  for name in contact fe2 map rve table contact-table; do
    case $name in
    contact | rve) PATH=.:$PATH lamella rve $name.yaml -o $name.h5 --quiet ;;
    *table) PATH=.:$PATH lamella build $name.yaml -d $name.h5 --quiet ;;
    *) PATH=.:$PATH lamella $name $name.yaml -o $name.h5 --quiet ;;
    esac
  done' >/dev/null
gzip -9n ./*.h5
cp ./*.h5.gz "$OLDPWD"
