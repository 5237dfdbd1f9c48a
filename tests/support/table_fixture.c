#include "table_fixture.h"

PetscErrorCode RefineTable(LamDatabase database, LamResponder solver, const LamLoad *load, PetscReal accuracy)
{
  PetscInt64 keys[LAM_MAX_NEEDS];
  LamResponse nodes[LAM_MAX_NEEDS];
  const PetscInt no_point = -1;
  PetscInt n = 1;

  PetscFunctionBeginUser;
  while (n) {
    LamTable table;
    LamGrid grid;

    PetscCall(LamDatabaseGetGrid(database, &grid));
    PetscCall(LamDatabaseGetTable(database, &table));
    PetscCall(LamTableNeeds(table, load, accuracy, NULL, &n, keys));
    PetscCall(LamTableDestroy(&table));
    for (PetscInt k = 0; k < n; k++) {
      LamLoad node;

      PetscCall(LamGridNodeLoad(grid, keys[k], &node));
      PetscCall(LamResponderRespond(solver, 1, &node, &no_point, &nodes[k]));
    }
    PetscCall(LamDatabaseAdd(database, n, keys, nodes));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode TableFixtureWrite(const char path[], const LamScene *scene, const Synthetic *material, PetscInt n,
                                 const LamLoad loads[], PetscReal accuracy)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  LamRecordWriter writer;
  LamResponder solver;
  LamDatabase database;
  Synthetic *made;
  LamGrid grid;
  PetscInt count;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamGridCreate(scene, NULL, &grid));
  PetscCall(LamGridGetText(grid, &text));
  PetscCall(LamRecordWriterOpen(path, "database", LAM_WRITE_CREATE, scene, &writer));
  PetscCall(LamRecordWriterText(writer, LAM_GRID_NAME, text));
  PetscCall(PetscFree(text));
  PetscCall(LamDatabaseCreateEmpty(scene, &database));
  PetscCall(LamDatabaseSetGrid(database, &grid));
  PetscCall(SyntheticCreate(0, &solver, &made));
  made->mu = material->mu;
  made->lambda = material->lambda;
  made->phi = material->phi;
  for (PetscInt i = 0; i < n; i++) PetscCall(RefineTable(database, solver, &loads[i], accuracy));
  PetscCall(LamResponderDestroy(&solver));
  PetscCall(LamDatabaseGetRecords(database, &count, &records, &keys));
  PetscCall(LamRecordWriterCommit(writer, count, keys, records));
  PetscCall(LamRecordWriterClose(&writer));
  PetscCall(LamDatabaseClose(&database));
  PetscFunctionReturn(0);
}
