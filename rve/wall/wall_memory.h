/*
  Walls with memory: finite linear viscoelasticity with a Prony series on the stress (Simo, Comput. Methods Appl. Mech.
  Engng 60 (1987) 153-173; Simo & Hughes, Computational Inelasticity, 10.3).

  With S_e = 2 dW/dC the second Piola-Kirchhoff stress of matrix and fibres, whose moduli are the instantaneous ones,
  and S_U that of U, which has no memory,

    S(t) = S_U + int_0^t G(t - s) dS_e/ds ds,    G(t) = g_inf + sum_i g_i exp(-t/tau_i),    g_inf = 1 - sum_i g_i.

  The springs of the Maxwell elements have the stresses H_i' + H_i/tau_i = g_i S_e'. With S_e straight in a step of
  duration dt, x = dt/tau and phi = (1 - exp(-x))/x, exactly

    H_i <- exp(-x_i) H_i + g_i phi_i dS_e,    S = S_U + scale S_e + history,    scale = g_inf + sum_i g_i phi_i,

  where `history` is constant in the step. So the step has one potential, W times `scale` plus history : E, with the
  Green-Lagrange strain E = (C - 1)/2.

  Energies. The strains of the springs are taken as E_i' + E_i/tau_i = E'. What the dashpots dissipate is int H_i : E_i
  dt/tau_i, and the rest of the work int S_e : dE + sum_i int (H_i - g_i S_e) : dE is stored: that of the springs of the
  generalised Maxwell model where W is quadratic (docs/theory/walls.md, Walls with memory).

  Components 11, 12, 22, 33 at Gauss points; stresses of the past in the C1 + C2 of the wall, with which they change.
*/
#ifndef LAM_RVE_WALL_MEMORY_H
#define LAM_RVE_WALL_MEMORY_H

#include "element.h"
#include "relaxation.h"

enum { LAM_MEMORY_COMPONENTS = 4 };
/* Stress and strain at the Gauss points of an element: S_e and E, or H_i and E_i. */
typedef struct {
  PetscReal S[LAM_MEMORY_COMPONENTS][LAM_GAUSS], E[LAM_MEMORY_COMPONENTS][LAM_GAUSS];
} LamMemoryPair;

/* S_e over `unit` and E of positions u, and the energy of matrix and fibres, which is returned. */
PetscReal LamElementElastic(const LamElementGeometry *geometry, const LamWallLaw *law, const LamWall *wall,
                            const PetscReal u[][2], PetscReal F33, PetscReal unit, LamMemoryPair *now);

/* past [1 + terms]: S_e and E at the start of the step, then H_i and E_i. Stresses of the past are multiplied by
   `unit`. */
void LamMemoryHistory(const LamMemoryStep *step, const LamMemoryPair past[], PetscReal unit,
                      LamPoints history[LAM_MEMORY_COMPONENTS]);
/* Integrals over the element of what the step adds: `retarded` sum_i int (H_i - g_i S_e) : dE, and `dissipated`; and of
   history : E at its end. */
typedef struct {
  PetscReal retarded, dissipated, history;
} LamMemoryWork;
/* next [1 + terms]: the past of the next step, from `now` at the end of this one; `now` is copied to the first. */
void LamMemoryAdvance(const LamMemoryStep *step, const LamElementGeometry *geometry, const LamMemoryPair past[],
                      const LamMemoryPair *now, PetscReal unit, LamMemoryPair next[], LamMemoryWork *work);

#endif
