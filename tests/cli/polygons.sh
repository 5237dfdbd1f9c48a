# slow: Hexagons written as polygons, in cells that begin at any corner: their responses are those of rve.cells to 1e-10, by
# each law; and what a tissue file must not say.
. "$(dirname "$0")/common.sh"

package

cat >hexagons.py <<'PYTHON'
"""Writes 2 x 2 hexagons of apothem 75 um, turned by the angle in degrees, as polygons of um; or a patch of 2 x 3."""
import json, math, sys

turn, patch = math.radians(float(sys.argv[1])), sys.argv[2:] == ["patch"]
L = [(150 * math.cos(turn + k * math.pi / 3), 150 * math.sin(turn + k * math.pi / 3)) for k in range(2)]
vertices, cells, known = [], [], {}
for i in range(2):
    for j in range(3 if patch else 2):
        cell = []
        for k in range(6):
            angle, radius = turn + math.radians(60 * k - 30), 150 / math.sqrt(3)
            # the rows of a patch shift by turns
            along = i - j // 2 if patch else i
            x = along * L[0][0] + j * L[1][0] + radius * math.cos(angle)
            y = along * L[0][1] + j * L[1][1] + radius * math.sin(angle)
            key = round(x, 6), round(y, 6)
            if key not in known:
                known[key] = len(vertices)
                vertices.append([x, y])
            cell.append(known[key])
        start = (i + 2 * j) % 6
        cells.append(cell[start:] + cell[:start])
file = {"lamella_tissue": 1, "unit": "um", "wall_thickness": 11.25, "vertices": vertices, "cells": cells}
json.dump(file if patch else {**file, "period": [[2 * c for c in v] for v in L]}, sys.stdout)
PYTHON
cat >compare.py <<'PYTHON'
import json, sys

def numbers(value, path=""):
    if isinstance(value, dict):
        for key in value:
            yield from numbers(value[key], f"{path}/{key}")
    elif isinstance(value, list):
        for k, item in enumerate(value):
            yield from numbers(item, f"{path}[{k}]")
    elif isinstance(value, (int, float)):
        yield path, value

# time; of equal cells; faces are counted from another corner; of saddles and the work on the way
own = ("seconds", "cell_difference", "_place", "lowest_eigenvalue", "iterations", "factorisations")
known = 0
for one, other in zip(*(map(json.loads, open(name)) for name in sys.argv[1:3])):
    a, b = (dict(p for p in numbers(x) if not any(word in p[0] for word in own)) for x in (one, other))
    assert a.keys() == b.keys(), a.keys() ^ b.keys()
    for key in a:
        assert abs(a[key] - b[key]) <= 1e-10 * max(1.0, abs(a[key])), (key, a[key], b[key])
    known += len(a)
assert known > 100, known
PYTHON

# scene NAME ORIENTATION CELLS INTERFACE [TURGOR [KEYS [BLOCKS]]]: keys of rve, blocks beside it
scene() {
  local load='load: [{F: [[1.02, 0.1], [0, 1]]}, {F: [[1.02, 0.2], [0.01, 1]]}]'
  cat >"$1.yaml" <<YAML
version: 1
rve:
  $3
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  interface: {law: $4}
  turgor: {mode: ${5:-prescribed}, pressure: 0.06 MPa}
  mesh: {along: 4, through: 1}
  ${6:-}
${7:-$load}
YAML
}
compare() {
  local name command=rve cells='cells: [2, 2]' patch=
  [ "$1" != patch ] || { cells='patch: {columns: 2, rows: 3}' patch=patch; shift; }
  [[ ${5:-} != *process:* ]] || command=process
  scene hexagons "$1" "cell: {apothem: 75 um, wall_thickness: 11.25 um, orientation: $1 deg}
  $cells" "${@:2}"
  scene polygons "$1" "cell: {orientation: $1 deg}
  tissue: hexagons.json" "${@:2}"
  "$python" hexagons.py "$1" $patch >hexagons.json
  for name in hexagons polygons; do
    "$lamella" $command $name.yaml --json --quiet >$name.out 2>err.txt || fail "$name: $(cat err.txt)"
  done
  "$python" compare.py hexagons.out polygons.out 2>err.txt || fail "$*: $(tail -1 err.txt)"
}
brittle='lamella, strength: 0.05 MPa, fracture_energy: 0.5 J/m^2'
compare 17 bonded sealed
compare 0 'contact, cohesion: 0.005 MPa'
compare 10 'contact, sharpness: smooth'
compare 0 "$brittle"
compare patch 0 "$brittle"
expect 0 "$lamella" rve polygons.yaml --quiet --no-estimate -o polygons.h5
expect 0 -o '^  tissue  *36 faces (--json lists them)' "$lamella" info polygons.h5
# stress given: F is what the solver finds
compare 0 'contact, cohesion: 0.005 MPa' prescribed '' 'load:
  - {F: [[1.05, 0.1], [0, free]], P: [[x, x], [x, -0.05 MPa]]}
  - {F: [[1.1, free], [0, free]], P: [[x, 0 MPa], [x, -0.05 MPa]]}'
