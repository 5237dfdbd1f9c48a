"""Label images: an integer per pixel, 0 is background. Thin background between cells is shared out to them, wide
background is air, small pockets of air at junctions are kept apart. Lengths are pixels; x points right, y up."""
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy import ndimage
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from .. import InputError, quantity

SPECK = 0.02  #: of the median cell's area: smaller cells, of a seventh of its diameter, are no cells
WIDEST = 0.25  #: of the mean cell's diameter: labels that are farther apart on the median are no cells of one tissue
POCKET = 0.038  #: of the mean cell's area: air at a corner of hexagons whose walls part at the limit, 0.45 of an edge
ROOM = 1.25  #: inscribed circle of a cell over its wall: lumens keep a fifth of it
SCREENS = (72, 96)  #: dots per inch that programs write which know no scale


@dataclass
class Picture:
    """labels [rows, columns]: 0 air, k the cell names[k - 1] of the file; row 0 is the lowest. pockets [n, 3]: x, y and
    area of air at junctions, where labels has cells. gap: width up to which background is a wall; lines: pixels of
    background between cells that were shared out; air: share of the picture. told: what was done to it, in words."""
    labels: np.ndarray
    names: np.ndarray
    gap: float
    lines: int = 0
    air: float = 0.0
    pockets: np.ndarray = field(default_factory=lambda: np.empty((0, 3)))
    told: list[str] = field(default_factory=list)

    def thin(self, thickness: float, mirrored: bool) -> np.ndarray:
        """Labels of cells that have no room for walls [pixels]; mirrored: the border cuts no cell. InputError: most
        have none."""
        padded = np.pad(self.labels, 1, "edge") if mirrored else np.pad(self.labels, 1, constant_values=-1)
        rim = np.zeros(padded.shape, bool)
        for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
            rim |= padded != np.roll(padded, step, axis)
        room = ndimage.distance_transform_edt(~rim)[1:-1, 1:-1] + 0.5
        index = np.unique(self.labels[self.labels > 0])
        inscribed = np.array(ndimage.maximum(room, self.labels, index))
        if np.median(inscribed) < ROOM * thickness:
            raise InputError(f"--wall-thickness: walls are {thickness:.3g} pixels thick, and half of the cells have no "
                             f"circle within them of a radius of {np.median(inscribed):.3g}")
        return index[inscribed < ROOM * thickness]

    def give_away(self, cells: np.ndarray) -> None:
        """These labels go to their neighbours."""
        self.told.append("cells that have no room for their walls went to their neighbours: "
                         f"{few(self.names[cells - 1])}")
        place = ndimage.distance_transform_edt(np.isin(self.labels, cells), return_distances=False, return_indices=True)
        self.labels = self.labels[tuple(place)]

    def fill(self) -> None:
        """What lies within one cell, be it background or cells, becomes part of it. InputError: all others do."""
        boxes = ndimage.find_objects(self.labels)
        for host in sorted(np.unique(self.labels[self.labels > 0]), key=lambda k: -_area(boxes[k - 1])):
            part = self.labels[boxes[host - 1]]
            number, count = ndimage.label(np.pad(part != host, 1, constant_values=True))
            if count < 2 or not (part == host).any():  # it lay within another one
                continue
            hole = (number > 0)[1:-1, 1:-1] & (number[1:-1, 1:-1] != number[0, 0])
            lost = self.names[np.unique(part[hole & (part > 0)]) - 1]
            part[hole] = host
            if len(lost) and (self.labels[self.labels > 0] == host).all():
                raise InputError(f"label {self.names[host - 1]} lies around all others: if it is background, give it the "
                                 "number 0")
            self.told.append(f"{'background' if not len(lost) else 'labels ' + few(lost)} within label "
                             f"{self.names[host - 1]} became part of it")


def _area(box: tuple[slice, slice]) -> int:
    return (box[0].stop - box[0].start) * (box[1].stop - box[1].start)


