#!/usr/bin/env bash
# lamella query: answers in reach, refusals out of reach, many questions from standard input.
. "$(dirname "$0")/common.sh"
set -e -o pipefail

cat >s.yaml <<'YAML'
version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: 11.25 um}
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  interface: {law: bonded}
  turgor: {mode: prescribed, pressure: 0.02 MPa}
  mesh: {along: 4, through: 1}
sample:
  stretch: {min: 0, max: 0.06}
  turgor: {min: 0.01 MPa, max: 0.03 MPa}
  count: 40
YAML
"$lamella" build s.yaml -d db.h5 --quiet >/dev/null

# in reach
expect 0 "$lamella" query db.h5 -F "1.03 0.01 0 1.02" -p "0.02 MPa" --accuracy inf --json --tangent
[ "$(wc -l <out.txt)" = 1 ] || fail "more than one line"
for part in '"source": *"database"' '"tangent": *\[' '"error_estimate": *[0-9]' '"indicators_trusted": *[tf]'; do
  grep -q "$part" out.txt || fail "$part is missing: $(cat out.txt)"
done
expect 0 "$lamella" query db.h5 -F "1.03 0.01 0 0 1.02 0 0 0 1" -p "20 kPa" --accuracy inf
grep -q 'error est. indicators' out.txt || fail "no columns of the estimate: $(cat out.txt)"

# out of reach: said so, not solved
expect 3 "$lamella" query db.h5 -F "1.5 0 0 1.5" -p "0.02 MPa" --json
grep -q '"status": *"out_of_reach"' out.txt || fail "status: $(cat out.txt)"
grep -q '"reason"' out.txt || fail "no reason: $(cat out.txt)"
expect 3 "$lamella" query db.h5 -F "-1 0 0 1" --json
grep -q '"status": *"invalid_F"' out.txt || fail "status: $(cat out.txt)"

# a turgor that changes the volume of the walls is beyond what the nodes' derivatives tell, also where F is in reach
expect 0 "$lamella" query db.h5 -F "1.03 0.01 0 1.02" -p "2 MPa" --accuracy inf
expect 3 "$lamella" query db.h5 -F "1.03 0.01 0 1.02" -p "1e40 MPa" --accuracy inf
grep -q 'it changes the volume of the walls' out.txt || fail "no reason: $(cat out.txt)"

# the unit of a question is of no account
for turgor in "20 kPa" "2e10 uPa" "2e-5 GPa" "2e-8 TPa"; do
  expect 0 "$lamella" query db.h5 -F "1.03 0.01 0 1.02" -p "$turgor" --accuracy inf --json
  sed 's/"seconds": [^,]*,//' out.txt >"told-${turgor#* }"
  cmp -s told-kPa "told-${turgor#* }" || fail "$turgor: $(cat out.txt)"
done

# what is asked for decides whether there is an answer
expect 3 "$lamella" query db.h5 -F "1.03 0.01 0 1.02" --accuracy 1e-12 --json
grep -q '"status": *"out_of_reach"' out.txt || fail "an answer with an error of 1e-12: $(cat out.txt)"

# many questions; turgor and cohesion in the line, else by -p, else the scene's
cat >lines <<'LINES'
# F11 F12 F21 F22, then turgor and cohesion
1.03 0.01 0 1.02

