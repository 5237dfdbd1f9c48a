"""What `lamella tissue` runs: one argument, a JSON object with its options as texts and where the tissue goes."""
import json
import re
import sys
from typing import Any

import numpy as np

from .. import InputError, quantity
from .._served import progress as shown, served
from . import file
from .make import Asked, make
from .report import table

NUMBERS = ("variation", "elongation", "aspect", "gas")
UNIT = re.compile(r"\s*[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?\s*(.*\S)")  # of a quantity that is one


def _quantity(request: dict[str, Any], name: str, dimension: str) -> float:
    """A quantity in SI units."""
    try:
        return quantity(request[name], dimension)
    except InputError as error:
        raise InputError(f"--{name.replace('_', '-')} {error}") from None


def _number(request: dict[str, Any], name: str) -> float:
    try:
        return float(request[name])
    except ValueError:
        raise InputError(f"--{name} {request[name]}: a number is wanted") from None


def asked_of(request: dict[str, Any]) -> Asked:
    """Asked, of options as texts; lengths are in the unit of the size."""
    size = _quantity(request, "size", "length")
    unit = UNIT.sub(r"\1", request["size"]).strip()
    scale = quantity(f"1 {unit}", "length")
    numbers = {name: _number(request, name) for name in NUMBERS if name in request}
    if "wall_thickness" in request:
        numbers["wall_thickness"] = _quantity(request, "wall_thickness", "length") / scale
    if "direction" in request:
        numbers["direction"] = np.degrees(_quantity(request, "direction", "angle"))
    rounded = {name: float(f"{value:.12g}") for name, value in numbers.items()}  # 4e-06 m is 4 um
    return Asked(request["cells"], float(f"{size / scale:.12g}"), unit, seed=request.get("seed", 0), **rounded)


def run(request: dict[str, Any]) -> None:
    """Makes the tissue, writes it, and tells what it is."""
    asked, output, overwrite = asked_of(request), request["output"], request.get("overwrite", False)
    file.output(output, overwrite)
    ended = shown("makes the tissue")
    tissue = make(asked)
    ended(1, 1)
    tissue.write(output, overwrite)
    if request.get("json"):
        print(json.dumps({"file": output, "asked": tissue.made_by["asked"], "got": tissue.made_by["got"]}))
    else:
        print("\n".join(table(tissue)), f"wrote {output}", sep="\n")
    sys.stdout.flush()


def main(argument: str) -> int:
    """Exit status of a request."""
    return served("lamella tissue", lambda: run(json.loads(argument)))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
