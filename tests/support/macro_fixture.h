/* A body made of the synthetic material, for tests of the macroscale solver. */
#ifndef LAM_SUPPORT_MACRO_FIXTURE_H
#define LAM_SUPPORT_MACRO_FIXTURE_H

#include "test.h"
#include <lamella/macro.h>
#include "synthetic_responder.h"

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
  LamMacroFields fields; /* of FixtureFields */
  char message[LAM_MESSAGE_LENGTH];
} Fixture;

/* FIXTURE fixture: made with one of the functions below, destroyed where the block ends. */
#define FIXTURE OWNED(Fixture, FixtureDestroy)
/* A test with a `Fixture *fixture` that it makes with one of the functions below; it is destroyed behind it. */
#define MACRO_TEST(name) TEST_ON(name, Fixture, fixture, (void)fixture, FixtureDestroy(fixture))

PetscErrorCode FixtureMonitor(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx);
/* A scene with a 1 x height body, without boundary conditions yet. */
void FixtureScene(Fixture *fixture, PetscInt nx, PetscInt ny, PetscReal height, PetscInt steps);
/* The lumens keep the water that they have with this turgor. */
void FixtureSeal(Fixture *fixture, PetscReal turgor, PetscReal bulk_modulus);
/* `NAN` leaves a component free. */
void FixtureBoundary(Fixture *fixture, const char on[], PetscReal ux, PetscReal uy);
/* Another condition, to be completed. */
LamBoundary *FixtureAdd(Fixture *fixture, const char on[], LamBoundaryKind kind);
/* Symmetry on the left and at the bottom. */
void FixtureSymmetry(Fixture *fixture);
/* A stiff disc on the top side, with its lowest point at (x, y), moved by (ux, uy). */
void FixtureIndenter(Fixture *fixture, PetscReal radius, PetscReal x, PetscReal y, PetscReal ux, PetscReal uy);
/* Turgor that the body swells under before the first step. */
void FixtureInflate(Fixture *fixture);
void FixtureLegs(Fixture *fixture, PetscInt n, const LamLeg legs[]);
/* A disc of radius 1, or a part of it. */
void FixtureDisc(Fixture *fixture, LamDiscPart part, PetscInt along, PetscInt across);
/* A scene with a quarter of it, n x n elements along and across, and its symmetry. */
void FixtureQuarterDisc(Fixture *fixture, PetscInt n, PetscInt steps);
/* Force on the body at a named side in the last step. */
const PetscReal *FixtureReaction(const Fixture *fixture, const char name[]);
void FixtureSetUp(Fixture *fixture, MPI_Comm comm);
/* The scene must be refused. */
void FixtureRefused(Fixture *fixture);
/* Ends, as it must, with this reason. */
void FixtureSolve(Fixture *fixture, LamMacroReason reason);
/* Both. */
void FixtureRun(Fixture *fixture, MPI_Comm comm, LamMacroReason reason);
const LamMacroFields *FixtureFields(Fixture *fixture);
const LamMacroStep *FixtureLast(const Fixture *fixture);
void FixtureDestroy(Fixture *fixture);
/* Bottom held, top moved sideways, the other sides free. */
void FixtureShear(Fixture *fixture, PetscInt elements, PetscReal shear, PetscInt steps);
/* Sides that slide, the right one moved by ux, the top one by uy. */
void FixtureRollers(Fixture *fixture, PetscReal ux, PetscReal uy);
/* Stretched between rollers: the deformation gradient is diag(1 + ux, 1 + uy) everywhere. */
void FixtureBiaxial(Fixture *fixture, PetscReal ux, PetscReal uy, PetscInt steps);

#endif
