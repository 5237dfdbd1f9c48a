/* Answers from scattered records: derivatives and symmetry. */
#include "query_fixture.h"

QUERY_TEST(a_record_answers_for_itself, MakeFilled())
{
  const LamLoad load = Load(1.08, 0.09, 0.02, 1.05, 0.3);
  const LamResponse exact = Exact(&load), r = Ask(db, load);

  AssertClose(1, &r.energy, &exact.energy, 1e-14);
  AssertClose(9, r.P, exact.P, 1e-13);
  AssertClose(81, r.tangent, exact.tangent, 1e-12);
  AssertClose(9, r.P_turgor, exact.P_turgor, 1e-13);
  AssertClose(1, &r.lumen_fraction, &exact.lumen_fraction, 1e-14);
  assert_near(r.distance, 0, 1e-12);
}

static const int in_plane[4] = {0, 1, 3, 4};

/* Stress against differences of the energy, tangent against differences of the stress, P33 included. */
static void AssertDerivatives(LamDatabase db, LamLoad load, PetscReal tolerance)
{
  const LamResponse r = Ask(db, load);
  const PetscReal h = 1e-6;

  for (int i = 0; i < 4; i++) {
    LamLoad plus = load, minus = load;
    LamResponse a, b;

    plus.F[in_plane[i]] += h;
    minus.F[in_plane[i]] -= h;
    a = Ask(db, plus);
    b = Ask(db, minus);
    assert_near((a.energy - b.energy) / (2 * h), r.P[in_plane[i]], tolerance);
    for (int j = 0; j < 4; j++)
      assert_near((a.P[in_plane[j]] - b.P[in_plane[j]]) / (2 * h), r.tangent[9 * in_plane[j] + in_plane[i]], tolerance);
    assert_near((a.P[8] - b.P[8]) / (2 * h), r.tangent[72 + in_plane[i]], tolerance);
  }
}

QUERY_TEST(stress_and_tangent_are_derivatives_of_the_answered_energy, MakeFilled())
{
  AssertDerivatives(db, probe, 1e-8);
}

/* Records that are said to be of another F33: a potential of its own. */
QUERY_TEST(records_blend_with_those_of_their_F33, MakeFilled())
{
  LamLoad load;

  for (int n = 0; n < 12; n++) {
    const LamLoad near = Load(1.06 + 0.01 * (n % 3), 0.05 + 0.01 * (n % 2), 0.01, 1.03 + 0.01 * (n / 4), 0.15);
    LamResponse record = Exact(&near);

    record.load.F[8] = 1.1;
    CHECK(LamDatabaseAdd(db, 1, NULL, &record));
  }
  load = Load(1.067, 0.056, 0.01, 1.041, 0.16);
  load.F[8] = 1.1;
  AssertDerivatives(db, load, 2e-7); /* the weights are steep between near records */
  load.F[8] = 1.09;
  AssertStatus(db, load, LAM_OUT_OF_REACH);
}

/* All images of the record fall on each other, and those of the question lie around it. */
QUERY_TEST(derivatives_are_exact_beside_an_isotropic_record, MakeFilled())
{
  AddExact(db, Load(1.04, 0, 0, 1.04, 0.2));
  AssertDerivatives(db, Load(1.041, 0.002, 0, 1.042, 0.2), 1e-8);
}

/* The weights are steep there: what they multiply must vanish without rounding. */
QUERY_TEST(next_to_a_record_the_answer_is_the_record_s, MakeFilled())
{
  for (PetscReal step = 1e-8; step < 1e-3; step *= 3) {
    const LamLoad near = Load(1.05 + step, 0.03 + step, -0.02, 1.01, 0.1);
    const LamResponse exact = Exact(&near), r = Ask(db, near);

    AssertClose(9, r.P, exact.P, 1e-12 + 50 * step * step);
    AssertClose(81, r.tangent, exact.tangent, 1e-11 + 50 * step);
  }
}

/* Around a circle that brings records into reach and out of it again. */
QUERY_TEST(a_closed_cycle_does_no_net_work, MakeFilled())
{
  enum { STEPS = 2000 };
  PetscReal work = 0, lowest = INFINITY, highest = -INFINITY;

  for (int n = 0; n < STEPS; n++) {
    const PetscReal t = 2 * PETSC_PI * n / STEPS, c = 0.02 * cos(t), s = 0.02 * sin(t);
    const LamResponse r = Ask(db, Load(1.06 + c, 0.06 + s, 0.01 - s, 1.02 + 0.5 * s, 0.15));

    work += 2 * PETSC_PI / STEPS * (-s * r.P[0] + c * r.P[1] - c * r.P[3] + 0.5 * c * r.P[4]);
    lowest = PetscMin(lowest, r.energy);
    highest = PetscMax(highest, r.energy);
  }
  assert_true(fabs(work) < 1e-8 * (highest - lowest));
}

