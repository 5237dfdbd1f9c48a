"""What is not known of a scene, carried through its prediction (`lamella rve` and `lamella process --uncertainty`).

The keys of the scene's block `uncertain` get N values each, one in the middle of each of N parts that are equally
likely (a Latin hypercube: McKay, Beckman & Conover, Technometrics 21 (1979) 239), in the order of a scrambled Sobol'
sequence, which spreads them evenly over all keys together (Owen, J. Complexity 14 (1998) 466). All samples are solved on
one mesh, and of each quantity the median is told and the interval that holds 95 % of the samples. Quantiles are Hazen's,
(k - 1/2)/n of the k-th of n values: exact for one key and a response that is linear in its place between the bounds. A
sample that has no answer is counted and left out.
"""
import json
import math
import os
import re
import sys
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from . import Error, InputError, parallel, program, scene_dict
from ._files import inputs_of, make_folder, may_write, with_member, write_whole
from ._served import UNSOLVED, end_with_program, progress as shown, served
from .measured import AREAS, FACTORS, FIGURES, FROM_INFLATED, figures_in, with_mesh
from .parameters import Parameter, uncertain, value_in, varied
from .units import time_unit

Object = dict[str, Any]
SEED = 1  #: of the samples: the same command has the same ones
ENDS = 0.025, 0.975  #: quantiles between which 95 % lie
LEAST = 40  #: answers for these: one of 40 is 2.5 %, so that one lies beyond each end; of fewer the extremes are told
CHANGE = 1e-6  #: by less, MPa or 1, nothing has changed
TENSORS = {"F11": "", "F22": "", "F12": "", "P11": "MPa", "P22": "MPa", "P12": "MPa"}
POINT = {"firmness": "MPa", "turgor": "MPa", "osmotic_pressure": "MPa"}
BODY = {"turgor_min": "MPa", "turgor_mean": "MPa", "turgor_max": "MPa", "plasmolysed": ""}
BOTH = {"water": "", "lumen_fraction": "", "walls": "", "lamella_normal_ratio": "", "lamella_shear_ratio": "",
        "wall_ratio": "", "opening_fraction": "", "debonded_fraction": ""}
QUANTITIES = POINT | BODY | BOTH | TENSORS  #: over states or time, and their units


class _Told:
    """What the program has told of one scene: values of quantities at `at`, numbers of states or s; `figures`, `first`:
    what happens first, and `first_at` at which load factor or time; `reason`: why it is not solved to the end; `inflated`:
    whether F counts from the inflated tissue."""

    def __init__(self, command: str, run: program.Run, failure: bool) -> None:
        rows = [row for row in run.objects if "state" in row or "step" in row]
        events = [row for row in rows if row.get("event")]
        self.at = np.array([row["time" if command == "process" else "state"] for row in rows], float)
        end = next((k for k, row in enumerate(rows) if row.get("status", "converged") != "converged"), len(rows))
        self.values = {name: np.array([_value(row, name) for row in rows[:end]] + [np.nan] * (len(rows) - end))
                       for name in QUANTITIES}
        found = figures_in(run.objects, failure, run.complete)
        self.figures = {name: found[name] / FACTORS[FIGURES[name]] for name in FIGURES if name in found}
        self.component = next((row["test"].get("component") for row in run.objects if row.get("test")), None)
        self.inflated = any(row.get("from_inflated") for row in rows)
        self.first: str | None = None
        self.first_at = np.nan
        if command == "process":
            self.first = events[0]["event"] if events else "none" if run.complete else "unknown"
            self.first_at = events[0]["time"] if events else np.nan
        elif failure:
            mode, criterion = found["mode"], found["criterion"]
            self.first = f"{mode}, {criterion}" if criterion else mode
            self.first_at = self.figures.get("failure.factor", np.nan)
        self.reason = "" if run.complete else _reason(rows, run.warnings)


