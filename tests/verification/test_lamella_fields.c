/*
  Fields of the lamella along the faces, at states of tissue that is sheared until it is half torn, and let back: jumps
  are those of the nodes, damage is the state's history, tractions obey the law.
*/
#include "support/error_message.h"
#include "support/rve_fixture.h"
#include <string.h>
#include "rve_impl.h"

#define STEPS 12
#define SHEAR 0.3
#define BACK 0.22 /* where lamella of all kinds is unloaded */
#define BETA 0.5

typedef struct {
  LamRVE rve;
  LamRVEState state;
  LamResponse response;
  PetscInt faces, points;
  PetscReal *from, *rest; /* current and reference positions of the samples */
  LamRVELamella at;
} Fields;

static Fields torn, back;

static LamMicrostructure Tissue(void)
{
  LamMicrostructure micro = DefaultTissue();

  micro.cells[1] = 2;
  micro.interface = LAM_INTERFACE_LAMELLA;
  micro.lamella = LAM_LAMELLA_UNIFORM;
  micro.lamella.stiffness = 700.0;
  micro.lamella.strength = 0.2;
  micro.lamella.energy = 2.5e-3;
  micro.lamella.shear_strength = BETA * micro.lamella.strength;
  micro.lamella.shear_energy = 4e-3;
  micro.lamella.face_strength[1] = 0.5;
  return micro;
}

static LamLoad Sheared(double shear)
{
  return PlaneLoad(1.0, shear, 0.0, 1.02, 0.01 / TISSUE_STRESS);
}

static void Sample(Fields *f)
{
  OWNED(LamRVEState, LamRVEStateDestroy) undeformed = NewState(f->rve);
  PetscInt n;

  CHECK(LamRVEGetInterfaceSize(f->rve, &f->faces, &f->points));
  n = f->faces * f->points;
  CHECK(PetscMalloc2(2 * n, &f->from, 2 * n, &f->rest));
  CHECK(PetscMalloc7(2 * n, &f->at.across, n, &f->at.damage, n, &f->at.broken, n, &f->at.opening, n, &f->at.slip, n,
                     &f->at.normal_traction, n, &f->at.shear_traction));
  CHECK(LamRVEGetInterface(f->rve, undeformed, f->rest, NULL, NULL, NULL));
  CHECK(LamRVEGetInterface(f->rve, f->state, f->from, NULL, NULL, NULL));
  CHECK(LamRVEGetLamella(f->rve, f->state, &f->at));
}

static int Shear(void **state)
{
  const LamMicrostructure micro = Tissue();
  const LamLoad unloaded = Sheared(BACK);

  CHECK(NewTissue(&micro, &torn.rve, &torn.state));
  for (int k = 1; k <= STEPS; k++) {
    const LamLoad load = Sheared(SHEAR * k / STEPS);

    CHECK(LamRVESolve(torn.rve, &load, torn.state, &torn.response));
    assert_int_equal(torn.response.status, LAM_CONVERGED);
  }
  back.rve = torn.rve;
  back.state = NewState(back.rve);
  CHECK(LamRVEStateCopy(torn.state, back.state));
  CHECK(LamRVESolve(back.rve, &unloaded, back.state, &back.response));
  assert_int_equal(back.response.status, LAM_CONVERGED);
  Sample(&torn); /* after the RVE has solved another state */
  Sample(&back);
  return 0;
}

static int Leave(void **state)
{
  Fields *const all[] = {&torn, &back};

  for (int k = 0; k < 2; k++) {
    LamRVELamella *at = &all[k]->at;

    CHECK(PetscFree2(all[k]->from, all[k]->rest));
    CHECK(
        PetscFree7(at->across, at->damage, at->broken, at->opening, at->slip, at->normal_traction, at->shear_traction));
  }
  CHECK(LamRVEStateDestroy(&back.state));
  CHECK(DestroyTissue(&torn.rve, &torn.state));
  return 0;
}

/* Current position of the node of a cell, or of one of its images, that is at X in the reference; NAN: none. */
static void NodeAt(const Fields *f, PetscInt cell, const PetscReal X[2], PetscReal x[2])
{
  const LamMesh *mesh = &f->rve->mesh;
  const PetscReal *F = f->state->load.F, (*period)[2] = mesh->period;

  x[0] = x[1] = NAN;
  for (PetscInt k = 0; k < 9 * mesh->element_count; k++)
    for (int image = 0; image < 9 && mesh->cell_of[k / 9] == cell; image++) {
      const int i = image / 3 - 1, j = image % 3 - 1;
      const PetscReal S[2] = {i * period[0][0] + j * period[1][0], i * period[0][1] + j * period[1][1]};
      const PetscReal *N = &mesh->X[2 * mesh->elements[k]];

      if (hypot(N[0] + S[0] - X[0], N[1] + S[1] - X[1]) > 1e-9) continue;
      LamNodePosition(f->rve, F, f->state->y, mesh->elements[k], x);
      for (int d = 0; d < 2; d++) x[d] += F[3 * d] * S[0] + F[3 * d + 1] * S[1];
    }
}

