/*
  How many random programs of tissue whose lamella breaks (support/random_lamella.h) are followed to the end, and at
  what cost; prints figures, asserts nothing.

    bench_lamella [--programs N] [--first K] [--steps N] [--turgor N] [--seed S] [--walls] [--finer] [--times]
  [--states] [--monitor]
      --programs N   default 50
      --first K      leaves out the first K programs, so that shares can run apart; default 0
      --steps N      of a program, from F = I; default 20
      --turgor N     the most that walls bear, in t/a (C1 + C2); default 3
      --seed S       of the random numbers; default 1
      --walls        whose walls tear, too
      --finer        follows each program in four times as many steps, too, and compares peak stress and dissipation
      --times        times of states near failure, against those of tissue with law contact and a cohesion of a tenth of
                     the strength, at least 0.001 MPa, at the same loads
      --states       prints the states of the last run of each program
      --monitor      prints the iterations of the last run of each program to stderr

  A program ends at about twice the strain of its peak stress, which repeated runs find, at most at 0.6. Stress is that
  since F = I.
*/
#include <stdio.h>
#include <unistd.h>
#include "support/random_lamella.h"
#include "support/tissue.h"
#include "options.h"
#include "measure.h"

#define MOST_STEPS 1000
#define FINER 4
#define FIRST_END 0.3
#define MOST_END 0.6
#define LEAST_END 0.02
#define RUNS 5                 /* to find the end */
#define AGREEMENT 0.05         /* of runs with fewer and more steps */
#define IMBALANCE 0.05         /* of the ledger of energies */
#define NEAR_FAILURE 0.02, 0.9 /* broken fraction of states whose times are compared */

typedef struct {
  int count, first, steps;
  double turgor;
  PetscBool walls, finer, times, states, monitor;
  uint64_t seed;
} Options;

typedef struct {
  LamRVE rve;
  LamRVEState state;
} Tissue;

/* One run of a program. */
typedef struct {
  double end;
  PetscBool prints; /* its states */
  int states, smooth, jumps;
  double peak, peak_strain, dissipated, broken;
  double largest_energy, imbalance;  /* of energies since F = I; imbalance: the largest of all states */
  PetscBool falls, outside, unknown; /* dissipation falls; broken fraction outside [0, 1]; numbers that are not */
  PetscReal stress[9], dissipated_before, at_rest[2]; /* of the first state; of the state before; stored and work */
  LamResponse last;
  double iterations[MOST_STEPS + 1], ms[MOST_STEPS + 1];
} Run;

typedef struct {
  int followed, states, smooth, jumps, falls, outside, unknown, imbalanced;
  int peaks_differ, dissipations_differ, compared;
  double *iterations, *ms, *imbalance; /* owned */
} Tally;

typedef enum { HOLDS, JUMPS, CONTACT, TIMED } Timed;
typedef struct {
  int count[TIMED];
  double *ms[TIMED], *iterations[TIMED]; /* owned */
} Times;

static PetscErrorCode TissueCreate(const LamMicrostructure *micro, LamWanted wanted, Tissue *t)
{
  PetscFunctionBeginUser;
  PetscCall(NewTissue(micro, &t->rve, &t->state));
  PetscCall(LamRVESetWanted(t->rve, wanted));
  PetscFunctionReturn(0);
}

static PetscErrorCode TissueDestroy(Tissue *t)
{
  return DestroyTissue(&t->rve, &t->state);
}

static PetscBool IsFollowed(const Run *run)
{
  return (PetscBool)(run->last.status == LAM_CONVERGED);
}

static PetscBool HasUnknown(const LamResponse *r)
{
  double sum = r->energy + r->stored + r->dissipated + r->released + r->work + r->broken_fraction;

  for (int i = 0; i < 9; i++) sum += r->P[i];
  for (int i = 0; i < 3; i++) sum += r->broken_by_face[i];
  return (PetscBool)!isfinite(sum);
}

static double StressSinceRest(const Run *run)
{
  double sum = 0.0;

  for (int i = 0; i < 5; i++) sum += pow(run->last.P[i] - run->stress[i], 2.0); /* in the plane */
  return sqrt(sum);
}

