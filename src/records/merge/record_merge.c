/*
  Merges databases.

  Method
    First all headers are read, so that incompatible files are found before anything is written. Then the records of
  each file are copied block by block to OUT.tmp (record_union.c), which is renamed to OUT when it is complete and
  synced. Salvage reads damaged files chunk by chunk and keeps the records with a correct checksum.
*/
#include "record_merge.h"
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

/* A LamRecordVisitor. */
static PetscErrorCode TakeBlock(void *ctx, const LamRecordLayout *layout, PetscInt first, PetscInt n,
                                const unsigned char *bytes)
{
  LamMerge *m = ctx;

  PetscFunctionBeginUser;
  (void)first;
  if (IsStopped(m)) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < n; i++, bytes += layout->size) {
    PetscCheck(m->grid_text || !LamKeyIsNode(LamRecordInt(bytes + layout->key)), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: holds nodes of a grid, but %s is missing; the file is damaged", m->grid_from, LAM_GRID_NAME);
    PetscCall(LamUnionTake(m->records, layout, bytes, m->report));
  }
  PetscFunctionReturn(0);
}

/* ---- salvage ---- */

enum { MOST_NAMED = 10 }; /* damaged records of a file that messages list */

typedef struct {
  LamMerge *merge;
  const char *path;
  LamRecordScan scan;
  PetscBool counted; /* the commit counter is sound: each record below it should be sound */
  PetscInt sound, damaged;
} Salvage;

/* A chunk that HDF5 cannot read is lost. */
static PetscErrorCode TakeSoundOfChunk(Salvage *s, PetscInt first, PetscInt n)
{
  const LamRecordLayout *layout = &s->scan.layout;
  PetscErrorCode unreadable;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  unreadable = LamRecordScanRead(s->path, &s->scan, first, n);
  PetscCall(PetscPopErrorHandler());
  for (PetscInt i = 0; i < n; i++) {
    const unsigned char *bytes = s->scan.bytes + (size_t)i * layout->size;
    const char *damage = unreadable ? "HDF5 cannot read it" : LamRecordDamage(layout, bytes);

    if (!damage) {
      PetscCall(TakeBlock(s->merge, layout, first + i, 1, bytes));
      s->sound++;
    } else if (s->damaged++ < MOST_NAMED && s->counted) {
      LamMergeTell(s->merge, "%s: record %" PetscInt_FMT " is damaged (%s) and left out", s->path, first + i, damage);
    }
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode TakeSoundChunks(Salvage *s, PetscInt count)
{
  const PetscInt chunk = LAM_RECORDS_PER_CHUNK;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < count && !IsStopped(s->merge); i += chunk)
    PetscCall(TakeSoundOfChunk(s, i, PetscMin(chunk, count - i)));
  if (s->counted && s->damaged)
    LamMergeTell(s->merge, "%s: %" PetscInt_FMT " records are sound, %" PetscInt_FMT " damaged", s->path, s->sound,
                 s->damaged);
  if (!s->counted)
    LamMergeTell(s->merge, "%s: %" PetscInt_FMT " records are sound; its commit counter is damaged", s->path, s->sound);
  if (s->counted) s->merge->report->left_out += s->damaged;
  PetscFunctionReturn(0);
}

/* Without a counter all allocated records are read; those that are damaged may never have been committed. */
static PetscErrorCode TakeSound(LamMerge *m, const char path[], hid_t file)
{
  Salvage s = {.merge = m, .path = path};
  PetscErrorCode ierr;
  PetscInt count = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  s.counted = (PetscBool)!LamCommittedRead(path, file, &count);
  PetscCall(PetscPopErrorHandler());
  PetscCall(LamRecordScanOpen(path, file, &s.scan));
  if (!s.counted) count = LamRecordScanExtent(&s.scan, file);
  ierr = TakeSoundChunks(&s, count);
  LamRecordScanClose(&s.scan);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- files ---- */

static PetscErrorCode TakeCommitted(LamMerge *m, const char path[], hid_t file)
{
  PetscInt committed;

  PetscFunctionBeginUser;
  PetscCall(LamCommittedRead(path, file, &committed));
  PetscCall(LamFileScanRecords(path, file, committed, TakeBlock, m));
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
  if (!ierr) ierr = LamMergeCheckHash(m, path, header.hash);
  if (!ierr) ierr = m->options->salvage ? TakeSound(m, path, file) : TakeCommitted(m, path, file);
  PetscCall(LamHeaderDestroy(&header));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- the result ---- */

static PetscErrorCode IsSameFile(const char a[], const char b[], PetscBool *same)
{
  struct stat one, other;

  PetscFunctionBeginUser;
  *same = (PetscBool)(!stat(a, &one) && !stat(b, &other) && one.st_dev == other.st_dev && one.st_ino == other.st_ino);
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckTarget(const LamMerge *m)
{
  PetscBool among = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (access(m->out, F_OK)) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < m->n && !among; i++) PetscCall(IsSameFile(m->out, m->files[i], &among));
  PetscCheck(among, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: exists; give another file name, remove it, or give it among the files to merge as well", m->out);
  PetscFunctionReturn(0);
}

/* Reports sources that have a writer. Called with the lock of `out`. */
static PetscErrorCode TellOfWriters(const LamMerge *m)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->n; i++) {
    LamLockHolder holder;
    PetscBool own;

    PetscCall(IsSameFile(m->out, m->files[i], &own));
    if (!own && LamLockGetHolder(m->files[i], &holder))
      LamMergeTell(m, "%s: process %ld on %s is writing to it; what it has committed so far is merged", m->files[i],
                   holder.pid, holder.host);
  }
  PetscFunctionReturn(0);
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
  size_t bytes = (m->grid_text ? strlen(m->grid_text) : 0) + (m->scene.text ? strlen(m->scene.text) : 0);

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->n; i++) bytes += strlen(m->files[i]) + 1;
  PetscCall(LamFileReserve(m->temporary, PETSC_TRUE, bytes));
  PetscCall(LamFileCreate(m->temporary, "database", &m->scene));
  PetscCall(LamFileReserve(m->temporary, PETSC_FALSE, bytes));
  PetscCall(LamFileWrite(m->temporary, WriteTexts, m));
  PetscCall(LamUnionCreate(m->temporary, &m->records));
  PetscFunctionReturn(0);
}

static PetscErrorCode Publish(LamMerge *m)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  LamLockBeginCommit(&m->lock);
  ierr = LamFilePublish(m->temporary, m->out);
  LamLockEndCommit(&m->lock);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode MergeLocked(LamMerge *m)
{
  PetscFunctionBeginUser;
  PetscCall(CheckTarget(m));
  PetscCall(LamMergeReadHeaders(m));
  PetscCall(TellOfWriters(m));
  PetscCall(StartFile(m));
  for (PetscInt i = 0; i < m->n && !IsStopped(m); i++) PetscCall(LamFileRead(m->files[i], TakeFile, m));
  if (m->report->stopped) PetscFunctionReturn(0);
  PetscCheck(m->report->records || !m->options->salvage, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: not one record is sound; build the database anew", m->files[0]);
  PetscCall(LamUnionFinish(m->records));
  PetscCall(Publish(m));
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
