"""Folders and files that the package writes, and what is told where that fails."""
import os
from pathlib import Path


def make_folder(folder: str | os.PathLike[str]) -> Path:
    """The folder, made where it is not there."""
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise OSError(f"{os.fspath(folder)}: cannot be made: {error.strerror or error}") from None
    return Path(folder)


def write_whole(path: Path, text: str) -> None:
    """A file, whole or not at all."""
    aside = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        aside.write_text(text, encoding="utf-8")
        os.replace(aside, path)
    except OSError as error:
        aside.unlink(missing_ok=True)
        raise OSError(f"{path}: cannot be written: {error.strerror or error}") from None
