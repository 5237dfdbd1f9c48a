# slow: lamella sensitivity: rows that are missing, elasticities that dimensions tell, samples without an answer;
# files, the picture, mistakes.
. "$(dirname "$0")/common.sh"
package scipy

tissue turgor='pressure: 0.02 MPa' >scene.yaml <<'END'
load: [{inflate: true}, {ramp: {to: [[1.2, 0], [0, 1]], steps: 3}}]
uncertain:
  - {key: rve.wall.C1, from: 0.05 MPa, to: 0.2 MPa, mean: 0.1 MPa, deviation: 0.02 MPa}
  - {key: rve.turgor.pressure, from: 5 kPa, to: 50 kPa}
END
expect 0 -o "modulus: 0.28.* MPa at the scene's values; mean " -o "^  rve.wall.C1 .* 0\.[0-9]* ± " -o "^  sum " \
  -o "^no key changes it: peak.strain 0.2" "$lamella" sensitivity scene.yaml --evaluations 40 -o folder --figure modulus,peak.strain
expect 0 "$lamella" sensitivity scene.yaml --evaluations 40 --json --processes 1 --figure peak.strain,modulus
cmp -s out.txt folder/sensitivity.json || fail "--json is not the file: $(cat out.txt)"

cat >check.py <<'PYTHON'
import csv, json
import numpy as np
import lamella
from lamella.measured import read_off
from lamella.sensitivity import Figure, study
from lamella.sobol import points, rows_for, sobol
from known_functions import ishigami
from raises import raises

# rows with NaN are left out as if they had not been there; of a constant, and of too few rows, there are no indices
u = points(3, 256)
values = ishigami(u)
assert u.shape == (1280, 3) and rows_for(3, 1280) == 256 and rows_for(8, 1000) == 128 and rows_for(8, 3) == 1
hole = np.where(np.arange(1280) == 3 * 256 + 9, np.nan, values)  # of row 9
assert np.allclose(sobol(hole, 3).total, sobol(np.delete(values.reshape(5, 256), 9, 1).ravel(), 3).total)
assert sobol(np.full(1280, 3.0) + 1e-12 * values, 3) is None and sobol(np.full(25, np.nan), 3) is None
few, many = (Figure("modulus", "MPa", np.where(np.arange(1280) % n == 0, np.nan, values), 3, 0) for n in (64, 10))
assert few.missing == 20 and few.indices.rows == 256 - 4 and few.reason == "", few.indices.rows
assert many.indices is None and many.reason == "128 of 1280 evaluations have none: too many for indices"

# the files
told = json.load(open("folder/sensitivity.json"))
rows = list(csv.DictReader(open("folder/samples.csv")))
assert told["lamella_sensitivity"] == 1 and told["evaluations"] == len(rows) == 4 * told["rows"] == 32
assert [f["name"] for f in told["figures"]] == ["modulus", "peak.strain"] and told["figures"][1]["reason"] == "no key changes it"
modulus = told["figures"][0]
of = sobol([float(row["modulus (MPa)"]) for row in rows], 2)
assert np.allclose(modulus["first"], of.first) and np.allclose(modulus["total_interval"], of.total_interval)
assert all(5 <= float(row["rve.turgor.pressure (kPa)"]) <= 50 for row in rows) and rows[-1]["block"] == "rve.turgor.pressure"
assert np.isclose(modulus["mean"], np.mean([float(row["modulus (MPa)"]) for row in rows if row["block"] in "AB"]))

# stresses scale with all stresses of a tissue together, and with no length; strains with none; at an end of the bounds, too
scene = lamella.scene_dict("scene.yaml")
stresses = {"wall.C1": ("0.05 MPa", "0.2 MPa"), "wall.C2": ("0.01 MPa", "0.02 MPa"), "wall.C4": ("0.5 MPa", "1 MPa"),
            "turgor.pressure": ("5 kPa", "50 kPa")}
lengths = {"cell.apothem": ("60 um", "90 um"), "cell.wall_thickness": ("11.25 um", "15 um")}
scene["uncertain"] = [{"key": f"rve.{key}", "from": low, "to": high} for key, (low, high) in (stresses | lengths).items()]
figures = study(scene, 32, processes=1).figures
for name in "modulus", "peak.stress", "energy_to_peak":
    e = figures[name].elasticity
    assert abs(e[:4].sum() - 1) < 1e-5 and abs(e[4:].sum()) < 1e-5 and e[2] > 0.1 and not figures[name].is_rough(2), (name, e)
