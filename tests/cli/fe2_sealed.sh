# fe2 in sealed tissue: turgor follows the load, a cache answers as well
. "$(dirname "$0")/common.sh"

tissue turgor='mode: sealed, pressure: 0.02 MPa' >block.yaml <<'YAML'
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 1]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, -0.5 mm]}]
  steps: 2
YAML

expect 0 "$lamella" fe2 block.yaml --json -o direct.h5
cp out.txt direct.jsonl
expect 0 "$lamella" fe2 block.yaml --json --response cache
cp out.txt cache.jsonl
if /usr/bin/python3 -c 'import json' 2>/dev/null; then
  /usr/bin/python3 - <<'PYTHON' || fail "not what sealed tissue does: $(cat direct.jsonl cache.jsonl)"
import json
direct, cache = ([json.loads(line) for line in open(name)] for name in ("direct.jsonl", "cache.jsonl"))
assert [s["step"] for s in direct] == [0, 1, 2]
assert abs(direct[0]["turgor_mean"] - 0.02) < 1e-12  # inflation has all the water it wants
assert direct[1]["turgor_mean"] > 0.021 and direct[2]["turgor_mean"] > direct[1]["turgor_mean"]  # pressed
for one, other in zip(direct[1:], cache[1:]):
    assert one["cutbacks"] == 0 and one["newton_iterations"] <= 5
    for i in range(2):
        a, b = one["reaction"]["top"][i], other["reaction"]["top"][i]
        assert abs(a - b) < 0.02 * abs(one["reaction"]["top"][1]), (a, b)
PYTHON
fi

# of cells in contact
sed 's/{law: bonded}/{law: contact, cohesion: 0.02 MPa}/' block.yaml >contact.yaml
expect 0 "$lamella" fe2 contact.yaml --json
cp out.txt direct.jsonl
expect 0 "$lamella" fe2 contact.yaml --json --response cache
cp out.txt cache.jsonl
if /usr/bin/python3 -c 'import json' 2>/dev/null; then
  /usr/bin/python3 - <<'PYTHON' || fail "not what sealed cells in contact do: $(cat direct.jsonl cache.jsonl)"
import json
direct, cache = ([json.loads(line) for line in open(name)] for name in ("direct.jsonl", "cache.jsonl"))
for one, other in zip(direct[1:], cache[1:]):
    assert abs(one["turgor_mean"] - other["turgor_mean"]) < 0.01 * one["turgor_mean"]
    for i in range(2):
        a, b = one["reaction"]["top"][i], other["reaction"]["top"][i]
        assert abs(a - b) < 0.02 * abs(one["reaction"]["top"][1]), (a, b)
PYTHON
fi

# a disc between plates: nodes leave the plate one by one, and the iterations are few (1,456 where all left at once); the
# forces are those of many small increments
sed 's/mode: prescribed/mode: sealed/' "$source/tests/scenes/pressed-disc.yaml" >disc.yaml
expect 0 "$lamella" fe2 disc.yaml --json
/usr/bin/python3 - <<'PYTHON' || fail "a sealed disc: $(cut -c1-300 out.txt)"
import json
steps = [json.loads(line) for line in open("out.txt")]
force = [s["reaction"]["plate"][1] for s in steps]
assert sum(s["newton_iterations"] for s in steps) <= 60
for a, b in zip(force, (0, -0.0211125433, -0.0659700174, -0.1642480224, -0.0400093097, 0)):
    assert abs(a - b) < 1e-8, force
PYTHON
