/*
  Responder that passes a batch on query by query until a stop is requested.
*/
#include "interruptible.h"

typedef struct {
  LamResponder *solver, *self; /* borrowed */
  PetscBool (*stop)(void);
} Interruptible;

static PetscErrorCode LeaveOut(const LamLoad *load, LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->status = LAM_OUT_OF_REACH;
  PetscCall(PetscStrncpy(response->reason, "stopped before it was solved", sizeof(response->reason)));
  PetscFunctionReturn(0);
}

static PetscErrorCode Respond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                              LamResponse responses[])
{
  Interruptible *i = (Interruptible *)ctx;
  const LamResponder before = *i->solver;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    if (i->stop())
      PetscCall(LeaveOut(&loads[k], &responses[k]));
    else
      PetscCall(i->solver->respond(i->solver->ctx, 1, &loads[k], &points[k], &responses[k]));
    if (!LamResponseHasFields(&responses[k])) i->self->failures++;
  }
  i->self->queries += n;
  i->self->solves += i->solver->solves - before.solves;
  i->self->solve_seconds += i->solver->solve_seconds - before.solve_seconds;
  PetscFunctionReturn(0);
}

static PetscErrorCode Accept(void *ctx)
{
  Interruptible *i = (Interruptible *)ctx;

  PetscFunctionBeginUser;
  PetscCall(i->solver->accept(i->solver->ctx));
  PetscFunctionReturn(0);
}

static PetscErrorCode Reject(void *ctx)
{
  Interruptible *i = (Interruptible *)ctx;

  PetscFunctionBeginUser;
  PetscCall(i->solver->reject(i->solver->ctx));
  PetscFunctionReturn(0);
}

static PetscErrorCode Seal(void *ctx, PetscReal bulk_modulus)
{
  Interruptible *i = (Interruptible *)ctx;

  PetscFunctionBeginUser;
  PetscCall(i->solver->seal(i->solver->ctx, bulk_modulus));
  PetscFunctionReturn(0);
}

static PetscErrorCode StateSize(void *ctx, size_t *bytes)
{
  Interruptible *i = (Interruptible *)ctx;

  PetscFunctionBeginUser;
  PetscCall(i->solver->state_size(i->solver->ctx, bytes));
  PetscFunctionReturn(0);
}

static PetscErrorCode Save(void *ctx, PetscInt point, void *bytes)
{
  Interruptible *i = (Interruptible *)ctx;

  PetscFunctionBeginUser;
  PetscCall(i->solver->save(i->solver->ctx, point, bytes));
  PetscFunctionReturn(0);
}

static PetscErrorCode Load(void *ctx, PetscInt point, const void *bytes)
{
  Interruptible *i = (Interruptible *)ctx;

  PetscFunctionBeginUser;
  PetscCall(i->solver->load(i->solver->ctx, point, bytes));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **ctx)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamInterruptibleResponderCreate(LamResponder *solver, PetscBool (*stop)(void), LamResponder *responder)
{
  Interruptible *i;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&i));
  i->solver = solver;
  i->self = responder;
  i->stop = stop;
  *responder = (LamResponder){.ctx = i, .respond = Respond, .accept = Accept, .reject = Reject, .destroy = Destroy};
  if (solver->seal) responder->seal = Seal;
  if (!solver->state_size) PetscFunctionReturn(0);
  responder->state_size = StateSize;
  responder->save = Save;
  responder->load = Load;
  PetscFunctionReturn(0);
}
