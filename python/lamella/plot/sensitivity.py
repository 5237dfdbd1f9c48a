"""How figures of a test depend on keys: bars of the Sobol' indices, a panel for each figure, and elasticities.

Dark bars are shares of the variance that a key makes alone, pale ones behind them with all its interactions; lines are
intervals of 95 %. Keys are in one order, by the median of their totals.
"""
import math

import numpy as np

from .. import InputError
from .page import INK, LINES, SMALL, TEXT, WIDTH, Page, settle, styled
from .read import WRONG, object_of, unlike

MARGIN, GAP, HEAD, FOOT, LEGEND = 9, 12, 24, 22, 12  #: points; HEAD above, FOOT below a panel
ROW, BAR = 13, 0.36  #: of a key; of a bar, over that
NARROW = 118  #: of a panel, with the room for its elasticities
NOTHING = 1e-3  #: of an interval: as wide as its line
BEYOND = 0.4  #: 0 and 1, what is drawn of intervals of few samples
SIGNS = 30  #: of elasticities beside a panel
NAMES = {"modulus": "modulus", "poisson": "Poisson's ratio", "bioyield.strain": "strain at bioyield",
         "bioyield.stress": "stress at bioyield", "peak.strain": "strain at the peak",
         "peak.stress": "stress at the peak", "energy_to_peak": "energy to the peak", "work": "work of loading",
         "returned": "energy returned", "hysteresis": "hysteresis", "failure.factor": "load factor of failure"}
FIRST, TOTAL = LINES[0], "#a9cfe8"  #: the second is the first, paler: it holds it
NOTE = "beside bars: elasticity, % of the figure for 1 % of the key"


def _read(path):
    told = object_of(path, "sensitivity")
    try:
        figures = [f for f in told["figures"] if f["first"] is not None]
        mode = told["mode"]
        if mode and mode["indices"] and mode["indices"]["first"] is not None:
            figures.append(mode["indices"] | {"share": mode["shares"]})
        keys = [k["key"] for k in told["keys"]]
        for figure in figures:
            for name, shape in (("first", (len(keys),)), ("total_interval", (len(keys), 2))):
                assert np.shape(figure[name]) == shape, name
        return told, figures, keys
    except WRONG as error:
        raise unlike(path, "sensitivity", error) from None


def _title(figure):
    """Two lines: name, and what its samples are."""
    if "share" in figure:
        of = figure["name"].split()[-1]
        return f"failure by {of.replace('_', ' ')}", f"{100 * figure['share'][of]:.3g} % of the samples"
    unit = f" {figure['unit']}".replace("^3", "³").replace("^2", "²").rstrip()
    mean, low, high = (f"{v:.3g}".replace("-", "\u2212") for v in (figure["mean"], *figure["quantiles"]))
    return NAMES[figure["name"]], f"mean {mean}{unit}; 95 %: {low} to {high}"


def _short(keys):
    """Keys without the block that all of them are of."""
    return [key.removeprefix("rve.") for key in keys] if all(key.startswith("rve.") for key in keys) else keys


def _bars(axes, figure, order):
    y = np.arange(len(order))
    for name, colour, side in (("first", FIRST, -1), ("total", TOTAL, 1)):
        values = np.array(figure[name], float)[order]
        ends = np.array(figure[f"{name}_interval"], float)[order]
        known = np.ptp(ends, axis=1) > NOTHING
        bars = np.maximum((ends - values[:, None]) * (-1, 1), 0).T
        axes.barh(y + side * BAR / 2, values, BAR, color=colour, zorder=2)
        axes.errorbar(values[known], (y + side * BAR / 2)[known], xerr=bars[:, known], fmt="none", ecolor=INK,
                      elinewidth=0.6, capsize=1.3, capthick=0.6, zorder=3)


def _range(figures):
    """Of shares, alike in all panels: with the intervals."""
    ends = np.concatenate([np.ravel([f["first_interval"], f["total_interval"]]).astype(float) for f in figures])
    low, high = max(-BEYOND, min(0, np.nanmin(ends))), min(1 + BEYOND, np.nanmax(ends))
    return (-0.04 if low > -0.03 else low - 0.02), max(1.02, high + 0.02)


