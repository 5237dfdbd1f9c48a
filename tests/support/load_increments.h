/* States that follow each other by small and large increments: what the test asserts and the bench program prints. */
#ifndef LAM_SUPPORT_LOAD_INCREMENTS_H
#define LAM_SUPPORT_LOAD_INCREMENTS_H

#include <math.h>
#include "solve.h"
#include "tissue.h"

#define INCREMENT_KINDS(X)                                                                                             \
  X(INCREMENT_BONDED, "bonded")                                                                                        \
  X(INCREMENT_DRY, "bonded, dry")                                                                                      \
  X(INCREMENT_SEALED, "bonded, sealed")                                                                                \
  X(INCREMENT_MIXED, "bonded, mixed control")                                                                          \
  X(INCREMENT_CONTACT, "contact")                                                                                      \
  X(INCREMENT_CONTACT_SEALED, "contact, sealed")                                                                       \
  X(INCREMENT_CONTACT_MIXED, "contact, mixed control")
typedef enum { INCREMENT_KINDS(LAM_ENUM_ENTRY) INCREMENT_KIND_COUNT } IncrementKind;

/* A tissue in a state from which increments start. */
typedef struct {
  IncrementKind kind;
  LamRVE rve;
  LamRVEState base, state;
  LamStressControl control; /* gives nothing where F is prescribed */
  LamResponse at;           /* the base */
} IncrementTissue;

PetscErrorCode IncrementCreate(IncrementKind kind, IncrementTissue *t);
PetscErrorCode IncrementDestroy(IncrementTissue *t);

#define INCREMENT_STEPS 10
typedef struct {
  PetscInt solved;
  PetscInt iterations, factorisations; /* most of a step */
  PetscInt fewest;                     /* iterations of a step */
  double error, size;                  /* largest of a step: |P1 - P0 - A dF|, |A dF|, C1 + C2 */
  double stress;                       /* |P - prescribed P|, largest */
  double seconds;                      /* all of them */
} IncrementWalk;

/* INCREMENT_STEPS steps of h, one after the other. */
PetscErrorCode IncrementWalkBy(IncrementTissue *t, double h, IncrementWalk *walk);

/* ---- steps that are too large ---- */

typedef struct {
  const char *name;
  double F[4];
} LargeStep;

static const LargeStep large_steps[] = {
    {"shear 0.5", {1, 0.5, 0, 1}},
    {"shear 1", {1, 1, 0, 1}},
    {"shear 2", {1, 2, 0, 1}},
    {"shear 3", {1, 3, 0, 1}},
    {"log strain 1 along 1", {2.718281828459045, 0, 0, 1}},
    {"log strain 0.5 along both", {1.6487212707001282, 0, 0, 1.6487212707001282}},
    {"log strain 1, -0.5", {2.718281828459045, 0, 0, 0.6065306597126334}},
    {"log strain -0.5 along 2", {1, 0, 0, 0.6065306597126334}},
    {"log strain -0.25 along both", {0.7788007830714049, 0, 0, 0.7788007830714049}},
};

#define LARGE_STEPS ((int)PETSC_STATIC_ARRAY_LENGTH(large_steps))
typedef struct {
  LamResponse once, small; /* in one go; in `steps`, the last one that was solved */
  int steps, failed;       /* failed: the step at which the small ones ended, 0: none */
  double small_seconds;
  PetscInt small_iterations;
  double apart; /* LamStressError between the two */
} LargeResult;

PetscErrorCode LargeStepSolve(LamRVE rve, const LargeStep *step, double turgor, int steps, LargeResult *l);

/* bulk modulus of water, C1 + C2 */
static const char *const increment_names[] = {INCREMENT_KINDS(LAM_NAME_ENTRY)};

#endif
