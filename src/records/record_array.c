/*
  Arrays and texts in open record files.
*/
#include "record_internal.h"
#include <stdio.h>
#include <string.h>

/* A soft or external link could lead HDF5 to a file that the user did not name. */
static PetscErrorCode CheckLink(const char path[], hid_t file, const char name[])
{
  H5L_info_t info;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Lget_info(file, name, &info, H5P_DEFAULT));
  PetscCheck(info.type == H5L_TYPE_HARD, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s is a link to elsewhere, which lamella never writes", path, name);
  PetscFunctionReturn(0);
}

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
    if (*has) PetscCall(CheckLink(path, file, part));
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
  PetscCall(LamSumWrite(path, dataset, LAM_SUM, LamBytesSum(0, text, strlen(text))));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dclose(dataset));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Pclose(groups));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Tclose(type));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Sclose(space));
  PetscFunctionReturn(0);
}

/* ---- reading ---- */

PetscErrorCode LamDatasetCheck(const char path[], hid_t dataset, const char name[], H5D_layout_t wanted)
{
  PetscBool ours;
  hid_t list;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, list = H5Dget_create_plist(dataset));
  ours = (PetscBool)(H5Pget_layout(list) == wanted && !H5Pget_nfilters(list) && !H5Pget_external_count(list));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pclose(list));
  PetscCheck(ours, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s is compressed, in another file or stored otherwise than lamella does; the file is damaged", path,
             name);
  PetscFunctionReturn(0);
}

typedef struct {
  hid_t dataset, type, space;
  hsize_t count;
  size_t bytes; /* of all values in the file */
  PetscBool is_text;
} Opened;

/* Also closes partly opened objects. */
static void Close(Opened *o)
{
  if (o->space >= 0) H5Sclose(o->space);
  if (o->type >= 0) H5Tclose(o->type);
  if (o->dataset >= 0) H5Dclose(o->dataset);
}

/* The values must fit into the size of the file. */
static PetscErrorCode CheckSize(const char path[], hid_t file, const char name[], Opened *o)
{
  hssize_t count;
  hsize_t size;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Fget_filesize(file, &size));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, count = H5Sget_simple_extent_npoints(o->space));
  o->count = (hsize_t)count;
  PetscCheck(o->count <= size / PetscMax(H5Tget_size(o->type), 1) && o->count < PETSC_MAX_INT, PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT, "%s: %s is said to have %lld values of %zu bytes, the file has %lld; it is damaged",
             path, name, (long long)count, H5Tget_size(o->type), (long long)size);
  o->bytes = o->count * H5Tget_size(o->type);
  PetscFunctionReturn(0);
}

static PetscErrorCode OpenParts(const char path[], hid_t file, const char name[], hid_t type, Opened *o)
{
  PetscBool same;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, o->dataset = H5Dopen2(file, name, H5P_DEFAULT));
  PetscCall(LamDatasetCheck(path, o->dataset, name, H5D_CONTIGUOUS));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, o->type = H5Dget_type(o->dataset));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, o->space = H5Dget_space(o->dataset));
  same = (PetscBool)(type >= 0 ? H5Tequal(o->type, type) > 0
                               : H5Tget_class(o->type) == H5T_STRING && H5Tis_variable_str(o->type) == 0);
  PetscCheck(same, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s is of another type than lamella writes; the file is damaged", path, name);
  PetscCall(CheckSize(path, file, name, o));
  PetscFunctionReturn(0);
}

/* `type`: type in the file; H5I_INVALID_HID: a text of fixed length. */
static PetscErrorCode Open(const char path[], hid_t file, const char name[], hid_t type, Opened *o)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *o = (Opened){.dataset = H5I_INVALID_HID, .type = H5I_INVALID_HID, .space = H5I_INVALID_HID};
  o->is_text = (PetscBool)(type < 0);
  ierr = OpenParts(path, file, name, type, o);
  if (ierr) Close(o);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* The checksum of an array includes its unit. */