/* What is wrong or lost in the history up to run->last. */
static void CheckHistory(Run *run)
{
  const LamResponse *r = &run->last;
  const double stored = r->stored - run->at_rest[0], work = r->work - run->at_rest[1];

  run->unknown = (PetscBool)(run->unknown || HasUnknown(r));
  run->outside = (PetscBool)(run->outside || r->broken_fraction < 0.0 || r->broken_fraction > 1.0 + 1e-9);
  run->falls = (PetscBool)(run->falls || r->dissipated < run->dissipated_before - 1e-12);
  run->dissipated_before = r->dissipated;
  run->largest_energy = PetscMax(run->largest_energy, PetscMax(r->dissipated, fabs(stored)));
  run->imbalance = PetscMax(run->imbalance, fabs(work - stored - r->dissipated - r->released));
}

static void CountState(double strain, Run *run)
{
  const LamResponse *r = &run->last;
  const int k = run->states++;

  if (k == 0) {
    PetscCallAbort(PETSC_COMM_SELF, PetscArraycpy(run->stress, r->P, 9));
    run->at_rest[0] = r->stored + r->dissipated + r->released;
    run->at_rest[1] = r->work;
  }
  run->iterations[k] = r->newton_iterations;
  run->smooth += r->contact_width > 0.0;
  run->jumps += r->jumped == PETSC_TRUE;
  run->dissipated = r->dissipated;
  run->broken = r->broken_fraction;
  CheckHistory(run);
  if (StressSinceRest(run) <= run->peak && k > 0) return;
  run->peak = StressSinceRest(run);
  run->peak_strain = strain;
}

static void PrintState(double strain, const Run *run)
{
  const LamResponse *r = &run->last;

  printf("    %.5f: P %8.4f %8.4f %8.4f %8.4f, broken %.4f, dissipated %.3e, released %.3e, stored %+.3e, work %+.3e, "
         "ledger "
         "%+.2e%s, width %g, %d iterations\n",
         strain, r->P[0], r->P[1], r->P[3], r->P[4], r->broken_fraction, r->dissipated, r->released,
         r->stored - run->at_rest[0], r->work - run->at_rest[1],
         r->work - run->at_rest[1] - (r->stored - run->at_rest[0]) - r->dissipated - r->released,
         r->jumped == PETSC_TRUE ? ", jumped" : "", r->contact_width, (int)r->newton_iterations);
}

/* Follows a program up to its end or to the first state that is not found, which is run->last. */
static PetscErrorCode FollowProgram(Tissue *t, const RandomLamella *s, int steps, double end, Run *run)
{
  PetscFunctionBeginUser;
  *run = (Run){.end = end, .prints = run->prints};
  PetscCall(LamRVEStateReset(t->rve, t->state));
  for (int k = 0; k <= steps; k++) {
    const double strain = end * k / steps, begin = ProcessorSeconds();
    const LamLoad load = LamellaProgramLoad(s, strain);

    PetscCall(LamRVESolve(t->rve, &load, t->state, &run->last));
    if (!IsFollowed(run)) break;
    run->ms[k] = 1e3 * (ProcessorSeconds() - begin);
    CountState(strain, run);
    if (run->prints) PrintState(strain, run);
  }
  PetscFunctionReturn(0);
}

/* Runs a program until it ends at about twice the strain of its peak. */
static PetscErrorCode FindEnd(Tissue *t, const RandomLamella *s, int steps, Run *run)
{
  double end = FIRST_END;

  PetscFunctionBeginUser;
  for (int k = 0; k < RUNS; k++) {
    PetscCall(FollowProgram(t, s, steps, end, run));
    if (!IsFollowed(run)) break;
    if (run->peak_strain > 0.6 * end && end < MOST_END)
      end = PetscMin(MOST_END, 1.8 * end);
    else if (run->peak_strain < 0.35 * end && end > LEAST_END)
      end = PetscMax(LEAST_END, 2.0 * run->peak_strain);
    else
      break;
  }
  PetscFunctionReturn(0);
}

