"""Geometry of tissue: areas and second moments of cells, air at junctions, what makes a file wrong, statistics.

`tissue` is a Tissue (file.py). Lengths are in its unit.
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial import cKDTree

from .. import InputError

if TYPE_CHECKING:
    from .file import Tissue


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _rows(tissue: Tissue) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Of all edges in a row, those of cell 0 first: its cell, its two ends, and the number of the edge before it."""
    count = np.array([len(cell) for cell in tissue.cells])
    first = np.cumsum(count) - count
    cell = np.repeat(np.arange(len(count)), count)
    before = np.arange(len(cell)) - 1
    before[first] = first + count - 1
    start = np.concatenate(tissue.cells)
    end = np.empty_like(start)
    end[before] = start
    return cell, tissue.vertices[start], tissue.vertices[end], before


def before(tissue: Tissue) -> np.ndarray:
    """Number [m] of the edge of the same cell that ends where each edge starts."""
    return _rows(tissue)[3]


def moments(tissue: Tissue) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Area [cells], negative of clockwise cells, centroid [cells, 2], second moments of area about it [cells, 2, 2]."""
    cell, a, b, _ = _rows(tissue)
    n = len(tissue.cells)
    origin = np.array([tissue.polygon(k).mean(0) for k in range(n)])
    a, b = a - origin[cell], b - origin[cell]
    cross = _cross(a, b)
    area = np.bincount(cell, cross, n) / 2
    safe = np.where(area == 0, 1, area)
    centroid = np.stack([np.bincount(cell, (a + b)[:, k] * cross, n) for k in (0, 1)], 1) / (6 * safe[:, None])
    second = np.empty((n, 2, 2))
    for i in (0, 1):
        for j in (0, 1):
            c = a[:, i] * a[:, j] + b[:, i] * b[:, j] + (a[:, i] + b[:, i]) * (a[:, j] + b[:, j])
            second[:, i, j] = np.bincount(cell, cross * c, n) / 24 - area * centroid[:, i] * centroid[:, j]
    return area, origin + centroid, second


def angles(tissue: Tissue) -> np.ndarray:
    """Interior angle [m] of each cell at the start of each of its edges, 0 to 2 pi."""
    _, a, b, before = _rows(tissue)
    ahead, back = b - a, (a - b)[before]
    return np.arctan2(_cross(ahead, back), (ahead * back).sum(1)) % (2 * np.pi)


def shortest_edges(tissue: Tissue) -> np.ndarray:
    """Of each point (Tissue.points) the length of the shortest edge that ends there."""
    point, e = tissue.points[0], tissue.edges
    length = length_of(tissue)
    shortest = np.full(point.max() + 1, np.inf)
    for vertex in (e.start, e.end):
        np.minimum.at(shortest, point[vertex], length)
    return shortest


def cuts(tissue: Tissue) -> np.ndarray:
    """Cut d [m] of the corner of each cell at the start of each of its edges."""
    from .file import TO_CUT
    return tissue.radii()[tissue.edges.start] * TO_CUT


def corner_air(angle: np.ndarray) -> np.ndarray:
    """Air [m] between corners of cells with these interior angles and the arcs that round them, over the cut d squared.

    The kite between corner, ends of the arc and its centre is d^2 tan(A/2), the sector in it (pi - A) tan(A/2)^2 / 2 of
    d^2. In a reflex corner the arc bulges out of the cell: the same formula is then negative, and takes away from what
    the neighbours lose, so that the sum over a point is the air there, 0 at a bend between two cells.
    """
    rest = np.pi - angle
    flat = np.abs(rest) < 1e-3
    t = np.tan(np.where(flat, 1.0, angle) / 2)
    return np.where(flat, rest / 6, t - t**2 * rest / 2)


def junction_air(tissue: Tissue) -> float:
    """Area of the air at junctions."""
    return float((corner_air(angles(tissue)) * cuts(tissue) ** 2).sum())


def lumen_corners(tissue: Tissue, thickness: np.ndarray) -> np.ndarray:
    """Corners [m, 2] of the lumens where two edges meet that are shifted inwards by thickness [m]: of each cell at the
    start of each of its edges."""
    _, a, b, before = _rows(tissue)
    along = b - a
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    sine = _cross(along[before], along)[:, None]
    straight = np.abs(sine) < 1e-9  # a vertex in the middle of a face
    t, t0 = thickness[:, None], thickness[before, None]
    inwards = np.column_stack([-along[:, 1], along[:, 0]]) * t
    return a + np.where(straight, inwards, (along * t0 - along[before] * t) / np.where(straight, 1, sine))


def lumens(tissue: Tissue, thickness: np.ndarray) -> np.ndarray:
    """Area [cells] of the lumens of cells whose walls are thickness [m] thick: the polygon of the shifted edges, but
    for what arcs cut off where the corner's radius is larger than the wall."""
    cell, _, _, before = _rows(tissue)
    n, inner = len(tissue.cells), lumen_corners(tissue, thickness)
    inner = inner - np.array([tissue.polygon(k).mean(0) for k in range(n)])[cell]
    end = np.empty_like(inner)
    end[before] = inner
    area = np.bincount(cell, _cross(inner, end), n) / 2
    angle = angles(tissue)
    convex = np.clip(angle, 1e-6, 3.1)  # at a flatter corner nothing is cut off that matters
    arc = np.maximum(cuts(tissue) * np.tan(convex / 2) - (thickness + thickness[before]) / 2, 0) * (angle < np.pi)
    return area - np.bincount(cell, (arc / np.tan(convex / 2)) ** 2 * corner_air(convex), n)


