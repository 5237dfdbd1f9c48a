# Contact tissue on the command line: states, second mesh, onset of separation, files, pictures, answers, refusals.
. "$(dirname "$0")/common.sh"
serve=1

# scene COHESION LOAD...: writes scene.yaml
scene() {
  printf '  - %s\n' "${@:2}" | sed '1i load:' |
    tissue interface="law: contact, cohesion: $1" turgor='pressure: 0.002 MPa' >scene.yaml
}

# number NAME: the numbers of that name, one a line
number() { grep -oE "\"$1\": *[-0-9.e+]+" out.txt | sed 's/.*: *//'; }

# the states of the examples have answers, and members that tell how far the cells are apart
for name in shear-contact shear-dry; do
  expect 0 -o 'contact: cohesion .* strategy one_step' "$lamella" check "$source/tests/scenes/$name.yaml"
done
expect 0 "$lamella" rve "$source/tests/scenes/shear-contact.yaml" --json
states=$(wc -l <out.txt)
for name in opening_fraction opening_by_face debonded_fraction debonded_by_face open_fraction open_by_face \
  debonded_spread open_spread max_gap min_gap mean_gap max_penetration fabric max_traction mean_face_traction floating_cells \
  zero_modes cell_clusters percolating_directions indicators_trusted; do
  [ "$(grep -c "\"$name\":" out.txt)" -eq "$states" ] || fail "no member $name"
done
grep -qE '"separated"|"P_cohesion"' out.txt && fail "members that nobody asked for"
number max_gap | sed '$!d' | awk '!($1 > 1e-3) { exit 1 }' || fail "no gap without turgor: $(cat out.txt)"
unknowns=$(number unknowns | head -1)
expect 0 "$lamella" check "$source/tests/scenes/shear-contact.yaml" --json
[ "$(number unknowns)" = "$unknowns" ] || fail "check predicts $(number unknowns) unknowns, rve has $unknowns"
expect 0 -o '"P_cohesion": \[' "$lamella" rve "$source/tests/scenes/shear-contact.yaml" --json --tangent

# the law of contact: exact, or smooth with its width and error
number contact_width | awk '$1 != 0 { exit 1 }' || fail "not all states are exact: $(cat out.txt)"
sed 's/law: contact,/law: contact, sharpness: smooth,/' "$source/tests/scenes/shear-contact.yaml" >smooth.yaml
expect 0 "$lamella" rve smooth.yaml --json --tangent
number contact_width | awk '!($1 > 0) { exit 1 }' && number contact_error | awk '!($1 > 0 && $1 < 0.1) { exit 1 }' ||
  fail "the smooth law does not tell its width and error: $(cat out.txt)"
sed 's/law: contact,/law: contact, width: 0.5 um,/' "$source/tests/scenes/shear-contact.yaml" >width.yaml
expect 2 -e 'width.yaml:[0-9]*:.*width.*says nothing of the exact law' "$lamella" check width.yaml
sed 's/law: contact,/law: contact, sharpness: smooth, width: 0.5 um,/' "$source/tests/scenes/shear-contact.yaml" >width.yaml
expect 0 "$lamella" rve width.yaml --json
number contact_width | awk '($1 - 0.5 / 75)^2 > 1e-16 { exit 1 }' || fail "not the width that the scene asks for: $(cat out.txt)"
sed 's/law: contact, cohesion: 0.001 MPa/law: bonded, sharpness: smooth/' "$source/tests/scenes/shear-contact.yaml" >bonded.yaml
expect 2 -e 'bonded.yaml:[0-9]*:.*sharpness.*contradicts law: bonded' "$lamella" check bonded.yaml

# other starts: never a state of higher energy
sed 's/^load:/&\n  - {F: [[1.02, 0.3], [0, 0.95]], turgor: 0.002 MPa}/' "$source/tests/scenes/shear-contact.yaml" >global.yaml
expect 0 "$lamella" rve global.yaml --json --no-estimate
energy=$(number energy | head -1)
expect 0 "$lamella" rve global.yaml --json --no-estimate --global
number energy | head -1 | awk -v e="$energy" '!($1 <= e + 1e-12) { exit 1 }' || fail "a higher energy: $(cat out.txt)"
expect 1 -e 'global.*bonded' "$lamella" rve "$source/tests/scenes/shear-bonded.yaml" --global
expect 1 -e 'global.*second mesh' "$lamella" rve global.yaml --global --second-mesh

# the table has the columns of contact, that of bonded tissue has not
scene "0.001 MPa" "{F: [[1, 0], [0, 1]]}" "{ramp: {to: [[1, 0.04], [0, 1]], steps: 2}}"
expect 0 "$lamella" rve scene.yaml
has out.txt cohesion opening debonded largest floating
expect 0 "$lamella" rve "$source/tests/scenes/shear-bonded.yaml"
grep -q debonded out.txt && fail "bonded tissue has columns of contact"

