# slow: lamella tissue: the cells have the statistics that were asked for; the same seed gives the same file; refusals; pictures.
. "$(dirname "$0")/common.sh"

package scipy

made="tissue --size 150um --wall-thickness 6um"
expect 0 -o '^porosity     0.120000' "$lamella" $made -o gas.json --cells 40 --variation 0.4 --elongation 2 \
  --direction "30 deg" --gas 0.12 --seed 5
expect 0 "$lamella" $made -o again.json --cells 40 --variation 0.4 --elongation 2 --direction 30deg --gas 0.12 --seed 5
cmp -s gas.json again.json || fail "the same seed gives other bytes"
expect 0 "$lamella" $made -o other.json --cells 40 --variation 0.4 --elongation 2 --direction 30deg --gas 0.12 --seed 6
cmp -s gas.json other.json && fail "another seed gives the same cells"
expect 0 "$lamella" $made -o few.json --cells 20 --gas 0.02 --aspect 2
expect 0 "$lamella" $made -o full.json --cells 60 --variation 0.5 --json
mv out.txt full.txt

"$python" - <<'PYTHON' || fail "the tissue"
import json
import numpy as np
from lamella.tissue import Tissue, geometry
from lamella.tissue.spaces import Contacts
from raises import raises
import lamella

gas, few, full = (Tissue.read(f"{name}.json") for name in ("gas", "few", "full"))
of = {id(t): t.statistics() for t in (gas, few, full)}

# areas of the cells: shoelace formula, no function of the package
def areas(t):
    return np.array([0.5 * (p[:, 0] @ np.roll(p[:, 1], -1) - p[:, 1] @ np.roll(p[:, 0], -1))
                     for p in (t.vertices[cell] for cell in t.cells)])
for t, variation in ((gas, 0.4), (few, 0), (full, 0.5)):
    assert abs(areas(t).mean() / (np.pi * 150**2 / 4) - 1) < 1e-9
    assert abs(areas(t).std() / areas(t).mean() - variation) < 1e-9
assert abs(areas(full).sum() / np.linalg.det(full.period) - 1) < 1e-9, "the cells fill the period"
assert few.period[0, 0] == 2 * few.period[1, 1] and not few.period[[0, 1], [1, 0]].any()

# elongation and direction, of points spread evenly over cells; another definition would differ by more
rng, tensor = np.random.default_rng(0), np.zeros((2, 2))
for cell, area in zip(gas.cells, areas(gas)):
    p = gas.vertices[cell]
    corners = np.stack([np.broadcast_to(p[0], (len(p) - 2, 2)), p[1:-1], p[2:]], 1)
    e = corners[:, 1:] - corners[:, :1]
    size = 0.5 * (e[:, 0, 0] * e[:, 1, 1] - e[:, 0, 1] * e[:, 1, 0])
    share = rng.dirichlet([1, 1, 1], (len(size), 4000))
    x = np.einsum("tnk,tkd->tnd", share, corners)
    middle = (size[:, None] * x.mean(1)).sum(0) / area
    tensor += (size[:, None, None] * np.einsum("tni,tnj->tij", x - middle, x - middle) / 4000).sum(0) / area**2
values, axes = np.linalg.eigh(tensor)
assert abs(np.sqrt(values[1] / values[0]) - 2) < 0.08, values
assert abs(np.degrees(np.arctan2(axes[1, 1], axes[0, 1])) % 180 - 30) < 3
assert abs(of[id(gas)]["elongation"] - np.sqrt(values[1] / values[0])) < 0.02

# porosity: points of a grid that lie in no cell, with their corners' arcs; and to 1e-6 by the package's formula
from matplotlib.path import Path
from lamella.plot.rest import outlines
for t, wanted in ((gas, 0.12), (few, 0.02)):
    assert abs(of[id(t)]["porosity"] - wanted) < 1e-6
    rounded, lumens = outlines(t, t.thickness())
    grid = (np.stack(np.meshgrid(np.arange(200), np.arange(200)), -1).reshape(-1, 2) + 0.5) / 200 @ t.period
    covered, inner = np.zeros(len(grid), bool), np.zeros(len(grid), bool)
    images = [(i, j) for i in (-2, -1, 0, 1, 2) for j in (-2, -1, 0, 1, 2)] @ t.period
    for k in range(len(t.cells)):
        for which, corners in ((covered, rounded), (inner, lumens)):
            loop = corners[t.edges.first[k]:t.edges.first[k + 1]].reshape(-1, 2)
            for image in images:
                near = ((grid > (loop + image).min(0)) & (grid < (loop + image).max(0))).all(1)
                if near.any():
                    which[near] |= Path(loop + image).contains_points(grid[near])
    assert abs(1 - covered.mean() - wanted) < 0.002, 1 - covered.mean()
    assert abs(inner.mean() - of[id(t)]["lumen_share"]) < 0.002, inner.mean()
