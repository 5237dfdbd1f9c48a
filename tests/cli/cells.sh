# slow: Tissue files of label images, against the tessellation that the image shows: areas, neighbours, junctions, porosity; and
# what pictures lack, told in words.
. "$(dirname "$0")/common.sh"
package scipy PIL

cat >truth.py <<'PYTHON'
"""Pictures of a periodic tessellation of 200 cells in its period, whose mean area is 1."""
import contextlib, io, json, re
import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree
from lamella.cells.__main__ import main
from lamella.tissue import Tissue, geometry, tessellation

rng = np.random.default_rng(1)
period = np.sqrt(200) * np.eye(2)
areas = np.exp(0.3 * rng.standard_normal(200))
areas *= 200 / areas.sum()
truth = tessellation.relax(tessellation.spread(200, period, rng), areas, period)
steps = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]) @ period
sites, weights = (truth.sites + steps[:, None]).reshape(-1, 2), np.tile(truth.weights, 9)
nearest = cKDTree(np.column_stack([sites, np.sqrt(weights.max() - weights)]))  # in the power distance

def picture(diameter, line=0, noise=0):
    """Labels with so many pixels to the mean diameter, lines of background between cells and borders that are displaced at
    random (rms, correlated over a pixel); the cell of each label, and the edge of a pixel."""
    count = round(period[0, 0] * diameter * np.sqrt(np.pi / 4))
    pixel = period[0, 0] / count
    middles = (np.arange(count) + 0.5) * pixel
    x = np.stack(np.meshgrid(middles, middles[::-1]), -1)
    if noise:
        shift = ndimage.gaussian_filter(np.random.default_rng(2).standard_normal((count, count, 2)), (1, 1, 0))
        x += noise * pixel * shift / shift.std()
    far, site = nearest.query(np.dstack([x, np.zeros(x.shape[:2])]), [1, 2, 3] if line else [1])
    away = np.linalg.norm(sites[site[..., 1:]] - sites[site[..., :1]], axis=-1)
    wall = ((far[..., 1:]**2 - far[..., :1]**2) / (2 * away)).min(-1, initial=np.inf)  # distance to the nearest one
    used, label = np.unique(site[..., 0], return_inverse=True)
    return np.where(wall < line / 2 * pixel, 0, np.reshape(label, site.shape[:2]) + 1), np.append(-1, used % 200), pixel

def run(labels, pixel, *options):
    """Tissue, read from its file, and what is told."""
    np.save("labels.npy", labels)
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        assert main(["labels.npy", "-o", "tissue.json", "--json", "--pixel", f"{pixel} um", *options]) == 0
    return Tissue.read("tissue.json"), json.loads(out.getvalue())

def whole(tissue, side):
    """Cells that the border of the picture does not cut."""
    return np.array([not np.isclose(tissue.polygon(k) / side, np.rint(tissue.polygon(k) / side), atol=1e-9).any()
                     for k in range(len(tissue.cells))])

def pairs(tissue, cell_of, inside):
    e = tissue.edges
    return {tuple(sorted(cell_of[[a, b]].tolist())) for a, b, c in zip(e.cell, e.cell[e.across], e.across)
            if c >= 0 and inside[a] and inside[b]}

def compare(tissue, cell, pixel):
    """Errors of areas of whole cells, and of junctions in pixels; lengths in pixels of the faces of neighbours that are lost, and
    new neighbours."""
    cell_of = cell[tissue.made_by["labels"]]
    inside = whole(tissue, period[0, 0])
    error = geometry.moments(tissue)[0][inside] / truth.area[cell_of[inside]] - 1
    there = set(cell_of[inside].tolist())
    true = {(i, j): l / pixel for i, j, l in zip(truth.i.tolist(), truth.j.tolist(), truth.length) if i < j and {i, j} <= there}
    found = pairs(tissue, cell_of, inside)
    lost = [l for pair, l in true.items() if pair not in found and period_apart(pair, tissue, cell_of, inside)]
    corners = (truth.polygons()[0] + steps[:, None]).reshape(-1, 2)
    inner = np.unique(np.concatenate([c for c, i in zip(tissue.cells, inside) if i]))
    away = cKDTree(corners).query(tissue.vertices[inner])[0] / pixel
    return error, away, lost, found - set(true)

def period_apart(pair, tissue, cell_of, inside):
    """Whether the two cells lie beside each other in the picture, not across its border."""
    middle = geometry.moments(tissue)[1]
    one, two = (middle[np.flatnonzero((cell_of == c) & inside)[0]] for c in pair)
    return (abs(one - two) < period[0, 0] / 2).all()
PYTHON

