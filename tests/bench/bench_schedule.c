/*
  How `lamella build` scales: its own decisions (schedule.c) on simulated ranks, 2 to 100,000 of them. Prints figures,
  asserts nothing; dispatch_model.h says what is simulated, docs/results/scaling.md what came out.
    bench_schedule                         the small tables, half a minute
    bench_schedule --full                  all tables, up to 1e9 samples on 100,000 ranks
    bench_schedule --ranks N ...           one case; every value has its option (--help)
  The work is that of figures_work.h, of contact tissue, whose pieces travel with the state of a node, unless --database
  FILE gives another; bonded tissue is --describe 64 --result 2000 besides.
*/
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include <figures_work.h>
#include "dispatch_simulation.h"

/* docs/results/scaling.md, Constants. */
static const Costs measured = {.latency = 2e-6,
                               .bandwidth = 5e9,
                               .message = 1e-6,
                               .byte = 0.21e-9,
                               .piece = 2e-6,
                               .pause = 1e-3,
                               .describe_bytes = 13100,
                               .result_bytes = 15000,
                               .node_bytes = 13700,
                               .bundle_bytes = 65536,
                               .bundle_age = 0.02,
                               .answer = 5e-3,
                               .answer_root = 5e-3,
                               .commit = 0.008,
                               .commit_record = 5e-6,
                               .poll = 0.05,
                               .poll_node = 0.2e-6,
                               .choose = 2e-6,
                               .restart = 60,
                               .read_record = 1e-6};
/* As build_rounds.c has it, and LAM_DISPATCH_GROUP. */
static const Case usual = {.group = 128,
                           .scale = 1,
                           .grain = 64,
                           .least_round = 32,
                           .round_share = 12,
                           .open_rounds = 2,
                           .jobs = 1,
                           .machine = 100,
                           .seed = 1};
enum { FLAT = 1 << 30 };

static void Tell(double share)
{
  if (isatty(STDERR_FILENO)) fprintf(stderr, "\r%5.1f %%  \r", 100 * share);
}

/* ---- one line ---- */

/* What keeps ranks from being busy most of all. */
static const char *Limit(const Outcome *o)
{
  const PetscReal serial = o->handing + o->committing + o->polling;

  if (o->busy > 0.95) return "";
  if (o->lost > o->starved && o->lost > o->waiting) return "failures";
  if (o->starved > o->waiting) return "rounds";
  if (serial > 0.5 && o->committing > o->handing) return "the file";
  if (serial > 0.5) return "rank 0's messages";
  return o->leading > 0.5 ? "leaders' messages" : "answers";
}

static void PrintHead(const char title[])
{
  printf("\n%s\n%8s %8s %8s %6s %6s %9s %6s %8s %8s %6s %7s %7s %6s %7s  %s\n", title, "ranks", "samples", "ms each",
         "group", "jobs", "s", "busy %", "no work", "waiting", "lost", "handing", "commits", "polls", "leaders",
         "limit");
}

static PetscErrorCode PrintCase(const Case *c, const Costs *costs, const WorkTable *table)
{
  Outcome o;

  PetscFunctionBeginUser;
  PetscCall(SimulateJobs(c, costs, table, Tell, &o));
  printf("%8d %8.0e %8.3g %6s %6d %9.4g %6.1f %8.1f %8.1f %6.1f %7.1f %7.1f %6.1f %7.1f  %s\n", (int)c->ranks,
         (double)c->samples, 1e3 * o.work, c->ranks > c->group + 1 ? "tree" : "flat", (int)c->jobs, o.seconds,
         100 * o.busy, 100 * o.starved, 100 * o.waiting, 100 * o.lost, 100 * o.handing, 100 * o.committing,
         100 * o.polling, 100 * o.leading, Limit(&o));
  fflush(stdout);
  PetscFunctionReturn(0);
}

/* ---- tables ---- */

/* All pieces are known at the beginning: the dispatcher alone. */
static PetscErrorCode DispatcherTable(const WorkTable *table, PetscInt most)
{
  static const PetscReal scales[] = {1, 10, 100};

  PetscFunctionBeginUser;
  PrintHead("The dispatcher alone: 1000 pieces a rank, all known at the beginning; flat, and groups of 128");
  for (int s = 0; s < 3; s++)
    for (PetscInt ranks = 10; ranks <= most; ranks *= 10)
      for (int tree = 0; tree < (ranks > 100 ? 2 : 1); tree++) {
        Case c = usual;

        c.ranks = ranks;
        c.samples = 1000 * (PetscInt64)ranks;
        c.scale = scales[s];
        c.least_round = 0;
        if (!tree) c.group = FLAT;
        PetscCall(PrintCase(&c, &measured, table));
      }
  PetscFunctionReturn(0);
}

static PetscErrorCode RoundsTable(const WorkTable *table, PetscInt most)
{
  PetscFunctionBeginUser;
  PrintHead("In rounds, as build makes them: 32 nodes or 1/12 of the table, two open");
  for (PetscInt64 samples = 10000; samples <= 100 * (PetscInt64)most; samples *= 10)
    for (PetscInt ranks = 10; ranks <= most; ranks *= 10) {
      Case c = usual;

      if (ranks * (PetscInt64)10 > samples) continue;
      c.ranks = ranks;
      c.samples = samples;
      PetscCall(PrintCase(&c, &measured, table));
    }
  PetscFunctionReturn(0);
}

