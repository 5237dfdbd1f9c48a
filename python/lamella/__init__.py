"""Lamella: homogenisation of fruit and plant tissue.

    import lamella
    rve = lamella.RVE("scene.yaml")
    r = rve.solve([[1, 0.2, 0], [0, 1, 0], [0, 0, 1]])
    r.P, r.status

All values are in SI units: Pa, m, J/m^3. F, P and the tangent A = dP/dF are indexed as P[i, j] and A[i, j, k, l].
Arrays of states have the shape of the states in front: F [n, 3, 3] gives P [n, 3, 3]. Errors are exceptions; a state
that has no answer is none: `converged` is False, and `reason` says why.
"""
import json
import os
import re
import sys
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

_missing = [name for name in ("numpy", "cffi") if not find_spec(name)]
if _missing:
    raise ImportError(f"lamella needs {' and '.join(_missing)}, not installed for {sys.executable}: run pip install "
                      f"{' '.join(_missing)} with it, or use Debian's /usr/bin/python3, for which ./setup.sh installs "
                      f"{' and '.join(f'python3-{name}' for name in _missing)}", name=_missing[0])

import numpy as np  # noqa: E402  (what is missing has been reported)
from numpy.typing import ArrayLike

from ._library import DTYPE, MEMBERS, NAMES, Error, InputError, call, check, ffi, library, name_of, own

__all__ = ["Scene", "RVE", "Database", "Responses", "Result", "fe2", "process", "map", "run", "Run", "solve", "sweep",
           "Sweep", "quantity", "to", "plot", "Error", "InputError"]


def _tensors(values: ArrayLike, what: str, out_of_plane: float) -> np.ndarray:
    """[..., 3, 3] of 3 x 3 tensors, or of 2 x 2 in the plane, whose 33 is out_of_plane; the rest is 0 or NaN, as it."""
    tensors = np.asarray(values, dtype=float)
    if tensors.shape[-2:] == (2, 2):
        whole = np.full(tensors.shape[:-2] + (3, 3), 0 * out_of_plane)
        whole[..., :2, :2], whole[..., 2, 2] = tensors, out_of_plane
        tensors = whole
    if tensors.shape[-2:] != (3, 3):
        raise InputError(f"{what} has the shape {tensors.shape}: its last axes must be 3 x 3, or 2 x 2 in the plane")
    return tensors


def rows_of(defaults: Sequence[float], F: ArrayLike, turgor: ArrayLike | None, cohesion: ArrayLike | None,
            P: ArrayLike | None = None) -> tuple[np.ndarray, np.ndarray | None]:
    """Loads [..., 11] and P [..., 9], or None, of all states, whose shape is that of the arguments broadcast. defaults:
    turgor and cohesion, Pa."""
    F = _tensors(F, "F", 1.0)
    P = None if P is None else _tensors(P, "P", np.nan)
    pressures = [defaults[0] if turgor is None else turgor, defaults[1] if cohesion is None else cohesion]
    shape = np.broadcast_shapes(F.shape[:-2], () if P is None else P.shape[:-2], *(np.shape(p) for p in pressures))
    rows = np.empty(shape + (11,))
    rows[..., :9] = np.broadcast_to(F, shape + (3, 3)).reshape(shape + (9,))
    rows[..., 9], rows[..., 10] = pressures
    return rows, None if P is None else np.ascontiguousarray(np.broadcast_to(P, shape + (3, 3)).reshape(shape + (9,)))


def _doubles(array: np.ndarray | None) -> Any:
    return ffi.NULL if array is None else ffi.from_buffer("double[]", array)


def _bytes(array: np.ndarray | bytearray) -> Any:
    return ffi.from_buffer("char[]", array, require_writable=True)


def _numbers(function: Any, handle: Any, count: int) -> list[float]:
    numbers = ffi.new("double[]", count)
    function(handle, numbers)
    return list(numbers)


