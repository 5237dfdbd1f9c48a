"""Air in tissue: cells that are missing, and rounded corners at the junctions."""
from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order

from . import geometry
from .file import LONGEST_CUT, TO_CUT, Tissue
from .merge import Failed

MOST_AIR = 0.5  #: of a cell's perimeter may border missing cells
CHOSEN = (0.3, 0.36, 0.42, 0.45)  #: the same while cells are chosen: less, since faces still change their lengths
LARGEST_CUT = 0.999 * LONGEST_CUT  #: less than what is refused, also after the file's 12 digits


class Contacts:
    """Faces between cells: cell, other [m], shift [m, 2] of the other one in whole periods, length [m]."""

    def __init__(self, tissue: Tissue) -> None:
        assert tissue.period is not None
        e = tissue.edges
        shared = e.across >= 0
        away = tissue.vertices[e.start] - tissue.vertices[e.end[e.across]]
        shift = np.rint(away @ np.linalg.inv(tissue.period)).astype(int)
        self.count = len(tissue.cells)
        self.cell, self.other, self.shift = e.cell[shared], e.cell[e.across][shared], shift[shared]
        length = geometry.length_of(tissue)
        self.length, self.perimeter = length[shared], np.bincount(e.cell, length)

    def hold(self, missing: np.ndarray, most: float = MOST_AIR) -> bool:
        """Whether the cells that are not missing (booleans) have faces with others along enough of their perimeters,
        and hang together, over the period in both directions."""
        kept = ~missing
        inside = kept[self.cell] & kept[self.other]
        cell, other, shift = self.cell[inside], self.other[inside], self.shift[inside]
        faces = np.bincount(cell, self.length[inside], self.count)
        if (faces[kept] < (1 - most) * self.perimeter[kept] * (1 - 1e-12)).any():
            return False
        graph = coo_matrix((np.ones(len(cell)), (cell, other)), (self.count, self.count)).tocsr()
        order, parent = breadth_first_order(graph, np.flatnonzero(kept)[0])
        if len(order) < kept.sum():
            return False
        # places of cells along the tree, in periods: sums to the parent, its parent, ... in doubling steps
        pairs, number = np.unique(cell * self.count + other, return_index=True)
        place, up = np.zeros((self.count, 2), int), np.where(parent < 0, np.arange(self.count), parent)
        below = order[1:]
        place[below] = shift[number[np.searchsorted(pairs, parent[below] * self.count + below)]]
        while (up[up] != up).any():
            place, up = place + place[up], up[up]
        # faces off the tree lead to images: they must do so over both periods
        return bool(np.linalg.matrix_rank(place[cell] + shift - place[other]) == 2)


def choose(tissue: Tissue, count: int, before: np.ndarray, order: np.ndarray) -> np.ndarray:
    """Which cells can be missing (booleans), as many as count. before: those that shall be (booleans), if they still
    can; order [cells]: the others are the first possible ones of it, at first those by which no cell loses much.
    Failed: too few can be."""
    contacts = Contacts(tissue)
    first = np.searchsorted(contacts.cell, np.arange(contacts.count + 1))
    air, missing = np.zeros(contacts.count), np.zeros(contacts.count, bool)
    for most, cells in [(CHOSEN[-1], np.flatnonzero(before)), *((most, order) for most in CHOSEN)]:
        for cell in cells:
            if missing.sum() == count:
                break
            faces, more = slice(first[cell], first[cell + 1]), air.copy()
            np.add.at(more, contacts.other[faces], contacts.length[faces])
            near = contacts.other[faces][~missing[contacts.other[faces]]]
            if missing[cell] or (more[near] > most * contacts.perimeter[near]).any():
                continue
            missing[cell] = before[cell] or contacts.hold(missing | (np.arange(contacts.count) == cell))
            air = more if missing[cell] else air
    if missing.sum() < count or not contacts.hold(missing):
        raise Failed("too few cells can be missing")
    return missing


def without(tissue: Tissue, missing: np.ndarray) -> Tissue:
    """The tissue without these cells (booleans), and without vertices of none."""
    cells = [cell for cell, gone in zip(tissue.cells, missing) if not gone]
    used, number = np.unique(np.concatenate(cells), return_inverse=True)
    bounds = np.cumsum([len(c) for c in cells])[:-1]
    return replace(tissue, vertices=tissue.vertices[used], cells=np.split(np.ravel(number), bounds))


class Junctions:
    """Air at the junctions of a tissue, whose corners have one radius as far as short edges admit it."""

    def __init__(self, tissue: Tissue) -> None:
        self.tissue = tissue
        self.limit = LARGEST_CUT * geometry.shortest_edges(tissue)[tissue.points[0]]
        corner = geometry.corner_air(geometry.angles(tissue))
        self._air = np.bincount(tissue.edges.start, corner, len(tissue.vertices))  # over d^2, of each vertex

    def air(self, radius: float) -> float:
        """Area of air in a period."""
        return float((self._air * np.minimum(radius * TO_CUT, self.limit) ** 2).sum())

    @property
    def largest(self) -> float:
        """The largest radius: half of the vertices have it, edges are too short for it at the others."""
        return float(np.median(self.limit)) / TO_CUT

    def filled(self, area: float) -> Tissue:
        """The tissue with this area of air."""
        if area <= 0:
            return self.tissue
        radius = brentq(lambda r: self.air(r) - area, 0, self.largest, xtol=1e-14 * self.largest)
        radii = np.minimum(radius, self.limit / TO_CUT)
        return replace(self.tissue, corner_radius=float(radius) if radii.min() == radius else radii)
