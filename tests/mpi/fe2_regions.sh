# fe2 of a body of different tissue on two ranks: the same reactions to 1e-8, from caches
. "$(dirname "$0")/../cli/common.sh"
command -v mpirun >/dev/null || exit 77
set -e

tissue >body.yaml <<'YAML'
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, 0 mm]}]
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
  END {exit !(NR > 0 && size > 0 && worst <= 1e-8 * size)}' ||
  fail "reactions depend on the number of ranks"
