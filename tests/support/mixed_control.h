/* Figures of mixed control that the tests assert and the bench program prints: how well the prescribed stress is
   reached, and what it costs against the same state at the F that it has. */
#ifndef LAM_SUPPORT_MIXED_CONTROL_H
#define LAM_SUPPORT_MIXED_CONTROL_H

#include "contact_tissue.h"
#include "mixed.h"

#define FREE NAN /* in place of a component of F */
/* Row-major 2 x 2 and F33; P counts where F is FREE. MPa. */
typedef struct {
  const char *name;
  double turgor, cohesion;
  double F[4], F33;
  double P[4], P33;
  PetscBool contact;
  PetscBool far; /* swells so far in one go that it costs more than the others */
} MixedCase;

static const MixedCase mixed_cases[] = {
    {"dry, uniaxial stretch 1.1", 0, 0, {FREE, FREE, 0, 1.1}, 1, {0}, 0, PETSC_FALSE, PETSC_FALSE},
    {"dry, uniaxial stretch 1.2", 0, 0, {FREE, FREE, 0, 1.2}, 1, {0}, 0, PETSC_FALSE, PETSC_FALSE},
    {"dry, uniaxial, F33 free", 0, 0, {FREE, FREE, 0, 1.1}, FREE, {0}, 0, PETSC_FALSE, PETSC_FALSE},
    {"dry, pulled by 0.02 MPa", 0, 0, {FREE, FREE, 0, FREE}, 1, {0, 0, 0, 0.02}, 0, PETSC_FALSE, PETSC_FALSE},
    {"dry, shear 0.1", 0, 0, {FREE, 0.1, 0, FREE}, 1, {0}, 0, PETSC_FALSE, PETSC_FALSE},
    {"dry, shear 0.3", 0, 0, {FREE, 0.3, 0, FREE}, 1, {0}, 0, PETSC_FALSE, PETSC_FALSE},
    {"turgid, free swelling", 0.02, 0, {FREE, FREE, 0, FREE}, 1, {0}, 0, PETSC_FALSE, PETSC_FALSE},
    {"turgid, free in 3D", 0.02, 0, {FREE, FREE, 0, FREE}, FREE, {0}, 0, PETSC_FALSE, PETSC_FALSE},
    {"turgid, uniaxial stretch 1.1", 0.02, 0, {FREE, FREE, 0, 1.1}, 1, {0}, 0, PETSC_FALSE, PETSC_FALSE},
    {"turgid, uniaxial stretch 1.3", 0.02, 0, {FREE, FREE, 0, 1.3}, 1, {0}, 0, PETSC_FALSE, PETSC_FALSE},
    {"turgid, pulled by 0.05 MPa", 0.02, 0, {FREE, FREE, 0, FREE}, 1, {0, 0, 0, 0.05}, 0, PETSC_FALSE, PETSC_FALSE},
    {"turgid, shear 0.1", 0.02, 0, {FREE, 0.1, 0, FREE}, 1, {0}, 0, PETSC_FALSE, PETSC_FALSE},
    {"turgid, shear 0.3", 0.02, 0, {FREE, 0.3, 0, FREE}, 1, {0}, 0, PETSC_FALSE, PETSC_FALSE},
    {"turgid, sheared by 0.01 MPa", 0.02, 0, {FREE, FREE, 0, FREE}, 1, {0, 0.01, 0, 0}, 0, PETSC_FALSE, PETSC_FALSE},
    {"contact, pressed by turgor", 0.02, 0, {1, FREE, 0, FREE}, 1, {0, 0, 0, -0.015}, 0, PETSC_TRUE, PETSC_FALSE},
    {"contact, cohesion, swelling", 0.02, 0.02, {FREE, FREE, 0, FREE}, 1, {0}, 0, PETSC_TRUE, PETSC_FALSE},
    {"contact, cohesion, uniaxial 1.02", 0.02, 0.02, {FREE, FREE, 0, 1.02}, 1, {0}, 0, PETSC_TRUE, PETSC_FALSE},
    {"contact, cohesion, shear 0.1", 0.02, 0.02, {FREE, 0.1, 0, FREE}, 1, {0}, 0, PETSC_TRUE, PETSC_FALSE},
    {"contact, cohesion, F33 free", 0.005, 0.02, {FREE, 0.1, 0, FREE}, FREE, {0}, 0, PETSC_TRUE, PETSC_FALSE},
    {"contact, turgid, F33 free", 0.02, 0.02, {FREE, 0.1, 0, FREE}, FREE, {0}, 0, PETSC_TRUE, PETSC_TRUE},
};

#define MIXED_CASES ((int)(sizeof(mixed_cases) / sizeof(mixed_cases[0])))
/* With the components of F that `before` has for first guesses. */
void MixedLoad(const MixedCase *c, const double before[9], LamLoad *load, LamStressControl *control);

typedef struct {
  LamResponse mixed, plain; /* from the same start; plain: F prescribed as mixed has it */
  double stress;            /* largest difference of P from what is prescribed, in C1 + C2 */
  double apart;             /* largest difference of P between the two, in C1 + C2 */
  int extra;                /* factorisations that mixed takes more */
} MixedResult;

/* From the undeformed tissue. */
PetscErrorCode SolveMixedCase(const MixedCase *c, MixedResult *result);

#endif
