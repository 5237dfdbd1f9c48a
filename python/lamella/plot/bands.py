"""Bands of samples (`lamella rve` and `lamella process --uncertainty`): the interval that holds 95 % of them, their
median, and what the scene's own values give; figures of a test; and what happens first in which share of the samples.
"""

import numpy as np

from .. import InputError
from ..uncertainty import counted
from ..units import time_unit
from .fits import ACROSS, GAP, HIGH, MARGIN, rows, titled
from .page import DASHES, LINES, NOW, WIDTH, Page, legend, limits, settle, styled
from .read import WRONG, object_of, unlike

OF = "rve or process --uncertainty"
MOST = 5  #: quantities that are drawn, beside what happens first: a page of two rows
LEAST = 40  #: answers for an interval of 95 %
NONE = 1e-6  #: MPa, kJ/m^3 or 1: the hysteresis of elastic tissue is 1e-13
PALE = 0.22  #: of the band's colour
WORDS = {"turgor_mean": "turgor, mean", "lumen_fraction": "lumens (volume over $V_0$)",
         "water": "water (volume over $V_0$)", "walls": "walls (share of the start)",
         "lamella_normal_ratio": "lamella, stress over strength", "lamella_shear_ratio": "lamella, shear over strength",
         "wall_ratio": "walls, stress over strength"}
#: of processes, the most wanted first
ORDER = ("firmness", "turgor", "turgor_mean", "lamella_normal_ratio", "wall_ratio", "lumen_fraction",
         "debonded_fraction", "walls")


def _label(name, unit, reference=None):
    words = titled(WORDS.get(name, name.replace("_", " ").replace(".", ", ")))
    return (f"{words} ({unit.replace('^3', '³')})" if unit else words) + counted(name, reference)


def _numbers(values):
    return np.array([np.nan if v is None else v for v in values], float)


class _Axis:
    """What bands are drawn over."""

    def __init__(self, told):
        axis = told["axis"]
        self.values, self.one, unit = np.array(axis["values"], float), 1, axis["unit"]
        if unit == "s":
            unit, self.one = time_unit(self.values[-1])
        self.values = self.values / self.one
        self.reference = told.get("reference")  # None in files of 0.1
        self.label, self.whole = _label(axis["name"], unit, self.reference), axis["name"] == "state"


def _ways(values):
    """Ways there and back of a load that returns: slices that are monotonic."""
    rises = np.sign(np.diff(values))
    turns = [i for i in range(1, len(rises)) if rises[i] * rises[i - 1] < 0]
    return [slice(a, b + 1) for a, b in zip([0, *turns], [*turns, len(values) - 1])]


def _band(axes, axis, of):
    """One quantity."""
    low, median, high, own = (_numbers(of[part]) for part in ("low", "median", "high", "scene"))
    words = "95 %" if max(of["count"]) >= LEAST else "all"
    marker = "o" if len(axis.values) < 3 else None
    for k, part in enumerate(_ways(axis.values)):
        axes.fill_between(axis.values[part], low[part], high[part], color=LINES[0], alpha=PALE, linewidth=0,
                          label=None if k else words)
    for line in (low, high):
        axes.plot(axis.values, line, color=LINES[0], linewidth=0.5)
    axes.plot(axis.values, median, color=LINES[0], linewidth=1.3, marker=marker, label="median")
    axes.plot(axis.values, own, color=NOW, linewidth=1.0, linestyle=DASHES, marker=marker, label="scene")
    axes.set(xlabel=axis.label, ylabel=_label(of["name"], of["unit"], axis.reference))
    if axis.whole:
        axes.xaxis.get_major_locator().set_params(integer=True)


def _told_figures(told):
    """Those that samples change, of a scene that has them."""
    return [of for of in told["figures"] if of["median"] is not None and abs(of["scene"] or 0) > NONE and
            of["low"] != of["high"]]


