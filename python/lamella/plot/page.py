"""What all pictures share: the page, its style and colours, colour bars, charts, labels that keep clear of each other.

Lengths on a page are points (1/72 inch), from its upper left corner.
"""
import io
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib import ticker
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from .. import InputError

WIDTH, HEIGHT = 504, 252  #: of a journal's page, and half of that
TEXT, SMALL, TITLE = 7.5, 6.75, 8.25  #: sizes of labels, of numbers and legends, of titles
ROW = 10  #: between rows of a legend
LEAST, LEAST_CHART = 5, 30  #: edge of axes, points: the bar of colours is 7 wide; of a chart without its labels
LARGEST = 2**16  #: pixels, of the library that draws
PNG_DPI, IMAGE_DPI = 400, 300  #: of PNG files, and of fields within vector files

#: M. Okabe and K. Ito, Color Universal Design (2008), without the yellow, which is too light for lines
LINES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000")
INK, DARK, RED, NOW, EVENT = "#262626", "#1f1f29", "#cc2605", "#bf1a1a", "#737380"
FIELD = matplotlib.colormaps["viridis"]
#: pink to dark magenta: brightness falls uniformly, and neither walls nor lines have these colours
GAPS = LinearSegmentedColormap.from_list("gaps", [(1, 0.76, 0.85), (0.95, 0.30, 0.66), (0.56, 0, 0.40)])
#: black where a lamella is intact, white where it is broken
LAMELLA = LinearSegmentedColormap.from_list("lamella", [DARK, "white"])
DASHES = (0, (3.2, 1.8))

STYLE = {
    "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans"], "mathtext.fontset": "dejavusans",
    "font.size": SMALL, "axes.labelsize": TEXT, "axes.titlesize": SMALL, "figure.titlesize": TITLE,
    "xtick.labelsize": SMALL, "ytick.labelsize": SMALL, "legend.fontsize": SMALL,
    "text.color": DARK, "axes.labelcolor": INK, "axes.edgecolor": INK, "xtick.color": INK, "ytick.color": INK,
    "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6, "xtick.major.size": 2.5,
    "ytick.major.size": 2.5, "xtick.minor.size": 1.25, "ytick.minor.size": 1.25, "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4, "xtick.major.pad": 3, "ytick.major.pad": 3, "axes.labelpad": 3,
    "axes.grid": True, "axes.axisbelow": True, "grid.color": "#dedede", "grid.linewidth": 0.4,
    "axes.unicode_minus": True, "axes.formatter.use_mathtext": True, "axes.formatter.limits": (-4, 5),
    "axes.xmargin": 0.06, "axes.ymargin": 0.06, "lines.linewidth": 1.0, "lines.markersize": 3.4,
    "lines.markeredgewidth": 0.8, "legend.frameon": False, "legend.handlelength": 2.0, "legend.handletextpad": 0.5,
    "legend.columnspacing": 1.2, "legend.borderaxespad": 0.2, "legend.borderpad": 0.2, "legend.labelspacing": 0.4,
    "hatch.linewidth": 0.4,
    "pdf.fonttype": 42, "svg.hashsalt": "lamella",
}


def styled(function):
    """Draws with the style of Lamella, whatever else the process draws with."""
    def drawn(*arguments, **options):
        with matplotlib.rc_context(STYLE):
            return function(*arguments, **options)
    drawn.__name__, drawn.__doc__ = function.__name__, function.__doc__
    return drawn


