"""Sobol' indices of a function of k independent inputs, with intervals: how much of its variance each of them makes.

    u = points(3, 1024)                     # where the function is wanted, uniform in the unit cube
    print(sobol(function(u), 3).total)

Method. A and B are n points each, the two halves of a scrambled Sobol' sequence in 2k dimensions; A_B^i is A with the
input i of B. With V the variance of f over A and B, and f less its mean there,
    first order  S_i = mean(f(B) (f(A_B^i) - f(A))) / V        the share that input i makes alone
    total        T_i = mean((f(A) - f(A_B^i))^2) / (2 V)       the share that is lost when input i is known last
They need n (k + 2) values of f. T_i - S_i is what input i makes together with others. Intervals of 95 % are those of
the bootstrap over rows (f(A), f(B), f(A_B^i)), which takes the points for random: those of a Sobol' sequence are spread
better, so that the intervals are rather too wide.

References. A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259, table 2 (b): first order; M. J. W. Jansen, Comput.
Phys. Commun. 117 (1999) 35: total (there table 2 (f)); A. B. Owen, J. Complexity 14 (1998) 466: scrambling.
"""
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

RESAMPLES = 1000  #: of the bootstrap: the ends of an interval of 95 % then scatter by some 5 % of it
AT_ONCE = 2**22  #: weights of resamples that are held, 32 MB
CONSTANT = 1e-10  #: deviation over the mean that is rounding: solves have ten digits
LEAST = 4  #: rows with an answer, below which nothing is told


@dataclass
class Indices:
    """first, total [k]: the indices; first_interval, total_interval [k, 2]: of 95 %; rows: those that they are from."""
    first: np.ndarray
    first_interval: np.ndarray
    total: np.ndarray
    total_interval: np.ndarray
    rows: int


def rows_for(k: int, evaluations: int) -> int:
    """The power of two n for which n (k + 2) is nearest to a number of evaluations, by their ratio."""
    return int(2 ** max(0, round(np.log2(evaluations / (k + 2)))))


def points(k: int, n: int, seed: int = 0) -> np.ndarray:
    """A, B, A_B^1 ... A_B^k: points [n (k + 2), k] in the unit cube. n: a power of two."""
    from scipy.stats import qmc
    both = qmc.Sobol(2 * k, scramble=True, seed=seed).random(n)
    A, B = both[:, :k], both[:, k:]
    return np.concatenate([A, B, *(np.where(np.arange(k) == i, B, A) for i in range(k))])


def rows_of(values: ArrayLike, k: int) -> np.ndarray:
    """Values at `points` [n (k + 2)] by rows: [n, k + 2], whose columns are of A, B, A_B^1 ..."""
    return np.asarray(values, float).reshape(k + 2, -1).T


def sobol(values: ArrayLike, k: int, seed: int = 0) -> Indices | None:
    """Indices from values at `points` [n (k + 2)]. Rows in which one is NaN are left out; None: fewer than four are
    left, or the function is constant. seed: of the bootstrap."""
    rows = rows_of(values, k)
    rows = rows[np.isfinite(rows).all(axis=1)]
    n = len(rows)
    if n < LEAST:
        return None
    mean = rows[:, :2].mean()
    if rows[:, :2].std() <= CONSTANT * abs(mean):
        return None
    rows = rows - mean
    a, b, ab = rows[:, :1], rows[:, 1:2], rows[:, 2:]
    of_rows = np.hstack([b * (ab - a), (a - ab) ** 2 / 2, (a + b) / 2, (a**2 + b**2) / 2])
    indices = _over_variance(of_rows.mean(axis=0))
    rng, step = np.random.default_rng(seed), max(1, AT_ONCE // n)
    again = [_over_variance(rng.multinomial(n, np.full(n, 1 / n), size=min(step, RESAMPLES - done)) @ of_rows / n)
             for done in range(0, RESAMPLES, step)]
    ends = np.nanquantile(np.concatenate(again), [0.025, 0.975], axis=0).T
    return Indices(indices[:k], ends[:k], indices[k:], ends[k:], n)


def _over_variance(means: np.ndarray) -> np.ndarray:
    """Indices [..., 2 k] from means over rows, the last two of which are those of f and of its square."""
    variance = means[..., -1:] - means[..., -2:-1] ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(variance > 0, means[..., :-2] / variance, np.nan)
