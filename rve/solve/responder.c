/*
  The direct responder: one RVE solve per query, warm-started from the last state of the material point.

  Each point has two states: the accepted one of the last load step, and the latest solution, which is nearer to the
  next query. A query starts from the latest one, unless that has left the accepted branch (by buckling): an iterate of
  the macroscale Newton must not select the branch; nor may it leave damage: with a lamella every query starts from the
  accepted state, as with walls that have a memory, whose step counts from there. A query without a point, or of one
  without stored states, starts from the reference state. After sealing, each point keeps the water of its accepted
  state.

  Jumps of a lamella. A body may be in equilibrium neither before one of its points jumps nor after, because the jump
  unloads the point and the body then takes it back across: iterates then go to and fro. So a point that has jumped in a
  load step stays behind the jump for queries nearby, which start from the latest solution with its history.

  A uniformly inflated body queries the same load at all its points. A query with the same load and initial state as the
  last one, bit for bit, therefore returns the last response.
*/
#include "solve.h"
#include <string.h>

static const PetscReal NEARBY =
    1e-3; /* change of F, Frobenius norm; chosen: what iterates that converge still move by */

typedef struct {
  LamRVE rve; /* borrowed */
  LamResponderCounters counters;
  PetscInt points;                /* number of points with stored states */
  LamRVEState *accepted, *latest; /* [points] */
  PetscBool *jumped;              /* [points] with a lamella: `latest` is behind a jump of this load step */
  PetscReal *water;               /* [points][cell] V_w over V0; NULL: turgor is prescribed */
  PetscReal bulk_modulus;         /* of the water */
  LamRVEState scratch;
  size_t size;         /* of a packed state, bytes */
  char *start, *first; /* [size] packed initial states of this query and of the last one solved */
  LamRVEState end;     /* solution of the last query solved */
  LamResponse last;    /* response of the last query solved; without fields: none to repeat */
  PetscInt changes;    /* rve->changes at that solve */
} DirectResponder;

static PetscBool SameLoad(const LamLoad *a, const LamLoad *b)
{
  for (int k = 0; k < 9; ++k) {
    if (a->F[k] != b->F[k]) return PETSC_FALSE;
  }
  return (PetscBool)(a->turgor == b->turgor && a->cohesion == b->cohesion && a->duration == b->duration);
}

/* Solves with the RVE, which is borrowed and therefore sealed only during the solve. */
static PetscErrorCode SolvePoint(DirectResponder *direct, PetscInt point, const LamLoad *load, LamRVEState state,
                                 LamResponse *response)
{
  const PetscInt cells = direct->rve->mesh.cell_count;

  PetscFunctionBeginUser;
  if (direct->water) {
    PetscCheck(point >= 0 && point < direct->points, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "a sealed response needs a material point whose states are kept");
    PetscCall(LamRVESeal(direct->rve, direct->bulk_modulus, &direct->water[point * cells]));
  }
  PetscCall(LamRVESolve(direct->rve, load, state, response));
  if (direct->water) PetscCall(LamRVEUnseal(direct->rve));
  PetscFunctionReturn(0);
}

/* Solves, or returns the last response for an identical query; updates the counters. */
static PetscErrorCode RespondAt(DirectResponder *direct, PetscInt point, const LamLoad *load, LamRVEState state,
                                LamResponse *response)
{
  const LamRVE rve = direct->rve;

  PetscFunctionBeginUser;
  ++direct->counters.queries;
  PetscCall(LamRVEStatePack(state, direct->start));
  if (!direct->water && direct->changes == rve->changes && LamResponseHasFields(&direct->last) &&
      SameLoad(load, &direct->last.load) && !memcmp(direct->start, direct->first, direct->size)) {
    PetscCall(LamRVEStateCopy(direct->end, state));
    *response = direct->last;
    response->seconds = 0;
    PetscFunctionReturn(0);
  }
  PetscCall(SolvePoint(direct, point, load, state, response));
  if (response->status != LAM_OUT_OF_REACH) ++direct->counters.solves;
  if (!LamResponseHasFields(response)) ++direct->counters.failures;
  direct->counters.solve_seconds += response->seconds;
  PetscCall(LamRVEStateCopy(state, direct->end));
  PetscCall(PetscMemcpy(direct->first, direct->start, direct->size));
  direct->last = *response;
  direct->changes = rve->changes;
  PetscFunctionReturn(0);
}

