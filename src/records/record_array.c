/*
  Arrays and texts in record files.
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

/* ---- rows ---- */

static herr_t SelectRows(hid_t dataset, hsize_t first, hsize_t n, hid_t *memory, hid_t *space)
{
  hsize_t start[H5S_MAX_RANK] = {first}, count[H5S_MAX_RANK];
  int rank;

  *space = H5Dget_space(dataset);
  rank = H5Sget_simple_extent_dims(*space, count, NULL);
  count[0] = n;
  *memory = H5Screate_simple(rank, count, NULL);
  return H5Sselect_hyperslab(*space, H5S_SELECT_SET, start, NULL, count, NULL);
}

static PetscErrorCode Transfer(const char path[], hid_t dataset, hid_t type, PetscBool write, hid_t memory, hid_t space,
                               void *rows)
{
  PetscFunctionBeginUser;
  if (write)
    LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dwrite(dataset, type, memory, space, H5P_DEFAULT, rows));
  else
    LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Dread(dataset, type, memory, space, H5P_DEFAULT, rows));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRowsTransfer(const char path[], hid_t dataset, hid_t type, PetscBool write, hsize_t first, hsize_t n,
                               void *rows)
{
  PetscErrorCode ierr;
  hid_t memory, space;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_LIB, SelectRows(dataset, first, n, &memory, &space));
  ierr = Transfer(path, dataset, type, write, memory, space, rows);
  PetscCall(LamCloseHDF5(path, memory, space));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- writing ---- */

size_t LamArrayCount(const LamArray *a)
{
  size_t count = 1;

  for (PetscInt i = 0; i < a->rank; i++) count *= (size_t)a->dims[i];
  return count;
}

/* Checksum of the bytes in the file, followed by the unit. */
static uint32_t ArraySum(const LamArray *a)
{
  uint32_t sum = 0;

  if (a->file_type == H5T_IEEE_F64LE) sum = LamBytesSum(0, a->values, 8 * LamArrayCount(a));
  for (size_t i = 0; a->file_type != H5T_IEEE_F64LE && i < LamArrayCount(a); i++) {
    const PetscInt64 value = ((const PetscInt *)a->values)[i];

    sum = LamBytesSum(sum, &value, sizeof(value));
  }
  return a->unit ? LamBytesSum(sum, a->unit, strlen(a->unit)) : sum;
}

/* Creates the dataset and its groups. */
static PetscErrorCode Create(const char path[], hid_t file, const LamArray *a, uint32_t sum)
{
  hid_t groups, space, dataset;
  hsize_t dims[4];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < a->rank; i++) dims[i] = (hsize_t)a->dims[i];
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, groups = H5Pcreate(H5P_LINK_CREATE));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Pset_create_intermediate_group(groups, 1));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, space = H5Screate_simple((int)a->rank, dims, NULL));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE,
              dataset = H5Dcreate2(file, a->name, a->file_type, space, groups, H5P_DEFAULT, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dwrite(dataset, a->memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, a->values));
  if (a->unit) PetscCall(LamAttributeWriteText(path, dataset, "unit", a->unit));
  PetscCall(LamSumWrite(path, dataset, LAM_SUM, sum));
  PetscCall(LamCloseHDF5(path, dataset, space, groups));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileWriteText(const char path[], hid_t file, const char name[], const char text[])
{
  LamArray array = {.name = name, .values = text};
  PetscBool has;

  PetscFunctionBeginUser;
  PetscCall(LamFileHas(path, file, name, &has));
  if (has) LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Ldelete(file, name, H5P_DEFAULT));
  PetscCall(LamTextTypeCreate(path, text, &array.file_type));
  array.memory_type = array.file_type;
  PetscCall(Create(path, file, &array, LamBytesSum(0, text, strlen(text))));
  PetscCall(LamCloseHDF5(path, array.file_type));
  PetscFunctionReturn(0);
}

/* An overwritten array has no valid checksum: a kill may leave old and new numbers. */
static PetscErrorCode DropSum(const char path[], hid_t file, hid_t dataset)
{
  const uint32_t none = LAM_NO_SUM;
  PetscBool summed;

  PetscFunctionBeginUser;
  PetscCall(LamSumHas(path, dataset, LAM_SUM, &summed));
  if (!summed) PetscFunctionReturn(0);
  PetscCall(LamAttributeUpdate(path, dataset, LAM_SUM, H5T_NATIVE_UINT32, &none));
  PetscCall(LamFileSync(path, file));
  PetscFunctionReturn(0);
}

