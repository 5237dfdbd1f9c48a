/*
  Answers from stored records.

  Method
    Second-order Taylor model of the potential about the nearest record, so that stress is the exact gradient of the
    answered energy and the tangent its exact, symmetric Hessian. Coordinates x = (c0, c1, c2, p) are invariants under
    rotation: c0 = (C11 + C22)/2, c1 = (C11 - C22)/2, c2 = C12. The fluid's part -p J of the potential is taken off
    before the expansion and put back exactly; what remains varies slowly with J, and hardly with p
    (effective-stress principle, docs/theory.md Section 6).

  Algorithm
    Record to expansion: with dF_a = 1/2 F^-T D_a, D = I, diag(1,-1), offdiag(1,1), a change dF_a changes c_a alone;
      E_a  = P : dF_a,   E_ab = dF_a : A : dF_b - S : sym(dF_a^T dF_b),   S = F^-1 P
    (the second term because C is held on a straight line: F^T d2F + d2F^T F = -2 sym(dF_a^T dF_b));
    the opening of contact tissue, dPsi/dg, changes by (dP/dg) : dF_a and by d2Psi/dpdg.
    Question to answer: c1 + i c2 of the question is rotated by 120 k degrees and mirrored in the axes of the lattice,
    the nearest record taken, its gradient and Hessian mapped back, and with K_a = F D_a, S = sum E_a D_a
      P = F S,   A_iJkL = delta_ik S_JL + sum E_ab (K_a)_iJ (K_b)_kL.

  Distance: |diag(1/2, 1/2, 1/2, w) dx|, w = 0.011 per C1 + C2 of turgor, which is the 0.1 per MPa that the prototype
  found for C1 + C2 = 0.11 MPa. 1/2 dC is the Green strain, so the distance is a strain.
*/
#include "database_internal.h"
#include <math.h>
#include <petsctime.h>
#include <stdio.h>
#include <string.h>

#define STRAIN_WEIGHT 0.5
#define TURGOR_WEIGHT 0.011
#define TIE 1e-14 /* distances (strain) closer than this are equal: the image or record that comes first answers */

static const PetscReal D[3][2][2] = {{{1, 0}, {0, 1}}, {{1, 0}, {0, -1}}, {{0, 1}, {1, 0}}};

typedef PetscReal Tensor[2][2];

/* ---- kinematics ---- */

static void InPlane(const PetscReal full[9], Tensor a)
{
  a[0][0] = full[0];
  a[0][1] = full[1];
  a[1][0] = full[3];
  a[1][1] = full[4];
}

static PetscReal Contract(Tensor a, Tensor b)
{
  return a[0][0] * b[0][0] + a[0][1] * b[0][1] + a[1][0] * b[1][0] + a[1][1] * b[1][1];
}

static void Invariants(Tensor F, PetscReal c[3])
{
  const PetscReal C11 = F[0][0] * F[0][0] + F[1][0] * F[1][0], C22 = F[0][1] * F[0][1] + F[1][1] * F[1][1];

  c[0] = 0.5 * (C11 + C22);
  c[1] = 0.5 * (C11 - C22);
  c[2] = F[0][0] * F[0][1] + F[1][0] * F[1][1];
}

/* J = sqrt(c0^2 - c1^2 - c2^2) with its gradient and Hessian. */
static PetscReal Volume(const PetscReal c[3], PetscReal gradient[3], PetscReal hessian[3][3])
{
  const PetscReal sign[3] = {1, -1, -1}, J = sqrt(c[0] * c[0] - c[1] * c[1] - c[2] * c[2]);

  for (int a = 0; a < 3; a++) gradient[a] = sign[a] * c[a] / J;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) hessian[a][b] = ((a == b ? sign[a] : 0) - gradient[a] * gradient[b]) / J;
  return J;
}

