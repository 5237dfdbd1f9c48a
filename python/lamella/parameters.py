"""Keys of scenes whose values are not known: their bounds, priors and distributions (block `uncertain`)."""
import copy
import math
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from . import InputError, Scene, scene_dict
from .program import SceneLike
from .sweeps import get_key, set_key
from .units import quantity, to

QUANTITY = re.compile(r"\s*([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*(.*?)\s*$")
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
        self._low, self.unit = _split(self.key, self.low)
        self._high = self._number(self.high)
        if not self._low < self._high:
            raise InputError(f"{self.key}: {self.low} is not below {self.high}")
        # degC has its zero anywhere: ratios mean nothing
        self.logarithmic = self._low > 0 and (not self.unit or quantity(f"0 {self.unit}") == 0)
        if self.prior is not None:
            mean, deviation = self._number(self.prior[0]), self._number(self.prior[1], is_difference=True)
            if deviation <= 0 or not self._low <= mean <= self._high:
                raise InputError(f"{self.key}: the prior {self.prior} is no mean between the bounds and deviation")
            self._prior = mean, deviation

    def _number(self, value: str | float, is_difference: bool = False) -> float:
        """In the unit of the lower bound."""
        number, unit = _split(self.key, value)
        if unit == self.unit:
            return number
        if not unit or not self.unit:
            raise InputError(f"{self.key}: {self.low} and {value}: one has a unit, the other none")
        origin = quantity(f"0 {self.unit}")
        zero = quantity(f"0 {unit}") if is_difference else origin
        return (quantity(f"{number!r} {unit}") - zero) / (quantity(f"1 {self.unit}") - origin)

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


def _split(key: str, value: str | float) -> tuple[float, str]:
    """Number and unit."""
    match = QUANTITY.match(str(value))
    if not match:
        raise InputError(f"{key}: {value}: is no number with a unit, such as 0.1 MPa")
    return float(match[1]), match[2]


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
