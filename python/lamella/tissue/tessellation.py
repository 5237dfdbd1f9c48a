"""Periodic Laguerre tessellations with given areas of cells.

Method. Cell i of sites x_i and weights w_i is {x: |x - x_i|^2 - w_i least}; its faces are straight. The tessellation is
the dual of the lower convex hull of the sites lifted to (x, |x|^2 - w) (Aurenhammer, SIAM J. Comput. 16, 1987): a facet
z = 2 v.x + c of the hull is the vertex v. Weights for given areas a_i maximise the concave function of semi-discrete
optimal transport, with gradient a_i - A_i(w) and Hessian dA_i/dw_j = -l_ij / (2 d_ij), where l is the length of a face
and d the distance of its sites: Newton's method, with halved steps while a cell would vanish (Kitagawa, Merigot &
Thibert, J. Eur. Math. Soc. 21, 2019). Sites then move to the centroids of their cells, again and again (Lloyd, IEEE
Trans. Inf. Theory 28, 1982), which makes cells round.

Lengths are such that the mean area of the cells is about 1.
"""
import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import spsolve
from scipy.spatial import ConvexHull, QhullError

from .. import Error

MARGIN = 3.5  #: sides of mean cells around the period, where images of sites are taken first; what lacks is noticed
LOOSE, TIGHT = 1e-2, 1e-11  #: errors of areas, over the mean: while sites move, and in the end
VORONOI, LLOYD = 10, 20  #: steps of Lloyd's method with equal weights, which spreads sites fast, and with given areas


def reduced(period: np.ndarray) -> np.ndarray:
    """The two shortest vectors (rows) of the same lattice, right-handed, by Gauss's method."""
    a, b = period
    while True:
        if a @ a > b @ b:
            a, b = b, a
        steps = np.rint(a @ b / (a @ a))
        if steps == 0:
            return np.array([a, b] if a[0] * b[1] > a[1] * b[0] else [a, -b])
        b = b - steps * a


def wrap(points: np.ndarray, period: np.ndarray) -> np.ndarray:
    """Points [n, 2] moved by whole periods into the parallelogram of the period."""
    return points - np.floor(points @ np.linalg.inv(period)) @ period


class Tessellation:
    """Cells of sites [n, 2] within the parallelogram of a reduced period, and weights [n].

    area [n], centroid [n, 2]; of each face, seen from both sides: i, j [m] its cells, length [m] of the face, distance
    [m] of the sites.
    """

    def __init__(self, sites: np.ndarray, weights: np.ndarray, period: np.ndarray) -> None:
        self.sites, self.weights, self.period = sites, weights, period
        whole = np.linalg.det(period)
        for images in (self._near, self._all):
            try:
                self._build(*images())
            except QhullError:
                continue
            if abs(self.area.sum() - whole) < 1e-9 * whole:  # cells that lack an image of a neighbour are too large
                return
        raise Error("the tessellation does not fill its period: too few cells, or sites that coincide")

    def _all(self) -> tuple[np.ndarray, np.ndarray]:
        reach = 1 if len(self.sites) > 20 else 2  # cells of a few sites reach over whole periods
        steps = range(-reach, reach + 1)
        shifts = np.array([(0, 0)] + [(i, j) for i in steps for j in steps if i or j])
        return np.tile(np.arange(len(self.sites)), len(shifts)), np.repeat(shifts, len(self.sites), axis=0)

    def _near(self) -> tuple[np.ndarray, np.ndarray]:
        """Those images of _all that lie in a margin around the period."""
        site, shift = self._all()
        inverse = np.linalg.inv(self.period)
        margin = MARGIN * np.linalg.norm(inverse, axis=0)
        share = (self.sites @ inverse)[site] + shift
        near = ((share > -margin) & (share < 1 + margin)).all(1)
        return site[near], shift[near]

    def _build(self, site: np.ndarray, shift: np.ndarray) -> None:
        n = len(self.sites)
        points = self.sites[site] + shift @ self.period
        origin = self.period.sum(0) / 2  # around which |x|^2 has the most digits
        lifted = np.column_stack([points, ((points - origin)**2).sum(1) - self.weights[site]])
        hull = ConvexHull(lifted)
        down = hull.equations[:, 2]
        lower = down < -1e-12
        vertex = np.where(lower[:, None], origin - hull.equations[:, :2] / (2 * np.where(lower, down, 1))[:, None], 0)
        t = np.tile(np.arange(len(down)), 3)
        across = hull.neighbors.T.ravel()
        one, two = np.roll(hull.simplices, -1, 1).T.ravel(), np.roll(hull.simplices, -2, 1).T.ravel()
        once = (t < across) & lower[t] & lower[across]
        t, across, one, two = t[once], across[once], one[once], two[once]
        a, b = np.concatenate([one, two]), np.concatenate([two, one])
        t, across = np.concatenate([t, t]), np.concatenate([across, across])
        own = a < n  # the sites themselves are the first
        a, b, self._facets = a[own], b[own], np.column_stack([t, across])[own]
        self._vertex, self.i, self.j = vertex, a, site[b]
        self._measure(points[a], points[b], vertex[self._facets[:, 0]], vertex[self._facets[:, 1]])

    def _measure(self, x: np.ndarray, y: np.ndarray, v: np.ndarray, w: np.ndarray) -> None:
        """Triangles between a site and the faces of its cell, whose areas have a sign: a site may lie outside."""
        n = len(self.sites)
        self.length, self.distance = np.linalg.norm(w - v, axis=1), np.linalg.norm(y - x, axis=1)
        height = (((v + w) / 2 - x) * (y - x)).sum(1) / self.distance
        triangle = self.length * height / 2
        self.area = np.bincount(self.i, triangle, n)
        middle = (v + w - 2 * x) * (triangle / 3)[:, None]
        offset = np.column_stack([np.bincount(self.i, middle[:, k], n) for k in (0, 1)])
        self.centroid = self.sites + offset / np.maximum(self.area, 1e-300)[:, None]

    def polygons(self) -> tuple[np.ndarray, list[np.ndarray]]:
        """Vertices [k, 2], and of each cell their numbers, counter-clockwise."""
        pairs = np.unique(np.column_stack([np.repeat(self.i, 2), self._facets.ravel()]), axis=0)
        away = self._vertex[pairs[:, 1]] - self.centroid[pairs[:, 0]]
        order = np.lexsort([np.arctan2(away[:, 1], away[:, 0]), pairs[:, 0]])
        cell, facet = pairs[order].T
        used, number = np.unique(facet, return_inverse=True)
        bounds = np.searchsorted(cell, np.arange(1, len(self.sites)))
        return self._vertex[used], np.split(np.ravel(number), bounds)


