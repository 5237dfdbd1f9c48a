"""Parameters of scenes from what was measured: least squares with bounds and priors, intervals, what data do not tell.

    fit = calibrate({"rve.wall.C1": ("0.02 MPa", "0.5 MPa")}, [Curve("tension.yaml", "tension.csv", scatter=0.03)])
    print(fit)

Method. Residuals are (model - data)/scatter of all points, and (parameter - mean)/deviation of those with a prior. The
search is in the logarithm of parameters whose bounds are above 0, else in the parameter, scaled to 0 ... 1 between the
bounds: a trust-region Gauss-Newton method with bounds (Branch, Coleman & Li, SIAM J. Sci. Comput. 21 (1999) 1; SciPy's
least_squares), from several starts of a Sobol' sequence, the first in the middle. Derivatives are forward differences
of solves, whose error is 1e-9. With the Jacobian J at the best fit the covariance is (J^T J)^-1, times the mean square
of the residuals where the scatter is not known; intervals are Student's. A direction of the parameters in which the
residuals hardly change is one that the data do not tell. The profile of a parameter is the least sum of squares at
given values of it: its interval has the values where that is less than the least by the square of Student's quantile,
times the variance (Bates & Watts, Nonlinear regression analysis and its applications, 1988, ch. 6), with no straight
line in place of the model.
"""
import json
import math
import sys
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from . import InputError, misfit, parallel, scene_dict
from ._files import inputs_of, make_folder, may_write, with_member, write_whole
from ._served import UNSOLVED, end_with_program, progress as shown, served
from .measured import Curve, Experiment, Figures, experiment
from .parameters import Parameter, Range, uncertain, varied
from .program import SceneLike

__all__ = ["Curve", "Figures", "Parameter", "Fit", "calibrate"]
STEP = 1e-5  #: of the scaled parameters, for forward differences: solves have ten digits, so that derivatives have five
LOST = 1e3  #: residual of each point of a curve that the model has not
BLIND = 0.25  #: of the way between the bounds, chosen: a direction whose 95 % interval is as large is not told
PROFILE = 17  #: values of a parameter in its profile, the bounds included


class Problem:
    """Residuals of experiments over the scaled parameters u [n]."""

    def __init__(self, parameters: list[Parameter], experiments: Sequence[Experiment]) -> None:
        self.parameters, self.experiments = parameters, list(experiments)
        self.priors = [p for p in parameters if p.prior is not None]
        self.known = all(e.known for e in experiments)
        if not self.known and any(e.known for e in experiments):
            unknown = next(e.name for e in experiments if not e.known)
            raise InputError(f"{unknown}: has no scatter, and others have one: give that of all, or of none (a third "
                             "column scatter of a curve)")
        self.points = sum(len(e.y) for e in experiments) + len(self.priors)
        self._last: list[np.ndarray] = [np.full(len(parameters), np.nan), np.empty(0)]

    def scene(self, of: Experiment, u: np.ndarray) -> dict[str, Any]:
        """The scene of an experiment; a parameter is put into those that it is of."""
        own = [(p, p.value(x)) for p, x in zip(self.parameters, u) if of.keys is None or p.key in of.keys]
        return varied(of.scene, [p for p, _ in own], [value for _, value in own])

    def check(self) -> None:
        """Chooses the meshes. InputError unless all experiments can be had in the middle of the bounds."""
        for e in self.experiments:
            middle = np.full(len(self.parameters), 0.5)
            e.settle(self.scene(e, middle))
            e.check(self.scene(e, middle))

    def residuals(self, u: np.ndarray) -> np.ndarray:
        if not np.array_equal(u, self._last[0]):  # the solver asks for these and the derivatives at the same place
            self._last = [u.copy(), self._compare(u)]
        return self._last[1]

    def _compare(self, u: np.ndarray) -> np.ndarray:
        parts = [(self._model(e, u) - e.y) / e.scatter for e in self.experiments]
        parts.append(np.array([p.misfit(p.value(x)) for p, x in zip(self.parameters, u) if p in self.priors]))
        return np.nan_to_num(np.concatenate(parts), nan=LOST)

    def _model(self, of: Experiment, u: np.ndarray) -> np.ndarray:
        """NaN where it does not reach, and where these parameters make no scene."""
        try:
            return of.model(self.scene(of, u))
        except InputError:
            return np.full(len(of.y), np.nan)

    def jacobian(self, u: np.ndarray, free: Sequence[int] | None = None) -> np.ndarray:
        here, columns = self.residuals(u), []
        for k in range(len(u)) if free is None else free:
            step = STEP if u[k] + STEP <= 1 else -STEP
            columns.append((self._compare(u + step * np.eye(len(u))[k]) - here) / step)
        return np.stack(columns, axis=1)

    def least(self, u: np.ndarray, fixed: int | None = None) -> tuple[np.ndarray, float]:
        """The place of the least sum of squares, from a start, and that sum; fixed: a parameter that stays."""
        from scipy.optimize import least_squares
        free = [k for k in range(len(u)) if k != fixed]
        if not free:
            return u, float(np.sum(self.residuals(u) ** 2))

        def whole(v: np.ndarray) -> np.ndarray:
            return np.insert(v, fixed, u[fixed]) if fixed is not None else v
        found = least_squares(lambda v: self.residuals(whole(v)), np.clip(u[free], 0.01, 0.99),
                              lambda v: self.jacobian(whole(v), free), (0, 1), x_scale=1.0, xtol=1e-8, ftol=1e-8)
        return whole(found.x), 2 * found.cost


