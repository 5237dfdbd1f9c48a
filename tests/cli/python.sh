# The Python package: its numbers are those of the program, states without an answer are flags, mistakes exceptions.
. "$(dirname "$0")/common.sh"

package

cp "$source/tests/scenes/shear-contact.yaml" contact.yaml
expect 0 "$lamella" rve contact.yaml --json --tangent --no-estimate
cp out.txt rve.txt
cat >table.yaml <"$source/tests/fuzz/files/contact-table.yaml"
expect 0 "$lamella" build table.yaml -d table.h5 --quiet
expect 0 "$lamella" query table.h5 -F 1.01,0.02,0,0.99 --turgor "0.02 MPa" --cohesion "0.001 MPa" --accuracy 0.05 --json --tangent

"$python" - <<'PYTHON' || fail "the package"
import json, threading
import numpy as np
import lamella
from raises import raises

def close(one, other):
    assert np.allclose(one, other, rtol=1e-12, atol=1e-9, equal_nan=True), (one, other)
def pascals(told):  # null is not known
    return 1e6 * np.array(told, dtype=float).ravel()

# states of a scene, one after the other
scene = lamella.Scene("contact.yaml")
rve = lamella.RVE(scene)
r = rve.solve(scene.F, scene.turgor, scene.cohesion)
told = [json.loads(line) for line in open("rve.txt")]
assert len(r) == len(told) > 2 and list(r.status) == [t["status"] for t in told] and r.converged.all()
for k, t in enumerate(told):
    close(r.P[k].ravel(), pascals(t["P"]))
    close(r.tangent[k].ravel(), pascals(t["tangent"]))
    close(r.debonded_fraction[k], t["debonded_fraction"])
assert r.P.shape == (len(r), 3, 3) and r.tangent.shape == (len(r), 3, 3, 3, 3) and r.stable.dtype == bool

# a state is kept as bytes
state = rve.state
last = rve.solve(scene.F[-1], scene.turgor[-1], scene.cohesion[-1])
rve.reset()
rve.state = state
close(rve.solve(scene.F[-1][:2, :2], scene.turgor[-1], scene.cohesion[-1]).P, last.P)

# a state without an answer
bad = rve.solve(np.diag([-1.0, 1, 1]))
assert not bad.converged and bad.status != "converged" and str(bad.reason).endswith("both must be positive")

# queries, of many states and threads
db = lamella.Database("table.h5")
t = json.loads(open("out.txt").read())
F = np.array([[1.01, 0.02], [0, 0.99]])
one = db.query(F, 2e4, 1e3, accuracy=0.05)
close(one.P.ravel(), pascals(t["P"]))
close(one.tangent.ravel(), pascals(t["tangent"]))
assert one.status == t["status"] and one.error_estimate == t["error_estimate"]
many = db.query(np.tile(F, (50, 4, 1, 1)), 2e4, 1e3, accuracy=0.05)
assert many.P.shape == (50, 4, 3, 3) and (many.P == one.P).all()
results = [None] * 4
def ask(k):
    results[k] = db.query(np.tile(F, (200, 1, 1)), 2e4, 1e3, accuracy=0.05).P
threads = [threading.Thread(target=ask, args=(k,)) for k in range(4)]
[thread.start() for thread in threads], [thread.join() for thread in threads]
assert all((P == one.P).all() for P in results)

# a sweep: the states of each scene, as it solves them alone; not in one process, so by no more than rounding
grid = {"rve.turgor.pressure": ["0 MPa", "0.02 MPa", "0.05 MPa"], "rve.wall.C4": ["1 MPa", "2 MPa"]}
swept = lamella.sweep("contact.yaml", grid, processes=2)
assert swept.P.shape == (3, 2, len(scene.F), 3, 3) and (swept.status == "converged").all()
varied = lamella.scene_dict("contact.yaml")
varied["rve"]["turgor"]["pressure"], varied["rve"]["wall"]["C4"] = "0.05 MPa", "2 MPa"
alone = lamella.Scene(varied)
assert np.allclose(swept.P[2, 1], lamella.RVE(alone).solve(alone.F, alone.turgor, alone.cohesion).P, rtol=1e-9, atol=1e-6)
rows = swept.table("status", "energy")
assert len(rows) == 6 * len(scene.F) and rows[-1]["rve.wall.C4"] == "2 MPa" and rows[-1]["state"] == len(scene.F) - 1
assert rows[-1]["energy"] == swept.energy[2, 1, -1]

