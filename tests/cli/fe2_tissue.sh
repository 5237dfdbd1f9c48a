# fe2 with regions of cells of their own files: against hexagons and files of turned cells; their databases
. "$(dirname "$0")/common.sh"
set -e

# cells FILE SIZE WAVE DEGREES: 2 x 2 hexagons of this apothem (um) in a period, their vertices displaced by a wave of
# this height (apothems), all of it turned by an angle
cells() {
  awk -v size="$2" -v wave="$3" -v degrees="$4" 'BEGIN {
    pi = atan2(0, -1); c = size * cos(degrees * pi / 180); s = size * sin(degrees * pi / 180); h = sqrt(3)
    printf "{\"lamella_tissue\": 1, \"unit\": \"um\", \"period\": [[%.17g, %.17g], [%.17g, %.17g]], \"vertices\": [",
      4 * c, 4 * s, 2 * c - 2 * h * s, 2 * s + 2 * h * c
    for (v = 0; v < 24; v++) {
      i = int(v / 12); j = int(v / 6) % 2; angle = pi / 3 * (v % 6 - 0.5)
      x = 2 * i + j + 2 / h * cos(angle); y = h * j + 2 / h * sin(angle)
      a = pi / 2 * (x - y / h); b = pi * y / h # of one period along either vector
      x += wave * (sin(a + 1) + cos(b)); y += wave * sin(b - a)
      printf "%s[%.17g, %.17g]", v ? ", " : "", c * x - s * y, s * x + c * y
    }
    print "], \"cells\": [[0,1,2,3,4,5], [6,7,8,9,10,11], [12,13,14,15,16,17], [18,19,20,21,22,23]]}"
  }' >"$1"
}
# scene NAME, its regions and fields on stdin: a body of 2 x 2 elements under turgor, sheared in one step
scene() {
  { cat <<'YAML'; cat; } | tissue >"$1"
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, 0 mm]}]
  steps: 1
YAML
}
# of_file FILE SCENE: the scene with the cells of a file for its hexagons
of_file() { sed "s/cell: .*/tissue: $1/; /tissue:/a \\  cell: {wall_thickness: 11.25 um}" "$2"; }
# forces NAME [OPTION...]: runs NAME.yaml; NAME.forces has the reactions of the top side
forces() {
  expect 0 "$lamella" fe2 "$1.yaml" --json "${@:2}"
  sed -n 's/.*"top": *\[ *\([-0-9.e+]*\), *\([-0-9.e+]*\).*/\1 \2/p' out.txt >"$1.forces"
  [ -s "$1.forces" ] || fail "$1 has no reaction: $(cat out.txt)"
}
# off NAME NAME: how far the reactions are from each other, relative
off() {
  paste "$1.forces" "$2.forces" | awk '
    {for (k = 1; k < 3; k++) {d = $k - $(k + 2); e += d * d; m += $k * $k}} END {print (m > 0 ? sqrt(e / m) : 1)}'
}
# alike NAME NAME TOLERANCE
alike() {
  awk -v e="$(off "$1" "$2")" -v t="$3" 'BEGIN {exit !(e <= t)}' || fail "$1 and $2: reactions $(off "$1" "$2") apart"
}

# a region of a file beside one of hexagons: hexagons of another size as polygons are those hexagons
cells small.json 40 0 0
scene hexagons.yaml <<'YAML'
  regions: [{name: skin, where: y > 5, cell: {apothem: 40 um}}]
YAML
sed 's/cell: {apothem: 40 um}/tissue: small.json/' hexagons.yaml >polygons.yaml
for name in hexagons polygons; do forces $name; done
alike hexagons polygons 1e-9

# an orientation turns cells of a file as a file of turned cells does, in a region and as a field; a field turns hexagons
cells skin.json 40 0.08 0
cells turned.json 40 0.08 25
scene file.yaml <<'YAML'
  regions: [{name: skin, where: y > 5, tissue: turned.json, wall: {C1: 0.2 MPa, C2: 0.02 MPa, C4: 2 MPa}}]
YAML
sed 's/turned.json/skin.json, cell: {orientation: 25 deg}/' file.yaml >region.yaml
sed 's/turned.json/skin.json/' file.yaml >straight.yaml
for name in file region straight; do forces $name; done
alike file region 1e-10
awk -v e="$(off file straight)" 'BEGIN {exit !(e > 1e-3)}' || fail "cells that are turned answer as those that are not"
scene field.yaml <<'YAML'
  fields: {orientation: {expression: 25, unit: deg}}
YAML
scene plain.yaml </dev/null
sed 's/cell: {/cell: {orientation: 25 deg, /' plain.yaml >key.yaml
of_file turned.json plain.yaml >turned_file.yaml
of_file skin.json field.yaml >turned_field.yaml
sed 's/11.25 um/&, orientation: 10 deg/; s/expression: 25/expression: 35/' turned_field.yaml >from_another.yaml
for name in field key turned_file turned_field from_another; do forces $name; done
alike field key 1e-10
alike turned_file turned_field 1e-10
alike turned_file from_another 1e-10

# cells turned along the body; each tissue has a database
scene varied.yaml <<'YAML'
  regions:
    - {name: skin, where: y > 5, tissue: skin.json, cell: {wall_thickness: 5 um}}
    - {name: core, where: x + y < 7, tissue: turned.json}
  fields: {orientation: {expression: 3 * x, unit: deg}}
YAML
forces varied
for run in cold warm; do
  cp varied.yaml $run.yaml
  forces $run -d db.h5
  alike varied $run 0.02
done
for name in '' skin. core.; do expect 0 -o 'records' "$lamella" info db.${name}h5; done
