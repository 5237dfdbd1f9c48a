/*
  Two cuboids in contact under generalised shear (Mihai, Safar & Wyatt, Section 4.1): gaps along the interface over
  shear, pressure and mesh, both tops moved alike or apart, with and without freedom across the plane; prints the tables
  of docs/results/paper-cuboids.md, asserts nothing. Takes a minute.

    bench_cuboids [N]        N x N elements a body, default 16
*/
#include <stdio.h>
#include "support/cuboids.h"

#define PRESSURES 6
#define MESHES 4
#define STRIP 41 /* characters of a picture of the interface */

static const PetscReal pressures[PRESSURES] = {0.0, 0.01, 0.02, 0.05, 0.1, 0.3}; /* MPa */
static const char *const pair_name[2] = {"equal bodies", "unequal bodies, C4 = 1 and 0.1 MPa"};

static CuboidsSetup Pair(int unequal, PetscInt n, PetscReal shear, PetscReal pressure)
{
  return unequal ? CuboidsUnequal(n, shear, pressure) : CuboidsDefault(n, shear, pressure);
}

/* x: in contact, dot: apart, from the bottom to the top. */
static void PrintStrip(const CuboidsProfile *profile)
{
  printf(" ");
  for (int i = 0; i < STRIP; i++)
    printf("%c", profile->pressure[i * (CUBOIDS_SAMPLES - 1) / (STRIP - 1)] > 0 ? 'x' : '.');
}

static void PrintProfile(const CuboidsProfile *profile)
{
  for (int i = 1; i < 10; i++) printf(" %7.3f", 1e3 * profile->gap[i * (CUBOIDS_SAMPLES - 1) / 10]);
}

static void PrintHead(const char first[], const char last[])
{
  printf("%s", first);
  for (int i = 1; i < 10; i++) printf("  X2=0.%d", i);
  printf("%s\n", last);
}

static PetscErrorCode Profiles(PetscInt n)
{
  PetscFunctionBeginUser;
  for (int unequal = 0; unequal < 2; unequal++) {
    printf("\ngap, 1e-3 edges: %s, shear 0.5, %d x %d elements a body\n", pair_name[unequal], (int)n, (int)n);
    PrintHead("p, MPa", "  largest at X2  apart open  area, 1e-3  contact from bottom to top");
    for (int k = 0; k < PRESSURES; k++) {
      const CuboidsSetup setup = Pair(unequal, n, 0.5, pressures[k]);
      CuboidsProfile profile = {0};
      Cuboids cuboids;

      PetscCall(CuboidsCompute(&setup, &cuboids, &profile));
      printf("%-6.2f", pressures[k]);
      PrintProfile(&profile);
      printf("  %7.3f %-5.3f  %-5.2f %-5.2f %-10.4f ", 1e3 * profile.largest, profile.at, profile.apart, profile.open,
             1e3 * profile.area);
      PrintStrip(&profile);
      printf("\n");
      PetscCall(CuboidsDestroy(&cuboids));
    }
  }
  PetscFunctionReturn(0);
}

/* Largest gap and share apart along a ramp of the shear in five steps, each from the one before. */
static PetscErrorCode RampRow(const CuboidsSetup *setup, PetscInt *iterations)
{
  Cuboids cuboids;

  PetscFunctionBeginUser;
  PetscCall(CuboidsCreate(setup, &cuboids));
  for (int step = 1; step <= 5; step++) {
    CuboidsProfile profile;
    PetscBool converged;

    PetscCall(CuboidsSolve(&cuboids, 0.2 * step, setup->pressure, &converged));
    CuboidsFindProfile(&cuboids, &profile);
    if (converged && CuboidsIsStable(&cuboids))
      printf("  %7.3f %4.2f", 1e3 * profile.largest, profile.apart);
    else
      printf("  %12s", "none");
  }
  *iterations += cuboids.iterations;
  PetscCall(CuboidsDestroy(&cuboids));
  PetscFunctionReturn(0);
}

static PetscErrorCode Ramps(PetscInt n)
{
  PetscFunctionBeginUser;
  for (int unequal = 0; unequal < 2; unequal++) {
    PetscInt iterations = 0, rows = 0;

    printf(
        "\nlargest gap, 1e-3 edges, and share apart along a ramp: %s\nsign p, MPa   shear 0.1           0.2           "
        "0.3           0.4           0.5\n",
        pair_name[unequal]);
    for (int sign = 1; sign >= -1; sign -= 2)
      for (int k = 0; k < PRESSURES; k++, rows++) {
        const CuboidsSetup setup = Pair(unequal, n, 0.5 * sign, pressures[k]);

        printf("%c    %-6.2f", sign > 0 ? '+' : '-', pressures[k]);
        PetscCall(RampRow(&setup, &iterations));
        printf("\n");
      }
    printf("iterations a step: %.1f\n", (double)iterations / (5.0 * rows));
  }
  PetscFunctionReturn(0);
}

