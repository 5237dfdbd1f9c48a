#include "fe2_patch.h"
#include "tissue.h"

#define SCALES_ALONG 4 /* elements along a face */
#define SCALES_THROUGH 1
static LamMicrostructure ScalesTissue(const ScalesCase *c, PetscInt n, PetscBool is_patch)
{
  LamMicrostructure micro = DefaultTissue();

  micro.interface = c->interface;
  micro.is_patch = is_patch;
  micro.sides = c->sides;
  micro.cells[0] = micro.cells[1] = n;
  micro.along = SCALES_ALONG;
  micro.through = SCALES_THROUGH;
  return micro;
}

static LamLoad ScalesLoad(const ScalesCase *c, double share)
{
  LamLoad load = PlaneLoad(1, share * c->shear, 0, 1 + share * c->stretch, c->turgor / TISSUE_STRESS);

  load.cohesion = c->cohesion / TISSUE_STRESS;
  return load;
}

PetscErrorCode ScalesSolveCells(const ScalesCase *c, PetscInt n, PetscBool is_patch, int steps, ScalesCurve *curve)
{
  const LamMicrostructure micro = ScalesTissue(c, n, is_patch);
  PetscLogDouble start, end;
  LamRVEState state;
  LamResponse r;
  LamRVE rve;

  PetscFunctionBeginUser;
  *curve = (ScalesCurve){0};
  PetscCall(PetscTime(&start));
  PetscCall(NewTissue(&micro, &rve, &state));
  for (int s = 0; s <= steps; s++) {
    const LamLoad load = ScalesLoad(c, (double)s / steps);

    PetscCall(LamRVESolve(rve, &load, state, &r));
    if (r.status != LAM_CONVERGED) break;
    if (!s) continue;
    curve->stress[s - 1] = TISSUE_STRESS * r.P[c->shear != 0 ? 1 : 4];
    curve->opening[s - 1] = r.opening_fraction;
    curve->debonded[s - 1] = r.debonded_fraction;
    curve->steps = s;
  }
  PetscCall(DestroyTissue(&rve, &state));
  PetscCall(PetscTime(&end));
  curve->seconds = end - start;
  PetscFunctionReturn(0);
}

/* ---- FE2 of the box with free sides ---- */
static PetscErrorCode ScalesScene(const ScalesCase *c, int elements, int steps, LamScene **scene)
{
  const double height = 0.5 * sqrt(3.0); /* of its width */
  char cohesion[64] = "", text[1024];

  PetscFunctionBeginUser;
  if (c->interface == LAM_INTERFACE_CONTACT) snprintf(cohesion, sizeof(cohesion), ", cohesion: %g MPa", c->cohesion);
  snprintf(text, sizeof(text),
           "version: 1\n"
           "rve:\n"
           "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
           "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
           "  interface: {law: %s%s}\n"
           "  turgor: {mode: prescribed, pressure: %g MPa}\n"
           "  mesh: {along: %d, through: %d}\n"
           "macro:\n"
           "  mesh: {box: [1 mm, %.16g mm], elements: [%d, %d]}\n"
           "  boundary:\n"
           "    - {on: bottom, displacement: [0 mm, 0 mm]}\n"
           "    - {on: top, displacement: [%.16g mm, %.16g mm]}\n"
           "  inflate: false\n"
           "  steps: %d\n",
           LamInterfaceLawNames[c->interface], cohesion, c->turgor, SCALES_ALONG, SCALES_THROUGH, height, elements,
           elements, c->shear * height, c->stretch * height, steps);
  PetscCall(LamSceneReadText("box", text, scene));
  PetscFunctionReturn(0);
}

typedef struct {
  const ScalesCase *scales_case;
  ScalesCurve *curve;
} ScalesBody;

