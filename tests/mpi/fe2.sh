# fe2 on two ranks: the same reactions, summary and zooms to 1e-8, direct and from caches, also of sealed tissue and of regions
. "$(dirname "$0")/../cli/common.sh"
set -e

tissue >block.yaml <<'YAML'
strength: {wall: 0.17 MPa}
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, 0.2 mm]}]
  steps: 2
YAML
# reactions FILE: all of them, one per line
reactions() { grep -o '"reaction": *{[^}]*}' "$1" | grep -o '\[[^]]*\]' | tr -d '[],' | tr ' ' '\n' | grep .; }

sed 's/mode: prescribed/mode: sealed/' block.yaml >sealed.yaml
cat block.yaml - >regions.yaml <<'YAML'
  regions: [{name: skin, where: y > 5, wall: {C1: 0.15 MPa}}]
  fields:
    wall_thickness: {expression: 11 + 0.1 * x, unit: um, levels: 2}
    orientation: {expression: 3 * x, unit: deg}
YAML
for case in "block direct" "block cache" "sealed direct" "regions cache"; do
  scene=${case% *}.yaml
  response=${case#* }
  "$lamella" fe2 $scene --json --response $response -o one.h5 >one.jsonl
  mpirun -n 2 "$lamella" fe2 $scene --json --response $response -o two.h5 >two.jsonl
  [ "$(wc -l <two.jsonl)" = 3 ] || fail "$case: not one object per step on two ranks"
  reactions one.jsonl >one.txt
  reactions two.jsonl >two.txt
  [ -s one.txt ] || fail "$case: no reactions"
  paste one.txt two.txt | awk '{d = $1 - $2; if (d < 0) d = -d; if (d > worst) worst = d; a = $1 < 0 ? -$1 : $1; if (a > size) size = a}
    END {exit !(NR > 0 && worst <= 1e-8 * size)}' || fail "$case: reactions depend on the number of ranks"
  /usr/bin/python3 -c 'import h5py' 2>/dev/null || continue
  /usr/bin/python3 - <<'PYTHON' || fail "$case: fields, summary or zooms depend on the number of ranks"
import json
import h5py, numpy as np
with h5py.File("one.h5") as one, h5py.File("two.h5") as two:
    def same(name, item):
        if isinstance(item, h5py.Dataset) and item.dtype.kind in "fi" and not any(word in name for word in ("seconds", "difference", "solves", "hits")):
            assert np.allclose(item, two[name], rtol=1e-6, atol=1e-8, equal_nan=True), name
    for group in "macro", "zoom":
        one[group].visititems(lambda name, item: same(f"{group}/{name}", item))
    a, b = (json.loads(h5["macro/summary"][()]) for h5 in (one, two))
    assert a["rupture"]["point"] == b["rupture"]["point"] and a["rupture"]["element"] == b["rupture"]["element"]
    assert abs(a["rupture"]["load_factor"] - b["rupture"]["load_factor"]) < 1e-6
PYTHON
done
