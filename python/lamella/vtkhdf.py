"""States and steps of a file as VTKHDF, which VTK 9.3 and ParaView 5.12 and later read:

    python3 -m lamella.vtkhdf FILE.h5 [OUT.vtkhdf]

The format: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html#vtkhdf-file-format
"""
import os
import sys
from pathlib import Path
from typing import Any

import numpy as np

from . import InputError, Result
from ._files import may_write

BIQUADRATIC_QUAD, QUADRATIC_TRIANGLE = 28, 22  # VTK's numbers of cells; their nodes are in the order of Lamella's


def _spatial(values: np.ndarray) -> np.ndarray:
    """Vectors of the plane in space, tensors as rows of nine numbers."""
    if values.shape[1:] == (2,):
        return np.pad(values, ((0, 0), (0, 1)))
    return values.reshape(len(values), -1) if values.ndim == 3 else values


class _Steps:
    """Datasets that grow by a part per step, and where the part of each step begins."""

    def __init__(self, group: Any, offsets: Any, count: int) -> None:
        self.group, self.offsets, self.count = group, offsets, count
        self.parts: dict[str, dict[int, np.ndarray]] = {}

    def add(self, step: int, name: str, values: np.ndarray) -> None:
        self.parts.setdefault(name, {})[step] = _spatial(values)

    def write(self) -> None:
        """What a step lacks is NaN."""
        for name, parts in self.parts.items():
            shape = next(iter(parts.values())).shape
            rows = [parts[step] if step in parts else np.full(shape, np.nan) for step in range(self.count)]
            self.group[name] = np.concatenate(rows)
            self.offsets[name] = np.arange(self.count) * shape[0]


def _times(result: Result, numbers: list[int]) -> np.ndarray:
    """Of a process the times, s; else the numbers of the states, as where two states are at one time: VTK finds a state
    by its time, so that times must rise."""
    if "process/time" in result.file:
        times = result["process/time"][np.searchsorted(result.steps, numbers) if result.kind == "fe2" else numbers]
        if (np.diff(times) > 0).all():
            return times
    return np.array(numbers, float)


def _write_topology(root: Any, elements: np.ndarray) -> None:
    sizes = (elements >= 0).sum(axis=1)
    root["NumberOfCells"], root["NumberOfConnectivityIds"] = [len(elements)], [sizes.sum()]
    root["Connectivity"], root["Offsets"] = elements[elements >= 0], np.concatenate([[0], np.cumsum(sizes)])
    root["Types"] = np.where(sizes == 9, BIQUADRATIC_QUAD, QUADRATIC_TRIANGLE).astype(np.uint8)


def _write_fields(result: Result, root: Any, steps: Any) -> list[np.ndarray]:
    """Fields of all states, and the positions of the nodes in each."""
    numbers, mesh, points = result.states(), result.mesh, []
    on_points, on_cells = (_Steps(root.create_group(f"{where}Data"), steps.create_group(f"{where}DataOffsets"),
                                  len(numbers)) for where in ("Point", "Cell"))
    for k, number in enumerate(numbers):
        fields = result.fields(number)
        points.append(_spatial(fields.pop("x", mesh["nodes"])))
        if "cell_of" in mesh:
            on_cells.add(k, "cell_of", mesh["cell_of"])
        for name, values in fields.items():
            if name != "obstacles" and "/" not in name:  # rigid bodies and samples of interfaces are not of this mesh
                (on_cells if result.kind == "fe2" and name != "u" else on_points).add(k, name, values)
    on_points.write()
    on_cells.write()
    return points


def _is_ours(path: Path) -> bool:
    """Whether a VTKHDF file has fields of Lamella's."""
    import h5py
    try:
        with h5py.File(path) as file:
            cells = file.get("VTKHDF/CellData", {})
            return "cell_of" in cells or "cauchy" in cells
    except OSError:
        return False


def write(result: Result, path: str | os.PathLike[str], overwrite: bool = False) -> None:
    """Writes the states of a file of `rve` or `process`, in their present shape, or the steps of a body, in the shape
    at rest with the displacement u, as an UnstructuredGrid in time, with the fields of nodes and elements; SI units.
    InputError: it would replace a file of another kind, without overwrite."""
    numbers = result.states()
    if not numbers:
        raise InputError(f"{result.file.filename}: of kind {result.kind}, has no states with a mesh")
    path = may_write(path, _is_ours, "a VTKHDF file of lamella", overwrite, [result.file.filename])
    aside = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        _write(result, numbers, aside)
        os.replace(aside, path)
    finally:
        aside.unlink(missing_ok=True)


def _write(result: Result, numbers: list[int], path: Path) -> None:
    import h5py
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = (2, 0)
        root.attrs.create("Type", b"UnstructuredGrid", dtype=h5py.string_dtype("ascii", 16))
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = count = len(numbers)
        _write_topology(root, result.mesh["elements"])
        points = _write_fields(result, root, steps)
        moving = result.kind != "fe2"
        root["NumberOfPoints"], root["Points"] = [len(points[0])], np.concatenate(points if moving else points[:1])
        steps["Values"] = _times(result, numbers)
        steps["NumberOfParts"], steps["PartOffsets"] = np.ones(count, int), np.zeros(count, int)
        steps["PointOffsets"] = len(points[0]) * np.arange(count) if moving else np.zeros(count, int)
        steps["CellOffsets"] = steps["ConnectivityIdOffsets"] = np.zeros((count, 1), int)


def main() -> None:
    """The command."""
    words = [word for word in sys.argv[1:] if word != "--overwrite"]
    if len(words) not in (1, 2) or words[0].startswith("-"):
        sys.exit("usage: python3 -m lamella.vtkhdf FILE.h5 [OUT.vtkhdf] [--overwrite]")
    target = words[1] if len(words) == 2 else str(Path(words[0]).with_suffix(".vtkhdf"))
    try:
        with Result(words[0]) as result:
            write(result, target, "--overwrite" in sys.argv)
    except (InputError, OSError) as error:
        sys.exit(f"lamella.vtkhdf: {error}")
    print(f"wrote {target}")


if __name__ == "__main__":
    main()
