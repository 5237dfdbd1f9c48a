"""Meshes of nine-node quadrilaterals and six-node triangles: their outlines, and fields on them, pixel by pixel."""
import numpy as np
from matplotlib.collections import TriMesh
from matplotlib.path import Path
from matplotlib.tri import Triangulation

from .. import InputError

MOST_CUTS = 24  #: of an element per direction
PIECE = 1.0  #: point: pieces of elements on the page, so that curved edges and quadratic fields look smooth
MOST_TRIANGLES = 3e6  #: of one page: elements side by side need less, whatever their number


def _squares(r, s):
    """Biquadratic functions [place, 9] in [-1, 1]^2: corners, mid-edges, centre."""
    a, b = (np.stack([t * (t - 1) / 2, t * (t + 1) / 2, 1 - t * t]) for t in (r, s))
    return np.stack([a[i] * b[j] for i, j in
                     ((0, 0), (1, 0), (1, 1), (0, 1), (2, 0), (1, 2), (2, 1), (0, 2), (2, 2))], axis=-1)


def _triangles(r, s):
    """Quadratic functions [place, 6] of a triangle whose third corner is the side s = 1 of the square: neighbours share
    the points of an edge, as squares do."""
    u, v = (1 + r) / 2, (1 + s) / 2
    L = np.stack([(1 - u) * (1 - v), u * (1 - v), v])
    return np.stack([*(l * (2 * l - 1) for l in L), *(4 * L[i] * L[(i + 1) % 3] for i in range(3))], axis=-1)


class Mesh:
    """elements [n, 9], or [n, 6] of triangles, which have -1 behind their six nodes among others; groups [n]: edges
    between elements of different groups are boundaries of both."""

    def __init__(self, elements, node_count, groups=None, name="elements"):
        elements = np.asarray(elements)
        if elements.shape[1] == 6:
            elements = np.hstack([elements, np.full((len(elements), 3), -1)])
        self.triangle = elements[:, 6] == -1
        used = np.where(self.triangle[:, None] & (np.arange(9) >= 6), 0, elements)
        if used.min(initial=0) < 0 or used.max(initial=0) >= node_count:
            raise InputError(f"{name} is damaged: there is no node {used.min() if used.min() < 0 else used.max()}")
        self.elements = elements
        self.groups = np.zeros(len(elements), int) if groups is None else np.asarray(groups).ravel()
        self._outline()

    def _outline(self):
        """Edges [edge, 3]: start, middle and end, with the element to the left; boundary edges in closed loops, outer
        ones counter-clockwise, those of holes clockwise."""
        parts = []
        for corners, chosen in ((4, ~self.triangle), (3, self.triangle)):
            e = np.flatnonzero(chosen)
            for k in range(corners):
                nodes = self.elements[e][:, [k, corners + k, (k + 1) % corners]]
                parts.append(np.column_stack([nodes, e]))
        edges = np.vstack(parts)
        group = self.groups[edges[:, 3]]
        keys = np.column_stack([group, edges[:, [0, 2]].min(axis=1), edges[:, [0, 2]].max(axis=1)])
        _, first, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
        self.inner = edges[first[count > 1]]  #: [edge, 4]: start, middle, end, element
        boundary = edges[np.sort(first[count == 1])]
        follows = {(self.groups[e[3]], e[0]): i for i, e in enumerate(boundary.tolist())}
        self.loops, unused = [], np.ones(len(boundary), bool)
        for start in range(len(boundary)):
            loop, i = [], start
            while i is not None and unused[i]:
                unused[i] = False
                loop.append(i)
                i = follows.get((self.groups[boundary[i, 3]], boundary[i, 2]))
            if loop:
                self.loops.append(boundary[loop])  #: each [edge, 4]

    def functions(self, x, r, s):
        """Values [element, place, ...] of a nodal quantity at places of each element."""
        values = np.empty((len(self.elements), len(r)) + x.shape[1:])
        for shape, n, chosen in ((_squares(r, s), 9, ~self.triangle), (_triangles(r, s), 6, self.triangle)):
            if chosen.any():
                values[chosen] = np.einsum("pa,ea...->ep...", shape, x[self.elements[chosen, :n]])
        return values

    def sizes(self, x):
        """The larger edge of each element's box."""
        nodes = np.where(self.elements < 0, self.elements[:, :1], self.elements)
        return (x[nodes].max(axis=1) - x[nodes].min(axis=1)).max(axis=1)


def area(loop, x):
    """Area inside a loop: of holes negative. Exact for quadratic edges."""
    a, m, b = (x[loop[:, k]] for k in range(3))
    cross = lambda p, q: p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
    return (4 * cross(a, m) + 4 * cross(m, b) - cross(a, b)).sum() / 6


def path(edges, x, closed=False):
    """Curved edges as a path, each joined to the one before it where that ends at its start."""
    a, m, b = (x[edges[:, k]] for k in range(3))
    points = np.stack([a, 2 * m - (a + b) / 2, b], axis=1).reshape(-1, 2)  # a parabola has one control point
    codes = np.tile(np.array([Path.MOVETO, Path.CURVE3, Path.CURVE3], Path.code_type), len(edges))
    joined = np.zeros(len(edges), bool)
    joined[1:] = edges[1:, 0] == edges[:-1, 2]
    keep = ~np.repeat(joined, 3) | (np.arange(3 * len(edges)) % 3 > 0)
    points, codes = points[keep], codes[keep]
    if closed and len(points):
        points, codes = np.vstack([points, points[:1]]), np.append(codes, np.uint8(Path.CLOSEPOLY))
    return Path(points, codes)


def paths(loops, x):
    """Closed loops as one path."""
    return Path.make_compound_path(*(path(loop, x, closed=True) for loop in loops)) if loops else Path(np.empty((0, 2)))


def field(mesh, x, values, scale, copies=1, per_element=False):
    """Points [n, 2], triangles [m, 3] and values [n] of a field on the mesh at positions x, whose values are of nodes
    or, per_element, of elements. scale: points of the page per unit of length; copies: how often it will be drawn."""
    cuts = int(np.clip(mesh.sizes(x).max(initial=0) * scale / PIECE, 1, MOST_CUTS))
    cuts = max(1, min(cuts, int(np.sqrt(MOST_TRIANGLES / (2 * copies * max(len(mesh.elements), 1))))))
    at = np.linspace(-1, 1, cuts + 1)
    s, r = (grid.ravel() for grid in np.meshgrid(at, at, indexing="ij"))
    points = mesh.functions(x, r, s)
    inside = np.repeat(values[:, None], len(r), axis=1) if per_element else mesh.functions(values, r, s)
    corner = (np.arange(cuts)[:, None] * (cuts + 1) + np.arange(cuts)).ravel()
    one = np.concatenate([np.column_stack([corner, corner + 1, corner + cuts + 2]),
                          np.column_stack([corner, corner + cuts + 2, corner + cuts + 1])])
    triangles = (np.arange(len(mesh.elements))[:, None, None] * len(r) + one).reshape(-1, 3)
    return points.reshape(-1, 2), triangles, inside.ravel()


def paint(axes, points, triangles, values, norm, cmap):
    """Colours of a field, as an image within vector files."""
    painted = TriMesh(Triangulation(*points.T, triangles), norm=norm, cmap=cmap, rasterized=True)
    painted.set_array(values)
    return axes.add_artist(painted)
