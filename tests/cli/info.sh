#!/usr/bin/env bash
# lamella info: describes what lamella wrote, refuses what it did not write.
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
load:
  - {F: [[1, 0.1], [0, 1]]}
sample:
  stretch: {min: 0, max: 0.05}
  turgor: {min: 0.01 MPa, max: 0.03 MPa}
  count: 3
YAML
"$lamella" build s.yaml -d db.h5 --quiet >/dev/null
"$lamella" rve s.yaml -o rve.h5 >/dev/null 2>&1

expect 0 "$lamella" info db.h5 --json
[ "$(wc -l <out.txt)" = 1 ] || fail "more than one line"
for part in '"kind": *"database"' '"records": *3' '"failed": *0' '"format_version": *1' '"microstructures": *\[{"hash"' \
  '"wall_thickness": *0.1[45]' '"PETSc"' '"HDF5"'; do
  grep -q "$part" out.txt || fail "$part is missing: $(cat out.txt)"
done
expect 0 "$lamella" info db.h5
grep -q 'records *3' out.txt || fail "table: $(cat out.txt)"
grep -q 'nodes *3' out.txt && grep -q 'grid of strains *step' out.txt || fail "the nodes of the grid: $(cat out.txt)"
expect 0 "$lamella" info db.h5 --json
grep -q '"scattered": 0, "table": {"nodes": 3, ' out.txt || fail "the nodes of the grid: $(cat out.txt)"
expect 0 "$lamella" info rve.h5 --json
grep -q '"kind": *"rve"' out.txt || fail "kind: $(cat out.txt)"
if grep -q '"table"' out.txt; then fail "a file of states has a table"; fi

# how far a macroscale run has come: the inflation and two steps
cat >macro.yaml <<'YAML'
macro:
  mesh: {box: [10 mm, 10 mm], elements: [1, 1]}
  boundary:
    - {on: bottom, displacement: [0 mm, 0 mm]}
    - {on: top, displacement: [1 mm, 0 mm]}
  steps: 2
YAML
cat s.yaml macro.yaml >fe2.yaml
"$lamella" fe2 fe2.yaml -d db.h5 -o fe2.h5 --quiet >/dev/null
expect 0 "$lamella" info fe2.h5 --json
grep -qE '"run": \{"steps": 3, "load_factor": 1\.0, "status": "done"\}' out.txt || fail "run: $(cat out.txt)"
expect 0 "$lamella" info fe2.h5
grep -qE '^steps +3$' out.txt && grep -qE '^load factor +1$' out.txt && grep -qE '^status +done$' out.txt || fail "table: $(cat out.txt)"
expect 0 "$lamella" info rve.h5 --json
if grep -q '"run"' out.txt; then fail "a file of states has a run"; fi

# cut short, of another program, not there
head -c 3000 db.h5 >cut.h5
expect 2 "$lamella" info cut.h5
grep -q 'cut.h5' err.txt || fail "the file is not named: $(cat err.txt)"
expect 2 "$lamella" info s.yaml
expect 4 "$lamella" info missing.h5
expect 1 "$lamella" info