class Page(Figure):
    """A figure of matplotlib that a notebook shows, and that keeps the style of Lamella when it is saved."""

    def __init__(self, width, height, options=None):
        size = (options or {}).get("size")
        super().__init__(figsize=size or (width / 72, height / 72))
        FigureCanvasAgg(self)  # it measures texts
        self.size = np.array(self.get_size_inches()) * 72  #: points
        self.charts, self.labels, self.occupied, self.chart_legends = [], [], [], {}

    def area(self, x, y, width, height, **options):
        """Axes at a place of the page, points."""
        w, h = self.size
        if min(width, height) < LEAST:
            raise InputError(f"--size {w / 72:.3g}x{h / 72:.3g}: the page is too small for this picture")
        return self.add_axes((x / w, 1 - (y + height) / h, width / w, height / h), **options)

    def chart(self, x, y, width, height, **options):
        """Axes of a chart that has this place together with its ticks, labels and legend (`settle`)."""
        axes = self.area(x, y, width, height, **options)
        axes.xaxis.set_major_locator(ticks(2))
        axes.yaxis.set_major_locator(ticks(2))
        self.charts.append((axes, (x, y, width, height)))
        return axes

    def head(self, title, options, x=9, y=12):
        """The title: `title` of the options, or this one; none where the option is False. Returns the room that it takes
        of a page that has none by itself."""
        wanted = options.get("title")
        if wanted is False or not (wanted or title):
            return 0
        text = self.text(x / self.size[0], 1 - y / self.size[1], wanted or title, size=TITLE, va="center", color=DARK,
                         parse_math=not wanted)
        width = text.get_window_extent().width * 72 / self.dpi
        text.set_size(TITLE * min(1, (self.size[0] - 2 * x) / max(width, 1)))
        return 14

    @styled
    def save(self, path, dpi=None):
        """Writes .png, .svg or .pdf; dpi: of a PNG (400), and of fields within the others (300). OSError: it cannot be
        written; then no part of a file is left."""
        check_path(path)
        kind = Path(path).suffix.lower()[1:]
        dpi = dpi or (PNG_DPI if kind == "png" else IMAGE_DPI)
        if self.get_size_inches().max() * dpi >= LARGEST:
            raise InputError(f"--dpi {dpi}: the picture would have more than {LARGEST} pixels across")
        whole = io.BytesIO()
        metadata = {"png": {"Software": "lamella"}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}[kind]
        self.savefig(whole, format=kind, dpi=dpi, metadata=metadata)
        write(path, whole.getvalue())

    def _repr_png_(self):
        with matplotlib.rc_context(STYLE):
            shown = io.BytesIO()
            self.savefig(shown, format="png", dpi=110)
            return shown.getvalue()


def check_path(path):
    """InputError unless the name ends as that of a picture, OSError unless its folder is there."""
    if Path(path).suffix.lower() not in (".png", ".svg", ".pdf"):
        raise InputError(f"{path}: a picture's name must end in .png, .svg or .pdf")
    if not Path(path).parent.is_dir():
        raise FileNotFoundError(f"{path}: cannot write the picture: No such file or directory")


def write(path, content):
    """Writes a file of these bytes; where that fails none is left."""
    opened = False
    try:
        with open(path, "wb") as file:
            opened = True
            file.write(content)
    except OSError as error:
        if opened:
            Path(path).unlink(missing_ok=True)
        raise OSError(f"{path}: cannot write the picture: {error.strerror or error}") from None


# ---- numbers ----

def number(value):
    """Four digits, and a true minus sign."""
    return f"{value:.4g}".replace("-", "\u2212")


def ratio(value):
    """The same of a number of order one, whose rounding errors around zero are zero."""
    return number(0 if abs(value) < 5e-13 else value)


def pressure_unit(*values):
    """MPa, kPa or Pa, whichever suits values in Pa, and its size in Pa."""
    largest = max((np.abs(v[np.isfinite(v)]).max(initial=0) for v in map(np.asarray, values)), default=0)
    return ("MPa", 1e6) if largest >= 1e4 or largest == 0 else ("kPa", 1e3) if largest >= 10 else ("Pa", 1.0)


def ticks(wanted):
    """Round numbers, about as many as wanted."""
    return ticker.MaxNLocator(max(2, int(wanted)), steps=[1, 2, 5, 10])


# ---- colours ----