/*
  Overwrites an array of the same shape and type. Only its numbers change in the file, so a table that grows full
  commit by commit takes no more space, and after a kill each number is either old or new.
*/
static PetscErrorCode Overwrite(const char path[], hid_t file, const LamArray *a, PetscBool *done)
{
  hsize_t dims[H5S_MAX_RANK];
  hid_t dataset, space, type;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, dataset = H5Dopen2(file, a->name, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, space = H5Dget_space(dataset));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, type = H5Dget_type(dataset));
  *done = (PetscBool)(H5Tequal(type, a->file_type) > 0 && H5Sget_simple_extent_dims(space, dims, NULL) == a->rank);
  for (PetscInt i = 0; i < a->rank && *done; i++) *done = (PetscBool)(dims[i] == (hsize_t)a->dims[i]);
  if (*done) PetscCall(DropSum(path, file, dataset));
  if (*done)
    LamCallHDF5(path, PETSC_ERR_FILE_WRITE,
                H5Dwrite(dataset, a->memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, a->values));
  PetscCall(LamCloseHDF5(path, type, space, dataset));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileWriteArray(const char path[], hid_t file, void *ctx)
{
  const LamArray *a = ctx;
  PetscBool has, done = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(LamFileHas(path, file, a->name, &has));
  if (has) PetscCall(Overwrite(path, file, a, &done));
  if (done) PetscFunctionReturn(0);
  if (has) LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Ldelete(file, a->name, H5P_DEFAULT));
  PetscCall(Create(path, file, a, ArraySum(a)));
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
  PetscCall(LamCloseHDF5(path, list));
  PetscCheck(ours, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s is compressed, in another file or stored otherwise than lamella does" LAM_FOREIGN, path, name);
  PetscFunctionReturn(0);
}

typedef struct {
  hid_t dataset, type, space;
} Opened;

/* `type`: type in the file; H5I_INVALID_HID: a text of fixed length. */
static PetscErrorCode Open(const char path[], hid_t file, const char name[], hid_t type, Opened *o)
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
             "%s: %s is of another type than lamella writes" LAM_FOREIGN, path, name);
  PetscFunctionReturn(0);
}

/* The values must fit into the size of the file. */
static PetscErrorCode GetShape(const char path[], hid_t file, const char name[], const Opened *o, LamFileArray *array)
{
  const size_t bytes = PetscMax(H5Tget_size(o->type), 1);
  hsize_t dims[H5S_MAX_RANK], size;
  hssize_t count;
  int rank;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Fget_filesize(file, &size));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, count = H5Sget_simple_extent_npoints(o->space));
  PetscCheck((hsize_t)count <= size / bytes && count < PETSC_MAX_INT, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s is said to have %lld values of %zu bytes, the file has %lld; it is damaged", path, name,
             (long long)count, H5Tget_size(o->type), (long long)size);
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, rank = H5Sget_simple_extent_dims(o->space, dims, NULL));
  PetscCheck(rank <= 4, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s has rank %d; lamella writes rank 4 at most",
             path, name, rank);
  array->rank = rank;
  for (int i = 0; i < rank; i++) array->dims[i] = (PetscInt)dims[i];
  array->count = (PetscInt)count;
  PetscFunctionReturn(0);
}

