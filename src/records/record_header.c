/*
  The header of record files: provenance, units, microstructure and the commit counter. It is written once, when the
  file is created; commits only overwrite the counter. Every size and type is checked before it is used.
*/
#include "record_internal.h"
#include <lamella/version.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define DESCRIPTION "/microstructures/%s/description"

typedef enum { TEXT, REAL, INT } Kind;

/* The attributes of the root, in the order of their checksum. */
static const struct {
  const char *name;
  Kind kind;
  size_t offset;
} attributes[] = {{"format", TEXT, offsetof(LamHeader, format)},
                  {"format_version", INT, offsetof(LamHeader, format_version)},
                  {"kind", TEXT, offsetof(LamHeader, kind)},
                  {"creator", TEXT, offsetof(LamHeader, creator)},
                  {"created", TEXT, offsetof(LamHeader, created)},
                  {"host", TEXT, offsetof(LamHeader, host)},
                  {"command", TEXT, offsetof(LamHeader, command)},
                  {"petsc_version", TEXT, offsetof(LamHeader, petsc)},
                  {"hdf5_version", TEXT, offsetof(LamHeader, hdf5)},
                  {"mpi_version", TEXT, offsetof(LamHeader, mpi)},
                  {"units", TEXT, offsetof(LamHeader, units)},
                  {"index_order", TEXT, offsetof(LamHeader, index_order)},
                  {"length_unit_m", REAL, offsetof(LamHeader, scales.length)},
                  {"stress_unit_Pa", REAL, offsetof(LamHeader, scales.stress)},
                  {"macro_length_unit_m", REAL, offsetof(LamHeader, scales.macro_length)},
                  {"accuracy", REAL, offsetof(LamHeader, accuracy)},
                  {"microstructure", TEXT, offsetof(LamHeader, hash)}};

/* ---- writing ---- */

/* The command line of this process, arguments separated by blanks. */
static void CommandLine(size_t size, char text[])
{
  FILE *file = fopen("/proc/self/cmdline", "r");
  const size_t n = file ? fread(text, 1, size - 1, file) : 0;

  if (file) fclose(file);
  text[n] = '\0';
  for (size_t i = 0; i + 1 < n; i++)
    if (!text[i]) text[i] = ' ';
}

static PetscErrorCode WriteAttributes(const char path[], hid_t file, const LamHeader *h)
{
  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(attributes); i++) {
    const char *name = attributes[i].name;
    const void *value = (const char *)h + attributes[i].offset;
    const PetscBool real = (PetscBool)(attributes[i].kind == REAL);

    if (attributes[i].kind == TEXT)
      PetscCall(LamAttributeWriteText(path, file, name, *(char *const *)value));
    else
      PetscCall(LamAttributeWriteNumber(path, file, name, real ? H5T_IEEE_F64LE : H5T_STD_I32LE,
                                        real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT32, value));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteHeader(const char path[], hid_t file, const char kind[], const LamScene *scene, char hash[])
{
  char now[LAM_TIME_LENGTH], host[256], command[4096], petsc[32], hdf5[32], mpi[MPI_MAX_LIBRARY_VERSION_STRING];
  const LamHeader header = {
      .format = LAM_FORMAT_NAME,
      .format_version = LAM_FORMAT_VERSION,
      .kind = (char *)kind,
      .creator = "lamella " LAMELLA_VERSION,
      .created = now,
      .host = host,
      .command = command,
      .petsc = petsc,
      .hdf5 = hdf5,
      .mpi = mpi,
      .units = "nondimensional: lengths in length_unit_m, stresses in stress_unit_Pa",
      .index_order = "row-major, 11 12 13 21 22 23 31 32 33; tangent[i][j][k][l] = dP_ij/dF_kl",
      .scales = scene->scales,
      .accuracy = scene->accuracy,
      .hash = hash,
  };
  unsigned major, minor, release;
  int length;

  PetscFunctionBeginUser;
  LamTimeNow(now);
  if (gethostname(host, sizeof(host) - 1)) snprintf(host, sizeof(host), "unknown");
  CommandLine(sizeof(command), command);
  snprintf(petsc, sizeof(petsc), "%d.%d.%d", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR);
  LamCallHDF5(path, PETSC_ERR_LIB, H5get_libversion(&major, &minor, &release));
  snprintf(hdf5, sizeof(hdf5), "%u.%u.%u", major, minor, release);
  MPI_Get_library_version(mpi, &length); /* allowed before MPI_Init */
  mpi[strcspn(mpi, ",\n")] = '\0';
  PetscCall(WriteAttributes(path, file, &header));
  PetscFunctionReturn(0);
}

/* Each commit overwrites the counter and its checksums. */
static PetscErrorCode WriteCounter(const char path[], hid_t dataset)
{
  const PetscInt64 none = 0;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeWriteNumber(path, dataset, "committed", H5T_STD_I64LE, H5T_NATIVE_INT64, &none));
  PetscCall(LamSumWrite(path, dataset, LAM_COUNTER_SUM, LamBytesSum(0, &none, sizeof(none))));
  PetscCall(LamSumWrite(path, dataset, LAM_RECORDS_SUM, 0));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteEmptyRecords(const char path[], hid_t file, const LamScales *scales)
{
  const hsize_t none = 0, unlimited = H5S_UNLIMITED, chunk = LAM_RECORDS_PER_CHUNK;
  const PetscInt64 padding = 0;
  hid_t type, space, list, dataset;
  uint32_t sum;

  PetscFunctionBeginUser;
  PetscCall(LamRecordTypeCreate(&type));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, space = H5Screate_simple(1, &none, &unlimited));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, list = H5Pcreate(H5P_DATASET_CREATE));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Pset_chunk(list, 1, &chunk));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE,
              dataset = H5Dcreate2(file, "/records", type, space, H5P_DEFAULT, list, H5P_DEFAULT));
  PetscCall(LamRecordTypeSum(type, &sum));
  PetscCall(LamSumWrite(path, dataset, LAM_TYPE_SUM, sum));
  PetscCall(LamAttributeWriteNumber(path, dataset, "padding", H5T_STD_I64LE, H5T_NATIVE_INT64, &padding));
  PetscCall(WriteCounter(path, dataset)); /* behind as much as puts it into one sector */
  PetscCall(LamRecordUnitsWrite(path, dataset, scales));
  PetscCall(LamCloseHDF5(path, dataset, list, space, type));
  PetscFunctionReturn(0);
}

