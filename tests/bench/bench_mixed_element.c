/*
  Macroscale elements, mixed (sealed lumens) and not: order of convergence, locking, Newton ratios. Prints figures.

    bench_mixed_element [--rve]     with --rve also with responses of the RVE: a minute
*/
#include <stdio.h>
#include "options.h"
#include "support/mixed_element.h"
#include "support/tissue.h"

static const char *const element_names[] = {"quadrilaterals", "triangles"};

/* Cook's force and energy on finer and finer meshes, and their order on the last three. */
static PetscErrorCode PrintCook(const char name[], Problem problem, PetscInt finest)
{
  PetscReal energy[3] = {0}, force[3] = {0};
  PetscInt meshes = 0;

  PetscFunctionBeginUser;
  for (problem.n = finest / 16 > 1 ? finest / 16 : 1; problem.n <= finest; problem.n *= 2) {
    ProblemResult r;
    PetscCall(ProblemSolve(&problem, &r));
    for (int k = 0; k < 2; k++) energy[k] = energy[k + 1], force[k] = force[k + 1];
    energy[2] = r.energy, force[2] = r.force;
    printf("%-26s %-14s %4d  %13.8f %13.8f", name, element_names[problem.elements], (int)problem.n, r.energy, r.force);
    if (++meshes >= 3 && r.residual_count) printf("  %5.2f %5.2f", OrderOf(energy), OrderOf(force));
    printf("\n");
  }
  PetscFunctionReturn(0);
}

/* Errors of the smooth problem on finer and finer meshes, and their orders. */
static PetscErrorCode PrintSmooth(const char name[], Problem problem, PetscInt finest)
{
  ProblemResult before = {0};

  PetscFunctionBeginUser;
  problem.kind = PROBLEM_SMOOTH;
  for (problem.n = 2; problem.n <= finest; problem.n *= 2) {
    ProblemResult r;
    PetscCall(ProblemSolve(&problem, &r));
    printf("%-26s %-14s %4d  %13.4e %13.4e", name, element_names[problem.elements], (int)problem.n, r.strain, r.turgor);
    if (problem.n > 2) printf("  %5.2f", log2(before.strain / r.strain));
    if (problem.n > 2 && problem.gradient) printf(" %5.2f", log2(before.turgor / r.turgor));
    printf("\n");
    before = r;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintOrders(void)
{
  const LamScene open = {.turgor = 0.2}, sealed = {.turgor = 0.2, .sealed = PETSC_TRUE, .water_bulk_modulus = 1e5},
                 dry = {0}, dry_sealed = {.sealed = PETSC_TRUE, .water_bulk_modulus = 2e4};

  PetscFunctionBeginUser;
  printf("%-26s %-14s %4s  %13s %13s  orders\n", "synthetic material", "elements", "n", "error of F", "of turgor");
  for (int e = 0; e < 2; e++) {
    Problem p = {.elements = (GmshElements)e, .amplitude = 1e-6, .mu = 1, .lambda = 2, .phi = 0.8, .c = 0.05};
    p.scene = &open;
    PetscCall(PrintSmooth("smooth, prescribed", p, 32));
    p.scene = &sealed, p.gradient = PETSC_TRUE, p.c = 0;
    PetscCall(PrintSmooth("smooth, sealed, K_w = 1e5", p, 32));
  }
  printf("\n%-26s %-14s %4s  %13s %13s  orders\n", "synthetic material", "elements", "n", "energy", "force");
  for (int e = 0; e < 2; e++) {
    Problem p = {.elements = (GmshElements)e, .amplitude = 4, .mu = 1, .lambda = 2, .phi = 0.8, .c = 0.05};
    p.scene = &dry;
    PetscCall(PrintCook("Cook, prescribed", p, 32));
    p.scene = &dry_sealed;
    PetscCall(PrintCook("Cook, sealed, K_w = 2e4", p, 32));
  }
  PetscFunctionReturn(0);
}

/* Force to lift the end of Cook's membrane, of a coarse mesh over that of a fine one: sealed tissue in the mixed
   element against a compressible material of the same bulk modulus in the plain one. */
static PetscErrorCode PrintLocking(void)
{
  printf("\n%-10s  %s\n%10s", "K_w / G", "force, 8 x 8 over 32 x 32", "");
  PetscFunctionBeginUser;
  for (int e = 0; e < 2; e++) printf("  %14s: mixed    plain", element_names[e]);
  printf("\n");
  for (PetscReal K = 1; K < 2e6; K *= 10) {
    const LamScene open = {0}, sealed = {.sealed = PETSC_TRUE, .water_bulk_modulus = K};
    printf("%10.0e", K);
    for (int e = 0; e < 2; e++) {
      for (int plain = 0; plain < 2; plain++) {
        Problem p = {.kind = PROBLEM_COOK, .elements = (GmshElements)e, .amplitude = 0.5, .mu = 1, .phi = 1};
        ProblemResult coarse, fine;
        p.scene = plain ? &open : &sealed;
        p.lambda = plain ? K : 0;
        p.n = 8;
        PetscCall(ProblemSolve(&p, &coarse));
        p.n = 32;
        PetscCall(ProblemSolve(&p, &fine));
        printf(" %*.5f", plain ? 8 : 22, coarse.force / fine.force);
      }
    }
    printf("\n");
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintNewton(void)
{
  PetscFunctionBeginUser;
  printf("\nNewton from the undeformed body, Cook 8 x 8, lifted by 4: residuals over the forces of the elements\n");
  for (PetscReal K = 1; K < 2e6; K *= 1e3) {
    const LamScene sealed = {.sealed = PETSC_TRUE, .water_bulk_modulus = K};
    const Problem p = {
        .kind = PROBLEM_COOK, .n = 8, .amplitude = 4, .scene = &sealed, .mu = 1, .lambda = 2, .phi = 0.8, .c = 0.05};
    ProblemResult r;
    PetscCall(ProblemSolve(&p, &r));
    printf("K_w = %.0e:", K);
    for (PetscInt k = 0; k < r.residual_count; k++) printf(" %.1e", r.residuals[k]);
    printf("\n");
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintTissue(void)
{
  LamScene scene = {.turgor = 0.02e6 / 0.11e6, .water_bulk_modulus = 2e4}, dry = {.water_bulk_modulus = 2e4};
  LamMicrostructure micro = DefaultTissue();
  LamRVE rve;

  PetscFunctionBeginUser;
  micro.along = 3, micro.through = 1;
  PetscCall(NewTissue(&micro, &rve, NULL));
  printf("\nbonded tissue, a solve per question: energy and force, or error of F\n");
  for (int sealed = 0; sealed < 2; sealed++) {
    Problem p = {.scene = &scene, .rve = rve, .amplitude = 1e-5};
    scene.sealed = (PetscBool)sealed;
    PetscCall(PrintSmooth(sealed ? "smooth, sealed" : "smooth, prescribed", p, 8));
    p.amplitude = 0.5, p.scene = &dry;
    dry.sealed = scene.sealed;
    PetscCall(PrintCook(sealed ? "Cook, sealed" : "Cook, prescribed", p, 8));
  }
  PetscCall(LamRVEDestroy(&rve));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PrintOrders());
  PetscCall(PrintLocking());
  PetscCall(PrintNewton());
  if (HasOption("--rve")) PetscCall(PrintTissue());
  return EndBench();
}
