"""A tissue file of a label image: python3 -m lamella.cells LABELS.tif -o tissue.json --pixel "0.65 um"."""
import argparse
import json
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from .. import InputError, quantity
from .._served import USAGE, progress as shown, served
from ..tissue import Tissue
from ..tissue.file import output
from . import borders, picture as pictures
from .walls import Walls

UNIT, METRE = "um", 1e6  #: of the file
JAGGED = 7  #: of the rms by which pixels differ from faces that follow their noise: 5 of the noise, which hardly one in
#: thousands exceeds
SHORTEST = 1.001 / 50  #: of the wall: the solver refuses shorter faces; more than it, also after the file's 12 digits


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        self.exit(USAGE, f"lamella.cells: {message}\n")


def _parser() -> argparse.ArgumentParser:
    p = _Parser(prog="python3 -m lamella.cells", description="A tissue file of a label image.", allow_abbrev=False)
    p.add_argument("labels", metavar="LABELS", help=".tif, .png or .npy: a whole number per pixel, 0 is background")
    p.add_argument("-o", "--output", metavar="TISSUE.json", required=True)
    p.add_argument("--as", dest="way", choices=("patch", "mirror", "period"), default="patch",
                   help="the picture as it is; mirrored; a periodic tessellation like it (default: patch)")
    p.add_argument("--pixel", metavar="LENGTH", help='edge of a pixel, "0.65 um" (default: the tags of a TIFF)')
    p.add_argument("--wall-thickness", metavar="LENGTH",
                   help="of one cell's wall (default: half of the background between cells)")
    p.add_argument("--gap", metavar="LENGTH", help="widest background that is a wall and no air; pixels, or with a "
                   "unit (default: twice the median one, at least 3 pixels)")
    p.add_argument("--error", metavar="LENGTH", default="1",
                   help="by which a wall may leave its straight faces; pixels, or with a unit (default: 1)")
    p.add_argument("--merge", metavar="SHARE", type=float, default=0.0,
                   help="of the mean face: shorter faces become points (default: those that the solver refuses)")
    p.add_argument("--pieces", choices=("largest", "refuse"), default="largest", help="of a label of several pieces")
    p.add_argument("--crop", metavar="LEFT,TOP,RIGHT,BOTTOM", help="pixels from the upper left corner")
    p.add_argument("--overwrite", action="store_true",
                   help="replace a file that is no tissue of Lamella, too; never the picture")
    p.add_argument("--json", action="store_true", help="an object in place of the table")
    return p


def _pixel(told: argparse.Namespace) -> tuple[float, str]:
    """um, and where it is from."""
    metres = quantity(told.pixel, "length") if told.pixel else None
    where = "of --pixel"
    if metres is None:
        metres = pictures.resolution(told.labels)
        where = "of the picture's tags"
    if metres is None:
        raise InputError(f'{told.labels}: has no tags of its resolution: give --pixel, as "0.65 um"')
    if not 0 < metres < np.inf:
        raise InputError(f"--pixel: {metres:g} m: it must be positive")
    return metres * METRE, where


def _pixels(told: argparse.Namespace, name: str, pixel: float) -> float | None:
    """A length of an option in pixels."""
    text = getattr(told, name)
    if text is None:
        return None
    try:
        value = float(text)
    except ValueError:
        try:
            value = quantity(text, "length") * METRE / pixel
        except InputError as error:
            raise InputError(f"--{name.replace('_', '-')}: {error}") from None
    if not 0 < value < np.inf:
        raise InputError(f"--{name} {text}: it must be positive")
    return value


def _cropped(labels: np.ndarray, text: str | None) -> np.ndarray:
    if text is None:
        return labels
    try:
        left, top, right, bottom = map(int, text.split(","))
    except ValueError:
        raise InputError(f"--crop {text}: four whole numbers are wanted, such as 0,0,500,400") from None
    rows, columns = labels.shape
    if not (0 <= left < right <= columns and 0 <= top < bottom <= rows):
        raise InputError(f"--crop {text}: left < right up to {columns} and top < bottom up to {rows} are wanted")
    return labels[top:bottom, left:right]


def _thickness(told: argparse.Namespace, walls: Walls, picture: pictures.Picture, pixel: float) -> float:
    """Pixels; half of the mean width of the background between cells, unless it is told."""
    if told.wall_thickness:
        if told.wall_thickness.replace(".", "").isdigit():
            raise InputError(f'--wall-thickness {told.wall_thickness}: has no unit: "2 um" is wanted')
        return _pixels(told, "wall_thickness", pixel)  # type: ignore[return-value]
    width = picture.lines / walls.faces()[0]
    if width < 1:
        raise InputError("--wall-thickness is wanted: labels touch each other, so that the picture has no walls")
    picture.told.append(f"wall thickness {width / 2 * pixel:.4g} {UNIT}: half of the mean background between cells, "
                        f"{width:.3g} pixels")
    return width / 2


def _check(tissue: Tissue, names: np.ndarray, thickness: float) -> None:
    """InputError that tells of labels, too."""
    try:
        tissue.check()
    except InputError as error:
        told = dict.fromkeys(int(names[int(k)]) for k in re.findall(r"\bcells? (\d+)", str(error)))
        if told:
            raise InputError(f"{error} (of label {' and '.join(map(str, told))}): join it with a neighbour in the "
                             f"picture, or give walls below {thickness:.3g} pixels or a smaller --error") from None
        raise