TEST(BothSidesAreTheNodesThatCoincideAtRest)
{
  const LamContactFace *faces = torn.rve->contact->faces;
  PetscInt count = 0;

  for (PetscInt f = 0; f < torn.faces; f++)
    for (PetscInt i = 2; i < torn.points - 2; i += 2) { /* corners belong to three cells */
      const PetscInt k = 2 * (f * torn.points + i);
      PetscReal x[2];

      if (faces[f].cell == faces[f].other) continue; /* an image of itself, whose node is at rest in two places */
      NodeAt(&torn, faces[f].cell, &torn.rest[k], x);
      for (int d = 0; d < 2; d++) assert_near(torn.from[k + d], x[d], 1e-12);
      NodeAt(&torn, faces[f].other, &torn.rest[k], x);
      for (int d = 0; d < 2; d++) assert_near(torn.at.across[k + d], x[d], 1e-12);
      count++;
    }
  assert_true(count > 0);
}

/* Along the middle between both walls: central differences of the samples within an edge, exact for quadratic ones. */
TEST(OpeningAndSlipAreTheJumpAcrossAndAlongTheFace)
{
  PetscReal widest = 0.0, farthest = 0.0;

  for (PetscInt f = 0; f < torn.faces; f++)
    for (PetscInt i = 0; i < torn.points; i++) {
      const PetscInt k = f * torn.points + i;
      const PetscReal *x = &torn.from[2 * k], *z = &torn.at.across[2 * k];
      PetscReal t[2], norm;

      if (i % 4 == 0) continue;
      for (int d = 0; d < 2; d++) t[d] = x[2 + d] + z[2 + d] - x[d - 2] - z[d - 2];
      norm = hypot(t[0], t[1]);
      assert_near(torn.at.slip[k], ((x[0] - z[0]) * t[0] + (x[1] - z[1]) * t[1]) / norm, 1e-12);
      assert_near(torn.at.opening[k], ((x[1] - z[1]) * t[0] - (x[0] - z[0]) * t[1]) / norm, 1e-12);
      widest = PetscMax(widest, torn.at.opening[k]);
      farthest = PetscMax(farthest, PetscAbsReal(torn.at.slip[k]));
    }
  assert_true(widest > 0.01 && farthest > 0.01); /* else nothing is shown */
}

/* The sample in the middle of an edge, where a Gauss point is, too. */
static PetscInt Middle(const Fields *f, PetscInt face, PetscInt edge, PetscInt *point)
{
  *point = LAM_EDGE_POINTS * (face * f->rve->mesh.along + edge) + LAM_EDGE_POINTS / 2;
  return face * f->points + 4 * edge + 2;
}

TEST(DamageIsThatOfTheHistory)
{
  const Fields *const all[] = {&torn, &back};

  for (int n = 0; n < 2; n++)
    for (PetscInt face = 0; face < torn.faces; face++)
      for (PetscInt edge = 0; edge < torn.rve->mesh.along; edge++) {
        PetscInt point;
        const PetscInt k = Middle(all[n], face, edge, &point);

        assert_near(all[n]->at.damage[k], 1.0 - all[n]->state->history[point].integrity, 1e-13);
      }
}

/* The bilinear law in closed form. */
TEST(BrokenIsTheShareOfTheEnergyThatIsSpent)
{
  const LamLamella law = Tissue().lamella;
  PetscInt partly = 0;

  for (PetscInt face = 0; face < torn.faces; face++)
    for (PetscInt edge = 0; edge < torn.rve->mesh.along; edge++) {
      const PetscReal strength = law.strength * law.face_strength[torn.rve->contact->faces[face].family];
      PetscInt point;
      const PetscInt k = Middle(&torn, face, edge, &point);
      const LamBondHistory *history = &torn.state->history[point];
      const PetscReal B = PetscMax(history->mode, 0.0), omega = history->integrity;
      const PetscReal G = law.energy + (law.shear_energy - law.energy) * B * B;
      const PetscReal onset = strength / law.stiffness, range = 2.0 * G / strength;
      const PetscReal kappa = onset * range / (onset + omega * (range - onset));

      assert_near(torn.at.broken[k], 0.5 * (strength * kappa - omega * law.stiffness * kappa * onset) / G, 1e-12);
      if (torn.at.broken[k] > 0.05 && torn.at.broken[k] < 0.95) partly++;
    }
  assert_true(partly > 0);
}