def _starts(jobs: list[tuple[Problem, np.ndarray]]) -> Iterator[tuple[np.ndarray, float]]:
    for problem, u in jobs:
        yield problem.least(u)


def _profiles(jobs: list[tuple[Problem, np.ndarray, int]]) -> Iterator[list[tuple[float, float]]]:
    """Of each job, a parameter: scaled values and the least sums of squares, from the best fit to both sides."""
    for problem, best, k in jobs:
        grid = np.linspace(0, 1, PROFILE)
        points = [(float(best[k]), float(np.sum(problem.residuals(best) ** 2)))]
        for side in grid[grid < best[k]][::-1], grid[grid > best[k]]:
            u = best
            for x in side:
                u, cost = problem.least(np.where(np.arange(len(u)) == k, x, u), k)
                points.append((float(x), cost))
        yield sorted(points)


class Fit:
    """What was found: `values` and 95 % `intervals` [n, 2] in the units of the bounds, `covariance` and `correlation`
    of the scaled parameters, `chi2` (the sum of squares) with `freedom`, `starts`: the sum of squares that each start
    has ended with, `untold`: directions of the parameters that are not identifiable from the data, as texts; `misfit`:
    a text where the scenes do not repeat the data, or do not reach some of them; `doubts`: texts on values at a bound,
    points that contradict each other or are far off, and curves of another form; `profiles`, by `profile`: of each
    parameter values and sums of squares, and `profiled`, the intervals that these give, NaN at an end where the data
    give no bound."""

    def __init__(self, problem: Problem, u: np.ndarray, chi2: float, starts: list[float]) -> None:
        from scipy.stats import t
        self.problem, self.parameters, self.known = problem, problem.parameters, problem.known
        self.u, self.chi2, self.starts = u, chi2, starts
        self.freedom = problem.points - len(u)
        if self.freedom < 1 and not self.known:
            raise InputError(f"{problem.points} points do not give {len(u)} parameters and their scatter: give the "
                             "scatter")
        self.variance = 1.0 if self.known else chi2 / self.freedom
        size, direction = np.linalg.svd(problem.jacobian(u), full_matrices=True)[1:]
        size = np.pad(size, (0, len(u) - len(size)))  # fewer points than parameters
        with np.errstate(divide="ignore"):
            spread = np.sqrt(self.variance) / size
        self.width = 1.96 if self.known else float(t.ppf(0.975, self.freedom))
        finite = np.minimum(spread, 1e6)  # of directions that nothing tells
        self.covariance = direction.T @ np.diag(finite**2) @ direction
        deviation = np.sqrt(np.diag(self.covariance))
        safe = np.where(deviation > 0, deviation, 1.0)  # 0: the data are repeated exactly
        self.correlation = self.covariance / np.outer(safe, safe)
        self.values = np.array([p.value(x) for p, x in zip(self.parameters, u)])
        self.intervals = np.array([[p.value(np.clip(x + s * self.width * d, 0, 1)) for s in (-1, 1)]
                                   for p, x, d in zip(self.parameters, u, deviation)])
        self.untold = [self._words(v) for v, s in zip(direction, spread) if self.width * s > BLIND]
        residuals = problem.residuals(u)
        self.misfit = misfit.overall(problem, residuals, self.freedom, int(np.sum(np.abs(residuals) >= LOST)))
        self.doubts = misfit.details(problem, u, residuals, self.freedom, self.misfit)
        self.profiles: list[np.ndarray] = []
        self.profiled = np.full((len(u), 2), np.nan)

    def _words(self, v: np.ndarray) -> str:
        """A direction as a product of powers, or a sum."""
        v = v / v[np.argmax(np.abs(v))]
        parts = [(p, c) for p, c in zip(self.parameters, v) if abs(c) > 0.1]
        if len(parts) == 1:
            return f"{parts[0][0].key}: the data hardly tell it"
        return (", ".join(f"{p.key} {'up' if c > 0 else 'down'}" for p, c in parts) +
                " together: the data hardly tell them apart")

    def profile(self, processes: int | None = None,
                progress: Callable[[int, int], None] = lambda done, total: None) -> None:
        """Finds `profiles` and `profiled`: some 17 fits of the other parameters for each. progress(done, total)."""
        jobs = [(self.problem, self.u, k) for k in range(len(self.u))]
        limit = self.chi2 + self.width**2 * self.variance
        for k, points in enumerate(parallel.each(_profiles, jobs, processes, progress)):
            u, cost = np.array(points).T
            if cost.min() < self.chi2 - 1e-3 * self.variance:
                self.untold.append(f"{self.parameters[k].key}: its profile has a smaller sum of squares, "
                                   f"{cost.min():.4g}: the fit is not the best one; give more starts")
            self.profiles.append(np.array([[self.parameters[k].value(x) for x in u], cost]))
            best = int(np.argmin(cost))
            for side, order in enumerate((range(best, 0, -1), range(best, len(u) - 1))):
                for i in order:
                    j = i + (1 if side else -1)
                    if cost[j] > limit:  # straight in the root, as a parabola is
                        at, to, there = (math.sqrt(max(c - cost[best], 0)) for c in (cost[i], limit, cost[j]))
                        share = (to - at) / (there - at)
                        self.profiled[k, side] = self.parameters[k].value(u[i] + max(share, 0.0) * (u[j] - u[i]))
                        break

    def scene(self, scene: SceneLike) -> dict[str, Any]:
        """A scene with the values that were found."""
        return varied(scene_dict(scene), self.parameters, self.values.tolist())

    def _profile_words(self, k: int) -> str:
        low, high = self.profiled[k]
        if math.isnan(low) and math.isnan(high):
            return "nothing: all values between the bounds will do"
        if math.isnan(low):
            return f"at most {high:.4g}"
        return f"at least {low:.4g}" if math.isnan(high) else f"from {low:.4g} to {high:.4g}"

    def __str__(self) -> str:
        lines = []
        for k, (p, v, (low, high)) in enumerate(zip(self.parameters, self.values, self.intervals)):
            profile = f"; by its profile {self._profile_words(k)}" if self.profiles else ""
            lines.append(f"{p.key:28s} {v:10.4g} {p.unit:6s} 95 % from {low:.4g} to {high:.4g}{profile}")
        scatter = 0.0 if self.known else 100 * math.sqrt(self.chi2 / self.freedom)
        words = f", scatter {scatter:.2g} % of the largest value" if scatter else ""
        lines.append(f"sum of squares {self.chi2:.4g}, {self.freedom} degrees of freedom{words}; "
                     f"{sum(s < 1.01 * self.chi2 + 1e-9 for s in self.starts)} of {len(self.starts)} starts end there")
        return "\n".join(lines + [self.misfit] * bool(self.misfit) + self.doubts + self.untold)

    def told(self) -> dict[str, Any]:
        """All of it as an object of JSON."""
        bare = lambda values: [None if math.isnan(v) else float(v) for v in values]
        entries: list[dict[str, Any]] = []
        for k, p in enumerate(self.parameters):
            entry = {"key": p.key, "unit": p.unit, "bounds": [p.value(0), p.value(1)], "value": float(self.values[k]),
                     "interval": bare(self.intervals[k])}
            if self.profiles:
                entry |= {"profile": self.profiles[k].tolist(), "profiled": bare(self.profiled[k])}
            entries.append(entry)
        of = self.problem
        return {"lamella_calibration": 1, "parameters": entries, "correlation": self.correlation.tolist(),
                "chi2": self.chi2, "freedom": self.freedom, "scatter_known": self.known, "starts": self.starts,
                "misfit": self.misfit, "doubts": self.doubts,
                "limit": self.chi2 + self.width**2 * self.variance, "untold": self.untold,
                "experiments": [e.told(of.scene(e, self.u)) for e in of.experiments]}


