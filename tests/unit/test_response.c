/* Responses: what is unknown is NaN, the table of members is complete, the error norm is that of
 * docs/reference/commands.md. */
#include "support/test.h"
#include "support/tissue.h"
#include <lamella/response.h>
#include <string.h>

static const LamLoad shear = {.F = {1, 0.1, 0, 0, 1, 0, 0, 0, 1}, .turgor = 0.2};

TEST(a_new_response_knows_nothing_but_its_load)
{
  LamResponse r;

  assert_int_equal(LamResponseInit(&shear, &r), 0);
  assert_memory_equal(&r.load, &shear, sizeof(shear));
  assert_int_equal(r.status, LAM_NOT_CONVERGED);
  assert_true(isnan(r.energy) && isnan(r.P[8]) && isnan(r.tangent[80]) && isnan(r.mean_face_traction[2]));
  assert_true(r.floating_cells == LAM_UNKNOWN_COUNT && r.zero_modes == LAM_UNKNOWN_COUNT);
  assert_true(r.cell_clusters == LAM_UNKNOWN_COUNT && r.percolating_directions == LAM_UNKNOWN_COUNT);
  assert_int_equal(r.newton_iterations, 0);
}

TEST(a_response_may_be_cleared_with_its_own_load)
{
  LamResponse r = {.load = shear};

  assert_int_equal(LamResponseInit(&r.load, &r), 0);
  assert_memory_equal(&r.load, &shear, sizeof(shear));
}

/* Every byte of a response belongs to one member of the table, up to padding and the duration of its load, which is of
   the way there. */
TEST(the_table_covers_the_whole_response)
{
  size_t covered = sizeof(((LamLoad *)0)->duration);

  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    const size_t size = m->type == LAM_MEMBER_REAL   ? sizeof(PetscReal)
                        : m->type == LAM_MEMBER_INT  ? sizeof(PetscInt)
                        : m->type == LAM_MEMBER_TEXT ? 1
                                                     : sizeof(int);

    assert_true(m->offset + size * (size_t)m->count <= sizeof(LamResponse));
    covered += size * (size_t)m->count;
  }
  assert_in_range(sizeof(LamResponse) - covered, 0, 2 * sizeof(PetscReal));
}

TEST(members_have_different_names)
{
  for (const LamMember *a = LamResponseMembers; a->name; a++)
    for (const LamMember *b = a + 1; b->name; b++) assert_string_not_equal(a->name, b->name);
}

TEST(the_stress_error_is_relative_with_a_floor)
{
  const LamStressScale scale = {0.02, 0.01};
  const PetscReal zero[9] = {0}, P[9] = {3, 0, 0, 0, 4, 0, 0, 0, 0};

  assert_near(LamStressError(scale, zero, P), 1, 1e-15);
  assert_near(LamStressError(scale, P, zero), 5 / 0.02, 1e-12);
}

TEST(the_stress_along_the_prisms_has_an_error_of_its_own)
{
  const LamStressScale scale = {0.02, 0.01};
  const PetscReal P[9] = {3, 0, 0, 0, 4, 0, 0, 0, -2}, other[9] = {3, 0, 0, 0, 4, 0, 0, 0, -1};

  assert_near(LamStressError(scale, other, P), 0, 0);
  assert_near(LamAxialError(scale, other, P), 0.5, 1e-15);
}

TEST(an_unknown_stress_has_an_unknown_error)
{
  const LamStressScale scale = {0.02, 0.01};
  const PetscReal P[9] = {3, 0, 0, 0, 4, 0, 0, 0, -2}, unknown[9] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};

  assert_true(isnan(LamStressError(scale, unknown, P)));
}

TEST(only_converged_and_unstable_states_have_fields)
{
  LamResponse r = {0};
  const LamStatus with[] = {LAM_CONVERGED, LAM_UNSTABLE};
  int count = 0;

  for (int s = 0; s < LAM_STATUS_COUNT; s++) {
    r.status = (LamStatus)s;
    count += LamResponseHasFields(&r);
  }
  assert_int_equal(count, 2);
  for (int i = 0; i < 2; i++) {
    r.status = with[i];
    assert_true(LamResponseHasFields(&r));
  }
}
