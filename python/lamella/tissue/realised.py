"""What is told of realisations: the object of `lamella rve --realisations --json` (docs/reference/realisations.md)."""
from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from . import scatter

if TYPE_CHECKING:
    from .realise import Job, Plan

VERSION = 1
Object: TypeAlias = dict[str, Any]
Solved: TypeAlias = "dict[Job, Object | str]"
STRESSES = ("P11", "P12", "P21", "P22")
MODULI = ("A1111", "A2222", "A1212", "E1", "E2")
SHARES = ("lumen_fraction", "debonded_fraction", "open_fraction", "broken_fraction")
PARTING = SHARES[1:]  #: those of cells that may part
UNITS = {name: "MPa" for name in (*STRESSES, *MODULI)}
SAME = 1e-12  #: of F: it was prescribed
NOISE = 1e-12  #: of P over the tangent: stress that is prescribed to be 0, up to rounding


def _real(value: Any) -> float:
    return np.nan if value is None else float(value)


def _reals(values: Any, count: int) -> np.ndarray:
    return np.full(count, np.nan) if values is None else np.array([_real(value) for value in values])


def numbers(state: Object) -> dict[str, float]:
    """Quantities of a state of `lamella rve --json --tangent`, NaN: not known."""
    P, F = _reals(state["P"], 9), _reals(state["F"], 9)
    A = scatter.in_plane(_reals(state.get("tangent"), 81))
    P[np.abs(P) < NOISE * np.linalg.norm(A)] = 0
    told = {f"F{n}": F[k] for n, k in zip((11, 12, 21, 22), scatter.PLANE)}
    told |= {f"P{n}": P[k] for n, k in zip((11, 12, 21, 22), scatter.PLANE)}
    told |= {"A1111": A[0, 0, 0, 0], "A2222": A[1, 1, 1, 1], "A1212": A[0, 1, 0, 1], "E1": scatter.young(A, 0),
             "E2": scatter.young(A, 1)}
    return told | {name: _real(state.get(name)) for name in SHARES}


class States:
    """A state of all realisations, by the number of cells; those that converged."""

    def __init__(self, number: int, states: dict[int, list[Object]], parting: bool) -> None:
        self.number = number
        rows = {cells: [numbers(state) for state in of] for cells, of in states.items()}
        self.tangents = {cells: np.array([scatter.in_plane(_reals(state.get("tangent"), 81)) for state in of])
                         .reshape(-1, 2, 2, 2, 2) for cells, of in states.items()}
        names = [f"F{n}" for n in (11, 12, 21, 22)] + [*STRESSES, *MODULI, *SHARES]
        self.values = {name: {cells: np.array([row[name] for row in of]) for cells, of in rows.items()}
                       for name in names if parting or name not in PARTING}

    def _told_of(self, name: str) -> bool:
        """Left out are what is never known, and F where it is prescribed."""
        everything = np.concatenate(list(self.values[name].values()))
        everything = everything[np.isfinite(everything)]
        return len(everything) > 0 and (name[0] != "F" or float(np.ptp(everything)) > SAME)

    def quantities(self, names: Sequence[str] | None = None) -> list[Object]:
        """Statistics of each quantity, or of these."""
        return [scatter.quantity(name, UNITS.get(name, "1"), self.values[name]) for name in names or self.values
                if self._told_of(name)]

    @property
    def stress(self) -> dict[int, np.ndarray]:
        """P [n, 4] by the number of cells."""
        return {cells: np.column_stack([self.values[name][cells] for name in STRESSES])
                for cells in self.values["P11"]}

    def stiffness(self) -> float:
        """Norm of the mean tangent of all tissues in the plane; 0: none is known."""
        A = np.concatenate(list(self.tangents.values()))
        A = A[np.isfinite(A).all((1, 2, 3, 4))]
        return float(np.linalg.norm(A.mean(0))) if len(A) else 0.0