def calibrate(parameters: dict[str, Range] | list[Parameter], curves: Sequence[Experiment], starts: int = 4,
              processes: int | None = 1, progress: Callable[[int, int], None] = lambda done, total: None) -> Fit:
    """Fits parameters to all experiments at once.

    parameters: {key: (low, high)} with units, or Parameters; curves: Curves and Figures. starts: how many, the first in
    the middle of the bounds; processes: starts at a time, None: as many as processors; progress(done, total): after each.
    InputError names a key that a
    scene does not take, and a column or figure that no response has.
    """
    from scipy.stats import qmc
    chosen = parameters if isinstance(parameters, list) else [Parameter(k, *ends) for k, ends in parameters.items()]
    n = len(chosen)
    if not n or not curves:
        raise InputError(f"calibrate: there is no {'curve' if n else 'parameter'}")
    if starts < 1:
        raise InputError(f"starts: {starts}: at least 1")
    problem = Problem(chosen, curves)
    problem.check()
    sobol = qmc.Sobol(n, scramble=False).random_base2(math.ceil(math.log2(max(starts, 2))))
    places = np.vstack([np.full((1, n), 0.5), sobol[1:starts]])
    fits = parallel.each(_starts, [(problem, u) for u in places], processes, progress)
    best, chi2 = min(fits, key=lambda f: f[1])
    return Fit(problem, best, chi2, [cost for _, cost in fits])


