# slow: pages of pictures: fields on curved elements, outlines, texts that do not lie on each other, states and their
# words, slices that are what queries give, damaged files that are refused in words.
. "$(dirname "$0")/common.sh"

python=${LAMELLA_PYTHON:-/usr/bin/python3}
export PYTHONPATH=$source/python:$source/tests/support LAMELLA_LIBRARY
LAMELLA_LIBRARY=$(dirname "$lamella")
"$python" -c 'import cffi, h5py, matplotlib, yaml' 2>/dev/null || { echo "skipped: python3-cffi, -h5py, -matplotlib, -yaml are not installed"; exit 77; }
[ -f "$LAMELLA_LIBRARY/liblamella.so" ] || { echo "skipped: no shared library in this build"; exit 77; }

tissue >bonded.yaml <<'YAML'
load: [{ramp: {to: [[1, 0.2], [0, 1]], steps: 3}}]
sample: {stretch: {min: 0, max: 0.1}, turgor: {min: 0 MPa, max: 0.02 MPa}}
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, 0 mm]}]
  steps: 1
map: {x: {quantity: turgor, from: 0 MPa, to: 0.04 MPa, points: 2}, y: {quantity: C4, from: 1 MPa, to: 2 MPa, points: 2}}
YAML
cat >torn.yaml <"$source/tests/scenes/apple-tear.yaml"
cat >week.yaml <"$source/tests/scenes/ripening.yaml"
expect 0 "$lamella" rve bonded.yaml -o rve.h5 --no-estimate
expect 0 "$lamella" rve torn.yaml -o torn.h5 --no-estimate
expect 0 "$lamella" build bonded.yaml -d database.h5 --quiet
expect 0 "$lamella" fe2 bonded.yaml -d database.h5 -o fe2.h5 --quiet
expect 0 "$lamella" process week.yaml --frames 3 -o process.h5 --quiet
"$lamella" map bonded.yaml -o map.h5 --quiet >/dev/null || [ $? = 3 ] || fail "no map"

"$python" -W error::RuntimeWarning - <<'PYTHON' || fail "pages"
import os
import shutil
import h5py
import numpy as np
from matplotlib.text import Text
import lamella
from raises import raises
from lamella.plot import curves, mesh, page, tables
from lamella.plot.read import Source

# a curved square and a triangle: area, outline, and values of a quadratic field at places inside
square = np.array([[0, 0], [2, 0], [2, 2], [0, 2], [1, -0.3], [2, 1], [1, 2], [0, 1], [1, 0.9], [4, 0], [3, 1], [3, 0]], float)
elements = np.array([[0, 1, 2, 3, 4, 5, 6, 7, 8], [1, 9, 2, 11, 10, 5, -1, -1, -1]])
m = mesh.Mesh(elements, 12)
assert len(m.loops) == 1 and len(m.inner) == 1 and len(m.loops[0]) == 5
assert np.isclose(mesh.area(m.loops[0], square), 4 + 4 / 3 * 0.3 + 2)
f = lambda x: 1 + x[:, 0] - 2 * x[:, 1]
points, triangles, values = mesh.field(m, square, f(square), 20)
assert np.allclose(values, f(points)) and triangles.max() == len(points) - 1
one = mesh.field(m, square, np.array([3.0, 5.0]), 20, per_element=True)[2]
assert set(one) == {3.0, 5.0}
try:
    mesh.Mesh(np.where(elements == 8, 99, elements), 12)
    raise AssertionError("node 99")
except lamella.InputError:
    pass

# a ring has an outer loop, counter-clockwise, and one around its hole, clockwise
with Source("rve.h5") as source:
    nodes = source.points("mesh/nodes")
    ring = mesh.Mesh(source.elements("mesh/elements"), len(nodes), source.array("mesh/cell_of").ravel())
    areas = sorted(mesh.area(loop, nodes) for loop in ring.loops)
    assert len(areas) == 2 and areas[0] < 0 < areas[1] and areas[1] > -areas[0]

# colours: an element's mean is what the picture shows in its middle
def pixels(drawn):
    drawn.canvas.draw()
    return np.asarray(drawn.canvas.buffer_rgba())[:, :, :3] / 255
drawn = lamella.plot.fe2("fe2.h5", field="J", state=1)
body = drawn.axes[1]  # beside the colour bar, with zooms
image = pixels(drawn)
with Source("fe2.h5") as source:
    F = source.array("macro/step/1/F", 4, 9).reshape(-1, 3, 3)
    x = source.points("macro/nodes") + source.points("macro/step/1/u")
    centres = x[source.elements("macro/elements")[:, 8]]