/* Other rounds, for the same job. */
static PetscErrorCode ChoicesTable(const WorkTable *table, PetscInt ranks)
{
  static const PetscInt choices[][3] = {{50, 8, 2}, {50, 8, 4}, {50, 2, 2}, {50, 2, 4},
                                        {0, 8, 2},  {0, 8, 4},  {0, 2, 4}};

  PetscFunctionBeginUser;
  for (int k = 0; k < 7; k++) {
    char title[128];
    Case c = usual;

    c.ranks = ranks;
    c.samples = 1000 * (PetscInt64)ranks;
    c.least_round = choices[k][0] ? choices[k][0] : c.samples / 256;
    c.round_share = choices[k][1];
    c.open_rounds = choices[k][2];
    snprintf(title, sizeof(title), "Rounds of %lld nodes or 1/%d of the table, %d open", (long long)c.least_round,
             (int)c.round_share, (int)c.open_rounds);
    PrintHead(title);
    PetscCall(PrintCase(&c, &measured, table));
  }
  PetscFunctionReturn(0);
}

/* Several jobs with a part of the box each (build --shard), and files written by leaders, which build has not. */
static PetscErrorCode ShardsTable(const WorkTable *table, PetscInt ranks)
{
  PetscFunctionBeginUser;
  PrintHead("Shards: jobs that share the ranks and the samples, all pieces known");
  for (PetscInt jobs = 1; jobs <= 16; jobs *= 4) {
    Case c = usual;

    c.ranks = ranks;
    c.samples = 1000 * (PetscInt64)ranks;
    c.jobs = jobs;
    c.least_round = 0;
    PetscCall(PrintCase(&c, &measured, table));
  }
  PrintHead("Each leader writes a file (a thought only)");
  for (int scale = 1; scale <= 10; scale *= 10) {
    Case c = usual;

    c.ranks = ranks;
    c.samples = 1000 * (PetscInt64)ranks;
    c.scale = scale;
    c.leaders_write = PETSC_TRUE;
    c.least_round = 0;
    PetscCall(PrintCase(&c, &measured, table));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode TroubleTable(const WorkTable *table, PetscInt ranks)
{
  static const char *const titles[] = {"Ranks alike", "Speeds spread by 10 %",
                                       "One rank in a hundred ten times slower"};
  Case c = usual;

  PetscFunctionBeginUser;
  c.ranks = ranks;
  c.samples = 1000 * (PetscInt64)ranks;
  c.scale = 10;
  c.least_round = 0;
  c.grain = 0; /* a rank that is slow is told by the number of its pieces */
  for (Speeds s = SPEED_UNIFORM; s <= SPEED_SLOW; s++) {
    c.speeds = s;
    PrintHead(titles[s]);
    PetscCall(PrintCase(&c, &measured, table));
  }
  c.speeds = SPEED_UNIFORM;
  c.mtbf = 3600.0 * (PetscReal)ranks / 100 / 20; /* a failure in three minutes */
  PrintHead("A failure every three minutes, a minute until the job runs again");
  PetscCall(PrintCase(&c, &measured, table));
  PetscFunctionReturn(0);
}

/* The network: what latency does. */
static PetscErrorCode LatencyTable(const WorkTable *table, PetscInt ranks)
{
  PetscFunctionBeginUser;
  for (PetscReal latency = 2e-6; latency < 2e-3; latency *= 22.36) {
    Costs costs = measured;
    char title[80];
    Case c = usual;

    costs.latency = latency;
    c.ranks = ranks;
    c.samples = 1000 * (PetscInt64)ranks;
    c.least_round = 0;
    snprintf(title, sizeof(title), "Latency %.2g ms", 1e3 * latency);
    PrintHead(title);
    PetscCall(PrintCase(&c, &costs, table));
  }
  PetscFunctionReturn(0);
}

/* Pieces of a rank and round put together, against each for itself. */
static PetscErrorCode GrainTable(const WorkTable *table)
{
  static const PetscReal grains[] = {0, 256, 64, 16};

  PetscFunctionBeginUser;
  PrintHead("Pieces put together: none, to 256, 64, 16 a rank and round");
  for (int k = 0; k < 4; k++) {
    Case c = usual;

    c.ranks = 300;
    c.samples = 1000000;
    c.least_round = 0;
    c.grain = grains[k];
    PetscCall(PrintCase(&c, &measured, table));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode LargeTable(const WorkTable *table)
{
  PetscFunctionBeginUser;
  PrintHead("The largest: 1e9 samples on 100,000 ranks, all known; then in rounds");
  for (int k = 0; k < 4; k++) {
    Case c = usual;

    c.ranks = 100000;
    c.samples = 1000000000;
    c.scale = k % 2 ? 100 : 10;
    c.least_round = k < 2 ? 0 : c.samples / 256;
    PetscCall(PrintCase(&c, &measured, table));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode AllTables(const WorkTable *table, PetscBool full)
{
  PetscFunctionBeginUser;
  PetscCall(GrainTable(table));
  PetscCall(DispatcherTable(table, full ? 100000 : 1000));
  PetscCall(RoundsTable(table, full ? 100000 : 1000));
  PetscCall(ChoicesTable(table, full ? 10000 : 1000));
  PetscCall(ShardsTable(table, full ? 10000 : 1000));
  PetscCall(TroubleTable(table, full ? 10000 : 1000));
  PetscCall(LatencyTable(table, full ? 10000 : 1000));
  if (full) PetscCall(LargeTable(table));
  PetscFunctionReturn(0);
}

/* ---- one case from the command line ---- */

typedef struct {
  const char *name, *help;
  PetscInt *count;
  PetscInt64 *large;
  PetscReal *real;
} Option;

static PetscBool Parse(int argc, char **argv, const Option options[], const char **path, PetscBool *full)
{
  for (int i = 1; i < argc; i++) {
    const Option *o = options;

    if (!strcmp(argv[i], "--full")) {
      *full = PETSC_TRUE;
      continue;
    }
    if (i + 1 == argc) return PETSC_FALSE;
    if (!strcmp(argv[i], "--database")) {
      *path = argv[++i];
      continue;
    }
    while (o->name && strcmp(argv[i] + 2, o->name)) o++;
    if (!o->name || strncmp(argv[i], "--", 2)) return PETSC_FALSE;
    i++;
    if (o->count) *o->count = (PetscInt)atof(argv[i]);
    if (o->large) *o->large = (PetscInt64)atof(argv[i]);
    if (o->real) *o->real = atof(argv[i]);
  }
  return PETSC_TRUE;
}

static int Usage(const Option options[])
{
  fprintf(stderr, "usage: bench_schedule [--full] [--database FILE.h5] [--OPTION NUMBER ...]\n");
  for (const Option *o = options; o->name; o++) fprintf(stderr, "  --%-14s %s\n", o->name, o->help);
  return 2;
}

int main(int argc, char **argv)
{
  const char *path = NULL;
  PetscBool full = PETSC_FALSE;
  PetscErrorCode ierr;
  Costs costs = measured;
  PetscReal equal = 0;
  Case c = usual;
  WorkTable table;
  const Option options[] = {
      {"ranks", "simulates this case alone", &c.ranks, NULL, NULL},
      {"samples", "pieces in all", NULL, &c.samples, NULL},
      {"scale", "of all times of work", NULL, NULL, &c.scale},
      {"equal", "s: all pieces take so long", NULL, NULL, &equal},
      {"group", "ranks of a group", &c.group, NULL, NULL},
      {"jobs", "that share ranks and samples", &c.jobs, NULL, NULL},
      {"speeds", "0: alike, 1: spread by 10 %, 2: one in a hundred ten times slower", (PetscInt *)&c.speeds, NULL,
       NULL},
      {"seed", "of all that is random", NULL, (PetscInt64 *)&c.seed, NULL},
      {"grain", "pieces a rank and round at most; 0: each for itself", NULL, NULL, &c.grain},
      {"round", "pieces of a round at least; 0: all are known", NULL, &c.least_round, NULL},
      {"share", "1/share of the table is a round", &c.round_share, NULL, NULL},
      {"open", "rounds at once", &c.open_rounds, NULL, NULL},
      {"describe", "bytes that a piece needs", NULL, NULL, &costs.describe_bytes},
      {"result", "bytes of a result", NULL, NULL, &costs.result_bytes},
      {"latency", "of a message, s", NULL, NULL, &costs.latency},
      {"message", "processor time of one, s", NULL, NULL, &costs.message},
      {"answer", "that leaders' schedules are told, s", NULL, NULL, &costs.answer},
      {"answer-root", "that rank 0's schedule is told, s", NULL, NULL, &costs.answer_root},
      {"commit", "s", NULL, NULL, &costs.commit},
      {"commit-record", "s", NULL, NULL, &costs.commit_record},
      {"poll", "s", NULL, NULL, &costs.poll},
      {"mtbf", "of a machine, s", NULL, NULL, &c.mtbf},
      {"machine", "ranks of one", &c.machine, NULL, NULL},
      {NULL, NULL, NULL, NULL, NULL},
  };

  if (!Parse(argc, argv, options, &path, &full)) return Usage(options);
  if (equal > 0)
    ierr = EqualWorkTable(equal, &table);
  else if (path)
    ierr = ReadWorkTable(path, &table);
  else
    ierr = FiguresWorkTable(sizeof(contact_work) / sizeof(*contact_work), contact_work, CONTACT_FACTORISATION, &table);
  if (ierr) return 1;
  if (c.ranks) {
    PrintHead("One case");
    ierr = PrintCase(&c, &costs, &table);
  } else {
    ierr = AllTables(&table, full);
  }
  DestroyWorkTable(&table);
  return ierr ? 1 : 0;
}
