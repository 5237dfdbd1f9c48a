/*
  Every call of HDF5 goes through LamCallHDF5: memory is limited, and a negative return becomes a PETSc error that names
  the file and HDF5's own reason.
*/
#ifndef LAM_H5CHECK_H
#define LAM_H5CHECK_H

#include <petscsys.h>
#include <hdf5.h>
#include <sys/resource.h>

#define LAM_HDF5_REASON_LENGTH 256

/* Between Begin and End the address space may grow by at most 256 MB, or less if a batch system's limit is lower. */
typedef struct {
  struct rlimit before;
  PetscBool is_set;
} LamMemoryBound;

LamMemoryBound LamMemoryBoundBegin(void);
void LamMemoryBoundEnd(const LamMemoryBound *bound);

/* The innermost reason on HDF5's error stack: the system's message ("No space left on device") if there is one. */
void LamHDF5Reason(char reason[LAM_HDF5_REASON_LENGTH]);

/*
  LamCallHDF5(path, PETSC_ERR_FILE_WRITE, H5Fflush(file, H5F_SCOPE_GLOBAL));
  LamCallHDF5(path, PETSC_ERR_FILE_READ, dataset = H5Dopen2(file, "/records", H5P_DEFAULT));
*/
#define LamCallHDF5(path, code, ...)                                                                                   \
  do {                                                                                                                 \
    const LamMemoryBound bound_ = LamMemoryBoundBegin();                                                               \
    const PetscBool fails_ = (PetscBool)((__VA_ARGS__) < 0);                                                           \
                                                                                                                       \
    LamMemoryBoundEnd(&bound_);                                                                                        \
    if (fails_) {                                                                                                      \
      char reason_[LAM_HDF5_REASON_LENGTH];                                                                            \
      LamHDF5Reason(reason_);                                                                                          \
      SETERRQ(PETSC_COMM_SELF, code, "%s: %s", path, reason_);                                                         \
    }                                                                                                                  \
  } while (0)

/* Closes files, datasets, types and other objects in this order, skipping those that were not opened (negative). */
#define LamCloseHDF5(path, ...)                                                                                        \
  LamCloseListHDF5(path, sizeof((hid_t[]){__VA_ARGS__}) / sizeof(hid_t), (const hid_t[]){__VA_ARGS__})
PetscErrorCode LamCloseListHDF5(const char path[], size_t n, const hid_t objects[]);

#endif