# the program's commands
told = lamella.run("rve", "contact.yaml", "-o", "contact.h5", "--no-estimate")
assert told.complete and len(told) == len(scene.F) and not told.warnings
close(told[-1]["P"], 1e-6 * r.P[-1].ravel())
assert lamella.run("info", "contact.h5")[0]["kind"] == "rve"

# their files
try:
    import h5py
except ImportError:
    h5py = None
if h5py:
    with lamella.Result("contact.h5") as file:
        assert file.kind == "rve" and list(file.keys) == list(range(1, len(scene.F) + 1)) and "contact" in file.scene
        close(file.responses.P, r.P)
        close(file.responses.energy, r.energy)
        assert (file.responses.status == r.status).all() and (file.responses.stable == r.stable).all()
        fields = file.fields(1)
        assert np.abs(fields["x"]).max() > 50e-6 and fields["interface/gap"].shape == fields["interface/pressure"].shape
        assert np.isclose(fields["interface/pressure"].max(), 1e6 * file.file["fields/1/interface/pressure"][()].max())
assert not lamella.run("query", "table.h5", "-F", "1.01 0.02 0 0.99", "--accuracy", 1e-6).complete

# mistakes
raises(lamella.InputError, "text:2:7: rve.cel: unknown key; did you mean cell?",
       lambda: lamella.Scene("text", text="version: 1\nrve: {cel: 3}\n"))
raises(lamella.InputError, "shape (3, 2)", lambda: rve.solve(np.ones((3, 2))))
raises(lamella.InputError, "a state of 3 bytes", lambda: setattr(rve, "state", b"abc"))
raises(lamella.InputError, "contact.yaml", lambda: lamella.Database("contact.yaml"))
raises(lamella.InputError, "no block turgr", lambda: lamella.sweep("contact.yaml", {"rve.turgr.pressure": [1]}))
raises(lamella.InputError, "did you mean pressure?", lambda: lamella.sweep("contact.yaml", {"rve.turgor.presure": ["1 Pa"]}))
raises(lamella.InputError, "cannot be opened", lambda: lamella.run("rve", "none.yaml"))
raises(lamella.InputError, "--colour", lambda: lamella.run("check", "contact.yaml", "--colour"))
raises(lamella.InputError, "contact.yaml: is not an HDF5 file; give", lambda: lamella.Result("contact.yaml"))
nan = np.nan
raises(OSError, "none.h5: cannot be read: No such file or directory", lambda: lamella.Result("none.h5"))
raises(lamella.InputError, "none.yaml: the scene cannot be opened", lambda: lamella.scene_dict("none.yaml"))
for call, words in ((lambda: rve.solve(np.eye(3), turgor=nan), "turgor: nan: is not a finite number"),
                    (lambda: rve.solve(np.eye(3), cohesion=[0, np.inf]), "cohesion: inf: is not a finite number"),
                    (lambda: rve.solve(np.eye(3), turgor="0.02 MPa"), "turgor: '0.02 MPa': an array of numbers is wanted"),
                    (lambda: rve.solve(np.ones((3, 3, 3)), turgor=[1, 2]), "F (3,), P (), turgor (2,), cohesion ()"),
                    (lambda: lamella.Database("table.h5").query(np.eye(3), accuracy=-1), "accuracy: -1: is not above 0"),
                    (lambda: lamella.Database("table.h5").query(np.eye(3), accuracy=nan), "accuracy: nan: is not above 0"),
                    (lambda: lamella.solve("contact.yaml", [np.eye(3)] * 2, processes=0), "processes: 0: a whole number from 1"),
                    (lambda: lamella.sweep("contact.yaml", {"rve.wall.C1": ["1 MPa"]}, processes=-1), "processes: -1: a whole"),
                    (lambda: lamella.run("check", "contact.yaml", ranks=0), "ranks: 0: at least 1"),
                    (lambda: lamella.Responses.help("lumen"), "a response has no lumen; did you mean lumen_contact or lumen_fraction?"),
                    (lambda: lamella.Scene({"version": {1}}), "the scene: {1}: is of type set"),
                    (lambda: lamella.Scene(None), "Scene: None: a path or a dictionary is wanted"),
                    (lambda: lamella.quantity("5"), '"5": has no unit; write'),
                    (lambda: lamella.quantity("5,3 MPa"), "has a decimal comma"),
                    (lambda: lamella.quantity("5 foo"), 'the unit "foo" is unknown')):
    raises(lamella.InputError, words, call)