def _shared(scenes: list[str]) -> tuple[list[Parameter], list[list[Parameter]]]:
    """The parameters of all scenes, and those of each. InputError: scenes contradict each other."""
    all_of: dict[str, Parameter] = {}
    of = [uncertain(scene) for scene in scenes]
    for scene, own in zip(scenes, of):
        for p in own:
            first = all_of.setdefault(p.key, p)
            if (p.low, p.high, p.prior) != (first.low, first.high, first.prior):
                raise InputError(f"{scene}: uncertain: {p.key}: another scene has other bounds for it; they are one "
                                 "parameter: write the same")
    return list(all_of.values()), of


def run(request: dict[str, Any]) -> int:
    """What `lamella calibrate` does; its exit status."""
    files, folder = request["files"], request.get("output")
    scenes, data = files[::2], files[1::2]
    file = None
    if folder:
        file = may_write(make_folder(folder) / "fit.json", with_member("lamella_calibration"), "a fit",
                         request.get("overwrite", False), [*inputs_of(*scenes), *data])
    parameters, of = _shared(scenes)
    experiments = [experiment(*each) for each in zip(scenes, data, of)]
    fit = calibrate(parameters, experiments, request.get("starts", 4), request.get("processes"),
                    shown("starts of the fit"))
    if request.get("profile"):
        fit.profile(request.get("processes"), shown("profiles"))
    told = fit.told()
    print(json.dumps(told) if request.get("json") else fit)
    if file:
        write_whole(file, json.dumps(told) + "\n")
        if not request.get("json"):
            print(f"wrote {file}", flush=True)
    return UNSOLVED if fit.misfit else 0


def main(argument: str) -> int:
    """Exit status of a request."""
    end_with_program()
    return served("lamella calibrate", lambda: run(json.loads(argument)))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