static void PrintProgram(int number, const RandomLamella *s)
{
  const LamLamella *l = &s->micro.lamella;

  printf("  %d: %s, t/a %.3f, C4 %.3g, orientation %.1f, p %.3f, strength %.3f, 2G/strength %.3f, shear %.2f, %.2f, %s",
         number, lamella_program_names[s->program], s->micro.wall_thickness, s->micro.wall.C4,
         s->micro.orientation * 180.0 / PETSC_PI, s->turgor, l->strength, 2.0 * l->energy / l->strength,
         l->shear_strength / l->strength, l->shear_energy / l->energy, LamSofteningNames[l->softening]);
}

static void PrintFault(int number, const RandomLamella *s, const Run *run, int steps)
{
  const PetscBool wrong = (PetscBool)(run->falls || run->outside || run->unknown);

  if (IsFollowed(run) && !wrong && run->imbalance <= IMBALANCE * run->largest_energy) return;
  PrintProgram(number, s);
  printf(": peak %.4g at %.4f, end %.4f", run->peak, run->peak_strain, run->end);
  if (!IsFollowed(run))
    printf("; state %d of %d, broken %.3f: %s, %d iterations: %s", run->states, steps, run->broken,
           LamStatusNames[run->last.status], (int)run->last.newton_iterations, run->last.reason);
  if (run->falls) printf("; dissipated energy falls");
  if (run->outside) printf("; broken fraction outside [0, 1]");
  if (run->unknown) printf("; numbers unknown");
  if (run->imbalance > IMBALANCE * run->largest_energy)
    printf("; ledger off by %.1f %%", 100.0 * run->imbalance / run->largest_energy);
  printf("\n");
}

static PetscErrorCode CountRun(const Run *run, int number, Tally *tally)
{
  PetscFunctionBeginUser;
  tally->followed += IsFollowed(run);
  tally->smooth += run->smooth;
  tally->jumps += run->jumps;
  tally->falls += run->falls;
  tally->outside += run->outside;
  tally->unknown += run->unknown;
  tally->imbalance[number] = run->largest_energy > 0.0 ? run->imbalance / run->largest_energy : 0.0;
  tally->imbalanced += tally->imbalance[number] > IMBALANCE;
  PetscCall(PetscArraycpy(tally->iterations + tally->states, run->iterations, run->states));
  PetscCall(PetscArraycpy(tally->ms + tally->states, run->ms, run->states));
  tally->states += run->states;
  PetscFunctionReturn(0);
}

static double Difference(double a, double b)
{
  return fabs(a - b) / PetscMax(PetscMax(fabs(a), fabs(b)), 1e-300);
}

/* The same program in more steps. */
static PetscErrorCode CompareFiner(Tissue *t, int number, const RandomLamella *s, const Options *o, const Run *run,
                                   Tally *tally)
{
  static Run finer = {0};
  double peak, dissipated;

  PetscFunctionBeginUser;
  PetscCall(FollowProgram(t, s, FINER * o->steps, run->end, &finer));
  if (!IsFollowed(&finer)) {
    printf("in %d steps", FINER * o->steps);
    PrintFault(number, s, &finer, FINER * o->steps);
    PetscFunctionReturn(0);
  }
  tally->compared++;
  peak = Difference(run->peak, finer.peak);
  /* where next to nothing breaks nothing is compared */
  dissipated = PetscMax(run->broken, finer.broken) > 0.01 ? Difference(run->dissipated, finer.dissipated) : 0.0;
  tally->peaks_differ += peak > AGREEMENT;
  tally->dissipations_differ += dissipated > AGREEMENT;
  if (peak <= AGREEMENT && dissipated <= AGREEMENT) PetscFunctionReturn(0);
  PrintProgram(number, s);
  printf(": in %d and %d steps to %.4f peak %.4g at %.4f and %.4g at %.4f, dissipated %.4g and %.4g, broken %.3f and "
         "%.3f, jumps %d and %d\n",
         o->steps, FINER * o->steps, run->end, run->peak, run->peak_strain, finer.peak, finer.peak_strain,
         run->dissipated, finer.dissipated, run->broken, finer.broken, run->jumps, finer.jumps);
  PetscFunctionReturn(0);
}

