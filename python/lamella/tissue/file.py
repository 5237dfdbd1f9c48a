"""Tissue files: cells as polygons, periodic or as a patch (docs/reference/tissue.md has the format)."""
import json
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from .. import InputError, quantity, parse_yaml
from .._files import may_write, with_member, write_whole
from . import geometry

VERSION = 1
SAME = 1e-6  #: of the mean cell's size: points that are closer are the same (the format says so)
LONGEST_CUT = 0.45  #: of the shortest edge at a vertex: the two cuts of an edge leave a tenth of it (the format)
TO_CUT = np.tan(np.pi / 6)  #: cut along the edges over the radius of a corner of 120 degrees


@dataclass
class Edges:
    """Edges of all cells in a row, those of cell 0 first: edge k of a cell runs from its vertex k to the next one.

    cell, start, end [m]: the cell, and numbers of vertices; across [m]: number of the same edge seen from the
    neighbour, -1: none, it borders air; first [cells + 1]: number of each cell's first edge.
    """
    cell: np.ndarray
    start: np.ndarray
    end: np.ndarray
    across: np.ndarray
    first: np.ndarray


@dataclass
class Tissue:
    """Cells of tissue. Lengths are in `unit`; what is computed is computed when it is first asked for: a changed tissue
    is a new Tissue (dataclasses.replace).

    period [2, 2]: rows are the period vectors, right-handed; None: a patch. vertices [n, 2]. cells: of each the numbers
    of its vertices, counter-clockwise. wall_thickness: of one cell's wall, a number or per cell a number or a list per
    face; None: the scene's. corner_radius: a number or [n]. classes [cells], face_classes [cells][faces] or None.
    """
    unit: str
    period: np.ndarray | None
    vertices: np.ndarray
    cells: list[np.ndarray]
    wall_thickness: float | Sequence[float | Sequence[float]] | None = None
    corner_radius: float | np.ndarray = 0.0
    classes: np.ndarray | None = None
    face_classes: Sequence[Sequence[int]] | None = None
    made_by: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.period = None if self.period is None else np.asarray(self.period, float)
        self.vertices = np.asarray(self.vertices, float)
        self.cells = [np.asarray(cell, int) for cell in self.cells]

    def polygon(self, cell: int) -> np.ndarray:
        """Corners [k, 2] of a cell."""
        return self.vertices[self.cells[cell]]

    @cached_property
    def size(self) -> float:
        """The mean cell's: the root of its area."""
        return float(np.sqrt(np.abs(geometry.moments(self)[0]).mean()))

    @cached_property
    def points(self) -> tuple[np.ndarray, np.ndarray]:
        """Number of the point that each vertex is [n], and whole periods [n, 2] from the point's first vertex to it:
        vertices that coincide, or do so modulo periods, are one point."""
        n, tolerance = len(self.vertices), SAME * self.size
        if self.period is None:
            pairs = cKDTree(self.vertices).query_pairs(tolerance, output_type="ndarray")
        else:
            inverse = np.linalg.inv(self.period)
            share = self.vertices @ inverse % 1.0
            share[share >= 1] = 0  # rounding
            reach = tolerance * np.linalg.norm(inverse, 2)
            near = cKDTree(share, boxsize=1.0).query_pairs(reach, output_type="ndarray")
            away = self.vertices[near[:, 0]] - self.vertices[near[:, 1]]
            away -= np.rint(away @ inverse) @ self.period
            pairs = near[np.linalg.norm(away, axis=1) < tolerance]
        graph = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(n, n))
        point = connected_components(graph, directed=False)[1]
        if self.period is None:
            return point, np.zeros((n, 2), int)
        first = np.unique(point, return_index=True)[1]
        shift = np.rint((self.vertices - self.vertices[first[point]]) @ inverse).astype(int)
        return point, shift

    @cached_property
    def edges(self) -> Edges:
        """Edges, paired with those of neighbours, also across the period. InputError: an edge is used twice in the same
        direction."""
        count = np.array([len(cell) for cell in self.cells])
        cell = np.repeat(np.arange(len(self.cells)), count)
        start = np.concatenate(self.cells)
        end = np.concatenate([np.roll(c, -1) for c in self.cells])
        point, shift = self.points
        along = shift[end] - shift[start]
        forth = np.column_stack([point[start], point[end], along])
        back = np.column_stack([point[end], point[start], -along])
        number: dict[bytes, int] = {}
        for k, key in enumerate(row.tobytes() for row in forth):
            if key in number:
                other = cell[number[key]]
                raise InputError(f"cells {other} and {cell[k]} have an edge in the same direction, from vertex "
                                 f"{start[k]} to {end[k]}: they overlap")
            number[key] = k
        across = np.array([number.get(row.tobytes(), -1) for row in back])
        return Edges(cell, start, end, across, np.concatenate([[0], np.cumsum(count)]))

    def neighbours(self) -> list[np.ndarray]:
        """Of each cell: the cell across each of its edges, -1: air."""
        e = self.edges
        other = np.where(e.across < 0, -1, e.cell[e.across])
        return np.split(other, e.first[1:-1])

    def radii(self) -> np.ndarray:
        """Corner radius of each vertex [n]."""
        return np.broadcast_to(np.asarray(self.corner_radius, float), len(self.vertices))

    def thickness(self) -> np.ndarray | None:
        """Thickness of the wall of each edge [m]; None: the scene gives it."""
        if self.wall_thickness is None:
            return None
        if np.ndim(self.wall_thickness) == 0 and not isinstance(self.wall_thickness, (list, tuple)):
            return np.full(len(self.edges.cell), float(self.wall_thickness))  # type: ignore[arg-type]
        rows = [np.broadcast_to(np.asarray(entry, float), len(cell))
                for entry, cell in zip(self.wall_thickness, self.cells)]  # type: ignore[arg-type]
        return np.concatenate(rows)

    def statistics(self) -> dict[str, Any]:
        """Numbers of the tissue, in `unit` and degrees (geometry.statistics)."""
        return geometry.statistics(self)

    def check(self) -> None:
        """InputError unless the tissue is what a file may hold: what is wrong, at which cell or vertex."""
        geometry.check(self)

    def write(self, path: str | os.PathLike[str], overwrite: bool = False) -> None:
        """Writes a file, whole or not at all; coordinates have 12 digits. InputError: it would replace a file that is
        no tissue, without overwrite."""
        write_whole(output(path, overwrite), self.text())

    def text(self) -> str:
        """What a file of it holds."""
        parts: dict[str, Any] = {"lamella_tissue": VERSION, "unit": self.unit}
        for name in ("period", "wall_thickness", "corner_radius", "vertices", "cells", "classes", "face_classes"):
            value = getattr(self, name)
            if value is not None and not (name == "corner_radius" and not np.any(value)):
                parts[name] = _plain(value)
        if self.made_by:
            parts["made_by"] = _plain(self.made_by)
        return "{\n" + ",\n".join(f'  "{name}": {_rows(value)}' for name, value in parts.items()) + "\n}\n"

    @staticmethod
    def read(path: str | os.PathLike[str]) -> "Tissue":
        """The tissue of a file, checked. InputError: file and what is wrong with it."""
        told = _object(path)
        try:
            tissue = _from(told)
            tissue.check()
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
        return tissue


