/*
  Room for records.

  Method
    HDF5 changes its index of chunks and the end of the file in several writes, between which the file cannot be read.
  So no file that has its name is ever extended: a copy gets the room, is brought to the disk and takes the name. What
  is left for a commit are writes over bytes that are there, none of which can harm what was committed. Half as much
    again at a time: all copies of a file that grows amount to some three times its size.
*/
#include "record_internal.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { COPY_BYTES = 1 << 20 };

PetscErrorCode LamFileReadRoom(const char path[], hid_t file, PetscInt *room)
{
  hid_t dataset, space;
  hssize_t extent;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, dataset = H5Dopen2(file, "/records", H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, space = H5Dget_space(dataset));
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, extent = H5Sget_simple_extent_npoints(space));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Sclose(space));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Dclose(dataset));
  *room = (PetscInt)extent;
  PetscFunctionReturn(0);
}

/* ---- in the file itself ---- */

/* HDF5 gives a chunk its place, and fills it, when its first record is written: it is the first of `chunks` from
   `before` on. */
static PetscErrorCode TouchChunks(const char path[], hid_t dataset, hsize_t before, hsize_t chunks)
{
  const hsize_t stride = LAM_RECORDS_PER_CHUNK;
  hid_t type, space, memory;
  char *zeros;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, type = H5Dget_type(dataset));
  PetscCall(PetscCalloc1((size_t)chunks * H5Tget_size(type), &zeros));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, space = H5Dget_space(dataset));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, memory = H5Screate_simple(1, &chunks, NULL));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Sselect_hyperslab(space, H5S_SELECT_SET, &before, &stride, &chunks, NULL));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dwrite(dataset, type, memory, space, H5P_DEFAULT, zeros));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Sclose(memory));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Sclose(space));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(type));
  PetscCall(PetscFree(zeros));
  PetscFunctionReturn(0);
}

static PetscErrorCode Extend(const char path[], hid_t file, PetscInt before, PetscInt room)
{
  const hsize_t extent = (hsize_t)room, chunk = LAM_RECORDS_PER_CHUNK;
  const hsize_t first = ((hsize_t)before + chunk - 1) / chunk * chunk; /* before it is a chunk that is there */
  hid_t dataset;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, dataset = H5Dopen2(file, "/records", H5P_DEFAULT));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dset_extent(dataset, &extent));
  if (first < extent) PetscCall(TouchChunks(path, dataset, first, (extent - first + chunk - 1) / chunk));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Dclose(dataset));
  PetscCall(LamFileSync(path, file));
  PetscFunctionReturn(0);
}

static PetscErrorCode ExtendFile(const char path[], PetscInt before, PetscInt room)
{
  PetscErrorCode ierr;
  hid_t file;

  PetscFunctionBeginUser;
  PetscCall(LamFileReserve(path, PETSC_FALSE, (size_t)(room - before + LAM_RECORDS_PER_CHUNK) * LAM_RECORD_BYTES));
  PetscCall(LamFileOpenWrite(path, &file));
  ierr = Extend(path, file, before, room);
  if (ierr) H5Fclose(file);
  PetscCall(ierr);
  PetscCall(LamFileClose(path, file));
  PetscFunctionReturn(0);
}

/* ---- in a copy ---- */

int LamWriteBytes(int fd, const void *bytes, size_t n)
{
  ssize_t part;

  for (size_t done = 0; done < n; done += (size_t)part) {
    part = write(fd, (const char *)bytes + done, n - done);
    if (part < 0 && errno != EINTR) return errno;
    part = PetscMax(part, 0);
  }
  return 0;
}

/* 0, or the reason as errno has it. */
static int CopyBytes(int in, int out, char bytes[COPY_BYTES])
{
  int error = 0;
  ssize_t n;

  while (!error && (n = read(in, bytes, COPY_BYTES)) > 0) error = LamWriteBytes(out, bytes, (size_t)n);
  return error || !n ? error : errno;
}

PetscErrorCode LamFileCopy(const char from[], const char to[])
{
  const int in = open(from, O_RDONLY | O_CLOEXEC);
  int out, error;
  struct stat info;
  char *bytes;

  PetscFunctionBeginUser;
  PetscCheck(in >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s: %s", from, strerror(errno));
  PetscCall(PetscMalloc1(COPY_BYTES, &bytes));
  out = open(to, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  error = out < 0 || fstat(in, &info) || fchmod(out, info.st_mode & 07777) ? errno : CopyBytes(in, out, bytes);
  close(in);
  if (out >= 0) close(out);
  PetscCall(PetscFree(bytes));
  PetscCheck(!error, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", to, strerror(error));
  PetscFunctionReturn(0);
}

static PetscErrorCode ExtendCopy(const char path[], const char temporary[], PetscInt before, PetscInt room)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  ierr = LamFileCopy(path, temporary);
  if (!ierr) ierr = ExtendFile(temporary, before, room);
  if (!ierr) ierr = LamFilePublish(temporary, path);
  if (ierr) unlink(temporary);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileMakeRoom(const char path[], const char temporary[], PetscInt records, PetscInt *room)
{
  const PetscInt chunk = LAM_RECORDS_PER_CHUNK, before = *room;
  PetscInt wanted;

  PetscFunctionBeginUser;
  if (records <= before) PetscFunctionReturn(0);
  wanted = (PetscMax(records, before + before / 2) + chunk - 1) / chunk * chunk;
  if (path)
    PetscCall(ExtendCopy(path, temporary, before, wanted));
  else
    PetscCall(ExtendFile(temporary, before, wanted));
  *room = wanted;
  PetscFunctionReturn(0);
}
