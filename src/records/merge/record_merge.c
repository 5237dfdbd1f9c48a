/*
  Merges databases.

  Method
    First all headers are read, so that incompatible files are found before anything is written. Then the records of
  each file are copied block by block to OUT.tmp (record_union.c), which is renamed to OUT when it is complete and
  synced. Salvage reads damaged files chunk by chunk and keeps the records with a correct checksum.
*/
#include "record_merge.h"
#include "target.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SHARDS_NAME "/merged" /* the files, one per line */

static PetscBool IsStopped(const LamMerge *m)
{
  if (!m->report->stopped && m->options->stop) m->report->stopped = m->options->stop();
  return m->report->stopped;
}

/* ---- records ---- */

/* Counts a record that has been read, sound or not. */
static PetscErrorCode Count(LamMerge *m)
{
  PetscFunctionBeginUser;
  if (++m->done % LAM_RECORDS_PER_REPORT == 0) PetscCall(LamMergeProgress(m));
  PetscFunctionReturn(0);
}

/* A LamRecordVisitor. */
static PetscErrorCode TakeRecord(void *ctx, const LamRecordLayout *layout, PetscInt number, const unsigned char *bytes,
                                 const char damage[])
{
  LamMerge *m = ctx;

  PetscFunctionBeginUser;
  if (IsStopped(m)) PetscFunctionReturn(0);
  PetscCall(Count(m));
  PetscCheck(m->grid_text || !LamKeyIsNode(LamRecordInt(bytes + layout->key)), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s is missing, though there are nodes of a grid", m->grid_from, LAM_GRID_NAME);
  PetscCall(LamUnionTake(m->records, layout, bytes, m->report));
  PetscFunctionReturn(0);
}

/* ---- salvage ---- */

enum { MOST_NAMED = 10 }; /* damaged records of a file that messages list */

typedef struct {
  LamMerge *merge;
  const char *path;
  PetscBool counted; /* the commit counter is sound: each record below it should be sound */
  PetscInt sound, damaged;
} Salvage;

/* A LamRecordVisitor. */
static PetscErrorCode TakeIfSound(void *ctx, const LamRecordLayout *layout, PetscInt number, const unsigned char *bytes,
                                  const char damage[])
{
  Salvage *s = ctx;

  PetscFunctionBeginUser;
  if (!damage) {
    PetscCall(TakeRecord(s->merge, layout, number, bytes, NULL));
    s->sound++;
    PetscFunctionReturn(0);
  }
  PetscCall(Count(s->merge));
  if (s->damaged++ < MOST_NAMED && s->counted) {
    LamMergeMessage(s->merge, "%s: record %" PetscInt_FMT " is damaged (%s) and left out", s->path, number, damage);
  }
  PetscFunctionReturn(0);
}

/* Without a counter all allocated records are read; those that are damaged may never have been committed. */
static PetscErrorCode TakeSound(LamMerge *m, const char path[], hid_t file)
{
  Salvage s = {.merge = m, .path = path};
  LamRecordScan scan;
  PetscErrorCode ierr;
  PetscInt count = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  s.counted = (PetscBool)!LamCommittedRead(path, file, &count);
  PetscCall(PetscPopErrorHandler());
  PetscCall(LamRecordScanOpen(path, file, &scan));
  if (!s.counted) count = LamRecordScanExtent(&scan, file);
  ierr = LamRecordScanAll(path, &scan, count, TakeIfSound, &s);
  PetscCall(LamRecordScanClose(path, &scan));
  PetscCall(ierr);
  if (s.counted && s.damaged)
    LamMergeMessage(m, "%s: %" PetscInt_FMT " records are sound, %" PetscInt_FMT " damaged", path, s.sound, s.damaged);
  if (!s.counted)
    LamMergeMessage(m, "%s: %" PetscInt_FMT " records are sound; its commit counter is damaged", path, s.sound);
  if (s.counted) m->report->left_out += s.damaged;
  PetscFunctionReturn(0);
}

/* ---- files ---- */

static PetscErrorCode TakeCommitted(LamMerge *m, const char path[], hid_t file)
{
  PetscInt committed;

  PetscFunctionBeginUser;
  PetscCall(LamCommittedRead(path, file, &committed));
  PetscCall(LamFileScanRecords(path, file, committed, TakeRecord, m));
  PetscFunctionReturn(0);
}

/* The file may have been replaced since its header was read. */
static PetscErrorCode TakeFile(const char path[], hid_t file, void *ctx)
{
  LamMerge *m = ctx;
  LamHeader header = {0};
  PetscBool matches;
  PetscErrorCode ierr = LamHeaderReadRoot(path, file, m->options->salvage ? &matches : NULL, &header);

  PetscFunctionBeginUser;
  if (!ierr) ierr = LamMergeCheckHash(m, path, &header);
  if (!ierr) ierr = m->options->salvage ? TakeSound(m, path, file) : TakeCommitted(m, path, file);
  PetscCall(LamHeaderDestroy(&header));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- the result ---- */

static PetscBool IsSameFile(const char a[], const char b[])
{
  struct stat one, other;

  return (PetscBool)(!stat(a, &one) && !stat(b, &other) && one.st_dev == other.st_dev && one.st_ino == other.st_ino);
}

static PetscErrorCode CheckTarget(const LamMerge *m)
{
  PetscBool among = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (access(m->out, F_OK)) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < m->n && !among; i++) among = IsSameFile(m->out, m->files[i]);
  PetscCheck(among, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists; give another file name, remove it, or give it among the files to merge as well", m->out);
  PetscFunctionReturn(0);
}

/* Reports sources that have a writer. Called with the lock of `out`. */
static void ReportWriters(const LamMerge *m)
{
  LamLockHolder holder;

  for (PetscInt i = 0; i < m->n; i++)
    if (!IsSameFile(m->out, m->files[i]) && LamLockGetHolder(m->files[i], &holder))
      LamMergeMessage(m, "%s: process %ld on %s is writing to it; what it has committed so far is merged", m->files[i],
                      holder.pid, holder.host);
}

/* The files, one per line. */
static PetscErrorCode ListFiles(const LamMerge *m, char **text)
{
  size_t length = 1, at = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->n; i++) length += strlen(m->files[i]) + 1;
  PetscCall(PetscCalloc1(length, text));
  for (PetscInt i = 0; i < m->n; i++) at += (size_t)snprintf(*text + at, length - at, "%s\n", m->files[i]);
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteTexts(const char path[], hid_t file, void *ctx)
{
  const LamMerge *m = ctx;
  PetscErrorCode ierr;
  char *list;

  PetscFunctionBeginUser;
  PetscCall(ListFiles(m, &list));
  ierr = LamFileWriteText(path, file, SHARDS_NAME, list);
  PetscCall(PetscFree(list));
  PetscCall(ierr);
  if (m->grid_text) PetscCall(LamFileWriteText(path, file, LAM_GRID_NAME, m->grid_text));
  PetscFunctionReturn(0);
}

static PetscErrorCode StartFile(LamMerge *m)
{
  size_t bytes = m->grid_text ? strlen(m->grid_text) : 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->n; i++) bytes += strlen(m->files[i]) + 1;
  PetscCall(LamFileCreate(m->temporary, "database", &m->scene));
  PetscCall(LamFileReserve(m->temporary, PETSC_FALSE, bytes));
  PetscCall(LamFileWrite(m->temporary, WriteTexts, m));
  PetscCall(LamUnionCreate(m->temporary, LamStressScaleOf(&m->scene.micro), &m->records));
  PetscFunctionReturn(0);
}

static PetscErrorCode MergeLocked(LamMerge *m)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(CheckTarget(m));
  PetscCall(LamMergeReadHeaders(m));
  ReportWriters(m);
  PetscCall(StartFile(m));
  for (PetscInt i = 0; i < m->n && !IsStopped(m); i++) {
    PetscCall(LamFileRead(m->files[i], TakeFile, m));
    PetscCall(LamMergeProgress(m));
  }
  if (m->report->stopped) PetscFunctionReturn(0);
  PetscCheck(m->report->records || !m->options->salvage, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: not one record is sound; build the database anew", m->files[0]);
  PetscCall(LamUnionFinish(m->records));
  LamLockBeginCommit(&m->lock);
  ierr = LamFilePublish(m->temporary, m->out);
  LamLockEndCommit(&m->lock);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(LamMerge *m)
{
  PetscFunctionBeginUser;
  PetscCall(LamUnionDestroy(&m->records));
  unlink(m->temporary);
  PetscCall(LamLockRelease(&m->lock));
  PetscCall(PetscFree(m->grid_text));
  PetscCall(PetscFree(m->scene.text));
  PetscCall(LamMicrostructureDestroy(&m->scene.micro));
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseMerge(const char out[], PetscInt n, const char *const files[], const LamMergeOptions *options,
                                LamMergeReport *report)
{
  LamMerge m = {.n = n, .files = files, .options = options, .report = report};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *report = (LamMergeReport){0};
  PetscCall(LamTargetFind(out, "database", LAM_WRITE_APPEND, m.out));
  snprintf(m.temporary, sizeof(m.temporary), "%.*s.tmp", PETSC_MAX_PATH_LEN - 8, m.out);
  PetscCall(LamLockTake(m.out, &m.lock));
  ierr = MergeLocked(&m);
  PetscCall(Destroy(&m));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
