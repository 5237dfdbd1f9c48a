/* FE2 with the real RVE: a homogeneous macroscale deformation gives the response of one RVE. */
#include <string.h>
#include "support/rve_fixture.h"

static const char scene_text[] = "version: 1\n"
                                 "rve:\n"
                                 "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                                 "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
                                 "  mesh: {along: 3, through: 1}\n"
                                 "  turgor: {mode: prescribed, pressure: 0.02 MPa}\n"
                                 "macro:\n"
                                 "  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}\n"
                                 "  boundary:\n"
                                 "    - {on: left, displacement: [0 mm, free]}\n"
                                 "    - {on: bottom, displacement: [free, 0 mm]}\n"
                                 "    - {on: right, displacement: [1 mm, free]}\n"
                                 "    - {on: top, displacement: [free, -0.2 mm]}\n"
                                 "  inflate: false\n"
                                 "  steps: 2\n";

typedef struct {
  LamScene *scene;
  LamRVE rve;
  LamMacro macro;
  LamResponder responder;
} Body;

static void SetUp(Body *body)
{
  PetscInt points;

  assert_int_equal(LamSceneReadText("homogeneous", scene_text, &body->scene), 0);
  body->rve = NewRVE(&body->scene->micro);
  assert_int_equal(LamMacroCreate(PETSC_COMM_SELF, &body->macro), 0);
  assert_int_equal(LamMacroSetScene(body->macro, body->scene), 0);
  assert_int_equal(LamMacroSetUp(body->macro), 0);
  assert_int_equal(LamMacroGetPointCount(body->macro, &points), 0);
  assert_int_equal(LamRVEResponderCreate(body->rve, points, &body->responder), 0);
  assert_int_equal(LamMacroSetResponder(body->macro, body->responder), 0);
}

static void TearDown(Body *body)
{
  assert_int_equal(LamMacroDestroy(&body->macro), 0);
  assert_int_equal(LamResponderDestroy(&body->responder), 0);
  assert_int_equal(LamRVEDestroy(&body->rve), 0);
  assert_int_equal(LamSceneDestroy(&body->scene), 0);
}

TEST(StressIsThatOfOneRVE)
{
  Body body;
  LamMacroReason reason;
  OWNED(LamMacroFields, LamMacroFieldsDestroy) fields;
  LamResponse exact;
  char message[LAM_MESSAGE_LENGTH];

  SetUp(&body);
  assert_int_equal(LamMacroSolve(body.macro, &reason, message), 0);
  assert_int_equal(reason, LAM_MACRO_DONE);
  exact = SolveFromReference(body.rve, PlaneLoad(1.1, 0, 0, 0.98, body.scene->turgor));
  assert_int_equal(LamMacroGetFields(body.macro, &fields), 0);
  for (PetscInt k = 0; k < 9 * fields.element_count; ++k) assert_true(fabs(fields.P[k] - exact.P[k % 9]) < 1e-8);
  TearDown(&body);
}
