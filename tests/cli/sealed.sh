# lamella rve with sealed cells: each keeps its water, and its pressure follows.
. "$(dirname "$0")/common.sh"

# the example: the lumens follow the pressures, from F = I with that of the scene
expect 0 "$lamella" rve "$source/tests/scenes/shear-sealed.yaml" --json -o out.h5
if /usr/bin/python3 -c 'import json' 2>/dev/null; then
  cp out.txt sealed.txt
  sed -e 's/mode: sealed/mode: prescribed/' -e 's/, water_bulk_modulus: 2.2 GPa//' -e '/^load:/,$d' \
    "$source/tests/scenes/shear-sealed.yaml" >open.yaml
  printf 'load:\n  - {F: [[1, 0], [0, 1]]}\n' >>open.yaml
  expect 0 "$lamella" rve open.yaml --json
  /usr/bin/python3 - <<'PYTHON' || fail "the cells do not keep their water: $(cat sealed.txt out.txt)"
import json
start = json.load(open("out.txt"))
assert start["turgor_mean"] == start["turgor"] == 0.02 and start["turgor_spread"] == 0
for line in open("sealed.txt"):
    s = json.loads(line)
    assert s["status"] == "converged" and s["stable"] and s["negative_eigenvalues"] == 0
    volume = s["lumen_fraction"] / start["lumen_fraction"]
    assert abs(volume - (1 - (s["turgor_mean"] - 0.02) / 2200)) < 1e-8, volume  # the cells' lumens are nearly alike
    assert s["turgor"] == 0.02 and s["turgor_mean"] != 0.02 and s["turgor_spread"] > 0
PYTHON
fi
expect 0 "$lamella" rve "$source/tests/scenes/shear-sealed.yaml"
grep -qE '^ +pressure in the lumens 0.03[0-9]* MPa, spread ' out.txt || fail "no pressure in the table: $(cat out.txt)"

# states of sealed cells are no table of (F, turgor)
expect 2 -e 'sealed cells' "$lamella" query out.h5 -F "1 0.1 0 1"

# check counts the pressures and says when the cells are sealed
expect 0 -o '"sealed": true' "$lamella" check "$source/tests/scenes/shear-sealed.yaml" --json
unknowns=$(grep -oE '"unknowns": [0-9]+' out.txt)
expect 0 -o "$unknowns" "$lamella" rve "$source/tests/scenes/shear-sealed.yaml" --json

# cells that cannot be sealed have no answer
sed -e 's/pressure: 0.02 MPa/pressure: -40 MPa/' -e 's/along: 6, through: 2/along: 2, through: 1/' \
  "$source/tests/scenes/shear-sealed.yaml" >refused.yaml
expect 3 -o 'no stable state at F = I in which the cells are sealed' "$lamella" rve refused.yaml --json

# a map: the tissue of each path is sealed under its own turgor
tissue turgor='mode: sealed, pressure: 0.02 MPa' >map.yaml <<'YAML'
strength: {wall: 0.3 MPa}
load:
  - {F: [[1, 0.6], [0, 1]]}
map:
  x: {quantity: turgor, from: 0.01 MPa, to: 0.1 MPa, points: 2}
  y: {quantity: shear, from: 0.3, to: 0.6, points: 2}
YAML
expect 0 "$lamella" map map.yaml -o map.h5
