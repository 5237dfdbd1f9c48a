/*
  Bodies that change in time, of the synthetic material (4 x 4 elements, 144 points): a week of storage under a grip,
  then a shear test.

  Work and precision of the integration over its tolerance; and of splitting, where a step of fixed length changes
  kinetics and water with the body held, implicitly point by point, and then balances the body with that water. `held`
  says what is: the deformation, so that the turgor follows the water by the lumen's own compliance; or the turgor.
  Errors are those of turgor (largest and smallest, over that of the start) and of the force on the grip at the end.
*/
#include <lamella/lamella.h>
#include "clock.h"
#include "support/synthetic_responder.h"
#include <math.h>
#include <stdio.h>

#define TISSUE                                                                                                         \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"                                                               \
  "  wall: {law: mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa}\n"                                                          \
  "  turgor: {pressure: 0.05 MPa}\n"
#define SCENE                                                                                                          \
  "macro:\n"                                                                                                           \
  "  mesh: {box: [10 mm, 10 mm], elements: [4, 4]}\n"                                                                  \
  "  boundary:\n"                                                                                                      \
  "    - {on: bottom, displacement: [0 mm, 0 mm]}\n"                                                                   \
  "    - {on: top, grip: [2 mm, free]}\n"                                                                              \
  "process:\n"                                                                                                         \
  "  duration: 604810 s\n"                                                                                             \
  "  output: 604810 s\n"                                                                                               \
  "  water: {permeability: 1e-7 m/s/MPa, osmotic_pressure: 0.5 MPa, non_osmotic: 0.1}\n"                               \
  "  surroundings: [{time: 0 s, outside: 0.45 MPa}, {time: 604800 s, outside: 0.42 MPa}]\n"                            \
  "  kinetics:\n"                                                                                                      \
  "    - {of: walls, law: fractional_conversion, rate: 0.3 /day, plateau: 0.5}\n"                                      \
  "  program: [{for: 604800 s}, {for: 10 s, load: 1}]\n"
#define STORED 604800.0
#define END 604810.0
static const PetscReal COMPLIANCES[] = {0.05, 0.002}; /* of the lumen of cells that are held */
enum { MOST_POINTS = 2000, MOST_STEPS = 20000 };

typedef struct {
  PetscReal turgor_min, turgor_max, force;
} End;

static PetscReal compliance; /* of the material */

static PetscReal ErrorOf(End a, End b)
{
  return fmax(fmax(fabs(a.turgor_min - b.turgor_min), fabs(a.turgor_max - b.turgor_max)), fabs(a.force - b.force));
}

static PetscErrorCode MakeSoft(PetscInt points, LamResponder *responder)
{
  Synthetic *material;

  PetscFunctionBeginUser;
  PetscCall(SyntheticCreate(points, responder, &material));
  material->phi = 0.7;
  material->c = compliance;
  PetscFunctionReturn(0);
}

static PetscReal ForceOnTop(const LamMacroStep *step)
{
  for (PetscInt s = 0; s < step->boundary_count; s++)
    if (!strcmp(step->boundary[s], "top")) return step->reaction[s][0];
  return NAN;
}

static PetscErrorCode KeepEnd(const LamBodyState *state, void *ctx)
{
  *(End *)ctx = (End){state->turgor_min, state->turgor_max, ForceOnTop(&state->step)};
  return 0;
}

static PetscErrorCode Together(LamScene *scene, PetscReal tolerance, End *end, LamProcessCounts *counts,
                               PetscReal *seconds)
{
  const PetscReal start = LamClock();
  char message[LAM_PROCESS_MESSAGE];
  LamProcessReason reason;
  LamResponder responder;
  PetscInt points;
  LamMacro macro;
  LamBody body;

  PetscFunctionBeginUser;
  scene->process.tolerance = tolerance;
  PetscCall(LamMacroCreate(PETSC_COMM_SELF, &macro));
  PetscCall(LamMacroSetScene(macro, scene));
  PetscCall(LamBodyCreate(scene, macro, &body));
  PetscCall(LamMacroSetUp(macro));
  PetscCall(LamMacroGetPointCount(macro, &points));
  PetscCall(MakeSoft(points, &responder));
  PetscCall(LamMacroSetResponder(macro, responder));
  PetscCall(LamBodySetMonitor(body, KeepEnd, end));
  PetscCall(LamBodyRun(body, &reason, message));
  PetscCheck(reason == LAM_PROCESS_DONE, PETSC_COMM_SELF, PETSC_ERR_LIB, "%s", message);
  PetscCall(LamBodyGetCounts(body, counts));
  PetscCall(LamBodyDestroy(&body));
  PetscCall(LamMacroDestroy(&macro));
  PetscCall(LamResponderDestroy(&responder));
  *seconds = LamClock() - start;
  PetscFunctionReturn(0);
}

