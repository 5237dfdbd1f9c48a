# slow: lamella plot of results with cells of any shape: air is no gap, forces between cells are in balance with the stress, images
# across the period, the outline at rest has no air within, slices of tables turn no hexagon.
. "$(dirname "$0")/common.sh"
package h5py matplotlib scipy

cat >tissue.json <<'JSON'
{"lamella_tissue": 1, "unit": "um", "period": [[180, 0], [0, 180]], "wall_thickness": 8, "corner_radius": 18,
 "vertices": [[0, 0], [100, 0], [180, 0], [0, 180], [100, 90], [100, 180], [180, 180], [0, 90], [180, 90]],
 "cells": [[0, 1, 4, 7], [1, 2, 8, 4], [7, 4, 5, 3], [4, 8, 6, 5]]}
JSON
scene() {
  cat <<YAML
version: 1
rve:
  tissue: tissue.json
  wall: {law: fibre_mooney_rivlin, C1: 0.2 MPa, C2: 0.02 MPa, C4: 0.5 MPa}
  interface: {$1}
  turgor: {pressure: 0.001 MPa}
  mesh: {along: 4, through: 1}
load: [{F: [[1.01, 0], [0, 1.01]]}]
sample: {stretch: {min: 0, max: 0.02}, turgor: {min: 0 MPa, max: 0.002 MPa}, count: 4}
YAML
}
scene "law: lamella, strength: 0.5 MPa, fracture_energy: 50 J/m^2" >lamella.yaml
scene "law: bonded" >bonded.yaml
expect 0 "$lamella" rve lamella.yaml -o lamella.h5 --no-estimate
expect 0 "$lamella" rve bonded.yaml -o bonded.h5 --no-estimate
expect 0 "$lamella" build bonded.yaml -d table.h5 --quiet
for file in lamella bonded table; do expect 0 "$lamella" plot --dpi 40 $file.h5; done
expect 0 "$lamella" plot --dpi 40 lamella.h5 --forces -o forces.png
expect 0 "$lamella" plot --dpi 40 lamella.h5 --forces --strip -o strip.png
cmp -s lamella.png forces.png && fail "--forces changes nothing"
expect 2 -e "are bonded" "$lamella" plot bonded.h5 --forces
expect 2 -e "--forces draws files of rve" "$lamella" plot table.h5 --forces

"$python" - <<'PYTHON' || fail "the pictures"
import json
import numpy as np
import lamella
from lamella.plot import tissue
from lamella.plot.interface import Forces
from lamella.plot.read import Source
from lamella.plot.states import _cells
from matplotlib.patches import Polygon

with Source("lamella.h5") as source:
    cells = _cells(source, 0, "wall_stress", True)
    response, unit = source.responses[0], source.apothem
file = json.load(open("tissue.json"))
corner = np.array(file["vertices"]) * 1e-6 / unit

# half of the length of these faces is on arcs: no gap is told there, and what is told is that of joined walls
i = cells.interface
assert len(i.faces) == 8 and i.air.any(axis=1).all() and not i.air.all(axis=1).any()
assert i.widest < 1e-3, i.widest

# 8 faces: 4 within, 4 across the period; lines go to the image that is across
length = np.linalg.norm(cells.forces.lines[:, 1] - cells.forces.lines[:, 0], axis=1)
assert (length > 0.9 * 80e-6 / unit).all() and (length < 1.1 * 110e-6 / unit).all(), length

# Love and Weber: trace P V0 = sum of force . branch at rest; the cells' mirrors leave no shear
branch = np.linalg.norm(cells.forces.lines[:, 1] - cells.forces.lines[:, 0], axis=1) / 1.01 * unit
trace = (cells.forces.force * branch).sum() / np.linalg.det(np.array(file["period"]) * 1e-6)
assert abs(trace / np.trace(response.P[:2, :2]) - 1) < 1e-3, (trace, np.trace(response.P[:2, :2]))

# the outline at rest: one loop around the four cells, through their corners, of the period's area
loops = tissue._border(cells)
assert len(loops) == 1
x = loops[0]
area = 0.5 * (x[:-1, 0] * x[1:, 1] - x[1:, 0] * x[:-1, 1]).sum()
assert abs(area / np.linalg.det(np.array(file["period"]) * 1e-6 / unit) - 1) < 1e-6, area
for k in (0, 1, 2, 3, 5, 6, 7, 8):
    assert np.linalg.norm(x - corner[k], axis=1).min() < 1e-6, k

# no hexagon in the slice of a table of other cells; axes count from X1
page = lamella.plot.draw("table.h5")
shown = [a for a in page.axes if not a.axison and any(isinstance(p, Polygon) and len(p.get_xy()) == 7 for p in a.patches)]
assert not shown
assert any("to $X_1$" in a.get_xlabel() for a in page.axes)
PYTHON
