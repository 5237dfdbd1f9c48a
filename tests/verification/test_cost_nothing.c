/* Features that a scene leaves off take no unknowns, no entries of the matrix, no factorisations, and change no digit.
 */
#include "support/rve_fixture.h"
#include "support/bare_tissue.h"

/* One solve with what it needs; the state is the solution. */
typedef struct {
  LamRVE rve;
  LamRVEState state;
  LamResponse response;
} Solved;

static Solved SolveWanted(const LamMicrostructure *micro, const LamLoad *load, LamWanted wanted)
{
  Solved s = {.rve = NewRVE(micro)};

  assert_int_equal(LamRVESetWanted(s.rve, wanted), 0);
  assert_int_equal(LamRVEStateCreate(s.rve, &s.state), 0);
  assert_int_equal(LamRVESolve(s.rve, load, s.state, &s.response), 0);
  assert_int_equal(s.response.status, LAM_CONVERGED);
  return s;
}

static Solved Solve(const LamMicrostructure *micro, const LamLoad *load)
{
  return SolveWanted(micro, load, LAM_WANT_ALL);
}

static void Destroy(Solved *s)
{
  assert_int_equal(LamRVEStateDestroy(&s->state), 0);
  assert_int_equal(LamRVEDestroy(&s->rve), 0);
}

/* The same matrix and work, and the same solution, bit for bit. */
static void AssertSameProblem(const Solved *a, const Solved *b)
{
  assert_int_equal(a->rve->linear->n, b->rve->linear->n);
  assert_int_equal(a->rve->linear->nonzeros, b->rve->linear->nonzeros);
  assert_int_equal(a->response.newton_iterations, b->response.newton_iterations);
  assert_int_equal(a->response.factorisations, b->response.factorisations);
  assert_int_equal(a->state->n, b->state->n);
  assert_memory_equal(a->state->y, b->state->y, sizeof(PetscReal) * (size_t)a->state->n);
  assert_memory_equal(a->response.P, b->response.P, sizeof(a->response.P));
  assert_memory_equal(&a->response.energy, &b->response.energy, sizeof(PetscReal));
}

/* Pairs of free classes, each with itself included, that an element joins. */
static PetscInt CountPairs(const LamMesh *mesh)
{
  const size_t n = (size_t)mesh->class_count;
  char *joined = calloc(n * n, 1);
  PetscInt count = 0;

  for (PetscInt e = 0; e < mesh->element_count; e++)
    for (int a = 0; a < LAM_ELEMENT_NODES; a++)
      for (int b = 0; b < LAM_ELEMENT_NODES; b++) {
        const PetscInt i = mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + a]];
        const PetscInt j = mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + b]];
        char *entry = &joined[(size_t)i * n + (size_t)j];

        if (i == 0 || j < i) continue;
        count += !*entry;
        *entry = 1;
      }
  free(joined);
  return count;
}

/* Contact, cohesion, sealed lumens: off, they leave the matrix to the positions of the walls, 2 x 2 for a pair of
   nodes, of which a diagonal block has 3. */
TEST(BondedTissueHasTheMatrixOfItsWalls)
{
  static const PetscInt cells[][2] = {{1, 1}, {2, 1}, {3, 2}};

  for (size_t k = 0; k < sizeof(cells) / sizeof(cells[0]); k++) {
    LamMicrostructure micro = DefaultTissue();
    OWNED(LamRVE, LamRVEDestroy) rve;

    micro.cells[0] = cells[k][0];
    micro.cells[1] = cells[k][1];
    micro.along = 3;
    rve = NewRVE(&micro);
    assert_int_equal(rve->linear->n, 2 * (rve->mesh.class_count - 1));
    assert_int_equal(rve->linear->nonzeros, 4 * CountPairs(&rve->mesh) - (rve->mesh.class_count - 1));
    assert_null(rve->contact);
    assert_null(rve->bonded);
  }
}

TEST(SolvesAsWallsAloneDo)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamLoad load = PlaneLoad(1.02, 0.1, 0, 1, 0);
  Solved s = Solve(&micro, &load);
  LamResponse response;
  OWNED(LamRVE, BareDestroy) bare = NULL;

  assert_int_equal(BareCreate(&micro, &bare), 0);
  assert_int_equal(BareSolve(bare, &load, &response), 0);
  assert_int_equal(response.status, LAM_CONVERGED);
  assert_int_equal(s.rve->linear->n, bare->linear->n);
  assert_int_equal(s.rve->linear->nonzeros, bare->linear->nonzeros);
  assert_true(s.response.newton_iterations <= response.newton_iterations);
  assert_true(s.response.factorisations <= response.factorisations);
  for (PetscInt i = 0; i < bare->ndof; i++) assert_true(fabs(s.state->y[i] - bare->y[i]) < 1e-12);
  for (int i = 0; i < 9; i++) assert_true(fabs(s.response.P[i] - response.P[i]) < 1e-14);
  Destroy(&s);
}