def _failed(solved: Solved, count: int) -> list[Object]:
    """Realisations, or states of them (0: at rest), without an answer, and why."""
    failed: list[Object] = []
    for job, told in solved.items():
        which: Object = {"cells": job.cells, "realisation": job.number, "seed": job.seed}
        if isinstance(told, str):
            failed.append(which | {"state": None, "reason": told})
            continue
        states = {0: told["rest"]} | {state["state"]: state for state in told["states"]}
        for number in range(count + 1):
            state = states.get(number)
            if state is None:
                failed.append(which | {"state": number, "reason": "the load ended before it"})
            elif state["status"] != "converged":
                failed.append(which | {"state": number, "reason": f"{state['status']}: {state.get('reason') or ''}"})
    return failed


def _states(solved: Solved, sizes: list[int], number: int, parting: bool) -> States:
    found: dict[int, list[Object]] = {cells: [] for cells in sizes}
    for job, told in solved.items():
        if isinstance(told, str):
            continue
        of = [told["rest"]] if number == 0 else [state for state in told["states"] if state["state"] == number]
        found[job.cells] += [state for state in of if state["status"] == "converged"]
    return States(number, found, parting)


def _failure(solved: Solved, sizes: list[int]) -> Object:
    """Load factors of the first criterion, how tissues fail, and the peaks of their curves."""
    known = [(job.cells, told) for job, told in solved.items() if not isinstance(told, str) and "failure" in told]

    def of(member: str, cells: int) -> list[Object]:
        return [told[member] for n, told in known if n == cells and member in told]

    def peaks(name: str) -> dict[int, Any]:
        return {cells: [test["peak"][name] for test in of("test", cells)] for cells in sizes}
    factors = {cells: [_real(f["factor"]) for f in of("failure", cells)] for cells in sizes}
    modes = [{"cells": cells, "modes": dict(Counter(f["mode"] + (f" ({f['criterion']})" if f["criterion"] else "")
                                                    for f in of("failure", cells)))} for cells in sizes]
    passed = [{"cells": cells, "passed": sum(test["peak_passed"] for test in of("test", cells)),
               "count": len(of("test", cells))} for cells in sizes]
    quantities = [scatter.quantity("load_factor", "1", factors)]
    if any(entry["count"] for entry in passed):
        quantities += [scatter.quantity("peak_stress", "MPa", peaks("stress")),
                       scatter.quantity("peak_strain", "1", peaks("strain"))]
    return {"modes": modes, "peaks": passed, "quantities": quantities}


def _need(states: list[Object], accuracy: float) -> Object | None:
    """That of the state that needs most cells."""
    needs: list[Object] = [{"accuracy": accuracy, "confidence": 0.95, "state": entry["state"],
                            **entry["stress"]["need"], "holds": entry["stress"]["fit"]["holds"]}
                           for entry in states if entry["stress"]["need"]]
    return max(needs, key=lambda need: int(need["cells"])) if needs else None


def summary(path: str, plan: "Plan", solved: Solved, count: int) -> Object:
    """The object. path: of the scene; count: states of its load."""
    sizes = sorted({job.cells for job in solved})
    parting = (plan.scene["rve"].get("interface") or {}).get("law", "bonded") != "bonded"
    rest, accuracy = _states(solved, sizes, 0, parting), float(plan.scene.get("accuracy", 0.01))
    floor = 0.01 * rest.stiffness()  # of the norm of `accuracy`: the stress of a strain of 1 %
    states = []
    for number in range(1, count + 1):
        s = _states(solved, sizes, number, parting)
        states.append({"state": number, "stress": scatter.relative("stress", s.stress, accuracy, floor),
                       "quantities": s.quantities()})
    moduli = [scatter.relative(name, {n: v[:, None] for n, v in rest.values[name].items()}, accuracy)
              for name in MODULI]
    asked = dataclasses.asdict(plan.asked)
    for name in ("cells", "seed"):
        asked.pop(name)
    told = {"lamella_realisations": VERSION, "scene": path, "asked": asked, "mesh": plan.scene["rve"]["mesh"],
            "sizes": [{"cells": n, "made": sum(job.cells == n for job in solved)} for n in sizes],
            "rest": {"stiffness": 100 * floor, "quantities": rest.quantities(MODULI), "moduli": moduli,
                     "isotropy": [scatter.isotropy(n, rest.tangents[n]) for n in sizes]},
            "states": states, "need": _need(states, accuracy), "failed": _failed(solved, count)}
    return told | ({"failure": _failure(solved, sizes)} if plan.failure else {})