/* The checksum of an array includes its unit. */
static PetscErrorCode CheckSum(const char path[], const char name[], hid_t dataset, const void *values, size_t bytes)
{
  uint32_t sum = LamBytesSum(0, values, bytes);
  PetscBool sound, has;
  char *unit;

  PetscFunctionBeginUser;
  PetscCall(LamSumHas(path, dataset, LAM_SUM, &has));
  if (!has) PetscFunctionReturn(0);
  PetscCall(LamAttributeHas(path, dataset, "unit", &has));
  if (has) {
    PetscCall(LamAttributeReadText(path, dataset, "unit", &unit));
    sum = LamBytesSum(sum, unit, strlen(unit));
    PetscCall(PetscFree(unit));
  }
  PetscCall(LamSumMatches(path, dataset, LAM_SUM, sum, &sound));
  PetscCheck(sound, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s is damaged (its checksum differs)", path, name);
  PetscFunctionReturn(0);
}

/* Reads all values, unconverted, followed by a zero. */
static PetscErrorCode Read(const char path[], hid_t file, const char name[], const Opened *o, LamFileArray *array)
{
  const PetscBool is_text = (PetscBool)(H5Tget_class(o->type) == H5T_STRING);
  size_t bytes;

  PetscFunctionBeginUser;
  PetscCall(GetShape(path, file, name, o, array));
  PetscCheck(!is_text || array->count == 1, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s is not one text" LAM_FOREIGN, path, name);
  bytes = (size_t)array->count * H5Tget_size(o->type);
  PetscCall(PetscCalloc(bytes + 1, &array->values));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Dread(o->dataset, o->type, H5S_ALL, H5S_ALL, H5P_DEFAULT, array->values));
  PetscCall(CheckSum(path, name, o->dataset, array->values, is_text ? strlen(array->values) : bytes));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileGetArray(const char path[], hid_t file, const char name[], hid_t type, LamFileArray *array)
{
  Opened o = {H5I_INVALID_HID, H5I_INVALID_HID, H5I_INVALID_HID};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *array = (LamFileArray){0};
  PetscCall(LamFileHas(path, file, name, &array->found));
  if (!array->found) PetscFunctionReturn(0);
  ierr = Open(path, file, name, type, &o);
  if (!ierr) ierr = Read(path, file, name, &o, array);
  if (ierr) PetscCall(PetscFree(array->values));
  PetscCall(LamCloseHDF5(path, o.space, o.type, o.dataset));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileGetText(const char path[], hid_t file, const char name[], char **text)
{
  LamFileArray array;

  PetscFunctionBeginUser;
  PetscCall(LamFileGetArray(path, file, name, H5I_INVALID_HID, &array));
  *text = array.values;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileGetGrid(const char path[], hid_t file, PetscBool required, const LamMicrostructure *micro,
                              LamGrid *grid)
{
  PetscErrorCode ierr;
  char *text;

  PetscFunctionBeginUser;
  *grid = NULL;
  PetscCall(LamFileGetText(path, file, LAM_GRID_NAME, &text));
  PetscCheck(text || !required, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s is missing, though there are nodes of a grid", path, LAM_GRID_NAME);
  if (!text) PetscFunctionReturn(0);
  ierr = LamGridFromText(path, micro, text, grid);
  PetscCall(PetscFree(text));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- reading one array, with the file opened for it ---- */

typedef struct {
  const char *name;
  hid_t type;
  LamFileArray array;
} Request;

static PetscErrorCode Get(const char path[], hid_t file, void *ctx)
{
  Request *r = ctx;

  PetscFunctionBeginUser;
  PetscCall(LamFileGetArray(path, file, r->name, r->type, &r->array));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReadReals(const char path[], const char name[], PetscBool *found, PetscInt *rank,
                                PetscInt dims[4], PetscReal **values)
{
  Request r = {.name = name, .type = H5T_IEEE_F64LE};

  PetscFunctionBeginUser;
  PetscCall(LamFileRead(path, Get, &r));
  *found = r.array.found;
  *rank = r.array.rank;
  *values = r.array.values;
  PetscCall(PetscArraycpy(dims, r.array.dims, r.array.rank));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReadInts(const char path[], const char name[], PetscBool *found, PetscInt *rank, PetscInt dims[4],
                               PetscInt **values)
{
  Request r = {.name = name, .type = H5T_STD_I64LE};

  PetscFunctionBeginUser;
  PetscCall(LamFileRead(path, Get, &r));
  *found = r.array.found;
  *rank = r.array.rank;
  *values = NULL;
  if (!r.array.found) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(dims, r.array.dims, r.array.rank));
  PetscCall(PetscMalloc1(r.array.count + 1, values));
  for (PetscInt i = 0; i < r.array.count; i++) (*values)[i] = (PetscInt)((const PetscInt64 *)r.array.values)[i];
  PetscCall(PetscFree(r.array.values));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReadText(const char path[], const char name[], PetscBool *found, char **text)
{
  Request r = {.name = name, .type = H5I_INVALID_HID};

  PetscFunctionBeginUser;
  PetscCall(LamFileRead(path, Get, &r));
  *found = r.array.found;
  *text = r.array.values;
  PetscFunctionReturn(0);
}
