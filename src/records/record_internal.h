/*
  Private to the record files: types, lock, header. docs/reference/files.md describes the layout.
*/
#ifndef LAM_RECORD_INTERNAL_H
#define LAM_RECORD_INTERNAL_H

#include <lamella/database.h>
#include <stdint.h>
#include "disk.h"
#include "h5check.h"

#define LAM_FORMAT_NAME "lamella"
#define LAM_FORMAT_VERSION 1
#define LAM_RECORDS_PER_CHUNK 64    /* about 90 kB: a commit writes one or two chunks */
#define LAM_RECORDS_PER_REPORT 4096 /* between reports of progress: a tenth of a second of a merge */

/* What lamella never writes, at the end of a message. */
#define LAM_FOREIGN                                                                                                    \
  "; another program has written it anew (h5py, h5repack), or it is damaged: take the file as lamella wrote it"

/* Advice for a damaged file, at the end of a message. */
#define LAM_SALVAGE "; \"lamella merge NEW.h5 FILE --salvage\" keeps the sound records of a database"

/* ---- record_type.c ---- */

/* The type of a record in the file: key, microstructure, the members of a response, checksum; packed, little-endian. */
PetscErrorCode LamRecordTypeCreate(hid_t *type);
/* Checks that every known member exists with the type that we write, except members added later, and that all
   members are contiguous with the checksum last. */
PetscErrorCode LamRecordTypeCheck(const char path[], hid_t file_type);

/* ---- record_bytes.c ---- */

#define LAM_MAX_MEMBERS 96
#define LAM_MAX_RECORD_BYTES 65536                   /* in any version */
#define LAM_RECORD_BYTES (sizeof(LamResponse) + 128) /* upper bound for a record in the file */

/* Offsets of the members in the bytes of a record, of a type that has passed the check above. */
typedef struct {
  size_t size;                    /* of a record; its last 4 bytes are the CRC-32 (zlib's) of the preceding bytes */
  size_t key, microstructure;     /* int64 */
  size_t status, source;          /* one byte each */
  size_t member[LAM_MAX_MEMBERS]; /* in the order of LamResponseMembers; LAM_NOT_IN_FILE if it is missing */
} LamRecordLayout;

PetscErrorCode LamRecordLayoutMake(hid_t file_type, LamRecordLayout *layout);
/* Offset in a record of the member at `response_offset` of LamResponse. */
size_t LamRecordOffset(const LamRecordLayout *layout, size_t response_offset);
/* Reads an integer of 8 bytes. */
PetscInt64 LamRecordInt(const unsigned char *bytes);
/* Converts records to the bytes of the file, including checksums; the caller frees `bytes`. */
PetscErrorCode LamRecordsPack(PetscInt n, const PetscInt64 keys[], const LamResponse responses[], hid_t file_type,
                              void **bytes);
/* The inverse for one record that has been checked. */
PetscErrorCode LamRecordUnpack(const LamRecordLayout *layout, const unsigned char *bytes, LamResponse *response);
/* Writes the checksum of a record into it. */
void LamRecordSeal(const LamRecordLayout *layout, unsigned char *bytes);
/* Checks checksum, status, source and microstructure of a record. Returns a description of the damage, or NULL. */
const char *LamRecordDamage(const LamRecordLayout *layout, const unsigned char *bytes);

/* ---- record_attribute.c ---- */

/* Attributes of one value. The type must be exactly `file_type`, a text has at most 64 kB: PETSC_ERR_USER_INPUT
   otherwise. */
PetscErrorCode LamAttributeWriteText(const char path[], hid_t object, const char name[], const char text[]);
PetscErrorCode LamAttributeWriteNumber(const char path[], hid_t object, const char name[], hid_t file_type,
                                       hid_t memory_type, const void *value);
/* Overwrites the value of an existing attribute. */
PetscErrorCode LamAttributeUpdate(const char path[], hid_t object, const char name[], hid_t memory_type,
                                  const void *value);
PetscErrorCode LamAttributeHas(const char path[], hid_t object, const char name[], PetscBool *has);
PetscErrorCode LamAttributeReadNumber(const char path[], hid_t object, const char name[], hid_t file_type,
                                      hid_t memory_type, void *value);
PetscErrorCode LamAttributeReadText(const char path[], hid_t object, const char name[],
                                    char **text); /* the caller frees it */
