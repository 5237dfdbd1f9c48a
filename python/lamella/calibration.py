"""Parameters of a scene from measured curves: least squares with bounds and priors, intervals, what data do not tell.

    fit = calibrate({"rve.wall.C1": ("0.02 MPa", "0.5 MPa")}, [Curve("tension.yaml", "tension.csv", scatter=0.03)])
    print(fit)

Method. Residuals are (model - data)/scatter of all points, and (parameter - mean)/deviation of those with a prior. The
search is in the logarithm of parameters whose bounds are above 0, else in the parameter, scaled to 0 ... 1 between the
bounds: a trust-region Gauss-Newton method with bounds (Branch, Coleman & Li, SIAM J. Sci. Comput. 21 (1999) 1; SciPy's
least_squares), from several starts of a Sobol' sequence, the first in the middle. Derivatives are forward differences
of solves, whose error is 1e-9. With the Jacobian J at the best fit the covariance is (J^T J)^-1, times the mean square
of the residuals where the scatter is not known; intervals are Student's. A direction of the parameters in which the
residuals hardly change is one that the data do not tell.
"""
import csv
import math
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import RVE, InputError, Responses, Scene, scene_dict
from ._library import NAMES
from .program import SceneLike
from .sweeps import set_key
from .units import quantity

STEP = 1e-5  #: of the scaled parameters, for forward differences: solves have ten digits, so that derivatives have five
LOST = 1e3  #: residual of each point of a curve that the model has not
BLIND = 0.25  #: of the way between the bounds, chosen: a direction whose 95 % interval is as large is not told
COLUMN = re.compile(r"^\s*([A-Za-z_]+?)(?:([123])([123]))?\s*(?:\(([^)]*)\))?\s*$")
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
            raise InputError(f"{self.key}: {self.low} and {self.high} have different units")
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
        return (value - self._prior[0]) / self._prior[1]


def _split(value: str | float) -> tuple[float, str]:
    """Number and unit."""
    number, _, unit = str(value).strip().partition(" ")
    try:
        return float(number), unit.strip()
    except ValueError:
        raise InputError(f"{value}: is no number with a unit, such as 0.1 MPa") from None


