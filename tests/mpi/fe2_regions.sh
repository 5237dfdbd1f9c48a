# fe2 of a body of different tissue on two ranks: the same reactions to 1e-8, from caches
set -eu
lamella=$(realpath "$1")
command -v mpirun >/dev/null || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat >body.yaml <<'YAML'
version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: 11.25 um}
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  turgor: {mode: prescribed, pressure: 0.02 MPa}
  mesh: {along: 4, through: 1}
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary:
    - {on: bottom, displacement: [0 mm, 0 mm]}
    - {on: top, displacement: [1 mm, 0 mm]}
  steps: 1
  regions: [{name: skin, where: y > 5, wall: {C1: 0.15 MPa}}]
  fields:
    wall_thickness: {expression: 11 + 0.1 * x, unit: um, levels: 2}
    orientation: {expression: 3 * x, unit: deg}
YAML
# reactions FILE: all of them, one per line
reactions() { grep -o '"reaction": *{[^}]*}' "$1" | grep -o '\[[^]]*\]' | tr -d '[],' | tr ' ' '\n' | grep .; }

"$lamella" fe2 body.yaml --json --response cache >one.jsonl
mpirun -n 2 "$lamella" fe2 body.yaml --json --response cache >two.jsonl
reactions one.jsonl >one.txt
reactions two.jsonl >two.txt
paste one.txt two.txt | awk '{d = $1 - $2; if (d < 0) d = -d; if (d > worst) worst = d; a = $1 < 0 ? -$1 : $1; if (a > size) size = a}
  END {exit !(NR > 0 && size > 0 && worst <= 1e-8 * size)}' || {
  echo "fe2_regions: reactions depend on the number of ranks" >&2
  exit 1
}