/* Adds s p J to an expansion's value, gradient and Hessian at x. */
static void AddFluid(PetscReal s, const PetscReal x[4], PetscReal *energy, PetscReal gradient[4],
                     PetscReal hessian[4][4])
{
  PetscReal JC[3], JCC[3][3];
  const PetscReal J = Volume(x, JC, JCC), p = x[3];

  *energy += s * p * J;
  gradient[3] += s * J;
  for (int a = 0; a < 3; a++) {
    gradient[a] += s * p * JC[a];
    hessian[a][3] += s * JC[a];
    hessian[3][a] += s * JC[a];
    for (int b = 0; b < 3; b++) hessian[a][b] += s * p * JCC[a][b];
  }
}

/* ---- symmetry ---- */

void LamImagesMake(const LamMicrostructure *micro, LamImages *images)
{
  const PetscBool hexagonal = (PetscBool)(micro->cells[0] == micro->cells[1] && !micro->is_patch && !micro->cell);

  /* unequal counts leave the half turn, which C does not see; cells that differ leave nothing */
  images->count = hexagonal ? LAM_MAX_IMAGES : 1;
  for (PetscInt i = 0; i < images->count; i++) {
    const PetscInt turn = i % 3;
    const PetscBool mirror = (PetscBool)(i >= 3);
    /* mirror at face normal 0 first, then turn by 60 degrees * turn; doubled angles act on c1 + i c2 */
    const PetscReal angle = 2 * PETSC_PI / 3 * turn + (mirror ? 4 * micro->orientation : 0);
    const PetscReal c = cos(angle), s = sin(angle), sign = mirror ? -1 : 1;

    images->map[i][0][0] = c;
    images->map[i][0][1] = -sign * s;
    images->map[i][1][0] = s;
    images->map[i][1][1] = sign * c;
    for (PetscInt k = 0; k < 3; k++) images->face[i][k] = ((mirror ? 3 - k : k) + turn) % 3;
  }
}

/* y = M x on (c1, c2). */
static void MapForward(const LamImages *images, PetscInt image, const PetscReal x[4], PetscReal y[4])
{
  const PetscReal(*M)[2] = images->map[image];

  y[0] = x[0];
  y[1] = M[0][0] * x[1] + M[0][1] * x[2];
  y[2] = M[1][0] * x[1] + M[1][1] * x[2];
  y[3] = x[3];
}

/* x = M^T y: a gradient in the record's frame, in the question's. */
static void MapBack(const LamImages *images, PetscInt image, PetscReal g[4])
{
  const PetscReal(*M)[2] = images->map[image];
  const PetscReal y[2] = {g[1], g[2]};

  g[1] = M[0][0] * y[0] + M[1][0] * y[1];
  g[2] = M[0][1] * y[0] + M[1][1] * y[1];
}

/* H <- M^T H M, columns first, then rows. */
static void MapBackHessian(const LamImages *images, PetscInt image, PetscReal H[4][4])
{
  for (int pass = 0; pass < 2; pass++) {
    for (int a = 0; a < 4; a++) MapBack(images, image, H[a]);
    for (int a = 0; a < 4; a++)
      for (int b = 0; b < a; b++) {
        const PetscReal swap = H[a][b];

        H[a][b] = H[b][a];
        H[b][a] = swap;
      }
  }
}

/* ---- record to expansion ---- */

/* dF_a = 1/2 F^-T D_a. */
static void Variations(Tensor F, Tensor dF[3])
{
  const PetscReal J = F[0][0] * F[1][1] - F[0][1] * F[1][0];
  const Tensor half = {{0.5 * F[1][1] / J, -0.5 * F[1][0] / J}, {-0.5 * F[0][1] / J, 0.5 * F[0][0] / J}};

  for (int a = 0; a < 3; a++)
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) dF[a][i][j] = half[i][0] * D[a][0][j] + half[i][1] * D[a][1][j];
}

/* a : A : b for the in-plane part of a tangent. */
static PetscReal Bilinear(const PetscReal A[81], Tensor a, Tensor b)
{
  PetscReal sum = 0;

  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2; l++) sum += a[i][j] * A[27 * i + 9 * j + 3 * k + l] * b[k][l];
  return sum;
}

