# the curves of fe2: OUT.csv holds what --json tells and the file holds, summary and info agree with them
. "$(dirname "$0")/common.sh"
set -e
/usr/bin/python3 -c 'import h5py' 2>/dev/null || exit 77

tissue >block.yaml <<'YAML'
strength: {wall: 0.2 MPa, lamella_normal: 1 MPa}
macro:
  mesh: {box: [8 mm, 4 mm], elements: [2, 1]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [free, 0.8 mm]}]
  steps: 2
YAML
"$lamella" fe2 block.yaml --json -o out.h5 >steps.jsonl
"$lamella" fe2 block.yaml >table.txt
"$lamella" info out.h5 --json >info.json
[ -z "$(ls | grep tmp || true)" ] || fail "files are left behind: $(ls)"
grep -q "rupture *wall at load factor" table.txt || fail "the table does not end with a summary: $(cat table.txt)"
/usr/bin/python3 - <<'PYTHON' || fail "curves, summary and file do not agree"
import csv, json
import h5py, numpy as np
steps = [json.loads(line) for line in open("steps.jsonl")]
rows = list(csv.DictReader(open("out.csv")))
assert [int(row["step"]) for row in rows] == [0, 1, 2]
for row, step in zip(rows, steps):
    for name in "load_factor", "debonded_fraction", "newton_iterations", "cutbacks", "queries", "hits", "solves", "failures":
        assert float(row[name]) == step[name], name
    for side in "top", "bottom":
        for i in 0, 1:
            assert np.isclose(float(row[f"{side} R{i + 1} (N/mm)"]), step["reaction"][side][i], rtol=1e-11, atol=1e-15)
    assert row["top u1 (mm)"] == "" and np.isclose(float(row["top u2 (mm)"]), 0.8 * step["load_factor"])
    assert row["face_unloading_max"] == "" # of bonded tissue
with h5py.File("out.h5") as h5:
    curve = h5["macro/curve"]
    assert curve["reaction"].attrs["unit"] in ("N/mm", b"N/mm")
    wall = np.array([h5[f"macro/step/{k}/wall_tension_max"][()].max() for k in range(3)])
    assert np.allclose(curve["wall_tension_max"], wall)
    assert np.allclose([float(row["wall_tension_max (MPa)"]) for row in rows], wall)
    u, R = curve["displacement"][:, 1, 1], curve["reaction"][:, 1, 1]
    summary = json.loads(h5["macro/summary"][()])
# walls reach 0.2 MPa between the steps, at a point whose tension is at least as large as the largest one interpolated
onset = summary["rupture"]
assert summary["separation"] is None and summary["criteria"]["lamella_normal"] is None
k = onset["step"]
assert wall[k - 1] < 0.2 <= wall[k]
at = k - 1 + (0.2 - wall[k - 1]) / (wall[k] - wall[k - 1])
assert abs(onset["load_factor"] - at / 2) < 0.02, (onset, at)
assert np.isclose(onset["reaction"], np.interp(onset["displacement"], u, R))
assert np.isclose(summary["stiffness"]["secant"], (R[2] - R[0]) / (u[2] - u[0]))
assert np.isclose(summary["modulus"]["secant"], summary["stiffness"]["secant"] * 4 / 8)
assert np.isclose(summary["firmness"]["reaction"], R.max()) and summary["loaded"]["direction"] == [0, 1]
assert json.load(open("info.json"))["summary"] == summary
PYTHON
