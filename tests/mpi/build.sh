#!/usr/bin/env bash
# lamella build under mpirun: the file does not depend on the number of ranks.
set -euo pipefail
lamella=$1
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"

fail() { echo "FAILED: $*" >&2; exit 1; }

cat >s.yaml <<'YAML'
version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: 11.25 um}
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  interface: {law: bonded}
  turgor: {mode: prescribed, pressure: 0.02 MPa}
  mesh: {along: 4, through: 1}
sample:
  stretch: {min: 0, max: 0.1}
  turgor: {min: 0.01 MPa, max: 0.03 MPa}
  count: 40
YAML
"$lamella" build s.yaml -d 1.h5 --quiet >1.out
mpirun -n 3 "$lamella" build s.yaml -d 3.h5 --json >3.out
tail -n 1 3.out | grep -q '"records": *40, *"failed": *0' || fail "progress: $(tail -n 1 3.out)"

# each record answers for itself, so answers near many of them compare the files number by number
for i in $(seq 0 9); do echo "1.0$i 0.0$i 0 1.05 ; 0.02 MPa"; done >lines
for n in 1 3; do
  "$lamella" query $n.h5 -F - --radius 1 --json --tangent <lines | sed 's/"seconds": *[^,}]*//' >$n.json
done
cmp -s 1.json 3.json || fail "three ranks give another file than one"

# an error of the rank that keeps the file ends all of them
status=0
timeout 60 mpirun -n 2 "$lamella" build s.yaml -d 1.h5 --quiet >/dev/null 2>err || status=$?
[ "$status" = 2 ] || fail "status $status for an existing file"
