"""Files of Lamella, over h5py."""
import numpy as np

from . import InputError, Responses
from ._library import MEMBERS


def _array(dataset, scales):
    """A dataset in SI units, by its attribute `unit`; with a unit that is not of stress or length as it is stored."""
    unit = dataset.attrs.get("unit", b"1")
    unit = unit.decode() if isinstance(unit, bytes) else unit
    return dataset[()] * scales[unit] if unit in scales else dataset[()]


class Result:
    """A file of `rve -o`, `build -d`, `fe2 -o`, `map -o` or `process -o`.

    kind: "rve", "database", ...; scene: its text; responses: Responses of its records, in their order, SI; keys: their
    numbers (of `rve`: the states). `file` is the h5py file for all else.
    """

    def __init__(self, path):
        import h5py  # only where files are read
        try:
            self.file = h5py.File(path, "r")
        except OSError as error:
            raise InputError(f"{path}: cannot be read: {error}") from None
        attributes = self.file.attrs
        if attributes.get("format", b"") not in (b"lamella", "lamella"):
            raise InputError(f"{path}: is not a file of Lamella")
        self.kind = attributes["kind"].decode() if isinstance(attributes["kind"], bytes) else attributes["kind"]
        self.stress_unit, self.apothem = float(attributes["stress_unit_Pa"]), float(attributes["length_unit_m"])
        self.scene = self.file["scene"][()].decode() if "scene" in self.file else None
        rows = self.file["records"][:self.file["records"].attrs["committed"]] if "records" in self.file else None
        self.keys = None if rows is None else rows["key"]
        self.responses = None if rows is None else self._responses(rows)

    def _responses(self, rows):
        factors = {"Pa": self.stress_unit, "1/Pa": 1 / self.stress_unit}
        array = np.zeros(rows.shape, Responses.dtype)
        for name, kind, _, _, unit, _ in MEMBERS:
            if name in rows.dtype.names:
                array[name] = rows[name] * factors.get(unit, 1) if kind == "f" else rows[name]
            elif kind == "f":
                array[name] = np.nan
        return Responses(array)

    def fields(self, state):
        """Fields of a state of `rve`, by their paths: {"x": [nodes, 2], "interface/gap": [faces, points], ...}, in m and
        Pa where they are lengths and stresses (docs/reference/files.md)."""
        group = self.file.get(f"fields/{state}")
        if group is None:
            raise InputError(f"{self.file.filename}: has no fields of state {state}")
        scales = {"apothem": self.apothem, "MPa": 1e6}
        found = {}
        group.visititems(lambda name, item: found.update({name: _array(item, scales)}) if hasattr(item, "shape") else None)
        return found

    def close(self):
        self.file.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
