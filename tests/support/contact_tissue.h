/* A state and the finite differences of its energy, stress, dPsi/dp and dPsi/dg in each component of (F, p, g): what
   tests assert and the bench program prints. Fourth-order central differences of warm-started solves. The potential of
   contact tissue is smooth while the contact set stays: the states that change theirs are counted. */
#ifndef LAM_SUPPORT_CONTACT_TISSUE_H
#define LAM_SUPPORT_CONTACT_TISSUE_H

#include "tissue.h"
#include "solve.h"
#include "random_reals.h"

#define CONTACT_STATES 6
#define CONTACT_COLUMNS 7 /* 0..4: components of F; turgor, cohesion */
#define CONTACT_TURGOR 5
#define CONTACT_COHESION 6
#define CONTACT_STEP 2e-4
#define CONTACT_STEP_LARGE_RVE 2e-5 /* with many hats one is always close to a change */
static const int contact_components[5] = {0, 1, 3, 4, 8};

typedef struct {
  const char *name;
  LamMicrostructure micro;
  LamLoad load;
  double step; /* of the differences */
} ContactState;

typedef struct {
  LamResponse response;
  double energy[CONTACT_COLUMNS], P[CONTACT_COLUMNS][9];           /* differences: of Psi and P, ... */
  double by_turgor[CONTACT_COLUMNS], by_cohesion[CONTACT_COLUMNS]; /* ... of dPsi/dp and dPsi/dg */
  int switches; /* states with another contact set or junction status */
} ContactSweep;

LamMicrostructure ContactTissue(PetscInt along, PetscInt through);
/* Turgor and cohesion in MPa. */
LamLoad ContactLoad(double F11, double F12, double F21, double F22, double turgor, double cohesion);
void ListContactStates(ContactState list[CONTACT_STATES]);
/* Bonded: a wall thickness, orientation, mesh position and load that nothing singles out; F33 differs from 1. */
#define RANDOM_STATES 6
ContactState RandomState(int number);

typedef struct {
  LamRVE rve;
  LamRVEState centre, state;
  PetscBool *active; /* of the centre */
  LamContactFace *faces;
} ContactCentre;

/* All columns about at->centre, which the RVE has just been solved for. */
PetscErrorCode SweepColumns(ContactCentre *at, double step, ContactSweep *sweep);
PetscErrorCode SweepContact(const ContactState *point, ContactSweep *sweep);
/* Largest diagonal entry of the tangent, by which errors of second derivatives are measured. */
double TangentScale(const LamResponse *r);
/* Largest differences between the response and the finite differences, tangents over TangentScale; symmetry: between
   the finite differences of the stress, because the response's tangent is symmetric by construction. */
typedef struct {
  double stress, turgor, cohesion, tangent, symmetry, turgor_coupling, cohesion_coupling, volumes;
  double lumen, opening; /* dPsi/dp + V_lumen/V0, dPsi/dg - V_gap/V0: zero where cells are alike */
} ContactDerivativeError;

ContactDerivativeError DerivativeError(const ContactSweep *s);

#endif
