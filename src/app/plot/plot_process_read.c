/*
  Reads the data of the pictures of a process from its file.
*/
#include "plot_process.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

PetscErrorCode LamProcessPictureRead(const char path[], LamProcessPicture *p)
{
  const PetscInt64 *keys;

  PetscFunctionBeginUser;
  *p = (LamProcessPicture){.path = path};
  PetscCall(LamDatabaseOpen(path, &p->database));
  PetscCall(LamDatabaseGetRecords(p->database, &p->n, &p->records, &keys));
  PetscCall(LamDatabaseGetMicrostructure(p->database, &p->micro, &p->scales, NULL));
  PetscCheck(p->n > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no states", path);
  PetscCall(LamTimeLineRead(path, p->n, &p->line));
  PetscCall(LamTimeReadColumn(&p->line, "turgor", &p->turgor));
  PetscCall(LamTimeReadColumn(&p->line, "cohesion", &p->cohesion));
  PetscCall(LamTimeReadColumn(&p->line, "osmotic_pressure", &p->osmotic));
  PetscCall(LamTimeReadColumn(&p->line, "outside", &p->outside));
  PetscCall(LamTimeReadColumn(&p->line, "firmness", &p->firmness));
  PetscCall(LamTimeReadColumn(&p->line, "walls", &p->walls));
  PetscCall(LamTimeReadGroup(&p->line, "factor", LAM_CHANGING_COUNT, LamChangingNames, LamTimeVaries, &p->factor_count,
                             p->factor, p->factor_name));
  PetscCall(LamTimeReadGroup(&p->line, "ratio", LAM_RATIO_COUNT, LamRatioNames, LamTimeIsKnown, &p->ratio_count,
                             p->ratio, p->ratio_name));
  PetscFunctionReturn(0);
}

PetscErrorCode LamProcessPictureDestroy(LamProcessPicture *p)
{
  PetscFunctionBeginUser;
  PetscCall(LamTimeLineDestroy(&p->line));
  PetscCall(PetscFree(p->turgor));
  PetscCall(PetscFree(p->cohesion));
  PetscCall(PetscFree(p->osmotic));
  PetscCall(PetscFree(p->outside));
  PetscCall(PetscFree(p->firmness));
  PetscCall(PetscFree(p->walls));
  for (PetscInt k = 0; k < p->factor_count; k++) PetscCall(PetscFree(p->factor[k]));
  for (PetscInt k = 0; k < p->ratio_count; k++) PetscCall(PetscFree(p->ratio[k]));
  PetscCall(LamDatabaseClose(&p->database));
  PetscFunctionReturn(0);
}
