/*
  Error against time for every parameter of a scene that trades one for the other.

  Method

  Each part of the work has its share of the budget; unused time passes to the next part. First the reference is
  computed, which determines the states at which errors are resolved. Then every setting of an RVE is measured once, the
  planned ones first, then from small to large, and again in interleaved rounds, so that a busy moment of the machine
  does not affect one setting alone; then tables and bodies. A setting that takes more than half of the remaining time
  of its part is abandoned.
*/
#include "mesh_choice.h"
#include "rounding.h"
#include "tradeoff.h"
#include <errno.h>
#include "clock.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Shares of the budget. */
typedef enum { PART_REFERENCE, PART_RVE, PART_REPEATS, PART_TABLES, PART_MACRO } Part;
#define PART_COUNT LAM_TRADEOFF_PARTS
static const PetscReal Shares[PART_COUNT] = {4, 3, 2, 4, 6};

/* Stopped by a signal: LamStopRequested is also true at the deadline of a measurement. */
static PetscBool IsStopped(void)
{
  return (PetscBool)(LamStopSignal() != 0);
}

/* ---- one measurement ---- */

static PetscErrorCode TablePath(const LamTradeoff *t, const LamSetting *setting, char path[PETSC_MAX_PATH_LEN])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, PETSC_MAX_PATH_LEN, "%s/table-%g.h5", t->folder, (double)setting->accuracy));
  PetscFunctionReturn(0);
}

/* The table of that accuracy; NULL: it was not built, or its queries failed. */
static const LamMeasurement *FindTable(const LamTradeoff *t, PetscReal accuracy)
{
  for (PetscInt i = 0; i < t->n; i++) {
    const LamMeasurement *m = &t->measured[i];

    if (m->setting.knob == LAM_KNOB_DATABASE && m->setting.accuracy == accuracy && m->nodes) return m;
  }
  return NULL;
}

static PetscErrorCode Measure(LamTradeoff *t, PetscReal deadline, LamMeasurement *m)
{
  const PetscBool queries = (PetscBool)(m->setting.knob == LAM_KNOB_MACRO && m->setting.response == LAM_FE2_DATABASE);
  const LamMeasurement *table = queries ? FindTable(t, m->setting.accuracy) : NULL;
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(TablePath(t, &m->setting, path));
  if (table) {
    m->build_cpu = table->build_cpu;
    m->build_wall = table->build_wall;
  }
  LamStopSetDeadline(deadline);
  if (queries && !table)
    PetscCall(PetscStrncpy(m->reason, "its table was not built", sizeof(m->reason)));
  else
    PetscCall(LamMeasure(t->scene, &t->states, path, m));
  LamStopSetDeadline(PETSC_INFINITY);
  t->done++;
  t->failed += !m->runs;
  PetscCall(LamReportProgress(&t->reporter, t->done, t->n * t->repeats, t->failed));
  PetscFunctionReturn(0);
}

/* ---- all measurements ---- */

static Part PartOf(LamKnob knob)
{
  return knob == LAM_KNOB_MACRO ? PART_MACRO : knob == LAM_KNOB_DATABASE ? PART_TABLES : PART_RVE;
}

/* Order of the settings: planned first, then by size. */
static PetscReal Rank(const LamSetting *s)
{
  const LamMicrostructure *m = &s->micro;

  if (s->planned) return 0;
  if (s->accuracy > 0) return 1 / s->accuracy;
  return (PetscReal)(m->along * m->through) * (PetscReal)(m->cells[0] * m->cells[1]);
}

/* First run of each setting of a part. */
static PetscErrorCode MeasureOnce(LamTradeoff *t, Part part)
{
  PetscFunctionBeginUser;
  for (;;) {
    const PetscReal now = LamClock(), left = t->ends[part] - now;
    LamMeasurement *next = NULL;

    for (PetscInt i = 0; i < t->n; i++) {
      LamMeasurement *m = &t->measured[i];

      if (PartOf(m->setting.knob) != part || m->runs || m->reason[0]) continue;
      if (!next || Rank(&m->setting) < Rank(&next->setting)) next = m;
    }
    if (!next || IsStopped()) PetscFunctionReturn(0);
    if (left <= 0)
      PetscCall(PetscStrncpy(next->reason, "left out: the time was over", sizeof(next->reason)));
    else
      PetscCall(Measure(t, next->setting.planned ? t->ends[part] : now + 0.5 * left, next));
    if (IsStopped() && !next->runs) next->reason[0] = '\0';
  }
}

/* Seconds of a repeat: a body does not build its table again. */
static PetscReal MeasuredAnew(const LamMeasurement *m)
{
  return m->wall[0] - (m->setting.knob == LAM_KNOB_MACRO ? m->build_wall : 0);
}

/* Repeats the settings measured, parts `first` to `last`, in rounds while there is time. */
static PetscErrorCode Repeat(LamTradeoff *t, PetscReal end, Part first, Part last)
{
  PetscFunctionBeginUser;
  for (PetscInt round = 1; round < t->repeats; round++) {
    for (PetscInt i = 0; i < t->n && !IsStopped(); i++) {
      LamMeasurement *m = &t->measured[i];
      const Part part = PartOf(m->setting.knob);

      if (part < first || part > last || m->runs != round) continue;
      if (LamClock() + MeasuredAnew(m) < end) PetscCall(Measure(t, end, m));
    }
  }
  PetscFunctionReturn(0);
}

