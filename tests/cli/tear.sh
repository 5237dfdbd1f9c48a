# lamella tear: its table, the balance of its energies, what turgor changes, and what it refuses.
. "$(dirname "$0")/common.sh"

brittle='law: lamella, strength: 0.02 MPa, fracture_energy: 0.1 J/m^2'
# on 6 elements along a face, which is coarse: a warning says so
tissue interface="$brittle" mesh='along: 6, through: 1' >scene.yaml </dev/null

expect 0 -o 'the layer comes apart' -o '^2 curves' -e 'do not resolve' "$lamella" tear scene.yaml --turgor "0,0.02 MPa" --modes opening --steps 80 -o law.csv
expect 0 "$lamella" tear scene.yaml --turgor "0, 20 kPa" --modes opening --steps 80 --json -o again.csv
cmp -s law.csv again.csv || fail "the table depends on what is printed"
/usr/bin/python3 - <<'PYTHON' || fail "the curves: $(grep curve out.txt)"
import csv, json
objects = [json.loads(line) for line in open("out.txt")]
points, curves = [o for o in objects if "curve" not in o], [o["curve"] for o in objects if "curve" in o]
rows = list(csv.DictReader(open("law.csv")))
assert list(rows[0]) == ["mode", "turgor (MPa)", "separation (um)", "traction (MPa)", "crack_separation (um)", "dilation (um)",
                         "work (J/m^2)", "stored (J/m^2)", "dissipated (J/m^2)", "released (J/m^2)", "broken_fraction",
                         "dissipated_walls (J/m^2)", "burst_fraction", "F11",
                         "F12", "F22", "jumped"], list(rows[0])
assert len(rows) == len(points) == sum(c["states"] for c in curves)
for row, point in zip(rows, points):
    assert abs(float(row["traction (MPa)"]) - point["traction"]) < 1e-12 and row["mode"] == point["mode"] == "opening"
assert [c["turgor"] for c in curves] == [0, 0.02] and all(c["end"] == "apart" for c in curves)
for c in curves:
    own = [p for p in points if p["turgor"] == c["turgor"]]
    F0, last = own[0], own[-1]
    height = 75 * 3 ** 0.5
    # the separation is that of the layer, and the traction does its work
    assert all(abs(p["separation"] - height * (p["F22"] - F0["F22"])) < 1e-6 and p["F11"] == F0["F11"] for p in own)
    integral = sum((p["traction"] + q["traction"]) / 2 * (q["separation"] - p["separation"]) for p, q in zip(own, own[1:]))
    assert abs(integral - last["work"]) < 0.005 * last["work"], (integral, last["work"])
    # the balance; what jumps lose is never gained, up to the error of the trapezoidal rule on coarse steps
    for p, q in zip(own, own[1:]):
        assert abs(q["work"] - q["stored"] - q["dissipated"] - q["released"]) < 1e-12
        assert q["dissipated"] >= p["dissipated"] - 1e-12 and q["released"] > p["released"] - 0.015 * last["work"]
    assert abs(c["energy"] - last["dissipated"] - last["released"]) < 1e-12 and c["work"] == last["work"]
    # the law of the crack alone spends what the layer does, up to the same rule: 2 % on steps four times as long
    assert abs(c["law_energy"] - last["work"]) < 0.005 * last["work"], (c["law_energy"], last["work"])
    assert abs(c["straight_crack_energy"] * F0["F11"] - 0.1 * 2 / 3 ** 0.5) < 1e-9
    assert c["strength"] == max(p["traction"] for p in own)
    assert 0.8 * c["straight_crack_energy"] < c["energy"] < 3 * c["straight_crack_energy"]
dry, turgid = curves
assert turgid["strength"] < 0.8 * dry["strength"] and turgid["work"] < turgid["energy"]
PYTHON

# in shear nothing presses on the layer, which rises
expect 0 -o '^shear under a turgor of 0.02 MPa' -o 'still holds' "$lamella" tear scene.yaml --modes shear --separation "20 um" --steps 6 -o shear.csv
/usr/bin/python3 - <<'PYTHON' || fail "the curve in shear: $(cat shear.csv)"
import csv
rows = list(csv.DictReader(open("shear.csv")))
assert len(rows) == 7 and abs(float(rows[-1]["separation (um)"]) - 20) < 1e-9
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