static PetscErrorCode CheckSum(const char path[], const char name[], const Opened *o, const void *values)
{
  PetscBool sound, has;
  uint32_t sum = LamBytesSum(0, values, o->is_text ? strlen(values) : o->bytes);
  char *unit;

  PetscFunctionBeginUser;
  PetscCall(LamSumHas(path, o->dataset, LAM_SUM, &has));
  if (!has) PetscFunctionReturn(0);
  PetscCall(LamAttributeHas(path, o->dataset, "unit", &has));
  if (has) {
    PetscCall(LamAttributeReadText(path, o->dataset, "unit", &unit));
    sum = LamBytesSum(sum, unit, strlen(unit));
    PetscCall(PetscFree(unit));
  }
  PetscCall(LamSumMatches(path, o->dataset, LAM_SUM, sum, &sound));
  PetscCheck(sound, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s is damaged (its checksum differs)", path, name);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadInto(const char path[], const char name[], const Opened *o, void *values)
{
  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Dread(o->dataset, o->type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  PetscCall(CheckSum(path, name, o, values));
  PetscFunctionReturn(0);
}

/* Reads all values, unconverted, followed by a zero; the caller frees them. */
static PetscErrorCode Read(const char path[], const char name[], const Opened *o, void **values)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc(o->bytes + 1, values));
  ierr = ReadInto(path, name, o, *values);
  if (ierr) (void)PetscFree(*values);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadOneText(const char path[], const char name[], const Opened *o, char **text)
{
  PetscFunctionBeginUser;
  PetscCheck(o->count == 1, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s is not one text; the file is damaged", path,
             name);
  PetscCall(Read(path, name, o, (void **)text));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileGetText(const char path[], hid_t file, const char name[], char **text)
{
  PetscErrorCode ierr;
  PetscBool has;
  Opened o;

  PetscFunctionBeginUser;
  PetscCall(LamFileHas(path, file, name, &has));
  PetscCheck(has, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s is missing; the file is damaged", path, name);
  PetscCall(Open(path, file, name, H5I_INVALID_HID, &o));
  ierr = ReadOneText(path, name, &o, text);
  Close(&o);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode Dims(const char path[], const char name[], const Opened *o, LamFileArray *array)
{
  hsize_t dims[H5S_MAX_RANK];
  int rank;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, rank = H5Sget_simple_extent_dims(o->space, dims, NULL));
  PetscCheck(rank <= 4, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s has rank %d; lamella writes rank 4 at most",
             path, name, rank);
  array->rank = rank;
  for (int i = 0; i < rank; i++) array->dims[i] = (PetscInt)dims[i];
  array->count = (PetscInt)o->count;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileGetArray(const char path[], hid_t file, const char name[], hid_t type, LamFileArray *array)
{
  PetscErrorCode ierr;
  Opened o;

  PetscFunctionBeginUser;
  *array = (LamFileArray){0};
  PetscCall(LamFileHas(path, file, name, &array->found));
  if (!array->found) PetscFunctionReturn(0);
  PetscCall(Open(path, file, name, type, &o));
  ierr = Dims(path, name, &o, array);
  if (!ierr) ierr = Read(path, name, &o, &array->values);
  Close(&o);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileCheckValues(const char path[], hid_t file, const char name[])
{
  LamFileArray array = {0};
  H5T_class_t class;
  hid_t dataset, type;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, dataset = H5Dopen2(file, name, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, type = H5Dget_type(dataset));
  class = H5Tget_class(type);
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(type));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Dclose(dataset));
  if (class == H5T_STRING)
    PetscCall(LamFileGetText(path, file, name, (char **)&array.values));
  else
    PetscCall(LamFileGetArray(path, file, name, class == H5T_FLOAT ? H5T_IEEE_F64LE : H5T_STD_I64LE, &array));
  PetscCall(PetscFree(array.values));
  PetscFunctionReturn(0);
}
