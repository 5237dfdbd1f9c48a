/*
  A tissue with known answers: records of a grid from a closed formula, differentiated twice by forward-mode
  differentiation in F11 F12 F21 F22 p g F33. With the symmetry of the hexagon, bonded or in contact.

    x_k = ln |F n_k|, n_k at orientation + 60 k degrees;   d = p - p0 (bonded), p - (s - g0) (contact), s = p + g
    bonded   Psi = Phi(x) + d T(x) + d^2 W(x) / 2 - p J
    contact  Psi = Phi(x - a(s), s) + d T + d^2 W / 2 + g J; nothing but E(s) + d T(s) + .. where all x_k >= a(s)
  axial: a, E, T and W depend on F33, too, and P33 is the derivative of Psi; otherwise P33 is a function of its own.
*/
#ifndef LAM_SUPPORT_ANALYTIC_TISSUE_H
#define LAM_SUPPORT_ANALYTIC_TISSUE_H

#include <math.h>
#include <string.h>
#include <lamella/database.h>

#define TISSUE_P0 0.3      /* turgor of bonded nodes: middle of the sample box */
#define TISSUE_G0 0.1      /* cohesion of contact nodes */
#define TISSUE_SUCTION 0.8 /* the largest */
typedef struct {
  PetscBool contact;
  double orientation;
  PetscBool axial;
} AnalyticTissue;

LamResponse TissueAnswer(const AnalyticTissue *tissue, const LamLoad *load);
/* A responder's. Cells that are drawn apart alike in all directions float where they do not touch. */
PetscErrorCode TissueRespond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                             LamResponse responses[]);

#endif
