"""Tissue of the walls of a picture: a patch, its mirror images, or a periodic tessellation that is like it."""
from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
from scipy import ndimage
from scipy.linalg import sqrtm

from .. import InputError
from ..tissue import Tissue, geometry
from ..tissue.file import TO_CUT
from ..tissue.merge import without_short_edges
from ..tissue.spaces import Junctions, without
from ..tissue.tessellation import fit_areas, reduced, wrap
from .picture import Picture
from .walls import Walls


def patch(walls: Walls, picture: Picture, pixel: float, thickness: float, unit: str) -> tuple[Tissue, int]:
    """The picture as it is, its lower left corner at 0; pixel and thickness in the unit. Corners have the radii that
    give the pockets of air their areas, as far as edges are long enough: their number that are not."""
    polygons = [walls.polygon(cell) for cell in walls.around]
    used, number = np.unique(np.concatenate(polygons), return_inverse=True)
    cells = np.split(np.ravel(number), np.cumsum([len(p) for p in polygons])[:-1])
    for cell, label in zip(cells, walls.around):
        if len(set(cell.tolist())) < max(len(cell), 3):
            raise InputError(f"label {picture.names[label - 1]}: too little is left by merging: a smaller --merge is wanted")
    tissue = Tissue(unit, None, walls.x[used] * pixel, cells, thickness)
    if not len(picture.pockets):
        return tissue, 0
    junctions, radii = Junctions(tissue), np.zeros(len(used))
    air = np.bincount(tissue.edges.start, geometry.corner_air(geometry.angles(tissue)), len(used))  # over cut^2
    meeting = np.bincount(np.concatenate(cells)) > 2
    for x, y, area in picture.pockets * [pixel, pixel, pixel**2]:
        away = np.where(meeting, np.hypot(*(tissue.vertices - [x, y]).T), np.inf)
        v = int(away.argmin())
        radii[v] = np.sqrt(area / max(air[v], 1e-9)) / TO_CUT
    limited = radii * TO_CUT > junctions.limit
    return replace(tissue, corner_radius=np.minimum(radii, junctions.limit / TO_CUT)), int(limited.sum())


def outer_sides(tissue: Tissue, size: np.ndarray) -> np.ndarray:
    """Whether each cell has an edge on the left, lower, right, upper border of a picture of this size [cells, 4]."""
    sides = np.zeros((len(tissue.cells), 4), bool)
    for k in range(len(tissue.cells)):
        x = tissue.polygon(k)
        on = np.column_stack([x == 0, x == size])
        sides[k] = (on & np.roll(on, -1, axis=0)).any(0)
    return sides


def mirror(tissue: Tissue, size: np.ndarray) -> tuple[Tissue, np.ndarray]:
    """The patch and its images in mirrors along its left and lower border, which repeat with twice its size; cells at
    borders are joined with their images. Number [cells] of the cell of the patch that each is."""
    rows, count, source = [], [], []
    for k, sides in enumerate(outer_sides(tissue, size)):
        if (sides[:2] & sides[2:]).any():
            raise InputError(f"cell {k} lies between two opposite borders: no mirrored tissue has it; take a larger "
                             "picture")
        corners = np.column_stack([tissue.polygon(k), tissue.radii()[tissue.cells[k]]])
        planes = np.where(sides[2:], size, 0)
        joined = sides[:2] | sides[2:]
        for apart in product(*[(0,) if j else (0, 1) for j in joined]):
            images = [np.array(apart) ^ np.array(turn) for turn in product(*[(0, 1) if j else (0,) for j in joined])]
            cell = _joined([_image(corners, flip, planes) for flip in images], joined, planes, k)
            rows.append(cell)
            count.append(len(cell))
            source.append(k)
    vertices, number = np.unique(np.concatenate(rows), axis=0, return_inverse=True)
    cells = np.split(np.ravel(number), np.cumsum(count)[:-1])
    radius = vertices[:, 2] if vertices[:, 2].any() else 0.0
    return replace(tissue, period=np.diag(2 * size), vertices=vertices[:, :2], cells=cells, corner_radius=radius), \
        np.array(source)


