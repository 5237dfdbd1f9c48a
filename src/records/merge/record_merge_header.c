/*
  The header of a merged database, from the headers of its sources.
*/
#include "record_merge.h"
#include "microstructure_compare.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void LamMergeMessage(const LamMerge *m, const char format[], ...)
{
  char words[1024];
  va_list arguments;

  if (!m->options->reporter.message) return;
  va_start(arguments, format);
  vsnprintf(words, sizeof(words), format, arguments);
  va_end(arguments);
  m->options->reporter.message(m->options->reporter.ctx, PETSC_FALSE, words);
}

PetscErrorCode LamMergeProgress(const LamMerge *m)
{
  const LamReporter *reporter = &m->options->reporter;

  PetscFunctionBeginUser;
  if (reporter->progress) PetscCall(reporter->progress(reporter->ctx, m->done, m->total, 0));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMergeCheckHash(const LamMerge *m, const char path[], const LamHeader *header)
{
  const PetscBool same = (PetscBool)!strcmp(m->hash, header->hash);
  char difference[LAM_DIFFERENCE_LENGTH] = "";

  PetscFunctionBeginUser;
  if (!same) PetscCall(LamMicrostructureCompare(&header->micro, &m->scene.micro, m->header_from, difference));
  PetscCheck(same, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds another microstructure than %s: %s; only databases of one microstructure are merged", path,
             m->header_from, difference);
  PetscFunctionReturn(0);
}

/* `text` NULL: the file has no grid. */
static PetscErrorCode CheckGrid(LamMerge *m, const char path[], const char text[])
{
  const PetscBool same = (PetscBool)(m->grid_text && text ? !strcmp(m->grid_text, text) : !m->grid_text && !text);

  PetscFunctionBeginUser;
  if (!m->grid_from) {
    m->grid_from = path;
    if (text) PetscCall(PetscStrallocpy(text, &m->grid_text));
    PetscFunctionReturn(0);
  }
  PetscCheck(same, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s and %s: have different grids (%s); only databases of one grid are merged, such as those of one scene",
             m->grid_from, path, LAM_GRID_NAME);
  PetscFunctionReturn(0);
}

/* Conversion would lose members of a later version. *extent: the number of allocated records. */
static PetscErrorCode CheckMembers(const char path[], hid_t file, PetscInt *extent)
{
  PetscBool known = PETSC_TRUE;
  char name[LAM_NAME_LENGTH];
  LamRecordScan scan;
  hid_t ours;

  PetscFunctionBeginUser;
  PetscCall(LamRecordScanOpen(path, file, &scan));
  PetscCall(LamRecordTypeCreate(&ours));
  for (int i = 0; known && i < H5Tget_nmembers(scan.type); i++) {
    char *member = H5Tget_member_name(scan.type, (unsigned)i);

    known = (PetscBool)(H5Tget_member_index(ours, member) >= 0);
    snprintf(name, sizeof(name), "%s", member);
    H5free_memory(member);
  }
  *extent = LamRecordScanExtent(&scan, file);
  PetscCall(LamRecordScanClose(path, &scan));
  PetscCall(LamCloseHDF5(path, ours));
  PetscCheck(known, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: its records have a member \"%s\" that this lamella does not know; merge with the version that "
             "wrote it",
             path, name);
  PetscFunctionReturn(0);
}

typedef struct {
  LamHeader header;
  PetscBool salvage;
  PetscBool matches;  /* the header's checksum is correct */
  PetscInt records;   /* that will be read; in salvage at most */
  char *grid, *scene; /* NULL: none */
} Source;

/* In salvage the header's checksum and the scene's text may be damaged: the description of the tissue has its own
   hash. */
static PetscErrorCode ReadSource(const char path[], hid_t file, void *ctx)
{
  Source *s = ctx;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  s->matches = PETSC_TRUE;
  PetscCall(LamHeaderReadRoot(path, file, s->salvage ? &s->matches : NULL, &s->header));
  PetscCall(CheckMembers(path, file, &s->records));
  if (!s->salvage) PetscCall(LamCommittedRead(path, file, &s->records));
  PetscCall(LamFileGetText(path, file, LAM_GRID_NAME, &s->grid));
  if (s->salvage) PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  ierr = LamFileGetText(path, file, "/scene", &s->scene);
  if (s->salvage) PetscCall(PetscPopErrorHandler());
  if (!s->salvage) PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* The result has the header of the first file. */
static PetscErrorCode TakeFirst(LamMerge *m, const char path[], Source *s)
{
  LamHeader *h = &s->header;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(m->hash, h->hash, sizeof(m->hash)));
  m->header_from = path;
  m->scene.micro = h->micro;
  m->scene.scales = h->scales;
  m->scene.accuracy = h->accuracy;
  m->scene.text = s->scene;
  h->micro.cell = NULL; /* ownership moved, as for the text */
  s->scene = NULL;
  PetscFunctionReturn(0);
}

static PetscErrorCode TakeSource(LamMerge *m, const char path[], Source *s)
{
  LamHeader *h = &s->header;

  PetscFunctionBeginUser;
  PetscCheck(!strcmp(h->kind, "database"), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: is of kind \"%s\"; only databases are merged", path, h->kind);
  if (!s->matches)
    LamMergeMessage(
        m, "%s: the header is damaged (its checksum differs): apothem %g m, C1 + C2 %g Pa, accuracy %g; check them",
        path, (double)h->scales.length, (double)h->scales.stress, (double)h->accuracy);
  if (m->header_from)
    PetscCall(LamMergeCheckHash(m, path, h));
  else
    PetscCall(TakeFirst(m, path, s));
  if (h->scales.length != m->scene.scales.length || h->scales.stress != m->scene.scales.stress)
    LamMergeMessage(m, "%s: is in other units; the result has those of %s: apothem %g m, C1 + C2 %g Pa", path,
                    m->header_from, (double)m->scene.scales.length, (double)m->scene.scales.stress);
  m->scene.accuracy = PetscMin(m->scene.accuracy, h->accuracy);
  m->total += s->records;
  PetscCall(CheckGrid(m, path, s->grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadHeader(LamMerge *m, const char path[])
{
  Source source = {.salvage = m->options->salvage};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = LamFileRead(path, ReadSource, &source);
  if (!ierr) ierr = TakeSource(m, path, &source);
  PetscCall(LamHeaderDestroy(&source.header));
  PetscCall(PetscFree(source.grid));
  PetscCall(PetscFree(source.scene));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMergeReadHeaders(LamMerge *m)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->n; i++) PetscCall(ReadHeader(m, m->files[i]));
  PetscFunctionReturn(0);
}