/* S : (a^T b), with S = sum S_a D_a given by its three numbers. */
static PetscReal Curvature(const PetscReal S[3], Tensor a, Tensor b)
{
  const PetscReal t00 = a[0][0] * b[0][0] + a[1][0] * b[1][0], t11 = a[0][1] * b[0][1] + a[1][1] * b[1][1];
  const PetscReal t01 = a[0][0] * b[0][1] + a[1][0] * b[1][1], t10 = a[0][1] * b[0][0] + a[1][1] * b[1][0];

  return S[0] * (t00 + t11) + S[1] * (t00 - t11) + S[2] * (t01 + t10);
}

static void ExpandEnergy(const LamResponse *r, Tensor dF[3], LamExpansion *e)
{
  Tensor P, Pp;

  InPlane(r->P, P);
  InPlane(r->P_turgor, Pp);
  e->energy = r->energy;
  for (int a = 0; a < 3; a++) {
    e->gradient[a] = Contract(P, dF[a]);
    e->hessian[a][3] = e->hessian[3][a] = Contract(Pp, dF[a]);
  }
  e->gradient[3] = r->energy_turgor;
  e->hessian[3][3] = r->energy_turgor2;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b <= a; b++) {
      const PetscReal bending = 0.5 * (Curvature(e->gradient, dF[a], dF[b]) + Curvature(e->gradient, dF[b], dF[a]));

      e->hessian[a][b] = 0.5 * (Bilinear(r->tangent, dF[a], dF[b]) + Bilinear(r->tangent, dF[b], dF[a])) - bending;
      e->hessian[b][a] = e->hessian[a][b];
    }
}

/* P33 + p J, from row 33 of the tangent. */
static void ExpandThickness(const LamResponse *r, Tensor dF[3], LamExpansion *e)
{
  PetscReal JC[3], JCC[3][3];
  const PetscReal J = Volume(e->x, JC, JCC), *row = &r->tangent[72];
  Tensor A33;

  InPlane(row, A33);
  e->P33 = r->P[8] + r->load.turgor * J;
  for (int a = 0; a < 3; a++) e->P33_gradient[a] = Contract(A33, dF[a]) + r->load.turgor * JC[a];
  e->P33_gradient[3] = r->P_turgor[8] + J;
}

static void ExpandOpening(const LamResponse *r, Tensor dF[3], LamExpansion *e)
{
  Tensor Pg;

  InPlane(r->P_cohesion, Pg);
  e->opening = r->energy_cohesion;
  for (int a = 0; a < 3; a++) e->opening_gradient[a] = Contract(Pg, dF[a]);
  e->opening_gradient[3] = r->energy_turgor_cohesion;
}

static PetscBool PlaneStrain(const PetscReal F[9])
{
  const PetscReal tiny = 10 * PETSC_MACHINE_EPSILON;

  return (PetscBool)(fabs(F[2]) <= tiny && fabs(F[5]) <= tiny && fabs(F[6]) <= tiny && fabs(F[7]) <= tiny &&
                     fabs(F[8] - 1) <= tiny);
}

/* Cells that float have a stress, but may have no tangent. */
static PetscBool IsFinite(const LamExpansion *e)
{
  PetscReal sum = e->energy;

  for (int a = 0; a < 4; a++) {
    sum += e->gradient[a];
    for (int b = 0; b < 4; b++) sum += e->hessian[a][b];
  }
  return (PetscBool)isfinite(sum);
}

void LamExpansionMake(const LamResponse *record, LamExpansion *e)
{
  Tensor F, dF[3];

  memset(e, 0, sizeof(*e));
  e->x[0] = INFINITY;
  if (record->status != LAM_CONVERGED || !record->stable || !PlaneStrain(record->load.F)) return;
  InPlane(record->load.F, F);
  Invariants(F, e->x);
  e->x[3] = record->load.turgor;
  Variations(F, dF);
  ExpandEnergy(record, dF, e);
  ExpandThickness(record, dF, e);
  ExpandOpening(record, dF, e);
  AddFluid(1, e->x, &e->energy, e->gradient, e->hessian);
  if (!IsFinite(e)) e->x[0] = INFINITY;
}

