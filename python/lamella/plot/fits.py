"""Fits of `lamella calibrate`: measured curves and figures with what the model finds, and profiles of the parameters.

Bars are 1.96 standard deviations of what was measured. Between its points a profile is drawn as a parabola would be:
straight in the root of what it lies above its least.
"""
import re

import numpy as np
from matplotlib.ticker import LogLocator, NullLocator

from .page import DARK, DASHES, EVENT, LINES, NOW, WIDTH, Page, legend, limits, number, settle, styled
from .read import WRONG, object_of, unlike

MARGIN, GAP, HIGH = 8, 10, 150  #: points
ACROSS = 3  #: panels in a row
BAR = 1.96  #: standard deviations: 95 % of normally distributed values
ABOVE = 3.0  #: of the profile's limit over its least: the top of its panel
NEEDED = {"parameters", "experiments", "limit", "chi2", "freedom"}
DECADE = 6.0  #: largest over least value of an axis that is logarithmic from there on


def titled(title):
    """F11 with its indices below the line."""
    return re.sub(r"\b([A-Z])([123]{2})\b", r"$\1_{\2}$", title)


def rows(page, x, y, width, height, panels, across=ACROSS):
    """Draws panels, functions of axes, side by side: rows that are all as wide as the page."""
    count = -(-len(panels) // across)
    high = (height - (count - 1) * GAP) / max(count, 1)
    for r, row in enumerate(np.array_split(np.arange(len(panels)), count) if count else ()):
        wide = (width - (len(row) - 1) * GAP) / len(row)
        for c, k in enumerate(row):
            panels[k](page.chart(x + c * (wide + GAP), y + r * (high + GAP), wide, high))


def wide_axis(axis, scale, ends):
    """A logarithmic axis where values differ by more than a few times, with numbers that people read."""
    if not 0 < ends[0] * DECADE < ends[1]:
        return
    scale("log")
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if ends[1] < 300 * ends[0] else (1,)))
    axis.set_major_formatter(lambda value, _: f"{value:g}")
    axis.set_minor_locator(NullLocator())


def _curve(page, axes, told):
    """A measured curve and the model's."""
    x, y = np.array(told["data"], float)
    known = told["scatter"] is not None
    axes.errorbar(x, y, BAR * np.array(told["scatter"]) if known else None, fmt="o", color=DARK, ecolor=EVENT,
                  markerfacecolor="white", elinewidth=0.7, capsize=1.5, zorder=3, label=told["name"].split("/")[-1])
    model = np.array(told["model"], float)
    axes.plot(*model, color=LINES[0], linewidth=1.3, label="model", zorder=4)
    reach = np.ptp(x) or 1.0
    axes.set_xlim(x.min() - 0.06 * reach, x.max() + 0.06 * reach)  # the model may go on
    axes.set(xlabel=titled(told["x"]), ylabel=titled(told["y"]))
    legend(page, axes)


def _figures(page, axes, told):
    """Of all experiments with figures: measured and found over the measured value."""
    names, data, scatter, model = [], [], [], []
    for of in told:
        names += of["figures"]
        for all_of, part in ((data, "data"), (scatter, "scatter"), (model, "model")):
            all_of += [np.nan if value is None else value for value in of[part]]
    size, at = np.abs(data), np.arange(len(names), 0, -1)
    axes.errorbar(np.zeros(len(at)), at, xerr=100 * BAR * np.array(scatter) / size, fmt="o", color=DARK, ecolor=EVENT,
                  markerfacecolor="white", elinewidth=0.7, capsize=1.5, zorder=3, label="measured")
    axes.plot(100 * (np.array(model) - data) / size, at, "D", color=LINES[0], zorder=4, label="model")
    axes.set(xlabel="off the measured value (%)", ylim=(0.4, len(at) + 0.6))
    for old, new in (("_", " "), (".", ", "), (" (", "\n("), ("^3", "³")):
        names = [name.replace(old, new) for name in names]
    axes.set_yticks(at, names)
    axes.tick_params(axis="y", length=0)
    axes.grid(False, axis="y")
    legend(page, axes)


