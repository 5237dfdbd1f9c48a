# The programs of examples/ say what the program says of the same scenes.
set -u
. "$(dirname "$0")/common.sh" "$@"
examples=$(dirname "$lamella")/examples
scenes=$source/tests/scenes

"$examples/example_state" "$scenes/shear-contact.yaml" >state.txt 2>&1
python3 - state.txt <<'PY' || fail "a state and its tangent: $(cat state.txt)"
import re, sys
text = open(sys.argv[1]).read()
tangent, difference = map(float, re.search(r"dP12/dF12 (\S+) Pa, by differences (\S+) Pa", text).groups())
assert abs(tangent - difference) < 1e-4 * abs(tangent) and tangent > 1e3, text
PY

"$examples/example_database" "$scenes/tissue-block.yaml" t.h5 >database.txt 2>&1
grep -q 'F11 1.05: P11 -\?[0-9.]*e-\?+\?[0-9]* Pa, estimated error' database.txt || fail "a database: $(cat database.txt)"
grep -q 'F11 3.00: no response: ' database.txt || fail "a state outside: $(cat database.txt)"
"$lamella" info t.h5 | grep -q database || fail "info of the example's database"

cp t.h5 u.h5 # both runs begin with the same records
"$examples/example_fe2_block" "$scenes/tissue-block.yaml" u.h5 >block.txt 2>&1
"$lamella" fe2 "$scenes/tissue-block.yaml" -d t.h5 --json --quiet >steps.json || fail "fe2"
python3 - block.txt steps.json <<'PY' || fail "FE2 of a block: $(cat block.txt)"
import json, re, sys
forces = [float(f) for f in re.findall(r"force on top (\S+) N/m", open(sys.argv[1]).read())]
steps = [json.loads(line) for line in open(sys.argv[2])]
assert len(forces) == len(steps) > 3
for force, step in zip(forces, steps):
    wanted = 1e3 * step["reaction"]["top"][0]  # N/mm
    assert abs(force - wanted) <= 1e-3 * abs(wanted) + 1e-3, (force, wanted)
PY

"$examples/example_own_law" "$scenes/tissue-block.yaml" >law.txt 2>&1
grep -q '^load 1.00: [1-6] Newton iterations' law.txt || fail "a law of one's own: $(cat law.txt)"

"$examples/example_state" missing.yaml >missing.txt 2>&1 && fail "a scene that is missing"
grep -q '^missing.yaml: ' missing.txt && ! grep -q 'PETSC ERROR' missing.txt || fail "the words of an error: $(cat missing.txt)"

for name in state database fe2_block own_law; do
  expect 1 -e "^usage: .*example_$name SCENE.yaml.*such as tests/scenes/" "$examples/example_$name"
  scene=$(sed 's/.*such as \([^ ]*\).*/\1/' err.txt)
  [ -f "$source/$scene" ] || fail "example_$name names $scene, which is not there"
done
