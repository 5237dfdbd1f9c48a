/*
  Contact tissue in simple shear from F = I: the two-step against the one-step strategy, and both against bonded tissue
  on the same mesh; prints figures, asserts nothing.

    bench_contact [--full] [--repeats N] [--random N]
      --full        also 288 elements, and the error of the stress against 24 x 8 elements a face; takes minutes
      --repeats N   solves of each state, of which the median time counts; default 1
      --random N    also both strategies at the first N states of the boxes "asked" and "wide" of
                    support/random_contact.h, 72 elements, seed 1; default 0
*/
#include <stdio.h>
#include "support/random_contact.h"
#include "support/tissue.h"
#include "options.h"
#include "measure.h"

#define COUNT(list) ((int)(sizeof(list) / sizeof((list)[0])))
#define CASES 40
#define MESHES 2
#define REPEATS_MAX 99
#define SAME 1e-6 /* stresses of one equilibrium differ by less, LamStressError */

static const double shears[] = {0.05, 0.1, 0.2, 0.3, 0.5};
static const double turgors[] = {0, 0.005, 0.02, 0.05}, cohesions[] = {0, 0.005}; /* MPa */
static const int meshes[MESHES][2] = {{6, 2}, {12, 4}};

typedef enum { BONDED, TWO_STEP, ONE_STEP, WAYS } Way;
static const char *const way_names[WAYS] = {"bonded", "two_step", "one_step"};

typedef struct {
  LamResponse response;
  double ms, error; /* error: of the stress against the reference; NaN: there is none */
} Result;

typedef struct {
  double shear, turgor, cohesion;
  LamLoad load;
  PetscBool has_reference;
  double P_reference[9];
  Result result[MESHES][WAYS];
} Case;

typedef struct {
  LamRVE rve;
  LamRVEState state;
} Tissue;

static int ListCases(Case list[CASES])
{
  int n = 0;

  for (int g = 0; g < COUNT(cohesions); g++)
    for (int p = 0; p < COUNT(turgors); p++)
      for (int s = 0; s < COUNT(shears); s++)
        list[n++] = (Case){.shear = shears[s],
                           .turgor = turgors[p],
                           .cohesion = cohesions[g],
                           .load = ContactLoad(1, shears[s], 0, 1, turgors[p], cohesions[g])};
  return n;
}

static PetscErrorCode TissueCreate(LamMicrostructure micro, Way way, Tissue *tissue)
{
  PetscFunctionBeginUser;
  if (way == BONDED) micro.interface = LAM_INTERFACE_BONDED;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &tissue->rve));
  PetscCall(LamRVESetMicrostructure(tissue->rve, &micro));
  PetscCall(LamRVESetStrategy(tissue->rve, way == ONE_STEP ? LAM_ONE_STEP : LAM_TWO_STEP));
  PetscCall(LamRVESetUp(tissue->rve));
  PetscCall(LamRVEStateCreate(tissue->rve, &tissue->state));
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(const Tissue *tissue, const LamLoad *load, LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateReset(tissue->rve, tissue->state));
  PetscCall(LamRVESolve(tissue->rve, load, tissue->state, response));
  PetscFunctionReturn(0);
}

static PetscBool IsSolved(const LamResponse *r)
{
  return (PetscBool)(r->status == LAM_CONVERGED && r->stable);
}

static PetscErrorCode AddReferences(int n, Case list[])
{
  Tissue tissue;

  PetscFunctionBeginUser;
  PetscCall(TissueCreate(ContactTissue(24, 8), TWO_STEP, &tissue));
  for (int k = 0; k < n; k++) {
    LamResponse response;

    PetscCall(Solve(&tissue, &list[k].load, &response));
    list[k].has_reference = IsSolved(&response);
    PetscCall(PetscArraycpy(list[k].P_reference, response.P, 9));
  }
  PetscCall(DestroyTissue(&tissue.rve, &tissue.state));
  PetscFunctionReturn(0);
}

