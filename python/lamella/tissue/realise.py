"""How large a period must be: many tissues like that of a scene, solved along its load (`lamella rve --realisations`).

A folder has of each realisation, K of N cells, the tissue N-K.json, its scenes N-K.yaml and N-K.rest.yaml, and what
`lamella rve` has told of them, N-K.states.json; what is there is not solved again.
"""
from __future__ import annotations

import dataclasses
import json
import os
import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeAlias

from .. import Error, InputError, Scene, parallel, program, scene_dict
from .._files import inputs_of, make_folder, may_write, write_whole
from .._served import end_with_program, progress as shown, served
from . import realised, scatter
from .file import Tissue
from .make import Asked

NUMBERS = 10000  #: seed = cells * NUMBERS + realisation: another one for each, below 1e9, the largest of a scene
KEPT = ("version", "rve", "strength", "load", "accuracy")  #: blocks that `lamella rve` uses
AT_REST = [{"F": [[1, 0], [0, 1]]}]  #: the load whose tangent isotropy is judged by
Object: TypeAlias = dict[str, Any]


def _words(error: Exception) -> str:
    """A message without the command that it came from."""
    return re.sub(r"^lamella[ a-z]*: ", "", str(error))


def _read(path: Path) -> Any:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise InputError(f"{path}: is damaged: {error}; remove it") from None


def _asked(path: str, scene: Object) -> Asked:
    """What was asked of the tissue of a scene. InputError: it was not made by `lamella tissue`."""
    if "tissue" not in scene["rve"]:
        raise InputError(f"{path}: rve.tissue is missing: realisations are tissues like that of a file which "
                         "`lamella tissue` has made")
    file = Path(path).parent / scene["rve"]["tissue"]
    made_by = Tissue.read(file).made_by
    try:
        if made_by["program"] != "lamella tissue":
            raise KeyError
        asked = Asked(**made_by["asked"])
        asked.check()
    except (KeyError, TypeError):
        raise InputError(f"{file}: was not made by `lamella tissue`: its made_by does not tell what was asked, so no "
                         "other tissue like it can be made") from None
    except InputError as error:
        raise InputError(f"{file}: made_by: {error}") from None
    return asked


def _base(path: str, asked: Asked) -> Object:
    """The scene that realisations share, with the mesh that the scene's own tissue gets."""
    scene = scene_dict(path)
    variation = scene["rve"].get("variation") or {}
    if "list" in variation:
        raise InputError(f"{path}: rve.variation.list: is of the cells of one tissue; write random, which all have")
    told = program.run("check", path)
    for warning in told.warnings:
        print(f"lamella rve: {_words(Error(warning))}", file=sys.stderr)
    mesh = {name: told[0]["mesh"][name] for name in ("along", "through", "grading")}
    base: Object = json.loads(json.dumps({name: scene[name] for name in KEPT if name in scene}))
    base["rve"]["mesh"] = mesh
    return base


@dataclasses.dataclass(frozen=True)
class Plan:
    """What realisations share: what is asked of tissues, but for cells and seed; the scene; where files are."""
    asked: Asked
    scene: Object
    folder: Path

    @property
    def failure(self) -> bool:
        """Whether it is asked how the tissue fails."""
        return "strength" in self.scene or (self.scene["rve"].get("interface") or {}).get("law") == "lamella"

    def settle(self, jobs: Sequence["Job"], overwrite: bool, inputs: Sequence[str]) -> None:
        """Takes the folder. InputError: it has realisations of something else, or other files of their names."""
        told = {"asked": dataclasses.asdict(dataclasses.replace(self.asked, cells=0, seed=0)), "scene": self.scene}
        file = self.folder / "scene.json"
        if not file.exists():
            names = [job.file(self, ending) for job in jobs for ending in ("json", "yaml", "rest.yaml", "states.json")]
            for path in (file, self.folder / "realisations.json", *names):
                may_write(path, lambda _: False, "of these realisations", overwrite, inputs)
            write_whole(file, json.dumps(told, indent=2) + "\n")
        elif _read(file) != told:
            raise InputError(f"{self.folder}: has realisations of another scene or tissue: give another folder by -o, "
                             "or remove it")


@dataclasses.dataclass(frozen=True)
class Job:
    """One realisation, from 1."""
    cells: int
    number: int

    @property
    def seed(self) -> int:
        """Of its tissue, and of what its scene deals out at random."""
        return self.cells * NUMBERS + self.number

    def file(self, plan: Plan, ending: str) -> Path:
        """One of its files."""
        return plan.folder / f"{self.cells}-{self.number:04d}.{ending}"


def _make(plan: Plan, job: Job) -> Path:
    """The file of its tissue, made unless it is there."""
    path, a = job.file(plan, "json"), plan.asked
    if not path.exists():
        words = ["--cells", job.cells, "--seed", job.seed, "--size", f"{a.size:.12g} {a.unit}", "--direction",
                 f"{a.direction:.12g} deg"]
        for name in ("variation", "elongation", "aspect", "gas"):
            words += [f"--{name}", f"{getattr(a, name):.12g}"]
        if a.wall_thickness is not None:
            words += ["--wall-thickness", f"{a.wall_thickness:.12g} {a.unit}"]
        program.run("tissue", "-o", path, *words)
    return path


