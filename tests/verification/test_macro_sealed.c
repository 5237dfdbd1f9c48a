/*
  Sealed lumens of the macroscale body, with a material of known answers: the mixed element and its Newton iteration.
*/
#include "support/macro_fixture.h"
#include "support/mixed_element.h"

static const GmshElements element_kinds[2] = {GMSH_QUADRILATERALS, GMSH_TRIANGLES};

/* A body that is no box: its mesh is read when the fixture is set up. */
static void UseMesh(Fixture *fixture, PetscInt n, GmshElements elements, GmshMap map)
{
  fixture->scene.macro.source = LAM_MESH_GMSH;
  GmshWrite(fixture->scene.macro.gmsh, (int)n, (int)n, elements, map);
}

/* With soft walls, whose lumens grow with the turgor. */
static void SetUp(Fixture *fixture)
{
  FixtureSetUp(fixture, PETSC_COMM_SELF);
  fixture->material->phi = 0.8;
  fixture->material->c = 0.05;
  if (fixture->scene.macro.source == LAM_MESH_GMSH) unlink(fixture->scene.macro.gmsh);
}

static void Solve(Fixture *fixture)
{
  FixtureSolve(fixture, LAM_MACRO_DONE);
  if (fixture->reason != LAM_MACRO_DONE) fail_msg("%s", fixture->message);
}

static void Run(Fixture *fixture)
{
  SetUp(fixture);
  Solve(fixture);
}

/* The turgor of the material at J of the reference where it was sealed, with p0: (phi + c p) J = v (1 - (p - p0) / K).
 */
static PetscReal SealedTurgor(const Fixture *fixture, PetscReal p0, PetscReal J)
{
  const Synthetic *m = fixture->material;
  const PetscReal v = m->phi + m->c * p0, K = fixture->scene.water_bulk_modulus;

  return (v * (1 + p0 / K) - m->phi * J) / (m->c * J + v / K);
}

/* The patch test: in a distorted mesh a homogeneous deformation has one F and one turgor. */
TEST(PatchTest)
{
  for (int k = 0; k < 2; k++) {
    FIXTURE fixture;
    OWNED(LamMacroFields, LamMacroFieldsDestroy) fields;
    FixtureScene(&fixture, 1, 1, 1, 1);
    FixtureRollers(&fixture, 0.1, -0.06);
    FixtureSeal(&fixture, 0.2, 2000);
    UseMesh(&fixture, 4, element_kinds[k], GmshDistorted);
    Run(&fixture);
    const PetscReal turgor = SealedTurgor(&fixture, 0.2, 1.1 * 0.94), F[9] = {1.1, 0, 0, 0, 0.94, 0, 0, 0, 1};
    assert_true(PetscAbsReal(turgor - 0.2) > 0.1);
    CHECK(LamMacroGetFields(fixture.macro, &fields));
    for (PetscInt e = 0; e < fields.element_count; e++) {
      for (int i = 0; i < 9; i++) assert_true(PetscAbsReal(fields.F[9 * e + i] - F[i]) < 1e-10);
      assert_true(PetscAbsReal(fields.mean[LAM_POINT_FIELD_COUNT * e + LAM_POINT_TURGOR] - turgor) < 1e-10);
    }
  }
}

/* Moves all nodes by an affine field. */
static void SetAffine(LamMacro macro, const PetscReal H[4], Vec u)
{
  PetscScalar *values;

  CHECK(VecGetArray(u, &values));
  for (PetscInt k = 0; k < macro->node_count; k++) {
    const PetscReal *X = macro->nodes[k].X;
    const PetscInt local = macro->nodes[k].local;
    for (PetscInt i = 0; i < 2; i++) values[local + i] = H[2 * i] * X[0] + H[2 * i + 1] * X[1];
  }
  CHECK(VecRestoreArray(u, &values));
}

/* At displacement u, with the pressures that belong to it. */
static void EvaluateAt(LamMacro macro, Vec u)
{
  PetscReal residual = 1;
  PetscBool ok;

  for (int k = 0; k < 10 && residual > 1e-14; k++) {
    CHECK(LamMacroMovePressures(macro, u));
    CHECK(LamMacroEvaluate(macro, u, &ok));
    assert_true(ok);
    CHECK(LamMacroSealedResidual(macro, &residual));
  }
  assert_true(residual < 1e-13);
}

