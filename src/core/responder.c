#include <lamella/response.h>

struct LamResponder_s {
  LamResponderFunctions call;
  void *ctx;                            /* owned if there is a `destroy` */
  const LamResponderCounters *counters; /* borrowed; NULL: none are kept */
};

PetscErrorCode LamResponderCreate(const LamResponderFunctions *functions, void *ctx,
                                  const LamResponderCounters *counters, LamResponder *responder)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(responder));
  **responder = (struct LamResponder_s){*functions, ctx, counters};
  PetscFunctionReturn(0);
}

PetscErrorCode LamResponderDestroy(LamResponder *responder)
{
  LamResponder r = *responder;

  PetscFunctionBeginUser;
  if (r && r->call.destroy) PetscCall(r->call.destroy(&r->ctx));
  PetscCall(PetscFree(*responder));
  PetscFunctionReturn(0);
}

LamResponderCounters LamResponderGetCounters(LamResponder r)
{
  return r->counters ? *r->counters : (LamResponderCounters){0};
}

PetscErrorCode LamResponderRespond(LamResponder r, PetscInt n, const LamLoad *loads, const PetscInt *points,
                                   LamResponse *responses)
{
  PetscFunctionBeginUser;
  PetscCall(r->call.respond(r->ctx, n, loads, points, responses));
  PetscFunctionReturn(0);
}

PetscErrorCode LamResponderAccept(LamResponder r)
{
  PetscFunctionBeginUser;
  if (r->call.accept) PetscCall(r->call.accept(r->ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamResponderReject(LamResponder r)
{
  PetscFunctionBeginUser;
  if (r->call.reject) PetscCall(r->call.reject(r->ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamResponderSeal(LamResponder r, PetscReal bulk_modulus)
{
  PetscFunctionBeginUser;
  PetscCheck(r->call.seal, PETSC_COMM_SELF, PETSC_ERR_SUP, "the cells of this responder cannot be sealed");
  PetscCall(r->call.seal(r->ctx, bulk_modulus));
  PetscFunctionReturn(0);
}

PetscErrorCode LamResponderGetStateSize(LamResponder r, size_t *bytes)
{
  PetscFunctionBeginUser;
  *bytes = 0;
  if (r->call.state_size) PetscCall(r->call.state_size(r->ctx, bytes));
  PetscFunctionReturn(0);
}

PetscErrorCode LamResponderSave(LamResponder r, PetscInt point, void *bytes)
{
  PetscFunctionBeginUser;
  if (r->call.save) PetscCall(r->call.save(r->ctx, point, bytes));
  PetscFunctionReturn(0);
}

PetscErrorCode LamResponderLoad(LamResponder r, PetscInt point, const void *bytes)
{
  PetscFunctionBeginUser;
  if (r->call.load) PetscCall(r->call.load(r->ctx, point, bytes));
  PetscFunctionReturn(0);
}
