/* FE2 with the real RVE, turgor prescribed and sealed: patch test, Cook's membrane, and the mixed element against one
   sealed RVE. */
#include "support/rve_fixture.h"
#include "support/mixed_element.h"

static const char scene_text[] = "version: 1\n"
                                 "rve:\n"
                                 "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                                 "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
                                 "  mesh: {along: 3, through: 1}\n"
                                 "  turgor: {mode: sealed, pressure: 0.02 MPa, water_bulk_modulus: 2.2 GPa}\n"
                                 "macro:\n"
                                 "  mesh: {box: [10 mm, 10 mm], elements: [1, 1]}\n"
                                 "  boundary:\n"
                                 "    - {on: left, displacement: [0 mm, free]}\n"
                                 "    - {on: bottom, displacement: [free, 0 mm]}\n"
                                 "    - {on: right, displacement: [1 mm, free]}\n"
                                 "    - {on: top, displacement: [free, -0.905 mm]}\n"
                                 "  inflate: false\n"
                                 "  steps: 1\n";

static const PetscReal stretch[2] = {1.1, 0.9095};

/* Solves the body on this mesh; the scene says what it is made of. */
static void SolveBody(LamScene *scene, LamMacroFields *fields)
{
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&scene->micro);
  OWNED(LamResponder, LamResponderDestroy) responder;
  OWNED(LamMacro, LamMacroDestroy) macro;
  LamMacroReason reason;
  PetscInt points;
  char message[LAM_MESSAGE_LENGTH];

  assert_int_equal(LamMacroCreate(PETSC_COMM_SELF, &macro), 0);
  assert_int_equal(LamMacroSetScene(macro, scene), 0);
  assert_int_equal(LamMacroSetUp(macro), 0);
  assert_int_equal(LamMacroGetPointCount(macro, &points), 0);
  assert_int_equal(LamRVEResponderCreate(rve, points, &responder), 0);
  assert_int_equal(LamMacroSetResponder(macro, responder), 0);
  assert_int_equal(LamMacroSolve(macro, &reason, message), 0);
  if (reason != LAM_MACRO_DONE) fail_msg("%s", message);
  assert_int_equal(LamMacroGetFields(macro, fields), 0);
}

/* The same tissue sealed in the RVE solve. */
static LamResponse SolveSealed(const LamScene *scene)
{
  OWNED(LamRVE, LamRVEDestroy) rve = NewSealable(&scene->micro);
  OWNED(LamRVEState, LamRVEStateDestroy) state = NewState(rve);
  LamLoad load = PlaneLoad(1, 0, 0, 1, scene->turgor);
  LamResponse response;
  PetscReal water;

  assert_int_equal(LamRVESolve(rve, &load, state, &response), 0);
  assert_int_equal(LamRVEGetLumens(rve, state, &water), 0);
  assert_int_equal(LamRVESeal(rve, scene->water_bulk_modulus, &water), 0);
  load.F[0] = stretch[0];
  load.F[4] = stretch[1];
  assert_int_equal(LamRVESolve(rve, &load, state, &response), 0);
  assert_int_equal(response.status, LAM_CONVERGED);
  return response;
}

/* Relative to their own sizes: in water a rounding error of J is 1e4 times as large in the pressure. */
TEST(StressIsThatOfOneSealedRVE)
{
  OWNED(LamScene *, LamSceneDestroy) scene;
  OWNED(LamMacroFields, LamMacroFieldsDestroy) fields;

  assert_int_equal(LamSceneReadText("sealed", scene_text, &scene), 0);
  const LamResponse exact = SolveSealed(scene);
  assert_true(fabs(exact.turgor_mean - scene->turgor) > 1);
  SolveBody(scene, &fields);
  for (PetscInt k = 0; k < 9 * fields.element_count; ++k)
    assert_true(fabs(fields.P[k] - exact.P[k % 9]) < 1e-8 * fabs(exact.P[0]));
  assert_true(fabs(fields.mean[LAM_POINT_TURGOR] - exact.turgor_mean) < 1e-8 * fabs(exact.turgor_mean));
}

/* In a distorted mesh of quadrilaterals, and of triangles, a homogeneous deformation has one F and one turgor. */
TEST(PatchTest)
{
  const GmshElements kinds[2] = {GMSH_QUADRILATERALS, GMSH_TRIANGLES};
  const PetscReal F[9] = {stretch[0], 0, 0, 0, stretch[1], 0, 0, 0, 1};

  for (int k = 0; k < 4; k++) {
    OWNED(LamScene *, LamSceneDestroy) scene;
    OWNED(LamMacroFields, LamMacroFieldsDestroy) fields;
    assert_int_equal(LamSceneReadText("sealed", scene_text, &scene), 0);
    scene->sealed = (PetscBool)(k / 2);
    scene->macro.source = LAM_MESH_GMSH;
    GmshWrite(scene->macro.gmsh, 2, 2, kinds[k % 2], GmshDistorted);
    SolveBody(scene, &fields);
    unlink(scene->macro.gmsh);
    for (PetscInt e = 0; e < fields.element_count; e++) {
      for (int i = 0; i < 9; i++) assert_true(fabs(fields.F[9 * e + i] - F[i]) < 1e-10);
      assert_true(fabs(fields.mean[LAM_POINT_FIELD_COUNT * e + LAM_POINT_TURGOR] / fields.mean[LAM_POINT_TURGOR] - 1) <
                  1e-10);
    }
  }
}

/* On coarse meshes, where its corners do not count yet, the force on Cook's membrane of dry tissue has order 2. */
TEST(CookHasTheOrderOfTheElement)
{
  LamMicrostructure micro = DefaultTissue();

  micro.along = 3;
  micro.through = 1;
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  for (int sealed = 0; sealed < 2; sealed++) {
    const LamScene scene = {.sealed = (PetscBool)sealed, .water_bulk_modulus = 2e4};
    Problem problem = {.kind = PROBLEM_COOK, .n = 1, .amplitude = 0.5, .scene = &scene, .rve = rve};
    PetscReal force[3];
    for (int k = 0; k < 3; k++, problem.n *= 2) {
      ProblemResult result;
      assert_int_equal(ProblemSolve(&problem, &result), 0);
      assert_true(result.residual_count > 0);
      force[k] = result.force;
    }
    assert_true(OrderOf(force) > 2);
  }
}
