/*
  Functions shared by all studies: stop requests, reports, errors of rank 0.
*/
#ifndef LAM_STUDY_H
#define LAM_STUDY_H

#include <lamella/lamella.h>
#include <lamella/study.h>
#include "json.h"
#include "load.h"
#include "stop.h"

void LamReportNote(const LamReporter *reporter, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
void LamReportWarning(const LamReporter *reporter, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
/* The warnings of the scene, and of its turgor. On rank 0. */
void LamReportScene(const LamReporter *reporter, const LamScene *scene);
/* What is being done and counted by the progress that follows, such as "load steps"; kept for the process, whose line
   on the terminal it begins. */
void LamActivitySet(const char format[], ...) PETSC_ATTRIBUTE_FORMAT(1, 2);
const char *LamActivity(void);
PetscErrorCode LamReportProgress(const LamReporter *reporter, PetscInt64 done, PetscInt64 total, PetscInt64 failed);

PetscBool LamIsFirst(MPI_Comm comm); /* rank 0 */
/* Raises an error of rank 0 on all ranks; rank 0 has already reported it. Collective. */
PetscErrorCode LamShareError(MPI_Comm comm, PetscErrorCode ierr);
/* Broadcasts *bytes [*size] of rank 0, and with it its error as LamShareError; the other ranks get a copy that they
   free. Collective. */
PetscErrorCode LamShareBytes(MPI_Comm comm, PetscErrorCode ierr, size_t *size, void *bytes);
/* Largest memory of any rank, MB. Collective. */
PetscErrorCode LamPeakMemory(MPI_Comm comm, PetscReal *megabytes);

/* Refuses tissue whose response depends on its history (law `lamella`), of the file `path`. what: "a table", which has
   none; remedy: what may be done besides taking another law, or "". */
PetscErrorCode LamRefuseHistory(const char path[], const LamMicrostructure *micro, const char what[],
                                const char remedy[]);

/* PETSC_ERR_USER_INPUT, with the first line or the file that differs, unless the scene is the one with which the file
   `path` was begun: its text, and what it said of the files that it names (LamSceneDescribeFiles; NULL: nothing). */
PetscErrorCode LamCheckSameScene(const char path[], const char before[], const char files_before[],
                                 const LamScene *scene);
/* The same of an HDF5 file, which holds both. */
PetscErrorCode LamCheckSameSceneFile(const char path[], const LamScene *scene);

/* An RVE of the scene, whose mesh is chosen, set up; comm as for LamRVECreate. */
PetscErrorCode LamSceneRVECreate(MPI_Comm comm, const LamScene *scene, LamRVE *rve);
/* Makes room for one more item of `size` bytes in a list of `count`; items: address of the owned pointer. */
PetscErrorCode LamListGrow(PetscInt count, size_t size, PetscInt *capacity, void *items);
/* Writes dims[0] rows, times `factor`, as LamRecordWriterReals does; `values`: the first row, each `row_size` bytes
   behind the previous one. */
PetscErrorCode LamWriteRows(LamRecordWriter writer, const char name[], PetscInt rank, const PetscInt dims[],
                            const PetscReal values[], size_t row_size, PetscReal factor, const char unit[]);

#endif