def _profile(page, axes, told, parameter):
    """The sum of squares over a parameter."""
    x, cost = np.array(parameter["profile"], float)
    low, high = parameter["bounds"]
    place = np.log(x) if low > 0 else x
    best = int(np.argmin(cost))
    least, limit = cost[best], told["limit"]
    top = least + ABOVE * max(limit - least, 1e-12)
    root = np.sqrt(np.maximum(cost - least, 0)) * np.where(np.arange(len(x)) < best, -1, 1)
    fine = np.union1d(np.linspace(place[0], place[-1], 1000), place)
    line = least + np.interp(fine, place, root) ** 2
    shown = fine[line <= top]
    fine_x = np.exp(fine) if low > 0 else fine
    ends = [float(np.exp(v) if low > 0 else v) for v in (shown[0], shown[-1])]
    axes.plot(fine_x, line, color=LINES[0], linewidth=1.1)
    axes.plot(x, cost, "o", color=LINES[0], markersize=2.2)
    axes.axhline(limit, color=EVENT, linestyle=DASHES, linewidth=0.8, label="95 %")
    inside = [b if v is None else v for v, b in zip(parameter["profiled"], (low, high))]
    axes.axvspan(*inside, color=LINES[0], alpha=0.10, linewidth=0)
    axes.plot([x[best]], [least], "D", color=NOW, markersize=4, zorder=4, label="best")
    wide_axis(axes.xaxis, axes.set_xscale, ends)
    margin = 0.04 * (shown[-1] - shown[0])
    around = np.array([shown[0] - margin, shown[-1] + margin])
    if axes.get_xscale() == "log":
        axes.set_xlim(np.exp(around))
    else:
        axes.set_xlim(ends[0] - 0.04 * (ends[1] - ends[0]), ends[1] + 0.04 * (ends[1] - ends[0]))
    axes.set_ylim(least - 0.08 * (top - least), top)
    unit = f" ({parameter['unit']})" if parameter["unit"] else ""
    axes.set(xlabel=f"{parameter['key']}{unit}", ylabel="sum of squares")
    legend(page, axes)


@styled
def draw(path, options):
    """All curves, figures and profiles of a file fit.json of `lamella calibrate`."""
    told = object_of(path, "calibrate", NEEDED)
    figures = [of for of in told["experiments"] if "figures" in of]
    data = [lambda axes, of=of: _curve(page, axes, of) for of in told["experiments"] if "figures" not in of]
    if figures:
        data.append(lambda axes: _figures(page, axes, figures))
    profiles = [lambda axes, p=p: _profile(page, axes, told, p) for p in told["parameters"] if "profile" in p]
    count = [-(-len(panels) // ACROSS) for panels in (data, profiles)]
    page = Page(WIDTH, sum(count) * (HIGH + GAP) + 2 * MARGIN + 14, options)
    found = ", ".join(f"{p['key'].split('.')[-1]} {number(p['value'])} {p['unit']}".rstrip()
                      for p in told["parameters"])
    top = MARGIN + page.head(f"{found}; sum of squares {number(told['chi2'])}, {told['freedom']} degrees of freedom",
                             options)
    width, height = page.size[0] - 2 * MARGIN, page.size[1] - top - MARGIN
    share = (height - GAP * (sum(count) - 1)) / sum(count)
    parts = [rows_of * share + (rows_of - 1) * GAP for rows_of in count]
    try:
        rows(page, MARGIN, top, width, parts[0], data)
        rows(page, MARGIN, top + parts[0] + GAP, width, parts[1], profiles)
    except WRONG as error:
        raise unlike(path, "calibrate", error) from None
    limits(page.axes[0], options)
    return settle(page)
