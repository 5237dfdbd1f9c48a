# The micro simulations for preCICE's Micro Manager: its calls in the order in which it makes them, its names, states that
# go back, go to another rank and another process, models that are switched, crashes that are exceptions.
. "$(dirname "$0")/common.sh"

python=/usr/bin/python3
export PYTHONPATH=$source/python:$source/tests/support:$source/integrations/micro_manager LAMELLA_LIBRARY
LAMELLA_LIBRARY=$(dirname "$lamella")
"$python" -c 'import cffi, numpy, yaml, h5py' 2>/dev/null || { echo "skipped: python3-cffi, python3-numpy, python3-yaml and python3-h5py are not installed"; exit 77; }
[ -f "$LAMELLA_LIBRARY/liblamella.so" ] || { echo "skipped: no shared library in this build"; exit 77; }
! nm -D "$LAMELLA_LIBRARY/liblamella.so" | grep -q __asan || { echo "skipped: the sanitizers are not loaded by Python"; exit 77; }

expect 0 "$lamella" build "$source/tests/scenes/tissue-block.yaml" -d tissue.h5 --quiet
echo '{"database": "tissue.h5"}' >lamella-micro.json
cat >common.py <<'PYTHON'
import importlib
import numpy as np
import lamella
from raises import raises

def data(F, **scalars):  # what the manager reads: rows of F
    return {"strains1to3": F[0], "strains4to6": list(F[1]), "strains7to9": F[2], **scalars}
def rows(output, name, *ends):
    return np.array([output[name + end] for end in ends])
def P(output):
    return rows(output, "stresses", "1to3", "4to6", "7to9")
def tangent(output):
    return rows(output, "cmat", *map(str, range(1, 28))).reshape(3, 3, 3, 3)
def F(shear, stretch=1.04):
    return np.array([[1.04, shear, 0], [0, stretch, 0], [0, 0, 1]])
def model(module):
    return getattr(importlib.import_module(module, "MicroSimulation"), "MicroSimulation")
PYTHON

expect 0 "$python" - <<'PYTHON'
import pickle, subprocess, sys
from common import *
import lamella_micro

def simulation_class(base):  # of the manager's earlier versions
    class Simulation(base):
        def __init__(self, global_id):
            base.__init__(self, global_id)
            self._global_id = global_id
    return Simulation

# what an RVE and a database say, under FANS's names; in plane strain nothing that the macroscale solver takes is NaN
scene = lamella.scene_dict(lamella.Result("tissue.h5").scene)
rve, db = lamella.RVE(scene), lamella.Database("tissue.h5")
plane = np.ix_(*[[0, 1, 3, 4, 8]] * 2)
outputs = []
for module, r in (("lamella_solve", rve.solve(F(0.03), 2e4)), ("lamella_database", db.query(F(0.03), 2e4))):
    sim = simulation_class(model(module))(3)
    assert sim.get_global_id() == 3
    out = sim.solve(data(F(0.03)), 0.1)
    assert np.allclose(P(out), r.P, rtol=1e-12, atol=1e-6) and out["energy"] == r.energy
    A = tangent(out).reshape(9, 9)
    assert np.allclose(A[plane], r.tangent.reshape(9, 9)[plane], rtol=1e-12, atol=1e-6 * abs(A).max())
    assert np.isfinite(np.concatenate([np.ravel(x) for x in out.values()])).all()
    assert all(np.shape(x) in ((), (3,)) for x in out.values()) and out["solved"] == (module == "lamella_solve")
    outputs.append(out)
assert set(outputs[0]) == set(outputs[1]) and np.allclose(P(outputs[0]), P(outputs[1]), atol=1e-2 * abs(P(outputs[0])).max())
later = sim.solve({name.capitalize(): x for name, x in data(F(0.03)).items()}, 0.1)
assert (later["Stresses4to6"] == out["stresses4to6"]).all() and (later["Cmat27"] == out["cmat27"]).all() and "cmat1" not in later
assert np.allclose(P(sim.solve(data(F(0.03), turgor=1e4), 0.1)), db.query(F(0.03), 1e4).P)

