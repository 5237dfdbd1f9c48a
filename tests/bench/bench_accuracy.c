/* Whether the planner keeps what it is asked: random tissues and loads, solved on the mesh that it takes for 10, 1 and
   0.1 %, on all meshes of its list and on a fine one. Prints, for each accuracy, the share of states whose error is
   below it, the time over that of the cheapest mesh that would have done, and the share of estimates within a factor of
   3 of the error. Usage: bench_accuracy [--contact] [--states N] [--seed N] [--list] */
#include <math.h>
#include <stdio.h>
#include <lamella/lamella.h>
#include "mesh_choice.h"
#include "options.h"
#include "measure.h"
#include "support/random_reals.h"
#include "support/tissue.h"

#define MOST_STATES 1000
#define LONG 0.05 /* s: solves that are not repeated */
#define ACCURACIES 3
static const double accuracies[ACCURACIES] = {0.1, 0.01, 0.001};

typedef struct {
  PetscInt along, through;
} Mesh;

enum { MESHES = 20 };

static const Mesh truths[] = {[LAM_INTERFACE_BONDED] = {36, 8}, [LAM_INTERFACE_CONTACT] = {32, 6}};

typedef struct {
  LamMicrostructure micro;
  LamLoad load;
} Sample;

typedef struct {
  double error, estimate, seconds; /* error: infinite where there is no stable state */
} Solved;

#define LARGEST_INFLATED 1.25 /* walls without fibres do not hold all turgors */

/* Turgor at which the tissue is in equilibrium with free sides, by the strain of thin walls that it then has. */
static PetscReal InflatedStretch(const Sample *s)
{
  return 1 + s->load.turgor / (100 * LamStressScaleOf(&s->micro).plane);
}

/* Tissue and load: walls t/a 0.01 to 0.4, C4/C1 0 to 1000, turgor to 20 (C1 + C2) t/a, strains from the inflated
   state. */
static Sample Draw(LamInterfaceLawType interface, uint64_t *seed)
{
  Sample s = {.micro = DefaultTissue(), .load = PlaneLoad(1, 0, 0, 1, 0)};
  const double size = pow(10, RandomReal(seed, -2, 0)); /* of the largest strains: 1 % to all of them */
  const double e[2] = {size * RandomReal(seed, -0.04, 0.16), size * RandomReal(seed, -0.04, 0.16)},
               angle = RandomReal(seed, 0, PETSC_PI);
  const double shear = size * RandomReal(seed, 0, 0.3), c = cos(angle), d = sin(angle);
  double a, b, U[4];

  s.micro.interface = interface;
  s.micro.wall_thickness = 0.01 * pow(40, RandomReal(seed, 0, 1));
  s.micro.wall.C4 = RandomReal(seed, 0, 1) < 0.2 ? 0 : s.micro.wall.C1 * pow(10, RandomReal(seed, 0, 3));
  s.micro.orientation = RandomReal(seed, 0, 2 * PETSC_PI);
  if (RandomReal(seed, 0, 1) > 0.1) do
      s.load.turgor = s.micro.wall_thickness * 20 * pow(10, RandomReal(seed, -2, 0));
    while (InflatedStretch(&s) > LARGEST_INFLATED);
  a = exp(e[0]) * InflatedStretch(&s);
  b = exp(e[1]) * InflatedStretch(&s);
  U[0] = c * c * a + d * d * b;
  U[1] = U[2] = c * d * (a - b);
  U[3] = d * d * a + c * c * b;
  s.load.F[0] = U[0] + shear * U[2];
  s.load.F[1] = U[1] + shear * U[3];
  s.load.F[3] = U[2];
  s.load.F[4] = U[3];
  return s;
}

static PetscErrorCode SolveOn(const Sample *s, Mesh mesh, LamResponse *response, double *estimate)
{
  LamMicrostructure micro = s->micro;
  LamRVE rve;
  LamRVEState state;
  LamRVEEstimate e;
  LamResponse copy;
  LamMeshTrial listed;
  int solves = 0;

  PetscFunctionBeginUser;
  micro.along = mesh.along;
  micro.through = mesh.through;
  (void)LamListedMesh(micro.interface, 0, &listed);
  micro.grading = listed.grading;
  PetscCall(NewTissue(&micro, &rve, &state));
  PetscCall(LamRVEEstimateCreate(rve, &e));
  do { /* the first one analyses the matrix */
    PetscCall(LamRVEStateReset(rve, state));
    PetscCall(LamRVESolve(rve, &s->load, state, response));
  } while (!solves++ && response->seconds < LONG);
  copy = *response;
  PetscCall(LamRVEEstimateError(e, state, &copy));
  *estimate = copy.error_estimate;
  PetscCall(LamRVEEstimateDestroy(&e));
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}

/* The planner's list. */
static int ListMeshes(LamInterfaceLawType interface, Mesh meshes[MESHES])
{
  LamMeshTrial mesh;
  int n = 0;

  while (n < MESHES && LamListedMesh(interface, n, &mesh)) meshes[n++] = (Mesh){mesh.along, mesh.through};
  return n;
}

static double ErrorOf(const LamMicrostructure *micro, const LamResponse *r, const LamResponse *truth)
{
  return r->status == LAM_CONVERGED ? LamWholeError(LamStressScaleOf(micro), r->P, truth->P) : INFINITY;
}