/* The type of a text in the file; the caller closes it. */
PetscErrorCode LamTextTypeCreate(const char path[], const char text[], hid_t *type);

/* ---- record_sums.c ---- */

/* Checksum attributes of the root, texts and arrays; and three of /records. Files of earlier versions lack them. */
#define LAM_SUM "checksum"
#define LAM_COUNTER_SUM "committed_check" /* of the 8 bytes of `committed` */
#define LAM_RECORDS_SUM "records_check"   /* of the checksums of the committed records, in their order */
#define LAM_TYPE_SUM "type_check"         /* of names, offsets and sizes of the members of a record */
#define LAM_UNITS_SUM "units_check"       /* of the attributes of record_units.c */

PetscErrorCode LamSumWrite(const char path[], hid_t object, const char name[], uint32_t sum);
/* Value for an overwritten array, whose checksum is not valid. */
#define LAM_NO_SUM 0
PetscErrorCode LamSumHas(const char path[], hid_t object, const char name[], PetscBool *has);
/* True also if the object has no such attribute. */
PetscErrorCode LamSumMatches(const char path[], hid_t object, const char name[], uint32_t sum, PetscBool *matches);
/* Continues the checksum `before` (0: none) with n bytes. */
uint32_t LamBytesSum(uint32_t before, const void *bytes, size_t n);
PetscErrorCode LamRecordTypeSum(hid_t file_type, uint32_t *sum);
/* The same for records, using only their checksums. */
uint32_t LamRecordsSum(uint32_t before, const LamRecordLayout *layout, PetscInt n, const unsigned char *bytes);

/* ---- record_units.c ---- */

/* Units and axes of the members of a record, as attributes of /records; files of earlier versions have none. */
PetscErrorCode LamRecordUnitsWrite(const char path[], hid_t dataset, const LamScales *scales);
/* PETSC_ERR_USER_INPUT: they have been changed. */
PetscErrorCode LamRecordUnitsCheck(const char path[], hid_t dataset);

/* ---- record_file.c ---- */

/* Opens without HDF5's own locks; closing the file closes all objects in it. */
PetscErrorCode LamFileOpen(const char path[], PetscBool write, hid_t *file);
PetscErrorCode LamFileOpenNew(const char path[], hid_t *file);
/* Writes everything to disk. */
PetscErrorCode LamFileSync(const char path[], hid_t file);
/* Call a function with the file open: for reading, while no commit is in progress; for writing, synced afterwards. */
typedef PetscErrorCode (*LamFileFunction)(const char path[], hid_t file, void *ctx);
PetscErrorCode LamFileRead(const char path[], LamFileFunction read, void *ctx);
PetscErrorCode LamFileWrite(const char path[], LamFileFunction write, void *ctx);

/* ---- record_array.c ---- */

/* Whether `name` ("/a/b/c") exists, with all its groups. PETSC_ERR_USER_INPUT if one is a soft or external link. */
PetscErrorCode LamFileHas(const char path[], hid_t file, const char name[], PetscBool *has);
/* Writes a text dataset; creates groups. */
PetscErrorCode LamFileWriteText(const char path[], hid_t file, const char name[], const char text[]);
/* Reads a text and verifies its checksum; NULL: there is none of this name. The caller frees it. */
PetscErrorCode LamFileGetText(const char path[], hid_t file, const char name[], char **text);
/* The grid of the file; NULL: none, which is an error if it is required. */
PetscErrorCode LamFileGetGrid(const char path[], hid_t file, PetscBool required, const LamMicrostructure *micro,
                              LamGrid *grid);
/* Transfers rows [first, first + n) of a dataset between the file and memory; `type` is that in memory. */
PetscErrorCode LamRowsTransfer(const char path[], hid_t dataset, hid_t type, PetscBool write, hsize_t first, hsize_t n,
                               void *rows);

/* Rejects datasets that Lamella never writes, before any data is read: another layout, filters, data in other files. */
PetscErrorCode LamDatasetCheck(const char path[], hid_t dataset, const char name[], H5D_layout_t wanted);