/* ---- the nearest record ---- */

typedef struct {
  PetscInt record, image; /* record -1: none */
  PetscReal distance2;
} Nearest;

/* Contact tissue is expanded at fixed cohesion, up to the grid that a cache rounds its questions to; bonded tissue does
   not feel it. */
static PetscBool CohesionFits(LamDatabase db, PetscInt i, const LamLoad *load)
{
  const PetscReal other = db->scattered[i].load.cohesion;

  return (PetscBool)(db->header.micro.interface == LAM_INTERFACE_BONDED ||
                     fabs(other - load->cohesion) <= 1e-9 * (1 + fabs(other)));
}

/* Square of the distance; infinite for a record that cannot be used. */
static PetscReal Distance2(const PetscReal y[4], const PetscReal z[4])
{
  const PetscReal d0 = STRAIN_WEIGHT * (y[0] - z[0]), d1 = STRAIN_WEIGHT * (y[1] - z[1]);
  const PetscReal d2 = STRAIN_WEIGHT * (y[2] - z[2]), d3 = TURGOR_WEIGHT * (y[3] - z[3]);

  return d0 * d0 + d1 * d1 + d2 * d2 + d3 * d3;
}

static Nearest FindNearest(LamDatabase db, const LamLoad *load, const PetscReal x[4])
{
  Nearest best = {-1, 0, INFINITY};
  PetscReal limit = INFINITY; /* a candidate must be nearer than this; a tie is not */

  for (PetscInt image = 0; image < db->images.count; image++) {
    PetscReal y[4];

    MapForward(&db->images, image, x, y);
    for (PetscInt i = 0; i < db->scattered_count; i++) {
      const PetscReal d2 = Distance2(y, db->expansions[i].x);

      if (!(d2 < limit) || !CohesionFits(db, i, load)) continue;
      best = (Nearest){i, image, d2};
      limit = d2 - 2 * TIE * sqrt(d2);
    }
  }
  return best;
}

/*
  The record and image of the last answer where they are still within the radius, else the nearest. At an isotropic C
  all images are equally near, so the image must be kept too, or the answers would jump.
*/
static Nearest FindHintedOrNearest(LamDatabase db, const LamLoad *load, const PetscReal x[4], PetscReal radius,
                                   PetscInt hint)
{
  Nearest at = {hint / LAM_MAX_IMAGES, hint % LAM_MAX_IMAGES, INFINITY};

  if (hint >= 0 && at.record < db->scattered_count && at.image < db->images.count &&
      CohesionFits(db, at.record, load)) {
    PetscReal y[4];

    MapForward(&db->images, at.image, x, y);
    at.distance2 = Distance2(y, db->expansions[at.record].x);
    if (sqrt(at.distance2) <= radius && isfinite(at.distance2)) return at;
  }
  return FindNearest(db, load, x);
}

/* ---- expansion to answer ---- */

/* The model's value, gradient and Hessian at x, in the question's frame, fluid included. */
static void Evaluate(LamDatabase db, const Nearest *at, const PetscReal x[4], LamExpansion *model)
{
  const LamExpansion *e = &db->expansions[at->record];
  PetscReal y[4], delta[4];

  *model = *e;
  MapForward(&db->images, at->image, x, y);
  for (int a = 0; a < 4; a++) delta[a] = y[a] - e->x[a];
  for (int a = 0; a < 4; a++) {
    PetscReal slope = 0;

    for (int b = 0; b < 4; b++) slope += e->hessian[a][b] * delta[b];
    model->energy += (e->gradient[a] + 0.5 * slope) * delta[a];
    model->gradient[a] += slope;
    model->P33 += e->P33_gradient[a] * delta[a];
    model->opening += e->opening_gradient[a] * delta[a];
  }
  MapBack(&db->images, at->image, model->gradient);
  MapBack(&db->images, at->image, model->P33_gradient);
  MapBack(&db->images, at->image, model->opening_gradient);
  MapBackHessian(&db->images, at->image, model->hessian);
  AddFluid(-1, x, &model->energy, model->gradient, model->hessian);
}