/* *useful is PETSC_FALSE where the fine mesh has no stable state. */
static PetscErrorCode SolveAll(const Sample *s, Solved solved[MESHES], PetscBool *useful)
{
  Mesh meshes[MESHES];
  const int count = ListMeshes(s->micro.interface, meshes);
  LamResponse truth, response;
  double nothing;

  PetscFunctionBeginUser;
  PetscCall(SolveOn(s, truths[s->micro.interface], &truth, &nothing));
  *useful = (PetscBool)(truth.status == LAM_CONVERGED);
  for (int m = 0; m < count && *useful; m++) {
    PetscCall(SolveOn(s, meshes[m], &response, &solved[m].estimate));
    solved[m].seconds = response.seconds;
    solved[m].error = ErrorOf(&s->micro, &response, &truth);
  }
  PetscFunctionReturn(0);
}

/* Which mesh the planner takes, and whether it warns that this one does not do. */
static PetscErrorCode Choose(const Sample *s, double accuracy, int *chosen, PetscBool *warns)
{
  Mesh meshes[MESHES];
  const int count = ListMeshes(s->micro.interface, meshes);
  LamLoad load = s->load;
  LamMeshTrial trial;
  LamScene scene = {.micro = s->micro, .accuracy = accuracy, .load_count = 1, .loads = &load};

  PetscFunctionBeginUser;
  scene.micro.along = scene.micro.through = 0;
  scene.micro.grading = -1;
  PetscCall(LamChooseMesh(&scene, &trial));
  *warns = (PetscBool) !(trial.error <= accuracy);
  *chosen = 0;
  while (*chosen < count - 1 &&
         (meshes[*chosen].along != scene.micro.along || meshes[*chosen].through != scene.micro.through))
    (*chosen)++;
  PetscFunctionReturn(0);
}

typedef struct {
  double kept, times[MOST_STATES], cheap;
  int count, timed, warned;
} Verdict;

static void Judge(int meshes, const Solved solved[], int chosen, double accuracy, Verdict *v)
{
  double cheapest = INFINITY;

  for (int m = 0; m < meshes; m++)
    if (solved[m].error <= accuracy) cheapest = fmin(cheapest, solved[m].seconds);
  v->count++;
  v->kept += solved[chosen].error <= accuracy;
  if (!isfinite(cheapest)) return;
  v->times[v->timed++] = solved[chosen].seconds / cheapest;
  v->cheap += solved[chosen].seconds <= 3 * cheapest;
}

static void Print(Verdict v[ACCURACIES], int estimates, int near)
{
  printf("accuracy  states  kept  or warned  time over that of the cheapest: median, 90 %%, within 3\n");
  for (int k = 0; k < ACCURACIES; k++)
    printf("%6.1f %%  %6d  %3.0f %%  %3.0f %%       %.2f  %.2f  %3.0f %%\n", 100 * accuracies[k], v[k].count,
           100 * v[k].kept / v[k].count, 100 * (v[k].kept + v[k].warned) / v[k].count,
           Quantile(v[k].times, v[k].timed, 0.5), Quantile(v[k].times, v[k].timed, 0.9), 100 * v[k].cheap / v[k].timed);
  printf("estimates within a factor of 3 of the error, on the meshes taken: %d of %d (%.0f %%)\n", near, estimates,
         100.0 * near / estimates);
}

static void List(int n, const Sample *s, const Solved solved[])
{
  Mesh meshes[MESHES];
  const int count = ListMeshes(s->micro.interface, meshes);

  for (int m = 0; m < count; m++)
    printf("%d  t/a %.4f C4/C1 %.2f p %.4f  %2d x %d  error %.3e  estimate %.3e  %.2f ms\n", n,
           (double)s->micro.wall_thickness, (double)(s->micro.wall.C4 / s->micro.wall.C1), (double)s->load.turgor,
           (int)meshes[m].along, (int)meshes[m].through, solved[m].error, solved[m].estimate, 1e3 * solved[m].seconds);
}

static PetscErrorCode Run(LamInterfaceLawType interface, int states, uint64_t seed, PetscBool list)
{
  static Verdict verdict[ACCURACIES];
  Mesh meshes[MESHES];
  const int count = ListMeshes(interface, meshes);
  int estimates = 0, near = 0, failed = 0;

  PetscFunctionBeginUser;
  for (int n = 0; n < states; n++) {
    const Sample s = Draw(interface, &seed);
    Solved solved[MESHES];
    PetscBool useful;

    PetscCall(SolveAll(&s, solved, &useful));
    failed += !useful;
    if (list && useful) List(n, &s, solved);
    for (int k = 0; k < ACCURACIES && useful; k++) {
      double ratio;
      PetscBool warns;
      int chosen;

      PetscCall(Choose(&s, accuracies[k], &chosen, &warns));
      if (list)
        printf("%d  at %g: %d x %d, error %.3e\n", n, accuracies[k], (int)meshes[chosen].along,
               (int)meshes[chosen].through, solved[chosen].error);
      ratio = solved[chosen].estimate / solved[chosen].error;
      verdict[k].warned += warns && solved[chosen].error > accuracies[k];
      Judge(count, solved, chosen, accuracies[k], &verdict[k]);
      estimates++;
      near += ratio > 1 / 3.0 && ratio < 3;
    }
  }
  printf("%s tissue, %d random states, %d without a stable one on the fine mesh\n", LamInterfaceLawNames[interface],
         states, failed);
  Print(verdict, estimates, near);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  setvbuf(stdout, NULL, _IOLBF, 0); /* it takes minutes: what is there is told */
  if (Run(HasOption("--contact") ? LAM_INTERFACE_CONTACT : LAM_INTERFACE_BONDED,
          NumberOption("--states", 30, 1, MOST_STATES), (uint64_t)NumberOption("--seed", 77, 0, PETSC_MAX_INT),
          HasOption("--list")))
    return 1;
  return EndBench();
}
