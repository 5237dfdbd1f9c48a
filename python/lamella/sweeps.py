"""Many independent solves in processes of their own, so that processors are shared and a crash is an exception."""
import copy
import itertools
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import RVE, InputError, Responses, Scene, rows_of, scene_dict
from .parallel import each
from .program import SceneLike

Job = tuple[str, str | dict[str, Any] | None, dict[str, Any]]  # path, and text or dictionary, of a scene, arguments of RVE.solve


class Sweep:
    """Responses over a grid of parameters.

    names: the keys; values: for each its values, as given. responses: of the shape [len(values[0]), ..., states], with
    the members of Responses as attributes of the sweep, too.
    """

    def __init__(self, values: dict[str, Sequence[Any]], responses: Responses) -> None:
        self.names, self.values, self.responses = list(values), list(values.values()), responses

    def __getattr__(self, name: str) -> Any:
        if name == "responses":
            raise AttributeError(name)
        return getattr(self.responses, name)

    def table(self, *members: str) -> list[dict[str, Any]]:
        """Rows of the sweep: a list of dictionaries with the keys, the state's number from 0 and members of the
        response; pandas.DataFrame takes it."""
        columns = {member: getattr(self.responses, member) for member in members}
        rows = []
        for index in np.ndindex(self.responses.array.shape):
            row = {name: values[k] for name, values, k in zip(self.names, self.values, index)}
            row["state"] = index[-1]
            row.update({member: column[index] for member, column in columns.items()})
            rows.append(row)
        return rows


def get_key(scene: Any, path: str, key: str | None = None) -> Any:
    """What is at a path such as "rve.turgor" or "load.0"; `key` is told where it is not there."""
    for part in path.split("."):
        scene = scene[_at(scene, part, key or path)]
    return scene


def set_key(scene: Any, key: str, value: Any) -> None:
    """Sets a key as "rve.turgor.pressure" or "load.0.F"; its blocks must exist, so that a wrong one is noticed."""
    path, _, last = key.rpartition(".")
    block = get_key(scene, path, key) if path else scene
    block[_at(block, last, key) if isinstance(block, list) else last] = value


def _at(block: Any, part: str, key: str) -> Any:
    """Where a part of the key is in its block."""
    if isinstance(block, list) and part.isdecimal() and int(part) < len(block):
        return int(part)
    if isinstance(block, dict) and part in block:
        return part
    raise InputError(f"the scene has no block {part} of the key {key}")


def _solve_here(jobs: list[Job]) -> Iterator[np.ndarray]:
    """Responses of jobs, each from undeformed tissue. Jobs of one scene use one RVE."""
    of, rve = None, None
    for path, text, loads in jobs:
        if rve is None or of != (path, text):
            of, rve = (path, text), RVE(Scene(path, text))
        rve.reset()
        yield rve.solve(**loads).array


def _solve(jobs: list[Job], processes: int | None) -> np.ndarray:
    """Responses of jobs [jobs, states], solved by so many processes at a time."""
    solved = each(_solve_here, jobs, processes)
    if len({len(states) for states in solved}) > 1:
        raise InputError("the scenes have different numbers of states: "
                         f"{', '.join(str(len(states)) for states in solved)}")
    return np.stack(solved)


def sweep(scene: SceneLike, values: dict[str, Sequence[Any]],
          processes: int | None = None) -> Sweep:
    """Solves a scene along its block `load`, as `lamella rve`, for all combinations of values of its keys.

    scene: path, dictionary or text of one; values: {"rve.turgor.pressure": ["0 MPa", "0.05 MPa"], ...}; processes: at a
    time, default the number of processors. Returns a Sweep. InputError names the key that a scene does not take.
    """
    base = scene_dict(scene)
    jobs: list[Job] = []
    for point in itertools.product(*values.values()):
        varied = copy.deepcopy(base)
        for key, value in zip(values, point):
            set_key(varied, key, value)
        jobs.append(("sweep", varied, {}))
    if not jobs:
        raise InputError("sweep: a key has no values")
    array = _solve(jobs, processes)
    return Sweep(values, Responses(array.reshape([len(v) for v in values.values()] + [-1])))


def solve(scene: SceneLike, F: ArrayLike, turgor: ArrayLike | None = None, cohesion: ArrayLike | None = None,
          P: ArrayLike | None = None, processes: int | None = None, derivatives: bool = True) -> Responses:
    """Solves many states of a scene that are independent of each other, each from undeformed tissue, or many paths.

    F [states, 3, 3]: independent states; F [paths, states, 3, 3]: independent paths, whose states are solved in order.
    The other arguments are those of RVE.solve, and broadcast with the states; processes: at a time, default the number
    of processors. Returns Responses of the shape of the states.
    """
    scene = scene if isinstance(scene, Scene) else Scene(scene)
    loads, stresses = rows_of(scene.pressures, F, turgor, cohesion, P)
    if loads.ndim not in (2, 3) or not loads.size:
        raise InputError(f"solve: states of the shape {loads.shape[:-1]}: [states] or [paths, states], at least one")
    paths = loads.reshape(len(loads), -1, 11)
    jobs: list[Job] = []
    for k, path in enumerate(paths):
        arguments = {"F": path[:, :9].reshape(-1, 3, 3), "turgor": path[:, 9], "cohesion": path[:, 10],
                     "P": None if stresses is None else stresses[k].reshape(-1, 3, 3), "derivatives": derivatives}
        jobs.append((scene.path, scene.text, arguments))
    return Responses(_solve(jobs, processes).reshape(loads.shape[:-1]))
