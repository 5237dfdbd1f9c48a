/*
  lamella: the program. Runs the command, reports errors, exits with the documented status.
*/
#include "app.h"

int main(int argc, char *argv[])
{
  int status = LAM_EXIT_OK;
  PetscErrorCode code = LamRuntimeBegin();

  if (!code) code = LamProgramRun(argc, argv, LamRuntimeStart, &status);
  LamRuntimeEnd(code, &status);
  return status;
}
