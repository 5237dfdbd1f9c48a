/* Tissue of law `lamella` and programs of loads, for tests of its history, energies and tangent. */
#ifndef LAM_SUPPORT_LAMELLA_TISSUE_H
#define LAM_SUPPORT_LAMELLA_TISSUE_H

#include "tissue.h"

/* The default tissue on 4 x 1 elements with a lamella of strength 0.2 (C1 + C2), which opens by `range` apothems until
   it is broken, alike in tension and shear, of stiffness 1000 (C1 + C2)/a. */
LamMicrostructure LamellaTissue(double range);

/* A state with its RVE. */
typedef struct {
  LamRVE rve;
  LamRVEState state;
  LamResponse response;
} Specimen;
PetscErrorCode SpecimenCreate(const LamMicrostructure *micro, Specimen *specimen);
PetscErrorCode SpecimenDestroy(Specimen *specimen);
/* Follows a straight path of F in `steps` from the present state to `to`; an error where a state is not found. Adds the
   work of P, by the trapezoidal rule, to *work. */
PetscErrorCode SpecimenFollow(Specimen *specimen, const LamLoad *to, int steps, double *work);

#endif
