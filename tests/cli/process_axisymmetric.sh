# slow: process of an axisymmetric body: a cylinder in a bath, whose water comes in around it, directly and from a database; its
# forces are those of the whole circle, and its axis is no surface
. "$(dirname "$0")/common.sh"
set -e

tissue turgor='mode: prescribed, pressure: 0.05 MPa' >soak.yaml <<'YAML'
macro:
  symmetry: axisymmetric
  mesh: {box: [5 mm, 2 mm], elements: [2, 1]}
  boundary:
    - {on: bottom, symmetry: true}
    - {on: top, plate: {displacement: [0 mm, -0.4 mm], friction: 0.3}}
process:
  program: [{for: 10 s, load: 1}, {for: 1 h, load: 1}]
  output: 0.5 h
  water: {permeability: 1e-5 m/s/MPa}
  surroundings: [{time: 0 s, outside: 0.5 MPa}]
  transport: {apoplast: 1e-9 m^2/s/MPa, surface: [{on: right}]}
YAML
for response in direct cache; do
  "$lamella" process soak.yaml --response $response --json >$response.jsonl
done
/usr/bin/python3 - <<'PYTHON'
import json
direct, cache = ([s for s in map(json.loads, open(f"{r}.jsonl")) if "reaction" in s] for r in ("direct", "cache"))
for states in direct, cache:
    assert all(abs(s["water_balance"]) < 1e-10 for s in states)
    assert abs(states[-1]["water"] - 1 - states[-1]["inflow"]) < 1e-9 and states[-1]["water"] < 0.999, states[-1]  # pressed out
    pressed, relaxed = (s["reaction"]["top"][1] for s in (states[1], states[-1]))
    assert pressed < 1.02 * relaxed < 0, (pressed, relaxed)  # and the force falls
for a, b in zip(direct, cache):
    assert abs(a["reaction"]["top"][1] - b["reaction"]["top"][1]) < 0.02 * abs(direct[1]["reaction"]["top"][1]), (a, b)
PYTHON
expect 0 -o 'reactions in N\.' "$lamella" process soak.yaml --response direct
sed 's/on: right}\]/on: right}, {on: left}]/' soak.yaml >axis.yaml
expect 2 -e 'axis.yaml:[0-9]*:[0-9]*: process.transport.surface: on: left: is the axis of the body' "$lamella" process axis.yaml --response direct
