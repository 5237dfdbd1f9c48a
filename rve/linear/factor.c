/*
  MUMPS LDL^T with one symbolic analysis for the lifetime of the object; values change in place. MUMPS pivots, so
  indefinite matrices are safe, and it counts negative eigenvalues (Sylvester's law of inertia).

  Small systems are first tried without pivoting (ldl.h).

  With several ranks, rank 0 announces every collective call: it broadcasts an order (operation, matrix number, size),
  and all ranks make the same calls. In the distributed matrix rank 0 owns all rows; MUMPS distributes the fronts
  itself. Waiting ranks sleep between polls.
*/
#include "factor.h"
#include "ldl.h"
#include <lamella/rve.h>
#include <time.h>

#define MOST_FACTORS 8 /* distributed over several ranks, at a time */
#define WORKSPACE 50   /* per cent above the estimate of the analysis; increased when delayed pivots need more, ... */
#define MOST_WORKSPACE 100000 /* ... up to four times this */

struct LamFactor_s {
  MPI_Comm comm;
  PetscMPIInt size;
  PetscInt number; /* index in Team */
  PetscInt n, nonzeros;
  PetscInt *row, *column; /* borrowed, on rank 0 */
  PetscReal *values;
  PetscInt margin;     /* workspace margin of MUMPS, per cent; the same on all ranks */
  LamLDL ldl;          /* tried first; NULL: too large */
  PetscBool unpivoted; /* `ldl` holds the present factor */
  Mat matrix, factor;  /* NULL before the first factorisation with pivoting, as the following are */
  Vec rhs, solution;   /* placeholders for the callers' arrays */
};

typedef enum { ORDER_CREATE, ORDER_NUMERIC, ORDER_SOLVE, ORDER_DESTROY, ORDER_DISMISS } OrderType;
typedef struct {
  PetscInt type, number, n;
} Order;

static LamFactor Team[MOST_FACTORS]; /* distributed systems by number; the same on all ranks */

/* Nonblocking, as the receivers poll (Await). */
static PetscErrorCode Broadcast(MPI_Comm comm, Order order)
{
  MPI_Request request;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Ibcast(&order, 3, MPIU_INT, 0, comm, &request));
  PetscCallMPI(MPI_Wait(&request, MPI_STATUS_IGNORE));
  PetscFunctionReturn(0);
}

static PetscErrorCode Announce(LamFactor factor, OrderType type)
{
  const Order order = {type, factor->number, factor->n};

  PetscFunctionBeginUser;
  if (factor->size > 1) PetscCall(Broadcast(factor->comm, order));
  PetscFunctionReturn(0);
}

/* ---- all ranks ---- */