/* The derivatives of P33 = (P33 + p J) - p J. */
static void ThicknessFluid(const PetscReal x[4], LamExpansion *model)
{
  PetscReal JC[3], JCC[3][3];
  const PetscReal J = Volume(x, JC, JCC);

  model->P33 -= x[3] * J;
  model->P33_gradient[3] -= J;
  for (int a = 0; a < 3; a++) model->P33_gradient[a] -= x[3] * JC[a];
}

/* sum_a v_a F D_a into the in-plane part of a 3x3 tensor. */
static void PushForward(Tensor K[3], const PetscReal v[3], PetscReal full[9])
{
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) full[3 * i + j] = v[0] * K[0][i][j] + v[1] * K[1][i][j] + v[2] * K[2][i][j];
}

static void FillTangent(const LamExpansion *m, Tensor K[3], PetscReal A3333, PetscReal A[81])
{
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      PetscReal slope[3] = {0}, *row = &A[27 * i + 9 * j], rest[9];

      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) slope[b] += K[a][i][j] * m->hessian[a][b];
      PushForward(K, slope, rest);
      for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2; l++) {
          PetscReal S = 0;

          for (int a = 0; a < 3; a++) S += m->gradient[a] * D[a][j][l];
          row[3 * k + l] = rest[3 * k + l] + (i == k ? S : 0);
        }
    }
  PushForward(K, m->P33_gradient, &A[72]);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) A[27 * i + 9 * j + 8] = A[72 + 3 * i + j];
  A[80] = A3333;
}

static PetscBool SameNumber(PetscReal a, PetscReal b)
{
  return (PetscBool)(fabs(a - b) <= 1e-10);
}

/* Stress, tangent and all else that the potential gives. */
static void FillPotential(const LamExpansion *m, Tensor F, const LamResponse *record, LamResponse *r)
{
  const PetscReal S_turgor[3] = {m->hessian[0][3], m->hessian[1][3], m->hessian[2][3]};
  Tensor K[3];

  for (int a = 0; a < 3; a++)
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) K[a][i][j] = F[i][0] * D[a][0][j] + F[i][1] * D[a][1][j];
  for (int i = 0; i < 9; i++) /* plane strain has no out-of-plane shear stress */
    r->P[i] = r->P_turgor[i] = r->P_cohesion[i] = 0;
  PushForward(K, m->gradient, r->P);
  PushForward(K, S_turgor, r->P_turgor);
  PushForward(K, m->opening_gradient, r->P_cohesion);
  r->P[8] = m->P33;
  r->P_turgor[8] = m->P33_gradient[3];
  r->P_cohesion[8] = record->P_cohesion[8];
  r->energy = m->energy;
  r->energy_turgor2 = m->hessian[3][3];
  r->energy_cohesion2 = record->energy_cohesion2;
  r->energy_turgor_cohesion = m->opening_gradient[3];
  r->energy_turgor = m->gradient[3];
  r->energy_cohesion = m->opening;
  /* derivatives of the potential are volumes only where all cells have the same turgor and cohesion */
  r->lumen_fraction = SameNumber(-record->energy_turgor, record->lumen_fraction) ? -m->gradient[3] : NAN;
  r->opening_fraction = SameNumber(record->energy_cohesion, record->opening_fraction) ? m->opening : NAN;
  FillTangent(m, K, record->tangent[80], r->tangent);
}

/*
  Radius over sqrt(accuracy). The expansion of the potential is of second order, so the stress error grows with the
  square of the distance: error = (distance / TRUST_COEFFICIENT)^2. Measured with tests/bench/bench_query.c on 480
  held-out states of the default tissue (principal strains -0.02 to 0.25): 99 % of the errors lie below that with
  0.286 to 0.296 at distances 0.005 to 0.04.
*/
static const PetscReal TRUST_COEFFICIENT = 0.28;

