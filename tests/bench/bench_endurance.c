/*
  Memory and time of very many states in one process: bonded and contact tissue, prescribed F, mixed control, sealed
  lumens, states as bytes, estimates, responders, other tissues now and then, and with --failures every tenth state one
  that fails. Prints, for each tenth of the run, bytes in use and resident, Newton iterations per state, and the median
  processor time of a state of each kind relative to the first tenth, over the same of a yardstick, work that never
  changes (a processor shared with others is not always as fast); asserts nothing.

    bench_endurance [--states N] [--failures] [--rebuild-every N] [--kind NAME] [--time-failures]
      --states N         default 2000
      --rebuild-every N  every so many states another microstructure is set up, solved and destroyed; 0: never (default)
      --kind NAME        states of this kind alone, such as contact
      --time-failures    what each failure costs, and nothing else
*/
#include "support/endurance.h"
#include "options.h"
#include "measure.h"

#define PARTS 10
#define YARDSTICK 128
#define DEAR 100 /* of so many failures one takes thousands of iterations */

typedef struct {
  int states, rebuild_every, kind; /* kind: -1, all */
  int failures;
} Options;

/* Of a part of the run. */
typedef struct {
  size_t in_use, resident;
  double iterations;                   /* per state */
  double median[ENDURANCE_KIND_COUNT]; /* ms; 0: no such states */
  double yardstick;                    /* ms */
} Part;

typedef struct {
  const Options *options;
  Endurance e;
  double *ms[ENDURANCE_KIND_COUNT]; /* of the present part */
  int count[ENDURANCE_KIND_COUNT], all[ENDURANCE_KIND_COUNT];
  int capacity;
  double *yardstick; /* ms, of the present part */
  int yardsticks;
  long iterations; /* of the present part */
} Run;

/* Products of a matrix that fits the cache, as factors are. */
static void MeasureYardstick(Run *run)
{
  static double A[YARDSTICK][YARDSTICK], x[YARDSTICK], y[YARDSTICK];
  const double begin = 1e3 * ProcessorSeconds();

  for (int i = 0; i < YARDSTICK; i++) {
    x[i] = 1;
    for (int j = 0; j < YARDSTICK; j++) A[i][j] = 1.0 / (1 + i + j);
  }
  for (int repeat = 0; repeat < YARDSTICK; repeat++) {
    for (int i = 0; i < YARDSTICK; i++) {
      y[i] = 0;
      for (int j = 0; j < YARDSTICK; j++) y[i] += A[i][j] * x[j];
    }
    for (int i = 0; i < YARDSTICK; i++) x[i] = y[i] / y[0];
  }
  run->yardstick[run->yardsticks++] = 1e3 * ProcessorSeconds() - begin;
}

static PetscErrorCode Next(Run *run, int k)
{
  EnduranceKind kind = EnduranceKindOf(k, run->options->rebuild_every);
  double begin;
  LamResponse r;

  PetscFunctionBeginUser;
  if (k % 10 == 0) MeasureYardstick(run);
  begin = 1e3 * ProcessorSeconds();
  if (run->options->kind >= 0) kind = (EnduranceKind)run->options->kind;
  if (run->options->failures && k % 10 == 8) kind = ENDURANCE_FAILURE;
  if (kind == ENDURANCE_FAILURE)
    PetscCall(EnduranceFail(&run->e, EnduranceFailureOf(k, DEAR), k, &r));
  else
    PetscCall(EnduranceSolve(&run->e, kind, k, &r));
  run->iterations += r.newton_iterations;
  run->ms[kind][run->count[kind]++] = 1e3 * ProcessorSeconds() - begin;
  PetscFunctionReturn(0);
}

static Part EndPart(Run *run)
{
  Part part = {
      .in_use = MemoryInUse(), .resident = MemoryResident(), .iterations = (double)run->iterations / run->capacity};

  part.yardstick = Quantile(run->yardstick, run->yardsticks, 0.5);
  run->yardsticks = 0;
  run->iterations = 0;
  for (int kind = 0; kind < ENDURANCE_KIND_COUNT; kind++) {
    part.median[kind] = Quantile(run->ms[kind], run->count[kind], 0.5);
    run->all[kind] += run->count[kind];
    run->count[kind] = 0;
  }
  return part;
}

