/*
  The type of a record, made from the table of response members, and its way between memory and file.

  The writer converts records to the bytes of the file itself and passes them through HDF5 unchanged, so the checksum
  covers what is on the disk and a reader in any language can test it.
*/
#include "record_internal.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

_Static_assert(sizeof(LamStatus) == sizeof(int) && sizeof(LamSource) == sizeof(int) && sizeof(PetscBool) == sizeof(int),
               "enumerations are stored as int");

static const char *const bool_names[] = {"FALSE", "TRUE", NULL}; /* as h5py names them */

static PetscErrorCode EnumType(PetscBool in_memory, const char *const names[], hid_t *type)
{
  PetscFunctionBeginUser;
  LamCallHDF5("enumeration", PETSC_ERR_LIB, *type = H5Tenum_create(in_memory ? H5T_NATIVE_INT : H5T_STD_I8LE));
  for (int value = 0; names[value]; value++) {
    const signed char byte = (signed char)value;

    LamCallHDF5(names[value], PETSC_ERR_LIB,
                H5Tenum_insert(*type, names[value], in_memory ? (const void *)&value : (const void *)&byte));
  }
  PetscFunctionReturn(0);
}

/* Reals in threes: 3 numbers are a vector, 9 a second-order tensor, 81 a fourth-order one. */
static PetscErrorCode RealType(PetscBool in_memory, PetscInt count, hid_t *type)
{
  const hsize_t dims[4] = {3, 3, 3, 3};
  const hid_t scalar = in_memory ? H5T_NATIVE_DOUBLE : H5T_IEEE_F64LE;
  unsigned rank = 0;

  PetscFunctionBeginUser;
  for (PetscInt c = count; c > 1; c /= 3) rank++;
  if (rank)
    LamCallHDF5("array type", PETSC_ERR_LIB, *type = H5Tarray_create2(scalar, rank, dims));
  else
    LamCallHDF5("real type", PETSC_ERR_LIB, *type = H5Tcopy(scalar));
  PetscFunctionReturn(0);
}

static PetscErrorCode MemberType(PetscBool in_memory, const LamMember *m, hid_t *type)
{
  PetscFunctionBeginUser;
  switch (m->type) {
  case LAM_MEMBER_REAL:
    PetscCall(RealType(in_memory, m->count, type));
    break;
  case LAM_MEMBER_BOOL:
    PetscCall(EnumType(in_memory, bool_names, type));
    break;
  case LAM_MEMBER_ENUM:
    PetscCall(EnumType(in_memory, m->names, type));
    break;
  case LAM_MEMBER_INT:
    LamCallHDF5(m->name, PETSC_ERR_LIB,
                *type = H5Tcopy(!in_memory                               ? H5T_STD_I64LE
                                : sizeof(PetscInt) == sizeof(PetscInt64) ? H5T_NATIVE_INT64
                                                                         : H5T_NATIVE_INT));
    break;
  case LAM_MEMBER_TEXT:
    LamCallHDF5(m->name, PETSC_ERR_LIB, *type = H5Tcopy(H5T_C_S1));
    LamCallHDF5(m->name, PETSC_ERR_LIB, H5Tset_size(*type, (size_t)m->count));
    break;
  }
  PetscFunctionReturn(0);
}

/* Inserts a member: in memory where the struct has it, in the file behind the members before it. Closes `type`. */
static PetscErrorCode Insert(PetscBool in_memory, hid_t compound, const char name[], size_t offset, hid_t type,
                             size_t *end)
{
  PetscFunctionBeginUser;
  LamCallHDF5(name, PETSC_ERR_LIB, H5Tinsert(compound, name, in_memory ? offset : *end, type));
  *end += H5Tget_size(type);
  LamCallHDF5(name, PETSC_ERR_LIB, H5Tclose(type));
  PetscFunctionReturn(0);
}

static const LamMember record_members[] = {
    {"key", LAM_MEMBER_INT, 1, offsetof(LamRecord, key), 0, NULL, ""},
    {"microstructure", LAM_MEMBER_INT, 1, offsetof(LamRecord, microstructure), 0, NULL, ""},
};

