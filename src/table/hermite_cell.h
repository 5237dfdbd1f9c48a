/*
  Interpolation of a function of three variables on a cube from data at its eight corners.

  Method
    Tensor product of cubic Hermite polynomials. Where the pure second derivative at an end of an edge is known too,
    bubbles raise the cubic along the edge to a quintic:
      h^2 (d0 q0(t_k) + d1 q1(t_k)) V_i(t_p) V_j(t_q),   q0 = t^2 (1-t)^3 / 2,   q1 = t^3 (1-t)^2 / 2,
    d = known second derivative minus that of the cubic, V the value functions 1-3t^2+2t^3 and 3t^2-2t^3. Value and
    gradient are continuous across faces, edges and corners for any choice of bubbles. At corners the Hessian is exact.
    docs/theory/database.md, Cells and nodes.
*/
#ifndef LAM_HERMITE_CELL_H
#define LAM_HERMITE_CELL_H

#include <petscsys.h>

/* Value, gradient, Hessian (11 22 33 23 13 12) and the mixed third derivative 123. */
typedef struct {
  PetscReal value, gradient[3], hessian[6], third;
} LamJet;

/*
  Adds to *sum the function (without its third derivative) at t in [0, 1]^3. corner[c]: bit k of c is the end of
  direction k (0: t_k = 0). NaN as a corner's pure second derivative: unknown, no bubble at that end. h: edge of the
  cube.
*/
void LamHermiteQuintic(const LamJet corner[8], PetscReal h, const PetscReal t[3], LamJet *sum);
/* The same without Hessian; its value alone. */
void LamHermiteQuinticSlope(const LamJet corner[8], PetscReal h, const PetscReal t[3], LamJet *sum);
PetscReal LamHermiteQuinticValue(const LamJet corner[8], PetscReal h, const PetscReal t[3]);
/* The first without bubbles. */
void LamHermiteCubic(const LamJet corner[8], PetscReal h, const PetscReal t[3], LamJet *sum);
/*
  Of the four edges of each direction k, in units of a slope: h times the known second derivative at an end minus that
  of the cubic. bend[k]: root mean square over the ends; spread[k]: standard deviation. The bubbles reproduce a common
  value of all ends (a constant fourth derivative), so the error goes with the spread.
*/
void LamHermiteSizes(const LamJet corner[8], PetscReal h, PetscReal bend[3], PetscReal spread[3]);
/*
  Interpolates from values and gradients alone, to third order: cubic along the edges, linear between them
  (transfinite), so that no mixed derivatives are needed. Continuous, not C1. Writes value and gradient.
*/
void LamHermiteEdges(const LamJet corner[8], PetscReal h, const PetscReal t[3], PetscReal *value,
                     PetscReal gradient[3]);

#endif
