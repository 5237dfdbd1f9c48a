/* A point whose cells are turned answers as tissue does whose cells lie so: polygons, bonded and in contact. */
#include "support/test.h"
#include <lamella/heterogeneous.h>
#include <lamella/lamella.h>
#include "support/polygons.h"
#include "support/tissue.h"

#define ANGLE 0.6

TEST_GROUP(.petsc = 1);

static const LamLoad load = {.F = {1.08, 0.06, 0, -0.03, 1.01, 0, 0, 0, 1}, .turgor = 0.3};

/* Four irregular cells, turned by an angle, and their responder. */
typedef struct {
  LamMicrostructure micro;
  LamRVE rve;
  LamResponder responder;
} Tissue;

static void TurnVector(PetscReal angle, PetscReal x[2])
{
  const PetscReal first = cos(angle) * x[0] - sin(angle) * x[1];

  x[1] = sin(angle) * x[0] + cos(angle) * x[1];
  x[0] = first;
}

static Tissue Start(LamInterfaceLawType law, PetscReal angle)
{
  Tissue t = {.micro = DefaultTissue()};
  LamTissue cells;

  CHECK(PolygonsCreate(2, Waves, &cells));
  for (PetscInt k = 0; k < cells->faces; k++) TurnVector(angle, cells->corner[k]);
  for (int k = 0; k < 2; k++) TurnVector(angle, cells->period[k]);
  t.micro.tissue = cells;
  t.micro.cells[0] = cells->cells;
  t.micro.orientation = angle;
  t.micro.interface = law;
  t.micro.along = 4;
  t.micro.through = 1;
  CHECK(NewTissue(&t.micro, &t.rve, NULL));
  CHECK(LamRVEResponderCreate(t.rve, 0, &t.responder));
  return t;
}

static void Finish(Tissue *t)
{
  CHECK(LamResponderDestroy(&t->responder));
  CHECK(LamRVEDestroy(&t->rve));
  CHECK(LamTissueDestroy(&t->micro.tissue));
}

static LamResponse Ask(LamResponder responder, const LamLoad *at)
{
  const PetscInt point = 0;
  LamResponse r;

  CHECK(LamResponderRespond(responder, 1, at, &point, &r));
  assert_int_equal(r.status, LAM_CONVERGED);
  return r;
}

/* The tissue at one point, turned by ANGLE. */
static LamResponder TurnedPoint(const Tissue *t)
{
  const LamHeterogeneousTissue tissue = {"", 1, {1, 1}, t->responder};
  const LamHeterogeneousPoint point = {1, {{0, 1, 1, 1}}, ANGLE};
  LamResponder turned;

  CHECK(LamHeterogeneousCreate(1, &tissue, 1, &point, &turned));
  return turned;
}

static void Compare(LamInterfaceLawType law)
{
  OWNED(Tissue, Finish) straight = Start(law, 0), lies_so = Start(law, ANGLE);
  OWNED(LamResponder, LamResponderDestroy) turned = TurnedPoint(&straight);
  const LamResponse a = Ask(turned, &load), b = Ask(lies_so.responder, &load);

  assert_near(a.energy, b.energy, 1e-10);
  assert_near(a.max_wall_tension, b.max_wall_tension, 1e-7);
  for (int i = 0; i < 9; i++) {
    assert_near(a.P[i], b.P[i], 1e-10);
    assert_near(a.P_turgor[i], b.P_turgor[i], 1e-8);
  }
  for (int i = 0; i < 81; i++)
    if (!isnan(b.tangent[i])) assert_near(a.tangent[i], b.tangent[i], 1e-7);
}

TEST_IS(bonded_cells_that_are_turned_answer_as_those_that_lie_so, Compare(LAM_INTERFACE_BONDED));
TEST_IS(cells_in_contact_that_are_turned_answer_as_those_that_lie_so, Compare(LAM_INTERFACE_CONTACT));

TEST(the_tangent_of_a_turned_point_is_the_slope_of_its_stress)
{
  const int plane[] = {0, 1, 3, 4};
  const PetscReal h = 1e-5;
  OWNED(Tissue, Finish) straight = Start(LAM_INTERFACE_BONDED, 0);
  OWNED(LamResponder, LamResponderDestroy) turned = TurnedPoint(&straight);
  const LamResponse at = Ask(turned, &load);

  for (int b = 0; b < 4; b++) {
    LamLoad plus = load, minus = load;
    LamResponse after, before;

    plus.F[plane[b]] += h;
    minus.F[plane[b]] -= h;
    after = Ask(turned, &plus);
    before = Ask(turned, &minus);
    assert_near(at.P[plane[b]], (after.energy - before.energy) / (2 * h), 1e-7);
    for (int a = 0; a < 4; a++)
      assert_near(at.tangent[9 * plane[a] + plane[b]], (after.P[plane[a]] - before.P[plane[a]]) / (2 * h), 1e-6);
  }
}
