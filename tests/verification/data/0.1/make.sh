#!/usr/bin/env bash
# How the files here were made, by version 0.1: bash make.sh PROGRAM FOLDER. Later versions must read them as they are
# (tests/cli/earlier.sh); what a later version adds goes into a folder of its own.
# Needs root, so that the files do not hold the name of a machine.
set -euo pipefail
lamella=$(realpath "$1")
mkdir -p "$2"
cp "$(dirname "$0")"/*.yaml "$2"
ln -s "$lamella" "$2/lamella"
cd "$2"
PATH=$PWD:$PATH unshare -u bash -ec '
  hostname host
  lamella tissue -o tissue.json --cells 6 --size "150 um" --variation 0.3 --gas 0.03 --wall-thickness "11.25 um"
  lamella build table.yaml -d table.h5
  lamella build contact.yaml -d contact.h5
  lamella fe2 contact.yaml -d contact.h5 -o fe2.h5
  lamella rve irregular.yaml -o rve.h5
  lamella process process.yaml -o process.h5 --frames 2
  lamella map map.yaml -o map.h5
  lamella tear tear.yaml -o tear.csv --modes opening --steps 4
'
gzip -9n ./*.h5
rm lamella ./*.xdmf
