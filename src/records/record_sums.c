/*
  Checksums of everything except the records: CRC-32, zlib's. Each is a separate attribute; files of earlier versions
  lack them. Format: docs/reference/files.md.
*/
#include "record_internal.h"
#include <string.h>
#include <zlib.h>

uint32_t LamBytesSum(uint32_t before, const void *bytes, size_t n)
{
  return (uint32_t)crc32_z(before, bytes, n);
}

/* ---- as attributes ---- */

PetscErrorCode LamSumWrite(const char path[], hid_t object, const char name[], uint32_t sum)
{
  PetscFunctionBeginUser;
  PetscCall(LamAttributeWriteNumber(path, object, name, H5T_STD_U32LE, H5T_NATIVE_UINT32, &sum));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSumHas(const char path[], hid_t object, const char name[], PetscBool *has)
{
  uint32_t stored = LAM_NO_SUM;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeHas(path, object, name, has));
  if (*has) PetscCall(LamAttributeReadNumber(path, object, name, H5T_STD_U32LE, H5T_NATIVE_UINT32, &stored));
  *has = (PetscBool)(stored != LAM_NO_SUM);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSumMatches(const char path[], hid_t object, const char name[], uint32_t sum, PetscBool *matches)
{
  uint32_t stored = sum;
  PetscBool has;

  PetscFunctionBeginUser;
  PetscCall(LamAttributeHas(path, object, name, &has));
  if (has) PetscCall(LamAttributeReadNumber(path, object, name, H5T_STD_U32LE, H5T_NATIVE_UINT32, &stored));
  *matches = (PetscBool)(stored == sum);
  PetscFunctionReturn(0);
}

/* ---- records ---- */

PetscErrorCode LamRecordTypeSum(hid_t file_type, uint32_t *sum)
{
  const int members = H5Tget_nmembers(file_type);

  PetscFunctionBeginUser;
  *sum = 0;
  for (int i = 0; i < members; i++) {
    const hid_t member = H5Tget_member_type(file_type, (unsigned)i);
    const uint64_t place[2] = {H5Tget_member_offset(file_type, (unsigned)i), H5Tget_size(member)};
    char *name = H5Tget_member_name(file_type, (unsigned)i);

    H5Tclose(member);
    *sum = LamBytesSum(LamBytesSum(*sum, name, strlen(name) + 1), place, sizeof(place));
    H5free_memory(name);
  }
  PetscFunctionReturn(0);
}

uint32_t LamRecordsSum(uint32_t before, const LamRecordLayout *layout, PetscInt n, const unsigned char *bytes)
{
  for (PetscInt i = 0; i < n; i++)
    before = LamBytesSum(before, bytes + ((size_t)i + 1) * layout->size - sizeof(uint32_t), sizeof(uint32_t));
  return before;
}
