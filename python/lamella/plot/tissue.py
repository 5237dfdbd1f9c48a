"""Cells in a picture: walls with a field, lumens, outlines, periodic images in paler colours; of tissue whose cells can
come apart what is between them (interface.py)."""
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.patches import PathPatch, Polygon, Rectangle
from matplotlib.path import Path

from .. import InputError
from . import interface, mesh as meshes
from .interface import PRESSURE, PULL, VISIBLE_GAP, WIDEST_RIBBON, Interface, faded, is_straight
from .page import DARK, DASHES, FIELD, GAPS, INK, LAMELLA, RED, ROW, SMALL, Range, bar, bar_width, number

FIELDS = {"wall_stress": ("largest principal Cauchy stress", "MPa"), "fibre_stretch": ("fibre stretch", None)}
LUMEN = "#e6f1f7"
FADE = 0.55  #: share of white in the periodic images
MARGIN, CONTACT_MARGIN = 1.1, 0.5  #: apothems around cells: neighbours are seen; where cells part, gaps are seen larger
SCALE_BAR = 52  #: points at most: half of the narrowest panel of a strip
THINNEST_WALL = 1.5  #: points in which the colours of a wall are still told apart
WIDEST_LAMELLA = 1.3  #: points
REACH = 12  #: periods to each side in which images are looked for: more than the margins need


def field_of(name):
    """Name, label and unit of a field of walls."""
    if name is not None and name not in FIELDS:
        raise InputError(f"--field {name}: a file of RVE states has {' and '.join(FIELDS)}")
    name = name or next(iter(FIELDS))
    label, unit = FIELDS[name]
    return name, f"{label} ({unit})" if unit else label


PALE = LinearSegmentedColormap.from_list("pale", [faded(c, FADE) for c in FIELD(np.linspace(0, 1, 256))], N=256)


class View:
    """A window of the plane on the page: axes without ticks. scale: points per unit of length."""

    def __init__(self, page, x, y, width, height, box):
        low, high = np.asarray(box[0], float), np.asarray(box[1], float)
        size = np.maximum(high - low, 1e-30)
        self.page, self.frame = page, (x, y, width, height)
        self.scale = min(width / size[0], height / size[1])
        half = np.array([width, height]) / self.scale / 2
        self.low, self.high = (low + high) / 2 - half, (low + high) / 2 + half
        self.axes = page.area(x, y, width, height)
        self.axes.set(xlim=(self.low[0], self.high[0]), ylim=(self.low[1], self.high[1]), xticks=[], yticks=[])
        self.axes.grid(False)

    def shows(self, box, shift):
        return bool(((box[1] + shift >= self.low) & (box[0] + shift <= self.high)).all())

    def points(self, x):
        """Places on the page, points, from the lower left corner of the view."""
        return (x - self.low) * self.scale


class Cells:
    """The tissue of one state. mesh, fields: groups of the file; F [3, 3] of the state."""

    def __init__(self, source, mesh, fields, field, parts, F):
        self.F = F
        self.nodes = source.points(f"{mesh}/nodes")
        n = len(self.nodes)
        elements = source.elements(f"{mesh}/elements")
        self.period = source.array(f"{mesh}/period", 2, 2, finite=True)
        cell = source.array(f"{mesh}/cell_of", len(elements), 1)
        self.mesh = meshes.Mesh(elements, n, cell, f"{source.path}: {mesh}/elements")
        self.x = source.points(f"{fields}/x", n)
        self.values = source.array(f"{fields}/{field}", n, 1).astype(float).ravel()
        self.interface = Interface(source, mesh, fields, elements, cell.ravel(), self.nodes) if parts else None
        self.forces = None  #: that are to be drawn
        self.outer = [loop for loop in self.mesh.loops if meshes.area(loop, self.nodes) >= 0]
        self.lumens = [loop for loop in self.mesh.loops if meshes.area(loop, self.nodes) < 0]

    @property
    def is_periodic(self):
        return bool(self.period.any())

    @property
    def box(self):
        return self.x.min(axis=0), self.x.max(axis=0)

    @property
    def undeformed_shift(self):
        """Shift of the reference for which both centroids coincide: translations have no meaning in periodic tissue."""
        return (self.x - self.nodes).mean(axis=0)

    @property
    def outer_of(self):
        """Outer edges of each cell."""
        loops = {}
        for loop in self.outer:
            loops.setdefault(int(self.mesh.groups[loop[0, 3]]), []).append(loop)
        return {cell: np.vstack(of) for cell, of in loops.items()}

    def centres(self):
        """Centroids of all cells [cell, 2], lumens included."""
        centres = np.zeros((1 + self.mesh.groups.max(), 2))
        for cell, edges in self.outer_of.items():
            a, b = (self.x[edges[:, [k, k + 1]]].reshape(-1, 2) for k in (0, 1))  # chords of both halves of an edge
            cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
            centres[cell] = (cross @ (a + b)) / (3 * cross.sum())
        return centres

    def images(self, view):
        """Shifts of the images that are seen, the RVE itself last, so that it lies on top."""
        reach = REACH if self.is_periodic else 0
        steps = [(i, j) for i in range(-reach, reach + 1) for j in range(-reach, reach + 1) if i or j]
        shifts = [self.F[:2, :2] @ (i * self.period[0] + j * self.period[1]) for i, j in steps]
        return [shift for shift in shifts if view.shows(self.box, shift)] + [np.zeros(2)]

    def thickness(self):
        """Mean thickness of each cell's wall: its area over the length of its outer loop."""
        hole = {}
        for loop in self.lumens:
            group = self.mesh.groups[loop[0, 3]]
            hole[group] = hole.get(group, 0) + meshes.area(loop, self.x)
        length = lambda loop: np.linalg.norm(self.x[loop[:, 2]] - self.x[loop[:, 0]], axis=1).sum()
        return np.array([(meshes.area(loop, self.x) + hole.get(self.mesh.groups[loop[0, 3]], 0)) /
                         max(length(loop), 1e-30) for loop in self.outer])