static PetscBool IsNearby(const LamLoad *a, const LamLoad *b)
{
  PetscReal square = 0.0;

  for (int k = 0; k < 9; ++k) square += PetscSqr(a->F[k] - b->F[k]);
  return (PetscBool)(square <= PetscSqr(NEARBY) && a->turgor == b->turgor && a->cohesion == b->cohesion);
}

/* Whether a query starts from the accepted state of a point that has stored states. */
static PetscBool StartsAccepted(const DirectResponder *direct, PetscInt point, const LamLoad *load)
{
  const LamRVEState latest = direct->latest[point];

  if (direct->rve->memory) return PETSC_TRUE;
  if (direct->rve->layer) return (PetscBool)(!direct->jumped[point] || !IsNearby(load, &latest->load));
  return (PetscBool)(latest->branch != direct->accepted[point]->branch);
}

static PetscErrorCode Respond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                              LamResponse responses[])
{
  DirectResponder *direct = (DirectResponder *)ctx;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscInt point = points ? points[i] : -1;
    LamRVEState state = direct->scratch;

    if (point >= 0 && point < direct->points) {
      state = direct->latest[point];
      if (StartsAccepted(direct, point, &loads[i])) {
        PetscCall(LamRVEStateCopy(direct->accepted[point], state));
        direct->jumped[point] = PETSC_FALSE;
      }
    } else {
      PetscCall(LamRVEStateReset(direct->rve, state));
    }
    PetscCall(RespondAt(direct, point, &loads[i], state, &responses[i]));
    if (state != direct->scratch && responses[i].jumped) direct->jumped[point] = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* Ends a load step. */
static PetscErrorCode CopyStates(DirectResponder *direct, LamRVEState from[], LamRVEState to[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < direct->points; ++i) PetscCall(LamRVEStateCopy(from[i], to[i]));
  PetscCall(PetscArrayzero(direct->jumped, direct->points));
  PetscFunctionReturn(0);
}

static PetscErrorCode Accept(void *ctx)
{
  DirectResponder *direct = (DirectResponder *)ctx;

  return CopyStates(direct, direct->latest, direct->accepted);
}

static PetscErrorCode Reject(void *ctx)
{
  DirectResponder *direct = (DirectResponder *)ctx;

  return CopyStates(direct, direct->accepted, direct->latest);
}

static PetscErrorCode Seal(void *ctx, PetscReal bulk_modulus)
{
  DirectResponder *direct = (DirectResponder *)ctx;
  const PetscInt cells = direct->rve->mesh.cell_count;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < direct->points; ++i)
    PetscCheck(direct->accepted[i]->solved, PETSC_COMM_SELF, PETSC_ERR_ORDER,
               "material point %d has no accepted response whose water it could keep", (int)i);
  PetscCall(PetscMalloc1(direct->points * cells, &direct->water));
  for (PetscInt i = 0; i < direct->points; ++i)
    PetscCall(LamRVEGetLumens(direct->rve, direct->accepted[i], &direct->water[i * cells]));
  direct->bulk_modulus = bulk_modulus;
  PetscFunctionReturn(0);
}

/* Layout: packed state, then, if the cells can be sealed, K_w (0: not sealed) and [cell] water. */
static PetscErrorCode StateSize(void *ctx, size_t *bytes)
{
  DirectResponder *direct = (DirectResponder *)ctx;

  PetscFunctionBeginUser;
  *bytes = direct->size;
  if (direct->rve->seal.allowed) *bytes += (size_t)(1 + direct->rve->mesh.cell_count) * sizeof(PetscReal);
  PetscFunctionReturn(0);
}

