#include "sealed_cells.h"
#include "tissue.h"

PetscErrorCode SealedCreate(const LamMicrostructure *micro, const LamLoad *load, double bulk_modulus, SealedTissue *s)
{
  LamLoad start = *load;

  PetscFunctionBeginUser;
  s->bulk_modulus = bulk_modulus;
  for (int i = 0; i < 9; i++) start.F[i] = i % 4 == 0;
  PetscCall(NewSealableTissue(micro, PETSC_TRUE, &s->rve, &s->state));
  PetscCall(LamRVEStateCreate(s->rve, &s->start));
  PetscCall(LamRVESolve(s->rve, &start, s->start, &s->response));
  PetscCall(LamRVEGetLumens(s->rve, s->start, s->water));
  PetscCall(LamRVESeal(s->rve, bulk_modulus, s->water));
  PetscFunctionReturn(0);
}

PetscErrorCode SealedSolve(SealedTissue *s, const LamLoad *load, LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCopy(s->start, s->state));
  PetscCall(LamRVESolve(s->rve, load, s->state, response));
  PetscFunctionReturn(0);
}

/* The largest difference between a lumen of s->state over its water and what its pressure says. */
static PetscErrorCode SealedLawError(SealedTissue *s, const LamLoad *load, double *error)
{
  double lumen[SEALED_CELLS];

  PetscFunctionBeginUser;
  *error = 0.0;
  PetscCall(LamRVEGetLumens(s->rve, s->state, lumen));
  for (PetscInt c = 0; c < s->rve->mesh.cell_count; c++) {
    const double over = s->state->y[s->rve->ndof + c] - load->turgor * LamTurgorFactor(s->rve, c);

    *error = PetscMax(*error, PetscAbsReal(lumen[c] / s->water[c] - (1.0 - over / s->bulk_modulus)));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SealedDestroy(SealedTissue *s)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateDestroy(&s->start));
  PetscCall(DestroyTissue(&s->rve, &s->state));
  PetscFunctionReturn(0);
}

void ListSealedStates(LamCell cells[SEALED_CELLS], SealedState list[SEALED_STATES])
{
  static const char *const names[SEALED_STATES] = {
      "bonded, shear",        "bonded, stretch, F33 not 1", "bonded, soft water", "contact, pressed",
      "contact, partly open", "contact, 2 x 1 cells",       "uneven, bonded",     "uneven patch, contact"};

  for (int k = 0; k < SEALED_STATES; k++)
    list[k] = (SealedState){.name = names[k],
                            .micro = k < 3 ? DefaultTissue() : ContactTissue(6, 2),
                            .bulk_modulus = k < 2 ? SEALED_WATER : 50.0,
                            .step = CONTACT_STEP};
  list[0].load = ContactLoad(1, 0.2, 0.05, 1.01, 0.02, 0);
  list[0].step = 2e-5;
  list[1].load = ContactLoad(1.08, -0.03, 0.04, 0.95, 0.03, 0);
  list[1].load.F[8] = 0.975;
  list[1].micro.orientation = 0.4;
  list[1].step = 2e-5;
  list[2].load = ContactLoad(1.05, 0.1, 0, 1.02, 0.03, 0);
  list[3].load = ContactLoad(0.99, 0.15, 0, 1, 0.03, 0.0002);
  list[4].load = ContactLoad(1.04, 0.05, 0, 1.01, 0.01, 0.005);
  list[4].step = CONTACT_STEP_LARGE_RVE;
  list[5].load = ContactLoad(1.01, -0.08, 0.05, 0.98, 0.02, 0.001);
  list[5].micro.cells[0] = 2;
  list[6].micro = UnevenTissue(PETSC_FALSE, LAM_INTERFACE_BONDED, cells);
  list[6].load = UnevenLoad(&list[6].micro);
  list[7].micro = UnevenTissue(PETSC_TRUE, LAM_INTERFACE_CONTACT, cells);
  list[7].load = UnevenLoad(&list[7].micro);
  list[7].step = CONTACT_STEP_LARGE_RVE;
}

PetscErrorCode SweepSealed(const SealedState *point, SealedFigures *figures)
{
  ContactSweep *sweep = &figures->sweep;
  ContactCentre at;
  SealedTissue s;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(figures, sizeof(*figures)));
  PetscCall(SealedCreate(&point->micro, &point->load, point->bulk_modulus, &s));
  PetscCall(SealedSolve(&s, &point->load, &sweep->response));
  PetscCall(SealedLawError(&s, &point->load, &figures->law_error));
  PetscCall(LamRVEStateCopy(s.state, s.start));
  at = (ContactCentre){.rve = s.rve, .centre = s.start, .state = s.state};
  PetscCall(SweepColumns(&at, point->step, sweep));
  PetscCall(SealedDestroy(&s));
  PetscFunctionReturn(0);
}
