/*
  Answers of a database: from its table, else from the records that belong to no grid.
*/
#include "database_internal.h"
#include <math.h>
#include <lamella/clock.h>
#include <stdio.h>

PetscBool LamQuestionIsGood(const LamLoad *load, LamResponse *r)
{
  const PetscReal *F = load->F;
  PetscReal sum = load->turgor + load->cohesion, J;

  for (int i = 0; i < 9; i++) sum += F[i];
  J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
  if (!isfinite(sum) || !(J > 0)) {
    r->status = LAM_INVALID_F;
    snprintf(r->reason, sizeof(r->reason), "det F = %g; a deformation gradient needs det F > 0", (double)J);
    return PETSC_FALSE;
  }
  if (!LamPlaneStrain(F)) {
    r->status = LAM_OUT_OF_REACH;
    snprintf(r->reason, sizeof(r->reason),
             "the records are of plane strain; F33 must be 1 and the out-of-plane shears 0");
    return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscErrorCode AskScattered(LamDatabase database, const LamLoad *load, PetscReal radius, PetscReal accuracy,
                                   LamResponse *response)
{
  const PetscReal start = LamClock();

  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->source = LAM_SOURCE_DATABASE;
  if (LamQuestionIsGood(load, response)) PetscCall(LamScatterQuery(database, load, radius, accuracy, response));
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
