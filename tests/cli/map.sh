#!/usr/bin/env bash
# lamella map: modes, JSON, refusals, signals, resumption, pictures.
. "$(dirname "$0")/common.sh"
set -e -o pipefail
member() { "$lamella" info "$1" --json | sed "s/.*\"$2\":\s*\([0-9]*\).*/\1/"; }

# scene LOAD X Y [STRENGTH]: bonded tissue
scene() {
  tissue turgor='pressure: 0 MPa' <<YAML
strength: ${4:-"{wall: 0.25 MPa, lamella_normal: 0.03 MPa, lamella_shear: 0.05 MPa}"}
load:
  - {ramp: {$1, steps: 4}}
map:
  x: {$2}
  y: {$3}
YAML
}
strain="to: [[1, 0.4], [0, 1]]" stress="to: [[free, 0.4], [0, free]], P: [[0 MPa, x], [x, 0 MPa]]"
shear="quantity: shear, from: 0, to: 0.4, points: 5" turgor="quantity: turgor, from: 0 MPa, to: 0.1 MPa, points: 3"
scene "$strain" "$shear" "$turgor" >s.yaml

# prescribed strain: without turgor the cells separate, with turgor the walls tear, later
expect 0 "$lamella" map s.yaml -o a.h5 --quiet
grep -qE '^ +0.1 +\. \. \. \. R$' out.txt || fail "row of high turgor: $(cat out.txt)"
grep -qE '^ +0 +\. \. S S S$' out.txt || fail "row without turgor: $(cat out.txt)"
expect 0 "$lamella" map s.yaml -o a.h5 --json
[ "$(wc -l <out.txt)" = 15 ] || fail "not one object per point"
grep -q '"point": 14, "x": 0.4.*"failure": {"mode": "rupture", "criterion": "wall", "load_factor": 0.8' out.txt ||
  fail "the last point: $(tail -n 1 out.txt)"

# the axes exchanged: the same points
scene "$strain" "$turgor" "$shear" >t.yaml
expect 0 "$lamella" map t.yaml -o t.h5 --quiet
for mode in separation rupture none; do
  [ "$(member a.h5 $mode)" = "$(member t.h5 $mode)" ] || fail "other axes, another number of points with $mode"
done

# prescribed stress: turgor alone breaks free tissue
scene "$stress" "$shear" "$turgor" >p.yaml
expect 0 "$lamella" map p.yaml -o p.h5 --quiet
grep -qE '^ +0.1 +S S S S S$' out.txt || fail "free tissue under turgor: $(cat out.txt)"

# neither axis of the load: strengths decide, and other walls have an RVE of their own
scene "$strain" "quantity: wall_thickness, from: 8 um, to: 12 um, points: 2" \
  "quantity: wall_strength, from: 0.05 MPa, to: 5 MPa, points: 2, spacing: log" "{lamella_normal: 0.06 MPa}" >w.yaml
expect 0 "$lamella" map w.yaml -o w.h5 --json
[ "$(grep -c '"mode": "rupture"' out.txt)" = 2 ] && [ "$(grep -c '"mode": "separation"' out.txt)" = 2 ] ||
  fail "strengths: $(grep -o '"failure.*' out.txt)"
[ "$(grep -o '"load_factor": [0-9.]*' out.txt | sort -u | wc -l)" = 4 ] || fail "walls of other thickness fail alike"

# a tissue that has no answer: status 3, the points are told with the reason
scene "$stress" "$shear" "quantity: turgor, from: 0 MPa, to: 2 MPa, points: 2" "{}" |
  sed 's/fibre_mooney_rivlin/mooney_rivlin/; s/, C4: 1 MPa//' >u.yaml
expect 3 -o '"failure": {"mode": "unknown", "reason": "' "$lamella" map u.yaml -o u.h5 --json

# what must be given, and what is not overwritten
expect 1 "$lamella" map s.yaml
sed '/^map/,$d' s.yaml >no.yaml
expect 2 -e 'no block `map`' "$lamella" map no.yaml -o no.h5
expect 1 "$lamella" map s.yaml -o s.yaml
expect 2 -e 'another scene' "$lamella" map t.yaml -o a.h5 --resume
expect 2 "$lamella" query a.h5 -F "1 0 0 1"

# --resume of a complete map solves nothing; the plan counts points
expect 0 "$lamella" map s.yaml -o a.h5 --resume --json
[ ! -s out.txt ] || fail "solved again: $(head -c 200 out.txt)"
"$lamella" check s.yaml --json | grep -q '"map": {"states": 27, "seconds": [0-9.e-]*, "share": [0-9.]*, "points": 15}' ||
  fail "the plan: $("$lamella" check s.yaml --json)"

# stopped by a signal, and killed: what is committed stays, and --resume gives the same map
scene "$strain" "quantity: load_factor, from: 0, to: 1, points: 21" "${turgor/3/40}" >many.yaml
expect 0 "$lamella" map many.yaml -o whole.h5 --quiet
for signal in TERM KILL; do
  "$lamella" map many.yaml -o $signal.h5 --json >$signal.out 2>/dev/null &
  pid=$!
  for _ in $(seq 400); do [ -s $signal.out ] && break || sleep 0.02; done
  kill -$signal $pid
  status=0
  wait $pid 2>/dev/null || status=$?
  [ $signal = KILL ] || [ $status = 143 ] || fail "status $status after SIGTERM"
  [ "$(member $signal.h5 records)" -ge 21 ] || fail "nothing was kept after $signal"
  expect 0 "$lamella" map many.yaml -o $signal.h5 --resume --quiet
  [ "$(member $signal.h5 records)" = 840 ] || fail "not complete after $signal"
  "$lamella" plot --dpi 40 $signal.h5 -o $signal.svg >/dev/null
done
"$lamella" plot --dpi 40 whole.h5 -o whole.svg >/dev/null
for signal in TERM KILL; do cmp -s whole.svg $signal.svg || fail "the map resumed after $signal looks different"; done

# pictures of other fields
expect 0 "$lamella" plot --dpi 40 a.h5 --field max_wall_tension -o a.png
expect 2 -e load_factor "$lamella" plot --dpi 40 a.h5 --field colour
expect 2 "$lamella" plot --dpi 40 a.h5 --state 1

# a unit that is no UTF-8, with a checksum that is right
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
  cp a.h5 foreign.h5
  /usr/bin/python3 - <<'PY'
import h5py, numpy, zlib
with h5py.File("foreign.h5", "r+") as f:
    unit = f["map/x/unit"]
    text = numpy.full((), b"\xff" * unit.dtype.itemsize, dtype=f"S{unit.dtype.itemsize}")
    unit.id.write(h5py.h5s.ALL, h5py.h5s.ALL, text, mtype=unit.id.get_type())
    unit.attrs.modify("checksum", numpy.uint32(zlib.crc32(text.tobytes())))
PY
  expect 0 -o '^x .* ?' "$lamella" info foreign.h5
  expect 0 "$lamella" info foreign.h5 --json
fi
