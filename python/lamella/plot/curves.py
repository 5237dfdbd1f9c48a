"""Stress over the load of a series of states."""
import numpy as np

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


class LoadAxis:
    """What varies along the states: label, values, component of F (None: something else), and whether it is the state's
    number."""

    def __init__(self, responses, keys):
        F, P = responses.F, responses.P
        self.component = self.name = self.unit = None
        self.label, self.values, self.whole = "state", np.asarray(keys, float), True
        varying = [tuple(c) for c in np.argwhere((np.abs(F - F[0]) > 1e-12).any(axis=0))]
        loads = [(name, sign, getattr(responses, name)) for name, sign in (("turgor", "p"), ("cohesion", "g"))
                 if _varies(getattr(responses, name))]
        H = F - np.eye(3)
        if not loads and varying:
            if len(varying) == 1:
                self._choose(varying[0], F, _monotonic)
            elif _proportional(H):
                norm = np.linalg.norm(H, axis=(1, 2))
                if _monotonic(norm):
                    self.label = self.name = r"$\Vert F - I\Vert$"
                    self.values, self.whole = norm, False
            elif _working(F, P) is not None:
                self._choose(_working(F, P), F, lambda values: True)
        elif len(loads) == 1 and not varying and _monotonic(loads[0][2]):
            name, sign, values = loads[0]
            self.unit, size = pressure_unit(values)
            self.label, self.values, self.whole = f"{name} ${sign}$ ({self.unit})", values / size, False
            self.name = f"${sign}$"

    def _choose(self, component, F, allowed):
        i, j = component
        if allowed(F[:, i, j]):
            self.component, self.values, self.whole = (i, j), F[:, i, j], False
            self.label = self.name = f"$F_{{{i + 1}{j + 1}}}$"


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


def stress(page, axes, responses, keys, test=None, options=None):
    """P11, P12, P21, P22 over the states; rings around unstable ones, crosses for those without an answer. test: what
    was read off the curve (docs/reference/commands.md, Mechanical tests)."""
    load, known, unstable = LoadAxis(responses, keys), solved(responses), responses.status == "unstable"
    unit, size = pressure_unit(responses.P[known][:, :2, :2])
    stride = 1 if len(keys) <= 40 else (len(keys) + 19) // 20
    lowest, highest = np.inf, -np.inf
    for k, (i, j) in enumerate(COMPONENTS):
        P = np.where(known, responses.P[:, i, j], np.nan) / size
        lowest, highest = min(lowest, np.nanmin(P, initial=np.inf)), max(highest, np.nanmax(P, initial=-np.inf))
        axes.plot(load.values, P, color=LINES[k], marker=MARKERS[k], linestyle=(0, (3.2, 1.8)) if k > 1 else "-",
                  markerfacecolor="white" if k % 2 else LINES[k], markevery=stride, label=f"$P_{{{i + 1}{j + 1}}}$")
        axes.plot(load.values[unstable], P[unstable], "o", color="black", markerfacecolor="none", markersize=7,
                  label="unstable" if unstable.any() and k == 3 else None)
    if not known.all():
        below = lowest - 0.1 * (highest - lowest) if lowest <= highest else 0
        axes.plot(load.values[~known], np.full((~known).sum(), below), "x", color="black", markeredgewidth=1.2,
                  label="no answer")
    axes.set(xlabel=load.label, ylabel=f"effective stress $P$ ({unit})")
    if load.whole:
        axes.xaxis.get_major_locator().set_params(integer=True)
    limits(axes, options or {})
    if test and load.component and test.get("component") == f"{load.component[0] + 1}{load.component[1] + 1}":
        _readings(page, axes, test, load.component)
    legend(page, axes)


def _readings(page, axes, test, component):
    """Bioyield and peak: strains count from the inflated tissue where the test does, F from rest."""
    i, j = component
    F0 = np.reshape(test.get("F_inflated", np.eye(3)), (3, 3))
    for name in ("bioyield", "peak"):
        read = test.get(name)
        if read and (name == "bioyield" or test.get("peak_passed")):
            mark(page, axes, (read["strain"] + (i == j)) * F0[j, j], name, EVENT)
