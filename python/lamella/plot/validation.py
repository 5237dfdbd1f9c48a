"""Predicted over measured figures: how far each is from what was measured, a row for each, experiments one below the
other. Bars are intervals; the tinted strip is what was measured, its middle at 1."""
import numpy as np
from matplotlib.ticker import FixedLocator, NullFormatter, NullLocator

from .page import LINES, RED, SMALL, WIDTH, Page, settle, styled

MARGIN, ROW, HEAD, TEXT = 9, 11.5, 15, 262  #: points: of rows, of titles of experiments, room for words on the left
LOWEST, HIGHEST = 0.1, 10.0  #: of predicted over measured that is drawn; beyond it an arrow stands


def _place(value):
    return float(np.clip(value, LOWEST * 1.06, HIGHEST / 1.06))


def _draw_row(axes, row, y):
    middle = np.sqrt(row.low * row.high) if row.low > 0 else 0.5 * (row.low + row.high)
    axes.fill_betweenx([y - 0.36, y + 0.36], row.low / middle, row.high / middle, color="#dbe7f2", linewidth=0, zorder=1)
    colour = "#8a8a8a" if row.fitted else LINES[2] if row.within else RED
    if row.interval and not row.fitted:
        axes.plot([_place(v / middle) for v in row.interval], [y, y], color=colour, linewidth=1.1, zorder=3)
    at = row.predicted / middle
    marker = "<" if at < LOWEST else ">" if at > HIGHEST else "D" if row.fitted else "o"
    axes.plot([_place(at)], [y], marker, color=colour, markersize=3.6, zorder=4)


@styled
def draw(experiments, options=None):
    """A Page of lamella.validation.Experiment objects that have figures."""
    options = options or {}
    shown = [e for e in experiments if e.rows]
    rows = sum(len(e.rows) for e in shown)
    height = 2 * MARGIN + 30 + HEAD * len(shown) + ROW * rows
    page = Page(WIDTH, height, options)
    top = MARGIN + page.head("Predicted over measured", options)
    area = (TEXT, top, WIDTH - TEXT - MARGIN - 6, height - top - 30 - MARGIN)
    axes = page.area(*area)
    total = HEAD * len(shown) + ROW * rows
    at, ticks = 0.0, []
    for e in shown:
        page.text(MARGIN / WIDTH, 1 - (top + (at + 0.62 * HEAD) / total * area[3]) / height, e.title, size=SMALL + 0.3,
                  weight="bold", va="center")
        at += HEAD
        for row in e.rows:
            y = (at + 0.5 * ROW) / ROW
            _draw_row(axes, row, y)
            words = row.what + (" (fitted)" if row.fitted else "")
            page.text((MARGIN + 8) / WIDTH, 1 - (top + (at + 0.5 * ROW) / total * area[3]) / height, words, size=SMALL,
                      va="center")
            ticks.append(y)
            at += ROW
    axes.axvline(1, color="#737380", linewidth=0.6, zorder=2)
    axes.set(xscale="log", xlim=(LOWEST, HIGHEST), ylim=(total / ROW, 0), xlabel="Lamella over what was measured")
    axes.xaxis.set_major_locator(FixedLocator([0.1, 0.2, 0.5, 1, 2, 5, 10]))
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_locator(NullLocator())
    axes.yaxis.set_major_formatter(NullFormatter())
    settle(page)
    return page
