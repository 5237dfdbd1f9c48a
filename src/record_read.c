/*
  Reading record files: the header and the committed records. Every size and type is checked before it is used.
*/
#include "record_internal.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- attributes ---- */

/* Opens an attribute of the wanted class and one element: anything else is no file of ours. */
static PetscErrorCode AttributeOpen(const char path[], hid_t object, const char name[], H5T_class_t wanted,
                                    hid_t *attribute, hid_t *type)
{
  hid_t space;

  PetscFunctionBeginUser;
  PetscCheck(H5Aexists(object, name) > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: attribute \"%s\" is missing; the file is damaged or was not written by lamella", path, name);
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, *attribute = H5Aopen(object, name, H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, *type = H5Aget_type(*attribute));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, space = H5Aget_space(*attribute));
  PetscCheck(H5Tget_class(*type) == wanted && H5Sget_simple_extent_npoints(space) == 1, PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT, "%s: attribute \"%s\" is of another type; the file is damaged", path, name);
  LamCallHDF5(path, PETSC_ERR_LIB, H5Sclose(space));
  PetscFunctionReturn(0);
}

static PetscErrorCode AttributeReadNumber(const char path[], hid_t object, const char name[], H5T_class_t wanted,
                                          hid_t memory_type, void *value)
{
  hid_t attribute, type;

  PetscFunctionBeginUser;
  PetscCall(AttributeOpen(path, object, name, wanted, &attribute, &type));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Aread(attribute, memory_type, value));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(type));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Aclose(attribute));
  PetscFunctionReturn(0);
}

/* The caller frees `text`. */
static PetscErrorCode AttributeReadText(const char path[], hid_t object, const char name[], char **text)
{
  hid_t attribute, type;

  PetscFunctionBeginUser;
  PetscCall(AttributeOpen(path, object, name, H5T_STRING, &attribute, &type));
  PetscCheck(H5Tis_variable_str(type) == 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: attribute \"%s\" is of another type; the file is damaged", path, name);
  PetscCall(PetscCalloc(H5Tget_size(type) + 1, text));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Aread(attribute, type, *text));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(type));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Aclose(attribute));
  PetscFunctionReturn(0);
}

