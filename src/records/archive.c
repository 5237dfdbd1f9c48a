/*
  Archives: HDF5 files with one dataset of bytes, [items][size], for each name, and its checksum.

  Rank 0 reads and writes block by block, so that its memory is bounded by BLOCK_BYTES. An error on rank 0 is printed
  there and returned on all ranks.
*/
#include <lamella/archive.h>
#include <petscsf.h>
#include <string.h>
#include <unistd.h>
#include "record_internal.h"

static const size_t BLOCK_BYTES = (size_t)64 << 20;

struct LamArchive_s {
  MPI_Comm comm;
  PetscMPIInt rank;
  PetscBool reading;
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  hid_t file; /* valid on rank 0 only, and not after an error */
};

/* Items of all ranks. `item` is the caller's, without gaps. */
typedef struct {
  const char *name;
  size_t size;
  PetscInt total, n; /* on all ranks, on this rank */
  const PetscInt *numbers;
  char *items;
  hid_t dataset; /* rank 0 */
  uint32_t sum;  /* checksum of the data written or read */
} Array;

static PetscErrorCode ShareError(LamArchive archive, PetscErrorCode ierr)
{
  int code = (int)ierr;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&code, 1, MPI_INT, 0, archive->comm));
  /* no SETERRQ: the message was printed where the error occurred */
  PetscFunctionReturn((PetscErrorCode)code);
}

/* ---- rank 0: datasets ---- */

static PetscErrorCode CreateDataset(const LamArchive archive, Array *array)
{
  const hsize_t dims[2] = {(hsize_t)array->total, (hsize_t)array->size};
  hid_t space;

  PetscFunctionBeginUser;
  LamCallHDF5(archive->path, PETSC_ERR_FILE_WRITE, space = H5Screate_simple(2, dims, NULL));
  LamCallHDF5(archive->path, PETSC_ERR_FILE_WRITE,
              array->dataset =
                  H5Dcreate2(archive->file, array->name, H5T_STD_U8LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  PetscCall(LamCloseHDF5(archive->path, space));
  PetscFunctionReturn(0);
}

/* If array->total is negative it is set to the number of items in the file; otherwise they must agree. */
static PetscErrorCode OpenDataset(const LamArchive archive, Array *array)
{
  hsize_t dims[H5S_MAX_RANK] = {0};
  PetscBool has, same;
  hid_t space;
  int rank;

  PetscFunctionBeginUser;
  PetscCall(LamFileHas(archive->path, archive->file, array->name, &has));
  PetscCheck(has, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds no %s; another version of lamella wrote it, or it is damaged", archive->path, array->name);
  LamCallHDF5(archive->path, PETSC_ERR_USER_INPUT, array->dataset = H5Dopen2(archive->file, array->name, H5P_DEFAULT));
  LamCallHDF5(archive->path, PETSC_ERR_USER_INPUT, space = H5Dget_space(array->dataset));
  LamCallHDF5(archive->path, PETSC_ERR_USER_INPUT, rank = H5Sget_simple_extent_dims(space, dims, NULL));
  PetscCall(LamCloseHDF5(archive->path, space));
  if (array->total < 0) array->total = (PetscInt)dims[0];
  same = (PetscBool)(rank == 2 && dims[0] == (hsize_t)array->total && dims[1] == (hsize_t)array->size);
  PetscCheck(same, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: %s has %lld items of %lld bytes, this run has %" PetscInt_FMT
             " of %zu; the mesh has changed, or another version of lamella wrote it",
             archive->path, array->name, (long long)dims[0], (long long)dims[1], array->total, array->size);
  PetscFunctionReturn(0);
}

/* Writes or reads rows [first, first + rows) of the dataset. */
static PetscErrorCode MoveBlock(const LamArchive archive, Array *array, PetscInt first, PetscInt rows, char *block)
{
  PetscFunctionBeginUser;
  PetscCall(LamRowsTransfer(archive->path, array->dataset, H5T_NATIVE_UCHAR, (PetscBool)!archive->reading,
                            (hsize_t)first, (hsize_t)rows, block));
  array->sum = LamBytesSum(array->sum, block, (size_t)rows * array->size);
  PetscFunctionReturn(0);
}

static PetscErrorCode CloseDataset(const LamArchive archive, Array *array)
{
  PetscBool sound = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (archive->reading)
    PetscCall(LamSumMatches(archive->path, array->dataset, LAM_SUM, array->sum, &sound));
  else
    PetscCall(LamSumWrite(archive->path, array->dataset, LAM_SUM, array->sum));
  PetscCall(LamCloseHDF5(archive->path, array->dataset));
  PetscCheck(sound, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s is damaged (its checksum differs)", archive->path,
             array->name);
  PetscFunctionReturn(0);
}

/* ---- between ranks ---- */

/* Moves the items with numbers [first, first + rows) between their ranks and the block on rank 0. */
static PetscErrorCode ExchangeBlock(const LamArchive archive, const Array *array, PetscInt first, PetscInt rows,
                                    char *block)
{
  PetscInt *local, n = 0;
  PetscSFNode *remote;
  MPI_Datatype item;
  PetscSF sf;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(array->n, &local, array->n, &remote));
  for (PetscInt k = 0; k < array->n; k++) {
    if (array->numbers[k] < first || array->numbers[k] >= first + rows) continue;
    local[n] = k;
    remote[n++] = (PetscSFNode){.rank = 0, .index = array->numbers[k] - first};
  }
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)array->size, MPI_BYTE, &item));
  PetscCallMPI(MPI_Type_commit(&item));
  PetscCall(PetscSFCreate(archive->comm, &sf));
  PetscCall(PetscSFSetGraph(sf, archive->rank ? 0 : rows, n, local, PETSC_COPY_VALUES, remote, PETSC_COPY_VALUES));
  if (archive->reading) {
    PetscCall(PetscSFBcastBegin(sf, item, block, array->items, MPI_REPLACE));
    PetscCall(PetscSFBcastEnd(sf, item, block, array->items, MPI_REPLACE));
  } else {
    PetscCall(PetscSFReduceBegin(sf, item, array->items, block, MPI_REPLACE));
    PetscCall(PetscSFReduceEnd(sf, item, array->items, block, MPI_REPLACE));
  }
  PetscCall(PetscSFDestroy(&sf));
  PetscCallMPI(MPI_Type_free(&item));
  PetscCall(PetscFree2(local, remote));
  PetscFunctionReturn(0);
}

