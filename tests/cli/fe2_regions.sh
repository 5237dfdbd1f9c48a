# slow: fe2 with regions and fields: which tissue answers, databases of their own, mistakes
. "$(dirname "$0")/common.sh"
set -e

# scene NAME, its regions and fields on stdin: a body of 2 x 2 elements under turgor, sheared in one step
scene() {
  cat - >blocks.yaml
  tissue >"$1" <<YAML
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, 0 mm]}]
  steps: 1
YAML
  cat blocks.yaml >>"$1"
}
# shear FILE: horizontal reaction of the top side in the last step
shear() { sed -n 's/.*"top": *\[ *\([-0-9.e+]*\),.*/\1/p' "$1" | tail -n 1; }
# near A B TOLERANCE: relative
near() { awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN {d = a - b; if (d < 0) d = -d; m = a < 0 ? -a : a; exit !(m > 0 && d <= t * m)}'; }

# what a region and a field say as the scene does, and a turn by a symmetry of the hexagon, change nothing
scene plain.yaml </dev/null
scene same.yaml <<'YAML'
  regions: [{name: turned, where: x > 5, cell: {orientation: 60 deg}}]
  fields: {turgor: {expression: 0.02, unit: MPa}}
YAML
for name in plain same; do "$lamella" fe2 $name.yaml --json >$name.jsonl; done
near "$(shear plain.jsonl)" "$(shear same.jsonl)" 1e-6 || fail "a turn by 60 degrees changes the reaction"

# a skin with walls twice as stiff in its own units is the body with stress twice as large
scene stiff.yaml <<'YAML'
  regions:
    - {name: skin, where: 1, wall: {C1: 0.2 MPa, C2: 0.02 MPa, C4: 2 MPa}, turgor: {pressure: 0.04 MPa}}
YAML
"$lamella" fe2 stiff.yaml --json >stiff.jsonl
near "$(shear stiff.jsonl)" "$(awk -v s="$(shear plain.jsonl)" 'BEGIN {printf "%.12g", 2 * s}')" 1e-6 ||
  fail "twice the moduli and turgor are not twice the reaction"

# thicknesses between levels; each tissue has a database, which the next run finds complete
scene fields.yaml <<'YAML'
  regions: [{name: skin, where: y > 5, wall: {C1: 0.15 MPa}}]
  fields:
    wall_thickness: {expression: 11 + 0.2 * y, unit: um, levels: 2}
    orientation: {expression: 3 * x, unit: deg}
YAML
"$lamella" fe2 fields.yaml --json >direct.jsonl
for run in cold warm; do "$lamella" fe2 fields.yaml --json -d db.h5 >$run.jsonl; done
near "$(shear direct.jsonl)" "$(shear cold.jsonl)" 0.02 || fail "a cache is another tissue than direct solves"
for file in db.t1.h5 db.t2.h5 db.skin.t1.h5 db.skin.t2.h5; do [ -s $file ] || fail "there is no $file"; done
[ ! -e db.h5 ] || fail "there is a database that nobody asks"
expect 2 -e 'is of kind "database"' "$lamella" fe2 fields.yaml -d db.h5 -o ./db.skin.t1.h5
"$lamella" fe2 fields.yaml --json -d db.h5 --response database >only.jsonl || fail "the databases do not answer alone"
near "$(shear warm.jsonl)" "$(shear only.jsonl)" 0.01 || fail "the databases answer otherwise than their cache"

# mistakes that only the body shows
scene nogroup.yaml <<'YAML'
  regions: [{name: skin}]
YAML
expect 2 -e 'skin: the mesh has no group of elements of this name' "$lamella" fe2 nogroup.yaml
scene thin.yaml <<'YAML'
  fields: {wall_thickness: {expression: 11 - 2 * x, unit: um}}
YAML
expect 2 -e 'wall_thickness: is -.* um at x = ' "$lamella" fe2 thin.yaml
scene hole.yaml <<'YAML'
  fields: {turgor: {expression: sqrt(x - 1), unit: MPa}}
YAML
expect 2 -e 'hole.yaml:12: macro.fields.turgor.expression: .* at x = ' "$lamella" fe2 hole.yaml
