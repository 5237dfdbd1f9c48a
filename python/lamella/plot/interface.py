"""What is between cells in a picture: gaps, contact pressure, the lamella, and forces from cell to cell.

Gaps are strips between two walls, coloured by their width; thinner ones than a line are drawn with a line's width, so
that an open face never looks closed. Walls that leave each other by arcs at rest have air between them, and no gap.
Pressure is a ribbon along the face, widest at the largest pressure. The lamella is a line along the face, from black to
white by the share of its energy that is spent; where it still holds across a gap that is seen, threads cross the gap.
Forces are lines between centroids of cells, as wide as the normal force on their face is large.
"""
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb

from .. import InputError
from .page import DARK, GAPS, LAMELLA

PRESSURE, PULL = "#f28700", "#0072b2"  #: what presses cells together, and what pulls them
VISIBLE_GAP = 1e-3  #: apothems
THINNEST_GAP, WIDEST_RIBBON, WIDEST_FORCE = 1.1, 5, 5.5  #: points
CASING = 1.6  #: of the lamella's line: width of its dark outlines over its own
THREAD, THREAD_DISTANCE, SHORTEST_THREAD = 0.7, 2.6, 1.5  #: points
ROUNDING = 1e-5  #: of C1 + C2: a smaller contact pressure is the solver's tolerance
HOLDS = 0.999  #: a lamella less broken than this is drawn across gaps
STRAIGHT = 1e-6  #: of its length, by which the middle of a straight edge may be off its chord: rounding
PER_EDGE = 4  #: samples of a file along an element's edge


def is_straight(a, middle, b):
    """Whether quadratic edges [..., 2] are straight lines."""
    off, along = middle - a, b - a
    return np.abs(along[..., 0] * off[..., 1] - along[..., 1] * off[..., 0]) <= STRAIGHT * (along**2).sum(axis=-1)


def faded(colour, share):
    return tuple(c + share * (1 - c) for c in to_rgb(colour))


class Interface:
    """Samples along the faces at one state (docs/reference/files.md): arrays [face, point, ...].

    faces [face, 3]: cell, its face, the cell across; edges [face, edge, 3]: nodes of the wall's outer edges; air [face,
    point - 1]: whether the walls between two samples leave each other at rest."""

    def __init__(self, source, mesh, fields, elements, cell, nodes):
        read = lambda name: source.array(f"{fields}/interface/{name}")
        self.start, self.to, self.gap, self.pressure = map(read, ("from", "to", "gap", "pressure"))
        shape = self.gap.shape
        self.has_lamella = source.has(f"{fields}/interface/broken")
        vectors, numbers = [self.start, self.to], [self.pressure]
        if self.has_lamella:
            self.across, self.broken = map(read, ("across", "broken"))
            vectors, numbers = [*vectors, self.across], [*numbers, self.broken]
        self.force = read("normal_force") if source.has(f"{fields}/interface/normal_force") else None  #: of the lamella
        self.faces = source.array(f"{mesh}/interface_faces", len(self.gap), 3)
        known = len(shape) == 2 and np.isin(self.faces[:, ::2], cell).all()
        self.edges = self._edges(elements, cell) if known else None
        if len(shape) != 2 or any(v.shape != shape + (2,) for v in vectors) or any(v.shape != shape for v in numbers) \
                or self.edges is None:
            raise InputError(f"{source.path}: {fields}/interface is damaged")
        self.air = np.repeat(~is_straight(*np.moveaxis(nodes[self.edges], 2, 0)), PER_EDGE, axis=1)
        self.gap = np.where(np.pad(self.air, ((0, 0), (1, 0)), constant_values=True) &
                            np.pad(self.air, ((0, 0), (0, 1)), constant_values=True), np.nan, self.gap)
        self.widest = float(np.nanmax(self.gap, initial=0))
        largest = float(np.nanmax(self.pressure, initial=0))  # MPa
        self.largest_pressure = largest if largest * 1e6 > ROUNDING * source.stress_unit else 0.0

    def _edges(self, elements, cell):
        """None: they do not fit. Elements of a face follow each other along it, and those through the wall outwards."""
        along = (self.gap.shape[-1] - 1) // PER_EDGE
        through = 1 + int(np.argmin(np.append(elements[:-1, 1] == elements[1:, 0], False)))
        first = np.searchsorted(cell, self.faces[:, 0]) // max(along * through, 1) + self.faces[:, 1]
        outer = ((first[:, None] * along + np.arange(along)) + 1) * through - 1
        if along < 1 or outer.min(initial=0) < 0 or outer.max(initial=0) >= len(elements):
            return None
        return elements[outer][:, :, [1, 5, 2]]


