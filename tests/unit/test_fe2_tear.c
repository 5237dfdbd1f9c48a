/* What a run of a breaking lamella adds to the reason of its end. */
#include <string.h>
#include "support/test.h"
#include "fe2_run.h"

/* The end of a run whose forces were 1, and are `force` at the last step. */
static void Explain(LamFE2Run *run, LamScene *scene, double force, double broken)
{
  LamMacroStep step = {.boundary_count = 1, .reaction = {{0.6, 0.8}}};

  *run = LAM_FE2_RUN;
  run->scene = scene;
  run->broken = broken;
  strcpy(run->message, "step 2: it failed");
  LamFE2NoteForce(&run->totals, &scene->macro, &step);
  step.reaction[0][0] = force;
  step.reaction[0][1] = 0;
  LamFE2NoteForce(&run->totals, &scene->macro, &step);
  CHECK(LamFE2ExplainTear(run));
}

TEST(ATornBodyIsSaidToBeTorn)
{
  LamScene scene = {0};
  LamFE2Run run;

  Explain(&run, &scene, 2e-4, 0.7);
  assert_non_null(strstr(run.message, "step 2: it failed; the body is torn: its forces are down to 0.0002"));
}

TEST(ASofteningBodyMaySnapBack)
{
  LamScene scene = {0};
  LamFE2Run run;

  Explain(&run, &scene, 0.5, 0.35);
  assert_non_null(strstr(run.message, "; 0.35 of the lamella is broken, and where a body softens"));
  assert_non_null(strstr(run.message, "snap-back"));
  assert_non_null(strstr(run.message, "macro.steps"));
  assert_null(strstr(run.message, "macro.control"));
}

TEST(ABodyUnderTractionIsToBeControlled)
{
  LamScene scene = {0};
  LamFE2Run run;

  scene.macro.boundary_count = 1;
  scene.macro.boundary[0].kind = LAM_BOUNDARY_TRACTION;
  Explain(&run, &scene, 1, 0.1);
  assert_non_null(strstr(run.message, "write macro.control"));
  strcpy(scene.macro.control.on, "top");
  Explain(&run, &scene, 1, 0.1);
  assert_null(strstr(run.message, "write macro.control"));
}

/* Nothing is broken, or the tissue has no lamella: nothing is added. */
TEST(WhereNothingBreaksNothingIsAdded)
{
  LamScene scene = {0};
  LamFE2Run run;

  Explain(&run, &scene, 1, 0);
  assert_string_equal(run.message, "step 2: it failed");
  Explain(&run, &scene, 1, NAN);
  assert_string_equal(run.message, "step 2: it failed");
}