# a second mesh gives errors, and tells the closed state from the open one
expect 0 "$lamella" rve scene.yaml --second-mesh --json -o spread.h5
[ "$(grep -c '"separated": false' out.txt)" -eq 1 ] && sed -n 1p out.txt | grep -q '"separated": false' ||
  fail "the first state alone is closed: $(cat out.txt)"
grep -qE '"(error_estimate|debonded_spread|open_spread)": null' out.txt && fail "the second mesh tells no error"
expect 0 -o 'second mesh: P differs by .* separated (gap)' "$lamella" rve scene.yaml --second-mesh

# the onset lies between the last closed and the first open state, bracketed to a thousandth
expect 0 "$lamella" rve scene.yaml --onset --json
[ "$(wc -l <out.txt)" -eq 4 ] || fail "the onset is not one object behind the states: $(cat out.txt)"
sed '$!d' out.txt | grep -q '"onset": {"status": "found", "states": \[1, 2\]' || fail "no onset: $(sed '$!d' out.txt)"
sed '$!d' out.txt | sed 's/.*"bracket": \[\([0-9.]*\), \([0-9.]*\)\].*/\1 \2/' |
  awk '!($1 > 0 && $2 < 1 && $2 - $1 > 0 && $2 - $1 <= 1e-3) { exit 1 }' || fail "bracket: $(sed '$!d' out.txt)"
expect 0 -o 'onset of separation: between states 1 and 2' "$lamella" rve scene.yaml --onset
# the state at the onset is as the onset says: 2e-3 of the way before it is closed, after it open
fraction=$("$lamella" rve scene.yaml --onset --json | sed -n 's/.*"fraction": \([0-9.]*\).*/\1/p')
for offset in -0.002 0.002; do
  shear=$(awk "BEGIN { print 0.02 * ($fraction + $offset) }")
  scene "0.001 MPa" "{F: [[1, 0], [0, 1]]}" "{F: [[1, $shear], [0, 1]]}"
  expect 0 "$lamella" rve scene.yaml --second-mesh --json
  sed -n 2p out.txt | grep -q "\"separated\": $([ $offset = 0.002 ] && echo true || echo false)" ||
    fail "the state at $offset of the way from the onset: $(sed -n 2p out.txt)"
done
scene "0.001 MPa" "{F: [[1, 0], [0, 1]]}" "{F: [[1, 1e-4], [0, 1]]}"
expect 0 -o 'not met' "$lamella" rve scene.yaml --onset

# what is not known is not called "not met": walls fill more than the area that is left, so the second state fails
scene "0.001 MPa" "{F: [[1, 0], [0, 1]]}" "{F: [[0.5, 0], [0, 0.5]]}" "{F: [[1, 1e-4], [0, 1]]}"
expect 3 "$lamella" rve scene.yaml --onset --json
sed '$!d' out.txt | grep -q '"onset": {"status": "unknown", "reason": "state 2 has no response on the first mesh: ' ||
  fail "an onset of which a state is missing: $(sed '$!d' out.txt)"
expect 3 -o 'onset of separation: unknown, .*state 2 has no response' "$lamella" rve scene.yaml --onset
sed -i '/0.5/d' scene.yaml
sed -i '$s/$/\n  - {ramp: {to: [[1, 2e-4], [0, 1]], steps: 5000}}/' scene.yaml
rm out.txt
"$lamella" rve scene.yaml --onset --json >out.txt 2>err.txt &
pid=$!
until [ -s out.txt ] || ! kill -0 $pid 2>/dev/null; do sleep 0.05; done
ends TERM 143 $pid
sed '$!d' out.txt | grep -qE '"status": "unknown", "reason": "stopped by a signal before state [0-9]+"' ||
  fail "an onset of a run that was stopped: $(sed '$!d' out.txt)"
# cells that float apart, one by one without contact
scene "0.001 MPa" "{F: [[1, 0], [0, 1]], turgor: 0 MPa}" "{F: [[1.05, 0], [0, 1.05]], turgor: 0 MPa}"
expect 0 "$lamella" rve scene.yaml --second-mesh --json -o apart.h5
sed -n 2p out.txt | grep -qE '"floating_cells": 1,.*"separated": true' || fail "no floating cell: $(sed -n 2p out.txt)"

