#include "crack.h"
#include <lamella/rve.h>
#include <math.h>

#define CELL_AREA (2 * sqrt(3.0)) /* apothem^2 */

void LamCrackAdd(LamCrack *crack, const LamMicrostructure *micro, PetscInt number, const LamResponse *response)
{
  const PetscBool grows = (PetscBool)(response->crack_length > (crack->begins ? crack->length[1] : 0));
  const PetscReal area = CELL_AREA * (PetscReal)(micro->cells[0] * micro->cells[1]);

  if (response->status != LAM_CONVERGED || !grows) return;
  if (!crack->begins) crack->begins = number;
  crack->last = number;
  crack->faces = response->crack_faces;
  for (int k = crack->begins == number ? 0 : 1; k < 2; k++) {
    crack->length[k] = response->crack_length;
    crack->dissipated[k] = response->dissipated * area;
    crack->F22[k] = response->load.F[4];
    crack->P22[k] = response->P[4];
  }
}

/* E' = 1/s_22 of the tissue without notch and grips, one cell of it. */
static PetscErrorCode FindModulus(const LamMicrostructure *micro, const LamLoad *load, PetscReal *modulus)
{
  LamMicrostructure cell = *micro;
  LamResponse response;
  LamRVEState state;
  LamRVE rve;

  PetscFunctionBeginUser;
  *modulus = NAN;
  if (micro->cell) PetscFunctionReturn(0);
  cell.is_patch = PETSC_FALSE;
  cell.cells[0] = cell.cells[1] = 1;
  cell.notch_row = cell.notch_columns = 0;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &rve));
  PetscCall(LamRVESetMicrostructure(rve, &cell));
  PetscCall(LamRVESetUp(rve));
  PetscCall(LamRVESetWanted(rve, LAM_WANT_DERIVATIVES));
  PetscCall(LamRVEStateCreate(rve, &state));
  PetscCall(LamRVESolve(rve, load, state, &response));
  if (LamResponseHasFields(&response)) {
    const PetscReal *A = response.tangent;

    *modulus = A[9 * 4 + 4] - A[9 * 0 + 4] * A[9 * 4 + 0] / A[0];
  }
  PetscCall(LamRVEStateDestroy(&state));
  PetscCall(LamRVEDestroy(&rve));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCrackConclude(LamCrack *crack, const LamMicrostructure *micro, const LamLoad *first)
{
  const PetscReal grown = crack->length[1] - crack->length[0];

  PetscFunctionBeginUser;
  if (!(grown > 0)) PetscFunctionReturn(0);
  crack->resistance = (crack->dissipated[1] - crack->dissipated[0]) / grown;
  PetscCall(FindModulus(micro, first, &crack->modulus));
  crack->toughness = sqrt(crack->modulus * crack->resistance);
  PetscFunctionReturn(0);
}
