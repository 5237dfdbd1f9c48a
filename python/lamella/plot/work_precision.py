"""Work-precision diagrams: error against core-seconds, both logarithmic, a panel for each kind of error.

A line joins the settings of one family; what failed is not there. A point has its setting beside it where there is
room: the best settings first, then the planned one.
"""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter

from .page import INK, LINES, SMALL, WIDTH, Page, mark, near, occupy, settle, styled
from .read import object_of

PANEL, GAP, MARGIN, LEGEND, NOTES = 178, 14, 8, 34, 70  #: points
LABEL = 6.0
KINDS = {"P": ("error of $P$ (%)", 100), "tangent": ("error of the tangent (%)", 100), "opening": ("", 1),
         "macro": ("error of reaction and work (%)", 100)}
FAMILIES = {"strategy": ("strategy", 3, "D"), "sharpness": ("law of contact", 4, "s"),
            "cells": ("cells per period", 5, "^"), "tolerance": ("Newton tolerance", 6, "v"),
            "database": ("table", 6, "D")}
NOTE = ("Beside a point: elements along a face, or its setting.", "Ring: as the scene and the planner say.",
        "Thick grey line: nothing measured has less error in less time.",
        "Grey area: below ten times the error of the reference,", "which is not ranked.",
        "Bars: fastest to slowest run. What failed is not there.")


def _group(setting):
    """Settings of one line."""
    family, mesh = setting["family"], setting["mesh"]
    return {"mesh": (family, mesh["through"], mesh["grading"] or 0),
            "macro": (family, setting.get("response"))}.get(family, (family,))


def _look(group, meshes):
    """Label and style of a line."""
    family = group[0]
    if family == "mesh":
        graded = group[2] > 0
        return f"mesh, {group[1]} through" + (f", graded {group[2]:g}" if graded else ""), {
            "color": LINES[meshes % 3], "marker": "o", "markerfacecolor": "white" if graded else None,
            "linestyle": (0, (3.2, 1.8)) if graded else "-"}
    if family == "macro":
        return f"body: {group[1]}", {"color": LINES[5 if group[1] == "cache" else 6], "marker": "s"}
    label, colour, marker = FAMILIES.get(family, (family, 3, "D"))
    return label, {"color": LINES[colour], "marker": marker}


def _points(settings, kind, scale, floor):
    """Measured settings of each group: time (median, fastest, slowest), error, and the setting."""
    groups = {}
    for s in settings:
        error = (s.get("error") or {}).get(kind)
        direct = s["family"] == "macro" and s.get("response") == "direct"
        if not s["runs"] or direct or error is None or error["max"] is None or (kind == "macro" and s["planned"]):
            continue
        t = s["core_seconds"]
        groups.setdefault(_group(s), []).append((t["median"], t["min"], t["max"], max(scale * error["max"], floor),
                                                 error["optimal"], s))
    return groups


def _front(axes, points):
    """Joins the best by steps: for each point above them a setting has no larger error in no more time."""
    best = sorted((p[0], p[3]) for points_of in points.values() for p in points_of if p[4])
    if best:
        axes.step(*np.array(best).T, where="post", color="#c7c7c7", linewidth=3.5, zorder=1.5)


def _decade(value, _):
    return f"{value:g}" if 1e-3 <= value < 1e4 else f"$10^{{{np.log10(value):.0f}}}$"


def _panel(page, axes, data, kind, label, scale, looks):
    settings = data["settings"]
    reference = ((data.get("reference") or {}).get("error") or {}).get(kind) if kind != "macro" else None
    errors = [e["max"] for s in settings if (e := (s.get("error") or {}).get(kind)) and e["max"]]
    points = _points(settings, kind, scale, scale * max(min(errors, default=0), reference or 0) or 1e-300)
    axes.set(xscale="log", yscale="log", xlabel="time (core-s)", ylabel=label)
    _front(axes, points)
    labels = []
    for group, line in points.items():
        at = np.array([p[:4] for p in line])
        style = looks[group][1]
        axes.plot(at[:, 0], at[:, 3], linewidth=0.7, markersize=4.2, zorder=2, **style)
        axes.hlines(at[:, 3], at[:, 1], at[:, 2], color=style["color"], linewidth=0.5, zorder=2)
        for time, _, _, error, optimal, s in line:
            if s["planned"] and s["family"] == "mesh":  # other families have it at the same place
                axes.plot(time, error, "o", color=INK, markerfacecolor="none", markersize=8, zorder=3)
            occupy(page, axes, time, error, 4.2)
            labels.append((0 if optimal else 1 if s["planned"] else 2, time, error, s, style["color"]))
    for _, time, error, s, colour in sorted(labels, key=lambda one: one[0]):
        near(page, axes, time, error, s.get("mark", s["setting"]), color=colour, size=LABEL,
             bbox={"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 0.5})
    bodies = [s for s in settings if kind == "macro" and s["family"] == "macro"]
    direct = next((s for s in bodies if s["planned"] and s["runs"]), None)
    if direct:
        mark(page, axes, direct["core_seconds"]["median"], "direct (the reference here)", INK, "-")
    for low, high, widen in ((*axes.get_xlim(), axes.set_xlim), (*axes.get_ylim(), axes.set_ylim)):  # whole decades
        widen(10.0 ** np.floor(np.log10(low)), 10.0 ** np.ceil(np.log10(high)))
    if reference:
        axes.axhspan(1e-300, 10 * scale * reference, color="#ededed", zorder=0.4)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(_decade)
        axis.set_minor_formatter(NullFormatter())


@styled
def draw(path, options):
    """The diagram of a file tradeoff.json that `lamella tradeoff -o` has written."""
    data = object_of(path, "tradeoff", {"settings"})
    settings = data["settings"]
    kinds = [kind for kind in KINDS if _points(settings, kind, 1, 1e-300)]
    looks = {}
    for s in settings:
        group = _group(s)
        if s["runs"] and group not in looks and group != ("macro", "direct"):
            looks[group] = _look(group, len(looks))
    rows = max((len(kinds) + 1) // 2, 1)
    below = LEGEND + MARGIN + rows * (PANEL + GAP)
    page = Page(WIDTH, below if len(kinds) % 2 else below + NOTES, options)
    width, wide = page.size[0], (page.size[0] - 2 * MARGIN - GAP) / 2
    place = lambda k: (MARGIN + k % 2 * (wide + GAP), MARGIN + LEGEND + k // 2 * (PANEL + GAP))
    for k, kind in enumerate(kinds):
        label, scale = KINDS[kind]
        label = label or f"error of the {data.get('volume', 'opening')} fraction"
        _panel(page, page.chart(*place(k), wide, PANEL), data, kind, label, scale, looks)
    lines = [Line2D([], [], linewidth=0.7, markersize=4.2, **style) for _, style in looks.values()]
    page.legend(lines, [label for label, _ in looks.values()], loc="upper left", ncols=4,
                bbox_to_anchor=(MARGIN / width, 1 - MARGIN / page.size[1] / 2))
    x, y = place(len(kinds)) if len(kinds) % 2 else (MARGIN, below)
    for k, note in enumerate(NOTE):
        page.text((x + 30 * (len(kinds) % 2)) / width, 1 - (y + 1.6 * SMALL * (k + 0.5)) / page.size[1], note,
                  va="center", size=SMALL)
    return settle(page)
