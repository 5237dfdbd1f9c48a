"""What speaks against a fit: data that the scenes do not repeat, points that contradict each other, values on a bound.

Method. Residuals are in standard deviations, or in shares of the largest value of a curve where the scatter is not
known. With known scatter the sum of squares has a chi-squared distribution; without, no test can say what scatter is,
and a misfit above MISS is one of the model. A point is far off if its residual, externally studentised where the
scatter is found from the others, is improbable for the largest of all (Cook & Weisberg, Residuals and influence in
regression, 1982, ch. 2). Residuals of one curve in the order of x are no scatter if neighbours are alike: von Neumann's
ratio of their mean squared difference to their mean square, 2 on the average, with the variance 4 (n - 2)/(n^2 - 1)
(Annals of Mathematical Statistics 12 (1941) 367).
"""
from typing import TYPE_CHECKING

import numpy as np

from .measured import Curve

if TYPE_CHECKING:
    from .calibration import Problem

UNLIKELY = 0.999  #: chosen: what chance exceeds once in a thousand times is not chance
MISS = 0.1  #: of the largest value of a curve, chosen: tests of tissue repeat to a few per cent
SMOOTH = 0.01  #: of the largest value, chosen: a smaller misfit is of no consequence, whatever its form
EDGE = 1e-3  #: of the way between the bounds: the search stays off a bound by less
SAME = 1e-6  #: of the range of x: rounding
FAR = 3  #: points far off that are named


def overall(problem: "Problem", residuals: np.ndarray, freedom: int, lost: int) -> str:
    """Why the whole fit is none, or nothing. lost: number of points that the scenes do not reach."""
    from scipy.stats import chi2 as squares
    if lost:
        return (f"{lost} of {problem.points} points are not reached by the best fit: give the scenes' loads more states "
                "there, or other bounds")
    chi2 = float(np.sum(residuals**2))
    expected = squares.ppf(UNLIKELY, max(freedom, 1))
    worst = _point(problem, residuals, int(np.argmax(np.abs(residuals))))
    if problem.known and chi2 > expected:
        return ("the scenes do not repeat the data within their scatter, which would have given less than "
                f"{expected:.3g}: the intervals mean nothing; the worst point is {worst}")
    if not problem.known and chi2 > freedom * MISS**2:
        return (f"the scenes miss the data by {100 * np.sqrt(chi2 / freedom):.2g} % of the largest value: the intervals "
                f"mean nothing; check units and signs of the data, loads and bounds; the worst point is {worst}")
    return ""


def details(problem: "Problem", u: np.ndarray, residuals: np.ndarray, freedom: int, misfit: str) -> list[str]:
    """Values on a bound and points that contradict each other; where the whole fits, points far off and curves of
    another form."""
    texts = _on_bounds(problem, u) + [text for e in problem.experiments if isinstance(e, Curve) for text in _twice(e)]
    return texts if misfit else texts + _far(problem, residuals, freedom) + _forms(problem, residuals)


def _on_bounds(problem: "Problem", u: np.ndarray) -> list[str]:
    return [f"{p.key}: the best value is the {'upper' if x > 0.5 else 'lower'} bound, {p.value(round(x)):.4g} {p.unit}".rstrip()
            + ": give other bounds if it may lie beyond" for p, x in zip(problem.parameters, u) if not EDGE < x < 1 - EDGE]


def _twice(curve: Curve) -> list[str]:
    """Points at one x whose y differ by more than their scatter."""
    from scipy.stats import norm
    order = np.argsort(curve.x, kind="stable")
    width = norm.ppf((1 + UNLIKELY) / 2)
    texts = []
    for i, j in zip(order, order[1:]):
        scatter = width * np.hypot(*curve.scatter[[i, j]]) if curve.known else MISS * curve.scatter[i]
        if curve.x[j] - curve.x[i] <= SAME * np.ptp(curve.x) and abs(curve.y[j] - curve.y[i]) > scatter:
            texts.append(f"{curve.point(min(i, j))}, and {curve.point(max(i, j))}: they contradict each other")
    return texts


def _far(problem: "Problem", residuals: np.ndarray, freedom: int) -> list[str]:
    """Points that are improbably far off."""
    from scipy.stats import norm, t
    rare = (1 - UNLIKELY) / 2 / len(residuals)
    if problem.known:
        far = np.abs(residuals) > norm.isf(rare)
    elif freedom > 1:
        others = np.sum(residuals**2) - residuals**2
        far = (residuals**2 * (freedom - 1) > t.isf(rare, freedom - 1) ** 2 * others) & (np.abs(residuals) > SMOOTH)
    else:
        return []
    worst = sorted(np.flatnonzero(far), key=lambda k: -abs(residuals[k]))
    more = [f"{len(worst) - FAR} more points are as far off"] if len(worst) > FAR else []
    return [f"{_point(problem, residuals, k)}: far off" for k in worst[:FAR]] + more


def _forms(problem: "Problem", residuals: np.ndarray) -> list[str]:
    """Curves whose residuals are no scatter."""
    from scipy.stats import norm
    texts, start = [], 0
    for e in problem.experiments:
        n = len(e.y)
        r, start = residuals[start:start + n], start + n
        if not isinstance(e, Curve) or n < 3 or np.mean(r**2) < (1 if e.known else SMOOTH) ** 2:
            continue
        r = r[np.argsort(e.x, kind="stable")]
        ratio = np.mean(np.diff(r) ** 2) / np.mean(r**2)
        if ratio < 2 - norm.ppf(UNLIKELY) * np.sqrt(4 * (n - 2) / (n**2 - 1)):
            texts.append(f"{e.name}: neighbouring points are off alike, which is no scatter: the model's curve has another "
                         "form, and the intervals are too narrow")
    return texts


def _point(problem: "Problem", residuals: np.ndarray, k: int) -> str:
    """Point k of the residuals, and what the scenes give there."""
    r = residuals[k]
    for e in problem.experiments:
        if k < len(e.y):
            off = f"{abs(r):.3g} standard deviations" if e.known else f"{100 * abs(r):.2g} % of the largest value"
            return f"{e.point(k)} (the model: {'+' if r > 0 else '-'}{off})"
        k -= len(e.y)
    return f"{problem.priors[k].key}: its prior (the value: {r:+.3g} standard deviations)"
