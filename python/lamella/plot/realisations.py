"""Realisations of tissue: scatter against the cells in a period with its fit s1/sqrt(cells), and means with intervals.

Bars are intervals of 95 % confidence, small points single realisations. Series lie beside each other at each number of
cells so that their bars can be told apart.
"""

import numpy as np
from matplotlib.ticker import FixedLocator, NullFormatter, NullLocator

from .. import InputError
from .curves import MARKERS
from .page import DASHES, EVENT, HEIGHT, LINES, WIDTH, Page, legend, limits, settle, styled
from .read import WRONG, object_of, unlike

MARGIN, GAP = 8, 10  #: points
MOST = 4  #: states that are drawn: those between the first and the last one in equal steps
BESIDE = 0.03  #: between series, of the logarithm of the cells
PALE = 0.45  #: of the colour of single realisations
MODULUS = "E1"  #: at rest: how moduli scatter beside stresses
NEEDED = {"name", "sizes", "fit"}


class _Series:
    """Label, scatter (an entry of scatter.relative) and the quantity (of scatter.quantity) whose mean is drawn."""

    def __init__(self, label, scatter, quantity):
        self.label, self.scatter, self.quantity = label, scatter, quantity
        assert NEEDED <= scatter.keys() and NEEDED <= quantity.keys()

    def means(self):
        """Cells, means, intervals and single values over the mean of the largest period with one, less 1; None: there
        is none."""
        known = [entry for entry in self.quantity["sizes"] if entry["interval"] and entry["mean"]]
        if not known:
            return None
        last = known[-1]["mean"]
        over = lambda values: 100 * (np.asarray(values, float) / last - 1)
        return [(entry["cells"], over(entry["mean"]), over(sorted(entry["interval"], key=lambda v: v / last)),
                 over(entry["values"])) for entry in known]


def _largest(state):
    """The component of P that is largest in the mean of the largest periods."""
    stresses = [q for q in state["quantities"] if q["name"][0] == "P"]
    return max(stresses, key=lambda q: abs(q["sizes"][-1]["mean"] or 0))


def _all_series(told):
    states = [state for state in told["states"] if any(q["name"][0] == "P" for q in state["quantities"])]
    drawn = sorted({round(k) for k in np.linspace(0, len(states) - 1, MOST)}) if states else []
    series = []
    for state in (states[k] for k in drawn):
        q = _largest(state)
        series.append(_Series(f"stress, state {state['state']}", state["stress"], q))
    of = {entry["name"]: entry for entry in told["rest"]["moduli"]}
    for q in told["rest"]["quantities"]:
        if q["name"] == MODULUS:
            series.append(_Series("$E_1$ at rest", of[MODULUS], q))
    return series


def _beside(k, count):
    """Factor of the cells of series k."""
    return np.exp(BESIDE * (k - (count - 1) / 2))


def _cells_axis(axes, told):
    sizes = [size["cells"] for size in told["sizes"]]
    axes.set(xscale="log", xlabel="cells in a period", xlim=(sizes[0] / 1.25, sizes[-1] * 1.25))
    axes.xaxis.set_major_locator(FixedLocator(sizes))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:.0f}")


def _scatter(page, axes, told, series):
    """Deviations, their intervals and the fits."""
    _cells_axis(axes, told)
    axes.set(yscale="log", ylabel="scatter of one period (%)")
    x = np.array(axes.get_xlim())
    for k, one in enumerate(series):
        colour = LINES[k]
        known = [entry for entry in one.scatter["sizes"] if entry["deviation"]]
        cells = np.array([entry["cells"] for entry in known]) * _beside(k, len(series))
        y = 100 * np.array([entry["deviation"] for entry in known])
        if not known:
            continue
        bars = np.abs(100 * np.array([entry["deviation_interval"] for entry in known]) - y[:, None]).T
        axes.errorbar(cells, y, bars, fmt=MARKERS[k % len(MARKERS)], color=colour, elinewidth=0.7, label=one.label)
        axes.plot(x, 100 * one.scatter["fit"]["s1"] / np.sqrt(x), color=colour, linewidth=0.7, linestyle=DASHES)
    axes.plot([], [], color=EVENT, linewidth=0.7, linestyle=DASHES, label=r"$s_1/\sqrt{\mathrm{cells}}$")
    axes.set_xlim(x)
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.yaxis.set_minor_formatter(NullFormatter())
    legend(page, axes)


def _means(page, axes, told, series):
    """Means, their intervals and single realisations."""
    _cells_axis(axes, told)
    axes.set(ylabel="mean over that of the largest period, less 1 (%)")
    for k, one in enumerate(series):
        for cells, mean, interval, values in one.means() or []:
            at, colour = cells * _beside(k, len(series)), LINES[k]
            axes.plot(np.full(len(values), at), values, ".", color=colour, alpha=PALE, markersize=3, zorder=1.8)
            axes.errorbar([at], [mean], [[mean - interval[0]], [interval[1] - mean]], fmt=MARKERS[k % len(MARKERS)],
                          color=colour, elinewidth=0.9, capsize=1.5)
    axes.plot([], [], ".", color=EVENT, markersize=3, label="single realisations; bars: 95 %")
    legend(page, axes)


def _read(path):
    """The object of the file, and its series."""
    told = object_of(path, "rve --realisations")
    try:
        return told, _all_series(told)
    except WRONG as error:
        raise unlike(path, "rve --realisations", error) from None


@styled
def draw(path, options):
    """Both charts of a file realisations.json of `lamella rve --realisations`. The means of a state are those of the
    component of P that is largest."""
    told, series = _read(path)
    if not series:
        raise InputError(f"{path}: no state has an answer: there is nothing to draw")
    page = Page(WIDTH, HEIGHT, options)
    head = page.head(f"Realisations of {told['scene']}", options)
    width, height = page.size[0] / 2 - MARGIN - GAP / 2, page.size[1] - 2 * MARGIN - head
    for k, chart in enumerate((_scatter, _means)):
        axes = page.chart(MARGIN + k * (width + GAP), MARGIN + head, width, height)
        chart(page, axes, told, series)
    limits(axes, options)
    return settle(page)
