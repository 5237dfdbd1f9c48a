# A rank of a job uses Lamella while the others do not: Python and a material of C, in a host that has started neither MPI nor
# PETSc, MPI, or both. Nothing waits, and the host's world is whole.
. "$(dirname "$0")/../cli/common.sh"
package h5py
job() { timeout 60 mpirun -n 2 "$python" "$@"; }

tissue mesh='along: 3, through: 1' >scene.yaml <<'YAML'
load: [{F: [[1, 0.02], [0, 1]]}]
YAML
cat >use.py <<'PYTHON'
import ctypes, sys
import host

def environment():  # of C, which Python's os.environ is a copy of
    all, found = ctypes.POINTER(ctypes.c_char_p).in_dll(ctypes.CDLL(None), "environ"), []
    while all[len(found)]:
        found.append(all[len(found)])
    return sorted(v for v in found if v.startswith((b"OMPI_", b"PMIX_", b"ORTE_")))

def by_python():
    import lamella
    before = environment()
    rve = lamella.RVE("scene.yaml")
    assert environment() == before and len(before) > 5
    return rve.solve([[1, 0.02], [0, 1]], estimate=True).converged and rve.solve().converged.all()

def by_material():
    material, F, P = ctypes.c_void_p(), (ctypes.c_double * 9)(1, 0.02, 0, 0, 1, 0, 0, 0, 1), (ctypes.c_double * 9)()
    assert host.library.LamMaterialCreateFromScene(b"scene.yaml", 0, ctypes.byref(material)) == 0
    assert host.library.LamMaterialEvaluate(material, 1, None, F, None, None, P, None, None) == 0
    return P[1] > 0

started, way = sys.argv[1:]
if started != "nothing":
    host.start_mpi()
if started == "petsc":
    host.start_petsc()
if host.RANK == 1:
    assert {"python": by_python, "material": by_material}[way]()
if started != "nothing":
    host.barrier()
    host.end()
PYTHON
expect 0 job use.py nothing python
expect 0 job use.py nothing material
expect 0 job use.py mpi python
expect 0 job use.py petsc material

# a host that starts PETSc later has its own world where MPI was running, and none where it was not
cat >later.py <<'PYTHON'
import sys
import host
if sys.argv[1] == "mpi":
    host.start_mpi()
import lamella
lamella.Scene("scene.yaml")
host.start_petsc()
assert host.world() == (2 if sys.argv[1] == "mpi" else 0), host.world()
if sys.argv[1] == "mpi":
    host.barrier()
    host.end()
PYTHON
expect 0 job later.py mpi
expect 0 job later.py nothing
expect 0 mpirun -n 1 "$python" -c 'import host, lamella; lamella.Scene("scene.yaml"); assert host.world() == 1'