def output(path: str | os.PathLike[str], overwrite: bool = False, inputs: Sequence[str] = ()) -> Path:
    """The path, to which a tissue may be written (_files.may_write)."""
    return may_write(path, with_member("lamella_tissue"), "a tissue", overwrite, inputs)


def _plain(value: Any) -> Any:
    """Of NumPy's types those of JSON, reals with 12 digits."""
    if isinstance(value, dict):
        return {name: _plain(v) for name, v in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(v) for v in (value.tolist() if isinstance(value, np.ndarray) else value)]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        rounded = float(f"{value:.12g}")
        return int(rounded) if rounded.is_integer() and abs(rounded) < 1e15 else rounded
    return value


def _rows(value: Any) -> str:
    """JSON, with lists of lists and objects in a row for each member."""
    if isinstance(value, dict):
        return "{\n" + ",\n".join(f"    {json.dumps(name)}: {json.dumps(v)}" for name, v in value.items()) + "\n  }"
    if isinstance(value, list) and any(isinstance(v, list) for v in value):
        return "[\n" + ",\n".join(f"    {json.dumps(v)}" for v in value) + "\n  ]"
    return json.dumps(value)


def _object(path: str | os.PathLike[str]) -> dict[str, Any]:
    """What a file holds, JSON or YAML."""
    try:
        content = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise OSError(f"{path}: cannot read the tissue: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is no tissue file: {error}") from None
    try:
        told = json.loads(content)
    except ValueError:
        import yaml  # type: ignore[import]
        try:
            told = parse_yaml(content)
        except yaml.YAMLError as error:
            raise InputError(f"{path}: is neither JSON nor YAML: {' '.join(str(error).split())}") from None
    if not isinstance(told, dict) or "lamella_tissue" not in told:
        raise InputError(f"{path}: is no tissue file: it has no lamella_tissue: {VERSION}")
    return told


