# lamella rve: a load from the inflated tissue, what is read off its curve, and its table.
. "$(dirname "$0")/common.sh"
serve=1

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

# the picture has the numbers of the table, and its axes say what they count from
if /usr/bin/python3 -c 'import cffi, h5py, matplotlib, yaml' 2>/dev/null && [ -f "$(dirname "$lamella")/liblamella.so" ]; then
  PYTHONPATH=$source/python LAMELLA_LIBRARY=$(dirname "$lamella") /usr/bin/python3 - <<'PYTHON' || fail "the picture contradicts the table"
import csv
import numpy as np
import lamella.plot
drawn = lamella.plot.draw("apple.h5")
axes = drawn.axes[-1]
assert axes.get_xlabel() == "$F_{11}$ from the inflated tissue", axes.get_xlabel()
assert axes.get_ylabel() == "effective stress $P$ (MPa) per area of the inflated tissue", axes.get_ylabel()
rows = list(csv.DictReader(open("apple.csv")))
for line in axes.lines:
    if line.get_label().startswith("$P_"):
        column = f"P{line.get_label()[4:6]} (MPa)"
        assert np.allclose(line.get_xdata(), [float(row["F11"]) for row in rows], atol=1e-9)
        assert np.allclose(line.get_ydata(), [float(row[column]) for row in rows], atol=1e-9), column
texts = [text.get_text() for text in drawn.findobj(match=lambda one: hasattr(one, "get_text"))]
assert any("from the inflated tissue" in text and "$F$ = [" in text for text in texts), texts
PYTHON
fi

# without readings the object is not there, and the table has the states alone
expect 0 "$lamella" rve "$source/tests/scenes/shear-bonded.yaml" --json -o shear.h5
grep -q '"test"' out.txt && fail "readings that nobody asked for"
head -1 shear.csv | grep -qE 'strain|stress|modulus|poisson|energy' && fail "a curve that nobody asked for"
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

# one test by three commands: strain from the inflated tissue, stress per area of it
pull='F: [[1.1, 0], [0, free]], P: [[x, x], [x, 0 MPa]]'
tissue turgor='pressure: 0.1 MPa' mesh='along: 4, through: 1' >tissue.yaml </dev/null
cat tissue.yaml - >rve.yaml <<YAML
load: [{inflate: true, reference: inflated}, {ramp: {to: [[1.1, 0], [0, free]], P: [[x, x], [x, 0 MPa]], steps: 10}}]
YAML
cat tissue.yaml - >point.yaml <<YAML
process: {reference: inflated, output: 1 s, program: [{for: 5 s}, {for: 10 s, $pull}]}
YAML
# body REFERENCE: pulled by a tenth of its inflated width
body() {
  cat tissue.yaml - <<YAML
macro:
  mesh: {box: [10 mm, 10 mm], elements: [1, 1]}
  reference: $1
  boundary: [{on: left, symmetry: true}, {on: bottom, symmetry: true}, {on: right, displacement: [$width mm, free]}]
  steps: 10
YAML
}
expect 0 "$lamella" rve rve.yaml --json --at 0.05 --no-estimate
tail -1 out.txt >rve.json
width=$(sed 's/.*"F_inflated": \[\([0-9.]*\).*/\1/' rve.json)
expect 0 "$lamella" process point.yaml --json --at 0.05
tail -1 out.txt >point.json
tail -2 out.txt | head -1 >state.json
body inflated >body.yaml
expect 0 "$lamella" fe2 body.yaml --json --at 0.05 -o body.h5
tail -1 out.txt >body.json
body rest >rest.yaml
expect 0 "$lamella" fe2 rest.yaml --json --readings
tail -1 out.txt >rest.json
(cat body.yaml; echo 'process: {output: 1 s, program: [{for: 5 s}, {for: 10 s, load: 1}]}') >held.yaml
expect 0 "$lamella" process held.yaml --json --at 0.05
tail -1 out.txt >held.json
expect 0 "$lamella" info body.h5 --json
/usr/bin/python3 - <<'PYTHON' || fail "three commands do not read the same: $(cat rve.json point.json body.json held.json rest.json)"
import json
read = {name: json.load(open(name + ".json"))["test"] for name in ("rve", "point", "body", "held", "rest")}
rve = read["rve"]
near = lambda a, b, t: abs(a - b) <= t * abs(b)
for name in ("point", "body", "held"):
    test = read[name]
    assert test["reference"] == "inflated" and near(test["F_inflated"][0], rve["F_inflated"][0], 1e-5), name
    assert near(test["peak"]["strain"], 0.1, 1e-5) and near(test["peak"]["stress"], rve["peak"]["stress"], 1e-4), name
    assert near(test["at"][0]["stress"], rve["at"][0]["stress"], 1e-4), name
    assert near(test["work"], rve["work"], 5e-3) and near(test["modulus"], rve["modulus"], 2e-2), name
assert near(read["point"]["poisson"], rve["poisson"], 1e-2)
assert near(read["rest"]["peak"]["stress"], rve["peak"]["stress"] * rve["F_inflated"][0], 1e-4)
state = json.load(open("state.json"))["from_inflated"]
assert near(state["F"][0], 1.1, 1e-9) and near(state["P"][0], read["point"]["peak"]["stress"], 1e-9)
kept = json.load(open("out.txt"))["summary"]["test"]
assert kept["peak"] == read["body"]["peak"]
PYTHON
expect 0 -o '^test: force on right over its displacement, both over edges of the box' -o 'at 0.05: stress' "$lamella" fe2 body.yaml --at 0.05
expect 0 -o '^test: P11 over F11 - 1, from the inflated tissue' "$lamella" process point.yaml --readings

# a stress that a process prescribes is per that area, too
cat tissue.yaml - >creep.yaml <<'YAML'
process: {reference: inflated, output: 5 s, program: [{for: 5 s, F: [[free, 0], [0, free]], P: [[0.02 MPa, x], [x, 0 MPa]]}]}
YAML
expect 0 -o '"from_inflated": {"F": \[[^]]*\], "P": \[0.0\(2\|1999999999\)[0-9]*, ' "$lamella" process creep.yaml --json

# the picture marks the peak of cells that come apart
tissue interface='law: contact, cohesion: 0.05 MPa' >apart.yaml <<'YAML'
load: [{inflate: true}, {ramp: {to: [[1.4, 0], [0, free]], P: [[x, x], [x, 0 MPa]], steps: 6}}]
YAML
expect 0 -o '^  peak 0.0' "$lamella" rve apart.yaml --no-estimate -o apart.h5
expect 0 "$lamella" plot --dpi 40 apart.h5 -o apart.svg
grep -q '<!-- peak -->' apart.svg || fail "the picture does not mark the peak"
