"""Pictures of response databases: a slice through the table, or the records in strain space.

Slice. F = U has principal logarithmic strains e1, e2 along two fixed axes. With n = (cos a, sin a) along the first,
U = exp(e1) n n + exp(e2) m m, m normal to n. A node with mean strain m, isochoric strain r and first axis at the angle
b lies r sin 2(b - a) out of the slice and is drawn at e1, e2 = m +- r cos 2(b - a). Rotations and mirrors of a regular
lattice give six images of it.
"""
import numpy as np
from matplotlib import ticker
from matplotlib.legend_handler import HandlerTuple
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon, Rectangle
from matplotlib.path import Path

from .. import Database, InputError, quantity
from .curves import solved
from .page import (FIELD, HEIGHT, INK, SMALL, WIDTH, Page, Range, bar, bar_width, columns, number, pressure_unit, ratio,
                   settle, styled, ticks)

SAMPLES = 180  #: per axis
REACH = 0.02  #: of the width of the slice: distance up to which nodes are drawn
MARGIN = 0.12  #: of the sample's width, around it
ROUNDING = 1e-9  #: of a suction, over C1 + C2
MANY = 1500  #: marks beyond which they are an image within vector files
FAILURE = "#cc260d"
FRAME, HEADER, BELOW, GLYPH, NODE = 152, 54, 36, 19, 5  #: points
RESPONDS, FLOATING, INACCURATE, KINK, NOTHING = range(5)
#: label, fill and hatching of points without a good response
LOOKS = {FLOATING: ("cells touch no one", None, "\\\\\\\\"), INACCURATE: ("estimated error above", None, "//////"),
         KINK: ("change of branch or failed node", "#b3b3b3", "xxxxxx"), NOTHING: ("no nodes around", "#ebebeb", "")}
SLICE_OPTIONS = ("angle", "suction", "turgor", "accuracy")
SOUND, ELSEWHERE, FAILED = range(3)


def principal(F):
    """Principal logarithmic strains [n, 2], e1 >= e2, of the plane, and the angle of the first axis to X1 before the
    deformation."""
    C = np.einsum("nki,nkj->nij", F[:, :, :2], F[:, :, :2])
    mean, half = (C[:, 0, 0] + C[:, 1, 1]) / 2, (C[:, 0, 0] - C[:, 1, 1]) / 2
    radius = np.hypot(half, C[:, 0, 1])
    with np.errstate(all="ignore"):
        strain = np.log(np.stack([mean + radius, np.where(mean > radius, mean - radius, np.nan)], axis=1)) / 2
    return strain, np.arctan2(2 * C[:, 0, 1], C[:, 0, 0] - C[:, 1, 1]) / 2


def size(P):
    """Frobenius norm of the known components."""
    return np.sqrt(np.nansum(np.square(P), axis=(-1, -2)))


