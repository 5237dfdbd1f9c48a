/* Databases that someone has changed: opened, described, checked, asked, merged and salvaged as the commands do it.
   Each is answered or refused in words, and leaves neither memory nor anything of HDF5 open. */
#include "hdf5_edits.h"
#include <hdf5.h>
#include <lamella/database.h>
#include <stdio.h>
#include <unistd.h>

#define FILE_NAME "database.h5"
#define MERGED_NAME "merged.h5"

static PetscErrorCode QueryAll(LamDatabase database)
{
  const PetscReal shears[] = {0, 0.01, 0.1, 0.2};

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(shears); i++) {
    const LamLoad load = {
        .F = {1.01, shears[i], 0, 0, 1.02, 0, 0, 0, 1}, .turgor = 0.02 / 0.11, .cohesion = 0.001 / 0.11};
    LamResponse response;

    PetscCall(LamDatabaseQuery(database, &load, i % 2 ? 0.01 : PETSC_INFINITY, &response));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Use(LamDatabase database, int question)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  const char *info;
  PetscInt n;

  PetscFunctionBeginUser;
  if (question % 3 == 0) PetscCall(LamDatabaseGetInfo(database, &info));
  if (question % 3 == 1) PetscCall(QueryAll(database));
  if (question % 3 == 2) PetscCall(LamDatabaseGetRecords(database, &n, &records, &keys));
  PetscFunctionReturn(0);
}

static PetscErrorCode Open(int question)
{
  LamDatabase database;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseOpen(FILE_NAME, &database));
  ierr = Use(database, question);
  PetscCall(LamDatabaseClose(&database));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode Check(void)
{
  PetscBool sound;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamFileCheck(FILE_NAME, NULL, &sound, &text));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

static PetscErrorCode Merge(PetscBool salvage)
{
  const LamMergeOptions options = {.salvage = salvage};
  const char *const files[] = {FILE_NAME};
  LamMergeReport report;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseMerge(MERGED_NAME, 1, files, &options, &report));
  PetscFunctionReturn(0);
}

/* Merging syncs files and is slow; most questions are those of opening. */
static PetscErrorCode Answer(int question)
{
  PetscFunctionBeginUser;
  if (question < 90)
    PetscCall(Open(question));
  else if (question < 116)
    PetscCall(Check());
  else
    PetscCall(Merge((PetscBool)(question % 2)));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(const uint8_t *data, size_t size)
{
  PetscErrorCode code;
  int file, question;

  FuzzEnterFolder();
  question = EditsMakeFile(data, size, FILE_NAME, &file);
  code = Answer(question);
  EditsReleaseFile();
  unlink(MERGED_NAME);
  FuzzLeaveFolder();
  return code;
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
  static const char *const names[] = {"table", "contact-table", "rve", "contact"};

  FuzzStart(argc, argv);
  FuzzCountMemory();
  EditsLoadFiles(PETSC_STATIC_ARRAY_LENGTH(names), names);
  FuzzCheck(!Run((const uint8_t *)"", 0), "a sound file is not read: %s", FuzzMessage());
  return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  const hsize_t open = EditsCountOpen();
  const PetscErrorCode code = Run(data, size);

  FuzzCheck(!code || (code == PETSC_ERR_USER_INPUT && FuzzMessage()[0]), "error %d: %s", code, FuzzMessage());
  FuzzCheck(!FuzzMemoryLeft(), "%zu bytes are left", FuzzMemoryLeft());
  FuzzCheck(EditsCountOpen() == open, "%d objects of HDF5 are left", (int)(EditsCountOpen() - open));
  EditsEndInput();
  return 0;
}
