"""Several states of a file beside each other, in one window and with common colours."""
import numpy as np

from .. import InputError
from .page import HEIGHT, SMALL, WIDTH, Page, settle
from .tissue import View

PANELS = 8
MARGIN, GAP, TITLE, KEYS = 9, 8, 19, 26  # points; KEYS: two rows of legend


def alone(state):
    """A strip has all states."""
    if state is not None:
        raise InputError(f"--state {state}: --strip draws several states")


def chosen(n, peak):
    """The first, the last and the peak of n states, and others evenly between."""
    count = min(n, PANELS)
    states = [round(i * (n - 1) / max(count - 1, 1)) for i in range(count)]
    if 0 < peak < n - 1 and count > 2:
        states[1 + int(np.abs(np.array(states[1:-1]) - peak).argmin())] = peak
    return states


def strip(options, frame, titles, draw, key):
    """draw(view, k) panel k, key(page, view, right) the legend below."""
    count, box = len(titles), frame.box
    shape = (box[1][1] - box[0][1]) / (box[1][0] - box[0][0])
    columns = count if count <= PANELS // 2 else (count + 1) // 2
    if shape < 0.5:
        columns = min(2, count)  # so that the colour bar's label has room
    rows = -(-count // columns)
    room = (options.get("size") or (WIDTH / 72,))[0] * 72
    width = (room - 2 * MARGIN - frame.bars - (columns - 1) * GAP) / columns
    # a slender body keeps room for titles and ticks, a single panel makes no tall page
    height = min(HEIGHT, width * np.clip(shape, 0.5, 1.5))
    total = rows * (height + TITLE + GAP) - TITLE - GAP
    page = Page(WIDTH, MARGIN + TITLE + total + KEYS, options)
    if options.get("size"):
        total = page.size[1] - MARGIN - TITLE - KEYS
        height = (total + TITLE + GAP) / rows - TITLE - GAP
    for k, title in enumerate(titles):
        x, y = MARGIN + k % columns * (width + GAP), MARGIN + TITLE + k // columns * (height + TITLE + GAP)
        view = View(page, x, y, width, height, box)
        draw(view, k)
        if options.get("title") is not False:
            text = page.text(x / page.size[0], 1 - (y - 12) / page.size[1], title, va="center", size=SMALL)
            text.set_size(SMALL * min(1, width * page.dpi / 72 / max(text.get_window_extent().width, 1)))
    right = page.size[0] - MARGIN - frame.bars
    frame.draw_bars(page, right, MARGIN + TITLE, total)
    view.frame = MARGIN, MARGIN + TITLE, right - MARGIN, total  # of the legend, at the scale of the panels
    key(page, view, right)
    return settle(page)
