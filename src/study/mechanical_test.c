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

/* What is prescribed, entry by entry: members of structs that are `stride` bytes apart. */
typedef struct {
  PetscInt first, count;
  const PetscReal *F;
  const LamStressControl *control; /* NULL: F alone */
  size_t F_stride, control_stride;
} Program;

static Program ProgramOfLoads(const LamScene *scene)
{
  return (Program){.first = scene->inflate ? 1 : 0, /* its start is known: F = I, or P = 0 */
                   .count = scene->load_count,
                   .F = scene->load_count ? scene->loads[0].F : NULL,
                   .control = scene->controls,
                   .F_stride = sizeof(LamLoad),
                   .control_stride = sizeof(LamStressControl)};
}

static Program ProgramOfLegs(const LamProcessSpec *spec)
{
  return (Program){.count = spec->leg_count,
                   .F = spec->leg_count ? spec->legs[0].F : NULL,
                   .control = spec->leg_count ? &spec->legs[0].control : NULL,
                   .F_stride = sizeof(LamProcessLeg),
                   .control_stride = sizeof(LamProcessLeg)};
}

static const LamStressControl *ControlAt(const Program *p, PetscInt k)
{
  return p->control ? (const LamStressControl *)(const void *)((const char *)p->control + (size_t)k * p->control_stride)
                    : NULL;
}

static const PetscReal *FAt(const Program *p, PetscInt k)
{
  return (const PetscReal *)(const void *)((const char *)p->F + (size_t)k * p->F_stride);
}

/* Sum of the changes of a component along the program, of F or of P; where it is free it counts as F = I or P = 0. */
static PetscReal Change(const Program *p, int i, PetscBool stress)
{
  const PetscReal none = stress ? 0 : i % 4 == 0;
  PetscReal sum = 0, before = none;

  for (PetscInt k = p->first; k < p->count; k++) {
    const LamStressControl *control = ControlAt(p, k);
    const PetscBool given = (PetscBool)(control && control->given[i]);
    const PetscReal value = given ? control->P[i] : FAt(p, k)[i];

    if (given == stress) sum += fabs(value - before);
    before = given == stress ? value : none;
  }
  return sum;
}

static int MostChanged(const Program *p, PetscBool stress)
{
  PetscReal most = LEAST_CHANGE;
  int component = -1;

  for (int k = 0; k < PLANE; k++) {
    const PetscReal change = Change(p, plane[k], stress);

    if (!(change > most)) continue;
    most = change;
    component = plane[k];
  }
  return component;
}

static LamTest Begin(const LamScene *scene, const Program *p)
{
  LamTest test = {.scene = scene,
                  .F0 = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                  .length = 1,
                  .area_factor = 1,
                  .volume = 1,
                  .unit = scene->scales.stress * 1e-6,
                  .lateral = -1};

  test.component = MostChanged(p, PETSC_FALSE);
  if (test.component < 0) test.component = MostChanged(p, PETSC_TRUE);
  if (test.component == 0) test.lateral = 4;
  if (test.component == 4) test.lateral = 0;
  return test;
}

void LamTestCreate(const LamScene *scene, LamTest *test)
{
  const Program program = ProgramOfLoads(scene);

  *test = Begin(scene, &program);
  test->inflated = scene->inflate;
  test->area = scene->area;
}

