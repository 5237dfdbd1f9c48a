/*
  Stress, lumen and indicators of the states of data/contact.json on finer and finer meshes, and how far the stress of a
  partly open state has the symmetries of the lattice; prints figures, asserts nothing.

    bench_contact_mesh [--full]
      --full   also 48 x 8 elements a face; takes a minute
*/
#include <stdio.h>
#include "options.h"
#include "support/contact_checks.h"
#include "support/tissue.h"

#define DATA LAMELLA_SOURCE_DIR "/tests/verification/data/contact.json"
#define MESHES 4

static const int meshes[MESHES][2] = {{6, 2}, {12, 4}, {24, 8}, {48, 8}};

static void PrintState(int along, int through, const LamResponse *r)
{
  printf("  %2d x %d  %-13s %9.3f %9.3f %9.3f %9.3f  %.6f  %-9.3f %-7.3f %-9.5f %.5f\n", along, through,
         LamStatusNames[r->status], 1e5 * TISSUE_STRESS * r->P[0], 1e5 * TISSUE_STRESS * r->P[1],
         1e5 * TISSUE_STRESS * r->P[3], 1e5 * TISSUE_STRESS * r->P[4], r->lumen_fraction, r->debonded_fraction,
         r->open_fraction, r->max_gap, r->max_penetration);
}

/* In the plane: R A R^T. */
static void Turn(const double R[4], const double A[4], double out[4])
{
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      out[2 * i + j] = 0.0;
      for (int k = 0; k < 4; k++) out[2 * i + j] += R[2 * i + k / 2] * A[k] * R[2 * j + k % 2];
    }
}

static PetscErrorCode SolveTurned(const LamMicrostructure *micro, const double R[4], double P[4])
{
  static const double F0[4] = {1.04, 0.12, -0.03, 0.99};
  LamResponse response;
  LamLoad load;
  double F[4];

  PetscFunctionBeginUser;
  Turn(R, F0, F);
  load = ContactLoad(F[0], F[1], F[2], F[3], 0.02, 0.002);
  PetscCall(SolveOnce(micro, &load, &response));
  for (int i = 0; i < 4; i++) P[i] = response.P[i + i / 2];
  PetscFunctionReturn(0);
}

/* Largest differences between the stress at R F R^T and R P R^T, R a mirror and rotations by 60 and 120 degrees. */
static PetscErrorCode Symmetries(int used_meshes)
{
  static const double identity[4] = {1, 0, 0, 1};

  PetscFunctionBeginUser;
  printf("\nsymmetries of the lattice, difference of the stress, C1 + C2\n  mesh    mirror   60 deg   120 deg\n");
  for (int m = 0; m < used_meshes; m++) {
    const LamMicrostructure micro = ContactTissue(meshes[m][0], meshes[m][1]);
    double P0[4];

    PetscCall(SolveTurned(&micro, identity, P0));
    printf("  %2d x %d", meshes[m][0], meshes[m][1]);
    for (int k = 0; k < 3; k++) {
      const double c = cos(k * PETSC_PI / 3.0), s = sin(k * PETSC_PI / 3.0);
      const double R[4] = {c, -s, s, k == 0 ? -c : c};
      double P[4], expected[4], error = 0.0;

      PetscCall(SolveTurned(&micro, R, P));
      Turn(R, P0, expected);
      for (int i = 0; i < 4; i++) error = fmax(error, fabs(P[i] - expected[i]));
      printf("  %.1e", error);
    }
    printf("\n");
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode States(int used_meshes)
{
  ContactReferenceCase cases[MESHES][CONTACT_CASES_MAX];
  int count = 0;

  PetscFunctionBeginUser;
  for (int m = 0; m < used_meshes; m++) PetscCall(CompareContact(DATA, meshes[m][0], meshes[m][1], &count, cases[m]));
  printf("contact.json, stress in 1e-5 MPa, gap and penetration in apothems\n  mesh    status              P11       "
         "P12       P21       P22     lumen  debonded  open    gap      penetration\n");
  for (int k = 0; k < count; k++) {
    const LamResponse *last = &cases[used_meshes - 1][k].response, *before = &cases[used_meshes - 2][k].response;

    printf("shear %g, turgor %g MPa\n", cases[0][k].shear, cases[0][k].turgor);
    for (int m = 0; m < used_meshes; m++) PrintState(meshes[m][0], meshes[m][1], &cases[m][k].response);
    printf("  change between the last two, norm of accuracy: %.2e\n", StressError(before->P, last->P));
  }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  int meshes_used;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  meshes_used = HasOption("--full") ? MESHES : MESHES - 1;
  if (States(meshes_used) || Symmetries(meshes_used)) return 1;
  return EndBench();
}
