/*
  What a scene requires: mesh, unknowns, number of solves.

  Mesh. The error of P was measured against 30 x 10 elements (docs/commands.md): bonded cells under turgor, shear up to
  0.3 and stretch up to 1.25. The coarsest mesh that stays below the wanted accuracy is taken. Walls thicker than
  THICK_WALL bend less and shear more, and need the next finer one.
*/
#include "app.h"

/* From coarse to fine; the last serves whatever is wanted beyond it. */
static const struct {
  PetscReal accuracy;
  PetscInt along, through;
} Meshes[] = {{0.01, 6, 2}, {0.005, 12, 4}, {0.002, 20, 6}};
enum { MESH_COUNT = PETSC_STATIC_ARRAY_LENGTH(Meshes) };
#define THICK_WALL 0.2 /* apothems */

/* How often a load step asks every material point: 3 to 4 Newton iterations. */
#define ANSWERS_PER_STEP 3.5
#define POINTS_PER_ELEMENT 9 /* 3 x 3 Gauss points of a quadratic element */

static void ChooseMesh(PetscReal accuracy, LamMicrostructure *micro)
{
  int m = 0;

  while (m < MESH_COUNT - 1 && accuracy < Meshes[m].accuracy) m++;
  if (micro->wall_thickness > THICK_WALL) m = PetscMin(m + 1, MESH_COUNT - 1);
  if (!micro->along) micro->along = Meshes[m].along;
  if (!micro->through) micro->through = Meshes[m].through;
}

/* Two for each node; bonded cells share their faces, whose corners belong to three; one node is held. Cells in contact
   have a multiplier for each end and middle of the elements along three of their faces. */
static PetscInt CountUnknowns(const LamMicrostructure *micro)
{
  const PetscInt ring = 12 * micro->along, cells = micro->cells[0] * micro->cells[1];
  const PetscBool bonded = (PetscBool)(micro->interface == LAM_INTERFACE_BONDED);
  const PetscInt outer = bonded ? 3 * (2 * micro->along - 1) + 2 : ring;
  const PetscInt multipliers = bonded ? 0 : 3 * (2 * micro->along + 1);

  return 2 * (cells * (ring * 2 * micro->through + outer) - 1) + cells * multipliers;
}

PetscErrorCode LamPlanMake(const LamScene *scene, LamPlan *plan)
{
  PetscFunctionBeginUser;
  *plan = (LamPlan){.micro = scene->micro, .load_states = scene->load_count};
  ChooseMesh(scene->accuracy, &plan->micro);
  plan->unknowns = CountUnknowns(&plan->micro);
  if (scene->has_sample) plan->sample_states = scene->sample.count;
  if (scene->has_macro) {
    const LamMacroSpec *macro = &scene->macro;

    plan->macro_points = POINTS_PER_ELEMENT * macro->elements[0] * macro->elements[1];
    plan->macro_states =
        (PetscInt64)(ANSWERS_PER_STEP * (PetscReal)plan->macro_points * (macro->steps + (macro->inflate ? 1 : 0)));
  }
  PetscFunctionReturn(0);
}
