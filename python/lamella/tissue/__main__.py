"""What `lamella tissue` runs: one argument, a JSON object with its options as texts and where the tissue goes."""
import json
import re
import sys
from collections.abc import Callable
from typing import Any

import numpy as np

from .. import Error, InputError, quantity
from .make import Asked, make
from .report import table

INPUT, IO, FAULT = 2, 4, 70  # exit statuses (docs/reference/commands.md)
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
    tissue, output = make(asked_of(request)), request["output"]
    tissue.write(output)
    if request.get("json"):
        print(json.dumps({"file": output, "asked": tissue.made_by["asked"], "got": tissue.made_by["got"]}))
    else:
        print("\n".join(table(tissue)), f"wrote {output}", sep="\n")
    sys.stdout.flush()


def served(command: str, run: Callable[[dict[str, Any]], int | None], argument: str) -> int:
    """Exit status of a request, what is wrong with it told in words."""
    try:
        return run(json.loads(argument)) or 0
    except InputError as error:
        status, message = INPUT, str(error)
    except OSError as error:
        status, message = IO, str(error)
    except MemoryError:
        status, message = FAULT, "out of memory"
    except Error as error:
        status, message = FAULT, str(error)
    except KeyboardInterrupt:
        return 130
    print(f"lamella {command}: {message}", file=sys.stderr)
    return status


def main(argument: str) -> int:
    """Exit status of a request."""
    return served("tissue", run, argument)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
