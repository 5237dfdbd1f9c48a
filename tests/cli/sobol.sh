# lamella.sobol: indices of Ishigami's function and Sobol's g within 0.02 of the known ones; lamella sensitivity has them.
. "$(dirname "$0")/common.sh"
package scipy

cat >known.py <<'PYTHON'
import numpy as np
from known_functions import KNOWN
from lamella.sobol import points, sobol

def sizes(first, total, of):
    """The largest error, and the share of the intervals that hold the indices."""
    exact, found = np.array([first, total]), np.array([of.first, of.total])
    ends = np.array([of.first_interval, of.total_interval])
    return np.abs(found - exact).max(), np.mean((ends[..., 0] <= exact) & (exact <= ends[..., 1]))

# 2048 rows, 10,240 and 20,480 evaluations, are enough for errors of 0.02 in all indices
for k, (f, first, total) in KNOWN.items():
    for seed in range(3):
        error, held = sizes(first, total, sobol(f(points(k, 2048, seed)), k, seed))
        assert error < 0.02 and held > 0.9, (k, seed, error, held)
PYTHON
"$python" known.py || fail "the indices"
tissue <<'END' >scene.yaml
load: [{F: [[1, 0], [0, 1]]}, {F: [[1.1, 0], [0, 1]]}]
uncertain: [{key: rve.wall.C1, from: 0.05 MPa, to: 0.2 MPa}, {key: rve.wall.C4, from: 0.5 MPa, to: 2 MPa}]
END
expect 0 -o "^  rve.wall.C1 .* 0\.[0-9]* ± " "$lamella" sensitivity scene.yaml --evaluations 16 --figure modulus --processes 1
expect 2 -e "stiffness: is no figure; there are modulus, " "$lamella" sensitivity scene.yaml --figure modulus,stiffness
