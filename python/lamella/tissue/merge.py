"""Short edges, which Laguerre tessellations have: their two ends are merged into one point, where more than three cells
then meet, and points move a little so that all cells have their areas again.

The change of points is the smallest one (in the sum of squares) that gives the cells their areas: Newton's method with
dx = J^T (J J^T)^-1 (wanted - area), where J has the derivatives of areas by points.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

from .. import Error
from .file import Tissue

SHORTEST = 0.15  #: of the mean edge: 2 % of the edges are shorter (docs/reference/tissue.md); with less, walls are left
#: that need fine meshes, with more, tissue loses its junctions of three cells
ROUNDS = 50  #: of merging and moving; each merges at least one edge
AREA = 1e-11  #: error of an area over the mean


class Failed(Error):
    """These cells cannot be had from this tessellation: another one may give them."""


class Complex:
    """Points x [n, 2] and the corners of cells in a row [m], those of cell 0 first: cell, point, and shift [m, 2] of
    the point in whole periods."""

    def __init__(self, tissue: Tissue) -> None:
        assert tissue.period is not None
        point, shift = tissue.points
        vertex = np.concatenate(tissue.cells)
        self.period, self.tissue = tissue.period, tissue
        self.x = tissue.vertices[np.unique(point, return_index=True)[1]]
        self.cell = np.repeat(np.arange(len(tissue.cells)), [len(c) for c in tissue.cells])
        self.point, self.shift = point[vertex], shift[vertex]
        self._drop()

    def _link(self) -> None:
        count = np.bincount(self.cell, minlength=len(self.tissue.cells))
        if count.min() < 3:
            raise Failed("a cell has collapsed")
        first = np.cumsum(count) - count
        self.next = np.arange(len(self.cell)) + 1
        self.next[first + count - 1] = first
        self.count, self.before = count, np.argsort(self.next)

    def _drop(self) -> None:
        """Corners that are the same as the next one of their cell go."""
        self._link()
        same = (self.point == self.point[self.next]) & (self.shift == self.shift[self.next]).all(1)
        self.cell, self.point, self.shift = self.cell[~same], self.point[~same], self.shift[~same]
        self._link()

    def corners(self) -> np.ndarray:
        return self.x[self.point] + self.shift @ self.period

    def short(self, thickness: float) -> np.ndarray:
        """Edges that are too short, the shortest one first: for the mean edge, the wall, or the lumen on their side,
        whose edge is shorter by t cot(A/2) at an end with the interior angle A."""
        x = self.corners()
        ahead = x[self.next] - x
        length, back = np.linalg.norm(ahead, axis=1), -ahead[self.before]
        sine = ahead[:, 0] * back[:, 1] - ahead[:, 1] * back[:, 0]
        angle = np.arctan2(sine, (ahead * back).sum(1)) % (2 * np.pi)
        loss = thickness / np.tan(np.maximum(angle, 1e-6) / 2)
        lumen = loss + loss[self.next] + (SHORTEST * thickness if thickness else 0)
        limit = np.maximum(max(SHORTEST * length.mean(), thickness), lumen)
        found = np.flatnonzero(length < limit)
        return found[np.argsort(length[found], kind="stable")]

    def merge(self, edges: np.ndarray) -> int:
        """Merges the ends of those edges that have no point or cell in common with one before them; their number."""
        to, by = np.arange(len(self.x)), np.zeros((len(self.x), 2), int)
        merged, points, cells = 0, set[int](), set[int]()
        twin = {(p, q): c for p, q, c in zip(self.point.tolist(), self.point[self.next].tolist(), self.cell.tolist())}
        x = self.corners()
        for e in edges:
            a, b = int(self.point[e]), int(self.point[self.next[e]])
            both = {int(self.cell[e]), twin[b, a]}
            if a == b or points & {a, b} or cells & both or min(self.count[c] for c in both) < 4:
                continue
            points |= {a, b}
            cells |= both
            to[b], by[b] = a, self.shift[e] - self.shift[self.next[e]]
            self.x[a] += (x[self.next[e]] - x[e]) / 2
            merged += 1
        self.shift = self.shift + by[self.point]
        self.point = to[self.point]
        self._drop()
        return merged

    def move(self, wanted: np.ndarray) -> None:
        """Gives the cells these areas [cells]."""
        n = len(wanted)
        for _ in range(30):
            x = self.corners()
            y = x[self.next]
            area = np.bincount(self.cell, x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0], n) / 2
            if np.abs(wanted - area).max() < AREA * wanted.mean():
                return
            slope = (y - x[self.before]) @ np.array([[0, -0.5], [0.5, 0]])  # of the area by the corner
            J = coo_matrix((slope.ravel(), (np.repeat(self.cell, 2),
                                            (2 * self.point[:, None] + [0, 1]).ravel())), (n, 2 * len(self.x))).tocsr()
            J, rest = J[1:], (wanted - area)[1:]  # all areas together are that of the period
            self.x = self.x + (J.T @ np.atleast_1d(spsolve((J @ J.T).tocsc(), rest))).reshape(-1, 2)
        raise Failed("the areas of cells without short edges are not met")

    def to_tissue(self) -> Tissue:
        corners, vertex = np.unique(np.column_stack([self.point, self.shift]), axis=0, return_inverse=True)
        cells = np.split(np.ravel(vertex), np.cumsum(self.count)[:-1])
        return replace(self.tissue, vertices=self.x[corners[:, 0]] + corners[:, 1:] @ self.period, cells=cells)


def without_short_edges(tissue: Tissue, wanted: np.ndarray, thickness: float) -> tuple[Tissue, int]:
    """The tissue without edges shorter than SHORTEST of the mean edge, than the wall (thickness) and than the lumens
    need, with cells of the areas wanted [cells], and the number of edges that are merged. Failed: there is none."""
    cells, merged = Complex(tissue), 0
    for _ in range(ROUNDS):
        short = cells.short(thickness)
        if not len(short):
            return cells.to_tissue(), merged
        count = cells.merge(short)
        if not count:
            raise Failed("an edge is too short for the wall, and its cell has only three")
        merged += count
        cells.move(wanted)
    raise Failed("short edges are left")
