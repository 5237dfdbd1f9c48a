# slow: docs/results/tissues.md: the table of what the scenes show, with the bands of 64 samples; values of scenes lie in
# their intervals, which are those that the document tells.
. "$(dirname "$0")/common.sh"
package scipy

"$python" - "$lamella" "$source" <<'PYTHON' || fail "the document"
import os, re, subprocess, sys
import lamella
from lamella import uncertainty
from lamella.parameters import uncertain, value_in

os.environ["LAMELLA_PROGRAM"], source = sys.argv[1], sys.argv[2]
text = open(f"{source}/docs/results/tissues.md", encoding="utf-8").read()
parts = re.split(r"^## ", text, flags=re.M)
of_all = parts[0]
rows = {m[1]: m[0] for m in re.finditer(r"^\| `(\w+)` \|.*$", parts[-2], re.M)}
wrong = []

def compare(cell, found, what):
    """Numbers of a cell of the table with those of the run."""
    shown = [float(n) for n in re.findall(r"(?<![\w.])\d+\.?\d*(?:e-\d+)?", cell)]
    if len(shown) != len(found) or any(abs(s - f) > 0.02 * abs(f) + 1e-4 for s, f in zip(shown, found)):
        wrong.append(f"{what}: the document has {cell}, the run {', '.join(f'{f:.4g}' for f in found)}")

for name in ("apple", "pear", "tomato", "potato", "carrot", "onion"):
    path = f"{source}/tests/scenes/tissues/{name}.yaml"
    scene, section = lamella.scene_dict(path), next(p for p in parts if p.lower().startswith(name))
    for p in uncertain(path):
        low, high, size = p.value(0), p.value(1), 2 if p.key == "rve.cell.apothem" else 1
        if not low <= value_in(scene, p) <= high:
            wrong.append(f"{name}: {p.key}: {value_in(scene, p)} is not between {low} and {high}")
        words = f"{size * low:g} to {size * high:g} {p.unit.replace('um', 'µm')}".strip().replace("e-0", "e-")
        if words not in section.replace("\n", " ") + of_all.replace("\n", " "):
            wrong.append(f"{name}: {p.key}: the document has not {words}")
    told = uncertainty.bands(path, 64, processes=2)
    series = {of["name"]: of for of in told["series"]}
    first, unit = told["first"], 60 if " min" in rows[name] else 86400
    cells = [c.strip() for c in rows[name].strip("|").split("|")]
    own = first["scene"]
    if not cells[1].startswith(own["name"]):
        wrong.append(f"{name}: the first event is {own['name']}, not {cells[1]}")
    compare(cells[1], [own["at"] / unit] if own["at"] is not None else [], f"{name}: time of the event")
    ends = [series[of]["scene"][k] for of in ("turgor", "firmness") for k in (0, -1)]
    compare(cells[2], ends, f"{name}: turgor and firmness")
    f = series["firmness"]
    compare(cells[3], [f[part][-1] for part in ("median", "low", "high")], f"{name}: the band of firmness")
    event = next((e for e in first["events"] if e["name"] != "none"), {"name": "none", "samples": 0})
    if not cells[4].startswith(event["name"]):
        wrong.append(f"{name}: of the samples {event['name']}")
    at = [event["at"][part] / unit for part in ("median", "low", "high")][:3 if event["samples"] > 1 else 1] if "at" in event else []
    found = [event["samples"], *at] if at else []
    compare(cells[4], found, f"{name}: {event['name']} of the samples")
    if os.environ.get("LAMELLA_SHOW"):
        g = lambda v: f"{v:.3g}" if abs(v) > 1e-6 else "0"
        print(f"| `{name}` | {own['name']}{'' if own['at'] is None else ' at ' + g(own['at'] / unit)} | {g(ends[0])} to {g(ends[1])} MPa,"
              f" {g(ends[2])} to {g(ends[3])} MPa | {g(f['median'][-1])} ({g(f['low'][-1])} to {g(f['high'][-1])}) | {event['name']}"
              + (f" in {found[0]}: {g(found[1])}" if found else "") + (f" ({g(found[2])} to {g(found[3])}) |" if len(found) > 2 else " |"))
print("\n".join(wrong), end="\n" if wrong else "")
sys.exit(bool(wrong))
PYTHON
