#!/usr/bin/env bash
# lamella build: accuracies, counts, refusal of an existing file, resumption, signals.
. "$(dirname "$0")/common.sh"
set -e -o pipefail
# member FILE NAME: a number from `info --json`
member() { "$lamella" info "$1" --json | sed "s/.*\"$2\":\s*\([0-9]*\).*/\1/"; }
# told NAME: a number of the last object that a command printed
told() { tail -n 1 out.txt | sed "s/.*\"$1\": *\([0-9.e+-]*\).*/\1/"; }
# holds COMPARISON: of numbers
holds() { awk "BEGIN { exit !($1) }"; }
scene() { # scene "count: 12" or "accuracy: 0.01"
  tissue mesh="along: ${along:-4}, through: 1" <<YAML
sample: {stretch: {min: 0, max: 0.1}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, $1}
YAML
}
scene 'count: 12' >s.yaml
scene 'count: 30' >more.yaml
along=160 # slow ones
scene 'count: 20000' >many.yaml
along=4

# a file with as many records as asked for
expect 0 "$lamella" build s.yaml -d a.h5 --quiet
[ "$(member a.h5 records)" = 12 ] || fail "not 12 records"
[ ! -e a.h5.lock ] && [ ! -e a.h5.tmp ] || fail "lock or temporary file left behind"

# what is there is not overwritten
expect 2 "$lamella" build s.yaml -d a.h5 --quiet
grep -q -- --resume err.txt || fail "the message does not tell of --resume: $(cat err.txt)"

# --resume goes on, and gives the same records as one run; with nothing to resume it begins
expect 0 "$lamella" build more.yaml -d a.h5 --resume --quiet
[ "$(member a.h5 records)" = 30 ] || fail "not 30 records"
expect 0 "$lamella" build more.yaml -d b.h5 --resume --json
[ "$(told records)" = 30 ] && [ "$(told failed)" = 0 ] || fail "progress: $(tail -n 1 out.txt)"
same a.h5 b.h5 || fail "a resumed build differs from one in one go"
expect 0 "$lamella" build more.yaml -d b.h5 --resume --json
[ "$(grep -c . out.txt)" = 1 ] && [ "$(told records)" = 30 ] || fail "it was complete: $(cat out.txt)"

# a wider box goes on with the same grid
sed 's/max: 0.1}/max: 0.15}/; s/count: 30/count: 60/' more.yaml >wide.yaml
expect 0 "$lamella" build wide.yaml -d a.h5 --resume --json
[ "$(told records)" = 60 ] && [ "$(told answered)" = 1.0 ] || fail "wider box: $(tail -n 1 out.txt)"
# another tissue is not mixed in
sed 's/C4: 1 MPa/C4: 2 MPa/' more.yaml >stiff.yaml
expect 2 "$lamella" build stiff.yaml -d a.h5 --resume --quiet

# until an accuracy is reached: the default box of strains and turgor, on the planner's mesh; on the fine mesh of 0.1 %
# compressed walls kink in a corner of the box
for accuracy in 0.01 0.001; do
  scene "accuracy: $accuracy" |
    sed '/mesh:/d; s/{min: 0, max: 0.1}/{min: -0.02, max: 0.25}/; s/min: 0.01 MPa, max: 0.03/min: 0 MPa, max: 0.05/' >d.yaml
  expect 0 "$lamella" build d.yaml -d $accuracy.h5 --json
  holds "$(told answered) >= $([ $accuracy = 0.01 ] && echo 0.99 || echo 0.97) && $(told error_95) <= $accuracy" || fail "$accuracy: $(tail -n 1 out.txt)"
  [ "$(told records)" -le "$([ $accuracy = 0.01 ] && echo 30 || echo 120)" ] || fail "$accuracy: $(told records) solves"
  [ "$(member $accuracy.h5 records)" = "$(told records)" ] || fail "records of the file"
done

# what fe2 adds to the database stays, and the build goes on all the same
cat >macro.part <<'YAML'
macro:
  mesh: {box: [10 mm, 10 mm], elements: [1, 1]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [2 mm, 0 mm]}]
  steps: 1
YAML
scene 'count: 5' | cat - macro.part >five.yaml
expect 0 "$lamella" build five.yaml -d e.h5 --quiet
expect 0 "$lamella" fe2 five.yaml -d e.h5 --quiet
before=$(member e.h5 records)
[ "$before" -gt 5 ] || fail "fe2 added no records"
scene 'count: 9' >nine.yaml
expect 0 "$lamella" build nine.yaml -d e.h5 --resume --json
[ "$(told records)" = 9 ] || fail "nodes of the build: $(tail -n 1 out.txt)"
[ "$(member e.h5 records)" -ge "$before" ] && [ "$(member e.h5 records)" -le $((before + 4)) ] ||
  fail "$before records of fe2 and a build of 5, then $(member e.h5 records)"
