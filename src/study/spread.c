#include "spread.h"
#include "gather.h"

typedef struct {
  MPI_Comm comm;       /* borrowed */
  LamResponder solver; /* borrowed */
} Spread;

/* All ranks: rank r answers queries r, r + ranks, ... ; all get all responses. */
static PetscErrorCode Answer(const Spread *spread, PetscInt n, const LamLoad loads[], LamResponse responses[])
{
  PetscMPIInt rank, ranks, *starts;
  LamResponse *mine, *all;
  PetscInt *points, count = 0;
  LamLoad *share;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(spread->comm, &rank));
  PetscCallMPI(MPI_Comm_size(spread->comm, &ranks));
  PetscCall(PetscMalloc3(n, &share, n, &points, n, &mine));
  for (PetscInt k = rank; k < n; k += ranks) {
    share[count] = loads[k];
    points[count++] = -1;
  }
  PetscCall(LamResponderRespond(spread->solver, count, share, points, mine));
  PetscCall(LamGather(spread->comm, sizeof(*mine), count, mine, &starts, (void **)&all));
  for (PetscInt k = 0; k < n; k++) responses[k] = all[starts[k % ranks] + k / ranks];
  PetscCall(PetscFree(starts));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree3(share, points, mine));
  PetscFunctionReturn(0);
}

static PetscErrorCode Respond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                              LamResponse responses[])
{
  const Spread *spread = ctx;
  size_t bytes = (size_t)n * sizeof(*loads);

  PetscFunctionBeginUser;
  (void)points;
  if (!n) PetscFunctionReturn(0);
  PetscCall(LamShareBytes(spread->comm, 0, &bytes, (void *)&loads)); /* only read on this rank */
  PetscCall(Answer(spread, n, loads, responses));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **ctx)
{
  void *nothing = NULL;
  size_t bytes = 0; /* the end */

  PetscFunctionBeginUser;
  PetscCall(LamShareBytes(((Spread *)*ctx)->comm, 0, &bytes, &nothing));
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSpreadCreate(MPI_Comm comm, LamResponder solver, LamResponder *responder)
{
  const LamResponderFunctions functions = {.respond = Respond, .destroy = Destroy};
  Spread *spread;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&spread));
  *spread = (Spread){comm, solver};
  PetscCall(LamResponderCreate(&functions, spread, NULL, responder));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSpreadServe(MPI_Comm comm, LamResponder solver)
{
  const Spread spread = {comm, solver};

  PetscFunctionBeginUser;
  for (;;) {
    LamResponse *responses;
    LamLoad *loads;
    size_t bytes;
    PetscInt n;

    PetscCall(LamShareBytes(comm, 0, &bytes, &loads));
    n = (PetscInt)(bytes / sizeof(*loads));
    PetscCall(PetscMalloc1(n, &responses));
    if (n) PetscCall(Answer(&spread, n, loads, responses));
    PetscCall(PetscFree(responses));
    PetscCall(PetscFree(loads));
    if (!n) break;
  }
  PetscFunctionReturn(0);
}