def _value(row: Object, name: str) -> float:
    """Of a row; NaN where it has none."""
    if row.get("status", "converged") != "converged":
        return np.nan
    if name[0] in "FP" and name[1:].isdecimal():
        tensors = row.get("from_inflated") or row
        return tensors[name[0]][3 * int(name[1]) + int(name[2]) - 4] if "F" in tensors else np.nan
    value = row.get(name)
    return np.nan if value is None else float(value)


def _reason(rows: list[Object], lines: list[str]) -> str:
    for row in rows:
        if row.get("status", "converged") != "converged":
            return f"state {row['state']}: {row['status']}: {row['reason']}"
    return _words(lines[-1]) if lines else "it was not solved to the end"


def _words(message: Any) -> str:
    """Of a message that begins with the command and the file of the sample."""
    return re.sub(r"^(lamella[ a-z]*: )?(\S*\.yaml(:\d+)*: )?", "", str(message))


def sample(parameters: Sequence[Parameter], count: int) -> np.ndarray:
    """Values [count, parameters]."""
    from scipy.stats import qmc
    points = qmc.Sobol(len(parameters), seed=SEED).random_base2(math.ceil(math.log2(count)))[:count]
    places = (points.argsort(axis=0).argsort(axis=0) + 0.5) / count
    return np.array([[p.quantile(float(q)) for p, q in zip(parameters, row)] for row in places])


def band(values: np.ndarray) -> Object:
    """Median, the ends of the interval and the number of values that are known: None where there are none."""
    known = values[np.isfinite(values)]
    if not len(known):
        return {"low": None, "median": None, "high": None, "count": 0}
    low, median, high = np.quantile(known, (ENDS[0], 0.5, ENDS[1]), method="hazen").tolist()
    if len(known) < LEAST:
        low, high = float(known.min()), float(known.max())
    return {"low": low, "median": median, "high": high, "count": len(known)}


def _bare(values: Any) -> list[float | None]:
    return [float(v) if np.isfinite(v) else None for v in values]


def _run(command: str, scene: Object, path: str, failure: bool) -> _Told:
    from . import Scene
    options = ["--readings", "--quiet"] + ["--no-estimate"] * (command == "rve") + ["--failure"] * failure
    with program.path_of(Scene(path, scene)) as file:
        return _Told(command, program.run(command, file, *options), failure)


def _series(own: _Told, samples: list[_Told], command: str, text: Object) -> tuple[Object, list[Object]]:
    """The axis, and the bands over it of all that differs. Of a test the axis is the component that all samples share,
    of F or of P."""
    body, driven = "macro" in text, "program" in text.get("process", {})
    over, order = np.unique(own.at, return_index=True)
    of = {name: np.array([_on(over, told, name) for told in samples]) for name in own.values}
    ours = {name: values[order] for name, values in own.values.items()}
    axis, names = {"name": "time", "unit": "s", "values": over.tolist()}, [*(BODY if body else POINT), *BOTH]
    names += ["F11", "F22"] if not (body or driven) else [] if body else list(TENSORS)
    if command == "rve":
        axis = {"name": "state", "unit": "", "values": over.tolist()}
        names = [n + own.component for n in "FP"] if own.component else ["P11", "P22", "P12"]
        for name in names:
            if np.isfinite(ours[name]).all() and _is_shared(of[name], ours[name]):
                axis = {"name": name, "unit": QUANTITIES[name], "values": ours[name].tolist()}
                break
    told = []
    for name in names:
        if name != axis["name"] and _varies(of[name], ours[name]):
            bands = [band(column) for column in of[name].T]
            told.append({"name": name, "unit": QUANTITIES[name], "scene": _bare(ours[name]),
                         **{part: [b[part] for b in bands] for part in ("low", "median", "high", "count")}})
    return axis, told


def _is_shared(values: np.ndarray, own: np.ndarray) -> bool:
    """Whether all samples have the same, where they have something."""
    return not (np.abs(values - own) > CHANGE).any()


def _varies(values: np.ndarray, own: np.ndarray) -> bool:
    """Whether it changes along the axis, or between samples."""
    known = np.vstack([values, own])
    known = known[np.isfinite(known)]
    return bool(len(known)) and float(np.ptp(known)) > max(CHANGE, 1e-4 * float(np.abs(known).max()))


