/* Costs of nodes as told from those around. */
#include "support/test.h"
#include "grid.h"
#include "node_costs.h"

static struct LamGrid_s grid;

static PetscInt64 Key(int i0, int j)
{
  const LamNodePlace place = {{i0 * LAM_ROOT, 0, 0}, j, 0};

  return LamNodeKeyOf(&place);
}

static void Learn(LamNodeCosts costs, PetscInt64 key, PetscInt factorisations)
{
  LamResponse response = {.factorisations = factorisations};

  assert_int_equal(LamNodeCostsLearn(costs, key, &response), 0);
}

static LamNodeCosts New(void)
{
  LamNodeCosts costs;

  assert_int_equal(LamNodeCostsCreate(&grid, &costs), 0);
  return costs;
}

TEST(one_that_is_known_is_what_all_cost)
{
  OWNED(LamNodeCosts, LamNodeCostsDestroy) costs = New();

  Learn(costs, Key(0, 0), 25);
  assert_near(LamNodeCostsPredict(costs, Key(50, 7)), 25, 1e-12);
}

TEST(the_four_nearest_count)
{
  OWNED(LamNodeCosts, LamNodeCostsDestroy) costs = New();

  for (int i = 0; i < 4; i++) Learn(costs, Key(20 + i, 0), 1000);
  for (int i = 0; i < 4; i++) Learn(costs, Key(i, 0), i < 2 ? 10 : 40);
  for (int i = 0; i < 4; i++) Learn(costs, Key(40 + i, 0), 1000);
  assert_near(LamNodeCostsPredict(costs, Key(0, 0)), 20, 1e-9); /* the geometric mean */
  assert_near(LamNodeCostsPredict(costs, Key(30, 0)), 1000, 1e-7);
}

TEST(the_oldest_are_forgotten)
{
  OWNED(LamNodeCosts, LamNodeCostsDestroy) costs = New();

  for (int i = 0; i < 10; i++) Learn(costs, Key(0, 0), 500);
  for (int i = 0; i < 1024; i++) Learn(costs, Key(9, i), 5);
  assert_near(LamNodeCostsPredict(costs, Key(0, 0)), 5, 1e-9);
}