class Forces:
    """Normal forces between cells, one for each face: force [face], N per m of thickness, tension positive; lines
    [face, 2, 2]: from centroid to centroid, of the image that is across."""

    def __init__(self, cells, apothem, cohesion):
        """cohesion in MPa."""
        i = cells.interface
        present = np.linalg.norm(np.diff(i.start, axis=1), axis=2)
        mean = lambda values: (values[:, 1:] + values[:, :-1]) / 2
        self.force = 1e6 * apothem * ((cohesion - mean(i.pressure)) * present).sum(axis=1)
        if i.force is not None:
            self.force += 1e3 * i.force
        centre = cells.centres()
        to = centre[i.faces[:, 2]] + self._images(cells) @ cells.F[:2, :2].T
        self.lines = np.stack([centre[i.faces[:, 0]], to], axis=1)
        self.largest = float(np.abs(self.force).max(initial=0))

    def draw(self, view, shift, fade, largest):
        """Compression below tension: chains of forces are what holds the tissue together."""
        order = np.argsort(self.force)
        widths = WIDEST_FORCE * np.abs(self.force[order]) / max(largest, 1e-30)
        colours = [faded(PULL if force > 0 else PRESSURE, fade) for force in self.force[order]]
        view.axes.add_artist(LineCollection(self.lines[order] + shift, colors=colours, linewidths=widths, zorder=4,
                                            capstyle="round", alpha=0.85))

    @staticmethod
    def _images(cells):
        """Shifts at rest [face, 2] of the cells across: by them an edge of theirs lies on one of the face."""
        if not cells.is_periodic:
            return np.zeros((len(cells.interface.faces), 2))
        i, middles = cells.interface, {k: cells.nodes[loop[:, 1]] for k, loop in cells.outer_of.items()}
        straight, shifts = np.argmin(i.air[:, ::PER_EDGE], axis=1), []
        for (_, _, other), edges, k in zip(i.faces, i.edges, straight):
            steps = (cells.nodes[edges[k, 1]] - middles[other]) @ np.linalg.inv(cells.period)
            nearest = np.abs(steps - np.round(steps)).sum(axis=1).argmin()
            shifts.append(np.round(steps[nearest]) @ cells.period)
        return np.array(shifts)


# ---- what is drawn ----

def draw(view, i, shift, width, gaps, pressure):
    """pressure: the largest; 0: none is drawn."""
    if pressure > 0:
        _ribbons(view, i, shift, CASING * width if i.has_lamella else 0, pressure)
    if i.has_lamella:
        _lamella(view, i, shift, width)
    _gaps(view, i, shift, gaps)
    if i.has_lamella:
        _threads(view, i, shift)


def _ribbons(view, i, shift, line, pressure):
    """Along one edge of the ribbon and back along the other; as much wider than zero as the lamella's line."""
    x = i.start + shift
    along = np.empty_like(x)
    along[:, 1:-1] = x[:, 2:] - x[:, :-2]
    along[:, 0], along[:, -1] = x[:, 1] - x[:, 0], x[:, -1] - x[:, -2]
    along /= np.maximum(np.linalg.norm(along, axis=2, keepdims=True), 1e-30)
    normal = np.stack([-along[..., 1], along[..., 0]], axis=2)
    half = 0.5 * (np.where(i.pressure > 0, line, 0) + WIDEST_RIBBON * i.pressure / pressure) / view.scale
    edges = np.concatenate([x + normal * half[..., None], (x - normal * half[..., None])[:, ::-1]], axis=1)
    pressed = (i.pressure > 0).any(axis=1)
    view.axes.add_artist(PolyCollection(edges[pressed], facecolors=PRESSURE, edgecolors="none", zorder=4))


def _gaps(view, i, shift, gaps):
    with np.errstate(invalid="ignore"):
        open_ = i.gap[:, :-1] + i.gap[:, 1:] > 2 * VISIBLE_GAP  # false also where a sample faces no wall
    strips = np.stack([i.start[:, :-1], i.start[:, 1:], i.to[:, 1:], i.to[:, :-1]], axis=2)[open_] + shift
    colours = GAPS(gaps(0.5 * (i.gap[:, :-1] + i.gap[:, 1:])[open_]))
    view.axes.add_artist(PolyCollection(strips, facecolors=colours, edgecolors=colours, linewidths=THINNEST_GAP,
                                            joinstyle="round", zorder=6))


def _stretch(view, i):
    """Points on the page between the sides of the lamella at each sample; 0: it is between walls that are not apart."""
    with np.errstate(invalid="ignore"):
        return np.where(i.gap > VISIBLE_GAP, np.linalg.norm(i.across - i.start, axis=2) * view.scale, 0)


def _lamella(view, i, shift, width):
    """The line along the faces; nothing where the gap shows that it is broken, or threads are drawn."""
    stretch, broken = _stretch(view, i), 0.5 * (i.broken[:, 1:] + i.broken[:, :-1])
    longest = np.maximum(stretch[:, 1:], stretch[:, :-1])
    drawn = ~((longest >= SHORTEST_THREAD) | ((longest > 0) & (broken > HOLDS)) | i.air)
    pieces = np.stack([i.start[:, :-1], i.start[:, 1:]], axis=2)[drawn] + shift
    for colours, wide in ((DARK, CASING * width), (LAMELLA(broken[drawn]), width)):
        view.axes.add_artist(LineCollection(pieces, colors=colours, linewidths=wide, capstyle="round", zorder=5))


def _threads(view, i, shift):
    """Across the gaps, as far apart as they are told apart."""
    stretch, lines, colours = _stretch(view, i), [], []
    at = view.points(i.start)
    for face in range(len(i.gap)):
        last = None
        for k in np.flatnonzero((stretch[face] >= SHORTEST_THREAD) & (i.broken[face] <= HOLDS)):
            if last is not None and np.hypot(*(at[face, k] - last)) < THREAD_DISTANCE:
                continue
            last = at[face, k]
            lines.append(np.stack([i.start[face, k], i.across[face, k]]) + shift)
            colours.append(LAMELLA(i.broken[face, k]))
    view.axes.add_artist(LineCollection(lines, colors=colours, linewidths=THREAD, zorder=7))


