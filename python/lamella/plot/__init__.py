"""Pictures of what files hold, as figures of matplotlib that can be changed before they are saved.

    import lamella
    page = lamella.plot.draw("shear.h5", field="fibre_stretch")
    page.axes[-1].axhline(0.02, color="grey")
    page.save("shear.pdf")

`draw` finds out the kind of a file; `rve`, `fe2`, `process`, `database`, `map`, `tradeoff`, `cells`, `realisations`,
`calibration`, `uncertainty` and `sensitivity` say which it is. All take
    title   text, or False: none
    size    width and height of the page, inches
    range   limits of the colour scale of the field, in its unit on the colour bar
    x, y    limits of the axes of charts, in the units that are shown
A Page is a matplotlib Figure with `save`; a notebook shows it as it is.
"""
import re
from importlib import import_module
from pathlib import Path

from .. import InputError
from .page import Page, check_path
from .read import Source

__all__ = ["draw", "rve", "fe2", "process", "database", "map", "tradeoff", "cells", "realisations", "calibration",
           "uncertainty", "sensitivity", "save", "fields", "Page"]
_MODULES = {"rve": "states", "fe2": "bodies", "process": "processes", "database": "tables", "map": "maps"}
_TEXTS = {"tradeoff": ("work_precision", "a work-precision diagram"), "cells": ("rest", "a tissue file"),
          "realisations": ("realisations", "what realisations tell"), "calibration": ("fits", "a fit"),
          "uncertainty": ("bands", "what samples tell"),
          "sensitivity": ("sensitivity", "what a study of sensitivity tells")}
_KEYS = {"lamella_tissue": "cells", "lamella_realisations": "realisations", "lamella_calibration": "calibration",
         "lamella_uncertainty": "uncertainty", "lamella_sensitivity": "sensitivity",
         '"settings"': "tradeoff"}  #: texts that files of these kinds have
_SCENE = re.compile(r"^(version|rve) *:", re.MULTILINE)
_DRAWN = ("plot draws the HDF5 files that rve, fe2, process, map (-o OUT.h5) and build (-d DB.h5) write, and the JSON files of "
          "tissue, tradeoff, calibrate, sensitivity, --realisations and --uncertainty")
_OPTIONS = {"title", "size", "range", "x", "y"}
_CHOICES = {"state", "field", "strip", "forces", "film", "map", "angle", "suction", "turgor", "accuracy"}


class _Options(dict):
    """Options of a page that tell which of them the drawing has asked for."""

    def __init__(self, options):
        super().__init__(options)
        self.asked = set()

    def get(self, name, default=None):
        self.asked.add(name)
        return super().get(name, default)


def _refuse_unused(path, options):
    for name in sorted(set(options) - options.asked):
        raise InputError(f"--{name} {options[name]}: this picture of {path} has nothing that it would change")


def _draw(kind, path, options):
    """Each option is of use, or an error."""
    for name in options:
        if name not in _OPTIONS | _CHOICES:
            raise InputError(f"{name}: pictures have no such option; they have {', '.join(sorted(_OPTIONS | _CHOICES))}")
    options = {name: value for name, value in options.items()
               if not (value is None or (value is False and name != "title"))}
    page = _Options({name: value for name, value in options.items() if name in _OPTIONS})
    options = {name: value for name, value in options.items() if name in _CHOICES}
    drawn = _page(kind, path, options, page)
    _refuse_unused(path, page)
    return drawn


def _page(kind, path, options, page):
    kind = kind or _kind_of_text(path)
    if kind in _TEXTS:
        if options:
            raise InputError(f"--{next(iter(options))}: {_TEXTS[kind][1]} is drawn as a whole")
        return import_module(f".{_TEXTS[kind][0]}", __name__).draw(path, page)
    with Source(path) as source:
        module = _MODULES.get(source.kind)
        if module is None or kind not in (None, source.kind):
            raise InputError(f"{path}: is of kind \"{source.kind}\"; " +
                             (f"lamella.plot.{kind} draws files of {kind}" if module else
                              _DRAWN))
        if source.kind != "database":
            import_module(".tables", __name__).refuse(path, options)
        for name, kinds in (("strip", ("rve", "fe2", "process")), ("forces", ("rve",)),
                            ("film", ("fe2", "process")), ("map", ("process",))):
            if options.get(name) and source.kind not in kinds:
                raise InputError(f"{path}: is of kind \"{source.kind}\"; --{name} draws files of {', '.join(kinds)}")
        drawn = import_module(f".{module}", __name__).draw(source, page, **options)
        return drawn if isinstance(drawn, Page) else list(drawn)


