"""The shared library, its functions and the members of a response.

The functions are those of include/lamella/bind.h, which is read as it is.
"""
import os
import re
import sys
import threading
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import cffi
import numpy as np

ffi: Any = cffi.FFI()  # its functions are known at run time only
_here = Path(__file__).resolve().parent
_source = _here.parents[1]


def _find(name: str, folders: list[Path]) -> Path:
    for folder in folders:
        if (folder / name).is_file():
            return folder / name
    raise ImportError(f"no {name} in {', '.join(map(str, folders))}: build Lamella (./setup.sh), or tell the folder of "
                      "liblamella.so by the variable LAMELLA_LIBRARY")


def _declarations() -> str:
    text = _find("bind.h", [_here, _source / "include" / "lamella"]).read_text()
    text = text[text.index("LAM_C_BEGIN") + len("LAM_C_BEGIN"):text.index("LAM_C_END")]
    return re.sub(r"\bLAM_EXPORT\b", "", text) + "const char *LamErrorMessage(void); int LamErrorCode(void); " \
        "int PetscPopErrorHandler(void);"


ffi.cdef(_declarations())
_told = os.environ.get("LAMELLA_LIBRARY")
_path = _find("liblamella.so", [Path(_told)] if _told else [_here, _source / "build"])
library_folder = _path.parent
library: Any = ffi.dlopen(str(_path))

class Error(RuntimeError):
    """A fault, or what the library cannot do."""


class InputError(Error, ValueError):
    """A mistake in a scene, a file or an argument; the message has file, line, column, key and remedy."""


def check(code: int) -> None:
    """Raises the error that a function of the library has returned."""
    if not code:
        return
    message = ffi.string(library.LamErrorMessage()).decode()
    kinds = {b"i": InputError, b"f": OSError, b"m": MemoryError}
    raise kinds.get(library.LamBindErrorKind(code), Error)(message)


_one_at_a_time = threading.RLock()  # PETSc is not made for threads; again: memory is collected during a call


class _Refuse:
    """Finds no module. petsc4py, and mpi4py where MPI was not running, would take what lamella has started for this rank
    alone for the world of the job."""

    def __init__(self, modules: list[str]) -> None:
        self.modules = modules

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> None:
        if name in self.modules:
            package = name.split(".")[0]
            raise ImportError(f"import {package} before lamella's first scene or RVE, on every rank: this rank has used "
                              f"lamella, which has started {'PETSc' if package == 'petsc4py' else 'MPI'} for it alone",
                              name=name)


@cache
def _start() -> None:
    """Starts MPI and PETSc where the process has not: before the first call, since files and pictures need neither."""
    check(library.LamBindStart())
    alone = library.LamBindStartedAlone()
    if alone:
        sys.meta_path.insert(0, _Refuse(["petsc4py", "petsc4py.lib"] + ["mpi4py.MPI"] * (alone == 2)))


def call(function: Any, *arguments: Any) -> None:
    """Calls a function that uses PETSc, one thread at a time, and raises its error."""
    with _one_at_a_time:
        _start()
        check(library.LamBindStart())  # keeps errors, whatever petsc4py has set since
        try:
            check(function(*arguments))
        finally:
            library.PetscPopErrorHandler()


def own(handle: Any, destroy: Any) -> Any:
    """The handle, which is destroyed with the object that has it."""
    def release(handle: Any) -> None:
        with _one_at_a_time:
            destroy(handle)
    return ffi.gc(handle, release)


def _members() -> Iterator[tuple[str, str, int, int, str, str]]:
    type_, count, offset = ffi.new("char *"), ffi.new("int *"), ffi.new("size_t *")
    unit, help_ = ffi.new("const char **"), ffi.new("const char **")
    for i in range(10000):
        name = library.LamBindMember(i, type_, count, offset, unit, help_)
        if name == ffi.NULL:
            return
        yield (ffi.string(name).decode(), type_[0].decode(), count[0], offset[0], ffi.string(unit[0]).decode(),
               ffi.string(help_[0]).decode())


MEMBERS = list(_members())
NAMES = [member[0] for member in MEMBERS]
_shapes = {9: (3, 3), 81: (3, 3, 3, 3)}


def _format(type_: str, count: int) -> Any:
    if type_ == "s":
        return f"S{count}"
    one = "f8" if type_ == "f" else "i4"
    return one if count == 1 else (one, _shapes.get(count, (count,)))


DTYPE = np.dtype({"names": NAMES, "formats": [_format(m[1], m[2]) for m in MEMBERS],
                  "offsets": [m[3] for m in MEMBERS], "itemsize": library.LamBindResponseSize()})


def name_of(member: str, value: int) -> str:
    """Name of a value of an enumeration: "converged"."""
    return ffi.string(library.LamBindMemberName(NAMES.index(member), int(value))).decode()