# an implicit coupling: checkpoint, iterations that go back to it, window after window
Simulation = model("lamella_solve")
sims = [Simulation(k) for k in range(3)]
for window in range(1, 4):
    checkpoints = [sim.get_state() for sim in sims]
    assert None not in checkpoints
    for iteration in range(2):
        found = [sim.solve(data(F(0.02 * window + 0.01 * sim.get_global_id())), 0.1) for sim in sims]
        if iteration == 0:
            first = found
            for sim, state in zip(sims, checkpoints):
                sim.set_state(state)
    for one, other in zip(first, found):
        assert (P(one) == P(other)).all()

# a simulation that goes to another rank: made late there, then given state and id; an object that is pickled
state = pickle.loads(pickle.dumps(sims[2].get_state()))
late = Simulation(-1)
late.set_state(state)
late.set_global_id(2)
whole = pickle.loads(pickle.dumps(sims[2]))
goes_on = data(F(0.12))
here = P(sims[2].solve(goes_on, 0.1))
assert (P(late.solve(goes_on, 0.1)) == here).all() and (P(whole.solve(goes_on, 0.1)) == here).all()
assert late.get_global_id() == whole.get_global_id() == 2 and late.get_state() == sims[2].get_state()
code = """import pickle, sys; from common import *
sim = model("lamella_solve")(-1); sim.set_state(pickle.load(sys.stdin.buffer))
sys.stdout.buffer.write(pickle.dumps(P(sim.solve(data(F(0.12)), 0.1))))"""
told = subprocess.run([sys.executable, "-c", code], input=pickle.dumps(state), stdout=subprocess.PIPE, check=True).stdout
assert np.allclose(pickle.loads(told), here, rtol=1e-12, atol=1e-9 * abs(here).max())

# crashes: exceptions that say which and why, and no harm to the state
far = data(F(0.9, 3.0))
kept = sims[0].get_state()
for sim, why in ((sims[0], "invalid_F"), (model("lamella_database")(5), "out_of_reach")):
    bad = data(np.diag([-1.0, 1, 1])) if why == "invalid_F" else far
    raises(lamella_micro.NoResponse, f"micro simulation {sim.get_global_id()}: {why}: ", lambda: sim.solve(bad, 0.1))
thicker = F(0.03)
thicker[2, 2] = 1.02
assert sims[1].solve(data(thicker), 0.1)["solved"]
out_of_plane = F(0.03)
out_of_plane[0, 2] = 0.01
sheared = P(sims[1].solve(data(out_of_plane), 0.1))
assert np.isfinite(sheared).all() and sheared[0, 2] != 0
assert sims[0].get_state() == kept
sims[0].solve(data(F(0.03)), 0.1)
raises(lamella.InputError, "strains7to9: not in the data read", lambda: sims[0].solve({"strains1to3": [1, 0, 0], "strains4to6": [0, 1, 0]}, 0.1))
raises(lamella.InputError, "3 dimensions", lambda: sims[0].solve(data(np.ones((3, 2))), 0.1))
raises(lamella.InputError, "bytes", lambda: sims[0].set_state({"state": 1}))

# model adaptivity: rounds of switch, solve, check until nothing switches; the state is handed on, or kept by model
models = [model("lamella_solve"), model("lamella_database")]
switch = importlib.import_module("lamella_micro", "switching_function").switching_function
def window(sims, states, inputs, kept_by_model):
    output, rounds = None, 0
    while True:
        rounds += 1
        for k, sim in enumerate(sims):
            now = models.index(type(sim))
            target = min(max(now + switch(now, np.zeros(3), 0.0, inputs[k], output and output[k]), 0), 1)
            if target == now:
                continue
            states[k][type(sim)] = sim.get_state()
            sims[k] = models[target](sim.get_global_id())
            if not kept_by_model:
                sims[k].set_state(sim.get_state())
            elif models[target] in states[k]:
                sims[k].set_state(states[k][models[target]])
        output = [sim.solve(one, 0.1) for sim, one in zip(sims, inputs)]
        if all(switch(models.index(type(s)), np.zeros(3), 0.0, one, out) == 0 for s, one, out in zip(sims, inputs, output)):
            return output, rounds