PetscErrorCode LamRecordTypeCreate(PetscBool in_memory, hid_t *type)
{
  const size_t most = 2 * sizeof(LamRecord); /* room for members that are wider in the file; cut below */
  size_t end = 0;
  hid_t member;

  PetscFunctionBeginUser;
  LamCallHDF5("record type", PETSC_ERR_LIB, *type = H5Tcreate(H5T_COMPOUND, in_memory ? sizeof(LamRecord) : most));
  LamCallHDF5("record type", PETSC_ERR_LIB, member = H5Tcopy(in_memory ? H5T_NATIVE_INT64 : H5T_STD_I64LE));
  PetscCall(Insert(in_memory, *type, record_members[0].name, record_members[0].offset, member, &end));
  PetscCall(MemberType(in_memory, &record_members[1], &member));
  PetscCall(Insert(in_memory, *type, record_members[1].name, record_members[1].offset, member, &end));
  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    PetscCall(MemberType(in_memory, m, &member));
    PetscCall(Insert(in_memory, *type, m->name, offsetof(LamRecord, response) + m->offset, member, &end));
  }
  LamCallHDF5("record type", PETSC_ERR_LIB, member = H5Tcopy(in_memory ? H5T_NATIVE_UINT32 : H5T_STD_U32LE));
  PetscCall(Insert(in_memory, *type, "checksum", offsetof(LamRecord, checksum), member, &end));
  if (!in_memory) LamCallHDF5("record type", PETSC_ERR_LIB, H5Tset_size(*type, end));
  PetscFunctionReturn(0);
}

/*
  Members that files of format version 1 did not have from its beginning: where one is missing it is not known (NaN,
  of a count LAM_UNKNOWN_COUNT). Bonded tissue has no gaps, so such files lack nothing. Cells did not differ then, so
  that dPsi/dp and dPsi/dg are the fractions.
*/
static const char *const added_members[] = {
    "opening_by_face",   "open_by_face",           "debonded_spread", "open_spread",
    "mean_gap",          "max_penetration",        "fabric",          "zero_modes",
    "cell_clusters",     "percolating_directions", "energy_turgor",   "energy_cohesion",
    "gap_place",         "opening_moment",         "normal_place",    "shear_place",
    "max_lamella_shear", "max_fibre_stretch",      "max_wall_energy", "max_wall_tension",
    "wall_place",        "mean_wall_tension",      "min_gap",         "indicators_trusted"};

