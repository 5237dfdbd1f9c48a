# lamella check: the plan, in agreement with what is then solved.
. "$(dirname "$0")/common.sh"
serve=1

# number FILE NAME: the first number of that name in a JSON line
number() { grep -oE "\"$2\": *[-0-9.e+]+" "$1" | head -1 | sed 's/.*: *//'; }

# scene CELLS THICKNESS ACCURACY MESH: writes scene.yaml
scene() {
  cat >scene.yaml <<YAML
version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: $2 um}
  cells: $1
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  turgor: {pressure: 0.02 MPa}
$4
load:
  - {ramp: {to: [[1, 0.02], [0, 1]], steps: 2}}
sample:
  stretch: {min: 0, max: 0.1}
  count: 7
macro:
  mesh: {box: [10 mm, 5 mm], elements: [4, 2]}
  boundary:
    - {on: bottom, displacement: [0 mm, 0 mm]}
  steps: 3
accuracy: $3
YAML
}

# mesh WANTED: along and through of the plan
mesh() {
  # without the body, whose prediction is long
  sed '/^macro:/,/steps: 3/d' scene.yaml >part.yaml
  "$lamella" check part.yaml --measure --json >plan.json || fail "fails: $(cat scene.yaml)"
  found="$(number plan.json along) $(number plan.json through)"
  [ "$found" = "$1" ] || fail "chooses $found elements instead of $1: $(grep -E 'cell:|accuracy|mesh' scene.yaml)"
}

scene "[1, 1]" 11.25 0.01 ""
mesh "10 1"
scene "[1, 1]" 11.25 0.005 ""
mesh "12 2"
scene "[1, 1]" 11.25 0.001 ""
mesh "16 4"
scene "[1, 1]" 30 0.01 ""
mesh "8 2"
scene "[1, 1]" 11.25 0.001 "  mesh: {along: 3, through: 1}"
mesh "3 1"
scene "[1, 1]" 11.25 0.001 "  mesh: {along: 5}"
mesh "5 4"
scene "[1, 1]" 11.25 0.01 "  interface: {law: contact, cohesion: 0.005 MPa}"
"$lamella" check scene.yaml --json >plan.json
grep -q '"mesh": {"along": 16, "through": 2' plan.json || fail "the tangents of cells in contact move the body: $(cat plan.json)"

# the numbers of states of each block
[ "$(number plan.json states)" = 2 ] || fail "counts $(number plan.json states) states of the load"
grep -q '"sample": {"states": 7,' plan.json || fail "does not count the samples: $(cat plan.json)"
[ "$(number plan.json points)" = 72 ] || fail "counts $(number plan.json points) material points"

# as many unknowns as are solved for
for cells in "[1, 1]" "[2, 3]"; do
  scene "$cells" 11.25 0.01 "  mesh: {along: 2, through: 1}"
  "$lamella" check scene.yaml --json >plan.json
  "$lamella" rve scene.yaml --json --quiet >states.json || fail "rve: $?"
  [ "$(number plan.json unknowns)" = "$(number states.json unknowns)" ] ||
    fail "$cells: $(number plan.json unknowns) unknowns, solved for $(number states.json unknowns)"
done

# patch ORIENTATION COLUMNS ROWS SIDES LAW: writes scene.yaml
patch() {
  tissue cell="apothem: 75 um, wall_thickness: 11.25 um, orientation: $1 deg" interface="$5" \
    turgor='pressure: 0.05 MPa' mesh='along: 2, through: 1' >scene.yaml <<YAML
  patch: {columns: $2, rows: $3, sides: $4}
  variation: {kinds: [{turgor: 0.5, wall_thickness: 9 um}], pattern: [[0, 1]]}
load:
  - {F: [[1, 0.01], [0, 1]]}
YAML
}

# of patches too: upright, lying and turned lattices
for kind in "0 3 3 affine law: bonded" "30 3 4 free law: bonded" "70 2 3 free law: bonded" \
  "0 3 2 affine law: contact" "30 2 3 free law: contact, cohesion: 0.01 MPa"; do
  read -r angle columns rows sides law <<<"$kind"
  patch "$angle" "$columns" "$rows" "$sides" "$law"
  "$lamella" check scene.yaml --json >plan.json || fail "$kind: $(cat plan.json)"
  "$lamella" rve scene.yaml --json --quiet >states.json 2>err.txt
  [ "$(number plan.json unknowns)" = "$(number states.json unknowns)" ] ||
    fail "$kind: $(number plan.json unknowns) unknowns, solved for $(number states.json unknowns) $(cat err.txt)"
done
grep -q '"patch": {"columns": 2, "rows": 3, "sides": "free"}' plan.json || fail "no patch: $(cat plan.json)"
grep -q '"variation": {"kinds": 2, "wall_thickness": \[0.12' plan.json || fail "no variation: $(cat plan.json)"
"$lamella" check scene.yaml >text.txt
has text.txt "a patch of 2 columns and 3 rows of cells between grips, lateral sides free" \
  "2 different: wall 0.12 to 0.15 of the apothem" "turgor 0.5 to 1 and"

