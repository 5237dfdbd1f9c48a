# slow: Many states in parallel processes, threads, types: what several of them do at a time has the numbers of one.
. "$(dirname "$0")/common.sh"
package

cp "$source"/tests/scenes/{shear-bonded,shear-contact}.yaml .

"$python" - <<'PYTHON' || fail "the package"
import inspect, pickle, subprocess, sys, threading, time
import numpy as np
import lamella
from raises import raises
nan = np.nan

def close(one, other):  # other processes round as they like
    assert np.allclose(one, other, rtol=1e-9, atol=1e-6, equal_nan=True), (one, other)

# independent states, and paths; each from undeformed tissue
shear = np.linspace(0, 0.3, 6)
F = np.tile(np.eye(3), (6, 1, 1))
F[:, 0, 1] = shear
batch = lamella.solve("shear-contact.yaml", F, 0.05e6, processes=2)
assert batch.P.shape == (6, 3, 3) and batch.converged.all()
for k in range(6):
    close(batch.P[k], lamella.RVE("shear-contact.yaml").solve(F[k], 0.05e6).P)
turgor = np.array([[1e4], [5e4]])
paths = lamella.solve("shear-contact.yaml", F, turgor, processes=2)  # [2, 6], by the shape of turgor
assert paths.P.shape == (2, 6, 3, 3)
close(paths.P[1], lamella.RVE("shear-contact.yaml").solve(F, 5e4).P)
free = lamella.solve("shear-bonded.yaml", [[[1.1, 0], [0, nan]], [[1.2, 0], [0, nan]]], P=[[nan, nan], [nan, 0]])
close(free.P[:, 1, 1], 0)
close(free.turgor, 2e4)
assert free.F[1, 1, 1] < free.F[0, 1, 1]
bad = lamella.solve("shear-bonded.yaml", [np.eye(3), -np.eye(3)])
assert list(bad.status) == ["converged", "invalid_F"]
raises(lamella.InputError, "[states] or [paths, states]", lambda: lamella.solve("shear-bonded.yaml", np.eye(3)))
raises(lamella.InputError, "F11 and P11 are both given", lambda: lamella.solve("shear-bonded.yaml", [np.eye(3)], P=np.zeros((3, 3))))
raises(lamella.InputError, "different numbers of states", lambda: lamella.sweep("shear-bonded.yaml", {"load": [
    [{"F": [[1, 0], [0, 1]]}], [{"ramp": {"to": [[1, 0.1], [0, 1]], "steps": 2}}]]}))

# threads: the interpreter goes on during a solve, and RVEs of two threads do not disturb each other
rves = [lamella.RVE("shear-bonded.yaml") for _ in range(2)]
many = np.tile(F, (60, 1, 1))
alone = [rve.solve(many, turgor).P for rve, turgor in zip(rves, (1e4, 5e4))]
for rve in rves:
    rve.reset()
found, ticks, done = [None] * 2, [], threading.Event()
def solve(k):
    found[k] = rves[k].solve(many, (1e4, 5e4)[k]).P
    lamella.RVE("shear-bonded.yaml")  # made and destroyed meanwhile
threads = [threading.Thread(target=solve, args=(k,)) for k in range(2)]
began = time.perf_counter()
[thread.start() for thread in threads]
while any(thread.is_alive() for thread in threads):
    ticks.append(time.perf_counter())
    time.sleep(1e-3)
took, longest = ticks[-1] - began, np.diff(ticks).max()
assert took > 0.05 and longest < took / 4, (took, longest)
for one, other in zip(found, alone):
    assert (one == other).all()

# all that is public has types and words
def public(owner, names):
    for name in names:
        thing = inspect.getattr_static(owner, name)
        thing = thing.fget if isinstance(thing, property) else getattr(thing, "__func__", getattr(thing, "func", thing))
        if inspect.isclass(thing):
            yield from public(thing, [n for n in vars(thing) if not n.startswith("_") and n != "dtype"])
        if inspect.isfunction(thing):
            yield thing
functions = list(public(lamella, [name for name in lamella.__all__ if name != "plot"]))
assert len(functions) > 25
for function in functions:
    kinds = inspect.signature(function)
    assert kinds.return_annotation is not kinds.empty, function
    assert all(p.annotation is not p.empty for p in list(kinds.parameters.values()) if p.name != "self"), function
    assert function.__doc__, function
assert all(getattr(lamella, name).__doc__ for name in lamella.__all__ if name != "plot")
if not subprocess.run([sys.executable, "-c", "import mypy"], capture_output=True).returncode:
    folder = lamella.__path__[0]
    done = subprocess.run([sys.executable, "-m", "mypy", "--ignore-missing-imports", "--disallow-untyped-defs",
                           "--cache-dir=mypy", "--exclude", "/plot/", folder], capture_output=True, text=True)
    assert not done.returncode, done.stdout
PYTHON
