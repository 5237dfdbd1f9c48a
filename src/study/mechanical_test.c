/*
  Mechanical tests.

  Method. With the free components f of F at prescribed stress, the driven component d changes P_d by
  A_dd - A_df A_ff^-1 A_fd and the free ones by -A_ff^-1 A_fd. So the curve has exact slopes, and between states it is
  taken as the cubic with the values and slopes at both (Hermite): maxima, energies and moduli are those of the cubic.
*/
#include "mechanical_test.h"
#include <math.h>
#include <petscblaslapack.h>

#define LEAST_CHANGE 1e-12 /* of a component that is driven */

static const int plane[] = {0, 1, 3, 4, 8}; /* components of F in plane strain */
#define PLANE 5

/* Sum of the changes of a component along the load while it is prescribed, of F or of P. */
static PetscReal Change(const LamScene *scene, int i, PetscBool stress)
{
  const PetscInt first = scene->inflate ? 1 : 0; /* its start is known: F = I, or P = 0 */
  PetscReal sum = 0, before = stress ? 0 : i % 4 == 0;

  for (PetscInt k = first; k < scene->load_count; k++) {
    const LamStressControl *control = scene->controls ? &scene->controls[k] : NULL;
    const PetscBool given = (PetscBool)(control && control->given[i]);
    const PetscReal value = given ? control->P[i] : scene->loads[k].F[i];

    if (given == stress && isfinite(before)) sum += fabs(value - before);
    before = given == stress ? value : NAN;
  }
  return sum;
}

static int MostChanged(const LamScene *scene, PetscBool stress)
{
  PetscReal most = LEAST_CHANGE;
  int component = -1;

  for (int k = 0; k < PLANE; k++) {
    const PetscReal change = Change(scene, plane[k], stress);

    if (!(change > most)) continue;
    most = change;
    component = plane[k];
  }
  return component;
}

void LamTestCreate(const LamScene *scene, LamTest *test)
{
  *test =
      (LamTest){.scene = scene, .F0 = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .length = 1, .area = 1, .volume = 1, .lateral = -1};
  test->component = MostChanged(scene, PETSC_FALSE);
  if (test->component < 0) test->component = MostChanged(scene, PETSC_TRUE);
  if (test->component == 0) test->lateral = 4;
  if (test->component == 4) test->lateral = 0;
}

void LamTestMeasures(const LamTest *test, const LamResponse *response, PetscReal F[9], PetscReal P[9])
{
  const PetscReal *F0 = test->F0, J0 = F0[0] * F0[4] * F0[8];

  for (int i = 0; i < 9; i++) {
    const PetscReal length = F0[4 * (i % 3)];

    F[i] = response->load.F[i] / length;
    P[i] = response->P[i] * (test->scene->area == LAM_AREA_INFLATED ? length / J0 : 1);
  }
}

/* Derivatives with respect to the driven component: of its stress, and of the lateral component (NaN: not free). */
static PetscErrorCode Slopes(const LamTest *test, const LamResponse *r, const LamStressControl *control,
                             PetscReal *modulus, PetscReal *lateral)
{
  PetscBLASInt n = 0, one = 1, size = PLANE, info = 0, pivots[PLANE];
  int loose[PLANE];
  PetscReal A[PLANE * PLANE], x[PLANE];

  PetscFunctionBeginUser;
  for (int k = 0; k < PLANE && control; k++)
    if (control->given[plane[k]] && plane[k] != test->component) loose[n++] = plane[k];
  for (int k = 0; k < n; k++) {
    x[k] = -r->tangent[9 * loose[k] + test->component];
    for (int l = 0; l < n; l++) A[k + PLANE * l] = r->tangent[9 * loose[k] + loose[l]];
  }
  if (n) LAPACKgesv_(&n, &one, A, &size, pivots, x, &size, &info);
  *modulus = info ? NAN : r->tangent[10 * test->component];
  *lateral = NAN;
  for (int k = 0; k < n && !info; k++) {
    *modulus += r->tangent[9 * test->component + loose[k]] * x[k];
    if (loose[k] == test->lateral) *lateral = x[k];
  }
  PetscFunctionReturn(0);
}

