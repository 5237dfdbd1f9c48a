#include "rounding.h"

/* Measured with bench_digits: the largest errors of the tangent over eps kappa/C1 size / depth are at most 85, kappa/C1
   from 1e2 to 1e7, t from 0.005 to 0.95 apothems, meshes from 6 x 2 to 40 x 40 elements, up to 8 x 8 cells. */
#define ROUNDING 100.0
#define FEW_ELEMENTS 6.0 /* along a face: with fewer the elements are slender, and more digits are lost */

/* Largest (kappa / C1) / t of the cells; worst: the cell. */
static PetscReal Slenderness(const LamMicrostructure *micro, PetscInt *worst)
{
  const PetscInt cells = micro->cell ? micro->cells[0] * micro->cells[1] : 1;
  PetscReal largest = 0.0;

  *worst = 0;
  for (PetscInt c = 0; c < cells; c++) {
    const LamWall *wall = micro->cell ? &micro->cell[c].wall : &micro->wall;
    const PetscReal slenderness = wall->bulk_modulus / (wall->C1 + wall->C2) / LamWallThickness(micro, c);

    if (slenderness > largest) *worst = c;
    largest = PetscMax(largest, slenderness);
  }
  return largest;
}

PetscReal LamTangentRounding(const LamMicrostructure *micro)
{
  const PetscReal side =
      micro->tissue ? PetscSqrtReal((PetscReal)micro->cells[0]) : (PetscReal)PetscMax(micro->cells[0], micro->cells[1]);
  const PetscReal size = 1.0 + PetscSqrtReal(3.0) * (side - 1.0);
  const PetscReal coarse = PetscMax(1.0, PetscSqr(FEW_ELEMENTS / (PetscReal)micro->along));
  PetscInt worst;

  return ROUNDING * PETSC_MACHINE_EPSILON * coarse * size * (PetscReal)micro->through * Slenderness(micro, &worst);
}

PetscErrorCode LamDigitsWarning(const LamMicrostructure *micro, PetscReal accuracy, char text[], size_t length)
{
  const PetscReal rounding = LamTangentRounding(micro);
  const LamWall *wall;
  PetscReal ratio;
  PetscInt worst, digits;

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (!(rounding > accuracy)) PetscFunctionReturn(0);
  (void)Slenderness(micro, &worst);
  wall = micro->cell ? &micro->cell[worst].wall : &micro->wall;
  ratio = wall->bulk_modulus / (wall->C1 + wall->C2);
  digits = rounding < 1.0 ? (PetscInt)PetscFloorReal(-PetscLog10Real(rounding)) : 0;
  PetscCall(PetscSNPrintf(text, length,
                          "a bulk modulus of %.2g (C1 + C2) in walls of %.2g apothems leaves about %d digit%s of the "
                          "tangent, fewer than an accuracy of %.2g %% needs: take a bulk modulus below %.1g (C1 + C2)",
                          (double)ratio, (double)LamWallThickness(micro, worst), (int)digits, digits == 1 ? "" : "s",
                          (double)(100 * accuracy), (double)(ratio * accuracy / rounding)));
  PetscFunctionReturn(0);
}

PetscErrorCode LamWarnOfDigits(MPI_Comm comm, const LamReporter *reporter, const LamMicrostructure *micro,
                               PetscReal accuracy)
{
  char text[256];

  PetscFunctionBeginUser;
  PetscCall(LamDigitsWarning(micro, accuracy, text, sizeof(text)));
  if (text[0] && LamIsFirst(comm)) LamReportWarning(reporter, "%s", text);
  PetscFunctionReturn(0);
}
