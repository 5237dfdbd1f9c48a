"""Tissue files: cells at rest, their walls and lumens, air at junctions and where cells are missing."""
import numpy as np
from matplotlib.patches import PathPatch, Polygon, Rectangle
from matplotlib.path import Path

from .. import quantity
from ..tissue import geometry
from ..tissue.file import Tissue
from .page import DARK, DASHES, LINES, RED, WIDTH, Page, number, settle, styled
from .tissue import FADE, LUMEN, Key, View, faded

WALL, AIR = "#8a9a5b", "white"
AROUND = 0.12  #: of the period: what is seen around it
LINE = 0.6  #: points at most: of the outlines of cells
SWATCH = 45  #: points that a colour and its word take
ARC = 9  #: points of a corner's arc
CLASS = 0.65  #: share of white in the colours of classes of cells


def outlines(tissue, thickness):
    """Corners [m, ARC, 2] of cells, with arcs, and of their lumens; m: all corners of cells, those of cell 0 first.
    thickness [m] or None: no lumens."""
    e, angle, cut = tissue.edges, geometry.angles(tissue), geometry.cuts(tissue)
    before = geometry.before(tissue)
    a = tissue.vertices[e.start]
    along = (a - a[before]) / np.linalg.norm(a - a[before], axis=1, keepdims=True)
    inwards = np.column_stack([-along[:, 1], along[:, 0]])
    turn = (np.pi - angle)[:, None] * np.linspace(0, 1, ARC)  # from the edge before to the next one
    normal = np.stack([inwards[:, :1] * np.cos(turn) - inwards[:, 1:] * np.sin(turn),
                       inwards[:, :1] * np.sin(turn) + inwards[:, 1:] * np.cos(turn)], axis=2)
    flat = np.abs(angle - np.pi) < 1e-3
    radius = np.where(flat, 0, cut * np.tan(np.where(flat, 1, angle) / 2))
    centre = np.where(flat[:, None], a, a - cut[:, None] * along + radius[:, None] * inwards)
    cells = centre[:, None] - radius[:, None, None] * normal
    if thickness is None:
        return cells, None
    wall = (thickness + thickness[before]) / 2
    inner = centre[:, None] - (radius - wall)[:, None, None] * normal
    sharp = (radius >= 0) & (radius <= wall) | flat
    corner = geometry.lumen_corners(tissue, thickness)
    return cells, np.where(sharp[:, None, None], corner[:, None], inner)




def _path(points, first, cells):
    """One path of the loops of these cells."""
    loops = [points[first[k]:first[k + 1]].reshape(-1, 2) for k in cells]
    return Path.make_compound_path(*(Path(np.vstack([loop, loop[:1]]), closed=True) for loop in loops))


class Cells:
    """Paths of the cells of a tissue: walls, and lumens by their class."""

    def __init__(self, tissue):
        self.tissue, first = tissue, tissue.edges.first
        self.thickness = tissue.thickness()
        walls, lumens = outlines(tissue, self.thickness)
        classes = np.zeros(len(tissue.cells), int) if tissue.classes is None else np.asarray(tissue.classes)
        self.walls = _path(walls, first, range(len(tissue.cells)))
        self.lumens = {int(k): _path(walls if lumens is None else lumens, first, np.flatnonzero(classes == k))
                       for k in np.unique(classes)}

    @property
    def box(self):
        """What is seen: a period and what is around it, or all of a patch."""
        corners = self.tissue.vertices if self.tissue.period is None else self.period
        low, high = corners.min(0), corners.max(0)
        margin = (0.02 if self.tissue.period is None else AROUND) * (high - low)
        return low - margin, high + margin

    @property
    def period(self):
        """Corners of the parallelogram [4, 2] around the middle of the cells."""
        a, b = self.tissue.period
        area, centroid, _ = geometry.moments(self.tissue)
        return (area @ centroid) / area.sum() - (a + b) / 2 + np.array([0 * a, a, a + b, b])

    def shifts(self):
        """Of the periods that are seen."""
        if self.tissue.period is None:
            return [np.zeros(2)]
        low, high = self.tissue.vertices.min(0), self.tissue.vertices.max(0)
        (x, y), inverse = self.box, np.linalg.inv(self.tissue.period)
        reach = np.ceil(np.abs(np.maximum(high - x, y - low)) @ np.abs(inverse)).astype(int)
        steps = [np.array([i, j]) for i in range(-reach[0], reach[0] + 1) for j in range(-reach[1], reach[1] + 1)]
        shifts = [step @ self.tissue.period for step in steps]
        return [shift for shift in shifts if (low + shift <= y).all() and (high + shift >= x).all()]


