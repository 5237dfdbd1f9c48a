/*
  Queries to the records outside the grid.

  Method
    Partition of unity of the second-order Taylor models T_k of the records' potential (expansion.h) and of their images
    under the symmetry of the lattice. The stress is the exact gradient of the returned energy and the tangent its
    exact, symmetric Hessian. With the distance d_k (a strain) from the query to record k, and a reach R,
      Phi = sum_k w_k T_k / sum_k w_k,   w_k = max(0, 1/d_k^2 - 1/R^2)^3:
    Shepard's weights with a compact support (Franke and Little). They are C2 where a model comes into reach, and so
    steep at a record that the blend has the record's value, gradient and Hessian there. R is twice the radius within
    which a record must lie for a response.

  Algorithm
    Phi = T_1 + sum w_k (T_k - T_1) / sum w_k, with T_1 the nearest model. Otherwise the weights' steep derivatives near
    a record would amplify rounding errors. With A, W the two sums and e = A / W:
      e_a  = A_a / W - e W_a / W,   e_ab = A_ab / W - e_a W_b / W - W_a e_b / W - e W_ab / W.

  Estimate of the error of P, root of the sum of two squares: the models' spread, (sum w_k |P_k - P|^2 / sum w_k)^1/2,
  and, since a single model has no spread, the error of one model at this distance times the square of the nearest
  model's share of the weights. Measurements: docs/results/performance.md.

  Records of another F33 do not blend: it is no variable of the models of a blend. That of a single record, which a
  material point holds, has it to second order.

  Only records that are converged, stable, of branch 0 and without floating cells are blended. A record of another
  branch or with floating cells serves its own state only; the model of one of another branch also serves the material
  points that hold it (scatter_model.h). Such records and failed ones forbid a blend unless they are much farther away
  than the nearest record that blends: between them the potential has a kink that no model contains. In contact a
  record whose tangent is not elliptic serves its own state only, and forbids nothing (LAM_SCATTER_KINK).

  References: Shepard, Proc. 23rd ACM National Conference (1968) 517; Franke and Nielson, Int. J. Numer. Meth. Engng 15
  (1980) 1691.
*/
#include "database_internal.h"
#include "scatter_model.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Relative error of P of a single model, divided by the square of the distance: the 99 % level in bonded tissue, the
   95 % level in contact tissue, whose walls separate between two states. */
#define BONDED_ERROR 12.8
#define CONTACT_ERROR 100.0
/* Factor on the models' spread: models on one side of a state where walls separate agree with each other. */
#define CONTACT_DOUBT 3.0
/* Reach of the blend, in trust radii. */
#define REACH 2
/* A record that does not blend forbids blends within this many times the distance of the nearest record that does. */
#define DOUBT 2

/* ---- the blend ---- */

/* A record's model at the query, in the query's frame, but with its Hessian in the record's frame. */
static void EvaluateModel(const LamScatterSearch *search, const LamScattered *state, PetscInt image,
                          LamScatterVector delta, LamExpansion *m)
{
  const LamImages *images = &search->db->images;
  const LamExpansion *e = &state->model;

  for (int a = 0; a < LAM_VARIABLES; a++) delta[a] = search->turned[image][a] - e->x[a];
  LamExpansionMove(e, search->turned[image], m);
  memcpy(m->x, search->x, sizeof(m->x));
  LamImagesBack(images, image, m->gradient);
  LamImagesBack(images, image, m->P33_gradient);
  LamImagesBack(images, image, delta);
}

/* w = u^3, u = 1/d^2 - 1/R^2, with its derivatives. */
typedef struct {
  PetscReal value;
  LamScatterVector gradient;
  PetscReal outer, metric; /* its Hessian is outer v v^T + metric M, v = M delta */
  LamScatterVector v;
} Weight;