# NumPy's numbers and arrays in a scene are those of Python; what things are
bare = lamella.scene_dict("contact.yaml") | {"load": [{"F": [[1.1, 0], [0, 1]], "turgor": "1 kPa"}], "cells": [2, 1]}
bare["rve"] = bare["rve"] | {"cells": [2, 1]}
del bare["cells"]
array = bare | {"load": [{"F": np.array([[1.1, 0], [0, 1]]), "turgor": np.str_("1 kPa")}], "version": np.int64(1)}
array["rve"] = bare["rve"] | {"cells": np.array([2, 1])}
assert lamella.scene_dict(array) == bare and (lamella.Scene(array).F == lamella.Scene(bare).F).all()
assert repr(lamella.Scene(array)) == "<lamella.Scene scene: 1 states in its block load>"
assert repr(rve).startswith("<lamella.RVE of ") and "apothem" in repr(rve)
assert repr(rve.solve(np.stack([np.eye(3), np.diag([-1, 1, 1])]))) == \
    "<lamella.Responses: 2 states of the shape (2,): 1 converged, 1 invalid_F>"
raises(AttributeError, "a response has no stress", lambda: one.stress)
assert "Piola" in lamella.Responses.help("P") and "Pa" in lamella.Responses.help("P")
PYTHON

# what the reference shows
ln -s "$source/tests" tests
cp "$source/docs/reference/python.md" .
"$python" -m doctest python.md || fail "docs/reference/python.md"

# installed by pip, away from the sources
if "$python" -c 'import setuptools, pip, venv, wheel' 2>/dev/null; then
  mkdir -p sources/build sources/include/lamella sources/tests/scenes
  cp -r "$source/python" sources
  cp -r "$source/tests/scenes/tissues" sources/tests/scenes
  cp "$source/include/lamella/bind.h" sources/include/lamella
  cp "$lamella" "$LAMELLA_LIBRARY/liblamella.so" sources/build
  "$python" -m venv --system-site-packages installed
  expect 0 installed/bin/pip install --no-build-isolation --no-index --quiet ./sources/python # Debian's packages suffice
  env -u PYTHONPATH -u LAMELLA_LIBRARY installed/bin/python -c '
import lamella
assert "installed" in lamella.__file__
assert lamella.RVE("tests/scenes/shear-bonded.yaml").solve([[1, 0], [0, 1]], 2e4).converged
import pathlib
assert (pathlib.Path(lamella.__file__).parent / "py.typed").exists()
import lamella.cells, lamella.plot, lamella.tissue, lamella.validation as validation
assert "installed" in str(validation.TISSUES) and len(list(validation.TISSUES.glob("*.yaml"))) >= 6
assert lamella.run("check", "tests/scenes/shear-bonded.yaml").complete' || fail "the installed package"
fi

# without what it needs
"$python" -m venv --without-pip bare
expect 1 -e "^ImportError: lamella needs numpy and cffi, not installed for .*bare/bin/python: run pip install numpy cffi" bare/bin/python -c 'import lamella'

# next to mpi4py and petsc4py, where they are installed, also on ranks of a job; what it starts is none of them
if "$python" -c 'import mpi4py, petsc4py' 2>/dev/null; then
  cat >beside.py <<'PYTHON'
import sys
from mpi4py import MPI
if MPI.COMM_WORLD.size > 1:
    import petsc4py.PETSc
import lamella
import numpy as np
assert lamella.quantity("1 mm") == 1e-3  # has started PETSc, or finds it
import petsc4py
petsc4py.init(sys.argv)
from petsc4py import PETSc
vector = PETSc.Vec().createSeq(3)
vector.set(2)
scene = "tests/scenes/shear-bonded.yaml"
assert lamella.RVE(scene).solve(np.eye(3), 2e4).converged and vector.sum() == 6
try:
    lamella.Scene(text="version: 2")
except lamella.InputError as error:
    assert "scene:1:10: version" in str(error), error
else:
    raise AssertionError("no error")
try:
    vector.dot(PETSc.Vec().createSeq(4))
except PETSc.Error as error:
    assert error.ierr == 75, error
else:
    raise AssertionError("no error of petsc4py")
if MPI.COMM_WORLD.rank == 0:
    assert lamella.solve(scene, [np.eye(3)], 2e4, processes=1).converged.all()
    assert lamella.run("rve", scene, ranks=2).complete
print("solved", MPI.COMM_WORLD.allreduce(1))
PYTHON
  expect 0 -o 'solved 1' "$python" beside.py
  expect 0 -o 'solved 2' mpirun -n 2 "$python" beside.py
fi
