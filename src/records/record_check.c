/*
  Check of a file.

  Method
    The functions that read a file stop at the first damage. Here each part is read separately, its error is recorded as
    damage of the part, and the next part is read. If the number of committed records is unknown, all allocated records
    are read and the sound ones counted; the others may never have been committed.
*/
#include "record_json.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const char *path;
  const LamReporter *reporter; /* borrowed; NULL: none */
  hid_t file;
  LamHeader header;
  json_t *damaged, *unchecked; /* arrays, owned */
  PetscBool counted;           /* the commit counter is sound */
  PetscBool scanned;           /* the records could be examined */
  PetscBool has_nodes;
  PetscInt sound_records;
  PetscInt total;   /* of records to be read */
  uint32_t sum;     /* of the checksums of the records */
  char words[1024]; /* message of the last error */
} Check;

/* ---- damage ---- */

static PetscErrorCode KeepWords(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                PetscErrorType type, const char *text, void *ctx)
{
  Check *c = ctx;
  const size_t n = strlen(c->path);
  const char *end;

  if (type != PETSC_ERROR_INITIAL || !text) return code;
  if (!strncmp(text, c->path, n) && !strncmp(text + n, ": ", 2)) text += n + 2;
  end = strstr(text, LAM_SALVAGE);
  snprintf(c->words, sizeof(c->words), "%.*s", (int)(end ? end - text : (long)strlen(text)), text);
  return code;
}

/* Removes the part's name from the message. */
static void AddPart(Check *c, const char part[])
{
  const size_t n = strlen(part);
  const char *words = !strncmp(c->words, part, n) && c->words[n] == ' ' ? c->words + n + 1 : c->words;

  json_array_append_new(c->damaged, json_pack("{s:o, s:o}", "part", LamJSONText(part), "reason", LamJSONText(words)));
}

/* True if the function that reads `part` returned without error. */
static PetscBool Sound(Check *c, const char part[], PetscErrorCode code)
{
  if (code && !c->words[0]) snprintf(c->words, sizeof(c->words), "cannot be read");
  if (code) AddPart(c, part);
  c->words[0] = '\0';
  return (PetscBool)!code;
}

/* Lists data without checksum: of an earlier version, or an array that was overwritten. */
static void AddUnsummed(Check *c, hid_t object, const char name[], const char part[])
{
  PetscBool has;

  if (!LamSumHas(c->path, object, name, &has) && !has) json_array_append_new(c->unchecked, LamJSONText(part));
  c->words[0] = '\0';
}

/* ---- records ---- */

static void AddRecord(Check *c, const LamRecordLayout *layout, PetscInt number, const unsigned char *bytes,
                      const char reason[])
{
  json_t *record = json_pack("{s:I}", "record", (json_int_t)number);

  if (bytes) json_object_set_new(record, "key", json_integer(LamRecordInt(bytes + layout->key)));
  json_object_set_new(record, "reason", LamJSONText(reason));
  json_array_append_new(c->damaged, record);
}

