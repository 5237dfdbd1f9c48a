/*
  A body made of the synthetic material, for tests of the macroscale solver.
*/
#ifndef LAM_MACRO_FIXTURE_H
#define LAM_MACRO_FIXTURE_H

#include "support/test.h"
#include <lamella/macro.h>
#include "synthetic_responder.h"

#define assert_ok(call) assert_int_equal((call), 0)

enum { FIXTURE_MAX_STEPS = 64 };

typedef struct {
  LamScene scene;
  LamMacro macro;
  LamResponder responder;
  Synthetic *material;
  PetscInt step_count;
  LamMacroStep steps[FIXTURE_MAX_STEPS]; /* reports of the converged steps */
  PetscInt stop_after;                   /* -1: never */
  LamMacroReason reason;
  char message[LAM_MESSAGE_LENGTH];
} Fixture;

static inline PetscErrorCode FixtureMonitor(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  Fixture *fixture = (Fixture *)ctx;

  PetscFunctionBeginUser;
  fixture->steps[fixture->step_count++] = *step;
  *stop = fixture->stop_after == step->step ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* A scene with a 1 x height body, without boundary conditions yet. */
static inline void FixtureScene(Fixture *fixture, PetscInt nx, PetscInt ny, PetscReal height, PetscInt steps)
{
  memset(fixture, 0, sizeof(*fixture));
  fixture->stop_after = -1;
  fixture->scene.scales = (LamScales){.length = 75e-6, .stress = 0.11e6, .macro_length = 0.01};
  fixture->scene.accuracy = 0.01;
  fixture->scene.has_macro = PETSC_TRUE;
  fixture->scene.macro = (LamMacroSpec){.box = {1, height}, .elements = {nx, ny}, .steps = steps};
}

/* The lumens keep the water that they have with this turgor. */
static inline void FixtureSeal(Fixture *fixture, PetscReal turgor, PetscReal bulk_modulus)
{
  fixture->scene.turgor = turgor;
  fixture->scene.sealed = PETSC_TRUE;
  fixture->scene.water_bulk_modulus = bulk_modulus;
}

/* `NAN` leaves a component free. */
static inline void FixtureBoundary(Fixture *fixture, const char on[], PetscReal ux, PetscReal uy)
{
  LamMacroSpec *spec = &fixture->scene.macro;
  LamBoundary *boundary = &spec->boundary[spec->boundary_count++];

  strcpy(boundary->on, on);
  boundary->given[0] = (PetscBool)!isnan(ux);
  boundary->given[1] = (PetscBool)!isnan(uy);
  boundary->displacement[0] = isnan(ux) ? 0 : ux;
  boundary->displacement[1] = isnan(uy) ? 0 : uy;
}

/* Another condition, to be completed. */
static inline LamBoundary *FixtureAdd(Fixture *fixture, const char on[], LamBoundaryKind kind)
{
  LamMacroSpec *spec = &fixture->scene.macro;
  LamBoundary *boundary = &spec->boundary[spec->boundary_count++];

  *boundary = (LamBoundary){.kind = kind};
  strcpy(boundary->on, on);
  return boundary;
}

/* A disc of radius 1, or a part of it. */
static inline void FixtureDisc(Fixture *fixture, LamDiscPart part, PetscInt along, PetscInt across)
{
  fixture->scene.macro.source = LAM_MESH_DISC;
  fixture->scene.macro.disc = part;
  fixture->scene.macro.elements[0] = along;
  fixture->scene.macro.elements[1] = across;
}

/* Force on the body at a named side in the last step. */
static inline const PetscReal *FixtureReaction(const Fixture *fixture, const char name[])
{
  const LamMacroStep *step = &fixture->steps[fixture->step_count - 1];

  for (PetscInt s = 0; s < step->boundary_count; s++) {
    if (!strcmp(step->boundary[s], name)) return step->reaction[s];
  }
  fail_msg("no side %s", name);
  return NULL;
}

static inline void FixtureSetUp(Fixture *fixture, MPI_Comm comm)
{
  PetscInt points;

  assert_ok(LamMacroCreate(comm, &fixture->macro));
  assert_ok(LamMacroSetScene(fixture->macro, &fixture->scene));
  assert_ok(LamMacroSetUp(fixture->macro));
  assert_ok(LamMacroGetPointCount(fixture->macro, &points));
  assert_ok(SyntheticCreate(points, &fixture->responder, &fixture->material));
  assert_ok(LamMacroSetResponder(fixture->macro, &fixture->responder));
  assert_ok(LamMacroSetMonitor(fixture->macro, FixtureMonitor, fixture));
}

static inline void FixtureSolve(Fixture *fixture)
{
  assert_ok(LamMacroSolve(fixture->macro, &fixture->reason, fixture->message));
}

static inline const LamMacroStep *FixtureLast(const Fixture *fixture)
{
  assert_true(fixture->step_count > 0);
  return &fixture->steps[fixture->step_count - 1];
}

static inline void FixtureDestroy(Fixture *fixture)
{
  assert_ok(LamMacroDestroy(&fixture->macro));
  assert_ok(fixture->responder.destroy(&fixture->responder.ctx));
}

/* Bottom held, top moved sideways, the other sides free. */
static inline void FixtureShear(Fixture *fixture, PetscInt elements, PetscReal shear, PetscInt steps)
{
  FixtureScene(fixture, elements, elements, 1, steps);
  FixtureBoundary(fixture, "bottom", 0, 0);
  FixtureBoundary(fixture, "top", shear, 0);
}

/* Sides that slide, the right one moved by ux, the top one by uy. */
static inline void FixtureRollers(Fixture *fixture, PetscReal ux, PetscReal uy)
{
  FixtureBoundary(fixture, "left", 0, NAN);
  FixtureBoundary(fixture, "right", ux, NAN);
  FixtureBoundary(fixture, "bottom", NAN, 0);
  FixtureBoundary(fixture, "top", NAN, uy);
}

/* Stretched between rollers: the deformation gradient is diag(1 + ux, 1 + uy) everywhere. */
static inline void FixtureBiaxial(Fixture *fixture, PetscReal ux, PetscReal uy, PetscInt steps)
{
  const PetscReal height = 0.6;

  FixtureScene(fixture, 3, 2, height, steps);
  FixtureRollers(fixture, ux, uy * height);
}

#endif
