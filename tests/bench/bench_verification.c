/* The figures of docs/results/verification.md: errors against references and theory, buckling, extremes; asserts
 * nothing. */
#include <stdio.h>
#include "measure.h"
#include "support/buckling.h"
#include "support/contact_checks.h"
#include "support/contact_blocks.h"
#include "support/effective_stress.h"
#include "support/extreme_tissue.h"
#include "support/honeycomb.h"
#include "support/reference_values.h"

#define DATA LAMELLA_SOURCE_DIR "/tests/verification/data/bonded.json"
#define CONTACT_DATA LAMELLA_SOURCE_DIR "/tests/verification/data/contact.json"
#define TURGOR (0.02 / TISSUE_STRESS)

/* First, while the process has solved nothing else. */
static PetscErrorCode Memory(void)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamLoad load = PlaneLoad(1, 0.3, 0, 1, TURGOR);
  const double before = PeakMemory();
  LamResponse response;

  PetscFunctionBeginUser;
  PetscCall(SolveOnce(&micro, &load, &response));
  printf("memory: peak %.1f MB after one solve of one cell, %.1f MB before it (MPI, PETSc, MUMPS)\n", PeakMemory(),
         before);
  PetscFunctionReturn(0);
}

static PetscErrorCode Reference(void)
{
  ReferenceError errors[REFERENCE_CASES_MAX];
  double others[OTHERS_CASES];
  int count;

  PetscFunctionBeginUser;
  printf("\nbonded.json, largest error relative to the largest component\n%-40s %-6s %9s %9s %9s %9s\n", "case", "mesh",
         "energy", "stress", "tangent", "lumen");
  PetscCall(CompareWithReference(DATA, &count, errors));
  for (int k = 0; k < count; k++)
    printf("%-40s %2dx%-3d %9.1e %9.1e %9.1e %9.1e\n", errors[k].name, errors[k].along, errors[k].through,
           errors[k].energy, errors[k].stress, errors[k].tangent, errors[k].lumen);
  PetscCall(CompareWithOthers(DATA, others));
  printf("FEBio, 20x6 elements: shear 0.1 %.2f %%, stretch 1.05 %.2f %% (largest error of a component)\n",
         100.0 * others[0], 100.0 * others[1]);
  PetscFunctionReturn(0);
}

static PetscErrorCode Derivatives(void)
{
  double stress = 0.0, lumen = 0.0, tangent = 0.0, symmetry = 0.0;

  PetscFunctionBeginUser;
  for (int s = 0; s < RANDOM_STATES; s++) {
    const ContactState state = RandomState(s);
    ContactSweep sweep;
    const LamResponse *r = &sweep.response;

    PetscCall(SweepContact(&state, &sweep));
    lumen = PetscMax(lumen, PetscAbsReal(r->lumen_fraction + sweep.energy[CONTACT_TURGOR]));
    for (int i = 0; i < 5; i++) {
      const int a = contact_components[i];

      stress = PetscMax(stress, PetscAbsReal(r->P[a] - sweep.energy[i]));
      for (int k = 0; k < 5; k++) {
        const int b = contact_components[k];

        tangent = PetscMax(tangent, PetscAbsReal(r->tangent[9 * a + b] - sweep.P[k][a]) / r->tangent[0]);
        symmetry = PetscMax(symmetry, PetscAbsReal(r->tangent[9 * a + b] - r->tangent[9 * b + a]));
      }
    }
  }
  printf("\nfinite differences at 6 random states: P %.1e, lumen %.1e (C1 + C2); tangent %.1e of A1111; major symmetry "
         "%.1e\n",
         stress, lumen, tangent, symmetry);
  PetscFunctionReturn(0);
}

