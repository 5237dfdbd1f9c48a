/*
  What a scene requires: mesh, unknowns, number of solves.
*/
#ifndef LAM_PLAN_H
#define LAM_PLAN_H

#include "mesh_choice.h"

/* Range of cells that differ: smallest and largest. */
typedef struct {
  PetscInt kinds; /* number of different cells; 0: all equal, and no range below is set */
  PetscReal wall_thickness[2];
  PetscReal shear_modulus[2]; /* C1 + C2, relative to that of the scene's own wall */
  PetscReal turgor[2], cohesion[2], lamella_strength[2], lamella_energy[2];
} LamCellSpread;

typedef struct {
  LamMicrostructure micro; /* with along and through chosen; borrows the scene's cells */
  LamMeshTrial trial;      /* that chose the mesh */
  LamCellSpread spread;
  PetscInt unknowns;      /* of one RVE */
  PetscInt load_states;   /* RVE solves of `rve`, `build` and `fe2` with direct response; 0: no such block */
  PetscInt sample_states; /* 0 also if an accuracy determines the number */
  PetscInt macro_elements, macro_points; /* 0 also if they are in a file */
  PetscInt map_points, map_states;       /* of `map`, without the states that bracket the failure; 0: no such block */
} LamPlan;
#define LAM_PARALLEL_UNKNOWNS 20000 /* of one RVE: from this size on several ranks factor its matrix together */
/* With the mesh of LamChooseMesh (mesh_choice.h). */
PetscErrorCode LamPlanMake(const LamScene *scene, LamPlan *plan);

/* ---- plan_cost.c ---- */
/* Commands that a scene has a block for. */
#define LAM_PLANNED(X)                                                                                                 \
  X(LAM_PLANNED_RVE, "rve")                                                                                            \
  X(LAM_PLANNED_BUILD, "build")                                                                                        \
  X(LAM_PLANNED_MAP, "map")                                                                                            \
  X(LAM_PLANNED_FE2, "fe2") /* with direct responses */                                                                \
  X(LAM_PLANNED_PROCESS, "process")
typedef enum { LAM_PLANNED(LAM_ENUM_ENTRY) LAM_PLANNED_COUNT } LamPlanned;
extern const char *const LamPlannedNames[];

typedef struct {
  PetscBool has;     /* the scene has its block */
  PetscReal seconds; /* of processor time on one core of this machine, with start and trial of meshes; NaN: unknown */
  PetscReal share;   /* of the command that was run to predict it */
} LamPrediction;
typedef struct {
  LamPrediction of[LAM_PLANNED_COUNT];
  PetscReal memory; /* MB, per rank */
} LamCost;
/* Runs parts of the commands for so many seconds of processor time in all; regions: plans of those of the body. On
   several ranks, and of RVEs too large for a part in this time, nothing is predicted. */
PetscErrorCode LamPlanCost(const LamScene *scene, const LamPlan *plan, const LamPlan regions[], PetscReal seconds,
                           LamCost *cost);

#endif
