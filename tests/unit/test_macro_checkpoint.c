/* A macroscale run that goes on from an archive of an earlier one; archives themselves. */
#include "support/macro_fixture.h"
#include <stdio.h>
#include <unistd.h>

static const char Path[] = "checkpoint.tmp.ckpt";

/* ---- archives ---- */

typedef struct {
  PetscInt shared, count;
  PetscReal items[3][2], *list;
} Contents;

static PetscErrorCode Transfer(LamArchive archive, Contents *c)
{
  const PetscInt numbers[3] = {2, 0, 1};

  PetscFunctionBeginUser;
  PetscCall(LamArchiveShared(archive, "shared", sizeof(c->shared), &c->shared));
  PetscCall(LamArchiveItems(archive, "items", sizeof(c->items[0]), 3, numbers, c->items));
  PetscCall(LamArchiveList(archive, "list", sizeof(PetscReal), &c->count, (void **)&c->list));
  PetscFunctionReturn(0);
}

static void WriteArchive(Contents *contents, PetscBool keep)
{
  LamArchive archive;

  CHECK(LamArchiveCreate(PETSC_COMM_SELF, Path, &archive));
  assert_false(LamArchiveIsReading(archive));
  CHECK(Transfer(archive, contents));
  CHECK(LamArchiveClose(&archive, keep));
}

TEST(WhatIsWrittenIsRead)
{
  PetscReal list[2] = {5, 6};
  Contents written = {7, 2, {{1, 2}, {3, 4}, {5, 6}}, list}, read = {0};
  LamArchive archive;

  WriteArchive(&written, PETSC_TRUE);
  CHECK(LamArchiveOpen(PETSC_COMM_SELF, Path, &archive));
  assert_true(LamArchiveIsReading(archive));
  CHECK(Transfer(archive, &read));
  CHECK(LamArchiveClose(&archive, PETSC_FALSE));
  assert_int_equal(read.shared, 7);
  assert_memory_equal(read.items, written.items, sizeof(read.items));
  assert_int_equal(read.count, 2);
  assert_memory_equal(read.list, list, sizeof(list));
  CHECK(PetscFree(read.list));
  unlink(Path);
}

TEST(WhatIsNotKeptLeavesTheFileBefore)
{
  Contents first = {.shared = 1}, second = {.shared = 2}, read = {0};
  LamArchive archive;

  WriteArchive(&first, PETSC_TRUE);
  WriteArchive(&second, PETSC_FALSE);
  CHECK(LamArchiveOpen(PETSC_COMM_SELF, Path, &archive));
  CHECK(Transfer(archive, &read));
  CHECK(LamArchiveClose(&archive, PETSC_FALSE));
  assert_int_equal(read.shared, 1);
  unlink(Path);
}

TEST(AnotherCountIsRefused)
{
  const PetscInt numbers[2] = {0, 1};
  Contents contents = {.shared = 1};
  PetscReal items[2][2];
  LamArchive archive;

  WriteArchive(&contents, PETSC_TRUE);
  CHECK(LamArchiveOpen(PETSC_COMM_SELF, Path, &archive));
  CHECK(PetscPushErrorHandler(PetscIgnoreErrorHandler, NULL));
  assert_int_equal(LamArchiveItems(archive, "items", sizeof(items[0]), 2, numbers, items), PETSC_ERR_USER_INPUT);
  assert_int_equal(LamArchiveItems(archive, "others", sizeof(items[0]), 2, numbers, items), PETSC_ERR_USER_INPUT);
  CHECK(PetscPopErrorHandler());
  CHECK(LamArchiveClose(&archive, PETSC_FALSE));
  unlink(Path);
}

/* ---- runs ---- */

/* Writes the archive after each complete step, as the program does. */
static PetscErrorCode SaveMonitor(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  LamArchive archive;

  PetscFunctionBeginUser;
  PetscCall(FixtureMonitor(macro, step, stop, ctx));
  if (!step->complete) PetscFunctionReturn(0);
  PetscCall(LamArchiveCreate(PETSC_COMM_WORLD, Path, &archive));
  PetscCall(LamMacroArchive(macro, archive));
  PetscCall(LamArchiveClose(&archive, PETSC_TRUE));
  PetscFunctionReturn(0);
}

