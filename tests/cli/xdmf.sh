# what fe2 writes reads back with meshio, and agrees with the HDF5 file
set -eu
lamella=$1
/usr/bin/python3 -c 'import meshio, h5py' 2>/dev/null || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat >block.yaml <<'YAML'
version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: 11.25 um}
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  interface: {law: bonded}
  turgor: {mode: prescribed, pressure: 0.02 MPa}
  mesh: {along: 4, through: 1}
macro:
  mesh: {box: [10 mm, 5 mm], elements: [2, 1]}
  boundary:
    - {on: bottom, displacement: [0 mm, 0 mm]}
    - {on: top, displacement: [0.5 mm, 0 mm]}
  inflate: true
  steps: 1
YAML
mkdir results
"$lamella" fe2 block.yaml --json -o results/block.h5 >steps.jsonl
mv results moved # the reference between the files holds no folder
/usr/bin/python3 - <<'PYTHON'
import json
import h5py, meshio, numpy as np
reactions = [json.loads(line)["reaction"] for line in open("steps.jsonl")]
with h5py.File("moved/block.h5") as h5, meshio.xdmf.TimeSeriesReader("moved/block.xdmf") as xdmf:
    points, cells = xdmf.read_points_cells()
    assert cells[0].type == "quad9" and cells[0].data.shape == (2, 9), cells
    assert points.shape == (15, 2) and np.ptp(points[:, 0]) == 10 and np.ptp(points[:, 1]) == 5, points
    assert h5["macro/nodes"].attrs["unit"] in ("mm", b"mm")
    assert list(h5["macro/steps"]) == [0, 1] and xdmf.num_steps == 2
    for k in range(xdmf.num_steps):
        time, point, cell = xdmf.read_data(k)
        assert time == h5["macro/curve/load_factor"][k]
        step = h5[f"macro/step/{k}"]
        assert np.array_equal(point["u"], step["u"]) and point["u"].shape == (15, 3)
        for name in ("F", "P", "cauchy", "lumen_fraction", "opening_fraction", "debonded_fraction", "turgor"):
            assert np.array_equal(cell[name][0], step[name]), name
    assert np.allclose(cell["turgor"][0], 0.02)
    F, P, cauchy = (np.asarray(cell[name][0]).reshape(-1, 3, 3) for name in ("F", "P", "cauchy"))
    size = np.abs(cauchy).max()
    assert np.allclose(cauchy, cauchy.transpose(0, 2, 1), rtol=0, atol=1e-6 * size) # as in every point
    of_means = P @ F.transpose(0, 2, 1) / np.linalg.det(F)[:, None, None] # not the mean, but not far from it
    assert np.allclose(cauchy, of_means, rtol=0, atol=0.2 * size), (cauchy, of_means)
    names = h5["macro/boundaries"][()]
    names = (names.decode() if isinstance(names, bytes) else names).split("\n")
    assert names == ["bottom", "top"], names
    for k, reaction in enumerate(reactions):
        for s, name in enumerate(names):
            assert np.allclose(h5["macro/curve/reaction"][k, s], reaction[name], rtol=1e-12, atol=1e-15)
PYTHON