def _numbers(told: dict[str, Any], name: str, columns: int | None = None) -> np.ndarray:
    wanted = f"{name}: rows of {columns} numbers are wanted" if columns else f"{name}: numbers are wanted"
    try:
        values = np.array(told[name], dtype=float)
    except (TypeError, ValueError):
        raise InputError(wanted) from None
    if columns and (values.ndim != 2 or values.shape[1] != columns):
        raise InputError(wanted)
    if not np.isfinite(values).all():
        raise InputError(f"{name}: a number is not finite")
    return values


def _cells(told: dict[str, Any], count: int) -> list[np.ndarray]:
    cells = told["cells"]
    if not isinstance(cells, list) or not cells:
        raise InputError("cells: a list of cells is wanted, each a list of vertex numbers")
    for k, cell in enumerate(cells):
        if not isinstance(cell, list) or not all(type(v) is int for v in cell):
            raise InputError(f"cells: cell {k}: a list of vertex numbers is wanted")
        for v in cell:
            if not 0 <= v < count:
                raise InputError(f"cells: cell {k}: there is no vertex {v}: they have the numbers 0 to {count - 1}")
    return [np.array(cell, int) for cell in cells]


KEYS = ("lamella_tissue", "unit", "period", "wall_thickness", "corner_radius", "vertices", "cells", "classes",
        "face_classes", "made_by")


def _from(told: dict[str, Any]) -> Tissue:
    for name in told:
        if name not in KEYS:
            raise InputError(f"{name}: unknown key; a tissue file has {', '.join(KEYS)}")
    for name in ("unit", "vertices", "cells"):
        if name not in told:
            raise InputError(f"{name} is missing")
    if told["lamella_tissue"] != VERSION:
        raise InputError(f"lamella_tissue: {told['lamella_tissue']}: this program reads version {VERSION}")
    quantity(f"1 {told['unit']}", "length")
    vertices = _numbers(told, "vertices", 2)
    period = _numbers(told, "period", 2) if told.get("period") is not None else None
    if period is not None and not (len(period) == 2 and np.linalg.det(period) > 0):
        raise InputError("period: two vectors are wanted, the second one to the left of the first")
    radius = _numbers(told, "corner_radius") if "corner_radius" in told else np.array(0.0)
    tissue = Tissue(told["unit"], period, vertices, _cells(told, len(vertices)), told.get("wall_thickness"),
                    float(radius) if radius.ndim == 0 else radius, told.get("classes"), told.get("face_classes"),
                    told.get("made_by") or {})
    if radius.ndim and radius.shape != (len(vertices),):
        raise InputError(f"corner_radius: {len(radius)} numbers for {len(vertices)} vertices")
    for name in ("classes", "face_classes"):
        if told.get(name) is not None and len(told[name]) != len(tissue.cells):
            raise InputError(f"{name}: {len(told[name])} entries for {len(tissue.cells)} cells")
    return tissue