norm = page.Range(np.linalg.det(F))
for centre, J in zip(centres, np.linalg.det(F)):
    i, j = body.transData.transform(centre + [0.4, 0.3]).astype(int)
    assert np.allclose(image[image.shape[0] - 1 - j, i], page.FIELD(norm(J))[:3], atol=0.02), J

# no text lies on another, whatever the page
def texts(figure):
    figure.canvas.draw()
    axes = [axis for one in figure.axes for axis in (one.xaxis, one.yaxis)]
    ticks = {tick.label1 for axis in axes for tick in [*axis.majorTicks, *axis.minorTicks]} | \
            {tick.label2 for axis in axes for tick in [*axis.majorTicks, *axis.minorTicks]}
    shown = {label for axis in axes if axis.axes.axison for tick in axis._update_ticks() for label in (tick.label1, tick.label2)}
    found = [t for t in figure.findobj(Text) if t.get_visible() and t.get_text().strip()
             and (t not in ticks or t in shown)]
    return [(t.get_text(), t.get_window_extent()) for t in found if t.get_window_extent().width > 0]
pages = [lamella.plot.draw("rve.h5"), lamella.plot.draw("torn.h5", state=6), lamella.plot.draw("torn.h5", strip=True),
         lamella.plot.draw("fe2.h5"), lamella.plot.draw("database.h5"), lamella.plot.draw("database.h5", field="stress"),
         lamella.plot.draw("process.h5"), *lamella.plot.draw("process.h5", film=True),
         lamella.plot.draw("map.h5"), lamella.plot.draw("process.h5", strip=True), lamella.plot.draw("rve.h5", size=(4, 3))]
for k, figure in enumerate(pages):
    boxes = texts(figure)
    assert len(boxes) > 5
    inside = figure.bbox.padded(1)
    for i, (one, a) in enumerate(boxes):
        assert inside.contains(*a.min) and inside.contains(*a.max), (k, one)
        for other, b in boxes[:i]:
            overlap = min(a.x1, b.x1) - max(a.x0, b.x0), min(a.y1, b.y1) - max(a.y0, b.y0)
            assert min(overlap) < 2, (k, one, other)
words = lambda figure: " ".join(text for text, _ in texts(figure))
assert "State 3, peak" in words(pages[0]) and "$P_{21}$" in words(pages[0]) and "µm" in words(pages[0])
assert "lamella: intact" in words(pages[1]) and "contact pressure" in words(pages[1]) and "lamella: intact" in words(pages[2])
assert "reaction per thickness" in words(pages[3]) and "undeformed" in words(pages[3])
assert any("fibre modulus $C_4$ (MPa)" in words(one) for one in pages)
assert "lamella: intact" not in words(pages[0])

# what varies along the states, and the peak
with Source("torn.h5") as source:
    load, peak = curves.LoadAxis(source.responses, source.keys, curves.Measured(source.responses, source.object("test"))), curves.peak(source.responses)
    assert load.component == (1, 1) and source.responses.P[peak, 1, 1] == source.responses.P[:, 1, 1].max()
    assert source.object("test")["component"] == "22"

# a slice shows what queries give
with Source("database.h5") as source:
    database = lamella.Database("database.h5")
    s = tables.Slice(source, database, "15 deg", None, "0.01 MPa", 0.001)
    e = s.low + (s.high - s.low) * (np.array([60, 90]) + 0.5) / tables.SAMPLES
    n = np.array([np.cos(np.radians(15)), np.sin(np.radians(15))])
    m = np.array([-n[1], n[0]])
    r = database.query(np.exp(e[0]) * np.outer(n, n) + np.exp(e[1]) * np.outer(m, m), 1e4, accuracy=np.inf)
    assert np.isclose(s.stress[90, 60], np.linalg.norm(r.P)) and np.isclose(s.error[90, 60], 100 * r.error_estimate)
    assert (database.levels == 0).any() and len(database.levels) == len(source.keys)

# options
drawn = lamella.plot.rve("rve.h5", title=False, range=(0, 1), x=(0, 1), y=(-1, 1), size=(6, 3))
assert drawn.axes[-1].get_xlim() == (0, 1) and drawn.axes[-1].get_ylim() == (-1, 1) and tuple(drawn.get_size_inches()) == (6, 3)
assert "State" not in words(drawn)
assert lamella.plot.rve("rve.h5", title="mine").texts[0].get_text() == "mine" and drawn._repr_png_()[1:4] == b"PNG"