def _scene_of(plan: Plan, job: Job, tissue: Path) -> Object:
    scene: Object = json.loads(json.dumps(plan.scene))
    scene["rve"]["tissue"] = tissue.name
    for block in ("random", "field"):
        if block in (scene["rve"].get("variation") or {}):
            scene["rve"]["variation"][block]["seed"] = job.seed
    return scene


def _rve(plan: Plan, job: Job, ending: str, scene: Object, *options: str) -> Object:
    """What `lamella rve` tells: states by their numbers from 1, failure and test."""
    path = job.file(plan, ending)
    write_whole(path, json.dumps(scene, indent=2) + "\n")
    told: Object = {"states": []}
    for entry in program.run("rve", path, "--tangent", "--no-estimate", *options).objects:
        if "state" in entry:
            told["states"].append(entry)
        else:
            told |= entry
    return told


def _solve(plan: Plan, job: Job) -> Object:
    """What is told of a realisation, solved unless its file is there."""
    path = job.file(plan, "states.json")
    if path.exists():
        return _read(path)
    scene = _scene_of(plan, job, _make(plan, job))
    rest = {name: value for name, value in scene.items() if name != "strength"} | {"load": AT_REST}
    told = {"seed": job.seed, "rest": _rve(plan, job, "rest.yaml", rest)["states"][0]}
    told |= _rve(plan, job, "yaml", scene, *(["--failure", "--readings"] if plan.failure else []))
    write_whole(path, json.dumps(told) + "\n")
    return told


def _solve_all(plan: Plan, jobs: list[Job], processes: int,
               progress: Callable[[int, int], None]) -> dict[Job, Object | str]:
    """Of each job what is told, or why nothing is."""
    solved = parallel.commands(lambda job: _solve(plan, job), jobs, processes, progress)
    return {job: _words(told) if isinstance(told, Error) else told for job, told in zip(jobs, solved)}


def realise(scene: str | os.PathLike[str], realisations: int, cells: Sequence[int] | None = None,
            processes: int | None = None, output: str | os.PathLike[str] = "realisations", overwrite: bool = False,
            progress: Callable[[int, int], None] = lambda done, total: None) -> Object:
    """Makes so many tissues of each number of cells like that of the scene, solves its load for each, and returns what
    is told of them, the object of `--json` (docs/reference/realisations.md), which is also in realisations.json.

    cells: default: as many as the scene's tissue has; processes: at a time, default the number of processors; output:
    the folder of all files; overwrite: files of their names that are of no realisation are replaced; progress(done,
    total) is called after each. InputError: the scene's tissue was not made by `lamella tissue`, or none of the
    realisations could be solved.
    """
    path = os.fspath(scene)
    if not len(Scene(path)):
        raise InputError(f"{path}: has no block `load`")
    asked = _asked(path, scene_dict(path))
    sizes = sorted(set(cells or [asked.cells]))
    for n in sizes:
        if not scatter.LEAST <= n <= scatter.MOST:
            raise InputError(f"--cells {n}: {scatter.LEAST} to {scatter.MOST} are wanted")
    if not 2 <= realisations < NUMBERS:
        raise InputError(f"--realisations {realisations}: 2 to {NUMBERS - 1} are wanted")
    plan = Plan(asked, _base(path, asked), make_folder(output))
    jobs = [Job(n, k) for n in sizes for k in range(1, realisations + 1)]
    plan.settle(jobs, overwrite, inputs_of(path))
    solved = _solve_all(plan, jobs, parallel.count(processes), progress)
    if all(isinstance(told, str) for told in solved.values()):
        raise InputError(f"none of {len(jobs)} realisations could be solved; the first one: {solved[jobs[0]]}")
    told = realised.summary(path, plan, solved, len(Scene(path)))
    write_whole(plan.folder / "realisations.json", json.dumps(told, allow_nan=False) + "\n")
    return told


def _cells(text: str | None) -> list[int] | None:
    if text is None:
        return None
    if not re.fullmatch(r"\d{1,6}(,\d{1,6})*", text):
        raise InputError(f"--cells {text}: numbers of cells are wanted, such as 25,50,100")
    return [int(part) for part in text.split(",")]


def run(request: Object) -> int:
    """Solves, and tells; the exit status: 3 where a state of a realisation has no answer."""
    from .realised_report import table
    folder = request["output"]
    try:
        told = realise(request["scene"], request["realisations"], _cells(request.get("cells")),
                       request.get("processes"), folder, request.get("overwrite", False),
                       (lambda done, total: None) if request.get("quiet") else shown("realisations"))
    except KeyboardInterrupt:
        print(f"lamella rve: stopped: the same command goes on with what is in {folder}", file=sys.stderr)
        raise
    if request.get("json"):
        print(json.dumps(told))
    else:
        print("\n".join(table(told)), f"wrote {folder}/realisations.json", sep="\n")
    sys.stdout.flush()
    return program.UNSOLVED if told["failed"] else 0


def main(argument: str) -> int:
    """Exit status of a request."""
    end_with_program()
    return served("lamella rve", lambda: run(json.loads(argument)))