/* A LamRecordVisitor. */
static PetscErrorCode CheckRecord(void *ctx, const LamRecordLayout *layout, PetscInt number, const unsigned char *bytes,
                                  const char damage[])
{
  Check *c = ctx;

  PetscFunctionBeginUser;
  if (c->reporter && number % LAM_RECORDS_PER_REPORT == 0)
    PetscCall(c->reporter->progress(c->reporter->ctx, number, c->total, 0));
  if (damage && c->counted) AddRecord(c, layout, number, bytes, damage);
  if (damage) PetscFunctionReturn(0);
  c->sound_records++;
  c->sum = LamRecordsSum(c->sum, layout, 1, bytes);
  if (LamKeyIsNode(LamRecordInt(bytes + layout->key))) c->has_nodes = PETSC_TRUE;
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckRecords(Check *c)
{
  LamRecordScan scan;
  PetscInt count;

  PetscFunctionBeginUser;
  PetscCall(LamRecordScanOpen(c->path, c->file, &scan));
  count = c->total = c->counted ? c->header.committed : LamRecordScanExtent(&scan, c->file);
  PetscCall(LamRecordScanAll(c->path, &scan, count, CheckRecord, c));
  if (c->counted && c->sound_records == count)
    (void)Sound(c, "order of the records", LamRecordScanEnd(c->path, &scan, count, c->sum));
  AddUnsummed(c, scan.dataset, LAM_COUNTER_SUM, "commit counter");
  if (count) AddUnsummed(c, scan.dataset, LAM_RECORDS_SUM, "order of the records");
  AddUnsummed(c, scan.dataset, LAM_TYPE_SUM, "members of the records");
  (void)Sound(c, "units of the records", LamRecordUnitsCheck(c->path, scan.dataset));
  AddUnsummed(c, scan.dataset, LAM_UNITS_SUM, "units of the records");
  PetscCall(LamRecordScanClose(c->path, &scan));
  PetscFunctionReturn(0);
}

/* ---- texts and arrays ---- */

static herr_t KeepName(hid_t group, const char name[], const H5L_info_t *info, void *ctx)
{
  char path[1024];

  snprintf(path, sizeof(path), "/%s", name);
  return json_array_append_new(ctx, LamJSONText(path)) ? -1 : 0;
}

static PetscErrorCode ListNames(Check *c, json_t *names)
{
  PetscFunctionBeginUser;
  LamCallHDF5(c->path, PETSC_ERR_USER_INPUT, H5Lvisit(c->file, H5_INDEX_NAME, H5_ITER_NATIVE, KeepName, names));
  PetscFunctionReturn(0);
}

/* H5O_INFO_ALL, as other programs use it: HDF5 then reads the whole index of a group. */
static PetscErrorCode CheckObject(Check *c, const char name[])
{
  LamFileArray array;
  H5T_class_t class;
  H5O_info_t info;
  PetscBool has;
  hid_t dataset, type, wanted;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  if (strcmp(name, "/")) PetscCall(LamFileHas(c->path, c->file, name, &has));
  LamCallHDF5(c->path, PETSC_ERR_USER_INPUT, H5Oget_info_by_name2(c->file, name, &info, H5O_INFO_ALL, H5P_DEFAULT));
  if (info.type == H5O_TYPE_GROUP || !strcmp(name, "/records")) PetscFunctionReturn(0);
  LamCallHDF5(c->path, PETSC_ERR_USER_INPUT, dataset = H5Dopen2(c->file, name, H5P_DEFAULT));
  LamCallHDF5(c->path, PETSC_ERR_USER_INPUT, type = H5Dget_type(dataset));
  class = H5Tget_class(type);
  wanted = class == H5T_STRING ? H5I_INVALID_HID : class == H5T_FLOAT ? H5T_IEEE_F64LE : H5T_STD_I64LE;
  ierr = LamFileGetArray(c->path, c->file, name, wanted, &array);
  if (!ierr) AddUnsummed(c, dataset, LAM_SUM, name);
  PetscCall(PetscFree(array.values));
  PetscCall(LamCloseHDF5(c->path, type, dataset));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckGrid(Check *c)
{
  const PetscBool required = (PetscBool)(c->has_nodes && !strcmp(c->header.kind, "database"));
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamFileGetGrid(c->path, c->file, required, &c->header.micro, &grid));
  PetscCall(LamGridDestroy(&grid));
  PetscFunctionReturn(0);
}

/* ---- the whole file ---- */

static void CheckParts(Check *c)
{
  json_t *names = json_array(), *name;
  PetscBool header;
  size_t i;

  header = Sound(c, "header", LamHeaderReadRoot(c->path, c->file, NULL, &c->header));
  AddUnsummed(c, c->file, LAM_SUM, "header");
  c->counted = Sound(c, "commit counter", LamCommittedRead(c->path, c->file, &c->header.committed));
  c->scanned = Sound(c, "/records", CheckRecords(c));
  (void)Sound(c, "groups", ListNames(c, names));
  (void)Sound(c, "/", CheckObject(c, "/"));
  json_array_foreach(names, i, name)
  {
    (void)Sound(c, json_string_value(name), CheckObject(c, json_string_value(name)));
  }
  if (header) (void)Sound(c, LAM_GRID_NAME, CheckGrid(c));
  json_decref(names);
}

/* A missing or unreadable file is an error, not damage. */
static PetscErrorCode OpenAndCheck(Check *c)
{
  PetscErrorCode ierr;
  const int lock = LamLockBeginRead(c->path);

  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(KeepWords, c));
  ierr = LamFileOpen(c->path, PETSC_FALSE, &c->file);
  if (ierr != PETSC_ERR_FILE_OPEN && ierr != PETSC_ERR_FILE_READ && Sound(c, "file", ierr)) CheckParts(c);
  if (c->file >= 0) H5Fclose(c->file);
  LamLockEndRead(lock);
  PetscCall(PetscPopErrorHandler());
  if (ierr != PETSC_ERR_FILE_OPEN && ierr != PETSC_ERR_FILE_READ) ierr = 0;
  if (ierr) SETERRQ(PETSC_COMM_SELF, ierr, "%s: %s", c->path, c->words);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFileCheck(const char path[], const LamReporter *reporter, PetscBool *sound, char **json)
{
  Check c = {.path = path,
             .reporter = reporter && reporter->progress ? reporter : NULL,
             .file = H5I_INVALID_HID,
             .damaged = json_array(),
             .unchecked = json_array()};
  PetscErrorCode ierr = OpenAndCheck(&c);
  json_t *object;
  char *text;

  PetscFunctionBeginUser;
  *sound = (PetscBool)!json_array_size(c.damaged);
  object = json_pack("{s:o, s:b, s:o, s:I, s:o, s:o, s:o}", "file", LamJSONText(path), "sound", (int)*sound, "records",
                     c.counted ? json_integer(c.header.committed) : json_null(), "sound_records",
                     (json_int_t)c.sound_records, "damaged", c.damaged, "unchecked", c.unchecked, "writer",
                     LamWriterToJSON(path));
  PetscCall(LamHeaderDestroy(&c.header));
  text = json_dumps(object, JSON_COMPACT);
  json_decref(object);
  if (!ierr) ierr = PetscStrallocpy(text, json);
  free(text);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
