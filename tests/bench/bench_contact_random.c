/*
  How many random states of contact tissue are solved, from F = I in one go; prints figures, asserts nothing.

    bench_contact_random [--random N] [--first K] [--along A] [--through B] [--seed S]
      --random N              states of each box; default 50
      --first K               leaves out the first K states of each box, so that shares can run apart; default 0
      --along A, --through B  mesh; default 6 x 2
      --seed S                of the random numbers; default 1

  Boxes of principal logarithmic strains e1, e2:
    asked   |e1 - e2| <= 0.3 and -0.05 <= (e1 + e2)/2 <= 0.3
    wide    e1 and e2 from -0.3 to 0.3, (e1 + e2)/2 >= -0.05
  with any principal direction, rotation and orientation, t/a from 0.03 to 0.4, turgor up to 0.05 MPa and cohesion up to
  0.01 MPa. Their sum is at least 0.002 MPa in nine states of ten, and zero in the rest.
*/
#include <stdio.h>
#include <unistd.h>
#include "support/contact_tissue.h"
#include "options.h"
#include "measure.h"
#include "support/random_reals.h"

#define DRY_SHARE 0.1
#define LEAST_PRESSURE 0.002 /* of p + g, MPa, of states that are not dry */

typedef enum { ASKED, WIDE, BOXES } Box;
static const char *const box_names[BOXES] = {"asked", "wide"};

typedef struct {
  int count, first, along, through;
  uint64_t seed;
} Options;

typedef struct {
  double strain[2], direction, rotation;
  double turgor, cohesion; /* MPa */
  LamMicrostructure micro;
  LamLoad load;
} Sample;

typedef struct {
  int count, solved, floating, dry, dry_solved;
  int by_status[LAM_STATUS_COUNT];
  double *iterations, *factorisations, *ms, *penetration; /* [count] of those that are solved, owned */
} Tally;

/* ---- a random state ---- */
static void DrawStrain(Box box, uint64_t *seed, double e[2])
{
  if (box == ASKED) {
    const double mean = RandomReal(seed, -0.05, 0.3), half = 0.5 * RandomReal(seed, -0.3, 0.3);

    e[0] = mean + half;
    e[1] = mean - half;
    return;
  }
  do {
    e[0] = RandomReal(seed, -0.3, 0.3);
    e[1] = RandomReal(seed, -0.3, 0.3);
  } while (0.5 * (e[0] + e[1]) < -0.05);
}

/* F = R U, U with stretches exp(e) along the principal directions. */
static LamLoad StretchedAndTurned(const Sample *s)
{
  const double a = exp(s->strain[0]), b = exp(s->strain[1]), c = cos(s->direction), d = sin(s->direction);
  const double U11 = a * c * c + b * d * d, U22 = a * d * d + b * c * c, U12 = (a - b) * c * d;
  const double C = cos(s->rotation), S = sin(s->rotation);

  return ContactLoad(C * U11 - S * U12, C * U12 - S * U22, S * U11 + C * U12, S * U12 + C * U22, s->turgor,
                     s->cohesion);
}

static Sample Draw(Box box, const Options *options, uint64_t *seed)
{
  Sample s = {.micro = ContactTissue(options->along, options->through)};
  PetscBool dry;

  DrawStrain(box, seed, s.strain);
  s.direction = RandomReal(seed, 0.0, PETSC_PI);
  s.rotation = RandomReal(seed, -PETSC_PI, PETSC_PI);
  s.micro.wall_thickness = RandomReal(seed, 0.03, 0.4);
  s.micro.orientation = RandomReal(seed, 0.0, PETSC_PI);
  dry = (PetscBool)(RandomReal(seed, 0.0, 1.0) < DRY_SHARE);
  do {
    s.turgor = RandomReal(seed, 0.0, 0.05);
    s.cohesion = RandomReal(seed, 0.0, 0.01);
  } while (s.turgor + s.cohesion < LEAST_PRESSURE);
  if (dry) s.turgor = s.cohesion = 0.0;
  s.load = StretchedAndTurned(&s);
  return s;
}

