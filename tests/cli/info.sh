#!/usr/bin/env bash
# lamella info: describes what lamella wrote, refuses what it did not write.
set -euo pipefail
lamella=$1
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"

fail() { echo "FAILED: $*" >&2; exit 1; }
expect() {
  local wanted=$1 status=0
  shift
  "$@" >out 2>err || status=$?
  [ "$status" = "$wanted" ] || { cat out err >&2; fail "status $status, wanted $wanted: $*"; }
}

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
[ "$(wc -l <out)" = 1 ] || fail "more than one line"
for part in '"kind": *"database"' '"records": *3' '"failed": *0' '"format_version": *1' '"microstructures": *\[{"hash"' \
  '"wall_thickness": *0.1[45]' '"PETSc"' '"HDF5"'; do
  grep -q "$part" out || fail "$part is missing: $(cat out)"
done
expect 0 "$lamella" info db.h5
grep -q 'records *3' out || fail "table: $(cat out)"
expect 0 "$lamella" info rve.h5 --json
grep -q '"kind": *"rve"' out || fail "kind: $(cat out)"

# cut short, of another program, not there
head -c 3000 db.h5 >cut.h5
expect 2 "$lamella" info cut.h5
grep -q 'cut.h5' err || fail "the file is not named: $(cat err)"
expect 2 "$lamella" info s.yaml
expect 4 "$lamella" info missing.h5
expect 1 "$lamella" info