1.02,0,0,1.02 ; 0.025 MPa
1.02 0 0 1.02 15kPa 1 kPa
1.02 0 0 0 1.02 0 0 0 1 ; 0.03 N mm-2; 0.002 MPa
LINES
expect 0 "$lamella" query db.h5 -F - --accuracy inf --json <lines
sed -E 's/.*"turgor": ([^,]*), "cohesion": ([^,]*),.*/\1 \2/' out.txt | awk '{ printf "%.6g %.6g\n", $1, $2 }' >told
cmp -s told <(printf '0.02 0\n0.025 0\n0.015 0.001\n0.03 0.002\n') || fail "turgor and cohesion of lines: $(cat told)"
expect 0 "$lamella" query db.h5 -F "1.03 0.01 0 1.02" --accuracy inf
grep -q "turgor where not given 0.02 MPa, the scene's" out.txt || fail "the turgor is not told: $(cat out.txt)"
expect 0 "$lamella" query db.h5 -F "1.03 0.01 0 1.02 ; 0.03 MPa" -p "0.01 MPa" --accuracy inf --json
grep -qE '"turgor": 0.0(3|29999)' out.txt || fail "-p before the question's own turgor: $(cat out.txt)"
printf '1.03 0.01 0 1.02\n1.02 zero 0 1.02\n' >lines
expect 2 "$lamella" query db.h5 -F - -p "0.02 MPa" --accuracy inf --json <lines
grep -q 'line 2: "zero" is no number' err.txt || fail "the line is not named: $(cat err.txt)"

# usage and wrong files
expect 1 "$lamella" query db.h5
for question in "1 0 0" "1 0 0 1 0.02" "1 0 0 1; 0.02" "1 0 0 1 1 MPa 1 MPa 1 MPa" "1 0 0 1;" "1 0 0 1 20 degC"; do
  expect 1 "$lamella" query db.h5 -F "$question"
done
expect 1 "$lamella" query db.h5 -F "1 0 0 1" -p 0.02
expect 1 "$lamella" query db.h5 -F "1 0 0 1" --accuracy 0
expect 1 "$lamella" query db.h5 -F "1 0 0 1" --accuracy "1 %"
expect 2 "$lamella" query s.yaml -F "1 0 0 1"
expect 4 "$lamella" query missing.h5 -F "1 0 0 1"

# a patch is no material point: its file answers no question
cat >patch.yaml <<'YAML'
version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: 11.25 um}
  patch: {columns: 2, rows: 2}
  wall: {law: mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa}
  mesh: {along: 2, through: 1}
load:
  - {F: [[1, 0.01], [0, 1]]}
YAML
expect 0 "$lamella" rve patch.yaml -o patch.h5
expect 2 "$lamella" query patch.h5 -F "1 0.01 0 1"
grep -q "patch.h5: holds states of a patch between grips" err.txt || fail "the reason: $(cat err.txt)"

# cells that differ answer from their own records, and not from mirrored ones
cat >uneven.yaml <<'YAML'
version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: 11.25 um}
  cells: [2, 2]
  wall: {law: mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa}
  variation: {kinds: [{wall_thickness: 22.5 um}], list: [0, 1, 0, 0]}
  turgor: {pressure: 0.02 MPa}
  mesh: {along: 2, through: 1}
load:
  - {F: [[1, 0.1], [0, 1]]}
YAML
expect 0 "$lamella" rve uneven.yaml -o uneven.h5
expect 0 "$lamella" query uneven.h5 -F "1 0.1 0 1" -p "0.02 MPa"
expect 3 "$lamella" query uneven.h5 -F "1 -0.1 0 1" -p "0.02 MPa"

# where they differ in turgor dPsi/dp is no lumen volume: that is the record's, and unknown elsewhere
sed -i 's/wall_thickness: 22.5 um/turgor: 0.5/' uneven.yaml
expect 0 "$lamella" rve uneven.yaml -o turgor.h5 --json
lumen=$(grep -oE '"lumen_fraction": [0-9.]+' out.txt)
expect 0 "$lamella" query turgor.h5 -F "1 0.1 0 1" -p "0.02 MPa" --json
grep -q "$lumen" out.txt || fail "not the $lumen of the record: $(cat out.txt)"
expect 0 "$lamella" query turgor.h5 -F "1 0.105 0 1" -p "0.02 MPa" --json
grep -q '"lumen_fraction": null' out.txt || fail "a lumen volume from dPsi/dp: $(cat out.txt)"