def _shifted(path, shift):
    return type(path)(path.vertices + shift, path.codes) if len(path.vertices) else path


def draw(view, cells, norm, gaps, pressure, force, undeformed=True):
    """Lumens, walls with their field, outlines; what is between cells by the scales `gaps`, `pressure` and `force`,
    which states share."""
    axes, images = view.axes, cells.images(view)
    thickness = cells.thickness() * view.scale
    thin = thickness.min(initial=np.inf) < THINNEST_WALL  # lumens' outlines would be in the middle of the wall
    line = 0.25 * max(thickness.min(initial=np.inf), THINNEST_WALL)
    lumens, outer = meshes.paths(cells.lumens, cells.x), meshes.paths(cells.outer, cells.x)
    parts = [(shift, 0 if k == len(images) - 1 else FADE) for k, shift in enumerate(images)]
    order = 1.0
    for shift, fade in parts:
        axes.add_artist(PathPatch(_shifted(lumens, shift), facecolor=faded(LUMEN, fade), edgecolor="none", zorder=1))
    points, triangles, values = meshes.field(cells.mesh, cells.x, cells.values, view.scale, len(images))
    for shift, fade in parts:
        order += 0.001
        painted = meshes.paint(axes, points + shift, triangles, values, norm, PALE if fade else FIELD)
        painted.set_zorder(order)
    for shift, fade in parts:
        ink = faded(DARK, 0.8 * fade)
        if thin:
            _widen(axes, cells, thickness, norm, shift, PALE if fade else FIELD)
        else:
            axes.add_artist(PathPatch(_shifted(lumens, shift), facecolor="none", edgecolor=ink, zorder=2,
                                      linewidth=min(0.4, line / 2)))
        axes.add_artist(PathPatch(_shifted(outer, shift), facecolor="none", edgecolor=ink, zorder=2.1,
                                 linewidth=min(line, 0.5 if fade else 0.9)))
    if undeformed:
        for loop in _border(cells):
            axes.add_artist(PathPatch(Path(loop + cells.undeformed_shift, closed=True), facecolor="none", edgecolor=RED,
                                      linewidth=0.9, linestyle=DASHES, zorder=3))
    for shift, fade in parts if cells.interface else []:
        interface.draw(view, cells.interface, shift, min(WIDEST_LAMELLA, 1.6 * line), gaps, pressure)
        if cells.forces:
            cells.forces.draw(view, shift, fade, force)


def _corners(loop, x):
    """Points [n, 2] around a cell at rest: where air rounds a corner, the corner itself is put between its ends."""
    a, m, b = (x[loop[:, k]] for k in range(3))
    straight = np.flatnonzero(is_straight(a, m, b))
    points = []
    for i, j in zip(straight, np.roll(straight, -1)):
        points.append(a[i:i + 1])
        if (i + 1) % len(loop) != j:
            steps = np.column_stack([b[i] - a[i], a[j] - b[j]])
            points.append(np.array([b[i], a[i] + (b[i] - a[i]) * np.linalg.solve(steps, b[j] - a[i])[0]]))
    return np.concatenate(points) if points else a


