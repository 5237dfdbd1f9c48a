/*
  Stress error of the nearest-record expansion against its distance, on held-out states of the default tissue; prints
  figures, asserts nothing. This is where the trust radius of cache.h comes from.
*/
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <petsctime.h>
#include <lamella/lamella.h>

#define CENTRES 60
#define DIRECTIONS 4

static const char scene_text[] = "version: 1\n"
                                 "rve:\n"
                                 "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                                 "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
                                 "  mesh: {along: 6, through: 2}\n"
                                 "  turgor: {mode: prescribed, pressure: 0.02 MPa}\n";

static double Uniform(unsigned *seed, double low, double high)
{
  *seed = *seed * 1664525u + 1013904223u;
  return low + (high - low) * (double)(*seed >> 8) / 16777216.0;
}

/* F = exp of the symmetric strain H = (h11, h12, h22), to second order in its difference: enough to place states. */
static LamLoad StretchLoad(const double h[3], double turgor)
{
  const double m = 0.5 * (h[0] + h[2]), d = 0.5 * (h[0] - h[2]), r = sqrt(d * d + h[1] * h[1]);
  const double c = exp(m) * cosh(r), s = r > 0.0 ? exp(m) * sinh(r) / r : 0.0;
  const LamLoad load = {.F = {c + s * d, s * h[1], 0, s * h[1], c - s * d, 0, 0, 0, 1}, .turgor = turgor};

  return load;
}

static int Compare(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;

  return (x > y) - (x < y);
}

static PetscErrorCode Solve(LamRVE rve, LamRVEState state, const double h[3], double turgor, LamResponse *response)
{
  const LamLoad load = StretchLoad(h, turgor);

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateReset(rve, state));
  PetscCall(LamRVESolve(rve, &load, state, response));
  PetscFunctionReturn(0);
}

/* Errors at one distance from CENTRES records; principal strains of the centres in [low, 0.25]. */
static PetscErrorCode Measure(const LamScene *scene, LamRVE rve, LamRVEState state, double distance, double low)
{
  double error[CENTRES * DIRECTIONS], ratio[CENTRES * DIRECTIONS];
  unsigned seed = 7;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < CENTRES; ++i) {
    const double e1 = Uniform(&seed, low, 0.25), e2 = Uniform(&seed, low, 0.25), angle = Uniform(&seed, 0.0, PETSC_PI);
    const double m = 0.5 * (e1 + e2), r = 0.5 * (e1 - e2);
    const double h[3] = {m + r * cos(2.0 * angle), r * sin(2.0 * angle), m - r * cos(2.0 * angle)};
    LamDatabase database;
    LamResponse centre;

    PetscCall(Solve(rve, state, h, scene->turgor, &centre));
    if (centre.status != LAM_CONVERGED || centre.branch > 0) continue;
    PetscCall(LamDatabaseCreateEmpty(scene, &database));
    PetscCall(LamDatabaseAdd(database, 1, NULL, &centre));
    for (PetscInt k = 0; k < DIRECTIONS; ++k) {
      const double a = Uniform(&seed, -1.0, 1.0), b = Uniform(&seed, -1.0, 1.0), c = Uniform(&seed, -1.0, 1.0);
      const double scale = distance / sqrt(0.5 * (a * a + c * c) + b * b);
      const double g[3] = {h[0] + scale * a, h[1] + scale * b, h[2] + scale * c};
      LamResponse truth, answer;

      PetscCall(Solve(rve, state, g, scene->turgor, &truth));
      if (truth.status != LAM_CONVERGED || truth.branch > 0) continue;
      PetscCall(LamDatabaseQuery(database, &truth.load, INFINITY, &answer));
      error[n] = LamStressError(answer.P, truth.P);
      ratio[n] = error[n] / (answer.distance * answer.distance);
      ++n;
    }
    PetscCall(LamDatabaseClose(&database));
  }
  qsort(error, (size_t)n, sizeof(*error), Compare);
  qsort(ratio, (size_t)n, sizeof(*ratio), Compare);
  printf("%8.3f %8.3f %6d   %7.3f %7.3f %7.3f %7.3f   %16.3f\n", low, distance, (int)n, 100 * error[n / 2],
         100 * error[n * 95 / 100], 100 * error[n * 99 / 100], 100 * error[n - 1], 1.0 / sqrt(ratio[n * 99 / 100]));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(void)
{
  static const double distances[] = {0.005, 0.01, 0.015, 0.02, 0.04};
  LamScene *scene;
  LamRVE rve;
  LamRVEState state;

  PetscFunctionBeginUser;
  PetscCall(LamSceneReadText("bench_query", scene_text, &scene));
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &rve));
  PetscCall(LamRVESetMicrostructure(rve, &scene->micro));
  PetscCall(LamRVESetUp(rve));
  PetscCall(LamRVEStateCreate(rve, &state));
  printf("P error of one record's second-order expansion; states that have buckled are left out\n");
  printf("  strain distance states   error %% median, 95 %%, 99 %%, max   distance / sqrt(99 %% error)\n");
  for (PetscInt k = 0; k < 2; ++k)
    for (size_t i = 0; i < sizeof(distances) / sizeof(distances[0]); ++i)
      PetscCall(Measure(scene, rve, state, distances[i], k == 0 ? 0.0 : -0.02));
  PetscCall(LamRVEStateDestroy(&state));
  PetscCall(LamRVEDestroy(&rve));
  PetscCall(LamSceneDestroy(&scene));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (Run()) return 1;
  return PetscFinalize() ? 1 : 0;
}