/* No force acts on a node inside the body where the deformation is affine, shear included. */
TEST(AffineFieldIsInBalance)
{
  const PetscReal H[4] = {0.05, 0.2, -0.1, -0.08};

  for (int k = 0; k < 2; k++) {
    FIXTURE fixture;
    PetscReal scale;
    PetscBool ok;
    const PetscScalar *force;
    FixtureShear(&fixture, 4, 0, 1);
    FixtureSeal(&fixture, 0.2, 2000);
    UseMesh(&fixture, 4, element_kinds[k], GmshDistorted);
    for (int b = 0; b < 2; b++) FixtureBoundary(&fixture, b ? "left" : "right", NAN, NAN);
    SetUp(&fixture);
    LamMacro macro = fixture.macro;
    CHECK(LamMacroSealLumens(macro, &ok));
    SetAffine(macro, H, macro->trial);
    EvaluateAt(macro, macro->trial);
    CHECK(LamMacroAssembleForce(macro, macro->force, &scale));
    CHECK(VecGetArrayRead(macro->force, &force));
    for (PetscInt n = 0; n < macro->node_count; n++) {
      const PetscInt local = macro->nodes[n].local;
      if (macro->sets[macro->nodes[n].point - macro->mesh_start]) continue;
      for (PetscInt i = 0; i < 2; i++) assert_true(PetscAbsReal(force[local + i]) < 1e-12 * scale);
    }
    CHECK(VecRestoreArrayRead(macro->force, &force));
  }
}

/* Relative error of the condensed tangent against differences of the forces, the pressures at their equilibrium. */
static PetscReal TangentError(GmshElements elements, PetscInt seed)
{
  const PetscReal h = 1e-5;
  FIXTURE fixture;
  PetscRandom random;
  PetscReal error, norm, scale;
  PetscBool ok;
  Vec u, direction, product, at, force[2];

  FixtureShear(&fixture, 3, 0, 1);
  FixtureSeal(&fixture, 0.2, 50);
  UseMesh(&fixture, 3, elements, GmshDistorted);
  SetUp(&fixture);
  LamMacro macro = fixture.macro;
  Vec *vectors[] = {&u, &direction, &product, &at, &force[0], &force[1]};
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(vectors); k++) CHECK(VecDuplicate(macro->u, vectors[k]));
  CHECK(PetscRandomCreate(PETSC_COMM_SELF, &random));
  CHECK(PetscRandomSetInterval(random, -0.008, 0.008));
  CHECK(PetscRandomSetSeed(random, (unsigned long)seed));
  CHECK(PetscRandomSeed(random));
  CHECK(VecSetRandom(u, random));
  CHECK(VecSetRandom(direction, random));
  CHECK(LamMacroSealLumens(macro, &ok));
  EvaluateAt(macro, u);
  CHECK(LamMacroAssembleTangent(macro, macro->tangent));
  CHECK(MatMult(macro->tangent, direction, product));
  for (int k = 0; k < 2; k++) {
    CHECK(VecWAXPY(at, k ? -h : h, direction, u));
    EvaluateAt(macro, at);
    CHECK(LamMacroAssembleForce(macro, force[k], &scale));
  }
  CHECK(VecAXPBYPCZ(force[0], -1 / (2 * h), -1, 1 / (2 * h), force[1], product));
  CHECK(VecNorm(force[0], NORM_2, &error));
  CHECK(VecNorm(product, NORM_2, &norm));
  CHECK(PetscRandomDestroy(&random));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(vectors); k++) CHECK(VecDestroy(vectors[k]));
  return error / norm;
}

TEST(TangentIsDerivative)
{
  for (PetscInt seed = 1; seed <= 3; seed++)
    for (int k = 0; k < 2; k++) assert_true(TangentError(element_kinds[k], seed) < 1e-8);
}

/* Each residual is at most a constant times the square of the one before, down to rounding, however stiff the water. */
TEST(NewtonIsQuadratic)
{
  const PetscReal moduli[] = {1, 1e3, 1e6};

  for (size_t m = 0; m < PETSC_STATIC_ARRAY_LENGTH(moduli); m++) {
    FIXTURE fixture;
    FixtureShear(&fixture, 3, 0.3, 1);
    FixtureSeal(&fixture, 0.2, moduli[m]);
    fixture.scene.macro.inflate = PETSC_TRUE;
    Run(&fixture);
    const LamMacroStep *step = FixtureLast(&fixture);
    assert_int_equal(step->cutbacks, 0);
    assert_in_range(step->newton_iterations, 3, 6);
    for (PetscInt k = 1; k + 1 < step->residual_count; k++)
      assert_true(step->residuals[k + 1] < 10 * PetscSqr(step->residuals[k]) + 1e-13);
  }
}

/* The lumen shrinks by what the water is compressed: v (1 - (p - p0) / K). */
TEST(LumenFollowsWater)
{
  const PetscReal moduli[] = {2, 2e4};

  for (size_t m = 0; m < PETSC_STATIC_ARRAY_LENGTH(moduli); m++) {
    FIXTURE fixture;
    FixtureBiaxial(&fixture, -0.05, 0.03, 2);
    FixtureSeal(&fixture, 0.2, moduli[m]);
    Run(&fixture);
    const PetscReal p = SealedTurgor(&fixture, 0.2, 0.95 * 1.03), v = fixture.material->phi + 0.2 * fixture.material->c;
    assert_true(PetscAbsReal(FixtureLast(&fixture)->turgor_mean - p) < 1e-10);
    for (PetscInt q = 0; q < fixture.macro->point_count; q++) {
      const PetscReal lumen = fixture.macro->accepted[q].field[LAM_POINT_LUMEN];
      assert_true(PetscAbsReal(lumen - v * (1 - (p - 0.2) / moduli[m])) < 1e-11);
    }
  }
}