def _border(cells):
    """Outline at rest of the RVE as a whole: edges of cells on which no other one's lies, but not around air within."""
    around = [_corners(loop, cells.nodes) for loop in cells.outer]
    start, end = np.vstack(around), np.vstack([np.roll(points, -1, axis=0) for points in around])
    _, where, count = np.unique(np.round(start + end, 6), axis=0, return_inverse=True, return_counts=True)
    start, end = (points[count[np.ravel(where)] == 1] for points in (start, end))
    places = np.unique(np.round(np.vstack([start, end]), 6), axis=0, return_inverse=True)[1].ravel().tolist()
    starts, ends = places[:len(start)], places[len(start):]
    follows, unused, loops = dict(zip(starts, range(len(start)))), set(range(len(start))), []
    while unused:
        k, loop = min(unused), []
        while k in unused:
            unused.remove(k)
            loop.append(start[k])
            k = follows.get(ends[k])
        loops.append(np.array(loop + loop[:1]))
    area = lambda x: (x[:-1, 0] * x[1:, 1] - x[1:, 0] * x[:-1, 1]).sum()
    return [loop for loop in loops if area(loop) > 0]


def _widen(axes, cells, thickness, norm, shift, cmap):
    """Walls that would be too thin to be seen, as wide as the thinnest that is, inwards, by means of their elements."""
    n = np.where(cells.mesh.triangle, 6, 9)
    nodes = np.where(cells.mesh.elements < 0, 0, cells.mesh.elements)
    used = np.arange(9) < n[:, None]
    mean = (cells.values[nodes] * used).sum(axis=1) / n
    for loop, width in zip(cells.outer, thickness):
        if width >= THINNEST_WALL:
            continue
        edges = [_curve(edge, cells.x + shift) for edge in loop]
        lines = LineCollection(edges, colors=cmap(norm(mean[loop[:, 3]])), linewidths=2 * THINNEST_WALL,
                               capstyle="round", zorder=1.9)
        axes.add_artist(lines)
        lines.set_clip_path(PathPatch(meshes.path(loop, cells.x + shift, closed=True), transform=axes.transData))


def _curve(edge, x):
    """Points along a quadratic edge."""
    t = np.linspace(0, 1, 5)[:, None]
    a, m, b = x[edge[0]], x[edge[1]], x[edge[2]]
    return (1 - t) * (1 - 2 * t) * a + 4 * t * (1 - t) * m + t * (2 * t - 1) * b


# ---- below a view ----

class Key:
    """A row of samples and texts on the page, from x to the right; y: its middle."""

    def __init__(self, page, x, y, right):
        self.page, self.left, self.x, self.y, self.right = page, x, x, y, right
        self.axes = page.area(0, 0, *page.size, facecolor="none")
        self.axes.set(xlim=(0, page.size[0]), ylim=(page.size[1], 0))
        self.axes.set_axis_off()

    def text(self, words, room=None, align="left"):
        """Smaller where it would be longer than its room."""
        at = self.right if align == "right" else self.x
        text = self.axes.text(at, self.y, words, ha=align, va="center_baseline", size=SMALL, color=INK)
        wide, room = self.width(text), self.right - self.x if room is None else room
        if wide > room > 0:
            text.set_size(SMALL * room / wide)
        return min(wide, max(room, 0))

    def width(self, text):
        return text.get_window_extent().width * 72 / self.page.dpi

    def row(self):
        self.x, self.y = self.left, self.y + ROW

    def scale_bar(self, points, unit):
        """A bar of a round length, at most SCALE_BAR wide; points: those of one unit."""
        longest = SCALE_BAR / points
        power = 10.0 ** np.floor(np.log10(longest))
        length = power * (5 if longest >= 5 * power else 2 if longest >= 2 * power else 1)
        self.axes.plot([self.x, self.x + length * points], [self.y, self.y], color=INK, linewidth=2,
                       solid_capstyle="butt")
        self.x += length * points + 4
        self.x += self.text(f"{length:g} {unit}") + 10

    def undeformed(self, label):
        """At the right end of the row."""
        wide = self.text(label, self.right - self.x - 23, "right")
        self.axes.plot([self.right - wide - 23, self.right - wide - 4], [self.y, self.y], color=RED, linewidth=0.9,
                       linestyle=DASHES)

    def forces(self, largest):
        """What pulls cells together, and what presses them; the largest one, N/m."""
        self.x += self.text("force between cells:") + 6
        for words, colour in (("tension", PULL), ("compression", PRESSURE)):
            self.axes.plot([self.x, self.x + 19], [self.y, self.y], color=colour, linewidth=WIDEST_RIBBON / 2,
                           solid_capstyle="butt")
            self.x += 23
            self.x += self.text(words) + 8
        self.x += self.text(f"up to {number(largest)} N/m") + 12

    def contact(self, pressure, is_open, has_lamella):
        """Ribbons."""
        words = "no contact"
        if pressure > 0:
            self.axes.add_patch(Polygon([(self.x, self.y), (self.x + 19, self.y - WIDEST_RIBBON / 2),
                                         (self.x + 19, self.y + WIDEST_RIBBON / 2)], color=PRESSURE, linewidth=0))
            more = "" if is_open or has_lamella else ";  no gap above 0.001 apothems"
            words = f"contact pressure, up to {number(pressure)} MPa{more}"
            self.x += 23
        self.x += self.text(words) + 12

    def lamella(self):
        """In a row of its own where it has no room."""
        length, height = 42, 3.6
        if self.x + 58 + 42 + 30 > self.right:
            self.row()
        self.x += self.text("lamella: intact") + 4
        frame = Rectangle((self.x, self.y - height / 2), length, height, facecolor="none", edgecolor=DARK,
                          linewidth=0.4)
        self.axes.imshow([np.linspace(0, 1, 64)], cmap=LAMELLA, norm=Normalize(0, 1), aspect="auto", zorder=1,
                         extent=(self.x, self.x + length, self.y + height / 2, self.y - height / 2))
        self.axes.add_patch(frame)
        self.axes.set(xlim=(0, self.page.size[0]), ylim=(self.page.size[1], 0))
        self.x += length + 4
        self.text("broken")


