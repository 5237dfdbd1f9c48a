/* Sealed tissue for tests: inflated at F = I with a turgor that is prescribed, then sealed. */
#ifndef LAM_FIGURES_SEALED_H
#define LAM_FIGURES_SEALED_H

#include "figures_uneven.h"
#include "random_reals.h"

#define SEALED_CELLS 4                        /* at most */
#define SEALED_WATER (2200.0 / TISSUE_STRESS) /* bulk modulus of water, C1 + C2 */

typedef struct {
  LamRVE rve;
  LamRVEState start, state; /* as it was sealed; work space */
  LamResponse response;     /* of the start */
  double water[SEALED_CELLS], bulk_modulus;
} SealedTissue;

/* Sealed at F = I with the turgor and cohesion of the load. */
static inline PetscErrorCode SealedCreate(const LamMicrostructure *micro, const LamLoad *load, double bulk_modulus,
                                          SealedTissue *s)
{
  LamLoad start = *load;

  PetscFunctionBeginUser;
  s->bulk_modulus = bulk_modulus;
  for (int i = 0; i < 9; i++) start.F[i] = i % 4 == 0;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &s->rve));
  PetscCall(LamRVESetMicrostructure(s->rve, micro));
  PetscCall(LamRVESetSealable(s->rve, PETSC_TRUE));
  PetscCall(LamRVESetUp(s->rve));
  PetscCall(LamRVEStateCreate(s->rve, &s->start));
  PetscCall(LamRVEStateCreate(s->rve, &s->state));
  PetscCall(LamRVESolve(s->rve, &start, s->start, &s->response));
  PetscCall(LamRVEGetLumens(s->rve, s->start, s->water));
  PetscCall(LamRVESeal(s->rve, bulk_modulus, s->water));
  PetscFunctionReturn(0);
}

/* From the sealed start in one go; the solution is in s->state. */
static inline PetscErrorCode SealedSolve(SealedTissue *s, const LamLoad *load, LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCopy(s->start, s->state));
  PetscCall(LamRVESolve(s->rve, load, s->state, response));
  PetscFunctionReturn(0);
}

static inline PetscErrorCode SealedDestroy(SealedTissue *s)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateDestroy(&s->start));
  PetscCall(LamRVEStateDestroy(&s->state));
  PetscCall(LamRVEDestroy(&s->rve));
  PetscFunctionReturn(0);
}

#endif