/* ---- splitting ---- */

typedef struct {
  LamScene *scene;
  LamMacro macro;
  PetscInt points;
  PetscReal start[MOST_POINTS], water[MOST_POINTS], u[8 * MOST_POINTS], pressures[MOST_POINTS];
} Split;

static void GivenWater(void *ctx, PetscInt point, PetscReal turgor, const PetscReal potential[], LamWater *water)
{
  water->water = ((Split *)ctx)->water[point];
  water->slope = 0;
}

/* V = V_n + dt k (pi(V) - outside - p), p = p_n + (V - V_n) / give; give infinite: p is held. */
static PetscReal NextWater(const Split *s, PetscInt p, PetscReal turgor, PetscReal give, PetscReal outside,
                           PetscReal dt)
{
  const LamWaterSpec *spec = &s->scene->process.water;
  const PetscReal k = spec->permeability * LamMembraneArea(&s->scene->micro), dead = spec->non_osmotic * s->start[p];
  const PetscReal solutes = spec->osmotic * (s->start[p] - dead), before = s->water[p];
  PetscReal V = before;

  for (int it = 0; it < 50; it++) {
    const PetscReal pi = solutes / (V - dead), drive = pi - outside - turgor - (V - before) / give;
    const PetscReal step = (V - before - dt * k * drive) / (1 + dt * k * (pi / (V - dead) + 1 / give));

    V -= step;
    if (fabs(step) < 1e-14) break;
  }
  return V;
}

static PetscErrorCode Step(Split *s, PetscReal time, PetscReal dt, PetscBool holds_turgor, PetscBool *ok)
{
  const LamSurroundings *at = s->scene->process.surroundings;
  const PetscReal outside = at[0].outside + fmin(1, time / STORED) * (at[1].outside - at[0].outside);
  LamMacroInstant instant = {.load = fmax(0, (time - STORED) / (END - STORED)),
                             .turgor = 1,
                             .lamella = 1,
                             .walls = 0.5 + 0.5 * exp(-0.3 * time / 86400)};

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < s->points; p++) {
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(s->macro, p, &point));
    const PetscReal J = point.lumen / (0.7 + compliance * point.load->turgor / instant.walls);

    s->water[p] =
        NextWater(s, p, point.load->turgor, holds_turgor ? INFINITY : compliance * J / instant.walls, outside, dt);
  }
  PetscCall(LamMacroBalance(s->macro, &instant, s->u, s->pressures, NULL, ok));
  if (!*ok) PetscFunctionReturn(0);
  PetscCall(LamMacroAccept(s->macro));
  PetscCall(LamMacroGetState(s->macro, s->u, s->pressures, NULL));
  PetscFunctionReturn(0);
}

static PetscErrorCode FindEnd(Split *s, End *end)
{
  LamMacroStep step;

  PetscFunctionBeginUser;
  *end = (End){INFINITY, -INFINITY, 0};
  for (PetscInt p = 0; p < s->points; p++) {
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(s->macro, p, &point));
    end->turgor_min = fmin(end->turgor_min, point.load->turgor);
    end->turgor_max = fmax(end->turgor_max, point.load->turgor);
  }
  PetscCall(LamMacroDescribe(s->macro, 1, END, LamClock(), &step));
  end->force = ForceOnTop(&step);
  PetscFunctionReturn(0);
}

