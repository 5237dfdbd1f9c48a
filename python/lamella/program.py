"""The commands of the program, in a process of their own: studies that take long, use several ranks or write files."""
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias

from . import Scene, without_lines
from ._library import Error, InputError, library_folder
from ._served import FILES, INPUT, UNSOLVED, USAGE
from .results import Result

SceneLike: TypeAlias = Scene | str | os.PathLike[str] | dict[str, Any]
Place: TypeAlias = str | os.PathLike[str]
WITHOUT_JSON = ("plot", "completion", "manual")
# what mpirun, or MPI itself, tells the ranks of a job; not what users set: OMPI_MCA_rmaps_base_oversubscribe, ...
RANK = re.compile("OMPI_(?!MCA_|ALLOW_RUN_AS_ROOT)|OMPI_MCA_(orte_|ess|pmix|initial_wdir|mpi_oversubscribe)|"
                  "(PMIX|PRTE)_(?!MCA_)|PMI_|ORTE_")

_children: set["subprocess.Popen[str]"] = set()  # commands that run


def stop() -> None:
    """Asks all commands that run to stop: each ends as after a signal, and the `run` of it raises Error."""
    for child in list(_children):
        child.terminate()


class Run:
    """What a command has said: objects, of --json; complete: all was solved; warnings, lines of its standard error."""

    def __init__(self, objects: list[dict[str, Any]], complete: bool, warnings: list[str]) -> None:
        self.objects, self.complete, self.warnings = objects, complete, warnings

    def __getitem__(self, index: Any) -> Any:
        return self.objects[index]

    def __len__(self) -> int:
        return len(self.objects)


def _program() -> str:
    installed = Path(__file__).resolve().parents[4] / "bin" / "lamella"  # with the package in share/lamella/python
    for path in (os.environ.get("LAMELLA_PROGRAM"), library_folder / "lamella", installed, shutil.which("lamella")):
        if path and Path(path).is_file():
            return str(path)
    raise ImportError(f"no program lamella in {library_folder}, {installed.parent} or PATH: build Lamella (./setup.sh), or "
                      "name the program by the variable LAMELLA_PROGRAM")


def environment(**changes: str) -> dict[str, str]:
    """Of processes that are started: they are no ranks of the job that this one may be a rank of."""
    return {name: value for name, value in os.environ.items() if not RANK.match(name)} | changes


def run(command: str, *arguments: Any, ranks: int = 1) -> Run:
    """Runs a command: run("fe2", "scene.yaml", "-o", "block.h5", ranks=2).

    arguments: as on the command line; numbers and paths may be given as they are. Units are those of the command's
    JSON, as MPa and um. Returns a Run, also where states were not solved (`complete` is then False). InputError: the
    usage, the scene or a file is wrong; OSError: a file cannot be read or written; Error: a fault. Ctrl-C ends the
    command as it does in a terminal: what was committed stays, and --resume goes on.
    """
    if ranks < 1:
        raise InputError(f"ranks: {ranks}: at least 1")
    words = [_program(), command, *(str(argument) for argument in arguments)]
    if command not in WITHOUT_JSON:
        words.append("--json")
    if ranks > 1:
        words = ["mpirun", "-n", str(ranks), *words]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          env=environment()) as child:
        _children.add(child)
        try:
            out, err = child.communicate()
        except KeyboardInterrupt:
            child.send_signal(signal.SIGINT)  # from a terminal it has it already; the third would end it at once
            child.communicate()
            raise
        finally:
            _children.discard(child)
    status = child.returncode
    if status in (USAGE, INPUT):
        raise InputError(err.strip())
    if status == FILES:
        raise OSError(err.strip())
    if status not in (0, UNSOLVED):
        raise Error(f"lamella {command} has ended with status {status}: {err.strip()}")
    objects = [json.loads(line) for line in out.splitlines() if line.startswith("{")]
    return Run(objects, status == 0, err.splitlines())


@contextmanager
def path_of(scene: SceneLike) -> Iterator[str]:
    """The scene as a file: its own, or for as long as it is needed one beside the files that it names."""
    if isinstance(scene, dict):
        scene = Scene(scene)
    if not isinstance(scene, Scene) or scene.text is None:
        yield scene.path if isinstance(scene, Scene) else os.fspath(scene)
        return
    folder = os.path.dirname(scene.path) or "."
    with tempfile.NamedTemporaryFile("w", prefix=".lamella-", suffix=".yaml", encoding="utf-8",
                                     dir=folder if os.access(folder, os.W_OK) else None) as file:
        file.write(scene.text)
        file.flush()
        try:
            yield file.name
        except Error as error:
            words = str(error) if scene.has_lines else without_lines(str(error), file.name)
            raise type(error)(words.replace(file.name, scene.path)) from None


def study(command: str, scene: SceneLike, ranks: int, **options: Any) -> None:
    """Runs a command on a scene. options: those of the command line, `_` for `-`; None and False: left out. What the
    command warns of, and states without a solution, are warnings."""
    words = []
    for name, value in options.items():
        if value is not None and value is not False:
            words += [f"--{name.replace('_', '-')}", *([] if value is True else [value])]
    with path_of(scene) as path:
        told = run(command, path, *words, ranks=ranks)
    if told.warnings:
        warnings.warn("\n".join(told.warnings), stacklevel=3)


def fe2(scene: SceneLike, output: Place, database: Place | None = None, *, ranks: int = 1, response: str | None = None,
        certify: bool | None = None, resume: bool = False, overwrite: bool = False) -> Result:
    """Solves the body of a scene, `lamella fe2`, and writes the file `output`.

    database: one that is queried, and added to; response: "direct", "cache" or "database"; certify: all reactions by
    direct solves, or none (default: the last); overwrite: files that Lamella did not write are replaced, too. Returns
    the Result: `steps`, `boundaries`, `displacement` and `reaction` [steps, sides, 2] in m and N/m, `mesh`, `fields(step)`, `summary`, and `status`: "done", or why it ended.
    """
    study("fe2", scene, ranks, output=output, database=database, response=response, certify=certify is True,
          no_certify=certify is False, resume=resume, overwrite=overwrite)
    return Result(output)


def process(scene: SceneLike, output: Place, database: Place | None = None, *, ranks: int = 1,
            response: str | None = None, frames: int | None = None, overwrite: bool = False) -> Result:
    """Follows the tissue of a scene in time, `lamella process`, and writes the file `output`.

    database, response: as of fe2; frames: number of states whose cells are kept besides those of events. Returns the
    Result: `time` [s], `temperature` [K], `turgor` and `firmness` [Pa], `water`, `event`, ..., `responses` of the
    states of a material point, and `status`: "done", or why it ended; of a body also what fe2 returns.
    """
    study("process", scene, ranks, output=output, database=database, response=response, frames=frames,
          overwrite=overwrite)
    return Result(output)


def map(scene: SceneLike, output: Place, *, ranks: int = 1, resume: bool = False, overwrite: bool = False) -> Result:
    """Finds how tissue fails over two quantities, `lamella map`, and writes the file `output`.

    Returns the Result: `axes`, and over them [y, x] `mode` ("none", "separation", ...), `criterion`, `load_factor` and
    `place`; `responses` of the points that have one, number x + y times the points along x of `keys`.
    """
    study("map", scene, ranks, output=output, resume=resume, overwrite=overwrite)
    return Result(output)
