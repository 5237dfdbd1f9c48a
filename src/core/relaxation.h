/*
  A step of a Prony series. With e(t) an elastic quantity, straight in a step of duration dt, x = dt/tau_i and phi_i =
  (1 - exp(-x))/x, the quantity with memory is exactly

    q(t) = int_0^t G(t - s) de/ds ds = scale e(t) + sum_i (decay_i h_i - share_i phi_i e) at the start of the step,
    h_i <- decay_i h_i + share_i phi_i de,      scale = 1 - sum_i share_i (1 - phi_i),      decay_i = exp(-x),

  with G(t) = 1 - sum_i share_i (1 - exp(-t/tau_i)) (Simo, Comput. Methods Appl. Mech. Engng 60 (1987) 153-173).
*/
#ifndef LAM_RELAXATION_H
#define LAM_RELAXATION_H

#include <lamella/wall.h>

typedef struct {
  PetscInt terms;
  PetscReal scale;
  PetscReal share[LAM_RELAXATION_TERMS], decay[LAM_RELAXATION_TERMS], phi[LAM_RELAXATION_TERMS];
  PetscReal psi[LAM_RELAXATION_TERMS];     /* (1 - phi)/x */
  PetscReal loss[LAM_RELAXATION_TERMS][3]; /* integrals over s in [0, x] of e^2, e f, f^2, e = exp(-s), f = (1 - e)/x */
} LamMemoryStep;
/* duration: from 0 (the instantaneous response) to infinite (the long-term one). */
LamMemoryStep LamMemoryStepOf(const LamRelaxation *relaxation, PetscReal duration);

#endif
