/*
  Certified reactions of an FE2 run whose responses are interpolated: material points are solved directly at the
  deformation that they have reached (macro.h, LamMacroSetReference).

  All points keep their states, as in a direct run. A sample needs one state, which each of its points starts from the
  reference and, of cells that come apart, is led along the path of the run. Points of a uniformly inflated body have
  the same first state, which is solved once.
*/
#include "fe2_run.h"
#include <string.h>

/* The responder of one point at a time; owned but for rve. */
typedef struct {
  LamRVE rve;
  LamResponder direct; /* its point 0 has the state */
  void *start, *first; /* the reference state; that of first_load from there */
  LamLoad first_load;
  PetscBool begins, knows_first; /* the state is the reference; `first` is known */
} Single;

/* Whether the states of two loads differ by less than the next solve makes up for. */
static PetscBool IsClose(const LamLoad *a, const LamLoad *b)
{
  const PetscReal close = 1e-8; /* equal but for the rounding of the body's Newton iterations */
  PetscReal difference = PetscMax(PetscAbsReal(a->turgor - b->turgor), PetscAbsReal(a->cohesion - b->cohesion));

  for (int k = 0; k < 9; k++) difference = PetscMax(difference, PetscAbsReal(a->F[k] - b->F[k]));
  return (PetscBool)(difference < close);
}

static PetscErrorCode Respond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                              LamResponse responses[])
{
  Single *single = (Single *)ctx;
  const PetscInt point = 0;

  PetscFunctionBeginUser;
  (void)points;
  PetscCall(LamRVESetWanted(single->rve, LAM_WANT_STRESS));
  for (PetscInt i = 0; i < n; i++) {
    if (single->begins && single->knows_first && IsClose(&loads[i], &single->first_load))
      PetscCall(LamResponderLoad(single->direct, point, single->first));
    PetscCall(LamResponderRespond(single->direct, 1, &loads[i], &point, &responses[i]));
    if (single->begins) single->first_load = loads[i];
  }
  PetscCall(LamRVESetWanted(single->rve, LAM_WANT_ALL));
  PetscFunctionReturn(0);
}

static PetscErrorCode Accept(void *ctx)
{
  Single *single = (Single *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamResponderAccept(single->direct));
  if (single->begins) PetscCall(LamResponderSave(single->direct, 0, single->first));
  if (single->begins) single->knows_first = PETSC_TRUE;
  single->begins = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Back to the reference. */
static PetscErrorCode Reject(void *ctx)
{
  Single *single = (Single *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamResponderLoad(single->direct, 0, single->start));
  single->begins = PETSC_TRUE;
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **ctx)
{
  Single *single = (Single *)*ctx;

  PetscFunctionBeginUser;
  PetscCall(LamResponderDestroy(&single->direct));
  PetscCall(PetscFree(single->start));
  PetscCall(PetscFree(single->first));
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

static PetscErrorCode SingleCreate(LamRVE rve, LamResponder *responder)
{
  const LamResponderFunctions functions = {.respond = Respond, .accept = Accept, .reject = Reject, .destroy = Destroy};
  Single *single;
  size_t size;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&single));
  single->rve = rve;
  single->begins = PETSC_TRUE;
  PetscCall(LamRVEResponderCreate(rve, 1, &single->direct));
  PetscCall(LamResponderGetStateSize(single->direct, &size));
  PetscCall(PetscMalloc(size, &single->start));
  PetscCall(PetscMalloc(size, &single->first));
  PetscCall(LamResponderSave(single->direct, 0, single->start));
  PetscCall(LamResponderCreate(&functions, single, NULL, responder));
  PetscFunctionReturn(0);
}

/* The responders of all tissues as one. */
static PetscErrorCode Join(LamFE2Run *run, LamResponder *responder)
{
  LamFE2Tissues *tissues = &run->tissues;
  LamHeterogeneousTissue *parts;

  PetscFunctionBeginUser;
  *responder = tissues->tissues[0].reference;
  if (tissues->plain) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(tissues->count, &parts));
  for (PetscInt t = 0; t < tissues->count; t++) {
    const LamFE2Tissue *tissue = &tissues->tissues[t];

    parts[t] = (LamHeterogeneousTissue){tissue->name, tissue->stress, LamFE2StressScale(tissue), tissue->reference};
  }
  PetscCall(LamHeterogeneousCreate(tissues->count, parts, tissues->points, tissues->point, &run->reference));
  *responder = run->reference;
  PetscCall(PetscFree(parts));
  PetscFunctionReturn(0);
}

/* Whether the response of a point depends on all increments that the run has gone, of which certificates know only
   complete steps. */
static PetscBool HasHistory(const LamFE2Run *run)
{
  PetscBool has = PETSC_FALSE;

  for (PetscInt t = 0; t < run->tissues.count; t++)
    has = (PetscBool)(has || LamFE2HoldsModels(run, &run->tissues.tissues[t]));
  return has;
}

PetscErrorCode LamFE2Certify(LamFE2Run *run)
{
  PetscBool contact = PETSC_FALSE;
  LamResponder responder;

  PetscFunctionBeginUser;
  if (HasHistory(run)) {
    PetscCheck(run->certify != LAM_CERTIFY_ALL, run->comm, PETSC_ERR_USER_INPUT,
               "%s: reactions of a lamella that breaks cannot be certified: they depend on every increment; leave "
               "--certify out, and compare with a smaller macro.response.accuracy or --response direct",
               run->scene_path);
    PetscCall(LamMacroRefuseCertificate(run->macro, "reactions of a lamella that breaks depend on every increment"));
    PetscFunctionReturn(0);
  }
  for (PetscInt t = 0; t < run->tissues.count; t++) {
    LamFE2Tissue *tissue = &run->tissues.tissues[t];

    if (LamCellsPart(tissue->scene.micro.interface)) contact = PETSC_TRUE;
    if (!tissue->rve) PetscCall(LamFE2CreateSolver(run, tissue));
    if (run->certify == LAM_CERTIFY_ALL)
      PetscCall(LamFE2CreateDirect(run, tissue, &tissue->reference));
    else
      PetscCall(SingleCreate(tissue->rve, &tissue->reference));
  }
  PetscCall(Join(run, &responder));
  PetscCall(LamMacroSetReference(run->macro, responder, run->certify, contact));
  PetscFunctionReturn(0);
}
