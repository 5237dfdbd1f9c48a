/*
  lamella tradeoff: error against time over every knob of a scene that trades them.

  Method
    Each part of the work has its share of the budget; what one leaves the next may use. First the reference is made,
    which says at what states errors can be told. Then every setting of an RVE is measured once, the planned ones first,
    then from small to large, and again in interleaved rounds, so that a busy moment of the machine does not meet one
    setting alone; then tables and bodies. A setting that takes more than half of what is left to its part is given up,
    and told.
*/
#include "app.h"
#include "rounding.h"
#include "tradeoff.h"
#include <errno.h>
#include <lamella/clock.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Shares of the budget. */
typedef enum { PART_REFERENCE, PART_RVE, PART_REPEATS, PART_TABLES, PART_MACRO, PART_COUNT } Part;
static const PetscReal Shares[PART_COUNT] = {4, 3, 2, 4, 6};

typedef struct {
  const char *scene_path, *directory, *repeats_text, *budget_text, *only;
  PetscBool json, quiet;
  PetscInt repeats;
  PetscReal budget;
  PetscBool chosen[LAM_KNOB_COUNT];

  LamScene *scene;
  LamStates states;
  LamReference reference;
  PetscInt n;
  LamMeasurement *measured; /* owned */
  const char *why[LAM_KNOB_COUNT];
  char folder[PETSC_MAX_PATH_LEN]; /* of tables; removed at the end */
  PetscReal start, ends[PART_COUNT];
  LamProgress progress;
  PetscInt done, failed;
} Run;

static PetscBool Signalled(void)
{
  return (PetscBool)(LamStopExitStatus() != 0);
}

/* ---- one measurement ---- */

static PetscErrorCode TablePath(const Run *run, const LamSetting *setting, char path[PETSC_MAX_PATH_LEN])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, PETSC_MAX_PATH_LEN, "%s/table-%g.h5", run->folder, (double)setting->accuracy));
  PetscFunctionReturn(0);
}

/* The table of that accuracy; NULL: it was not built, or could not answer. */
static const LamMeasurement *FindTable(const Run *run, PetscReal accuracy)
{
  for (PetscInt i = 0; i < run->n; i++) {
    const LamMeasurement *m = &run->measured[i];

    if (m->setting.knob == LAM_KNOB_DATABASE && m->setting.accuracy == accuracy && m->nodes) return m;
  }
  return NULL;
}

/* What a body needs of the table that it queries; has_table PETSC_FALSE: m has the reason. */
static PetscErrorCode UseTable(const Run *run, LamMeasurement *m, PetscBool *has_table)
{
  const LamMeasurement *table = FindTable(run, m->setting.accuracy);

  PetscFunctionBeginUser;
  *has_table = (PetscBool)(table != NULL);
  if (!table) {
    PetscCall(PetscStrncpy(m->reason, "its table was not built", sizeof(m->reason)));
    PetscFunctionReturn(0);
  }
  m->build_cpu = table->build_cpu;
  m->build_wall = table->build_wall;
  PetscFunctionReturn(0);
}

static PetscErrorCode Measure(Run *run, PetscReal deadline, LamMeasurement *m)
{
  PetscBool possible = PETSC_TRUE;
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(TablePath(run, &m->setting, path));
  if (m->setting.knob == LAM_KNOB_MACRO && m->setting.response == LAM_FE2_DATABASE)
    PetscCall(UseTable(run, m, &possible));
  LamStopSetDeadline(deadline);
  if (possible) PetscCall(LamMeasure(run->scene, &run->states, path, m));
  LamStopSetDeadline(PETSC_INFINITY);
  run->done++;
  run->failed += !m->runs;
  PetscCall(LamProgressUpdate(&run->progress, run->done, run->failed));
  PetscFunctionReturn(0);
}

/* ---- all of them ---- */

static Part PartOf(LamKnob knob)
{
  return knob == LAM_KNOB_MACRO ? PART_MACRO : knob == LAM_KNOB_DATABASE ? PART_TABLES : PART_RVE;
}

