/*
  MUMPS LDL^T with one symbolic analysis for the lifetime of the object; values change in place. MUMPS pivots, so
  indefinite matrices are safe, and it counts negative eigenvalues (Sylvester's law of inertia). Unknowns are ordered by
  METIS's nested dissection, and the large fronts at its top are compressed to low rank, to rounding.

  Small systems are first tried without pivoting (ldl.h).

  With several ranks, rank 0 announces every collective call: it broadcasts an order (operation, matrix number, size),
  and all ranks make the same calls. Rank 0 has the matrix and all vectors; MUMPS distributes the fronts itself. Waiting
  ranks sleep between polls.

  References. Amestoy, Duff, L'Excellent & Koster, SIAM J. Matrix Anal. Appl. 23 (2001) 15; low rank: Amestoy, Buttari,
  L'Excellent & Mary, ACM Trans. Math. Softw. 45 (2019) 2; METIS: Karypis & Kumar, SIAM J. Sci. Comput. 20 (1998) 359.
*/
#include "factor.h"
#include "ldl.h"
#include <dmumps_c.h>
#include <lamella/rve.h>
#include <metis.h>
#include <time.h>

#define MOST_FACTORS 8 /* distributed over several ranks, at a time */
#define WORKSPACE 50   /* per cent above the estimate of the analysis; increased when delayed pivots need more, ... */
#define MOST_WORKSPACE 100000 /* ... up to four times this */
#define LOW_RANK 1e-14        /* of the largest entries: solutions are as exact as without (docs/results/tearing.md) */

/* Entries of MUMPS's arrays by the numbers of its manual. */
#define ICNTL(mumps, k) ((mumps)->icntl[(k)-1])
#define INFOG(mumps, k) ((mumps)->infog[(k)-1])
#define CNTL(mumps, k) ((mumps)->cntl[(k)-1])

#define MUMPS_CREATE (-1)
#define MUMPS_ANALYSE 1
#define MUMPS_FACTOR 2
#define MUMPS_SOLVE 3
#define MUMPS_DESTROY (-2)

#define MUMPS_SINGULAR (-10)
#define MUMPS_NO_MEMORY (-13)

struct LamFactor_s {
  MPI_Comm comm;
  PetscMPIInt size;
  PetscInt number; /* index in Team */
  PetscInt n;
  PetscInt *row, *column; /* borrowed, on rank 0 */
  PetscReal *values;
  LamLDL ldl;            /* tried first; NULL: too large */
  PetscBool unpivoted;   /* `ldl` holds the present factor */
  DMUMPS_STRUC_C *mumps; /* NULL before the first factorisation with pivoting */
  MUMPS_INT *i, *j;      /* rows and columns of the entries from 1, on rank 0 */
  MUMPS_INT *place;      /* [n] of an unknown in the order of elimination, from 1; on rank 0 */
};

typedef enum { ORDER_CREATE, ORDER_NUMERIC, ORDER_SOLVE, ORDER_DESTROY, ORDER_DISMISS } OrderType;
typedef struct {
  PetscInt type, number, n; /* n: of a solve, the number of right-hand sides */
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

static PetscErrorCode Announce(LamFactor factor, OrderType type, PetscInt n)
{
  const Order order = {type, factor->number, n};

  PetscFunctionBeginUser;
  if (factor->size > 1) PetscCall(Broadcast(factor->comm, order));
  PetscFunctionReturn(0);
}

/* ---- all ranks ---- */

static void Call(LamFactor f, MUMPS_INT job)
{
  f->mumps->job = job;
  dmumps_c(f->mumps);
}

/* Nested dissection of the matrix's graph, whose rows METIS wants whole. */
static PetscErrorCode FindOrdering(LamFactor f)
{
  idx_t n = f->n, *first, *neighbour, *unknown, *place, options[METIS_NOPTIONS];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n + 2, &first));
  PetscCall(PetscMalloc3(2 * f->row[n], &neighbour, n, &unknown, n, &place));
  for (idx_t i = 0; i < n; ++i)
    for (PetscInt p = f->row[i]; p < f->row[i + 1]; ++p) {
      first[i + 2] += f->column[p] != i;
      first[f->column[p] + 2] += f->column[p] != i;
    }
  for (idx_t i = 0; i < n; ++i) first[i + 2] += first[i + 1];
  for (idx_t i = 0; i < n; ++i)
    for (PetscInt p = f->row[i]; p < f->row[i + 1]; ++p) {
      if (f->column[p] == i) continue;
      neighbour[first[i + 1]++] = f->column[p];
      neighbour[first[f->column[p] + 1]++] = i;
    }
  (void)METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 0; /* the same order in every run */
  PetscCheck(METIS_NodeND(&n, first, neighbour, NULL, options, unknown, place) == METIS_OK, PETSC_COMM_SELF,
             PETSC_ERR_MEM, "METIS found no ordering of %d unknowns", (int)n);
  for (idx_t i = 0; i < n; ++i) f->place[i] = place[i] + 1;
  PetscCall(PetscFree(first));
  PetscCall(PetscFree3(neighbour, unknown, place));
  PetscFunctionReturn(0);
}

