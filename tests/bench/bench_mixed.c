/* States under mixed control from the undeformed tissue against the same states at the F that they have; prints
 * figures.
 */
#include <stdio.h>
#include "figures_mixed.h"

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  printf("%-34s %-14s %5s %5s %6s %8s %8s  %8s %8s %8s\n", "state", "status", "mixed", "at F", "extra", "P", "at F",
         "F11", "F22", "F33");
  printf("%-34s %-14s %5s %5s %6s %8s %8s\n", "", "", "factorisations", "", "", "off by", "off by");
  for (int k = 0; k < MIXED_CASES; k++) {
    const MixedCase *c = &mixed_cases[k];
    MixedResult r;

    if (SolveMixedCase(c, &r)) return 1;
    printf("%-34s %-14s %5d %5d %6d %8.1e %8.1e  %8.5f %8.5f %8.5f\n", c->name, LamStatusNames[r.mixed.status],
           (int)r.mixed.factorisations, (int)r.plain.factorisations, r.extra, r.stress, r.apart, r.mixed.load.F[0],
           r.mixed.load.F[4], r.mixed.load.F[8]);
    if (r.mixed.reason[0]) printf("    %s\n", r.mixed.reason);
  }
  return PetscFinalize() ? 1 : 0;
}