static PetscBool MakeWeight(const LamScatterMetric *metric, const LamScatterVector delta, PetscReal reach, Weight *w)
{
  const PetscReal d2 = LamScatterApply(metric, delta, w->v), u = 1 / d2 - 1 / (reach * reach), d4 = d2 * d2;

  if (!(u > 0)) return PETSC_FALSE;
  w->value = u * u * u;
  for (int a = 0; a < LAM_VARIABLES; a++) w->gradient[a] = -6 * u * u / d4 * w->v[a];
  w->outer = 24 * u / (d4 * d4) + 24 * u * u / (d4 * d2);
  w->metric = -6 * u * u / d4;
  return PETSC_TRUE;
}

/* Sums over the models in reach: of the weights, and of the weights times a model's difference from the first. */
typedef struct {
  LamExpansion first;
  PetscReal W, W_metric, A, A_metric, P33, A3333; /* _metric: the part of the Hessian along the metric */
  LamScatterVector W_slope, A_slope, P33_slope;
  LamScatterMatrix W_hessian, A_hessian;
  LamScatterMatrix own_hessian[LAM_MAX_IMAGES];    /* of the records' Hessians, each image in its own frame */
  PetscReal P33_square, P_mean[3], P_square[3][3]; /* P_: of the gradients in C */
} Sums;

static void AddModel(const Weight *w, const LamExpansion *m, Sums *s)
{
  const PetscReal energy = m->energy - s->first.energy, P33 = m->P33 - s->first.P33;
  LamScatterVector slope;

  for (int a = 0; a < LAM_VARIABLES; a++) slope[a] = m->gradient[a] - s->first.gradient[a];
  s->W += w->value;
  s->W_metric += w->metric;
  s->A += w->value * energy;
  s->A_metric += w->metric * energy;
  s->P33 += w->value * P33;
  s->P33_square += w->value * P33 * P33;
  for (int a = 0; a < LAM_VARIABLES; a++) {
    s->W_slope[a] += w->gradient[a];
    s->A_slope[a] += w->value * slope[a] + w->gradient[a] * energy;
    s->P33_slope[a] += w->value * m->P33_gradient[a] + w->gradient[a] * P33;
    for (int b = 0; b <= a; b++) {
      const PetscReal outer = w->outer * w->v[a] * w->v[b];

      s->W_hessian[a][b] += outer;
      s->A_hessian[a][b] += outer * energy + w->gradient[a] * slope[b] + slope[a] * w->gradient[b];
    }
  }
  for (int a = 0; a < 3; a++) {
    s->P_mean[a] += w->value * slope[a];
    for (int b = 0; b < 3; b++) s->P_square[a][b] += w->value * slope[a] * slope[b];
  }
}

static void AddState(const LamScatterSearch *search, PetscInt k, PetscReal reach, Sums *s)
{
  const LamScattered *state = &search->db->scatter.states[k];
  const PetscReal A3333 = search->db->scatter.records[k].tangent[80];

  for (PetscInt i = 0; i < search->db->images.count; i++) {
    LamScatterVector delta;
    LamExpansion m;
    Weight w;

    if (!(state->images >> i & 1) || LamScatterDistance2(search, state, i) >= reach * reach) continue;
    EvaluateModel(search, state, i, delta, &m);
    if (!MakeWeight(&search->db->metric, delta, reach, &w)) continue;
    AddModel(&w, &m, s);
    s->A3333 += w.value * A3333;
    for (int a = 0; a < LAM_VARIABLES; a++)
      for (int b = 0; b <= a; b++) s->own_hessian[i][a][b] += w.value * state->model.hessian[a][b];
  }
}

static void Mirror(LamScatterMatrix H)
{
  for (int a = 0; a < LAM_VARIABLES; a++)
    for (int b = 0; b < a; b++) H[b][a] = H[a][b];
}

