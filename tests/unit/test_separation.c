/* When cells count as separated, from what two meshes say. */
#include "support/test.h"
#include "separation.h"

/* Both meshes alike; all face families carry the same traction, and of each this share is without contact. */
static LamSeparation JudgeShare(PetscReal turgor, PetscReal cohesion, PetscReal max_gap, PetscReal traction,
                                PetscReal share)
{
  const LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .turgor = turgor, .cohesion = cohesion};
  LamResponse responses[2];

  for (PetscInt m = 0; m < 2; m++) {
    assert_int_equal(LamResponseInit(&load, &responses[m]), 0);
    responses[m].status = LAM_CONVERGED;
    responses[m].max_gap = max_gap;
    responses[m].debonded_fraction = 1;
    for (PetscInt k = 0; k < 3; k++) {
      responses[m].mean_face_traction[k] = traction;
      responses[m].debonded_by_face[k] = share;
    }
  }
  return LamSeparationOf(responses);
}

static LamSeparation Judge(PetscReal turgor, PetscReal cohesion, PetscReal max_gap, PetscReal traction)
{
  return JudgeShare(turgor, cohesion, max_gap, traction, 1);
}

TEST(faces_that_carry_no_contact_are_separated)
{
  (void)state;
  assert_int_equal(Judge(0.02, 0.01, 0, 0.01 - 0.9e-3 * 0.03), LAM_SEPARATION_TRACTION);
  assert_int_equal(Judge(0.02, 0.01, 0, 0.01 - 1.1e-3 * 0.03), LAM_SEPARATION_NONE);
}

/* Cells may have more cohesion than the load says. */
TEST(closed_faces_are_not_separated_whatever_they_bear)
{
  (void)state;
  assert_int_equal(JudgeShare(0.02, 0.01, 0, 0.02, 0), LAM_SEPARATION_NONE);
}

/* The traction is then that of rounding, or the margin has the wrong sign. */
TEST(where_nothing_presses_the_gap_alone_decides)
{
  (void)state;
  assert_int_equal(Judge(0, 0, 0, 0), LAM_SEPARATION_NONE);
  assert_int_equal(Judge(-0.01, 0.01, 0, 0.01), LAM_SEPARATION_NONE);
  assert_int_equal(Judge(-0.02, 0.01, 0, 0.03), LAM_SEPARATION_NONE);
  assert_int_equal(Judge(-0.02, 0.01, 2 * LAM_VISIBLE_GAP, 0.01), LAM_SEPARATION_GAP);
}

TEST(cells_of_which_no_walls_face_each_other_are_separated)
{
  (void)state;
  assert_int_equal(Judge(0, 0, NAN, 0), LAM_SEPARATION_GAP);
}

/* A criterion that one mesh alone fulfils does not count, nor do two that differ. */
TEST(both_meshes_must_agree)
{
  const LamLoad load = {.turgor = 0.02};
  LamResponse responses[2];

  (void)state;
  for (PetscInt m = 0; m < 2; m++) {
    assert_int_equal(LamResponseInit(&load, &responses[m]), 0);
    responses[m].status = LAM_CONVERGED;
    responses[m].max_gap = m == 0 ? 2 * LAM_VISIBLE_GAP : 0;
    for (PetscInt k = 0; k < 3; k++) responses[m].mean_face_traction[k] = m == 0 ? -0.01 : 0;
  }
  assert_int_equal(LamSeparationOf(responses), LAM_SEPARATION_NONE);
  responses[1].status = LAM_NOT_CONVERGED;
  assert_int_equal(LamSeparationOf(responses), LAM_SEPARATION_UNKNOWN);
}
