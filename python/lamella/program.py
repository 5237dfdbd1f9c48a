"""The commands of the program, in a process of their own: studies that take long, use several ranks or write files."""
import json
import os
import shutil
import subprocess
from pathlib import Path

from ._library import Error, InputError, library_folder

USAGE, INPUT, UNSOLVED, FILES = 1, 2, 3, 4  # exit statuses (docs/reference/commands.md)
WITHOUT_JSON = ("plot", "completion", "manual")


class Run:
    """What a command has said: objects, of --json; complete: all was solved; warnings, lines of its standard error."""

    def __init__(self, objects, complete, warnings):
        self.objects, self.complete, self.warnings = objects, complete, warnings

    def __getitem__(self, index):
        return self.objects[index]

    def __len__(self):
        return len(self.objects)


def _program():
    for path in (os.environ.get("LAMELLA_PROGRAM"), library_folder / "lamella", shutil.which("lamella")):
        if path and Path(path).is_file():
            return str(path)
    raise ImportError("no program lamella: tell it by the variable LAMELLA_PROGRAM")


def run(command, *arguments, ranks=1):
    """Runs a command: run("fe2", "scene.yaml", "-o", "block.h5", ranks=2).

    arguments: as on the command line; numbers and paths may be given as they are. Units are those of the command's JSON, as
    MPa and um. Returns a Run, also where states were not solved (`complete` is then False). InputError: the usage, the
    scene or a file is wrong; OSError: a file cannot be read or written; Error: a fault. Ctrl-C ends the command as it
    does in a terminal: what was committed stays, and --resume goes on.
    """
    words = [_program(), command, *map(str, arguments)]
    if command not in WITHOUT_JSON:
        words.append("--json")
    if ranks > 1:
        words = ["mpirun", "-n", str(ranks), *words]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            out, err = process.communicate()
        except KeyboardInterrupt:
            process.wait()  # it has the signal, too
            raise
    status = process.returncode
    if status in (USAGE, INPUT):
        raise InputError(err.strip())
    if status == FILES:
        raise OSError(err.strip())
    if status not in (0, UNSOLVED):
        raise Error(f"lamella {command} has ended with status {status}: {err.strip()}")
    objects = [json.loads(line) for line in out.splitlines() if line.startswith("{")]
    return Run(objects, status == 0, err.splitlines())