def _panel(axes, figure, order, labels, marks, last):
    _bars(axes, figure, order)
    axes.set(ylim=(len(order) - 0.4, -0.6), yticks=range(len(order)), yticklabels=labels or [])
    axes.tick_params(axis="y", length=0)
    axes.grid(False, axis="y")
    axes.axvline(0, color=INK, linewidth=0.6, zorder=2.5)
    axes.set_xticks([0, 0.5, 1], ["0", "0.5", "1"])
    if last:
        axes.set_xlabel("share of the variance")
    for spine in ("top", "right", "left"):
        axes.spines[spine].set_visible(False)
    name, samples = _title(figure)
    axes.annotate(name, (0, 1), xycoords="axes fraction", xytext=(0, 12), textcoords="offset points", size=TEXT,
                  color=INK, weight="bold")
    axes.annotate(samples, (0, 1), xycoords="axes fraction", xytext=(0, 3.5), textcoords="offset points", size=SMALL)
    for k, i in enumerate(order):
        value = figure["elasticity"][i]
        if value is not None and "share" not in figure:
            text = "0" if abs(value) < 0.005 else f"{value:+.{2 if abs(value) < 10 else 0}f}"
            text = "~" * figure["rough"][i] + text.replace("-", "\u2212") + marks[i]
            axes.annotate(text, (1, k), xycoords=("axes fraction", "data"), xytext=(SIGNS - 2, 0),
                          textcoords="offset points", size=SMALL, ha="right", va="center")


def _legend(page, x, y, note):
    """In a row: the two bars, lines, and what stands beside them."""
    w, h = page.size
    for colour, text in ((FIRST, "by the key alone"), (TOTAL, "with its interactions"), (None, note)):
        if colour:
            axes = page.area(x, y, 9, 6)
            axes.set_facecolor(colour)
            axes.set(xticks=[], yticks=[])
            for spine in axes.spines.values():
                spine.set_visible(False)
            x += 12
        label = page.text(x / w, 1 - (y + 3) / h, text, size=SMALL, va="center_baseline")
        x += label.get_window_extent().width * 72 / page.dpi + 14


def _width(page, texts):
    """Of the widest text, points."""
    widths = []
    for text in texts:
        label = page.text(0, 0, text, size=SMALL)
        widths.append(label.get_window_extent().width * 72 / page.dpi)
        label.remove()
    return max(widths)


@styled
def draw(path, options):
    """A panel for each figure of a sensitivity.json of `lamella sensitivity` that has indices."""
    told, figures, keys = _read(path)
    if not figures:
        raise InputError(f"{path}: no figure has indices: there is nothing to draw")
    order = np.argsort([-np.median([f["total"][k] for f in figures]) for k in range(len(keys))], kind="stable")
    labels = [_short(keys)[k] for k in order]
    names = _width(Page(WIDTH, WIDTH), labels) + 6
    columns = max(1, min(len(figures), int((WIDTH - 2 * MARGIN - names + GAP) / (NARROW + SIGNS + GAP))))
    rows = math.ceil(len(figures) / columns)
    columns = math.ceil(len(figures) / rows)
    head = LEGEND + 14 * (options.get("title") is not False)
    each = HEAD + ROW * len(keys) + 8 + FOOT
    page = Page(WIDTH, 2 * MARGIN + head + rows * each, options)
    page.head(f"Sensitivity of {told['scene']}: {told['evaluations']} evaluations", options)
    marks = ["" if key["logarithmic"] else "*" for key in told["keys"]]
    rough = any(f["rough"][k] for f in figures for k in range(len(keys)))
    _legend(page, MARGIN, MARGIN + head - LEGEND,
            NOTE + "; *: over its bounds" * any(marks) + "; ~: not smooth" * rough)
    shares = options.get("x") or _range(figures)
    width = (page.size[0] - 2 * MARGIN - names - columns * SIGNS - (columns - 1) * GAP) / columns
    high = (page.size[1] - 2 * MARGIN - head) / rows
    for i, figure in enumerate(figures):
        x = MARGIN + names + (i % columns) * (width + SIGNS + GAP)
        axes = page.area(x, MARGIN + head + (i // columns) * high + HEAD, width, high - HEAD - FOOT)
        _panel(axes, figure, order, labels if i % columns == 0 else None, marks, i + columns >= len(figures))
        axes.set_xlim(shares)
    return settle(page)