# ---- statistics ----

def texture(second: np.ndarray, area: np.ndarray) -> tuple[float, float]:
    """Elongation and direction (degrees from X1, -90 to 90) of the mean over cells of second moments over area squared:
    the root of the ratio of its principal values, which is the ratio of the axes of an ellipse."""
    values, axes = np.linalg.eigh((second / area[:, None, None] ** 2).mean(0))
    direction = np.degrees(np.arctan2(axes[1, 1], axes[0, 1]))
    return float(np.sqrt(values[1] / values[0])), float((direction + 90) % 180 - 90)


def _sides(tissue: Tissue) -> np.ndarray:
    """Number of neighbours of each cell; images of a cell in other periods are neighbours of their own."""
    e = tissue.edges
    away = tissue.vertices[e.start] - tissue.vertices[e.end[e.across]]
    shift = np.rint(0 * away if tissue.period is None else away @ np.linalg.inv(tissue.period))
    shared = e.across >= 0
    pairs = np.column_stack([e.cell, e.cell[e.across], shift])[shared]
    return np.bincount(np.unique(pairs, axis=0)[:, 0].astype(int), minlength=len(tissue.cells))


def statistics(tissue: Tissue) -> dict[str, Any]:
    """Numbers of a tissue. Areas are those of the polygons of cells, with their walls and without rounded corners."""
    area, _, second = moments(tissue)
    e = tissue.edges
    length = length_of(tissue)
    perimeter = np.bincount(e.cell, length)
    shape = 4 * np.pi * area / perimeter**2
    elongation, direction = texture(second, area)
    sides = _sides(tissue)
    told: dict[str, Any] = {
        "cells": len(area), "unit": tissue.unit, "period": None if tissue.period is None else tissue.period.tolist(),
        "area_mean": area.mean(), "area_variation": area.std() / area.mean(),
        "diameter_mean": np.sqrt(4 * area / np.pi).mean(), "elongation": elongation, "direction": direction,
        "shape_factor": shape.mean(), "shape_factor_deviation": shape.std(), "neighbours": sides.mean(),
        "neighbours_count": {int(k): int((sides == k).sum()) for k in np.unique(sides)},
        "edge_shortest": length.min(), "edge_mean": length.mean(), "angle_smallest": np.degrees(angles(tissue).min())}
    air = junction_air(tissue)
    whole = area.sum()
    if tissue.period is not None:
        whole = np.linalg.det(tissue.period)
        spaces = max((whole - area.sum()) / whole, 0.0) if (tissue.edges.across < 0).any() else 0.0
        told |= {"porosity": spaces + air / whole, "porosity_junctions": air / whole, "porosity_spaces": spaces}
    thickness = tissue.thickness()
    if thickness is not None:
        lumen = lumens(tissue, thickness)
        told |= {"wall_share": (area.sum() - air - lumen.sum()) / whole, "lumen_share": lumen.sum() / whole}
    return {name: float(v) if isinstance(v, np.floating) else v for name, v in told.items()}


# ---- what makes a file wrong ----

def check(tissue: Tissue) -> None:
    """InputError unless cells are simple, counter-clockwise, apart from each other and without T-junctions, and their
    walls and corners have room."""
    for k, cell in enumerate(tissue.cells):
        if len(cell) < 3 or len(set(cell.tolist())) != len(cell):
            raise InputError(f"cell {k}: three or more vertices are wanted, all of them different")
    area = moments(tissue)[0]
    if area.min() <= 0:
        raise InputError(f"cell {area.argmin()}: its vertices are not counter-clockwise")
    e, length = tissue.edges, length_of(tissue)
    if length.min() < 1e-6 * tissue.size:
        k = int(length.argmin())
        raise InputError(f"cell {e.cell[k]}: its edge from vertex {e.start[k]} has no length")
    if tissue.period is not None and area.sum() > np.linalg.det(tissue.period) * (1 + 1e-9):
        raise InputError("the cells have more area than a period: they overlap")
    _check_crossings(tissue)
    _check_walls(tissue)