static PetscErrorCode AttributeCopyText(const char path[], hid_t object, const char name[], size_t length, char value[])
{
  char *text;

  PetscFunctionBeginUser;
  PetscCall(AttributeReadText(path, object, name, &text));
  PetscCall(PetscStrncpy(value, text, length));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

/* ---- header ---- */

PetscErrorCode LamHeaderDestroy(LamHeader *header)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(header->command));
  PetscCall(PetscFree(header->description));
  PetscCall(LamMicrostructureDestroy(&header->micro));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadProvenance(const char path[], hid_t file, LamHeader *h)
{
  PetscFunctionBeginUser;
  PetscCall(AttributeCopyText(path, file, "creator", sizeof(h->creator), h->creator));
  PetscCall(AttributeCopyText(path, file, "created", sizeof(h->created), h->created));
  PetscCall(AttributeCopyText(path, file, "host", sizeof(h->host), h->host));
  PetscCall(AttributeCopyText(path, file, "petsc_version", sizeof(h->petsc), h->petsc));
  PetscCall(AttributeCopyText(path, file, "hdf5_version", sizeof(h->hdf5), h->hdf5));
  PetscCall(AttributeCopyText(path, file, "mpi_version", sizeof(h->mpi), h->mpi));
  PetscCall(AttributeReadText(path, file, "command", &h->command));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadScales(const char path[], hid_t file, LamHeader *h)
{
  const struct {
    const char *name;
    PetscReal *value, least;
  } rows[] = {{"length_unit_m", &h->scales.length, PETSC_SMALL},
              {"stress_unit_Pa", &h->scales.stress, PETSC_SMALL},
              {"macro_length_unit_m", &h->scales.macro_length, 0},
              {"accuracy", &h->accuracy, 0}};

  PetscFunctionBeginUser;
  for (size_t i = 0; i < sizeof(rows) / sizeof(rows[0]); i++) {
    PetscCall(AttributeReadNumber(path, file, rows[i].name, H5T_FLOAT, H5T_NATIVE_DOUBLE, rows[i].value));
    PetscCheck(isfinite(*rows[i].value) && *rows[i].value >= 0 && (rows[i].least == 0 || *rows[i].value > 0),
               PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: attribute \"%s\" is %g; the file is damaged", path,
               rows[i].name, (double)*rows[i].value);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadMicrostructure(const char path[], hid_t file, LamHeader *h)
{
  char name[64], hash[LAM_HASH_LENGTH], *json;
  H5G_info_t info;

  PetscFunctionBeginUser;
  PetscCall(AttributeCopyText(path, file, "microstructure", sizeof(h->hash), h->hash));
  snprintf(name, sizeof(name), "/microstructures/%s/description", h->hash);
  PetscCall(LamFileGetText(path, file, name, &h->description));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Gget_info_by_name(file, "/microstructures", &info, H5P_DEFAULT));
  PetscCheck(info.nlinks == 1, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds %d microstructures; this version reads files of one", path, (int)info.nlinks);
  PetscCall(LamMicrostructureParse(path, h->description, &h->micro));
  PetscCall(LamMicrostructureDescribe(&h->micro, &json, hash));
  PetscCall(PetscFree(json));
  PetscCheck(!strcmp(hash, h->hash), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the description of microstructure %s has been changed (its hash is %s)", path, h->hash, hash);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadCommitted(const char path[], hid_t file, PetscInt *committed)
{
  hid_t dataset, space;
  PetscInt64 count;
  hssize_t extent;

  PetscFunctionBeginUser;
  PetscCheck(H5Lexists(file, "/records", H5P_DEFAULT) > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the table /records is missing; the file is damaged", path);
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, dataset = H5Dopen2(file, "/records", H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, space = H5Dget_space(dataset));
  PetscCheck(H5Sget_simple_extent_ndims(space) == 1, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: /records is not a list; the file is damaged", path);
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, extent = H5Sget_simple_extent_npoints(space));
  PetscCall(AttributeReadNumber(path, dataset, "committed", H5T_INTEGER, H5T_NATIVE_INT64, &count));
  PetscCheck(count >= 0 && count <= (PetscInt64)extent && count < PETSC_MAX_INT, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %lld records are said to be committed, %lld are there; the file is damaged", path, (long long)count,
             (long long)extent);
  *committed = (PetscInt)count;
  LamCallHDF5(path, PETSC_ERR_LIB, H5Sclose(space));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Dclose(dataset));
  PetscFunctionReturn(0);
}

PetscErrorCode LamHeaderRead(const char path[], hid_t file, LamHeader *header)
{
  char format[16] = "";
  int version;

  PetscFunctionBeginUser;
  memset(header, 0, sizeof(*header));
  if (H5Aexists(file, "format") > 0) PetscCall(AttributeCopyText(path, file, "format", sizeof(format), format));
  PetscCheck(!strcmp(format, LAM_FORMAT_NAME), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: was not written by lamella (attribute \"format\" is \"%s\", not \"%s\")", path, format,
             LAM_FORMAT_NAME);
  PetscCall(AttributeReadNumber(path, file, "format_version", H5T_INTEGER, H5T_NATIVE_INT, &version));
  PetscCheck(version == LAM_FORMAT_VERSION, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has format version %d; this lamella reads version %d", path, version, LAM_FORMAT_VERSION);
  header->format_version = version;
  PetscCall(AttributeCopyText(path, file, "kind", sizeof(header->kind), header->kind));
  PetscCall(ReadProvenance(path, file, header));
  PetscCall(ReadScales(path, file, header));
  PetscCall(ReadMicrostructure(path, file, header));
  PetscCall(ReadCommitted(path, file, &header->committed));
  PetscFunctionReturn(0);
}

/* ---- records ---- */

#define BLOCK (8 * LAM_RECORDS_PER_CHUNK) /* 0.9 MB: checked and used while it is in the processor's cache */

typedef struct {
  hid_t dataset, type, space, memory;
  LamRecordLayout layout;
  unsigned char *bytes; /* of one block */
} Scan;

/* Without HDF5's cache of chunks: each is read once, right into our block. */
static PetscErrorCode ScanOpen(const char path[], hid_t file, Scan *s)
{
  hid_t access;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_LIB, access = H5Pcreate(H5P_DATASET_ACCESS));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pset_chunk_cache(access, H5D_CHUNK_CACHE_NSLOTS_DEFAULT, 0, 1));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, s->dataset = H5Dopen2(file, "/records", access));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pclose(access));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, s->type = H5Dget_type(s->dataset));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, s->space = H5Dget_space(s->dataset));
  PetscCall(LamRecordTypeCheck(path, s->type));
  PetscCall(LamRecordLayoutMake(s->type, &s->layout));
  PetscCall(PetscMalloc(BLOCK * s->layout.size, &s->bytes));
  PetscFunctionReturn(0);
}

static PetscErrorCode ScanClose(Scan *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->bytes));
  if (s->space >= 0) H5Sclose(s->space);
  if (s->type >= 0) H5Tclose(s->type);
  if (s->dataset >= 0) H5Dclose(s->dataset);
  PetscFunctionReturn(0);
}

/* The bytes of records first .. first + n - 1, as they are in the file. */
static PetscErrorCode ReadBlock(const char path[], Scan *s, hsize_t first, hsize_t n)
{
  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_LIB, H5Sselect_hyperslab(s->space, H5S_SELECT_SET, &first, NULL, &n, NULL));
  LamCallHDF5(path, PETSC_ERR_LIB, s->memory = H5Screate_simple(1, &n, NULL));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, H5Dread(s->dataset, s->type, s->memory, s->space, H5P_DEFAULT, s->bytes));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Sclose(s->memory));
  PetscFunctionReturn(0);
}

static PetscErrorCode ScanBlocks(const char path[], Scan *s, PetscInt count, LamRecordVisitor visit, void *ctx)
{
  PetscFunctionBeginUser;
  for (PetscInt first = 0; first < count; first += BLOCK) {
    const PetscInt n = PetscMin(BLOCK, count - first);

    PetscCall(ReadBlock(path, s, (hsize_t)first, (hsize_t)n));
    PetscCall(LamRecordsCheck(path, &s->layout, first, n, s->bytes));
    PetscCall(visit(ctx, &s->layout, first, n, s->bytes));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileScanRecords(const char path[], hid_t file, PetscInt count, LamRecordVisitor visit, void *ctx)
{
  Scan scan = {.dataset = H5I_INVALID_HID, .type = H5I_INVALID_HID, .space = H5I_INVALID_HID};
  PetscErrorCode ierr = ScanOpen(path, file, &scan);

  PetscFunctionBeginUser;
  if (!ierr) ierr = ScanBlocks(path, &scan, count, visit, ctx);
  PetscCall(ScanClose(&scan)); /* also of damaged records: a program may go on without this file */
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
