# slow: lamella rve and process --uncertainty: quantiles of samples, of responses that are known; counts; samples without an
# answer; refusals; pictures.
. "$(dirname "$0")/common.sh"
package scipy

tissue mesh='along: 4, through: 1' >one.yaml <<'YAML'
strength: {lamella_normal: 0.05 MPa}
load: [{F: [[1.02, 0], [0, 1]]}, {ramp: {to: [[1.2, 0], [0, 1]], steps: 2}}]
uncertain: [{key: rve.wall.C4, from: 0.5 MPa, to: 2 MPa}]
YAML
expect 0 -o "the least and the largest; an interval of 95 % takes 40" "$lamella" rve one.yaml --uncertainty 5 --failure -o five
tissue cell='apothem: 75 um, wall_thickness: 11.25 um' >rots.yaml <<'YAML'
strength: {lamella_normal: 0.1 MPa}
process:
  duration: 4 h
  output: 2 h
  kinetics: [{of: lamella, law: first_order, rate: 0.5 /h}]
uncertain: [{key: process.kinetics.0.rate, from: 0.1 /h, to: 2 /h}, {key: strength.lamella_normal, from: 0.05 MPa, to: 0.2 MPa}]
YAML
expect 0 -o "^first event:" -o "^  lamella_normal  .* h " -o "^40 samples of 2 keys: from ... to holds 95 %" \
  "$lamella" process rots.yaml --uncertainty 40 -o rots

# what F and P count from is named, in the table, the file and the picture
tissue mesh='along: 4, through: 1' >inflated.yaml <<'YAML'
load: [{inflate: true, reference: inflated}, {ramp: {to: [[1.1, 0], [0, 1]], steps: 2}}]
uncertain: [{key: rve.wall.C4, from: 0.5 MPa, to: 2 MPa}]
YAML
expect 0 -o "^F from the inflated tissue$" -o "^P per area of the inflated tissue$" "$lamella" rve inflated.yaml --uncertainty 3 -o inflated
has inflated/uncertainty.json '"reference": "inflated"'
expect 0 "$lamella" plot inflated/uncertainty.json -o inflated.svg
has inflated.svg 'from the inflated tissue' 'per area of the inflated tissue'

# walls that leave no lumen: a sample that has no answer is told and left out
sed 's/^uncertain.*/uncertain: [{key: rve.cell.wall_thickness, from: 10 um, to: 200 um}]/' one.yaml >thick.yaml
expect 3 -o '"reason": "rve.cell.wall_thickness' "$lamella" rve thick.yaml --uncertainty 4 -o thick --json --processes 1

"$python" - <<'PYTHON' || fail "the numbers"
import json
import numpy as np
import lamella
from lamella import uncertainty
from lamella.parameters import Parameter

# one key: the band of a figure is the figure of the key's band; the samples are solved again one by one
told = json.load(open("five/uncertainty.json"))
key, axis, figures = told["parameters"][0], told["axis"], {f["name"]: f for f in told["figures"]}
assert np.allclose(sorted(key["values"]), 0.5 * 4 ** (np.arange(0.5, 5) / 5)) and key["scene"] == 1, key
scene = lamella.scene_dict("one.yaml")
def solved(C4):
    rve = lamella.RVE(scene | {"rve": scene["rve"] | {"wall": scene["rve"]["wall"] | {"C4": f"{C4!r} MPa"}}})
    return rve.solve().P[:, 0, 0] / 1e6, rve.readings["modulus"]
assert axis["name"] == "F11" and np.allclose(axis["values"], [1.02, 1.11, 1.2]) and [s["name"] for s in told["series"]] == ["P11"]
for part, C4 in zip(("low", "median", "high", "scene"), (*np.sort(key["values"])[[0, 2, 4]], 1.0)):
    P, modulus = solved(float(C4))
    assert np.allclose(told["series"][0][part], P, rtol=1e-6), (part, told["series"], P)
    assert np.isclose(figures["modulus"][part], modulus, rtol=1e-6), (part, figures["modulus"], modulus)
