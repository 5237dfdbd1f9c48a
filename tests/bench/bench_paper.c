/* The figures of docs/results/paper.md: Section 3 of Mihai, Safar & Wyatt; asserts nothing. */
#include <stdio.h>
#include "support/gap_between_walls.h"
#include "support/paper_shear.h"
#include "support/strip.h"

static PetscErrorCode Stresses(void)
{
  ShearErrors e;

  PetscFunctionBeginUser;
  PetscCall(ComputeShearErrors(&e));
  printf("prescribed shear, %d random states, over 1 + the largest stress\n", SHEAR_STATES);
  printf("  kernels: P %.1e, Cauchy %.1e, tractions %.1e\n", e.nominal, e.cauchy, e.traction);
  printf("  element: nodal forces %.1e, fibre stretch %.1e, principal stress %.1e\n", e.force, e.stretch, e.principal);
  PetscFunctionReturn(0);
}

/* Default tissue, fibres along X2, sigma22 = 0, on planes that were X1 = const and X2 = const. */
static void Tractions(void)
{
  static const double normals[2][2] = {{1, 0}, {0, 1}};
  const LamWall wall = DefaultStrip(1, 1e3).wall;

  printf(
      "\ntractions, sigma22 = 0, C1 + C2\nplane  s     P N                   sigma n               N.PN      n.PN      "
      "n.sigma n  shear     area\n");
  for (int plane = 0; plane < 2; plane++)
    for (double s = 0.1; s < 1.1; s += s < 0.4 ? 0.4 : 0.5) {
      const ExactShear stress = ShearStress(&wall, GAP_PSI, s, ShearPressure(&wall, GAP_PSI, s, 0.0));
      const FaceTraction t = ShearTraction(&stress, s, normals[plane]);

      printf("X%d     %.1f  (%9.5f, %8.5f)  (%9.5f, %8.5f)  %9.5f %9.5f %9.5f %9.5f  %.5f\n", plane + 1, s,
             t.nominal[0], t.nominal[1], t.cauchy[0], t.cauchy[1], t.nominal[plane], t.normal * t.stretch, t.normal,
             t.shear, t.stretch);
    }
}

/* Default tissue, then fibres ever stiffer at k = 0.1. */
static void Gaps(void)
{
  static const double shears[] = {1.0, 0.5, 0.2, 0.1, 0.01};

  printf("\ngap between walls, fibres along X2\nk     C4        (C1+C2)/(C4 k^2)  gap(1)/k  sigma12(1)  shear     "
         "normal\n");
  for (int i = 0; i < 9; i++) {
    LamWall wall = DefaultStrip(1, 1e3).wall;
    const double k = i < 5 ? shears[i] : 0.1;
    Gap gap;

    if (i >= 5) wall.C4 = pow(10.0, i - 2);
    gap = ComputeGap(&wall, k);
    printf("%-5g %-9.3g %-17.3g %-9.4f %-11.3e %.3e %.3e\n", k, wall.C4, gap.ratio, gap.gap, gap.scale, gap.shear,
           gap.spread);
  }
}

/* Default tissue, then stiffer fibres; kappa = 1000 (C1 + C2). */
static PetscErrorCode Faces(void)
{
  static const double cases[][2] = {{10.0 / 1.1, 0.5},  {10.0 / 1.1, 0.2}, {10.0 / 1.1, 0.1},
                                    {10.0 / 1.1, 0.01}, {100.0, 0.5},      {100.0, 0.1}};

  PetscFunctionBeginUser;
  printf("\ngap between free faces over k: computed, of the cubic, of the power 4/3\n");
  for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
    LamWall wall = DefaultStrip(1, 1e3).wall;
    FreeFaces f = {{0}, {0}, {0}};
    double least = 0.0;

    wall.C4 = cases[i][0];
    PetscCall(ComputeFreeFaces(&wall, cases[i][1], &f));
    for (int j = 0; j < FACE_NODES; j++) least = fmin(least, f.computed[j]);
    printf("C4 = %.3g, k = %g, least %.1e\n", wall.C4, cases[i][1], least);
    for (int j = FACE_ELEMENTS / 2; j < FACE_NODES; j += FACE_ELEMENTS / 2)
      printf("  X2 = %.2f  %.4f  %.4f  %.4f\n", j / (FACE_NODES - 1.0), f.computed[j], f.sheared[j], f.power[j]);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Meshes(const char *title, StripProblem problem)
{
  StripErrors e, before = {0};

  PetscFunctionBeginUser;
  printf(
      "\nstrip, %s: kappa = %g, psi = %g deg\nrows  iter.  f         f'        node      x2 - X2   sigma12   sigma22   "
      "orders\n",
      title, problem.wall.bulk_modulus, problem.psi * 180.0 / PETSC_PI);
  for (PetscInt rows = 1; rows <= 32; rows *= 2, before = e) {
    problem.rows = rows;
    PetscCall(ComputeStrip(problem, &e));
    printf("%-5d %-6d %.2e  %.2e  %.2e  %.2e  %.2e  %.2e", (int)rows, (int)e.iterations, e.displacement, e.gradient,
           e.nodal, e.lateral, e.shear, e.normal);
    if (rows > 1)
      printf("  %.2f %.2f %.2f %.2f %.2f", log2(before.displacement / e.displacement),
             log2(before.gradient / e.gradient), log2(before.nodal / e.nodal), log2(before.shear / e.shear),
             log2(before.normal / e.normal));
    printf("\n");
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode BulkModuli(void)
{
  PetscFunctionBeginUser;
  printf("\nstrip, 32 rows\nkappa     f         f'        x2 - X2   sigma12   iter.\n");
  for (double kappa = 1e2; kappa < 2e9; kappa *= 10.0) {
    StripErrors e;

    PetscCall(ComputeStrip(DefaultStrip(32, kappa), &e));
    printf("%-8.0e  %.2e  %.2e  %.2e  %.2e  %d\n", kappa, e.displacement, e.gradient, e.lateral, e.shear,
           (int)e.iterations);
  }
  PetscFunctionReturn(0);
}

int main(void)
{
  StripProblem pulled = DefaultStrip(1, 1e8), oblique = DefaultStrip(1, 1e8);

  if (PetscInitialize(NULL, NULL, NULL, NULL)) return 1;
  pulled.pulled = PETSC_TRUE;
  oblique.psi = 75.0 * PETSC_PI / 180.0;
  if (Stresses()) return 1;
  Tractions();
  Gaps();
  if (Faces() || Meshes("moved", DefaultStrip(1, 1e8)) || Meshes("pulled", pulled) || Meshes("oblique", oblique) ||
      BulkModuli())
    return 1;
  return PetscFinalize() ? 1 : 0;
}
