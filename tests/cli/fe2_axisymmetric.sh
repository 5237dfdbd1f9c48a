# axisymmetric bodies in fe2: the scenes of the documents, on coarse meshes; units of files; what is
# refused
. "$(dirname "$0")/common.sh"
set -e

sed 's/elements: \[3, 4\]/elements: [2, 2]/; s/steps: 6/steps: 3/' "$source/tests/scenes/potato-cylinder.yaml" >cylinder.yaml
sed 's/elements: \[6, 6\]/elements: [3, 3]/' "$source/tests/scenes/fruit-probe.yaml" >probe.yaml
for scene in cylinder probe; do
  "$lamella" fe2 $scene.yaml --response direct --json -o $scene.h5 >$scene.jsonl 2>/dev/null
done
/usr/bin/python3 - <<'PYTHON'
import csv, json, h5py, numpy as np
steps = [json.loads(line) for line in open("cylinder.jsonl")]
forces = [s["reaction"]["top"][1] for s in steps if "reaction" in s]
assert forces[0] == 0 or abs(forces[0]) < 1e-6, forces
assert forces[3] < 1.5 * forces[2] < 2 * forces[1] < 0, forces  # it stiffens
for s in steps[:4]:
    assert abs(s["reaction"]["top"][1] + s["reaction"]["bottom"][1]) < 1e-6, s["reaction"]
    assert -s["reaction"]["top"][0] <= -0.3 * s["reaction"]["top"][1] + 1e-6, s["reaction"]
with h5py.File("cylinder.h5") as f:
    text = lambda v: v.decode() if isinstance(v, bytes) else v
    assert text(f["macro/curve/reaction"].attrs["unit"]) == "N"
    assert text(f["macro/curve/work"].attrs["unit"]) == "N mm"
    summary = json.loads(text(f["macro/summary"][()]))
    assert summary["force_unit"] == "N" and abs(summary["modulus"]["area"] - np.pi * 7.5**2) < 1e-9, summary["modulus"]
    F = f["macro/step/3/F"][:]
    u = f["macro/step/3/u"][:]
    nodes = f["macro/nodes"][:]
    axis = nodes[:, 0] == 0
    assert abs(u[axis, 0]).max() < 1e-12
    assert F[:, 8].min() > 1.05, F[:, 8]  # it swells and bulges
assert "top R2 (N)" in next(csv.reader(open("cylinder.csv")))
probe = [json.loads(line)["reaction"]["probe"][1] for line in open("probe.jsonl") if "reaction" in json.loads(line)]
assert probe[3] < probe[2] < probe[1] < -1e-3 and abs(probe[-1]) < 1e-9, probe
PYTHON

# the summary has the unit, too
"$lamella" fe2 cylinder.yaml --response direct 2>/dev/null | tail -14 >whole.txt
grep -q "largest force .* N at u 3 mm" whole.txt || fail "the force has another unit: $(cat whole.txt)"

# refused: a database of plane strain; models of a lamella, which are of one F33
sed '/symmetry: axisymmetric/d; s/steps: 3/steps: 1/; s/symmetry: true/displacement: [0 mm, 0 mm]/' cylinder.yaml >plane.yaml
"$lamella" fe2 plane.yaml --response cache -d plane.h5 --quiet >/dev/null
"$lamella" fe2 cylinder.yaml --response cache -d plane.h5 2>plane.txt && fail "a table of plane strain is accepted"
grep -q "plane.h5: holds states of plane strain.*sample.F33" plane.txt || fail "no remedy: $(cat plane.txt)"
sed 's/{law: bonded}/{law: lamella, strength: 0.5 MPa, fracture_energy: 5 J\/m^2}/; s/mode: sealed, pressure/mode: prescribed, pressure/' cylinder.yaml >lamella.yaml
"$lamella" fe2 lamella.yaml --response cache 2>lamella.txt && fail "models of a lamella are accepted"
grep -q "choose --response direct" lamella.txt || fail "no remedy: $(cat lamella.txt)"
sed 's/symmetry: axisymmetric/symmetry: round/' cylinder.yaml >wrong.yaml
"$lamella" check wrong.yaml 2>wrong.txt && fail "an unknown symmetry is accepted"
grep -q "plane_strain" wrong.txt || fail "the names are not told: $(cat wrong.txt)"
"$lamella" check cylinder.yaml >/dev/null
