# lamella rve: stress prescribed in place of components of F.
. "$(dirname "$0")/common.sh"

# the example: the stresses are those prescribed, F is what was found, and the ramp goes on from there
expect 0 "$lamella" rve "$source/tests/scenes/uniaxial.yaml" --json -o out.h5
[ "$(grep -c '"P_prescribed": \[0.0, 0.0, null, null' out.txt)" -eq 7 ] || fail "no prescribed stress: $(cat out.txt)"
if /usr/bin/python3 -c 'import json' 2>/dev/null; then
  /usr/bin/python3 - <<'PYTHON' || fail "the states are not as prescribed: $(cat out.txt)"
import json
states = [json.loads(line) for line in open("out.txt")]
for s in states:
    for P, given in zip(s["P"], s["P_prescribed"]):
        assert given is None or abs(P - given) < 1e-9
    assert s["F"][3] == 0 and s["status"] == "converged"
F22 = [s["F"][4] for s in states]
assert 1.03 < F22[0] < 1.06 and F22[5] == F22[6] == 1.3
assert all(abs(F22[k] - (F22[0] + k * (1.3 - F22[0]) / 5)) < 1e-12 for k in range(6))
assert states[5]["F"][8] == 1 and states[6]["F"][8] > 1.05
PYTHON
fi
expect 0 "$lamella" info out.h5

# F alone has no prescribed stress
expect 0 "$lamella" rve "$source/tests/scenes/shear-bonded.yaml" --json
grep -q P_prescribed out.txt && fail "a prescribed stress that nobody prescribed"

# a stress that nothing carries: F is not known, and the next state starts from the last answer
tissue turgor='mode: none' mesh='along: 6, through: 2' >scene.yaml <<'YAML'
load:
  - {F: [[free, free], [0, free]], P: [[0 MPa, 0 MPa], [x, -0.05 MPa]]}
  - {F: [[free, 0.1], [0, free]], P: [[0 MPa, x], [x, 0 MPa]]}
YAML
expect 3 "$lamella" rve scene.yaml --json -o failed.h5
sed -n 1p out.txt | grep -q '"F": \[null, null, 0.0, 0.0, null,' || fail "a free F without answer: $(sed -n 1p out.txt)"
sed -n 1p out.txt | grep -q '"reason": "[^"]' || fail "no reason: $(sed -n 1p out.txt)"
sed -n 2p out.txt | grep -q '"status": "converged"' || fail "the second state: $(sed -n 2p out.txt)"
"$lamella" info failed.h5 --json | grep -q '"failed": 1' || fail "the failed state is not on disk"
expect 3 "$lamella" rve scene.yaml
grep -qE '^ +1 +- +- +0.0000 +- ' out.txt || fail "the table shows an F that is not known: $(cat out.txt)"

# separation, the second mesh at the F that the first has found
tissue interface='law: contact, cohesion: 0.02 MPa' mesh='along: 6, through: 2' >contact.yaml <<'YAML'
load:
  - {F: [[1, free], [0, free]], P: [[x, 0 MPa], [x, -0.01 MPa]]}
YAML
expect 0 -o '"separated": [tf]' -o '"error_estimate": 0.0' "$lamella" rve contact.yaml --json --second-mesh
