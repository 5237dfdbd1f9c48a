/*
  The lamella between facing walls, law `lamella` (cohesive.h, cohesive_edge.h).

  Facing walls lie on each other at rest and have equal meshes: a point of the lamella joins the two points with the
  same reference place. An undamaged lamella resists compression, too; where it is damaged, compression is left to
  contact, which keeps all walls apart. So tissue that is not yet damaged is elastic, without contact to be found.

  Walls that tear have the same law across their cuts (mesh.h), with edges through the wall. The sides of a cut keep
  each other out, damaged or not, by the stiffness of the undamaged one. A cut is torn once all its points are broken;
  its cell bursts, at that iterate (LamLayerBurst).
*/
#ifndef LAM_RVE_LAMELLA_H
#define LAM_RVE_LAMELLA_H

#include "cohesive_edge.h"
#include "contact.h"

/* Nodes of an edge: x = y_class + F shift. */
typedef struct {
  PetscInt class[LAM_EDGE_NODES];
  PetscReal shift[LAM_EDGE_NODES][2], length; /* of the edge at rest */
} LamEdgeNodes;

typedef struct {
  PetscInt between;       /* points between cells: those of edge e of face f begin at LAM_EDGE_POINTS (f
                             along + e) */
  PetscInt count;         /* and all; those of edge m from the lumen of cut k begin at between +
                             LAM_EDGE_POINTS (k through + m) */
  LamEdgeNodes *nodes;    /* [edge] */
  LamBond *bond;          /* [count] with the history at the start of the step */
  PetscReal *weight;      /* [count] reference length */
  PetscBool secant;       /* the tangent is that of fixed omega, an upper bound (cohesive.h) */
  PetscReal toughness[2]; /* energy of fracture in tension, of the lamella and of all cuts, per V0 */
  PetscReal spent, released, work, juice, spilt; /* until the start of the step, as in the state */
  PetscInt (*first)[LAM_EDGE_PAIRS]; /* [edge] of nodes i <= j, row by row: first entry of their classes in the matrix
                                        in use; -1: prescribed */
  PetscBool *torn;  /* [cut] cuts broken through at the start of the step, or by which a cell bursts in it;
                       NULL: walls do not tear */
  PetscBool *burst; /* [cell] */
} LamLayer;

/* Sums over the points of an edge. */
typedef struct {
  PetscInt edge;
  const LamEdgeNodes *nodes;
  LamCohesiveSum sum;
} LamEdgeBlock;
typedef void (*LamEdgeVisitor)(void *ctx, const LamEdgeBlock *block);

/* A point at some positions. */
typedef struct {
  PetscInt point, face; /* face -1: of a cut */
  PetscReal at;         /* in edges from the start of its face or cut */
  LamJump jump;
  LamCohesiveStep step;
} LamBondPoint;
typedef void (*LamBondVisitor)(void *ctx, const LamBondPoint *point);

/* How the jump of a point changes with the load. */
#define LAM_BOND_RATES 5 /* F11, F12, F21, F22, p */
typedef struct {
  PetscReal jump[2], rate[2][LAM_BOND_RATES]; /* delta_n and delta_t */
  PetscReal secant, slope;                    /* T/delta and dT/ddelta of the tangent */
} LamBondRate;
typedef struct {
  LamLoad load; /* of the state that they belong to */
  LamBondRate *bond;
  LamBondHistory *before; /* from which the tangent of that state counts, */
  PetscReal spent;        /* with what was dissipated until then, per V0 */
} LamBondRates;

PetscErrorCode LamLayerCreate(const LamMicrostructure *micro, const LamMesh *mesh, const LamContact *contact,
                              LamLayer **layer);
/* Sets the laws of all points to those of `micro`, which may have changed. */
void LamLayerSetLaws(const LamMicrostructure *micro, const LamMesh *mesh, const LamContact *contact, LamLayer *layer);
PetscErrorCode LamLayerDestroy(LamLayer **layer);

#endif
