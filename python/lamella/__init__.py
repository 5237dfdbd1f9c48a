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
from difflib import get_close_matches
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
    tensors = _array(values, what)
    if tensors.shape[-2:] == (2, 2):
        whole = np.full(tensors.shape[:-2] + (3, 3), 0 * out_of_plane)
        whole[..., :2, :2], whole[..., 2, 2] = tensors, out_of_plane
        tensors = whole
    if tensors.shape[-2:] != (3, 3):
        raise InputError(f"{what} has the shape {tensors.shape}: its last axes must be 3 x 3, or 2 x 2 in the plane")
    return tensors


def _array(values: ArrayLike, what: str) -> np.ndarray:
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{what}: {values!r:.60}: an array of numbers is wanted, in SI units") from None


def _pressure(values: ArrayLike, what: str) -> np.ndarray:
    array = _array(values, what)
    if not np.isfinite(array).all():
        raise InputError(f"{what}: {array[~np.isfinite(array)][0]}: is not a finite number")
    return array


def rows_of(defaults: Sequence[float], F: ArrayLike, turgor: ArrayLike | None, cohesion: ArrayLike | None,
            P: ArrayLike | None = None) -> tuple[np.ndarray, np.ndarray | None]:
    """Loads [..., 11] and P [..., 9], or None, of all states, whose shape is that of the arguments broadcast. defaults:
    turgor and cohesion, Pa."""
    F = _tensors(F, "F", 1.0)
    P = None if P is None else _tensors(P, "P", np.nan)
    pressures = [defaults[0] if turgor is None else turgor, defaults[1] if cohesion is None else cohesion]
    pressures = [_pressure(p, what) for p, what in zip(pressures, ("turgor", "cohesion"))]
    shapes = [F.shape[:-2], () if P is None else P.shape[:-2], *(p.shape for p in pressures)]
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        words = ", ".join(f"{name} {of}" for name, of in zip(("F", "P", "turgor", "cohesion"), shapes))
        raise InputError(f"the states of the loads have shapes that do not broadcast: {words}") from None
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
    `help(name)` says what a member is and its unit. Reals that are not known are NaN."""

    dtype = DTYPE  #: of the array

    def __init__(self, array: np.ndarray) -> None:
        self.array = array  #: structured NumPy array

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in NAMES:
            raise AttributeError(_no_member(name))
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

    def __repr__(self) -> str:
        """Shape, and how many states have which status."""
        names, counts = np.unique(np.asarray(self.status, str), return_counts=True)
        states = "1 state" if self.array.size == 1 else f"{self.array.size} states of the shape {self.array.shape}"
        return f"<lamella.Responses: {states}: " + ", ".join(f"{n} {name}" for name, n in zip(names, counts)) + ">"

    def __getitem__(self, index: Any) -> "Responses":
        return Responses(self.array[index])

    def __len__(self) -> int:
        return len(self.array)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *NAMES]

    @staticmethod
    def help(name: str) -> str:
        """What a member is, and its unit. InputError: no member has that name."""
        for member in MEMBERS:
            if member[0] == name:
                return f"{member[5]} ({member[4]})"
        raise InputError(_no_member(name))


def _no_member(name: str) -> str:
    near = [n for n in NAMES if str(name).lower() in n.lower()] or get_close_matches(str(name), NAMES)
    return f"a response has no {name}; " + (f"did you mean {' or '.join(near)}?" if near else f"it has {', '.join(NAMES)}")


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


def scene_text(scene: dict[str, Any]) -> str:
    """A scene of dictionaries as text. InputError: a value is none that scenes have."""
    def plain(value: Any) -> Any:
        if isinstance(value, os.PathLike):
            return os.fspath(value)
        if isinstance(value, (np.ndarray, np.generic)):
            return value.tolist()
        raise InputError(f"the scene: {value!r:.60}: is of type {type(value).__name__}; scenes have dictionaries, lists, "
                         "texts and numbers")
    try:
        return json.dumps(scene, default=plain)
    except (TypeError, ValueError, RecursionError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"the scene: {error}") from None


def scene_dict(scene: "str | os.PathLike[str] | dict[str, Any] | Scene") -> dict[str, Any]:
    """A scene as nested dictionaries of numbers, texts and lists: of a path, of a text (with a line break in it), of a
    Scene, or of a dictionary, which may have NumPy's numbers and arrays. InputError: it cannot be read; with file, line
    and column."""
    if isinstance(scene, dict):
        found: dict[str, Any] = json.loads(scene_text(scene))
        return found
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


def without_lines(message: str, path: str) -> str:
    """A message without the line and column of a text that nobody has written, and with numbers of six digits."""
    message = re.sub(rf"{re.escape(path)}:\d+:\d+: ", f"{path}: ", message)
    return re.sub(r"\b\d+\.\d{6,}\b", lambda number: f"{float(number[0]):.6g}", message)


class Scene:
    """A scene from a file, from a dictionary, whose numbers and arrays may be NumPy's, or with `text` from a text or a
    dictionary, which messages then call `path`. Mistakes raise InputError.

    apothem [m], stress_unit: C1 + C2 of the walls [Pa]; pressures: turgor and cohesion of the block `rve` [Pa].
    F, P [n, 3, 3], turgor and cohesion [n], Pa: the loads of its block `load`, which RVE.solve takes. NaN in F: P is
    prescribed instead, NaN in P: F is; NaN in both: the component goes straight from an F that is found. Loads that are
    not known before they are solved, from inflated tissue or by dissipation, raise InputError; RVE(scene).solve()
    solves all.
    """

    def __init__(self, path: str | os.PathLike[str] | dict[str, Any] = "scene",
                 text: str | dict[str, Any] | None = None) -> None:
        if isinstance(path, dict):
            path, text = "scene", path
        elif not isinstance(path, (str, os.PathLike)) or (text is None and "\n" in os.fspath(path)):
            raise InputError(f"Scene: {path!r:.60}: a path or a dictionary is wanted; a text of YAML is given as "
                             "Scene(text=...)")
        self.path = os.fspath(path)
        self.has_lines = not isinstance(text, dict)  #: a dictionary has none that a message could name
        self.text = scene_text(text) if isinstance(text, dict) else text
        handle = ffi.new("LamBindScene *")
        try:
            call(library.LamBindSceneRead, self.path.encode(), ffi.NULL if text is None else self.text.encode(), handle)
        except InputError as error:
            raise error if self.has_lines else InputError(without_lines(str(error), self.path)) from None
        self._handle = own(handle[0], library.LamBindSceneDestroy)
        self.apothem, self.stress_unit, *self.pressures = _numbers(library.LamBindSceneNumbers, self._handle, 4)

    def check_material(self) -> None:
        """Raises InputError unless a host program can take the tissue as its material: a patch is no material point, and
        the turgor of sealed cells is not prescribed."""
        call(library.LamBindSceneIsMaterial, self._handle)

    def __repr__(self) -> str:
        return f"<lamella.Scene {self.path}: {len(self)} states in its block load>"

    @property
    def files(self) -> list[str]:
        """The files that it names: mesh, tissues, tables."""
        names = iter(lambda: library.LamBindSceneFile(self._handle, len(found)), ffi.NULL)
        found: list[str] = []
        for name in names:
            found.append(ffi.string(name).decode())
        return found

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

    def __repr__(self) -> str:
        return f"<lamella.RVE of {self.scene.path}: apothem {self.scene.apothem:g} m, C1 + C2 {self.scene.stress_unit:g} Pa, " \
            f"turgor {self.scene.pressures[0]:g} Pa>"

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
        self.path, handle = os.fspath(path), ffi.new("LamBindDatabase *")
        call(library.LamBindDatabaseOpen, self.path.encode(), handle)
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

    def __repr__(self) -> str:
        return f"<lamella.Database {self.path}: {len(self.levels)} records, accuracy {self.accuracy:g}>"

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
        if accuracy is not None and not accuracy > 0:
            raise InputError(f"accuracy: {accuracy}: is not above 0")
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
