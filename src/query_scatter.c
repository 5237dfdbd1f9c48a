/*
  Answers from records that belong to no grid.

  Method
    Partition of unity of the second-order Taylor models T_k of the records' potential (expansion.h) and of their images
    under the symmetry of the lattice, so that stress is the exact gradient of the answered energy and the tangent its
    exact, symmetric Hessian. With the distance d_k from the question to record k, a strain, and a reach R,
      Phi = sum_k w_k T_k / sum_k w_k,   w_k = max(0, 1/d_k^2 - 1/R^2)^3:
    Shepard's weights with a compact support (Franke and Little), C2 where a model comes into reach, and so steep at a
    record that the blend has the record's value, gradient and Hessian there. R is twice the radius within which a
    record must lie for an answer.

  Algorithm
    The nearest model T_1 is taken out, Phi = T_1 + sum w_k (T_k - T_1) / sum w_k, else the weights' steep derivatives
    near a record would multiply rounding. With A, W the two sums and e = A / W:
      e_a  = A_a / W - e W_a / W,   e_ab = A_ab / W - e_a W_b / W - W_a e_b / W - e W_ab / W.
    Distance: d^2 = (|dc|^2)/4 + (TURGOR_WEIGHT dp)^2, in contact + (SUCTION_WEIGHT (dp + dg))^2. dC/2 is the Green
    strain, so the distance is a strain. The prototype found 0.1 per MPa for p, that is 0.011 per C1 + C2 of 0.11 MPa.

  Estimate of the error: the models' spread, the root of sum w_k |P_k - P|^2 / sum w_k. ...

  What other records say: ...

  References: Shepard, Proc. 23rd ACM National Conference (1968) 517; Franke and Nielson, Int. J. Numer. Meth. Engng 15
  (1980) 1691.
*/
#include "database_internal.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define TURGOR_WEIGHT 0.011
#define SUCTION_WEIGHT 0.5
#define TIE 1e-14 /* distances (strain) closer than this are equal: the record or image that comes first counts */
#define REACH 2   /* of the blend, in radii of trust */
#define DOUBT                                                                                                          \
  2 /* a record that refuses makes an answer doubtful up to so many distances of the nearest that blends               \
     */

typedef PetscReal Vector[LAM_VARIABLES];
typedef PetscReal Matrix[LAM_VARIABLES][LAM_VARIABLES];

/* ---- distance ---- */

typedef struct {
  PetscReal strain, pp, pg, gg; /* the squared distance's coefficients: of |dc|^2, dp^2, 2 dp dg, dg^2 */
} Metric;

static Metric MakeMetric(LamDatabase db)
{
  const PetscReal turgor = PetscSqr(TURGOR_WEIGHT);
  const PetscReal suction = db->header.micro.interface == LAM_INTERFACE_BONDED ? 0 : PetscSqr(SUCTION_WEIGHT);

  return (Metric){0.25, turgor + suction, suction, suction};
}

/* v = M delta; returns delta . M delta. */
static PetscReal Apply(const Metric *m, const Vector delta, Vector v)
{
  PetscReal sum = 0;

  for (int a = 0; a < 3; a++) v[a] = m->strain * delta[a];
  v[3] = m->pp * delta[3] + m->pg * delta[4];
  v[4] = m->pg * delta[3] + m->gg * delta[4];
  for (int a = 0; a < LAM_VARIABLES; a++) sum += v[a] * delta[a];
  return sum;
}

/* No image of the state is nearer. */
static PetscReal LowerBound(const Metric *m, const LamScatterPlace *a, const LamScatterPlace *b)
{
  const PetscReal dm = a->mean - b->mean, dd = a->deviator - b->deviator;
  const PetscReal dp = a->turgor - b->turgor, dg = a->cohesion - b->cohesion;

  return m->strain * (dm * dm + dd * dd) + m->pp * dp * dp + 2 * m->pg * dp * dg + m->gg * dg * dg;
}

/* ---- the nearest records ---- */

typedef struct {
  PetscInt state, image; /* state -1: none */
  PetscReal distance2;
} Nearest;