static void PrintParts(const Run *run, const Part parts[PARTS])
{
  printf("%6s %12s %12s %7s %9s", "states", "in use kB", "resident kB", "iter.", "yardstick");
  for (int kind = 0; kind < ENDURANCE_KIND_COUNT; kind++)
    if (run->all[kind]) printf(" %15s", endurance_names[kind]);
  printf("\n%6s %12s %12s %7s %6.2g ms", "", "", "", "", parts[0].yardstick);
  for (int kind = 0; kind < ENDURANCE_KIND_COUNT; kind++)
    if (run->all[kind]) printf("  %6d %4.2g ms", run->all[kind], parts[0].median[kind]);
  putchar('\n');
  for (int p = 0; p < PARTS; p++) {
    const double speed = parts[p].yardstick / parts[0].yardstick;

    printf("%6d %12.1f %12.1f %7.3f %9.3f", (p + 1) * run->capacity, (double)parts[p].in_use / 1024,
           (double)parts[p].resident / 1024, parts[p].iterations, speed);
    for (int kind = 0; kind < ENDURANCE_KIND_COUNT; kind++)
      if (run->all[kind]) printf(" %15.3f", parts[p].median[kind] / parts[0].median[kind] / speed);
    putchar('\n');
  }
}

static void PrintFailures(const Endurance *e)
{
  for (int f = 0; f < FAILURE_COUNT; f++) {
    printf("%-34s", failure_names[f]);
    for (int s = 0; s < LAM_STATUS_COUNT; s++)
      if (e->statuses[f][s]) printf(" %6d %s", (int)e->statuses[f][s], LamStatusNames[s]);
    putchar('\n');
  }
}

static PetscErrorCode Endure(const Options *options)
{
  Run run = {.options = options, .capacity = options->states / PARTS};
  Part parts[PARTS];

  PetscFunctionBeginUser;
  PetscCall(EnduranceCreate(&run.e));
  PetscCall(PetscCalloc1(run.capacity, &run.yardstick));
  for (int kind = 0; kind < ENDURANCE_KIND_COUNT; kind++) PetscCall(PetscCalloc1(run.capacity, &run.ms[kind]));
  for (int p = 0; p < PARTS; p++) {
    for (int k = 0; k < run.capacity; k++) PetscCall(Next(&run, p * run.capacity + k));
    parts[p] = EndPart(&run);
  }
  PrintParts(&run, parts);
  if (options->failures) PrintFailures(&run.e);
  printf("%d states answered otherwise than meant\n", (int)run.e.unexpected);
  for (int kind = 0; kind < ENDURANCE_KIND_COUNT; kind++) PetscCall(PetscFree(run.ms[kind]));
  PetscCall(PetscFree(run.yardstick));
  PetscCall(EnduranceDestroy(&run.e));
  PetscFunctionReturn(0);
}

static PetscErrorCode TimeFailures(void)
{
  Endurance e;
  LamResponse r;

  PetscFunctionBeginUser;
  PetscCall(EnduranceCreate(&e));
  for (int f = 0; f < FAILURE_COUNT; f++)
    for (int k = 0; k < 3; k++) {
      const double begin = 1e3 * ProcessorSeconds();

      PetscCall(EnduranceFail(&e, (EnduranceFailure)f, k, &r));
      printf("%-34s %8.2f ms %5d iterations %5d factorisations %s: %s\n", failure_names[f],
             1e3 * ProcessorSeconds() - begin, (int)r.newton_iterations, (int)r.factorisations,
             LamStatusNames[r.status], r.reason);
    }
  PetscCall(EnduranceDestroy(&e));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  Options options;
  PetscInt kind = -1;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (PetscOptionsGetEList(NULL, NULL, "--kind", endurance_names, ENDURANCE_KIND_COUNT, &kind, NULL)) return 1;
  options = (Options){.states = NumberOption("--states", 2000, PARTS, PETSC_MAX_INT),
                      .rebuild_every = NumberOption("--rebuild-every", 0, 0, PETSC_MAX_INT),
                      .kind = (int)kind,
                      .failures = HasOption("--failures")};
  if (HasOption("--time-failures") ? TimeFailures() : Endure(&options)) return 1;
  return EndBench();
}