def _on(over: np.ndarray, told: _Told, name: str) -> np.ndarray:
    """Values of a sample at those of the scene's own run; NaN beyond its end and between states without an answer."""
    if not len(told.at):
        return np.full(len(over), np.nan)
    return np.interp(over, told.at, told.values[name], left=np.nan, right=np.nan)


def _first(own: _Told, samples: list[_Told], command: str) -> Object | None:
    """What happens first, in how many samples, and when."""
    if own.first is None:
        return None
    names = [told.first or "" for told in samples]
    at = np.array([told.first_at for told in samples])
    of = [{"name": name, "samples": names.count(name), "at": band(at[[n == name for n in names]])}
          for name in sorted(set(names), key=lambda name: (-names.count(name), name))]
    return {"of": "time" if command == "process" else "load_factor", "unit": "s" if command == "process" else "",
            "scene": {"name": own.first, "at": _bare([own.first_at])[0]}, "events": of, "names": names, "at": _bare(at)}


def bands(scene: str | os.PathLike[str], samples: int, command: str | None = None, failure: bool = False,
          processes: int | None = None, progress: Callable[[int, int], None] = lambda done, total: None) -> Object:
    """Solves so many samples of a scene's uncertain keys, and returns what is told of them: the object of `--json`
    (docs/reference/commands.md).

    command: "rve" or "process", default what the scene has; failure: of rve, also how the tissue fails; processes: at a
    time, default the number of processors; progress(done, total) is called after each. InputError: the scene has no
    block `uncertain`, or no sample has an answer.
    """
    path = os.fspath(scene)
    parameters, text = uncertain(path), scene_dict(path)
    solver = command or ("process" if "process" in text else "rve")
    if samples < 1:
        raise InputError(f"samples: {samples}: at least 1")
    block = "load" if solver == "rve" else "process"
    if block not in text:
        raise InputError(f"{path}: has no block `{block}`")
    values = sample(parameters, samples)
    base = with_mesh(text, path)
    scenes = [base, *(varied(base, parameters, row.tolist()) for row in values)]
    own, *told = parallel.commands(lambda each: _run(solver, each, path, failure), scenes, processes, progress)
    if isinstance(own, Error) or not len(own.at):
        raise InputError(f"{path}: with its own values: {_words(own if isinstance(own, Error) else own.reason)}")
    solved = [t for t in told if not isinstance(t, Error)]
    if not solved:
        raise InputError(f"{path}: none of {samples} samples could be solved; the first one: {_words(told[0])}")
    axis, series = _series(own, solved, solver, text)
    reference = (text["load"][0] if solver == "rve" else text["process"]).get("reference", "rest")
    names = [name for name in FIGURES if any(name in t.figures for t in (own, *solved))]
    figures = []
    for name in names:
        of = np.array([t.figures.get(name, np.nan) for t in solved])
        figures.append({"name": name, "unit": FIGURES[name], "scene": own.figures.get(name), **band(of),
                        "values": _bare(of)})
    failed = [{"sample": k + 1, "reason": _words(t) if isinstance(t, Error) else t.reason}
              for k, t in enumerate(told) if isinstance(t, Error) or t.reason]
    answered = [k + 1 for k, t in enumerate(told) if not isinstance(t, Error)]
    return {"lamella_uncertainty": 1, "scene": path, "command": solver, "samples": samples, "answered": answered,
            "failed": failed, "parameters": [{"key": p.key, "unit": p.unit, "bounds": [p.value(0), p.value(1)],
            "scene": value_in(text, p), "values": values[:, k].tolist()} for k, p in enumerate(parameters)],
            "reference": reference if own.inflated else None, "axis": axis, "series": series, "figures": figures,
            "first": _first(own, solved, solver)}


# ---- for people ----

def counted(name: str, area: str | None) -> str:
    """What F counts from, or P is per area of, where that is not the tissue at rest; a component of either by name."""
    if area is None or name not in TENSORS:
        return ""
    return FROM_INFLATED if name[0] == "F" else AREAS[area]


