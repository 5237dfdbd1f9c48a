# slow: F33 of 0.5 and 2 in tissue that is bonded or in contact: the answers and certificates of docs/results/extremes.md
. "$(dirname "$0")/common.sh"
set -e

sed 's/law: bonded/law: contact, cohesion: 0.05 MPa/' "$source/tests/scenes/axial-extremes.yaml" >contact.yaml
cp "$source/tests/scenes/axial-extremes.yaml" bonded.yaml
for law in bonded contact; do
  expect 3 "$lamella" rve $law.yaml --no-estimate --json
  cp out.txt $law.jsonl
done
/usr/bin/python3 - "$source/docs/results/extremes.md" <<'PYTHON'
import json, re, sys
table = [[c.strip() for c in line.strip("| \n").split("|")] for line in open(sys.argv[1]) if re.match(r"\| .*\| (0\.5|2) \|", line)]
rows = {"bonded": table[0:2], "contact": table[2:4]}
for law, wanted in rows.items():
    states = [s for s in map(json.loads, open(f"{law}.jsonl")) if "status" in s]
    for k, state in enumerate(states):
        cell = wanted[0 if state["F"][8] < 1 else 1][-3 + (0, 0, 1, 1, 2, 2)[k]]
        number = float(re.search(r"-?[0-9.]+[0-9]", cell.split("=")[-1])[0])
        if "collapses" in cell:
            share = float(re.search(r"between ([0-9.]+)", state["reason"])[1])
            assert state["status"] == "no_equilibrium" and abs(share - number) < 0.02, (law, k, cell, state["reason"])
        else:
            value = state["F"][0] if k in (2, 3) else state["P"][8]
            assert state["status"] == "converged" and abs(value / number - 1) < 0.01, (law, k, cell, value)
PYTHON
