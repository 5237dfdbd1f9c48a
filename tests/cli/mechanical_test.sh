# lamella rve: a load from the inflated tissue, what is read off its curve, and its table.
. "$(dirname "$0")/common.sh"

scene=$source/tests/scenes/apple-tension.yaml
expect 0 "$lamella" rve "$scene" --json --at 0.05,0.3 -o apple.h5
/usr/bin/python3 - <<'PYTHON' || fail "the readings: $(tail -1 out.txt)"
import csv, json
lines = [json.loads(line) for line in open("out.txt")]
states, test = lines[:-1], lines[-1]["test"]
rows = list(csv.DictReader(open("apple.csv")))
assert len(rows) == len(states) == 21
F0 = test["F_inflated"]
assert F0 == states[0]["F"] and test["component"] == "11" and test["reference"] == "inflated"
for row, state in zip(rows, states):
    G, P = state["from_inflated"]["F"], state["from_inflated"]["P"]
    assert abs(G[0] - state["F"][0] / F0[0]) < 1e-12 and abs(P[0] - state["P"][0] / F0[4]) < 1e-9
    assert abs(float(row["strain"]) - (G[0] - 1)) < 1e-9 and abs(float(row["stress (MPa)"]) - P[0]) < 1e-9
    assert abs(float(row["P22 (MPa)"])) < 1e-9 and row["status"] == "converged"
assert abs(float(rows[10]["F11"]) - 1.1) < 1e-12
at, beyond = test["at"]
assert abs(at["stress"] - float(rows[5]["stress (MPa)"])) < 1e-9 and at["tangent_modulus"] > at["secant_modulus"] > test["modulus"]
assert beyond["stress"] is None and not test["peak_passed"] and abs(test["work"] - test["returned"]) < 1e-9 * test["work"]
PYTHON

# without readings the object is not there, and the table has the states alone
expect 0 "$lamella" rve "$source/tests/scenes/shear-bonded.yaml" --json -o shear.h5
grep -q '"test"' out.txt && fail "readings that nobody asked for"
head -1 shear.csv | grep -q strain && fail "a curve that nobody asked for"
[ "$(wc -l <shear.csv)" -eq 4 ] || fail "not one line per state: $(cat shear.csv)"

# a load that drives nothing has no curve
tissue mesh='along: 6, through: 2' >still.yaml <<'YAML'
load:
  - {F: [[1, 0], [0, 1]]}
YAML
expect 0 -o 'there is no curve' "$lamella" rve still.yaml --readings
expect 1 -e 'give at most' "$lamella" rve still.yaml --at 0.1,x
# an inflated state that is not found: what follows from it is not solved
tissue turgor='pressure: 100 MPa' mesh='along: 6, through: 2' >burst.yaml <<'YAML'
load:
  - {inflate: true}
  - {F: [[1.1, 0], [0, 1]]}
YAML
expect 3 -e 'what follows counts from it' "$lamella" rve burst.yaml