TEST(TractionsObeyTheLaw)
{
  const LamLamella law = Tissue().lamella;
  const Fields *const all[] = {&torn, &back};

  for (int n = 0; n < 2; n++)
    for (PetscInt face = 0; face < torn.faces; face++)
      for (PetscInt edge = 0; edge < torn.rve->mesh.along; edge++) {
        const LamRVELamella *at = &all[n]->at;
        PetscInt point;
        const PetscInt k = Middle(all[n], face, edge, &point);
        const PetscReal secant = (1.0 - at->damage[k]) * law.stiffness;

        const PetscReal pressing = at->damage[k] == 0.0 ? law.stiffness : 0.0; /* an undamaged one resists it */

        assert_near(at->normal_traction[k], (at->opening[k] > 0.0 ? secant : pressing) * at->opening[k], 1e-12);
        assert_near(at->shear_traction[k], secant * BETA * BETA * at->slip[k], 1e-12);
      }
}

TEST(NoTractionIsAboveTheStrength)
{
  const LamLamella law = Tissue().lamella;
  PetscReal largest = 0.0;

  for (PetscInt k = 0; k < torn.faces * torn.points; k++) {
    const PetscReal strength = law.strength * law.face_strength[torn.rve->contact->faces[k / torn.points].family];
    const PetscReal T = hypot(PetscMax(0.0, torn.at.normal_traction[k]), torn.at.shear_traction[k] / BETA);

    assert_true(T <= strength * (1.0 + 1e-12));
    largest = PetscMax(largest, T / strength);
  }
  assert_true(largest > 0.8);
}

/* Means by the trapezoidal rule; all energies of fracture are alike where the modes are. */
TEST(MeanOfBrokenIsTheBrokenFraction)
{
  PetscReal sum = 0.0;

  for (PetscInt k = 0; k < torn.faces * torn.points; k++) {
    const PetscInt i = k % torn.points;

    sum += (i == 0 || i == torn.points - 1 ? 0.5 : 1.0) * torn.at.broken[k];
  }
  assert_true(torn.response.broken_fraction > 0.1 && torn.response.broken_fraction < 0.9);
  assert_near(sum / (torn.faces * (torn.points - 1)), torn.response.broken_fraction, 0.02);
}

TEST(DamageStaysWhenTheTissueIsLetBack)
{
  PetscInt unloaded = 0;

  for (PetscInt k = 0; k < torn.faces * torn.points; k++) {
    assert_true(back.at.damage[k] >= torn.at.damage[k] - 1e-12);
    if (torn.at.damage[k] > 0.5 && back.at.opening[k] < 0.9 * torn.at.opening[k]) unloaded++;
  }
  assert_true(unloaded > 0);
}

TEST(TheReferenceStateIsUndamaged)
{
  OWNED(LamRVEState, LamRVEStateDestroy) undeformed = NewState(torn.rve);
  const PetscInt n = torn.faces * torn.points;
  PetscReal *damage, *broken, *traction;

  CHECK(PetscMalloc3(n, &damage, n, &broken, n, &traction));
  CHECK(LamRVEGetLamella(torn.rve, undeformed,
                         &(LamRVELamella){.damage = damage, .broken = broken, .normal_traction = traction}));
  for (PetscInt k = 0; k < n; k++) assert_true(damage[k] == 0.0 && broken[k] == 0.0 && traction[k] == 0.0);
  CHECK(PetscFree3(damage, broken, traction));
}

TEST(OtherLawsHaveNoLamella)
{
  const LamMicrostructure micro = ContactTissue(2, 1);
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) undeformed = NewState(rve);
  PetscErrorCode ierr;

  CHECK(KeepErrorMessages());
  ierr = LamRVEGetLamella(rve, undeformed, &(LamRVELamella){NULL});
  CHECK(PetscPopErrorHandler());
  assert_int_equal(ierr, PETSC_ERR_ARG_WRONGSTATE);
  assert_non_null(strstr(ErrorMessage, "law contact"));
}

TEST_GROUP(.petsc = 1, .setup = Shear, .teardown = Leave);
