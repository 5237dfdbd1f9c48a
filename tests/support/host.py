"""A host program with several ranks, for the tests: MPI, and PETSc where a test has it, without mpi4py and petsc4py."""
import ctypes
import os

RANK = int(os.environ["OMPI_COMM_WORLD_RANK"])
library = ctypes.CDLL(os.path.join(os.environ["LAMELLA_LIBRARY"], "liblamella.so"))  # finds MPI and PETSc, too
WORLD = ctypes.addressof(ctypes.c_char.in_dll(library, "ompi_mpi_comm_world"))


def start_mpi():
    assert library.MPI_Init(None, None) == 0


def start_petsc():
    assert library.PetscInitializeNoArguments() == 0


def barrier():
    assert library.MPI_Barrier(ctypes.c_void_p(WORLD)) == 0


def end():
    assert library.MPI_Finalize() == 0


def world():
    """The size of PETSC_COMM_WORLD; 0: it is none."""
    comm, size = ctypes.c_void_p.in_dll(library, "PETSC_COMM_WORLD"), ctypes.c_int()
    if comm.value == ctypes.addressof(ctypes.c_char.in_dll(library, "ompi_mpi_comm_null")):
        return 0
    assert library.MPI_Comm_size(comm, ctypes.byref(size)) == 0
    return size.value