class Slice:
    """Responses [SAMPLES, SAMPLES], e2 along the first axis, and the nodes that lie in the slice."""

    def __init__(self, source, database, angle, suction, turgor, accuracy):
        tissue, self.parts = source.tissue, source.parts
        self.hexagons = "tissue" not in tissue
        self.orientation = float(tissue.get("orientation", 0)) if self.hexagons else 0.0
        self.angle = 0 if angle is None else quantity(angle, "angle")
        self.accuracy = float(source.file.attrs["accuracy"]) if accuracy is None else float(accuracy)
        self.source, self.unit = source, source.stress_unit
        self.level = database.levels
        self.nodes = np.flatnonzero(self.level >= 0)
        if not len(self.nodes):
            raise InputError(f"{source.path}: its table holds no nodes to draw")
        self.responses = source.responses
        self.suction = self.responses.turgor + self.responses.cohesion
        self._choose_load(suction, turgor)
        self._choose_box()
        self._collect()
        self._query(database)

    def _choose_load(self, suction, turgor):
        if suction is not None and not self.parts:
            raise InputError(f"--suction {suction}: bonded tissue has none; give its --turgor")
        if turgor is not None and self.parts:
            raise InputError(f"--turgor {turgor}: slices of contact tissue have a --suction, which is turgor + "
                             "cohesion")
        text, own = suction if self.parts else turgor, self.suction[self.nodes]
        wanted, nodes = (own.min() + own.max()) / 2, self.nodes[self.level[self.nodes] == 0]
        if text is not None:
            wanted, nodes = quantity(text, "stress"), self.nodes
            if self.parts and not own.min() - ROUNDING * self.unit <= wanted <= own.max() + ROUNDING * self.unit:
                raise InputError(f"--suction {text}: the nodes of {self.source.path} cover {own.min() / 1e6:.4g} to "
                                 f"{own.max() / 1e6:.4g} MPa")
        if not len(nodes):
            raise InputError(f"{self.source.path}: its table lacks all coarse nodes")
        node = nodes[np.abs(self.suction[nodes] - wanted).argmin()]
        self.node_suction, self.cohesion = self.suction[node], self.responses.cohesion[node]
        self.turgor = self.responses.turgor[node] if text is None else wanted - self.cohesion

    def _choose_box(self):
        """The scene's sample box, else the range of the nodes, with a margin."""
        import yaml
        self.box = None
        try:
            stretch = (yaml.safe_load(self.source.scene or "") or {})["sample"]["stretch"]
            self.box = low, high = float(stretch["min"]), float(stretch["max"])
        except (KeyError, TypeError, ValueError, yaml.YAMLError):
            strain = principal(self.responses.F[self.nodes])[0]
            low, high = np.nanmin(strain), np.nanmax(strain)
        margin = MARGIN * max(high - low, 1e-3)
        self.low, self.high = low - margin, high + margin

    def _collect(self):
        """Images of nodes within reach: e1, e2, level and kind."""
        tissue, r = self.source.tissue, self.responses
        same = tissue.get("cells", [1, 1])
        images = 6 if same[0] == same[1] and not {"cell", "tissue"} & set(tissue) else 1
        chosen = self.nodes[np.abs(self.suction[self.nodes] - self.node_suction) <= ROUNDING * self.unit]
        strain, angle = principal(r.F[chosen])
        sound = r.stable[chosen] & (r.branch[chosen] == 0)
        kind = np.where(~solved(r[chosen]), FAILED, np.where(sound, SOUND, ELSEWHERE))
        mean, shape = strain.mean(axis=1), (strain[:, 0] - strain[:, 1]) / 2
        self.at, self.at_level, self.kind = np.empty((0, 2)), np.empty(0, int), np.empty(0, int)
        for i in range(images):
            own = angle - self.orientation
            turn = 2 * ((own if i < 3 else -own) + np.pi / 3 * (i % 3) - self.angle)
            at = np.stack([mean + shape * np.cos(turn), mean - shape * np.cos(turn)], axis=1)
            with np.errstate(invalid="ignore"):
                near = (np.abs(shape * np.sin(turn)) <= REACH * (self.high - self.low)) & \
                    (at.max(axis=1) <= self.high) & (at.min(axis=1) >= self.low)
            self.at = np.vstack([self.at, at[near]])
            self.at_level = np.append(self.at_level, self.level[chosen][near])
            self.kind = np.append(self.kind, kind[near])

    def _query(self, database):
        e = self.low + (self.high - self.low) * (np.arange(SAMPLES) + 0.5) / SAMPLES
        u1, u2 = np.exp(e)[None, :], np.exp(e)[:, None]
        a = self.orientation + self.angle
        c, s = np.cos(a), np.sin(a)
        F = np.zeros((SAMPLES, SAMPLES, 3, 3))
        F[..., 0, 0], F[..., 1, 1], F[..., 2, 2] = c * c * u1 + s * s * u2, s * s * u1 + c * c * u2, 1
        F[..., 0, 1] = F[..., 1, 0] = c * s * (u1 - u2)
        r = database.query(F, self.turgor, self.cohesion, accuracy=np.inf)
        known = solved(r)
        of = lambda values: np.where(known, values, np.nan)
        self.potential = of(r.energy + r.turgor * (r.lumen_fraction + r.opening_fraction))
        self.stress, self.error = of(size(r.P)), of(100 * r.error_estimate)
        self.volume = of(100 * (r.opening_fraction if self.parts else r.lumen_fraction))
        kink = np.char.find(r.reason.astype(str), "not all of one kind") >= 0
        self.verdict = np.where(~known, np.where(kink, KINK, NOTHING),
                                np.where(self.error > 100 * self.accuracy, INACCURATE,
                                         np.where(r.floating_cells > 0, FLOATING, RESPONDS)))