typedef struct {
  LamDatabase db;
  Metric metric;
  Vector x; /* of the question */
  LamScatterPlace place;
  Vector turned[LAM_MAX_IMAGES];  /* x in the frame of each image */
  Nearest blends, alone, refuses; /* of each use */
} Search;

static void BeginSearch(LamDatabase db, const LamLoad *load, Search *search)
{
  const Nearest none = {-1, 0, INFINITY};

  *search = (Search){.db = db, .metric = MakeMetric(db), .blends = none, .alone = none, .refuses = none};
  LamVariables(load, search->x);
  search->place = LamScatterPlaceOf(search->x);
  for (PetscInt i = 0; i < db->images.count; i++) LamImagesForward(&db->images, i, search->x, search->turned[i]);
}

static PetscReal Distance2(const Search *search, const LamScattered *state, PetscInt image)
{
  Vector delta, v;

  for (int a = 0; a < LAM_VARIABLES; a++) delta[a] = search->turned[image][a] - state->model.x[a];
  return Apply(&search->metric, delta, v);
}

static void FindNearest(Search *search)
{
  const LamScatter *scatter = &search->db->scatter;
  Nearest *const nearest[] = {&search->blends, &search->alone, &search->refuses};

  for (PetscInt k = 0; k < scatter->n; k++) {
    const LamScattered *state = &scatter->states[k];
    Nearest *best = nearest[state->use];

    if (!(LowerBound(&search->metric, &search->place, &scatter->places[k]) < best->distance2)) continue;
    for (PetscInt i = 0; i < search->db->images.count; i++) {
      PetscReal d2;

      if (!(state->images >> i & 1)) continue;
      d2 = Distance2(search, state, i);
      if (d2 < best->distance2 - 2 * TIE * sqrt(d2)) *best = (Nearest){k, i, d2};
    }
  }
}

/* ---- the blend ---- */

/* A record's model at the question: the expansion's members, without the Hessian, in the question's frame. */
typedef struct {
  PetscReal energy, P33;
  Vector gradient, P33_gradient;
} Model;

static void EvaluateModel(const Search *search, const LamScattered *state, PetscInt image, Vector delta, Model *m)
{
  const LamImages *images = &search->db->images;
  const LamExpansion *e = &state->model;

  for (int a = 0; a < LAM_VARIABLES; a++) delta[a] = search->turned[image][a] - e->x[a];
  m->energy = e->energy;
  m->P33 = e->P33;
  for (int a = 0; a < LAM_VARIABLES; a++) {
    PetscReal slope = 0;

    for (int b = 0; b < LAM_VARIABLES; b++) slope += e->hessian[a][b] * delta[b];
    m->energy += (e->gradient[a] + 0.5 * slope) * delta[a];
    m->gradient[a] = e->gradient[a] + slope;
    m->P33_gradient[a] = e->P33_gradient[a];
    m->P33 += e->P33_gradient[a] * delta[a];
  }
  LamImagesBack(images, image, m->gradient);
  LamImagesBack(images, image, m->P33_gradient);
  LamImagesBack(images, image, delta);
}

/* w = u^3, u = 1/d^2 - 1/R^2, with its derivatives. */
typedef struct {
  PetscReal value;
  Vector gradient;
  PetscReal outer, metric; /* its Hessian is outer v v^T + metric M, v = M delta */
  Vector v;
} Weight;

static PetscBool MakeWeight(const Metric *metric, const Vector delta, PetscReal reach, Weight *w)
{
  const PetscReal d2 = Apply(metric, delta, w->v), u = 1 / d2 - 1 / (reach * reach), d4 = d2 * d2;

  if (!(u > 0)) return PETSC_FALSE;
  w->value = u * u * u;
  for (int a = 0; a < LAM_VARIABLES; a++) w->gradient[a] = -6 * u * u / d4 * w->v[a];
  w->outer = 24 * u / (d4 * d4) + 24 * u * u / (d4 * d2);
  w->metric = -6 * u * u / d4;
  return PETSC_TRUE;
}

