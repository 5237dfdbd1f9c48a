# lamella.sobol: indices of Ishigami's function and Sobol's g within 0.02 of the known ones; lamella sensitivity has them.
. "$(dirname "$0")/common.sh"
package scipy

cat >known.py <<'PYTHON'
import numpy as np
from lamella.sobol import points, sobol

def ishigami(u):
    x = np.pi * (2 * u - 1)
    return np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])

A = np.array([0, 1, 4.5, 9, 99, 99, 99, 99])
parts = np.array([(1 + 0.1 * np.pi**4 / 5) ** 2 / 2, 49 / 8, 0.01 * np.pi**8 * (1 / 18 - 1 / 50)])  # V1, V2, V13
alone = 1 / (3 * (1 + A) ** 2)
known = {3: (ishigami, np.array([*parts[:2], 0]) / parts.sum(), np.array([parts[0] + parts[2], parts[1], parts[2]]) / parts.sum()),
         8: (lambda u: np.prod((np.abs(4 * u - 2) + A) / (1 + A), axis=1), alone / (np.prod(1 + alone) - 1),
             alone / (1 + alone) * np.prod(1 + alone) / (np.prod(1 + alone) - 1))}
for k, (f, first, total) in known.items():
    for seed in range(3):
        found = sobol(f(points(k, 2048, seed)), k, seed)
        error = max(np.abs(found.first - first).max(), np.abs(found.total - total).max())
        assert error < 0.02, (k, seed, error)
PYTHON
"$python" known.py || fail "the indices"
tissue <<'END' >scene.yaml
load: [{F: [[1, 0], [0, 1]]}, {F: [[1.1, 0], [0, 1]]}]
uncertain: [{key: rve.wall.C1, from: 0.05 MPa, to: 0.2 MPa}, {key: rve.wall.C4, from: 0.5 MPa, to: 2 MPa}]
END
expect 0 -o "^  rve.wall.C1 .* 0\.[0-9]* ± " "$lamella" sensitivity scene.yaml --evaluations 16 --figure modulus --processes 1
expect 2 -e "stiffness: is no figure; there are modulus, " "$lamella" sensitivity scene.yaml --figure modulus,stiffness
