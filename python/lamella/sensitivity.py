"""How figures of a scene's test depend on the keys in its block `uncertain`.

    told = study("scene.yaml", evaluations=1000)
    print(told)

Local: at the scene's own values the elasticity d ln(figure) / d ln(key) of keys whose bounds are above 0, of others
d(figure) / d(key) times the width of the bounds over the figure; by differences of fourth order over four steps of 2 %
(of the width where there is no logarithm), to both sides or, at an end of the bounds, to one.

Global: Sobol' indices over the bounds (`sobol`), each key distributed as Parameter.quantile says, independently.
Figures are those of measured.FIGURES; of the mode of failure the indices are those of the number that is 1 where the
commonest mode occurs, else 0. All evaluations have the mesh that is chosen for the scene's own values.
"""
import csv
import io
import json
import math
import os
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import InputError, Scene, parallel, scene_dict
from ._files import inputs_of, make_folder, may_write, text_of, with_member, write_whole
from ._served import end_with_program, progress as shown, served
from .measured import FACTORS, FIGURES, OF_FAILURE, read_off, with_mesh
from .parameters import Parameter, uncertain, value_in, varied
from .program import SceneLike
from .sobol import LEAST, Indices, points, rows_for, rows_of, sobol

__all__ = ["Figure", "Sensitivity", "study"]
STEP = 0.02  #: of the differences: load factors have errors of 1e-3, other figures of 1e-9, differences of 1e-7
ROUGH = 0.02  #: between differences of second and fourth order, over the larger of the elasticity and 1: no derivative
FEW = 0.05  #: chosen: with more samples without a figure those that are left are others than were asked for
MODE = OF_FAILURE + "mode"
ROUNDING = 1e-9  #: of figures without a unit, as hysteresis, which are 0 where they are smaller
#: of bodies that are no boxes, plane ones and axisymmetric ones; stresses and strains of peaks are not told
OF_FORCES = [{"modulus": "N/mm^2", "energy_to_peak": "N", "work": "N", "returned": "N"},
             {"modulus": "N/mm", "energy_to_peak": "N mm", "work": "N mm", "returned": "N mm"}]
SAME = "no key changes it"
Found = dict[str, Any]  # figures by name, SI; mode
Job = tuple[str, dict[str, Any], bool]  # path of a scene, the scene, whether it is asked how it fails


def _offsets(p: Parameter, own: float) -> tuple[list[int], list[int]]:
    """Steps of the differences of a key, in units of STEP: all, and those of the lower order."""
    low, high = sorted((_moved(p, own, -2), _moved(p, own, 2)))
    if low < p.value(0):
        return [1, 2, 3, 4], [1, 2]
    return ([-1, -2, -3, -4], [-1, -2]) if high > p.value(1) else ([1, -1, 2, -2], [1, -1])


def _logarithmic(p: Parameter, own: float) -> bool:
    return p.logarithmic and own > 0


def _moved(p: Parameter, own: float, steps: int) -> float:
    """The value of a key so many steps away."""
    if _logarithmic(p, own):
        return own * math.exp(steps * STEP)
    return own + steps * STEP * (p.value(1) - p.value(0))


def _derivative(offsets: Sequence[int], own: float, values: Sequence[float]) -> float:
    """By steps, at 0, over the value there: exact for polynomials through all points."""
    x = np.array([0, *offsets], float)
    weights = np.linalg.solve(np.vander(x, increasing=True).T, np.eye(len(x))[1])
    return float(weights @ [own, *values]) / (STEP * own)


def _evaluate(jobs: list[Job]) -> Iterator[Found]:
    for path, scene, failure in jobs:
        yield read_off(scene, path, failure)