def _colour(number_of_class):
    """Of lumens."""
    return faded(LINES[(number_of_class - 1) % len(LINES)], CLASS) if number_of_class else LUMEN


def _draw(view, cells, fade, clip, order):
    """All images of the cells, paler by fade, within a patch (None: everywhere)."""
    if cells.thickness is None:
        parts = [(path, _colour(k), LINE) for k, path in cells.lumens.items()]
    else:
        line = min(LINE, 0.2 * cells.thickness.mean() * view.scale)
        parts = [(cells.walls, WALL, line), *((path, _colour(k), line / 2) for k, path in cells.lumens.items())]
    for number_of_part, (path, face, width) in enumerate(parts):
        for shift in cells.shifts():
            patch = PathPatch(Path(path.vertices + shift, path.codes), linewidth=width, joinstyle="round",
                              facecolor=faded(face, fade), edgecolor=faded(DARK, fade),
                              zorder=order + 0.01 * number_of_part)
            view.axes.add_artist(patch)
            if clip is not None:
                patch.set_clip_path(clip)


def _title(tissue):
    told = tissue.statistics()
    text = f"{told['cells']} cells"
    if tissue.period is not None and told["porosity"] > 0:
        text += f",  porosity {number(round(told['porosity'], 4))}"
    return text


def _swatches(key, cells):
    """What the colours of the tissue are."""
    parts = [("wall", WALL)] if cells.thickness is not None else []
    parts += [("cell" if cells.thickness is None else "lumen", LUMEN)] if 0 in cells.lumens else []
    parts += [(f"class {k}", _colour(k)) for k in cells.lumens if k]
    is_open = cells.tissue.period is not None and (cells.tissue.edges.across < 0).any()
    parts += [("air", AIR)] if is_open or cells.tissue.radii().any() else []
    first = key.y
    for word, colour in parts:
        if key.x + SWATCH > key.right and key.y == first:
            key.row()
        key.axes.add_patch(Rectangle((key.x, key.y - 3), 9, 6, facecolor=colour, edgecolor=DARK, linewidth=0.4))
        key.x += 12
        key.x += key.text(word) + 8


@styled
def draw(path, options):
    """The tissue of a file."""
    cells = Cells(Tissue.read(path))
    low, high = cells.box
    shape = np.clip((high - low)[1] / (high - low)[0], 0.4, 1.6)
    page = Page(WIDTH / 2, 18 + (WIDTH / 2 - 18) * shape + 32, options)
    top = 9 + page.head(_title(cells.tissue), options)
    width, height = page.size
    view = View(page, 9, top, width - 18, height - top - 32, cells.box)
    periodic = cells.tissue.period is not None
    _draw(view, cells, FADE if periodic else 0, None, 1)
    if periodic:
        outline = Polygon(cells.period, facecolor="none", edgecolor=RED, linewidth=0.9, linestyle=DASHES, zorder=3)
        view.axes.add_artist(outline)
        clip = Polygon(cells.period, transform=view.axes.transData)
        view.axes.add_artist(PathPatch(clip.get_path(), facecolor=AIR, edgecolor="none", zorder=1.9))
        _draw(view, cells, 0, clip, 2)
    unit = quantity(f"1 {cells.tissue.unit}", "length")
    key = Key(page, 9, height - 24, width - 9)
    key.scale_bar(view.scale / (unit * 1e6), "µm")
    _swatches(key, cells)
    if periodic:
        if key.y < height - 20:
            key.row()
        key.undeformed("one period;  paler: the same cells again")
    return settle(page)
