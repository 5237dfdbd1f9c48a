"""What it takes to tear tissue: work, toughness, direction."""
import copy
import math
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from .. import parallel, program, scene_dict
from ..calibration import Figures, Parameter, calibrate
from ..measured import read_off
from ..parameters import varied
from . import SAMPLES, TISSUES, Experiment, Mode, Row, Scene, band, changed, figures, followed, pulled, samples, scene


def alvarez() -> Experiment:
    days = 28
    of = scene_dict(str(TISSUES / "apple.yaml"))
    of["process"]["duration"] = f"{days} day"
    of["process"]["surroundings"] = [entry for entry in of["process"]["surroundings"]
                                     if float(entry["time"].split()[0]) <= days and entry["temperature"] == "2 degC"]
    drawn = samples(of)
    after = followed(drawn)
    rest = [{"version": 1, "rve": each["rve"] | {"turgor": each["rve"]["turgor"] | {"mode": "sealed"}},
             "load": pulled(1.01)} for each in drawn]
    fresh = np.array([t.get("modulus", math.nan) * 1e-6 for t in figures(rest)])
    stored = np.array([t.get("modulus", math.nan) * 1e-6 for t in figures(
        [changed(each, a["turgor"], a["walls"]) for each, a in zip(rest, after)])])
    lamella = np.array([a["lamella"] for a in after])
    return Experiment(
        "alvarez", "Apple: toughness and energy of fracture, fresh and stored",
        "Alvarez, Saunders & Vincent (2000)",
        "Toughness K (the stress around a crack at which it grows) of 10 to 50 kPa√m, energy of fracture R (per area "
        "of the crack) of 40 to 400 J/m²; in four weeks of storage K falls by about 50 %, the energy of cutting by "
        "about 30 %. K²/R is the modulus of the tissue, if it is elastic: 2.5 MPa of the least, 6.25 MPa of the "
        "largest values. Allowed of the falls: a quarter.",
        f"Nothing. Stored: the apple of [the six tissues](tissues.md) after {days} days at 2 °C. What a crack spends "
        "is proportional to what the lamella spends, and K is the root of modulus times energy.",
        "The modulus agrees, and so does the loss of energy, with a wide interval: rates in storage are estimates. "
        "Toughness falls more than the scene itself says, which leaves the tissue nearly as stiff as it was; only the "
        "fastest rates of the interval reach what was measured.",
        [Row("K²/R, the modulus", "MPa", 2.5, 6.25, *band(fresh)),
         Row("energy of fracture after four weeks, over fresh", "", 0.7 - 0.075, 0.7 + 0.075, *band(lamella)),
         Row("toughness after four weeks, over fresh", "", 0.5 - 0.125, 0.5 + 0.125,
             *band(np.sqrt(stored / fresh * lamella)))])


STRAIN, LENGTH = 0.05, 20.0  #: of the loops, chosen; mm, of the sample, chosen
MIDDLE = 45.0  #: mm/min, between 20 and 100


def _loop(speed: float) -> Scene:
    """The loop at a speed of the machine, mm/min."""
    of = copy.deepcopy(scene("apple-cycle"))
    for entry in of["load"][1:]:
        entry["for"] = f"{STRAIN * LENGTH / (speed / 60)} s"
    return of


def schoorl_holt() -> Experiment:
    wanted = ((20.0, 0.13), (100.0, 0.4))
    fit = calibrate([Parameter("rve.wall.relaxation.0.share", 0.05, 0.95),
                     Parameter("rve.wall.relaxation.0.time", "0.001 s", "100 s")],
                    [Figures(_loop(speed), {"hysteresis": (h, 0.03)}) for speed, h in wanted], starts=2, processes=None)
    between, *fitted = (read_off(fit.scene(_loop(v)))["hysteresis"] for v in (MIDDLE, 20.0, 100.0))
    drawn = np.random.default_rng(0).multivariate_normal(fit.u, fit.covariance, SAMPLES).clip(0, 1)
    of = [varied(_loop(MIDDLE), fit.parameters, [p.value(x) for p, x in zip(fit.parameters, u)]) for u in drawn]
    spread = band([between, *(f.get("hysteresis", math.nan) for f in figures(of))])[1]
    rows = [Row(f"hysteresis at {speed:g} mm/min", "", h - 0.03, h + 0.03, found, fitted=True)
            for (speed, h), found in zip(wanted, fitted)]
    rows.append(Row("apparent work of fracture, of a real one of 200 J/m²", "J/m²", 258, 300, 200 / (1 - between),
                    (200 / (1 - spread[0]), 200 / (1 - spread[1]))))
    share, time = fit.values
    (low, high), (short, long) = fit.intervals
    return Experiment(
        "schoorl-holt", "Apple: hysteresis and work of fracture in tension", "Schoorl & Holt, J. Texture Stud. (1983)",
        "Apparent work of fracture of 258 to 300 J/m², 200 J/m² without what a loop of loading loses; hysteresis of "
        "0.13 to 0.4 at 20 to 100 mm/min, read as 0.13 at the least speed and 0.4 at the largest, each ± 0.03.",
        f"Fitted to the two hystereses: walls that relax by a share of {share:.2f} (95 %: {low:.2f} to {high:.2f}) in "
        f"{time:.2g} s ({short:.2g} to {long:.2g} s). Chosen: samples of 20 mm, loops of 5 %, pressure that stays. "
        "Predicted: apparent work as the real one over 1 less the hysteresis, at 45 mm/min, in the middle.",
        "Work and hysteresis fit together. With cells that keep all their water a loop would lose 15 % at most "
        "(measured once), as turgor, which is elastic, bears most of a small strain: water has to find a way, or "
        "walls beside those of "
        "the section.", rows)