/* `steps` of equal length in storage, a tenth of that in the test. *ok: all of them have an equilibrium. */
static PetscErrorCode Splitting(LamScene *scene, PetscInt steps, PetscBool holds_turgor, End *end, PetscBool *ok,
                                PetscReal *seconds)
{
  const PetscReal start = LamClock();
  static Split s;
  char why[LAM_MESSAGE_LENGTH];
  LamResponder responder;

  PetscFunctionBeginUser;
  s.scene = scene;
  PetscCall(LamMacroCreate(PETSC_COMM_SELF, &s.macro));
  PetscCall(LamMacroSetScene(s.macro, scene));
  PetscCall(LamMacroSetWaterLaw(s.macro, GivenWater, &s));
  PetscCall(LamMacroSetUp(s.macro));
  PetscCall(LamMacroGetPointCount(s.macro, &s.points));
  PetscCall(MakeSoft(s.points, &responder));
  PetscCall(LamMacroSetResponder(s.macro, responder));
  PetscCall(LamMacroStart(s.macro, ok, why));
  PetscCall(LamMacroGetState(s.macro, s.u, s.pressures, NULL));
  for (PetscInt p = 0; p < s.points; p++) {
    LamMacroPoint point;

    PetscCall(LamMacroGetPoint(s.macro, p, &point));
    s.start[p] = s.water[p] = point.lumen;
  }
  for (PetscInt k = 1; k <= steps && *ok; k++)
    PetscCall(Step(&s, STORED * k / steps, STORED / steps, holds_turgor, ok));
  for (PetscInt k = 1; k <= (steps + 9) / 10 && *ok; k++)
    PetscCall(Step(&s, STORED + (END - STORED) * k / ((steps + 9) / 10), (END - STORED) / ((steps + 9) / 10),
                   holds_turgor, ok));
  if (*ok) PetscCall(FindEnd(&s, end));
  PetscCall(LamMacroDestroy(&s.macro));
  PetscCall(LamResponderDestroy(&responder));
  *seconds = LamClock() - start;
  PetscFunctionReturn(0);
}

/* ---- tables ---- */

static PetscErrorCode Measure(LamScene *scene)
{
  End exact, end;
  LamProcessCounts counts;
  PetscReal seconds;
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(Together(scene, 1e-9, &exact, &counts, &seconds));
  printf("compliance of held lumens %g: turgor %.6f to %.6f, force %.6f\n", (double)compliance,
         (double)exact.turgor_min, (double)exact.turgor_max, (double)exact.force);
  printf("%-22s %9s %7s %11s %9s %9s\n", "", "tolerance", "steps", "evaluations", "error", "seconds");
  for (PetscReal tolerance = 1e-2; tolerance > 0.5e-7; tolerance /= 10) {
    PetscCall(Together(scene, tolerance, &end, &counts, &seconds));
    printf("%-22s %9.0e %7d %11d %9.1e %9.3f\n", "together", (double)tolerance, (int)counts.steps,
           (int)counts.questions, (double)ErrorOf(end, exact), (double)seconds);
  }
  for (int holds_turgor = 0; holds_turgor < 2; holds_turgor++)
    for (PetscInt steps = 100; steps <= MOST_STEPS; steps *= holds_turgor ? 10 : 4) {
      PetscCall(Splitting(scene, steps, (PetscBool)holds_turgor, &end, &ok, &seconds));
      printf("%-22s %9s %7d %11d ", holds_turgor ? "split, turgor held" : "split, F held", "",
             (int)(steps + (steps + 9) / 10), (int)(steps + (steps + 9) / 10));
      if (ok)
        printf("%9.1e %9.3f\n", (double)ErrorOf(end, exact), (double)seconds);
      else
        printf("%9s %9.3f\n", "diverges", (double)seconds);
    }
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  LamScene *scene;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(LamSceneReadText("body.yaml", TISSUE SCENE, &scene));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(COMPLIANCES); k++) {
    compliance = COMPLIANCES[k];
    PetscCall(Measure(scene));
  }
  PetscCall(LamSceneDestroy(&scene));
  PetscCall(PetscFinalize());
  return 0;
}
