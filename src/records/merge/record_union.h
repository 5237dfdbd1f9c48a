/*
  Private to merging: a file that grows by records of other files, each state once.
*/
#ifndef LAM_RECORD_UNION_H
#define LAM_RECORD_UNION_H

#include "record_internal.h"

/*
  Two records are of one state where they have the key of the same node, or where they are of a cache and have the
  same load, or else the same key and load. Of two the one that has converged is kept, else the first; in the place of
  the first. Records of a cache get new keys, LAM_CACHE_KEY and on.
*/
typedef struct LamUnion_s *LamUnion;

/* `path`: a file that LamFileCreate has made, without records; it is open until LamUnionDestroy. */
PetscErrorCode LamUnionCreate(const char path[], LamUnion *records);
/* Takes the bytes of one record, whose checksum is right, of any version. Counts into `report`. */
PetscErrorCode LamUnionTake(LamUnion records, const LamRecordLayout *layout, const unsigned char *bytes,
                            LamMergeReport *report);
/* Writes and counts what is left; closes the file. */
PetscErrorCode LamUnionFinish(LamUnion records);
PetscErrorCode LamUnionDestroy(LamUnion *records);

#endif
