"""CSV files of measured data: a line of titles and lines of cells. Mistakes are named with their line and column."""
import csv
import math
import re

from ._library import InputError

NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
COMMA = re.compile(r"[-+]?[0-9]+,[0-9]+(?:[eE][-+]?[0-9]+)?")
FORMATS = ((b"\x89HDF", "an HDF5 file"), (b"PK", "a spreadsheet or archive"), (b"\xff\xfe", "text in UTF-16"),
           (b"\xfe\xff", "text in UTF-16"), (b"%PDF", "a PDF file"))
SEPARATORS = {";": "semicolons", "\t": "tabs"}


def read(path: str, example: str) -> list[tuple[int, list[str]]]:
    """Lines that are not empty, with their numbers; all have as many cells as the first, the titles. example: of lines
    that were right, for messages."""
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as error:
        raise OSError(f"{path}: cannot be read: {error.strerror or error}; give a CSV file of measured data") from None
    wanted = f"save the data as CSV in UTF-8, with lines such as {example}"
    kind = next((kind for head, kind in FORMATS if data.startswith(head)), "not text" if b"\0" in data else "")
    if kind:
        raise InputError(f"{path}: is {kind}; {wanted}")
    lines = data.decode("utf-8-sig", "replace").splitlines()
    rows = [(number, [cell.strip() for cell in row]) for number, row in _rows(lines) if any(cell.strip() for cell in row)]
    if not rows:
        raise InputError(f"{path}: is empty; {wanted}")
    number, titles = rows[0]
    while not titles[-1]:
        titles.pop()
    for sign, name in SEPARATORS.items():
        if sign in lines[number - 1]:
            raise InputError(f"{path}:{number}: columns are separated by {name}; separate them by commas, and write the "
                             "decimal sign as a point")
    for number, row in rows:
        while len(row) > len(titles) and not row[-1]:
            row.pop()
        if len(row) != len(titles):
            commas = any(COMMA.fullmatch(f"{a},{b}") for a, b in zip(row, row[1:])) and len(row) > len(titles)
            raise InputError(f"{path}:{number}: {', '.join(row)}: {len(row)} cells under {len(titles)} titles" +
                             ("; is the decimal sign a comma? Write it as a point" * commas or f"; {wanted}"))
    return rows


def _rows(lines: list[str]) -> list[tuple[int, list[str]]]:
    """Cells of lines, each for itself: a quote that is not closed ends with its line."""
    return [(number, next(csv.reader([line], skipinitialspace=True), [])) for number, line in enumerate(lines, 1)]


def number(path: str, line: int, title: str, cell: str) -> float:
    """A finite number in a cell."""
    if NUMBER.fullmatch(cell) and math.isfinite(float(cell)):
        return float(cell)
    why = "is empty" if not cell else "has a decimal comma; write the decimal sign as a point" if COMMA.fullmatch(cell) \
        else "is not a finite number"
    raise InputError(f"{path}:{line}: column {title}: {cell + ': ' if cell else ''}{why}")
