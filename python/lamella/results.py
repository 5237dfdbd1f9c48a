"""Files of Lamella, over h5py."""
import json
import os
from functools import cached_property
from typing import Any

import numpy as np

from . import InputError, Responses
from ._library import MEMBERS

GROUPS = ("macro/curve", "macro", "process", "map")  # whose datasets are attributes of a result
LISTS = ("boundaries", "modes", "criteria", "events")  # texts with a name per line
NAMES = {"mode": "modes", "criterion": "criteria", "event": "events"}  # numbers of these
UNITS = {"1": 1.0, "s": 1.0, "K": 1.0, "MPa": 1e6, "mm": 1e-3, "um": 1e-6, "N/mm": 1e3, "N mm/mm": 1.0,
         "N": 1.0, "N mm": 1e-3, "kJ/m^3": 1e3}


class Result:
    """A file of `rve -o`, `build -d`, `fe2 -o`, `map -o` or `process -o`; all values are in SI units.

    kind: "rve", "database", "fe2", "map" or "process"; scene: its text. `result[path]` is what docs/reference/files.md
    describes at that path: an array, a text, or of a group a dictionary by their paths in it. What is in the groups
    /macro/curve, /macro, /process and /map are attributes, too: `reaction`, `time`, `load_factor`, ...; `mode`,
    `criterion` and `event` by their names, "" where there is none. `file` is the h5py file.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        try:
            import h5py  # only where files are read
        except ModuleNotFoundError:
            raise ImportError(f"{path}: reading it needs h5py: pip install h5py, or Debian's python3-h5py",
                              name="h5py") from None
        try:
            self.file = h5py.File(path, "r")
        except OSError as error:
            try:
                open(path, "rb").close()
            except OSError as why:
                raise OSError(f"{path}: cannot be read: {why.strerror}") from None
            what = f"is damaged or cut short: {error}" if h5py.is_hdf5(path) else "is not an HDF5 file"
            raise InputError(f"{path}: {what}; give a file that lamella has written, such as OUT.h5 of -o OUT.h5") from None
        attributes = self.file.attrs
        if attributes.get("format", b"") not in (b"lamella", "lamella"):
            raise InputError(f"{path}: is not a file of Lamella")
        self.kind = _text(attributes["kind"])
        self.stress_unit, self.apothem = float(attributes["stress_unit_Pa"]), float(attributes["length_unit_m"])
        self.scene = self["scene"] if "scene" in self.file else None

    def __getitem__(self, path: str) -> Any:
        if path not in self.file:
            raise InputError(f"{self.file.filename}: has no {path}")
        return self._value(self.file[path])

    def _value(self, item: Any) -> Any:
        if not hasattr(item, "shape"):
            paths: list[str] = []
            item.visit(paths.append)
            return {path: self._value(item[path]) for path in paths if hasattr(item[path], "shape")}
        name, values = item.name.rsplit("/", 1)[1], item[()]
        if isinstance(values, bytes):
            return _text(values).splitlines() if name in LISTS else _text(values)
        if values.dtype.kind != "f":
            return values
        unit = _text(item.attrs.get("unit", b"1"))
        if name == "values" and "unit" in item.parent:  # of an axis of a map
            unit = _text(item.parent["unit"][()])
        values = values * (self.apothem if unit == "apothem" else UNITS[unit])
        return values.reshape(values.shape[:-1] + (3, 3)) if values.shape[-1:] == (9,) else values

    def __getattr__(self, name: str) -> Any:
        for group in GROUPS:
            if not name.startswith("_") and "file" in self.__dict__ and f"{group}/{name}" in self.file:
                values = self[f"{group}/{name}"]
                if name in NAMES:
                    return np.array([*self[f"{group}/{NAMES[name]}"], ""])[values]  # -1 is the last one
                return json.loads(values) if name == "summary" else values
        raise AttributeError(f"no {name} in this file of kind {self.__dict__.get('kind')}")

    def __dir__(self) -> list[str]:
        found = [name for group in GROUPS for name in self.file.get(group, ())]
        return [*super().__dir__(), *found]

    @cached_property
    def _records(self) -> np.ndarray:
        return self.file["records"][:self.file["records"].attrs["committed"]]

    @property
    def keys(self) -> np.ndarray:
        """Keys of the records [n]: numbers of the states of `rve` and `process`, of the points of a map."""
        return self._records["key"]

    @cached_property
    def responses(self) -> Responses:
        """Responses of the records, in the order of `keys`."""
        factors = {"Pa": self.stress_unit, "1/Pa": 1 / self.stress_unit, "m": self.apothem, "m^2": self.apothem**2}
        array = np.zeros(self._records.shape, Responses.dtype)
        for name, kind, _, _, unit, _ in MEMBERS:
            if name in self._records.dtype.names:
                array[name] = self._records[name] * factors.get(unit, 1) if kind == "f" else self._records[name]
            elif kind == "f":
                array[name] = np.nan
        return Responses(array)

    @property
    def axes(self) -> dict[str, np.ndarray]:
        """The axes of a map, x and y: {"turgor": values, "k2": values}; arrays of the map are [y][x]."""
        return {self[f"map/{axis}/quantity"]: self[f"map/{axis}/values"] for axis in "xy"}

    @property
    def mesh(self) -> dict[str, np.ndarray]:
        """nodes [n, 2], m, elements [n, 9] or [n, 6] (corners, middles of edges, centre; -1 beyond a triangle's), and
        what else is of the mesh."""
        if self.kind == "fe2":
            return {name: self[f"macro/{name}"] for name in ("nodes", "elements", "gripped")}
        return self["mesh"]

    def fields(self, state: int) -> dict[str, Any]:
        """Fields of a state or step: {"x": [nodes, 2], "wall_stress": [nodes], "interface/gap": [faces, points], ...}
        of `rve` and `process`, {"u": [nodes, 3], "P": [elements, 3, 3], ...} of a body."""
        return self[f"macro/step/{state}" if self.kind == "fe2" else f"fields/{state}"]

    def states(self) -> list[int]:
        """Numbers of the states or steps that have fields."""
        return sorted(int(name) for name in self.file.get("macro/step" if self.kind == "fe2" else "fields", ()))

    def close(self) -> None:
        """Closes the file; `with lamella.Result(path) as result` does."""
        self.file.close()

    def __enter__(self) -> "Result":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()


def _text(value: str | bytes) -> str:
    return value.decode() if isinstance(value, bytes) else value
