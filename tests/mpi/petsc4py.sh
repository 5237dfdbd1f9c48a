# petsc4py on two ranks of which one uses Lamella: imported before, its world is whole; imported afterwards, it is an error.
. "$(dirname "$0")/../cli/common.sh"
package mpi4py petsc4py
job() { timeout 60 mpirun -n 2 "$python" "$@"; }

tissue mesh='along: 3, through: 1' </dev/null >scene.yaml
expect 0 job -c '
from petsc4py import PETSc
import lamella
if PETSc.COMM_WORLD.rank == 1:
    assert lamella.RVE("scene.yaml").solve([[1, 0.02], [0, 1]]).converged
x = PETSc.Vec().createMPI(6, comm=PETSc.COMM_WORLD)
x.set(1)
assert x.sum() == 6 and x.getLocalSize() == 3'

# lamella first, with MPI running and without; a rank that fails ends the job
for mpi in 'from mpi4py import MPI' ''; do
  expect 1 -e 'ImportError: import petsc4py before lamella' job -c "$mpi
import lamella
lamella.Scene('scene.yaml')
from petsc4py import PETSc"
done
expect 1 -e 'ImportError: import mpi4py before lamella' job -c 'import lamella
lamella.Scene("scene.yaml")
from mpi4py import MPI'

# a rank alone may do as it likes
for launch in '' 'mpirun -n 1'; do
  expect 0 $launch "$python" -c 'import lamella
lamella.Scene("scene.yaml")
from petsc4py import PETSc
assert PETSc.COMM_WORLD.size == 1'
done
