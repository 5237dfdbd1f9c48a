/*
  Functions shared by all studies.
*/
#include "study.h"
#include "turgor_stretch.h"
#include <stdarg.h>
#include <stdio.h>
#include <sys/resource.h>

const char *const LamFE2ResponseNames[] = {"direct", "cache", "database"};

enum { MOST_CHARACTERS = 1024 };

static void Report(const LamReporter *reporter, PetscBool warning, const char format[], va_list values)
{
  char text[MOST_CHARACTERS];

  if (!reporter || !reporter->message) return;
  vsnprintf(text, sizeof(text), format, values);
  reporter->message(reporter->ctx, warning, text);
}

void LamReportNote(const LamReporter *reporter, const char format[], ...)
{
  va_list values;

  va_start(values, format);
  Report(reporter, PETSC_FALSE, format, values);
  va_end(values);
}

void LamReportWarning(const LamReporter *reporter, const char format[], ...)
{
  va_list values;

  va_start(values, format);
  Report(reporter, PETSC_TRUE, format, values);
  va_end(values);
}

void LamReportScene(const LamReporter *reporter, const LamScene *scene)
{
  for (PetscInt k = 0; k < scene->warning_count; k++) LamReportWarning(reporter, "%s", scene->warnings[k]);
  LamWarnOfTurgor(reporter, scene);
}

PetscErrorCode LamRefuseHistory(const char path[], const LamMicrostructure *micro, const char what[],
                                const char remedy[])
{
  PetscFunctionBeginUser;
  PetscCheck(
      micro->interface != LAM_INTERFACE_LAMELLA, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
      "%s: rve.interface.law: lamella: its responses depend on history, which %s does not have; write law: bonded "
      "or contact%s",
      path, what, remedy);
  PetscCheck(!LamWallsRelax(micro), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.wall.relaxation: responses of walls with memory depend on time, which %s does not have; leave it "
             "out%s",
             path, what, remedy);
  PetscFunctionReturn(0);
}

static char Activity[128];

void LamActivitySet(const char format[], ...)
{
  va_list values;

  va_start(values, format);
  vsnprintf(Activity, sizeof(Activity), format, values);
  va_end(values);
}

const char *LamActivity(void)
{
  return Activity;
}

PetscErrorCode LamReportProgress(const LamReporter *reporter, PetscInt64 done, PetscInt64 total, PetscInt64 failed)
{
  PetscFunctionBeginUser;
  if (reporter && reporter->progress) PetscCall(reporter->progress(reporter->ctx, done, total, failed));
  PetscFunctionReturn(0);
}

PetscBool LamIsFirst(MPI_Comm comm)
{
  PetscMPIInt rank = 0;

  MPI_Comm_rank(comm, &rank);
  return (PetscBool)(rank == 0);
}

PetscErrorCode LamShareError(MPI_Comm comm, PetscErrorCode ierr)
{
  int code = (int)ierr;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&code, 1, MPI_INT, 0, comm));
  /* no SETERRQ: the message was stored where the error was raised */
  PetscFunctionReturn((PetscErrorCode)code);
}

PetscErrorCode LamShareBytes(MPI_Comm comm, PetscErrorCode ierr, size_t *size, void *bytes)
{
  PetscMPIInt count = 0;

  PetscFunctionBeginUser;
  PetscCall(LamShareError(comm, ierr));
  if (LamIsFirst(comm)) PetscCall(PetscMPIIntCast((PetscInt)*size, &count));
  PetscCallMPI(MPI_Bcast(&count, 1, MPI_INT, 0, comm));
  *size = (size_t)count;
  if (!LamIsFirst(comm)) PetscCall(PetscMalloc(*size, (void **)bytes));
  PetscCallMPI(MPI_Bcast(*(void **)bytes, count, MPI_BYTE, 0, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPeakMemory(MPI_Comm comm, PetscReal *megabytes)
{
  struct rusage usage;

  PetscFunctionBeginUser;
  getrusage(RUSAGE_SELF, &usage);
  *megabytes = (PetscReal)usage.ru_maxrss / 1024; /* Linux reports kilobytes */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, megabytes, 1, MPIU_REAL, MPIU_MAX, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneRVECreate(MPI_Comm comm, const LamScene *scene, LamRVE *rve)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVECreate(comm, rve));
  PetscCall(LamRVESetMicrostructure(*rve, &scene->micro));
  PetscCall(LamRVESetStrategy(*rve, scene->strategy));
  PetscCall(LamRVESetTolerance(*rve, scene->tolerance));
  PetscCall(LamRVESetOutOfPlane(*rve, scene->out_of_plane));
  PetscCall(LamRVESetUp(*rve));
  PetscFunctionReturn(0);
}

PetscErrorCode LamListGrow(PetscInt count, size_t size, PetscInt *capacity, void *items)
{
  PetscFunctionBeginUser;
  if (count < *capacity) PetscFunctionReturn(0);
  *capacity = PetscMax(64, 2 * count);
  PetscCall(PetscRealloc((size_t)*capacity * size, (void **)items));
  PetscFunctionReturn(0);
}

PetscErrorCode LamWriteRows(LamRecordWriter writer, const char name[], PetscInt rank, const PetscInt dims[],
                            const PetscReal values[], size_t row_size, PetscReal factor, const char unit[])
{
  PetscInt columns = 1;
  PetscErrorCode ierr;
  PetscReal *scaled;

  PetscFunctionBeginUser;
  for (PetscInt d = 1; d < rank; d++) columns *= dims[d];
  PetscCall(PetscMalloc1(dims[0] * columns, &scaled));
  for (PetscInt r = 0; r < dims[0]; r++) {
    const PetscReal *row = (const PetscReal *)((const char *)values + (size_t)r * row_size);

    for (PetscInt c = 0; c < columns; c++) scaled[r * columns + c] = row[c] * factor;
  }
  ierr = LamRecordWriterReals(writer, name, rank, dims, scaled, unit);
  PetscCall(PetscFree(scaled));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
