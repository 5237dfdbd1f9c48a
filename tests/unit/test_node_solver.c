/* Nodes solved from their parents: where they start, and that their responses depend on nothing else. */
#include "support/rve_fixture.h"
#include "grid.h"
#include "node_solver.h"
#include <string.h>

#define MPA (1.0 / TISSUE_STRESS)
#define ROOM ((size_t)64 << 20)
enum { HALF = LAM_ROOT / 2 };

/* Without free cells the strains are origin + step i / LAM_ROOT. */
static struct LamGrid_s grid;
static LamRVE rve;

static PetscInt64 Key(int i0, int i1, int i2, int j)
{
  const LamNodePlace place = {{i0, i1, i2}, j, 0};

  return LamNodeKeyOf(&place);
}

static LamNodeChain NewChain(LamInterfaceLawType interface, size_t memory)
{
  LamNodeChain chain;

  assert_int_equal(LamNodeChainCreate(rve, interface, &grid, memory, &chain), 0);
  return chain;
}

static LamResponse Solve(LamNodeChain chain, PetscInt64 key)
{
  LamResponse response;

  assert_int_equal(LamNodeChainSolve(chain, key, &response), 0);
  return response;
}

/* Equal bits, time apart. */
static void AssertSame(LamResponse a, LamResponse b)
{
  a.seconds = b.seconds = 0;
  assert_memory_equal(&a, &b, sizeof(a));
}

static LamResponse SolveAlone(PetscInt64 key)
{
  OWNED(LamNodeChain, LamNodeChainDestroy) chain = NewChain(LAM_INTERFACE_CONTACT, ROOM);
  const LamResponse response = Solve(chain, key);

  return response;
}

/* ---- contact ---- */

TEST(ChildStartsFromItsParent)
{
  const PetscInt64 child = Key(0, HALF, LAM_ROOT, 0), parent = LamGridNodeParent(&grid, child);
  LamResponse first, second;
  OWNED(LamRVEState, LamRVEStateDestroy) before;
  LamLoad load;

  assert_int_equal(parent, Key(0, 0, LAM_ROOT, 0));
  assert_int_equal(LamRVEStateCreate(rve, &before), 0);
  assert_int_equal(LamGridNodeLoad(&grid, parent, &load), 0);
  assert_int_equal(LamRVESolve(rve, &load, before, &first), 0);
  assert_int_equal(LamGridNodeLoad(&grid, child, &load), 0);
  assert_int_equal(LamRVESolve(rve, &load, before, &second), 0);
  assert_int_equal(second.status, LAM_CONVERGED);
  AssertSame(SolveAlone(parent), first);
  AssertSame(SolveAlone(child), second);
  assert_true(memcmp(SolveFromReference(rve, load).P, second.P, sizeof(second.P))); /* another start, other bits */
}

static const int family[][4] = {
    {0, 0, 0, 0},
    {HALF, HALF, HALF, 0}, /* child of the first */
    {0, HALF, HALF, HALF},
    {0, 0, 2 * LAM_ROOT, LAM_ROOT},
    {0, LAM_ROOT, LAM_ROOT, 0},
    {0, LAM_ROOT, 2 * LAM_ROOT, LAM_ROOT},
    {LAM_ROOT, 2 * LAM_ROOT, 2 * LAM_ROOT, 0},
};
enum { FAMILY = PETSC_STATIC_ARRAY_LENGTH(family) };

static PetscInt64 FamilyKey(int n)
{
  return Key(family[n][0], family[n][1], family[n][2], family[n][3]);
}

/* Whatever was solved before, and remembered or forgotten: memory 0 leaves room for one node. */
TEST(OrderAndMemoryDoNotMatter)
{
  LamResponse alone[FAMILY];

  for (int n = 0; n < FAMILY; n++) alone[n] = SolveAlone(FamilyKey(n));
  for (int k = 2; k < 2 * FAMILY; k++) {
    const int between = k % FAMILY;
    OWNED(LamNodeChain, LamNodeChainDestroy) chain = NewChain(LAM_INTERFACE_CONTACT, k < FAMILY ? ROOM : 0);

    AssertSame(Solve(chain, FamilyKey(0)), alone[0]);
    AssertSame(Solve(chain, FamilyKey(between)), alone[between]);
    AssertSame(Solve(chain, FamilyKey(1)), alone[1]);
  }
}

/* A parent without an answer is no start: the strains of this one are those of no F. */
TEST(FailedParentIsPassedOver)
{
  const PetscInt64 child = Key(HALF, HALF, LAM_ROOT, 0), parent = LamGridNodeParent(&grid, child);
  const struct LamGrid_s usual = grid;
  LamLoad load;

  grid.origin = -0.35;
  grid.step = 0.72;
  assert_int_equal(parent, Key(0, 0, LAM_ROOT, 0));
  assert_int_equal(SolveAlone(parent).status, LAM_INVALID_F);
  assert_int_equal(LamGridNodeLoad(&grid, child, &load), 0);
  AssertSame(SolveAlone(child), SolveFromReference(rve, load));
  grid = usual;
}

static PetscBool Stop(void *ctx)
{
  return PETSC_TRUE;
}

TEST(StoppedNodesAreLeftOut)
{
  const PetscInt64 key = Key(0, 0, LAM_ROOT, 0);
  OWNED(LamNodeChain, LamNodeChainDestroy) chain = NewChain(LAM_INTERFACE_CONTACT, ROOM);

  assert_int_equal(LamRVESetInterrupt(rve, Stop, NULL), 0);
  assert_int_equal(Solve(chain, key).status, LAM_OUT_OF_REACH);
  assert_int_equal(LamRVESetInterrupt(rve, NULL, NULL), 0);
}

/* ---- bonded ---- */

TEST(BondedNodesStartFromTheReference)
{
  const PetscInt64 child = Key(0, HALF, LAM_ROOT, 0);
  OWNED(LamNodeChain, LamNodeChainDestroy) chain = NewChain(LAM_INTERFACE_BONDED, ROOM);
  LamLoad load;

  assert_int_equal(LamGridNodeLoad(&grid, child, &load), 0);
  AssertSame(Solve(chain, child), SolveFromReference(rve, load));
}

static int SetUp(void **state)
{
  const LamMicrostructure micro = ContactTissue(4, 1);

  grid = (struct LamGrid_s){.contact = PETSC_TRUE,
                            .symmetric = PETSC_TRUE,
                            .axes = LamLatticeAxesOf(0),
                            .origin = -0.04085,
                            .step = 0.08,
                            .cohesion = 0.002 * MPA,
                            .suction_scale = 0.011 * MPA,
                            .tau_min = log1p(2.0),
                            .tau_step = 0.5,
                            .tau_cells = 1};
  rve = NewRVE(&micro);
  return 0;
}

static int TearDown(void **state)
{
  return LamRVEDestroy(&rve);
}

TEST_GROUP(.petsc = 1, .setup = SetUp, .teardown = TearDown);