/* ---- failures ---- */
static void PrintFailure(Box box, int number, const Sample *s, const LamResponse *r)
{
  printf("  %s %d: e %.3f %.3f at %.0f deg, rotation %.0f, t/a %.3f, orientation %.1f, p %.4f, g %.4f MPa: %s, %d "
         "iterations: %s\n",
         box_names[box], number, s->strain[0], s->strain[1], s->direction * 180.0 / PETSC_PI,
         s->rotation * 180.0 / PETSC_PI, s->micro.wall_thickness, s->micro.orientation * 180.0 / PETSC_PI, s->turgor,
         s->cohesion, LamStatusNames[r->status], (int)r->newton_iterations, r->reason);
}

/* ---- a box ---- */
static void Count(const Sample *s, const LamResponse *r, Tally *tally)
{
  const PetscBool solved = (PetscBool)(r->status == LAM_CONVERGED && r->stable);
  const PetscBool dry = (PetscBool)(s->turgor + s->cohesion == 0.0);

  tally->count++;
  tally->by_status[r->status]++;
  tally->dry += dry;
  if (!solved) return;
  tally->dry_solved += dry;
  tally->floating += r->floating_cells > 0;
  tally->penetration[tally->solved] = r->max_penetration / s->micro.wall_thickness;
  tally->iterations[tally->solved] = r->newton_iterations;
  tally->factorisations[tally->solved] = r->factorisations;
  tally->ms[tally->solved++] = 1e3 * r->seconds;
}

static void PrintSpread(const char what[], double values[], int n)
{
  printf("  %s: median %.3g, 90 %% %.3g, largest %.3g\n", what, Quantile(values, n, 0.5), Quantile(values, n, 0.9),
         Quantile(values, n, 1.0));
}

static void PrintTally(Box box, Tally *t)
{
  printf("%s: %d of %d converged and stable (%.1f %%), of which %d floating; of %d dry ones %d; others:",
         box_names[box], t->solved, t->count, 100.0 * t->solved / t->count, t->floating, t->dry, t->dry_solved);
  for (int status = 0; status < LAM_STATUS_COUNT; status++)
    if (status != LAM_CONVERGED && t->by_status[status]) printf(" %d %s", t->by_status[status], LamStatusNames[status]);
  printf("\n");
  PrintSpread("iterations", t->iterations, t->solved);
  PrintSpread("factorisations", t->factorisations, t->solved);
  PrintSpread("ms", t->ms, t->solved);
  PrintSpread("penetration over wall thickness", t->penetration, t->solved);
}

static void ShowProgress(Box box, const Options *options, const Tally *tally)
{
  if (!isatty(STDERR_FILENO)) return;
  fprintf(stderr, "\r%s: %d of %d, %d not solved", box_names[box], tally->count, options->count,
          tally->count - tally->solved);
  if (tally->count == options->count) fprintf(stderr, "\n");
}

static PetscErrorCode RunBox(Box box, const Options *options)
{
  uint64_t seed = options->seed;
  Tally tally = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(options->count, &tally.iterations, options->count, &tally.factorisations, options->count,
                         &tally.ms, options->count, &tally.penetration));
  for (int k = 0; k < options->first + options->count; k++) {
    const Sample sample = Draw(box, options, &seed);
    LamResponse response;

    if (k < options->first) continue;
    PetscCall(SolveOnce(&sample.micro, &sample.load, &response));
    Count(&sample, &response, &tally);
    if (response.status != LAM_CONVERGED || !response.stable) PrintFailure(box, k, &sample, &response);
    ShowProgress(box, options, &tally);
  }
  PrintTally(box, &tally);
  PetscCall(PetscFree4(tally.iterations, tally.factorisations, tally.ms, tally.penetration));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  Options options;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  options = (Options){.count = NumberOption("--random", 50, 1, PETSC_MAX_INT),
                      .first = NumberOption("--first", 0, 0, PETSC_MAX_INT),
                      .along = NumberOption("--along", 6, 1, PETSC_MAX_INT),
                      .through = NumberOption("--through", 2, 1, PETSC_MAX_INT),
                      .seed = (uint64_t)NumberOption("--seed", 1, 0, PETSC_MAX_INT)};
  printf("contact at random states, seed %llu, %d elements\n", (unsigned long long)options.seed,
         6 * options.along * options.through);
  for (int box = 0; box < BOXES; box++)
    if (RunBox((Box)box, &options)) return 1;
  return EndBench();
}