QUERY_TEST(turgor_derivatives_belong_to_the_answered_energy, MakeFilled())
{
  const LamResponse r = Ask(db, probe);
  const PetscReal h = 1e-4;
  LamLoad plus = probe, minus = probe;
  LamResponse a, b;

  plus.turgor += h;
  minus.turgor -= h;
  a = Ask(db, plus);
  b = Ask(db, minus);
  assert_near((a.energy - b.energy) / (2 * h), -r.lumen_fraction, 1e-10);
  for (int i = 0; i < 9; i++) assert_near((a.P[i] - b.P[i]) / (2 * h), r.P_turgor[i], 1e-10);
}

QUERY_TEST(the_tangent_has_major_symmetry, MakeFilled())
{
  const LamResponse r = Ask(db, probe);

  for (int i = 0; i < 9; i++)
    for (int j = 0; j < i; j++)
      if (!isnan(r.tangent[9 * i + j])) assert_near(r.tangent[9 * i + j], r.tangent[9 * j + i], 1e-14);
}

QUERY_TEST(tangent_entries_of_the_out_of_plane_shear_are_unknown, MakeFilled())
{
  const LamResponse r = Ask(db, probe);

  assert_true(isnan(r.tangent[9 * 2 + 2]) && isnan(r.tangent[9 * 0 + 5]) && isnan(r.tangent[9 * 8 + 7]));
}

QUERY_TEST(a_rotation_of_space_rotates_the_stress, MakeFilled())
{
  const LamResponse r = Ask(db, probe);

  for (PetscReal angle = 0.1; angle < 6; angle += 0.37) {
    const PetscReal c = cos(angle), s = sin(angle);
    LamLoad turned = probe;
    LamResponse t;
    PetscReal P[9];

    for (int j = 0; j < 2; j++) {
      turned.F[j] = c * probe.F[j] - s * probe.F[3 + j];
      turned.F[3 + j] = s * probe.F[j] + c * probe.F[3 + j];
    }
    t = Ask(db, turned);
    memcpy(P, r.P, sizeof(P));
    for (int j = 0; j < 2; j++) {
      P[j] = c * r.P[j] - s * r.P[3 + j];
      P[3 + j] = s * r.P[j] + c * r.P[3 + j];
    }
    AssertClose(9, t.P, P, 1e-12);
    AssertClose(1, &t.energy, &r.energy, 1e-12);
  }
}

QUERY_TEST(images_of_the_lattice_have_the_same_answer, MakeFilled())
{
  const LamResponse r = Ask(db, probe);

  for (int image = 0; image < 12; image++) {
    const PetscReal mirror = image < 6 ? 1 : -1;
    const PetscReal angle = image * PETSC_PI / 3 + (mirror < 0 ? 2 * THETA : 0);
    LamLoad turned = probe;
    LamResponse t;
    PetscReal P[9];

    TurnRight(probe.F, cos(angle), sin(angle), mirror, turned.F);
    if (mirror < 0) /* a mirrored sample is seen with a mirrored frame, or det F < 0 */
      for (int j = 0; j < 3; j++) turned.F[3 + j] *= -1;
    t = Ask(db, turned);
    TurnRight(r.P, cos(angle), sin(angle), mirror, P);
    if (mirror < 0)
      for (int j = 0; j < 3; j++) P[3 + j] *= -1;
    AssertClose(9, t.P, P, 1e-12);
    AssertClose(1, &t.energy, &r.energy, 1e-12);
  }
}

TEST(faces_are_renamed_with_the_image)
{
  for (int image = 0; image < 12; image++) {
    const PetscReal mirror = image < 6 ? 1 : -1;
    const PetscReal angle = image * PETSC_PI / 3 + (mirror < 0 ? 2 * THETA : 0);
    OWNED(LamDatabase, LamDatabaseClose) db = Make(1, 1);
    LamLoad turned = probe;
    LamResponse exact, r;

    AddExact(db, probe);
    TurnRight(probe.F, cos(angle), sin(angle), mirror, turned.F);
    if (mirror < 0)
      for (int j = 0; j < 3; j++) turned.F[3 + j] *= -1;
    exact = Exact(&turned);
    r = Ask(db, turned);
    assert_near(r.distance, 0, 1e-12);
    AssertClose(3, r.mean_face_traction, exact.mean_face_traction, 1e-12);
  }
}

QUERY_TEST(unequal_cell_counts_have_no_sixfold_symmetry, Make(2, 3))
{
  LamLoad turned = probe;

  AddExact(db, probe);
  TurnRight(probe.F, 0.5, sqrt(0.75), 1, turned.F);
  AssertStatus(db, turned, LAM_OUT_OF_REACH);
}
