#!/usr/bin/env bash
# lamella build: counts, refusal of an existing file, resumption, signals.
. "$(dirname "$0")/common.sh"
set -e -o pipefail
# member FILE NAME: a number from `info --json`
member() { "$lamella" info "$1" --json | sed "s/.*\"$2\":\s*\([0-9]*\).*/\1/"; }

scene() { # scene COUNT
  cat <<YAML
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
  count: $1
YAML
}
scene 12 >s.yaml
scene 30 >more.yaml
scene 20000 >many.yaml

# a file with as many records as asked for
expect 0 "$lamella" build s.yaml -d a.h5 --quiet
[ "$(member a.h5 records)" = 12 ] || fail "not 12 records"
[ ! -e a.h5.lock ] && [ ! -e a.h5.tmp ] || fail "lock or temporary file left behind"

# what is there is not overwritten
expect 2 "$lamella" build s.yaml -d a.h5 --quiet
grep -q -- --resume err.txt || fail "the message does not tell of --resume: $(cat err.txt)"

# --resume goes on, and gives the same file as one run
expect 0 "$lamella" build more.yaml -d a.h5 --resume --quiet
[ "$(member a.h5 records)" = 30 ] || fail "not 30 records"
expect 0 "$lamella" build more.yaml -d b.h5 --resume --json
[ "$(tail -n 1 out.txt | grep -c '"records": *30, *"failed": *0')" = 1 ] || fail "progress: $(tail -n 1 out.txt)"
for file in a b; do
  printf '1 0.02 0 1\n1.04 0.01 0.02 1.07 ; 0.015 MPa\n' |
    "$lamella" query $file.h5 -F - --radius 1 --json --tangent | sed 's/"seconds": *[^,}]*//' >$file.json
done
cmp -s a.json b.json || fail "a resumed build differs from one in one go"

# another sample box is not mixed in
sed 's/max: 0.1}/max: 0.2}/' more.yaml >other.yaml
expect 2 "$lamella" build other.yaml -d a.h5 --resume --quiet
# nor another tissue
sed 's/C4: 1 MPa/C4: 2 MPa/' more.yaml >stiff.yaml
expect 2 "$lamella" build stiff.yaml -d a.h5 --resume --quiet

# what fe2 adds to the database is none of the sample's states: the build goes on all the same
cat >macro.part <<'YAML'
macro:
  mesh: {box: [10 mm, 10 mm], elements: [1, 1]}
  boundary:
    - {on: bottom, displacement: [0 mm, 0 mm]}
    - {on: top, displacement: [2 mm, 0 mm]}
  steps: 1
YAML
scene 5 | cat - macro.part >five.yaml
expect 0 "$lamella" build five.yaml -d e.h5 --quiet
expect 0 "$lamella" fe2 five.yaml -d e.h5 --quiet
added=$(($(member e.h5 records) - 5))
[ "$added" -gt 0 ] || fail "fe2 added no records"
scene 9 >nine.yaml
expect 0 "$lamella" build nine.yaml -d e.h5 --resume --json
[ "$(tail -n 1 out.txt | grep -c '"records": *9,')" = 1 ] || fail "sample states: $(tail -n 1 out.txt)"
[ "$(member e.h5 records)" = $((9 + added)) ] || fail "not 9 sample states and $added of fe2"
expect 0 "$lamella" fe2 five.yaml -d e.h5 --quiet
expect 0 "$lamella" build nine.yaml -d e.h5 --resume --quiet

# stopped by a signal: what is solved is there, and the build goes on
"$lamella" build many.yaml -d c.h5 --json >c.out 2>/dev/null &
pid=$!
for _ in $(seq 200); do [ -s c.out ] && break || sleep 0.05; done
kill -TERM $pid
status=0
wait $pid || status=$?
[ "$status" = 143 ] || fail "status $status after SIGTERM"
kept=$(member c.h5 records)
[ "$kept" -gt 0 ] || fail "nothing was kept"
scene $((kept + 5)) >few.yaml
expect 0 "$lamella" build few.yaml -d c.h5 --resume --quiet
[ "$(member c.h5 records)" = $((kept + 5)) ] || fail "not resumed behind what was kept"

# killed without warning: the same
"$lamella" build many.yaml -d d.h5 --json >d.out 2>/dev/null &
pid=$!
for _ in $(seq 200); do [ -s d.out ] && break || sleep 0.05; done
kill -KILL $pid
wait $pid 2>/dev/null || true
told=$(tail -n 1 d.out | sed 's/.*"records": *\([0-9]*\).*/\1/')
kept=$(member d.h5 records)
[ "$kept" -ge "$told" ] || fail "$told records acknowledged, $kept kept"
scene $((kept + 1)) >few.yaml
expect 0 "$lamella" build few.yaml -d d.h5 --resume --quiet

# usage
expect 1 "$lamella" build s.yaml
expect 4 "$lamella" build s.yaml -d no/such/folder/a.h5