/* Sums over the models in reach: of the weights (all models), of weights times what a model has over the first. */
typedef struct {
  Model first;
  PetscReal W, W_metric, A, A_metric, P33, A3333; /* _metric: the part of the Hessian along the metric */
  Vector W_slope, A_slope, P33_slope;
  Matrix W_hessian, A_hessian;
  Matrix own_hessian[LAM_MAX_IMAGES];          /* of the records, each image in its own frame */
  PetscReal spread, P_mean[3], P_square[3][3]; /* of P33 squared; of the gradients in C */
} Sums;

static void AddModel(const Weight *w, const Model *m, Sums *s)
{
  const PetscReal energy = m->energy - s->first.energy, P33 = m->P33 - s->first.P33;
  Vector slope;

  for (int a = 0; a < LAM_VARIABLES; a++) slope[a] = m->gradient[a] - s->first.gradient[a];
  s->W += w->value;
  s->W_metric += w->metric;
  s->A += w->value * energy;
  s->A_metric += w->metric * energy;
  s->P33 += w->value * P33;
  s->spread += w->value * P33 * P33;
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

static void AddState(const Search *search, PetscInt k, PetscReal reach, Sums *s)
{
  const LamScattered *state = &search->db->scatter.states[k];
  const PetscReal A3333 = search->db->scatter.records[k].tangent[80];

  for (PetscInt i = 0; i < search->db->images.count; i++) {
    Vector delta;
    Weight w;
    Model m;

    if (!(state->images >> i & 1) || Distance2(search, state, i) >= reach * reach) continue;
    EvaluateModel(search, state, i, delta, &m);
    if (!MakeWeight(&search->metric, delta, reach, &w)) continue;
    AddModel(&w, &m, s);
    s->A3333 += w.value * A3333;
    for (int a = 0; a < LAM_VARIABLES; a++)
      for (int b = 0; b <= a; b++) s->own_hessian[i][a][b] += w.value * state->model.hessian[a][b];
  }
}

static void Mirror(Matrix H)
{
  for (int a = 0; a < LAM_VARIABLES; a++)
    for (int b = 0; b < a; b++) H[b][a] = H[a][b];
}

/* The metric's part of the Hessians, and the records' own Hessians in the question's frame. */
static void CompleteHessians(const Search *search, Sums *s)
{
  const Metric *m = &search->metric;
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

/* The blend's expansion at the question, in the question's frame. */
static void Finish(const Search *search, Sums *s, LamExpansion *blend)
{
  const PetscReal energy = s->A / s->W, P33 = s->P33 / s->W;
  Vector slope, l;

  CompleteHessians(search, s);
  memcpy(blend->x, search->x, sizeof(blend->x));
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
static PetscReal Spread(const Search *search, const Sums *s, const LamExpansion *blend, const PetscReal F[9])
{
  PetscReal B[3][3], sum = s->spread / s->W - PetscSqr(s->P33 / s->W), slope[3];

  LamStressMetric(F, B);
  for (int a = 0; a < 3; a++) slope[a] = blend->gradient[a] - s->first.gradient[a];
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      sum += B[a][b] * ((s->P_square[a][b] - 2 * s->P_mean[a] * slope[b]) / s->W + slope[a] * slope[b]);
  return sqrt(PetscMax(sum, 0));
}

static PetscReal Blend(const Search *search, PetscReal reach, const LamLoad *load, LamExpansion *blend,
                       PetscReal *A3333)
{
  const LamScatter *scatter = &search->db->scatter;
  Sums sums = {0};
  Vector delta;

  EvaluateModel(search, &scatter->states[search->blends.state], search->blends.image, delta, &sums.first);
  for (PetscInt k = 0; k < scatter->n; k++)
    if (scatter->states[k].use == LAM_SCATTER_BLENDS &&
        LowerBound(&search->metric, &search->place, &scatter->places[k]) < reach * reach)
      AddState(search, k, reach, &sums);
  Finish(search, &sums, blend);
  *A3333 = sums.A3333 / sums.W;
  return Spread(search, &sums, blend, load->F);
}

/* ---- the answer ---- */

/* The model of the state that the question is, in the question's frame. */
static void OwnState(const Search *search, const Nearest *at, LamExpansion *own)
{
  const LamScattered *state = &search->db->scatter.states[at->state];
  Vector delta;
  Model m;

  EvaluateModel(search, state, at->image, delta, &m);
  *own = state->model;
  memcpy(own->x, search->x, sizeof(own->x));
  own->energy = m.energy;
  own->P33 = m.P33;
  memcpy(own->gradient, m.gradient, sizeof(own->gradient));
  memcpy(own->P33_gradient, m.P33_gradient, sizeof(own->P33_gradient));
  LamImagesBackHessian(&search->db->images, at->image, own->hessian);
}

static PetscBool SameNumber(PetscReal a, PetscReal b)
{
  return (PetscBool)(fabs(a - b) <= 1e-10);
}

static void Fill(const Search *search, const Nearest *at, PetscBool own, const LamExpansion *e, PetscReal A3333,
                 LamResponse *r)
{
  const LamDatabase db = search->db;
  const LamResponse *record = &db->scatter.records[at->state];

  LamExpansionToResponse(e, A3333, r);
  /* derivatives of the potential are volumes only where all cells have the same turgor and cohesion */
  r->lumen_fraction = SameNumber(-record->energy_turgor, record->lumen_fraction) ? -r->energy_turgor : NAN;
  r->opening_fraction = SameNumber(record->energy_cohesion, record->opening_fraction) ? r->energy_cohesion : NAN;
  LamIndicatorsCopy(record, db->images.face[at->image], own, db->header.micro.interface, r);
  r->indicators_trusted = own;
  r->status = LAM_CONVERGED;
}

/* PETSC_FALSE, with the reason, where the nearest records forbid a blend. */
static PetscBool MayBlend(const Search *search, PetscReal radius, LamResponse *r)
{
  const PetscReal other = sqrt(PetscMin(search->alone.distance2, search->refuses.distance2));

  if (search->blends.state < 0) {
    snprintf(r->reason, sizeof(r->reason), "the database has no usable record (converged, stable, branch 0)");
    return PETSC_FALSE;
  }
  if (r->distance > radius) {
    snprintf(r->reason, sizeof(r->reason), "the nearest record is %.3g away in strain, %.3g is trusted",
             (double)r->distance, (double)radius);
    return PETSC_FALSE;
  }
  if (other < DOUBT * r->distance) {
    snprintf(r->reason, sizeof(r->reason),
             "a state of another branch, or without an answer, is %.3g away in strain, the nearest record %.3g",
             (double)other, (double)r->distance);
    return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* What LamStressError would say of an error of this size. */
static PetscReal RelativeError(PetscReal size, const PetscReal P[9])
{
  PetscReal other[9];

  memcpy(other, P, sizeof(other));
  other[0] += size;
  return LamStressError(other, P);
}

PetscErrorCode LamScatterQuery(LamDatabase database, const LamLoad *load, PetscReal radius, PetscReal accuracy,
                               LamResponse *response)
{
  Search search;
  LamExpansion e;
  const Nearest *own;
  PetscReal A3333, spread;

  PetscFunctionBeginUser;
  BeginSearch(database, load, &search);
  FindNearest(&search);
  own = search.alone.distance2 < search.blends.distance2 ? &search.alone : &search.blends;
  response->status = LAM_OUT_OF_REACH;
  if (own->state >= 0 && own->distance2 < PetscSqr(LAM_OWN_STATE)) {
    OwnState(&search, own, &e);
    A3333 = database->scatter.records[own->state].tangent[80];
    response->distance = sqrt(own->distance2);
    response->error_estimate = 0;
    Fill(&search, own, PETSC_TRUE, &e, A3333, response);
    PetscFunctionReturn(0);
  }
  if (search.blends.state >= 0) response->distance = sqrt(search.blends.distance2);
  if (!MayBlend(&search, radius, response)) PetscFunctionReturn(0);
  spread = Blend(&search, REACH * radius, load, &e, &A3333);
  Fill(&search, &search.blends, PETSC_FALSE, &e, A3333, response);
  response->error_estimate = RelativeError(spread, response->P);
  PetscFunctionReturn(0);
}
