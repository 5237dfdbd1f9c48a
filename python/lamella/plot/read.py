"""Arrays of a file, checked: what lacks or does not fit is an InputError that names it."""
import json

import numpy as np

from .. import InputError
from ..results import Result

WRONG = (ValueError, KeyError, TypeError, IndexError, AttributeError, AssertionError)  #: of an object that is read


def object_of(path, command, needed=()):
    """The object of a JSON file that a command has written, with the members that are needed."""
    try:
        with open(path, encoding="utf-8") as file:
            told = json.load(file)
    except OSError as error:
        raise OSError(f"{path}: {error.strerror}") from None
    except ValueError as error:
        raise InputError(f"{path}: is not of lamella {command}: it is no JSON ({error})") from None
    lacking = sorted(set(needed) - set(told)) if isinstance(told, dict) else ["its object"]
    if lacking:
        raise InputError(f"{path}: is not of lamella {command}: {lacking[0]} is missing")
    return told


def unlike(path, command, error):
    """InputError of an object that is not as the command writes it; what was wrong with it is one of WRONG."""
    if isinstance(error, InputError):
        return error
    why = f"{error.args[0]} is missing" if isinstance(error, KeyError) and error.args else error
    return InputError(f"{path}: is not of lamella {command}, or damaged: {why}")


class Source(Result):
    """A file that is drawn."""

    def has(self, name):
        return name in self.file

    def array(self, name, rows=None, columns=None, finite=False):
        """The dataset, with the shape [rows, columns] where these are given: `columns` counts all numbers of a row.
        finite: NaN and infinity cannot be drawn."""
        if name not in self.file:
            raise InputError(f"{self.path}: holds no {name}: its scene has nothing of the kind, or the file is damaged or "
                             "older than this program")
        try:
            values = self.file[name][()]
        except (OSError, ValueError, TypeError) as error:
            raise InputError(f"{self.path}: {name} is damaged: {error}") from None
        if not isinstance(values, np.ndarray) or values.dtype.kind not in "fiu" or values.ndim < 1:
            raise InputError(f"{self.path}: {name} is damaged: it holds no numbers")
        size = int(np.prod(values.shape[1:]))
        if len(values) == 0 or (rows is not None and len(values) != rows) or (columns is not None and size != columns):
            raise InputError(f"{self.path}: {name} is damaged: {len(values)} rows of {size} numbers do not fit the "
                             "rest of the file")
        if finite and not np.isfinite(values).all():
            raise InputError(f"{self.path}: {name}: the numbers of the file cannot be drawn: some are not finite")
        return values.reshape(len(values), size) if columns is not None and columns > 1 else values

    def points(self, name, rows=None):
        """Points of the plane [n, 2], of two or three coordinates in the file."""
        values = self.array(name, rows, finite=True)
        if values.ndim != 2 or values.shape[1] not in (2, 3):
            raise InputError(f"{self.path}: {name} is damaged: it holds no points")
        return values[:, :2].astype(float)

    def elements(self, name):
        values = self.array(name)
        if values.ndim != 2 or values.shape[1] not in (6, 9) or values.dtype.kind not in "iu":
            raise InputError(f"{self.path}: {name} is damaged: it holds no elements")
        return values

    def text(self, name, default=None):
        if name not in self.file:
            if default is not None:
                return default
            raise InputError(f"{self.path}: holds no {name}; it is damaged, or older than this program")
        value = self.file[name][()]
        return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)

    def object(self, name):
        """A text that is JSON; an empty dictionary where there is none."""
        try:
            return json.loads(self.text(name, "{}"))
        except ValueError:
            return {}

    @property
    def path(self):
        return self.file.filename

    @property
    def tissue(self):
        """The description of the microstructure."""
        group = self.file.get("microstructures", {})
        return self.object(f"microstructures/{next(iter(group))}/description") if len(group) else {}

    @property
    def parts(self):
        """Whether its cells can come apart."""
        return self.tissue.get("interface", {}).get("law", "bonded") != "bonded"

