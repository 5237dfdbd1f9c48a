/*
  FE2 against a direct patch of n x n cells between grips: what the tests assert and the bench program prints.

  Matching. A block of n x n cells that stand on a corner has rows of height sqrt(3) a and columns of width 2 a. Its
  outer walls are zigzags around the sides of a box of 2 n a x sqrt(3) n a, whose area is n^2 V0: that box is the body
  of FE2, with bottom and top where the zigzags of the grips have their mean. The box has the same shape for all n and
  FE2 knows no length, so that one FE2 solution stands against all n. Grips move as x = F X in both; the force on the
  top over its width is the mean P_i2 of the box, and of the patch as docs/theory/walls.md, Patches between grips, has
  it. Lateral sides: free (the walls of the patch bear turgor from inside and nothing from outside, so that fluid and
  walls together carry no traction, as the free side of FE2); or affine, where F is the same everywhere and FE2 is one
  RVE. In both the walls are meshed alike, turgor acts first, with the grips at rest, and then F grows in equal steps.

  Stresses in MPa.
*/
#ifndef LAM_FIGURES_FE2_PATCH_H
#define LAM_FIGURES_FE2_PATCH_H

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <petsctime.h>
#include "tissue.h"

#define SCALES_STEPS_MAX 4
#define SCALES_ALONG 4 /* elements along a face */
#define SCALES_THROUGH 1

/* A block and the way that its grips go: simple shear, or apart with F22. */
typedef struct {
  const char *name;
  LamInterfaceLawType interface;
  LamPatchSides sides;
  double turgor, cohesion; /* MPa */
  double shear, stretch;   /* at the end: F12 and F22 - 1, one of them 0 */
  int largest;             /* block that is solved: larger ones that buckle do not find their pattern in minutes */
} ScalesCase;

/* In the order of the list. */
enum {
  SCALES_BONDED_FREE_SHEARED,
  SCALES_BONDED_FREE_PULLED,
  SCALES_BONDED_FREE_PRESSED,
  SCALES_CONTACT_FREE_SHEARED,
  SCALES_CONTACT_FREE_PULLED,
  SCALES_CONTACT_FREE_PRESSED,
  SCALES_CONTACT_AFFINE_SHEARED,
  SCALES_CONTACT_AFFINE_PULLED,
  SCALES_CONTACT_AFFINE_PRESSED,
  SCALES_CASES
};
static const ScalesCase scales_cases[SCALES_CASES] = {
    {"bonded, free, sheared", LAM_INTERFACE_BONDED, LAM_SIDES_FREE, 0.02, 0, 0.1, 0, 16},
    {"bonded, free, pulled", LAM_INTERFACE_BONDED, LAM_SIDES_FREE, 0.02, 0, 0, 0.1, 16},
    {"bonded, free, pressed", LAM_INTERFACE_BONDED, LAM_SIDES_FREE, 0.02, 0, 0, -0.05, 16},
    {"contact, free, sheared", LAM_INTERFACE_CONTACT, LAM_SIDES_FREE, 0.01, 0.02, 0.1, 0, 16},
    {"contact, free, pulled", LAM_INTERFACE_CONTACT, LAM_SIDES_FREE, 0.01, 0.02, 0, 0.1, 16},
    {"contact, free, pressed", LAM_INTERFACE_CONTACT, LAM_SIDES_FREE, 0.01, 0.02, 0, -0.04, 16},
    {"contact, affine, sheared", LAM_INTERFACE_CONTACT, LAM_SIDES_AFFINE, 0.02, 0.005, 0.2, 0, 16},
    {"contact, affine, pulled", LAM_INTERFACE_CONTACT, LAM_SIDES_AFFINE, 0.02, 0.005, 0, 0.1, 16},
    {"contact, affine, pressed", LAM_INTERFACE_CONTACT, LAM_SIDES_AFFINE, 0.02, 0.005, 0, -0.05, 8},
};

/* Values at the steps 1..steps; as far as they go where a run ends early. */
typedef struct {
  int steps;
  double stress[SCALES_STEPS_MAX];   /* P12 in shear, else P22 */
  double opening[SCALES_STEPS_MAX];  /* gaps over the volume of the block */
  double debonded[SCALES_STEPS_MAX]; /* share of the interface that carries no contact */
  double seconds;
} ScalesCurve;

static inline LamMicrostructure ScalesTissue(const ScalesCase *c, PetscInt n, PetscBool is_patch)
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

static inline LamLoad ScalesLoad(const ScalesCase *c, double share)
{
  LamLoad load = PlaneLoad(1, share * c->shear, 0, 1 + share * c->stretch, c->turgor / TISSUE_STRESS);

  load.cohesion = c->cohesion / TISSUE_STRESS;
  return load;
}