def length_of(tissue: Tissue) -> np.ndarray:
    """Lengths [m] of the edges."""
    return np.linalg.norm(tissue.vertices[tissue.edges.end] - tissue.vertices[tissue.edges.start], axis=1)


def _near_edges(tissue: Tissue, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pairs of edges i, j, and shifts of j, that may touch: all but those of middles too far apart."""
    middle, reach = (a + b) / 2, np.linalg.norm(b - a, axis=1).max()
    shifts = np.zeros((1, 2))
    if tissue.period is not None:
        inverse = np.linalg.inv(tissue.period)
        spread = np.abs((middle.max(0) - middle.min(0) + 2 * reach) @ np.abs(inverse))
        m, n = np.ceil(spread).astype(int)
        shifts = np.array([(i, j) for i in range(-m, m + 1) for j in range(-n, n + 1)]) @ tissue.period
    tree, found = cKDTree(middle), []
    for shift in shifts:
        low, high = middle.min(0) - reach, middle.max(0) + reach
        inside = np.flatnonzero(((middle + shift >= low) & (middle + shift <= high)).all(1))
        if len(inside):
            other = cKDTree(middle[inside] + shift).sparse_distance_matrix(tree, reach, output_type="coo_matrix")
            j, i = inside[other.row], other.col
            found.append((i, j, np.broadcast_to(shift, (len(i), 2))))
    i, j, s = (np.concatenate(parts) for parts in zip(*found))
    return i, j, s


def _check_crossings(tissue: Tissue) -> None:
    """No edge crosses another one or has a vertex within it."""
    e, tolerance = tissue.edges, 1e-6 * tissue.size
    a, b = tissue.vertices[e.start], tissue.vertices[e.end]
    i, j, shift = _near_edges(tissue, a, b)
    p, q = a[j] + shift, b[j] + shift
    along = b[i] - a[i]
    length = np.linalg.norm(along, axis=1)
    high, other = _cross(along, p - a[i]) / length, _cross(along, q - a[i]) / length
    place = ((p - a[i]) * along).sum(1) / length
    within = (np.abs(high) < tolerance) & (place > tolerance) & (place < length - tolerance)
    if within.any():
        k = np.flatnonzero(within)[0]
        raise InputError(f"cell {e.cell[i[k]]}: vertex {e.start[j[k]]} of cell {e.cell[j[k]]} lies within its edge "
                         f"from vertex {e.start[i[k]]} to {e.end[i[k]]}: where cells meet all of them have the vertex")
    back = q - p
    size = np.linalg.norm(back, axis=1)
    low, far = _cross(back, a[i] - p) / size, _cross(back, b[i] - p) / size
    crossing = (np.abs(np.stack([high, other, low, far])) > tolerance).all(0) & (high * other < 0) & (low * far < 0)
    if crossing.any():
        k = np.flatnonzero(crossing)[0]
        one, two = sorted((e.cell[i[k]], e.cell[j[k]]))
        raise InputError(f"cell {one}: its border crosses itself" if one == two and not shift[k].any() else
                         f"cells {one} and {two} overlap")


def _check_walls(tissue: Tissue) -> None:
    from .file import LONGEST_CUT, TO_CUT
    if not isinstance(tissue.unit, str):
        raise InputError("unit: that of a length is wanted")
    radii = tissue.radii()
    limit = LONGEST_CUT * shortest_edges(tissue)[tissue.points[0]]
    wrong = np.flatnonzero((radii < 0) | (radii * TO_CUT >= limit) & (radii > 0))
    if len(wrong):
        v = int(wrong[0])
        raise InputError(f"corner_radius: {radii[v]:g} of vertex {v}: 0 to {limit[v] / TO_CUT:g} is wanted, so that "
                         "the shortest edge there keeps its middle")
    try:
        thickness = tissue.thickness()
    except (ValueError, TypeError):
        raise InputError("wall_thickness: a number is wanted, or of each cell a number or one per face") from None
    if thickness is None:
        return
    if len(thickness) != len(tissue.edges.cell):
        raise InputError(f"wall_thickness: entries for {len(tissue.cells)} cells are wanted, or a number")
    if not (thickness > 0).all():
        raise InputError(f"wall_thickness: of cell {tissue.edges.cell[np.argmin(thickness)]}: it must be positive")
    lumen = lumens(tissue, thickness)
    if lumen.min() <= 0:
        raise InputError(f"wall_thickness: cell {lumen.argmin()} has no lumen: its walls are too thick")
