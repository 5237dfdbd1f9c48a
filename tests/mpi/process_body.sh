# slow: process of a body on two ranks: the same states to 1e-6, with water and events, from a database and solved directly
. "$(dirname "$0")/../cli/common.sh"
set -e

sed 's/elements: \[8, 8\]/elements: [3, 2]/' "$source/tests/scenes/storage.yaml" >body.yaml
sed 's/elements: \[3, 2\]/elements: [2, 1]/; s/1209610 s/7.5 day/; s/output: 1 day/output: 4 day\n  tolerance: 1e-3/' body.yaml >direct.yaml
"$lamella" process body.yaml -d d.h5 --quiet >/dev/null
# water that moves through the body, from surface to surface of the ranks
sed 's/output: 1 h/output: 6 h/' "$source/tests/scenes/slice-baths.yaml" >slice.yaml
"$lamella" process slice.yaml -d s.h5 --quiet >/dev/null
# a region, and more ranks than elements
sed 's/elements: \[2, 1\]/elements: [1, 1]/; s/^process:/  regions: [{name: skin, where: "y > 5", cell: {apothem: 40 um}}]\nprocess:/' direct.yaml >skin.yaml
mpirun -n 3 "$lamella" process skin.yaml --quiet >three.txt
"$lamella" process skin.yaml --quiet >alone.txt
[ "$(wc -l <three.txt)" = "$(wc -l <alone.txt)" ] || fail "three ranks with one element differ: $(cat three.txt)"

for case in "body database -d d.h5" "slice database -d s.h5" "direct direct"; do
  set -- $case
  scene=$1.yaml response=$2
  shift 2
  "$lamella" process "$scene" --json --response "$response" "$@" -o one.h5 >one.jsonl
  mpirun -n 2 "$lamella" process "$scene" --json --response "$response" "$@" -o two.h5 >two.jsonl
  /usr/bin/python3 - <<'PYTHON' || fail "$case: two ranks differ from one"
import json, sys

one, two = ([json.loads(line) for line in open(name)] for name in ("one.jsonl", "two.jsonl"))
good = len(one) == len(two) > 2
for a, b in zip(one, two):
    for key in ("time", "water", "turgor_min", "turgor_max", "turgor_mean", "walls", "inflow"):
        if key not in a:
            continue
        good = good and abs(a[key] - b[key]) <= 1e-6 * max(abs(a[key]), 1e-3)
    for side in a["reaction"]:
        good = good and all(abs(x - y) < 1e-8 for x, y in zip(a["reaction"][side], b["reaction"][side]))
    good = good and a.get("event") == b.get("event")
sys.exit(0 if good else 1)
PYTHON
done