def _node_style(kind, level):
    return {"marker": "oDx"[kind], "markersize": NODE * 0.9 * 0.75 ** level, "linestyle": "none",
            "color": INK if kind == SOUND else FAILURE, "markerfacecolor": "white"}


def _hatch(axes, s, inside, look, points):
    """Lines over the samples; below each dark one a light one, so that they are seen on any colour."""
    _, fill, hatch = look
    edges = s.low + (s.high - s.low) * np.arange(SAMPLES + 1) / SAMPLES
    boxes = []
    for row in np.flatnonzero(inside.any(axis=1)):
        ends = np.flatnonzero(np.diff(np.concatenate([[0], inside[row].astype(int), [0]])))
        low, high = edges[row:row + 2]
        for left, right in edges[ends].reshape(-1, 2):
            boxes.append([(left, low), (right, low), (right, high), (left, high)])
    clip = Path.make_compound_path(*(Path(box + box[:1], closed=True) for box in boxes))
    width = s.high - s.low
    start = np.arange(s.low - width, s.high, width * (7 if len(hatch) < 5 else 4.5) / points)
    lines = [[(x, s.low), (x + width, s.high)] for x in start if set(hatch) & set("/x")]
    lines += [[(x, s.high), (x + width, s.low)] for x in start if set(hatch) & set("\\x")]
    for colour, thick in (("white", 0.6),) if fill else (("white", 0.9), (INK, 0.4)):
        drawn = axes.add_artist(LineCollection(lines, colors=colour, linewidths=thick, zorder=2))
        drawn.set_clip_path(clip, axes.transData)


def _panel(page, place, s, values, norm, label, axis_labels, with_nodes, options):
    axes = page.area(*place)
    axes.set(xlabel=axis_labels[0], ylabel=axis_labels[1], xlim=(s.low, s.high), ylim=(s.low, s.high))
    axes.xaxis.set_major_locator(ticks(8))
    axes.yaxis.set_major_locator(ticks(8))
    axes.grid(False)
    extent = (s.low, s.high, s.low, s.high)
    colours = FIELD(norm(np.ma.masked_invalid(values)))
    colours[~np.isfinite(values)] = 1
    for verdict, (_, fill, _) in LOOKS.items():
        if fill:
            colours[s.verdict == verdict] = [int(fill[k:k + 2], 16) / 255 for k in (1, 3, 5)] + [1]
    axes.imshow(colours, origin="lower", extent=extent, interpolation="nearest", aspect="auto", zorder=1)
    for verdict, look in LOOKS.items():
        if look[2] and (s.verdict == verdict).any():
            _hatch(axes, s, s.verdict == verdict, look, place[2])
    if s.box:
        for colour, width, dashes in (("white", 1.2, "-"), (INK, 0.7, (0, (3.2, 1.8)))):
            axes.add_patch(Rectangle((s.box[0], s.box[0]), s.box[1] - s.box[0], s.box[1] - s.box[0], facecolor="none",
                                     edgecolor=colour, linewidth=width, linestyle=dashes, zorder=3))
    for level in sorted(set(s.at_level)) if with_nodes else ():
        for kind in (SOUND, ELSEWHERE, FAILED):
            at = s.at[(s.at_level == level) & (s.kind == kind)]
            axes.plot(*at.T, **_node_style(kind, level), rasterized=len(s.at) > MANY, zorder=4)
    drawn = bar(page, place[0] + place[2], place[1], place[3], norm, label)
    if label.startswith("estimated error"):  # the bar tells numbers, not their logarithms
        drawn.set_major_locator(ticker.MultipleLocator(1))
        drawn.set_major_formatter(lambda value, _: f"{10 ** value:g}")


