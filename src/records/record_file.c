/*
  Record files as a whole: open, close, sync, header. Provenance is written once, when the file is made.
*/
#include "record_internal.h"
#include "whole.h"
#include <errno.h>
#include <fcntl.h>
#include <lamella/version.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define TABLE_BYTES 131072 /* more than the header, or the index and attributes of a commit, take */

/* ---- open, close, sync ---- */

static PetscErrorCode AccessList(const char path[], hid_t *access)
{
  PetscFunctionBeginUser;
  H5dont_atexit(); /* our files are closed; a file that failed must not be tried again when the program ends */
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* reasons go into our messages */
  LamCallHDF5(path, PETSC_ERR_LIB, *access = H5Pcreate(H5P_FILE_ACCESS));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pset_file_locking(*access, 0, 1));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pset_fclose_degree(*access, H5F_CLOSE_STRONG));
  PetscFunctionReturn(0);
}

/* Without O_NONBLOCK a pipe would wait for someone to write into it. */
static PetscErrorCode FileOpen(const char path[], PetscBool write, hid_t *file)
{
  const int fd = open(path, (write ? O_RDWR : O_RDONLY) | O_CLOEXEC | O_NONBLOCK);
  struct stat status;
  unsigned char byte;
  hid_t access;

  PetscFunctionBeginUser;
  PetscCheck(fd >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", path, strerror(errno));
  if (!fstat(fd, &status) && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) {
    close(fd);
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
            "%s: is a device, pipe or socket; a file written by lamella is wanted", path);
  }
  if (read(fd, &byte, 1) < 0) {
    const int error = errno;

    close(fd);
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s: %s", path, strerror(error));
  }
  close(fd);
  PetscCall(AccessList(path, &access));
  if (H5Fis_hdf5(path) <= 0) {
    H5Pclose(access);
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: is not an HDF5 file; a file written by lamella is wanted",
            path);
  }
  *file = H5Fopen(path, write ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access);
  if (*file < 0) {
    char reason[LAM_HDF5_REASON_LENGTH];

    LamHDF5Reason(reason);
    H5Pclose(access);
    /* a file that is opened for writing has been read before */
    PetscCheck(!write, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", path, reason);
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: the file is damaged or cut short: %s", path, reason);
  }
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pclose(access));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileOpenRead(const char path[], hid_t *file)
{
  PetscFunctionBeginUser;
  PetscCall(FileOpen(path, PETSC_FALSE, file));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileOpenWrite(const char path[], hid_t *file)
{
  PetscFunctionBeginUser;
  PetscCall(FileOpen(path, PETSC_TRUE, file));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileReserve(const char path[], PetscBool create, size_t bytes)
{
  const int fd = open(path, O_RDWR | O_CLOEXEC | (create ? O_CREAT | O_TRUNC : 0), 0666);
  off_t end;
  int error;

  PetscFunctionBeginUser;
  PetscCheck(fd >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", path, strerror(errno));
  end = lseek(fd, 0, SEEK_END);
  error = LamWholeReserve(fd, end, (off_t)(bytes + TABLE_BYTES)); /* what is not used HDF5 cuts off when it closes */
  if (error && ftruncate(fd, end)) error = errno;
  close(fd);
  PetscCheck(!error, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", path, strerror(error));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileClose(const char path[], hid_t file)
{
  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Fclose(file));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileSync(const char path[], hid_t file)
{
  int *fd;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Fflush(file, H5F_SCOPE_GLOBAL));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Fget_vfd_handle(file, H5P_DEFAULT, (void **)&fd));
  PetscCheck(!LamWholeSync(*fd), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", path, strerror(errno));
  PetscFunctionReturn(0);
}

/* ---- making a file ---- */

void LamTimeNow(char text[LAM_TIME_LENGTH])
{
  const time_t now = time(NULL);
  struct tm utc;

  gmtime_r(&now, &utc);
  strftime(text, LAM_TIME_LENGTH, "%Y-%m-%dT%H:%M:%SZ", &utc);
}

/* The command line of this process, blanks between the arguments. */
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

/* The counter and what it is tested with are written over at each commit. */
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
  PetscCall(LamSumWrite(path, dataset, LAM_TYPE_SUM, sum)); /* before the counter, which so lies in one sector */
  PetscCall(WriteCounter(path, dataset));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dclose(dataset));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Pclose(list));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Sclose(space));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Tclose(type));
  PetscFunctionReturn(0);
}

/*
  The records come first: so the counter and its checksums lie at the same place in every file, within one page of
  memory, where HDF5 writes them by one call. A kill cannot come between them.
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
  hid_t access, file;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(AccessList(path, &access));
  LamCallHDF5(path, PETSC_ERR_FILE_OPEN, file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pclose(access));
  ierr = WriteAll(path, file, kind, scene);
  if (ierr) H5Fclose(file);
  PetscCall(ierr);
  PetscCall(LamFileClose(path, file));
  PetscFunctionReturn(0);
}