class Responses:
    """Responses of an array of states. Each member is an attribute, an array of the states' shape with the member's own
    axes behind: `P` [..., 3, 3] Pa, `tangent` [..., 3, 3, 3, 3] Pa, `energy` J/m^3, `stable`, `lumen_fraction`, ...
    `help(name)` tells what a member is and its unit. Reals that are not known are NaN."""

    dtype = DTYPE  #: of the array

    def __init__(self, array: np.ndarray) -> None:
        self.array = array  #: structured NumPy array

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in NAMES:
            raise AttributeError(f"a response has no {name}; its members: {', '.join(NAMES)}")
        kind, values = MEMBERS[NAMES.index(name)][1], self.array[name]
        if kind == "b":
            return values.astype(bool)
        if kind == "s":
            texts = [text.split(b"\0")[0].decode("utf-8", "replace") for text in values.ravel()]  # to C's end of a text
            return np.array(texts, dtype=str).reshape(values.shape)[()]
        if kind == "e":
            found, place = np.unique(values.ravel(), return_inverse=True)
            names = np.array([name_of(name, value) for value in found], dtype=object)
            return names[place].reshape(values.shape)[()]
        return values

    @property
    def converged(self) -> Any:
        """Whether a state has an answer that is stable."""
        return self.status == "converged"

    def __getitem__(self, index: Any) -> "Responses":
        return Responses(self.array[index])

    def __len__(self) -> int:
        return len(self.array)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *NAMES]

    @staticmethod
    def help(name: str) -> str:
        """What a member is, and its unit."""
        for member in MEMBERS:
            if member[0] == name:
                return f"{member[5]} ({member[4]})"
        raise KeyError(name)


