#!/usr/bin/env bash
# Walls with memory in rve and process, what they write, and where they are refused.
. "$(dirname "$0")/common.sh"
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

# a process of the same walls, with its cells in the file; not with a table
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
expect 2 -e 'rve.wall.relaxation: responses of walls with memory depend on time' "$lamella" process process.yaml -d d.h5