/* An array to be written. */
typedef struct {
  const char *name;
  hid_t file_type, memory_type;
  PetscInt rank;
  const PetscInt *dims;
  const void *values;
  const char *unit; /* or NULL */
} LamArray;
size_t LamArrayCount(const LamArray *array);
/* A LamFileFunction; ctx: the LamArray. Reals and integers both have 8 bytes in the file. */
PetscErrorCode LamFileWriteArray(const char path[], hid_t file, void *ctx);

/* An array in the file. */
typedef struct {
  PetscBool found;
  PetscInt rank, dims[4], count;
  void *values; /* followed by a zero; NULL: not found. The caller frees them */
} LamFileArray;
/* Reads an array and verifies its checksum. `type`: of the values in the file; H5I_INVALID_HID: one text. */
PetscErrorCode LamFileGetArray(const char path[], hid_t file, const char name[], hid_t type, LamFileArray *array);

/* ---- record_scan.c ---- */

/* The number of committed records, checked against its checksum, the extent and the size of the file. */
PetscErrorCode LamCommittedRead(const char path[], hid_t file, PetscInt *committed);
/* Receives one record, whose bytes are those in the file. `damage` NULL: it is sound. `bytes` NULL: HDF5 cannot read
   it. */
typedef PetscErrorCode (*LamRecordVisitor)(void *ctx, const LamRecordLayout *layout, PetscInt number,
                                           const unsigned char *bytes, const char damage[]);
/* Reads the first `count` records once, in blocks, checks them and passes them to the visitor in their order; a
   damaged one is an error. */
PetscErrorCode LamFileScanRecords(const char path[], hid_t file, PetscInt count, LamRecordVisitor visit, void *ctx);

/* The same for callers that handle damaged records: open, visit all, close. */
typedef struct {
  hid_t dataset, type, space;
  LamRecordLayout layout;
  unsigned char *bytes; /* of a block, or of all records if there are fewer; owned */
} LamRecordScan;

PetscErrorCode LamRecordScanOpen(const char path[], hid_t file, LamRecordScan *scan);
PetscErrorCode LamRecordScanAll(const char path[], LamRecordScan *scan, PetscInt count, LamRecordVisitor visit,
                                void *ctx);
PetscErrorCode LamRecordScanClose(const char path[], LamRecordScan *scan);
/* Verifies the sum of the checksums of all committed records, `count`; more may have been committed since. */
PetscErrorCode LamRecordScanEnd(const char path[], const LamRecordScan *scan, PetscInt count, uint32_t sum);
/* The number of allocated records, committed or not. */
PetscInt LamRecordScanExtent(const LamRecordScan *scan, hid_t file);

/* ---- record_header.c ---- */

/* Attributes of the root group. The header owns all texts, and the cells of `micro`. */
typedef struct {
  char *format, *kind, *creator, *created, *host, *command;
  char *petsc, *hdf5, *mpi; /* versions */
  char *units, *index_order;
  int format_version;
  LamScales scales;
  PetscReal accuracy;
  char *hash, *description; /* of the microstructure */
  LamMicrostructure micro;
  PetscInt committed;
} LamHeader;

PetscErrorCode LamHeaderDestroy(LamHeader *header);
/* Creates a file without records: header, microstructure, scene, empty record table. */
PetscErrorCode LamFileCreate(const char path[], const char kind[], const LamScene *scene);
/* Reads and checks the header; `file` stays open. */
PetscErrorCode LamHeaderRead(const char path[], hid_t file, LamHeader *header);
/* The same without the number of committed records. *matches: whether the checksum is correct; NULL: an error if
   not. */
PetscErrorCode LamHeaderReadRoot(const char path[], hid_t file, PetscBool *matches, LamHeader *header);
/* Checksum of the root's attributes, as read. */
PetscErrorCode LamHeaderSum(const char path[], hid_t file, uint32_t *sum);
/* Sets the number of committed records and the sum of their checksums; does not sync. */
PetscErrorCode LamCounterWrite(const char path[], hid_t dataset, PetscInt committed, uint32_t records_sum);

/* ---- record_preallocate.c ---- */

/*
  Allocates space for at least `records` records; *extent: before and after. The file `path` is replaced by a copy,
  created as `temporary`; after a kill it is unchanged. NULL: extends `temporary` itself, which has not been renamed
  yet.
*/
PetscErrorCode LamFilePreallocate(const char path[], const char temporary[], PetscInt records, PetscInt *extent);

#endif