TEST(BondedTissueDoesNotFeelCohesion)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamLoad without = PlaneLoad(1, 0.1, 0, 1, 0.1);
  LamLoad with = without;
  Solved a, b;

  with.cohesion = 0.05;
  a = Solve(&micro, &without);
  b = Solve(&micro, &with);
  AssertSameProblem(&a, &b);
  Destroy(&a);
  Destroy(&b);
}

/* Also in contact. */
TEST(ListedCellsThatAreAlikeAreNoOtherProblem)
{
  const LamLoad load = ContactLoad(1, 0.1, 0, 1, 0.02, 0.005);

  for (int contact = 0; contact < 2; contact++) {
    LamMicrostructure micro = ContactTissue(4, 1);
    LamCell cells[2];
    Solved a, b;

    if (!contact) micro.interface = LAM_INTERFACE_BONDED;
    micro.cells[0] = 2;
    cells[0] = cells[1] =
        (LamCell){.wall_thickness = micro.wall_thickness, .wall = micro.wall, .turgor = 1, .cohesion = 1};
    a = Solve(&micro, &load);
    micro.cell = cells;
    b = Solve(&micro, &load);
    AssertSameProblem(&a, &b);
    Destroy(&a);
    Destroy(&b);
  }
}

/* Without a past and at once walls with memory are as others. */
TEST(MemoryWithoutAPastChangesNoDigit)
{
  const LamLoad load = PlaneLoad(1.02, 0.1, 0, 1, 0.1);
  LamMicrostructure micro = DefaultTissue();
  Solved a = Solve(&micro, &load), b;

  micro.relaxation = (LamRelaxation){.terms = 1, .share = {0.5}, .time = {1}};
  b = Solve(&micro, &load);
  AssertSameProblem(&a, &b);
  assert_null(a.state->past);
  assert_int_equal(a.state->pairs, 0);
  Destroy(&a);
  Destroy(&b);
}

/* Room for one pressure in each lumen, and only where it is asked for. */
TEST(OnlySealableLumensHaveUnknowns)
{
  LamMicrostructure micro = DefaultTissue();
  LamRVE open, sealable;

  micro.cells[0] = 2;
  open = NewRVE(&micro);
  sealable = NewSealable(&micro);
  assert_int_equal(open->linear->n + 2, sealable->linear->n);
  assert_int_equal(open->length + 2, sealable->length);
  assert_int_equal(LamRVEDestroy(&open), 0);
  assert_int_equal(LamRVEDestroy(&sealable), 0);
}

/* Also of contact tissue, whose bonded start is asked for nothing in any case. */
TEST(WhatIsNotAskedForChangesNoAnswer)
{
  const LamLoad load = ContactLoad(1, 0.1, 0, 1, 0.02, 0.005);

  for (int contact = 0; contact < 2; contact++) {
    const LamMicrostructure micro = contact ? ContactTissue(6, 2) : DefaultTissue();
    Solved all = Solve(&micro, &load), stress = SolveWanted(&micro, &load, LAM_WANT_STRESS);

    AssertSameProblem(&all, &stress);
    assert_true(isnan(stress.response.tangent[0]) && !isnan(all.response.tangent[0]));
    assert_true(isnan(stress.response.P_turgor[0]) && !isnan(all.response.P_turgor[0]));
    assert_true(isnan(stress.response.max_traction) && !isnan(all.response.max_traction));
    assert_true(isnan(stress.response.max_wall_tension) && !isnan(all.response.max_wall_tension));
    Destroy(&all);
    Destroy(&stress);
  }
}

/* The tangent is then needed to judge the state. */
TEST(PrescribedStressDerivesInAnyCase)
{
  const LamMicrostructure micro = DefaultTissue();
  const LamLoad load = PlaneLoad(1.1, 0, 0, 1, 0.1);
  const LamStressControl control = {.given = {[4] = PETSC_TRUE}};
  LamResponse responses[2];

  for (int k = 0; k < 2; k++) {
    OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
    OWNED(LamRVEState, LamRVEStateDestroy) at;

    assert_int_equal(LamRVESetWanted(rve, k ? LAM_WANT_STRESS : LAM_WANT_ALL), 0);
    assert_int_equal(LamRVEStateCreate(rve, &at), 0);
    assert_int_equal(LamRVESolveMixed(rve, &load, &control, at, &responses[k]), 0);
    assert_int_equal(responses[k].status, LAM_CONVERGED);
  }
  assert_memory_equal(responses[0].load.F, responses[1].load.F, sizeof(responses[0].load.F));
  assert_memory_equal(responses[0].P, responses[1].P, sizeof(responses[0].P));
}
