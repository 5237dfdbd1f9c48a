"""Stress over the load of a series of states."""
import numpy as np

from ..measured import AREAS, FROM_INFLATED
from .page import EVENT, LINES, legend, limits, mark, pressure_unit

COMPONENTS = ((0, 0), (0, 1), (1, 0), (1, 1))
MARKERS = "os^D"


def solved(responses):
    """Whether states have fields."""
    return np.isin(responses.status, ("converged", "unstable"))


def _varies(values):
    return bool((np.abs(values - values[0]) > 1e-12).any() or np.isnan(values).any())


def _monotonic(values):
    steps = np.diff(values)
    return len(steps) > 0 and bool((steps * steps[0] > 0).all())


def _proportional(H):
    """Whether all F - I are multiples of the last one."""
    norm = np.linalg.norm(H, axis=(1, 2))
    return norm[-1] > 0 and bool((np.abs(H - (norm / norm[-1])[:, None, None] * H[-1]) <= 1e-9).all())


def _working(F, P):
    """The component of F that does nearly all of the work, such as the one that is pulled with free sides."""
    with np.errstate(invalid="ignore"):
        work = np.nansum(np.abs((P[1:] + P[:-1]) * np.diff(F, axis=0)), axis=0)
    most = np.unravel_index(work.argmax(), (3, 3))
    return most if work[most] > 0.99 * work.sum() > 0 else None


class Measured:
    """F and P of states as the table of `rve` and OUT.csv have them, and what they count from. test: what was read off
    the curve (docs/reference/commands.md, Mechanical tests): with F_inflated F counts from the inflated tissue, and P is
    per area of `reference`."""

    def __init__(self, responses, test):
        self.F, self.P = responses.F, responses.P
        self.of_F = self.of_P = ""
        if "F_inflated" in test:
            lengths = np.diagonal(np.reshape(test["F_inflated"], (3, 3)))
            self.F = self.F / lengths
            self.of_F, self.of_P = FROM_INFLATED, AREAS[test["reference"]]
            if test["reference"] == "inflated":
                self.P = self.P * lengths / lengths.prod()


class LoadAxis:
    """What varies along the states: label, values, component of F (None: something else), what F counts from (of), and
    whether it is the state's number."""

    def __init__(self, responses, keys, measured):
        F, P = measured.F, measured.P
        self.component = self.name = self.unit = None
        self.of = ""
        self.label, self.values, self.whole = "state", np.asarray(keys, float), True
        varying = [tuple(c) for c in np.argwhere((np.abs(F - F[0]) > 1e-12).any(axis=0))]
        loads = [(name, sign, getattr(responses, name)) for name, sign in (("turgor", "p"), ("cohesion", "g"))
                 if _varies(getattr(responses, name))]
        H = F - np.eye(3)
        if not loads and varying:
            if len(varying) == 1:
                self._choose(varying[0], measured, _monotonic)
            elif _proportional(H):
                norm = np.linalg.norm(H, axis=(1, 2))
                if _monotonic(norm):
                    self.name, self.of = r"$\Vert F - I\Vert$", measured.of_F
                    self.label = self.name + self.of
                    self.values, self.whole = norm, False
            elif _working(F, P) is not None:
                self._choose(_working(F, P), measured, lambda values: True)
        elif len(loads) == 1 and not varying and _monotonic(loads[0][2]):
            name, sign, values = loads[0]
            self.unit, size = pressure_unit(values)
            self.label, self.values, self.whole = f"{name} ${sign}$ ({self.unit})", values / size, False
            self.name = f"${sign}$"

    def _choose(self, component, measured, allowed):
        i, j = component
        if allowed(measured.F[:, i, j]):
            self.component, self.values, self.whole = (i, j), measured.F[:, i, j], False
            self.name, self.of = f"$F_{{{i + 1}{j + 1}}}$", measured.of_F
            self.label = self.name + self.of


def peak(responses):
    """The state at which the stress along the way of F has risen most since the first response, (P - P1) : (F - F1)
    over ||F - F1||; None: it does not rise."""
    known = np.flatnonzero(solved(responses))
    if not len(known):
        return None
    way = responses.F[known] - responses.F[known[0]]
    size = np.linalg.norm(way, axis=(1, 2))
    with np.errstate(invalid="ignore", divide="ignore"):
        rise = np.einsum("nij,nij->n", responses.P[known] - responses.P[known[0]], way) / size
    # free tissue swells without stress, up to rounding: 1e-6 of the stress of the fluid
    rise[~(rise > 1e-6 * responses.turgor[known])] = -np.inf
    return int(known[rise.argmax()]) if np.isfinite(rise).any() else None


def stress(page, axes, responses, keys, test, options=None):
    """P11, P12, P21, P22 over the states; rings around unstable ones, crosses for those without an answer. test: what
    was read off the curve (docs/reference/commands.md, Mechanical tests)."""
    measured = Measured(responses, test)
    load, known, unstable = LoadAxis(responses, keys, measured), solved(responses), responses.status == "unstable"
    unit, size = pressure_unit(measured.P[known][:, :2, :2])
    stride = 1 if len(keys) <= 40 else (len(keys) + 19) // 20
    lowest, highest = np.inf, -np.inf
    for k, (i, j) in enumerate(COMPONENTS):
        P = np.where(known, measured.P[:, i, j], np.nan) / size
        lowest, highest = min(lowest, np.nanmin(P, initial=np.inf)), max(highest, np.nanmax(P, initial=-np.inf))
        axes.plot(load.values, P, color=LINES[k], marker=MARKERS[k], linestyle=(0, (3.2, 1.8)) if k > 1 else "-",
                  markerfacecolor="white" if k % 2 else LINES[k], markevery=stride, label=f"$P_{{{i + 1}{j + 1}}}$")
        axes.plot(load.values[unstable], P[unstable], "o", color="black", markerfacecolor="none", markersize=7,
                  label="unstable" if unstable.any() and k == 3 else None)
    if not known.all():
        below = lowest - 0.1 * (highest - lowest) if lowest <= highest else 0
        axes.plot(load.values[~known], np.full((~known).sum(), below), "x", color="black", markeredgewidth=1.2,
                  label="no answer")
    axes.set(xlabel=load.label, ylabel=f"effective stress $P$ ({unit}){measured.of_P}")
    if load.whole:
        axes.xaxis.get_major_locator().set_params(integer=True)
    limits(axes, options or {})
    if load.component and test.get("component") == f"{load.component[0] + 1}{load.component[1] + 1}":
        _readings(page, axes, test, load.component)
    legend(page, axes)


def _readings(page, axes, test, component):
    """Bioyield and peak, whose strains count from where F does."""
    i, j = component
    for name in ("bioyield", "peak"):
        read = test.get(name)
        if read and (name == "bioyield" or test.get("peak_passed")):
            mark(page, axes, read["strain"] + (i == j), name, EVENT)