/* Water that is next to nothing keeps nothing: the turgor stays as prescribed, and so does the reaction. */
TEST(SoftWaterIsPrescribedTurgor)
{
  PetscReal reaction[2];

  for (int sealed = 0; sealed < 2; sealed++) {
    FIXTURE fixture;
    FixtureShear(&fixture, 3, 0.2, 1);
    FixtureSeal(&fixture, 0.2, 1e-9);
    fixture.scene.sealed = (PetscBool)sealed;
    fixture.scene.macro.inflate = PETSC_TRUE;
    Run(&fixture);
    assert_true(!fixture.macro->seal == !sealed);
    reaction[sealed] = FixtureLast(&fixture)->reaction[1][0];
  }
  assert_true(PetscAbsReal(reaction[1] - reaction[0]) < 1e-8 * reaction[0]);
}

/* Sealing changes nothing, whatever the turgor is from point to point: without load the body stays as it inflated. */
MACRO_TEST(SealingKeepsTheInflatedState)
{
  FixtureShear(fixture, 3, 0, 1);
  FixtureSeal(fixture, 0.2, 2e4);
  fixture->scene.macro.inflate = PETSC_TRUE;
  SetUp(fixture);
  LamMacro macro = fixture->macro;
  for (PetscInt p = 0; p < macro->point_count; p++) macro->turgor_share[p] = 0.2 + 0.05 * PetscSinReal((PetscReal)p);
  Solve(fixture);
  assert_int_equal(FixtureLast(fixture)->newton_iterations, 0);
  assert_int_equal(FixtureLast(fixture)->queries, 0);
  for (PetscInt p = 0; p < macro->point_count; p++)
    assert_true(macro->accepted[p].load.turgor == macro->turgor_share[p]);
}

/* A step that is cut goes on from the pressures of the last converged state. */
TEST(CutbackReachesTheSameEnd)
{
  PetscReal reaction[2], turgor[2];

  for (int limited = 0; limited < 2; limited++) {
    FIXTURE fixture;
    FixtureShear(&fixture, 2, 0.3, 1);
    FixtureSeal(&fixture, 0.2, 2e3);
    fixture.scene.macro.inflate = PETSC_TRUE;
    SetUp(&fixture);
    if (limited) fixture.material->largest_step = 0.25;
    Solve(&fixture);
    assert_true(!limited == !FixtureLast(&fixture)->cutbacks);
    reaction[limited] = FixtureLast(&fixture)->reaction[1][0];
    turgor[limited] = FixtureLast(&fixture)->turgor_mean;
  }
  assert_true(PetscAbsReal(reaction[1] - reaction[0]) < 1e-8 * PetscAbsReal(reaction[0]));
  assert_true(PetscAbsReal(turgor[1] - turgor[0]) < 1e-8);
}

/* Force that lifts the free end of Cook's membrane by 1, of 48. */
static PetscReal CookForce(PetscInt n, GmshElements elements, PetscReal bulk_modulus)
{
  FIXTURE fixture;
  PetscReal force;

  FixtureScene(&fixture, 1, 1, 1, 1);
  FixtureBoundary(&fixture, "left", 0, 0);
  FixtureBoundary(&fixture, "right", NAN, 1);
  FixtureSeal(&fixture, 0, bulk_modulus);
  UseMesh(&fixture, n, elements, GmshCook);
  SetUp(&fixture);
  fixture.material->lambda = 0;
  Solve(&fixture);
  force = FixtureLast(&fixture)->reaction[1][1];
  return force;
}

/* The error of a mesh is not larger with stiffer water: neither element locks. */
TEST(StiffWaterDoesNotLock)
{
  const PetscReal moduli[] = {1, 1e2, 1e4, 1e6};

  for (int k = 0; k < 2; k++) {
    for (size_t m = 0; m < PETSC_STATIC_ARRAY_LENGTH(moduli); m++) {
      const PetscReal coarse = CookForce(4, element_kinds[k], moduli[m]),
                      fine = CookForce(16, element_kinds[k], moduli[m]);
      assert_true(coarse > fine && coarse < 1.02 * fine);
    }
  }
}

/* Deformation gradient and turgor of next to incompressible tissue are met with order 2, on uneven meshes. */
TEST(ErrorsFallWithTheSquare)
{
  const LamScene scene = {.turgor = 0.2, .sealed = PETSC_TRUE, .water_bulk_modulus = 1e5};

  for (int k = 0; k < 2; k++) {
    Problem p = {PROBLEM_SMOOTH, 16, element_kinds[k], 1e-6, PETSC_TRUE, &scene, .mu = 1, .lambda = 2, .phi = 0.8};
    ProblemResult coarse, fine;
    CHECK(ProblemSolve(&p, &coarse));
    p.n = 32;
    CHECK(ProblemSolve(&p, &fine));
    assert_true(fine.residual_count && fine.strain < 0.32 * coarse.strain && fine.turgor < 0.32 * coarse.turgor);
    assert_true(fine.strain < 1e-3 && fine.turgor < 1e-2);
  }
}