static PetscBool AllLoads; /* beside displacements */

/* In place of the prescribed top: a grip that moves freely upwards, pulled; a plate that rubs the right side. */
static void PrepareLoads(Fixture *fixture)
{
  LamBoundary *boundary;

  fixture->scene.macro.boundary_count = 1;
  boundary = FixtureAdd(fixture, "top", LAM_BOUNDARY_GRIP);
  boundary->given[0] = PETSC_TRUE;
  boundary->displacement[0] = 0.2;
  FixtureAdd(fixture, "top", LAM_BOUNDARY_TRACTION)->traction[1] = 0.1;
  boundary = FixtureAdd(fixture, "right", LAM_BOUNDARY_PLATE);
  boundary->displacement[0] = -0.1;
  boundary->displacement[1] = 0.1;
  boundary->friction = 0.2;
  strcpy(fixture->scene.macro.control.on, "left");
  fixture->scene.macro.control.component = 1;
  fixture->scene.macro.control.displacement = 0.05;
}

static void Prepare(Fixture *fixture, PetscBool inflate, PetscBool sealed, PetscInt stop_after)
{
  FixtureShear(fixture, 3, 0.3, 4);
  if (AllLoads) PrepareLoads(fixture);
  FixtureSeal(fixture, 0.1, 2e3);
  fixture->scene.sealed = sealed;
  fixture->scene.macro.inflate = inflate;
  FixtureSetUp(fixture, PETSC_COMM_WORLD);
  fixture->stop_after = stop_after;
  CHECK(LamMacroSetMonitor(fixture->macro, SaveMonitor, fixture));
}

/* A run that is stopped after a step, and one that goes on from there, are one that is not stopped, bit for bit. */
static void CheckGoesOn(PetscBool inflate, PetscBool sealed, PetscInt stop_after)
{
  FIXTURE whole, first, second;
  LamArchive archive;

  Prepare(&whole, inflate, sealed, -1);
  FixtureSolve(&whole, LAM_MACRO_DONE);
  Prepare(&first, inflate, sealed, stop_after);
  FixtureSolve(&first, LAM_MACRO_STOPPED);
  Prepare(&second, inflate, sealed, -1);
  CHECK(LamArchiveOpen(PETSC_COMM_WORLD, Path, &archive));
  CHECK(LamMacroArchive(second.macro, archive));
  CHECK(LamArchiveClose(&archive, PETSC_FALSE));
  FixtureSolve(&second, LAM_MACRO_DONE);
  assert_int_equal(first.step_count + second.step_count, whole.step_count);
  for (PetscInt k = 0; k < second.step_count; k++) {
    const LamMacroStep *a = &whole.steps[first.step_count + k], *b = &second.steps[k];
    assert_int_equal(a->step, b->step);
    assert_int_equal(a->newton_iterations, b->newton_iterations);
    assert_memory_equal(a->reaction, b->reaction, sizeof(a->reaction));
    assert_memory_equal(&a->work, &b->work, sizeof(a->work));
  }
  unlink(Path);
}

TEST_IS(GoesOnBehindAStep, CheckGoesOn(PETSC_FALSE, PETSC_FALSE, 2));
TEST_IS(GoesOnBehindInflation, CheckGoesOn(PETSC_TRUE, PETSC_FALSE, 0));
TEST_IS(GoesOnBehindAStepOfAnInflatedBody, CheckGoesOn(PETSC_TRUE, PETSC_FALSE, 3));

TEST(SealedBodyGoesOn)
{
  CheckGoesOn(PETSC_FALSE, PETSC_TRUE, 1);
  CheckGoesOn(PETSC_TRUE, PETSC_TRUE, 0);
  CheckGoesOn(PETSC_TRUE, PETSC_TRUE, 2);
}

/* With unknowns beside the displacements, and nodes that touch. */
TEST(GoesOnWithLoads)
{
  AllLoads = PETSC_TRUE;
  CheckGoesOn(PETSC_FALSE, PETSC_FALSE, 2);
  AllLoads = PETSC_FALSE;
}