def parse_yaml(text: str) -> Any:
    """What a text of YAML holds, with scalars as scenes have them (YAML 1.2): `on` is a name and 1e-3 a number, unlike
    in PyYAML."""
    import yaml  # type: ignore[import]  # only where scenes are taken apart

    class Loader(yaml.SafeLoader):
        yaml_implicit_resolvers: dict[str, Any] = {}

    for tag, pattern in (("bool", "true|false"), ("int", "[-+]?(0|[1-9][0-9]*)"),
                         ("float", r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?")):
        Loader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(f"^({pattern})$"), None)
    return yaml.load(text, Loader)


def scene_dict(scene: "str | os.PathLike[str] | dict[str, Any] | Scene") -> dict[str, Any]:
    """A scene as nested dictionaries: of a path, of a text (with a line break in it), of a Scene, or a dictionary as it
    is. InputError: it cannot be read; with file, line and column."""
    if isinstance(scene, dict):
        return scene
    if isinstance(scene, Scene):
        scene = scene.path if scene.text is None else scene.text + "\n"
    is_text = isinstance(scene, str) and "\n" in scene
    try:
        found = parse_yaml(str(scene) if is_text else Path(scene).read_text(encoding="utf-8-sig"))
    except Exception:  # of files, encodings and YAML
        found = None
    if not isinstance(found, dict):
        Scene("scene", str(scene)) if is_text else Scene(scene)  # its message names the place
        raise InputError(f"{'the scene' if is_text else scene}: is no YAML that can be read")
    return found


class Scene:
    """A scene from a file, from a dictionary, or with `text` from a text, which messages then call `path`. Mistakes
    raise InputError.

    apothem [m], stress_unit: C1 + C2 of the walls [Pa]; pressures: turgor and cohesion of the block `rve` [Pa].
    F, P [n, 3, 3], turgor and cohesion [n], Pa: the loads of its block `load`, which RVE.solve takes. NaN in F: P is
    prescribed instead, NaN in P: F is; NaN in both: the component goes straight from an F that is found. Loads that are
    not known before they are solved, from inflated tissue or by dissipation, raise InputError; RVE(scene).solve()
    solves all.
    """

    def __init__(self, path: str | os.PathLike[str] | dict[str, Any] = "scene", text: str | None = None) -> None:
        if isinstance(path, dict):
            path, text = "scene", json.dumps(path)
        self.path, self.text = os.fspath(path), text
        handle = ffi.new("LamBindScene *")
        call(library.LamBindSceneRead, self.path.encode(), ffi.NULL if text is None else text.encode(), handle)
        self._handle = own(handle[0], library.LamBindSceneDestroy)
        self.apothem, self.stress_unit, *self.pressures = _numbers(library.LamBindSceneNumbers, self._handle, 4)

    def check_material(self) -> None:
        """Raises InputError unless a host program can take the tissue as its material: a patch is no material point, and
        the turgor of sealed cells is not prescribed."""
        call(library.LamBindSceneIsMaterial, self._handle)

    def __len__(self) -> int:
        """Number of states of the block `load`."""
        return library.LamBindSceneLoads(self._handle, ffi.NULL, ffi.NULL)

    def _loads(self) -> tuple[np.ndarray, np.ndarray]:
        why = library.LamBindSceneLoadsAreOpen(self._handle)
        if why != ffi.NULL:
            raise InputError(f"{self.path}: load: {ffi.string(why).decode()}, which is not known before it is solved: "
                             "RVE(scene).solve() solves the states")
        loads, P = np.empty((len(self), 11)), np.empty((len(self), 9))
        library.LamBindSceneLoads(self._handle, _doubles(loads), _doubles(P))
        return loads, P

    @property
    def F(self) -> np.ndarray:
        """Prescribed deformation gradients [n, 3, 3]; NaN: not prescribed."""
        return self._loads()[0][:, :9].reshape(-1, 3, 3)

    @property
    def P(self) -> np.ndarray:
        """Prescribed stresses [n, 3, 3], Pa, per area at rest; NaN: not prescribed."""
        return self._loads()[1].reshape(-1, 3, 3)

    @property
    def turgor(self) -> np.ndarray:
        """Turgor of the loads [n], Pa."""
        return self._loads()[0][:, 9]

    @property
    def cohesion(self) -> np.ndarray:
        """Cohesion of the loads [n], Pa."""
        return self._loads()[0][:, 10]


class RVE:
    """The representative volume element of a scene, with the mesh that `lamella rve` chooses. Sealed cells keep the
    water that they have in undeformed tissue, or in the inflated tissue that the scene's own loads find.

    Threads may use RVEs, one at a time: PETSc is not made for threads, so the solves of a process wait for each other.
    """

    def __init__(self, scene: Scene | str | os.PathLike[str] | dict[str, Any]) -> None:
        self.scene = scene if isinstance(scene, Scene) else Scene(scene)
        handle = ffi.new("LamBindRVE *")
        call(library.LamBindRVECreate, self.scene._handle, handle)
        self._handle = own(handle[0], library.LamBindRVEDestroy)

    def solve(self, F: ArrayLike | None = None, turgor: ArrayLike | None = None, cohesion: ArrayLike | None = None,
              P: ArrayLike | None = None, state: bytes | None = None, derivatives: bool = True,
              estimate: bool = False) -> Responses:
        """Solves states in order, each from the last one that converged: that before this call for the first. Without
        arguments for the loads: those of the scene, from undeformed tissue, as `lamella rve` does.

        F [..., 3, 3] (or 2 x 2 in the plane), turgor and cohesion in Pa (default: the scene's), numbers or arrays that
        broadcast with the states. P [..., 3, 3], Pa: components of the stress that are prescribed; NaN where F is
        given, and F is NaN where P is. state: begins with that one. derivatives: tangent and derivatives with respect
        to turgor, too. estimate: error_estimate, too, at the cost of another solve or several. Returns Responses of
        the shape of the states, whose F is that found.
        """
        if state is not None:
            self.state = state
        if F is None:
            if turgor is not None or cohesion is not None or P is not None or state is not None:
                raise InputError("solve: turgor, cohesion, P or state without F: give F, NaN where P is prescribed")
            return self._solve_own(derivatives, estimate)
        loads, P = rows_of(self.scene.pressures, F, turgor, cohesion, P)
        array = np.zeros(loads.shape[:-1], DTYPE)
        call(library.LamBindRVESolve, self._handle, array.size, _doubles(loads), _doubles(P), derivatives, estimate,
             _bytes(array))
        return Responses(array)

    def _solve_own(self, derivatives: bool, estimate: bool) -> Responses:
        array, count = np.zeros(len(self.scene), DTYPE), ffi.new("int *")
        if not len(array):
            raise InputError(f"{self.scene.path}: has no block `load`: give F")
        call(library.LamBindRVESolveOwnLoads, self._handle, derivatives, estimate, _bytes(array), count)
        return Responses(array[:count[0]])

    @property
    def readings(self) -> dict[str, Any] | None:
        """What is read off the curve of the scene's own loads, solved last with derivatives: the object `test` of
        `lamella rve --readings --json`, in its units (MPa, kJ/m^3). None: there is no curve."""
        text = library.LamBindRVEReadings(self._handle)
        return None if text == ffi.NULL else json.loads(ffi.string(text))

    @property
    def state(self) -> bytes:
        """The state that the next solve begins with, as bytes; of law `lamella` its history is in it."""
        state = bytearray(self._state_size())
        call(library.LamBindRVEGetState, self._handle, _bytes(state))
        return bytes(state)

    @state.setter
    def state(self, state: bytes) -> None:
        if len(state) != self._state_size():
            raise InputError(f"a state of {len(state)} bytes; those of this RVE have {self._state_size()}")
        call(library.LamBindRVESetState, self._handle, ffi.from_buffer("char[]", state))

    def _state_size(self) -> int:
        size = ffi.new("size_t *")
        call(library.LamBindRVEStateSize, self._handle, size)
        return size[0]

    def reset(self) -> None:
        """Forgets the state: the next solve begins with undeformed tissue."""
        call(library.LamBindRVEReset, self._handle)


class Database:
    """A database of `lamella build`. Threads may query it at a time.

    apothem [m], stress_unit: C1 + C2 of the walls [Pa]; pressures [turgor, cohesion], Pa, and accuracy: those of its
    scene.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        handle = ffi.new("LamBindDatabase *")
        call(library.LamBindDatabaseOpen, os.fspath(path).encode(), handle)
        self._handle = own(handle[0], library.LamBindDatabaseClose)
        self.apothem, self.stress_unit, *self.pressures, self.accuracy = \
            _numbers(library.LamBindDatabaseNumbers, self._handle, 5)

    @staticmethod
    def build(scene: "SceneLike", path: str | os.PathLike[str], *, ranks: int = 1, resume: bool = False,
              shard: str | None = None, ranks_per_rve: int | None = None) -> "Database":
        """Builds the database of a scene's block `sample`, `lamella build`, into the file `path`, and opens it.

        resume: goes on with a file; shard: "1/4", one of four parts of the box; ranks_per_rve: that solve an RVE.
        """
        study("build", scene, ranks, database=path, resume=resume, shard=shard, ranks_per_rve=ranks_per_rve)
        return Database(path)

    @property
    def levels(self) -> np.ndarray:
        """Of each record in the order of the file: the refinement of the node of the table that it is, 0 the coarsest;
        -1: it is none."""
        levels = np.empty(library.LamBindDatabaseLevels(self._handle, ffi.NULL), np.int32)
        library.LamBindDatabaseLevels(self._handle, ffi.from_buffer("int[]", levels, require_writable=True))
        return levels

    def query(self, F: ArrayLike, turgor: ArrayLike | None = None, cohesion: ArrayLike | None = None,
              accuracy: float | None = None) -> Responses:
        """Answers states from the database.

        F [..., 3, 3] (or 2 x 2 in the plane), turgor and cohesion in Pa, numbers or arrays that broadcast with the
        states; accuracy: largest estimated relative error of P with which a state is answered. Defaults are those of
        the scene of the database. Returns Responses of the shape of the states.
        """
        loads, _ = rows_of(self.pressures, F, turgor, cohesion)
        array = np.zeros(loads.shape[:-1], DTYPE)
        check(library.LamBindDatabaseQuery(self._handle, array.size, _doubles(loads),
                                           self.accuracy if accuracy is None else accuracy, _bytes(array)))
        return Responses(array)


from .units import quantity, to  # noqa: E402  (need the names above)
from .results import Result  # noqa: E402
from .program import Run, SceneLike, fe2, map, process, run, study  # noqa: E402
from .sweeps import Sweep, solve, sweep  # noqa: E402


def __getattr__(name: str) -> Any:
    """lamella.plot is loaded when it is used: matplotlib takes half a second."""
    if name != "plot":
        raise AttributeError(f"module lamella has no {name}")
    from importlib import import_module
    return import_module(".plot", __name__)
