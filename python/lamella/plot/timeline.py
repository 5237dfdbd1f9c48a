"""Quantities of a process against time, and pages that show them beside a state."""
import numpy as np

from ..units import time_unit
from .page import DASHES, EVENT, LINES, NOW, WIDTH, Page, legend, limits, mark, number, settle

TIME_HEIGHT = 350  #: of a page with charts, points
PICTURE_WIDTH = 210  #: of a picture beside charts, with its colour bars


class TimeLine:
    """The states of a process in time."""

    def __init__(self, source, n):
        self.source, self.n = source, n
        time = source.array("process/time", n, 1, finite=True).ravel()
        self.unit, seconds = time_unit(time[-1])
        self.time = time / seconds
        names = source.text("process/events").split("\n")
        events = source.array("process/event", n, 1).ravel().astype(int)
        self.events = [names[k].replace("_", " ") if 0 <= k < len(names) else "" for k in events]

    def column(self, name):
        return self.source.array(f"process/{name}", self.n, 1).ravel().astype(float)

    def group(self, name, shows):
        """Values and labels of those arrays of the group that `shows` selects."""
        found = []
        for member in self.source.file.get(f"process/{name}", ()):
            values = self.column(f"{name}/{member}")
            if shows(values):
                found.append((values, member.replace("_", " ")))
        return found

    @staticmethod
    def varies(values):
        return bool((values != values[0]).any())

    @staticmethod
    def is_known(values):
        return bool(np.isfinite(values[0]))

    def title(self, k):
        event = f": {self.events[k]}" if self.events[k] else ""
        several = "s" if self.unit == "day" and self.time[k] != 1 else ""
        return f"{number(self.time[k])} {self.unit}{several}{event}"


def charts(page, x, y, width, height, line, four, now, options):
    """Up to four charts (label, [(values, label), ...]) two by two, or in a row where the place is low, with lines at events,
    and a red one at the state `now`."""
    columns = len(four) if width > 3 * height else 2
    gap, rows = 12, -(-len(four) // columns)
    wide, high = (width - (columns - 1) * gap) / columns, (height - (rows - 1) * gap) / rows
    for k, (label, curves) in enumerate(four):
        axes = page.chart(x + k % columns * (wide + gap), y + k // columns * (high + gap), wide, high)
        for c, (values, name) in enumerate(curves):
            axes.plot(line.time, values, color=LINES[c % len(LINES)], label=name or None,
                      linestyle=DASHES if c > 2 else "-")
        axes.set(xlabel=f"time ({line.unit})", ylabel=label)
        for i, event in enumerate(line.events):
            if event:
                mark(page, axes, line.time[i], event if k == 0 else None, EVENT)
        if now is not None:
            axes.axvline(line.time[now], color=NOW, linewidth=0.8)
        limits(axes, {"x": options.get("x"), "y": options.get("y") if k == 0 else None})
        legend(page, axes)


def film_page(line, k, picture, four, options):
    """A state beside the charts: picture(page, x, y, width, height)."""
    page = Page(WIDTH, TIME_HEIGHT, options)
    page.head(f"{line.title(k)}  (red line in the charts)", options, y=14)
    width, height = page.size
    picture(page, 9, 30, PICTURE_WIDTH, height - 60)
    charts(page, PICTURE_WIDTH + 30, 18, width - PICTURE_WIDTH - 39, height - 24, line, four(), k, options)
    return settle(page)