# a patch of one column has no faces of family 0: the onset is not there
scene "0.002 MPa" "{F: [[1, 0], [0, 1]], turgor: 0.01 MPa}" "{F: [[1, 0], [0, 1.1]], turgor: 0.01 MPa}"
sed 's/^rve:/&\n  patch: {columns: 1, rows: 2}/' scene.yaml >column.yaml
expect 0 "$lamella" rve column.yaml --onset --json
sed '$!d' out.txt | grep -qE '"face": [12],.*"mean_face_traction": \[\[null' || fail "the onset's face: $(sed '$!d' out.txt)"

# bonded tissue has no second mesh and no onset: a mistake of usage
for option in --second-mesh --onset; do
  expect 1 -e "$option.*bonded" "$lamella" rve "$source/tests/scenes/shear-bonded.yaml" $option -o none.h5
  [ -e none.h5 ] && fail "a mistake of usage writes a file"
done

# the file: samples along the faces of each state
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
  /usr/bin/python3 - <<'PYTHON' || fail "the file is not what docs/reference/files.md says"
import h5py, numpy as np
with h5py.File("apart.h5") as f:
    records = f["records"][: f.attrs.get("committed", f["records"].attrs["committed"])]
    for k in (1, 2):
        group = f[f"fields/{k}/interface"]
        start, end, gap, pressure = (group[name][()] for name in ("from", "to", "gap", "pressure"))
        assert start.shape == end.shape == gap.shape + (2,) == pressure.shape + (2,) and gap.shape == (3, 17)
        assert group["gap"].attrs["unit"] in ("apothem", b"apothem") and group["pressure"].attrs["unit"] in ("MPa", b"MPa")
        facing = np.isfinite(gap)
        assert facing.any() and (pressure >= 0).all()
        assert np.allclose(np.linalg.norm(end - start, axis=2)[facing], np.abs(gap[facing]), atol=1e-9)
    assert (f["mesh/interface_faces"][()] == [[0, 0, 0], [0, 1, 0], [0, 2, 0]]).all()
    assert (pressure == 0).all() and gap[facing].min() > 1e-3
    assert abs(gap[facing].max() / records["max_gap"][1] - 1) < 0.1
PYTHON
fi

# a picture
expect 0 "$lamella" plot --dpi 40 apart.h5 --state 2 -o state2.png
head -c 8 state2.png | grep -qa PNG || fail "no picture of state 2"

# answers from records of contact tissue: near their turgor and cohesion, gaps only in a record's own state
expect 0 "$lamella" query spread.h5 -F "1 0.0201 0 1" -p "0.002 MPa" --json
grep -qE '"cohesion": 0.001[,0].*"opening_fraction": -?[0-9].*"max_gap": null' out.txt || fail "answer: $(cat out.txt)"
expect 0 "$lamella" query spread.h5 -F "1 0.02 0 1" -p "0.002 MPa" -g "1 kPa" --json
grep -qE '"max_gap": [0-9]' out.txt || fail "a record does not answer for itself: $(cat out.txt)"
expect 3 -o 'nearest record' "$lamella" query spread.h5 -F "1 0.02 0 1" -p "0.002 MPa" -g "0.02 MPa"
printf '1 0.0201 0 1 ; 0.002 MPa ; 0.001 MPa\n1 0.0201 0 1 ; 0.002 MPa ; 0.02 MPa\n' >lines
"$lamella" query spread.h5 -F - --json <lines >out.txt
[ $? -eq 3 ] && [ "$(grep -c '"converged"' out.txt)" -eq 1 ] || fail "cohesions of lines: $(cat out.txt)"
expect 1 "$lamella" query spread.h5 -F "1 0.02 0 1" -g 0.001

# a body that inflates needs cohesion: refused by check and fe2 alike
scene "0 MPa" "{F: [[1, 0], [0, 1]]}"
cat >>scene.yaml <<'YAML'
macro:
  mesh: {box: [10 mm, 10 mm], elements: [1, 1]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, 0 mm]}]
  inflate: true
  steps: 1
YAML
for command in check fe2; do
  expect 2 "$lamella" $command scene.yaml
  grep -q 'scene.yaml:13:12: macro.inflate: true: .*give interface.cohesion > 0, or inflate: false' err.txt ||
    fail "$command: $(cat err.txt)"
done
# with it, it comes apart but carries on; a cache answers likewise, gaps included
sed -i 's/cohesion: 0 MPa/cohesion: 0.005 MPa/' scene.yaml
expect 0 "$lamella" fe2 scene.yaml --json --quiet
grep -qE '"debonded_fraction": 0\.[0-9]+, "max_gap": 0\.[0-9]+' out.txt || fail "fe2 tells no debonding: $(cat out.txt)"
expect 0 "$lamella" fe2 scene.yaml -d cache.h5 --json --quiet
grep -qE '"debonded_fraction": 0\.[0-9]+, "max_gap": 0\.[0-9]+' out.txt || fail "a cache knows no gaps: $(cat out.txt)"