def _image(corners: np.ndarray, flip: np.ndarray, planes: np.ndarray) -> np.ndarray:
    image = corners.copy()
    image[:, :2] = np.where(flip, 2 * planes - corners[:, :2], corners[:, :2])
    return image[::-1] if flip.sum() == 1 else image


def _joined(images: list[np.ndarray], joined: np.ndarray, planes: np.ndarray, k: int) -> np.ndarray:
    """Corners of images as one cell, without their edges on the mirrors."""
    following: dict[tuple[float, ...], tuple[float, ...]] = {}
    for image in images:
        on = (image[:, :2] == planes) & joined
        for a, b, inside in zip(image, np.roll(image, -1, axis=0), (on & np.roll(on, -1, axis=0)).any(1)):
            if not inside and following.setdefault(tuple(a), tuple(b)) != tuple(b):
                raise InputError(f"cell {k} and its mirror image meet at a corner, too: crop the picture elsewhere")
    start = next(iter(following))
    loop, at = [start], following[start]
    while at != start:
        loop.append(at)
        at = following[at]
    if len(loop) != len(following):
        raise InputError(f"cell {k} and its mirror image enclose others: crop the picture elsewhere")
    return np.array(loop)


# ---- a tessellation that is like the picture ----

def _air(picture: Picture, pixel: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of the air spaces: area, centroid, and whether they reach the right or upper border."""
    number, count = ndimage.label(picture.labels == 0)
    index = np.arange(1, count + 1)
    area = np.bincount(number.ravel(), minlength=count + 1)[1:] * pixel**2
    middle = np.array(ndimage.center_of_mass(number, number, index)).reshape(-1, 2)[:, ::-1] + 0.5
    return area, middle * pixel, np.isin(index, np.concatenate([number[:, -1], number[-1]]))


def period(tissue: Tissue, picture: Picture, pixel: float, size: np.ndarray) -> tuple[Tissue, np.ndarray, int]:
    """A periodic Laguerre tessellation with the patch's cells, apart from those that the right and upper border cut, so
    that a cell which a border cuts counts once. Areas are those of whole cells; cut ones get quantiles of these, in the
    order of what is seen of them. Spaces are cells that are missing. Sites are the centroids, in the space where cells
    are round, and stay there: moved to the centroids of their own cells, as in tissue that is made of nothing, cells
    become rounder than those of the picture, and fewer neighbours are kept. Number [cells] of the patch's cell that
    each is; and number of short faces that became points."""
    sides, (area, centroid, second) = outer_sides(tissue, size), geometry.moments(tissue)
    whole, kept = ~sides.any(1), np.flatnonzero(~sides[:, 2:].any(1))
    if whole.sum() < 4:
        raise InputError(f"{whole.sum()} cells are not cut by the picture's border: 4 are wanted for --as period")
    wanted, cut = area[kept].copy(), np.flatnonzero(~whole[kept])
    wanted[cut[np.argsort(wanted[cut])]] = np.quantile(area[whole], (np.arange(len(cut)) + 0.5) / max(len(cut), 1))
    air, middle, beyond = _air(picture, pixel)
    here = ~beyond if (~beyond).any() else beyond
    share = air.sum() / np.prod(size)
    spaces = air[here] * (share / (1 - share) * wanted.sum() / max(air[here].sum(), 1e-30))
    wanted, sites = np.concatenate([wanted, spaces]), np.concatenate([centroid[kept], middle[here]])
    scale = np.sqrt(wanted.sum() / np.prod(size))
    shape = np.real(sqrtm((second[whole] / area[whole, None, None] ** 2).mean(0)))
    stretch = shape / np.sqrt(np.linalg.det(shape))
    unit = np.sqrt(wanted.mean())  # tessellations have cells of mean area 1
    lattice = reduced(np.diag(size) * scale @ np.linalg.inv(stretch) / unit)
    t = fit_areas(wrap(sites * scale @ np.linalg.inv(stretch) / unit, lattice), wanted / unit**2, lattice)
    vertices, cells = t.polygons()
    made = Tissue(tissue.unit, np.diag(size) * scale, unit * vertices @ stretch, cells, tissue.wall_thickness)
    made, merged = without_short_edges(made, wanted, float(tissue.wall_thickness))  # type: ignore[arg-type]
    made = without(made, np.arange(len(wanted)) >= len(kept)) if len(spaces) else made
    return made, kept, merged


# ---- how well it fits ----

def lumens(tissue: Tissue) -> np.ndarray:
    """Areas of the lumens [cells]; walls that are too thick leave none, or less."""
    thickness = tissue.thickness()
    assert thickness is not None
    return geometry.lumens(tissue, thickness)


def without_lumen(tissue: Tissue) -> int:
    """Number of edges of cells that are too short for the wall: nothing is left of them on the lumen's side, where a
    wall of the thickness t takes t cot(A/2) at an end with the interior angle A."""
    e, thickness = tissue.edges, tissue.thickness()
    assert thickness is not None
    loss = thickness / np.tan(geometry.angles(tissue) / 2)
    after = np.arange(len(loss)) + 1
    after[e.first[1:] - 1] = e.first[:-1]
    return int((geometry.length_of(tissue) < loss + loss[after]).sum())


def _pairs(tissue: Tissue, source: np.ndarray) -> set[tuple[int, int]]:
    """Neighbours, by the numbers of the patch's cells."""
    e = tissue.edges
    shared = e.across >= 0
    pairs = np.sort(np.column_stack([source[e.cell], source[e.cell[e.across]]])[shared], axis=1)
    return {(a, b) for a, b in pairs.tolist() if a != b}


def fit(tissue: Tissue, source: np.ndarray, seen: Tissue, walls: Walls, picture: Picture,
        pixel: float) -> dict[str, Any]:
    """What the tissue is (`source`: numbers of its cells in the patch `seen`) beside what the picture has. Cells that
    its border cuts count for the porosity only."""
    size = walls.top * pixel
    sides = outer_sides(seen, size).any(1)
    labels = np.array(list(walls.around))
    measured, got = walls.area[labels] * pixel**2, geometry.moments(tissue)[0]
    inner = ~sides[source]
    error = got[inner] / measured[source[inner]] - 1 if inner.any() else np.array([np.nan])
    numbers = set(source[inner].tolist())
    before = {p for p in _neighbours(walls, labels) if numbers >= set(p)}
    after = {p for p in _pairs(tissue, source) if numbers >= set(p)}
    whole = np.prod(size) if tissue.period is None else np.linalg.det(tissue.period)
    rounded = geometry.junction_air(tissue)
    shape = [_shape(t)[cells].mean() for t, cells in ((seen, ~sides), (tissue, inner))]
    area, _, second = geometry.moments(seen)
    texture = geometry.texture(second[~sides], area[~sides]) if not sides.all() else (np.nan, np.nan)
    return {"cells_whole": int(inner.sum()), "area_error_mean": float(error.mean()),
            "area_error_largest": float(np.abs(error).max()), "pairs": len(before), "pairs_kept": len(before & after),
            "pairs_new": len(after - before), "porosity_picture": picture.air,
            "porosity": round(float((whole - got.sum() + rounded) / whole), 12) + 0.0,
            "shape_factor_picture": float(shape[0]),
            "shape_factor": float(shape[1]), "elongation_picture": texture[0], "direction_picture": texture[1]}


def _neighbours(walls: Walls, labels: np.ndarray) -> set[tuple[int, int]]:
    """Pairs of cells that share a face in the picture, by their order."""
    order = {label: k for k, label in enumerate(labels.tolist())}
    pairs = [(order[c.left], order[c.right]) for c in walls.curves if min(c.left, c.right) > 0]
    return {(min(pair), max(pair)) for pair in pairs}


def _shape(tissue: Tissue) -> np.ndarray:
    """4 pi A / P^2 of each cell."""
    perimeter = np.bincount(tissue.edges.cell, geometry.length_of(tissue))
    return 4 * np.pi * geometry.moments(tissue)[0] / perimeter**2
