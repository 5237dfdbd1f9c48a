"""Tissue that is made by its statistics: a relaxed Laguerre tessellation (tessellation.py), in the space where the
elongated cells are round, without short edges (merge.py) and with air (spaces.py)."""
from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from scipy.optimize import brentq
from scipy.special import ndtri

from .. import InputError
from . import geometry, spaces
from .file import Tissue
from .merge import Failed, without_short_edges
from .tessellation import Tessellation, reduced, relax, spread, wrap

TRIES = 8  #: of sites at random
CLOSE = 0.015  #: error of the mean second moments for which no other sites are tried
AT_JUNCTIONS = 0.8  #: of the air that junctions could have, where cells are missing, too: room for the rest
SETTLE = 8  #: steps of Lloyd's method after missing cells have got their areas
ALMOST = 0.48  #: of a cell's perimeter may border spaces before short edges are merged, which changes faces a little
SPACE = 1.4  #: area of a missing cell over the mean of the others: at 1 a gas of 0.3 has too many of them to be found
ROUNDS = 12  #: of choosing: the areas of those chosen change their neighbours' faces


@dataclass(frozen=True)
class Asked:
    """What the tissue is to be. Lengths are in `unit`: size: diameter of a circle of the cells' mean area; variation:
    standard deviation of the area over its mean; elongation: ratio of axes; direction: of the long one, degrees from
    X1; aspect: width over height of the period; gas: air over the volume of the tissue."""
    cells: int
    size: float
    unit: str = "um"
    variation: float = 0.0
    elongation: float = 1.0
    direction: float = 0.0
    aspect: float = 1.0
    wall_thickness: float | None = None
    gas: float = 0.0
    seed: int = 0

    def check(self) -> None:
        """InputError: a number is not within its limits."""
        for name, low, high in (("cells", 4, 20000), ("variation", 0, 0.5), ("elongation", 1, 3), ("aspect", 0.1, 10),
                                ("gas", 0, 0.3), ("seed", 0, 2**32 - 1)):
            value = getattr(self, name)
            if not low <= value <= high:
                raise InputError(f"--{name} {value:g}: {low:g} to {high:g} is wanted")
        if not 0 < self.size < np.inf:
            raise InputError(f"--size {self.size:g} {self.unit}: it must be positive")
        if not abs(self.direction) <= 360:
            raise InputError(f"--direction: {self.direction:g} degrees: -360 to 360 are wanted")
        if self.wall_thickness is not None and not 0 < self.wall_thickness < 0.5 * self.size:
            raise InputError(f"--wall-thickness {self.wall_thickness:g} {self.unit}: more than nothing and less than "
                             "half of the size is wanted")

    @property
    def area(self) -> float:
        """Mean area of a cell."""
        return np.pi * self.size**2 / 4

    @property
    def stretch(self) -> np.ndarray:
        """From the space where cells are round, row vectors times it [2, 2]; it keeps areas."""
        c, s = np.cos(np.radians(self.direction)), np.sin(np.radians(self.direction))
        turn = np.array([[c, s], [-s, c]])
        return turn.T @ np.diag([self.elongation**0.5, self.elongation**-0.5]) @ turn


def areas(count: int, variation: float) -> np.ndarray:
    """Areas [count] of mean 1 and this coefficient of variation: quantiles of a log-normal distribution in equal steps,
    whose width gives the coefficient exactly."""
    quantiles = ndtri((np.arange(count) + 0.5) / count)

    def of(width: float) -> np.ndarray:
        values = np.exp(width * quantiles)
        return values / values.mean()
    if variation == 0:
        return np.ones(count)
    return of(brentq(lambda width: of(width).std() - variation, 0, 5, xtol=1e-14))


@dataclass
class _Plan:
    """Numbers of cells and of missing ones, and the share of the volume that these have."""
    cells: int
    missing: int = 0
    share: float = 0.0

    @property
    def areas_missing(self) -> np.ndarray:
        """Over the mean area of the cells [missing]."""
        return np.full(self.missing, self.cells * self.share / (1 - self.share) / max(self.missing, 1))


_Base: TypeAlias = tuple[Tissue, np.ndarray, np.ndarray]  # all cells, their areas over the mean, which shall be missing


def _tissue(t: Tessellation, asked: Asked, period: np.ndarray) -> Tissue:
    """The tessellation's cells in the unit of the tissue."""
    vertices, cells = t.polygons()
    scale = np.sqrt(asked.area)
    return Tissue(asked.unit, scale * period, scale * vertices @ asked.stretch, cells, asked.wall_thickness)