/* ---- the curve between two states ---- */

/* Stress at a fraction t of the strain between two states, its derivative with respect to t, and its integral from 0
   over t. A straight line where a slope is not known, or the second state was reached by a jump. */
typedef struct {
  PetscReal value, slope, integral;
} Between;

static Between At(const LamTestPoint *a, const LamTestPoint *b, PetscReal t)
{
  const PetscReal h = b->strain - a->strain, rise = b->stress - a->stress;
  PetscReal m0 = h * a->modulus, m1 = h * b->modulus, c2, c3;

  if (b->jumped || !isfinite(m0 + m1)) m0 = m1 = rise;
  c2 = 3 * rise - 2 * m0 - m1;
  c3 = m0 + m1 - 2 * rise;
  return (Between){.value = a->stress + t * (m0 + t * (c2 + t * c3)),
                   .slope = m0 + t * (2 * c2 + t * 3 * c3),
                   .integral = t * (a->stress + t * (m0 / 2 + t * (c2 / 3 + t * c3 / 4)))};
}

/* The fraction at which sign times the stress has a maximum before the second state, which may be at the first if the
   curve falls from there; NaN: none. */
static PetscReal Maximum(const LamTestPoint *a, const LamTestPoint *b, PetscReal sign)
{
  const Between start = At(a, b, 0), middle = At(a, b, 0.5), end = At(a, b, 1);
  /* slope = p + q t + r t^2 */
  const PetscReal p = sign * start.slope, r = sign * 2 * (start.slope - 2 * middle.slope + end.slope);
  const PetscReal q = sign * (end.slope - start.slope) - r, root = q * q - 4 * r * p;

  if (p <= 0) return sign * (end.value - start.value) < 0 ? 0 : NAN;
  if (root < 0 || !isfinite(root)) return NAN;

  const PetscReal down = -2 * p / (q - PetscSqrtReal(root)); /* where the slope falls through 0 */

  return down > 0 && down < 1 ? down : NAN;
}

static void SetInflated(LamTest *test, const PetscReal F0[9])
{
  const PetscBool inflated = (PetscBool)(test->scene->area == LAM_AREA_INFLATED);

  for (int i = 0; i < 9; i++) test->F0[i] = F0[i];
  if (test->component < 0) return;
  test->length = F0[4 * (test->component % 3)];
  test->area = inflated ? test->length / (F0[0] * F0[4] * F0[8]) : 1;
  test->volume = inflated ? 1 : test->length;
}

PetscErrorCode LamTestAdd(LamTest *test, PetscInt state, const LamResponse *response, const LamStressControl *control)
{
  static const LamStressControl none = {0};
  const LamScene *scene = test->scene;
  const int d = test->component;
  LamTestPoint *point;
  PetscReal F[9], P[9], lateral;

  PetscFunctionBeginUser;
  if (!LamResponseHasFields(response)) PetscFunctionReturn(0);
  if (scene->inflate && state == 1) {
    SetInflated(test, response->load.F);
    /* the slope at the start is that of the states to come */
    control = scene->load_count > 1 ? &scene->controls[1] : &none;
  }
  if (d < 0) PetscFunctionReturn(0);
  PetscCall(LamListGrow(test->count, sizeof(*point), &test->capacity, &test->points));
  point = &test->points[test->count++];
  LamTestMeasures(test, response, F, P);
  *point = (LamTestPoint){
      .state = state, .strain = F[d] - (d % 4 == 0), .stress = P[d], .poisson = NAN, .jumped = response->jumped};
  PetscCall(Slopes(test, response, control, &point->modulus, &lateral));
  point->modulus *= test->length * test->area;
  if (test->lateral >= 0) point->poisson = -lateral * test->length / test->F0[test->lateral];
  if (test->count > 1) {
    const LamTestPoint *a = point - 1;

    point->energy = a->energy + test->volume * (point->strain - a->strain) * At(a, point, 1).integral;
  }
  PetscFunctionReturn(0);
}

/* ---- what is read off ---- */