/* Adds the metric's part of the Hessians, and the records' own Hessians in the query's frame. */
static void CompleteHessians(const LamScatterSearch *search, Sums *s)
{
  const LamScatterMetric *m = &search->db->metric;
  const PetscReal diagonal[LAM_VARIABLES] = {m->strain, m->strain, m->strain, m->pp, m->gg};

  for (int a = 0; a < LAM_VARIABLES; a++) {
    s->W_hessian[a][a] += s->W_metric * diagonal[a];
    s->A_hessian[a][a] += s->A_metric * diagonal[a];
  }
  s->W_hessian[4][3] += s->W_metric * m->pg;
  s->A_hessian[4][3] += s->A_metric * m->pg;
  for (PetscInt i = 0; i < search->db->images.count; i++) {
    Mirror(s->own_hessian[i]);
    LamImagesBackHessian(&search->db->images, i, s->own_hessian[i]);
    for (int a = 0; a < LAM_VARIABLES; a++)
      for (int b = 0; b <= a; b++) s->A_hessian[a][b] += s->own_hessian[i][a][b];
  }
}

/* The blend's expansion at the query, in the query's frame. */
static void Finish(const LamScatterSearch *search, Sums *s, LamExpansion *blend)
{
  const PetscReal energy = s->A / s->W, P33 = s->P33 / s->W;
  LamScatterVector slope, l;

  CompleteHessians(search, s);
  memcpy(blend->x, search->x, sizeof(blend->x));
  blend->F33 = s->first.F33; /* AddState takes records of this F33 alone */
  blend->energy = s->first.energy + energy;
  blend->P33 = s->first.P33 + P33;
  for (int a = 0; a < LAM_VARIABLES; a++) {
    l[a] = s->W_slope[a] / s->W;
    slope[a] = s->A_slope[a] / s->W - energy * l[a];
    blend->gradient[a] = s->first.gradient[a] + slope[a];
    blend->P33_gradient[a] = s->P33_slope[a] / s->W - P33 * l[a];
  }
  for (int a = 0; a < LAM_VARIABLES; a++)
    for (int b = 0; b <= a; b++)
      blend->hessian[a][b] =
          (s->A_hessian[a][b] - energy * s->W_hessian[a][b]) / s->W - slope[a] * l[b] - l[a] * slope[b];
  Mirror(blend->hessian);
}

/* Root of the weighted mean of |P_k - P|^2 over the models. */
static PetscReal Spread(const LamScatterSearch *search, const Sums *s, const LamExpansion *blend, const PetscReal F[9])
{
  PetscReal B[3][3], sum = s->P33_square / s->W - PetscSqr(s->P33 / s->W), slope[3];

  LamStressMetric(F, B);
  for (int a = 0; a < 3; a++) slope[a] = blend->gradient[a] - s->first.gradient[a];
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      sum += B[a][b] * ((s->P_square[a][b] - 2 * s->P_mean[a] * slope[b]) / s->W + slope[a] * slope[b]);
  return sqrt(PetscMax(sum, 0));
}

/* Error of a single model at this distance. */
static PetscReal OneModelError(LamDatabase database, PetscReal distance2)
{
  return (database->header.micro.interface == LAM_INTERFACE_BONDED ? BONDED_ERROR : CONTACT_ERROR) * distance2;
}

/* Error of the nearest model alone, times the square of its share of the weights. */
static PetscReal LonelyError(const LamScatterSearch *search, PetscReal reach, const Sums *s)
{
  const PetscReal d2 = search->blends.distance2, u = 1 / d2 - 1 / (reach * reach), share = u * u * u / s->W;

  return OneModelError(search->db, d2) * share * share;
}

/* ---- the response ---- */

static PetscBool SameNumber(PetscReal a, PetscReal b)
{
  return (PetscBool)(fabs(a - b) <= 1e-10);
}

/* Volumes are derivatives of the potential only where all cells have the same turgor and cohesion; else NaN. */
static void TakeVolumes(const LamResponse *record, LamResponse *r)
{
  r->lumen_fraction = SameNumber(-record->energy_turgor, record->lumen_fraction) ? -r->energy_turgor : NAN;
  r->opening_fraction = SameNumber(record->energy_cohesion, record->opening_fraction) ? r->energy_cohesion : NAN;
}