/* Which comes first: what is planned, then what is small. */
static PetscReal Rank(const LamSetting *s)
{
  const LamMicrostructure *m = &s->micro;

  if (s->planned) return 0;
  if (s->accuracy > 0) return 1 / s->accuracy;
  return (PetscReal)(m->along * m->through) * (PetscReal)(m->cells[0] * m->cells[1]);
}

/* The first time for each setting of a part. */
static PetscErrorCode MeasureOnce(Run *run, Part part)
{
  PetscFunctionBeginUser;
  for (;;) {
    const PetscReal now = LamClock(), left = run->ends[part] - now;
    LamMeasurement *next = NULL;

    for (PetscInt i = 0; i < run->n; i++) {
      LamMeasurement *m = &run->measured[i];

      if (PartOf(m->setting.knob) != part || m->runs || m->reason[0]) continue;
      if (!next || Rank(&m->setting) < Rank(&next->setting)) next = m;
    }
    if (!next || Signalled()) PetscFunctionReturn(0);
    if (left <= 0)
      PetscCall(PetscStrncpy(next->reason, "left out: the time was over", sizeof(next->reason)));
    else
      PetscCall(Measure(run, next->setting.planned ? run->ends[part] : now + 0.5 * left, next));
    if (Signalled() && !next->runs) next->reason[0] = '\0';
  }
}

/* Seconds that a repeat takes: a body does not build its table again. */
static PetscReal MeasuredAnew(const LamMeasurement *m)
{
  return m->wall[0] - (m->setting.knob == LAM_KNOB_MACRO ? m->build_wall : 0);
}

/* Rounds over all that was measured, from `first` to `last`, while there is time. */
static PetscErrorCode Repeat(Run *run, PetscReal end, Part first, Part last)
{
  PetscFunctionBeginUser;
  for (PetscInt round = 1; round < run->repeats; round++) {
    for (PetscInt i = 0; i < run->n && !Signalled(); i++) {
      LamMeasurement *m = &run->measured[i];
      const Part part = PartOf(m->setting.knob);

      if (part < first || part > last || m->runs != round) continue;
      if (LamClock() + MeasuredAnew(m) < end) PetscCall(Measure(run, end, m));
    }
  }
  PetscFunctionReturn(0);
}

/* Bodies have one of their own. */
static PetscBool NeedsReference(const Run *run)
{
  for (PetscInt i = 0; i < run->n; i++)
    if (run->measured[i].setting.knob != LAM_KNOB_MACRO) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscErrorCode MeasureAll(Run *run)
{
  PetscFunctionBeginUser;
  if (NeedsReference(run)) {
    PetscCall(LamReferenceMake(run->scene, &run->states, run->ends[PART_REFERENCE], &run->reference));
    PetscCall(LamReferenceSkipUnused(&run->reference, &run->states));
  }
  PetscCall(MeasureOnce(run, PART_RVE));
  PetscCall(Repeat(run, run->ends[PART_REPEATS], PART_RVE, PART_RVE));
  PetscCall(MeasureOnce(run, PART_TABLES));
  PetscCall(MeasureOnce(run, PART_MACRO));
  PetscCall(Repeat(run, run->ends[PART_COUNT - 1], PART_RVE, PART_MACRO));
  PetscFunctionReturn(0);
}

/* ---- before and after ---- */

static PetscErrorCode AddSettings(Run *run, LamKnob knob)
{
  LamSetting *settings;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamSettingsMake(run->scene, knob, &n, &settings));
  PetscCall(PetscRealloc((size_t)(run->n + n) * sizeof(*run->measured), &run->measured));
  for (PetscInt i = 0; i < n; i++) PetscCall(LamMeasurementInit(&settings[i], &run->measured[run->n++]));
  PetscCall(PetscFree(settings));
  PetscFunctionReturn(0);
}

/* Parts that have nothing to do leave their share to the others. */
static void ShareBudget(Run *run)
{
  PetscReal share[PART_COUNT], sum = 0, end = 0;
  PetscBool needed[PART_COUNT] = {PETSC_FALSE};

  for (PetscInt i = 0; i < run->n; i++) needed[PartOf(run->measured[i].setting.knob)] = PETSC_TRUE;
  needed[PART_REFERENCE] = NeedsReference(run);
  needed[PART_REPEATS] = needed[PART_RVE];
  for (int p = 0; p < PART_COUNT; p++) sum += share[p] = needed[p] ? Shares[p] : 0;
  for (int p = 0; p < PART_COUNT; p++) run->ends[p] = run->start + run->budget * (end += share[p]) / sum;
}