def convert(told: argparse.Namespace) -> tuple[Tissue, dict[str, Any]]:
    """The tissue, and what was done and how well it fits."""
    labels = _cropped(pictures.read(told.labels), told.crop)
    pixel, where = _pixel(told)
    picture = pictures.prepare(labels, _pixels(told, "gap", pixel), told.pieces)
    error = _pixels(told, "error", pixel)
    assert error is not None
    walls = Walls(picture, error)
    thickness = _thickness(told, walls, picture, pixel)
    thin = picture.thin(thickness, told.way == "mirror")
    while True:
        if len(thin):
            picture.give_away(thin)
            walls = Walls(picture, error)
        length, number = walls.faces()
        merged = walls.merge(max(told.merge * length / number, SHORTEST * thickness))
        size, cells = walls.top * pixel, np.array(list(walls.around))
        seen, limited = borders.patch(walls, picture, pixel, thickness * pixel, UNIT)
        tissue, source = borders.mirror(seen, size) if told.way == "mirror" else (seen, np.arange(len(cells)))
        thin = np.unique(cells[source[borders.lumens(tissue) <= 0]])
        if not len(thin):
            break
    if borders.outer_sides(seen, size).any(1).all():
        raise InputError(f"{told.labels}: the picture's border cuts all of its {len(cells)} cells, so that none can be measured: "
                         "take a larger picture")
    names = picture.names[cells - 1]
    if told.way == "period":
        tissue, source, merged = borders.period(seen, picture, pixel, size)
    _check(tissue, names[source], thickness)
    rms = float(np.sqrt((walls.deviations() ** 2).mean()))
    if walls.bends() > len(names):
        walls.told.append(f"{walls.bends()} bends: walls are curved; or they are jagged, then --error "
                          f"{JAGGED * rms:.2g} leaves only a few")
    report = {"as": told.way, "pixel": pixel, "pixel_from": where, "pixels": labels.shape[::-1],
              "gap": picture.gap * pixel, "deviation_largest": walls.deviations().max() * pixel,
              "deviation_rms": rms * pixel, "faces_merged": merged,
              "edges_without_lumen": borders.without_lumen(tissue), "bends": walls.bends(),
              "pockets": len(picture.pockets), "pockets_limited": limited, "wall_thickness": thickness * pixel,
              "told": picture.told + walls.told}
    report["fit"] = borders.fit(tissue, source, seen, walls, picture, pixel)
    tissue.made_by = {"program": "lamella.cells", "picture": Path(told.labels).name, "labels": names[source].tolist(),
                      **report}
    return tissue, report


def table(tissue: Tissue, report: dict[str, Any]) -> list[str]:
    """Lines: what was done, what the tissue is, how well it fits."""
    got, fit = tissue.statistics(), report["fit"]
    columns, rows = report["pixels"]
    lines = [("picture", f"{columns} x {rows} pixels of {report['pixel']:.4g} {UNIT} ({report['pixel_from']}); "
                         f"background up to {report['gap']:.4g} {UNIT} is a wall"),
             ("tissue", f"{report['as']} of {got['cells']} cells" + ("" if tissue.period is None else
              f", period {np.hypot(*tissue.period[0]):.5g} x {np.hypot(*tissue.period[1]):.5g} {UNIT}")),
             ("walls", f"{report['wall_thickness']:.4g} {UNIT} thick; pixels differ from faces by "
                       f"{report['deviation_rms']:.2g} {UNIT} (rms), {report['deviation_largest']:.3g} at most; "
                       f"{report['bends']} bends, {report['faces_merged']} short faces merged"),
             ("size", f"mean area {got['area_mean']:.5g} {UNIT}^2, its variation {got['area_variation']:.3f}"),
             ("shape", f"4 pi A/P^2 {got['shape_factor']:.3f}; elongation {got['elongation']:.3f} at "
                       f"{got['direction']:.1f} deg; whole cells of the picture {fit['shape_factor_picture']:.3f}, "
                       f"{fit['elongation_picture']:.3f} at {fit['direction_picture']:.1f} deg"),
             ("edges", f"shortest {got['edge_shortest']:.3g} {UNIT}, mean {got['edge_mean']:.3g} {UNIT}; "
                       f"{report['edges_without_lumen']} too short for the wall beside them (--merge)"),
             ("whole cells", f"{fit['cells_whole']}: areas {100 * fit['area_error_mean']:+.3f} % on average, "
                             f"{100 * fit['area_error_largest']:.3f} % at most, from those of their pixels"),
             ("neighbours", f"{fit['pairs_kept']} of {fit['pairs']} pairs kept, {fit['pairs_new']} new"),
             ("porosity", f"{fit['porosity']:.4f}, in the picture {fit['porosity_picture']:.4f}")]
    if report["pockets"]:
        lines.append(("pockets", f"{report['pockets']} of air at junctions became rounded corners, "
                                 f"{report['pockets_limited']} of them smaller, as edges are short"))
    return [f"{name:12s} {text}" for name, text in lines + [("", text) for text in report["told"]]]


def run(told: argparse.Namespace) -> None:
    output(told.output, told.overwrite, [told.labels])
    ended = shown("finds the cells and their walls")
    tissue, report = convert(told)
    ended(1, 1)
    tissue.write(told.output, told.overwrite)
    if told.json:
        print(json.dumps({"file": told.output, **report, "pixels": list(report["pixels"]), "got": tissue.statistics()}))
    else:
        print("\n".join(table(tissue, report)), f"wrote {told.output}", sep="\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit status."""
    told = _parser().parse_args(arguments)
    return served("lamella.cells", lambda: run(told))


if __name__ == "__main__":
    sys.exit(main())
