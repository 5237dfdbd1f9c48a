#!/usr/bin/env bash
# Walls with memory in rve and process, what they write, and where they are refused.
. "$(dirname "$0")/common.sh"
serve=1
set -e -o pipefail
scene=$source/tests/scenes/relaxation.yaml

expect 0 "$lamella" check "$scene"
grep -q 'relaxes    25 % with 5 s, 25 % with 120 s, 50 % stay' out.txt || fail "check: $(cat out.txt)"
expect 0 -o '"relaxation": \[{"share": 0.25' "$lamella" check "$scene" --json

# times add up, in JSON, the table and the file; held tissue relaxes; the estimate has a history of its own
expect 0 "$lamella" rve "$scene" --json -o r.h5
/usr/bin/python3 - out.txt <<'PY' || fail "wrong states"
import json, sys
states = [o for o in map(json.loads, open(sys.argv[1])) if "state" in o]
P, t = [o["P"][0] for o in states], [o["time"] for o in states]
assert len(states) == 19 and t[0] == 86400 and abs(t[-1] - 87600) < 1e-6
assert all(a > b for a, b in zip(P[4:13], P[5:14])) and P[13] < 0.75 * P[4]
assert all(o["status"] == "converged" and o["error_estimate"] < 0.1 for o in states)
assert all(a["dissipated"] <= b["dissipated"] for a, b in zip(states, states[1:]))
PY
head -1 r.csv | grep -q ',time (s),work (kJ/m^3),stored (kJ/m^3),dissipated (kJ/m^3)' || fail "r.csv: $(head -1 r.csv)"
expect 0 "$lamella" info r.h5
expect 0 "$lamella" plot --dpi 40 r.h5 -o r.svg

for option in --onset --failure; do
    sed 's/law: bonded/law: lamella, strength: 0.1 MPa, fracture_energy: 1 J\/m^2/' "$scene" >lamella.yaml
    expect 2 -e 'rve.wall.relaxation: --onset, --failure and --global look for states' "$lamella" rve lamella.yaml $option
done
expect 2 -e 'rve.wall.relaxation: responses of walls with memory depend on time' "$lamella" query r.h5 -F '1.02 0 0 1'

# a process of the same walls, with its cells in the file
sed '/^load/,$d' "$scene" >walls.yaml
cat walls.yaml - >process.yaml <<'YAML'
process:
  output: 1 min
  program:
    - {for: 10 s, F: [[1.05, 0], [0, free]], P: [[x, x], [x, 0 MPa]]}
    - {for: 5 min}
YAML
expect 0 "$lamella" process process.yaml --json -o p.h5
/usr/bin/python3 - out.txt <<'PY' || fail "wrong states of the process"
import json, sys
states = [o for o in map(json.loads, open(sys.argv[1])) if "state" in o]
held = [o["P"][0] for o in states if o["time"] >= 10]
assert len(held) > 4 and all(a > b for a, b in zip(held, held[1:]))
assert all(a["dissipated"] <= b["dissipated"] for a, b in zip(states, states[1:])) and states[-1]["dissipated"] > 0
PY
expect 0 "$lamella" plot --dpi 40 p.h5 -o p.svg

# from a database, which is of the walls at once: nearly the same, and its cells are of walls that relax
expect 0 -e 'responses of a database are of elastic walls' "$lamella" process process.yaml -d d.h5 --json -o pd.h5
mv out.txt database.jsonl
"$lamella" process process.yaml --json >direct.jsonl
/usr/bin/python3 - direct.jsonl database.jsonl <<'PY' || fail "wrong states from a database"
import json, sys
a, b = [[s for s in map(json.loads, open(path)) if "state" in s] for path in sys.argv[1:]]
assert len(a) == len(b) > 4 and b[-1]["dissipated"] is None
assert all(abs(s["P"][0] - t["P"][0]) < 0.1 * a[-1]["P"][0] for s, t in zip(a[1:], b[1:]))
PY
expect 0 "$lamella" plot --dpi 40 pd.h5 -o pd.svg
cat walls.yaml - >table.yaml <<'YAML'
sample: {stretch: {min: -0.1, max: 0.2}, turgor: {min: 0 MPa, max: 0.05 MPa}}
accuracy: 0.1
YAML
expect 0 -e 'a table is of the walls at once' "$lamella" build table.yaml -d table.h5
expect 0 "$lamella" process process.yaml -d table.h5 --response cache

# in contact a new database reaches to the pressures of walls that have relaxed: (turgor + cohesion) / 0.5
sed 's/law: bonded/law: contact, cohesion: 0.01 MPa/' process.yaml >contact.yaml
expect 0 "$lamella" process contact.yaml -d contact.h5
expect 0 -o 'grid of suction    0.0075 to 0.06 MPa' "$lamella" info contact.h5

# a body: in a process alone
cat walls.yaml - >body.yaml <<'YAML'
macro:
  mesh: {box: [1 mm, 1 mm], elements: [1, 1]}
  boundary: [{on: left, symmetry: true}, {on: bottom, symmetry: true}, {on: top, displacement: [free, 0.05 mm]}]
process:
  output: 1 min
  program: [{for: 10 s, load: 1}, {for: 5 min}]
YAML
expect 2 -e 'the steps of `lamella fe2` take no time' "$lamella" fe2 body.yaml
expect 0 "$lamella" process body.yaml --json
/usr/bin/python3 - out.txt <<'PY' || fail "wrong states of the body"
import json, sys
states = [o for o in map(json.loads, open(sys.argv[1])) if "reaction" in o and o["time"] > 10]
held = [o["reaction"]["top"][1] for o in states]
assert len(held) > 4 and all(a > b for a, b in zip(held, held[1:]))
PY