def _titled(name: str, unit: str) -> str:
    return f"{name} ({unit})" if unit else name


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}" if abs(value) > CHANGE else "0"


def _row(head: str, at: str, numbers: Sequence[float | None], count: int) -> str:
    return f"{head:26s} {at:>18s} " + " ".join(f"{_number(v):>10s}" for v in numbers) + f" {count:8d}"


def table(told: Object) -> list[str]:
    """Lines for people."""
    axis, rows = told["axis"], told["axis"]["values"]
    unit, one = time_unit(rows[-1]) if axis["unit"] == "s" else (axis["unit"], 1)
    lines = [f"{'':26s} {'at':>18s} " + " ".join(f"{w:>10s}" for w in ("scene", "median", "from", "to")) + "  samples"]
    parts = ("scene", "median", "low", "high")
    count = min(len(rows), 2 if axis["unit"] == "s" else 9)
    for of in told["series"]:
        for i in sorted({round(k) for k in np.linspace(0, len(rows) - 1, count)}):
            at = f"{'' if axis['unit'] == 's' else axis['name']} {_number(rows[i] / one)} {unit}".strip()
            lines.append(_row(_titled(of["name"], of["unit"]), at, [of[p][i] for p in parts], of["count"][i]))
    for of in told["figures"]:
        lines.append(_row(_titled(of["name"], of["unit"]), "", [of[p] for p in parts], of["count"]))
    first = told["first"]
    if first:
        lines.append("first event:" if axis["unit"] == "s" else "failure, and its load factor:")
        for event in first["events"]:
            own = first["scene"]["at"] if event["name"] == first["scene"]["name"] else None
            numbers = [None if v is None else v / one for v in (own, *(event["at"][p] for p in parts[1:]))]
            lines.append(_row(f"  {event['name']}", unit if event["at"]["count"] else "", numbers, event["samples"]))
    ways = {counted(of["name"], told["reference"]) for of in (axis, *told["series"])} - {""}
    return lines + [f"{'F' if way.startswith(' from') else 'P'}{way}" for way in sorted(ways)] + _ending(told)


def _ending(told: Object) -> list[str]:
    """What the intervals are, and what has no answer."""
    first = told["first"]
    counts = [of["count"] for of in told["figures"]] + [c for of in told["series"] for c in of["count"]]
    counts += [event["at"]["count"] for event in first["events"] if event["at"]["count"]] if first else []
    number = len(told["parameters"])
    keys = f"{told['samples']} samples of {number} key{'s' * (number > 1)}"
    words = "holds 95 % of them"
    if max(counts, default=0) < LEAST:
        words = f"are the least and the largest; an interval of 95 % takes {LEAST}"
    elif min(counts) < LEAST:
        words += f"; where fewer than {LEAST} have a value, all of them"
    lines = [f"{keys}: from ... to {words}"]
    lines += [f"not solved to the end: sample {f['sample']}: {f['reason']}" for f in told["failed"][:3]]
    if len(told["failed"]) > 3:
        lines.append(f"and {len(told['failed']) - 3} more")
    return lines


def run(request: Object) -> int:
    """Solves, and tells; the exit status: 3 where a sample is not solved to its end."""
    file = None
    if request.get("output"):
        file = may_write(make_folder(request["output"]) / "uncertainty.json", with_member("lamella_uncertainty"),
                         "the result of --uncertainty", request.get("overwrite", False), inputs_of(request["scene"]))
    told = bands(request["scene"], request["samples"], request["command"], bool(request.get("failure")),
                 request.get("processes"), (lambda done, total: None) if request.get("quiet") else shown("samples"))
    print(json.dumps(told) if request.get("json") else "\n".join(table(told)))
    if file:
        write_whole(file, json.dumps(told, allow_nan=False) + "\n")
        if not request.get("json"):
            print(f"wrote {file}")
    sys.stdout.flush()
    return UNSOLVED if told["failed"] else 0


def main(argument: str) -> int:
    """Exit status of a request."""
    end_with_program()
    request = json.loads(argument)
    return served(f"lamella {request['command']}", lambda: run(request))