def read(path: str) -> np.ndarray:
    """Labels [rows, columns] of a .npy, TIFF, PNG or GIF file."""
    try:
        open(path, "rb").close()
    except OSError as error:
        raise OSError(f"{path}: cannot be read: {error.strerror}") from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of what follows as an error, or of tags
            labels = np.load(path) if Path(path).suffix == ".npy" else _image(path)
    except (InputError, MemoryError):
        raise
    except Exception as error:  # Pillow's readers have many kinds
        raise InputError(f"{path}: is no picture that can be read: {error}; give a TIFF, PNG or GIF file, or a .npy of "
                         "whole numbers") from None
    labels = np.squeeze(labels) if np.ndim(labels) > 2 else np.asarray(labels)
    if labels.ndim != 2 or not labels.size:
        raise InputError(f"{path}: has the shape {labels.shape}: one plane with a number per pixel is wanted")
    if labels.dtype.kind not in "biuf" or not np.isfinite(labels).all() or (labels != np.rint(labels)).any() \
            or labels.min() < 0:
        raise InputError(f"{path}: labels are whole numbers, 0 is background")
    return labels


def _image(path: str) -> np.ndarray:
    from PIL import Image  # type: ignore[import]
    if Path(path).suffix.lower() in (".tif", ".tiff"):
        try:
            import tifffile  # type: ignore[import]  # reads what Pillow does not: 64 bits, BigTIFF
            with tifffile.TiffFile(path) as file:
                _refuse_pages(path, len(file.pages))
                return file.asarray()
        except ImportError:
            pass
    with Image.open(path) as image:
        _refuse_pages(path, getattr(image, "n_frames", 1))
        if image.format == "JPEG":
            raise InputError(f"{path}: is a JPEG file, which changes labels; save them as TIFF or PNG")
        return np.asarray(image)


def _refuse_pages(path: str, pages: int) -> None:
    if pages != 1:
        raise InputError(f"{path}: has {pages} pages, and a label image has one: save the page that is wanted as a file "
                         "of its own")


def resolution(path: str) -> float | None:
    """Metres per pixel by the tags of a TIFF file, those of OME and ImageJ too, or None. InputError: pixels are not
    square."""
    from PIL import Image  # type: ignore[import]
    try:
        with warnings.catch_warnings(), Image.open(path) as image:
            warnings.simplefilter("ignore")
            tags: Any = getattr(image, "tag_v2", {})
            across, up, unit, words = (tags.get(k) for k in (282, 283, 296, 270))  # of TIFF 6.0
    except Exception:  # it is read later, with a message
        return None
    words = str(words or "").encode("latin-1", "replace").decode("utf-8", "replace")  # as Pillow reads what is UTF-8
    sizes = [_ome(words, axis) for axis in "XY"]
    if None in sizes:
        metres = {2: 0.0254, 3: 0.01}.get(unit)
        for line in words.splitlines():  # ImageJ's own unit
            if line.startswith("unit="):
                metres = _length(f"1 {line[5:]}")
        if not metres or not across or not up or (unit == 2 and float(across) in SCREENS):
            return None
        sizes = [metres / float(across), metres / float(up)]
    if not np.isclose(*sizes, rtol=1e-6):
        raise InputError(f"{path}: its pixels are {1e6 * sizes[0]:.6g} um wide and {1e6 * sizes[1]:.6g} um high by its "
                         "tags: resample the picture to square ones, or give --pixel if the tags are wrong")
    return sizes[0]


def _ome(words: str, axis: str) -> float | None:
    """PhysicalSize of OME-XML in m; its unit is um unless it is there."""
    size, unit = (re.search(rf'<Pixels\b[^>]*\bPhysicalSize{axis}{name}="([^"]*)"', words) for name in ("", "Unit"))
    return _length(f"{size[1]} {unit[1] if unit else 'um'}") if size else None


def _length(text: str) -> float | None:
    """In m, with the ways that pictures have of writing um; None: it is none."""
    for name in ("\\u00B5", "&#181;", "&#xB5;", "µ", "μ"):
        text = text.replace(name, "u")
    try:
        return quantity(text.replace("micron", "um"), "length")
    except InputError:
        return None