path = [[0.02, 0.05], [0.25, 0.05], [0.25, 0.22], [0.02, 0.24]]
for kept_by_model in (False, True):
    sims, states = [models[0](k) for k in range(2)], [{}, {}]
    for shears in path:
        output, rounds = window(sims, states, [data(F(x)) for x in shears], kept_by_model)
        answered = [db.query(F(x), 2e4).converged for x in shears]
        assert rounds == 1, rounds
        assert [out["solved"] for out in output] == [not known for known in answered]
        for x, out in zip(shears, output):
            r = rve.solve(F(x), 2e4)
            off = abs(P(out) - r.P).max() / abs(r.P).max()
            assert off < (1e-6 if out["solved"] else 1e-2), (x, out["solved"], off, str(r.status), P(out), r.P)
    assert [sim.get_global_id() for sim in sims] == [0, 1]
assert not answered[1] and answered[0]  # the path has both
PYTHON

# a lamella that breaks: iterations break nothing, a window that ends does; settings that name a scene
mkdir scene && cd scene || exit 1
tissue interface='law: lamella, strength: 0.02 MPa, fracture_energy: 0.4 J/m^2' mesh='along: 3, through: 1' </dev/null >tissue.yaml
echo '{"scene": "tissue.yaml"}' >lamella-micro.json
export PYTHONPATH=$PYTHONPATH:$work
expect 0 "$python" - <<'PYTHON'
from common import *
sim = model("lamella_solve")(0)
low, high = data(F(0.02, 1.06)), data(F(0.05, 1.35))
virgin = P(sim.solve(low, 0.1))
checkpoint = sim.get_state()
sim.solve(high, 0.1)
sim.set_state(checkpoint)
assert np.allclose(P(sim.solve(low, 0.1)), virgin, rtol=1e-9, atol=1e-6 * abs(virgin).max())
sim.solve(high, 0.1)
assert abs(P(sim.solve(low, 0.1)) - virgin).max() > 0.05 * abs(virgin).max()
raises(lamella.InputError, "has no database", lambda: model("lamella_database")(0).solve(low, 0.1))
PYTHON
for settings in '{"scene": "tissue.yaml", "database": "x.h5"}' '{"scen": "tissue.yaml"}' '{"scene": "none.yaml"}' '{' ; do
  echo "$settings" >lamella-micro.json
  expect 1 -e 'lamella-micro.json: \|none.yaml' "$python" -c 'import lamella_micro; lamella_micro.tissue()'
done

# the example: data of both configurations are those of preCICE's, and of the classes; the tissue is found
cp "$source"/integrations/micro_manager/example/* .
cp ../tissue.h5 .
expect 0 "$python" - <<'PYTHON'
import json
import xml.etree.ElementTree as xml
from common import *
text = open("precice-config.xml").read().replace("data:", "data-").replace("m2n:", "").replace("export:", "").replace("scheme:", "scheme-")
root = xml.fromstring(text.split("?>")[1])
kinds = {d.get("name"): d.tag[5:] for d in root if d.tag in ("data-vector", "data-scalar")}
names = lambda path, key="name": {e.get(key) for e in root.findall(path)}
manager, macro = (f"participant[@name='{name}']" for name in ("Micro-Manager", "macro"))
own = {"active_state", "active_steps", "model_resolution"}
out = model("lamella_database")(0).solve(data(F(0.02), turgor=1e4), 0.1)
assert {kind + str(np.shape(out[name])) for name, kind in kinds.items() if name in out} == {"vector(3,)", "scalar()"}
assert names("mesh/use-data") == set(kinds) and names("mesh/use-data") - own == names(macro + "/write-data") | names(macro + "/read-data")
assert names("coupling-scheme-serial-implicit/exchange", "data") == set(kinds) - own
for file in ("micro-manager-config.json", "micro-manager-models.json"):
    config = json.load(open(file))
    coupling, models = config["coupling_params"], config.get("micro_file_names", [config.get("micro_file_name")])
    assert set(coupling["read_data_names"]) == names(manager + "/read-data") == names(macro + "/write-data")
    assert set(coupling["write_data_names"]) == names(manager + "/write-data") - own == set(out) == names(macro + "/read-data")
    assert all(model(name) for name in models)
PYTHON
