"""Keys of scenes whose values are not known: their bounds, priors and distributions (block `uncertain`)."""
import copy
import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from . import InputError, Scene, scene_dict
from .program import SceneLike
from .sweeps import get_key, set_key
from .units import quantity, to

Range = tuple[str | float, str | float]


@dataclass
class Parameter:
    """A key of scenes, its bounds, and if something is known of it before a mean and a standard deviation."""
    key: str
    low: str | float
    high: str | float
    prior: Range | None = None
    unit: str = field(init=False, default="")

    def __post_init__(self) -> None:
        (self._low, self.unit), (self._high, other) = _split(self.low), _split(self.high)
        if other != self.unit:
            raise InputError(f"{self.key}: {self.low} and {self.high} have different units: give both in one")
        if not self._low < self._high:
            raise InputError(f"{self.key}: {self.low} is not below {self.high}")
        self.logarithmic = self._low > 0
        if self.prior is not None:
            (mean, unit), (deviation, spread) = _split(self.prior[0]), _split(self.prior[1])
            if unit != self.unit or spread != self.unit or deviation <= 0:
                raise InputError(f"{self.key}: the prior {self.prior} is no mean and deviation in "
                                 f"{self.unit or 'numbers'}")
            self._prior = mean, deviation

    def value(self, u: float) -> float:
        """At u of the way between the bounds."""
        if self.logarithmic:
            return self._low * (self._high / self._low) ** u
        return self._low + u * (self._high - self._low)

    def place(self, value: float) -> float:
        """Inverse of `value`."""
        if self.logarithmic:
            return math.log(value / self._low) / math.log(self._high / self._low)
        return (value - self._low) / (self._high - self._low)

    def text(self, value: float) -> str | float:
        """As a scene has it."""
        return f"{value!r} {self.unit}" if self.unit else value

    def misfit(self, value: float) -> float:
        """Of the prior, in its deviations."""
        return (value - self._prior[0]) / self._prior[1]

    def quantile(self, q: float) -> float:
        """The value below which it is with probability q: alike in all places between the bounds, or by the prior."""
        if self.prior is None:
            return self.value(q)
        from scipy.stats import truncnorm
        mean, deviation = self._prior
        ends = [(end - mean) / deviation for end in (self._low, self._high)]
        return float(truncnorm.ppf(q, *ends, mean, deviation))


def _split(value: str | float) -> tuple[float, str]:
    """Number and unit."""
    number, _, unit = str(value).strip().partition(" ")
    try:
        return float(number), unit.strip()
    except ValueError:
        raise InputError(f"{value}: is no number with a unit, such as 0.1 MPa") from None


def varied(scene: dict[str, Any], parameters: Sequence[Parameter], values: Sequence[float]) -> dict[str, Any]:
    """A copy of a scene with these values."""
    scene = copy.deepcopy(scene)
    for parameter, value in zip(parameters, values):
        set_key(scene, parameter.key, parameter.text(float(value)))
    return scene


def uncertain(scene: SceneLike) -> list[Parameter]:
    """What a scene says of values that are not known. InputError: it says nothing."""
    text = scene_dict(scene)
    name = scene if isinstance(scene, (str, os.PathLike)) else "the scene"
    if not isinstance(scene, Scene):
        Scene(scene)  # its mistakes are told
    if not text.get("uncertain"):
        raise InputError(f"{name}: has no block `uncertain`, which says what values are not known and between which "
                         "bounds they lie")
    return [Parameter(entry["key"], entry["from"], entry["to"],
                      (entry["mean"], entry["deviation"]) if "mean" in entry else None)
            for entry in text["uncertain"]]


def value_in(scene: dict[str, Any], parameter: Parameter) -> float:
    """The value that a scene has, in the unit of the bounds."""
    value = get_key(scene, parameter.key)
    return float(to(quantity(str(value)), parameter.unit)) if parameter.unit else float(value)
