# slow: axisymmetric bodies in fe2 from databases with F33 as an axis: bonded and in contact
. "$(dirname "$0")/common.sh"
set -e

sed 's/elements: \[3, 4\]/elements: [2, 2]/; s/steps: 6/steps: 3/' "$source/tests/scenes/potato-cylinder.yaml" >cylinder.yaml
"$lamella" fe2 cylinder.yaml --response direct --json >cylinder.jsonl 2>/dev/null

# from a database with F33 as an axis: the forces of the solves within their accuracy; the second run solves next to nothing
for run in first second; do
  "$lamella" fe2 cylinder.yaml --response cache -d table.h5 --json >$run.jsonl 2>/dev/null
done
/usr/bin/python3 - <<'PYTHON'
import json
force = lambda path: [s["reaction"]["top"][1] for s in map(json.loads, open(path)) if "reaction" in s][1:]
direct, first, second = map(force, ("cylinder.jsonl", "first.jsonl", "second.jsonl"))
assert all(abs(a / b - 1) < 0.02 for run in (first, second) for a, b in zip(run, direct)), (direct, first, second)
solves = [sum(s.get("solves", 0) for s in map(json.loads, open(p)) if "reaction" in s) for p in ("first.jsonl", "second.jsonl")]
assert solves[0] > 50 and solves[1] < 0.1 * solves[0], solves
PYTHON

# 2,025 points in contact, the first three of twenty steps, from an empty database: among its records is one at a kink
sed 's/-1.2 mm/-0.18 mm/; s/steps: 20/steps: 3/' "$source/tests/scenes/cylinder-contact.yaml" >cold.yaml
expect 0 "$lamella" fe2 cold.yaml -d cold.h5
! grep -q 'cut back' err.txt || fail "cut back: $(cat err.txt)"

# likewise in contact, in two steps on a coarse mesh
sed 's/elements: .15, 15./elements: [2, 2]/; s/-1.2 mm/-0.2 mm/; s/steps: 20/steps: 2/' "$source/tests/scenes/cylinder-contact.yaml" >contact.yaml
for response in direct cache; do
  "$lamella" fe2 contact.yaml --response $response --json >$response.jsonl 2>/dev/null
done
/usr/bin/python3 - <<'PYTHON'
import json
direct, cache = ([s["reaction"]["top"][1] for s in map(json.loads, open(f"{r}.jsonl")) if "reaction" in s][1:] for r in ("direct", "cache"))
assert len(direct) == 2 and all(abs(a / b - 1) < 0.03 for a, b in zip(cache, direct)), (direct, cache)
PYTHON
