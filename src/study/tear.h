/*
  The law of a layer of tissue that tears: traction against the separation of what is above and below it, in opening and
  in shear, under each of several turgors. Other programs take it as a cohesive law. docs/theory/lamella.md, A layer of
  tissue, has the definitions.

    LamTear tear = {.turgor_count = ..., ...};   options below
    LamSceneRead(path, &tear.scene); LamTearPrepare(&tear); LamTearRun(&tear); LamTearDestroy(&tear);

  Nondimensional: lengths in apothems, stresses in C1 + C2. Tractions and energies are per area of the layer that is
  free of stress under its turgor, along X1.
*/
#ifndef LAM_TEAR_H
#define LAM_TEAR_H

#include "study.h"

#define LAM_TEAR_MODES(X)                                                                                              \
  X(LAM_TEAR_OPENING, "opening") /* along X2, at the lateral stretch of the layer free of stress */                    \
  X(LAM_TEAR_SHEAR, "shear")     /* along X1, without pressure on the layer: P22 = 0 */
typedef enum { LAM_TEAR_MODES(LAM_ENUM_ENTRY) LAM_TEAR_MODE_COUNT } LamTearMode;
extern const char *const LamTearModeNames[]; /* "opening", "shear" */

/* Why a curve ends. */
#define LAM_TEAR_ENDS(X)                                                                                               \
  X(LAM_TEAR_APART, "apart")           /* the traction has fallen below a hundredth of its peak, and stays there */    \
  X(LAM_TEAR_SEPARATION, "separation") /* the largest separation is reached, and something holds */                    \
  X(LAM_TEAR_TORN, "torn_by_turgor")   /* nothing holds in the tissue that is free of stress, or it has no such state  \
                                        */                                                                             \
  X(LAM_TEAR_UNSOLVED, "unsolved")     /* a state was not found; the reason says why */                                \
  X(LAM_TEAR_STOPPED, "stopped")
typedef enum { LAM_TEAR_ENDS(LAM_ENUM_ENTRY) LAM_TEAR_END_COUNT } LamTearEnd;
extern const char *const LamTearEndNames[];

/* ---- tear_layer.c: one period of the tissue as a layer with the normal X2 ---- */

typedef struct {
  PetscReal height; /* along X2, at rest: the volume of a period over its width */
  PetscReal width;  /* along X1: the shortest period in this direction */
  PetscReal energy; /* of the lamella that a straight crack must cut, per width at rest, (C1 + C2) a */
} LamTearLayer;

/* PETSC_ERR_USER_INPUT, with the path: no period of the tissue is along X1, or one cell would be cut by two cracks. */
PetscErrorCode LamTearLayerOf(const char path[], const LamMicrostructure *micro, LamTearLayer *layer);

/* ---- tear.c ---- */

/* A point of a curve. Energies per area, in (C1 + C2) a, since the tissue free of stress. */
typedef struct {
  PetscBool is_state;   /* no: on the way down in a jump, where only separation, traction and crack are known */
  PetscReal separation; /* D = height (F22 - F0_22), in shear height (F12 - F0_12) */
  PetscReal traction;
  PetscReal crack;                /* separation less that of bonded tissue under this traction; NaN: not known */
  PetscReal dilation;             /* height (F22 - F0_22) in shear; 0 in opening */
  PetscReal work;                 /* of the traction, by the trapezoidal rule over the parts of all steps */
  PetscReal stored;               /* in walls, lamella and fluid, that of burst cells as they burst */
  PetscReal dissipated, released; /* spent in lamella and walls; lost in jumps and bursts */
  PetscReal broken;               /* broken_fraction of the response */
  PetscReal walls;                /* the part of `dissipated` in walls that tear */
  PetscReal burst;                /* burst_fraction of the response */
  PetscBool jumped;               /* from the state before */
  PetscReal F[2][2];              /* from the undeformed tissue */
} LamTearPoint;

typedef struct {
  LamTearMode mode;
  PetscReal turgor;
  LamTearEnd end;
  char reason[256];    /* of LAM_TEAR_TORN and LAM_TEAR_UNSOLVED */
  PetscReal F0[2];     /* F11 and F22 of the tissue free of stress; NaN: there is none */
  PetscReal stiffness; /* slope of the traction at the start, (C1 + C2)/a */
  PetscReal straight;  /* energy of the lamella of a straight crack */
  PetscInt count, capacity;
  LamTearPoint *points; /* the first one is the tissue free of stress; owned */
} LamTearCurve;

/* What is read off a curve. */
typedef struct {
  PetscReal strength, at; /* largest traction, and its separation */
  PetscReal energy;       /* dissipated + released in the end: the work that does not come back */
  PetscReal imbalance;    /* work - stored - energy in the end: error of the sums, and jumps that were not seen */
  PetscInt states;        /* points that are */
  PetscReal share;        /* of `energy` released in jumps */
  PetscReal law; /* integral of the traction over the crack's part of the separation, by lines between states */
} LamTearReadings;

typedef struct LamTear_s {
  /* options; all borrowed */
  PetscInt turgor_count;   /* 0: the scene's */
  const PetscReal *turgor; /* SI */
  PetscBool mode[LAM_TEAR_MODE_COUNT];
  PetscReal separation; /* largest, SI; 0: as far as it takes */
  PetscInt steps;
  LamReporter reporter;
  /* Called when a curve is complete; ctx: that of the reporter. */
  PetscErrorCode (*curve)(void *ctx, const struct LamTear_s *tear, const LamTearCurve *curve);

  LamScene *scene; /* set by the caller; owned */
  LamTearLayer layer;
  PetscInt curves, unsolved; /* done; of these not solved to their end */
  LamRVE rve, bonded;        /* of the scene, and with bonded cells */
} LamTear;

/* Chooses what the scene leaves open, and makes its tissue. PETSC_ERR_USER_INPUT: not a scene that can tear. */
PetscErrorCode LamTearPrepare(LamTear *tear);
/* Follows all curves, those of one turgor after each other. */
PetscErrorCode LamTearRun(LamTear *tear);
PetscErrorCode LamTearDestroy(LamTear *tear);
LamTearReadings LamTearRead(const LamTearCurve *curve);

#endif
