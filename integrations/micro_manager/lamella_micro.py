"""Tissue of Lamella as a micro simulation of the preCICE Micro Manager.

The manager's configuration names the module of a class MicroSimulation: lamella_solve, which solves an RVE, or
lamella_database, which queries a database. With model adaptivity it names both, in this order, and this module, whose
switching_function takes the database wherever that answers to the accuracy.

The file lamella-micro.json in the folder of the run: {"database": "tissue.h5"}, whose tissue is then solved, too, or
{"scene": "tissue.yaml"}; and "accuracy": largest estimated relative error of P of a query (0.01 if absent).

Data, in SI units; names as those of FANS for large strain, in small letters or, as in its later versions, with a first
capital. Vectors of 3:
    read     strains1to3, strains4to6, strains7to9            rows of F
    write    stresses1to3, stresses4to6, stresses7to9         rows of P
             cmat1 ... cmat27                                 dP/dF, 9 x 9 by rows, 3 numbers each
Scalars:
    read     turgor, cohesion                                 if the macroscale solver gives them; else the scene's
    write    energy, lumen_fraction, debonded_fraction, solved    solved: 1 if an RVE was solved, 0 if not
"""
import functools
import json
from pathlib import Path

import numpy as np

import lamella

try:  # later versions expect their base class; for a while it demanded methods that are optional
    from micro_manager import MicroSimulationInterface as _Interface
    _Interface = object if "output" in _Interface.__abstractmethods__ else _Interface
except ImportError:
    _Interface = object

SETTINGS = "lamella-micro.json"
SOLVE, QUERY = 0, 1  # models in the manager's list, the more exact first
_PLANE = np.ix_([0, 1, 3, 4, 8], [0, 1, 3, 4, 8])  # of dP/dF, 9 x 9: what plane strain knows


class NoResponse(RuntimeError):
    """The tissue has no stress at a load."""


class Tissue:
    """What the settings name. RVE and database are made when they are first needed, one of each for a process: micro
    simulations differ by their states."""

    def __init__(self, settings):
        unknown = set(settings) - {"database", "scene", "accuracy"}
        if unknown or ("database" in settings) == ("scene" in settings):
            raise lamella.InputError(f"{SETTINGS}: has {', '.join(settings) or 'nothing'}; write database or scene, "
                                     "one of them, and accuracy if it is not 0.01")
        self.path, self.accuracy = settings.get("database"), settings.get("accuracy", 0.01)
        if self.path:
            with lamella.Result(self.path) as file:
                text = file.scene
        else:
            text = Path(settings["scene"]).read_text(encoding="utf-8")
        self.scene = lamella.Scene(self.path or settings["scene"], text=text)
        scene = lamella.scene_dict(text)
        self.scene.check_material()
        at_rest = lamella.Scene({"version": scene["version"], "rve": scene["rve"], "load": [{"F": [[1, 0], [0, 1]]}]})
        self.turgor, self.cohesion = at_rest.turgor[0], at_rest.cohesion[0]

    @functools.cached_property
    def rve(self):
        return lamella.RVE(self.scene)

    @functools.cached_property
    def database(self):
        if not self.path:
            raise lamella.InputError(f"{SETTINGS}: has no database, which lamella_database and model adaptivity need")
        return lamella.Database(self.path)

    def query(self, load):
        return self.database.query(*load, accuracy=self.accuracy)


@functools.lru_cache(maxsize=None)
def tissue():
    try:
        settings = json.loads(Path(SETTINGS).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise lamella.InputError(f"{SETTINGS}: cannot be read: {error}") from None
    return Tissue(settings)


def _capital(macro_data):
    return "Strains1to3" in macro_data


def _scalar(macro_data, name):
    """What the macroscale solver gives, with a capital or without; else the scene's."""
    return macro_data.get(name, macro_data.get(name.capitalize(), getattr(tissue(), name)))


def _load(macro_data):
    """F, turgor and cohesion of what the macroscale solver gives."""
    names = ["strains1to3", "strains4to6", "strains7to9"]
    if _capital(macro_data):
        names = [name.capitalize() for name in names]
    missing = [name for name in names if name not in macro_data]
    if missing:
        raise lamella.InputError(f"{', '.join(missing)}: not in the data read; Lamella takes F, whose rows are "
                                 f"{', '.join(names)}")
    F = np.array([macro_data[name] for name in names], dtype=float)
    if F.shape != (3, 3):
        raise lamella.InputError(f"{names[0]}: has not 3 numbers; the mesh of preCICE must have 3 dimensions")
    return F, _scalar(macro_data, "turgor"), _scalar(macro_data, "cohesion")


def _output(r, capital, solved):
    """What the macroscale solver takes. Entries of dP/dF with an out-of-plane shear, which plane strain does not know,
    are 0: they multiply strains that are 0."""
    A = np.zeros((9, 9))
    A[_PLANE] = r.tangent.reshape(9, 9)[_PLANE]
    out = {f"stresses{3 * i + 1}to{3 * i + 3}": row for i, row in enumerate(r.P.copy())}
    out.update((f"cmat{i + 1}", row) for i, row in enumerate(A.reshape(27, 3)))
    if capital:
        out = {name.capitalize(): row for name, row in out.items()}
    scalars = {name: float(getattr(r, name)) for name in ("energy", "lumen_fraction", "debonded_fraction")}
    return {**out, **scalars, "solved": float(solved)}


def _known(r):
    numbers = (r.P, r.tangent.reshape(9, 9)[_PLANE], r.energy, r.lumen_fraction, r.debonded_fraction)
    return r.status in ("converged", "unstable") and all(np.isfinite(x).all() for x in numbers)


class Micro(_Interface):
    """What the manager's calls have in common. A state is bytes: b"" of tissue at rest, else that of lamella.RVE; a
    simulation that queries hands on the one it was given."""

    def __init__(self, sim_id):  # -1: late, and its state is set before it solves
        self._id, self._state = sim_id, b""

    def get_global_id(self):
        return self._id

    def set_global_id(self, sim_id):
        self._id = sim_id

    def get_state(self):
        return self._state

    def set_state(self, state):
        if not isinstance(state, bytes):
            raise lamella.InputError(f"a state is bytes of get_state, not {type(state).__name__}")
        self._state = state

    def solve(self, macro_data, dt):
        """The response at the end of a time step; dt is not used: tissue does not depend on rates."""
        load = _load(macro_data)
        r = self._respond(load)
        if not _known(r):
            F, turgor, _ = load
            raise NoResponse(f"micro simulation {self._id}: {r.status}: {r.reason}; F = "
                             f"[{' '.join(f'{x:.6g}' for x in F.ravel())}], turgor {turgor:.6g} Pa")
        return _output(r, _capital(macro_data), self.SOLVED)


class Solve(Micro):
    """Solves an RVE, from the state that the last solve has left."""

    SOLVED = True

    def _respond(self, load):
        rve = tissue().rve
        if self._state:
            rve.state = self._state
        else:
            rve.reset()
        r = rve.solve(*load)
        if _known(r):
            self._state = rve.state
        return r


class Query(Micro):
    """Queries the database."""

    SOLVED = False

    def _respond(self, load):
        return tissue().query(load)


def switching_function(resolution, location, t, input, prev_output):
    """By how much the manager is to move in its list of models: the database where it answers to the accuracy, else a
    solve. Decided by the load alone, before either model has seen it, so that one round is enough."""
    return (QUERY if _known(tissue().query(_load(input))) else SOLVE) - int(resolution)