def _tissue(folder: str, seed: int, direction: int, thickness: str) -> Path:
    """Cells 1.5 times as long as wide, their length turned by so many degrees from X1."""
    path = Path(folder) / f"{seed}-{direction}.json"
    program.run("tissue", "-o", path, "--cells", 12, "--size", "150 um", "--variation", 0.3, "--elongation", 1.5,
                "--direction", f"{direction} deg", "--wall-thickness", thickness, "--seed", seed)
    return path


def _torn(jobs: list[tuple[int, int]]) -> Iterator[tuple[float, float]]:
    """Energy and stiffness of layers torn along X1."""
    with tempfile.TemporaryDirectory() as folder:
        for seed, direction in jobs:
            of = scene("apple-layer")
            of["rve"]["tissue"] = str(_tissue(folder, seed, direction, "12 um"))
            with program.path_of(of) as path:
                curve = program.run("tear", path, "--modes", "opening", "--quiet").objects[-1]["curve"]
            yield curve["energy"], curve["stiffness"]


def _crushed(jobs: list[tuple[int, int]]) -> Iterator[dict[str, Any]]:
    """How tissue that is compressed along X1 loses its stability: strain, and how far the normal of the band that forms
    is from the load, degrees; None: it does not."""
    from .. import RVE
    with tempfile.TemporaryDirectory() as folder:
        for seed, direction in jobs:
            of = scene("apple-crushed")
            of["rve"]["tissue"] = str(_tissue(folder, seed, direction, "3 um"))
            r = RVE(of).solve()
            lost = [k for k in range(len(r)) if r.converged[k] and not r.ellipticity[k] > 0]
            n = r.localisation_normal[lost[0]] if lost else None
            yield {"strain": 1 - r.F[lost[0], 0, 0] / r.F[0, 0, 0] if lost else None,
                   "angle": None if n is None else math.degrees(math.atan2(abs(n[1]), abs(n[0])))}


TORN, CRUSHED = (1, 2, 3), (1, 2, 3, 4, 5, 6)  #: tissues, by their seeds; docs/results/tearing.md has ten torn ones
UPRIGHT = 20  #: degrees, chosen: a band whose normal is no farther from the load is a layer across it


def khan_vincent() -> Experiment:
    from scipy.stats import t
    torn = parallel.each(_torn, [(seed, direction) for seed in TORN for direction in (0, 90)])
    K = np.sqrt(np.reshape(torn, (len(TORN), 2, 2)).prod(axis=2))  # the crack runs along the cells first
    ratio = np.log(K[:, 1] / K[:, 0])
    mean = float(ratio.mean())
    error = float(ratio.std(ddof=1) / math.sqrt(len(TORN)) * t.ppf(0.975, len(TORN) - 1))
    crushed = parallel.each(_crushed, [(seed, direction) for seed in CRUSHED for direction in (0, 90)])
    layers = [sum(c["strain"] is not None and c["angle"] < UPRIGHT for c in of) for of in (crushed[::2], crushed[1::2])]
    words = ["a layer of cells collapses" if 2 * n > len(CRUSHED) else "no layer collapses" for n in layers]
    return Experiment(
        "khan-vincent", "Apple: direction", "Khan & Vincent, J. Texture Stud. (1993)",
        "Toughness in the tangential direction is 1.5 times the radial one (allowed: 10 %); radial compression "
        "collapses one layer of cells, tangential compression shears the tissue. Cells are longer along the radius.",
        "Nothing. Irregular tissue of cells 1.5 times as long as wide, torn between cells along and across their "
        f"length ({len(TORN)} tissues; [ten of them](tearing.md#elongated-cells) give 1.42, 1.19 to 1.70), and "
        f"compressed by half along and across it ({len(CRUSHED)} tissues, turgor 0.1 MPa).",
        "Elongation makes the tissue stiffer along the cells, and by that tougher across them; the energy hardly "
        f"differs. Compressed along their length cells fold in a layer across the load in {layers[0]} of "
        f"{len(CRUSHED)} tissues, across it in {layers[1]}; a shear failure across it is one of walls or lamella, "
        "which were not given strengths.",
        [Row("toughness K across the cells over that along them", "", 1.35, 1.65, math.exp(mean),
             (math.exp(mean - error), math.exp(mean + error)))],
        [Mode("compressed along the radius", "a layer of cells collapses", words[0]),
         Mode("compressed across the radius", "no layer collapses", words[1])])
