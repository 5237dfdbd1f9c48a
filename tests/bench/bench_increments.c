/* What increments of 1e-13 to 0.1 of F, or of prescribed stress, cost, one after the other from an equilibrium, and how
   far the increment of P is that of the tangent; then steps that are too large, from F = I, against the same way in
   small ones. Prints figures, asserts nothing. */
#include <stdio.h>
#include "support/load_increments.h"
#include "support/tissue.h"

static const double increments[] = {1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2};

static PetscErrorCode PrintKind(IncrementKind kind)
{
  IncrementTissue t;

  PetscFunctionBeginUser;
  PetscCall(IncrementCreate(kind, &t));
  printf("%s (start %s)\n  %6s %6s %5s %7s %9s %9s %9s %9s\n", increment_names[kind], LamStatusNames[t.at.status],
         "step", "solved", "iter.", "factors", "ms/state", "|A dF|", "off by", "P given");
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(increments); i++) {
    IncrementWalk w;

    PetscCall(IncrementWalkBy(&t, increments[i], &w));
    printf("  %6.0e %3d/%-2d %5d %7d %9.2f %9.1e %9.1e %9.1e\n", increments[i], (int)w.solved, INCREMENT_STEPS,
           (int)w.iterations, (int)w.factorisations, 1e3 * w.seconds / INCREMENT_STEPS, w.size, w.error, w.stress);
  }
  PetscCall(IncrementDestroy(&t));
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintLarge(LamInterfaceLawType interface, double turgor)
{
  LamMicrostructure micro = DefaultTissue();
  LamRVE rve;

  PetscFunctionBeginUser;
  micro.interface = interface;
  PetscCall(NewTissue(&micro, &rve, NULL));
  printf("%s, turgor %.3g C1+C2\n", LamInterfaceLawNames[interface], turgor);
  for (int k = 0; k < LARGE_STEPS; k++) {
    LargeResult l;

    PetscCall(LargeStepSolve(rve, &large_steps[k], turgor, 50, &l));
    printf("  %-28s once %-13s %5d iter. %9.1f ms, branch %d | %d steps %-13s at %2d %5d iter. %9.1f ms, branch %d | P "
           "apart %.1e  %s\n",
           large_steps[k].name, LamStatusNames[l.once.status], (int)l.once.newton_iterations, 1e3 * l.once.seconds,
           (int)l.once.branch, l.steps, LamStatusNames[l.small.status], l.failed, (int)l.small_iterations,
           1e3 * l.small_seconds, (int)l.small.branch, l.apart, l.once.reason);
    fflush(stdout);
  }
  PetscCall(LamRVEDestroy(&rve));
  PetscFunctionReturn(0);
}

int main(void)
{
  if (PetscInitializeNoArguments()) return 1;
  for (int kind = 0; kind < INCREMENT_KIND_COUNT; kind++)
    if (PrintKind((IncrementKind)kind)) return 1;
  for (int interface = 0; interface < LAM_INTERFACE_LAW_COUNT; interface++)
    for (int p = 0; p < 2; p++)
      if (PrintLarge((LamInterfaceLawType)interface, 0.2 * p)) return 1;
  return PetscFinalize() ? 1 : 0;
}
