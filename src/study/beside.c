/*
  Text files beside an HDF5 file, replaced atomically: a reader never sees a partial file.
*/
#include "beside.h"
#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

PetscErrorCode LamBesideOpen(const char hdf5[], const LamTextKind *kind, LamBeside *file)
{
  PetscFunctionBeginUser;
  PetscCall(LamTargetBeside(hdf5, kind->ending, file->path));
  PetscCall(PetscSNPrintf(file->temporary, sizeof(file->temporary), "%s.tmp", file->path));
  file->out = fopen(file->temporary, "w");
  PetscCheck(file->out, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", file->temporary, strerror(errno));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBesideClose(LamBeside *file)
{
  int failed = ferror(file->out);

  PetscFunctionBeginUser;
  failed |= fclose(file->out);
  if (!failed) failed = rename(file->temporary, file->path);
  if (failed) unlink(file->temporary);
  PetscCheck(!failed, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: cannot write", file->path);
  PetscFunctionReturn(0);
}

void LamBesideNumber(FILE *out, PetscReal value)
{
  fputc(',', out);
  if (isfinite(value)) fprintf(out, "%.12g", (double)value);
}