# docs/reference/cells.md: pixels of a diameter, line, displacement of borders, --error; largest and rms error of areas, %, and
# rms of junctions, pixels; neighbours that may be lost.
"$python" - <<'PYTHON' || fail "errors of pictures"
from truth import *
for diameter, line, noise, error, largest, rms, junctions, losses in (
        (30, 0, 0, 1, 1.7, 0.45, 0.2, 0), (60, 0, 0, 1, 0.9, 0.2, 0.15, 0), (120, 0, 0, 1, 0.3, 0.07, 0.1, 0),
        (60, 2, 0, 1, 1.1, 0.35, 0.25, 0), (60, 0, 0.5, 2.5, 1.5, 0.55, 0.4, 0), (60, 0, 1, 4.5, 3.3, 1, 0.7, 1)):
    labels, cell, pixel = picture(diameter, line, noise)
    wall = [] if line else ["--wall-thickness", f"{pixel} um"]
    tissue, told = run(labels, pixel, "--error", str(error), *wall)
    areas, away, lost, new = compare(tissue, cell, pixel)
    found = 100 * abs(areas).max(), 100 * areas.std(), np.sqrt((away**2).mean()), len(lost), len(new)
    assert (np.array(found) <= (largest, rms, junctions, losses, losses)).all(), (diameter, line, noise, found)
    assert all(l < 1 for l in lost) and abs(areas.mean()) < 1e-4, (lost, areas.mean())  # without bias
    assert told["bends"] <= 10, told["bends"]  # walls are straight
    assert np.isclose(told["wall_thickness"], pixel, rtol=0.02), told["wall_thickness"]  # half of a line of 2 pixels
    fit = told["fit"]
    assert fit["pairs_kept"] == fit["pairs"] and not fit["pairs_new"] and fit["area_error_largest"] < 1e-3, fit
PYTHON

"$python" - <<'PYTHON' || fail "borders"
from truth import *
labels, cell, pixel = picture(40)
side = period[0, 0]

# a patch fills the picture; its grips are straight
patch, _ = run(labels, pixel, "--wall-thickness", f"{2 * pixel} um")
assert patch.period is None and np.isclose(geometry.moments(patch)[0].sum(), side**2, rtol=1e-9)
y, e = patch.vertices[:, 1], patch.edges
for height in (0, side):
    on = (abs(y[e.start] - height) < 1e-9) & (abs(y[e.end] - height) < 1e-9)
    assert (e.across[on] < 0).all() and np.isclose(geometry.length_of(patch)[on].sum(), side), height

# mirror images fill two by two pictures; all edges have a neighbour; each is its own mirror image
mirror, told = run(labels, pixel, "--wall-thickness", f"{2 * pixel} um", "--as", "mirror")
assert np.allclose(mirror.period, 2 * side * np.eye(2)) and (mirror.edges.across >= 0).all()
assert np.isclose(geometry.moments(mirror)[0].sum(), 4 * side**2, rtol=1e-9)
middle = geometry.moments(mirror)[1]
one, other = (tessellation.wrap(m + 0.1 * side, mirror.period) for m in (middle, middle * [-1, 1]))  # cells lie at 0
assert cKDTree(one, boxsize=2 * side).query(other)[0].max() < 1e-6 * side

# a periodic tessellation: areas, elongation, most of the neighbours
like, told = run(labels, pixel, "--wall-thickness", f"{2 * pixel} um", "--as", "period")
fit, got = told["fit"], told["got"]
assert (like.edges.across >= 0).all() and abs(len(like.cells) - 200) <= 10 and abs(np.linalg.det(like.period) / 200 - 1) < 0.05
assert fit["area_error_largest"] < 1e-3 and fit["pairs_kept"] > 0.97 * fit["pairs"] and fit["pairs_new"] < 0.01 * fit["pairs"]
assert abs(got["elongation"] - fit["elongation_picture"]) < 0.02 and abs(fit["shape_factor"] - fit["shape_factor_picture"]) < 0.01

# stretched by 1.6 along X1: the tessellation, too
rows = np.arange(0, len(labels), 1.6).astype(int)
like, told = run(labels[rows], pixel, "--wall-thickness", f"{pixel} um", "--as", "period")
assert abs(told["got"]["elongation"] - 1.6) < 0.08 and abs(told["got"]["direction"]) < 3, told["got"]

# points in place of short faces
merged, told = run(labels, pixel, "--wall-thickness", f"{2 * pixel} um", "--merge", "0.2")
assert told["faces_merged"] > 5 and told["edges_without_lumen"] == 0, told
assert 0 < told["fit"]["pairs"] - told["fit"]["pairs_kept"] <= told["faces_merged"] and told["fit"]["area_error_largest"] < 1e-3
PYTHON