/*
  The records are created first: the counter and its checksums then have the same offset in every file, within one
  page of memory, where HDF5 writes them by one call. A kill cannot interrupt it.
*/
static PetscErrorCode WriteAll(const char path[], hid_t file, const char kind[], const LamScene *scene,
                               const char json[], char hash[])
{
  char name[64], *files;
  uint32_t sum;

  PetscFunctionBeginUser;
  PetscCall(WriteEmptyRecords(path, file, &scene->scales));
  snprintf(name, sizeof(name), DESCRIPTION, hash);
  PetscCall(LamFileWriteText(path, file, name, json));
  if (scene->text) PetscCall(LamFileWriteText(path, file, "/scene", scene->text));
  if (scene->file_count) {
    PetscCall(LamSceneDescribeFiles(scene, &files));
    PetscCall(LamFileWriteText(path, file, LAM_SCENE_FILES, files));
    PetscCall(PetscFree(files));
  }
  PetscCall(WriteHeader(path, file, kind, scene, hash));
  PetscCall(LamHeaderSum(path, file, &sum));
  PetscCall(LamSumWrite(path, file, LAM_SUM, sum));
  PetscCall(LamFileSync(path, file));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileCreate(const char path[], const char kind[], const LamScene *scene)
{
  char hash[LAM_HASH_LENGTH], *json;
  hid_t file = H5I_INVALID_HID;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(LamMicrostructureDescribe(&scene->micro, &json, hash));
  ierr = LamFileReserve(path, PETSC_TRUE, strlen(json) + (scene->text ? strlen(scene->text) : 0));
  if (!ierr) ierr = LamFileOpenNew(path, &file);
  if (!ierr) ierr = WriteAll(path, file, kind, scene, json, hash);
  PetscCall(PetscFree(json));
  if (ierr && file >= 0) H5Fclose(file);
  PetscCall(ierr);
  PetscCall(LamCloseHDF5(path, file));
  PetscFunctionReturn(0);
}

/* Files of earlier versions have no checksums of the counter, and get none: the counter has to be written by one
   call. */
PetscErrorCode LamCounterWrite(const char path[], hid_t dataset, PetscInt committed, uint32_t records_sum)
{
  const PetscInt64 count = committed;
  const uint32_t sum = LamBytesSum(0, &count, sizeof(count));
  PetscBool has;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeUpdate(path, dataset, "committed", H5T_NATIVE_INT64, &count));
  PetscCall(LamAttributeHas(path, dataset, LAM_COUNTER_SUM, &has));
  if (has) PetscCall(LamAttributeUpdate(path, dataset, LAM_COUNTER_SUM, H5T_NATIVE_UINT32, &sum));
  PetscCall(LamAttributeHas(path, dataset, LAM_RECORDS_SUM, &has));
  if (has) PetscCall(LamAttributeUpdate(path, dataset, LAM_RECORDS_SUM, H5T_NATIVE_UINT32, &records_sum));
  PetscFunctionReturn(0);
}

/* ---- reading ---- */

PetscErrorCode LamHeaderDestroy(LamHeader *header)
{
  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(attributes); i++)
    if (attributes[i].kind == TEXT) PetscCall(PetscFree(*(char **)((char *)header + attributes[i].offset)));
  PetscCall(PetscFree(header->description));
  PetscCall(LamMicrostructureDestroy(&header->micro));
  PetscFunctionReturn(0);
}

