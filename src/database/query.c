/*
  Answers of a database: from its table, else from the records that belong to no grid.
*/
#include "database_internal.h"
#include <math.h>
#include "clock.h"
#include <stdio.h>

static PetscErrorCode AskScattered(LamDatabase database, const LamLoad *load, PetscReal radius, PetscReal accuracy,
                                   LamResponse *response)
{
  const PetscReal start = LamClock();

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->source = LAM_SOURCE_DATABASE;
  if (LamLoadValidate(load, response)) PetscCall(LamScatterQuery(database, load, radius, accuracy, response));
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
    PetscCall(AskScattered(database, load, LAM_TRUST_RADIUS, accuracy, response));
    PetscFunctionReturn(0);
  }
  PetscCall(LamTableQuery(table, load, accuracy, response));
  PetscCall(LamTableDestroy(&table));
  if (response->status != LAM_OUT_OF_REACH || !database->scatter.n) PetscFunctionReturn(0);
  /* beside a table they are states that it could not answer: each is trusted for itself alone */
  PetscCall(AskScattered(database, load, 0, accuracy, &scattered));
  if (LamResponseHasFields(&scattered)) *response = scattered; /* else the table's reason stands */
  PetscFunctionReturn(0);
}
