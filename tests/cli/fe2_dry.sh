#!/usr/bin/env bash
# A block of dry tissue, unstressed at first, is compressed between plates with the real RVE.
set -eu
lamella=$1
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cat >"$dir/dry.yaml" <<'Y'
version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: 11.25 um}
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  mesh: {along: 3, through: 1}
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary:
    - {on: bottom, displacement: [0 mm, 0 mm]}
    - {on: top, displacement: [0 mm, -0.2 mm]}
  steps: 2
Y
"$lamella" fe2 "$dir/dry.yaml" --json --quiet >"$dir/out" || { cat "$dir/out"; echo "FAILED: exit status $?"; exit 1; }
[ "$(wc -l <"$dir/out")" = 2 ] || { echo "FAILED: $(wc -l <"$dir/out") steps, expected 2"; exit 1; }
