/*
  Figures of mixed control that the tests assert and the bench program prints: how well the prescribed stress is
  reached, and what it costs against the same state at the F that it has.
*/
#ifndef LAM_FIGURES_MIXED_H
#define LAM_FIGURES_MIXED_H

#include "figures_contact_derivatives.h"
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
static inline void MixedLoad(const MixedCase *c, const double before[9], LamLoad *load, LamStressControl *control)
{
  *load = PlaneLoad(c->F[0], c->F[1], c->F[2], c->F[3], c->turgor / TISSUE_STRESS);
  load->cohesion = c->cohesion / TISSUE_STRESS;
  load->F[8] = c->F33;
  *control = (LamStressControl){.P = {c->P[0], c->P[1], 0, c->P[2], c->P[3], 0, 0, 0, c->P33}};
  for (int i = 0; i < 9; i++) {
    control->P[i] /= TISSUE_STRESS;
    control->given[i] = (PetscBool)isnan(load->F[i]);
  }
  *load = LamLoadAfter(load, control, before);
}

typedef struct {
  LamResponse mixed, plain; /* from the same start; plain: F prescribed as mixed has it */
  double stress;            /* largest difference of P from what is prescribed, in C1 + C2 */
  double apart;             /* largest difference of P between the two, in C1 + C2 */
  int extra;                /* factorisations that mixed takes more */
} MixedResult;

/* From the undeformed tissue. */
static inline PetscErrorCode SolveMixedCase(const MixedCase *c, MixedResult *result)
{
  static const double undeformed[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const LamMicrostructure micro = c->contact ? ContactTissue(6, 2) : DefaultTissue();
  LamRVEState state;
  LamStressControl control;
  LamLoad load;
  LamRVE rve;

  PetscFunctionBeginUser;
  MixedLoad(c, undeformed, &load, &control);
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &rve));
  PetscCall(LamRVESetMicrostructure(rve, &micro));
  PetscCall(LamRVESetUp(rve));
  PetscCall(LamRVEStateCreate(rve, &state));
  PetscCall(LamRVESolveMixed(rve, &load, &control, state, &result->mixed));
  PetscCall(LamRVEStateReset(rve, state));
  PetscCall(LamRVESolve(rve, &result->mixed.load, state, &result->plain));
  PetscCall(LamRVEStateDestroy(&state));
  PetscCall(LamRVEDestroy(&rve));
  result->stress = result->apart = 0.0;
  for (int i = 0; i < 9; i++) {
    if (control.given[i]) result->stress = fmax(result->stress, fabs(result->mixed.P[i] - control.P[i]));
    result->apart = fmax(result->apart, fabs(result->mixed.P[i] - result->plain.P[i]));
  }
  result->extra = (int)(result->mixed.factorisations - result->plain.factorisations);
  PetscFunctionReturn(0);
}

#endif
