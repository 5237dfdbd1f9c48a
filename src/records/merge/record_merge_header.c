/*
  What a merged database is of: the headers of its sources.

  In salvage a file whose header HDF5 cannot read must tell its microstructure in another way (record_remains.c):
  records of other tissue must not slip in.
*/
#include "record_merge.h"
#include <string.h>
#include <stdio.h>

/* Takes over what `micro` owns. */
static PetscErrorCode SetHeader(LamMerge *m, const char from[], LamMicrostructure *micro, const LamScales *scales,
                                PetscReal accuracy, char *text)
{
  char *json;

  PetscFunctionBeginUser;
  PetscCall(LamMicrostructureDescribe(micro, &json, m->hash));
  PetscCall(PetscFree(json));
  m->header_from = from;
  m->scene.micro = *micro;
  m->scene.scales = *scales;
  m->scene.accuracy = accuracy;
  m->scene.text = text;
  micro->cell = NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMergeCheckHash(const LamMerge *m, const char path[], const char hash[])
{
  PetscFunctionBeginUser;
  PetscCheck(!strcmp(m->hash, hash), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds microstructure %s, %s holds %s; only databases of one microstructure are merged", path, hash,
             m->header_from, m->hash);
  PetscFunctionReturn(0);
}

/* `text` NULL: the file has no grid; in salvage it may have lost it. */
static PetscErrorCode CheckGrid(LamMerge *m, const char path[], const char text[])
{
  const PetscBool same = (PetscBool)(m->grid_text && text ? !strcmp(m->grid_text, text) : !m->grid_text && !text);

  PetscFunctionBeginUser;
  if (m->options->salvage && !text) PetscFunctionReturn(0);
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

static PetscErrorCode ReadText(const char path[], hid_t file, const char name[], char **text)
{
  PetscBool has;

  PetscFunctionBeginUser;
  PetscCall(LamFileHas(path, file, name, &has));
  *text = NULL;
  if (has) PetscCall(LamFileGetText(path, file, name, text));
  PetscFunctionReturn(0);
}

/* Converting would lose what we do not know. */
static PetscErrorCode CheckMembers(const char path[], hid_t file)
{
  hid_t dataset, theirs, ours;
  int members;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, dataset = H5Dopen2(file, "/records", H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, theirs = H5Dget_type(dataset));
  PetscCall(LamRecordTypeCheck(path, theirs));
  PetscCall(LamRecordTypeCreate(&ours));
  LamCallHDF5(path, PETSC_ERR_LIB, members = H5Tget_nmembers(theirs));
  for (int i = 0; i < members; i++) {
    char *name = H5Tget_member_name(theirs, (unsigned)i), copy[LAM_NAME_LENGTH];
    const PetscBool known = (PetscBool)(H5Tget_member_index(ours, name) >= 0);

    snprintf(copy, sizeof(copy), "%s", name);
    H5free_memory(name);
    PetscCheck(known, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: its records have a member \"%s\" that this lamella does not know; merge with the version that "
               "wrote it",
               path, copy);
  }
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(ours));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(theirs));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Dclose(dataset));
  PetscFunctionReturn(0);
}

typedef struct {
  LamHeader header;
  char *grid, *scene; /* NULL: none */
} Told;

/* Salvage asks nothing of the records' table. */
static PetscErrorCode ReadTold(const char path[], hid_t file, PetscBool salvage, Told *told)
{
  PetscFunctionBeginUser;
  PetscCall(LamHeaderReadRoot(path, file, &told->header));
  if (!salvage) PetscCall(CheckMembers(path, file));
  PetscCall(ReadText(path, file, LAM_GRID_NAME, &told->grid));
  PetscCall(ReadText(path, file, "/scene", &told->scene));
  PetscFunctionReturn(0);
}