static PetscErrorCode Save(void *ctx, PetscInt point, void *bytes)
{
  DirectResponder *direct = (DirectResponder *)ctx;
  const size_t cells = (size_t)direct->rve->mesh.cell_count;
  char *seal = (char *)bytes + direct->size;

  PetscFunctionBeginUser;
  if (point >= direct->points) PetscCall(LamRVEStateReset(direct->rve, direct->scratch));
  PetscCall(LamRVEStatePack(point < direct->points ? direct->accepted[point] : direct->scratch, bytes));
  if (!direct->rve->seal.allowed) PetscFunctionReturn(0);
  memset(seal, 0, (1 + cells) * sizeof(PetscReal));
  if (!direct->water || point >= direct->points) PetscFunctionReturn(0);
  memcpy(seal, &direct->bulk_modulus, sizeof(PetscReal));
  memcpy(seal + sizeof(PetscReal), &direct->water[(size_t)point * cells], cells * sizeof(PetscReal));
  PetscFunctionReturn(0);
}

static PetscErrorCode Load(void *ctx, PetscInt point, const void *bytes)
{
  DirectResponder *direct = (DirectResponder *)ctx;
  const size_t cells = (size_t)direct->rve->mesh.cell_count;
  const char *seal = (const char *)bytes + direct->size;

  PetscFunctionBeginUser;
  if (point >= direct->points) PetscFunctionReturn(0);
  PetscCall(LamRVEStateUnpack(bytes, direct->accepted[point]));
  PetscCall(LamRVEStateUnpack(bytes, direct->latest[point]));
  if (!direct->rve->seal.allowed) PetscFunctionReturn(0);
  memcpy(&direct->bulk_modulus, seal, sizeof(PetscReal));
  if (direct->bulk_modulus == 0.0) PetscFunctionReturn(0);
  if (!direct->water) PetscCall(PetscMalloc1((size_t)direct->points * cells, &direct->water));
  memcpy(&direct->water[(size_t)point * cells], seal + sizeof(PetscReal), cells * sizeof(PetscReal));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **ctx)
{
  DirectResponder *direct = (DirectResponder *)*ctx;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < direct->points; ++i) {
    PetscCall(LamRVEStateDestroy(&direct->accepted[i]));
    PetscCall(LamRVEStateDestroy(&direct->latest[i]));
  }
  PetscCall(LamRVEStateDestroy(&direct->scratch));
  PetscCall(LamRVEStateDestroy(&direct->end));
  PetscCall(PetscFree2(direct->start, direct->first));
  PetscCall(PetscFree3(direct->accepted, direct->latest, direct->jumped));
  PetscCall(PetscFree(direct->water));
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEResponderCreate(LamRVE rve, PetscInt points, LamResponder *responder)
{
  LamResponderFunctions functions = {.respond = Respond,
                                     .accept = Accept,
                                     .reject = Reject,
                                     .destroy = Destroy,
                                     .state_size = StateSize,
                                     .save = Save,
                                     .load = Load};
  DirectResponder *direct;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&direct));
  direct->rve = rve;
  direct->points = points;
  PetscCall(PetscCalloc3(points, &direct->accepted, points, &direct->latest, points, &direct->jumped));
  for (PetscInt i = 0; i < points; ++i) {
    PetscCall(LamRVEStateCreate(rve, &direct->accepted[i]));
    PetscCall(LamRVEStateCreate(rve, &direct->latest[i]));
  }
  PetscCall(LamRVEStateCreate(rve, &direct->scratch));
  PetscCall(LamRVEStateCreate(rve, &direct->end));
  PetscCall(LamRVEStateSize(direct->scratch, &direct->size));
  PetscCall(PetscMalloc2(direct->size, &direct->start, direct->size, &direct->first));
  direct->last.status = LAM_OUT_OF_REACH;
  if (rve->seal.allowed) functions.seal = Seal;
  PetscCall(LamResponderCreate(&functions, direct, &direct->counters, responder));
  PetscFunctionReturn(0);
}
