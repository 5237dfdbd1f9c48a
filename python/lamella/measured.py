"""What was measured: curves and single figures, and what scenes find for them.

A file of data is CSV. A curve has the titles of two members of a response, "F11, P11 (MPa)", and may have a third
column, `scatter`, the standard deviation of the second. Single figures have the titles "figure, value, scatter", and
lines such as "modulus (MPa), 3.6, 0.4": what `lamella rve --readings` and `--failure` tell (FIGURES).
"""
import math
import os
import re
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import RVE, InputError, Responses, Scene, columns, program, scene_dict
from ._library import MEMBERS
from .parameters import Parameter
from .program import SceneLike
from .units import quantity

COLUMN = re.compile(r"^\s*([A-Za-z_]+?)(?:([123])([123]))?\s*(?:\(([^)]*)\))?\s*$")
FIGURE = re.compile(r"^\s*([a-z_.]+)\s*(?:\(([^)]*)\))?\s*$")
#: what can be read off a test, and its unit in JSON
FIGURES = {"modulus": "MPa", "poisson": "", "bioyield.strain": "", "bioyield.stress": "MPa", "peak.strain": "",
           "peak.stress": "MPa", "energy_to_peak": "kJ/m^3", "work": "kJ/m^3", "returned": "kJ/m^3", "hysteresis": "",
           "failure.factor": "", "failure.strain": "", "failure.stress": "MPa"}
CURVE_LINES = "F11, P11 (MPa) and 1.05, 0.012"  #: an example
FIGURE_LINES = "figure, value, scatter and modulus (MPa), 3.6, 0.4"  #: an example
OF_FAILURE = "failure."
OF_PEAK, OF_ALL = ("peak.strain", "peak.stress", "energy_to_peak"), ("work", "returned", "hysteresis")
#: what F counts from, and P is per area of, in labels
FROM_INFLATED = " from the inflated tissue"
AREAS = {"rest": " per area at rest", "inflated": " per area of the inflated tissue"}
FACTORS = {"": 1.0, "MPa": 1e6, "kJ/m^3": 1e3}  #: SI values of the units of JSON
TENSOR = 9  #: components
#: units of members that scenes know: their dimension, and an example
DIMENSIONS = {"Pa": ("stress", "MPa"), "m": ("length", "um"), "s": ("time", "s")}
ENERGIES = {"J/m^3": 1.0, "kJ/m^3": 1e3, "MJ/m^3": 1e6}  #: no dimension of scenes