static PetscReal LamTrustRadius(PetscReal accuracy)
{
  return TRUST_COEFFICIENT * PetscSqrtReal(accuracy);
}

/*
  The stress of a second-order model of the energy is of first order, so its error grows with the square of the
  distance; LamTrustRadius holds the measured factor.
*/
static PetscReal ErrorEstimate(PetscReal distance)
{
  const PetscReal accuracy = 0.01, ratio = distance / LamTrustRadius(accuracy);

  return accuracy * ratio * ratio;
}

PetscBool LamQuestionIsGood(const LamLoad *load, LamResponse *r)
{
  const PetscReal *F = load->F;
  PetscReal sum = load->turgor + load->cohesion, J;

  for (int i = 0; i < 9; i++) sum += F[i];
  J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
  if (!isfinite(sum) || !(J > 0)) {
    r->status = LAM_INVALID_F;
    snprintf(r->reason, sizeof(r->reason), "det F = %g; a deformation gradient needs det F > 0", (double)J);
    return PETSC_FALSE;
  }
  if (!PlaneStrain(F)) {
    r->status = LAM_OUT_OF_REACH;
    PetscSNPrintf(r->reason, sizeof(r->reason),
                  "the records are of plane strain; F33 must be 1 and the out-of-plane shears 0");
    return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static void SetOutOfReach(const Nearest *at, PetscReal radius, LamResponse *r)
{
  r->status = LAM_OUT_OF_REACH;
  if (at->record < 0) {
    PetscSNPrintf(r->reason, sizeof(r->reason), "the database has no usable record (converged, stable, same cohesion)");
    return;
  }
  r->distance = sqrt(at->distance2);
  PetscSNPrintf(r->reason, sizeof(r->reason), "the nearest record is %.3g away in strain, %.3g is trusted",
                (double)r->distance, (double)radius);
}

static PetscErrorCode NearestQuery(LamDatabase database, const LamLoad *load, PetscReal radius, PetscInt *hint,
                                   LamResponse *response)
{
  Nearest at;
  LamExpansion model;
  PetscLogDouble start, end;
  PetscReal x[4];
  Tensor F;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(LamResponseInit(load, response));
  response->source = LAM_SOURCE_DATABASE;
  if (!LamQuestionIsGood(load, response)) PetscFunctionReturn(0);
  InPlane(load->F, F);
  Invariants(F, x);
  x[3] = load->turgor;
  at = FindHintedOrNearest(database, load, x, radius, hint ? *hint : -1);
  if (at.record < 0 || sqrt(at.distance2) > radius) {
    SetOutOfReach(&at, radius, response);
    PetscFunctionReturn(0);
  }
  Evaluate(database, &at, x, &model);
  ThicknessFluid(x, &model);
  FillPotential(&model, F, &database->scattered[at.record], response);
  LamIndicatorsCopy(&database->scattered[at.record], database->images.face[at.image], sqrt(at.distance2) < TIE,
                    database->header.micro.interface, response);
  response->status = LAM_CONVERGED;
  response->distance = sqrt(at.distance2);
  response->error_estimate = ErrorEstimate(response->distance);
  if (hint) *hint = LAM_MAX_IMAGES * at.record + at.image;
  PetscCall(PetscTime(&end));
  response->seconds = end - start;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseQuery(LamDatabase database, const LamLoad *load, PetscReal accuracy, LamResponse *response)
{
  LamTable table;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetTable(database, &table));
  if (table) {
    PetscCall(LamTableQuery(table, load, accuracy, response));
    PetscCall(LamTableDestroy(&table));
    if (response->status != LAM_OUT_OF_REACH || !database->scattered_count) PetscFunctionReturn(0);
  }
  PetscCall(NearestQuery(database, load, LamTrustRadius(accuracy), NULL, response));
  PetscFunctionReturn(0);
}
