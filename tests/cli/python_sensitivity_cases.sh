# slow: lamella sensitivity of a bonded scene with eight keys and about 300 evaluations. The indices are of the
# intervals of another seed, dimensions hold for elasticities, of load factors of failure, too.
. "$(dirname "$0")/common.sh"
package scipy

tissue wall='law: fibre_exponential, C1: 0.1 MPa, C2: 0.02 MPa, k1: 0.4 MPa, k2: 3, dispersion: 0.1' \
  turgor='pressure: 0.02 MPa' >eight.yaml <<'END'
load: [{inflate: true}, {ramp: {to: [[1.2, 0], [0, 1]], steps: 6}}]
uncertain:
  - {key: rve.wall.C1, from: 0.05 MPa, to: 0.2 MPa}
  - {key: rve.wall.C2, from: 0.01 MPa, to: 0.04 MPa}
  - {key: rve.wall.k1, from: 0.2 MPa, to: 0.8 MPa, mean: 0.4 MPa, deviation: 0.1 MPa}
  - {key: rve.wall.k2, from: 1, to: 9}
  - {key: rve.wall.dispersion, from: 0, to: 0.3}
  - {key: rve.turgor.pressure, from: 5 kPa, to: 50 kPa}
  - {key: rve.cell.wall_thickness, from: 8 um, to: 15 um}
  - {key: rve.cell.apothem, from: 60 um, to: 90 um}
END
tissue turgor='pressure: 0.02 MPa' >fails.yaml <<'END'
strength: {wall: 0.5 MPa, lamella_normal: 0.1 MPa, lamella_shear: 0.05 MPa}
load: [{F: [[1.02, 0], [0, 1.02]]}, {ramp: {to: [[1.3, 0], [0, 0.95]], steps: 7}}]
uncertain:
  - {key: rve.wall.C1, from: 0.05 MPa, to: 0.2 MPa}
  - {key: rve.wall.C2, from: 0.005 MPa, to: 0.02 MPa}
  - {key: rve.wall.C4, from: 0.5 MPa, to: 2 MPa}
  - {key: rve.turgor.pressure, from: 5 kPa, to: 50 kPa}
  - {key: strength.wall, from: 0.2 MPa, to: 1 MPa}
  - {key: strength.lamella_normal, from: 0.02 MPa, to: 0.3 MPa}
  - {key: strength.lamella_shear, from: 0.02 MPa, to: 0.3 MPa}
END
expect 0 "$lamella" sensitivity eight.yaml -o one --evaluations 300
expect 0 "$lamella" sensitivity eight.yaml -o other --seed 1 --evaluations 600
expect 0 "$lamella" sensitivity fails.yaml -o fails --evaluations 300

"$python" - <<'PYTHON' || fail "the numbers"
import json
import numpy as np
one, other, fails = (json.load(open(f"{name}/sensitivity.json")) for name in ("one", "other", "fails"))
assert one["evaluations"] == 320 and other["evaluations"] == 640 and len(one["keys"]) == 8
for a, b in zip(one["figures"], other["figures"]):
    assert a["name"] == b["name"] and a["elasticity"] == b["elasticity"] and not a["missing"]
    if a["first"] is None:
        continue
    for name in "first", "total":  # intervals of both seeds overlap
        (low, high), (least, most) = np.array(a[f"{name}_interval"]).T, np.array(b[f"{name}_interval"]).T
        assert ((low <= most) & (least <= high)).mean() > 0.8, (a["name"], name)
    assert np.array(a["total"]).min() >= 0 and 0.5 < sum(a["first"]) < 1.3, a
    stresses, lengths = np.array(a["elasticity"])[[0, 1, 2, 5]].sum(), np.array(a["elasticity"])[6:].sum()
    assert np.isclose(stresses, 1, atol=1e-4) and abs(lengths) < 1e-4, (a["name"], stresses, lengths)
figures = {figure["name"]: figure for figure in fails["figures"]}
assert abs(sum(figures["failure.factor"]["elasticity"])) < 0.03, figures["failure.factor"]
assert abs(sum(figures["peak.stress"]["elasticity"]) - 1) < 1e-4
shares = fails["mode"]["shares"]
assert abs(sum(shares.values()) - 1) < 1e-12 and {"separation", "rupture"} <= set(shares), shares
assert fails["mode"]["own"] == "separation" and fails["mode"]["indices"]["total"][5] > 0.3
assert max(fails["mode"]["indices"]["total"][0:2]) < 0.5
PYTHON
