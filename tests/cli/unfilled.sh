#!/usr/bin/env bash
# Tissue whose lumens do not fill what the walls leave: a database answers at any turgor of its box what rve does.
serve=1
. "$(dirname "$0")/common.sh"
set -e -o pipefail

# hexagons with air at junctions, 3 % of the volume
/usr/bin/python3 - <<'PYTHON'
import json, math
a = 75.0
R = 2 * a / math.sqrt(3)
corners = [[R * math.cos(math.pi / 6 + k * math.pi / 3), R * math.sin(math.pi / 6 + k * math.pi / 3)] for k in range(6)]
json.dump({"lamella_tissue": 1, "unit": "um", "period": [[2 * a, 0], [a, math.sqrt(3) * a]], "wall_thickness": 11.25,
           "corner_radius": 0.19 * R * math.sqrt(3), "vertices": corners, "cells": [list(range(6))]}, open("air.json", "w"))
PYTHON
scene() { # NAME KEYS: of rve; what goes on comes on standard input
  printf 'version: 1\nrve:\n  %s\n  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n' "$2" >"$1"
  printf '  mesh: {along: 6, through: 2}\n' >>"$1"
  cat >>"$1"
}
box='sample: {stretch: {min: -0.02, max: 0.2}, turgor: {min: 0 MPa, max: 0.2 MPa}}'
value() { grep -oE "\"$1\": [-0-9.e]+" out.txt | head -n 1 | sed 's/.*: //'; }
above() { awk "BEGIN {exit !($1 >= $2)}" || fail "$3: $1, less than $2"; }

# of random states all but a few are answered, hardly one beyond the accuracy, and errors keep to their estimates
scene air.yaml 'tissue: air.json' <<<"$box"
expect 0 "$lamella" build air.yaml -d air.h5 --quiet
expect 0 "$lamella" verify air.h5 --samples 60 --json --quiet
above "$(value share_answered)" 0.95 "share of answers"
above 0.017 "$(value share_beyond_accuracy)" "beyond the accuracy" # one of 60
above "$(value share_estimate_holds)" 0.97 "estimates of P that hold"
above "$(value share_tangent_estimate_holds)" 0.95 "estimates of the tangent that hold"
expect 0 "$lamella" info air.h5 --json
has out.txt '"suction": \[0'

# equal hexagons need as few nodes as ever: all of one turgor
scene full.yaml 'cell: {apothem: 75 um, wall_thickness: 11.25 um}' <<<"$box"
expect 0 "$lamella" build full.yaml -d full.h5 --quiet
expect 0 "$lamella" info full.h5 --json
has out.txt '"records": 10,' '"turgor": 0.1'

# one turgor far from the middle of the box: the database and rve agree to the accuracy
state='{F: [[1.10, 0.05], [0.05, 1.05]], turgor: 0.02 MPa}'
scene state.yaml 'tissue: air.json' <<<"load: [$state]"
expect 0 "$lamella" rve state.yaml --json --no-estimate --quiet
solved=$(grep -oE '"P": \[[^,]*' out.txt | tr -cd '0-9.e-')
expect 0 "$lamella" query air.h5 -F "1.10 0.05 0.05 1.05" -p "0.02 MPa" --json
answered=$(grep -oE '"P": \[[^,]*' out.txt | tr -cd '0-9.e-')
awk "BEGIN {d = $solved - $answered; exit !(d * d < (0.01 * 0.05) ^ 2)}" || fail "P11 $answered, rve has $solved"

# a record of one turgor says nothing of one far off
scene far.yaml 'tissue: air.json' <<<'load: [{F: [[1.1, 0], [0, 1.1]], turgor: 0.15 MPa}]'
expect 0 "$lamella" rve far.yaml -o far.h5 --quiet
expect 0 "$lamella" query far.h5 -F "1.1 0 0 1.1" -p "0.15 MPa"
expect 3 "$lamella" query far.h5 -F "1.1 0 0 1.1" -p "0.02 MPa"
