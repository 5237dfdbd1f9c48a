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
  if (integrity <= 0.0) return e->softening == LAM_SOFTENING_BILINEAR ? e->range : PETSC_INFINITY;
  if (e->softening == LAM_SOFTENING_BILINEAR)
    return e->onset * e->range / (e->onset + integrity * (e->range - e->onset));
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

/* v^2/m with m = tangent.tangent, and its derivatives in (jump, tangent). */
typedef struct {
  PetscReal value, d[4], dd[4][4];
} Square;

/* v is bilinear: dv, and cross of jump [i] and tangent [j]. */
static void SquareOf(PetscReal v, const PetscReal dv[4], const PetscReal cross[2][2], const PetscReal tangent[2],
                     Square *out)
{
  const PetscReal m = tangent[0] * tangent[0] + tangent[1] * tangent[1], r = v / m;
  const PetscReal g[4] = {dv[0], dv[1], dv[2] - 2.0 * r * tangent[0], dv[3] - 2.0 * r * tangent[1]}; /* m dr */

  out->value = v * r;
  for (PetscInt i = 0; i < 4; ++i) {
    out->d[i] = r * (dv[i] + g[i]);
    for (PetscInt j = 0; j < 4; ++j) out->dd[i][j] = 2.0 / m * g[i] * g[j];
  }
  for (PetscInt i = 0; i < 2; ++i) {
    out->dd[2 + i][2 + i] -= 2.0 * r * r;
    for (PetscInt j = 0; j < 2; ++j) {
      out->dd[i][2 + j] += 2.0 * r * cross[i][j];
      out->dd[2 + j][i] += 2.0 * r * cross[i][j];
    }
  }
}

void LamJumpEvaluate(const PetscReal jump[2], const PetscReal tangent[2], PetscReal beta, LamJump *out)
{
  /* delta_n^2 = c^2/m and delta_t^2 = p^2/m, c = tangent x jump and p = tangent.jump: a sum of squares, in which small
     openings keep their digits beside large slips */
  static const PetscReal of_c[2][2] = {{0.0, -1.0}, {1.0, 0.0}}, of_p[2][2] = {{1.0, 0.0}, {0.0, 1.0}};
  const PetscReal dc[4] = {-tangent[1], tangent[0], jump[1], -jump[0]};
  const PetscReal dp[4] = {tangent[0], tangent[1], jump[0], jump[1]};
  const PetscReal c = tangent[0] * jump[1] - tangent[1] * jump[0], p = tangent[0] * jump[0] + tangent[1] * jump[1];
  const PetscReal length = PetscSqrtReal(tangent[0] * tangent[0] + tangent[1] * tangent[1]);
  const PetscReal open = c >= 0.0 ? 1.0 : 0.0, pressed = 1.0 - open, weight = beta * beta;
  Square n, t;

  SquareOf(c, dc, of_c, tangent, &n);
  SquareOf(p, dp, of_p, tangent, &t);
  out->normal = c / length;
  out->shear = p / length;
  out->axial = 0.0;
  out->q = open * n.value + weight * t.value;
  out->r = pressed * n.value;
  for (PetscInt i = 0; i < 4; ++i) {
    out->dq[i] = open * n.d[i] + weight * t.d[i];
    out->dr[i] = pressed * n.d[i];
    for (PetscInt j = 0; j < 4; ++j) {
      out->ddq[i][j] = open * n.dd[i][j] + weight * t.dd[i][j];
      out->ddr[i][j] = pressed * n.dd[i][j];
    }
  }
}

PetscReal LamJumpMode(const LamJump *jump, PetscReal beta, PetscReal before)
{
  const PetscReal slip = jump->shear * jump->shear + jump->axial * jump->axial;

  return jump->q > 0.0 ? PetscMin(1.0, beta * beta * slip / jump->q) : before;
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
