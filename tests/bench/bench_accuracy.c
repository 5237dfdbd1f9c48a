/* Whether the planner keeps what it is asked: random tissues and loads that its model was not fitted to, solved on the
   mesh that it takes for 10, 1 and 0.1 %, on all other meshes and on a fine one. Prints, for each accuracy, the share
   of states whose error is below it, the time over that of the cheapest mesh that would have done, and the share of
   estimates within a factor of 3 of the error. Usage: bench_accuracy [--contact] [--states N] [--seed N] [--list] */
#include <math.h>
#include <stdio.h>
#include <lamella/lamella.h>
#include "error_model.h"
#include "options.h"
#include "measure.h"
#include "support/random_reals.h"
#include "support/tissue.h"

#define MOST_STATES 1000
#define ACCURACIES 3
static const double accuracies[ACCURACIES] = {0.1, 0.01, 0.001};

typedef struct {
  PetscInt along, through;
} Mesh;
static const Mesh meshes[] = {{4, 1}, {4, 2}, {6, 2}, {8, 2}, {10, 2}, {12, 2}, {8, 4}, {12, 4}, {16, 4}, {20, 6}};
enum { MESHES = PETSC_STATIC_ARRAY_LENGTH(meshes) };

typedef struct {
  LamMicrostructure micro;
  LamLoad load;
  LamErrorCase c;
} Sample;

typedef struct {
  double error, estimate, seconds; /* error: infinite where there is no stable state */
} Solved;

static Sample Draw(LamInterfaceLawType interface, uint64_t *seed)
{
  Sample s = {.micro = DefaultTissue(), .load = PlaneLoad(1, 0, 0, 1, 0)};
  const double e[2] = {RandomReal(seed, -0.04, 0.16), RandomReal(seed, -0.04, 0.16)},
               angle = RandomReal(seed, 0, PETSC_PI);
  const double shear = RandomReal(seed, 0, 0.3), c = cos(angle), d = sin(angle), a = exp(e[0]), b = exp(e[1]);
  const double U[4] = {c * c * a + d * d * b, c * d * (a - b), c * d * (a - b), d * d * a + c * c * b};

  s.micro.interface = interface;
  s.micro.wall_thickness = 0.04 * pow(10, RandomReal(seed, 0, 1));
  s.micro.wall.C4 = s.micro.wall.C1 * pow(10, RandomReal(seed, 0.5, 1.5));
  s.micro.orientation = RandomReal(seed, 0, 2 * PETSC_PI);
  s.load.F[0] = U[0] + shear * U[2];
  s.load.F[1] = U[1] + shear * U[3];
  s.load.F[3] = U[2];
  s.load.F[4] = U[3];
  s.load.turgor = RandomReal(seed, 0.1, 0.5);
  s.c = (LamErrorCase){interface, s.micro.wall_thickness, s.micro.wall.C4 / s.micro.wall.C1, LamStrainSize(s.load.F)};
  return s;
}

static PetscErrorCode SolveOn(const Sample *s, Mesh mesh, PetscReal grading, LamResponse *response, double *estimate)
{
  LamMicrostructure micro = s->micro;
  LamRVE rve;
  LamRVEState state;
  LamRVEEstimate e;
  LamResponse copy;

  PetscFunctionBeginUser;
  micro.along = mesh.along;
  micro.through = mesh.through;
  micro.grading = grading;
  PetscCall(NewTissue(&micro, &rve, &state));
  PetscCall(LamRVEEstimateCreate(rve, &e));
  for (int k = 0; k < 2; k++) { /* the first one analyses the matrix */
    PetscCall(LamRVEStateReset(rve, state));
    PetscCall(LamRVESolve(rve, &s->load, state, response));
  }
  copy = *response;
  PetscCall(LamRVEEstimateError(e, state, &copy));
  *estimate = copy.error_estimate;
  PetscCall(LamRVEEstimateDestroy(&e));
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}

