/*
  The direct responder: one RVE solve per question, warm-started from the material point's last state.

  Each point keeps two states: the accepted one of the last load step, and the latest solution, which is nearer to the
  next question. A question starts from the latest one, unless that has left the accepted branch (buckled on the way):
  an iterate of the macroscale Newton must not decide which branch the tissue is on. A question without a point starts
  from the reference.
*/
#include "rve_impl.h"

typedef struct {
  LamRVE rve;              /* borrowed */
  LamResponder *responder; /* borrowed: its counters */
  PetscInt points;
  LamRVEState *accepted, *latest; /* [points] */
  LamRVEState scratch;
} DirectResponder;

static PetscErrorCode Respond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                              LamResponse responses[])
{
  DirectResponder *direct = (DirectResponder *)ctx;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; ++i) {
    const PetscInt point = points ? points[i] : -1;
    LamRVEState state = direct->scratch;

    PetscCheck(point < direct->points, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "material point %d of %d", (int)point,
               (int)direct->points);
    if (point >= 0) {
      state = direct->latest[point];
      if (state->branch != direct->accepted[point]->branch) PetscCall(LamRVEStateCopy(direct->accepted[point], state));
    } else {
      PetscCall(LamRVEStateReset(direct->rve, state));
    }
    PetscCall(LamRVESolve(direct->rve, &loads[i], state, &responses[i]));
    ++direct->responder->queries;
    if (responses[i].status != LAM_OUT_OF_REACH) ++direct->responder->solves;
    if (!LamResponseHasFields(&responses[i])) ++direct->responder->failures;
    direct->responder->solve_seconds += responses[i].seconds;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Accept(void *ctx)
{
  DirectResponder *direct = (DirectResponder *)ctx;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < direct->points; ++i) PetscCall(LamRVEStateCopy(direct->latest[i], direct->accepted[i]));
  PetscFunctionReturn(0);
}

static PetscErrorCode Reject(void *ctx)
{
  DirectResponder *direct = (DirectResponder *)ctx;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < direct->points; ++i) PetscCall(LamRVEStateCopy(direct->accepted[i], direct->latest[i]));
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
  PetscCall(PetscFree2(direct->accepted, direct->latest));
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEResponderCreate(LamRVE rve, PetscInt points, LamResponder *responder)
{
  DirectResponder *direct;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&direct));
  direct->rve = rve;
  direct->responder = responder;
  direct->points = points;
  PetscCall(PetscMalloc2(points, &direct->accepted, points, &direct->latest));
  for (PetscInt i = 0; i < points; ++i) {
    PetscCall(LamRVEStateCreate(rve, &direct->accepted[i]));
    PetscCall(LamRVEStateCreate(rve, &direct->latest[i]));
  }
  PetscCall(LamRVEStateCreate(rve, &direct->scratch));
  PetscCall(PetscMemzero(responder, sizeof(*responder)));
  responder->ctx = direct;
  responder->respond = Respond;
  responder->accept = Accept;
  responder->reject = Reject;
  responder->destroy = Destroy;
  PetscFunctionReturn(0);
}
