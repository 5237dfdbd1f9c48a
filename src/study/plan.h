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
  PetscInt unknowns;       /* of one RVE */
  PetscInt load_states;    /* RVE solves of `rve`, `build` and `fe2` with direct response; 0: no such block */
  PetscInt sample_states;  /* 0 also if an accuracy determines the number */
  PetscInt64 macro_states; /* predicted */
  PetscInt macro_elements, macro_points; /* 0 also if they are in a file */
  PetscInt map_points, map_states;       /* of `map`, without the states that bracket the failure; 0: no such block */
} LamPlan;
#define LAM_PARALLEL_UNKNOWNS 20000 /* of one RVE: from this size on several ranks factor its matrix together */
/* With the mesh of LamChooseMesh (mesh_choice.h). */
PetscErrorCode LamPlanMake(const LamScene *scene, LamPlan *plan);

/* What it costs on one rank of this machine. */
typedef struct {
  PetscReal assembly, state, point; /* seconds: one assembly, one state, one query during a macroscale step */
  PetscReal map;                    /* seconds, with the states that bracket the failure; 0: no such block */
  PetscReal memory;                 /* MB */
} LamCost;
/* plan_cost.c: times an assembly. */
PetscErrorCode LamPlanCost(const LamScene *scene, const LamPlan *plan, LamCost *cost);

#endif
