# fe2 -o keeps the cells at chosen points: they are those that rve finds at the point's deformation; plot draws them
. "$(dirname "$0")/common.sh"
set -e
/usr/bin/python3 -c 'import h5py, numpy' 2>/dev/null || exit 77

tissue >block.yaml <<'YAML'
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, 0 mm]}]
  steps: 1
  zoom: [[9.9 mm, 9.9 mm], [2.5 mm, 2.5 mm]]
YAML
"$lamella" fe2 block.yaml --quiet -o direct.h5 >/dev/null
"$lamella" fe2 block.yaml --quiet -d db.h5 -o cache.h5 >/dev/null
"$lamella" fe2 block.yaml --quiet -d db.h5 >/dev/null # nodes that came later ask for some more
"$lamella" fe2 block.yaml --quiet -d db.h5 --response database -o database.h5 >/dev/null
/usr/bin/python3 - >loads <<'PYTHON'
import h5py
with h5py.File("direct.h5") as h5:
    for F in h5["zoom/F"]:
        print(f"  - {{F: {F[:2, :2].tolist()}}}")
PYTHON
# of tissues that differ, in their own units and turned
cat block.yaml - >regions.yaml <<'YAML'
  regions: [{name: skin, where: y > 5, cell: {apothem: 50 um, wall_thickness: 9 um}, wall: {C1: 0.15 MPa}}]
  fields: {orientation: {expression: 3 * x, unit: deg}}
YAML
"$lamella" fe2 regions.yaml --quiet -o regions.h5 >/dev/null
{
  sed '/^macro:/,$d' block.yaml
  echo "load:"
  cat loads
} >points.yaml
"$lamella" rve points.yaml --quiet -o points.h5 >/dev/null
/usr/bin/python3 - <<'PYTHON' || fail "a zoom shows other cells than the run has used"
import h5py, numpy as np
with h5py.File("direct.h5") as direct, h5py.File("points.h5") as rve:
    zoom = direct["zoom"]
    assert zoom["points"].shape == (2, 2) and np.all(zoom["difference"][()] < 1e-9)
    # the point nearest to each place, and where the displacement has brought it
    assert np.all(np.abs(zoom["place"][()] - [[9.9, 9.9], [2.5, 2.5]]) < 0.6)
    for k, (place, position, point) in enumerate(zip(zoom["place"], zoom["position"], zoom["points"])):
        element = direct["macro/elements"][point[0]]
        corners = direct["macro/nodes"][()][element[:4]]
        assert np.all(corners.min(0) < place) and np.all(place < corners.max(0))
        if k == 1: # the middle of an element is its ninth node
            node = element[8]
            assert np.allclose(place, direct["macro/nodes"][node])
            assert np.allclose(position, place + direct["macro/step/1/u"][node, :2])
        for name in "x", "wall_stress", "fibre_stretch":
            ours, theirs = zoom[f"{k + 1}/fields/{name}"][()], rve[f"fields/{k + 1}/{name}"][()]
            if name == "x": # a translation has no meaning
                ours, theirs = ours - ours.mean(0), theirs - theirs.mean(0)
            assert np.allclose(ours, theirs, rtol=1e-6, atol=1e-7), name
with h5py.File("regions.h5") as h5:
    assert np.all(h5["zoom/difference"][()] < 1e-8) and np.allclose(h5["zoom/apothem"], [50, 75])
for name in "cache", "database":
    with h5py.File(f"{name}.h5") as h5: # interpolated to 1 %
        assert np.all(h5["zoom/difference"][()] < 0.02) and np.any(h5["zoom/difference"][()] > 1e-9)
PYTHON
"$lamella" plot --dpi 40 direct.h5 -o zoom.png >/dev/null
"$lamella" plot --dpi 40 direct.h5 --state 0 -o plain.png >/dev/null
/usr/bin/python3 - <<'PYTHON' || fail "the picture of the last step is not taller, for the zooms, than that of another step"
import struct
height = [struct.unpack(">II", open(name, "rb").read(24)[16:])[1] for name in ("zoom.png", "plain.png")]
assert height[0] > 1.5 * height[1]
PYTHON
