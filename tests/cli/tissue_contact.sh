# slow: random tissues of 8 to 14 cells, with air and in contact, turgor 0 to 0.3 MPa: at rest, sheared by 0.2 and
# compressed by 0.2 they are solved, or say why not. LAMELLA_TISSUES=200 takes as many, which take 35 minutes; each
# path has a line.
. "$(dirname "$0")/common.sh"

package scipy

"$python" - "$lamella" "${LAMELLA_TISSUES:-6}" <<'PYTHON' || fail "random tissue in contact"
import json, random, subprocess, sys
import numpy as np
from lamella.tissue.make import Asked, make

lamella, tissues = sys.argv[1], int(sys.argv[2])
loads = {"shear": "[[1, 0.2], [0, 1]]", "compression": "[[1, 0], [0, 0.8]]"}
rng, solved, paths = np.random.default_rng(32), 0, 0
for seed in range(tissues):
    cells, variation, elongation = int(rng.integers(8, 15)), rng.uniform(0, 0.5), rng.uniform(1, 3)
    direction, gas, size = rng.uniform(-90, 90), rng.uniform(0, 0.3), rng.uniform(50, 250)
    apothem = np.sqrt(np.pi * size**2 / 4 / (2 * np.sqrt(3)))
    make(Asked(cells, round(size, 1), "um", round(variation, 3), round(elongation, 3), round(direction, 1), 1.0,
               round(rng.uniform(0.05, 0.2) * apothem, 2), round(gas, 4), seed)).write("tissue.json")
    turgor = round(0.3 * random.Random(seed).random(), 3)
    for name, F in loads.items():
        with open("scene.yaml", "w") as scene:
            scene.write(f"""version: 1
rve:
  tissue: tissue.json
  wall: {{law: fibre_mooney_rivlin, C1: 5 MPa, C2: 0.5 MPa, C4: 50 MPa}}
  interface: {{law: contact}}
  turgor: {{mode: prescribed, pressure: {turgor} MPa}}
  mesh: {{along: 4, through: 1}}
load:
  - {{F: [[1, 0], [0, 1]]}}
  - {{ramp: {{to: {F}, steps: 2}}}}
""")
        told = subprocess.run([lamella, "rve", "scene.yaml", "--no-estimate", "--json"], capture_output=True, text=True)
        states = [json.loads(line) for line in told.stdout.splitlines()]
        assert told.returncode in (0, 3) and len(states) == 3, (seed, name, told.stderr)
        failed = [s for s in states if s["status"] != "converged"]
        assert all(s["reason"] for s in failed), (seed, name)
        paths, solved = paths + 1, solved + (not failed)
        print(seed, name, turgor, *(f"{s['status']}: {s['reason']}" for s in failed), flush=True)
print(f"{solved} of {paths} paths are solved")
assert solved >= 0.98 * paths - 1, (solved, paths)  # one more may be missing of few
PYTHON
