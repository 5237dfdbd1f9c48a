"""Pictures of maps: how tissue fails over two of its quantities, and a number of each point.

Each point is a cell of the picture, whose edges are half-way to its neighbours.
"""
import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from .. import InputError
from .._library import MEMBERS
from .curves import solved
from .page import (FIELD, HEIGHT, INK, WIDTH, Page, Range, bar, bar_width, legend, limits, near, pressure_unit,
                   settle, styled)

EMPTY = "#ededed"  #: a point that is not computed
#: Okabe and Ito's colours, some of them lighter
MODES = {"none": ("no failure", "#cce6c7"), "separation": ("cells separate", "#57b5e8"),
         "rupture": ("walls rupture", "#d65e00"), "buckling": ("walls buckle", "#cc99c7"),
         "turgor_loss": ("turgor is lost", "#f5de73"), "unknown": ("not known", "#ffffff")}
LABELS = {"turgor": "turgor $p$", "cohesion": "cohesion $g$", "shear": "shear $F_{12}$", "load_factor": "load factor",
          "wall_strength": "strength of the wall", "lamella_normal": "normal strength of the lamella",
          "lamella_shear": "shear strength of the lamella", "wall_thickness": "wall thickness $t$"}
FIELD_LABELS = {"load_factor": "load factor at failure", "open_fraction": "open share of the interface",
                "debonded_fraction": "debonded share of the interface", "max_gap": "largest gap / apothem",
                "max_traction": "largest lamella traction", "max_wall_tension": "largest wall tension",
                "ellipticity": "ellipticity of the tangent", "kinked_fraction": "kinked share of the walls"}
OF_LOAD = ("shear", "load_factor")


class Side:
    """One axis: quantity, unit, label, values of its points, edges of their cells."""

    def __init__(self, source, letter):
        text = lambda name, *default: source.text(f"map/{letter}/{name}", *default)
        self.quantity, self.unit, self.is_log = text("quantity"), text("unit"), text("spacing") == "log"
        self.values = source.array(f"map/{letter}/values", finite=True).astype(float).ravel()
        if len(self.values) < 2:
            raise InputError(f"{source.path}: map/{letter}/values is damaged: an axis has two points or more")
        at = np.log10(self.values) if self.is_log else self.values
        edges = np.concatenate([[1.5 * at[0] - 0.5 * at[1]], (at[1:] + at[:-1]) / 2, [1.5 * at[-1] - 0.5 * at[-2]]])
        self.edges = 10 ** edges if self.is_log else edges
        words = LABELS.get(self.quantity) or text("label", self.quantity.replace("_", " "))
        self.label = words if self.unit == "1" else f"{words} ({self.unit})"


class Map:
    """Axes, and of each point [y, x] mode and load factor at failure."""

    def __init__(self, source):
        self.source, self.x, self.y = source, Side(source, "x"), Side(source, "y")
        self.shape = len(self.y.values), len(self.x.values)
        names = [name for name in source.text("map/modes").split("\n") if name]
        number = source.array("map/mode", *self.shape).astype(int)
        known = [list(MODES).index(name) if name in MODES else len(MODES) - 1 for name in names] or [0]
        self.mode = np.where(number < 0, -1, np.take(known, np.clip(number, 0, len(known) - 1)))
        self.load_factor = source.array("map/load_factor", *self.shape).astype(float)

    def of_records(self, name, default=np.nan):
        """A member of the records, at their points; states without an answer are not known."""
        r, keys = self.source.responses, self.source.keys
        values = np.full(self.shape, default, float)
        inside = (keys >= 0) & (keys < values.size)
        known = solved(r)
        values.ravel()[keys[inside]] = np.where(known, np.asarray(name(r), float), np.nan)[inside]
        return values


def _scales(axes, m):
    axes.set(xlabel=m.x.label, ylabel=m.y.label)
    if m.x.is_log:
        axes.set_xscale("log")
    if m.y.is_log:
        axes.set_yscale("log")
    axes.set(xlim=m.x.edges[[0, -1]], ylim=m.y.edges[[0, -1]])
    axes.grid(False)


def _onset(axes, m):
    """The load at which each path along the axis of the load fails."""
    along_x = m.x.quantity in OF_LOAD
    load, other = (m.x, m.y) if along_x else (m.y, m.x)
    last = (slice(None), -1) if along_x else (-1, slice(None))
    at = m.load_factor[last]
    onset = m.of_records(lambda r: r.F[:, 0, 1])[last] if load.quantity == "shear" else at
    onset = np.where(~np.isnan(at) & (onset >= load.edges[0]), onset, np.nan)
    axes.plot(*((onset, other.values) if along_x else (other.values, onset)), color=INK, linewidth=1.0, zorder=3)


