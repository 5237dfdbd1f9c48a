/*
  The third component of positions: prisms under any F (docs/theory/homogenisation.md, Out of the section).

  In the frame whose third axis is that of the cells, F_13 = F_23 = 0, and positions do not depend on X3 apart from
  F33 X3: x_3 = z(X1, X2) + F33 X3, with nodes z_a = z_class + G.S, G = (F_31, F_32). Volumes of lumens and gaps and
  contact, which slides freely along the cells, do not depend on z: only walls and the lamella do. All sums of the RVE
  hold z; the functions below are what they lack.
*/
#ifndef LAM_RVE_ANTIPLANE_H
#define LAM_RVE_ANTIPLANE_H

#include "rve_impl.h"

/* A direction or a gradient in the plane: components of F in the section, F33, positions [ndof]. */
typedef struct {
  PetscReal F[4], F33;
  const PetscReal *y;
} LamPlaneDirection;
typedef struct {
  PetscReal F[4], F33;
  PetscReal *y;
} LamPlaneGradient;

/* An element, or an edge of the lamella, and its derivatives: with respect to z and, mixed, to positions and F33. */
typedef struct {
  PetscInt count; /* of nodes: the first ones of the arrays are in use */
  PetscInt class[LAM_ELEMENT_NODES];
  PetscReal shift[LAM_ELEMENT_NODES][2];
  LamElementAxial d;
  PetscInt entry[LAM_ELEMENT_NODES * (LAM_ELEMENT_NODES + 1) / 2]; /* in values, of nodes a <= b; -1: prescribed */
} LamAxialPiece;

struct LamAntiplane_s {
  PetscInt classes, n; /* n: unknowns, those of classes 1, 2, ..., and one to make it even */
  PetscReal G[2], *z;  /* [class]; z of class 0 is 0 */
  PetscReal *f, LG[2]; /* [class] dL/dz, and dL/dG */
  PetscBool couples;   /* mixed derivatives are not all zero */
  PetscInt *row, *column;
  PetscReal *values; /* d2L/dz2 in upper compressed rows */
  LamFactor factor;  /* of it, where pieces that hang on nothing are held at one class; owned */
  PetscInt pieces;   /* elements, then edges of the lamella */
  LamAxialPiece *piece;
  LamPoints (*shear)[2]; /* [element] g at the points */
  PetscInt *root;        /* [class] work space */
};

PetscErrorCode LamAntiplaneCreate(LamRVE rve, LamAntiplane *antiplane);
PetscErrorCode LamAntiplaneDestroy(LamAntiplane *antiplane);
/* Third component of an image of a class, at G of a load. */
static inline PetscReal LamAxialPosition(const LamLoad *load, const PetscReal z[], PetscInt class, const PetscReal S[2])
{
  return z[class] + load->F[6] * S[0] + load->F[7] * S[1];
}
/* Sets G to that of a load, and z so that a node is there. */
void LamAntiplanePlace(LamRVE rve, const LamLoad *load, PetscInt node, PetscReal z);
/* Sets the shear of elements and the slip of the lamella to those of G and z. */
void LamAntiplaneUse(LamRVE rve);
/* Derivatives at rve->y, where residual and tangent have been assembled; factors d2L/dz2. *ok: it is positive
   definite. */
PetscErrorCode LamAntiplaneAssemble(LamRVE rve, const LamLoad *load, PetscBool *ok);
/* Second derivatives times a direction, added: from the plane to z and G, back, and from z and G to themselves. */
void LamAntiplaneFromPlane(LamRVE rve, const LamPlaneDirection *d, PetscReal z[], PetscReal G[2]);
void LamAntiplaneToPlane(LamRVE rve, const PetscReal z[], const PetscReal G[2], LamPlaneGradient *out);
void LamAntiplaneApply(LamRVE rve, const PetscReal z[], const PetscReal G[2], PetscReal out[], PetscReal outG[2]);
/*
  Solves S z = rhs [class], S = L_zz - L_zy K^-1 L_yz with the factor of the consistent tangent K: by conjugate
  gradients, preconditioned by L_zz. *ok: S is positive definite in the directions met.
*/
PetscErrorCode LamAntiplaneSolve(LamRVE rve, const PetscReal rhs[], PetscReal z[], PetscBool *ok);
/* y := K^-1 rhs for the positions of a gradient, [ndof] each; other right-hand sides are zero. */
PetscErrorCode LamAntiplaneRelax(LamRVE rve, const PetscReal rhs[], PetscReal y[]);

#endif
