"""Lamella: homogenisation of fruit and plant tissue.

    import lamella
    rve = lamella.RVE("scene.yaml")
    r = rve.solve([[1, 0.2, 0], [0, 1, 0], [0, 0, 1]])
    r.P, r.status

All values are in SI units: Pa, m, J/m^3. F, P and the tangent A = dP/dF are indexed as P[i, j] and A[i, j, k, l]. Arrays
of states have the shape of the states in front: F [n, 3, 3] gives P [n, 3, 3]. Errors are exceptions; a state that has no
answer is none: `converged` is False, and `reason` says why.
"""
import json
import os

import numpy as np

from ._library import DTYPE, MEMBERS, Error, InputError, check, ffi, library, name_of, start

__all__ = ["Scene", "RVE", "Database", "Responses", "sweep", "Sweep", "run", "Run", "Result", "quantity", "plot", "Error", "InputError"]


def _loads(F, turgor, cohesion):
    """Rows of loads, and the shape of the states: that of F without its last two axes, turgor and cohesion broadcast."""
    F = np.asarray(F, dtype=float)
    if F.shape[-2:] == (2, 2):  # in the plane
        whole = np.zeros(F.shape[:-2] + (3, 3))
        whole[..., :2, :2], whole[..., 2, 2] = F, 1.0
        F = whole
    if F.shape[-2:] != (3, 3):
        raise InputError(f"F has the shape {F.shape}: its last axes must be 3 x 3, or 2 x 2 in the plane")
    shape = np.broadcast_shapes(F.shape[:-2], np.shape(turgor), np.shape(cohesion))
    rows = np.empty(shape + (11,))
    rows[..., :9] = np.broadcast_to(F, shape + (3, 3)).reshape(shape + (9,))
    rows[..., 9], rows[..., 10] = turgor, cohesion
    return rows, shape


class Responses:
    """Responses of an array of states. Each member is an attribute, an array of the states' shape with the member's own
    axes behind: `P` [..., 3, 3] Pa, `tangent` [..., 3, 3, 3, 3] Pa, `energy` J/m^3, `stable`, `lumen_fraction`, ...
    `help(name)` tells what a member is and its unit. Reals that are not known are NaN."""

    dtype = DTYPE  #: of the array

    def __init__(self, array):
        self.array = array  #: structured NumPy array

    def __getattr__(self, name):
        if name.startswith("_") or name not in DTYPE.names:
            raise AttributeError(f"a response has no {name}; its members: {', '.join(DTYPE.names)}")
        kind, values = MEMBERS[DTYPE.names.index(name)][1], self.array[name]
        if kind == "b":
            return values.astype(bool)
        if kind == "s":
            return np.char.decode(values, "utf-8", "replace")
        if kind == "e":
            found, place = np.unique(values.ravel(), return_inverse=True)
            names = np.array([name_of(name, value) for value in found], dtype=object)
            return names[place].reshape(values.shape)[()]
        return values

    @property
    def converged(self):
        """Whether a state has an answer that is stable."""
        return self.status == "converged"

    def __getitem__(self, index):
        return Responses(self.array[index])

    def __len__(self):
        return len(self.array)

    def __dir__(self):
        return [*super().__dir__(), *DTYPE.names]

    @staticmethod
    def help(name):
        """What a member is, and its unit."""
        for member in MEMBERS:
            if member[0] == name:
                return f"{member[5]} ({member[4]})"
        raise KeyError(name)


def _respond(call, F, turgor, cohesion):
    rows, shape = _loads(F, turgor, cohesion)
    array = np.zeros(shape, DTYPE)
    check(call(array.size, ffi.from_buffer("double[]", np.ascontiguousarray(rows)),
               ffi.from_buffer("char[]", array, require_writable=True)))
    return Responses(array)


def scene_dict(scene):
    """A scene as nested dictionaries: of a path, of a text (with a line break in it), or a dictionary as it is."""
    if isinstance(scene, dict):
        return scene
    import yaml  # only where scenes are taken apart
    if isinstance(scene, str) and "\n" in scene:
        return yaml.safe_load(scene)
    with open(scene, encoding="utf-8") as file:
        return yaml.safe_load(file)