static PetscErrorCode TakeTold(LamMerge *m, const char path[], Told *told)
{
  LamHeader *h = &told->header;

  PetscFunctionBeginUser;
  PetscCheck(!strcmp(h->kind, "database"), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: is of kind \"%s\"; only databases are merged", path, h->kind);
  if (m->header_from) {
    PetscCall(LamMergeCheckHash(m, path, h->hash));
  } else {
    PetscCall(SetHeader(m, path, &h->micro, &h->scales, h->accuracy, told->scene));
    told->scene = NULL;
  }
  if (h->scales.length != m->scene.scales.length || h->scales.stress != m->scene.scales.stress)
    LamMergeTell(m, "%s: is in other units; the result has those of %s: apothem %g m, C1 + C2 %g Pa", path,
                 m->header_from, (double)m->scene.scales.length, (double)m->scene.scales.stress);
  m->scene.accuracy = PetscMin(m->scene.accuracy, h->accuracy);
  PetscCall(CheckGrid(m, path, told->grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode DestroyTold(Told *told)
{
  PetscFunctionBeginUser;
  PetscCall(LamHeaderDestroy(&told->header));
  PetscCall(PetscFree(told->grid));
  PetscCall(PetscFree(told->scene));
  PetscFunctionReturn(0);
}

static PetscErrorCode KeepWords(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                PetscErrorType type, const char *words, void *ctx)
{
  (void)comm, (void)line, (void)function, (void)file;
  if (type == PETSC_ERROR_INITIAL) snprintf(ctx, 512, "%s", words);
  return code;
}

typedef PetscErrorCode (*OpenFunction)(const char path[], hid_t *file);

static PetscErrorCode OpenTold(const char path[], OpenFunction open, PetscBool salvage, Told *told)
{
  const int lock = LamLockBeginRead(path);
  hid_t file = H5I_INVALID_HID;
  PetscErrorCode ierr = open(path, &file);

  PetscFunctionBeginUser;
  if (!ierr) ierr = ReadTold(path, file, salvage, told);
  if (file >= 0) H5Fclose(file);
  LamLockEndRead(lock);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* As it is, or, where it has been cut, as it was. `words`: what is wrong. */
static PetscErrorCode OpenDamaged(const char path[], Told *told, char words[512])
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(KeepWords, words));
  ierr = OpenTold(path, LamFileOpenRead, PETSC_TRUE, told);
  PetscCall(PetscPopErrorHandler());
  if (!ierr) PetscFunctionReturn(0);
  PetscCheck(ierr == PETSC_ERR_USER_INPUT, PETSC_COMM_SELF, ierr, "%s", words);
  PetscCall(DestroyTold(told));
  *told = (Told){0};
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  ierr = OpenTold(path, LamRemainsOpen, PETSC_TRUE, told);
  PetscCall(PetscPopErrorHandler());
  PetscFunctionReturn(ierr);
}

/* In salvage what is wrong with a file is told; one whose header cannot be read is marked. */
static PetscErrorCode ReadHeader(LamMerge *m, PetscInt i)
{
  const char *path = m->files[i];
  char words[512] = "";
  PetscErrorCode ierr;
  Told told = {0};

  PetscFunctionBeginUser;
  ierr = m->options->salvage ? OpenDamaged(path, &told, words) : OpenTold(path, LamFileOpenRead, PETSC_FALSE, &told);
  if (!ierr) {
    if (words[0]) LamMergeTell(m, "%s", words);
    ierr = TakeTold(m, path, &told);
  } else if (ierr == PETSC_ERR_USER_INPUT && m->options->salvage) {
    LamMergeTell(m, "%s", words);
    m->state[i] = LAM_FILE_DAMAGED;
    ierr = 0;
  }
  PetscCall(DestroyTold(&told));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- damaged headers ---- */

static PetscErrorCode SetHeaderFromRemains(LamMerge *m, const char path[], LamRemains *r)
{
  PetscFunctionBeginUser;
  if (!r->description || !r->has_scales) PetscFunctionReturn(0);
  PetscCall(SetHeader(m, path, &r->micro, &r->scales, r->accuracy, NULL));
  LamMergeTell(m, "%s: units are read from a damaged header: apothem %g m, C1 + C2 %g Pa, accuracy %g; check them",
               path, (double)r->scales.length, (double)r->scales.stress, (double)r->accuracy);
  PetscFunctionReturn(0);
}

/* No header is sound: the first that can be made out. */
static PetscErrorCode FindHeader(LamMerge *m)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->n && !m->header_from; i++) {
    LamRemains remains;
    PetscErrorCode ierr;

    PetscCall(LamRemainsFind(m->files[i], "", &remains));
    ierr = SetHeaderFromRemains(m, m->files[i], &remains);
    PetscCall(LamRemainsDestroy(&remains));
    PetscCall(ierr);
  }
  PetscCheck(m->header_from, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: its microstructure and units cannot be made out any more; merge it with a sound database of the same "
             "tissue, or use build --resume --salvage with its scene",
             m->files[0]);
  PetscFunctionReturn(0);
}

static PetscErrorCode TakeRemains(LamMerge *m, PetscInt i, LamRemains *r)
{
  const char *path = m->files[i];

  PetscFunctionBeginUser;
  if (r->description) PetscCall(LamMergeCheckHash(m, path, r->hash));
  if (r->grid) PetscCall(CheckGrid(m, path, r->grid));
  if (r->description || r->names_hash || m->options->scene) PetscFunctionReturn(0);
  LamMergeTell(m,
               "%s: whether it is of microstructure %s cannot be made out any more; nothing of it is taken (build "
               "--resume --salvage takes it for that of its scene)",
               path, m->hash);
  m->state[i] = LAM_FILE_UNKNOWN;
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadRemains(LamMerge *m, PetscInt i)
{
  LamRemains remains;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(LamRemainsFind(m->files[i], m->hash, &remains));
  ierr = TakeRemains(m, i, &remains);
  PetscCall(LamRemainsDestroy(&remains));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode SetHeaderFromScene(LamMerge *m, const LamScene *scene)
{
  LamMicrostructure micro;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(LamMicrostructureCopy(&scene->micro, &micro));
  PetscCall(PetscStrallocpy(scene->text, &text));
  PetscCall(SetHeader(m, scene->path, &micro, &scene->scales, scene->accuracy, text));
  PetscFunctionReturn(0);
}

/* Sound files tell first. */
PetscErrorCode LamMergeReadHeaders(LamMerge *m)
{
  PetscFunctionBeginUser;
  if (m->options->scene) PetscCall(SetHeaderFromScene(m, m->options->scene));
  PetscCall(PetscCalloc1(m->n, &m->state)); /* sound */
  for (PetscInt i = 0; i < m->n; i++) PetscCall(ReadHeader(m, i));
  if (!m->header_from) PetscCall(FindHeader(m));
  for (PetscInt i = 0; i < m->n; i++)
    if (m->state[i] == LAM_FILE_DAMAGED) PetscCall(ReadRemains(m, i));
  if (!m->grid_from && m->options->grid) PetscCall(PetscStrallocpy(m->options->grid, &m->grid_text));
  PetscFunctionReturn(0);
}
