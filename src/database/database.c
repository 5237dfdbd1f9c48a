/*
  The database in memory: loaded once, then read by queries or extended by a cache.
*/
#include "database_internal.h"
#include <string.h>

/* ---- open, close ---- */

/* Records left out of the database. */
typedef struct {
  PetscInt first, n; /* first: index in the file */
  PetscInt64 *keys;
  LamResponse *records;
} Later;

typedef struct {
  LamDatabase db;
  LamNodeLayout nodes; /* made with the first record */
  Later *later;        /* NULL: load all records */
} Loading;

static PetscErrorCode LoadRecord(void *ctx, const LamRecordLayout *layout, PetscInt number, const unsigned char *bytes,
                                 const char damage[])
{
  const PetscInt64 key = LamRecordInt(bytes + layout->key);
  Loading *l = ctx;
  LamDatabase db = l->db;
  LamNodeSet *set = &db->nodes;
  LamResponse record;

  PetscFunctionBeginUser;
  if (!number) LamNodeLayoutMake(layout->key, layout->member, &l->nodes);
  if (l->later && number >= l->later->first) {
    l->later->keys[l->later->n] = key;
    PetscCall(LamRecordUnpack(layout, bytes, &l->later->records[l->later->n++]));
    PetscFunctionReturn(0);
  }
  db->keys[db->n++] = key;
  if (LamKeyIsNode(key)) {
    /* upper bound, allocated once: unused pages stay untouched */
    PetscCall(LamGrow(set->count, db->header.committed - number, sizeof(*set->data), &set->capacity, &set->data));
    LamNodeDataFromBytes(&l->nodes, bytes, &set->data[set->count++]);
  } else {
    PetscCall(LamRecordUnpack(layout, bytes, &record));
    PetscCall(LamScatterAdd(db, &record));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode MakeLater(const char path[], PetscInt committed, Later *later)
{
  PetscFunctionBeginUser;
  PetscCheck(later->first <= committed, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: has %" PetscInt_FMT " records, %" PetscInt_FMT " are wanted; it is another file than before", path,
             committed, later->first);
  PetscCall(PetscMalloc1(committed - later->first, &later->keys));
  PetscCall(PetscMalloc1(committed - later->first, &later->records));
  PetscFunctionReturn(0);
}

static PetscErrorCode Load(const char path[], hid_t file, void *ctx)
{
  const Loading *loading = ctx;
  LamDatabase db = loading->db;
  PetscBool required;

  PetscFunctionBeginUser;
  PetscCall(LamHeaderRead(path, file, &db->header));
  if (loading->later) PetscCall(MakeLater(path, db->header.committed, loading->later));
  PetscCall(PetscStrallocpy(path, &db->path));
  PetscCall(LamImagesMake(&db->header.micro, &db->images));
  PetscCall(LamScatterMetricMake(&db->header.micro, &db->metric));
  PetscCall(LamGrow(db->n, db->header.committed, sizeof(*db->keys), &db->capacity, &db->keys));
  PetscCall(LamFileScanRecords(path, file, db->header.committed, LoadRecord, ctx));
  db->records_first = db->n;
  required = (PetscBool)(db->nodes.count && !strcmp(db->header.kind, "database"));
  PetscCall(LamFileGetGrid(path, file, required, &db->header.micro, &db->grid));
  PetscFunctionReturn(0);
}

static PetscErrorCode Open(const char path[], Later *later, LamDatabase *database)
{
  Loading loading = {.later = later};
  PetscErrorCode ierr;
  LamDatabase db;

  PetscFunctionBeginUser;
  *database = NULL;
  PetscCall(PetscNew(&db));
  loading.db = db;
  ierr = LamFileRead(path, Load, &loading);
  if (ierr) {
    PetscCall(LamDatabaseClose(&db));
    if (later) PetscCall(PetscFree(later->keys));
    if (later) PetscCall(PetscFree(later->records));
  }
  PetscCall(ierr);
  *database = db;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseOpen(const char path[], LamDatabase *database)
{
  PetscFunctionBeginUser;
  PetscCall(Open(path, NULL, database));
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseOpenFirst(const char path[], PetscInt first, LamDatabase *database, PetscInt *n,
                                    PetscInt64 *keys[], LamResponse *records[])
{
  Later later = {.first = first};

  PetscFunctionBeginUser;
  PetscCall(Open(path, &later, database));
  *n = later.n;
  *keys = later.keys;
  *records = later.records;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseCreateEmpty(const LamScene *scene, LamDatabase *database)
{
  LamDatabase db;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&db));
  db->header.format_version = LAM_FORMAT_VERSION;
  db->header.scales = scene->scales;
  db->header.accuracy = scene->accuracy;
  PetscCall(LamMicrostructureCopy(&scene->micro, &db->header.micro));
  PetscCall(PetscStrallocpy("database", &db->header.kind));
  PetscCall(PetscMalloc1(LAM_HASH_LENGTH, &db->header.hash));
  PetscCall(LamMicrostructureDescribe(&scene->micro, &db->header.description, db->header.hash));
  PetscCall(LamImagesMake(&scene->micro, &db->images));
  PetscCall(LamScatterMetricMake(&scene->micro, &db->metric));
  *database = db;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseClose(LamDatabase *database)
{
  LamDatabase db = *database;

  PetscFunctionBeginUser;
  if (!db) PetscFunctionReturn(0);
  PetscCall(LamHeaderDestroy(&db->header));
  PetscCall(PetscFree(db->path));
  PetscCall(PetscFree(db->keys));
  PetscCall(PetscFree(db->nodes.data));
  PetscCall(PetscFree(db->scatter.records));
  PetscCall(PetscFree(db->scatter.states));
  PetscCall(PetscFree(db->scatter.places));
  PetscCall(PetscFree(db->records));
  PetscCall(PetscFree(db->info));
  PetscCall(LamTableDestroy(&db->table));
  PetscCall(LamGridDestroy(&db->grid));
  PetscCall(PetscFree(*database));
  PetscFunctionReturn(0);
}

/* ---- whole responses ---- */

/* Loads the file's records and puts them in front of those added in memory. The file may have grown since it was
   opened, but must not have been replaced. */
static PetscErrorCode LoadRecords(LamDatabase db)
{
  const PetscInt count = db->records_first;
  Later all = {0};
  LamDatabase now;
  PetscBool same;

  PetscFunctionBeginUser;
  PetscCall(Open(db->path, &all, &now));
  same = (PetscBool)(!strcmp(now->header.hash, db->header.hash) && all.n >= count &&
                     !memcmp(all.keys, db->keys, (size_t)count * sizeof(*db->keys)));
  PetscCall(LamDatabaseClose(&now));
  PetscCall(PetscFree(all.keys));
  if (!same) PetscCall(PetscFree(all.records));
  PetscCheck(same, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: the file was replaced while it was in use", db->path);
  PetscCall(PetscRealloc((size_t)db->n * sizeof(*db->records), &all.records));
  PetscCall(PetscArraycpy(all.records + count, db->records, db->n - count));
  PetscCall(PetscFree(db->records));
  db->records = all.records;
  db->records_capacity = db->n;
  db->records_first = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseGetRecords(LamDatabase database, PetscInt *n, const LamResponse *records[],
                                     const PetscInt64 *keys[])
{
  PetscFunctionBeginUser;
  if (n) *n = database->n;
  if (records && database->records_first) PetscCall(LoadRecords(database));
  if (records) *records = database->records;
  if (keys) *keys = database->keys;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseGetAdded(LamDatabase database, PetscInt from, PetscInt *n, const LamResponse *records[])
{
  PetscFunctionBeginUser;
  PetscCheck(from >= database->records_first && from <= database->n, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "record %" PetscInt_FMT " is none of those added", from);
  *n = database->n - from;
  *records = database->records + (from - database->records_first);
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseGetMicrostructure(LamDatabase database, LamMicrostructure *micro, LamScales *scales,
                                            const char *hash[])
{
  PetscFunctionBeginUser;
  if (micro) *micro = database->header.micro;
  if (scales) *scales = database->header.scales;
  if (hash) *hash = database->header.hash;
  PetscFunctionReturn(0);
}

/* Without keys the records are states outside the grid, numbered from LAM_CACHE_KEY on. */
PetscErrorCode LamDatabaseAdd(LamDatabase database, PetscInt n, const PetscInt64 keys[], const LamResponse records[])
{
  const PetscInt held = database->n - database->records_first;
  LamNodeSet *set = &database->nodes;

  PetscFunctionBeginUser;
  PetscCall(LamGrow(database->n, n, sizeof(*database->keys), &database->capacity, &database->keys));
  PetscCall(LamGrow(set->count, n, sizeof(*set->data), &set->capacity, &set->data));
  PetscCall(LamGrow(held, n, sizeof(*records), &database->records_capacity, &database->records));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt at = database->n++;
    const PetscInt64 key = keys ? keys[i] : LAM_CACHE_KEY + at;

    database->keys[at] = key;
    database->records[held + i] = records[i];
    if (LamKeyIsNode(key))
      LamNodeDataFromResponse(&records[i], key, &set->data[set->count++]);
    else
      PetscCall(LamScatterAdd(database, &records[i]));
  }
  PetscFunctionReturn(0);
}

/* ---- grid and table ---- */

PetscErrorCode LamDatabaseSetGrid(LamDatabase database, LamGrid *grid)
{
  PetscFunctionBeginUser;
  PetscCheck(!database->grid, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "the database has a grid");
  database->grid = *grid;
  *grid = NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseGetGrid(LamDatabase database, LamGrid *grid)
{
  PetscFunctionBeginUser;
  *grid = database->grid;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseGetTable(LamDatabase database, LamTable *table)
{
  PetscFunctionBeginUser;
  if (database->grid && (!database->table || database->table_count != database->nodes.count)) {
    PetscCall(LamTableDestroy(&database->table));
    PetscCall(LamTableMake(&database->nodes, database->grid, &database->header.micro, &database->table));
    database->table_count = database->nodes.count;
  }
  *table = LamTableReference(database->table);
  PetscFunctionReturn(0);
}
