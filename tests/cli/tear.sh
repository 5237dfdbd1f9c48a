# lamella tear: its table, the balance of its energies, what turgor changes, and what it refuses.
. "$(dirname "$0")/common.sh"

brittle='law: lamella, strength: 0.02 MPa, fracture_energy: 0.1 J/m^2'
# on 4 elements along a face, which is coarse: a warning says so
tissue interface="$brittle" mesh='along: 4, through: 1' >scene.yaml </dev/null

for steps in 10 30; do
  expect 0 -o 'the layer comes apart' -o '^2 curves' -e 'do not resolve' "$lamella" tear scene.yaml --turgor "0,0.02 MPa" --modes opening --steps $steps -o law$steps.csv
  if grep -q 'warning' out.txt; then fail "its energies are not balanced: $(cat out.txt)"; fi
done
expect 0 "$lamella" tear scene.yaml --turgor "0, 20 kPa" --modes opening --steps 10 --json -o again.csv
cmp -s law10.csv again.csv || fail "the table depends on what is printed"
/usr/bin/python3 - <<'PYTHON' || fail "the curves: $(grep curve out.txt)"
import csv, json
objects = [json.loads(line) for line in open("out.txt")]
points, curves = [o for o in objects if "curve" not in o], [o["curve"] for o in objects if "curve" in o]
rows = list(csv.DictReader(open("law10.csv")))
assert list(rows[0]) == ["mode", "turgor (MPa)", "separation (um)", "traction (MPa)", "crack_separation (um)", "dilation (um)",
                         "work (J/m^2)", "stored (J/m^2)", "dissipated (J/m^2)", "released (J/m^2)", "broken_fraction",
                         "dissipated_walls (J/m^2)", "burst_fraction", "F11",
                         "F12", "F22", "jumped"], list(rows[0])
assert len(rows) == len(points)
for row, point in zip(rows, points):
    assert abs(float(row["traction (MPa)"]) - point["traction"]) < 1e-12 and row["mode"] == point["mode"] == "opening"
assert [c["turgor"] for c in curves] == [0, 0.02] and all(c["end"] == "apart" for c in curves)
for c in curves:
    own = [p for p in points if p["turgor"] == c["turgor"]]
    states = [p for p in own if p["work"] is not None]
    F0, last = states[0], states[-1]
    height = 75 * 3 ** 0.5
    assert len(states) == c["states"]
    # the separation is that of the layer
    assert all(abs(p["separation"] - height * (p["F22"] - F0["F22"])) < 1e-6 and p["F11"] == F0["F11"] for p in states)
    # each energy is computed by itself: what jumps lose is seen, and the sum is the work of the traction
    assert abs(c["imbalance"] - last["work"] + last["stored"] + c["energy"]) < 1e-12 and 0 < abs(c["imbalance"]) < 0.005 * c["energy"], c
    for p, q in zip(states, states[1:]):
        assert q["dissipated"] >= p["dissipated"] - 1e-12 and q["released"] >= p["released"]
        assert q["jumped"] == (q["released"] > p["released"]), q
    assert abs(c["energy"] - last["dissipated"] - last["released"]) < 1e-12 and c["work"] == last["work"]
    assert abs(c["straight_crack_energy"] * F0["F11"] - 0.1 * 2 / 3 ** 0.5) < 1e-9
    assert c["strength"] == max(p["traction"] for p in own)
    assert 0.8 * c["straight_crack_energy"] < c["energy"] < 3 * c["straight_crack_energy"]
dry, turgid = curves
assert turgid["strength"] < 0.8 * dry["strength"] and turgid["work"] < turgid["energy"]
assert any(p["work"] is None for p in points), "no jump is wide"

# lines between the rows do the work, over the separation and over the crack's part of it alike, on any steps
for name in ("law10.csv", "law30.csv"):
    rows = list(csv.DictReader(open(name)))
    for turgor in (0.0, 0.02):
        own = [r for r in rows if abs(float(r["turgor (MPa)"]) - turgor) < 1e-9]
        work = float(own[-1]["work (J/m^2)"])
        for of in ("separation (um)", "crack_separation (um)"):
            line = sum((float(p["traction (MPa)"]) + float(q["traction (MPa)"])) / 2 * (float(q[of]) - float(p[of])) for p, q in zip(own, own[1:]))
            assert abs(line - work) < 0.001 * work, (name, turgor, of, line, work)
PYTHON

# rigid cells: the two faces that a crack cuts open by D and nothing else does; the law of the lamella is that of the layer
tissue wall='law: fibre_mooney_rivlin, C1: 100 MPa, C2: 10 MPa, C4: 1000 MPa' turgor='mode: none' mesh='along: 6, through: 1' \
  interface='law: lamella, strength: 0.01 MPa, fracture_energy: 0.05 J/m^2' >rigid.yaml </dev/null
