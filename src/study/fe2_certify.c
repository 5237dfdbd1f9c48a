/*
  Certified reactions of an FE2 run whose responses are interpolated: the material points are solved directly at the
  deformation that they have reached (macro.h, LamMacroSetReference).
*/
#include "fe2_run.h"

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

    parts[t] = (LamHeterogeneousTissue){tissue->name, tissue->stress, tissue->reference};
  }
  PetscCall(LamHeterogeneousCreate(tissues->count, parts, tissues->points, tissues->point, &run->reference));
  *responder = run->reference;
  PetscCall(PetscFree(parts));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2Certify(LamFE2Run *run)
{
  LamResponder responder;

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < run->tissues.count; t++) {
    LamFE2Tissue *tissue = &run->tissues.tissues[t];

    if (!tissue->rve) PetscCall(LamFE2CreateSolver(run, tissue));
    PetscCall(LamFE2CreateDirect(run, tissue, &tissue->reference));
  }
  PetscCall(Join(run, &responder));
  PetscCall(LamMacroSetReference(run->macro, responder));
  PetscFunctionReturn(0);
}
