/*
  Failure of tissue along a program of loads: the criterion reached first, its place, and the load.

    LamFailureFind(&meshes, &program, &failure);      mode, factor, load, response

  Load factor: the number of a state plus the fraction of the load path from it to the next. F, turgor and cohesion are
  linear along the path; where P is prescribed instead of F, P is linear, starting from its value in the previous state.
  State 0 is F = I, or P = 0 where state 1 prescribes P, at the turgor and cohesion of state 1. If state 0 has no
  solution, the program begins with state 1. Definitions: docs/theory/failure.md, Failure criteria.
*/
#ifndef LAM_FAILURE_H
#define LAM_FAILURE_H

#include "onset.h"

#define LAM_FAILURE_MODES(X)                                                                                           \
  X(LAM_FAILURE_NONE, "none")                                                                                          \
  X(LAM_FAILURE_SEPARATION, "separation")   /* the lamella fails and cells separate */                                 \
  X(LAM_FAILURE_RUPTURE, "rupture")         /* a wall tears */                                                         \
  X(LAM_FAILURE_BUCKLING, "buckling")       /* the stable branch ends */                                               \
  X(LAM_FAILURE_TURGOR_LOSS, "turgor_loss") /* walls kept taut by turgor go slack */                                   \
  X(LAM_FAILURE_UNKNOWN, "unknown")         /* a load has no solution before any criterion is reached */
typedef enum { LAM_FAILURE_MODES(LAM_ENUM_ENTRY) LAM_FAILURE_MODE_COUNT } LamFailureMode;
extern const char *const LamFailureModeNames[];

/* If several criteria are reached at the same load, the first in this list determines the mode. */
#define LAM_CRITERIA(X)                                                                                                \
  X(LAM_CRITERION_LAMELLA_NORMAL, "lamella_normal") /* bonded: max_traction reaches its strength */                    \
  X(LAM_CRITERION_LAMELLA_SHEAR, "lamella_shear")   /* bonded: max_lamella_shear reaches its strength */               \
  X(LAM_CRITERION_CONTACT, "contact")               /* contact: the cells are separated (separation.h) */              \
  X(LAM_CRITERION_WALL, "wall")                     /* max_wall_tension reaches its strength */                        \
  X(LAM_CRITERION_STABILITY, "stability")           /* a saddle, or no stable branch is found */                       \
  X(LAM_CRITERION_TURGOR, "turgor")                 /* turgor or the mean wall tension falls to 0 */
typedef enum { LAM_CRITERIA(LAM_ENUM_ENTRY) LAM_CRITERION_COUNT } LamCriterion;
extern const char *const LamCriterionNames[];

LamFailureMode LamFailureModeOf(LamCriterion criterion);

/* Loads of states 1..count, in order, and the strengths for the criteria. Everything is borrowed. */
typedef struct {
  LamInterfaceLawType interface;
  const LamStrength *strength; /* NULL: none given */
  PetscInt count;
  const LamLoad *loads;
  const LamStressControl *controls; /* [count]; NULL: F is prescribed in all loads */
  PetscBool stop_at_first; /* stop at the first state at which a criterion is reached; else follow the whole program */
} LamFailureProgram;

/* Onset of one criterion. */
typedef struct {
  PetscBool judged;     /* evaluated: applies to this tissue, and the strength is given where it needs one */
  PetscReal factor;     /* load factor at which it is reached; NaN: not up to `followed` */
  PetscReal bracket[2]; /* load factors that bracket the onset: not reached, reached */
  PetscReal place[3];   /* cell, face 0..5, position along the face in [0, 1]; NaN if it has none */
  LamResponse response; /* at `factor`, on the first mesh */
} LamCriterionOnset;

/* A solved point on the load path between two states. */
typedef struct {
  PetscReal share; /* fraction of the load path */
  LamResponse responses[2];
  LamRVEState states[2]; /* owned */
} LamPathPoint;

typedef struct {
  LamFailureMode mode;
  LamCriterion criterion;                       /* reached first; LAM_CRITERION_COUNT: none */
  PetscReal factor;                             /* load factor of its onset; NaN: none */
  LamLoad load;                                 /* at the onset; if none, the last load with a solution */
  LamResponse response;                         /* to `load`, on the first mesh */
  LamCriterionOnset onset[LAM_CRITERION_COUNT]; /* of every criterion */
  PetscReal followed;                           /* all loads up to this load factor are solved */
  char reason[256];                             /* why the program was not followed to its end; else empty */

  LamFailureProgram program;
  PetscBool turgid, taut; /* turgor was positive before; walls were taut (LamIsTaut) before */
  LamPathPoint last;      /* at `followed`; owned */
} LamFailure;