def _figures(axes, told):
    """Figures over those of the scene."""
    known = _told_figures(told)
    at = np.arange(len(known), 0, -1)
    low, median, high = (100 * (np.array([of[p] / of["scene"] for of in known]) - 1) for p in ("low", "median", "high"))
    bars = [median - np.minimum(low, high), np.maximum(low, high) - median]
    axes.errorbar(median, at, xerr=bars, fmt="o", color=LINES[0], elinewidth=1.1, capsize=2, label="median", zorder=3)
    axes.plot([], [], color=NOW, linestyle=DASHES, linewidth=1.0, label="scene")
    axes.axvline(0, color=NOW, linestyle=DASHES, linewidth=1.0)
    axes.set_yticks(at, [f"{_label(of['name'], '')}\n{of['median']:.3g} {of['unit'].replace('^3', '³')}".rstrip()
                         for of in known])
    axes.set(xlabel="off the scene's value (%)", ylim=(0.4, len(at) + 0.6))
    axes.tick_params(axis="y", length=0)
    axes.grid(False, axis="y")


def _first(axes, told, axis):
    """The share of the samples in which something has happened first, over time or load factor."""
    first, total = told["first"], len(told["first"]["names"])
    one = axis.one if first["of"] == "time" else 1
    at = _numbers(first["at"]) / one
    known = [e for e in first["events"] if e["at"]["count"]]
    end = axis.values[-1] if first["of"] == "time" else np.nanmax(at, initial=1.0)
    for k, event in enumerate(known):
        own = np.sort(at[[n == event["name"] for n in first["names"]]])
        share = 100 * np.arange(len(own) + 1) / total
        axes.step(np.r_[0, own, end], np.r_[share, share[-1]], where="post", color=LINES[(k + 1) % len(LINES)],
                  linewidth=1.3, label=event["name"].replace("_", " "))
    if first["scene"]["at"] is not None:
        axes.axvline(first["scene"]["at"] / one, color=NOW, linestyle=DASHES, linewidth=1.0)
    for event in first["events"]:
        if event not in known:
            axes.plot([], [], " ", label=f"{event['name']}: {event['samples']} of {total}")
    axes.set(xlabel=axis.label if first["of"] == "time" else "load factor", ylabel="samples (%)", ylim=(-3, 103),
             xlim=(-0.03 * end, 1.03 * end))


def _chosen(told):
    """Series that are drawn."""
    series = told["series"]
    wanted = [of for name in ORDER for of in series if of["name"] == name]
    return (wanted + [of for of in series if of not in wanted])[:MOST]


def _panels(page, told):
    """Functions of axes."""
    axis, panels = _Axis(told), []

    def panel(draw, *arguments):
        def drawn(axes):
            draw(axes, *arguments)
            legend(page, axes, handlelength=1.3)
        panels.append(drawn)
    for of in _chosen(told):
        panel(_band, axis, of)
    if _told_figures(told):
        panel(_figures, told)
    if told["first"] and any(e["at"]["count"] for e in told["first"]["events"]):
        panel(_first, told, axis)
    return panels


@styled
def draw(path, options):
    """Up to five quantities, figures, and what happens first, of a file uncertainty.json."""
    told = object_of(path, OF, {"axis", "series", "figures", "first", "samples", "parameters", "scene"})
    try:
        count = len(_panels(None, told))
        if not count:
            raise InputError(f"{path}: no sample has an answer that differs: there is nothing to draw")
        across = count if count <= ACROSS else ACROSS
        high = -(-count // across)
        wide = told["samples"] >= LEAST
        page = Page(WIDTH, high * (HIGH + GAP) + 2 * MARGIN + 14, options)
        keys = len(told["parameters"])
        top = MARGIN + page.head(f"{told['scene'].split('/')[-1]}: {told['samples']} samples of {keys} uncertain key" +
                              "s" * (keys > 1) + ("; bands hold 95 % of them" if wide else ""), options)
        rows(page, MARGIN, top, page.size[0] - 2 * MARGIN, page.size[1] - top - MARGIN, _panels(page, told), across)
    except WRONG as error:
        raise unlike(path, OF, error) from None
    limits(page.axes[0], options)
    return settle(page)
