"""Pictures of FE2 runs and of processes of bodies: the deformed body at a step with a field, the cells at chosen
points, and the reactions of its sides, or charts against time."""
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle, PathPatch, Polygon, Rectangle

from .. import InputError
from . import mesh as meshes
from .page import (DARK, DASHES, FIELD, HEIGHT, LINES, RED, ROW, SMALL, WIDTH, Page, Range, bar, bar_width, legend,
                   limits, mark, ratio, settle, styled)
from .strip import alone, chosen, strip as draw_strip
from .timeline import TimeLine, charts, film_page
from .tissue import FIELDS as WALL_FIELDS, Cells, Frame, Key, View

_tensor = lambda name, i, j: lambda step: step(name, 9).reshape(-1, 3, 3)[:, i, j]


def _von_mises(step):
    s = step("cauchy", 9).reshape(-1, 3, 3)
    s = s - np.trace(s, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
    return np.sqrt(np.maximum(1.5 * np.einsum("eij,eji->e", s, s), 0))


_scalar = lambda name: lambda step: step(name, 1).ravel()
#: label, unit, and values of elements by the datasets of a step
FIELDS = {
    "von_mises": ("von Mises Cauchy stress", "MPa", _von_mises),
    "mean_stress": ("mean Cauchy stress", "MPa",
                    lambda step: np.trace(step("cauchy", 9).reshape(-1, 3, 3), axis1=1, axis2=2) / 3),
    **{f"cauchy_{i + 1}{j + 1}": (f"Cauchy stress $\\sigma_{{{i + 1}{j + 1}}}$", "MPa", _tensor("cauchy", i, j))
       for i, j in ((0, 0), (0, 1), (1, 1))},
    **{f"P_{i + 1}{j + 1}": (f"nominal stress $P_{{{i + 1}{j + 1}}}$", "MPa", _tensor("P", i, j))
       for i, j in ((0, 0), (0, 1), (1, 0), (1, 1))},
    "J": ("volume ratio $J$", None, lambda step: np.linalg.det(step("F", 9).reshape(-1, 3, 3))),
    **{name: (label, unit, _scalar(name)) for name, label, unit in (
        ("lumen_fraction", "lumen fraction", None),
        ("opening_fraction", "opening fraction", None),
        ("debonded_fraction", "debonded fraction", None),
        ("turgor", "turgor $p$", "MPa"),
        ("open_fraction", "open fraction", None),
        ("max_gap", "largest gap, mean over points", "apothems"),
        ("max_gap_max", "largest gap", "apothems"),
        ("face_unloading_max", "unloading of faces, largest", None),
        ("wall_tension", "wall tension", "MPa"),
        ("wall_tension_max", "wall tension, largest", "MPa"),
        ("lamella_normal", "normal traction of the lamella", "MPa"),
        ("lamella_normal_max", "normal traction of the lamella, largest", "MPa"),
        ("lamella_shear", "shear traction of the lamella", "MPa"),
        ("lamella_shear_max", "shear traction of the lamella, largest", "MPa"),
        ("ellipticity_min", "ellipticity of the tangent, smallest", "MPa"),
        ("wall_tension_ratio_max", "wall tension over strength, largest", None),
        ("lamella_normal_ratio_max", "normal traction over strength, largest", None),
        ("lamella_shear_ratio_max", "shear traction over strength, largest", None),
        ("water_potential", "water potential of cells $\\psi_c$", "MPa"),
        ("apoplast_potential", "water potential of the apoplast $\\psi_a$", "MPa"),
        ("broken_fraction", "broken share of the lamella", None),
        ("broken_fraction_max", "broken share of the lamella, largest", None),
        ("broken_face_max", "broken share of a face family, largest", None),
        ("stored", "energy stored", "kJ/m³"),
        ("dissipated", "energy dissipated", "kJ/m³"),
        ("released", "energy released in jumps", "kJ/m³"),
        ("error_estimate", "estimated error of the stress", None),
        ("interpolated", "share of interpolated responses", None))},
}
RIGID, RIGID_WIDTH = "#bdbdc4", 5  #: of plates, indenters and grips; points
PLATE_SHARE, INDENTER_SHARE = 0.05, 0.25  #: of the body's size that a plate takes beside it, and at most an indenter
ZOOM_HEIGHT, CURVE_HEIGHT, ZOOM_GAP = 236, 150, 9  #: points, of a page with zooms
ROUNDING = 1e-6  #: of the largest reaction: a smaller one, as of a roller's free component, is rounding
NOTHING = 1e-9  #: of C1 + C2 over the body's size: smaller reactions, as of a free body, are rounding, too


class Reactions:
    """What the file has of each step: load factor, reactions [step, side, 2] in `unit`, and the displacement of the
    loaded side in mm, if there is one."""

    def __init__(self, source, steps):
        self.sides = [name for name in source.text("macro/boundaries").split("\n") if name]
        read = lambda name, columns: self._curve(source, name, steps, columns)
        n = len(self.sides)
        self.load = read("load_factor", 1).ravel()
        self.values = read("reaction", 2 * n).reshape(steps, n, 2)
        self.certified = self.margin = self.x = self.pull = None
        if source.has("macro/curve/certified_margin"):
            self.certified = read("certified", 2 * n).reshape(steps, n, 2)
            self.margin = read("certified_margin", 2 * n).reshape(steps, n, 2)
        self.summary = source.object("macro/summary")
        self.unit = self.summary.get("force_unit", "N/mm")  # absent in older files
        size = np.ptp(source.points("macro/nodes"), axis=0).max()  # mm
        self.nothing = NOTHING * 1e-6 * source.stress_unit * (size**2 if self.unit == "N" else size)
        loaded = self.summary.get("loaded") or {}
        self.loaded = loaded.get("boundary")
        if self.loaded in self.sides:
            along, side = np.array(loaded["direction"], float)[:2], self.sides.index(self.loaded)
            self.x = np.nan_to_num(read("displacement", 2 * n).reshape(steps, n, 2)[:, side]) @ along
            self.pull = self.values[:, side] @ along

    @staticmethod
    def _curve(source, name, steps, columns):
        """A run that was stopped may have written one row more than complete steps."""
        values = source.array(f"macro/curve/{name}", None, columns)
        if len(values) < steps:
            raise InputError(f"{source.path}: macro/curve/{name} is damaged: it has not {steps} steps")
        return values[:steps]

    @property
    def peak(self):
        """The step with the largest force of the loaded side, or else load factor; of equal ones the last."""
        size = np.abs(self.load if self.pull is None else self.pull)
        return len(size) - 1 - int(np.argmax(size[::-1]))

    def columns(self):
        """Side, component and label of those that are not rounding."""
        least = max(self.nothing, ROUNDING * np.nanmax(np.abs(self.values), initial=0))
        for s, side in enumerate(self.sides):
            for i in (0, 1):
                if not np.nanmax(np.abs(self.values[:, s, i]), initial=0) < least:
                    yield s, i, f"{side} $R_{i + 1}$"

    def draw(self, page, axes, options):
        """One colour per side; full lines for component 1, hollow squares and dashes for component 2."""
        x = self.load if self.x is None else self.x
        for s, i, label in self.columns():
            axes.plot(x, self.values[:, s, i], color=LINES[s % len(LINES)], marker="os"[i], label=label,
                      markerfacecolor="white" if i else None, linestyle=DASHES if i else "-",
                      markevery=1 if len(x) <= 40 else (len(x) + 19) // 20)
            if self.certified is not None:
                axes.errorbar(x, self.certified[:, s, i], self.margin[:, s, i], fmt="none", ecolor=DARK, elinewidth=0.9,
                              capsize=3)
        axes.set(xlabel="load factor" if self.x is None else f"displacement $u$ of {self.loaded} (mm)",
                 ylabel="reaction $R$ (N)" if self.unit == "N" else "reaction per thickness $R$ (N/mm)")
        for name in ("separation", "rupture"):
            at = (self.summary.get(name) or {}).get("load_factor" if self.x is None else "displacement")
            if isinstance(at, (int, float)):
                mark(page, axes, at, name)
        since = (self.summary.get("mesh_dependent") or {}).get("load_factor")
        if isinstance(since, (int, float)):
            for k in np.flatnonzero(np.abs(self.load - since) <= 1e-9)[:1]:
                mark(page, axes, x[k], "mesh-dependent")
        limits(axes, options)
        legend(page, axes)


class Body:
    """The mesh of the file, and one step of it at a time: x, values of the field, obstacles."""

    def __init__(self, source, field):
        if field is not None and field not in FIELDS:
            raise InputError(f"--field {field}: an fe2 file has {', '.join(FIELDS)}")
        if not source.has("macro/steps"):
            raise InputError(f"{source.path}: holds no complete load step to draw")
        self.source, self.name = source, field or "von_mises"
        label, unit, self.evaluate = FIELDS[self.name]
        self.label = f"{label} ({unit})" if unit else label
        self.steps = source.array("macro/steps").ravel()
        self.nodes = source.points("macro/nodes")
        elements, n = source.elements("macro/elements"), len(self.nodes)
        self.mesh = meshes.Mesh(elements, n, name=f"{source.path}: macro/elements")
        self.reactions = Reactions(source, len(self.steps))
        self.gripped = source.array("macro/gripped", n, 1).ravel() if source.has("macro/gripped") else None
        self.times = TimeLine(source, len(self.steps)) if source.has("process/time") else None

    def row(self, state):
        """Index of a step: a number, "last", or None for the peak."""
        if state is None:
            return self.reactions.peak
        if state == "last":
            return len(self.steps) - 1
        found = np.flatnonzero(self.steps.astype(str) == str(state))
        if not len(found):
            raise InputError(f"--state {state}: {self.source.path} holds steps {self.steps[0]} to {self.steps[-1]}")
        return int(found[0])

    def load(self, row):
        group, n = f"macro/step/{self.steps[row]}", len(self.mesh.elements)
        self.x = self.nodes + self.source.points(f"{group}/u", len(self.nodes))
        self.values = self.evaluate(lambda name, columns: self.source.array(f"{group}/{name}", n, columns))
        self.obstacles = np.empty((0, 6))
        if self.source.has(f"{group}/obstacles"):
            older = self.source.array(f"{group}/obstacles").shape[-1] == 5  # without the radius of the edge
            self.obstacles = self.source.array(f"{group}/obstacles", None, 5 if older else 6, finite=True)
            if older:
                self.obstacles = self.obstacles[:, [0, 1, 2, 3, 4, 4]]
        self.at = row
        return self

    @property
    def box(self):
        """Of the body, as it is and undeformed, and so much of plates and indenters that they are seen."""
        both = np.vstack([self.x, self.nodes])
        low, high = both.min(axis=0), both.max(axis=0)
        size, points = (self.nodes.max(axis=0) - self.nodes.min(axis=0)).max(), [low, high]
        for *x, n1, n2, radius, edge in self.obstacles:
            x, n, middle = np.array(x), np.array([n1, n2]), (np.min(points, axis=0) + np.max(points, axis=0)) / 2
            points.append(x + n * (edge - min(2 * radius, INDENTER_SHARE * size)) if radius > 0 else
                          middle - n * ((middle - x) @ n + PLATE_SHARE * size))
        return np.min(points, axis=0), np.max(points, axis=0)

    @property
    def title(self):
        if self.times:
            return f"Step {self.steps[self.at]}:  {self.times.title(self.at)}"
        inflated = "" if self.steps[self.at] else ", inflated"
        peak = ", peak" if self.at == self.reactions.peak else ""
        return f"Step {self.steps[self.at]}{inflated}{peak}:  load factor {ratio(self.reactions.load[self.at])}"

    # ---- drawing ----

    def draw(self, view, norm):
        axes = view.axes
        axes.set_axis_off()
        _obstacles(view, self.obstacles)
        self.has_grip = bool(self.at) and self._grips(axes)  # inflated without them
        points, triangles, values = meshes.field(self.mesh, self.x, self.values, view.scale, per_element=True)
        meshes.paint(axes, points, triangles, values, norm, FIELD).set_zorder(1)
        lines = lambda path, **style: axes.add_artist(PathPatch(path, facecolor="none", clip_on=False, **style))
        if np.sqrt(view.frame[2] * view.frame[3] / len(self.mesh.elements)) > 4:  # lines of a finer mesh hide the field
            lines(meshes.path(self.mesh.inner, self.x), edgecolor=DARK, linewidth=0.3, zorder=2)
        lines(meshes.paths(self.mesh.loops, self.x), edgecolor=DARK, linewidth=0.9, zorder=2)
        lines(meshes.paths(self.mesh.loops, self.nodes), edgecolor=RED, linewidth=0.9, linestyle=DASHES, zorder=3)

    def _grips(self, axes):
        """Bands along gripped sides, half covered by the body."""
        if self.gripped is None:
            return False
        edges = np.vstack(self.mesh.loops)
        edges = edges[(self.gripped[edges[:, :3]] != 0).all(axis=1)]
        for colour, width in ((DARK, 2 * RIGID_WIDTH), (RIGID, 2 * RIGID_WIDTH - 1.2)):
            axes.add_artist(PathPatch(meshes.path(edges, self.x), facecolor="none", edgecolor=colour, linewidth=width,
                                      capstyle="butt", clip_on=False, zorder=0.9))
        return len(edges) > 0

    def key(self, page, view, right=None):
        x, y, width, height = view.frame
        key = Key(page, x, y + height + 11, right or x + width)
        key.scale_bar(view.scale, "mm")
        radii = self.obstacles[:, 4]
        names = [name for name, has in (("plate", (radii <= 0).any()), ("indenter", (radii > 0).any()),
                                        ("grip", self.has_grip)) if has]
        if names:
            key.axes.add_patch(Rectangle((key.x, key.y - RIGID_WIDTH / 2), 2 * RIGID_WIDTH, RIGID_WIDTH,
                                         facecolor=RIGID, edgecolor=DARK, linewidth=0.6))
            key.x += 2 * RIGID_WIDTH + 4
            key.x += key.text(", ".join(names)) + 10
        key.undeformed("undeformed")


def _obstacles(view, obstacles):
    far = 4 * np.sum(view.high - view.low)
    for *x, n1, n2, radius, edge in obstacles:
        style = {"facecolor": RIGID, "edgecolor": DARK, "linewidth": 0.6, "zorder": 0.8}
        x, n = np.array(x), np.array([n1, n2])
        if radius > edge:  # the rounded end of a shaft
            angle, aside = np.linspace(0, np.pi / 2, 24), np.array([-n2, n1])
            corner = np.outer(radius - edge + edge * np.sin(angle), aside) + np.outer(edge * np.cos(angle), n)
            across = corner - 2 * np.outer(corner @ aside, aside)
            view.axes.add_artist(Polygon(x + np.vstack([corner, corner[-1:] - far * n, across[-1:] - far * n,
                                                        across[::-1]]), **style))
            continue
        if radius > 0:
            view.axes.add_artist(Circle(x, radius, **style))
            continue
        along, behind = far * np.array([-n2, n1]), RIGID_WIDTH / view.scale * n
        view.axes.add_artist(Polygon([x - along, x + along, x + along - behind, x - along - behind], **style))


# ---- zooms ----

class Zooms:
    """The cells at chosen points of the last step, at one scale and with common colours."""

    def __init__(self, source):
        self.count = len(source.array("zoom/points", None, 2)) if source.has("zoom/points") else 0
        if not self.count:
            return
        self.apothem = source.array("zoom/apothem", self.count, 1, finite=True).ravel()  # um
        self.place, self.position = source.points("zoom/place", self.count), source.points("zoom/position", self.count)
        F = source.array("zoom/F", self.count, 9, finite=True).reshape(-1, 3, 3)
        name, (label, unit) = next(iter(WALL_FIELDS.items()))
        self.cells = [Cells(source, f"zoom/{k + 1}/mesh", f"zoom/{k + 1}/fields", name,
                            source.has(f"zoom/{k + 1}/fields/interface/from"), F[k]) for k in range(self.count)]
        self.frame = Frame(self.cells, f"{label} of walls ({unit})", {})
        self.frame.norm = Range(np.concatenate([c.values for c in self.cells]))

    def draw(self, page, body, x, y, width, height):
        """One below the other, from the highest point down, so that the lines to them do not cross."""
        margin = 0.5 if self.frame.parts else 0.8
        half = max(a * ((c.box[1] - c.box[0]).max() / 2 + margin) for a, c in zip(self.apothem, self.cells))
        wide, high = width - self.frame.bars, (height - (self.count - 1) * ZOOM_GAP) / self.count
        over = page.area(0, 0, *page.size, facecolor="none", zorder=5)
        over.set(xlim=(0, page.size[0]), ylim=(page.size[1], 0))
        over.set_axis_off()
        for i, k in enumerate(np.argsort(-self.position[:, 1], kind="stable")):
            top = y + i * (high + ZOOM_GAP)
            middle = np.mean(self.cells[k].box, axis=0)
            view = View(page, x, top, wide, high, (middle - half / self.apothem[k], middle + half / self.apothem[k]))
            self.frame.draw(view, self.cells[k])
            at = body.points(self.position[k])
            at = body.frame[0] + at[0], body.frame[1] + body.frame[3] - at[1]
            for colour, line in (("white", 1.3), (DARK, 0.5)):  # seen on dark colours, too
                lines = [[at, (x, top)], [at, (x, top + high)]]
                over.add_collection(LineCollection(lines, colors=colour, linewidths=line))
            over.plot(*at, "s", markersize=3.2, color="white", markeredgecolor=DARK, markeredgewidth=0.9)
            view.axes.annotate(f"$X$ = ({self.place[k, 0]:.3g}, {self.place[k, 1]:.3g}) mm", (0, 1), (2, -2),
                               xycoords="axes fraction", textcoords="offset points", va="top", size=SMALL, zorder=9,
                               bbox={"facecolor": "white", "edgecolor": "none", "pad": 2})
            last = k
        self.frame.draw_bars(page, x + wide, y, height)
        view.frame = x, y, wide, height
        self.frame.key(page, view, self.apothem[last], x + width, undeformed=False)


# ---- the page ----

def _time_charts(body):
    """Reactions, turgor, shares of the start, and what is nearest to damage, against time."""
    t = body.times
    forces = [(body.reactions.values[:, s, i], label) for s, i, label in body.reactions.columns()]
    turgor = [(t.column(f"turgor_{name}"), words) for name, words in (("min", "least"), ("mean", "mean"),
                                                                      ("max", "largest"))]
    shares = t.group("factor", t.varies)
    if t.is_known(t.column("water")):
        shares.append((t.column("water"), "water"))
    damage, label = t.group("ratio", t.is_known), "stress over strength"
    if not damage:
        damage, label = [(t.column("debonded_fraction"), "debonded")], "share"
    lost = t.column("plasmolysed")
    if t.is_known(lost) and t.varies(lost):
        damage.append((lost, "without turgor"))
    return ([(f"reaction $R$ ({body.reactions.unit})", forces)] if forces else []) + [
        ("turgor $p$ (MPa)", turgor), ("share of the start", shares), (label, damage)]


def _page(body, options):
    zooms = Zooms(body.source) if body.at == len(body.steps) - 1 else None
    has_zooms = bool(zooms and zooms.count)
    more = ROW if has_zooms and zooms.frame.has_lamella else 0
    page = Page(WIDTH, 25.2 + ZOOM_HEIGHT + 34 + more + CURVE_HEIGHT + 4 if has_zooms else HEIGHT, options)
    width, height = page.size
    page.head(body.title + ("  (red line in the charts)" if body.times else ""), options)
    norm = Range(body.values, options)
    left, high = 0.56 * width, height - 25.2 - 34 - more - CURVE_HEIGHT - 4 if has_zooms else height - 51
    bars = bar_width(norm)
    if has_zooms:  # the colour bar is at the left, so that it does not cross the lines to the zooms
        bar(page, 3, 25.2, high, norm, body.label)
        view = View(page, 15 + bars, 25.2, left - bars - 6, high, body.box)
    else:
        view = View(page, 9, 25.2, left - bars, high, body.box)
        bar(page, 9 + left - bars, 25.2, high, norm, body.label)
    body.draw(view, norm)
    body.key(page, view)
    if has_zooms:
        zooms.draw(page, view, left + 36, 25.2, width - left - 44, high)
        place = 9, height - CURVE_HEIGHT - 4, width - 17, CURVE_HEIGHT
    else:
        place = left + 26, 21, width - left - 34, height - 24
    if body.times:
        charts(page, *place, body.times, _time_charts(body), body.at, options)
    else:
        body.reactions.draw(page, page.chart(*place), options)
    return settle(page)


def _frame(body, rows, options):
    """Window and colours of several steps, as a Frame of tissue has them."""
    low, high, values = [], [], []
    for row in rows:
        body.load(row)
        low.append(body.box[0])
        high.append(body.box[1])
        values.append(body.values)
    norm = Range(np.concatenate(values), options)

    class Shared:
        box, bars = (np.min(low, axis=0), np.max(high, axis=0)), bar_width(norm)
        colours = norm

        @staticmethod
        def draw_bars(page, x, y, height):
            bar(page, x, y, height, norm, body.label)
    return Shared


@styled
def draw(source, options, state=None, field=None, strip=False, film=False):
    """The deformed body at a step, coloured by `field`, with the reactions of its sides, or of a process charts against
    time; strip: up to eight steps beside each other; film: a list of pages, one for each state of a process."""
    body = Body(source, field)
    row = body.row(state)
    if film and not body.times:
        raise InputError(f"{source.path}: is of load steps; --film draws files of process, --strip their steps")
    if strip:
        alone(state)
        rows = chosen(len(body.steps), body.reactions.peak)
        shared = _frame(body, rows, options)
        titles = [body.load(k).title for k in rows]
        return draw_strip(options, shared, titles, lambda view, k: body.load(rows[k]).draw(view, shared.colours),
                          lambda page, view, right: body.key(page, view, right))
    if film or (body.times and (state not in (None, "last") or not source.has("zoom/points"))):
        rows = range(len(body.steps)) if film else [row]
        shared = _frame(body, rows, options)

        @styled  # also where a film asks for its pages one by one
        def page(k):
            def picture(page, x, y, width, height):
                view = View(page, x, y, width - shared.bars, height, shared.box)
                shared.draw_bars(page, x + width - shared.bars, y, height)
                body.load(k).draw(view, shared.colours)
                body.key(page, view)
            return film_page(body.times, k, picture, lambda: _time_charts(body.load(k)), options)
        return (page(k) for k in rows) if film else page(row)
    body.load(row)
    return _page(body, options)
