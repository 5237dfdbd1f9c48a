/*
  Stress-load curves of a series of states.
*/
#include "plot.h"
#include <math.h>
#include <stdio.h>

static PetscBool Differs(PetscReal a, PetscReal b)
{
  return (PetscBool)(!(PetscAbsReal(a - b) <= 1e-12)); /* also if one is NaN */
}

static PetscReal Norm9(const PetscReal a[9])
{
  PetscReal sum = 0;

  for (int i = 0; i < 9; i++) sum += a[i] * a[i];
  return PetscSqrtReal(sum);
}

/* F - I. */
static void Displacement(const LamLoad *load, PetscReal H[9])
{
  for (int i = 0; i < 9; i++) H[i] = load->F[i] - (i % 4 == 0);
}

/* Whether all F - I are multiples of the last one. */
static PetscBool Proportional(PetscInt n, const LamResponse records[])
{
  PetscReal D[9], H[9], norm, share;

  Displacement(&records[n - 1].load, D);
  norm = Norm9(D);
  if (!(norm > 0)) return PETSC_FALSE;
  for (PetscInt k = 0; k < n; k++) {
    Displacement(&records[k].load, H);
    share = Norm9(H) / norm;
    for (int i = 0; i < 9; i++)
      if (!(PetscAbsReal(H[i] - share * D[i]) <= 1e-9)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscBool Monotonic(PetscInt n, const PetscReal values[])
{
  for (PetscInt k = 2; k < n; k++)
    if (!((values[k] - values[k - 1]) * (values[1] - values[0]) > 0)) return PETSC_FALSE;
  return (PetscBool)(n > 1 && values[0] != values[1]);
}

/* The only component of F that varies; -1: none, -2: several. */
static int VaryingComponent(PetscInt n, const LamResponse records[])
{
  int component = -1;

  for (int i = 0; i < 9; i++) {
    for (PetscInt k = 1; k < n; k++) {
      if (!Differs(records[k].load.F[i], records[0].load.F[i])) continue;
      if (component >= 0) return -2;
      component = i;
      break;
    }
  }
  return component;
}

/* The component of F that does nearly all of the work, such as the one that is pulled with free sides; -2: none. */
static int WorkingComponent(PetscInt n, const LamResponse records[])
{
  PetscReal work[9] = {0}, total = 0;
  int most = 0;

  for (int i = 0; i < 9; i++) {
    for (PetscInt k = 1; k < n; k++) {
      const PetscReal w = (records[k].P[i] + records[k - 1].P[i]) * (records[k].load.F[i] - records[k - 1].load.F[i]);

      if (isfinite(w)) work[i] += fabs(w);
    }
    total += work[i];
    if (work[i] > work[most]) most = i;
  }
  return work[most] > 0.99 * total && total > 0 ? most : -2;
}

PetscErrorCode LamLoadAxisChoose(PetscInt n, const LamResponse records[], const PetscInt64 keys[],
                                 const LamScales *scales, LamLoadAxis *axis, PetscReal values[])
{
  int component = VaryingComponent(n, records);
  PetscBool turgor = PETSC_FALSE, cohesion = PETSC_FALSE, found = PETSC_FALSE, works = PETSC_FALSE;
  PetscReal H[9];

  PetscFunctionBeginUser;
  for (PetscInt k = 1; k < n; k++) {
    turgor = (PetscBool)(turgor || Differs(records[k].load.turgor, records[0].load.turgor));
    cohesion = (PetscBool)(cohesion || Differs(records[k].load.cohesion, records[0].load.cohesion));
  }
  *axis = (LamLoadAxis){"", NULL, PETSC_FALSE, -1};
  if (component == -2 && !turgor && !cohesion && !Proportional(n, records)) {
    component = WorkingComponent(n, records);
    works = (PetscBool)(component >= 0);
  }
  if (component >= 0 && !turgor && !cohesion) {
    found = PETSC_TRUE;
    axis->component = component;
    snprintf(axis->label, sizeof axis->label, "$F$_{%d%d}", component / 3 + 1, component % 3 + 1);
    for (PetscInt k = 0; k < n; k++) values[k] = records[k].load.F[component];
  } else if (component == -2 && !turgor && !cohesion && Proportional(n, records)) {
    found = PETSC_TRUE;
    snprintf(axis->label, sizeof axis->label, "‖$F$ \u2212 $I$‖");
    for (PetscInt k = 0; k < n; k++) {
      Displacement(&records[k].load, H);
      values[k] = Norm9(H);
    }
  } else if (component == -1 && turgor != cohesion) {
    found = PETSC_TRUE;
    snprintf(axis->label, sizeof axis->label, turgor ? "turgor $p$" : "cohesion $g$");
    axis->unit = "MPa";
    for (PetscInt k = 0; k < n; k++)
      values[k] = (turgor ? records[k].load.turgor : records[k].load.cohesion) * scales->stress * 1e-6;
  }
  if (!found || (!works && !Monotonic(n, values))) {
    *axis = (LamLoadAxis){"state", NULL, PETSC_TRUE, -1};
    for (PetscInt k = 0; k < n; k++) values[k] = (PetscReal)keys[k];
  }
  PetscFunctionReturn(0);
}

PetscInt LamStressPeak(PetscInt n, const LamResponse records[])
{
  const LamResponse *first = NULL;
  PetscReal largest = 0;
  PetscInt peak = -1;

  for (PetscInt k = 0; k < n; k++) {
    const LamResponse *r = &records[k];
    PetscReal way[9], work = 0;

    if (!LamResponseHasFields(r)) continue;
    if (!first) first = r;
    for (int i = 0; i < 9; i++) {
      way[i] = r->load.F[i] - first->load.F[i];
      work += (r->P[i] - first->P[i]) * way[i];
    }
    /* free tissue swells without stress, up to rounding: 1e-6, as LamReactionsGet, of the stress of the fluid */
    if (!(work > PetscMax(largest, 1e-6 * r->load.turgor) * Norm9(way))) continue;
    largest = work / Norm9(way);
    peak = k;
  }
  return peak;
}

/* Curves of P11, P12, P21, P22 in MPa, with gaps at states that did not converge. */
static PetscErrorCode StressSeries(PetscInt n, const LamResponse records[], const PetscReal load[], PetscReal stress,
                                   LamSeries series[4])
{
  static const int components[4] = {0, 1, 3, 4};

  PetscFunctionBeginUser;
  for (int c = 0; c < 4; c++) {
    const int i = components[c];

    PetscCall(LamSeriesCreate(n, &series[c]));
    series[c].style = (LamStyle){LamColourOfLine(c), (LamMarker)c, (PetscBool)(c % 2), PETSC_TRUE, (PetscBool)(c > 1)};
    snprintf(series[c].label, sizeof series[c].label, "$P$_{%d%d}", i / 3 + 1, i % 3 + 1);
    for (PetscInt k = 0; k < n; k++) {
      series[c].x[k] = load[k];
      series[c].y[k] = LamResponseHasFields(&records[k]) ? records[k].P[i] * stress : NAN;
    }
  }
  PetscFunctionReturn(0);
}

/* Crosses for the states of the given kind, below all curves (these states have no stress). */
static PetscErrorCode FailureSeries(PetscInt n, const LamResponse records[], const PetscReal load[],
                                    const LamSeries stresses[4], LamSeries *series)
{
  LamAxes limits = {.x.low = 0};
  PetscInt failed = 0;

  PetscFunctionBeginUser;
  LamAxesEmpty(&limits);
  for (int c = 0; c < 4; c++) LamSeriesExtend(&stresses[c], &limits);
  if (!(limits.y.low <= limits.y.high)) limits.y.low = limits.y.high = 0;
  PetscCall(LamSeriesCreate(n, series));
  series->style = (LamStyle){{0, 0, 0}, LAM_MARKER_CROSS, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
  for (PetscInt k = 0; k < n; k++) {
    const PetscBool answered = LamResponseHasFields(&records[k]);

    failed += !answered;
    series->x[k] = load[k];
    series->y[k] = answered ? NAN : limits.y.low - 0.1 * (limits.y.high - limits.y.low);
  }
  if (failed) snprintf(series->label, sizeof series->label, "no answer");
  PetscFunctionReturn(0);
}

/* Rings around the markers of states whose equilibrium is unstable. */
static PetscErrorCode UnstableSeries(PetscInt n, const LamResponse records[], const LamSeries stresses[4],
                                     LamSeries *series)
{
  PetscInt unstable = 0;

  PetscFunctionBeginUser;
  PetscCall(LamSeriesCreate(4 * n, series));
  series->style = (LamStyle){{0, 0, 0}, LAM_MARKER_RING, PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
  for (PetscInt k = 0; k < n; k++) {
    const PetscBool ring = (PetscBool)(records[k].status == LAM_UNSTABLE);

    unstable += ring;
    for (int c = 0; c < 4; c++) {
      series->x[4 * k + c] = stresses[c].x[k];
      series->y[4 * k + c] = ring ? stresses[c].y[k] : NAN;
    }
  }
  if (unstable) snprintf(series->label, sizeof series->label, "unstable");
  PetscFunctionReturn(0);
}

static void DrawMark(LamCanvas canvas, const LamAxes *axes, const LamTest *test, LamTestMark mark, const char name[])
{
  const PetscReal F = (mark.strain + (test->component % 4 == 0)) * test->length; /* from rest, as the axis is */

  if (isfinite(F)) LamAxesMark(canvas, axes, F, (LamColour){0.45, 0.45, 0.5}, PETSC_TRUE, name);
}

static void DrawReadings(LamCanvas canvas, const LamAxes *axes, const LamTest *test)
{
  LamTestReadings r;

  LamTestRead(test, &r);
  DrawMark(canvas, axes, test, r.bioyield, "bioyield");
  if (r.passed) DrawMark(canvas, axes, test, r.peak, "peak");
}

PetscErrorCode LamStressChart(LamCanvas canvas, LamRect outer, PetscInt n, const LamResponse records[],
                              const PetscInt64 keys[], const LamScales *scales, const LamTest *test)
{
  LamSeries series[6];
  LamLoadAxis load;
  LamAxes axes = {.y = {.label = "effective stress $P$", .unit = "MPa"}};
  PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &values));
  PetscCall(LamLoadAxisChoose(n, records, keys, scales, &load, values));
  axes.x.label = load.label;
  axes.x.unit = load.unit;
  axes.x.whole = load.whole;
  PetscCall(StressSeries(n, records, values, scales->stress * 1e-6, &series[0]));
  PetscCall(UnstableSeries(n, records, &series[0], &series[4]));
  PetscCall(FailureSeries(n, records, values, &series[0], &series[5]));
  LamChart(canvas, outer, &axes, 6, series);
  if (test->count > 1 && test->component == load.component) DrawReadings(canvas, &axes, test);
  for (int c = 0; c < 6; c++) PetscCall(LamSeriesDestroy(&series[c]));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}