def _newton_step(t: Tessellation, residual: np.ndarray) -> np.ndarray:
    """Change of the weights; that of the first one is 0, since a common constant changes nothing."""
    n = len(t.sites)
    off = coo_matrix((-t.length / (2 * t.distance), (t.i, t.j)), shape=(n, n)).tocsr()
    hessian = (off - diags(np.asarray(off.sum(1)).ravel())).tocsc()
    return np.concatenate([[0], np.atleast_1d(spsolve(hessian[1:, 1:], residual[1:]))])


def fit_areas(sites: np.ndarray, wanted: np.ndarray, period: np.ndarray, weights: np.ndarray | None = None,
              tolerance: float = TIGHT) -> Tessellation:
    """The tessellation whose cells have the areas wanted [n], up to tolerance times their mean. weights: begins with
    these, unless a cell vanishes by them. Error: the areas are not met."""
    t = Tessellation(sites, np.zeros(len(sites)) if weights is None else weights, period)
    if weights is not None and t.area.min() < 0.01 * wanted.min():
        t = Tessellation(sites, np.zeros(len(sites)), period)
    least = 0.5 * min(t.area.min(), wanted.min())
    for _ in range(60):
        residual = wanted - t.area
        if np.abs(residual).max() < tolerance * wanted.mean():
            return t
        change, step = _newton_step(t, residual), 1.0
        while True:
            trial = Tessellation(sites, t.weights + step * change, period)
            if trial.area.min() > least or step < 1e-4:
                break
            step /= 2
        t = trial
    raise Error(f"the areas of the cells are not met: the largest error is {np.abs(residual).max():.2g} mean areas")


def relax(sites: np.ndarray, wanted: np.ndarray, period: np.ndarray, steps: int = LLOYD) -> Tessellation:
    """The tessellation with areas wanted [n] of sites that have moved to the centroids of their cells."""
    weights = None
    for _ in range(steps):
        t = fit_areas(sites, wanted, period, weights, LOOSE)
        sites, weights = wrap(t.centroid, period), t.weights
    return fit_areas(sites, wanted, period, weights)


def spread(n: int, period: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Sites [n, 2] at random, apart from each other."""
    sites = wrap(rng.random((n, 2)) @ period, period)
    for _ in range(VORONOI):
        sites = wrap(Tessellation(sites, np.zeros(n), period).centroid, period)
    return sites
