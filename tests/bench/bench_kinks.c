/*
  What walls that have kinked do to the error of a mesh: random bonded states on meshes of 6 x 2 to 24 x 8 elements
  (with
  --fine 48 x 8), each loaded in steps from F = I. Prints, for each state, the share of the walls that has lost
  ellipticity on each mesh, the errors of P against the finest that has an answer, and the a-posteriori estimate of
  each; then, by that share, how errors and estimates compare. Usage: bench_kinks [--states N] [--seed N] [--steps N]
  [--fine] [--tension] [--graded] [--turgor]
*/
#include <math.h>
#include <stdio.h>
#include <lamella/lamella.h>
#include "options.h"
#include "measure.h"
#include "support/random_reals.h"
#include "support/tissue.h"

typedef struct {
  PetscInt along, through;
} Mesh;
static const Mesh meshes[] = {{6, 2}, {12, 4}, {24, 8}, {48, 8}};
#define MOST_STATES 1000
enum { MESHES = PETSC_STATIC_ARRAY_LENGTH(meshes) };

typedef struct {
  int states, steps, count; /* count: of the meshes */
  PetscBool tension, graded, turgor;
  uint64_t seed;
} Options;

typedef struct {
  LamMicrostructure micro;
  LamLoad load;
  double ratio, shear, e[2];
} Sample;

static Sample Draw(Options *o)
{
  Sample s = {.micro = DefaultTissue(), .load = PlaneLoad(1, 0, 0, 1, 0)};
  double angle, c, d, a, b;

  s.e[0] = RandomReal(&o->seed, -0.2, 0.4);
  s.e[1] = RandomReal(&o->seed, -0.2, 0.4);
  s.shear = RandomReal(&o->seed, 0, 1);
  angle = RandomReal(&o->seed, 0, PETSC_PI);
  s.ratio = pow(10, RandomReal(&o->seed, -1, 3)); /* C4 / C1; the lowest tenth of the decades: no fibres */
  s.micro.wall_thickness = 0.05 * pow(10, RandomReal(&o->seed, 0, 1));
  s.micro.orientation = RandomReal(&o->seed, 0, 2 * PETSC_PI);
  if (s.ratio < 0.25) s.ratio = 0;
  s.micro.wall.C4 = s.micro.wall.C1 * s.ratio;
  s.micro.wall.fibres = o->tension ? LAM_FIBRES_TENSION : LAM_FIBRES_BOTH;
  if (o->graded) s.micro.grading = 0.7;
  c = cos(angle), d = sin(angle), a = exp(s.e[0]), b = exp(s.e[1]);
  const double U[4] = {c * c * a + d * d * b, c * d * (a - b), c * d * (a - b), d * d * a + c * c * b};

  s.load.F[0] = U[0] + s.shear * U[2];
  s.load.F[1] = U[1] + s.shear * U[3];
  s.load.F[3] = U[2];
  s.load.F[4] = U[3];
  s.load.turgor = o->turgor ? RandomReal(&o->seed, 0.1, 0.5) : 0;
  return s;
}

/* Wrinkled walls have many branches; a state that needs more factorisations than these is left out. */
#define MOST_FACTORISATIONS 200

static PetscBool IsTooMuch(void *count)
{
  return (PetscBool)(++*(int *)count > MOST_FACTORISATIONS);
}

/* In steps linear in F; the response of the last. */
static PetscErrorCode SolveOn(const Sample *s, const Options *o, Mesh mesh, LamResponse *response)
{
  LamMicrostructure micro = s->micro;
  LamLoad load = s->load;
  LamRVE rve;
  LamRVEState state;
  LamRVEEstimate e;
  int count = 0;

  PetscFunctionBeginUser;
  micro.along = mesh.along;
  micro.through = mesh.through;
  PetscCall(NewTissue(&micro, &rve, NULL));
  PetscCall(LamRVESetInterrupt(rve, IsTooMuch, &count));
  PetscCall(LamRVEStateCreate(rve, &state));
  PetscCall(LamRVEEstimateCreate(rve, &e));
  response->status = LAM_CONVERGED;
  for (int k = 1; k <= o->steps && response->status == LAM_CONVERGED; k++) {
    count = 0;
    for (int i = 0; i < 9; i++) load.F[i] = (i % 4 ? 0 : 1) * (1 - (double)k / o->steps) + s->load.F[i] * k / o->steps;
    PetscCall(LamRVESolve(rve, &load, state, response));
    PetscCall(LamRVEEstimateError(e, state, response)); /* each: it keeps a state of its own */
  }
  PetscCall(LamRVEEstimateDestroy(&e));
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}