class Scene:
    """A scene from a file, from a dictionary, or with `text` from a text. Mistakes raise InputError."""

    def __init__(self, path="scene", text=None):
        if isinstance(path, dict):
            path, text = "scene", json.dumps(path)
        start()
        handle = ffi.new("LamBindScene *")
        check(library.LamBindSceneRead(os.fspath(path).encode(), ffi.NULL if text is None else text.encode(), handle))
        self._handle = ffi.gc(handle[0], library.LamBindSceneDestroy)
        scales = ffi.new("double[2]")
        library.LamBindSceneScales(self._handle, scales)
        self.apothem, self.stress_unit = scales  #: m; C1 + C2 of the walls, Pa
        loads = np.empty((library.LamBindSceneLoads(self._handle, ffi.NULL), 11))
        library.LamBindSceneLoads(self._handle, ffi.from_buffer("double[]", loads))
        #: of block `load`: F [n, 3, 3], turgor [n] and cohesion [n], Pa
        self.F, self.turgor, self.cohesion = loads[:, :9].reshape(-1, 3, 3), loads[:, 9], loads[:, 10]


class RVE:
    """The representative volume element of a scene, with the mesh that `lamella rve` chooses."""

    def __init__(self, scene):
        scene = scene if isinstance(scene, Scene) else Scene(scene)
        handle = ffi.new("LamBindRVE *")
        check(library.LamBindRVECreate(scene._handle, handle))
        self._handle = ffi.gc(handle[0], library.LamBindRVEDestroy)
        self.scene = scene

    def solve(self, F, turgor=0.0, cohesion=0.0, derivatives=True):
        """Solves states in order, each from the last one that converged: that before this call for the first.

        F [..., 3, 3] (or 2 x 2 in the plane), turgor and cohesion in Pa, numbers or arrays that broadcast with the
        states. derivatives: tangent and derivatives with respect to turgor, too. Returns Responses.
        """
        return _respond(lambda n, loads, out: library.LamBindRVESolve(self._handle, n, loads, bool(derivatives), out),
                        F, turgor, cohesion)

    @property
    def state(self):
        """The state that the next solve begins with, as bytes; of law `lamella` its history is in it."""
        size = ffi.new("size_t *")
        check(library.LamBindRVEStateSize(self._handle, size))
        state = bytearray(size[0])
        check(library.LamBindRVEGetState(self._handle, ffi.from_buffer("char[]", state, require_writable=True)))
        return bytes(state)

    @state.setter
    def state(self, state):
        size = ffi.new("size_t *")
        check(library.LamBindRVEStateSize(self._handle, size))
        if len(state) != size[0]:
            raise InputError(f"a state of {len(state)} bytes; those of this RVE have {size[0]}")
        check(library.LamBindRVESetState(self._handle, ffi.from_buffer("char[]", state)))

    def reset(self):
        """Forgets the state: the next solve begins with undeformed tissue."""
        check(library.LamBindRVEReset(self._handle))


_DIMENSIONS = ("length", "stress", "angle", "time", "temperature")


def quantity(text, dimension):
    """A text such as "0.02 MPa" in SI units; dimension: length, stress, angle, time or temperature. InputError: its unit is
    missing, unknown or of another dimension."""
    start()
    value = ffi.new("double *")
    check(library.LamBindQuantity(str(text).encode(), _DIMENSIONS.index(dimension), value))
    return value[0]


class Database:
    """A database of `lamella build`. Threads may query it at a time."""

    def __init__(self, path):
        start()
        handle = ffi.new("LamBindDatabase *")
        check(library.LamBindDatabaseOpen(os.fspath(path).encode(), handle))
        self._handle = ffi.gc(handle[0], library.LamBindDatabaseClose)
        scales = ffi.new("double[2]")
        library.LamBindDatabaseScales(self._handle, scales)
        self.apothem, self.stress_unit = scales  #: m; C1 + C2 of the walls, Pa

    @property
    def levels(self):
        """Of each record in the order of the file: the refinement of the node of the table that it is, 0 the coarsest; -1:
        it is none."""
        levels = np.empty(library.LamBindDatabaseLevels(self._handle, ffi.NULL), np.int32)
        library.LamBindDatabaseLevels(self._handle, ffi.from_buffer("int[]", levels, require_writable=True))
        return levels

    def query(self, F, turgor=0.0, cohesion=0.0, accuracy=0.01):
        """Answers states from the database; arguments as of RVE.solve. accuracy: largest estimated relative error of P
        with which a state is answered. Returns Responses."""
        return _respond(lambda n, loads, out: library.LamBindDatabaseQuery(self._handle, n, loads, accuracy, out), F,
                        turgor, cohesion)


from .program import Run, run  # noqa: E402  (need the names above)
from .results import Result  # noqa: E402
from .sweeps import Sweep, sweep  # noqa: E402


def __getattr__(name):
    """lamella.plot is loaded when it is used: matplotlib takes half a second."""
    if name != "plot":
        raise AttributeError(f"module lamella has no {name}")
    from importlib import import_module
    return import_module(".plot", __name__)
