/*
  States under mixed control from the undeformed tissue against the same states at the F that they have; prints figures.

    bench_mixed [--random N]
      --random N   also N random states of bonded and of contact tissue: solved at prescribed F, then with random
                   components free under the stress that they have, where that is stable
*/
#include <stdio.h>
#include "options.h"
#include "support/mixed_control.h"
#include "support/random_reals.h"

#define CLASSES 6 /* of additional factorisations */
static const int most[CLASSES] = {0, 3, 10, 30, 100, 1 << 30};

static PetscErrorCode PrintCases(void)
{
  PetscFunctionBeginUser;
  printf("%-34s %-14s %6s %6s %6s %8s %8s  %8s %8s %8s\n", "state", "status", "mixed", "at F", "extra", "P", "at F",
         "F11", "F22", "F33");
  printf("%-34s %-14s %20s %8s %8s\n", "", "", "factorisations", "off by", "off by");
  for (int k = 0; k < MIXED_CASES; k++) {
    const MixedCase *c = &mixed_cases[k];
    MixedResult r;

    PetscCall(SolveMixedCase(c, &r));
    printf("%-34s %-14s %6d %6d %6d %8.1e %8.1e  %8.5f %8.5f %8.5f\n", c->name, LamStatusNames[r.mixed.status],
           (int)r.mixed.factorisations, (int)r.plain.factorisations, r.extra, r.stress, r.apart, r.mixed.load.F[0],
           r.mixed.load.F[4], r.mixed.load.F[8]);
    if (r.mixed.reason[0]) printf("    %s\n", r.mixed.reason);
  }
  PetscFunctionReturn(0);
}

/* A random state at prescribed F; *usable where it is stable under the control that frees random components. */
static PetscErrorCode RandomCase(uint64_t *seed, PetscBool contact, MixedCase *c, PetscBool *usable)
{
  static const int place[5] = {0, 1, 3, 4, 8};
  const LamMicrostructure micro = contact ? ContactTissue(6, 2) : DefaultTissue();
  LamStressControl control = {0};
  LamResponse response;
  LamMixedView view;
  LamLoad load;

  PetscFunctionBeginUser;
  *c = (MixedCase){.contact = contact, .turgor = RandomReal(seed, 0, 0.04)};
  if (contact) c->cohesion = RandomReal(seed, 0, 0.02);
  load = ContactLoad(RandomReal(seed, 0.98, 1.15), RandomReal(seed, -0.15, 0.15), 0, RandomReal(seed, 0.98, 1.15),
                     c->turgor, c->cohesion);
  PetscCall(SolveOnce(&micro, &load, &response));
  for (int q = 0; q < 5; q++) control.given[place[q]] = (PetscBool)(q != 2 && RandomReal(seed, 0, 1) < 0.5);
  *usable = (PetscBool)(response.status == LAM_CONVERGED);
  if (!*usable) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(control.P, response.P, 9));
  PetscCall(LamMixedLook(&control, &response, &view));
  *usable = (PetscBool)(view.count > 0 && LamMixedIsStable(&view));
  for (int q = 0; q < 4; q++) {
    c->F[q] = control.given[place[q]] ? FREE : load.F[place[q]];
    c->P[q] = response.P[place[q]] * TISSUE_STRESS;
  }
  c->F33 = control.given[8] ? FREE : 1;
  c->P33 = response.P[8] * TISSUE_STRESS;
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintRandom(int n, PetscBool contact)
{
  int count[CLASSES] = {0}, solved = 0, failed = 0;
  double stress = 0;
  uint64_t seed = 5;

  PetscFunctionBeginUser;
  while (solved + failed < n) {
    MixedResult r;
    MixedCase c;
    PetscBool usable = PETSC_FALSE;
    int k = 0;

    PetscCall(RandomCase(&seed, contact, &c, &usable));
    if (!usable) continue;
    PetscCall(SolveMixedCase(&c, &r));
    if (r.mixed.status != LAM_CONVERGED) {
      ++failed;
      continue;
    }
    ++solved;
    stress = fmax(stress, r.stress);
    while (r.extra > most[k]) k++;
    ++count[k];
  }
  printf("%-8s %8d %8d %8.1e  ", contact ? "contact" : "bonded", solved, failed, stress);
  for (int k = 0; k < CLASSES; k++) printf(" %8d", count[k]);
  printf("\n");
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int n;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  n = NumberOption("--random", 0, 0, PETSC_MAX_INT);
  if (PrintCases()) return 1;
  if (n > 0) {
    printf(
        "\nrandom states from the undeformed tissue, by additional factorisations\n%-8s %8s %8s %8s   %8s %8s %8s %8s "
        "%8s %8s\n",
        "tissue", "solved", "failed", "P off by", "<= 0", "<= 3", "<= 10", "<= 30", "<= 100", "more");
    if (PrintRandom(n, PETSC_FALSE) || PrintRandom(n, PETSC_TRUE)) return 1;
  }
  return EndBench();
}
