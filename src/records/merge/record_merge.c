/*
  One database of several.

  Method
    All headers first: files that do not belong together are found before anything is written. Then the records of each
    file, block by block, into OUT.tmp (record_union.c), which gets the name OUT when it is complete and on the disk.
    In salvage the records of all files are looked for in their bytes (record_salvage.c), and a file whose header cannot
    be read must tell its microstructure in another way: a damaged file of other tissue must not slip in.
*/
#include "record_merge.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SHARDS_NAME "/merged" /* the files, one a line */

void LamMergeTell(const LamMerge *m, const char format[], ...)
{
  char words[1024];
  va_list arguments;

  if (!m->options->tell) return;
  va_start(arguments, format);
  vsnprintf(words, sizeof(words), format, arguments);
  va_end(arguments);
  m->options->tell(words);
}

static PetscBool IsStopped(const LamMerge *m)
{
  if (!m->report->stopped && m->options->stop) m->report->stopped = m->options->stop();
  return m->report->stopped;
}

/* ---- records ---- */

/* A LamRecordVisitor */
static PetscErrorCode TakeBlock(void *ctx, const LamRecordLayout *layout, PetscInt first, PetscInt n,
                                const unsigned char *bytes)
{
  LamMerge *m = ctx;
  const PetscBool ours = (PetscBool)(layout->size == LamUnionLayout(m->records)->size);

  PetscFunctionBeginUser;
  (void)first;
  if (IsStopped(m)) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < n; i++, bytes += layout->size) {
    if (ours)
      PetscCall(LamUnionTake(m->records, bytes, m->report));
    else
      PetscCall(LamUnionConvert(m->records, layout, bytes, m->report));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ScanFile(LamMerge *m, const char path[], hid_t file)
{
  LamHeader header = {0};
  PetscErrorCode ierr = LamHeaderRead(path, file, &header);

  PetscFunctionBeginUser;
  if (!ierr) ierr = LamMergeCheckHash(m, path, header.hash); /* it may have been replaced meanwhile */
  if (!ierr) ierr = LamFileScanRecords(path, file, header.committed, TakeBlock, m);
  PetscCall(LamHeaderDestroy(&header));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode TakeFile(LamMerge *m, const char path[])
{
  hid_t file = H5I_INVALID_HID;
  PetscErrorCode ierr;
  int lock;

  PetscFunctionBeginUser;
  lock = LamLockBeginRead(path);
  ierr = LamFileOpenRead(path, &file);
  if (!ierr) ierr = ScanFile(m, path, file);
  if (file >= 0) H5Fclose(file);
  LamLockEndRead(lock);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- records of damaged files ---- */

/* Free cells' states stand farther apart than the place of their key says; their suction is that of it. */
static PetscErrorCode IsOfGrid(LamGrid grid, PetscInt64 key, const LamLoad *load, PetscBool *is)
{
  const PetscBool free_cell = LamKeyIsFreeCell(key);
  const PetscReal error = free_cell ? 1e-9 : 1e-12;
  LamLoad wanted;

  PetscFunctionBeginUser;
  PetscCall(LamGridNodeLoad(grid, key, &wanted));
  *is = (PetscBool)(fabs(load->turgor - wanted.turgor) <= error && fabs(load->cohesion - wanted.cohesion) <= error);
  for (int i = 0; i < 9 && !free_cell; i++)
    if (!(fabs(load->F[i] - wanted.F[i]) <= error)) *is = PETSC_FALSE;
  PetscFunctionReturn(0);
}

typedef struct {
  LamMerge *merge;
  LamGrid grid;       /* NULL: there is none, and no node of it */
  PetscBool unknown;  /* of what tissue: nothing is taken */
  PetscInt64 foreign; /* records of another grid, or that */
} Salvage;

/* A LamRecordVisitor */
static PetscErrorCode TakeSound(void *ctx, const LamRecordLayout *layout, PetscInt first, PetscInt n,
                                const unsigned char *bytes)
{
  Salvage *s = ctx;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++, bytes += layout->size) {
    const PetscInt64 key = LamRecordInt(bytes + layout->key);
    PetscBool good = (PetscBool)!s->unknown;
    LamResponse response;

    if (good && LamKeyIsNode(key)) {
      PetscCall(LamRecordUnpack(layout, bytes, &response));
      good = PETSC_FALSE;
      if (s->grid) PetscCall(IsOfGrid(s->grid, key, &response.load, &good));
    }
    if (good)
      PetscCall(TakeBlock(s->merge, layout, first, 1, bytes));
    else
      s->foreign++;
  }
  PetscFunctionReturn(0);
}

/* The counter tells of records that have gone without a trace. */
static PetscInt64 Lost(const LamSalvage *found, PetscInt64 committed)
{
  return PetscMax(found->damaged, committed - found->sound);
}

static void TellOfSalvage(LamMerge *m, const char path[], const LamSalvage *found, PetscInt64 committed,
                          const Salvage *salvage)
{
  const PetscInt64 lost = Lost(found, committed);

  for (PetscInt64 i = 0; i < PetscMin(found->damaged, LAM_SALVAGE_NAMED); i++)
    LamMergeTell(m, "%s: the record with key %lld at byte %lld is damaged and left out", path, (long long)found->key[i],
                 (long long)found->offset[i]);
  if (lost)
    LamMergeTell(m, "%s: %lld records are sound, %lld damaged or lost", path, (long long)found->sound, (long long)lost);
  if (committed < 0)
    LamMergeTell(m, "%s: %lld records are sound; how many it held cannot be made out any more", path,
                 (long long)found->sound);
  if (salvage->foreign && !salvage->unknown)
    LamMergeTell(m, "%s: %lld records are left out, they are not of the grid %s", path, (long long)salvage->foreign,
                 m->grid_text ? m->grid_text : "(there is none)");
  m->report->left_out += lost + salvage->foreign;
}

static PetscErrorCode TakeRest(LamMerge *m, LamGrid grid, PetscInt i)
{
  Salvage salvage = {.merge = m, .grid = grid, .unknown = (PetscBool)(m->state[i] == LAM_FILE_UNKNOWN)};
  const char *path = m->files[i];
  LamRemains remains;
  LamSalvage found;
  PetscInt64 committed;

  PetscFunctionBeginUser;
  PetscCall(LamRemainsFind(path, m->hash, &remains));
  committed = remains.committed;
  PetscCall(LamRemainsDestroy(&remains));
  PetscCall(LamFileSalvage(path, TakeSound, &salvage, &found));
  TellOfSalvage(m, path, &found, committed, &salvage);
  PetscFunctionReturn(0);
}

static PetscErrorCode SalvageFiles(LamMerge *m)
{
  PetscErrorCode ierr = 0;
  LamGrid grid = NULL;

  PetscFunctionBeginUser;
  if (m->grid_text) PetscCall(LamGridFromText(m->header_from, &m->scene.micro, m->grid_text, &grid));
  for (PetscInt i = 0; i < m->n && !ierr && !IsStopped(m); i++) ierr = TakeRest(m, grid, i);
  PetscCall(LamGridDestroy(&grid));
  PetscCall(ierr);
  if (m->report->records || m->report->stopped || m->options->scene) PetscFunctionReturn(0); /* or begin afresh */
  PetscCheck(m->grid_text, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: its grid cannot be made out any more, nor is there a sound record of no grid; merge it with a sound "
             "database of the same build, or use build --resume --salvage with its scene",
             m->files[0]);
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: not one sound record was found; build the database anew",
          m->files[0]);
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

/* The lock of `out` is ours. */
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

/* The files, one a line. */
static PetscErrorCode ListFiles(const LamMerge *m, char **text)
{
  size_t length = 1, at = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->n; i++) length += strlen(m->files[i]) + 1;
  PetscCall(PetscCalloc1(length, text));
  for (PetscInt i = 0; i < m->n; i++) at += (size_t)snprintf(*text + at, length - at, "%s\n", m->files[i]);
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteTexts(const LamMerge *m, const char list[])
{
  PetscErrorCode ierr;
  hid_t file;

  PetscFunctionBeginUser;
  PetscCall(LamFileOpenWrite(m->temporary, &file));
  ierr = LamFileWriteText(m->temporary, file, SHARDS_NAME, list);
  if (!ierr && m->grid_text) ierr = LamFileWriteText(m->temporary, file, LAM_GRID_NAME, m->grid_text);
  if (ierr) H5Fclose(file);
  PetscCall(ierr);
  PetscCall(LamFileClose(m->temporary, file));
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeFile(const LamMerge *m, const char list[])
{
  const size_t bytes =
      strlen(list) + (m->grid_text ? strlen(m->grid_text) : 0) + (m->scene.text ? strlen(m->scene.text) : 0);

  PetscFunctionBeginUser;
  PetscCall(LamFileReserve(m->temporary, PETSC_TRUE, bytes));
  PetscCall(LamFileCreate(m->temporary, "database", &m->scene));
  PetscCall(LamFileReserve(m->temporary, PETSC_FALSE, bytes));
  PetscCall(WriteTexts(m, list));
  PetscFunctionReturn(0);
}

static PetscErrorCode StartFile(LamMerge *m)
{
  PetscErrorCode ierr;
  char *list;

  PetscFunctionBeginUser;
  PetscCall(ListFiles(m, &list));
  ierr = MakeFile(m, list);
  PetscCall(PetscFree(list));
  PetscCall(ierr);
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
  if (m->options->salvage)
    PetscCall(SalvageFiles(m));
  else
    for (PetscInt i = 0; i < m->n && !IsStopped(m); i++) PetscCall(TakeFile(m, m->files[i]));
  if (m->report->stopped) PetscFunctionReturn(0);
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
  PetscCall(PetscFree(m->state));
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