static PetscErrorCode MakeFolder(Run *run)
{
  const char *temporary = getenv("TMPDIR");

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(run->folder, sizeof(run->folder), "%s/lamella-XXXXXX", temporary ? temporary : "/tmp"));
  PetscCheck(mkdtemp(run->folder), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", run->folder, strerror(errno));
  PetscFunctionReturn(0);
}

static PetscErrorCode RemoveFolder(const Run *run)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < run->n; i++) {
    if (run->measured[i].setting.knob != LAM_KNOB_DATABASE) continue;
    PetscCall(TablePath(run, &run->measured[i].setting, path));
    unlink(path);
  }
  rmdir(run->folder);
  PetscFunctionReturn(0);
}

/* The folder of the results is made before anything is measured. */
static PetscErrorCode CheckDirectory(const Run *run)
{
  struct stat status;

  PetscFunctionBeginUser;
  if (!run->directory) PetscFunctionReturn(0);
  PetscCheck((!mkdir(run->directory, 0777) || errno == EEXIST) && !stat(run->directory, &status), PETSC_COMM_SELF,
             PETSC_ERR_FILE_OPEN, "%s: %s", run->directory, strerror(errno));
  PetscCheck(S_ISDIR(status.st_mode), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: is no folder", run->directory);
  PetscCheck(!access(run->directory, W_OK | X_OK), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", run->directory,
             strerror(errno));
  PetscFunctionReturn(0);
}

static PetscErrorCode Prepare(Run *run)
{
  LamPlan plan;

  PetscFunctionBeginUser;
  run->start = LamClock();
  PetscCall(LamSceneRead(run->scene_path, &run->scene));
  PetscCall(CheckDirectory(run));
  PetscCall(LamPlanMake(run->scene, &plan));
  PetscCall(LamWarnOfDigits(PETSC_COMM_WORLD, &LamConsole, &plan.micro, run->scene->accuracy));
  run->scene->micro = plan.micro;
  PetscCall(LamStatesMake(run->scene, &run->states));
  PetscCheck(run->states.n || Signalled(), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: no state of its block load has an answer on the planned mesh", run->scene_path);
  for (int k = 0; k < LAM_KNOB_COUNT; k++) {
    if (!run->chosen[k])
      run->why[k] = "not asked for";
    else if (LamKnobApplies(run->scene, (LamKnob)k, &run->why[k]))
      PetscCall(AddSettings(run, (LamKnob)k));
  }
  ShareBudget(run);
  PetscCall(MakeFolder(run));
  PetscFunctionReturn(0);
}

static PetscErrorCode Tell(Run *run)
{
  LamTradeoff t = {.scene = run->scene,
                   .states = &run->states,
                   .reference = &run->reference,
                   .n = run->n,
                   .measured = run->measured,
                   .repeats = run->repeats,
                   .budget = run->budget,
                   .seconds = LamClock() - run->start,
                   .stopped = Signalled()};

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(t.why, run->why, LAM_KNOB_COUNT));
  PetscCall(LamJudge(&run->reference, &run->states, run->n, run->measured));
  if (run->json)
    PetscCall(LamTradeoffPrintJSON(&t));
  else
    LamTradeoffPrint(&t);
  if (run->directory) PetscCall(LamTradeoffWrite(&t, run->directory));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(Run *run)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < run->n; i++) PetscCall(LamMeasurementDestroy(&run->measured[i]));
  PetscCall(PetscFree(run->measured));
  PetscCall(LamReferenceDestroy(&run->reference));
  PetscCall(LamStatesDestroy(&run->states));
  PetscCall(LamSceneDestroy(&run->scene));
  PetscFunctionReturn(0);
}

