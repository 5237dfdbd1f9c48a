/*
  Bodies of wall elements (blocks.h) that the law of the lamella joins along edges, and that are torn apart: for tests
  of the law in mechanics that has nothing to do with cells. Springs keep pressed faces from each other.

  Dead loads `load` act with a factor lambda, under control of what they do work on, load.u = target: one step is a
  minimum of walls + sum of the lamella's potentials among states with that target.

  Method. Newton with the multiplier lambda, whose matrix has one negative eigenvalue where the energy is convex beside
  the constraint. Where it has more, the nodes of the lamella are held by springs (a shift of the diagonal). The first
  step meets the target, the others go down by halving.

    BlocksCreate, BlocksAddGrid; TornCreate(&blocks, edges, &rule, &torn); edge, length, law, load;
    TornPull(&torn, target, &step) ...; TornDestroy; BlocksDestroy
*/
#ifndef LAM_SUPPORT_TORN_BLOCKS_H
#define LAM_SUPPORT_TORN_BLOCKS_H

#include "blocks.h"
#include "cohesive_edge.h"

#define TORN_POINTS 8 /* at most, of an edge */

/* Gauss's rule on [0, 1]. */
typedef struct {
  PetscInt count;
  PetscReal place[TORN_POINTS], weight[TORN_POINTS];
} TornRule;
void TornGauss(PetscInt count, TornRule *rule);

typedef struct {
  Blocks *blocks; /* borrowed */
  TornRule rule;
  PetscInt edges;
  PetscInt (*edge)[LAM_EDGE_NODES]; /* [edge] nodes, as in cohesive_edge.h; owned, like the others */
  PetscReal *length;                /* [edge] */
  LamCohesive law;
  PetscReal contact;       /* stiffness of faces that are pressed together: traction over penetration */
  LamBondHistory *history; /* [edge][rule.count] */
  LamBond *bond;
  PetscReal (*load)[2]; /* [node] */
  PetscReal lambda, target;
  PetscReal springs; /* of the last iteration */
  Mat K, factor;
} Torn;

/* Of a body; energies at its end. */
typedef struct {
  PetscReal lambda, target;
  PetscReal walls, stored, spent; /* in walls and lamella; dissipated in this step */
  PetscReal work;                 /* of the loads in this step, by the trapezoidal rule */
  PetscInt iterations;
} TornStep;

PetscErrorCode TornCreate(Blocks *blocks, PetscInt edges, const TornRule *rule, Torn *torn);
PetscErrorCode TornDestroy(Torn *torn);
/* Goes to the target, or a little beyond it where the bodies jump there, and keeps the history; an error where there is
   no equilibrium. */
PetscErrorCode TornPull(Torn *torn, PetscReal target, TornStep *step);
/* Jump of a point in the last state. */
LamJump TornJump(const Torn *torn, PetscInt edge, PetscInt q);

#endif