/* One case on all meshes; errors are those of the gap relative to its largest on the finest mesh. */
static PetscErrorCode MeshRows(const char name[], CuboidsSetup setup)
{
  static const PetscInt meshes[MESHES] = {8, 12, 16, 24};
  CuboidsProfile profile[MESHES];
  PetscReal seconds[MESHES], error[MESHES];
  PetscInt iterations[MESHES];

  PetscFunctionBeginUser;
  for (int m = 0; m < MESHES; m++) {
    Cuboids cuboids;

    setup.n = meshes[m];
    PetscCall(CuboidsCompute(&setup, &cuboids, &profile[m]));
    seconds[m] = cuboids.seconds;
    iterations[m] = cuboids.iterations;
    PetscCall(CuboidsDestroy(&cuboids));
  }
  for (int m = 0; m < MESHES; m++) {
    error[m] = CuboidsGapError(&profile[m], &profile[MESHES - 1]);
    printf("%-8s %-6.2f  %2d x %-2d  %8.4f  %8.5f  %8.4f  %9.1e  %2d  %6.3f", name, CUBOIDS_STRESS * setup.pressure,
           (int)meshes[m], (int)meshes[m], 1e3 * profile[m].largest, 1e3 * profile[m].area, error[m], profile[m].depth,
           (int)iterations[m], seconds[m]);
    if (m == 2)
      printf("  order %.1f", PetscLogReal(error[0] / error[2]) / PetscLogReal((PetscReal)meshes[2] / meshes[0]));
    printf("\n");
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Meshes(void)
{
  PetscFunctionBeginUser;
  printf("\nmeshes, shear 0.5 in one step (apart: tops moved by 0.375 and 0.5); error: largest difference of the gap "
         "to 24 x 24, relative to the largest gap\n"
         "bodies   p, MPa  mesh     largest   area      error     depth      its s\n");
  PetscCall(MeshRows("equal", CuboidsDefault(0, 0.5, 0.0)));
  for (int k = 0; k < 3; k++) PetscCall(MeshRows("unequal", CuboidsUnequal(0, 0.5, pressures[k])));
  for (int k = 0; k < PRESSURES; k += 2) {
    CuboidsSetup setup = CuboidsDefault(0, 0.5, pressures[k]);

    setup.top[0] = 0.375;
    PetscCall(MeshRows("apart", setup));
  }
  PetscFunctionReturn(0);
}

/* Tops moved differently without pressure, then pressure step by step. */
static PetscErrorCode Apart(PetscInt n, PetscReal left, PetscReal right)
{
  CuboidsSetup setup = CuboidsDefault(n, 0.5, 0.0);
  Cuboids cuboids;

  PetscFunctionBeginUser;
  setup.top[0] = left;
  setup.top[1] = right;
  printf("\ngap, 1e-3 edges: tops moved apart, by %g and %g, equal bodies\n", left, right);
  PrintHead("p, MPa", "   X2=1  area, 1e-3");
  PetscCall(CuboidsCreate(&setup, &cuboids));
  for (int k = 0; k < PRESSURES; k++) {
    CuboidsProfile profile;
    PetscBool converged;

    if (k == 0)
      PetscCall(CuboidsSolve(&cuboids, 1.0, 0.0, &converged));
    else
      PetscCall(CuboidsSolve(&cuboids, 1.0, pressures[k] / CUBOIDS_STRESS, &converged));
    CuboidsFindProfile(&cuboids, &profile);
    printf("%-6.2f", pressures[k]);
    PrintProfile(&profile);
    printf(" %7.3f  %.2f%s\n", 1e3 * profile.gap[CUBOIDS_SAMPLES - 1], 1e3 * profile.area, converged ? "" : "  none");
  }
  PetscCall(CuboidsDestroy(&cuboids));
  PetscFunctionReturn(0);
}

/* Horizontal gap k X2 - (3 k / 4) X2^(4/3) of the two shears of the paper's Section 3, which prescribes them. */
static void PrintKinematicGap(PetscReal k)
{
  printf("paper ");
  for (int i = 1; i <= 10; i++) {
    const PetscReal X2 = 0.1 * i;

    printf(" %7.3f", 1e3 * k * (X2 - 0.75 * PetscPowReal(X2, 4.0 / 3.0)));
  }
  printf("\n");
}

/* Normal pressure on the sides in homogeneous shear of plane stress, MPa: docs/results/paper-cuboids.md. */
static PetscReal SidePressure(PetscReal shear)
{
  const PetscReal C1 = 0.1, C2 = 0.01, square = shear * shear;

  return (C1 * square + C2 * (2.0 * square + square * square)) / (1.0 + square);
}

/* Along a ramp of the shear to 0.4 in steps of 0.1. */
static PetscErrorCode DepthRows(int unequal, PetscBool plane_stress, PetscInt n)
{
  CuboidsSetup setup = Pair(unequal, n, 0.4, 0.0);
  Cuboids cuboids;

  PetscFunctionBeginUser;
  setup.plane_stress = plane_stress;
  PetscCall(CuboidsCreate(&setup, &cuboids));
  for (int step = 1; step <= 4; step++) {
    const PetscReal shear = 0.1 * step;
    CuboidsProfile profile;
    PetscReal force[2];
    PetscBool converged;

    PetscCall(CuboidsSolve(&cuboids, 0.25 * step, 0.0, &converged));
    CuboidsFindProfile(&cuboids, &profile);
    CuboidsContactForce(&cuboids, force);
    printf("%-8s %-12s  %.1f    ", unequal ? "unequal" : "equal", plane_stress ? "plane stress" : "plane strain",
           shear);
    if (converged && CuboidsIsStable(&cuboids))
      printf("%-17.3f  %-5.2f  %-13.5f  %.5f\n", 1e3 * profile.largest, profile.apart, -CUBOIDS_STRESS * force[0],
             SidePressure(shear));
    else
      printf("none\n");
  }
  PetscCall(CuboidsDestroy(&cuboids));
  PetscFunctionReturn(0);
}

/* The two bounds of freedom along X3: none (plane strain), and faces without traction (plane stress). */
static PetscErrorCode Depths(PetscInt n)
{
  PetscFunctionBeginUser;
  printf("\nfreedom along X3, no pressure; contact: horizontal force per height; estimate: of homogeneous shear, MPa\n"
         "bodies   state         shear  largest gap, 1e-3  apart  contact, MPa   estimate\n");
  for (int unequal = 0; unequal < 2; unequal++) {
    PetscCall(DepthRows(unequal, PETSC_FALSE, n));
    PetscCall(DepthRows(unequal, PETSC_TRUE, n));
  }
  PetscFunctionReturn(0);
}

/* Pressure outside and cohesion at the interface act through their sum. */
static PetscErrorCode Cohesion(PetscInt n)
{
  CuboidsProfile reference;

  PetscFunctionBeginUser;
  printf("\ncohesion: unequal bodies, shear 0.5\np, MPa  g, MPa  largest gap, 1e-3  difference to the first, of the "
         "largest gap\n");
  for (int k = 0; k < 3; k++) {
    CuboidsSetup setup = CuboidsUnequal(n, 0.5, 0.01 * (2 - k));
    CuboidsProfile profile;
    Cuboids cuboids;

    setup.cohesion = 0.01 * k / CUBOIDS_STRESS;
    PetscCall(CuboidsCompute(&setup, &cuboids, &profile));
    if (k == 0) reference = profile;
    printf("%-6.2f  %-6.2f  %-17.4f  %.1e\n", 0.01 * (2 - k), 0.01 * k, 1e3 * profile.largest,
           CuboidsGapError(&profile, &reference));
    PetscCall(CuboidsDestroy(&cuboids));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(PetscInt n)
{
  PetscFunctionBeginUser;
  PetscCall(Profiles(n));
  PetscCall(Ramps(n));
  PetscCall(Meshes());
  PetscCall(Apart(n, 0.375, 0.5));
  PrintKinematicGap(0.5);
  PetscCall(Apart(n, -0.5, 0.5));
  PetscCall(Depths(n));
  PetscCall(Cohesion(n));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  const PetscInt n = argc > 1 ? atoi(argv[1]) : 16;

  if (n < 4) {
    fprintf(stderr, "bench_cuboids: %s is no number of elements; give 4 or more, for example 16\n", argv[1]);
    return 1;
  }
  argc = 1;
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (Run(n)) return 1;
  return PetscFinalize() ? 1 : 0;
}
