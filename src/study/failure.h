/*
  How tissue fails along a program of loads: which criterion is reached first, where, and at what load.

    LamFailureFind(&meshes, &program, &failure);      mode, factor, load, response

  Load factor: the number of a state, with a fraction for the share of the way from it to the next, along which F,
  turgor and cohesion are linear; where P is prescribed instead of F, P is, from its value in the state before. State 0
  is F = I, or P = 0 where state 1 prescribes P, at the turgor and cohesion of state 1; where it has no answer the
  program begins with state 1. Definitions: docs/theory/failure.md, Failure criteria.
*/
#ifndef LAM_FAILURE_H
#define LAM_FAILURE_H

#include "onset.h"

#define LAM_FAILURE_MODES(X)                                                                                           \
  X(LAM_FAILURE_NONE, "none")                                                                                          \
  X(LAM_FAILURE_SEPARATION, "separation")   /* the lamella gives way: cells come apart */                              \
  X(LAM_FAILURE_RUPTURE, "rupture")         /* a wall tears */                                                         \
  X(LAM_FAILURE_BUCKLING, "buckling")       /* the stable branch ends */                                               \
  X(LAM_FAILURE_TURGOR_LOSS, "turgor_loss") /* walls that turgor has held taut are slack */                            \
  X(LAM_FAILURE_UNKNOWN, "unknown")         /* a load has no answer before any criterion is reached */
typedef enum { LAM_FAILURE_MODES(LAM_ENUM_ENTRY) LAM_FAILURE_MODE_COUNT } LamFailureMode;
extern const char *const LamFailureModeNames[];

/* Of criteria that are reached at the same load the first here decides. */
#define LAM_CRITERIA(X)                                                                                                \
  X(LAM_CRITERION_LAMELLA_NORMAL, "lamella_normal") /* bonded: max_traction reaches its strength */                    \
  X(LAM_CRITERION_LAMELLA_SHEAR, "lamella_shear")   /* bonded: max_lamella_shear reaches its strength */               \
  X(LAM_CRITERION_CONTACT, "contact")               /* contact: the cells are separated (separation.h) */              \
  X(LAM_CRITERION_WALL, "wall")                     /* max_wall_tension reaches its strength */                        \
  X(LAM_CRITERION_STABILITY, "stability")           /* a saddle is met, or no stable branch found */                   \
  X(LAM_CRITERION_TURGOR, "turgor")                 /* turgor, or the mean tension of the walls, falls to 0 */
typedef enum { LAM_CRITERIA(LAM_ENUM_ENTRY) LAM_CRITERION_COUNT } LamCriterion;
extern const char *const LamCriterionNames[];

LamFailureMode LamFailureModeOf(LamCriterion criterion);

/* Loads in order, states 1..count, and what they are judged by. Everything is borrowed. */
typedef struct {
  LamInterfaceLawType interface;
  const LamStrength *strength; /* NULL: none is given */
  PetscInt count;
  const LamLoad *loads;
  const LamStressControl *controls; /* of the loads; NULL: F is given in all of them */
  PetscBool stop_at_first; /* at the first state at which a criterion is reached; else all are sought, to the end */
} LamFailureProgram;

/* Where one criterion is first reached. */
typedef struct {
  PetscBool judged;     /* it applies to this tissue, and its strength is given where it needs one */
  PetscReal factor;     /* load factor at which it is reached; NaN: nowhere up to `followed` */
  PetscReal bracket[2]; /* load factors between which it lies: not reached, reached */
  PetscReal place[3];   /* cell, face 0..5, place along the face in [0, 1]; NaN where it has none */
  LamResponse response; /* at `factor`, on the first mesh */
} LamCriterionOnset;

typedef struct {
  LamFailureMode mode;
  LamCriterion criterion;                       /* that decides the mode; LAM_CRITERION_COUNT: none */
  PetscReal factor;                             /* where; NaN: nowhere */
  LamLoad load;                                 /* there; where nothing is reached, the last one with an answer */
  LamResponse response;                         /* likewise, on the first mesh */
  LamCriterionOnset onset[LAM_CRITERION_COUNT]; /* of every criterion */
  PetscReal followed;                           /* all loads up to this factor are known */
  char reason[256];                             /* why not further; empty where the program was followed to its end */

  LamFailureProgram program;
  PetscBool turgid, taut; /* the tissue has been under turgor, and its walls under tension by it */
  LamResponse last[2];    /* at `followed`, on both meshes */
  LamRVEState before[2];  /* states there; owned */
} LamFailure;

/*
  Follows the program from the reference state and finds where each criterion is first reached, to 1e-3 of a state.
  Contact tissue is judged on two meshes as separation.h says, with meshes->count 1 on the one, whose gaps at the
  junctions are as wide as its elements are long. Leaves other states in `meshes`. What it fills has no need to be
  destroyed.
*/
PetscErrorCode LamFailureFind(LamMeshes *meshes, const LamFailureProgram *program, LamFailure *failure);

/* The same state by state, for a caller that solves them anyway: */
PetscErrorCode LamFailureCreate(LamMeshes *meshes, const LamFailureProgram *program, LamFailure *failure);
/* Takes note of state `number`, which has just been solved on all meshes; the states in `meshes` stay as they are. */
PetscErrorCode LamFailureWatch(LamFailure *failure, LamMeshes *meshes, PetscInt number, const LamResponse responses[2]);
/* After the last state: the verdict. */
PetscErrorCode LamFailureConclude(LamFailure *failure);
PetscErrorCode LamFailureDestroy(LamFailure *failure);

#endif
