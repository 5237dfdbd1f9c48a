/*
  Tissue with walls that have a memory, from its elastic responses Psi_e(F, p, g).

  Method. Where strains are small the equations of equilibrium are linear in the walls' stress, turgor p and cohesion g,
  and all of them convolve alike: the positions are those of elastic tissue under p_e and g_e, of which p and g are the
  convolutions (correspondence principle). Where they are not small, quantities of the reference convolve: the mean
  stress of the walls, without that of the fluids in lumens and gaps, and J times the pressures, the force on the ratio
  of a lumen to the tissue's volume. With the Prony series G of the walls, l = p and g, V_l = dPsi_e/dl (minus the
  lumens, and the gaps) and B = F^-T,

    S_e = F^-1 (P_e - sum_l V_l l_e B),   S = int G(t - s) dS_e/ds ds,   J l = int G(t - s) d(J l_e)/ds ds,
    P = F S + sum_l V_l l B.

  In a step (relaxation.h) of scale c: S = c S_e + S_0, J l = c J l_e + q_l, with S_0 and q_l constant in it. So with
  l_0 = q_l/J and l_e = (l - l_0)/c it has one potential,

    Psi = c Psi_e(F, p_e, g_e) + S_0 : (F^T F - 1)/2,      P = c P_e + U B + F S_0,      U = sum_l l_0 V_l,
    A = c A_e + sum_l l_0 (P_l x B + B x P_l) + (sum_lm l_0 m_0 Psi_lm/c - U) B x B + U dB/dF + delta_ik S_0,LJ,
    Psi_l = Psi_e,l = V_l,   Psi_lm = Psi_e,lm/c,   dP/dl = P_l + sum_m m_0 Psi_lm/c B.

  At once c = 1; for ever c = g_inf, and S_0 and q_l vanish: P = g_inf P_e(F, p/g_inf, g/g_inf), tissue whose walls have
  g_inf of their moduli. Both limits are exact at finite strain, but for volume changes of the walls.

  References: Simo, Comput. Methods Appl. Mech. Engng 60 (1987) 153-173; Schapery, Int. J. Fract. 25 (1984) 195-223
  (correspondence principles).
*/
#include "relaxation.h"
#include <lamella/ellipticity.h>
#include <lamella/relaxing.h>
#include <stddef.h>
#include <string.h>

enum { TURGOR, COHESION, LOADS };
/* What convolves: S_e, J p_e and J g_e, tractions and tensions. */
enum { STRESS = 0, PRESSURES = 9, INDICATORS = PRESSURES + LOADS, COUNT = INDICATORS + 1 + 1 + 3 + 1 + 3 };

typedef struct {
  size_t offset; /* in LamResponse */
  PetscInt count;
} Indicator;
static const Indicator indicators[] = {{offsetof(LamResponse, max_traction), 1},
                                       {offsetof(LamResponse, max_lamella_shear), 1},
                                       {offsetof(LamResponse, mean_face_traction), 3},
                                       {offsetof(LamResponse, max_wall_tension), 1},
                                       {offsetof(LamResponse, mean_wall_tension), 3}};

/* Of a material point: the elastic quantities, and h_i of each. */
typedef struct {
  PetscReal elastic[COUNT], spring[LAM_RELAXATION_TERMS][COUNT];
} Past;

typedef struct {
  LamResponder elastic; /* borrowed */
  LamRelaxation relaxation;
  LamResponderCounters counters; /* of `elastic` */
  PetscInt points;
  Past *now, *accepted; /* [points] */
} Relaxing;

/* A query: its step, the past at its start, what is constant in the step; J and B. */
typedef struct {
  LamMemoryStep step;
  Past past;
  PetscReal rest[COUNT];
  PetscReal J, B[9];
} Question;

/* Cramer's rule. */
static void SetInverse(const PetscReal F[9], Question *q)
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const int a = 3 * ((i + 1) % 3), b = 3 * ((i + 2) % 3), c = (j + 1) % 3, d = (j + 2) % 3;

      q->B[3 * i + j] = F[a + c] * F[b + d] - F[a + d] * F[b + c];
    }
  q->J = F[0] * q->B[0] + F[1] * q->B[1] + F[2] * q->B[2];
  for (int n = 0; n < 9; n++) q->B[n] /= q->J;
}

