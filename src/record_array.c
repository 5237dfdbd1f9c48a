/*
  Arrays and texts in record files: reading, and the texts that the header itself uses.
*/
#include "record_internal.h"
#include <stdio.h>
#include <string.h>

PetscErrorCode LamFileHas(const char path[], hid_t file, const char name[], PetscBool *has)
{
  char part[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(part, name, sizeof(part)));
  *has = PETSC_TRUE;
  for (char *slash = strchr(part + 1, '/'); *has; slash = strchr(slash + 1, '/')) {
    htri_t exists;

    if (slash) *slash = '\0';
    LamCallHDF5(path, PETSC_ERR_USER_INPUT, exists = H5Lexists(file, part, H5P_DEFAULT));
    *has = (PetscBool)(exists > 0);
    if (!slash) break;
    *slash = '/';
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileWriteText(const char path[], hid_t file, const char name[], const char text[])
{
  hid_t space, type, groups, dataset;
  PetscBool has;

  PetscFunctionBeginUser;
  PetscCall(LamFileHas(path, file, name, &has));
  if (has) LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Ldelete(file, name, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, space = H5Screate(H5S_SCALAR));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, type = H5Tcopy(H5T_C_S1));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Tset_size(type, strlen(text) + 1));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Tset_cset(type, H5T_CSET_UTF8));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, groups = H5Pcreate(H5P_LINK_CREATE));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Pset_create_intermediate_group(groups, 1));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE,
              dataset = H5Dcreate2(file, name, type, space, groups, H5P_DEFAULT, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dclose(dataset));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Pclose(groups));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Tclose(type));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Sclose(space));
  PetscFunctionReturn(0);
}

/* ---- reading ---- */

typedef struct {
  hid_t dataset, type, space;
} Opened;

static PetscErrorCode Open(const char path[], hid_t file, const char name[], H5T_class_t wanted, Opened *o)
{
  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, o->dataset = H5Dopen2(file, name, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, o->type = H5Dget_type(o->dataset));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, o->space = H5Dget_space(o->dataset));
  PetscCheck(H5Tget_class(o->type) == wanted, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s is of another type than lamella writes; the file is damaged", path, name);
  PetscFunctionReturn(0);
}

static PetscErrorCode Close(const char path[], Opened *o)
{
  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_LIB, H5Sclose(o->space));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(o->type));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Dclose(o->dataset));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileGetText(const char path[], hid_t file, const char name[], char **text)
{
  PetscBool has;
  Opened o;

  PetscFunctionBeginUser;
  PetscCall(LamFileHas(path, file, name, &has));
  PetscCheck(has, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s is missing; the file is damaged", path, name);
  PetscCall(Open(path, file, name, H5T_STRING, &o));
  PetscCheck(H5Tis_variable_str(o.type) == 0 && H5Sget_simple_extent_npoints(o.space) == 1, PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT, "%s: %s is not a text as lamella writes it; the file is damaged", path, name);
  PetscCall(PetscCalloc(H5Tget_size(o.type) + 1, text));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Dread(o.dataset, o.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, *text));
  PetscCall(Close(path, &o));
  PetscFunctionReturn(0);
}

typedef struct {
  const char *name;
  H5T_class_t wanted;
  hid_t memory_type;
  PetscBool found;
  PetscInt rank, *dims;
  void *values;
  char kind[LAM_NAME_LENGTH];
} Question;

static PetscErrorCode ReadArray(const char path[], hid_t file, Question *q)
{
  hsize_t dims[H5S_MAX_RANK];
  hssize_t count;
  Opened o;
  int rank;

  PetscFunctionBeginUser;
  PetscCall(LamFileHas(path, file, q->name, &q->found));
  if (!q->found) PetscFunctionReturn(0);
  PetscCall(Open(path, file, q->name, q->wanted, &o));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, rank = H5Sget_simple_extent_dims(o.space, dims, NULL));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, count = H5Sget_simple_extent_npoints(o.space));
  PetscCheck(rank <= 4 && count < PETSC_MAX_INT, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s has rank %d and %lld numbers; lamella writes rank 4 at most", path, q->name, rank,
             (long long)count);
  q->rank = rank;
  for (int i = 0; i < rank; i++) q->dims[i] = (PetscInt)dims[i];
  PetscCall(PetscMalloc(((size_t)count + 1) * H5Tget_size(q->memory_type), &q->values));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Dread(o.dataset, q->memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, q->values));
  PetscCall(Close(path, &o));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadText(const char path[], hid_t file, Question *q)
{
  PetscFunctionBeginUser;
  PetscCall(LamFileHas(path, file, q->name, &q->found));
  if (q->found) PetscCall(LamFileGetText(path, file, q->name, (char **)&q->values));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadKind(const char path[], hid_t file, Question *q)
{
  LamHeader header;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = LamHeaderRead(path, file, &header);
  if (!ierr) ierr = PetscStrncpy(q->kind, header.kind, sizeof(q->kind));
  PetscCall(LamHeaderDestroy(&header));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode Ask(const char path[], PetscErrorCode (*read)(const char[], hid_t, Question *), Question *q)
{
  hid_t file = H5I_INVALID_HID;
  const int lock = LamLockBeginRead(path);
  PetscErrorCode ierr = LamFileOpenRead(path, &file);

  PetscFunctionBeginUser;
  if (!ierr) ierr = read(path, file, q);
  if (file >= 0) H5Fclose(file);
  LamLockEndRead(lock);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReadReals(const char path[], const char name[], PetscBool *found, PetscInt *rank,
                                PetscInt dims[4], PetscReal **values)
{
  Question q = {.name = name, .wanted = H5T_FLOAT, .memory_type = H5T_NATIVE_DOUBLE, .dims = dims};

  PetscFunctionBeginUser;
  PetscCall(Ask(path, ReadArray, &q));
  *found = q.found;
  *rank = q.rank;
  *values = q.values;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReadInts(const char path[], const char name[], PetscBool *found, PetscInt *rank, PetscInt dims[4],
                               PetscInt **values)
{
  Question q = {.name = name, .wanted = H5T_INTEGER, .dims = dims};

  PetscFunctionBeginUser;
  q.memory_type = sizeof(PetscInt) == sizeof(PetscInt64) ? H5T_NATIVE_INT64 : H5T_NATIVE_INT;
  PetscCall(Ask(path, ReadArray, &q));
  *found = q.found;
  *rank = q.rank;
  *values = q.values;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReadText(const char path[], const char name[], PetscBool *found, char **text)
{
  Question q = {.name = name};

  PetscFunctionBeginUser;
  PetscCall(Ask(path, ReadText, &q));
  *found = q.found;
  *text = q.values;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReadKind(const char path[], char kind[LAM_NAME_LENGTH])
{
  Question q = {0};

  PetscFunctionBeginUser;
  PetscCall(Ask(path, ReadKind, &q));
  PetscCall(PetscStrncpy(kind, q.kind, LAM_NAME_LENGTH));
  PetscFunctionReturn(0);
}
