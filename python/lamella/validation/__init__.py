"""Published measurements against what Lamella finds for them: `lamella validate`.

Each experiment has its source, how it was read, what was chosen or fitted, and rows that were predicted. The scenes of
the tissues are in the folder `scenes`; their block `uncertain` gives each figure an interval, which a prediction
carries: the 95 % of SAMPLES samples.
"""
import copy
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .. import Error, parallel, program, scene_dict
from ..measured import read_off, with_mesh
from ..parameters import uncertain, varied
from ..uncertainty import band as interval_of
from ..uncertainty import sample

SCENES = Path(__file__).parent / "scenes"
SOURCE = Path(__file__).resolve().parents[3] / "tests" / "scenes" / "tissues"
TISSUES = SOURCE if SOURCE.is_dir() else SCENES / "tissues"  #: an installed package has them
SAMPLES = 40  #: 2.5 and 97.5 % of them are the extremes
ABOUT = 0.1  #: scatter that a single figure is given whose source tells none, chosen

Scene = dict[str, Any]


@dataclass
class Row:
    """A figure: measured between low and high, predicted with an interval, or fitted (`fitted`)."""
    what: str
    unit: str
    low: float
    high: float
    predicted: float
    interval: tuple[float, float] | None = None
    fitted: bool = False

    @property
    def inside(self) -> bool:
        """Whether the predicted value itself was measured."""
        return bool(self.low <= self.predicted <= self.high)

    def ends(self) -> tuple[float, float]:
        """Of what is predicted, its interval included."""
        known = [v for v in (self.predicted, *(self.interval or ())) if math.isfinite(v)]
        return (min(known), max(known)) if math.isfinite(self.predicted) else (math.nan, math.nan)

    @property
    def within(self) -> bool:
        """Whether prediction and measurement, each with its interval, have values in common."""
        low, high = self.ends()
        return bool(low <= self.high and high >= self.low)

    @property
    def miss(self) -> float:
        """Factor between the nearest ends of what was measured and predicted, at least 1; inf: there is no answer."""
        if self.within:
            return 1.0
        low, high = self.ends()
        below, above = (high, self.low) if high < self.low else (self.high, low)
        return float(above / below) if below > 0 and math.isfinite(above) else math.inf


@dataclass
class Mode:
    """How tissue fails, or which way a figure goes: seen, and found."""
    what: str
    seen: str
    found: str

    @property
    def right(self) -> bool:
        return self.seen == self.found


@dataclass
class Experiment:
    name: str
    title: str
    source: str
    read: str  #: how its figures were read, and what they are
    chosen: str  #: what was chosen or fitted, and from what
    lesson: str  #: what the comparison shows; of a miss the physics that is lacking
    rows: list[Row] = field(default_factory=list)
    modes: list[Mode] = field(default_factory=list)

    @property
    def verdict(self) -> str:
        """within, misses, or none where nothing was predicted as a figure."""
        told = [row for row in self.rows if not row.fitted]
        return "none" if not told else "within" if all(row.within for row in told) else "misses"

    @property
    def miss(self) -> float:
        return max([row.miss for row in self.rows if not row.fitted], default=1.0)


def about(value: float) -> tuple[float, float]:
    """Bounds of a figure without a scatter of its own."""
    return (1 - ABOUT) * value, (1 + ABOUT) * value


def scene(name: str, **changes: Any) -> Scene:
    """A scene of the folder, with other blocks."""
    return scene_dict(str(SCENES / f"{name}.yaml")) | changes


def tissue(name: str, load: list[Any], strength: Scene | None = None, mode: str = "prescribed") -> Scene:
    """One of the six tissues at its start, under a load; mode: of its turgor; strength: another one."""
    of = scene_dict(str(TISSUES / f"{name}.yaml"))
    rve = of["rve"] | {"turgor": of["rve"]["turgor"] | {"mode": mode}}
    known = [entry for entry in of.get("uncertain", []) if entry["key"].startswith("rve.")]
    return {"version": 1, "rve": rve, "load": load, "uncertain": known} | ({"strength": strength} if strength else {})


def pulled(to: float, steps: int = 1, seconds: float | None = None) -> list[Any]:
    """A load: the tissue as turgor inflates it, then stretched with its sides free."""
    ramp: dict[str, Any] = {"to": [[to, 0], [0, "free"]], "P": [["x", "x"], ["x", "0 MPa"]], "steps": steps}
    if seconds is None:
        return [{"inflate": True}, {"ramp": ramp}]
    return [{"inflate": True, "for": "1 day"}, {"ramp": ramp, "for": f"{seconds} s"}]


def changed(of: Scene, turgor: float, walls: float = 1, lamella: float = 1) -> Scene:
    """Tissue with another turgor (MPa), its moduli and strengths of walls and of the lamella by factors."""
    of = copy.deepcopy(of)
    of["rve"]["turgor"]["pressure"] = f"{turgor!r} MPa"
    for name in ("C1", "C2", "C4"):
        of["rve"]["wall"][name] = _times(of["rve"]["wall"][name], walls)
    for name, value in of.get("strength", {}).items():
        of["strength"][name] = _times(value, walls if name == "wall" else lamella)
    return of


def number_of(value: str) -> float:
    """Of a quantity, in its unit."""
    return float(value.split()[0])


def _times(value: str, factor: float) -> str:
    number, unit = value.split()
    return f"{float(number) * factor!r} {unit}"


def followed(of: list[Scene]) -> list[dict[str, float]]:
    """Turgor (MPa) and factors of walls and lamella at the end of processes, solved in parallel."""
    return parallel.each(_follow, of)


def _follow(jobs: list[Scene]) -> Iterator[dict[str, float]]:
    for of in jobs:
        with program.path_of(of) as path:
            last = program.run("process", path, "--quiet")[-1]
        yield {"turgor": last["turgor"], **last["factors"]}


def samples(of: Scene) -> list[Scene]:
    """The scene itself, and samples of what is uncertain of it; all have its mesh."""
    parameters = uncertain(of)
    bare = with_mesh({name: block for name, block in of.items() if name != "uncertain"})
    return [bare] + [varied(bare, parameters, values.tolist()) for values in sample(parameters, SAMPLES)]


def _read(jobs: list[tuple[Scene, bool]]) -> Iterator[dict[str, Any]]:
    for each, failure in jobs:
        yield read_off(each, failure=failure)


def figures(scenes: Sequence[Scene], failure: bool = False) -> list[dict[str, Any]]:
    """What is read off the tests of scenes, solved in parallel."""
    return parallel.each(_read, [(each, failure) for each in scenes])


def band(values: Sequence[float] | np.ndarray) -> tuple[float, tuple[float, float]]:
    """The scene's own value, and the interval of the samples behind it. Error: a tenth of them have none."""
    told = interval_of(np.array(values[1:], float))
    if told["count"] < 0.9 * (len(values) - 1):
        raise Error(f"{len(values) - 1 - told['count']} of {len(values) - 1} samples have no answer")
    return float(values[0]), (told["low"], told["high"])


def experiments() -> dict[str, Callable[[], Experiment]]:
    """All of them by name, in the order of the page."""
    from . import contact, fracture, modes, moduli
    return {"calbo-nery": contact.calbo_nery, "nilsson": moduli.nilsson, "niklas": moduli.niklas,
            "section": moduli.section, "ting": moduli.ting, "alvarez": fracture.alvarez, "schoorl-holt":
            fracture.schoorl_holt, "khan-vincent": fracture.khan_vincent, "de-belie": modes.de_belie,
            "verlinden": modes.verlinden, "pitt-chen": modes.pitt_chen, "paper": modes.paper}
