/*
  Bodies of wall elements in frictionless contact along one pair of chains, for tests of the mortar kernel in mechanics
  that has nothing to do with cells. Energy: walls, plus pressures times the areas at the sides they press on, minus sum
  lambda G; held components keep their starting positions.

    BlocksCreate(nodes, elements, n, m, &blocks); BlocksAddGrid(...) for every body; slave, master, J0, held, x;
    BlocksSolve(blocks, &iterations); BlocksDestroy(blocks);

  With plane_stress every element has its own stretch F33, at which its mean stress P33 vanishes; it is eliminated in
  the element. Pressures then are per reference thickness.
*/
#ifndef LAM_SUPPORT_BLOCKS_H
#define LAM_SUPPORT_BLOCKS_H

#include <petscmat.h>
#include "displaced.h"
#include "edge_area.h"
#include "mortar.h"

#define BLOCKS_ITERATIONS 40
#define BLOCKS_SIDES 4
/* dPi_e/dF33, d2Pi_e/dx dF33, d2Pi_e/dF33^2 of the last evaluation. */
typedef struct {
  PetscReal force, fx[LAM_ELEMENT_DOFS], ff;
} BlocksThickness;

typedef struct {
  PetscInt node_count, element_count, n, m;
  PetscReal (*X)[2], (*x)[2];              /* [node] reference and current positions */
  PetscBool (*held)[2];                    /* [node] */
  PetscInt (*elements)[LAM_ELEMENT_NODES]; /* [element] node order of LamMesh */
  LamElementGeometry *geometry;            /* [element] */
  LamElementStress *stress;                /* [element] */
  LamWall *wall_of;                        /* [element]: `wall` when its grid was added */
  PetscReal *F33;                          /* [element] */
  BlocksThickness *thickness;              /* [element] */
  PetscReal (*pressure)[BLOCKS_SIDES];     /* [element]: Cauchy pressure on its sides */
  PetscInt *chain;                         /* nodes of both chains: slave [2n+1], then master [2m+1] */
  PetscReal (*chain_x)[2], *J0, *lambda;   /* J0[n], lambda[2n+1] */
  PetscBool *active;                       /* [2n+1] */
  PetscBool ends_held;                     /* the chains' ends are: their hats go with their neighbours' */
  PetscBool plane_stress;
  PetscReal scale;    /* weighs gaps against multipliers in the active set */
  PetscReal fibre[2]; /* of the grids that are added next */
  LamWall wall;       /* likewise */
  const LamWallLaw *law;
  PetscInt negative; /* eigenvalues of the last factor */
  LamMortarSegments segments;
  LamMortarResult result;
} Blocks;

/* Room for nodes and elements; walls of the plain law, C1 = 0.9, C2 = 0.1. */
PetscErrorCode BlocksCreate(PetscInt nodes, PetscInt elements, PetscInt n, PetscInt m, Blocks *b);
PetscErrorCode BlocksDestroy(Blocks *b);
/* Adds nx x ny elements whose node (i, j), i <= 2 nx, j <= 2 ny, lies at place(ctx, i, j); its number is
   first + j (2 nx + 1) + i. */
PetscErrorCode BlocksAddGrid(Blocks *b, PetscInt nx, PetscInt ny,
                             void (*place)(void *ctx, PetscInt i, PetscInt j, PetscReal X[2]), void *ctx,
                             PetscInt *first);
/* E' = E/(1 - nu^2) at small strain of a wall without fibres. */
PetscReal BlocksPlaneStrainModulus(const LamWall *wall);
/* Current positions of the chains. */
LamMortarChains BlocksChains(Blocks *b);
void BlocksGather(const Blocks *b, PetscInt e, PetscReal x[LAM_ELEMENT_NODES][2]);
/* Adds the walls' residual, of held components too (reactions), and their tangent without these. */
PetscErrorCode BlocksAddWalls(Blocks *b, Mat K, PetscReal residual[], PetscBool *valid);
/* Independent stresses to begin with in bodies under a hydrostatic pressure. */
void BlocksStartUnder(Blocks *b, PetscReal pressure);
/* Weighted gaps at the present positions. */
void BlocksFindGaps(Blocks *b);
/* solution := K^-1 rhs. negative: number of negative eigenvalues of a symmetric K; NULL: K need not be symmetric. */
PetscErrorCode BlocksFactorAndSolve(Mat K, PetscInt size, PetscReal rhs[], PetscReal solution[], PetscInt *negative);
/* Moves positions, independent stresses and multipliers by the solution of the system. */
void BlocksStep(Blocks *b, const PetscReal solution[]);
/* Newton's method with active sets from the present positions and multipliers. */
PetscErrorCode BlocksTry(Blocks *b, PetscReal tolerance, PetscInt *iterations, PetscBool *converged);
/* The same; an error where it does not converge. */
PetscErrorCode BlocksSolve(Blocks *b, PetscReal tolerance, PetscInt *iterations);

#endif