class Range(Normalize):
    """Limits of a colour scale: of the middle 98 % of values where the rest would stretch it, as peaks of the stress at
    corners of lumens do; or those of the options. `extend`: at which ends values lie beyond it."""

    def __init__(self, values, options=None):
        values = np.sort(np.asarray(values, dtype=float)[np.isfinite(values)])
        limits, self.extend = (0.0, 1.0), "neither"
        if len(values):
            last = len(values) - 1
            inner = values[int(0.01 * last)], values[int(np.ceil(0.99 * last))]
            margin = 0.15 * (inner[1] - inner[0])
            clipped = margin > 0 and values[0] < inner[0] - margin, margin > 0 and values[-1] > inner[1] + margin
            limits = tuple(inner[k] if clipped[k] else values[-k] for k in (0, 1))
        self.own = limits  #: those of the values, before a constant gets a range
        limits = (options or {}).get("range") or limits
        size = max(map(abs, limits))
        if limits[1] - limits[0] <= 1e-6 * size or size == 0:  # constant, up to rounding
            half = 0.05 * size or 1.0
            limits = limits[0] - half, limits[1] + half
        if len(values):
            below, above = (values[0] < limits[0] - 1e-12 * size), (values[-1] > limits[1] + 1e-12 * size)
            self.extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[below, above]
        super().__init__(*limits)


def _formatter():
    return ticker.ScalarFormatter(useMathText=True)


def bar_width(norm):
    """Points that a colour bar takes beside its picture."""
    values = ticks(10).tick_values(norm.vmin, norm.vmax)
    values = [v for v in values if norm.vmin <= v <= norm.vmax] or [norm.vmin]
    formatter = _formatter()
    formatter.create_dummy_axis()
    return 20 + TEXT + 0.62 * SMALL * max(len(_plain(label)) for label in formatter.format_ticks(values))


def _plain(label):
    return label.replace(r"\mathdefault{", "").replace("}", "").replace("$", "")


def bar(page, x, y, height, norm, label, cmap=FIELD):
    """A colour bar to the right of x, points, which takes bar_width; returns its axis."""
    axes = page.area(x + 6, y, 7, height)
    drawn = page.colorbar(ScalarMappable(norm, cmap), cax=axes, extend=norm.extend, extendfrac=7 / height,
                          format=_formatter(), ticks=ticks(height / 20))
    finish_bar(drawn, label)
    drawn.ax.yaxis.label.set_size(min(TEXT, TEXT * height / (0.58 * TEXT * max(len(label.replace("$", "")), 1))))
    return drawn.ax.yaxis


def finish_bar(drawn, label):
    """Label and lines of a colour bar."""
    drawn.set_label(label, labelpad=2)
    drawn.outline.set_linewidth(0.5)
    drawn.ax.grid(False)
    drawn.ax.tick_params(width=0.5)


# ---- charts ----

def legend(page, axes, handles=None, **options):
    """A legend in rows above a chart, in as many columns as it is wide (`settle`)."""
    page.chart_legends[axes] = handles, options


def _legend(axes, handles, options):
    labels = [h.get_label() for h in handles] if handles is not None else axes.get_legend_handles_labels()[1]
    if not labels:
        return
    size = SMALL if len(labels) <= 12 else SMALL * 12 / len(labels)  # many sides leave room for the curves
    sample = options.get("handlelength", matplotlib.rcParams["legend.handlelength"])
    width = axes.bbox.width * 72 / axes.figure.dpi
    axes.legend(handles=handles, loc="lower left", bbox_to_anchor=(0, 1), ncols=columns(labels, width, size, sample),
                fontsize=size, **options)


def columns(labels, width, size=SMALL, sample=2.0):
    """Of a legend that fits into this width, points."""
    each = [size * (0.54 * len(label.replace("$", "").replace("_{", "").replace("}", "")) + sample + 1.7)
            for label in labels]
    for count in range(len(each), 1, -1):  # as matplotlib fills them
        if sum(max(column) for column in np.array_split(each, count)) <= width:
            return count
    return 1


def limits(axes, options):
    """Limits of a chart that the user has chosen."""
    if options.get("x"):
        axes.set_xlim(options["x"])
    if options.get("y"):
        axes.set_ylim(options["y"])


