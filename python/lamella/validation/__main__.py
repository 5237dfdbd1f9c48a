"""What `lamella validate` does: solves the experiments, tells what agrees, and writes the page and its picture."""
import dataclasses
import json
import math
import sys
import time
from importlib import import_module
from pathlib import Path
from typing import Any

from .. import InputError
from .._files import beginning, make_folder, may_write, write_whole
from .._served import end_with_program, progress as shown, served
from . import Experiment, experiments
from .page import TITLE, WHAT, counts, misses, number, page, summary


def _told(e: Experiment) -> dict[str, Any]:
    """As an object of JSON."""
    return {"name": e.name, "title": e.title, "source": e.source, "verdict": e.verdict,
            "miss": e.miss if math.isfinite(e.miss) else None,
            "rows": [dataclasses.asdict(row) | {"inside": row.inside, "within": row.within} for row in e.rows],
            "modes": [dataclasses.asdict(mode) | {"right": mode.right} for mode in e.modes]}


def _print(e: Experiment, seconds: float) -> None:
    print(f"{e.name}: {e.title} ({seconds:.0f} s)")
    for row in e.rows:
        word = ("fitted" if row.fitted else "agrees" if row.inside else "agrees by its interval" if row.within
                else f"misses by a factor of {number(row.miss)}")
        print(f"  {row.what}: {number(row.predicted)} {row.unit}".rstrip() +
              f", measured {number(row.low)} to {number(row.high)}: {word}")
    for mode in e.modes:
        print(f"  {mode.what}: {mode.found}" + ("" if mode.right else f"; seen: {mode.seen}"))
    sys.stdout.flush()


def run(request: dict[str, Any]) -> None:
    """Solves the experiments that are asked for, or all."""
    of = experiments()
    if request.get("list"):
        print("\n".join(of))
        return
    names = request["only"].split(",") if request.get("only") else list(of)
    for name in names:
        if name not in of:
            raise InputError(f"--only {name}: there is no such experiment; there are {', '.join(of)}")
    if request.get("output"):
        may_write(make_folder(request["output"]) / "validation.md", beginning(f"{TITLE}\n\n{WHAT}"),
                  "the page of lamella validate", request.get("overwrite", False))
        import_module("lamella.plot")  # what it needs may be missing
    told = []
    for k, name in enumerate(names):
        start, ended = time.monotonic(), shown(f"experiment {k + 1} of {len(names)}, {name}")
        told.append(of[name]())
        ended(1, 1)
        if request.get("json"):
            print(json.dumps(_told(told[-1])), flush=True)
        else:
            _print(told[-1], time.monotonic() - start)
    if request.get("json"):
        print(json.dumps({"summary": counts(told), "misses": [[e.name, row.what] for e, row in misses(told)]}))
    else:
        print(summary(told))
    if request.get("output"):
        _write(Path(request["output"]), told, bool(request.get("json")))


def _write(folder: Path, told: list[Experiment], silent: bool) -> None:
    plot, picture = (import_module(f"lamella.plot{part}") for part in ("", ".validation"))
    write_whole(folder / "validation.md", page(told))
    plot.save(picture.draw(told), str(folder / "validation.png"), 200)
    if not silent:
        print(f"wrote {folder / 'validation.md'} and {folder / 'validation.png'}", flush=True)


def main(argument: str) -> int:
    """Exit status of a request."""
    end_with_program()
    return served("lamella validate", lambda: run(json.loads(argument)))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
