# slow: Tissue in FEniCSx: forces of blocks are those of `lamella fe2`, states without response are an error and change nothing.
. "$(dirname "$0")/common.sh"

python=/usr/bin/python3
export PYTHONPATH=$source/python:$source/integrations/fenicsx LAMELLA_LIBRARY XDG_CACHE_HOME=$work/cache
LAMELLA_LIBRARY=$(dirname "$lamella")
"$python" -c 'import cffi, yaml, dolfinx' 2>/dev/null || { echo "skipped: python3-dolfinx, python3-cffi and python3-yaml are not installed"; exit 77; }
[ -f "$LAMELLA_LIBRARY/liblamella.so" ] || { echo "skipped: no shared library in this build"; exit 77; }
! nm -D "$LAMELLA_LIBRARY/liblamella.so" | grep -q __asan || { echo "skipped: the sanitizers are not loaded by Python"; exit 77; }
ln -s "$source/tests" tests
block() { "$python" "$source/integrations/fenicsx/block.py" "$@"; }

# the block of the tutorial from a database, also in one step, which has to be halved, and on 2 ranks: to 1e-8
expect 0 "$lamella" build tests/scenes/tissue-block.yaml -d tissue.h5 --quiet
cp tissue.h5 coarse.h5
expect 0 "$lamella" fe2 tests/scenes/tissue-block.yaml -d tissue.h5 --no-certify --quiet
expect 0 -o 'step  5 .*e-[0-9]* ' block tests/scenes/tissue-block.yaml -d tissue.h5
sed 's/steps: 5/steps: 1/' tests/scenes/tissue-block.yaml >one.yaml
expect 0 -o '[1-9] increments halved' -e 'out_of_reach' block one.yaml -d tissue.h5
if command -v mpirun >/dev/null; then
  expect 0 mpirun -n 2 "$python" "$source/integrations/fenicsx/block.py" one.yaml -d tissue.h5
fi
expect 1 block one.yaml -d tissue.h5 --tolerance 1e-17

# an RVE at each point: uneven cells, which turn the block as it swells; a lamella that breaks
tissue cell='apothem: 75 um, wall_thickness: 11.25 um, orientation: 7 deg' mesh='along: 3, through: 1' >uneven.yaml <<'YAML'
  cells: [2, 1]
  variation: {field: {wall_thickness: 0.2, correlation: 1, seed: 3}}
macro:
  mesh: {box: [10 mm, 5 mm], elements: [1, 1]}
  boundary: [{on: bottom, displacement: [0.2 mm, 0 mm]}, {on: top, displacement: [1 mm, free]}]
  steps: 1
YAML
expect 0 block uneven.yaml --direct
sed 's/elements: \[8, 8\]/elements: [2, 2]/; s/steps: 5/steps: 2/' tests/scenes/tissue-block.yaml >small.yaml
expect 0 block small.yaml --direct
tissue interface='law: lamella, strength: 0.02 MPa, fracture_energy: 0.4 J/m^2' turgor='mode: prescribed, pressure: 0.01 MPa' \
  mesh='along: 3, through: 1' >lamella.yaml <<'YAML'
macro:
  mesh: {box: [1 mm, 1 mm], elements: [1, 1]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [0.02 mm, 0.08 mm]}]
  steps: 2
YAML
expect 0 block lamella.yaml --direct

expect 0 "$python" - <<'PYTHON'
import numpy as np
from dolfinx import fem, mesh
from mpi4py import MPI
import lamella
from lamella_fenicsx import Newton, NoResponse, Tissue

def square(n, L):
    box = mesh.create_rectangle(MPI.COMM_SELF, [[0, 0], [L, L]], [n, n], mesh.CellType.quadrilateral)
    return fem.Function(fem.VectorFunctionSpace(box, ("CG", 2)))
def stretch(u, F):
    u.interpolate(lambda x: (np.array(F) - np.eye(2)) @ x[:2])

# states out of reach: their number and reasons; nothing of them is in P or u
u = square(2, 0.01)
tissue = Tissue(u, lamella.Database("coarse.h5"), turgor=2e4)
stretch(u, [[1.03, 0], [0, 1.03]])
tissue.update()
work = fem.form(tissue.P[0, 0] * tissue.dx)
before = fem.assemble_scalar(work)
assert np.isclose(before, 1e-4 * tissue.responses.P[0, 0, 0, 0], rtol=1e-12)
X = tissue.place()
tissue.turgor = np.where(X[..., 0] < 0.005, 2e4, np.where(X[..., 1] < 0.005, 1e9, 2e4))  # one element of four
try:
    tissue.update()
    raise AssertionError("turgor of 1 GPa")
except NoResponse as error:
    assert error.count == 9 and sum(error.reasons.values()) == 9 and "out_of_reach" in next(iter(error.reasons)), error
    assert "9 material points" in str(error) and "turgor 1e+09 Pa" in str(error)
assert fem.assemble_scalar(work) == before
corner = fem.locate_dofs_geometrical(u.function_space, lambda x: np.isclose(x[0], 0))
old = u.x.array.copy()
try:
    Newton(tissue, [fem.dirichletbc(np.zeros(2), corner, u.function_space)]).solve()
    raise AssertionError("solved")
except NoResponse:
    assert (u.x.array == old).all()

# of an RVE: the tangent is the derivative; an increment that is given up breaks nothing, one that is accepted does
u = square(1, 0.001)
tissue = Tissue(u, lamella.RVE("lamella.yaml"), turgor=1e4)
F = np.array([[1.0, 0.02], [0.0, 1.05]])
def P(F):
    stretch(u, F)
    tissue.update()
    return tissue.responses.P[0, 0, :2, :2].copy()
first, h = P(F), 1e-6
A = tissue.responses.tangent[0, 0, :2, :2, 1, 1].copy()
assert np.allclose((P(F + [[0, 0], [0, h]]) - P(F - [[0, 0], [0, h]])) / (2 * h), A, rtol=1e-4, atol=1e-4 * abs(A).max())
P([[1.0, 0.06], [0.0, 1.3]])
assert tissue.responses.broken_fraction.min() > 0.1 and np.allclose(P(F), first, rtol=1e-9, atol=1e-6 * abs(first).max())
P([[1.0, 0.06], [0.0, 1.3]])
tissue.accept()
assert abs(P(F) - first).max() > 0.1 * abs(first).max()

# three dimensions
cube = mesh.create_unit_cube(MPI.COMM_SELF, 1, 1, 1, mesh.CellType.hexahedron)
try:
    Tissue(fem.Function(fem.VectorFunctionSpace(cube, ("CG", 2))), lamella.Database("coarse.h5"))
    raise AssertionError("a cube")
except ValueError as error:
    assert "plane strain" in str(error)
PYTHON

# what the reference shows
cp "$source/docs/reference/fenicsx.md" .
expect 0 "$python" -m doctest fenicsx.md