def _contours(page, axes, m):
    """Contours of the load factor among points of the same mode: between modes it may jump."""
    if not np.isfinite(m.load_factor).any():
        return
    levels = MaxNLocator(6, steps=[1, 2, 5, 10]).tick_values(np.nanmin(m.load_factor), np.nanmax(m.load_factor))
    labelled = set()
    for mode in np.unique(m.mode[m.mode >= 0]):
        inside = np.where(m.mode == mode, m.load_factor, np.nan)
        if np.isfinite(inside).sum() < 3 or min(inside.shape) < 2:
            continue
        drawn = axes.contour(m.x.values, m.y.values, np.ma.masked_invalid(inside), levels, colors=INK, linewidths=0.7)
        for level, lines in zip(drawn.levels, drawn.allsegs):
            longest = max(lines, key=len, default=())
            if len(longest) > 1 and level not in labelled:
                labelled.add(level)
                near(page, axes, *longest[len(longest) // 2], f"{level:g}", away=2)


def modes(page, axes, m, more=()):
    """How each point fails; more: lines that the legend also names."""
    shown = ListedColormap([EMPTY] + [colour for _, colour in MODES.values()])
    axes.pcolormesh(m.x.edges, m.y.edges, m.mode, cmap=shown, vmin=-1.5, vmax=len(MODES) - 0.5, zorder=1)
    unknown = np.argwhere(m.mode == len(MODES) - 1)
    axes.plot(m.x.values[unknown[:, 1]], m.y.values[unknown[:, 0]], "x", color=INK, markersize=3.6, markeredgewidth=0.7)
    _scales(axes, m)
    has_load = m.x.quantity in OF_LOAD or m.y.quantity in OF_LOAD
    if has_load:
        _onset(axes, m)
    else:
        _contours(page, axes, m)
    present = [k for k in range(len(MODES)) if (m.mode == k).any()]
    handles = [Patch(facecolor=colour, edgecolor=INK, linewidth=0.4, label=label)
               for k, (label, colour) in enumerate(MODES.values()) if k in present]
    handles.append(Line2D([], [], color=INK, linewidth=1.0, label="onset" if has_load else "load factor"))
    legend(page, axes, handles + list(more), handlelength=1.0)


def _single():
    return [name for name, kind, count, *_ in MEMBERS if count == 1 and kind in "fi"]


@styled
def draw(source, options, state=None, field=None):
    """How tissue fails, and `field` of each point: load_factor, or a single number of the records."""
    if state is not None:
        raise InputError("--state: a map is drawn as a whole")
    m, name = Map(source), field or "load_factor"
    if name == "load_factor":
        values, unit = m.load_factor, None
    elif name not in _single():
        raise InputError(f"--field {name}: a map has load_factor and the single numbers of its records, such as "
                         "max_wall_tension, max_traction, open_fraction, max_gap, energy")
    else:
        values, unit = m.of_records(lambda r: getattr(r, name)), source.responses.help(name).rsplit("(", 1)[1][:-1]
        if unit == "Pa":
            unit, size = pressure_unit(values)
            values = values / size
        elif unit == "m":
            values, unit = values / source.apothem, None if name in FIELD_LABELS else "apothems"
        unit = None if unit == "1" else unit
    page = Page(WIDTH, HEIGHT, options)
    norm = Range(values.ravel(), options)
    width, height = page.size
    wide = (width - 32 - bar_width(norm)) / 2
    top = 6 + page.head("", options)
    left = page.chart(9, top, wide, height - top - 6)
    modes(page, left, m)
    settle(page)
    box = left.get_position()
    right = page.add_axes((box.x0 + (wide + 14) / width, box.y0, box.width, box.height))
    right.set_facecolor(EMPTY)
    right.pcolormesh(m.x.edges, m.y.edges, np.ma.masked_invalid(values), cmap=FIELD, norm=norm, shading="flat")
    _scales(right, m)
    limits(left, options)
    limits(right, options)
    label = FIELD_LABELS.get(name, name.replace("_", " "))
    frame = right.get_position()
    label = f"{label} ({unit})" if unit else label
    bar(page, frame.x1 * width, (1 - frame.y1) * height, frame.height * height, norm, label)
    return page
