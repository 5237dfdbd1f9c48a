/* Sealed tissue for tests: inflated at F = I with a turgor that is prescribed, then sealed. */
#ifndef LAM_SUPPORT_SEALED_CELLS_H
#define LAM_SUPPORT_SEALED_CELLS_H

#include "uneven_cells.h"
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
PetscErrorCode SealedCreate(const LamMicrostructure *micro, const LamLoad *load, double bulk_modulus, SealedTissue *s);
/* From the sealed start in one go; the solution is in s->state. */
PetscErrorCode SealedSolve(SealedTissue *s, const LamLoad *load, LamResponse *response);
PetscErrorCode SealedDestroy(SealedTissue *s);

/* ---- states ---- */

#define SEALED_STATES 8
typedef struct {
  const char *name;
  LamMicrostructure micro;
  LamLoad load;
  double bulk_modulus, step; /* step: of differences */
} SealedState;

/* Bonded and contact, one cell and many, alike or not; stiff water where the volume hardly changes. Borrows `cells`. */
void ListSealedStates(LamCell cells[SEALED_CELLS], SealedState list[SEALED_STATES]);

typedef struct {
  ContactSweep sweep;
  double law_error;
} SealedFigures;

PetscErrorCode SweepSealed(const SealedState *point, SealedFigures *figures);

#endif