# for a person: model, mesh, cost
"$lamella" check "$source/tests/scenes/tissue-block.yaml" >text.txt || fail "exit status $?"
has text.txt "plane strain" fibre_mooney_rivlin bonded "0.02 MPa" "10 elements along" "^unknowns *596$" "about .* MB" \
  "576 material points.*, about .* s (.* % of the time measured)"

# a lamella: the opening at failure 2 G/strength, the stiffness that it chooses, and the elements that would resolve it
tissue interface='law: lamella, strength: 0.05 MPa, fracture_energy: 1 J/m^2, residual_cohesion: 0.001 MPa' \
  mesh='along: 4, through: 1' </dev/null >breaks.yaml
expect 0 "$lamella" check breaks.yaml
has out.txt "^interface .* lamella, bilinear: strength 0.05 MPa, energy of fracture 1 J/m^2; residual cohesion 0.001 MPa" \
  "^  failure .* at an opening of 40 um, 0.533 of the apothem; over about 34.3 um" \
  "^  stiffness .* 1.972e+04 MPa/mm (chosen): costs about 0.08 %" "^warning .*: tissue will seem too strong; write rve.mesh.along: 8 or more"
expect 0 "$lamella" check breaks.yaml --json
has out.txt '"failure_opening": 0.5333' '"stiffness_chosen": true' '"compliance": 0.0008' '"warnings": \["elements of up to'
sed 's/fracture_energy: 1/stiffness: 1e4 MPa\/mm, &/; s/along: 4/along: 8/' breaks.yaml >fine.yaml
expect 0 -o "1e+04 MPa/mm (as the scene says): costs about 0.16 %" "$lamella" check fine.yaml
grep -q warning out.txt && fail "warns of a mesh that is fine: $(cat out.txt)"

# a body's regions, each with its own tissue and mesh
scene "[1, 1]" 11.25 0.01 ""
sed 's/^  steps: 3/  steps: 3\n  regions:\n    - {name: skin, where: y > 4, cell: {apothem: 40 um, wall_thickness: 12 um}}/' scene.yaml >regions.yaml
"$lamella" check regions.yaml >regions.txt || fail "fails with regions"
grep -qE "skin  *wall 0.3 of the apothem \(40 um\).* [0-9]+ x [0-9]+ elements" regions.txt || fail "the region's tissue is not told: $(cat regions.txt)"
"$lamella" check regions.yaml --json | grep -qE '"regions": *\[\{"name": *"skin"' || fail "no regions: $("$lamella" check regions.yaml --json)"

# digits: one sentence where rounding leaves fewer than the accuracy needs, in check and once on stderr; else nothing
scene "[1, 1]" 1.5 0.00001 "  mesh: {along: 2, through: 1}"
sed 's/C4: 1 MPa/C4: 1 MPa, bulk_modulus: 1e7 MPa/; /^sample:/,/count:/d; /^macro:/,/steps: 3/d' scene.yaml >stiff.yaml
"$lamella" check stiff.yaml >stiff.txt || fail "check fails with stiff walls: $(cat stiff.txt)"
grep -qE "^rounding .* digits? of the tangent, fewer than an accuracy of 0.001 % needs: take a bulk modulus below" stiff.txt ||
  fail "is silent of rounding: $(cat stiff.txt)"
"$lamella" check stiff.yaml --json | grep -q '"warning": "a bulk modulus of' || fail "is silent of rounding in JSON"
"$lamella" rve stiff.yaml --quiet >/dev/null 2>err.txt
[ "$(grep -c "digits\? of the tangent" err.txt)" = 1 ] || fail "rve does not say it once: $(cat err.txt)"
"$lamella" check scene.yaml --json | grep -q '"warning": null' || fail "speaks of rounding without need"

# predictions: of what ends within the time they are measured, else extrapolated; the whole takes 2 s of a processor, and a
# trial that would take longer is left unfinished
seconds() { TIMEFORMAT='%U %S'; { time "$@" >out.txt 2>err.txt; } 2>&1 | awk '{print $1 + $2}'; }
"$lamella" check "$source/tests/scenes/rate-loop.yaml" --json >plan.json
grep -qE '"process": \{[^}]*"seconds": [0-9.]+, "share": 1(\.0)?\}' plan.json || fail "does not predict a short process: $(cat plan.json)"
"$lamella" check "$source/tests/scenes/shear-bonded.yaml" --json >plan.json
awk "BEGIN { a = $(number plan.json seconds); b = $(seconds "$lamella" rve "$source/tests/scenes/shear-bonded.yaml" --quiet); exit !(a < 3 * b && b < 3 * a) }" ||
  fail "predicts $(number plan.json seconds) s of shear-bonded.yaml, which takes $(seconds "$lamella" rve "$source/tests/scenes/shear-bonded.yaml" --quiet)"
tissue cell='apothem: 75 um, wall_thickness: 2 um' interface='law: contact, cohesion: 0.005 MPa' mesh='grading: 0.6' >long.yaml <<'YAML'
  cells: [3, 3]
load:
  - {ramp: {to: [[1, 0.5], [0, 1]], steps: 40}}
accuracy: 0.001
YAML
took=$(seconds "$lamella" check long.yaml)
awk "BEGIN { exit !($took < 2.5) }" || fail "takes $took s of a processor"
has out.txt "not tried to the end: --measure finds the mesh that commands take"
