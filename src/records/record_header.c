/*
  The header of record files: provenance, units, microstructure and the commit counter. It is written once, when the
  file is created; commits only overwrite the counter. Every size and type is checked before it is used.
*/
#include "record_internal.h"
#include <lamella/version.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

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

static void MPIVersion(size_t size, char text[])
{
  char version[MPI_MAX_LIBRARY_VERSION_STRING] = "unknown";
  int length;

  MPI_Get_library_version(version, &length); /* allowed before MPI_Init */
  version[strcspn(version, ",\n")] = '\0';
  snprintf(text, size, "%s", version);
}

static PetscErrorCode WriteProvenance(const char path[], hid_t file)
{
  char text[4096], now[LAM_TIME_LENGTH];
  unsigned major, minor, release;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeWriteText(path, file, "creator", "lamella " LAMELLA_VERSION));
  LamTimeNow(now);
  PetscCall(LamAttributeWriteText(path, file, "created", now));
  if (gethostname(text, sizeof(text) - 1)) snprintf(text, sizeof(text), "unknown");
  PetscCall(LamAttributeWriteText(path, file, "host", text));
  CommandLine(sizeof(text), text);
  PetscCall(LamAttributeWriteText(path, file, "command", text));
  snprintf(text, sizeof(text), "%d.%d.%d", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR);
  PetscCall(LamAttributeWriteText(path, file, "petsc_version", text));
  LamCallHDF5(path, PETSC_ERR_LIB, H5get_libversion(&major, &minor, &release));
  snprintf(text, sizeof(text), "%u.%u.%u", major, minor, release);
  PetscCall(LamAttributeWriteText(path, file, "hdf5_version", text));
  MPIVersion(sizeof(text), text);
  PetscCall(LamAttributeWriteText(path, file, "mpi_version", text));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteHeader(const char path[], hid_t file, const char kind[], const LamScene *scene)
{
  const int version = LAM_FORMAT_VERSION;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeWriteText(path, file, "format", LAM_FORMAT_NAME));
  PetscCall(LamAttributeWriteNumber(path, file, "format_version", H5T_STD_I32LE, H5T_NATIVE_INT, &version));
  PetscCall(LamAttributeWriteText(path, file, "kind", kind));
  PetscCall(WriteProvenance(path, file));
  PetscCall(LamAttributeWriteText(path, file, "units",
                                  "nondimensional: lengths in length_unit_m, stresses in stress_unit_Pa"));
  PetscCall(LamAttributeWriteText(path, file, "index_order",
                                  "row-major, 11 12 13 21 22 23 31 32 33; tangent[i][j][k][l] = dP_ij/dF_kl"));
  PetscCall(
      LamAttributeWriteNumber(path, file, "length_unit_m", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &scene->scales.length));
  PetscCall(
      LamAttributeWriteNumber(path, file, "stress_unit_Pa", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &scene->scales.stress));
  PetscCall(LamAttributeWriteNumber(path, file, "macro_length_unit_m", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
                                    &scene->scales.macro_length));
  PetscCall(LamAttributeWriteNumber(path, file, "accuracy", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &scene->accuracy));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteMicrostructure(const char path[], hid_t file, const LamScene *scene)
{
  char hash[LAM_HASH_LENGTH], name[64], *json;

  PetscFunctionBeginUser;
  PetscCall(LamMicrostructureDescribe(&scene->micro, &json, hash));
  snprintf(name, sizeof(name), "/microstructures/%s/description", hash);
  PetscCall(LamFileWriteText(path, file, name, json));
  PetscCall(PetscFree(json));
  PetscCall(LamAttributeWriteText(path, file, "microstructure", hash));
  if (scene->text) PetscCall(LamFileWriteText(path, file, "/scene", scene->text));
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

static PetscErrorCode WriteEmptyRecords(const char path[], hid_t file)
{
  const hsize_t none = 0, unlimited = H5S_UNLIMITED, chunk = LAM_RECORDS_PER_CHUNK;
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
  PetscCall(LamSumWrite(path, dataset, LAM_TYPE_SUM, sum)); /* before the counter, which then lies in one sector */
  PetscCall(WriteCounter(path, dataset));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dclose(dataset));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Pclose(list));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Sclose(space));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Tclose(type));
  PetscFunctionReturn(0);
}