def mark(page, axes, x, text=None, colour=EVENT, style=":"):
    """A vertical line across a chart, with a text beside it where it lies on no other one."""
    axes.axvline(x, color=colour, linestyle=style, linewidth=0.8)
    if not text:
        return
    places = [(x, height, side, 0, "right" if side < 0 else "left", end)
              for height, end in ((0.97, "top"), (0.5, "center"), (0.03, "bottom")) for side in (-2, 2)]
    style = {"rotation": 90, "size": SMALL, "color": colour}
    page.labels.append((axes, axes.get_xaxis_transform(), text, places, style))


def near(page, axes, x, y, text, away=4, **style):
    """A text beside a point, in the first of eight directions in which it lies on no other one; none if all are
    taken."""
    places = [(x, y, away * dx, away * dy, {1: "left", -1: "right", 0: "center"}[dx],
               {1: "bottom", -1: "top", 0: "center"}[dy])
              for dx, dy in ((1, 1), (-1, 1), (1, -1), (-1, -1), (1, 0), (-1, 0), (0, 1), (0, -1))]
    page.labels.append((axes, axes.transData, text, places, {"size": SMALL, **style}))


def _fit(page, axes, x, y, width, height):
    """Shrinks a chart so that all of it is in its place."""
    wanted = np.array([[x, page.size[1] - y - height], [x + width, page.size[1] - y]]) * page.dpi / 72
    for _ in range(2):
        for axis, points in ((axes.xaxis, axes.bbox.width / 26), (axes.yaxis, axes.bbox.height / 20)):
            if isinstance(axis.get_major_locator(), ticker.MaxNLocator):
                axis.get_major_locator().set_params(nbins=max(2, int(points * 72 / page.dpi)))
        axes.yaxis.get_offset_text().set(x=-0.02, ha="right")  # not below the legend
        if axes in page.chart_legends:
            _legend(axes, *page.chart_legends[axes])
        whole, frame = axes.get_tightbbox(page.canvas.get_renderer()), axes.get_window_extent()
        place = wanted + frame.get_points() - whole.get_points()
        if (place[1] - place[0]).min() * 72 / page.dpi < LEAST_CHART:
            raise InputError(f"--size {page.size[0] / 72:.3g}x{page.size[1] / 72:.3g}: the page is too small for its charts")
        axes.set_position(Bbox(place / (page.size * page.dpi / 72)))


def occupy(page, axes, x, y, size):
    """Labels keep clear of a mark of this size, points, at this place."""
    page.occupied.append((axes, x, y, size))


def _zero(axes):
    """A stronger grid line at zero."""
    for line, scale, (low, high) in ((axes.axhline, axes.get_yscale(), axes.get_ylim()),
                                     (axes.axvline, axes.get_xscale(), axes.get_xlim())):
        if scale == "linear" and low < 0 < high and axes.xaxis.get_gridlines()[0].get_visible():
            line(0, color="#dedede", linewidth=1, zorder=0.6)


def settle(page):
    """Gives charts their size, then labels their places."""
    for axes, place in page.charts:
        _zero(axes)
        _fit(page, axes, *place)
    page.charts.clear()
    boxes = []
    for axes, x, y, size in page.occupied:
        at, half = axes.transData.transform((x, y)), size * page.dpi / 144
        boxes.append(Bbox([at - half, at + half]))
    for axes, transform, text, places, style in page.labels:
        frame = axes.get_window_extent().padded(1)
        for x, y, dx, dy, ha, va in places:
            label = axes.annotate(text, (x, y), xycoords=transform, xytext=(dx, dy), textcoords="offset points", ha=ha,
                                  va=va, annotation_clip=False, **style)
            box = label.get_window_extent()
            if frame.contains(*box.min) and frame.contains(*box.max) and not any(box.overlaps(b) for b in boxes):
                boxes.append(box)
                break
            label.remove()
    page.labels.clear()
    return page
