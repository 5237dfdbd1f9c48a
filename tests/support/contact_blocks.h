/*
  Contact of two bodies with known answers: what the tests assert and the bench program prints.

  Patch: two blocks with non-matching distorted meshes, compressed between rollers, free to widen; the exact solution is
  one homogeneous deformation.

  Hertz: an elastic cylinder of radius 1 pressed on a rigid base of curvature k, plane strain (Johnson, Contact
  Mechanics, ch. 4), with the plane-strain modulus E' = E / (1 - nu^2) of small strain and R = 1 / (1 + k):
    p = p0 sqrt(1 - x^2/b^2),  p0^2 = P E' / (pi R),  b^2 = 4 P R / (pi E'),
  with the force P of the same solution, so that nothing need be known of the far field. What small-strain theory leaves
  out is of the order of the strain, b/R.
*/
#ifndef LAM_SUPPORT_CONTACT_BLOCKS_H
#define LAM_SUPPORT_CONTACT_BLOCKS_H

#include "blocks.h"
#include "random_reals.h"

PetscErrorCode PatchCreate(Blocks *b);
/* Largest differences, between elements of the deformation gradient and of P22, and of the multipliers to -P22. */
typedef struct {
  double gradient, stress, multiplier, pressure;
} PatchError;

PetscErrorCode ComputePatch(PatchError *error);

typedef struct {
  double force, peak, half_width;        /* P, p0 and b of the fit */
  double peak_theory, half_width_theory; /* from the force */
  PetscInt iterations, nodes;
} Hertz;

/* even: elements over 1.3 half-widths or so. */
PetscErrorCode ComputeHertz(int even, double curvature, Hertz *hertz);

#endif