/*
  Follows the program from the reference state and finds the onset of each criterion to 1e-3 in load factor. Contact
  tissue is evaluated on two meshes (separation.h); with meshes->count 1 on one mesh only, where gaps at the junctions
  are as wide as its elements are long. Changes the states in `meshes`. `failure` need not be destroyed.
*/
PetscErrorCode LamFailureFind(LamMeshes *meshes, const LamFailureProgram *program, LamFailure *failure);

/* The same, one state at a time, for a caller that solves the states itself: */
PetscErrorCode LamFailureCreate(LamMeshes *meshes, const LamFailureProgram *program, LamFailure *failure);
/* Evaluates state `number`, which has just been solved on all meshes. The states in `meshes` are unchanged. */
PetscErrorCode LamFailureWatch(LamFailure *failure, LamMeshes *meshes, PetscInt number, const LamResponse responses[2]);
/* After the last state: sets mode, criterion, factor, load and response. */
PetscErrorCode LamFailureConclude(LamFailure *failure);
PetscErrorCode LamFailureDestroy(LamFailure *failure);

/* ---- evaluation of the criteria from the responses to one load on both meshes ---- */

/* Walls are taut if their mean tension exceeds this fraction of the turgor p. In free tissue turgor alone causes a
   tension above p; in tissue held at F = I about p^2/kappa, because walls are compressible. */
#define LAM_TAUT 0.1

/* Whether a criterion is evaluated: it applies to this interface, and its strength is given where it needs one. */
static inline PetscBool LamCriterionIsJudged(LamCriterion criterion, LamInterfaceLawType interface,
                                             const LamStrength *strength)
{
  const PetscBool contact = LamCellsPart(interface);

  switch (criterion) {
  case LAM_CRITERION_LAMELLA_NORMAL:
    return (PetscBool)(!contact && isfinite(strength->lamella_normal));
  case LAM_CRITERION_LAMELLA_SHEAR:
    return (PetscBool)(!contact && isfinite(strength->lamella_shear));
  case LAM_CRITERION_CONTACT:
    return contact;
  case LAM_CRITERION_WALL:
    return (PetscBool)isfinite(strength->wall);
  default:
    return PETSC_TRUE;
  }
}

/* Whether the responses on both meshes have fields. */
static inline PetscBool LamHaveFields(const LamResponse responses[2])
{
  return (PetscBool)(LamResponseHasFields(&responses[0]) && LamResponseHasFields(&responses[1]));
}

/* Turgor of the lumens, which is computed if they are sealed; that of the load if the response has none. */
static inline PetscReal LamTurgorReached(const LamResponse *r)
{
  return isfinite(r->turgor_mean) ? r->turgor_mean : r->load.turgor;
}

static inline PetscBool LamIsTurgid(const LamResponse *r)
{
  return (PetscBool)(LamTurgorReached(r) > 0);
}

/* Mean over all walls. The three face families have equal weight. */
static inline PetscReal LamMeanTension(const LamResponse *r)
{
  return (r->mean_wall_tension[0] + r->mean_wall_tension[1] + r->mean_wall_tension[2]) / 3;
}

static inline PetscBool LamIsTaut(const LamResponse *r)
{
  return (PetscBool)(LamIsTurgid(r) && LamMeanTension(r) > LAM_TAUT * LamTurgorReached(r));
}

/*
  Excess of an evaluated criterion at responses with fields; >= 0 if it is reached. Continuous along a load path, except
  contact and stability, which are -1 or 1. `before`: responses at a load where the criterion is not reached. Loss of
  turgor or tension counts only if failure->turgid or failure->taut is set.
*/
static inline PetscReal LamCriterionExcess(LamCriterion criterion, const LamFailure *failure,
                                           const LamResponse before[2], const LamResponse responses[2])
{
  const LamResponse *r = &responses[0];
  const LamStrength *strength = failure->program.strength;
  const LamSeparation separation = LamSeparationOf(responses);
  PetscReal excess = -1;

  switch (criterion) {
  case LAM_CRITERION_LAMELLA_NORMAL:
    return r->max_traction / strength->lamella_normal - 1;
  case LAM_CRITERION_LAMELLA_SHEAR:
    return r->max_lamella_shear / strength->lamella_shear - 1;
  case LAM_CRITERION_WALL:
    return r->max_wall_tension / strength->wall - 1;
  case LAM_CRITERION_CONTACT:
    return separation == LAM_SEPARATION_GAP || separation == LAM_SEPARATION_TRACTION ? 1 : -1;
  case LAM_CRITERION_STABILITY:
    return r->status == LAM_UNSTABLE || r->branch > before[0].branch ? 1 : -1;
  case LAM_CRITERION_TURGOR:
    if (failure->turgid) excess = -LamTurgorReached(r);
    if (failure->taut) excess = PetscMax(excess, -LamMeanTension(r));
    return excess;
  default:
    return excess;
  }
}

#endif