/* *useful is PETSC_FALSE where the fine mesh has no stable state. */
static PetscErrorCode SolveAll(const Sample *s, PetscReal grading, Solved solved[MESHES], PetscBool *useful)
{
  const PetscBool contact = (PetscBool)(s->c.interface == LAM_INTERFACE_CONTACT);
  const Mesh fine = {contact ? 28 : 32, contact ? 4 : 8};
  LamResponse truth, response;
  double nothing;

  PetscFunctionBeginUser;
  PetscCall(SolveOn(s, fine, grading, &truth, &nothing));
  *useful = (PetscBool)(truth.status == LAM_CONVERGED);
  for (int m = 0; m < MESHES && *useful; m++) {
    PetscCall(SolveOn(s, meshes[m], grading, &response, &solved[m].estimate));
    solved[m].seconds = response.seconds;
    solved[m].error = response.status == LAM_CONVERGED ? LamStressError(response.P, truth.P) : INFINITY;
  }
  PetscFunctionReturn(0);
}

/* Which mesh the planner takes; the last where it takes a finer one. */
static int Chosen(const LamErrorCase *c, double accuracy, PetscReal *grading)
{
  PetscInt along, through;
  int m = 0;

  LamCheapestMesh(c, accuracy, &along, &through, grading);
  while (m < MESHES - 1 && (meshes[m].along != along || meshes[m].through != through)) m++;
  return m;
}

typedef struct {
  double kept, times[MOST_STATES], cheap;
  int count, timed;
} Verdict;

static void Judge(const Solved solved[MESHES], int chosen, double accuracy, Verdict *v)
{
  double cheapest = INFINITY;

  for (int m = 0; m < MESHES; m++)
    if (solved[m].error <= accuracy) cheapest = fmin(cheapest, solved[m].seconds);
  v->count++;
  v->kept += solved[chosen].error <= accuracy;
  if (!isfinite(cheapest)) return;
  v->times[v->timed++] = solved[chosen].seconds / cheapest;
  v->cheap += solved[chosen].seconds <= 3 * cheapest;
}

static void Print(Verdict v[ACCURACIES], int estimates, int near)
{
  printf("accuracy  states  kept  time over that of the cheapest: median, 90 %%, within 3\n");
  for (int k = 0; k < ACCURACIES; k++)
    printf("%6.1f %%  %6d  %3.0f %%  %.2f  %.2f  %3.0f %%\n", 100 * accuracies[k], v[k].count,
           100 * v[k].kept / v[k].count, Quantile(v[k].times, v[k].timed, 0.5), Quantile(v[k].times, v[k].timed, 0.9),
           100 * v[k].cheap / v[k].timed);
  printf("estimates within a factor of 3 of the error, on the meshes taken: %d of %d (%.0f %%)\n", near, estimates,
         100.0 * near / estimates);
}

static PetscErrorCode Run(LamInterfaceLawType interface, int states, uint64_t seed, PetscBool list)
{
  static Verdict verdict[ACCURACIES];
  int estimates = 0, near = 0, failed = 0;

  PetscFunctionBeginUser;
  for (int n = 0; n < states; n++) {
    const Sample s = Draw(interface, &seed);
    Solved solved[MESHES];
    PetscReal grading;
    PetscBool useful;

    (void)Chosen(&s.c, 0.01, &grading);
    PetscCall(SolveAll(&s, grading, solved, &useful));
    failed += !useful;
    if (list && useful)
      for (int m = 0; m < MESHES; m++)
        printf("%d  %.4f %.2f %.3f  %2d x %d  error %.3e  estimate %.3e  %.2f ms\n", n, (double)s.c.thickness,
               (double)s.c.fibres, (double)s.c.strain, (int)meshes[m].along, (int)meshes[m].through, solved[m].error,
               solved[m].estimate, 1e3 * solved[m].seconds);
    for (int k = 0; k < ACCURACIES && useful; k++) {
      const int chosen = Chosen(&s.c, accuracies[k], &grading);
      const double ratio = solved[chosen].estimate / solved[chosen].error;

      Judge(solved, chosen, accuracies[k], &verdict[k]);
      if (!isfinite(ratio)) continue;
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