static PetscErrorCode RunProgram(int number, const Options *o, Tally *tally)
{
  RandomLamella s = DrawLamella(o->seed, number, o->turgor);
  static Run run = {0};
  Tissue t;

  PetscFunctionBeginUser;
  if (o->walls) DrawTearing(o->seed, number, &s.micro);
  PetscCall(TissueCreate(&s.micro, LAM_WANT_ALL, &t));
  PetscCall(FindEnd(&t, &s, o->steps, &run));
  PetscCall(CountRun(&run, number - o->first, tally));
  PrintFault(number, &s, &run, o->steps);
  if (o->states || o->monitor) {
    PetscCall(LamRVESetMonitor(t.rve, o->monitor));
    run.prints = o->states;
    PetscCall(FollowProgram(&t, &s, o->steps, run.end, &run));
    PetscCall(LamRVESetMonitor(t.rve, PETSC_FALSE));
  }
  if (o->finer && IsFollowed(&run)) PetscCall(CompareFiner(&t, number, &s, o, &run, tally));
  PetscCall(TissueDestroy(&t));
  PetscFunctionReturn(0);
}

static void PrintSpread(const char *name, double values[], int n)
{
  printf("  %-24s %9.3g %9.3g %9.3g\n", name, Quantile(values, n, 0.5), Quantile(values, n, 0.9),
         Quantile(values, n, 1.0));
}

static void PrintTally(const Options *o, Tally *t)
{
  printf("%d of %d programs followed to the end; %d states, %d by the smooth law, %d jumps\n", t->followed, o->count,
         t->states, t->smooth, t->jumps);
  printf(
      "history: dissipated energy falls in %d programs, broken fraction outside [0, 1] in %d, numbers unknown in %d, "
      "ledger off by more than %g %% in %d\n",
      t->falls, t->outside, t->unknown, 100.0 * IMBALANCE, t->imbalanced);
  if (o->finer)
    printf("of %d programs also followed in %d steps: peak differs by more than %g %% in %d, dissipation in %d\n",
           t->compared, FINER * o->steps, 100.0 * AGREEMENT, t->peaks_differ, t->dissipations_differ);
  printf("  %-24s %9s %9s %9s\n", "", "median", "90 %", "largest");
  PrintSpread("iterations of a state", t->iterations, t->states);
  PrintSpread("ms of a state", t->ms, t->states);
  PrintSpread("imbalance of a program", t->imbalance, o->count);
}

static void ShowProgress(const Options *o, int done)
{
  if (!isatty(STDERR_FILENO)) return;
  fprintf(stderr, "\r%d of %d", done, o->count);
  if (done == o->count) fprintf(stderr, "\n");
}

static PetscErrorCode RunPrograms(const Options *o)
{
  const int states = o->count * (o->steps + 1);
  Tally tally = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(states, &tally.iterations, states, &tally.ms, o->count, &tally.imbalance));
  for (int k = 0; k < o->count; k++) {
    PetscCall(RunProgram(o->first + k, o, &tally));
    ShowProgress(o, k + 1);
  }
  PrintTally(o, &tally);
  PetscCall(PetscFree3(tally.iterations, tally.ms, tally.imbalance));
  PetscFunctionReturn(0);
}

/* ---- times ---- */

static PetscErrorCode SolveTimed(Tissue *t, const LamLoad *load, LamResponse *response, double *ms)
{
  const double begin = ProcessorSeconds();

  PetscFunctionBeginUser;
  PetscCall(LamRVESolve(t->rve, load, t->state, response));
  *ms = 1e3 * (ProcessorSeconds() - begin);
  PetscFunctionReturn(0);
}

static void CountTime(Times *times, Timed kind, const LamResponse *r, double ms)
{
  if (r->status != LAM_CONVERGED) return;
  times->iterations[kind][times->count[kind]] = r->newton_iterations;
  times->ms[kind][times->count[kind]++] = ms;
}

