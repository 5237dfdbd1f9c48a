"""Sweeps of parameters: one scene, some of its keys varied, in processes of their own."""
import itertools
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from . import RVE, InputError, Responses, Scene, scene_dict


MISTAKE = 2  # exit status of a worker whose scene is wrong


class Sweep:
    """Responses over a grid of parameters.

    names: the keys; values: for each its values, as given. responses: of the shape [len(values[0]), ..., states], with
    the members of Responses as attributes of the sweep, too.
    """

    def __init__(self, values, responses):
        self.names, self.values, self.responses = list(values), list(values.values()), responses

    def __getattr__(self, name):
        if name == "responses":
            raise AttributeError(name)
        return getattr(self.responses, name)

    def table(self, *members):
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


def _set(scene, key, value):
    """Sets a key as "rve.turgor.pressure" or "load.0.F"; its blocks must exist, so that a wrong one is noticed."""
    *path, last = key.split(".")
    block = scene
    for part in path:
        if isinstance(block, list):
            block = block[int(part)]
        elif isinstance(block, dict) and part in block:
            block = block[part]
        else:
            raise InputError(f"sweep: the scene has no block {part} of the key {key}")
    block[int(last) if isinstance(block, list) else last] = value


def _solve_here(texts):
    """What a worker does: responses of scenes along their own loads, one scene after the other, as bytes."""
    scenes = [Scene("sweep", text=text) for text in texts]
    return b"".join(RVE(s).solve(s.F, s.turgor, s.cohesion).array.tobytes() for s in scenes)


def _solve_there(texts):
    """The same in another process, so that processors are shared and a crash is an exception."""
    package = str(Path(__file__).resolve().parents[1])
    paths = [package, *filter(None, [os.environ.get("PYTHONPATH")])]
    done = subprocess.run([sys.executable, "-c", "from lamella import sweeps; sweeps.work()"], input=json.dumps(texts).encode(), capture_output=True,
                          env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)}, check=False)
    if done.returncode == MISTAKE:
        raise InputError(done.stderr.decode().strip())
    if done.returncode:
        raise RuntimeError(f"a worker has ended with status {done.returncode}: {done.stderr.decode().strip()}")
    return np.frombuffer(done.stdout, Responses.dtype).reshape(len(texts), -1)


def sweep(scene, values, processes=None):
    """Solves a scene along its block `load` for all combinations of values of its keys.

    scene: path, dictionary or text of one; values: {"rve.turgor.pressure": ["0 MPa", "0.05 MPa"], ...}; processes: at a
    time, default the number of processors. Returns a Sweep. InputError names the key that a scene does not take.
    """
    base = scene_dict(scene)
    texts = []
    for point in itertools.product(*values.values()):
        varied = json.loads(json.dumps(base))
        for key, value in zip(values, point):
            _set(varied, key, value)
        texts.append(json.dumps(varied))
    if not texts:
        raise InputError("sweep: a key has no values")
    processes = min(processes or len(os.sched_getaffinity(0)), len(texts))
    chunks = [texts[k::processes] for k in range(processes)]
    with ThreadPoolExecutor(processes) as pool:
        solved = list(pool.map(_solve_there, chunks))
    array = np.empty((len(texts), solved[0].shape[1]), Responses.dtype)
    for k, part in enumerate(solved):
        array[k::processes] = part
    return Sweep(values, Responses(array.reshape([len(v) for v in values.values()] + [-1])))


def work():
    """A worker: texts of scenes as JSON on stdin, the bytes of responses on stdout."""
    try:
        answer = _solve_here(json.load(sys.stdin))
    except InputError as error:
        print(error, file=sys.stderr)
        sys.exit(MISTAKE)
    sys.stdout.buffer.write(answer)
