/*
  Files that can be queried.
*/
#include "query_source.h"
#include <string.h>

static PetscErrorCode CheckKind(const char path[])
{
  char kind[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(LamFileReadKind(path, kind));
  PetscCheck(!strcmp(kind, "database") || !strcmp(kind, "rve"), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: is of kind \"%s\"; a response database is wanted, as lamella build writes it", path, kind);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadScene(const char path[], LamScene **scene)
{
  PetscBool found;
  char *text;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadText(path, "/scene", &found, &text));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: its scene is missing; the file is damaged", path);
  ierr = LamSceneReadText(path, text, scene);
  PetscCall(PetscFree(text));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* Uses turgor and cohesion of the records if all have the same. */
static PetscErrorCode UseCommonLoads(LamQuerySource *a)
{
  const LamResponse *records;
  PetscBool same_turgor, same_cohesion;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetRecords(a->database, &n, &records, NULL));
  same_turgor = same_cohesion = (PetscBool)(n > 0);
  for (PetscInt i = 1; i < n; i++) {
    if (records[i].load.turgor != records[0].load.turgor) same_turgor = PETSC_FALSE;
    if (records[i].load.cohesion != records[0].load.cohesion) same_cohesion = PETSC_FALSE;
  }
  if (same_turgor) {
    a->turgor = records[0].load.turgor;
    a->turgor_origin = "that of all records";
  }
  if (same_cohesion) {
    a->cohesion = records[0].load.cohesion;
    a->cohesion_origin = "that of all records";
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Open(const char path[], LamQuerySource *a)
{
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseOpen(path, &a->database));
  PetscCall(LamDatabaseGetMicrostructure(a->database, &a->micro, &a->scales, NULL));
  PetscCheck(
      !a->micro.is_patch, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
      "%s: holds states of a patch between grips, a body whose response is its own and no material point's; take "
      "a file of periodic cells (rve.cells), or solve the patch with lamella rve",
      path);
  PetscCall(LamRefuseHistory(path, &a->micro, "a table", ""));
  PetscCall(ReadScene(path, &a->scene));
  PetscCheck(!a->scene->sealed, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds states of sealed cells, whose pressure depends on their water; take a file of prescribed "
             "turgor (rve.turgor.mode: prescribed)",
             path);
  a->accuracy = a->scene->accuracy;
  a->turgor = a->scene->turgor;
  a->cohesion = a->scene->cohesion;
  a->turgor_origin = a->cohesion_origin = "the scene's";
  PetscCall(LamDatabaseGetGrid(a->database, &grid));
  if (!grid) PetscCall(UseCommonLoads(a));
  PetscFunctionReturn(0);
}

PetscErrorCode LamQuerySourceOpen(const char path[], LamQuerySource *answers)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *answers = (LamQuerySource){0};
  PetscCall(CheckKind(path));
  ierr = Open(path, answers);
  if (ierr) (void)LamQuerySourceClose(answers);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamQuerySourceClose(LamQuerySource *answers)
{
  PetscFunctionBeginUser;
  PetscCall(LamDatabaseClose(&answers->database));
  PetscCall(LamSceneDestroy(&answers->scene));
  PetscFunctionReturn(0);
}
