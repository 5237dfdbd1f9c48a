"""Statistics of realisations: means with their intervals, how scatter falls with the number of cells, isotropy, and
what an accuracy needs. All intervals have a confidence of 95 %."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

BOTH_SIDES = 0.975  #: quantile at either end of a confidence of 95 %
LEAST, MOST = 4, 4096  #: cells that `lamella tissue` makes (make.Asked) and that a scene takes (LAM_MAX_CELLS^2)
PLANE = (0, 1, 3, 4)  #: components 11, 12, 21, 22 of row-major tensors
NOISE = 1e-9  #: relative deviation of what is prescribed, up to rounding and Newton's tolerance
TURNS = 8  #: angles over which a tensor of fourth order has its mean over all rotations exactly: more than four
Entry: TypeAlias = dict[str, Any]


def student(freedom: int) -> float:
    """Half the width of an interval over the standard error."""
    return float(special.stdtrit(freedom, BOTH_SIDES))


def mean_of(cells: int, values: ArrayLike) -> Entry:
    """Count, mean, standard deviation and their intervals (Student, chi square) of values [n] that are known; what
    takes two values is None of one."""
    v = np.asarray(values, float)
    v = v[np.isfinite(v)]
    n = len(v)
    told: Entry = {"cells": cells, "count": n, "mean": float(v.mean()) if n else None, "deviation": None,
                   "interval": None, "deviation_interval": None, "values": v.tolist()}
    if n > 1:
        deviation, half = float(v.std(ddof=1)), student(n - 1) * float(v.std(ddof=1)) / np.sqrt(n)
        told |= {"deviation": deviation, "interval": [v.mean() - half, v.mean() + half],
                 "deviation_interval": deviation_interval(deviation, n)}
    return told


def deviation_interval(deviation: float, count: int) -> list[float]:
    """Of a standard deviation of so many values with a normal distribution."""
    f = count - 1
    return [float(deviation * np.sqrt(f / special.chdtri(f, p))) for p in (1 - BOTH_SIDES, BOTH_SIDES)]


def fit(entries: Sequence[Entry]) -> Entry | None:
    """deviation = s1/sqrt(cells), s1 by the pooled variance; freedom: of s1; exponent: of the straight line through the
    logarithms, weighted with the degrees of freedom, with its interval; holds: -1/2 lies in it. None where nothing
    scatters; exponent None of a single size."""
    used = [e for e in entries if e["deviation"]]
    if not used:
        return None
    n, f, s = (np.array([e[name] for e in used], float) for name in ("cells", "count", "deviation"))
    f -= 1
    told: Entry = {"s1": float(np.sqrt((f * n * s**2).sum() / f.sum())), "freedom": int(f.sum()), "exponent": None,
                   "exponent_interval": None, "holds": None}
    if len(used) > 1:
        x, y, weight = np.log(n), np.log(s), 2 * f  # the variance of ln s is 1/(2 f) to first order
        away = x - np.average(x, weights=weight)
        spread = (weight * away**2).sum()
        slope, half = float((weight * away * y).sum() / spread), float(special.ndtri(BOTH_SIDES) / np.sqrt(spread))
        told |= {"exponent": slope, "exponent_interval": [slope - half, slope + half],
                 "holds": bool(abs(slope + 0.5) <= half)}
    return told


def bias(entries: Sequence[Entry]) -> list[Entry]:
    """Sizes whose mean differs from that of the largest one by more than both intervals, and by how much."""
    known = [e for e in entries if e["interval"]]
    return [{"cells": e["cells"], "difference": e["mean"] - known[-1]["mean"]} for e in known
            if e["interval"][1] < known[-1]["interval"][0] or known[-1]["interval"][1] < e["interval"][0]]


def quantity(name: str, unit: str, values: Mapping[int, ArrayLike]) -> Entry:
    """All that is told of a quantity whose values are given by the number of cells."""
    entries = [mean_of(cells, v) for cells, v in values.items()]
    return {"name": name, "unit": unit, "sizes": entries, "fit": fit(entries), "bias": bias(entries)}


def relative(name: str, values: Mapping[int, np.ndarray], accuracy: float, floor: float = 0.0) -> Entry:
    """Scatter of values [n, m] by the number of cells, relative to their mean: root of the sum of the variances of the
    m components over the larger one of |mean| and the floor, which of stress is the norm of `accuracy`. bias: distance
    of the mean from that of the largest size, where it is beyond their intervals, else 0. None where too few are
    known."""
    known = {cells: v[np.isfinite(v).all(1)] for cells, v in values.items()}
    means = [v.mean(0) for v in known.values() if len(v) > 1]
    entries = [_relative(cells, v, means[-1] if means else np.nan, floor) for cells, v in known.items()]
    errors = {e["cells"]: student(e["count"] - 1) * e["deviation"] / np.sqrt(e["count"]) for e in entries
              if e["deviation"] is not None}
    for e in entries:
        if e["cells"] in errors and e["bias"] <= errors[e["cells"]] + errors[max(errors)]:
            e["bias"] = 0.0
    fitted = fit(entries)
    return {"name": name, "sizes": entries, "fit": fitted, "need": needed(fitted, list(values), accuracy)}


def _relative(cells: int, v: np.ndarray, last: np.ndarray | float, floor: float) -> Entry:
    told: Entry = {"cells": cells, "count": len(v), "deviation": None, "deviation_interval": None, "bias": None}
    size = max(float(np.linalg.norm(v.mean(0))), floor) if len(v) > 1 else 0.0
    if size > 0:
        deviation = float(np.sqrt(v.var(axis=0, ddof=1).sum()) / size)
        told["deviation"] = deviation if deviation > NOISE else 0.0
        told["deviation_interval"] = deviation_interval(told["deviation"], len(v))
        told["bias"] = float(np.linalg.norm(v.mean(0) - last) / size)
    return told


def needed(fitted: Entry | None, sizes: Sequence[int], accuracy: float) -> Entry | None:
    """What the accuracy needs with a confidence of 95 %: cells of one period (at least LEAST), and of each size the
    number of realisations, whose mean is taken. None where nothing scatters."""
    if fitted is None:
        return None
    cells = (student(fitted["freedom"]) * fitted["s1"] / accuracy) ** 2
    return {"cells": max(LEAST, int(np.ceil(cells))),
            "realisations": [{"cells": n, "count": int(max(1, np.ceil(cells / n)))} for n in sizes]}


def in_plane(tangent: ArrayLike) -> np.ndarray:
    """[2, 2, 2, 2] of a tangent of 81 numbers."""
    return np.asarray(tangent, float).reshape(9, 9)[np.ix_(PLANE, PLANE)].reshape(2, 2, 2, 2)


def isotropic(A: np.ndarray) -> np.ndarray:
    """Means over all rotations in the plane of tensors [..., 2, 2, 2, 2]."""
    total = np.zeros_like(A)
    for angle in 2 * np.pi * np.arange(TURNS) / TURNS:
        c, s = np.cos(angle), np.sin(angle)
        Q = np.array([[c, -s], [s, c]])
        total += np.einsum("ia,jb,kc,ld,...abcd->...ijkl", Q, Q, Q, Q, A)
    return total / TURNS


def isotropy(cells: int, A: np.ndarray) -> Entry:
    """Of tangents [n, 2, 2, 2, 2]: A1111 - A2222; distance of the mean tangent from its mean over all rotations, over
    the norm of the latter, and the distance below which 95 % of realisations of isotropic tissue would be, by their
    scatter."""
    A = A[np.isfinite(A).all((1, 2, 3, 4))]
    told: Entry = {"cells": cells, "difference": mean_of(cells, A[:, 0, 0, 0, 0] - A[:, 1, 1, 1, 1]),
                   "distance": None, "distance_by_scatter": None}
    if len(A):
        round_part = isotropic(A)
        rest, size = (A - round_part).reshape(len(A), -1), np.linalg.norm(round_part.mean(0))
        told["distance"] = float(np.linalg.norm(rest.mean(0)) / size)
        if len(A) > 1:
            error = np.sqrt(rest.var(axis=0, ddof=1).sum() / len(A))
            told["distance_by_scatter"] = float(student(len(A) - 1) * error / size)
    return told


def young(A: np.ndarray, axis: int) -> float:
    """Young's modulus in plane strain along X1 (axis 0) or X2 (1): slope of P over F of that component, the lateral
    stretch and F12 free, F21 kept, which would turn the tissue. NaN where these are not resisted."""
    M = A.reshape(4, 4)
    i, free = (0, [1, 3]) if axis == 0 else (3, [0, 1])
    inner = M[np.ix_(free, free)]
    if not np.isfinite(M).all() or np.linalg.cond(inner) > 1e12:  # rounding
        return np.nan
    return float(M[i, i] - M[i, free] @ np.linalg.solve(inner, M[free, i]))