expect 0 "$lamella" fe2 five.yaml -d e.h5 --quiet
expect 0 "$lamella" build nine.yaml -d e.h5 --resume --quiet

# stopped by a signal: what is solved is there, and the build goes on
"$lamella" build many.yaml -d c.h5 --json >c.out 2>/dev/null &
pid=$!
for _ in $(seq 200); do [ -s c.out ] && break || sleep 0.05; done
ends TERM 143 $pid
kept=$(member c.h5 records)
[ "$kept" -gt 0 ] || fail "nothing was kept"
along=160
scene "count: $((kept + 5))" >few.yaml
expect 0 "$lamella" build few.yaml -d c.h5 --resume --json
[ "$(told records)" = $((kept + 5)) ] || fail "not resumed behind what was kept: $(tail -n 1 out.txt)"

# killed without warning, within a round: the same, and in the end the records are those of an undisturbed build
"$lamella" build many.yaml -d d.h5 --json >d.out 2>/dev/null &
pid=$!
for _ in $(seq 200); do [ "$(grep -c . d.out)" -ge 3 ] && break || sleep 0.05; done
kill -KILL $pid
wait $pid 2>/dev/null || true
acknowledged=$(tail -n 1 d.out | sed 's/.*"records": *\([0-9]*\).*/\1/')
kept=$(member d.h5 records)
[ "$kept" -ge "$acknowledged" ] || fail "$acknowledged records acknowledged, $kept kept"
scene "count: $((kept + 20))" >few.yaml
expect 0 "$lamella" build few.yaml -d d.h5 --resume --quiet
expect 0 "$lamella" build few.yaml -d undisturbed.h5 --quiet
same undisturbed.h5 d.h5 known || fail "a build that was killed differs from an undisturbed one"
along=4

# contact: an axis of suction, and cells that touch no one
scene 'accuracy: 0.1' |
  sed 's/law: bonded/law: contact, cohesion: 0.005 MPa/; s/min: 0, max: 0.1}/min: -0.02, max: 0.08}/; s/min: 0.01/min: 0.005/' >k.yaml
expect 0 "$lamella" build k.yaml -d k.h5 --json
holds "$(told answered) >= 0.9" || fail "contact: $(tail -n 1 out.txt)"
expect 0 "$lamella" build k.yaml -d k.h5 --resume --json
[ "$(grep -c . out.txt)" = 1 ] || fail "contact: it was complete: $(cat out.txt)"
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
  # nodes that start from others are the same whether build or fe2 solves them
  sed 's/\[2 mm, 0 mm\]/[0.4 mm, 0 mm]/' macro.part | cat k.yaml - >kmacro.yaml
  expect 0 "$lamella" fe2 kmacro.yaml -d kf.h5 --quiet
  /usr/bin/python3 - <<'PYTHON' || fail "fe2 and build differ in their nodes"
import h5py

def records(path):
    with h5py.File(path) as f:
        return {r["key"]: r for r in f["records"][: f["records"].attrs["committed"]] if r["key"] < 1 << 61}

build, fe2 = records("k.h5"), records("kf.h5")
common = build.keys() & fe2.keys()
assert len(common) > 20, f"{len(common)} nodes in both files"
for key in common:
    for name in set(build[key].dtype.names) - {"seconds", "checksum"}:
        assert build[key][name].tobytes() == fe2[key][name].tobytes(), (key, name)
PYTHON
fi

# a file of records without a grid is not gone on with
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
  /usr/bin/python3 -c 'import h5py; del h5py.File("b.h5", "r+")["table/grid"]'
  expect 2 -e grid "$lamella" build more.yaml -d b.h5 --resume --quiet
fi

# usage
expect 1 "$lamella" build s.yaml
expect 4 "$lamella" build s.yaml -d no/such/folder/a.h5

# of a table that answers nothing yet there is no error to report
tissue mesh='along: 2, through: 1' >few.yaml <<'YAML'
sample: {stretch: {min: -0.1, max: 0.3}, turgor: {min: 0 MPa, max: 0.02 MPa}, count: 6}
YAML
expect 0 -o 'answered *0.0 %' "$lamella" build few.yaml -d few.h5 --quiet
! grep -q 'inf' out.txt || fail "an infinite error: $(cat out.txt)"
