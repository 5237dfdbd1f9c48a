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

static void Connect(Body *body)
{
  PetscInt points;

  assert_int_equal(LamMacroCreate(PETSC_COMM_SELF, &body->macro), 0);
  assert_int_equal(LamMacroSetScene(body->macro, body->scene), 0);
  assert_int_equal(LamMacroSetUp(body->macro), 0);
  assert_int_equal(LamMacroGetPointCount(body->macro, &points), 0);
  assert_int_equal(LamRVEResponderCreate(body->rve, points, &body->responder), 0);
  assert_int_equal(LamMacroSetResponder(body->macro, body->responder), 0);
}

static void SetUp(Body *body)
{
  assert_int_equal(LamSceneReadText("homogeneous", scene_text, &body->scene), 0);
  body->rve = NewRVE(&body->scene->micro);
  Connect(body);
}

/* LamMacroMonitor */
static PetscErrorCode KeepStep(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  PetscFunctionBeginUser;
  (void)macro;
  (void)stop;
  *(LamMacroStep *)ctx = *step;
  PetscFunctionReturn(0);
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

/* ---- an axisymmetric body ---- */

/* One RVE at F = diag(a, b, a). */
static LamResponse SolveAround(LamRVE rve, PetscReal a, PetscReal b, PetscReal turgor)
{
  LamLoad load = PlaneLoad(a, 0, 0, b, turgor);

  load.F[8] = a;
  return SolveFromReference(rve, load);
}

/* F = diag(a, b, a) is in equilibrium in a cylinder where P11 = P33; by bisection, at b = 0.9. */
static PetscReal StretchAround(LamRVE rve, PetscReal b, PetscReal turgor)
{
  PetscReal low = 1.05, high = 1.1;

  for (int it = 0; it < 45; it++) {
    const PetscReal a = 0.5 * (low + high);
    const LamResponse r = SolveAround(rve, a, b, turgor);

    assert_int_equal(r.status, LAM_CONVERGED);
    if (r.P[0] > r.P[8])
      high = a;
    else
      low = a;
  }
  assert_true(low > 1.05 && high < 1.1);
  return low;
}

/* A cylinder of tissue in that state has the RVE's stress everywhere, and forces of stress times area. */
TEST(CylinderIsThatOfOneRVE)
{
  const PetscReal height = 1, area = PETSC_PI, pi2 = 2 * PETSC_PI;
  Body body;
  LamMacroReason reason;
  OWNED(LamMacroFields, LamMacroFieldsDestroy) fields;
  LamMacroStep step;
  char message[LAM_MESSAGE_LENGTH];

  SetUp(&body);
  const PetscReal b = 0.9, a = StretchAround(body.rve, b, body.scene->turgor);
  const LamResponse exact = SolveAround(body.rve, a, b, body.scene->turgor);
  assert_int_equal(LamMacroDestroy(&body.macro), 0);
  assert_int_equal(LamResponderDestroy(&body.responder), 0);
  body.scene->macro.symmetry = LAM_AXISYMMETRIC;
  body.scene->macro.boundary[2].displacement[0] = a - 1;
  body.scene->macro.boundary[3].displacement[1] = (b - 1) * height;
  Connect(&body);
  assert_int_equal(LamMacroSetMonitor(body.macro, KeepStep, &step), 0);
  assert_int_equal(LamMacroSolve(body.macro, &reason, message), 0);
  assert_int_equal(reason, LAM_MACRO_DONE);
  assert_int_equal(LamMacroGetFields(body.macro, &fields), 0);
  for (PetscInt k = 0; k < 9 * fields.element_count; ++k) assert_near(fields.P[k], exact.P[k % 9], 1e-8);
  assert_near(step.reaction[3][1], area * exact.P[4], 1e-8);
  assert_near(step.reaction[2][0], pi2 * height * exact.P[0], 1e-8);
  TearDown(&body);
}