# ---- a window that states share ----

class Frame:
    """Window, colours and scales of one state or several: norm of the field, gaps, and pressure of the interfaces or
    forces of cells."""

    def __init__(self, several, label, options, reference=False):
        boxes = [c.box for c in several]
        if reference:
            boxes += [((c.nodes + c.undeformed_shift).min(axis=0), (c.nodes + c.undeformed_shift).max(axis=0))
                      for c in several]
        faces = [c.interface for c in several if c.interface]
        margin = CONTACT_MARGIN if faces else MARGIN
        self.box = np.min([b[0] for b in boxes], axis=0) - margin, np.max([b[1] for b in boxes], axis=0) + margin
        self.label = label
        low, high = zip(*(Range(c.values).own for c in several))  # each without its own outliers
        self.norm = Range(np.concatenate([c.values for c in several]),
                          {"range": options.get("range") or (min(low), max(high))})
        widest = max((i.widest for i in faces), default=0)
        self.is_open = widest > VISIBLE_GAP
        self.gaps = Range([], {"range": (0, max(widest, VISIBLE_GAP))})
        self.force = max((c.forces.largest for c in several if c.forces), default=0)
        self.pressure = 0 if self.force > 0 else max((i.largest_pressure for i in faces), default=0)
        self.has_lamella = any(i.has_lamella for i in faces)
        self.parts, self.is_periodic = bool(faces), any(c.is_periodic for c in several)

    @property
    def bars(self):
        """Points that the colour bars take."""
        return bar_width(self.norm) + (bar_width(self.gaps) if self.is_open else 0)

    def draw_bars(self, page, x, y, height):
        bar(page, x, y, height, self.norm, self.label)
        if self.is_open:
            bar(page, x + bar_width(self.norm), y, height, self.gaps, "gap (apothems)", GAPS)

    def draw(self, view, cells, undeformed=False):
        draw(view, cells, self.norm, self.gaps, self.pressure, self.force, undeformed)

    def key(self, page, view, um, right, undeformed=True):
        """Scale bar and legend below the view; um: micrometres of an apothem."""
        x, y, _, height = view.frame
        key = Key(page, x, y + height + 11, right)
        key.scale_bar(view.scale / um, "µm")
        paler = "paler: periodic images" if self.is_periodic else ""
        if undeformed:
            key.undeformed(f"undeformed;  {paler}" if paler else "undeformed")
        elif paler:
            key.text(paler, align="right")
        if self.parts:
            key.row()
            if self.force > 0:
                key.forces(self.force)
            else:
                key.contact(self.pressure, self.is_open, self.has_lamella)
            if self.has_lamella:
                key.lamella()
