"""Pictures of files of RVE states: the tissue at one state with the curves of all, or states beside each other."""
import numpy as np

from .. import InputError
from . import curves
from .interface import Forces
from .page import HEIGHT, WIDTH, Page, number, ratio, settle, styled
from .strip import alone, chosen, strip as draw_strip
from .tissue import Cells, Frame, field_of, View


def state_of(keys, answered, state, peak, path):
    """Index of a state: a number, "last", or None for the peak."""
    if state is None or state == "last":
        known = np.flatnonzero(answered)
        if not len(known):
            return None
        return int(known[-1]) if state == "last" or peak is None else peak
    found = np.flatnonzero(np.asarray(keys).astype(str) == str(state))
    if not len(found):
        raise InputError(f"--state {state}: {path} holds states {keys[0]} to {keys[-1]}")
    return int(found[0])


def _choose(source, state):
    keys, r = source.keys, source.responses
    if keys is None or not len(keys):
        raise InputError(f"{source.path}: holds no states")
    known, highest = curves.solved(r), curves.peak(r)
    k = state_of(keys, known, state, highest, source.path)
    if k is None:
        raise InputError(f"{source.path}: no state has a response to draw; the first is {r.status[0]}: {r.reason[0]}")
    if not known[k]:
        raise InputError(f"--state {state}: has no fields to draw; it is {r.status[k]}: {r.reason[k]}")
    return k, highest


def _title(source, k, highest):
    """State 5, peak:  F = [1, 0.3; 0, 1],  turgor p = 0.02 MPa"""
    r, measured = source.responses[k], curves.Measured(source.responses, source.object("test"))
    F = measured.F[k]
    if not F[[0, 1, 2, 2], [2, 2, 0, 1]].any() and F[2, 2] == 1:  # plane strain
        F = F[:2, :2]
    rows = "; ".join(", ".join(map(ratio, row)) for row in F)
    text = f"State {source.keys[k]}{', peak' if k == highest else ''}:  $F$ = [{rows}]{measured.of_F},  turgor $p$ = " \
           f"{number(float(r.turgor) / 1e6)} MPa"
    if source.tissue.get("interface", {}).get("law") == "contact" or r.cohesion > 0:
        text += f",  cohesion $g$ = {number(float(r.cohesion) / 1e6)} MPa"
    return text + ("  (unstable)" if r.status == "unstable" else "")


def _cells(source, k, field, forces):
    cells = Cells(source, "mesh", f"fields/{source.keys[k]}", field, source.parts, source.responses.F[k])
    if forces:
        if not source.parts:
            raise InputError(f"--forces: cells of {source.path} are bonded: forces between them are known of "
                             "interface.law contact and lamella")
        if cells.interface.has_lamella and cells.interface.force is None:
            raise InputError(f"--forces: {source.path} is older than this program and has none: solve it again")
        cells.forces = Forces(cells, source.apothem, source.responses.cohesion[k] / 1e6)
    return cells


@styled
def draw(source, options, state=None, field=None, strip=False, forces=False):
    """The tissue at a state, coloured by `field` (wall_stress, fibre_stretch), and the effective stress over the
    states; strip: up to eight states beside each other. forces: lines between cells in place of contact
    pressure and of the undeformed outline."""
    name, label = field_of(field)
    k, highest = _choose(source, state)
    if strip:
        alone(state)
        return _strip(source, name, label, highest, forces, options)
    page = Page(WIDTH, HEIGHT, options)
    cells = _cells(source, k, name, forces)
    frame = Frame([cells], label, options, reference=not forces)
    page.head(_title(source, k, highest), options)
    width, height = page.size
    wide, high = 0.56 * width - frame.bars, height - 51 - (10 if frame.parts else 0)
    view = View(page, 9, 25.2, wide, high, frame.box)
    frame.draw_bars(page, 9 + wide, 25.2, high)
    frame.draw(view, cells, undeformed=not forces)
    frame.key(page, view, source.apothem * 1e6, 9 + wide + (frame.bars if frame.is_open else 0),
              undeformed=not forces)
    left = 0.56 * width + 26
    axes = page.chart(left, 21, width - left - 8, height - 24)
    curves.stress(page, axes, source.responses, source.keys, source.object("test"), options)
    return settle(page)


def _strip(source, name, label, highest, forces, options):
    load = curves.LoadAxis(source.responses, source.keys, curves.Measured(source.responses, source.object("test")))
    states = [k for k in range(len(source.keys)) if source.has(f"fields/{source.keys[k]}/x")]
    states = [states[i] for i in chosen(len(states), int(np.searchsorted(states, highest or 0)))]
    cells = [_cells(source, k, name, forces) for k in states]
    frame = Frame(cells, label, options)

    def title(k):
        unit = " " + load.unit if load.unit else ""
        at = "" if load.whole else f":  {load.name} = {ratio(load.values[k])}{unit}{load.of}"
        return f"State {source.keys[k]}{', peak' if k == highest else ''}{at}"
    return draw_strip(options, frame, [title(k) for k in states], lambda view, k: frame.draw(view, cells[k]),
                      lambda page, view, right: frame.key(page, view, source.apothem * 1e6, right, undeformed=False))