static void Fill(const LamScatterSearch *search, const LamScatterNearest *at, PetscBool own, const LamExpansion *e,
                 PetscReal A3333, LamResponse *r)
{
  const LamDatabase db = search->db;
  const LamResponse *record = &db->scatter.records[at->state];

  LamExpansionToResponse(e, A3333, r);
  TakeVolumes(record, r);
  LamIndicatorsCopy(record, db->images.face[at->image], own, db->header.micro.interface, r);
  r->indicators_trusted = own;
  r->status = LAM_CONVERGED;
}

/* PETSC_FALSE, with the reason, where the nearest records forbid a blend. */
static PetscBool MayBlend(const LamScatterSearch *search, PetscReal radius, LamResponse *r)
{
  const PetscReal other = sqrt(PetscMin(search->alone.distance2, search->refuses.distance2));

  if (search->blends.state < 0) {
    snprintf(r->reason, sizeof(r->reason),
             "the database has no usable record (converged, stable, branch 0, no cell floats) at F33 = %.6g",
             (double)r->load.F[8]);
    return PETSC_FALSE;
  }
  if (r->distance > radius) {
    snprintf(r->reason, sizeof(r->reason), "the nearest record is %.3g away in strain, %.3g is trusted",
             (double)r->distance, (double)radius);
    return PETSC_FALSE;
  }
  if (other < DOUBT * r->distance) {
    snprintf(r->reason, sizeof(r->reason),
             "a state of another branch, with loose cells or without a response is %.3g away in strain, the nearest "
             "record %.3g",
             (double)other, (double)r->distance);
    return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* P has the error e, and errs to second order in the distance d: the tangent by 2 e / d, e and d of the same state. */
static void EstimateTangent(const LamScatterSearch *search, LamResponse *r)
{
  const LamStressScale scale = LamStressScaleOf(&search->db->header.micro);
  const PetscReal size = r->error_estimate / LamStressErrorOfSize(scale, 1, r->P);

  r->tangent_error_estimate = LamTangentErrorOfSize(scale, r->distance > 0 ? 2 * size / r->distance : 0, r->tangent);
}

static PetscBool IsOwnState(const LamScatterNearest *at)
{
  return (PetscBool)(at->distance2 < PetscSqr(LAM_OWN_STATE));
}

/* Indicators are copied from the record. */
static void RespondFromModel(const LamScatterSearch *search, const LamScatterNearest *at, PetscReal error,
                             LamResponse *r)
{
  const LamResponse *record = &search->db->scatter.records[at->state];
  LamScatterVector delta;
  LamExpansion e;

  EvaluateModel(search, &search->db->scatter.states[at->state], at->image, delta, &e);
  LamExpansionStretch(record->tangent[80], r->load.F[8], &e);
  LamImagesBackHessian(&search->db->images, at->image, e.hessian);
  r->distance = sqrt(at->distance2);
  r->error_estimate = error;
  Fill(search, at, PETSC_TRUE, &e, record->tangent[80], r);
  EstimateTangent(search, r);
  if (IsOwnState(at)) return;
  TakeVolumes(record, r);
  r->opening_fraction = PetscMax(r->opening_fraction, 0);
  r->indicators_trusted = PETSC_FALSE;
}

static void RespondFromBlend(const LamScatterSearch *search, PetscReal reach, LamResponse *r)
{
  const LamScatter *scatter = &search->db->scatter;
  LamExpansion blend;
  Sums sums = {0};
  PetscReal spread;
  LamScatterVector delta;

  EvaluateModel(search, &scatter->states[search->blends.state], search->blends.image, delta, &sums.first);
  for (PetscInt k = 0; k < scatter->n; k++)
    if (scatter->states[k].use == LAM_SCATTER_BLENDS && LamScatterSameF33(search, k) &&
        LamScatterLowerBound(search, &scatter->places[k]) < reach * reach)
      AddState(search, k, reach, &sums);
  Finish(search, &sums, &blend);
  Fill(search, &search->blends, PETSC_FALSE, &blend, sums.A3333 / sums.W, r);
  spread =
      LamStressErrorOfSize(LamStressScaleOf(&search->db->header.micro), Spread(search, &sums, &blend, r->load.F), r->P);
  if (LamCellsPart(search->db->header.micro.interface)) spread *= CONTACT_DOUBT;
  r->error_estimate = hypot(spread, LonelyError(search, reach, &sums));
  EstimateTangent(search, r);
}

/* Replaces the response by LAM_OUT_OF_REACH with the reason. */
static PetscErrorCode Refuse(PetscReal accuracy, LamResponse *r)
{
  const LamResponse kept = *r;

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(&kept.load, r));
  r->source = kept.source;
  r->status = LAM_OUT_OF_REACH;
  r->distance = kept.distance;
  r->error_estimate = kept.error_estimate;
  snprintf(r->reason, sizeof(r->reason),
           "the nearest record is %.3g away in strain, the estimated error of P is %.2g, the accuracy is %.2g",
           (double)r->distance, (double)r->error_estimate, (double)accuracy);
  PetscFunctionReturn(0);
}

PetscErrorCode LamScatterQuery(LamDatabase database, const LamLoad *load, PetscReal radius, PetscReal accuracy,
                               LamResponse *response)
{
  const LamScatterNearest *own;
  LamScatterSearch search;

  PetscFunctionBeginUser;
  LamScatterFind(database, load, PETSC_TRUE, &search);
  own = search.alone.distance2 < search.blends.distance2 ? &search.alone : &search.blends;
  if (search.kinks.distance2 < own->distance2) own = &search.kinks;
  if (IsOwnState(own)) {
    RespondFromModel(&search, own, 0, response);
    PetscFunctionReturn(0);
  }
  response->status = LAM_OUT_OF_REACH;
  if (search.blends.state >= 0) response->distance = sqrt(search.blends.distance2);
  if (!MayBlend(&search, radius, response)) PetscFunctionReturn(0);
  RespondFromBlend(&search, REACH * radius, response);
  if (!(response->error_estimate <= accuracy)) PetscCall(Refuse(accuracy, response));
  PetscFunctionReturn(0);
}

/* ---- one model ---- */

void LamScatterModelFind(LamDatabase database, const LamLoad *load, LamScatterModel *model)
{
  LamScatterSearch search;
  const LamScatterNearest *at;

  LamScatterFind(database, load, PETSC_FALSE, &search);
  at = search.alone.distance2 < search.blends.distance2 ? &search.alone : &search.blends;
  *model = (LamScatterModel){-1, 0};
  if (at->state < 0 || database->scatter.records[at->state].floating_cells > 0) return;
  if (search.refuses.distance2 <= DOUBT * DOUBT * at->distance2) return;
  *model = (LamScatterModel){at->state, at->image};
}

LamLoad LamScatterModelLoad(LamDatabase database, const LamScatterModel *model)
{
  return database->scatter.records[model->state].load;
}

PetscErrorCode LamScatterModelQuery(LamDatabase database, const LamScatterModel *model, const LamLoad *load,
                                    PetscReal accuracy, LamResponse *response)
{
  LamScatterNearest at = {model->state, model->image, PETSC_INFINITY};
  LamScatterSearch search;
  PetscReal error;

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->source = LAM_SOURCE_DATABASE;
  response->status = LAM_OUT_OF_REACH;
  if (!LamLoadValidateInPlane(load, response)) PetscFunctionReturn(0);
  LamScatterBegin(database, load, &search);
  at.distance2 = LamScatterDistance2(&search, &database->scatter.states[at.state], at.image);
  error = OneModelError(database, at.distance2);
  if (error <= accuracy) RespondFromModel(&search, &at, error, response);
  PetscFunctionReturn(0);
}