static Question Begin(const Relaxing *r, const LamLoad *load, const Past *past)
{
  Question q = {.step = LamMemoryStepOf(&r->relaxation, load->duration)};

  if (past) q.past = *past;
  for (PetscInt k = 0; k < COUNT; k++)
    for (PetscInt i = 0; i < q.step.terms; i++)
      q.rest[k] += q.step.decay[i] * q.past.spring[i][k] - q.step.share[i] * q.step.phi[i] * q.past.elastic[k];
  SetInverse(load->F, &q);
  return q;
}

static LamLoad ElasticLoad(const Question *q, const LamLoad *load)
{
  LamLoad elastic = *load;

  elastic.turgor = (load->turgor - q->rest[PRESSURES + TURGOR] / q->J) / q->step.scale;
  elastic.cohesion = (load->cohesion - q->rest[PRESSURES + COHESION] / q->J) / q->step.scale;
  elastic.duration = 0;
  return elastic;
}

/* The past of the next step, from the elastic response at the end of this one. */
static void Advance(const Question *q, const LamResponse *e, Past *next)
{
  const PetscReal load[LOADS] = {e->load.turgor, e->load.cohesion};
  const PetscReal fluids = e->energy_turgor * load[TURGOR] + e->energy_cohesion * load[COHESION];
  PetscReal *now = next->elastic;
  PetscInt k = INDICATORS;

  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int n = 0; n < 3; n++) /* F^-1_in = B_ni */
        now[STRESS + 3 * i + j] += q->B[3 * n + i] * (e->P[3 * n + j] - fluids * q->B[3 * n + j]);
  for (int l = 0; l < LOADS; l++) now[PRESSURES + l] = q->J * load[l];
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(indicators); i++) {
    const PetscReal *value = (const PetscReal *)((const char *)e + indicators[i].offset);

    for (PetscInt m = 0; m < indicators[i].count; m++, k++) /* unknown: as it was */
      now[k] = PetscIsNanReal(value[m]) ? q->past.elastic[k] : value[m];
  }
  for (PetscInt i = 0; i < q->step.terms; i++)
    for (k = 0; k < COUNT; k++)
      next->spring[i][k] =
          q->step.decay[i] * q->past.spring[i][k] + q->step.share[i] * q->step.phi[i] * (now[k] - q->past.elastic[k]);
}

/* Adds A's terms beside c A_e. slope: dP_e/dl; l0: l_0. */
static void AddTangent(const Question *q, const LamResponse *e, const PetscReal l0[LOADS], PetscReal fluids,
                       PetscReal A[81])
{
  const PetscReal *B = q->B, *S = &q->rest[STRESS];
  const PetscReal square =
      (l0[TURGOR] * (l0[TURGOR] * e->energy_turgor2 + 2 * l0[COHESION] * e->energy_turgor_cohesion) +
       l0[COHESION] * l0[COHESION] * e->energy_cohesion2) /
          q->step.scale -
      fluids;
  PetscReal slope[9];

  for (int n = 0; n < 9; n++) slope[n] = l0[TURGOR] * e->P_turgor[n] + l0[COHESION] * e->P_cohesion[n];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) {
          const int ij = 3 * i + j, kl = 3 * k + l;

          A[9 * ij + kl] += slope[ij] * B[kl] + B[ij] * slope[kl] + square * B[ij] * B[kl] -
                            fluids * B[3 * i + l] * B[3 * k + j] + (i == k ? S[3 * l + j] : 0);
        }
}

/* r: from the elastic response to that of the step. */
static void Relax(const Question *q, const LamLoad *load, LamResponse *r)
{
  const PetscReal c = q->step.scale, *S = &q->rest[STRESS], *F = load->F;
  const PetscReal l0[LOADS] = {q->rest[PRESSURES + TURGOR] / q->J, q->rest[PRESSURES + COHESION] / q->J};
  const PetscReal fluids = l0[TURGOR] * r->energy_turgor + l0[COHESION] * r->energy_cohesion;
  const PetscReal by_turgor = (l0[TURGOR] * r->energy_turgor2 + l0[COHESION] * r->energy_turgor_cohesion) / c;
  const PetscReal by_cohesion = (l0[TURGOR] * r->energy_turgor_cohesion + l0[COHESION] * r->energy_cohesion2) / c;
  PetscInt k = INDICATORS;

  for (int n = 0; n < 81; n++) r->tangent[n] *= c;
  AddTangent(q, r, l0, fluids, r->tangent);
  r->energy *= c;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const int ij = 3 * i + j;
      PetscReal strain = i == j ? -0.5 : 0.0, history = 0.0;

      for (int n = 0; n < 3; n++) {
        history += F[3 * i + n] * S[3 * n + j];
        strain += 0.5 * F[3 * n + i] * F[3 * n + j];
      }
      r->P[ij] = c * r->P[ij] + fluids * q->B[ij] + history;
      r->P_turgor[ij] += by_turgor * q->B[ij];
      r->P_cohesion[ij] += by_cohesion * q->B[ij];
      r->energy += S[ij] * strain;
    }
  r->energy_turgor2 /= c;
  r->energy_cohesion2 /= c;
  r->energy_turgor_cohesion /= c;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(indicators); i++)
    for (PetscInt m = 0; m < indicators[i].count; m++, k++) {
      PetscReal *value = (PetscReal *)((char *)r + indicators[i].offset) + m;

      *value = c * *value + q->rest[k];
    }
  if (!PetscIsNanReal(r->ellipticity)) LamResponseFindBand(r);
  r->turgor_mean = load->turgor;
}