def _relaxed(asked: Asked, plan: _Plan, rng: np.random.Generator) -> _Base:
    """All cells, their areas over the mean, and which are to be missing (booleans). Failed: too few can be."""
    ranks = areas(plan.cells, asked.variation)
    wanted = rng.permutation(np.concatenate([ranks, plan.areas_missing]))
    period = np.sqrt(wanted.sum()) * np.diag([asked.aspect**0.5, asked.aspect**-0.5])
    round_period = reduced(period @ np.linalg.inv(asked.stretch))
    t = relax(spread(len(wanted), round_period, rng), wanted, round_period)
    missing = np.zeros(len(wanted), bool)
    if not plan.missing:
        return _tissue(t, asked, period), wanted, missing
    for k in range(ROUNDS):
        missing = spaces.choose(_tissue(t, asked, period), plan.missing, missing, rng.permutation(len(wanted)))
        wanted[missing], wanted[~missing] = plan.areas_missing, _ranked(t.area[~missing], ranks)
        t = relax(wrap(t.centroid, round_period), wanted, round_period, 0 if k else SETTLE)
        if spaces.Contacts(_tissue(t, asked, period)).hold(missing, ALMOST):
            return _tissue(t, asked, period), wanted, missing
    raise Failed("cells at spaces have too few neighbours")


def _ranked(values: np.ndarray, sorted_areas: np.ndarray) -> np.ndarray:
    """The areas in the order of these values, so that cells change little."""
    result = np.empty(len(values))
    result[np.argsort(values, kind="stable")] = sorted_areas
    return result


def _misfit(tissue: Tissue, missing: np.ndarray, asked: Asked) -> float:
    """How far the cells' mean second moments are from those asked for: 0.01 is about 1 % of the elongation."""
    area, _, second = geometry.moments(tissue)
    mean = (second / area[:, None, None] ** 2)[~missing].mean(0)
    back = np.linalg.inv(asked.stretch)
    tensor = back @ mean @ back
    values = np.linalg.eigvalsh(tensor)
    return float(np.sqrt(values[1] / values[0]) - 1)


def _finished(base: _Base, asked: Asked) -> tuple[Tissue, int]:
    """Without short edges and missing cells; number of merged edges. Failed: it cannot be had."""
    tissue, wanted, missing = base
    tissue, merged = without_short_edges(tissue, wanted * asked.area, asked.wall_thickness or 0.0)
    try:
        if missing.any() and not spaces.Contacts(tissue).hold(missing):
            raise Failed("cells at spaces have lost too many neighbours")
        tissue = spaces.without(tissue, missing)
        tissue.check()
    except InputError as error:
        raise Failed(str(error)) from None
    return tissue, merged


def _bases(asked: Asked, plan: _Plan, why: list[str]) -> Iterator[_Base]:
    """Tessellations of other sites: those that are CLOSE as they are found, then the others, the nearest one first."""
    far = []
    for attempt in range(TRIES):
        try:
            base = _relaxed(asked, plan, np.random.default_rng([asked.seed, plan.missing, attempt]))
        except Failed as error:
            why.append(str(error))
            continue
        misfit = _misfit(base[0], base[2], asked)
        if misfit < CLOSE:
            yield base
        else:
            far.append((misfit, attempt, base))
    yield from (base for _, _, base in sorted(far, key=lambda entry: entry[:2]))


def _best(asked: Asked, plan: _Plan) -> tuple[Tissue, int]:
    """Of several tessellations that whose mean second moments are nearest to those asked for, finished."""
    why: list[str] = []
    for base in _bases(asked, plan, why):
        try:
            return _finished(base, asked)
        except Failed as error:
            why.append(str(error))
    raise InputError(f"no tissue of {asked.cells} cells found in {TRIES} trials: {why[-1]}; take thinner walls, less "
                     "gas, less variation or more cells")


def make(asked: Asked) -> Tissue:
    """The tissue; its made_by tells what was asked and what it is. InputError: it cannot be had."""
    asked.check()
    plan = _Plan(asked.cells)
    for _ in range(6):
        tissue, merged = _best(asked, plan)
        assert tissue.period is not None
        whole = np.linalg.det(tissue.period)
        junctions, rest = spaces.Junctions(tissue), asked.gas - plan.share
        room = junctions.air(junctions.largest) / whole
        if rest <= room:
            tissue = junctions.filled(rest * whole)
            return dataclasses.replace(tissue, made_by=_told(tissue, asked, plan, merged))
        plan = _planned(asked, plan, room)
    raise InputError(f"--gas {asked.gas:g}: not met with {asked.cells} cells: take more cells, or less gas")


def _planned(asked: Asked, before: _Plan, room: float) -> _Plan:
    """More missing cells than before, where junctions have room for this share of air. Spaces are no smaller than half
    a cell where junctions can have less."""
    share = asked.gas - AT_JUNCTIONS * room
    share = max(share, min(0.5 / asked.cells, 0.95 * asked.gas))
    count = max(1, round(asked.cells * share / (1 - share) / SPACE), before.missing)
    return _Plan(asked.cells, count, share)


def _told(tissue: Tissue, asked: Asked, plan: _Plan, merged: int) -> dict[str, Any]:
    radii, got = tissue.radii(), tissue.statistics()
    got |= {"cells_missing": plan.missing, "edges_merged": merged, "corner_radius": float(radii.max()),
            "corners_limited": float((radii < radii.max()).mean())}
    return {"program": "lamella tissue", "asked": dataclasses.asdict(asked), "got": got}
