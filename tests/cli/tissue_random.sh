# slow: 40 tissues with random numbers: all of them can be had, and are as docs/reference/tissue.md says. LAMELLA_SEEDS=200
# takes all tissues of its table. With a folder as the third argument the files stay there.
. "$(dirname "$0")/common.sh"

package scipy

"$python" - "${3:-.}" "${LAMELLA_SEEDS:-40}" <<'PYTHON' || fail "random tissue"
import sys
import numpy as np
from lamella.tissue import Tissue, geometry
from lamella.tissue.make import Asked, make

rng, rows = np.random.default_rng(32), []
for seed in range(int(sys.argv[2])):
    cells, variation, elongation = int(rng.integers(20, 61)), rng.uniform(0, 0.5), rng.uniform(1, 3)
    direction, gas, size = rng.uniform(-90, 90), rng.uniform(0, 0.3), rng.uniform(50, 250)
    apothem = np.sqrt(np.pi * size**2 / 4 / (2 * np.sqrt(3)))
    asked = Asked(cells, round(size, 1), "um", round(variation, 3), round(elongation, 3), round(direction, 1),
                  1.0, round(rng.uniform(0.05, 0.2) * apothem, 2), round(gas, 4), seed)
    path = f"{sys.argv[1]}/{seed:03d}.json"
    make(asked).write(path)
    tissue = Tissue.read(path)  # checks it
    s, got = tissue.statistics(), tissue.made_by["got"]
    assert abs(s["porosity"] - asked.gas) < 1e-6 and abs(s["area_mean"] / asked.area - 1) < 1e-9
    assert abs(s["area_variation"] - asked.variation) < 1e-9 and len(tissue.cells) == asked.cells
    assert s["edge_shortest"] > asked.wall_thickness
    rows.append((s["edge_shortest"] / s["edge_mean"], s["angle_smallest"], np.degrees(geometry.angles(tissue).max()),
                 100 * abs(s["elongation"] / asked.elongation - 1), 100 * got["edges_merged"] / (3 * asked.cells)))
rows = np.array(rows)
for name, column in zip(("shortest over mean edge", "smallest angle", "largest angle", "error of elongation, %",
                         "merged edges, %"), rows.T):
    print(f"{name:24s} {column.min():8.3g} {np.median(column):8.3g} {column.max():8.3g}")
assert rows[:, 0].min() > 0.15 and rows[:, 1].min() > 20 and rows[:, 2].max() < 175
assert rows[:, 3].max() < 6 and np.median(rows[:, 3]) < 1.5 and np.median(rows[:, 4]) < 4 and rows[:, 4].max() < 12
PYTHON
