/*
  How many random states of contact tissue (support/random_contact.h) are solved, from F = I in one go; prints figures,
  asserts nothing.

    bench_contact_random [--random N] [--first K] [--box asked|wide|thin] [--along A] [--through B] [--seed S]
      --random N              states of each box; default 50
      --first K               leaves out the first K states of each box, so that shares can run apart; default 0
      --box B                 one box alone
      --along A, --through B  mesh; default 6 x 2
      --seed S                of the random numbers; default 1
*/
#include <stdio.h>
#include <unistd.h>
#include "support/random_contact.h"
#include "options.h"
#include "measure.h"

typedef struct {
  int count, first, along, through;
  int box; /* BOX_COUNT: all */
  uint64_t seed;
} Options;

typedef enum { ITERATIONS, FACTORISATIONS, MS, PENETRATION, FIGURES } Figure;
static const char *const figure_names[FIGURES] = {"iterations", "factorisations", "ms", "penetration/t"};

/* Of the states of a box, or of its dry ones. */
typedef struct {
  int count, solved, floating, exact;
  double seconds;           /* of all states */
  double *figures[FIGURES]; /* [count] of those that are solved, owned */
} Tally;

typedef struct {
  Tally all, dry;
  int by_status[LAM_STATUS_COUNT];
} Tallies;

static PetscBool IsSolved(const LamResponse *r)
{
  return (PetscBool)(r->status == LAM_CONVERGED && r->stable);
}

static void PrintFailure(ContactBox box, int number, const RandomContact *s, const LamResponse *r)
{
  printf("  %s %d: e %.3f %.3f at %.0f deg, rotation %.0f, t/a %.3f, orientation %.1f, p %.4f, g %.4f MPa: %s, %d "
         "iterations: %s\n",
         contact_box_names[box], number, s->strain[0], s->strain[1], s->direction * 180.0 / PETSC_PI,
         s->rotation * 180.0 / PETSC_PI, s->micro.wall_thickness, s->micro.orientation * 180.0 / PETSC_PI, s->turgor,
         s->cohesion, LamStatusNames[r->status], (int)r->newton_iterations, r->reason);
}

static void Count(const RandomContact *s, const LamResponse *r, Tally *tally)
{
  tally->count++;
  tally->seconds += r->seconds;
  if (!IsSolved(r)) return;
  tally->floating += r->floating_cells > 0;
  tally->exact += r->contact_width == 0.0;
  tally->figures[ITERATIONS][tally->solved] = r->newton_iterations;
  tally->figures[FACTORISATIONS][tally->solved] = r->factorisations;
  tally->figures[MS][tally->solved] = 1e3 * r->seconds;
  tally->figures[PENETRATION][tally->solved++] = r->max_penetration / s->micro.wall_thickness;
}

static void PrintSpread(Tally *t, Figure f)
{
  for (int k = 0; k < 3; k++) printf(" %9.3g", Quantile(t->figures[f], t->solved, k == 0 ? 0.5 : k == 1 ? 0.9 : 1.0));
}

static void PrintTallies(ContactBox box, Tallies *t)
{
  printf("%s: %d of %d converged and stable (%.1f %%), of which %d floating, %d by the exact law; of %d dry ones %d; "
         "%.0f s; others:",
         contact_box_names[box], t->all.solved, t->all.count, 100.0 * t->all.solved / t->all.count, t->all.floating,
         t->all.exact, t->dry.count, t->dry.solved, t->all.seconds);
  for (int status = 0; status < LAM_STATUS_COUNT; status++)
    if (status != LAM_CONVERGED && t->by_status[status]) printf(" %d %s", t->by_status[status], LamStatusNames[status]);
  printf("\n  %-15s %9s %9s %9s  %9s %9s %9s\n", "solved states", "median", "90 %", "largest", "dry ones", "90 %",
         "largest");
  for (Figure f = 0; f < FIGURES; f++) {
    printf("  %-15s", figure_names[f]);
    PrintSpread(&t->all, f);
    printf(" ");
    PrintSpread(&t->dry, f);
    printf("\n");
  }
}

static void ShowProgress(ContactBox box, const Options *options, const Tally *tally)
{
  if (!isatty(STDERR_FILENO)) return;
  fprintf(stderr, "\r%s: %d of %d, %d not solved", contact_box_names[box], tally->count, options->count,
          tally->count - tally->solved);
  if (tally->count == options->count) fprintf(stderr, "\n");
}

static PetscErrorCode TallyCreate(int count, Tally *tally)
{
  PetscFunctionBeginUser;
  for (int f = 0; f < FIGURES; f++) PetscCall(PetscMalloc1(count, &tally->figures[f]));
  PetscFunctionReturn(0);
}

static PetscErrorCode TallyDestroy(Tally *tally)
{
  PetscFunctionBeginUser;
  for (int f = 0; f < FIGURES; f++) PetscCall(PetscFree(tally->figures[f]));
  PetscFunctionReturn(0);
}

static PetscErrorCode RunBox(ContactBox box, const Options *options)
{
  uint64_t seed = options->seed;
  Tallies tallies = {0};

  PetscFunctionBeginUser;
  PetscCall(TallyCreate(options->count, &tallies.all));
  PetscCall(TallyCreate(options->count, &tallies.dry));
  for (int k = 0; k < options->first + options->count; k++) {
    const RandomContact sample = DrawContact(box, k, options->along, options->through, &seed);
    LamResponse response;

    if (k < options->first) continue;
    PetscCall(SolveOnce(&sample.micro, &sample.load, &response));
    tallies.by_status[response.status]++;
    Count(&sample, &response, &tallies.all);
    if (sample.dry) Count(&sample, &response, &tallies.dry);
    if (!IsSolved(&response)) PrintFailure(box, k, &sample, &response);
    ShowProgress(box, options, &tallies.all);
  }
  PrintTallies(box, &tallies);
  PetscCall(TallyDestroy(&tallies.all));
  PetscCall(TallyDestroy(&tallies.dry));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  Options options;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  options = (Options){.count = NumberOption("--random", 50, 1, PETSC_MAX_INT),
                      .first = NumberOption("--first", 0, 0, PETSC_MAX_INT),
                      .box = ChoiceOption("--box", contact_box_names, BOX_COUNT),
                      .along = NumberOption("--along", 6, 1, PETSC_MAX_INT),
                      .through = NumberOption("--through", 2, 1, PETSC_MAX_INT),
                      .seed = (uint64_t)NumberOption("--seed", 1, 0, PETSC_MAX_INT)};
  printf("contact at random states, seed %llu, %d elements a cell\n", (unsigned long long)options.seed,
         6 * options.along * options.through);
  for (int box = 0; box < BOX_COUNT; box++)
    if ((options.box == BOX_COUNT || options.box == box) && RunBox((ContactBox)box, &options)) return 1;
  return EndBench();
}
