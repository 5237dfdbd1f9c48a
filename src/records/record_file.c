/*
  Record files in HDF5: open, close, sync.
*/
#include "record_internal.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static PetscErrorCode AccessList(const char path[], hid_t *access)
{
  PetscFunctionBeginUser;
  H5dont_atexit();                       /* our files are closed; HDF5 must not retry a failed one at exit */
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* our messages contain the reasons */
  LamCallHDF5(path, PETSC_ERR_LIB, *access = H5Pcreate(H5P_FILE_ACCESS));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pset_file_locking(*access, 0, 1));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Pset_fclose_degree(*access, H5F_CLOSE_STRONG));
  PetscFunctionReturn(0);
}

/* Without O_NONBLOCK opening a pipe would wait for a writer. */
PetscErrorCode LamFileOpen(const char path[], PetscBool write, hid_t *file)
{
  const int fd = open(path, (write ? O_RDWR : O_RDONLY) | O_CLOEXEC | O_NONBLOCK);
  struct stat status;
  char reason[LAM_HDF5_REASON_LENGTH];
  unsigned char byte;
  PetscBool is_hdf5;
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
  is_hdf5 = (PetscBool)(H5Fis_hdf5(path) > 0);
  *file = is_hdf5 ? H5Fopen(path, write ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access) : H5I_INVALID_HID;
  if (*file < 0) LamHDF5Reason(reason);
  PetscCall(LamCloseHDF5(path, access));
  PetscCheck(is_hdf5, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: is not an HDF5 file; a file written by lamella is wanted", path);
  /* a file opened for writing was readable before */
  PetscCheck(*file >= 0 || !write, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", path, reason);
  PetscCheck(*file >= 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: the file is damaged or cut short: %s", path,
             reason);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileOpenNew(const char path[], hid_t *file)
{
  hid_t access;

  PetscFunctionBeginUser;
  PetscCall(AccessList(path, &access));
  LamCallHDF5(path, PETSC_ERR_FILE_OPEN, *file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access));
  PetscCall(LamCloseHDF5(path, access));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileSync(const char path[], hid_t file)
{
  int *fd;

  PetscFunctionBeginUser;
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Fflush(file, H5F_SCOPE_GLOBAL));
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Fget_vfd_handle(file, H5P_DEFAULT, (void **)&fd));
  PetscCheck(!LamFsync(*fd), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s", path, strerror(errno));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileRead(const char path[], LamFileFunction read, void *ctx)
{
  hid_t file = H5I_INVALID_HID;
  const int lock = LamLockBeginRead(path);
  PetscErrorCode ierr = LamFileOpen(path, PETSC_FALSE, &file);

  PetscFunctionBeginUser;
  if (!ierr) ierr = read(path, file, ctx);
  if (file >= 0) H5Fclose(file);
  LamLockEndRead(lock);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileWrite(const char path[], LamFileFunction write, void *ctx)
{
  PetscErrorCode ierr;
  hid_t file;

  PetscFunctionBeginUser;
  PetscCall(LamFileOpen(path, PETSC_TRUE, &file));
  ierr = write(path, file, ctx);
  if (!ierr) ierr = LamFileSync(path, file);
  if (ierr) H5Fclose(file);
  PetscCall(ierr);
  PetscCall(LamCloseHDF5(path, file));
  PetscFunctionReturn(0);
}
