/*
  Private to merging: a merge in progress, and the properties of its result.
*/
#ifndef LAM_RECORD_MERGE_H
#define LAM_RECORD_MERGE_H

#include "record_union.h"

typedef struct {
  char out[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  PetscInt n;
  const char *const *files;       /* [n] borrowed */
  const LamMergeOptions *options; /* borrowed */
  LamMergeReport *report;         /* borrowed */
  LamLock lock;
  LamUnion records;
  PetscInt64 done, total; /* records that have been read, that there are */
  /* properties of the result, and the files from which they come */
  const char *header_from, *grid_from;
  LamScene scene; /* micro, scales, accuracy and text; micro and text owned */
  char hash[LAM_HASH_LENGTH];
  char *grid_text; /* owned; NULL: none */
} LamMerge;

/* A message for the user; as printf, without a newline. */
void LamMergeMessage(const LamMerge *merge, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
/* Reports how many records have been read. */
PetscErrorCode LamMergeProgress(const LamMerge *merge);
/* Reads the headers of all files, and checks their compatibility. */
PetscErrorCode LamMergeReadHeaders(LamMerge *merge);
PetscErrorCode LamMergeCheckHash(const LamMerge *merge, const char path[], const LamHeader *header);

#endif
