/*
  Patches and cells that differ against differences and the periodic tissue; blocks of cells between grips in simple
  shear, as in Section 4.2 of the source paper: both strategies, blocks of growing size, the interfaces against turgor,
  and the directions in which empty cells come apart; prints figures, asserts nothing. Every state from F = I in one go,
  one thread, but for the last table, which walks.

    bench_patch [--full]
      --full   also blocks of more than 8 x 8 cells, empty ones up to a shear of 0.25 (minutes)
*/
#include <stdio.h>
#include "measure.h"
#include "options.h"
#include "support/uneven_cells.h"
#include "support/tissue.h"

#define COUNT(list) ((int)(sizeof(list) / sizeof((list)[0])))
#define LARGEST_BLOCK 8 /* without --full */

static PetscErrorCode PrintDerivative(const ContactState *state)
{
  ContactDerivativeError e;
  ContactSweep sweep;

  PetscFunctionBeginUser;
  PetscCall(SweepContact(state, &sweep));
  e = DerivativeError(&sweep);
  printf("%-22s %-6.2f %8d %8.0e %8.0e %8.0e %8.0e %9.0e %9.0e\n", state->name, sweep.response.open_fraction,
         sweep.switches, e.stress, fmax(e.turgor, e.cohesion), e.tangent, fmax(e.turgor_coupling, e.cohesion_coupling),
         e.lumen, e.opening);
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintDerivatives(void)
{
  ContactState patches[PATCH_STATES], uneven[UNEVEN_STATES];
  LamCell cells[UNEVEN_CELLS];

  PetscFunctionBeginUser;
  ListPatchStates(patches);
  ListUnevenStates(cells, uneven);
  printf("largest errors against differences; volumes: dPsi/dp + V_lumen/V0 and dPsi/dg - V_gap/V0\n"
         "patch                  open   switches        P  dp, dg   tangent couplings    volumes\n");
  for (int s = 0; s < PATCH_STATES; s++) PetscCall(PrintDerivative(&patches[s]));
  printf("cells that differ\n");
  for (int s = 0; s < UNEVEN_STATES; s++) PetscCall(PrintDerivative(&uneven[s]));
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintBondedLimit(void)
{
  double error[PATCH_SIZES], limit;

  PetscFunctionBeginUser;
  PetscCall(BondedPatchErrors(error, &limit));
  printf("\nbonded n x n cells against the periodic tissue, error of the stress:");
  for (int k = 0; k < PATCH_SIZES; k++) printf("  n = %d: %.4f", patch_sizes[k], error[k]);
  printf("  extrapolated: %.4f\n", limit);
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintStrategies(void)
{
  LamResponse list[PATCH_TURGORS][LAM_STRATEGY_COUNT];

  PetscFunctionBeginUser;
  PetscCall(SolvePatchStates(list));
  printf(
      "\n3 x 3 cells, 72 elements each, shear %g; stresses in MPa, gaps in apothems\n"
      "turgor  strategy  status        s     it  fact  largest gap  open   debonded  P11        P12        P21        "
      "P22        difference\n",
      PATCH_SHEAR);
  for (int p = 0; p < PATCH_TURGORS; p++)
    for (int strategy = 0; strategy < LAM_STRATEGY_COUNT; strategy++) {
      const LamResponse *r = &list[p][strategy];

      printf("%-7g %-9s %-12s %5.2f %5d %5d  %-12.4f %-6.3f %-9.3f %-10.6f %-10.6f %-10.6f %-10.6f %.1e\n",
             patch_turgors[p], LamStrategyNames[strategy], LamStatusNames[r->status], r->seconds,
             (int)r->newton_iterations, (int)r->factorisations, r->max_gap, r->open_fraction, r->debonded_fraction,
             TISSUE_STRESS * r->P[0], TISSUE_STRESS * r->P[1], TISSUE_STRESS * r->P[3], TISSUE_STRESS * r->P[4],
             StressError(r->P, list[p][LAM_TWO_STEP].P));
    }
  PetscFunctionReturn(0);
}

/* The limit of many cells: extrapolated from the last two blocks, and one cell a period. */
static PetscErrorCode PrintLimit(const LamLoad *load, double extrapolated)
{
  LamMicrostructure micro = PaperPatch(1);
  LamResponse r;

  PetscFunctionBeginUser;
  micro.is_patch = PETSC_FALSE;
  PetscCall(SolveOnce(&micro, load, &r));
  printf("limit of P12, extrapolated in 1/n: %.6f; periodic: %.6f\n", extrapolated, TISSUE_STRESS * r.P[1]);
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintSizes(PetscBool full)
{
  static const int sizes[] = {4, 6, 8, 10, 12, 16};
  const LamLoad load = ContactLoad(1, PATCH_SHEAR, 0, 1, 0.02, 0);
  double sum[2] = {0, 0}, extrapolated = NAN; /* sum: n P12 of a block and of the one before */

  PetscFunctionBeginUser;
  printf("\nn x n cells, turgor 0.02 MPa, shear %g; peak: of the process so far\n"
         "n   unknowns  status        s        s/cell   it   fact  peak (MB)  open   P12 (MPa)\n",
         PATCH_SHEAR);
  for (int k = 0; k < COUNT(sizes) && (full || sizes[k] <= LARGEST_BLOCK); k++) {
    const LamMicrostructure micro = PaperPatch(sizes[k]);
    LamResponse r;

    PetscCall(SolveOnce(&micro, &load, &r));
    sum[1] = sum[0];
    sum[0] = sizes[k] * TISSUE_STRESS * r.P[1];
    if (k > 0) extrapolated = (sum[0] - sum[1]) / (sizes[k] - sizes[k - 1]);
    printf("%-3d %-9d %-12s %-8.2f %-8.3f %-4d %-5d %-10.0f %-6.3f %.6f\n", sizes[k], (int)r.unknowns,
           LamStatusNames[r.status], r.seconds, r.seconds / (sizes[k] * sizes[k]), (int)r.newton_iterations,
           (int)r.factorisations, PeakMemory(), r.open_fraction, TISSUE_STRESS * r.P[1]);
    fflush(stdout);
  }
  PetscCall(PrintLimit(&load, extrapolated));
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintTurgors(void)
{
  static const double turgors[] = {0, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1};
  const LamMicrostructure micro = PaperPatch(6);

  PetscFunctionBeginUser;
  printf("\n6 x 6 cells, shear %g: interfaces against turgor (MPa); opening: area between facing walls over V0\n"
         "turgor  status        s      it   fact  open   debonded  largest gap  opening  P12 (MPa)\n",
         PATCH_SHEAR);
  for (int p = 0; p < COUNT(turgors); p++) {
    const LamLoad load = ContactLoad(1, PATCH_SHEAR, 0, 1, turgors[p], 0);
    LamResponse r;

    PetscCall(SolveOnce(&micro, &load, &r));
    printf("%-7g %-12s %-6.2f %-4d %-5d %-6.3f %-9.3f %-12.4f %-8.4f %.6f\n", turgors[p], LamStatusNames[r.status],
           r.seconds, (int)r.newton_iterations, (int)r.factorisations, r.open_fraction, r.debonded_fraction, r.max_gap,
           r.opening_by_face[0] + r.opening_by_face[1] + r.opening_by_face[2], TISSUE_STRESS * r.P[1]);
    fflush(stdout);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintDirection(LamRVE rve, LamRVEState state, int n, double shear)
{
  const LamLoad load = ContactLoad(1, shear, 0, 1, 0, 0);
  double moment[3] = {0};
  LamResponse r;

  PetscFunctionBeginUser;
  PetscCall(LamRVESolve(rve, &load, state, &r));
  PetscCall(GapWeightedNormals(rve, state, moment));
  printf("%-3d %-6g %-12s %-6.1f %-8.1f %-12.1f %-7.1f %-6.1f %-5.2f %.2f %.2f %.2f  %-7.3f %.2e %.2e\n", n, shear,
         LamStatusNames[r.status], r.seconds, StretchAxis(shear), FirstAxis(r.opening_moment), FirstAxis(moment),
         FirstAxis(moment) + (FirstAxis(moment) > 0.0 ? -90.0 : 90.0),
         hypot(moment[0] - moment[1], 2.0 * moment[2]) / (moment[0] + moment[1]), r.open_by_face[0], r.open_by_face[1],
         r.open_by_face[2], r.max_gap, TISSUE_STRESS * r.P[1], TISSUE_STRESS * r.P[3]);
  fflush(stdout);
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintDirections(PetscBool full)
{
  static const int sizes[] = {3, 6, 10};

  PetscFunctionBeginUser;
  printf("\nn x n empty cells, each state from the one before: angles from X1 in degrees of the larger principal\n"
         "stretch, of the axis of opening_moment, and of the gap-weighted normals and lines of the interfaces, with\n"
         "the anisotropy of the normals (0: none, 1: all parallel); open shares of face families 0, 1, 2\n"
         "n   shear  status       s      stretch  coming apart normals lines  anis. open by face   gap     P12 (MPa) "
         "P21\n");
  for (int k = 0; k < COUNT(sizes) && (full || sizes[k] <= LARGEST_BLOCK); k++) {
    const LamMicrostructure micro = PaperPatch(sizes[k]);
    LamRVE rve;
    LamRVEState state;

    PetscCall(PatchCreate(&micro, LAM_TWO_STEP, &rve, &state));
    for (int s = 1; s <= (sizes[k] > LARGEST_BLOCK ? 5 : 6); s++)
      PetscCall(PrintDirection(rve, state, sizes[k], 0.05 * s));
    PetscCall(DestroyTissue(&rve, &state));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(PetscBool full)
{
  PetscFunctionBeginUser;
  PetscCall(PrintDerivatives());
  PetscCall(PrintBondedLimit());
  PetscCall(PrintStrategies());
  PetscCall(PrintSizes(full));
  PetscCall(PrintTurgors());
  PetscCall(PrintDirections(full));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (Run(HasOption("--full"))) return 1;
  return EndBench();
}