def _legend(page, s, width):
    handles, labels = [], []
    for verdict, (label, fill, hatch) in LOOKS.items():
        if (s.verdict == verdict).any():
            handles.append(Patch(facecolor=fill or FIELD(0.6), hatch=hatch, edgecolor=INK, linewidth=0.4))
            labels.append(f"{label} {number(100 * s.accuracy)} %" if verdict == INACCURATE else label)
    where = f" at {number(s.node_suction / 1e6)} MPa" if s.parts and abs(s.turgor + s.cohesion - s.node_suction) > \
        1e-9 * abs(s.node_suction) else ""
    for kind, words in enumerate(("node", "node on another branch", "node without an answer")):
        levels = sorted(set(s.at_level[s.kind == kind]))
        if levels:
            handles.append(tuple(Line2D([], [], **_node_style(kind, level)) for level in levels))
            labels.append(f"{words}{where}{', coarse to fine' if len(levels) > 1 else ''}")
    if s.box:
        handles.append(Patch(facecolor="none", edgecolor=INK, linewidth=0.7, linestyle=(0, (3.2, 1.8))))
        labels.append("box of the scene's sample")
    page.legend(handles, labels, loc="upper left", bbox_to_anchor=(7 / page.size[0], 1 - 20 / page.size[1]),
                ncols=columns(labels, width), handler_map={tuple: HandlerTuple(None, pad=0.6)})


def _glyph(page, s):
    """A cell, where it is a hexagon, and the two principal axes."""
    x, y = page.size[0] - 1.6 * GLYPH, HEADER / 2 + 2
    axes = page.area(x - 1.6 * GLYPH, y - 1.6 * GLYPH, 3.2 * GLYPH, 3.2 * GLYPH, facecolor="none")
    axes.set(xlim=(-1.6, 1.6), ylim=(-1.6, 1.6))
    axes.set_axis_off()
    around = s.orientation + np.pi / 6 + np.arange(6) * np.pi / 3
    if s.hexagons:
        axes.add_patch(Polygon(0.8 * np.stack([np.cos(around), np.sin(around)], axis=1), facecolor="#cce6c7",
                               edgecolor="#738c6e", linewidth=1.6))
    for name, turn in (("1", 0), ("2", np.pi / 2)):
        n = np.array([np.cos(s.orientation + s.angle + turn), np.sin(s.orientation + s.angle + turn)])
        axes.annotate("", n, -n, arrowprops={"arrowstyle": "->", "color": INK, "linewidth": 0.9, "shrinkA": 0,
                                             "shrinkB": 0, "mutation_scale": 6})
        axes.text(*(1.3 * n), name, ha="center", va="center", size=SMALL)


def _slice_page(source, choice, options):
    s = Slice(source, Database(source.path), **choice)
    page = Page(WIDTH, HEADER + 2 * (FRAME + BELOW), options)
    load, name = (s.turgor + s.cohesion, "suction") if s.parts else (s.turgor, "turgor")
    count = len(s.nodes)
    page.head(f"Table of {count} node{'s' if count != 1 else ''}: slice at {name} {number(load / 1e6)} MPa", options)
    _legend(page, s, page.size[0] - 4 * GLYPH)
    _glyph(page, s)
    unit, one = pressure_unit(s.potential)
    stress_unit, stress_one = pressure_unit(s.stress)
    limit = np.log10(100 * s.accuracy)
    with np.errstate(divide="ignore"):
        error = np.log10(np.maximum(s.error, 1e-12))
    # two decades below the accuracy and one above it, so that pictures of tables are comparable
    error_range = Range(error.ravel(), {"range": (limit - 2, limit + 1)})
    panels = [(s.potential / one, f"{'potential' if s.parts else 'energy of the walls'} $\\Phi$ ({unit})", None),
              (s.stress / stress_one, f"stress $\\Vert P\\Vert$ ({stress_unit})", None),
              (error, "estimated error of $P$ (%)", error_range),
              (s.volume, f"{'gaps' if s.parts else 'lumens'} (% of $V_0$)", None)]
    degrees, axis = np.degrees(s.angle), "face normal" if s.hexagons else "$X_1$"
    degrees += 0 if s.hexagons else np.degrees(s.orientation)
    labels = [f"log. strain $e_{k + 1}$, {ratio(degrees + 90 * k)}° to {axis}" for k in (0, 1)]
    width, height = (page.size[0] - 18) / 2, (page.size[1] - HEADER) / 2
    norms = [norm or Range(values.ravel(), options) for values, _, norm in panels]
    room = max(map(bar_width, norms))
    for k, ((values, label, _), norm) in enumerate(zip(panels, norms)):
        edge = min(width - room - 38, height - BELOW)
        place = 9 + k % 2 * width + 36, HEADER + k // 2 * height + 3, edge, edge
        _panel(page, place, s, values, norm, label, labels, k == 2, options)
    return page


