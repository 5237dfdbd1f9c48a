#include "cohesive.h"
#include <math.h>

LamEnvelope LamEnvelopeOf(const LamCohesive *law, PetscReal B)
{
  LamEnvelope e = {.softening = law->softening, .stiffness = law->stiffness, .strength = law->strength};

  e.energy = law->energy[0];
  if (law->energy[1] != law->energy[0] && B > 0.0)
    e.energy += (law->energy[1] - law->energy[0]) * PetscPowReal(B, law->mixing);
  if (!(e.strength > 0.0 && e.energy > 0.0)) {
    e.strength = e.energy = 0.0;
    return e;
  }
  e.onset = e.strength / e.stiffness;
  e.range = 2.0 * e.energy / e.strength;
  if (e.softening == LAM_SOFTENING_EXPONENTIAL) e.range = 0.5 * (e.range - e.onset);
  return e;
}

PetscReal LamEnvelopeTraction(const LamEnvelope *e, PetscReal delta, PetscReal *slope)
{
  if (e->strength == 0.0) return *slope = 0.0;
  *slope = e->stiffness;
  if (delta <= e->onset) return e->stiffness * delta;
  if (e->softening == LAM_SOFTENING_EXPONENTIAL) {
    const PetscReal T = e->strength * PetscExpReal((e->onset - delta) / e->range);

    *slope = -T / e->range;
    return T;
  }
  *slope = delta < e->range ? -e->strength / (e->range - e->onset) : 0.0;
  return delta < e->range ? e->strength * (e->range - delta) / (e->range - e->onset) : 0.0;
}

PetscReal LamEnvelopeIntegrity(const LamEnvelope *e, PetscReal kappa)
{
  PetscReal slope;

  if (e->strength == 0.0) return 0.0;
  return kappa <= e->onset ? 1.0 : LamEnvelopeTraction(e, kappa, &slope) / (e->stiffness * kappa);
}

PetscReal LamEnvelopeReach(const LamEnvelope *e, PetscReal integrity)
{
  PetscReal x, c;

  if (integrity >= 1.0 || e->strength == 0.0) return e->onset;
  if (e->softening == LAM_SOFTENING_BILINEAR)
    return e->onset * e->range / (e->onset + integrity * (e->range - e->onset));
  if (integrity <= 0.0) return PETSC_INFINITY;
  /* omega kappa = delta_0 exp(-(kappa - delta_0)/range): x + log x = c for x = kappa/range, by Newton's method, which
     converges from below for this concave function */
  c = PetscLogReal(e->onset / (e->range * integrity)) + e->onset / e->range;
  x = c > 1.0 ? c - PetscLogReal(c) : PetscExpReal(c - 1.0);
  for (PetscInt k = 0; k < 60; ++k) {
    const PetscReal step = (c - x - PetscLogReal(x)) * x / (1.0 + x);

    x += step;
    if (PetscAbsReal(step) <= 2.0 * PETSC_MACHINE_EPSILON * x) break;
  }
  return PetscMax(e->onset, x * e->range);
}

PetscReal LamEnvelopeSpent(const LamEnvelope *e, PetscReal kappa)
{
  PetscReal T, slope;

  if (kappa <= e->onset || e->strength == 0.0) return 0.0;
  if (PetscIsInfReal(kappa)) return e->energy;
  T = LamEnvelopeTraction(e, kappa, &slope);
  if (e->softening == LAM_SOFTENING_BILINEAR) return 0.5 * (e->strength * PetscMin(kappa, e->range) - T * e->onset);
  return 0.5 * e->strength * e->onset + e->range * (e->strength - T) - 0.5 * T * kappa;
}

/* whole jump.jump + shear delta_t^2 with delta_t^2 = p^2/m, p = jump.tangent and m = tangent.tangent, and its
   derivatives in (jump, tangent). */
static PetscReal Form(const PetscReal jump[2], const PetscReal tangent[2], PetscReal whole, PetscReal shear,
                      PetscReal d[4], PetscReal dd[4][4])
{
  const PetscReal m = tangent[0] * tangent[0] + tangent[1] * tangent[1];
  const PetscReal p = jump[0] * tangent[0] + jump[1] * tangent[1];

  for (PetscInt i = 0; i < 2; ++i) {
    d[i] = 2.0 * (whole * jump[i] + shear * p / m * tangent[i]);
    d[2 + i] = 2.0 * shear * p / m * (jump[i] - p / m * tangent[i]);
    for (PetscInt j = 0; j < 2; ++j) {
      const PetscReal one = i == j ? 1.0 : 0.0, tt = tangent[i] * tangent[j];

      dd[i][j] = 2.0 * (whole * one + shear * tt / m);
      dd[i][2 + j] = 2.0 * shear / m * (tangent[i] * jump[j] + p * one - 2.0 * p / m * tt);
      dd[2 + j][i] = dd[i][2 + j];
      dd[2 + i][2 + j] = 2.0 * shear / m *
                         (jump[i] * jump[j] - p / m * (2.0 * (jump[i] * tangent[j] + tangent[i] * jump[j]) + p * one) +
                          4.0 * p * p / (m * m) * tt);
    }
  }
  return whole * (jump[0] * jump[0] + jump[1] * jump[1]) + shear * p * p / m;
}

void LamJumpEvaluate(const PetscReal jump[2], const PetscReal tangent[2], PetscReal beta, LamJump *out)
{
  const PetscReal length = PetscSqrtReal(tangent[0] * tangent[0] + tangent[1] * tangent[1]);
  PetscReal open, pressed;

  out->normal = (tangent[0] * jump[1] - tangent[1] * jump[0]) / length;
  out->shear = (tangent[0] * jump[0] + tangent[1] * jump[1]) / length;
  open = out->normal >= 0.0 ? 1.0 : 0.0;
  pressed = 1.0 - open;
  out->q = Form(jump, tangent, open, beta * beta - open, out->dq, out->ddq);
  out->r = Form(jump, tangent, pressed, -pressed, out->dr, out->ddr);
}

PetscReal LamJumpMode(const LamJump *jump, PetscReal beta, PetscReal before)
{
  return jump->q > 0.0 ? PetscMin(1.0, beta * beta * jump->shear * jump->shear / jump->q) : before;
}

void LamCohesiveStepEvaluate(const LamEnvelope *e, PetscReal kappa, PetscReal q, LamCohesiveStep *step)
{
  const PetscReal delta = PetscSqrtReal(q);
  PetscReal T, slope;

  if (delta <= kappa) {
    const PetscReal secant = LamEnvelopeIntegrity(e, kappa) * e->stiffness;

    *step = (LamCohesiveStep){.phi = 0.5 * secant * q, .d = 0.5 * secant, .kappa = kappa};
    return;
  }
  T = LamEnvelopeTraction(e, delta, &slope);
  *step = (LamCohesiveStep){.phi = 0.5 * T * delta + LamEnvelopeSpent(e, delta) - LamEnvelopeSpent(e, kappa),
                            .d = 0.5 * T / delta,
                            .dd = (slope - T / delta) / (4.0 * q),
                            .kappa = delta};
}