class Figure:
    """A figure: `own`, at the scene's values, `mean`, `deviation` and `quantiles` (2.5 and 97.5 %) of the samples, in
    `unit`; `elasticity` [keys] and `change`, that of it with the order of the differences, NaN: there is none;
    `indices`: an Indices, or None, and then `reason`; `missing`: evaluations without it."""

    def __init__(self, name: str, unit: str, values: np.ndarray, k: int, seed: int) -> None:
        self.name, self.unit, self.own = name, unit, math.nan
        self.elasticity, self.change = np.full(k, np.nan), np.full(k, np.nan)
        self.missing = int(np.isnan(values).sum())
        rows = rows_of(values, k)
        drawn = rows[:, :2][np.isfinite(rows[:, :2])]  # A and B, which are independent
        self.mean, self.deviation = (float(drawn.mean()), float(drawn.std())) if len(drawn) else (math.nan, math.nan)
        self.quantiles = np.quantile(drawn, [0.025, 0.975]) if len(drawn) else np.full(2, np.nan)
        self.indices: Indices | None = None
        self.reason = ""
        if self.missing > FEW * len(values):
            self.reason = f"{self.missing} of {len(values)} evaluations have none: too many for indices"
            return
        self.indices = sobol(values, k, seed)
        if self.indices is None:
            whole = np.isfinite(rows).all(axis=1).sum()
            self.reason = SAME if whole >= LEAST else f"{whole} rows of the samples are whole: too few"

    def local(self, k: int, offsets: tuple[list[int], list[int]], values: Sequence[float]) -> None:
        """Takes the elasticity of key k from values at all offsets."""
        if self.own == 0 or not np.isfinite([self.own, *values]).all():
            return
        self.elasticity[k] = _derivative(offsets[0], self.own, values)
        self.change[k] = abs(self.elasticity[k] - _derivative(offsets[1], self.own, values[:len(offsets[1])]))

    def is_rough(self, k: int) -> bool:
        """Whether the figure is not smooth over the steps, so that its elasticity is no derivative."""
        return bool(self.change[k] > ROUGH * max(1, abs(self.elasticity[k])))

    def told(self) -> dict[str, Any]:
        """An object of JSON; null: there is none."""
        of = self.indices
        return {"name": self.name, "unit": self.unit, "own": _bare(self.own), "mean": _bare(self.mean),
                "deviation": _bare(self.deviation), "quantiles": _bare(self.quantiles), "missing": self.missing,
                "elasticity": _bare(self.elasticity),
                "rough": [self.is_rough(k) for k in range(len(self.change))], "reason": self.reason or None,
                "rows": of.rows if of else 0, "first": _bare(of.first) if of else None,
                "first_interval": _bare(of.first_interval) if of else None, "total": _bare(of.total) if of else None,
                "total_interval": _bare(of.total_interval) if of else None}