/* n x n cells, as one block or as the period of tissue under one F. */
static inline PetscErrorCode ScalesSolveCells(const ScalesCase *c, PetscInt n, PetscBool is_patch, int steps,
                                              ScalesCurve *curve)
{
  const LamMicrostructure micro = ScalesTissue(c, n, is_patch);
  PetscLogDouble start, end;
  LamRVEState state;
  LamResponse r;
  LamRVE rve;

  PetscFunctionBeginUser;
  *curve = (ScalesCurve){0};
  PetscCall(PetscTime(&start));
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &rve));
  PetscCall(LamRVESetMicrostructure(rve, &micro));
  PetscCall(LamRVESetUp(rve));
  PetscCall(LamRVEStateCreate(rve, &state));
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
  PetscCall(LamRVEStateDestroy(&state));
  PetscCall(LamRVEDestroy(&rve));
  PetscCall(PetscTime(&end));
  curve->seconds = end - start;
  PetscFunctionReturn(0);
}

/* ---- FE2 of the box with free sides ---- */
static inline PetscErrorCode ScalesScene(const ScalesCase *c, int elements, int steps, LamScene **scene)
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
static inline PetscErrorCode ScalesNoteStep(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
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

static inline PetscErrorCode ScalesSolveBody(const ScalesCase *c, int elements, int steps, ScalesCurve *curve)
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
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &rve));
  PetscCall(LamRVESetMicrostructure(rve, &scene->micro));
  PetscCall(LamRVESetUp(rve));
  PetscCall(LamMacroCreate(PETSC_COMM_SELF, &macro));
  PetscCall(LamMacroSetScene(macro, scene));
  PetscCall(LamMacroSetUp(macro));
  PetscCall(LamMacroGetPointCount(macro, &points));
  PetscCall(LamRVEResponderCreate(rve, points, &responder));
  PetscCall(LamMacroSetResponder(macro, &responder));
  PetscCall(LamMacroSetMonitor(macro, ScalesNoteStep, &body));
  PetscCall(LamMacroSolve(macro, &reason, message));
  if (reason != LAM_MACRO_DONE) curve->steps = 0; /* its last step came only part of its way */
  PetscCall(LamMacroDestroy(&macro));
  PetscCall(responder.destroy(&responder.ctx));
  PetscCall(LamRVEDestroy(&rve));
  PetscCall(LamSceneDestroy(&scene));
  PetscCall(PetscTime(&end));
  curve->seconds = end - start;
  PetscFunctionReturn(0);
}

/*
  FE2 on infinitely fine meshes, from `elements` and twice as many. Where a held side meets a free one F is singular,
  and the reaction has an error of h^2q there, q the exponent of the displacement; 2q = 4/3 fits what meshes of 2, 4 and
  8 elements give (1.3 to 1.4). Opening and debonded share are those of the finer mesh: switches of contact at material
  points change them by as much as the mesh does.
*/
static inline ScalesCurve ScalesBodyLimit(const ScalesCurve *elements, const ScalesCurve *twice)
{
  const double share = 1 / (pow(2, 4.0 / 3.0) - 1);
  ScalesCurve limit = *twice;

  for (int s = 0; s < twice->steps; s++) limit.stress[s] += share * (twice->stress[s] - elements->stress[s]);
  return limit;
}

/* What the block tends to: the body, from meshes of `elements` and 2 `elements`; or, where F is the same everywhere,
   tissue with a period of 2 x 2 cells, which may buckle in a pattern of two. Without steps where a mesh has none. */
static inline PetscErrorCode ScalesSolveLimit(const ScalesCase *c, int elements, int steps, ScalesCurve *limit)
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

/* ---- differences ---- */
/* Largest difference along two curves of the same steps, over the largest value of the second. */
static inline double ScalesDifference(int steps, const double values[], const double reference[])
{
  double difference = 0, size = 0;

  for (int s = 0; s < steps; s++) {
    difference = fmax(difference, fabs(values[s] - reference[s]));
    size = fmax(size, fabs(reference[s]));
  }
  return difference / size;
}

/* The limit of curves of n and 2 n cells whose difference from it is proportional to 1/n. */
static inline ScalesCurve ScalesExtrapolated(const ScalesCurve *n, const ScalesCurve *twice)
{
  ScalesCurve limit = *twice;

  for (int s = 0; s < twice->steps; s++) {
    limit.stress[s] += twice->stress[s] - n->stress[s];
    limit.opening[s] += twice->opening[s] - n->opening[s];
    limit.debonded[s] += twice->debonded[s] - n->debonded[s];
  }
  return limit;
}

#endif
