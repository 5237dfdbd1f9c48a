#!/usr/bin/env bash
# A database with a range of F33: built, joined, repaired and queried as others are, and of no meaning to plane strain.
. "$(dirname "$0")/common.sh"
serve=1
set -e -o pipefail

tissue >plane.yaml <<'YAML'
sample: {stretch: {min: 0, max: 0.1}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, count: 60}
YAML
sed 's/sample: {/sample: {F33: {min: 0.9, max: 1.15}, /' plane.yaml >s.yaml

# mistakes
sed 's/min: 0.9/min: 1.2/' s.yaml >bad.yaml
expect 2 -e 'sample.F33.min' -e 'min is larger than max' "$lamella" check bad.yaml
sed 's/min: 0.9/min: 1.15/' s.yaml >bad.yaml
expect 2 -e 'sample.F33.max' -e 'leave `F33` out for plane strain' "$lamella" check bad.yaml

# a file says its range
expect 0 -o 'sample' "$lamella" check s.yaml --json
expect 0 "$lamella" build s.yaml -d db.h5 --quiet
expect 0 -o 'grid of F33 *0.9 to 1.15' "$lamella" info db.h5
expect 0 -o '"F33": \[0.9' "$lamella" info db.h5 --json
expect 0 "$lamella" info db.h5 --check
expect 0 "$lamella" build plane.yaml -d plane.h5 --quiet
expect 0 "$lamella" info plane.h5 --json
if grep -q F33 out.txt; then fail "a file of plane strain has a range"; fi

# queries: within the range as a solve, outside with the reason
F="1.05 0.02 0 0 1.03 0 0 0 1.1"
P() { grep -oE '"P": \[.*' out.txt | head -n 1 | sed 's/, "[a-z].*//'; }
sed '/^sample/d' plane.yaml >one.yaml
echo "load: [{F: [[1.05, 0.02, 0], [0, 1.03, 0], [0, 0, 1.1]], turgor: 0.02 MPa}]" >>one.yaml
expect 0 "$lamella" rve one.yaml --json
P >solve.txt
expect 0 "$lamella" query db.h5 -F "$F" -p "0.02 MPa" --accuracy inf --json
P >query.txt
paste <(tr -cs '0-9.e-' '\n' <solve.txt | grep '[0-9]') <(tr -cs '0-9.e-' '\n' <query.txt | grep '[0-9]') |
  awk '{d = $1 - $2; if (d * d > 4e-8) exit 1; n++} END {exit n != 9}' || fail "another P: $(cat solve.txt query.txt)"
expect 3 -o 'F33 is 1.2, the database covers 0.9 to 1.15' "$lamella" query db.h5 -F "${F%1.1}1.2" -p "0.02 MPa"
expect 3 -o 'F33 is 1.1, the database covers 1 alone' "$lamella" query plane.h5 -F "$F" -p "0.02 MPa"
expect 0 "$lamella" query db.h5 -F "1.05 0.02 0 1.03" -p "0.02 MPa" --accuracy inf
expect 0 -o '"P33": {"median"' -o '"F33": \[0.9' "$lamella" verify db.h5 --samples 10 --accuracy inf --json

# parts of the box make the whole; other ranges are other grids
for part in 1/2 2/2; do "$lamella" build s.yaml -d "part${part%/2}.h5" --shard $part --quiet >/dev/null; done
expect 0 "$lamella" merge all.h5 part1.h5 part2.h5
expect 0 "$lamella" build s.yaml -d all.h5 --resume --quiet
expect 0 "$lamella" query all.h5 -F "$F" -p "0.02 MPa" --accuracy inf --json
P >all.txt
cmp -s query.txt all.txt || fail "parts give another answer: $(cat query.txt all.txt)"
expect 2 "$lamella" merge new.h5 db.h5 plane.h5
cp db.h5 bad.h5
printf 'damaged.' | dd of=bad.h5 bs=1 seek=40000 conv=notrunc status=none
expect 2 "$lamella" info bad.h5 --check
expect 0 "$lamella" merge sound.h5 bad.h5 --salvage
expect 0 -o 'grid of F33 *0.9 to 1.15' "$lamella" info sound.h5

