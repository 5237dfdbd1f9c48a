"""Units: quantities to SI, and SI values to other units, by what scene files know (udunits2)."""
import numpy as np
from numpy.typing import ArrayLike

from ._library import InputError, call, ffi, library

DIMENSIONS = ("length", "stress", "angle", "time", "temperature")
TIMES = (("s", 1), ("min", 60), ("h", 3600), ("day", 86400))


def quantity(text: str, dimension: str | None = None) -> float:
    """A quantity as scenes have it in SI units: quantity("0.02 MPa") is 20000.0, quantity("4 degC") 277.15. dimension:
    length, stress, angle, time or temperature; None: any that scenes have. InputError: its unit is missing, unknown or
    of another dimension."""
    if dimension is not None and dimension not in DIMENSIONS:
        raise InputError(f"quantity: the dimension {dimension} is none of {', '.join(DIMENSIONS)}")
    value = ffi.new("double *")
    number = -1 if dimension is None else DIMENSIONS.index(dimension)
    call(library.LamBindQuantity, str(text).encode(), number, value)
    return value[0]


def to(values: ArrayLike, unit: str) -> np.ndarray:
    """Values in SI units in another unit: to(response.P, "MPa"), to(result.time, "day"), to(result.reaction, "N/mm").
    The shape stays. InputError: the unit is not known."""
    zero, one = quantity(f"0 {unit}"), quantity(f"1 {unit}")
    return (np.asarray(values) - zero) / (one - zero)


def time_unit(duration: float) -> tuple[str, int]:
    """The unit that suits a time in s, and its seconds: two of it are not longer."""
    return [unit for unit in TIMES if unit[1] == 1 or duration >= 2 * unit[1]][-1]