/* 3 where the planned setting has no answer, or there is nothing to compare with. */
static int ExitStatus(const Run *run)
{
  if (Signalled()) return LamStopExitStatus();
  for (PetscInt i = 0; i < run->n; i++)
    if (run->measured[i].setting.planned && !run->measured[i].runs) return LAM_EXIT_UNSOLVED;
  return NeedsReference(run) && !run->reference.used_count ? LAM_EXIT_UNSOLVED : LAM_EXIT_OK;
}

static PetscErrorCode Solve(Run *run, int *exit_status)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(Prepare(run));
  PetscCall(LamProgressStart(&run->progress, run->n * run->repeats, run->quiet));
  ierr = MeasureAll(run);
  PetscCall(LamProgressEnd(&run->progress));
  PetscCall(RemoveFolder(run));
  PetscCall(ierr);
  PetscCall(Tell(run));
  *exit_status = ExitStatus(run);
  PetscCall(Destroy(run));
  PetscFunctionReturn(0);
}

/* ---- the command line ---- */

static PetscBool ReadFamilies(Run *run, int *exit_status)
{
  char text[256], *rest = text;

  for (int k = 0; k < LAM_KNOB_COUNT; k++) run->chosen[k] = (PetscBool)!run->only;
  snprintf(text, sizeof(text), "%s", run->only ? run->only : "");
  for (char *word = strsep(&rest, ","); run->only && word; word = strsep(&rest, ",")) {
    int k = 0;

    while (k < LAM_KNOB_COUNT && strcmp(word, LamKnobNames[k])) k++;
    if (k == LAM_KNOB_COUNT)
      return LamUsageError("tradeoff", "--only", word, "there are mesh, strategy, cells, tolerance, database, macro",
                           exit_status);
    run->chosen[k] = PETSC_TRUE;
  }
  return PETSC_TRUE;
}

static PetscBool ReadValues(Run *run, int *exit_status)
{
  char *end;

  if (!LamCountParse("tradeoff", "--repeats", run->repeats_text, 1, &run->repeats, exit_status)) return PETSC_FALSE;
  if (run->repeats > LAM_MOST_REPEATS)
    return LamUsageError("tradeoff", "--repeats", run->repeats_text, "100 at most", exit_status);
  if (run->budget_text) {
    run->budget = strtod(run->budget_text, &end);
    if (end == run->budget_text || *end || !(run->budget > 0) || PetscIsInfReal(run->budget))
      return LamUsageError("tradeoff", "--budget", run->budget_text, "a number of seconds is wanted, such as 120",
                           exit_status);
  }
  return ReadFamilies(run, exit_status);
}

/* Other ranks would share the processor, and the times would tell nothing. */
static PetscBool IsSerial(int *exit_status)
{
  PetscMPIInt size;

  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  if (size == 1) return PETSC_TRUE;
  if (LamAppIsRoot())
    fprintf(stderr, "lamella tradeoff: measures the time of one core; run it without mpirun, or on one rank\n");
  *exit_status = LAM_EXIT_USAGE;
  return PETSC_FALSE;
}

PetscErrorCode LamCommandTradeoff(LamArgs *args, int *exit_status)
{
  Run run = {.repeats = 3, .budget = 120};
  PetscBool done;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "DIR",
       "folder for tradeoff.json, tradeoff.png and .svg (the diagram) and model.json; made where it is missing",
       &run.directory},
      {0, "budget", LAM_OPTION_TEXT, "SECONDS", "how long it may measure, in all; default 120", &run.budget_text},
      {0, "repeats", LAM_OPTION_TEXT, "N", "how often each setting is measured; default 3", &run.repeats_text},
      {0, "only", LAM_OPTION_TEXT, "FAMILY,...", "of mesh, strategy, cells, tolerance, database, macro", &run.only},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object per setting on stdout", &run.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &run.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(
      args, "tradeoff SCENE [-o DIR] [--budget SECONDS] [--repeats N] [--only FAMILY,...] [--json] [--quiet]",
      "Measures error against time over the knobs of a scene that trade them.", options, 1, &run.scene_path, &done,
      exit_status));
  if (done || !ReadValues(&run, exit_status)) PetscFunctionReturn(0);
  PetscCall(args->start(args));
  if (IsSerial(exit_status)) PetscCall(Solve(&run, exit_status));
  PetscFunctionReturn(0);
}