/* *sum: their checksum. */
static PetscErrorCode ReadAttributes(const char path[], hid_t file, LamHeader *h, uint32_t *sum)
{
  PetscFunctionBeginUser;
  *sum = 0;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(attributes); i++) {
    const char *name = attributes[i].name;
    void *value = (char *)h + attributes[i].offset;
    const PetscBool real = (PetscBool)(attributes[i].kind == REAL);

    if (attributes[i].kind == TEXT) {
      PetscCall(LamAttributeReadText(path, file, name, value));
      *sum = LamBytesSum(*sum, *(char **)value, strlen(*(char **)value) + 1);
    } else {
      PetscCall(LamAttributeReadNumber(path, file, name, real ? H5T_IEEE_F64LE : H5T_STD_I32LE,
                                       real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT32, value));
      *sum = LamBytesSum(*sum, value, real ? sizeof(double) : sizeof(int32_t));
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamHeaderSum(const char path[], hid_t file, uint32_t *sum)
{
  LamHeader header = {0};
  PetscErrorCode ierr = ReadAttributes(path, file, &header, sum);

  PetscFunctionBeginUser;
  PetscCall(LamHeaderDestroy(&header));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* Units are positive, however small; a macroscopic length or accuracy of 0 is unknown. */
static PetscErrorCode CheckNumbers(const char path[], const LamHeader *h)
{
  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(attributes); i++) {
    const PetscReal *value = (const PetscReal *)(const void *)((const char *)h + attributes[i].offset);

    if (attributes[i].kind != REAL) continue;
    PetscCheck(isfinite(*value) && *value >= 0 &&
                   (*value > 0 || (value != &h->scales.length && value != &h->scales.stress)),
               PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: attribute \"%s\" is %g; the file is damaged", path,
               attributes[i].name, (double)*value);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadMicrostructure(const char path[], hid_t file, LamHeader *h)
{
  char name[64], hash[LAM_HASH_LENGTH], *json;
  H5G_info_t info;

  PetscFunctionBeginUser;
  snprintf(name, sizeof(name), DESCRIPTION, h->hash);
  PetscCall(LamFileGetText(path, file, name, &h->description));
  PetscCheck(h->description, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s is missing; the file is damaged", path,
             name);
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

/* Other versions may have other attributes, so the version is checked before all of them are read. */
static PetscErrorCode CheckFormat(const char path[], hid_t file)
{
  char *format = NULL, name[16] = "";
  PetscBool has;
  int version;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeHas(path, file, "format", &has));
  if (has) PetscCall(LamAttributeReadText(path, file, "format", &format));
  if (has) snprintf(name, sizeof(name), "%s", format);
  PetscCall(PetscFree(format));
  PetscCheck(!strcmp(name, LAM_FORMAT_NAME), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: was not written by lamella (attribute \"format\" is \"%s\", not \"%s\")", path, name,
             LAM_FORMAT_NAME);
  PetscCall(LamAttributeReadNumber(path, file, "format_version", H5T_STD_I32LE, H5T_NATIVE_INT, &version));
  PetscCheck(version == LAM_FORMAT_VERSION, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has format version %d; this lamella reads version %d", path, version, LAM_FORMAT_VERSION);
  PetscFunctionReturn(0);
}

PetscErrorCode LamHeaderReadRoot(const char path[], hid_t file, PetscBool *matches, LamHeader *header)
{
  PetscBool sound;
  uint32_t sum;

  PetscFunctionBeginUser;
  memset(header, 0, sizeof(*header));
  PetscCall(CheckFormat(path, file));
  PetscCall(ReadAttributes(path, file, header, &sum));
  PetscCall(CheckNumbers(path, header));
  PetscCall(LamSumMatches(path, file, LAM_SUM, sum, &sound));
  if (matches) *matches = sound;
  PetscCheck(sound || matches, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the header is damaged (an attribute of the root has been changed: its checksum differs)" LAM_SALVAGE,
             path);
  PetscCall(ReadMicrostructure(path, file, header));
  PetscFunctionReturn(0);
}

PetscErrorCode LamHeaderRead(const char path[], hid_t file, LamHeader *header)
{
  PetscFunctionBeginUser;
  PetscCall(LamHeaderReadRoot(path, file, NULL, header));
  PetscCall(LamCommittedRead(path, file, &header->committed));
  PetscFunctionReturn(0);
}

static PetscErrorCode GetKind(const char path[], hid_t file, void *kind)
{
  LamHeader header;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = LamHeaderRead(path, file, &header);
  if (!ierr) ierr = PetscStrncpy(kind, header.kind, LAM_NAME_LENGTH);
  PetscCall(LamHeaderDestroy(&header));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReadKind(const char path[], char kind[LAM_NAME_LENGTH])
{
  PetscFunctionBeginUser;
  PetscCall(LamFileRead(path, GetKind, kind));
  PetscFunctionReturn(0);
}
