# slow: hysteresis of walls that relax and of water that leaves the cells, together and apart: the table of docs/tutorial.md
. "$(dirname "$0")/common.sh"
set -e

scene=$source/tests/scenes/rate-loop.yaml
for time in 1 10 100 1000; do
  sed "s/for: 10 s/for: $time s/; s/output: .*/output: $(awk "BEGIN {print $time / 40}") s/" "$scene" >both.yaml
  sed '/relaxation/d' both.yaml >water.yaml
  sed '/water:/d' both.yaml >walls.yaml
  for what in both water walls; do expect 0 "$lamella" process $what.yaml --json && mv out.txt $what-$time.jsonl; done
done
/usr/bin/python3 - "$source/docs/tutorial.md" <<'PYTHON'
import json, re, sys

def loop(path):
    states = [s for s in map(json.loads, open(path)) if "F" in s and "P" in s]
    assert len(states) == 81 and abs(states[-1]["F"][0] - states[0]["F"][0]) < 1e-9, path
    x, y = [s["F"][0] for s in states], [s["P"][0] for s in states]
    return 1e3 * sum((x[i + 1] - x[i]) * (y[i + 1] + y[i]) / 2 for i in range(80))

rows = re.findall(r"^\| (\d+) s \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", open(sys.argv[1]).read(), re.M)
assert len(rows) == 4, rows
for time, *told in rows:
    found = [loop(f"{what}-{time}.jsonl") for what in ("both", "water", "walls")]
    assert all(abs(a - float(b)) < 0.002 for a, b in zip(found, told)), (time, found, told)
PYTHON
