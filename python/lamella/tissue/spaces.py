"""Air in tissue: cells that are missing, and rounded corners at the junctions."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order

from . import geometry
from .file import LONGEST_CUT, TO_CUT, Tissue

MOST_AIR = 0.5  #: of a cell's perimeter may border missing cells
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

    def hold(self, missing: Sequence[int] | np.ndarray, most: float = MOST_AIR) -> bool:
        """Whether the cells that are not missing have faces with others along enough of their perimeters, and hang
        together, over the period in both directions."""
        kept = np.ones(self.count, bool)
        kept[np.asarray(missing, int)] = False
        inside = kept[self.cell] & kept[self.other]
        cell, other, shift = self.cell[inside], self.other[inside], self.shift[inside]
        faces = np.bincount(cell, self.length[inside], self.count)
        if (faces[kept] < (1 - most) * self.perimeter[kept] * (1 - 1e-12)).any():
            return False
        graph = coo_matrix((np.arange(1, len(cell) + 1), (cell, other)), (self.count, self.count)).tocsr()
        order, before = breadth_first_order(graph, np.flatnonzero(kept)[0])
        if len(order) < kept.sum():
            return False
        return self._wraps(cell, other, shift, order, before)

    def _wraps(self, cell, other, shift, order, before) -> bool:  # type: ignore[no-untyped-def]
        """Whether ways from a cell to its images lead over both periods: places of cells along a tree, and the shifts
        by which other faces differ from them."""
        step = {(c, o): s for c, o, s in zip(cell.tolist(), other.tolist(), shift)}
        place = np.zeros((self.count, 2), int)
        for c in order[1:]:
            place[c] = place[before[c]] + step[int(before[c]), int(c)]
        return bool(np.linalg.matrix_rank(place[cell] + shift - place[other]) == 2)


def choose(tissue: Tissue, count: int, order: np.ndarray, most: float) -> np.ndarray | None:
    """Numbers [count] of cells that can be missing, the first ones possible in this order [cells]; None: too few can.
    most: of a cell's perimeter that may border them."""
    contacts, missing = Contacts(tissue), []
    for cell in order.tolist():
        if len(missing) == count:
            break
        if contacts.hold([*missing, cell], most):
            missing.append(cell)
    return np.array(missing, int) if len(missing) == count else None


def without(tissue: Tissue, missing: np.ndarray) -> Tissue:
    """The tissue without these cells, and without vertices of none."""
    gone = set(np.asarray(missing).tolist())
    cells = [cell for k, cell in enumerate(tissue.cells) if k not in gone]
    used, number = np.unique(np.concatenate(cells), return_inverse=True)
    bounds = np.cumsum([len(c) for c in cells])[:-1]
    return replace(tissue, vertices=tissue.vertices[used], cells=np.split(np.ravel(number), bounds))


class Junctions:
    """Air at the junctions of a tissue, whose corners have one radius as far as short edges admit it."""

    def __init__(self, tissue: Tissue) -> None:
        self.tissue = tissue
        self.limit = LARGEST_CUT * geometry.shortest_edges(tissue)[tissue.points[0]]
        corner = geometry.corner_air(tissue, geometry.angles(tissue))
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