class Curve:
    """A measured curve, and the scene whose block `load` repeats it.

    data: a CSV file, or {"F11": values, "P11 (MPa)": values}: members of a response, with components where it has them,
    in the order x, y. Where the scene begins with `inflate`, F counts from the inflated tissue. scatter: standard
    deviation of y, a share of its largest value, or with a unit ("5 kPa"); by default that of the file, or unknown, and
    found from the misfit. keys: of the parameters that are of this scene; None: all. The model is interpolated between
    its states (monotone cubic), so the scene's ramp needs as many steps as the curve has bends, and a state where it
    begins.
    """

    def __init__(self, scene: SceneLike, data: str | os.PathLike[str] | dict[str, ArrayLike],
                 scatter: str | float | None = None, keys: set[str] | None = None) -> None:
        self.name = os.fspath(data) if not isinstance(data, dict) else "data"
        self.path, self.scene, self.keys = _path(scene), scene_dict(scene), keys
        given, self.lines = (dict(data), []) if isinstance(data, dict) else _read(self.name)
        own = given.pop("scatter", None)
        if len(given) != 2:
            raise InputError(f"{self.name}: has {len(given)} column{'s' * (len(given) != 1)} ({', '.join(given)}); a curve "
                             "has two, such as F11, P11 (MPa), and may have a third, scatter")
        self.columns = [_Column(self.name, title) for title in given]
        self.x, self.y = (c.si(values) for c, values in zip(self.columns, given.values()))
        if self.x.ndim != 1 or self.x.shape != self.y.shape or not len(self.x):
            raise InputError(f"{self.name}: numbers of the shapes {self.x.shape} and {self.y.shape} in its columns; a curve "
                             "has as many of both")
        if not (np.isfinite(self.x) & np.isfinite(self.y)).all():
            raise InputError(f"{self.name}: a value is not a finite number")
        self.known = scatter is not None or own is not None
        self.scatter: np.ndarray = np.full(len(self.y), float(np.abs(self.y).max()))
        if isinstance(scatter, str):
            self.scatter[:] = quantity(scatter, self.columns[1].dimension)
        elif scatter is not None:
            self.scatter *= scatter
        elif own is not None:
            self.scatter = self.columns[1].si(own)
        if not self.known and not self.y.any():
            raise InputError(f"{self.name}: column {self.columns[1].title}: all values are 0; give their scatter")
        if self.scatter.shape != self.y.shape or not (wrong := self.scatter > 0).all():
            where = f":{self.lines[int(np.argmin(wrong))]}" if self.lines else ""
            raise InputError(f"{self.name}{where}: a scatter is not above 0" if self.scatter.shape == self.y.shape else
                             f"{self.name}: {self.scatter.size} numbers of scatter for {len(self.y)} points")

    def point(self, k: int) -> str:
        """Point k, for messages: its line and values in the units of the titles."""
        where = f"{self.name}:{self.lines[k]}" if self.lines else f"{self.name}, point {k + 1}"
        return f"{where}: " + ", ".join(f"{c.title} = {v[k] / c.one:.6g}" for c, v in zip(self.columns, (self.x, self.y)))

    def states(self, scene: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
        """x and y of the states of a scene, up to the first that has not converged. InputError: x goes back."""
        r = RVE(Scene(self.path, scene)).solve(derivatives=False)
        end = len(r) if r.converged.all() else int(np.argmin(r.converged))
        x, y = (c.of(r, scene)[:end] for c in self.columns)
        steps = np.diff(x)
        if (steps > 0).any() and (steps < 0).any():
            raise InputError(f"{self.name}: along the scene's load {self.columns[0].title} goes back: give loading and "
                             "unloading as experiments of their own, each with its scene and its data")
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

    def settle(self, middle: dict[str, Any]) -> None:
        """All solves from now on have the mesh of a scene in the middle of the bounds."""
        self.scene = with_mesh(self.scene, self.path, middle)

    def told(self, scene: dict[str, Any]) -> dict[str, Any]:
        """Data and model in the units of the titles, for charts."""
        x, y = self.columns
        return {"name": self.name, "x": x.title, "y": y.title, "data": [(self.x / x.one).tolist(),
                (self.y / y.one).tolist()], "scatter": (self.scatter / y.one).tolist() if self.known else None,
                "model": [(of / c.one).tolist() for of, c in zip(self.states(scene), self.columns)]}


class Figures:
    """Single measured figures, and the scene whose test gives them.

    data: a CSV file with the titles "figure, value, scatter", or {"modulus (MPa)": (3.6, 0.4)}: values and standard
    deviations, of FIGURES. keys: as of Curve.
    """

    known = True

    def __init__(self, scene: SceneLike, data: str | os.PathLike[str] | dict[str, tuple[float, float]],
                 keys: set[str] | None = None) -> None:
        self.name = os.fspath(data) if not isinstance(data, dict) else "data"
        self.path, self.scene, self.keys = _path(scene), scene_dict(scene), keys
        if not isinstance(data, dict):
            data = _read_figures(self.name)
        self.titles, self.names, self.ones = list(data), [], []
        for title in data:
            name, one = _figure(self.name, title)
            self.names.append(name)
            self.ones.append(one)
        ones = np.array(self.ones)
        self.y, self.scatter = (ones * np.array([float(v[k]) for v in data.values()]) for k in (0, 1))
        if not (self.scatter > 0).all():
            raise InputError(f"{self.name}: {self.titles[int(np.argmin(self.scatter > 0))]}: its scatter is not above 0")

    def point(self, k: int) -> str:
        """As of Curve."""
        return f"{self.name}: {self.titles[k]} = {self.y[k] / self.ones[k]:.6g}"

    def model(self, scene: dict[str, Any]) -> np.ndarray:
        """The figures of a scene, SI; NaN where it has none."""
        found = read_off(scene, self.path, any(name.startswith(OF_FAILURE) for name in self.names))
        if found.get("of_forces"):
            raise InputError(f"{self.path}: macro: the test of a body that is no box gives forces, which are none of "
                             f"{', '.join(FIGURES)}; take a box")
        return np.array([found.get(name, np.nan) for name in self.names], float)

    def check(self, scene: dict[str, Any]) -> None:
        """InputError unless a scene has the figures."""
        for title, value in zip(self.titles, self.model(scene)):
            if math.isnan(value):
                raise InputError(f"{self.name}: {title}: with parameters in the middle of their bounds the scene has "
                                 "none")

    def settle(self, middle: dict[str, Any]) -> None:
        """As of Curve."""
        self.scene = with_mesh(self.scene, self.path, middle)

    def told(self, scene: dict[str, Any]) -> dict[str, Any]:
        """As of Curve."""
        ones = np.array(self.ones)
        return {"name": self.name, "figures": self.titles, "data": (self.y / ones).tolist(),
                "scatter": (self.scatter / ones).tolist(), "model": (self.model(scene) / ones).tolist()}


Experiment = Curve | Figures


def experiment(scene: SceneLike, path: str, parameters: list[Parameter]) -> Experiment:
    """Of a scene and a file of data, whatever that holds."""
    keys = {p.key for p in parameters}
    kind = Figures if columns.read(path, CURVE_LINES)[0][1][0] == "figure" else Curve
    return kind(scene, path, keys=keys)


def read_off(scene: dict[str, Any], path: str = "scene", failure: bool = False) -> dict[str, Any]:
    """The FIGURES of a scene's test that it has, SI; with failure also `mode` and `criterion`, texts. Where a state has
    no answer there is no work of all states, and no peak unless the curve falls behind it. Bodies, processes and
    failure are solved by the program, in a process of their own. With `of_forces` a body is no box: figures are 1e6 or
    1e3 times what JSON has in N and mm."""
    text = Scene(path, scene)
    if "load" in scene and not failure:
        rve = RVE(text)
        complete = bool(rve.solve().converged.all())
        objects = [{"test": rve.readings}]
    else:
        told = _asked(text, "rve" if "load" in scene else "process" if "process" in scene else "fe2", failure)
        objects, complete = told.objects, told.complete
        if "load" in scene:  # whose failure may be unknown although all states have answers
            complete = all(part.get("status", "converged") == "converged" for part in objects)
    return figures_in(objects, failure, complete)


def figures_in(objects: list[dict[str, Any]], failure: bool = False, complete: bool = True) -> dict[str, Any]:
    """The same of the objects that a command has told; complete: all states have answers."""
    found: dict[str, Any] = {}
    for part in objects:
        _flatten(part.get("test"), "", found)
        _flatten(part.get("failure"), OF_FAILURE, found)
    if found.get("work") and found.get("returned"):  # 0: the load does not return
        found["hysteresis"] = 1 - found["returned"] / found["work"]
    if failure:
        found |= _at_failure(objects, found)
    read: dict[str, Any] = {name: found[name] * FACTORS[unit] for name, unit in FIGURES.items()
                            if isinstance(found.get(name), (int, float))}
    for name in () if complete else OF_ALL if found.get("peak_passed") else OF_ALL + OF_PEAK:
        read.pop(name, None)
    if "boundary" in found and "reference" not in found:
        read["of_forces"] = True
    if failure:
        read["mode"] = found.get(OF_FAILURE + "mode", "unknown")
        read["criterion"] = found.get(OF_FAILURE + "criterion")
        read["wall_over_lamella"] = found.get(OF_FAILURE + "wall_over_lamella")
    return read


def _at_failure(objects: list[dict[str, Any]], found: dict[str, Any]) -> dict[str, float]:
    """Strain and stress (MPa) of the test's curve where the tissue fails first; the stress between two states by a
    straight line."""
    if "component" not in found or OF_FAILURE + "F" not in found or OF_FAILURE + "criterion" not in found:
        return {}  # F is of the last state where nothing fails
    row, column = (int(i) - 1 for i in found["component"])
    start = np.reshape(found.get("F_inflated", np.eye(3)), (3, 3))
    strain = lambda F: (np.reshape(F, (3, 3)) @ np.linalg.inv(start))[row, column] - (row == column)
    inflated = found.get("reference") == "inflated"
    states = [part for part in objects if "P" in part and part["status"] == "converged"]
    P = [np.reshape(part["from_inflated"]["P"] if inflated else part["P"], (3, 3))[row, column] for part in states]
    x = np.array([strain(part["F"]) for part in states])
    order, at = np.argsort(x), strain(found[OF_FAILURE + "F"])
    return {"failure.strain": float(at), "failure.stress": float(np.interp(at, x[order], np.array(P)[order]))}


def with_mesh(scene: dict[str, Any], path: str = "scene", middle: dict[str, Any] | None = None) -> dict[str, Any]:
    """A scene with the mesh that is chosen for it, or for another one, so that all of a study have the same: results
    are then smooth in the parameters, and no scene waits for the choice."""
    with program.path_of(Scene(path, middle or scene)) as file:
        mesh = program.run("check", file)[0]["mesh"]
    chosen = {name: mesh[name] for name in ("along", "through", "grading") if name in mesh}
    return scene | {"rve": scene["rve"] | {"mesh": (scene["rve"].get("mesh") or {}) | chosen}}


def _asked(scene: Scene, command: str, failure: bool) -> program.Run:
    options = ["--readings"] + ["--no-estimate"] * (command == "rve") + ["--failure"] * failure
    with program.path_of(scene) as file:
        return program.run(command, file, *options, "--quiet")


def _flatten(block: Any, head: str, found: dict[str, Any]) -> None:
    if isinstance(block, dict):
        for name, value in block.items():
            _flatten(value, f"{head}{name}." if isinstance(value, dict) else f"{head}{name}", found)
    elif block is not None:
        found[head] = block


def _path(scene: SceneLike) -> str:
    """Where the files that a scene names are looked for from."""
    return "scene" if isinstance(scene, dict) else scene.path if isinstance(scene, Scene) else \
        os.fspath(scene) if "\n" not in os.fspath(scene) else "scene"


class _Column:
    """A member of a response, or a component of it, in a unit."""

    def __init__(self, source: str, title: str) -> None:
        match = COLUMN.match(title)
        if not match:
            raise InputError(f"{source}: a column {title!r}; its title is a member of a response with its unit, such as P11 (MPa)")
        self.title, self.member = title.strip(), match[1]
        self.index = tuple(int(i) - 1 for i in match.group(2, 3)) if match[2] else ()
        of = {name: (count, unit) for name, type_, count, _, unit, _ in MEMBERS
              if type_ == "f" and count in (1, TENSOR)}
        if self.member == "scatter":
            raise InputError(f"{source}: a column {self.title}: write scatter, without a unit: it has that of the "
                             "second column")
        if self.member not in of:
            raise InputError(f"{source}: a column {self.title}: a response has no number {self.member}; it has "
                             f"{', '.join(of)}")
        count, unit = of[self.member]
        if (count == TENSOR) != bool(self.index):
            raise InputError(f"{source}: a column {self.title}: {self.member} " +
                             ("is a tensor: write a component, as P11" if count == TENSOR else "has no components"))
        if unit in DIMENSIONS and not match[4]:
            raise InputError(f"{source}: a column {self.title}: the unit is missing, as {self.title} "
                             f"({DIMENSIONS[unit][1]})")
        self.dimension = DIMENSIONS[unit][0] if unit in DIMENSIONS else None
        self.one = quantity(f"1 {match[4]}", self.dimension) if match[4] else 1.0

    def si(self, values: ArrayLike) -> np.ndarray:
        return self.one * np.asarray(values, float)

    def of(self, r: Responses, scene: dict[str, Any]) -> np.ndarray:
        values = getattr(r, self.member)
        if self.member == "F" and "inflate" in scene["load"][0]:
            values = values @ np.linalg.inv(values[0])
        return np.asarray(values[(slice(None), *self.index)], float)


def _figure(source: str, title: str) -> tuple[str, float]:
    """Name and SI value of the unit of a figure."""
    match = FIGURE.match(title)
    if not match or match[1] not in FIGURES:
        raise InputError(f"{source}: a figure {title!r}; wanted is one of {', '.join(FIGURES)}, with its unit")
    name, unit, own = match[1], match[2] or "", FIGURES[match[1]]
    if bool(unit) != bool(own):
        raise InputError(f"{source}: {title}: {'has no unit' if unit else f'a unit is missing, as ({own})'}")
    if own == "kJ/m^3":
        if unit not in ENERGIES:
            raise InputError(f"{source}: {title}: the unit is none of {', '.join(ENERGIES)}")
        return name, ENERGIES[unit]
    return name, quantity(f"1 {unit}", "stress") if unit else 1.0


def _read(path: str) -> tuple[dict[str, ArrayLike], list[int]]:
    """Columns of a CSV file by their titles, and the numbers of its lines."""
    (head, titles), *rows = columns.read(path, CURVE_LINES)
    if twice := next((title for k, title in enumerate(titles) if title in titles[:k]), None):
        raise InputError(f"{path}:{head}: two columns are called {twice}")
    if not rows:
        raise InputError(f"{path}: has no numbers under its line of titles, {', '.join(titles)}")
    values = [[columns.number(path, line, title, cell) for title, cell in zip(titles, row)] for line, row in rows]
    return {title: [row[k] for row in values] for k, title in enumerate(titles)}, [line for line, _ in rows]


def _read_figures(path: str) -> dict[str, tuple[float, float]]:
    (head, titles), *rows = columns.read(path, FIGURE_LINES)
    if titles != ["figure", "value", "scatter"] or not rows:
        raise InputError(f"{path}:{head}: {', '.join(titles)}: give lines such as {FIGURE_LINES}")
    read: dict[str, tuple[float, float]] = {}
    for line, (name, *cells) in rows:
        if name in read:
            raise InputError(f"{path}:{line}: {name}: is there already")
        value, scatter = (columns.number(path, line, title, cell) for title, cell in zip(titles[1:], cells))
        if scatter <= 0:
            raise InputError(f"{path}:{line}: column scatter: {scatter:g}: is not above 0")
        read[name] = value, scatter
    return read