static PetscErrorCode MoveBlocks(const LamArchive archive, Array *array)
{
  const PetscInt rows = (PetscInt)PetscMax(1, BLOCK_BYTES / PetscMax(1, array->size));
  PetscErrorCode ierr = 0;
  char *block;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc((size_t)PetscMin(rows, array->total) * array->size, &block));
  for (PetscInt first = 0; first < array->total && !ierr; first += rows) {
    const PetscInt n = PetscMin(rows, array->total - first);
    PetscCall(PetscArrayzero(block, (size_t)n * array->size));
    if (!archive->reading) PetscCall(ExchangeBlock(archive, array, first, n, block));
    if (!archive->rank) ierr = MoveBlock(archive, array, first, n, block);
    ierr = ShareError(archive, ierr);
    if (!ierr && archive->reading) PetscCall(ExchangeBlock(archive, array, first, n, block));
  }
  PetscCall(PetscFree(block));
  PetscFunctionReturn(ierr);
}

static PetscErrorCode Move(LamArchive archive, Array *array)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  if (!archive->rank) ierr = archive->reading ? OpenDataset(archive, array) : CreateDataset(archive, array);
  PetscCall(ShareError(archive, ierr));
  PetscCallMPI(MPI_Bcast(&array->total, 1, MPIU_INT, 0, archive->comm));
  PetscCall(MoveBlocks(archive, array));
  if (!archive->rank) ierr = CloseDataset(archive, array);
  PetscCall(ShareError(archive, ierr));
  PetscFunctionReturn(0);
}

/* ---- public ---- */