/* Distributed matrix; rank 0 owns all rows. */
static PetscErrorCode CreateDistributed(LamFactor f)
{
  const PetscInt local = f->row ? f->n : 0;
  PetscInt *lengths = NULL;

  PetscFunctionBeginUser;
  if (local > 0) PetscCall(PetscMalloc1(local, &lengths));
  for (PetscInt i = 0; i < local; ++i) lengths[i] = f->row[i + 1] - f->row[i];
  PetscCall(MatCreateSBAIJ(f->comm, 1, local, local, f->n, f->n, 0, lengths, 0, NULL, &f->matrix));
  PetscCall(PetscFree(lengths));
  for (PetscInt i = 0; i < local; ++i)
    PetscCall(MatSetValues(f->matrix, 1, &i, f->row[i + 1] - f->row[i], f->column + f->row[i], f->values + f->row[i],
                           INSERT_VALUES));
  PetscCall(MatAssemblyBegin(f->matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(f->matrix, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateMatrix(LamFactor f)
{
  const PetscInt local = f->row ? f->n : 0;

  PetscFunctionBeginUser;
  if (f->size > 1)
    PetscCall(CreateDistributed(f));
  else
    PetscCall(MatCreateSeqSBAIJWithArrays(f->comm, 1, f->n, f->n, f->row, f->column, f->values, &f->matrix));
  PetscCall(MatSetOption(f->matrix, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(VecCreateMPIWithArray(f->comm, 1, local, f->n, NULL, &f->rhs));
  PetscCall(VecCreateMPIWithArray(f->comm, 1, local, f->n, NULL, &f->solution));
  PetscFunctionReturn(0);
}

static PetscErrorCode Analyse(LamFactor f)
{
  MatFactorInfo info;

  PetscFunctionBeginUser;
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatGetFactor(f->matrix, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &f->factor));
  PetscCall(MatMumpsSetIcntl(f->factor, 14, f->margin));
  PetscCall(MatMumpsSetIcntl(f->factor, 10, 0)); /* no iterative refinement: Newton refines */
  PetscCall(
      MatMumpsSetIcntl(f->factor, 8, 0)); /* no scaling: the unknowns are of similar size; saves a fifth of the time */
  /* default ordering of MUMPS: PORD, the best of its own from 600 to 200,000 unknowns */
  if (f->size > 1) PetscCall(MatMumpsSetIcntl(f->factor, 13, 1)); /* inertia of the whole matrix */
  PetscCall(MatCholeskyFactorSymbolic(f->factor, f->matrix, NULL, &info));
  PetscFunctionReturn(0);
}

static PetscErrorCode Numeric(LamFactor f, PetscInt *negative, PetscBool *ok)
{
  MatFactorInfo info;
  MatFactorError error;

  PetscFunctionBeginUser;
  PetscCall(MatFactorInfoInitialize(&info));
  for (;;) {
    if (!f->factor) PetscCall(Analyse(f));
    PetscCall(MatCholeskyFactorNumeric(f->factor, f->matrix, &info));
    PetscCall(MatFactorGetError(f->factor, &error));
    if (error != MAT_FACTOR_OUTMEMORY || f->margin > MOST_WORKSPACE) break;
    f->margin *= 4;                    /* delayed pivots need more workspace */
    PetscCall(MatDestroy(&f->factor)); /* MUMPS applies the new margin only after another analysis */
  }
  *ok = (PetscBool)(error == MAT_FACTOR_NOERROR);
  *negative = 0;
  if (*ok) PetscCall(MatGetInertia(f->factor, negative, NULL, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(LamFactor f, const PetscReal rhs[], PetscReal solution[])
{
  PetscFunctionBeginUser;
  PetscCall(VecPlaceArray(f->rhs, rhs));
  PetscCall(VecPlaceArray(f->solution, solution));
  PetscCall(MatSolve(f->factor, f->rhs, f->solution));
  PetscCall(VecResetArray(f->rhs));
  PetscCall(VecResetArray(f->solution));
  PetscFunctionReturn(0);
}

static PetscErrorCode Free(LamFactor f)
{
  PetscFunctionBeginUser;
  PetscCall(LamLDLDestroy(&f->ldl));
  PetscCall(MatDestroy(&f->factor));
  PetscCall(MatDestroy(&f->matrix));
  PetscCall(VecDestroy(&f->rhs));
  PetscCall(VecDestroy(&f->solution));
  if (f->size > 1) Team[f->number] = NULL;
  PetscCall(PetscFree(f));
  PetscFunctionReturn(0);
}

/* ---- rank 0 ---- */

PetscErrorCode LamFactorCreate(MPI_Comm comm, PetscInt n, PetscInt row[], PetscInt column[], PetscReal values[],
                               PetscInt positions, LamFactor *factor)
{
  LamFactor f;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  f->comm = comm;
  PetscCallMPI(MPI_Comm_size(comm, &f->size));
  f->margin = WORKSPACE;
  f->n = n;
  f->nonzeros = row[n];
  f->row = row;
  f->column = column;
  f->values = values;
  if (f->size > 1) {
    while (f->number < MOST_FACTORS && Team[f->number]) ++f->number;
    PetscCheck(f->number < MOST_FACTORS, PETSC_COMM_SELF, PETSC_ERR_SUP, "more than %d systems of several ranks",
               MOST_FACTORS);
    Team[f->number] = f;
  }
  PetscCall(Announce(f, ORDER_CREATE));
  if (f->size == 1) PetscCall(LamLDLCreate(n, positions, row, column, values, &f->ldl));
  *factor = f;
  PetscFunctionReturn(0);
}

/* Tries the factorisation without pivoting. *done: there is a factor, or more than `most` eigenvalues are negative. */
static PetscErrorCode TryUnpivoted(LamFactor f, PetscInt most, PetscInt *negative, PetscBool *done)
{
  PetscBool unsure;

  PetscFunctionBeginUser;
  f->unpivoted = *done = PETSC_FALSE;
  if (!f->ldl) PetscFunctionReturn(0);
  PetscCall(LamLDLNumeric(f->ldl, most, negative, &f->unpivoted, &unsure));
  *done = (PetscBool)(f->unpivoted || (*negative > most && !unsure));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFactorNumeric(LamFactor factor, PetscInt *negative, PetscBool *ok)
{
  Mat rows;
  PetscScalar *array; /* on one rank this is factor->values; accessed through PETSc so that the change is registered */

  PetscFunctionBeginUser;
  *negative = 0;
  PetscCall(TryUnpivoted(factor, factor->n, negative, ok));
  if (*ok) PetscFunctionReturn(0);
  PetscCall(Announce(factor, ORDER_NUMERIC));
  if (!factor->matrix) PetscCall(CreateMatrix(factor));
  rows = factor->matrix;
  if (factor->size > 1) PetscCall(MatGetDiagonalBlock(factor->matrix, &rows));
  PetscCall(MatSeqSBAIJGetArray(rows, &array));
  if (array != factor->values) PetscCall(PetscArraycpy(array, factor->values, factor->nonzeros));
  PetscCall(MatSeqSBAIJRestoreArray(rows, &array));
  PetscCall(Numeric(factor, negative, ok));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFactorExpected(LamFactor factor, PetscInt expected, PetscBool *ok)
{
  PetscInt negative;
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(TryUnpivoted(factor, expected, &negative, &done));
  *ok = PETSC_TRUE;
  if (!done) PetscCall(LamFactorNumeric(factor, &negative, ok));
  *ok = (PetscBool)(*ok && negative == expected);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFactorSolve(LamFactor factor, PetscInt count, const PetscReal rhs[], PetscReal solution[])
{
  Mat B, X;

  PetscFunctionBeginUser;
  if (factor->unpivoted) {
    PetscCall(LamLDLSolve(factor->ldl, count, rhs, solution));
    PetscFunctionReturn(0);
  }
  if (count == 1 || factor->size > 1) {
    for (PetscInt k = 0; k < count; ++k) {
      PetscCall(Announce(factor, ORDER_SOLVE));
      PetscCall(Solve(factor, rhs + k * factor->n, solution + k * factor->n));
    }
    PetscFunctionReturn(0);
  }
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, factor->n, count, (PetscScalar *)rhs, &B));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, factor->n, count, solution, &X));
  PetscCall(MatMatSolve(factor->factor, B, X));
  PetscCall(MatDestroy(&B));
  PetscCall(MatDestroy(&X));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFactorDestroy(LamFactor *factor)
{
  PetscFunctionBeginUser;
  if (!*factor) PetscFunctionReturn(0);
  PetscCall(Announce(*factor, ORDER_DESTROY));
  PetscCall(Free(*factor));
  *factor = NULL;
  PetscFunctionReturn(0);
}

/* ---- the other ranks ---- */

static PetscErrorCode Await(MPI_Comm comm, PetscBool (*waiting)(void *ctx), void *ctx, Order *order)
{
  const struct timespec pause = {0, 200000};
  MPI_Request request;
  int done = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Ibcast(order, 3, MPIU_INT, 0, comm, &request));
  while (!done) {
    PetscCallMPI(MPI_Test(&request, &done, MPI_STATUS_IGNORE));
    if (done) break;
    if (waiting) (void)waiting(ctx);
    nanosleep(&pause, NULL);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Join(MPI_Comm comm, const Order *order)
{
  LamFactor f;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  f->comm = comm;
  PetscCallMPI(MPI_Comm_size(comm, &f->size));
  f->margin = WORKSPACE;
  f->number = order->number;
  f->n = order->n;
  Team[f->number] = f;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEServe(MPI_Comm comm, PetscBool (*waiting)(void *ctx), void *ctx)
{
  PetscReal nothing[1] = {0.0};
  Order order;

  PetscFunctionBeginUser;
  do {
    PetscInt negative;
    PetscBool ok;

    PetscCall(Await(comm, waiting, ctx, &order));
    if (order.type == ORDER_CREATE) PetscCall(Join(comm, &order));
    if (order.type == ORDER_NUMERIC && !Team[order.number]->matrix) PetscCall(CreateMatrix(Team[order.number]));
    if (order.type == ORDER_NUMERIC) PetscCall(Numeric(Team[order.number], &negative, &ok));
    if (order.type == ORDER_SOLVE) PetscCall(Solve(Team[order.number], nothing, nothing));
    if (order.type == ORDER_DESTROY) PetscCall(Free(Team[order.number]));
  } while (order.type != ORDER_DISMISS);
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEDismiss(MPI_Comm comm)
{
  const Order order = {ORDER_DISMISS, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(Broadcast(comm, order));
  PetscFunctionReturn(0);
}