static PetscErrorCode ListEntries(LamFactor f)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(f->row[f->n], &f->i, f->row[f->n], &f->j, f->n, &f->place));
  for (PetscInt i = 0; i < f->n; ++i)
    for (PetscInt p = f->row[i]; p < f->row[i + 1]; ++p) {
      f->i[p] = i + 1;
      f->j[p] = f->column[p] + 1;
    }
  PetscCall(FindOrdering(f));
  f->mumps->n = f->n;
  f->mumps->nnz = f->row[f->n];
  f->mumps->irn = f->i;
  f->mumps->jcn = f->j;
  f->mumps->a = f->values;
  f->mumps->perm_in = f->place;
  PetscFunctionReturn(0);
}

static PetscErrorCode Analyse(LamFactor f)
{
  DMUMPS_STRUC_C *m;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  f->mumps = m;
  m->par = 1;
  m->sym = 2; /* indefinite */
  m->comm_fortran = MPI_Comm_c2f(f->comm);
  Call(f, MUMPS_CREATE);
  for (PetscInt k = 1; k <= 3; ++k) ICNTL(m, k) = -1; /* no messages */
  ICNTL(m, 4) = 0;
  ICNTL(m, 6) = 0;  /* no permutation to the diagonal, ... */
  ICNTL(m, 7) = 1;  /* ... the ordering is given, ... */
  ICNTL(m, 8) = 0;  /* ... no scaling: the unknowns are of similar size; saves a fifth of the time, ... */
  ICNTL(m, 10) = 0; /* ... no iterative refinement: Newton refines, ... */
  ICNTL(m, 12) = 1;
  ICNTL(m, 13) = 1; /* ... inertia of the whole matrix, ... */
  ICNTL(m, 14) = WORKSPACE;
  ICNTL(m, 35) = 2; /* ... and low rank */
  CNTL(m, 7) = LOW_RANK;
  if (f->row) PetscCall(ListEntries(f));
  Call(f, MUMPS_ANALYSE);
  PetscCheck(INFOG(m, 1) >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB,
             "MUMPS cannot analyse a matrix of %d unknowns: error %d, %d", (int)f->n, (int)INFOG(m, 1),
             (int)INFOG(m, 2));
  PetscFunctionReturn(0);
}

static PetscErrorCode Numeric(LamFactor f, PetscInt *negative, PetscBool *ok)
{
  PetscFunctionBeginUser;
  if (!f->mumps) PetscCall(Analyse(f));
  for (;;) {
    Call(f, MUMPS_FACTOR);
    PetscCheck(INFOG(f->mumps, 1) != MUMPS_NO_MEMORY, PETSC_COMM_SELF, PETSC_ERR_MEM,
               "no memory for the factor of %d unknowns", (int)f->n);
    if (INFOG(f->mumps, 1) >= 0 || INFOG(f->mumps, 1) == MUMPS_SINGULAR || ICNTL(f->mumps, 14) > MOST_WORKSPACE) break;
    ICNTL(f->mumps, 14) *= 4; /* delayed pivots need more workspace */
  }
  *ok = (PetscBool)(INFOG(f->mumps, 1) >= 0);
  *negative = *ok ? INFOG(f->mumps, 12) : 0;
  PetscFunctionReturn(0);
}

/* In place. */
static void Solve(LamFactor f, PetscInt count, PetscReal x[])
{
  f->mumps->nrhs = count;
  f->mumps->lrhs = f->n;
  f->mumps->rhs = x;
  Call(f, MUMPS_SOLVE);
}

static PetscErrorCode Free(LamFactor f)
{
  PetscFunctionBeginUser;
  PetscCall(LamLDLDestroy(&f->ldl));
  if (f->mumps) Call(f, MUMPS_DESTROY);
  PetscCall(PetscFree(f->mumps));
  if (f->i) PetscCall(PetscFree3(f->i, f->j, f->place));
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
  f->n = n;
  f->row = row;
  f->column = column;
  f->values = values;
  if (f->size > 1) {
    while (f->number < MOST_FACTORS && Team[f->number]) ++f->number;
    PetscCheck(f->number < MOST_FACTORS, PETSC_COMM_SELF, PETSC_ERR_SUP, "more than %d systems of several ranks",
               MOST_FACTORS);
    Team[f->number] = f;
  }
  PetscCall(Announce(f, ORDER_CREATE, n));
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
  PetscFunctionBeginUser;
  *negative = 0;
  PetscCall(TryUnpivoted(factor, factor->n, negative, ok));
  if (*ok) PetscFunctionReturn(0);
  PetscCall(Announce(factor, ORDER_NUMERIC, 0));
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
  PetscFunctionBeginUser;
  if (factor->unpivoted) {
    PetscCall(LamLDLSolve(factor->ldl, count, rhs, solution));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscArraycpy(solution, rhs, count * factor->n));
  PetscCall(Announce(factor, ORDER_SOLVE, count));
  Solve(factor, count, solution);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFactorDestroy(LamFactor *factor)
{
  PetscFunctionBeginUser;
  if (!*factor) PetscFunctionReturn(0);
  PetscCall(Announce(*factor, ORDER_DESTROY, 0));
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
  f->number = order->number;
  f->n = order->n;
  Team[f->number] = f;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEServe(MPI_Comm comm, PetscBool (*waiting)(void *ctx), void *ctx)
{
  Order order;

  PetscFunctionBeginUser;
  do {
    PetscInt negative;
    PetscBool ok;

    PetscCall(Await(comm, waiting, ctx, &order));
    if (order.type == ORDER_CREATE) PetscCall(Join(comm, &order));
    if (order.type == ORDER_NUMERIC) PetscCall(Numeric(Team[order.number], &negative, &ok));
    if (order.type == ORDER_SOLVE) Solve(Team[order.number], order.n, NULL);
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
