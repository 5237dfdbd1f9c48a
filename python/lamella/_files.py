"""Folders and files that the package writes: made before the work begins, whole, and in place of nothing else.

A file that is there is replaced only if Lamella wrote it, of the same kind, as by the program (src/records/target.h).
"""
import json
import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeAlias

from . import InputError, Scene

Place: TypeAlias = str | os.PathLike[str]
Kind: TypeAlias = Callable[[Path], bool]  #: whether a file is of a kind that Lamella writes


def make_folder(folder: Place) -> Path:
    """The folder, made where it is not there."""
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise OSError(f"{os.fspath(folder)}: cannot be made: {error.strerror or error}") from None
    return Path(folder)


def write_whole(path: Path, text: str | bytes) -> None:
    """A file, whole or not at all."""
    aside = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        aside.write_bytes(text if isinstance(text, bytes) else text.encode())
        os.replace(aside, path)
    except OSError as error:
        aside.unlink(missing_ok=True)
        raise OSError(f"{path}: cannot be written: {error.strerror or error}") from None


def text_of(path: Path) -> str:
    """What a file holds."""
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        raise OSError(f"{path}: exists and cannot be read: {error.strerror or error}; give another name") from None


def with_member(*names: str) -> Kind:
    """JSON objects that have all of these members."""
    def has(path: Path) -> bool:
        try:
            found = json.loads(text_of(path))
        except ValueError:
            return False
        return isinstance(found, dict) and found.keys() >= set(names)
    return has


def beginning(start: str) -> Kind:
    """Texts that begin so."""
    return lambda path: text_of(path).startswith(start)


def may_write(path: Place, kind: Kind, what: str, overwrite: bool = False, inputs: Iterable[Place] = ()) -> Path:
    """The path, unless a file there is no `what`, which Lamella has not written: before the work begins.

    overwrite: any plain file but an input is replaced. InputError: it would replace something else;
    OSError: there is no such folder, or nothing can be written to it.
    """
    path = Path(path)
    for file in inputs:
        if os.path.exists(file) and path.exists() and os.path.samefile(file, path):
            raise InputError(f"{path}: is an input of this command, and would be replaced by its output; give another "
                             "name")
    if path.exists() and not path.is_file():
        raise InputError(f"{path}: exists and is a {'folder' if path.is_dir() else 'device, pipe or socket'}; give "
                         "another name")
    if not os.access(path.parent, os.W_OK | os.X_OK):
        reason = "nothing can be written to its folder" if path.parent.is_dir() else "make the folder first"
        raise OSError(f"{path}: cannot be made: {reason}")
    if path.exists() and path.stat().st_size and not overwrite and not kind(path):
        raise InputError(f"{path}: exists and is not {what}, which is to be written there; give another name, or "
                         "--overwrite")
    return path


def inputs_of(*scenes: Any) -> list[str]:
    """The files of scenes, and those that they name."""
    read = [scene if isinstance(scene, Scene) else Scene(scene) for scene in scenes]
    return [file for scene in read for file in (scene.path, *scene.files)]