/* Sign of the largest change of the stress since the first state. */
static PetscReal Direction(const LamTest *test)
{
  PetscReal largest = 0;

  for (PetscInt k = 1; k < test->count; k++) {
    const PetscReal change = test->points[k].stress - test->points[0].stress;

    if (fabs(change) > fabs(largest)) largest = change;
  }
  return largest < 0 ? -1 : 1;
}

static PetscBool Grows(const LamTestPoint *a, const LamTestPoint *b)
{
  return (PetscBool)(fabs(b->strain) > fabs(a->strain));
}

static LamTestMark Mark(const LamTestPoint *a, const LamTestPoint *b, PetscReal t)
{
  return (LamTestMark){a->strain + t * (b->strain - a->strain), At(a, b, t).value};
}

/* The peak is this mark, if it is the largest so far. */
static void TakePeak(LamTestReadings *r, LamTestMark mark, PetscReal sign, PetscReal energy, PetscBool passed)
{
  if (sign * mark.stress < sign * r->peak.stress) return; /* NaN: none so far */
  r->peak = mark;
  r->energy_to_peak = energy;
  r->passed = passed;
}

static void ReadMaxima(const LamTest *test, LamTestReadings *r)
{
  const LamTestPoint *start = test->points;
  const PetscReal sign = Direction(test);
  LamTestMark first = {NAN, NAN};

  TakePeak(r, (LamTestMark){start->strain, start->stress}, sign, 0, PETSC_FALSE);
  for (PetscInt k = 1; k < test->count; k++) {
    const LamTestPoint *a = &test->points[k - 1], *b = &test->points[k];
    const PetscReal t = Grows(a, b) ? Maximum(a, b, sign) : NAN;

    if (isfinite(t)) {
      const LamTestMark mark = Mark(a, b, t);

      if (isnan(first.strain)) first = mark;
      TakePeak(r, mark, sign, a->energy + test->volume * (b->strain - a->strain) * At(a, b, t).integral, PETSC_TRUE);
    }
    TakePeak(r, (LamTestMark){b->strain, b->stress}, sign, b->energy, PETSC_FALSE);
  }
  if (isfinite(first.strain) && first.strain != r->peak.strain) r->bioyield = first;
}

void LamTestRead(const LamTest *test, LamTestReadings *r)
{
  const LamTestMark unknown = {NAN, NAN};

  *r = (LamTestReadings){.modulus = NAN, .poisson = NAN, .bioyield = unknown, .peak = unknown, .energy_to_peak = NAN};
  if (!test->count) return;
  r->modulus = test->points[0].modulus;
  r->poisson = test->points[0].poisson;
  for (PetscInt k = 1; k < test->count; k++) {
    const PetscReal energy = test->points[k].energy - test->points[k - 1].energy;

    if (Grows(&test->points[k - 1], &test->points[k]))
      r->work += energy;
    else
      r->returned -= energy;
  }
  ReadMaxima(test, r);
}

PetscBool LamTestAt(const LamTest *test, PetscReal strain, PetscReal *stress, PetscReal *secant, PetscReal *tangent)
{
  for (PetscInt k = 1; k < test->count; k++) {
    const LamTestPoint *a = &test->points[k - 1], *b = &test->points[k];
    const PetscReal h = b->strain - a->strain, t = (strain - a->strain) / h;
    Between at;

    if (!(t >= 0 && t <= 1)) continue;
    at = At(a, b, t);
    *stress = at.value;
    *tangent = at.slope / h;
    *secant = (at.value - test->points[0].stress) / (strain - test->points[0].strain);
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscErrorCode LamTestDestroy(LamTest *test)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(test->points));
  test->count = test->capacity = 0;
  PetscFunctionReturn(0);
}

/* ---- loads from the inflated tissue ---- */

void LamLoadsFromInflated(LamScene *scene, const PetscReal F0[9])
{
  const PetscReal J0 = F0[0] * F0[4] * F0[8];

  for (PetscInt k = 1; k < scene->load_count; k++)
    for (int i = 0; i < 9; i++) {
      const PetscReal length = F0[4 * (i % 3)];

      scene->loads[k].F[i] *= length;
      if (scene->area == LAM_AREA_INFLATED) scene->controls[k].P[i] *= J0 / length;
    }
}