factor = figures["failure.factor"]
assert factor["count"] == 5 and factor["low"] < factor["median"] < factor["high"], factor
assert [(e["name"], e["samples"]) for e in told["first"]["events"]] == [("separation, lamella_normal", 5)], told["first"]

# quantiles: exact where the response is linear in the place between the bounds
q = (np.random.default_rng(1).permutation(64) + 0.5) / 64
band = uncertainty.band(3 + 2 * q)
assert np.allclose([band[p] for p in ("low", "median", "high")], [3.05, 4, 4.95]) and band["count"] == 64, band
few = uncertainty.band(np.array([5.0, np.nan, 1, 3]))
assert few == {"low": 1, "median": 3, "high": 5, "count": 3} and uncertainty.band(np.array([np.nan]))["median"] is None
prior = uncertainty.sample([Parameter("k", 0.0, 10.0, (4.0, 1.0)), Parameter("m", "1 MPa", "4 MPa")], 400)
band = uncertainty.band(prior[:, 0])
assert np.allclose([band[p] for p in ("low", "median", "high")], (2.04, 4, 5.96), atol=0.002), band
assert abs(np.median(prior[:, 1]) - 2) < 0.01 and abs(np.corrcoef(prior.T)[0, 1]) < 0.02  # keys are independent

# the lamella decays as exp(-k t): strength over stress gives the time
told = json.load(open("rots/uncertainty.json"))
rate, strength = (np.array(p["values"]) for p in told["parameters"])
first = told["first"]
ratio = {s["name"]: s for s in told["series"]}["lamella_normal_ratio"]["scene"][0]  # of 0.1 MPa
expected = np.maximum(3600 * np.log(strength / (0.1 * ratio)) / rate, 0)
at = np.array([np.nan if v is None else v for v in first["at"]])
known = np.isfinite(at)
assert np.array_equal(known, expected < 4 * 3600) and np.allclose(at[known], expected[known], rtol=1e-3, atol=2), (at, expected)
assert [e["samples"] for e in first["events"] if e["name"] == "lamella_normal"] == [known.sum()]
assert {s["name"] for s in told["series"]} == {"lamella_normal_ratio"}, told["series"]  # nothing else changes

told = json.load(open("thick/uncertainty.json"))
assert len(told["answered"]) + len(told["failed"]) == 4 and told["series"][0]["count"] == [len(told["answered"])] * 3
PYTHON

if "$python" -c 'import matplotlib' 2>/dev/null; then
  for folder in five rots; do
    expect 0 "$lamella" plot --dpi 40 $folder/uncertainty.json -o $folder.png
    [ -s $folder.png ] || fail "no picture"
  done
  expect 2 -e "is drawn as a whole" "$lamella" plot --dpi 40 five/uncertainty.json --state 1
  echo '{"lamella_uncertainty": 1}' >broken.json
  expect 2 -e "is not of lamella rve or process --uncertainty" "$lamella" plot broken.json
fi

# refusals
sed /^uncertain/d one.yaml >known.yaml
expect 2 -e "known.yaml: has no block .uncertain" "$lamella" rve known.yaml --uncertainty 5
expect 2 -e "rots.yaml: has no block .load" "$lamella" rve rots.yaml --uncertainty 5
sed 's/key: rve.wall.C4/key: rve.wall.C9/' one.yaml >wrong.yaml
expect 2 -e "wrong.yaml:.*rve.wall.C9" "$lamella" rve wrong.yaml --uncertainty 5
expect 1 -e "a whole number from 2 on" "$lamella" rve one.yaml --uncertainty 1
expect 1 -e "--tangent does not go with --uncertainty" "$lamella" rve one.yaml --uncertainty 5 --tangent
expect 1 -e "--realisations does not go with --uncertainty" "$lamella" rve one.yaml --uncertainty 5 --realisations 2
expect 1 -e "--database does not go with --uncertainty" "$lamella" process rots.yaml --uncertainty 5 -d d.h5
expect 1 -e "--processes is of --uncertainty N" "$lamella" process rots.yaml --processes 2
expect 1 -e "--processes is of --realisations N or --uncertainty N" "$lamella" rve one.yaml --processes 2
