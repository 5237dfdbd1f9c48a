"""Walls of a label image as straight faces that neighbours share. Lengths are pixels; x points right, y up.

Method: pixels of different labels meet in cracks. Cracks between two junctions, where three labels meet, are a curve
that both cells share; it begins as one straight face. All vertices together are fitted by least squares: distances of
the cracks' middles from their faces, and areas of cells and air from their pixels (Gauss-Newton; junctions so are where
their walls meet, not at corners of pixels). A curve with a crack farther from its face than the error gets a bend
there, as by Douglas and Peucker, and all is fitted again.
"""
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_matrix, identity
from scipy.sparse.linalg import spsolve

from .. import InputError
from .picture import Picture

OUTSIDE = -1
HOLD = 1e-2  #: weight of a vertex' first place, in cracks: where walls that are in line leave it free
HOLD_BEND = 1.0  #: likewise of a bend, which may slide along faces that are almost in line
HELD, FIXED = 10.0, 1e4  #: likewise of short faces that the fit would turn, and more, until they stay as they are seen
AREA = 10.0  #: weight of areas, as a shift of their borders, over that of cracks: a hundredth of their misfit is left
CORNER = 1.0  #: pixels by which a corner of pixels may be off its junction
BENDING, SETTLING = 4, 30  #: steps of a fit that shows where bends are wanted; at most, until it is settled
SETTLED = 1e-2  #: pixels
ENDS = 2  #: cracks at the ends of a curve, where junctions are rounded by pixels, that make no bend


@dataclass(eq=False)
class Curve:
    """left, right: labels; nodes: numbers of vertices; cracks [m, 2]: their middles; cuts: cracks from cuts[k] to
    cuts[k + 1] are those of the face from node k to the next."""
    left: int
    right: int
    nodes: list[int]
    cracks: np.ndarray
    cuts: list[int]

    def bend(self, at: int, vertex: int) -> None:
        place = int(np.searchsorted(self.cuts, at))
        self.nodes.insert(place, vertex)
        self.cuts.insert(place, at)