def _kind_of_text(path):
    """One of _KEYS of a file that is no HDF5; None: it may be one."""
    suffix = Path(path).suffix.lower()
    if suffix not in (".json", ".yaml", ".yml", ".csv"):
        return None
    try:
        text = Path(path).read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        raise OSError(f"{path}: {error.strerror}") from None
    if suffix == ".csv":
        raise InputError(f"{path}: is a CSV file; {_DRAWN}")
    kind = next((kind for key, kind in _KEYS.items() if key in text), None)
    if kind is None:
        raise InputError(f"{path}: is {'a scene' if _SCENE.search(text) else 'no text file that lamella writes'}; {_DRAWN}")
    return kind


def draw(path, **options):
    """A Page of what a file holds, or with film a list of them. Options: those of the function of its kind. InputError:
    what the file lacks, or an option that does not fit."""
    return _draw(None, path, options)


def rve(path, state=None, field=None, strip=False, forces=False, **options):
    """The tissue of `rve -o` at a state (its number, "last", None: the peak load), coloured by `field` (wall_stress,
    fibre_stretch), and the effective stress over the states. strip: up to eight states beside each other. forces: lines
    between cells as wide as the normal force on their face is large."""
    return _draw("rve", path, {"state": state, "field": field, "strip": strip, "forces": forces, **options})


def fe2(path, state=None, field=None, strip=False, film=False, **options):
    """The body of `fe2 -o`, or of a process, at a step, coloured by `field` (docs/reference/pictures.md), with its
    reactions. strip: up to eight steps beside each other. film: a list of Pages of a process."""
    return _draw("fe2", path, {"state": state, "field": field, "strip": strip, "film": film, **options})


def process(path, state=None, field=None, strip=False, film=False, map=None, **options):
    """Charts of `process -o` against time; state: beside the cells of this state; film: a list of Pages, one for each
    state whose cells are kept; map: a file of `map -o`, over which the path of the tissue is drawn."""
    return _draw("process", path, {"state": state, "field": field, "strip": strip, "film": film, "map": map, **options})


def database(path, field=None, angle=None, suction=None, turgor=None, accuracy=None, **options):
    """A slice through the table of `build -d`, at an angle ("15 deg") and a suction or turgor ("0.02 MPa"), for an
    accuracy; field (stress, turgor): its records in strain space."""
    return _draw("database", path, {"field": field, "angle": angle, "suction": suction, "turgor": turgor,
                                    "accuracy": accuracy, **options})


def map(path, field=None, **options):
    """How the tissue of `map -o` fails, and a number of each point: load_factor, or a single number of its records."""
    return _draw("map", path, {"field": field, **options})


def tradeoff(path, **options):
    """The work-precision diagram of a tradeoff.json that `tradeoff -o` has written."""
    return _draw("tradeoff", path, options)


def cells(path, **options):
    """The cells of a tissue file (`tissue -o`) at rest: walls, lumens and air, one period outlined."""
    return _draw("cells", path, options)


def realisations(path, **options):
    """Scatter and means against the cells in a period, of a realisations.json of `rve --realisations`."""
    return _draw("realisations", path, options)


def sensitivity(path, **options):
    """Sobol' indices with intervals and elasticities, a panel for each figure, of a sensitivity.json of `lamella
    sensitivity`."""
    return _draw("sensitivity", path, options)


def calibration(path, **options):
    """Measured curves and figures with the model's, and profiles, of a fit.json of `lamella calibrate -o`."""
    return _draw("calibration", path, options)


def uncertainty(path, **options):
    """Bands of an uncertainty.json of `lamella rve` or `lamella process --uncertainty`."""
    return _draw("uncertainty", path, options)


def fields():
    """Names of all fields of files of rve, fe2 and databases; maps have the single numbers of records, too."""
    from .bodies import FIELDS as of_bodies
    from .tissue import FIELDS as of_walls
    return [*of_walls, *of_bodies, "stress", "load_factor"]


def save(drawn, path, dpi=None, progress=None):
    """Writes a Page, or several: pages of a PDF, or numbered files. progress(done): is called after each."""
    from .film import save_all
    check_path(path)
    if isinstance(drawn, Page):
        drawn.save(path, dpi)
    else:
        save_all(drawn, path, dpi, progress)