assert gas.made_by["got"]["cells_missing"] > 0 and few.made_by["got"]["cells_missing"] == 0

# cells at missing ones keep at least half of their neighbours, and the tissue hangs together
assert Contacts(gas).hold(np.zeros(40, bool))
assert not Contacts(gas).hold(np.arange(40) > 2)

# short edges are gone; walls have room
for t in (gas, few, full):
    length = geometry.length_of(t)
    assert length.min() >= 0.15 * length.mean() - 1e-6 and length.min() > 6

# --json is what the file has
told, made = json.loads(open("full.txt").read()), json.load(open("full.json"))["made_by"]
assert told["asked"] == made["asked"] and abs(told["got"]["area_variation"] - 0.5) < 1e-9
assert told["got"]["neighbours_count"] == made["got"]["neighbours_count"]

# a file that is read and written again is the same; YAML is read, too
gas.write("copy.json")
assert open("copy.json").read() == open("gas.json").read()
import yaml
open("gas.yaml", "w").write(yaml.safe_dump(json.load(open("gas.json")), sort_keys=False))
assert Tissue.read("gas.yaml").text() == gas.text()

# what a file must not hold
def broken(words, **changes):
    told = json.load(open("full.json")) | changes
    json.dump(told, open("broken.json", "w"))
    raises(lamella.InputError, words, lambda: Tissue.read("broken.json"))
cells = json.load(open("full.json"))["cells"]
broken("broken.json: cell 3: its vertices are not counter-clockwise", cells=cells[:3] + [cells[3][::-1]] + cells[4:])
broken("cells 0 and 60 have an edge in the same direction", cells=cells + [cells[0]])
broken("there is no vertex 100000", cells=[[0, 1, 100000]])
broken("corner_radius: 500", corner_radius=500)
broken("has no lumen", wall_thickness=60)
broken("unknown key", colour="red")
broken("version 1", lamella_tissue=2)
broken("the unit \"apples\" is unknown", unit="apples")
p = [[0, 0], [2, 0], [2, 2], [0, 2], [1, 1], [3, 1], [3, 3], [1, 3], [2, 1], [4, 1], [4, 2]]
square = {"period": None, "vertices": p, "wall_thickness": 0.1}
broken("cells 0 and 1 overlap", cells=[[0, 1, 2, 3], [4, 5, 6, 7]], **square)
broken("lies within its edge", cells=[[0, 1, 2, 3], [8, 9, 10]], **square)
broken("crosses itself", cells=[[0, 1, 3, 2, 7]], **square)
open("broken.json", "w").write('{"lamella_tissue": 1, ')
raises(lamella.InputError, "neither JSON nor YAML", lambda: Tissue.read("broken.json"))
PYTHON

# refusals
expect 1 -e "the second is missing" "$lamella" tissue -o a.json --size 150um
expect 1 -e "one argument too many" "$lamella" $made -o a.json --cells 20 more
expect 2 -e "--variation 0.7: 0 to 0.5 is wanted" "$lamella" $made -o a.json --cells 20 --variation 0.7
expect 2 -e "--gas much: a number is wanted" "$lamella" $made -o a.json --cells 20 --gas much
expect 2 -e "--size 150.*has no unit" "$lamella" tissue -o a.json --cells 20 --size 150
expect 2 -e "--direction 30.*unit" "$lamella" $made -o a.json --cells 20 --elongation 1.5 --direction 30
expect 2 -e "--wall-thickness 90 um" "$lamella" tissue -o a.json --cells 20 --size 150um --wall-thickness 90um
expect 2 -e "thinner walls" "$lamella" tissue -o a.json --cells 20 --size 150um --wall-thickness 60um
expect 4 -e "no/such/a.json: cannot be made: make the folder first" "$lamella" $made -o no/such/a.json --cells 8
[ ! -e a.json ] || fail "a refused tissue was written"
LAMELLA_PYTHON=/no/python expect 4 -e "tissue needs Python 3 with the package scipy" "$lamella" $made -o a.json --cells 8

# what the reference shows, and pictures
if "$python" -c 'import matplotlib' 2>/dev/null; then
  "$python" -m doctest "$source/docs/reference/tissue.md" || fail "docs/reference/tissue.md"
  expect 0 "$lamella" plot --dpi 40 gas.json
  [ "$(head -c 4 gas.png | tail -c 3)" = PNG ] || fail "no picture of the tissue"
  expect 2 -e "--state: a tissue file is drawn as a whole" "$lamella" plot --dpi 40 gas.json --state 1
  expect 2 -e "broken.json: is neither" "$lamella" plot --dpi 40 broken.json
fi