PetscErrorCode LamArchiveItems(LamArchive archive, const char name[], size_t size, PetscInt n, const PetscInt numbers[],
                               void *items)
{
  Array array = {.name = name, .size = size, .n = n, .numbers = numbers, .items = items};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) array.total = PetscMax(array.total, numbers[k] + 1);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &array.total, 1, MPIU_INT, MPI_MAX, archive->comm));
  PetscCall(Move(archive, &array));
  PetscFunctionReturn(0);
}

PetscErrorCode LamArchiveShared(LamArchive archive, const char name[], size_t size, void *value)
{
  const PetscInt number = 0;
  Array array = {.name = name,
                 .size = size,
                 .total = 1,
                 .n = archive->reading || !archive->rank ? 1 : 0,
                 .numbers = &number,
                 .items = value};

  PetscFunctionBeginUser;
  PetscCall(Move(archive, &array));
  PetscFunctionReturn(0);
}

PetscErrorCode LamArchiveList(LamArchive archive, const char name[], size_t size, PetscInt *n, void **items)
{
  char counter[PETSC_MAX_PATH_LEN];
  PetscInt *numbers, mine;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(counter, sizeof(counter), "%s count", name));
  PetscCall(LamArchiveShared(archive, counter, sizeof(*n), n));
  mine = archive->rank ? 0 : *n;
  if (archive->reading) *items = NULL;
  if (archive->reading && mine) PetscCall(PetscMalloc((size_t)mine * size, items));
  PetscCall(PetscMalloc1(mine, &numbers));
  for (PetscInt k = 0; k < mine; k++) numbers[k] = k;
  PetscCall(LamArchiveItems(archive, name, size, mine, numbers, *items));
  PetscCall(PetscFree(numbers));
  *n = mine;
  PetscFunctionReturn(0);
}

static PetscErrorCode Open(MPI_Comm comm, const char path[], PetscBool reading, LamArchive *archive)
{
  PetscErrorCode ierr = 0;
  LamArchive a;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(archive));
  a = *archive;
  a->comm = comm;
  a->reading = reading;
  a->file = H5I_INVALID_HID;
  PetscCallMPI(MPI_Comm_rank(comm, &a->rank));
  PetscCall(PetscStrncpy(a->path, path, sizeof(a->path)));
  PetscCall(PetscSNPrintf(a->temporary, sizeof(a->temporary), "%s.tmp", path));
  if (!a->rank) ierr = reading ? LamFileOpen(path, PETSC_FALSE, &a->file) : LamFileOpenNew(a->temporary, &a->file);
  ierr = ShareError(a, ierr);
  if (ierr) PetscCall(PetscFree(*archive));
  PetscFunctionReturn(ierr);
}

PetscErrorCode LamArchiveCreate(MPI_Comm comm, const char path[], LamArchive *archive)
{
  return Open(comm, path, PETSC_FALSE, archive);
}

PetscErrorCode LamArchiveOpen(MPI_Comm comm, const char path[], LamArchive *archive)
{
  return Open(comm, path, PETSC_TRUE, archive);
}

PetscBool LamArchiveIsReading(LamArchive archive)
{
  return archive->reading;
}

/* On rank 0. */
static PetscErrorCode CloseFile(LamArchive archive, PetscBool keep)
{
  PetscFunctionBeginUser;
  if (archive->file < 0) PetscFunctionReturn(0);
  if (!archive->reading && !keep) {
    H5Fclose(archive->file);
    unlink(archive->temporary);
    PetscFunctionReturn(0);
  }
  PetscCall(LamCloseHDF5(archive->path, archive->file));
  if (!archive->reading) PetscCall(LamFilePublish(archive->temporary, archive->path));
  PetscFunctionReturn(0);
}

PetscErrorCode LamArchiveClose(LamArchive *archive, PetscBool keep)
{
  PetscErrorCode ierr = 0;

  PetscFunctionBeginUser;
  if (!*archive) PetscFunctionReturn(0);
  if (!(*archive)->rank) ierr = CloseFile(*archive, keep);
  ierr = ShareError(*archive, ierr);
  PetscCall(PetscFree(*archive));
  PetscFunctionReturn(ierr);
}
