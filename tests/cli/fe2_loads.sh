# slow: the loads of fe2: forces of named obstacles balance, a cycle ends without force; mistakes that only the mesh shows
. "$(dirname "$0")/common.sh"
set -e

for scene in pressed-disc puncture; do
  "$lamella" fe2 "$source/tests/scenes/$scene.yaml" --json >$scene.jsonl
  python3 - $scene.jsonl <<'PYTHON'
import json, sys
steps = [json.loads(line) for line in open(sys.argv[1])]
forces = [s["reaction"] for s in steps]
obstacle = [f[k][1] for f in forces for k in f if k in ("plate", "indenter")]
for f in forces:
    for i in range(2):
        assert abs(sum(f[k][i] for k in f)) < 1e-9, f
assert obstacle[3] < obstacle[2] < obstacle[1] < -1e-3, obstacle
assert abs(obstacle[-1]) < 1e-9 and [s["load_factor"] for s in steps][3:] == [1, 0.5, 0], obstacle
assert abs(steps[-1]["work"]) < 0.1 * steps[3]["work"]
assert max(s["convergence_order"] or 0 for s in steps) > 1.7
PYTHON
done

sed 's/on: rim/on: edge/' "$source/tests/scenes/pressed-disc.yaml" >unknown.yaml
"$lamella" fe2 unknown.yaml 2>unknown.txt && fail "an unknown side is accepted"
grep -q "macro.boundary\[2\].on: edge: is none of the names known here" unknown.txt || fail "an unknown side is not named"
sed '/bottom, symmetry/d' "$source/tests/scenes/pressed-disc.yaml" >loose.yaml
"$lamella" fe2 loose.yaml 2>loose.txt && fail "a loose body is accepted"
grep -q "plates and indenters do not count" loose.txt || fail "a loose body is not explained"
