/*
  Private to merging: appends records of several files to one file, each state once.
*/
#ifndef LAM_RECORD_UNION_H
#define LAM_RECORD_UNION_H

#include "record_internal.h"

/*
  Two records are of one state if they have the key of the same node, or if they are of a cache and have the same
  load, or otherwise the same key and load. The converged one of the two is kept, otherwise the first, at the position
  of the first. Records of a cache are renumbered from LAM_CACHE_KEY.
*/
typedef struct LamUnion_s *LamUnion;

/* `path`: a file created by LamFileCreate, without records; it stays open until LamUnionDestroy. scale: of its tissue. */
PetscErrorCode LamUnionCreate(const char path[], LamStressScale scale, LamUnion *records);
/* Appends the bytes of one record, whose checksum must be correct, of any version. Counts into `report`. */
PetscErrorCode LamUnionTake(LamUnion records, const LamRecordLayout *layout, const unsigned char *bytes,
                            LamMergeReport *report);
/* Writes and counts the remaining records; closes the file. */
PetscErrorCode LamUnionFinish(LamUnion records);
PetscErrorCode LamUnionDestroy(LamUnion *records);

#endif