/* The ways take turns, so that their times compare. */
static PetscErrorCode MeasureCase(const Tissue tissue[WAYS], int repeats, Case *c, Result result[WAYS])
{
  double ms[WAYS][REPEATS_MAX];

  PetscFunctionBeginUser;
  for (int r = 0; r < repeats; r++)
    for (int w = 0; w < WAYS; w++) {
      PetscCall(Solve(&tissue[w], &c->load, &result[w].response));
      ms[w][r] = 1e3 * result[w].response.seconds;
    }
  for (int w = 0; w < WAYS; w++) {
    const LamResponse *response = &result[w].response;

    result[w].ms = Quantile(ms[w], repeats, 0.5);
    result[w].error = c->has_reference && IsSolved(response) ? StressError(response->P, c->P_reference) : NAN;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode MeasureMesh(int mesh, int repeats, int n, Case list[])
{
  Tissue tissue[WAYS];

  PetscFunctionBeginUser;
  for (int w = 0; w < WAYS; w++) {
    LamResponse warm;

    PetscCall(TissueCreate(ContactTissue(meshes[mesh][0], meshes[mesh][1]), (Way)w, &tissue[w]));
    PetscCall(Solve(&tissue[w], &list[n - 1].load, &warm));
  }
  for (int k = 0; k < n; k++) PetscCall(MeasureCase(tissue, repeats, &list[k], list[k].result[mesh]));
  for (int w = 0; w < WAYS; w++) PetscCall(DestroyTissue(&tissue[w].rve, &tissue[w].state));
  PetscFunctionReturn(0);
}

/* Both strategies, on meshes[0]. */
static PetscErrorCode MeasureRandom(ContactBox box, int n, Case list[])
{
  uint64_t seed = 1;

  PetscFunctionBeginUser;
  for (int k = 0; k < n; k++) {
    const RandomContact sample = DrawContact(box, k, meshes[0][0], meshes[0][1], &seed);

    list[k] = (Case){.turgor = sample.turgor, .cohesion = sample.cohesion, .load = sample.load};
    for (int w = TWO_STEP; w <= ONE_STEP; w++) {
      Result *result = &list[k].result[0][w];
      Tissue tissue;

      PetscCall(TissueCreate(sample.micro, (Way)w, &tissue));
      PetscCall(Solve(&tissue, &sample.load, &result->response));
      *result = (Result){.response = result->response, .ms = 1e3 * result->response.seconds, .error = NAN};
      PetscCall(DestroyTissue(&tissue.rve, &tissue.state));
    }
  }
  PetscFunctionReturn(0);
}

static int Elements(int mesh)
{
  return 6 * meshes[mesh][0] * meshes[mesh][1];
}

/* ---- two_step against one_step ---- */
static void PrintResult(const Result *result)
{
  const LamResponse *r = &result->response;

  if (IsSolved(r))
    printf("  %4d/%-4d %7.1f %7.3f", (int)r->newton_iterations, (int)r->factorisations, result->ms,
           100.0 * result->error);
  else
    printf("  %-9.9s %7.1f %7s", LamStatusNames[r->status], result->ms, "-");
}

/* Between the stresses of the two strategies; NaN where one of them has none. */
static double Difference(const Result result[WAYS])
{
  const LamResponse *two = &result[TWO_STEP].response, *one = &result[ONE_STEP].response;

  return IsSolved(two) && IsSolved(one) ? StressError(one->P, two->P) : NAN;
}

static void PrintStates(int mesh, int n, const Case list[])
{
  printf("\n%d elements: iterations/factorisations, ms, error of the stress (%%)\n"
         "shear  turgor  cohesion   two_step                    one_step                    difference (%%)\n",
         Elements(mesh));
  for (int k = 0; k < n; k++) {
    printf("%-6g %-7g %-8g", list[k].shear, list[k].turgor, list[k].cohesion);
    PrintResult(&list[k].result[mesh][TWO_STEP]);
    PrintResult(&list[k].result[mesh][ONE_STEP]);
    printf("  %.1e\n", 100.0 * Difference(list[k].result[mesh]));
  }
  for (int k = 0; k < n; k++)
    for (int way = BONDED; way < WAYS; way++) {
      const LamResponse *r = &list[k].result[mesh][way].response;

      if (!IsSolved(r))
        printf("%s, shear %g, p %g, g %g: %s\n", way_names[way], list[k].shear, list[k].turgor, list[k].cohesion,
               r->reason);
    }
}

/* States that are looked at together. */
typedef struct {
  const char *name;
  double least_pressure, most_pressure, most_shear;
} Group;

static const Group groups[] = {
    {"p + g > 0, shear to 0.3", 1e-9, 1.0, 0.3}, {"p + g > 0, shear to 0.5", 1e-9, 1.0, 0.5},
    {"p + g = 0, shear to 0.3", 0.0, 0.0, 0.3},  {"p + g = 0, shear to 0.5", 0.0, 0.0, 0.5},
    {"all, shear to 0.5", 0.0, 1.0, 0.5},
};

static PetscBool IsIn(const Group *group, const Case *c)
{
  const double pressure = c->turgor + c->cohesion;

  return (PetscBool)(pressure >= group->least_pressure && pressure <= group->most_pressure &&
                     c->shear <= group->most_shear);
}

static void PrintGroup(int mesh, const Group *group)
{
  printf("%-9d %-24s", Elements(mesh), group->name);
}

static void PrintSpread(double values[], int n)
{
  printf("  %6.1f %6.1f %6.1f ", Quantile(values, n, 0.5), Quantile(values, n, 0.9), Quantile(values, n, 1.0));
}

/* Values of a strategy at the states that both solve, [counted]; solved, seconds: of all its states. */
typedef struct {
  double *iterations, *factorisations, *ms, error, seconds; /* owned; error: sum */
  int states, solved, counted, with_error, same;
} Comparison;

static void Compare(int mesh, Way way, const Group *group, int n, const Case list[], Comparison *sum)
{
  for (int k = 0; k < n; k++) {
    const Result *both = list[k].result[mesh], *result = &both[way];

    if (!IsIn(group, &list[k])) continue;
    sum->states++;
    sum->solved += IsSolved(&result->response);
    sum->seconds += 1e-3 * result->ms;
    if (!IsSolved(&both[TWO_STEP].response) || !IsSolved(&both[ONE_STEP].response)) continue;
    sum->same += Difference(both) < SAME;
    sum->iterations[sum->counted] = result->response.newton_iterations;
    sum->factorisations[sum->counted] = result->response.factorisations;
    sum->ms[sum->counted++] = result->ms;
    if (isnan(result->error)) continue;
    sum->with_error++;
    sum->error += result->error;
  }
}

static PetscErrorCode PrintComparison(int mesh, const Group *group, int n, const Case list[])
{
  PetscFunctionBeginUser;
  for (int way = TWO_STEP; way <= ONE_STEP; way++) {
    Comparison c = {0};

    PetscCall(PetscMalloc3(n, &c.iterations, n, &c.factorisations, n, &c.ms));
    Compare(mesh, (Way)way, group, n, list, &c);
    PrintGroup(mesh, group);
    printf("%-9s %3d of %-4d", way_names[way], c.solved, c.states);
    PrintSpread(c.iterations, c.counted);
    PrintSpread(c.factorisations, c.counted);
    PrintSpread(c.ms, c.counted);
    printf("  %-7.2f %-9.3f  %d of %d\n", c.seconds, c.with_error ? 100.0 * c.error / c.with_error : NAN, c.same,
           c.counted);
    PetscCall(PetscFree3(c.iterations, c.factorisations, c.ms));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintRandom(ContactBox box, int n)
{
  const Group all = {contact_box_names[box], 0.0, 1.0, 0.0};
  Case *list;

  PetscFunctionBeginUser;
  if (n == 0) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(n, &list));
  PetscCall(MeasureRandom(box, n, list));
  PetscCall(PrintComparison(0, &all, n, list));
  PetscCall(PetscFree(list));
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintStrategies(int used_meshes, int n, const Case list[], int random)
{
  PetscFunctionBeginUser;
  printf("\nmedian, 90 %%, largest of the states that both strategies solve, and mean error; s: of all states;\n"
         "same: stress equal to %g\n"
         "elements  %-24sstrategy  solved       iterations              factorisations          ms                    "
         "  s       error (%%)  same\n",
         SAME, "states");
  for (int mesh = 0; mesh < used_meshes; mesh++)
    for (int g = 0; g < COUNT(groups); g++) PetscCall(PrintComparison(mesh, &groups[g], n, list));
  PetscCall(PrintRandom(BOX_ASKED, random));
  PetscCall(PrintRandom(BOX_WIDE, random));
  PetscFunctionReturn(0);
}

/* ---- contact against bonded ---- */
typedef struct {
  double total[CASES], released[CASES], factorisations[CASES], time[CASES];
  int count;
} Costs;

/* released: iterations without those of the bonded stage, which are those of the bonded tissue from F = I. */
static void CollectCosts(int mesh, const Group *group, int n, const Case list[], Costs *costs)
{
  costs->count = 0;
  for (int k = 0; k < n; k++) {
    const Result *bonded = &list[k].result[mesh][BONDED], *contact = &list[k].result[mesh][TWO_STEP];
    const LamResponse *b = &bonded->response, *c = &contact->response;

    if (!IsIn(group, &list[k]) || !IsSolved(b) || !IsSolved(c)) continue;
    costs->total[costs->count] = c->newton_iterations;
    costs->released[costs->count] = c->newton_iterations - b->newton_iterations;
    costs->factorisations[costs->count] = (double)c->factorisations / b->factorisations;
    costs->time[costs->count++] = contact->ms / bonded->ms;
  }
}

static void PrintCosts(int used_meshes, int n, const Case list[])
{
  printf("\ntwo_step against bonded on the same mesh; each: median, 90 %%, largest\n"
         "elements  %-24sstates  iterations              from bonded             factorisations, ratio   time, ratio\n",
         "states");
  for (int mesh = 0; mesh < used_meshes; mesh++)
    for (int g = 0; g < COUNT(groups); g++) {
      Costs costs;

      CollectCosts(mesh, &groups[g], n, list, &costs);
      PrintGroup(mesh, &groups[g]);
      printf("%-6d", costs.count);
      PrintSpread(costs.total, costs.count);
      PrintSpread(costs.released, costs.count);
      PrintSpread(costs.factorisations, costs.count);
      PrintSpread(costs.time, costs.count);
      printf("\n");
    }
}

static PetscErrorCode Run(int repeats, PetscBool full, int random)
{
  static Case list[CASES];
  const int n = ListCases(list), used_meshes = full ? MESHES : 1;

  PetscFunctionBeginUser;
  printf("contact, simple shear from F = I; times: medians of %d\n", repeats);
  if (full) PetscCall(AddReferences(n, list));
  for (int mesh = 0; mesh < used_meshes; mesh++) {
    PetscCall(MeasureMesh(mesh, repeats, n, list));
    PrintStates(mesh, n, list);
  }
  PetscCall(PrintStrategies(used_meshes, n, list, random));
  PrintCosts(used_meshes, n, list);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (Run(NumberOption("--repeats", 1, 1, REPEATS_MAX), HasOption("--full"), NumberOption("--random", 0, 0, 100000)))
    return 1;
  return EndBench();
}