def beside(labels: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Values of all pixels and of those to their right; and above."""
    yield labels[:, :-1].ravel(), labels[:, 1:].ravel()
    yield labels[:-1].ravel(), labels[1:].ravel()


def _pieces(labels: np.ndarray) -> np.ndarray:
    """Number of the piece that each pixel is in: of one label, joined by sides."""
    pairs = zip(beside(np.arange(labels.size).reshape(labels.shape)), beside(labels))
    one, other = np.hstack([np.array(place)[:, value[0] == value[1]] for place, value in pairs])
    graph = coo_matrix((np.ones(len(one), np.int8), (one, other)), shape=(labels.size,) * 2)
    return connected_components(graph, directed=False)[1].reshape(labels.shape)


def _lesser(labels: np.ndarray) -> np.ndarray:
    """Where pieces of cells are that are not the largest one of their label."""
    piece = _pieces(labels)
    size, label = np.bincount(piece.ravel()), np.empty(piece.max() + 1, labels.dtype)
    label[piece] = labels
    order = np.lexsort((size, label))
    lesser = label > 0
    lesser[order[np.append(np.diff(label[order]) != 0, True)]] = False
    return lesser[piece]


def _open(background: np.ndarray, width: float) -> np.ndarray:
    """Where a disc of this width fits into the background, all of it; half a pixel is that of the label beside it."""
    core = ndimage.distance_transform_edt(background) > width / 2 + 0.5
    return background & (ndimage.distance_transform_edt(~core) <= width / 2 + 0.5) if core.any() else core


def few(names: np.ndarray) -> str:
    return ", ".join(map(str, names[:5])) + (f" and {len(names) - 5} more" if len(names) > 5 else "")


def _rubbish(labels: np.ndarray, given: np.ndarray, pieces: str, told: list[str]) -> np.ndarray:
    """Where lesser pieces and specks are; given: names of the labels."""
    lesser = _lesser(labels)
    if lesser.any():
        words = f"labels of several pieces: {few(given[np.unique(labels[lesser])])}"
        if pieces == "refuse":
            raise InputError(f"{words}: give each cell a number of its own, or --pieces largest")
        told.append(f"{words}: the largest was kept of each")
    area = np.bincount(labels[~lesser])
    area[0] = 0
    specks = np.flatnonzero((area > 0) & (area < SPECK * np.median(area[area > 0]))) if area.any() else area[:0]
    if len(specks):
        told.append(f"specks, smaller than {SPECK} of the median cell, were taken out: {few(given[specks])}")
    return lesser | np.isin(labels, specks)


def _spacing(labels: np.ndarray, distance: np.ndarray, nearest: np.ndarray) -> float:
    """Median width of the background where labels meet."""
    width = np.concatenate([(a + b)[p != q] for (a, b), (p, q) in zip(beside(distance), beside(nearest))])
    spacing = float(np.median(width)) if len(width) else 0.0
    diameter = np.sqrt(4 / np.pi * (labels > 0).sum() / max(len(np.unique(labels)) - 1, 1))
    if spacing > WIDEST * diameter:
        raise InputError(f"labels are {spacing:.3g} pixels apart, cells have {diameter:.3g}: give --gap, the width of "
                         "background up to which it is a wall")
    return spacing


def _pockets(labels: np.ndarray, air: np.ndarray, nearest: np.ndarray, wide: np.ndarray, gap: float) -> tuple:
    """x, y, area of small air that three cells surround, and where it is; its cusps are thinner than the gap."""
    number, count = ndimage.label(air)
    if not count:
        return np.empty((0, 3)), air
    away, place = ndimage.distance_transform_edt(number == 0, return_indices=True)
    whole = np.where(wide & (away <= 2 * gap), number[tuple(place)], 0)
    area = np.bincount(whole.ravel(), minlength=count + 1)
    rows, small = [], np.zeros(count + 1, bool)
    limit = POCKET * (labels > 0).sum() / len(np.unique(labels[labels > 0]))
    inner = np.ones(count + 1, bool)
    inner[np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]])] = False
    for k, box in enumerate(ndimage.find_objects(number), 1):
        if inner[k] and area[k] <= limit:
            here = number[box] == k
            if len(np.unique(nearest[box][here])) == 3:
                y, x = np.argwhere(here).mean(axis=0) + [box[0].start + 0.5, box[1].start + 0.5]
                rows.append((x, y, area[k]))
                small[k] = True
    return np.array(rows).reshape(-1, 3), small[number]


def _hanging(labels: np.ndarray) -> np.ndarray:
    """Labels of cells that hang at no chain of neighbours from the largest group, and so from nothing."""
    count = labels.max() + 1
    pairs = np.hstack([np.array((a, b))[:, (a != b) & (a > 0) & (b > 0)] for a, b in beside(labels)])
    group = connected_components(coo_matrix((np.ones(pairs.shape[1]), pairs), shape=(count, count)), directed=False)[1]
    here = np.unique(labels[labels > 0])
    return here[group[here] != np.bincount(group[here]).argmax()]


def _without_points(labels: np.ndarray) -> np.ndarray:
    """Air that meets air at a point only, between two cells, is closed there."""
    labels = labels.copy()
    for _ in range(labels.size):
        a, b, c, d = labels[:-1, :-1], labels[:-1, 1:], labels[1:, :-1], labels[1:, 1:]
        falling = np.argwhere((a == 0) & (d == 0) & (b > 0) & (c > 0))
        rising = np.argwhere((b == 0) & (c == 0) & (a > 0) & (d > 0))
        if len(falling) + len(rising) == 0:
            break
        for i, j in falling:
            labels[i, j] = labels[i, j + 1]
        for i, j in rising:
            labels[i, j + 1] = labels[i, j]
    return labels


def prepare(labels: np.ndarray, gap: float | None, pieces: str) -> Picture:
    """Cells and air of labels [rows, columns] as they are in the file, the first row at the top. gap: None: twice the
    median width of the background between cells (where three walls of a width meet at 120 degrees, a disc of 1.15
    widths fits; sharp corners have more), 3 pixels at least, so that frayed borders of labels are no air."""
    told: list[str] = []
    shape = labels.shape
    given, labels = np.unique(labels[::-1], return_inverse=True)  # as many numbers as labels: they may be large
    labels = np.reshape(labels, shape) + int(given[0] != 0)
    given = given if given[0] == 0 else np.append(0, given)
    rubbish = _rubbish(labels, given, pieces, told)  # goes to the cell beside it; or it would widen lines to air
    background, labels = labels == 0, np.where(rubbish, 0, labels)
    if len(np.unique(labels[labels > 0])) < 2:
        raise InputError("fewer than two labels: each cell has a number of its own in a label image; a mask of "
                         "walls and lumens is labelled first, as by scipy.ndimage.label")
    distance, place = ndimage.distance_transform_edt(labels == 0, return_indices=True)
    nearest = labels[tuple(place)]
    spacing = _spacing(labels, distance, nearest) if gap is None else gap / 2
    gap = max(2 * spacing, 3.0) if gap is None else gap
    air = _open(background, gap)
    pockets, small = _pockets(labels, air, nearest, _open(background, 0.65 * gap if spacing >= 1 else 0), gap)
    lines, share = int((background & ~air).sum()), ((air & ~small).sum() + pockets[:, 2].sum()) / air.size
    shared = np.where(air & ~small, 0, nearest)
    while (lesser := _lesser(shared)).any():
        place = ndimage.distance_transform_edt(lesser, return_distances=False, return_indices=True)
        shared = shared[tuple(place)]
    hanging = _hanging(shared)
    if len(hanging):
        told.append(f"cells that hang at no others were taken out: {few(given[hanging])}")
        shared = np.where(np.isin(shared, hanging), 0, shared)
    names, number = np.unique(_without_points(shared), return_inverse=True)
    number = number.reshape(shared.shape) + (names[0] > 0)
    return Picture(number, given[names[names > 0]], gap, lines, float(share), pockets, told)