void LamTestMeasures(const LamTest *test, const LamResponse *response, PetscReal F[9], PetscReal P[9])
{
  const PetscReal *F0 = test->F0, J0 = F0[0] * F0[4] * F0[8];

  for (int i = 0; i < 9; i++) {
    const PetscReal length = F0[4 * (i % 3)];

    F[i] = response->load.F[i] / length;
    P[i] = response->P[i] * (test->area == LAM_AREA_INFLATED ? length / J0 : 1);
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

void LamTestSetInflated(LamTest *test, const PetscReal F0[9])
{
  const PetscBool inflated = (PetscBool)(test->area == LAM_AREA_INFLATED);

  for (int i = 0; i < 9; i++) test->F0[i] = F0[i];
  if (test->component < 0) return;
  test->length = F0[4 * (test->component % 3)];
  test->area_factor = inflated ? test->length / (F0[0] * F0[4] * F0[8]) : 1;
  test->volume = inflated ? 1 : test->length;
}

PetscErrorCode LamTestAddPoint(LamTest *test, LamTestPoint point)
{
  const LamTestPoint *last;

  PetscFunctionBeginUser;
  PetscCall(LamListGrow(test->count, sizeof(point), &test->capacity, &test->points));
  if (test->count) {
    last = &test->points[test->count - 1];
    point.energy = last->energy + test->volume * (point.strain - last->strain) * At(last, &point, 1).integral;
  }
  test->points[test->count++] = point;
  PetscFunctionReturn(0);
}

/* Strain and stress; nothing else is known. F, P: as LamTestMeasures gives them. */
static LamTestPoint PointOf(const LamTest *test, PetscInt state, const PetscReal F[9], const PetscReal P[9],
                            PetscBool jumped)
{
  const int d = test->component;

  return (LamTestPoint){.state = state,
                        .strain = F[d] - (d % 4 == 0),
                        .stress = P[d],
                        .modulus = NAN,
                        .poisson = NAN,
                        .lateral = test->lateral < 0 ? NAN : F[test->lateral],
                        .jumped = jumped};
}

PetscErrorCode LamTestAdd(LamTest *test, PetscInt state, const LamResponse *response, const LamStressControl *control)
{
  static const LamStressControl none = {0};
  const LamScene *scene = test->scene;
  PetscReal F[9], P[9], lateral;
  LamTestPoint point;

  PetscFunctionBeginUser;
  if (!LamResponseHasFields(response)) PetscFunctionReturn(0);
  if (scene->inflate && state == 1) {
    LamTestSetInflated(test, response->load.F);
    /* the slope at the start is that of the states to come */
    control = scene->load_count > 1 ? &scene->controls[1] : &none;
  }
  if (test->component < 0) PetscFunctionReturn(0);
  LamTestMeasures(test, response, F, P);
  point = PointOf(test, state, F, P, response->jumped);
  point.lateral = NAN;
  PetscCall(Slopes(test, response, control, &point.modulus, &lateral));
  point.modulus *= test->length * test->area_factor;
  if (test->lateral >= 0) point.poisson = -lateral * test->length / test->F0[test->lateral];
  PetscCall(LamTestAddPoint(test, point));
  PetscFunctionReturn(0);
}

/* Whether the lateral component is free in all parts in which the driven one is prescribed. */
static PetscBool LateralIsFree(const LamTest *test, const Program *p)
{
  for (PetscInt k = 0; k < p->count && test->lateral >= 0; k++)
    if (!ControlAt(p, k)->given[test->component] && !ControlAt(p, k)->given[test->lateral]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* F0 of a process: the ratio of F from rest and from there. */
static void Inflated(const LamProcessState *state, PetscReal F0[9])
{
  for (int i = 0; i < 9; i++) F0[i] = i % 4 ? 0 : state->response.load.F[i] / state->F[i];
}

void LamProcessMeasures(const LamScene *scene, const LamProcessState *state, PetscReal F[9], PetscReal P[9])
{
  LamTest test = {.component = -1, .area = scene->process.area};

  Inflated(state, test.F0);
  LamTestMeasures(&test, &state->response, F, P);
  for (int i = 0; i < 9; i++) F[i] = state->F[i]; /* F0 of cells that differ may have a shear */
}

/* When the component of F, or of P, is first driven. */
static PetscReal StartOf(const LamProcessSpec *spec, int i, PetscBool stress)
{
  PetscReal start = 0, before = stress ? 0 : i % 4 == 0;

  for (PetscInt k = 0; k < spec->leg_count; k++) {
    const LamProcessLeg *leg = &spec->legs[k];
    const PetscReal value = stress ? leg->control.P[i] : leg->F[i];

    if (leg->control.given[i] != stress)
      before = NAN;
    else if (!(fabs(value - before) <= LEAST_CHANGE))
      break;
    start += leg->duration;
  }
  return start;
}

PetscErrorCode LamTestOfProcess(const LamScene *scene, PetscInt count, const LamProcessState states[], LamTest *test)
{
  const LamProcessSpec *spec = &scene->process;
  const Program program = ProgramOfLegs(spec);
  PetscReal F0[9], start;

  PetscFunctionBeginUser;
  *test = Begin(scene, &program);
  test->inflated = spec->inflate;
  test->area = spec->area;
  if (test->component < 0 || !count) PetscFunctionReturn(0);
  start = StartOf(spec, test->component, (PetscBool) !(Change(&program, test->component, PETSC_FALSE) > LEAST_CHANGE));
  if (!LateralIsFree(test, &program)) test->lateral = -1;
  Inflated(&states[0], F0);
  LamTestSetInflated(test, F0);
  for (PetscInt k = 0; k < count; k++) {
    PetscReal F[9], P[9];

    if (states[k].time < start || !LamResponseHasFields(&states[k].response)) continue;
    LamProcessMeasures(scene, &states[k], F, P);
    PetscCall(LamTestAddPoint(test, PointOf(test, k, F, P, states[k].response.jumped)));
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

/* Where the strain begins to change; of lines between states those of the first one. */
static void ReadStart(const LamTest *test, LamTestReadings *r)
{
  const LamTestPoint *a = test->points, *end = test->points + test->count - 1;
  PetscReal h;

  while (a + 1 < end && fabs(a[1].strain - a->strain) <= LEAST_CHANGE) a++;
  r->modulus = a->modulus;
  r->poisson = a->poisson;
  if (a == end) return;
  h = a[1].strain - a->strain;
  if (isnan(r->modulus)) r->modulus = At(a, a + 1, 0).slope / h;
  if (isnan(r->poisson)) r->poisson = -(a[1].lateral - a->lateral) / h;
}

void LamTestRead(const LamTest *test, LamTestReadings *r)
{
  const LamTestMark unknown = {NAN, NAN};

  *r = (LamTestReadings){.modulus = NAN, .poisson = NAN, .bioyield = unknown, .peak = unknown, .energy_to_peak = NAN};
  if (!test->count) return;
  ReadStart(test, r);
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