static PetscErrorCode Respond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                              LamResponse responses[])
{
  Relaxing *r = (Relaxing *)ctx;
  Question *questions;
  LamLoad *queries;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &questions, n, &queries));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt point = points ? points[i] : -1;

    questions[i] = Begin(r, &loads[i], point < 0 ? NULL : &r->accepted[point]);
    queries[i] = ElasticLoad(&questions[i], &loads[i]);
  }
  PetscCall(LamResponderRespond(r->elastic, n, queries, points, responses));
  for (PetscInt i = 0; i < n; i++) {
    Past next = {.elastic = {0}};

    if (LamResponseHasFields(&responses[i])) {
      Advance(&questions[i], &responses[i], &next);
      Relax(&questions[i], &loads[i], &responses[i]);
      if (points && points[i] >= 0) r->now[points[i]] = next;
    }
    responses[i].load = loads[i];
  }
  PetscCall(PetscFree2(questions, queries));
  r->counters = LamResponderGetCounters(r->elastic);
  PetscFunctionReturn(0);
}

static PetscErrorCode Accept(void *ctx)
{
  Relaxing *r = (Relaxing *)ctx;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(r->accepted, r->now, r->points));
  PetscCall(LamResponderAccept(r->elastic));
  PetscFunctionReturn(0);
}

static PetscErrorCode Reject(void *ctx)
{
  Relaxing *r = (Relaxing *)ctx;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(r->now, r->accepted, r->points));
  PetscCall(LamResponderReject(r->elastic));
  PetscFunctionReturn(0);
}

/* Saved: the past of a point, in front of the bytes of `elastic`. */
static PetscErrorCode StateSize(void *ctx, size_t *bytes)
{
  Relaxing *r = (Relaxing *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamResponderGetStateSize(r->elastic, bytes));
  *bytes += sizeof(Past);
  PetscFunctionReturn(0);
}

static PetscErrorCode Save(void *ctx, PetscInt point, void *bytes)
{
  Relaxing *r = (Relaxing *)ctx;

  PetscFunctionBeginUser;
  memcpy(bytes, &r->accepted[point], sizeof(Past));
  PetscCall(LamResponderSave(r->elastic, point, (char *)bytes + sizeof(Past)));
  PetscFunctionReturn(0);
}

static PetscErrorCode Load(void *ctx, PetscInt point, const void *bytes)
{
  Relaxing *r = (Relaxing *)ctx;

  PetscFunctionBeginUser;
  memcpy(&r->accepted[point], bytes, sizeof(Past));
  r->now[point] = r->accepted[point];
  PetscCall(LamResponderLoad(r->elastic, point, (const char *)bytes + sizeof(Past)));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **ctx)
{
  Relaxing *r = (Relaxing *)*ctx;

  PetscFunctionBeginUser;
  PetscCall(PetscFree2(r->now, r->accepted));
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRelaxingResponderCreate(LamResponder elastic, const LamRelaxation *relaxation, PetscInt points,
                                          LamResponder *responder)
{
  static const LamResponderFunctions functions = {.respond = Respond,
                                                  .accept = Accept,
                                                  .reject = Reject,
                                                  .destroy = Destroy,
                                                  .state_size = StateSize,
                                                  .save = Save,
                                                  .load = Load};
  Relaxing *r;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&r));
  *r = (Relaxing){.elastic = elastic, .relaxation = *relaxation, .points = points};
  PetscCall(PetscCalloc2(points, &r->now, points, &r->accepted));
  PetscCall(LamResponderCreate(&functions, r, &r->counters, responder));
  PetscFunctionReturn(0);
}
