# slow: synthetic curves with 2 % of noise: of the 95 % intervals of five parameters at least 90 % hold the truth.
. "$(dirname "$0")/common.sh"
package scipy

tissue wall='law: fibre_exponential, C1: 0.1 MPa, C2: 0.02 MPa, k1: 0.4 MPa, k2: 3, dispersion: 0.1' \
  turgor='pressure: 0.02 MPa' >tissue.yaml </dev/null

"$python" - <<'PYTHON' || fail "the package"
import numpy as np
import lamella
from lamella.calibration import Curve, calibrate

LOADS = ([[1.25, 0], [0, 1]], "11"), ([[1, 0.4], [0, 1]], "12"), ([[1.15, 0], [0, 1.15]], "22")
BOUNDS = {"rve.wall.C1": ("0.02 MPa", "0.5 MPa"), "rve.wall.dispersion": (0.001, 0.33), "rve.wall.k1": ("0.05 MPa", "3 MPa"),
          "rve.wall.k2": (0.3, 30.0), "rve.turgor.pressure": ("0.002 MPa", "0.1 MPa")}
TRUTH = 0.1, 0.1, 0.4, 3, 0.02

def curve(to, of, rng):
    scene = lamella.scene_dict("tissue.yaml") | {"load": [{"ramp": {"to": to, "steps": 12}}]}
    r = lamella.RVE(scene).solve()
    F, P = (getattr(r, name)[:, int(of[0]) - 1, int(of[1]) - 1] for name in "FP")
    return Curve(scene, {f"F{of}": F, f"P{of} (Pa)": P + 0.02 * np.abs(P).max() * rng.standard_normal(len(P))}, 0.02)

held = []
for seed in range(6):
    rng = np.random.default_rng(seed)
    fit = calibrate(BOUNDS, [curve(*load, rng) for load in LOADS], starts=1)
    held += list((fit.intervals[:, 0] <= TRUTH) & (TRUTH <= fit.intervals[:, 1]))
assert np.mean(held) >= 0.9, np.mean(held)
PYTHON