static PetscBool WasAdded(const char name[])
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(added_members); i++)
    if (!strcmp(name, added_members[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode LamRecordTypeCheck(const char path[], hid_t file_type)
{
  hid_t ours;
  int members, last;

  PetscFunctionBeginUser;
  PetscCheck(H5Tget_class(file_type) == H5T_COMPOUND, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: /records is not a table of records; the file is damaged or no Lamella file", path);
  PetscCall(LamRecordTypeCreate(PETSC_FALSE, &ours));
  LamCallHDF5(path, PETSC_ERR_LIB, members = H5Tget_nmembers(ours));
  for (int i = 0; i < members; i++) {
    char *name = H5Tget_member_name(ours, (unsigned)i);
    const int at = H5Tget_member_index(file_type, name);
    const hid_t wanted = H5Tget_member_type(ours, (unsigned)i);
    const hid_t found = at < 0 ? H5I_INVALID_HID : H5Tget_member_type(file_type, (unsigned)at);
    const PetscBool same = (PetscBool)(at < 0 ? WasAdded(name) : H5Tequal(wanted, found) > 0);

    if (found >= 0) LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(found));
    LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(wanted));
    if (!same) LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(ours));
    PetscCheck(same, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: member \"%s\" of /records is %s; the file is damaged or of another format", path, name,
               found >= 0 ? "of another type" : "missing");
    H5free_memory(name);
  }
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(ours));
  LamCallHDF5(path, PETSC_ERR_LIB, last = H5Tget_member_index(file_type, "checksum"));
  PetscCheck(H5Tget_member_offset(file_type, (unsigned)last) + sizeof(uint32_t) == H5Tget_size(file_type),
             PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: the checksum is not the last member of /records", path);
  PetscFunctionReturn(0);
}

/* CRC-32 with the polynomial 0xEDB88320, as zlib's crc32(). */
static void ChecksumTable(uint32_t table[256])
{
  for (uint32_t i = 0; i < 256; i++) {
    table[i] = i;
    for (int bit = 0; bit < 8; bit++) table[i] = (table[i] >> 1) ^ (table[i] & 1 ? 0xEDB88320u : 0);
  }
}

static uint32_t Checksum(const uint32_t table[256], const unsigned char *bytes, size_t n)
{
  uint32_t crc = 0xFFFFFFFFu;

  for (size_t i = 0; i < n; i++) crc = (crc >> 8) ^ table[(crc ^ bytes[i]) & 0xFF];
  return crc ^ 0xFFFFFFFFu;
}

/* Converts n records in place; `bytes` has room for the larger of both types. `background`, of type `to`, gives what
   `from` lacks. */
static PetscErrorCode Convert(hid_t from, hid_t to, PetscInt n, void *bytes, void *background)
{
  PetscFunctionBeginUser;
  LamCallHDF5("records", PETSC_ERR_LIB, H5Tconvert(from, to, (size_t)n, bytes, background, H5P_DEFAULT));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordsPack(PetscInt n, const PetscInt64 keys[], const LamResponse responses[], hid_t file_type,
                              void **bytes)
{
  const size_t size = H5Tget_size(file_type), body = size - sizeof(uint32_t);
  uint32_t table[256];
  unsigned char *packed;
  LamRecord *records;
  hid_t memory_type;
  void *zeros;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc(((size_t)n + 1) * PetscMax(size, sizeof(LamRecord)), bytes));
  records = *bytes;
  for (PetscInt i = 0; i < n; i++) {
    records[i].key = keys[i];
    records[i].response = responses[i];
  }
  PetscCall(LamRecordTypeCreate(PETSC_TRUE, &memory_type));
  PetscCall(PetscCalloc(((size_t)n + 1) * size, &zeros));
  PetscCall(Convert(memory_type, file_type, n, *bytes, zeros));
  PetscCall(PetscFree(zeros));
  LamCallHDF5("records", PETSC_ERR_LIB, H5Tclose(memory_type));
  ChecksumTable(table);
  packed = *bytes;
  for (PetscInt i = 0; i < n; i++, packed += size) {
    const uint32_t crc = Checksum(table, packed, body);

    for (int b = 0; b < 4; b++) packed[body + b] = (unsigned char)(crc >> (8 * b));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckSums(const char path[], PetscInt n, const unsigned char *packed, size_t size)
{
  const size_t body = size - sizeof(uint32_t);
  uint32_t table[256];

  PetscFunctionBeginUser;
  ChecksumTable(table);
  for (PetscInt i = 0; i < n; i++, packed += size) {
    uint32_t stored = 0;

    for (int b = 0; b < 4; b++) stored |= (uint32_t)packed[body + b] << (8 * b);
    PetscCheck(stored == Checksum(table, packed, body), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: record %" PetscInt_FMT " is damaged (its checksum differs); build the file anew", path, i);
  }
  PetscFunctionReturn(0);
}

/* Records of which nothing is known. */
static PetscErrorCode UnknownRecords(PetscInt n, LamRecord **records)
{
  const LamLoad load = {{0}, 0, 0};

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n + 1, records));
  for (PetscInt i = 0; i < n; i++) PetscCall(LamResponseInit(&load, &(*records)[i].response));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordsUnpack(const char path[], PetscInt n, const void *bytes, hid_t file_type,
                                LamResponse responses[], PetscInt64 keys[])
{
  const size_t size = H5Tget_size(file_type);
  LamRecord *records, *unknown;
  hid_t memory_type;

  PetscFunctionBeginUser;
  PetscCall(CheckSums(path, n, bytes, size));
  PetscCall(PetscMalloc(((size_t)n + 1) * PetscMax(size, sizeof(LamRecord)), &records));
  memcpy(records, bytes, (size_t)n * size);
  PetscCall(LamRecordTypeCreate(PETSC_TRUE, &memory_type));
  PetscCall(UnknownRecords(n, &unknown));
  PetscCall(Convert(file_type, memory_type, n, records, unknown));
  PetscCall(PetscFree(unknown));
  LamCallHDF5(path, PETSC_ERR_LIB, H5Tclose(memory_type));
  for (PetscInt i = 0; i < n; i++) {
    LamResponse *r = &responses[i];

    *r = records[i].response;
    keys[i] = records[i].key;
    r->reason[sizeof(r->reason) - 1] = '\0';
    if (isnan(r->energy_turgor)) r->energy_turgor = -r->lumen_fraction;
    if (isnan(r->energy_cohesion)) r->energy_cohesion = r->opening_fraction;
    PetscCheck((int)r->status >= 0 && r->status < LAM_STATUS_COUNT && (int)r->source >= 0 &&
                   r->source < LAM_SOURCE_COUNT && records[i].microstructure == 0,
               PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: record %" PetscInt_FMT " has an unknown status or source",
               path, i);
  }
  PetscCall(PetscFree(records));
  PetscFunctionReturn(0);
}