static PetscErrorCode PressureAtRest(void)
{
  const LamLoad load = PlaneLoad(1, 0, 0, 1, TURGOR);

  PetscFunctionBeginUser;
  printf("\nkappa/(C1+C2)  |P33 + p|/p at F = I  remainder of P + p J F^-T, p = 0.05 MPa\n");
  for (double kappa = 1e2; kappa < 2e6; kappa *= 10.0) {
    LamMicrostructure micro = DefaultTissue();
    LamResponse response;
    double remainder = 0.0;

    micro.wall.bulk_modulus = kappa;
    PetscCall(SolveOnce(&micro, &load, &response));
    PetscCall(EffectiveStressRemainder(kappa, &remainder));
    printf("%-14g %-21.2e %.2e\n", kappa, PetscAbsReal(response.P[8] + load.turgor) / load.turgor, remainder);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ThinWalls(void)
{
  static const double h_l[] = {0.035, 0.02, 0.01, 0.005}, mu[] = {1, 2, 4};
  static const int along[] = {12, 40, 80};

  PetscFunctionBeginUser;
  printf("\nthin-walled honeycomb over theory\nh/l     along  E*      G*      K*      G(p), mu = 1, 2, 4\n");
  for (size_t k = 0; k < sizeof(h_l) / sizeof(h_l[0]); k++)
    for (size_t a = 0; a < sizeof(along) / sizeof(along[0]); a++) {
      double ratio[3] = {0};

      PetscCall(HoneycombModuli(h_l[k], along[a], 1, ratio));
      printf("%-7g %-6d %.4f  %.4f  %.4f ", h_l[k], along[a], ratio[0], ratio[1], ratio[2]);
      for (size_t m = 0; m < sizeof(mu) / sizeof(mu[0]); m++) {
        double shear = 0.0;

        PetscCall(PressurisedShearModulus(h_l[k], mu[m], along[a], 1, &shear));
        printf(" %.4f", shear);
      }
      printf("\n");
    }
  PetscFunctionReturn(0);
}

/* Onset, then the stable answer beside the symmetric solution past it. */
static PetscErrorCode Buckling(PetscInt n0, PetscInt n1, PetscInt along, PetscInt through)
{
  static const double strain[] = {0.02, 0.025, 0.03};
  LamMicrostructure micro = DefaultTissue();
  LamRVE rve;
  LamRVEState state;
  double low = 0.002, high = 0.03;

  PetscFunctionBeginUser;
  micro.cells[0] = n0;
  micro.cells[1] = n1;
  micro.along = along;
  micro.through = through;
  PetscCall(NewTissue(&micro, &rve, NULL));
  PetscCall(BucklingOnset(rve, 0.0, 1e-5, &low, &high));
  printf("%d x %d  %2dx%-4d %.5f .. %.5f\n", (int)n0, (int)n1, (int)along, (int)through, low, high);
  PetscCall(LamRVEStateCreate(rve, &state));
  for (size_t k = 0; k < sizeof(strain) / sizeof(strain[0]) && along == 6; k++) {
    const LamLoad load = PlaneLoad(1 - strain[k], 0, 0, 1 - strain[k], 0);
    PetscInt negative;
    double energy;
    LamResponse r;

    PetscCall(SymmetricSolution(rve, strain[k], 0.0, &energy, &negative));
    PetscCall(LamRVEStateReset(rve, state));
    PetscCall(LamRVESolve(rve, &load, state, &r));
    printf("    strain %.3f: symmetric energy %.5e (%d negative); answer %s, energy %.5e, P11 %.5f, %d iterations, "
           "%.0f ms\n",
           strain[k], energy, (int)negative, LamStatusNames[r.status], r.energy, r.P[0], (int)r.newton_iterations,
           1e3 * r.seconds);
  }
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}

static PetscErrorCode BucklingTable(void)
{
  static const PetscInt runs[][4] = {{1, 1, 6, 2}, {1, 1, 12, 4}, {1, 2, 6, 2}, {2, 2, 6, 2}, {2, 2, 12, 4}};

  PetscFunctionBeginUser;
  printf("\nbuckling, dry, F = (1 - e) 1, t/a = 0.15\ncells  mesh   onset between\n");
  for (size_t k = 0; k < sizeof(runs) / sizeof(runs[0]); k++)
    PetscCall(Buckling(runs[k][0], runs[k][1], runs[k][2], runs[k][3]));
  PetscFunctionReturn(0);
}

static PetscErrorCode Extremes(void)
{
  const LamMicrostructure micro = DefaultTissue();
  Extreme list[EXTREMES];

  PetscFunctionBeginUser;
  ListExtremes(list);
  printf("\n%-24s turgor   status      stable  iterations  factorisations  ms\n", "from F = I in one go");
  for (int k = 0; k < EXTREMES; k++) {
    LamResponse r;

    PetscCall(SolveOnce(&micro, &list[k].load, &r));
    printf("%-24s %.2f MPa %-11s %-7s %-11d %-15d %.0f  %s\n", list[k].name, TISSUE_STRESS * list[k].load.turgor,
           LamStatusNames[r.status], r.stable ? "yes" : "no", (int)r.newton_iterations, (int)r.factorisations,
           1e3 * r.seconds, r.reason);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Tractions(void)
{
  static const int mesh[][2] = {{6, 2}, {12, 4}, {20, 6}};
  const LamLoad load = PlaneLoad(1.05, 0.1, 0, 1, 0.1);

  PetscFunctionBeginUser;
  printf("\ntractions at F = [1.05 0.1; 0 1], p = 0.1 (C1 + C2)\nmesh   largest   mean of faces 0, 1, 2\n");
  for (size_t k = 0; k < sizeof(mesh) / sizeof(mesh[0]); k++) {
    LamMicrostructure micro = DefaultTissue();
    LamResponse r;

    micro.along = mesh[k][0];
    micro.through = mesh[k][1];
    PetscCall(SolveOnce(&micro, &load, &r));
    printf("%2dx%-3d %.5f  %.5f %.5f %.5f\n", mesh[k][0], mesh[k][1], r.max_traction, r.mean_face_traction[0],
           r.mean_face_traction[1], r.mean_face_traction[2]);
  }
  PetscFunctionReturn(0);
}

/* Residual just above which Newton must stop: what rounding leaves, in units of the tolerance. */
static PetscErrorCode RoundingFloor(void)
{
  static const double thickness[] = {0.3, 0.15, 0.05, 0.01};

  PetscFunctionBeginUser;
  printf("\nresidual at F = I over the Newton tolerance\nt/a     cells 1 x 1, 2 x 2, 4 x 4\n");
  for (size_t k = 0; k < sizeof(thickness) / sizeof(thickness[0]); k++) {
    printf("%-7g", thickness[k]);
    for (PetscInt cells = 1; cells < 5; cells *= 2) {
      const LamLoad load = PlaneLoad(1, 0, 0, 1, 0);
      LamMicrostructure micro = DefaultTissue();
      LamRVE rve;
      PetscReal energy;
      PetscBool valid;

      micro.wall_thickness = thickness[k];
      micro.cells[0] = micro.cells[1] = cells;
      PetscCall(NewTissue(&micro, &rve, NULL));
      PetscCall(LamAssemble(rve, &load, rve->mesh.class_X, &energy, rve->residual, &valid));
      printf("  %.2f", LamResidualNorm(rve, rve->residual) / LamNewtonTolerance(rve));
      PetscCall(LamRVEDestroy(&rve));
    }
    printf("\n");
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ContactBlocks(void)
{
  PatchError patch;

  PetscFunctionBeginUser;
  PetscCall(ComputePatch(&patch));
  printf("\ncontact patch test: deformation gradient %.1e, stress %.1e, multipliers %.1e (C1 + C2)\n", patch.gradient,
         patch.stress, patch.multiplier);
  printf("Hertz, error of peak pressure and half-width against the theory\nbase      elements  nodes  iterations  peak "
         "     "
         "half-width\n");
  for (int curvature = 0; curvature < 2; curvature++)
    for (int even = 8; even <= 64; even *= 2) {
      Hertz h;

      PetscCall(ComputeHertz(even, curvature, &h));
      printf("%-9s %-9d %-6d %-11d %+.3f %%  %+.3f %%\n", curvature ? "cylinder" : "flat", even, (int)h.nodes,
             (int)h.iterations, 100.0 * (h.peak / h.peak_theory - 1.0),
             100.0 * (h.half_width / h.half_width_theory - 1.0));
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode ContactReference(void)
{
  static const int mesh[][2] = {{6, 2}, {12, 4}, {24, 4}};

  PetscFunctionBeginUser;
  printf("\ncontact.json, 1e-5 MPa\nshear  turgor  mesh   error  allowed  iterations  debonded  open    largest gap  "
         "penetration\n");
  for (size_t m = 0; m < sizeof(mesh) / sizeof(mesh[0]); m++) {
    ContactReferenceCase cases[CONTACT_CASES_MAX];
    int count;

    PetscCall(CompareContact(CONTACT_DATA, mesh[m][0], mesh[m][1], &count, cases));
    for (int k = 0; k < count; k++) {
      const LamResponse *r = &cases[k].response;

      printf("%-6g %-7g %2dx%-3d %-6.1f %-8.1f %-11d %-9.3f %-7.3f %-12.4f %.4f\n", cases[k].shear, cases[k].turgor,
             mesh[m][0], mesh[m][1], 1e5 * cases[k].error, 1e5 * cases[k].allowed, (int)r->newton_iterations,
             r->debonded_fraction, r->open_fraction, r->max_gap, r->max_penetration);
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ContactDerivatives(void)
{
  ContactState list[CONTACT_STATES];

  PetscFunctionBeginUser;
  ListContactStates(list);
  printf("\ncontact, finite differences inside one contact set\n%-18s switches  P        lumen    opening  tangent  "
         "symmetry P_turgor P_cohes. volumes\n",
         "state");
  for (int s = 0; s < CONTACT_STATES; s++) {
    ContactDerivativeError e;
    ContactSweep sweep;

    PetscCall(SweepContact(&list[s], &sweep));
    e = DerivativeError(&sweep);
    printf("%-18s %-9d %.1e  %.1e  %.1e  %.1e  %.1e  %.1e  %.1e  %.1e\n", list[s].name, sweep.switches, e.stress,
           e.lumen, e.opening, e.tangent, e.symmetry, e.turgor_coupling, e.cohesion_coupling, e.volumes);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ContactComplementarity(void)
{
  PetscFunctionBeginUser;
  printf("\ncomplementarity and pointwise penetration\nload  along  pressure x gap  tension  overlap  penetration\n");
  for (int k = 0; k < PENETRATION_LOADS; k++)
    for (int along = 6; along <= 24; along *= 2) {
      const LamMicrostructure micro = ContactTissue(along, along == 6 ? 2 : 4);
      const LamLoad load = PenetrationLoad(k);
      Complementarity c;

      PetscCall(ComputeComplementarity(&micro, &load, &c));
      printf("%-5d %-6d %-15.1e %-8.1e %-8.1e %.5f\n", k, along, c.product, c.tension, c.overlap,
             c.response.max_penetration);
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode ContactTractions(void)
{
  static const double load[][2] = {{0.001, 0}, {0, 0.001}, {0.005, 0}, {0.02, 0}, {0.015, 0.005}, {0.05, 0}};

  PetscFunctionBeginUser;
  printf("\nmean face tractions against statics, error over the spread between faces\nturgor  cohesion  strain  small "
         "strains  current faces\n");
  for (size_t k = 0; k < sizeof(load) / sizeof(load[0]); k++)
    for (double strain = 1e-2; strain > 2e-4; strain /= PetscSqrtReal(10.0)) {
      StaticTractions s;

      PetscCall(ComputeStaticTractions(strain, load[k][0], load[k][1], &s));
      printf("%-7g %-9g %-7.1e %-14.2e %.2e\n", load[k][0], load[k][1], strain, s.reference, s.current);
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode ContactPrinciple(void)
{
  PetscFunctionBeginUser;
  printf("\ncontact, differences of P + p J F^-T at p + g = 0.025 MPa, over p + g\nkappa/C1  along  shear 0.1  stretch "
         "1.05  shear 0.2  converged\n");
  for (double kappa = 1e3; kappa < 2e5; kappa *= 10.0)
    for (int along = 6; along <= 12; along *= 2) {
      double difference[PRINCIPLE_LOADS];
      int converged;

      PetscCall(ComputePrinciple(ContactTissue(along, along / 3), kappa, difference, &converged));
      printf("%-9g %-6d %-10.2e %-13.2e %-10.2e %d of %d\n", kappa, along, difference[0], difference[1], difference[2],
             converged, PRINCIPLE_LOADS * PRINCIPLE_PAIRS);
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode Contact(void)
{
  PetscFunctionBeginUser;
  PetscCall(ContactBlocks());
  PetscCall(ContactReference());
  PetscCall(ContactDerivatives());
  PetscCall(ContactComplementarity());
  PetscCall(ContactTractions());
  PetscCall(ContactPrinciple());
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (Memory() || Reference() || Derivatives() || PressureAtRest() || ThinWalls() || BucklingTable() || Extremes() ||
      Tractions() || RoundingFloor() || Contact())
    return 1;
  return PetscFinalize() ? 1 : 0;
}
