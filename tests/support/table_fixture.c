#include "table_fixture.h"

/* Solves what the table lacks to answer `load`, until it does or nothing helps. */
static PetscErrorCode TableFixtureRefine(LamDatabase database, LamRecordWriter writer, const Synthetic *material,
                                         const LamLoad *load, PetscReal accuracy)
{
  PetscInt64 keys[LAM_MAX_NEEDS];
  PetscInt n = 1;

  PetscFunctionBeginUser;
  while (n) {
    LamTable table;
    LamGrid grid;

    PetscCall(LamDatabaseGetGrid(database, &grid));
    PetscCall(LamDatabaseGetTable(database, &table));
    PetscCall(LamTableNeeds(table, load, accuracy, &n, keys));
    PetscCall(LamTableDestroy(&table));
    for (PetscInt k = 0; k < n; k++) {
      LamResponse response;
      LamLoad node;

      PetscCall(LamGridNodeLoad(grid, keys[k], &node));
      PetscCall(LamResponseInit(&node, &response));
      SyntheticEvaluate(material, &node, &response);
      PetscCall(LamRecordWriterCommit(writer, 1, &keys[k], &response));
      PetscCall(LamDatabaseAdd(database, 1, &keys[k], &response));
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode TableFixtureWrite(const char path[], const LamScene *scene, const Synthetic *material, PetscInt n,
                                 const LamLoad loads[], PetscReal accuracy)
{
  LamRecordWriter writer;
  LamDatabase database;
  LamGrid grid;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamGridCreate(scene, NULL, &grid));
  PetscCall(LamGridGetText(grid, &text));
  PetscCall(LamRecordWriterOpen(path, "database", LAM_WRITE_CREATE, scene, &writer));
  PetscCall(LamRecordWriterText(writer, LAM_GRID_NAME, text));
  PetscCall(PetscFree(text));
  PetscCall(LamDatabaseCreateEmpty(scene, &database));
  PetscCall(LamDatabaseSetGrid(database, &grid));
  for (PetscInt i = 0; i < n; i++) PetscCall(TableFixtureRefine(database, writer, material, &loads[i], accuracy));
  PetscCall(LamRecordWriterClose(&writer));
  PetscCall(LamDatabaseClose(&database));
  PetscFunctionReturn(0);
}