/* LamMacroMonitor. The box is as wide as the unit of length, and its elements are alike. */
static PetscErrorCode ScalesNoteStep(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  const ScalesBody *body = (const ScalesBody *)ctx;
  ScalesCurve *curve = body->curve;
  LamMacroFields fields;
  double opening = 0;

  PetscFunctionBeginUser;
  PetscCall(LamMacroGetFields(macro, &fields));
  for (PetscInt e = 0; e < fields.element_count; e++)
    opening += fields.mean[LAM_POINT_FIELD_COUNT * e + LAM_POINT_OPENING] / fields.element_count;
  PetscCall(LamMacroFieldsDestroy(&fields));
  for (PetscInt side = 0; side < step->boundary_count; side++)
    if (!strcmp(step->boundary[side], "top"))
      curve->stress[curve->steps] = TISSUE_STRESS * step->reaction[side][body->scales_case->shear != 0 ? 0 : 1];
  curve->opening[curve->steps] = opening;
  curve->debonded[curve->steps++] = step->debonded_fraction;
  PetscFunctionReturn(0);
}

PetscErrorCode ScalesSolveBody(const ScalesCase *c, int elements, int steps, ScalesCurve *curve)
{
  ScalesBody body = {c, curve};
  char message[LAM_MESSAGE_LENGTH];
  PetscLogDouble start, end;
  LamResponder responder;
  LamMacroReason reason;
  LamScene *scene;
  LamMacro macro;
  PetscInt points;
  LamRVE rve;

  PetscFunctionBeginUser;
  *curve = (ScalesCurve){0};
  PetscCall(PetscTime(&start));
  PetscCall(ScalesScene(c, elements, steps, &scene));
  PetscCall(NewTissue(&scene->micro, &rve, NULL));
  PetscCall(LamMacroCreate(PETSC_COMM_SELF, &macro));
  PetscCall(LamMacroSetScene(macro, scene));
  PetscCall(LamMacroSetUp(macro));
  PetscCall(LamMacroGetPointCount(macro, &points));
  PetscCall(LamRVEResponderCreate(rve, points, &responder));
  PetscCall(LamMacroSetResponder(macro, responder));
  PetscCall(LamMacroSetMonitor(macro, ScalesNoteStep, &body));
  PetscCall(LamMacroSolve(macro, &reason, message));
  if (reason != LAM_MACRO_DONE) curve->steps = 0; /* its last step came only part of its way */
  PetscCall(LamMacroDestroy(&macro));
  PetscCall(LamResponderDestroy(&responder));
  PetscCall(LamRVEDestroy(&rve));
  PetscCall(LamSceneDestroy(&scene));
  PetscCall(PetscTime(&end));
  curve->seconds = end - start;
  PetscFunctionReturn(0);
}

ScalesCurve ScalesBodyLimit(const ScalesCurve *elements, const ScalesCurve *twice)
{
  const double share = 1 / (pow(2, 4.0 / 3.0) - 1);
  ScalesCurve limit = *twice;

  for (int s = 0; s < twice->steps; s++) limit.stress[s] += share * (twice->stress[s] - elements->stress[s]);
  return limit;
}

PetscErrorCode ScalesSolveLimit(const ScalesCase *c, int elements, int steps, ScalesCurve *limit)
{
  ScalesCurve coarse, fine;

  PetscFunctionBeginUser;
  if (c->sides == LAM_SIDES_AFFINE) {
    PetscCall(ScalesSolveCells(c, 2, PETSC_FALSE, steps, limit));
    PetscFunctionReturn(0);
  }
  PetscCall(ScalesSolveBody(c, elements, steps, &coarse));
  PetscCall(ScalesSolveBody(c, 2 * elements, steps, &fine));
  *limit = ScalesBodyLimit(&coarse, &fine);
  if (coarse.steps < steps) limit->steps = 0;
  PetscFunctionReturn(0);
}

double ScalesDifference(int steps, const double values[], const double reference[])
{
  double difference = 0, size = 0;

  for (int s = 0; s < steps; s++) {
    difference = fmax(difference, fabs(values[s] - reference[s]));
    size = fmax(size, fabs(reference[s]));
  }
  return difference / size;
}

ScalesCurve ScalesExtrapolated(const ScalesCurve *n, const ScalesCurve *twice)
{
  ScalesCurve limit = *twice;

  for (int s = 0; s < twice->steps; s++) {
    limit.stress[s] += twice->stress[s] - n->stress[s];
    limit.opening[s] += twice->opening[s] - n->opening[s];
    limit.debonded[s] += twice->debonded[s] - n->debonded[s];
  }
  return limit;
}
