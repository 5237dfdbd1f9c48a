/*
  The cohesive law of the middle lamella at one point (docs/theory/lamella.md).

    delta = sqrt(<delta_n>^2 + beta^2 (delta_t^2 + delta_3^2))   equivalent opening; beta: strength in shear over that
  in tension T(delta)     envelope: stiffness k up to the strength sigma at delta_0 = sigma/k, then softening; its area
  is the energy G kappa        largest delta so far; below it the law is linear through the origin: T = omega k delta,
  with the integrity omega = T(kappa)/(k kappa) In mixed mode G depends on B, the share of shear in delta^2, by
  Benzeggagh and Kenane: G = G_n + (G_t - G_n) B^eta. B is that of the last accepted state, so that the energy of a step
  is a potential.

  Potential of a step from kappa_n, the work of T less what was dissipated before:
    phi = 1/2 omega k delta^2 + D(kappa) - D(kappa_n),    kappa = max(kappa_n, delta),
    D(kappa) = int_0^kappa T - 1/2 T(kappa) kappa         dissipated energy
  It is C1 in delta, and concave in q = delta^2: at fixed omega k its tangent is an upper bound, whose steps go down
  where those of Newton's method find points on the other side of the kink at kappa_n. A lamella that is undamaged at
  the start of the step resists compression as it does tension, by 1/2 k <-delta_n>^2, without damage: the law is then
  linear through zero. Damaged, it leaves compression to contact.

  References. Ortiz & Pandolfi, Int. J. Numer. Meth. Engng 44 (1999) 1267; Benzeggagh & Kenane, Compos. Sci. Technol. 56
  (1996) 439.
*/
#ifndef LAM_RVE_COHESIVE_H
#define LAM_RVE_COHESIVE_H

#include <lamella/cohesive.h>

/* The law of one point, factors included. A strength or an energy of 0: nothing holds. */
typedef struct {
  LamSoftening softening;
  PetscReal stiffness, strength, beta;
  PetscReal energy[2], mixing; /* in tension and shear; eta */
} LamCohesive;

/* Its envelope for one mode. */
typedef struct {
  LamSoftening softening;
  PetscReal stiffness, strength, energy;
  PetscReal onset; /* delta_0 */
  PetscReal range; /* bilinear: opening at which nothing holds; exponential: by which traction falls to 1/e */
} LamEnvelope;
LamEnvelope LamEnvelopeOf(const LamCohesive *law, PetscReal B);
/* T, and its derivative with respect to delta. */
PetscReal LamEnvelopeTraction(const LamEnvelope *envelope, PetscReal delta, PetscReal *slope);
/* omega of kappa, and its inverse, which is at least delta_0. */
PetscReal LamEnvelopeIntegrity(const LamEnvelope *envelope, PetscReal kappa);
PetscReal LamEnvelopeReach(const LamEnvelope *envelope, PetscReal integrity);
/* D, per reference area. */
PetscReal LamEnvelopeSpent(const LamEnvelope *envelope, PetscReal kappa);

/* The jump of a point in its frame: q = delta^2, with its derivatives in z = (jump, tangent), jump = x_slave -
   x_master, tangent that of the middle between both walls, of any length; the walls of the slave run along it with
   their outside to the right. */
typedef struct {
  PetscReal q, dq[4], ddq[4][4];
  PetscReal r, dr[4], ddr[4][4]; /* <-delta_n>^2, likewise */
  PetscReal normal, shear;       /* delta_n and delta_t */
  PetscReal axial;               /* delta_3, slip along the cells' axis, which is held; q contains beta^2 delta_3^2 */
} LamJump;
void LamJumpEvaluate(const PetscReal jump[2], const PetscReal tangent[2], PetscReal beta, LamJump *out);
/* B of a jump; `before` where there is none. */
PetscReal LamJumpMode(const LamJump *jump, PetscReal beta, PetscReal before);

/* phi as a function of q, its derivatives, and kappa after the step. */
typedef struct {
  PetscReal phi, d, dd, kappa;
} LamCohesiveStep;
void LamCohesiveStepEvaluate(const LamEnvelope *envelope, PetscReal kappa, PetscReal q, LamCohesiveStep *step);

#endif