"$python" - <<'PYTHON' || fail "air, curves and pieces"
from truth import *
labels, cell, pixel = picture(40)
wall = "--wall-thickness", f"{1.5 * pixel} um"

# missing cells: their area is the porosity, of a patch, mirrored and periodic
gone = np.isin(labels, np.arange(5, 240, 12))
for way in ("patch", "mirror", "period"):
    tissue, told = run(np.where(gone, 0, labels), pixel, *wall, "--as", way)
    assert abs(told["fit"]["porosity"] - gone.mean()) < 1e-3 and told["fit"]["pairs_kept"] > 0.96 * told["fit"]["pairs"], told["fit"]

# a round pocket of air at each of two junctions becomes a rounded corner of its area
tissue, _ = run(labels, pixel, *wall)
count = len(tissue.cells)
shortest = geometry.shortest_edges(tissue)[tissue.points[0]] / pixel
meeting = np.bincount(np.concatenate(tissue.cells)) == 3
chosen = np.flatnonzero(meeting & (shortest > 17))[:2]
rows, columns = np.indices(labels.shape) + 0.5
air = np.zeros(labels.shape, bool)
for x, y in tissue.vertices[chosen] / pixel:
    air |= np.hypot(columns - x, len(labels) - rows - y) < 3
tissue, told = run(np.where(air, 0, labels), pixel, *wall)
assert told["pockets"] == 2 and told["pockets_limited"] == 0 and (tissue.radii() > 0).sum() == 2
assert np.isclose(told["fit"]["porosity"], air.mean(), rtol=0.01), (told["fit"]["porosity"], air.mean())

# waves of 4 pixels: bends of two cells, as far from the pixels as the error admits, areas as they are
y, x = np.indices(labels.shape)
waves = ndimage.map_coordinates(labels, [y + 4 * np.sin(x / 11), x + 4 * np.sin(y / 11)], order=0, mode="nearest")[:300, :300]
for error in (1, 3):
    tissue, told = run(waves, pixel, *wall, "--error", str(error))
    assert told["fit"]["area_error_largest"] < 2e-3 and told["deviation_rms"] < 0.5 * error * pixel, told
    assert (told["bends"] > 30) == (error == 1), told["bends"]

# jagged borders: the error that is told leaves walls straight
jagged = picture(60, 0, 1)[0][:250, :250]
_, told = run(jagged, 1, "--wall-thickness", "1 um")
error = re.search(r"jagged, then --error (\S+) ", " ".join(told["told"]))[1]
assert run(jagged, 1, "--wall-thickness", "1 um", "--error", error)[1]["bends"] < 0.05 * told["bends"]

# a speck, a second piece, a hole, and a cell within a cell
y, x = (int(v) for v in ndimage.center_of_mass(labels == 100))
other, (v, u) = labels.copy(), (int(v) for v in ndimage.center_of_mass(labels == 60))
other[y:y + 3, x:x + 3] = 100 + (np.arange(3) == 1) * 900
other[v - 8:v + 8, u - 8:u + 8] = 60 * (np.indices((16, 16)).max(0) < 8)
other[v + 12:v + 15, u:u + 3] = 100
tissue, told = run(other, pixel, *wall)
for words in ("labels of several pieces: 100", "specks, smaller than 0.02 of the median cell, were taken out",
              "background within label 60 became part of it"):
    assert any(re.search(words, line) for line in told["told"]), (words, told["told"])
assert 1000 not in tissue.made_by["labels"] and len(tissue.cells) == count
PYTHON

"$python" - <<'PYTHON' || fail "large labels, cells within others"
from truth import *
import resource
labels, cell, pixel = picture(20)
wall = "--wall-thickness", f"{pixel} um"
tissue, told = run(labels, pixel, *wall)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
large, _ = run(np.where(labels == 100, 2**40, labels.astype(np.int64)), pixel, *wall)
assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < before + 1e5 and np.allclose(large.vertices, tissue.vertices)  # KB
assert sorted(large.made_by["labels"])[-1] == 2**40 and len(large.cells) == len(tissue.cells)

# two cells within a third become part of it, as one does; one around all others is no cell
y, x = (int(v) for v in ndimage.center_of_mass(np.kron(labels == 100, np.ones((2, 2)))))
for second in 1000, 1001:
    other = np.kron(labels, np.ones((2, 2), int))
    other[y - 4:y + 4, x - 4:x], other[y - 4:y + 4, x:x + 4] = 1000, second
    inner, told = run(other, pixel / 2, *wall)
    assert any(f"labels {'1000' if second == 1000 else '1000, 1001'} within label 100 became part of it" in t for t in told["told"]), told
    assert not {1000, 1001} & set(inner.made_by["labels"]) and 100 in inner.made_by["labels"]