# ---- records ----

def _scatter(axes, x, y, values, norm, labels, marks):
    failed = np.isnan(values)
    many = len(values) > MANY
    axes.scatter(x[~failed], y[~failed], s=marks ** 2, c=values[~failed], cmap=FIELD, norm=norm, linewidths=0,
                 rasterized=many)
    axes.plot(x[failed], y[failed], "x", color=FAILURE, markersize=marks, markeredgewidth=1.2, rasterized=many)
    axes.set(xlabel=labels[0], ylabel=labels[1])


def _records_page(source, field, options):
    if field not in (None, "stress", "turgor"):
        raise InputError(f"--field {field}: a database has stress and turgor")
    r = source.responses
    if r is None or not len(r):
        raise InputError(f"{source.path}: holds no records to draw")
    known, (e, _) = solved(r), principal(r.F)
    values = np.where(known, r.turgor if field == "turgor" else size(r.P), np.nan)
    unit, one = pressure_unit(values)
    values, norm = values / one, None
    norm, n = Range(values, options), len(values)
    outside = int((~np.isfinite(e).all(axis=1)).sum())
    title = f"{n} record{'' if n == 1 else 's'}"
    if (~known).any():
        title += f",  {(~known).sum()} without an answer (crosses)"
    if outside:
        title += f",  {outside} without a strain (not drawn)"
    page = Page(WIDTH, HEIGHT, options)
    page.head(title, options)
    width, height = page.size
    wide, marks = (width - 28 - bar_width(norm)) / 2, 1.6 if n > 3000 else 2.6 if n > 300 else 4
    left, right = page.chart(9, 21, wide, height - 27), page.chart(19 + wide, 21, wide, height - 27)
    _scatter(left, e.mean(axis=1), (e[:, 0] - e[:, 1]) / 2, values, norm,
             ("mean strain $m$ = ½ ln $J$", "isochoric strain $r$"), marks)
    _scatter(right, e[:, 0], e[:, 1], values, norm,
             ("larger principal log. strain $e_1$", "smaller principal log. strain $e_2$"), marks)
    settle(page)
    frame = right.get_position()
    bar(page, frame.x1 * width, (1 - frame.y1) * height, frame.height * height, norm,
        f"turgor $p$ ({unit})" if field == "turgor" else f"$\\Vert P\\Vert$ ({unit})")
    return page


@styled
def draw(source, options, state=None, field=None, angle=None, suction=None, turgor=None, accuracy=None):
    """With a table a slice through it: the first principal axis at `angle` ("15 deg") to the normal of face 0, at a
    suction (contact) or turgor (bonded) such as "0.02 MPa", and the accuracy that is asked for. Without one, and with
    `field` (stress, turgor), the records in the plane of their principal strains."""
    if state is not None:
        raise InputError("--state: a database is drawn as a whole")
    choice = {"angle": angle, "suction": suction, "turgor": turgor, "accuracy": accuracy}
    if source.has("table/grid") and field is None:
        return _slice_page(source, choice, options)
    refuse(source.path, choice)
    return _records_page(source, field, options)


def refuse(path, options):
    """InputError where an option chooses a slice of what has no table."""
    for name in SLICE_OPTIONS:
        if options.get(name) is not None:
            raise InputError(f"--{name} {options[name]}: chooses a slice through the table of a database; what is "
                             f"drawn of {path} has none")
