/*
  A mechanical test: stress over strain of the component of F that a load drives, and what is read off the curve.

  Strain and stress count from the tissue at rest, or with LamScene.inflate from the inflated one: F = G F0, and the
  strain is G_ii - 1, in shear G_ij. The stress is P of F or, with LAM_AREA_INFLATED, per area of the inflated tissue,
  P F0^T / det F0; F0 is diagonal.

  Of a body (LamSummaryTest) strain is the displacement u of its loaded side over the height, stress its reaction R over
  the length, both along its motion and positive where it resists; where the body is no box they are u and R themselves.
*/
#ifndef LAM_MECHANICAL_TEST_H
#define LAM_MECHANICAL_TEST_H

#include "study.h"
#include <jansson.h>
#include <lamella/process.h>

/* A state of the curve. */
typedef struct {
  PetscInt state;           /* its number */
  PetscReal strain, stress; /* stress in C1 + C2 */
  PetscReal modulus;        /* d stress / d strain, with free components following; NaN: unknown */
  PetscReal poisson;        /* -d lateral strain / d strain of a free lateral component; NaN: unknown */
  PetscReal lateral;        /* that strain, where poisson is not known; NaN: unknown */
  PetscReal energy;         /* work per volume of the reference since the first state, C1 + C2 */
  PetscBool jumped;         /* from the state before; no smooth curve joins them */
} LamTestPoint;

typedef struct {
  int component, lateral; /* row-major index of the component of F that is driven; -1: none. Its free neighbour; -1 */
  const LamScene *scene;  /* borrowed */
  const char *side;       /* the loaded side of a body; NULL: a material point; borrowed */
  PetscBool is_force;     /* strain is u in mm, stress R in N/mm, of a whole body in N */
  PetscReal unit;         /* of stress, MPa, N/mm or N */
  PetscBool inflated;     /* it counts from the inflated tissue, and stress is ... */
  LamArea area;           /* ... per this area */
  PetscReal F0[9];        /* of the inflated tissue, or the identity */
  PetscReal length, area_factor; /* strain = F_ij / length - delta_ij; stress = P_ij area_factor */
  PetscReal volume;              /* energy per volume = volume times the integral of the stress over the strain */
  PetscInt count, capacity;
  LamTestPoint *points; /* states with a solution; owned */
} LamTest;

/* Strain and stress; NaN where the curve does not have it. */
typedef struct {
  PetscReal strain, stress;
} LamTestMark;

typedef struct {
  PetscReal modulus, poisson; /* where the strain begins to change */
  LamTestMark bioyield;       /* the first maximum of |stress|, if it is exceeded later */
  LamTestMark peak;           /* the largest |stress| */
  PetscBool passed;           /* it is a maximum of the curve: stress falls while strain grows */
  PetscReal energy_to_peak;   /* per volume */
  PetscReal work, returned;   /* while |strain| grows, and while it falls; per volume */
} LamTestReadings;

/* Chooses the component that the load drives: of those of F that are prescribed, or if none changes of those of P, the
   one that changes most in sum. Call before LamLoadsFromInflated. */
void LamTestCreate(const LamScene *scene, LamTest *test);
/* Adds a state that has a solution. The first one with LamScene.inflate is that of the inflated tissue. control: of
   the state, NULL: none. */
PetscErrorCode LamTestAdd(LamTest *test, PetscInt state, const LamResponse *response, const LamStressControl *control);
/* Adds a state whose slopes are not known (NaN): lines then join the states. */
PetscErrorCode LamTestAddPoint(LamTest *test, LamTestPoint point);
/* The inflated tissue has this F. */
void LamTestSetInflated(LamTest *test, const PetscReal F0[9]);
/* F from the inflated tissue and P per area of the reference, of a state of a process. */
void LamProcessMeasures(const LamScene *scene, const LamProcessState *state, PetscReal F[9], PetscReal P[9]);
/* Of a process at a material point: the component is chosen likewise, and the curve begins with the first part of the
   program that drives it. */
PetscErrorCode LamTestOfProcess(const LamScene *scene, PetscInt count, const LamProcessState states[], LamTest *test);
/* F from the inflated tissue, and P per area of the reference, of a response. */
void LamTestMeasures(const LamTest *test, const LamResponse *response, PetscReal F[9], PetscReal P[9]);
void LamTestRead(const LamTest *test, LamTestReadings *readings);
/* Secant and tangent modulus and stress at a strain on the way there; PETSC_FALSE: the curve does not reach it. */
PetscBool LamTestAt(const LamTest *test, PetscReal strain, PetscReal *stress, PetscReal *secant, PetscReal *tangent);
PetscErrorCode LamTestDestroy(LamTest *test);
/* What is read off, and at `count` strains; new reference. */
json_t *LamTestToJSON(const LamTest *test, PetscInt count, const PetscReal strain[]);

/* Loads and controls after the first, given from the inflated tissue with its F, become those of F itself. */
void LamLoadsFromInflated(LamScene *scene, const PetscReal F0[9]);

#endif
