"""Pictures of a process at a material point: charts against time, the cells of its states beside them, the path of the
tissue over a map of its failure."""
from .. import InputError
from .maps import Map, modes
from .page import HEIGHT, NOW, WIDTH, Page, limits, near, settle, styled
from .read import Source
from .strip import alone, chosen, strip as draw_strip
from .timeline import TIME_HEIGHT, TimeLine, charts, film_page
from .tissue import Cells, Frame, View, field_of


def _four(source, line):
    """Firmness; pressures; what changes, as shares of the start; separation, or stresses over the strengths."""
    r = source.responses
    pressures = [(line.column("turgor"), "turgor")]
    if line.is_known(line.column("osmotic_pressure")):
        pressures += [(line.column("osmotic_pressure"), "osmotic, in cells"), (line.column("outside"), "outside")]
    if source.parts:
        pressures.append((line.column("cohesion"), "cohesion"))
    factors = line.group("factor", line.varies) or [(r.lumen_fraction / r.lumen_fraction[0], "lumen")]
    label, last = "share of the interface", [(r.debonded_fraction, "debonded"), (r.open_fraction, "open")]
    if not source.parts:
        label, last = "stress over strength", line.group("ratio", line.is_known)
        if not last:
            label = "stress (MPa)"
            last = [(r.max_traction / 1e6, "lamella traction"), (r.max_wall_tension / 1e6, "wall tension")]
    return [("firmness $E$ (MPa)", [(line.column("firmness"), "")]), ("pressure (MPa)", pressures),
            ("share of the start", factors), (label, last)]


def _path(source, line, of_map, options):
    """The way of the states. The map is of the initial walls: when all wall moduli have become s times the initial
    ones, tissue fails as the initial tissue does at p / s and g / s."""
    with Source(of_map) as source_of_map:
        if source_of_map.kind != "map":
            raise InputError(f"--map {of_map}: is of kind \"{source_of_map.kind}\"; lamella map makes maps")
        m = Map(source_of_map)
    if {m.x.quantity, m.y.quantity} != {"turgor", "cohesion"}:
        raise InputError(f"--map {of_map}: is of {m.x.quantity} and {m.y.quantity}; the path of a process is drawn "
                         "over turgor and cohesion")
    page = Page(0.55 * WIDTH, HEIGHT, options)
    top = 6 + page.head("", options)
    axes = page.chart(9, top, page.size[0] - 18, page.size[1] - top - 6)
    walls = line.column("walls")
    x, y = (line.column(side.quantity) / walls for side in (m.x, m.y))
    (way,) = axes.plot(x, y, color=NOW, linewidth=1.3, label="path of the tissue", zorder=4)
    for k, event in enumerate(line.events):
        if event or k in (0, line.n - 1):
            axes.plot(x[k], y[k], "D" if event else "o", color=NOW, markerfacecolor="white" if k else None, zorder=5)
            near(page, axes, x[k], y[k], event or ("end" if k else "start"), zorder=6)
    modes(page, axes, m, [way])
    limits(axes, options)
    return settle(page)


@styled
def draw(source, options, state=None, field=None, strip=False, film=False, map=None):
    """Charts against time; state: with the cells of this state; film: a list of pages, one for each state whose cells
    the file has; strip: up to eight of them beside each other; map: the path of the tissue over this map of failure."""
    if source.keys is None or not len(source.keys):
        raise InputError(f"{source.path}: holds no states")
    line = TimeLine(source, len(source.keys))
    if map is not None or not (film or strip or state is not None):
        for name, value in (("field", field), ("state", state)):
            if value is not None:
                raise InputError(f"--{name} {value}: there are no cells in this picture")
    if map is not None:
        return _path(source, line, map, options)
    if not (film or strip) and state is None:
        page = Page(WIDTH, TIME_HEIGHT, options)
        top = 9 + page.head("", options)
        charts(page, 9, top, page.size[0] - 18, page.size[1] - top - 6, line, _four(source, line), None, options)
        return settle(page)
    name, label = field_of(field)
    states = [k for k, key in enumerate(source.keys) if source.has(f"fields/{key}/x") and
              state in (None, "last", key, str(key))]
    if not states:
        of = " of this state" if state not in (None, "last") else ""
        raise InputError(f"{source.path}: holds no cells{of} to draw; lamella process with --frames N keeps them")
    if state == "last":
        states = states[-1:]
    if strip:
        alone(state)
        states = [states[i] for i in chosen(len(states), len(states) - 1)]
    F = source.responses.F
    cells = [Cells(source, "mesh", f"fields/{source.keys[k]}", name, source.parts, F[k]) for k in states]
    frame = Frame(cells, label, options)
    key = lambda page, view, right: frame.key(page, view, source.apothem * 1e6, right, undeformed=False)
    if strip:
        return draw_strip(options, frame, [line.title(k) for k in states],
                          lambda view, k: frame.draw(view, cells[k]), key)

    @styled  # also where a film asks for its pages one by one
    def page(i):
        def picture(page, x, y, width, height):
            view = View(page, x, y, width - frame.bars, height, frame.box)
            frame.draw_bars(page, x + width - frame.bars, y, height)
            frame.draw(view, cells[i])
            key(page, view, x + width - frame.bars)
        return film_page(line, states[i], picture, lambda: _four(source, line), options)
    return (page(i) for i in range(len(states))) if film else page(0)