def _cracks(labels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cracks [m, 2]: corners of pixels, numbered row by row, from one to the other; labels [m, 2] left and right."""
    padded = np.pad(labels, 1, constant_values=OUTSIDE)
    corner = np.arange((labels.shape[0] + 1) * (labels.shape[1] + 1)).reshape(labels.shape[0] + 1, -1)
    ends, sides = [], []
    for left, right, a, b in ((padded[1:, 1:-1], padded[:-1, 1:-1], corner[:, :-1], corner[:, 1:]),
                              (padded[1:-1, :-1], padded[1:-1, 1:], corner[:-1], corner[1:])):
        differ = left != right
        ends.append(np.column_stack([a[differ], b[differ]]))
        sides.append(np.column_stack([left[differ], right[differ]]))
    return np.concatenate(ends), np.concatenate(sides)


class _Trace:
    """Curves of labels [rows, columns] as they are walked along from junction to junction; corners of the picture are
    junctions, too. What is left are closed curves that meet no other."""

    def __init__(self, labels: np.ndarray) -> None:
        self.columns = labels.shape[1] + 1
        self.ends, self.sides = _cracks(labels)
        last = (labels.shape[0] + 1) * self.columns - 1
        count = np.bincount(self.ends.ravel(), minlength=last + 1)
        self.at: dict[int, list[int]] = {}
        for k, (a, b) in enumerate(self.ends.tolist()):
            self.at.setdefault(a, []).append(k)
            self.at.setdefault(b, []).append(k)
        self.stops = set(np.flatnonzero(count > 2).tolist()) | {0, self.columns - 1, last - self.columns + 1, last}
        self.walked = np.zeros(len(self.ends), bool)
        self.curves = [self.walk(s, k) for s in sorted(self.stops) for k in self.at[s] if not self.walked[k]]
        self.loops = [self.walk(int(self.ends[k, 0]), k) for k in range(len(self.ends)) if not self.walked[k]]

    def walk(self, start: int, crack: int) -> tuple[list[int], int, int]:
        """Corners from a start, and the labels left and right of them."""
        corners = [start]
        forth = self.ends[crack, 0] == start
        left, right = self.sides[crack] if forth else self.sides[crack, ::-1]
        while True:
            self.walked[crack] = True
            a, b = self.ends[crack]
            corners.append(int(b if a == corners[-1] else a))
            if corners[-1] in self.stops or corners[-1] == start:
                return corners, int(left), int(right)
            crack = next(k for k in self.at[corners[-1]] if k != crack)

    def points(self, corners: list[int]) -> np.ndarray:
        return np.column_stack(np.divmod(corners, self.columns)[::-1]).astype(float)


class Walls:
    """Faces of a picture. x [n, 2]: vertices; curves; around: of each cell, by its label in the picture, the curves
    around it counter-clockwise, as (curve, forth?). area: of cells, by their label, in pixels. error: largest distance
    of a crack from its face, but for those at the ends of curves."""

    def __init__(self, picture: Picture, error: float) -> None:
        self.names, self.error = picture.names, error
        self.told: list[str] = []
        picture.fill()
        labels, trace = picture.labels, _Trace(picture.labels)
        if trace.loops:
            raise InputError("air lies around a single cell: there is no tissue")
        self.top, self.area = np.array(labels.shape[::-1], float), np.bincount(labels.ravel()).astype(float)
        corners = sorted({c for path, _, _ in trace.curves for c in (path[0], path[-1])})
        number = {c: k for k, c in enumerate(corners)}
        self.x = trace.points(corners)
        self.curves = []
        for path, left, right in trace.curves:
            points = trace.points(path)
            middles = (points[1:] + points[:-1]) / 2
            self.curves.append(Curve(left, right, [number[path[0]], number[path[-1]]], middles, [0, len(middles)]))
        self.around = self._around()
        self.junctions = len(self.x)
        self._bend_twins()
        self._fit_bends()

    def _around(self) -> dict[int, list[tuple[Curve, bool]]]:
        """Of each cell, in the order of their labels, its curves in a row."""
        leaving: dict[int, dict[int, tuple[Curve, bool]]] = {}
        for curve in self.curves:
            for cell, forth in ((curve.left, True), (curve.right, False)):
                start = curve.nodes[0 if forth else -1]
                if cell > 0 and leaving.setdefault(cell, {}).setdefault(start, (curve, forth)) != (curve, forth):
                    raise InputError(self._no_piece(cell, start))
        around = {}
        for cell, curves in sorted(leaving.items()):
            node = first = next(iter(curves))
            around[cell] = [curves[first]]
            while (node := curves[node][0].nodes[-1 if curves[node][1] else 0]) != first:
                around[cell].append(curves[node])
            if len(around[cell]) != len(curves):
                raise InputError(self._no_piece(cell, first))
        return around

    def _no_piece(self, cell: int, vertex: int) -> str:
        x, y = self.x[vertex]
        return f"label {self.names[cell - 1]}, at pixel ({x:.0f}, {self.top[1] - y:.0f}) from the upper left corner: " \
            "lies around others or meets itself; a cell is one piece without holes"

    def _bend_twins(self) -> None:
        """Curves between the same junctions would be one straight line: each gets a bend where it is widest."""
        ends: dict[tuple[int, ...], list[Curve]] = {}
        for curve in self.curves:
            ends.setdefault(tuple(sorted(curve.nodes)), []).append(curve)
        for curves in ends.values():
            for curve in curves if len(curves) > 1 or curves[0].nodes[0] == curves[0].nodes[1] else []:
                if len(curve.cracks) > 1:
                    self._bend(curve, max(1, int(self._distances(curve).argmax())))

    def _bend(self, curve: Curve, at: int) -> None:
        curve.bend(at, len(self.x))
        self.x = np.vstack([self.x, (curve.cracks[at - 1] + curve.cracks[at]) / 2])

    def _distances(self, curve: Curve) -> np.ndarray:
        """Of the cracks from their faces."""
        n = np.diff(curve.cuts)
        a, b = (np.repeat(self.x[nodes], n, axis=0) for nodes in (curve.nodes[:-1], curve.nodes[1:]))
        along = b - a
        share = ((curve.cracks - a) * along).sum(1) / np.maximum((along ** 2).sum(1), 1e-12)
        return np.hypot(*(curve.cracks - a - np.clip(share, 0, 1)[:, None] * along).T)

    def polygon(self, cell: int) -> np.ndarray:
        """Numbers of the vertices of a cell, counter-clockwise."""
        parts = [c.nodes[:-1] if forth else c.nodes[:0:-1] for c, forth in self.around[cell]]
        return np.concatenate([np.array(p, int) for p in parts])

    # ---- fit ----

    def _points(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Of all cracks the ends of their faces [m], [m], and middles [m, 2]."""
        count = [np.diff(c.cuts) for c in self.curves]
        a, b = (np.concatenate([np.repeat(c.nodes[part], n) for c, n in zip(self.curves, count)]).astype(int)
                for part in (slice(None, -1), slice(1, None)))
        return a, b, np.concatenate([c.cracks for c in self.curves])

    def _rows(self, ends: tuple[np.ndarray, np.ndarray, np.ndarray]) -> tuple[coo_matrix, np.ndarray]:
        """Derivatives of the residuals with respect to the vertices, and residuals, of distances."""
        a, b, p = ends
        along = self.x[b] - self.x[a]
        length = np.maximum(np.hypot(*along.T), 1e-6)
        normal = np.column_stack([-along[:, 1], along[:, 0]]) / length[:, None]
        share = np.clip(((p - self.x[a]) * along).sum(1) / length ** 2, 0, 1)
        row = np.repeat(np.arange(len(p)), 4)
        column = np.column_stack([2 * a, 2 * a + 1, 2 * b, 2 * b + 1]).ravel()
        value = np.column_stack([normal * (1 - share)[:, None], normal * share[:, None]]).ravel()
        return coo_matrix((value, (row, column)), shape=(len(p), self.x.size)), \
            ((p - self.x[a]) * normal).sum(1)

    def _areas(self) -> tuple[coo_matrix, np.ndarray]:
        """Likewise of areas, weighted."""
        rows, columns, values, residual = [], [], [], []
        for k, cell in enumerate(self.around):
            v = self.polygon(cell)
            x = self.x[v]
            turn = np.roll(x, -1, axis=0) - np.roll(x, 1, axis=0)
            weight = AREA / np.sqrt(max(np.hypot(*(np.roll(x, -1, axis=0) - x).T).sum(), 1.0))
            rows.append(np.full(2 * len(v), k))
            columns.append(np.column_stack([2 * v, 2 * v + 1]).ravel())
            values.append(weight / 2 * np.column_stack([turn[:, 1], -turn[:, 0]]).ravel())
            residual.append(weight * (self.area[cell] - (x * np.column_stack([turn[:, 1], -turn[:, 0]])).sum() / 4))
        return coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))),
                          shape=(len(residual), self.x.size)), np.array(residual)

    def _fit(self, steps: int = SETTLING) -> None:
        """Vertices on the picture's border stay on it."""
        ends = self._points()
        free = np.flatnonzero(((self.first > 0) & (self.first < self.top)).ravel())
        hold = np.repeat(self.hold, 2)
        for _ in range(steps):
            matrix, force = identity(self.x.size).multiply(hold[:, None]).tocsr(), hold * (self.first - self.x).ravel()
            for rows, residual in (self._rows(ends), self._areas()):
                rows = rows.tocsr()
                matrix, force = matrix + rows.T @ rows, force + rows.T @ residual
            step = np.zeros(self.x.size)
            step[free] = spsolve(matrix[free][:, free].tocsc(), force[free])
            self.x = self.x + np.clip(step, -1, 1).reshape(-1, 2)  # a face that turns by more is linearised anew
            if np.abs(step).max() < SETTLED:
                break

    def _bend_all(self, error: float) -> bool:
        """Bends curves where they are farther than that from their cracks, once each; whether one is."""
        before = len(self.x)
        for curve in self.curves:
            inner = self._distances(curve)[ENDS:-ENDS]
            if len(inner) and inner.max() > error and int(inner.argmax()) + ENDS not in curve.cuts:
                self._bend(curve, int(inner.argmax()) + ENDS)
        return len(self.x) > before

    def _fit_bends(self) -> None:
        """Bends curves from pixel to pixel, then fits, and bends those that are farther from their cracks than the
        error, until none is; faces that the fit turns round are held."""
        while self._bend_all(self.error + CORNER):
            pass
        self.first, self.hold = self.x.copy(), np.where(np.arange(len(self.x)) < self.junctions, HOLD, HOLD_BEND)
        steps = BENDING
        while True:
            self._fit(steps)
            before = len(self.x)
            bent = self._bend_all(self.error)
            self.first = np.vstack([self.first, self.x[before:]])
            self.hold = np.append(self.hold, np.full(len(self.x) - before, HOLD_BEND))
            turned = self._turned()
            turned = turned[self.hold[turned] < FIXED]
            self.hold[turned] = np.maximum(10 * self.hold[turned], HELD)
            if steps == SETTLING and not bent and not len(turned):
                return
            steps = BENDING if bent or len(turned) else SETTLING

    def _turned(self) -> np.ndarray:
        """Vertices of faces whose direction is more than 60 degrees off: where junctions are near each other, walls
        would cross."""
        a = np.concatenate([c.nodes[:-1] for c in self.curves]).astype(int)
        b = np.concatenate([c.nodes[1:] for c in self.curves]).astype(int)
        now, before = self.x[b] - self.x[a], self.first[b] - self.first[a]
        wrong = (now * before).sum(1) <= 0.5 * np.hypot(*now.T) * np.hypot(*before.T)
        return np.unique(np.concatenate([a[wrong], b[wrong]]))

    # ---- what it is ----

    @cached_property
    def _border(self) -> np.ndarray:
        return ((self.first <= 0) | (self.first >= self.top)).sum(1)

    def deviations(self) -> np.ndarray:
        """Distances of all cracks from their faces, but for those of faces that are merged."""
        return np.concatenate([self._distances(curve) for curve in self.curves if curve.cuts[-1]])

    def bends(self) -> int:
        return sum(max(len(curve.nodes) - 2, 0) for curve in self.curves)

    def faces(self) -> tuple[float, int]:
        """Length of all faces between cells, and their number."""
        shared = [c for c in self.curves if min(c.left, c.right) > 0 and c.cuts[-1]]
        return sum(float(np.hypot(*np.diff(self.x[c.nodes], axis=0).T).sum()) for c in shared), len(shared)

    def merge(self, limit: float) -> int:
        """Faces shorter than the limit become a point, the shortest first; their number. Points of the border stay on
        it, and no face between two of them is taken away."""
        done = 0
        while True:
            short = [(float(np.hypot(*(self.x[a] - self.x[b]))), a, b) for c in self.curves if c.cuts[-1]
                     for a, b in zip(c.nodes[:-1], c.nodes[1:])]
            short = [s for s in short if s[0] < limit and min(self._border[list(s[1:])]) == 0]
            if not short:
                if done:
                    self._fit()
                return done
            _, a, b = min(short)
            if self._border[a] < self._border[b]:
                a, b = b, a
            if not self._border[a]:
                self.x[a] = self.first[a] = (self.x[a] + self.x[b]) / 2
            self._join(a, b)
            done += 1

    def _join(self, a: int, b: int) -> None:
        """Vertex b becomes a; a face between them is gone."""
        for curve in self.curves:
            curve.nodes = [a if v == b else v for v in curve.nodes]
            keep = [k for k in range(len(curve.nodes) - 1) if curve.nodes[k] != curve.nodes[k + 1]]
            if len(keep) < len(curve.nodes) - 1:
                n = np.diff(curve.cuts)
                inside = np.repeat(np.isin(np.arange(len(n)), keep), n)
                curve.cracks, curve.cuts = curve.cracks[inside], [0, *np.cumsum(n[keep]).tolist()]
                curve.nodes = [curve.nodes[k] for k in keep] + [curve.nodes[-1]]