expect 0 "$lamella" tear rigid.yaml --modes opening --steps 10 --json --quiet
/usr/bin/python3 - <<'PYTHON' || fail "one interface: $(tail -1 out.txt)"
import json
objects = [json.loads(line) for line in open("out.txt")]
points, c = objects[:-1], objects[-1]["curve"]
share = 2 / 3 ** 0.5  # of faces per width
assert c["end"] == "apart" and c["released_share"] < 1e-4
for of in ("energy", "work", "law_energy"):
    assert abs(c[of] - 0.05 * share) < 0.003 * 0.05 * share, (of, c[of])
assert abs(c["strength"] - 0.01 * share) < 0.03 * 0.01 * share, c["strength"]
for p in points:
    if 0.4 < p["crack_separation"] < 9.9:
        assert abs(p["traction"] - 0.01 * share * (1 - p["crack_separation"] / 10)) < 0.01 * 0.01 * share, p
PYTHON

# cells whose walls burst give their fluid away: the traction alone does the work, and the sum is closed
tissue interface='law: lamella, strength: 0.05 MPa, fracture_energy: 0.5 J/m^2' turgor='mode: prescribed, pressure: 0.01 MPa' >burst.yaml <<'YAML'
strength: {wall: 0.2 MPa, wall_fracture_energy: 1 J/m^2}
YAML
expect 0 -o '100 % of the cells have burst' "$lamella" tear burst.yaml --modes opening --steps 10 -o burst.csv
/usr/bin/python3 - <<'PYTHON' || fail "bursts: $(cat burst.csv)"
import csv
rows = list(csv.DictReader(open("burst.csv")))
assert float(rows[-1]["burst_fraction"]) == 1
line = sum((float(p["traction (MPa)"]) + float(q["traction (MPa)"])) / 2 * (float(q["separation (um)"]) - float(p["separation (um)"])) for p, q in zip(rows, rows[1:]))
work, stored, dissipated, released = (float(rows[-1][f"{name} (J/m^2)"]) for name in ("work", "stored", "dissipated", "released"))
assert abs(line - work) < 0.005 * work, (line, work)
assert abs(work - stored - dissipated - released) < 0.02 * (dissipated + released)
PYTHON

# in shear nothing presses on the layer, which rises
expect 0 -o '^shear under a turgor of 0.02 MPa' -o 'still holds' "$lamella" tear scene.yaml --modes shear --separation "20 um" --steps 6 -o shear.csv
/usr/bin/python3 - <<'PYTHON' || fail "the curve in shear: $(cat shear.csv)"
import csv
rows = list(csv.DictReader(open("shear.csv")))
assert len(rows) >= 7 and abs(float(rows[-1]["separation (um)"]) - 20) < 1e-9
assert abs(float(rows[-1]["dilation (um)"])) > 0.5
assert max(float(r["traction (MPa)"]) for r in rows) > float(rows[-1]["traction (MPa)"])
PYTHON

expect 1 -e 'there are opening, shear' "$lamella" tear scene.yaml --modes bending
expect 1 -e 'ends in .csv' "$lamella" tear scene.yaml -o scene.yaml
expect 1 -e '--turgor "0.1": has no unit' "$lamella" tear scene.yaml --turgor 0.1
expect 1 -e 'must not be negative' "$lamella" tear scene.yaml --turgor "0,-0.1 MPa"
expect 1 -e 'is not a unit of length' "$lamella" tear scene.yaml --separation "1 MPa"
expect 1 -e 'must be above 0' "$lamella" tear scene.yaml --separation "0 um"
expect 4 "$lamella" tear scene.yaml -o no/such/folder.csv
for law in 'law: bonded' 'law: contact, cohesion: 0.001 MPa'; do
  tissue interface="$law" >other.yaml </dev/null
  expect 2 -e 'has no energy of fracture.*write law: lamella' "$lamella" tear other.yaml -o other.csv
done
[ ! -e other.csv ] && [ ! -e other.csv.tmp ] || fail "a run that is refused leaves a file behind"
tissue interface="$brittle" turgor='mode: sealed, pressure: 0.02 MPa' >other.yaml </dev/null
expect 2 -e 'write mode: prescribed' "$lamella" tear other.yaml
tissue interface="$brittle" >other.yaml <<'YAML'
  patch: {columns: 2, rows: 2}
YAML
expect 2 -e 'no layer that goes on to both sides' "$lamella" tear other.yaml
tissue interface="$brittle" cell='apothem: 75 um, wall_thickness: 11.25 um, orientation: 10 deg' >other.yaml </dev/null
expect 2 -e 'write a multiple of 30 deg' "$lamella" tear other.yaml

# a signal: what is complete is kept
"$lamella" tear scene.yaml --turgor "0.02,0,0,0,0,0,0,0 MPa" --modes opening --steps 20 --json -o stopped.csv >out.txt 2>err.txt &
pid=$!
until grep -q '"curve"' out.txt || ! kill -0 $pid 2>/dev/null; do sleep 0.01; done
ends TERM 143 $pid
has err.txt 'stopped: stopped.csv has what came before'
[ "$(wc -l <stopped.csv)" -gt 10 ] || fail "a stop loses what was complete"
