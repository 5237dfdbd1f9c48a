/*
  The lamella between facing walls, law `lamella` (cohesive.h, cohesive_edge.h).

  Facing walls lie on each other at rest and have equal meshes: a point of the lamella joins the two points with the
  same reference place. An undamaged lamella resists compression, too; where it is damaged, compression is left to
  contact, which keeps all walls apart. So tissue that is not yet damaged is elastic, without contact to be found.
*/
#ifndef LAM_RVE_LAMELLA_H
#define LAM_RVE_LAMELLA_H

#include "cohesive_edge.h"
#include "contact.h"

typedef struct {
  PetscInt count;                    /* points: those of edge e of face f begin at LAM_EDGE_POINTS (f along + e) */
  LamBond *bond;                     /* [count] with the history at the start of the step */
  PetscReal *weight;                 /* [count] reference length */
  PetscBool secant;                  /* the tangent is that of fixed omega, an upper bound (cohesive.h) */
  PetscReal toughness;               /* energy of fracture in tension, per V0 */
  PetscReal spent, released, work;   /* until the start of the step, as in the state */
  PetscInt (*first)[LAM_EDGE_PAIRS]; /* [edge] of nodes i <= j, row by row: first entry of their classes in the matrix
                                        in use; -1: prescribed */
} LamLayer;

/* Sums over the points of an edge. */
typedef struct {
  PetscInt edge;
  PetscInt class[LAM_EDGE_NODES];     /* of its nodes */
  PetscReal shift[LAM_EDGE_NODES][2]; /* x = y_class + F shift */
  LamCohesiveSum sum;
} LamEdgeBlock;
typedef void (*LamEdgeVisitor)(void *ctx, const LamEdgeBlock *block);

/* A point at some positions. */
typedef struct {
  PetscInt point, face;
  PetscReal at; /* in edges from the start of its face */
  LamJump jump;
  LamCohesiveStep step;
} LamBondPoint;
typedef void (*LamBondVisitor)(void *ctx, const LamBondPoint *point);

PetscErrorCode LamLayerCreate(const LamMicrostructure *micro, const LamMesh *mesh, const LamContact *contact,
                              LamLayer **layer);
PetscErrorCode LamLayerDestroy(LamLayer **layer);

#endif
