/*
  Queries to a database: to its table, else to the records outside the grid.
*/
#include "database_internal.h"
#include <math.h>
#include "clock.h"
#include <stdio.h>

static PetscErrorCode QueryScattered(LamDatabase database, const LamLoad *load, PetscReal radius, PetscReal accuracy,
                                     LamResponse *response)
{
  const PetscReal start = LamClock();

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->source = LAM_SOURCE_DATABASE;
  if (LamLoadValidateInPlane(load, response)) PetscCall(LamScatterQuery(database, load, radius, accuracy, response));
  response->seconds = LamClock() - start;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseQuery(LamDatabase database, const LamLoad *load, PetscReal accuracy, LamResponse *response)
{
  LamResponse scattered;
  LamTable table;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetTable(database, &table));
  if (!table) {
    PetscCall(QueryScattered(database, load, LAM_TRUST_RADIUS, accuracy, response));
    PetscFunctionReturn(0);
  }
  PetscCall(LamTableQuery(table, load, accuracy, response));
  PetscCall(LamTableDestroy(&table));
  if (response->status != LAM_OUT_OF_REACH || !database->scatter.n) PetscFunctionReturn(0);
  /* with a table, scattered records are states that it did not cover: each is used for its own state only */
  PetscCall(QueryScattered(database, load, 0, accuracy, &scattered));
  if (LamResponseHasFields(&scattered)) *response = scattered; /* else keep the table's reason */
  PetscFunctionReturn(0);
}