# walls begin to tear; cells differ, since of equal ones any may be the first
compare 0 "$brittle" prescribed 'variation: {kinds: [{turgor: 1.1}, {turgor: 0.9}, {turgor: 0.8}], list: [0, 1, 2, 3]}' \
  'strength: {wall: 0.25 MPa, wall_fracture_energy: 10 J/m^2}
load: [{F: [[1.05, 0], [0, 1]]}, {F: [[1.1, 0], [0, 1]]}]'
grep -q '"dissipated_walls": [1-9]' polygons.out || fail "no wall tears: $(cat polygons.out)"
# ripening: water, turgor, the lamella and the walls
compare 0 bonded prescribed '' "$(sed -n '/^strength/,$p' "$source/tests/scenes/ripening.yaml")"
compare 0 bonded prescribed 'variation: {kinds: [{turgor: 0.5}], list: [0, 1, 1, 0]}'

# what the file says wrong: an expression for Python, and the message
wrong() {
  "$python" - "$1" <<'PYTHON'
import json, sys
d = json.load(open("hexagons.json"))
exec(sys.argv[1])
json.dump(d, open("wrong.json", "w"))
PYTHON
  sed 's/hexagons.json/wrong.json/' polygons.yaml >wrong.yaml
  expect 2 -e "$2" "$lamella" check wrong.yaml
}
wrong 'd["cells"][1].reverse()' 'wrong.json: cells\[1\] runs clockwise, or has no area; write its vertices counter-clockwise'
wrong 'd["cells"][2][0] = 99' 'wrong.json: cells\[2\] has vertex 99; they are numbered from 0 to'
wrong 'd["cells"][0] = d["cells"][0][:2]' 'wrong.json: cells\[0\] has 2 vertices; a cell has 3 at least'
wrong 'd["cells"].append(d["cells"][0])' 'wrong.json: cells.* and cells\[4\] both have the edge from vertex'
wrong 'c = d["cells"][3]; c[1], c[2] = c[2], c[1]' 'wrong.json: cells\[3\] crosses itself'
# a corner of cell 0, which lies around the origin, is pushed into its neighbours
wrong 'v = d["vertices"]; c = d["cells"][0]; v.append([1.1 * x for x in v[c[0]]]); c[0] = len(v) - 1' 'wrong.json: cells of .*: cells overlap'
wrong 'd["period"].reverse()' 'wrong.json: period: its two vectors must span an area, the second one to the left'
wrong 'd["corner_radius"] = 90' 'wrong.json: corner_radius: air at vertex .* write a smaller radius'
wrong 'd["wall_thickness"] = [10, 10]' 'wrong.json: wall_thickness: has 2 entries for 4 cells'
wrong 'd["unit"] = "MPa"' 'wrong.json: unit: MPa: '
wrong 'd["remark"] = 1' 'wrong.json: remark: unknown; remarks belong in made_by'
wrong 'd["lamella_tissue"] = 2' 'wrong.json: is no tissue file that this version knows'
sed -i 's/, list: .*}/}/' polygons.yaml
wrong 'd["classes"] = [0, 0, 2, 0]' 'kinds: .*has 1 kinds, and the file of the tissue has a cell of class 2'
wrong 'd["wall_thickness"] = 80' 'the walls, 80 um, fill cells of the apothem 75 um'
sed -i 's/^  tissue:/  patch: {sides: free}\n&/' polygons.yaml
wrong 'del d["period"]' 'no edge lies along the .* end of the patch'
sed 's/tissue:/cells: [2, 2]\n  &/' polygons.yaml >wrong.yaml
expect 2 -e 'rve.cells: given together with tissue in line 6, whose file has the cells; leave it out' "$lamella" check wrong.yaml
sed 's/hexagons.json/none.json/' polygons.yaml >wrong.yaml
expect 2 -e 'none.json: the tissue cannot be read: ' "$lamella" check wrong.yaml