# a film's pages look as that of a state; a state without stress does not stretch the colours of a strip
assert lamella.plot.draw("process.h5", film=True)[0].axes[-1].xaxis.label.get_size() == page.TEXT
(scale,) = [axes for axes in pages[2].axes if axes.get_ylabel().startswith("largest principal")]
with Source("torn.h5") as source:
    most = max(np.abs(source.array(f"fields/{key}/wall_stress")).max() for key in source.keys)
assert np.abs(scale.get_ylim()).max() <= most

# a picture that cannot be written takes nothing away
os.mkdir("taken.png")
try:
    drawn.save("taken.png", 20)
    raise AssertionError("written over a folder")
except OSError:
    assert os.path.isdir("taken.png")

# what does not fit is refused in words
raises(lamella.InputError, "holds states 1 to 3", lambda: lamella.plot.draw("rve.h5", state=9))
raises(lamella.InputError, "wall_stress and fibre_stretch", lambda: lamella.plot.draw("rve.h5", field="J"))
raises(lamella.InputError, 'is of kind "rve"', lambda: lamella.plot.fe2("rve.h5"))
raises(lamella.InputError, "--strip draws files of", lambda: lamella.plot.draw("map.h5", strip=True))
raises(lamella.InputError, "--angle 3 deg: chooses a slice", lambda: lamella.plot.draw("rve.h5", angle="3 deg"))
raises(lamella.InputError, "no such option", lambda: lamella.plot.draw("rve.h5", feild="J"))
raises(lamella.InputError, "nothing that it would change", lambda: lamella.plot.draw("database.h5", x=(0, 1)))
raises(lamella.InputError, "too small", lambda: lamella.plot.draw("rve.h5", size=(2, 8)))
raises(lamella.InputError, "no cells in this picture", lambda: lamella.plot.draw("process.h5", field="wall_stress"))
raises(lamella.InputError, "gram", lambda: lamella.plot.draw("database.h5", turgor="3 gram"))

# arrays that someone has changed: drawn or refused
draw = np.random.default_rng(1)
refusals = 0
for name in ("rve.h5", "torn.h5", "fe2.h5", "map.h5", "process.h5"):
    with h5py.File(name) as file:
        arrays = []
        file.visititems(lambda path, item: arrays.append(path) if isinstance(item, h5py.Dataset) and item.shape and
                        path != "records" else None)
    for path in draw.permutation(arrays)[:5]:
        shutil.copy(name, "changed.h5")
        with h5py.File("changed.h5", "r+") as file:
            values = file[path][()]
            kind = draw.integers(3)
            del file[path]
            if kind == 0 and len(values) > 1:
                file[path] = values[: len(values) // 2]
            elif kind == 1:
                file[path] = values.ravel()
            elif values.dtype.kind == "f":
                file[path] = np.full_like(values, np.nan)
        try:
            lamella.plot.draw("changed.h5", state=None if name == "map.h5" else "last").canvas.draw()
        except lamella.InputError as error:
            assert "changed.h5" in str(error), error
            refusals += 1
assert refusals > 5, refusals
PYTHON

# the names of fields that the program completes are those that there are
"$python" -c 'import lamella; print("\n".join(lamella.plot.fields()))' | sort -u >fields.txt
"$lamella" completion bash | sed -n "/^  plot)/,/^    esac/s/.*--field).*words='\([^']*\)'.*/\1/p" | tr ' ' '\n' | sort -u >completed.txt
[ -z "$(comm -23 fields.txt completed.txt)" ] || fail "not completed: $(comm -23 fields.txt completed.txt)"

# without Python or a package: said so, with what to install
LAMELLA_PYTHON=$PWD/none expect 4 -e 'python3-matplotlib' "$lamella" plot rve.h5
mkdir -p without
printf 'import sys\nsys.modules["matplotlib"] = None\n' >without/sitecustomize.py
PYTHONPATH=$PWD/without:$source/python expect 4 -e 'package matplotlib .Debian: python3-matplotlib' "$lamella" plot rve.h5

# the reference's example
ln -s "$source/tests" tests
cp "$source/docs/reference/pictures.md" .
"$python" -m doctest pictures.md || fail "docs/reference/pictures.md"
