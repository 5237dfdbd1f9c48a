# The loads of a scene, solved in Python, have the numbers of `lamella rve`: prescribed stress, loads from inflated tissue,
# sealed cells, contact, a lamella that breaks.
. "$(dirname "$0")/common.sh"
package

cp "$source"/tests/scenes/{shear-bonded,shear-contact,shear-sealed,uniaxial,apple-tension,uneven-cells}.yaml .
tissue turgor='pressure: 0 MPa' \
  interface='law: lamella, strength: 0.15 MPa, fracture_energy: 2 J/m^2, sharpness: smooth' >torn.yaml <<'END'
  patch: {columns: 3, rows: 2, sides: free, notch: {row: 1, columns: 1}}
load:
  - {F: [[1, 0], [0, 1]]}
  - {ramp: {to: [[1, 0], [0, 1.6]], steps: 12, dissipation: {faces: 0.3}}}
END
tissue turgor='mode: sealed, pressure: 0.02 MPa' >sealed.yaml <<'END'
load:
  - {inflate: true, reference: inflated}
  - {ramp: {to: [[1.05, 0], [0, free]], P: [[x, x], [x, 0 MPa]], steps: 2}}
END

"$python" - "$lamella" <<'PYTHON' || fail "the package"
import glob, json, subprocess, sys
import numpy as np
import lamella
from raises import raises
nan = np.nan

def close(one, other, rtol=1e-10):
    assert np.allclose(one, other, rtol=rtol, atol=1e-9, equal_nan=True), (one, other)

# along a scene's own loads, with what the program tells of each state
UNITS = {"F": 1, "P": 1e6, "tangent": 1e6, "energy": 1e6, "turgor": 1e6, "lumen_fraction": 1, "turgor_mean": 1e6, "jumped": 1,
         "energy_released": 1e6, "error_estimate": 1, "max_traction": 1e6, "broken_fraction": 1, "crack_length": 75e-6, "max_gap": 75e-6}
scenes = sorted(glob.glob("*.yaml"))
assert len(scenes) == 8
for scene in scenes:
    out = subprocess.run([sys.argv[1], "rve", scene, "--json", "--tangent"], capture_output=True, check=True).stdout
    told = [state for state in map(json.loads, out.splitlines()) if "state" in state]
    rve = lamella.RVE(scene)
    for repetition in range(2):  # from undeformed tissue, whatever was solved before
        r = rve.solve(estimate=True)
        assert list(r.status) == [state["status"] for state in told], scene
        for name, unit in UNITS.items():
            close(np.array(getattr(r, name), dtype=float).reshape(len(told), -1),
                  unit * np.array([np.ravel(state[name]) for state in told], dtype=float))

# the same as arrays; NaN where a component is not prescribed
scene = lamella.Scene("shear-sealed.yaml")
assert len(scene) == 5 and np.isnan(scene.F[3:, 0, 0]).all() and (scene.P[3:, 0, 0] == 0).all()
assert not np.isnan(scene.F[:2]).any() and np.isnan(scene.P[:2]).all()
close(lamella.RVE(scene).solve(scene.F, P=scene.P).P, lamella.RVE(scene).solve().P)
raises(lamella.InputError, "find their pressure", lambda: lamella.RVE(scene).solve(np.eye(3), 1e4))

# ... loads that are not known before are none
raises(lamella.InputError, "torn.yaml: load: the ramp follows what is dissipated", lambda: lamella.Scene("torn.yaml").F)
raises(lamella.InputError, "sealed.yaml: load: F counts from the inflated tissue", lambda: lamella.Scene("sealed.yaml").F)
scene = lamella.Scene("uniaxial.yaml")
raises(lamella.InputError, "state 1: F22 and P22 are both NaN", lambda: lamella.RVE(scene).solve(scene.F, P=scene.P))
assert "sealed in the inflated tissue" in str(lamella.RVE("sealed.yaml").solve(np.eye(3)).reason)

# one's own loads: inflated tissue, and what counts from there
rve = lamella.RVE("shear-bonded.yaml")
free = rve.solve([[nan, 0], [0, nan]], P=[[0, nan], [nan, 0]])
assert np.abs(free.P[:2, :2]).max() < 1e-3 and free.turgor == 2e4  # the scene's
stretched = rve.solve([[1.1, 0], [0, nan]] * np.diag(free.F)[:2], P=[[nan, nan], [nan, 0]])
text = lamella.scene_dict("shear-bonded.yaml")
text["load"] = [{"inflate": True}, {"F": [[1.1, 0], [0, "free"]], "P": [["x", "x"], ["x", "0 MPa"]]}]
close(lamella.RVE(text).solve()[1].P[:2, :2], stretched.P[:2, :2], rtol=1e-6)

# kept as bytes, with the F that free components start from
again = lamella.RVE("shear-bonded.yaml")
again.solve([[1.1, 0], [0, nan]] * np.diag(free.F)[:2], P=[[nan, nan], [nan, 0]], state=rve.state)
close(again.solve([[1.1, 0.1], [0, 1]]).P, rve.solve([[1.1, 0.1], [0, 1]]).P)

# mistakes
raises(lamella.InputError, "F11 and P11 are both given", lambda: rve.solve(np.eye(3), P=np.zeros((3, 3))))
raises(lamella.InputError, "P has the shape ()", lambda: rve.solve(np.eye(3), P=0))
raises(lamella.InputError, "give F", lambda: rve.solve(turgor=1e4))
raises(lamella.InputError, "no block `load`", lambda: lamella.RVE({key: text[key] for key in ("version", "rve")}).solve())
raises(lamella.InputError, "scene's own loads alone", lambda: lamella.RVE("torn.yaml").solve(np.eye(3), estimate=True))
assert rve.solve([[nan, 0], [0, 1]]).status == "invalid_F"  # of no answer, but no mistake
assert "rotate" in str(rve.solve([[1, nan], [nan, 1]], P=[[nan, 0], [0, nan]]).reason)
PYTHON