# Python
package
"$python" - <<'PYTHON' || fail "the package"
import json, numpy as np, lamella
F = np.diag([1.05, 1.03, 1.1]); F[0, 1] = 0.02
told = open("query.txt").read()
P = 1e6 * np.array(json.loads(told[told.index("["):]))
r = lamella.Database("db.h5").query(F, 0.02e6, accuracy=np.inf)
assert r.status == "converged" and np.allclose(r.P.ravel(), P.ravel(), rtol=1e-9, atol=1e-6), (r.P, P)
F[2, 2] = 1.2
r = lamella.Database("db.h5").query(F, 0.02e6, accuracy=np.inf)
assert r.status == "out_of_reach" and "0.9 to 1.15" in str(r.reason), r.reason
PYTHON

# out-of-plane shear: a rotation of the section is none; a small one is answered as a solve does, a large one by tissue in contact
# alone, whose cells slide along their axis
cat one.yaml >contact.yaml
sed -i 's/law: bonded/law: contact/; s/\[1.05, 0.02, 0\], \[0, 1.03, 0\], \[0, 0, 1.1\]/[1.05, 0.02], [0, 1.03]/' contact.yaml
expect 0 "$lamella" rve contact.yaml -o contact.h5 --quiet
"$python" - <<'PYTHON' || fail "out-of-plane shear"
import numpy as np, lamella
F0 = np.diag([1.05, 1.03, 1.1]); F0[0, 1] = 0.02
c, s = np.cos(0.3), np.sin(0.3)
Q = np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
ask = lambda file, F: lamella.Database(file).query(F, 0.02e6, accuracy=np.inf)
small = F0.copy(); small[2, :2] = 2e-5, -1e-5
sheared = np.diag([1.05, 1.03, 1]); sheared[0, 1] = 0.02; sheared[2, :2] = 0.1, 0.05

plane, turned = ask("db.h5", F0), ask("db.h5", Q @ F0)
assert np.allclose(turned.P, Q @ plane.P, rtol=0, atol=1e-7 * abs(plane.P).max()), (turned.P, Q @ plane.P)
for F, file, scene in ((Q @ small, "db.h5", "one.yaml"), (Q @ sheared, "contact.h5", "contact.yaml")):
    r, rve = ask(file, F), lamella.RVE(scene).solve(F, 0.02e6)
    assert r.status == "converged", r.reason
    assert abs(r.P - rve.P).max() < 2e-3 * abs(rve.P).max(), (r.P, rve.P)
    step = np.zeros((3, 3)); step[0, 2] = step[2, 1] = 1e-6  # the tangent is the derivative of the answers
    slope = (ask(file, F + step).P - ask(file, F - step).P) / 2e-6
    found = np.einsum("ijkl,kl", r.tangent, step / 1e-6)
    assert np.allclose(found, slope, rtol=0, atol=1e-4 * abs(r.tangent).max()), (found, slope)
assert r.error_estimate < 1e-9 or np.isnan(r.error_estimate)

small[2, 0] = 0.01
r = ask("db.h5", small)
assert r.status == "out_of_reach" and "F31 = 0.01, F32 = -1e-05: out-of-plane shear of 0.01; the database answers up to 0.0001" in str(r.reason), r.reason
rounded = np.diag([1.05, 1.03, 1 + 4e-7]); rounded[1, 2] = 2e-10  # the arithmetic of a host
assert ask("plane.h5", rounded).converged and np.allclose(ask("plane.h5", rounded).P, ask("plane.h5", np.diag([1.05, 1.03, 1])).P, rtol=1e-5, atol=1)
PYTHON