/*
  The records are created first: the counter and its checksums then have the same offset in every file, within one
  page of memory, where HDF5 writes them by one call. A kill cannot interrupt it.
*/
static PetscErrorCode WriteAll(const char path[], hid_t file, const char kind[], const LamScene *scene)
{
  uint32_t sum;

  PetscFunctionBeginUser;
  PetscCall(WriteEmptyRecords(path, file));
  PetscCall(WriteHeader(path, file, kind, scene));
  PetscCall(WriteMicrostructure(path, file, scene));
  PetscCall(LamHeaderSum(path, file, &sum));
  PetscCall(LamSumWrite(path, file, LAM_SUM, sum));
  PetscCall(LamFileSync(path, file));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileCreate(const char path[], const char kind[], const LamScene *scene)
{
  PetscErrorCode ierr;
  hid_t file;

  PetscFunctionBeginUser;
  PetscCall(LamFileOpenNew(path, &file));
  ierr = WriteAll(path, file, kind, scene);
  if (ierr) H5Fclose(file);
  PetscCall(ierr);
  PetscCall(LamFileClose(path, file));
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
  PetscCall(PetscFree(header->command));
  PetscCall(PetscFree(header->description));
  PetscCall(LamMicrostructureDestroy(&header->micro));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadProvenance(const char path[], hid_t file, LamHeader *h)
{
  PetscFunctionBeginUser;
  PetscCall(LamAttributeCopyText(path, file, "creator", sizeof(h->creator), h->creator));
  PetscCall(LamAttributeCopyText(path, file, "created", sizeof(h->created), h->created));
  PetscCall(LamAttributeCopyText(path, file, "host", sizeof(h->host), h->host));
  PetscCall(LamAttributeCopyText(path, file, "petsc_version", sizeof(h->petsc), h->petsc));
  PetscCall(LamAttributeCopyText(path, file, "hdf5_version", sizeof(h->hdf5), h->hdf5));
  PetscCall(LamAttributeCopyText(path, file, "mpi_version", sizeof(h->mpi), h->mpi));
  PetscCall(LamAttributeReadText(path, file, "command", &h->command));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadScales(const char path[], hid_t file, LamHeader *h)
{
  const struct {
    const char *name;
    PetscReal *value;
    PetscBool is_unit; /* positive, however small */
  } rows[] = {{"length_unit_m", &h->scales.length, PETSC_TRUE},
              {"stress_unit_Pa", &h->scales.stress, PETSC_TRUE},
              {"macro_length_unit_m", &h->scales.macro_length, PETSC_FALSE},
              {"accuracy", &h->accuracy, PETSC_FALSE}};

  PetscFunctionBeginUser;
  for (size_t i = 0; i < sizeof(rows) / sizeof(rows[0]); i++) {
    PetscCall(LamAttributeReadNumber(path, file, rows[i].name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, rows[i].value));
    PetscCheck(isfinite(*rows[i].value) && *rows[i].value >= 0 && (!rows[i].is_unit || *rows[i].value > 0),
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
  PetscCall(LamAttributeCopyText(path, file, "microstructure", sizeof(h->hash), h->hash));
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

/* Other versions may have other attributes, so the version is checked before the checksum. */
static PetscErrorCode CheckFormat(const char path[], hid_t file, PetscInt *format_version)
{
  char format[16] = "";
  PetscBool has;
  int version;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeHas(path, file, "format", &has));
  if (has) PetscCall(LamAttributeCopyText(path, file, "format", sizeof(format), format));
  PetscCheck(!strcmp(format, LAM_FORMAT_NAME), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: was not written by lamella (attribute \"format\" is \"%s\", not \"%s\")", path, format,
             LAM_FORMAT_NAME);
  PetscCall(LamAttributeReadNumber(path, file, "format_version", H5T_STD_I32LE, H5T_NATIVE_INT, &version));
  PetscCheck(version == LAM_FORMAT_VERSION, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has format version %d; this lamella reads version %d", path, version, LAM_FORMAT_VERSION);
  *format_version = version;
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckSum(const char path[], hid_t file, PetscBool *matches)
{
  PetscBool sound;
  uint32_t sum;

  PetscFunctionBeginUser;
  PetscCall(LamHeaderSum(path, file, &sum));
  PetscCall(LamSumMatches(path, file, LAM_SUM, sum, &sound));
  if (matches) *matches = sound;
  PetscCheck(sound || matches, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the header is damaged (an attribute of the root has been changed: its checksum differs)" LAM_SALVAGE,
             path);
  PetscFunctionReturn(0);
}

PetscErrorCode LamHeaderReadRoot(const char path[], hid_t file, PetscBool *matches, LamHeader *header)
{
  PetscFunctionBeginUser;
  memset(header, 0, sizeof(*header));
  PetscCall(CheckFormat(path, file, &header->format_version));
  PetscCall(LamAttributeCopyText(path, file, "kind", sizeof(header->kind), header->kind));
  PetscCall(ReadProvenance(path, file, header));
  PetscCall(ReadScales(path, file, header));
  PetscCall(CheckSum(path, file, matches));
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