/* Both laws in turn at each load; those of contact count where the lamella is near failure. */
static PetscErrorCode TimeBoth(Tissue *lamella, Tissue *contact, const RandomLamella *s, int steps, double end,
                               Times *times)
{
  static const double near[2] = {NEAR_FAILURE};

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateReset(lamella->rve, lamella->state));
  for (int k = 0; k <= steps; k++) {
    const LamLoad load = LamellaProgramLoad(s, end * k / steps);
    LamLoad cohesive = load;
    LamResponse r[2];
    double ms[2];

    cohesive.cohesion = PetscMax(0.1 * s->micro.lamella.strength, 0.001 / TISSUE_STRESS);
    PetscCall(SolveTimed(lamella, &load, &r[0], &ms[0]));
    PetscCall(SolveTimed(contact, &cohesive, &r[1], &ms[1]));
    if (r[0].status != LAM_CONVERGED) break;
    if (r[0].broken_fraction < near[0] || r[0].broken_fraction > near[1]) continue;
    CountTime(times, r[0].jumped == PETSC_TRUE ? JUMPS : HOLDS, &r[0], ms[0]);
    CountTime(times, CONTACT, &r[1], ms[1]);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode TimeProgram(int number, const Options *o, Times *times)
{
  const LamWanted wanted = (LamWanted)(LAM_WANT_STRESS | LAM_WANT_DERIVATIVES);
  const RandomLamella s = DrawLamella(o->seed, number, o->turgor);
  LamMicrostructure micro = s.micro;
  Tissue lamella, contact;
  static Run run = {0};

  PetscFunctionBeginUser;
  micro.interface = LAM_INTERFACE_CONTACT;
  PetscCall(TissueCreate(&s.micro, wanted, &lamella));
  PetscCall(TissueCreate(&micro, wanted, &contact));
  PetscCall(FindEnd(&lamella, &s, o->steps, &run));
  PetscCall(TimeBoth(&lamella, &contact, &s, o->steps, run.end, times));
  PetscCall(TissueDestroy(&lamella));
  PetscCall(TissueDestroy(&contact));
  PetscFunctionReturn(0);
}

static void PrintTimes(Times *times)
{
  static const char *const names[TIMED] = {"lamella", "lamella, jumps", "contact"};
  double median[TIMED];

  printf("states near failure    number   ms: median     90 %%   largest   iterations: median   90 %%\n");
  for (Timed k = 0; k < TIMED; k++) {
    const int n = times->count[k];

    median[k] = Quantile(times->ms[k], n, 0.5);
    printf("%-20s %8d %12.3g %8.3g %9.3g %20.0f %6.0f\n", names[k], n, median[k], Quantile(times->ms[k], n, 0.9),
           Quantile(times->ms[k], n, 1.0), Quantile(times->iterations[k], n, 0.5),
           Quantile(times->iterations[k], n, 0.9));
  }
  printf("a state of the lamella over one of contact: %.2f; with a jump: %.2f\n", median[HOLDS] / median[CONTACT],
         median[JUMPS] / median[CONTACT]);
}

static PetscErrorCode RunTimes(const Options *o)
{
  const int states = o->count * (o->steps + 1);
  Times times = {0};

  PetscFunctionBeginUser;
  for (Timed k = 0; k < TIMED; k++) PetscCall(PetscMalloc2(states, &times.ms[k], states, &times.iterations[k]));
  for (int k = 0; k < o->count; k++) {
    PetscCall(TimeProgram(o->first + k, o, &times));
    ShowProgress(o, k + 1);
  }
  PrintTimes(&times);
  for (Timed k = 0; k < TIMED; k++) PetscCall(PetscFree2(times.ms[k], times.iterations[k]));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  Options o;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  o = (Options){.count = NumberOption("--programs", 50, 1, PETSC_MAX_INT / MOST_STEPS),
                .first = NumberOption("--first", 0, 0, PETSC_MAX_INT),
                .steps = NumberOption("--steps", 20, 1, MOST_STEPS / FINER),
                .turgor = NumberOption("--turgor", 3, 0, PETSC_MAX_INT),
                .seed = (uint64_t)NumberOption("--seed", 1, 0, PETSC_MAX_INT),
                .walls = HasOption("--walls"),
                .finer = HasOption("--finer"),
                .times = HasOption("--times"),
                .states = HasOption("--states"),
                .monitor = HasOption("--monitor")};
  printf("lamella in random programs of %d steps, seed %llu, turgor up to %g t/a\n", o.steps,
         (unsigned long long)o.seed, o.turgor);
  if (o.times ? RunTimes(&o) : RunPrograms(&o)) return 1;
  return EndBench();
}