class Sensitivity:
    """What was found. `parameters`, with the scene's own values `own` [keys] in the units of the bounds; `samples`
    [n (k + 2), k]: values of the keys, in the order of sobol.points; `found`: what each has given, SI; `figures`:
    Figures by name; `modes`: shares of the modes of failure, and `mode`, that at the scene's values."""

    def __init__(self, scene: str, parameters: list[Parameter], own: list[float], u: np.ndarray, seed: int) -> None:
        self.scene, self.parameters, self.own, self.seed = scene, parameters, own, seed
        self.rows = len(u) // (len(parameters) + 2)
        self.units = FIGURES
        self.samples = np.array([[p.quantile(x) for p, x in zip(parameters, point)] for point in u])
        self.found: list[Found] = []
        self.figures: dict[str, Figure] = {}
        self.modes: dict[str, float] = {}
        self.mode: str | None = None

    def take(self, names: list[str], failure: bool, own: Found, near: list[tuple[int, Found]]) -> None:
        """Statistics of `found`. own: figures at the scene's values; near: a key and figures one of its steps away."""
        for name in names:
            values = np.array([_value(f, name) for f in self.found])
            figure = Figure(name, self.units[name], values, len(self.own), self.seed)
            figure.own = _value(own, name)
            for k, p in enumerate(self.parameters):
                figure.local(k, _offsets(p, self.own[k]), [_value(f, name) for i, f in near if i == k])
            self.figures[name] = figure
        if failure:
            self.mode = own["mode"]
            self._take_modes()

    def _take_modes(self) -> None:
        modes = [f["mode"] for f in self.found]
        drawn = Counter(modes[:2 * self.rows])  # A and B
        self.modes = {mode: count / (2 * self.rows) for mode, count in drawn.most_common()}
        known = [mode for mode in self.modes if mode != "unknown"]
        if len(known) > 1:
            values = np.array([np.nan if mode == "unknown" else float(mode == known[0]) for mode in modes])
            self.figures[MODE] = Figure(f"{MODE} {known[0]}", "", values, len(self.own), self.seed)

    def __str__(self) -> str:
        k = len(self.own)
        lines = [f"{self.scene}: {len(self.found)} evaluations ({self.rows} x ({k} + 2)), seed {self.seed}"]
        same = [figure for figure in self.figures.values() if figure.reason == SAME]
        for name, figure in self.figures.items():
            if figure in same:
                continue
            lines += ["", self._modes_words() if name == MODE else _words(figure)]
            lines += [figure.reason] if figure.reason else []
            lines += self._table(figure, name != MODE)
        if same:
            lines += ["", f"{SAME}: {', '.join(f'{f.name} {f.mean:.4g} {f.unit}'.strip() for f in same)}"]
        if self.modes and MODE not in self.figures:
            lines += ["", self._modes_words()]
        return "\n".join([*lines, "", *self._notes()])

    def _modes_words(self) -> str:
        shares = ", ".join(f"{mode} {100 * share:.3g} %" for mode, share in self.modes.items())
        only = "" if MODE not in self.figures else f"; indices of {self.figures[MODE].name[len(MODE) + 1:]}"
        return f"mode of failure: {self.mode} at the scene's values; of the samples {shares}{only}"

    def _table(self, figure: Figure, local: bool) -> list[str]:
        of, width = figure.indices, max(len(p.key) for p in self.parameters) + 2
        if not of and not np.isfinite(figure.elasticity).any():
            return []
        lines = [f"  {'key':{width}}{'elasticity' if local else '':>12}" +
                 ("       first order             total" if of else "")]
        for k, p in enumerate(self.parameters):
            mark = " " if _logarithmic(p, self.own[k]) else "*"
            mark = " " if math.isnan(figure.elasticity[k]) else "~" if figure.is_rough(k) else mark
            line = f"  {p.key:{width}}" + (f"{_number(figure.elasticity[k], '.3f'):>11}{mark}" if local else 12 * " ")
            if of:
                line += "".join(f"{_number(v, '.3f'):>10} ± {(high - low) / 2:.3f}" for v, (low, high) in
                                ((of.first[k], of.first_interval[k]), (of.total[k], of.total_interval[k])))
            lines.append(line.rstrip())
        if of:
            lines.append(f"  {'sum':{width}}{'':12}{of.first.sum():10.3f}{'':8}{of.total.sum():10.3f}")
        return lines

    def _notes(self) -> list[str]:
        figures = [f for f in self.figures.values() if np.isfinite(f.elasticity).any()]
        keys = range(len(self.own))
        lines = ["elasticity: % that the figure changes by where the key changes by 1 %"] if figures else []
        if figures and not all(_logarithmic(p, v) for p, v in zip(self.parameters, self.own)):
            lines.append("*: bounds or value not above 0: derivative times the width of the bounds, over the figure")
        if any(f.is_rough(k) for f in figures for k in keys):
            lines.append("~: the figure is not smooth here: with other steps another value")
        widths = [np.ptp(of, axis=1).max() / 2 for f in self.figures.values() if f.indices
                  for of in (f.indices.first_interval, f.indices.total_interval)]
        if widths:
            lines.append("±: half the interval of 95 %; half as wide with four times the --evaluations")
        return lines

    def told(self) -> dict[str, Any]:
        """All of it but the samples as an object of JSON."""
        keys = [{"key": p.key, "unit": p.unit, "bounds": [p.value(0), p.value(1)], "own": own, "prior": p.prior,
                 "logarithmic": _logarithmic(p, own)} for p, own in zip(self.parameters, self.own)]
        indices = self.figures[MODE].told() if MODE in self.figures else None
        failure = None if self.mode is None else {"own": self.mode, "shares": self.modes, "indices": indices}
        return {"lamella_sensitivity": 1, "scene": self.scene, "evaluations": len(self.found), "rows": self.rows,
                "seed": self.seed, "keys": keys, "mode": failure,
                "figures": [f.told() for name, f in self.figures.items() if name != MODE]}

    def table(self) -> str:
        """All samples as CSV, values and figures in their units: row and block (A, B, or the key that A has from B)."""
        keys, names = self.parameters, [name for name in self.figures if name != MODE]
        out = io.StringIO()
        file = csv.writer(out, lineterminator="\n")
        titles = [(p.key, p.unit) for p in keys] + [(name, self.units[name]) for name in names]
        file.writerow(["row", "block", *(f"{name} ({unit})" if unit else name for name, unit in titles)] +
                      ["mode"] * (self.mode is not None))
        blocks = ["A", "B", *(p.key for p in keys)]
        for i, (values, found) in enumerate(zip(self.samples, self.found)):
            figures = [_value(found, name) if name in found else "" for name in names]
            file.writerow([i % self.rows, blocks[i // self.rows], *values.tolist(), *figures] +
                          ([] if self.mode is None else [found["mode"]]))
        return out.getvalue()

    def write(self, folder: str | os.PathLike[str], overwrite: bool = False) -> None:
        """sensitivity.json and samples.csv in a folder. InputError: they would replace other files; OSError: they
        cannot be written."""
        names = outputs(folder, overwrite)
        for name, text in zip(names, (json.dumps(self.told()) + "\n", self.table())):
            write_whole(name, text)


def _is_samples(path: Path) -> bool:
    """The table of samples: row, block, keys, figures."""
    head = next(csv.reader(io.StringIO(text_of(path))), [])
    names = [re.sub(r" \([^()]*\)$", "", column) for column in head[2:]]
    return head[:2] == ["row", "block"] and bool(names) and all(
        name in (*FIGURES, "mode") or "." in name for name in names)


def outputs(folder: str | os.PathLike[str], overwrite: bool = False, inputs: Sequence[str] = ()) -> tuple[Path, Path]:
    """The folder's sensitivity.json and samples.csv, which may be written; the folder is made where it is not there."""
    folder = make_folder(folder)
    return (may_write(folder / "sensitivity.json", with_member("lamella_sensitivity"), "the result of a sensitivity",
                      overwrite, inputs),
            may_write(folder / "samples.csv", _is_samples, "a table of samples", overwrite, inputs))


def _value(found: Found, name: str) -> float:
    """A figure in its unit; NaN: there is none."""
    value = float(found.get(name, math.nan)) / FACTORS[FIGURES[name]]
    return 0.0 if not FIGURES[name] and abs(value) < ROUNDING else value


def _bare(value: Any) -> Any:
    """As JSON has it: null for NaN."""
    if np.ndim(value):
        return [_bare(v) for v in value]
    return float(value) if math.isfinite(value) else None


def _number(value: float, form: str) -> str:
    """No digits of rounding, and no minus before zero."""
    text = format(value, form) if math.isfinite(value) else "-"
    return text[1:] if text[:1] == "-" and text.strip("-0.") == "" and text != "-" else text


def _words(figure: Figure) -> str:
    unit = f" {figure.unit}" if figure.unit else ""
    own = "none" if math.isnan(figure.own) else f"{figure.own:.4g}{unit}"
    text = f"{figure.name}: {own} at the scene's values"
    if math.isfinite(figure.mean):
        low, high = figure.quantiles
        text += (f"; mean {figure.mean:.4g}{unit}, standard deviation {figure.deviation:.3g}{unit}, 95 % from "
                 f"{low:.4g} to {high:.4g}{unit}")
    if figure.missing and not figure.reason:
        text += f"; {figure.missing} evaluations have none: their rows are left out"
    return text


def _fails(scene: dict[str, Any]) -> bool:
    """Whether it is asked of a scene how it fails."""
    law = (scene["rve"].get("interface") or {}).get("law")
    return "load" in scene and ("strength" in scene or law == "lamella")


def _check_names(name: str, scene: dict[str, Any], figures: Sequence[str]) -> None:
    """InputError: there is no such figure, or not of this scene."""
    for figure in figures:
        if figure not in (*FIGURES, MODE):
            raise InputError(f"{figure}: is no figure; there are {', '.join((*FIGURES, MODE))}")
        if figure.startswith(OF_FAILURE) and not _fails(scene):
            raise InputError(f"{figure}: {name} tells no failure: that is of scenes with a block load, and a block "
                             "strength or the law lamella")


def _checked(jobs: list[Job], parameters: list[Parameter], values: np.ndarray) -> list[Job]:
    """InputError: a scene is refused; its values are told. Before any is solved."""
    for (path, scene, _), of in zip(jobs, values):
        try:
            Scene(path, scene)
        except InputError as error:
            words = ", ".join(f"{p.key}: {p.text(float(f'{v:.6g}'))}" for p, v in zip(parameters, of))
            raise InputError(f"{error} (with {words}); give bounds within which all scenes are possible") from None
    return jobs


def study(scene: SceneLike, evaluations: int = 1000, figures: Sequence[str] | None = None, seed: int = 0,
          processes: int | None = None, progress: Callable[[int, int], None] = lambda done, total: None) -> Sensitivity:
    """Elasticities and Sobol' indices of a scene's figures by the keys in its block `uncertain`.

    evaluations: about so many, n (k + 2) of k keys with a power of two n; four more for each key, and one, give the
    elasticities. figures: names of measured.FIGURES and "failure.mode"; None: all that the scene has. seed: of the
    samples and of the bootstrap; processes: at a time, default the number of processors; progress(done, total).
    InputError: the scene, its block, a name, or a scene between the bounds is wrong.
    """
    parameters, text = uncertain(scene), scene_dict(scene)
    path = "scene" if isinstance(scene, dict) else scene.path if isinstance(scene, Scene) else os.fspath(scene)
    k, n = len(parameters), rows_for(len(parameters), evaluations)
    if n < LEAST:
        raise InputError(f"{evaluations} evaluations are too few for {k} keys: give at least {LEAST * (k + 2)}")
    _check_names(path, text, figures or [])
    failure = _fails(text) and (figures is None or any(name.startswith(OF_FAILURE) for name in figures))
    base = with_mesh(text, path)
    own = [value_in(base, p) for p in parameters]
    here = read_off(base, path, failure)
    names = [name for name in FIGURES if (name in here or name == f"{OF_FAILURE}factor" and failure
                                          if figures is None else name in figures)]
    if not names and not failure:
        raise InputError(f"{path}: its test has no figures: nothing is read off that could depend on the keys")
    told = Sensitivity(path, parameters, own, points(k, n, seed), seed)
    if here.get("of_forces"):
        told.units = FIGURES | OF_FORCES[text["macro"].get("symmetry") == "axisymmetric"]
    near = [(i, [*own[:i], _moved(p, own[i], steps), *own[i + 1:]])
            for i, p in enumerate(parameters) for steps in _offsets(p, own[i])[0]]
    values = np.concatenate([np.array([v for _, v in near]).reshape(-1, k), told.samples])
    jobs = _checked([(path, varied(base, parameters, v), failure) for v in values], parameters, values)
    found = parallel.each(_evaluate, jobs, processes, progress)
    told.found = found[len(near):]
    told.take(names, failure, here, [(i, f) for (i, _), f in zip(near, found)])
    return told


def run(request: dict[str, Any]) -> None:
    """What `lamella sensitivity` does."""
    folder, figures = request.get("output"), request.get("figure")
    if folder:
        outputs(folder, request.get("overwrite", False), inputs_of(request["scene"]))
    told = study(request["scene"], request.get("evaluations", 1000), figures.split(",") if figures else None,
                 request.get("seed", 0), request.get("processes"), shown("evaluations"))
    print(json.dumps(told.told()) if request.get("json") else told)
    if not folder:
        return
    told.write(folder, request.get("overwrite", False))
    if not request.get("json"):
        print(f"wrote {Path(folder) / 'sensitivity.json'} and samples.csv", flush=True)


def main(argument: str) -> int:
    """Exit status of a request."""
    end_with_program()
    return served("lamella sensitivity", lambda: run(json.loads(argument)))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
