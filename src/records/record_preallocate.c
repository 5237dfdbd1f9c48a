/*
  Preallocation of records.

  Method
    HDF5 changes its chunk index and the end of the file in several writes, between which the file is not readable. A
  file that has its name is therefore never extended: a copy is extended, synced and renamed. A commit then only
  overwrites allocated bytes, which cannot damage committed records. Each time the space grows by half: all copies of a
  growing file amount to three times its size.
*/
#include "record_internal.h"
#include <unistd.h>

/* ---- in the file itself ---- */

typedef struct {
  PetscInt before, wanted;
} Range;

/* HDF5 allocates and fills a chunk when its first record is written. */
static PetscErrorCode Extend(const char path[], hid_t file, void *ctx)
{
  const Range *r = ctx;
  const hsize_t extent = (hsize_t)r->wanted, chunk = LAM_RECORDS_PER_CHUNK;
  const hsize_t first = ((hsize_t)r->before + chunk - 1) / chunk * chunk; /* earlier chunks exist */
  hid_t dataset, type;
  char *zeros;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, dataset = H5Dopen2(file, "/records", H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dset_extent(dataset, &extent));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, type = H5Dget_type(dataset));
  PetscCall(PetscCalloc1(H5Tget_size(type), &zeros));
  for (hsize_t i = first; i < extent; i += chunk)
    PetscCall(LamRowsTransfer(path, dataset, type, PETSC_TRUE, i, 1, zeros));
  PetscCall(PetscFree(zeros));
  PetscCall(LamCloseHDF5(path, type, dataset));
  PetscFunctionReturn(0);
}

static PetscErrorCode ExtendFile(const char path[], PetscInt before, PetscInt wanted)
{
  Range range = {before, wanted};

  PetscFunctionBeginUser;
  PetscCall(LamFileReserve(path, PETSC_FALSE, (size_t)(wanted - before + LAM_RECORDS_PER_CHUNK) * LAM_RECORD_BYTES));
  PetscCall(LamFileWrite(path, Extend, &range));
  PetscFunctionReturn(0);
}

/* ---- in a copy ---- */

static PetscErrorCode ExtendCopy(const char path[], const char temporary[], PetscInt before, PetscInt wanted)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = LamFileCopy(path, temporary);
  if (!ierr) ierr = ExtendFile(temporary, before, wanted);
  if (!ierr) ierr = LamFilePublish(temporary, path);
  if (ierr) unlink(temporary);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFilePreallocate(const char path[], const char temporary[], PetscInt records, PetscInt *extent)
{
  const PetscInt chunk = LAM_RECORDS_PER_CHUNK, before = *extent;
  PetscInt wanted;

  PetscFunctionBeginUser;
  if (records <= before) PetscFunctionReturn(0);
  wanted = (PetscMax(records, before + before / 2) + chunk - 1) / chunk * chunk;
  if (path)
    PetscCall(ExtendCopy(path, temporary, before, wanted));
  else
    PetscCall(ExtendFile(temporary, before, wanted));
  *extent = wanted;
  PetscFunctionReturn(0);
}