class Curve:
    """A measured curve, and the scene whose block `load` repeats it.

    data: a CSV file whose first line names two columns, such as "F11, P11 (MPa)", or {"F11": values, "P11 (MPa)":
    values}: members of a response, with components where it has them, in the order x, y. Where the scene begins with
    `inflate`, F counts from the inflated tissue. scatter: standard deviation of y, a share of its largest value, or
    with a unit ("5 kPa"); by default unknown, and found from the misfit. The model is interpolated between its states
    (monotone cubic), so the scene's ramp needs as many steps as the curve has bends, and a state where it begins.
    """

    def __init__(self, scene: SceneLike, data: str | os.PathLike[str] | dict[str, ArrayLike],
                 scatter: str | float | None = None) -> None:
        self.name = os.fspath(data) if not isinstance(data, dict) else "data"
        self.scene = scene_dict(scene)
        columns = dict(data) if isinstance(data, dict) else _read(self.name)
        if len(columns) != 2:
            raise InputError(f"{self.name}: has {len(columns)} columns; two are wanted, such as F11 and P11 (MPa)")
        self.columns = [_Column(self.name, title) for title in columns]
        self.x, self.y = (c.si(values) for c, values in zip(self.columns, columns.values()))
        if len(self.x) != len(self.y) or not len(self.x):
            raise InputError(f"{self.name}: {len(self.x)} and {len(self.y)} numbers in its columns")
        self.known = scatter is not None
        if isinstance(scatter, str):
            self.scatter = quantity(scatter)
        else:
            self.scatter = (1.0 if scatter is None else scatter) * float(np.abs(self.y).max())
        if not self.scatter > 0:
            raise InputError(f"{self.name}: a scatter of {scatter} is none")

    def states(self, scene: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
        """x and y of the states of a scene that have converged."""
        r = RVE(Scene(scene)).solve(derivatives=False)
        x, y = (c.of(r, scene)[r.converged] for c in self.columns)
        return x, y

    def model(self, scene: dict[str, Any]) -> np.ndarray:
        """y of a scene at the data's x; NaN where the model does not reach."""
        from scipy.interpolate import PchipInterpolator
        x, y = self.states(scene)
        order = np.unique(x, return_index=True)[1]
        if len(order) < 2:
            return np.full(len(self.x), np.nan)
        found = PchipInterpolator(x[order], y[order], extrapolate=False)(self.x)
        reached = 1e-9 * (1 + np.abs(self.x))  # the ends, but for rounding
        for end in order[0], order[-1]:
            found[np.abs(self.x - x[end]) < reached] = y[end]
        return found


    def check(self, scene: dict[str, Any]) -> None:
        """InputError unless a scene's states reach over the data."""
        if not np.isnan(self.model(scene)).any():
            return
        x, column = self.states(scene)[0], self.columns[0]
        ends = [f"{value / column.one:.6g}" for of in (self.x, x) if len(of) for value in (of.min(), of.max())]
        reach = f"reach from {ends[2]} to {ends[3]}" if len(x) else "do not converge"
        raise InputError(f"{self.name}: {column.title} from {ends[0]} to {ends[1]}; with parameters in the middle of "
                         f"their bounds the scene's states {reach}: give its load states there, or other bounds")


class _Column:
    """A member of a response, or a component of it, in a unit."""

    def __init__(self, source: str, title: str) -> None:
        match = COLUMN.match(title)
        if not match:
            raise InputError(f"{source}: a column {title!r}; wanted is a member of a response, as P11 (MPa)")
        self.title, self.member = title.strip(), match[1]
        self.index = tuple(int(i) - 1 for i in match.group(2, 3)) if match[2] else ()
        if self.member not in NAMES:
            raise InputError(f"{source}: a column {self.title}: a response has no {self.member}; its members: "
                             f"{', '.join(NAMES)}")
        self.one = quantity(f"1 {match[4]}") if match[4] else 1.0

    def si(self, values: ArrayLike) -> np.ndarray:
        return self.one * np.asarray(values, float)

    def of(self, r: Responses, scene: dict[str, Any]) -> np.ndarray:
        values = getattr(r, self.member)
        if self.member == "F" and "inflate" in scene["load"][0]:
            values = values @ np.linalg.inv(values[0])
        return np.asarray(values[(slice(None), *self.index)], float)


def _read(path: str) -> dict[str, ArrayLike]:
    """Columns of a CSV file by their titles."""
    with open(path, newline="") as file:
        rows = [(number, row) for number, row in enumerate(csv.reader(file), 1) if any(cell.strip() for cell in row)]
    if len(rows) < 2:
        raise InputError(f"{path}: has no numbers; wanted is a line of titles, such as F11, P11 (MPa), and lines of "
                         "numbers")
    titles = [cell.strip() for cell in rows[0][1]]
    for number, row in rows[1:]:
        try:
            if len([float(cell) for cell in row]) == len(titles) and all(map(math.isfinite, map(float, row))):
                continue
        except ValueError:
            pass
        raise InputError(f"{path}:{number}: {', '.join(row)}: wanted are {len(titles)} numbers")
    return {title: [float(row[k]) for _, row in rows[1:]] for k, title in enumerate(titles)}


class Fit:
    """What was found: `values` and 95 % `intervals` [n, 2] in the units of the bounds, `covariance` and `correlation`
    of the scaled parameters, `chi2` (the sum of squares) with `freedom`, `starts`: the sum of squares that each start
    has ended with, `untold`: directions of the parameters that the data do not tell, as texts."""

    def __init__(self, parameters: list[Parameter], u: np.ndarray, J: np.ndarray, chi2: float, points: int, known: bool,
                 starts: list[float]) -> None:
        from scipy.stats import t
        self.parameters, self.u, self.chi2, self.known, self.starts = parameters, u, chi2, known, starts
        self.freedom = points - len(u)
        if self.freedom < 1 and not known:
            raise InputError(f"{points} points do not give {len(u)} parameters and their scatter: give the scatter")
        variance = 1.0 if known else chi2 / self.freedom
        size, direction = np.linalg.svd(J, full_matrices=False)[1:]
        with np.errstate(divide="ignore"):
            spread = np.sqrt(variance) / size
        width = 1.96 if known else t.ppf(0.975, self.freedom)
        finite = np.minimum(spread, 1e6)  # of directions that nothing tells
        self.covariance = direction.T @ np.diag(finite**2) @ direction
        deviation = np.sqrt(np.diag(self.covariance))
        self.correlation = self.covariance / np.outer(deviation, deviation)
        self.values = np.array([p.value(x) for p, x in zip(parameters, u)])
        self.intervals = np.array([[p.value(np.clip(x + s * width * d, 0, 1)) for s in (-1, 1)]
                                   for p, x, d in zip(parameters, u, deviation)])
        self.untold = [self._words(v) for v, s in zip(direction, spread) if width * s > BLIND]

    def _words(self, v: np.ndarray) -> str:
        """A direction as a product of powers, or a sum."""
        v = v / v[np.argmax(np.abs(v))]
        parts = [(p, c) for p, c in zip(self.parameters, v) if abs(c) > 0.1]
        if len(parts) == 1:
            return f"{parts[0][0].key}: the data hardly tell it"
        return (", ".join(f"{p.key} {'up' if c > 0 else 'down'}" for p, c in parts) +
                " together: the data hardly tell them apart")

    def scene(self, scene: SceneLike) -> dict[str, Any]:
        """A scene with the values that were found."""
        return _varied(scene_dict(scene), self.parameters, self.values.tolist())

    def __str__(self) -> str:
        lines = [f"{p.key:28s} {v:10.4g} {p.unit:6s} 95 % from {low:.4g} to {high:.4g}"
                 for p, v, (low, high) in zip(self.parameters, self.values, self.intervals)]
        scatter = 0.0 if self.known else 100 * math.sqrt(self.chi2 / self.freedom)
        words = f", scatter {scatter:.2g} % of the largest value" if scatter else ""
        lines.append(f"sum of squares {self.chi2:.4g}, {self.freedom} degrees of freedom{words}; "
                     f"{sum(s < 1.01 * self.chi2 + 1e-9 for s in self.starts)} of {len(self.starts)} starts end there")
        return "\n".join(lines + self.untold)


def _varied(scene: dict[str, Any], parameters: list[Parameter], values: Sequence[float]) -> dict[str, Any]:
    import copy
    scene = copy.deepcopy(scene)
    for parameter, value in zip(parameters, values):
        set_key(scene, parameter.key, parameter.text(float(value)))
    return scene


def calibrate(parameters: dict[str, Range] | list[Parameter], curves: list[Curve], starts: int = 4) -> Fit:
    """Fits parameters to all curves at once.

    parameters: {key: (low, high)} with units, or Parameters. starts: how many, the first in the middle of the bounds.
    InputError names a key that a scene does not take, and a column that no response has.
    """
    from scipy.optimize import least_squares
    from scipy.stats import qmc
    chosen = parameters if isinstance(parameters, list) else [Parameter(k, *ends) for k, ends in parameters.items()]
    n = len(chosen)
    if not n or not curves or starts < 1:
        raise InputError("calibrate: no parameter, no curve or no start")
    known = all(curve.known for curve in curves)
    priors = [p for p in chosen if p.prior is not None]

    last: list[np.ndarray] = [np.full(n, np.nan), np.empty(0)]  # the solver asks for both at the same place

    def residuals(u: np.ndarray) -> np.ndarray:
        if not np.array_equal(u, last[0]):
            last[:] = u.copy(), compare(u)
        return last[1]

    def compare(u: np.ndarray) -> np.ndarray:
        values = [p.value(x) for p, x in zip(chosen, u)]
        parts = [(c.model(_varied(c.scene, chosen, values)) - c.y) / c.scatter for c in curves]
        parts.append(np.array([p.misfit(v) for p, v in zip(chosen, values) if p in priors]))
        return np.nan_to_num(np.concatenate(parts), nan=LOST)

    def jacobian(u: np.ndarray) -> np.ndarray:
        here = residuals(u)
        columns = []
        for k in range(n):
            step = STEP if u[k] + STEP <= 1 else -STEP
            columns.append((compare(u + step * np.eye(n)[k]) - here) / step)
        return np.stack(columns, axis=1)

    for curve in curves:
        curve.check(_varied(curve.scene, chosen, [p.value(0.5) for p in chosen]))
    places = np.vstack([np.full((1, n), 0.5), qmc.Sobol(n, scramble=False).random(max(starts, 2))[1:starts]])
    fits = [least_squares(residuals, np.clip(u, 0.01, 0.99), jacobian, (0, 1), x_scale=1.0, xtol=1e-8, ftol=1e-8)
            for u in places]
    best = min(fits, key=lambda f: f.cost)
    points = sum(len(c.x) for c in curves) + len(priors)
    return Fit(chosen, best.x, jacobian(best.x), 2 * best.cost, points, known, [2 * f.cost for f in fits])