PYTHON

"$python" - <<'PYTHON' || fail "no pictures"
from truth import *
from PIL import Image
labels, cell, pixel = picture(20)
Image.fromarray(labels.astype(np.int32)).save("cells.tif", resolution=10000, resolution_unit=3)
Image.fromarray(labels.astype(np.int32)).save("screen.tif", resolution=72, resolution_unit=2)
Image.fromarray(labels.astype(np.uint16)).save("cells.png")
Image.fromarray(np.zeros((9, 9, 3), np.uint8)).save("colours.png")
np.save("mask.npy", labels > 0)
np.save("empty.npy", np.zeros((0, 10)))
np.save("cut.npy", np.kron([[1, 2], [3, 4]], np.ones((20, 20), int)))
np.save("around.npy", np.pad(np.kron([[1, 2], [3, 4]], np.ones((20, 20), int)), 20, constant_values=5))
Image.fromarray((labels % 250).astype(np.uint8)).save("lossy.jpg")
pages = [Image.fromarray(((labels + k) % 250).astype(np.uint8)) for k in range(3)]
for kind in "tif", "gif", "png":
    pages[0].save(f"stack.{kind}", save_all=True, append_images=pages[1:])
open("broken.tif", "wb").write(b"II*" + bytes(99))
for name, height in (("ome.tif", 0.65), ("oblong.tif", 0.7)):
    words = f'<OME><Pixels ID="1" PhysicalSizeX="0.65" PhysicalSizeXUnit="XXm" PhysicalSizeY="{height}"/></OME>'
    Image.fromarray(labels.astype(np.int32)).save(name, description=words)
    data = open(name, "rb").read().replace(b"XXm", "µm".encode())
    open(name, "wb").write(data)
PYTHON
cells="$python -m lamella.cells"
expect 0 -o "of 1 um (of the picture's tags)" $cells cells.tif -o tissue.json --wall-thickness "0.5 um"
expect 0 -o "of 2 um (of --pixel)" $cells cells.png -o tissue.json --wall-thickness "0.5 um" --pixel "2 um" --crop 10,20,150,140
has out.txt "140 x 120 pixels"
rm tissue.json
expect 1 -e "lamella.cells: .*-o" $cells cells.tif
expect 2 -e 'screen.tif: has no tags of its resolution: give --pixel' $cells screen.tif -o tissue.json
expect 2 -e "labels touch each other" $cells cells.tif -o tissue.json
expect 2 -e '--wall-thickness 2: has no unit: "2 um"' $cells cells.tif -o tissue.json --wall-thickness 2
expect 2 -e "half of the cells have no circle within them" $cells cells.tif -o tissue.json --wall-thickness "9 um"
expect 2 -e "colours.png: has the shape (9, 9, 3)" $cells colours.png -o tissue.json --pixel "1 um"
expect 2 -e "a mask of walls and lumens is labelled first" $cells mask.npy -o tissue.json --pixel "1 um"
expect 2 -e "--crop 0,0,5: four whole numbers" $cells cells.tif -o tissue.json --crop 0,0,5
expect 2 -e "--error: .*unit" $cells cells.tif -o tissue.json --error "1 cell"
expect 0 -o "of 0.65 um (of the picture's tags)" $cells ome.tif -o tissue.json --wall-thickness "0.5 um"
rm tissue.json
expect 2 -e "oblong.tif: its pixels are 0.65 um wide and 0.7 um high by its tags" $cells oblong.tif -o tissue.json
for kind in tif gif png; do
  expect 2 -e "stack.$kind: has 3 pages, and a label image has one" $cells stack.$kind -o tissue.json --pixel "1 um"
done
expect 2 -e "empty.npy: has the shape (0, 10)" $cells empty.npy -o tissue.json --pixel "1 um"
expect 2 -e "cut.npy: the picture.s border cuts all of its 4 cells" $cells cut.npy -o tissue.json --pixel "1 um" --wall-thickness "1 um"
expect 2 -e "label 5 lies around all others" $cells around.npy -o tissue.json --pixel "1 um" --wall-thickness "1 um"
expect 2 -e "lossy.jpg: is a JPEG file, which changes labels" $cells lossy.jpg -o tissue.json --pixel "1 um"
expect 2 -e "broken.tif: is no picture that can be read" $cells broken.tif -o tissue.json --pixel "1 um"
expect 4 -e "none.tif: cannot be read: No such file" $cells none.tif -o tissue.json --pixel "1 um"
expect 4 -e "no/tissue.json: cannot be made: make the folder first" $cells cells.tif -o no/tissue.json --wall-thickness "0.5 um"
[ ! -e tissue.json ] || fail "a refused picture has left a file"
