# slow: a cylinder of turgid potato whose walls relax, directly and from a database: the table of docs/tutorial.md
. "$(dirname "$0")/common.sh"
set -e

scene=$source/tests/scenes/cylinder-relaxation.yaml
expect 0 "$lamella" process "$scene" --json -o held.h5 && mv out.txt direct.jsonl
expect 0 -e 'approximated from them, and err most against fast loads after long turgor' \
    "$lamella" process "$scene" -d held-db.h5 --json && mv out.txt database.jsonl
/usr/bin/python3 - "$source/docs/tutorial.md" <<'PYTHON'
import json, re, sys

def forces(path):
    states = [s for s in map(json.loads, open(path)) if "reaction" in s]
    return {round(s["time"]): -s["reaction"]["top"][1] for s in states}

rows = re.findall(r"^\| (6 s|30 s|1 min|5 min) \| ([\d.]+) \| ([\d.]+) \|$", open(sys.argv[1]).read(), re.M)
assert len(rows) == 4, rows
found = [forces(path) for path in ("direct.jsonl", "database.jsonl")]
for time, *told in rows:
    at = float(time.split()[0]) * (60 if "min" in time else 1)
    for force, number in zip(found, told):
        assert abs(force[at] - float(number)) < 0.06, (time, force[at], number)
PYTHON
