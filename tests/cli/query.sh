#!/usr/bin/env bash
# lamella query: answers in reach, refusals out of reach, many questions from standard input.
. "$(dirname "$0")/common.sh"
serve=1
set -e -o pipefail

tissue >s.yaml <<'YAML'
sample: {stretch: {min: 0, max: 0.06}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, count: 40}
YAML
"$lamella" build s.yaml -d db.h5 --quiet >/dev/null

# in reach
expect 0 "$lamella" query db.h5 -F "1.03 0.01 0 1.02" -p "0.02 MPa" --accuracy inf --json --tangent
[ "$(wc -l <out.txt)" = 1 ] || fail "more than one line"
has out.txt '"source": *"database"' '"tangent": *\[' '"error_estimate": *[0-9]' '"indicators_trusted": *[tf]'
expect 0 -o 'error est. indicators' "$lamella" query db.h5 -F "1.03 0.01 0 0 1.02 0 0 0 1" -p "20 kPa" --accuracy inf

# out of reach: said so, not solved
expect 3 -o '"status": *"out_of_reach"' -o '"reason"' "$lamella" query db.h5 -F "1.5 0 0 1.5" -p "0.02 MPa" --json
expect 3 -o '"status": *"invalid_F"' "$lamella" query db.h5 -F "-1 0 0 1" --json

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
expect 3 -o '"status": *"out_of_reach"' "$lamella" query db.h5 -F "1.03 0.01 0 1.02" --accuracy 1e-12 --json

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
expect 0 -o "turgor where not given 0.02 MPa, the scene's" "$lamella" query db.h5 -F "1.03 0.01 0 1.02" --accuracy inf
expect 0 "$lamella" query db.h5 -F "1.03 0.01 0 1.02 ; 0.03 MPa" -p "0.01 MPa" --accuracy inf --json
grep -qE '"turgor": 0.0(3|29999)' out.txt || fail "-p before the question's own turgor: $(cat out.txt)"
printf '1.03 0.01 0 1.02\n1.02 zero 0 1.02\n' >lines
expect 2 -e 'line 2: "zero" is no number' "$lamella" query db.h5 -F - -p "0.02 MPa" --accuracy inf --json <lines

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
plain='law: mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa'
tissue wall="$plain" turgor='mode: none' mesh='along: 2, through: 1' >patch.yaml <<'YAML'
  patch: {columns: 2, rows: 2}
load:
  - {F: [[1, 0.01], [0, 1]]}
YAML
expect 0 "$lamella" rve patch.yaml -o patch.h5
expect 2 -e "patch.h5: holds states of a patch between grips" "$lamella" query patch.h5 -F "1 0.01 0 1"

# cells that differ answer from their own records, and not from mirrored ones
tissue wall="$plain" mesh='along: 2, through: 1' >uneven.yaml <<'YAML'
  cells: [2, 2]
  variation: {kinds: [{wall_thickness: 22.5 um}, {wall_thickness: 15 um}, {wall_thickness: 8 um}], list: [0, 1, 2, 3]}
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
expect 0 -o "$lumen" "$lamella" query turgor.h5 -F "1 0.1 0 1" -p "0.02 MPa" --json
expect 0 -o '"lumen_fraction": null' "$lamella" query turgor.h5 -F "1 0.105 0 1" -p "0.02 MPa" --json
