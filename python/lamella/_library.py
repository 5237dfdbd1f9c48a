"""The shared library, its functions and the members of a response.

The functions are those of include/lamella/bind.h, which is read as it is.
"""
import os
import re
from pathlib import Path

import cffi
import numpy as np

ffi = cffi.FFI()
_here = Path(__file__).resolve().parent
_source = _here.parents[1]


def _find(name, folders):
    for folder in folders:
        if (folder / name).is_file():
            return folder / name
    raise ImportError(f"no {name} in {', '.join(map(str, folders))}: build Lamella (./setup.sh), or tell the folder of "
                      "liblamella.so by the variable LAMELLA_LIBRARY")


def _declarations():
    text = _find("bind.h", [_here, _source / "include" / "lamella"]).read_text()
    text = text[text.index("LAM_C_BEGIN") + len("LAM_C_BEGIN"):text.index("LAM_C_END")]
    return re.sub(r"\bLAM_EXPORT\b", "", text) + "const char *LamErrorMessage(void); int LamErrorCode(void);"


ffi.cdef(_declarations())
_told = os.environ.get("LAMELLA_LIBRARY")
_path = _find("liblamella.so", [Path(_told)] if _told else [_here, _source / "build"])
library_folder = _path.parent
library = ffi.dlopen(str(_path))

class Error(RuntimeError):
    """A fault, or what the library cannot do."""


class InputError(Error, ValueError):
    """A mistake in a scene, a file or an argument; the message has file, line, column, key and remedy."""


def check(code):
    """Raises the error that a function of the library has returned."""
    if not code:
        return
    message = ffi.string(library.LamErrorMessage()).decode()
    kinds = {b"i": InputError, b"f": OSError, b"m": MemoryError}
    raise kinds.get(library.LamBindErrorKind(code), Error)(message)


def start():
    """Starts MPI and PETSc where the process has not: before the first scene or database, since files and pictures need
    neither."""
    check(library.LamBindStart())


def _members():
    type_, count, offset = ffi.new("char *"), ffi.new("int *"), ffi.new("size_t *")
    unit, help_ = ffi.new("const char **"), ffi.new("const char **")
    for i in range(10000):
        name = library.LamBindMember(i, type_, count, offset, unit, help_)
        if name == ffi.NULL:
            return
        yield (ffi.string(name).decode(), type_[0].decode(), count[0], offset[0], ffi.string(unit[0]).decode(),
               ffi.string(help_[0]).decode())


MEMBERS = list(_members())
_shapes = {9: (3, 3), 81: (3, 3, 3, 3)}


def _format(type_, count):
    if type_ == "s":
        return f"S{count}"
    one = "f8" if type_ == "f" else "i4"
    return one if count == 1 else (one, _shapes.get(count, (count,)))


DTYPE = np.dtype({"names": [m[0] for m in MEMBERS], "formats": [_format(m[1], m[2]) for m in MEMBERS],
                  "offsets": [m[3] for m in MEMBERS], "itemsize": library.LamBindResponseSize()})


def name_of(member, value):
    """Name of a value of an enumeration: "converged"."""
    return ffi.string(library.LamBindMemberName(DTYPE.names.index(member), int(value))).decode()