static void PrintHeader(const Options *o)
{
  printf("state    t/a  C4/C1  shear     e1     e2");
  for (int m = 0; m < o->count; m++)
    printf(" | %2d x %d kinked, ellip., error, estimate, branch", (int)meshes[m].along, (int)meshes[m].through);
  printf("\n");
}

/* Errors of the meshes but the finest, over their estimates, by the share of the walls that has kinked. */
enum { CLASSES = 3 };
static const double limits[CLASSES + 1] = {0, LAM_KINKED_SHARE, 0.02, 1.01};
typedef struct {
  double error[MOST_STATES], ratio[MOST_STATES];
  int count;
} Class;

static void Count(const LamResponse *r, double error, Class classes[CLASSES])
{
  for (int c = 0; c < CLASSES; c++) {
    Class *class = &classes[c];

    if (r->kinked_fraction < limits[c] || r->kinked_fraction >= limits[c + 1] || !isfinite(r->error_estimate)) continue;
    class->error[class->count] = error;
    class->ratio[class->count++] = error / r->error_estimate;
  }
}

static void PrintClasses(Mesh mesh, Class classes[CLASSES])
{
  for (int c = 0; c < CLASSES; c++) {
    Class *class = &classes[c];
    int within = 0;

    for (int k = 0; k < class->count; k++) within += class->ratio[k] < 3;
    if (!class->count) continue;
    printf("%2d x %d, kinked %.1f to %.1f %%: %d states; error median %.2f %%, 90 %% of them %.2f %%, largest %.2f %%; "
           "error over estimate median %.1f, 90 %% %.1f, largest %.1f; below 3: %d\n",
           (int)mesh.along, (int)mesh.through, 100 * limits[c], fmin(100, 100 * limits[c + 1]), class->count,
           100 * Quantile(class->error, class->count, 0.5), 100 * Quantile(class->error, class->count, 0.9),
           100 * Quantile(class->error, class->count, 1), Quantile(class->ratio, class->count, 0.5),
           Quantile(class->ratio, class->count, 0.9), Quantile(class->ratio, class->count, 1), within);
  }
}

static PetscErrorCode RunState(Options *o, int n, Class classes[MESHES][CLASSES])
{
  const Sample s = Draw(o);
  LamResponse r[MESHES];
  int finest = -1;

  PetscFunctionBeginUser;
  for (int m = 0; m < o->count; m++) {
    PetscCall(SolveOn(&s, o, meshes[m], &r[m]));
    if (r[m].status != LAM_CONVERGED) break;
    finest = m;
  }
  printf("%5d  %.3f  %5.1f  %.3f  %5.2f  %5.2f", n, (double)s.micro.wall_thickness, s.ratio, s.shear, s.e[0], s.e[1]);
  for (int m = 0; m <= finest; m++) {
    const double error = StressError(r[m].P, r[finest].P);

    printf(" | %.4f %7.3f %.2e %.2e %2d", (double)r[m].kinked_fraction, (double)r[m].wall_ellipticity, error,
           (double)r[m].error_estimate, (int)r[m].branch);
    if (m < finest) Count(&r[m], error, classes[m]);
  }
  printf("\n");
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(Options *o)
{
  static Class classes[MESHES][CLASSES];

  PetscFunctionBeginUser;
  PrintHeader(o);
  for (int n = 0; n < o->states; n++) PetscCall(RunState(o, n, classes));
  for (int m = 0; m < o->count - 1; m++) PrintClasses(meshes[m], classes[m]);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  Options o;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  o = (Options){.states = NumberOption("--states", 10, 1, MOST_STATES),
                .steps = NumberOption("--steps", 5, 1, PETSC_MAX_INT),
                .count = HasOption("--fine") ? MESHES : 3,
                .tension = HasOption("--tension"),
                .graded = HasOption("--graded"),
                .turgor = HasOption("--turgor"),
                .seed = (uint64_t)NumberOption("--seed", 20, 0, PETSC_MAX_INT)};
  setvbuf(stdout, NULL, _IOLBF, 0); /* it takes minutes: what is there is told */
  if (Run(&o)) return 1;
  return EndBench();
}