assert np.allclose(figures["peak.strain"].elasticity, 0, atol=1e-9)

# keys whose bounds are not above 0: over the width of the bounds. d modulus / d dispersion by hand
scene["rve"]["wall"] = {"law": "fibre_exponential", "C1": "0.1 MPa", "C2": "0.01 MPa", "k1": "0.4 MPa", "k2": 3, "dispersion": 0.1}
scene["uncertain"] = [{"key": "rve.wall.dispersion", "from": 0, "to": 0.3}]
told = study(scene, 12, ["modulus"], processes=1)
at = [read_off(scene | {"rve": scene["rve"] | {"wall": scene["rve"]["wall"] | {"dispersion": d}}})["modulus"] for d in (0.1, 0.1001, 0.0999)]
assert np.isclose(told.figures["modulus"].elasticity[0], 0.3 * (at[1] - at[2]) / 2e-4 / at[0], rtol=1e-3)
assert "*: bounds or value not above 0" in str(told), told

# a test that does not come to its end has no peak and no work
scene["load"] = [{"ramp": {"to": [[0.5, 0], [0, 0.5]], "steps": 4}}]
assert set(read_off(scene)) <= {"modulus", "poisson"}, read_off(scene)
scene["load"] = [{"F": [[1, 0], [0, 1]]}]
raises(lamella.InputError, "no figures", lambda: study(scene, 12, processes=1))

# mistakes
scene = lamella.scene_dict("scene.yaml")
thick = [{"key": "rve.cell.wall_thickness", "from": "5 um", "to": "900 um"}]
for of, asked, figures, why in (({key: scene[key] for key in scene if key != "uncertain"}, 16, None, "has no block `uncertain`"),
                                (scene, 16, ["failure.factor"], "failure.factor: scene tells no failure"),
                                (scene, 4, None, "4 evaluations are too few for 2 keys: give at least 16"),
                                (scene | {"uncertain": thick}, 16, None, "um); give bounds within which all scenes are possible")):
    raises(lamella.InputError, why, lambda: study(of, asked, figures, processes=1))
PYTHON
"$python" check.py || fail "the numbers"

# how the tissue fails
sed '/^load/,$d' scene.yaml >fails.yaml
cat >>fails.yaml <<'END'
strength: {wall: 0.5 MPa, lamella_normal: 0.1 MPa}
load: [{ramp: {to: [[1.25, 0], [0, 0.95]], steps: 2}}]
uncertain:
  - {key: strength.wall, from: 0.1 MPa, to: 1 MPa}
  - {key: strength.lamella_normal, from: 0.01 MPa, to: 0.2 MPa}
END
expect 0 -o "^mode of failure: separation at the scene's values; of the samples .*%.*; indices of " \
  "$lamella" sensitivity fails.yaml --figure failure.mode --evaluations 16 -o fails
has fails/samples.csv "^row,block,strength.wall (MPa),strength.lamella_normal (MPa),mode$" "^0,A,.*,\(separation\|rupture\)$"

if "$python" -c 'import matplotlib' 2>/dev/null; then
  expect 0 "$lamella" plot fails/sensitivity.json -o p.svg --x -0.1,1.1 --title "What matters"
  has p.svg "^<svg"
  echo '{"lamella_sensitivity": 1}' >broken.json
  expect 2 -e "is not of lamella sensitivity" "$lamella" plot broken.json
fi

# mistakes
expect 2 -e "stiffness: is no figure; there are modulus, " "$lamella" sensitivity scene.yaml --figure modulus,stiffness
expect 4 -e "scene.yaml/no: cannot be made" "$lamella" sensitivity scene.yaml -o scene.yaml/no
mkdir -p taken/samples.csv
expect 2 -e "taken/samples.csv: exists and is a folder" "$lamella" sensitivity scene.yaml --evaluations 16 --figure modulus -o taken
[ ! -e taken/sensitivity.json ] || fail "a part of the files is there"