/* Bodies have their own reference. */
static PetscBool NeedsReference(const LamTradeoff *t)
{
  for (PetscInt i = 0; i < t->n; i++)
    if (t->measured[i].setting.knob != LAM_KNOB_MACRO) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscErrorCode MeasureAll(LamTradeoff *t)
{
  PetscFunctionBeginUser;
  if (NeedsReference(t)) PetscCall(LamReferenceMake(t->scene, &t->states, t->ends[PART_REFERENCE], &t->reference));
  PetscCall(MeasureOnce(t, PART_RVE));
  PetscCall(Repeat(t, t->ends[PART_REPEATS], PART_RVE, PART_RVE));
  PetscCall(MeasureOnce(t, PART_TABLES));
  PetscCall(MeasureOnce(t, PART_MACRO));
  PetscCall(Repeat(t, t->ends[PART_COUNT - 1], PART_RVE, PART_MACRO));
  PetscFunctionReturn(0);
}

/* ---- setup and cleanup ---- */

static PetscErrorCode AddSettings(LamTradeoff *t, LamKnob knob)
{
  LamSetting *settings;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamSettingsMake(t->scene, knob, &n, &settings));
  PetscCall(PetscRealloc((size_t)(t->n + n) * sizeof(*t->measured), &t->measured));
  for (PetscInt i = 0; i < n; i++) PetscCall(LamMeasurementInit(&settings[i], &t->measured[t->n++]));
  PetscCall(PetscFree(settings));
  PetscFunctionReturn(0);
}

/* Parts without work leave their share to the others. */
static void ShareBudget(LamTradeoff *t)
{
  PetscReal share[PART_COUNT], sum = 0, end = 0;
  PetscBool needed[PART_COUNT] = {PETSC_FALSE};

  for (PetscInt i = 0; i < t->n; i++) needed[PartOf(t->measured[i].setting.knob)] = PETSC_TRUE;
  needed[PART_REFERENCE] = NeedsReference(t);
  needed[PART_REPEATS] = needed[PART_RVE];
  for (int p = 0; p < PART_COUNT; p++) sum += share[p] = needed[p] ? Shares[p] : 0;
  for (int p = 0; p < PART_COUNT; p++) t->ends[p] = t->start + t->budget * (end += share[p]) / sum;
}

static PetscErrorCode MakeFolder(LamTradeoff *t)
{
  const char *temporary = getenv("TMPDIR");

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(t->folder, sizeof(t->folder), "%s/lamella-XXXXXX", temporary ? temporary : "/tmp"));
  PetscCheck(mkdtemp(t->folder), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", t->folder, strerror(errno));
  PetscFunctionReturn(0);
}

static PetscErrorCode RemoveFolder(const LamTradeoff *t)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n; i++) {
    if (t->measured[i].setting.knob != LAM_KNOB_DATABASE) continue;
    PetscCall(TablePath(t, &t->measured[i].setting, path));
    unlink(path);
  }
  rmdir(t->folder);
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(LamTradeoff *t)
{
  PetscFunctionBeginUser;
  t->start = LamClock();
  PetscCall(LamSceneRead(t->scene_path, &t->scene));
  PetscCall(LamChooseMesh(t->scene, NULL));
  PetscCall(LamWarnOfDigits(PETSC_COMM_WORLD, &t->reporter, &t->scene->micro, t->scene->accuracy));
  PetscCall(LamStatesMake(t->scene, &t->states));
  PetscCheck(t->states.n || IsStopped(), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: no state of its block load has a response on the planned mesh", t->scene_path);
  for (int k = 0; k < LAM_KNOB_COUNT; k++) {
    if (!t->chosen[k])
      t->why[k] = "not asked for";
    else if (LamKnobApplies(t->scene, (LamKnob)k, &t->why[k]))
      PetscCall(AddSettings(t, (LamKnob)k));
  }
  ShareBudget(t);
  PetscCall(MakeFolder(t));
  PetscFunctionReturn(0);
}

PetscErrorCode LamTradeoffRun(LamTradeoff *t)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(Prepare(t));
  ierr = MeasureAll(t);
  PetscCall(RemoveFolder(t));
  PetscCall(ierr);
  t->seconds = LamClock() - t->start;
  t->stopped = IsStopped();
  PetscCall(LamJudge(&t->reference, &t->states, t->n, t->measured));
  PetscFunctionReturn(0);
}

PetscBool LamTradeoffIsSolved(const LamTradeoff *t)
{
  for (PetscInt i = 0; i < t->n; i++)
    if (t->measured[i].setting.planned && !t->measured[i].runs) return PETSC_FALSE;
  return (PetscBool)(!NeedsReference(t) || t->reference.used_count);
}

PetscErrorCode LamTradeoffDestroy(LamTradeoff *t)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n; i++) PetscCall(LamMeasurementDestroy(&t->measured[i]));
  PetscCall(PetscFree(t->measured));
  PetscCall(PetscFree(t->reference.responses));
  PetscCall(PetscFree(t->reference.used));
  PetscCall(PetscFree(t->reference.difference));
  PetscCall(PetscFree(t->states.loads));
  PetscCall(PetscFree(t->states.skip));
  PetscCall(LamSceneDestroy(&t->scene));
  PetscFunctionReturn(0);
}
