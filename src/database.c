/*
  The database in memory: loaded once, then only read (queries) or added to (cache).
*/
#include "database_internal.h"
#include <string.h>

static PetscErrorCode Reserve(LamDatabase db, PetscInt n)
{
  PetscFunctionBeginUser;
  if (n <= db->capacity) PetscFunctionReturn(0);
  db->capacity = PetscMax(2 * db->capacity, n);
  PetscCall(PetscRealloc((size_t)db->capacity * sizeof(*db->records), &db->records));
  PetscCall(PetscRealloc((size_t)db->capacity * sizeof(*db->keys), &db->keys));
  PetscCall(PetscRealloc((size_t)db->capacity * sizeof(*db->expansions), &db->expansions));
  PetscFunctionReturn(0);
}

static PetscErrorCode Load(const char path[], hid_t file, LamDatabase db)
{
  PetscFunctionBeginUser;
  PetscCall(LamHeaderRead(path, file, &db->header));
  PetscCall(LamFileReadRecords(path, file, db->header.committed, &db->records, &db->keys));
  db->n = db->capacity = db->header.committed;
  PetscCall(PetscMalloc1(db->n + 1, &db->expansions));
  LamImagesMake(&db->header.micro, &db->images);
  for (PetscInt i = 0; i < db->n; i++) LamExpansionMake(&db->records[i], &db->expansions[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseOpen(const char path[], LamDatabase *database)
{
  hid_t file = H5I_INVALID_HID;
  PetscErrorCode ierr;
  LamDatabase db;
  int lock;

  PetscFunctionBeginUser;
  *database = NULL;
  PetscCall(PetscNew(&db));
  lock = LamLockBeginRead(path);
  ierr = LamFileOpenRead(path, &file);
  if (!ierr) ierr = Load(path, file, db);
  if (file >= 0) H5Fclose(file);
  LamLockEndRead(lock);
  if (ierr) (void)LamDatabaseClose(&db);
  PetscCall(ierr);
  *database = db;
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
  PetscCall(PetscStrncpy(db->header.kind, "database", sizeof(db->header.kind)));
  PetscCall(LamMicrostructureDescribe(&scene->micro, &db->header.description, db->header.hash));
  LamImagesMake(&scene->micro, &db->images);
  *database = db;
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseClose(LamDatabase *database)
{
  LamDatabase db = *database;

  PetscFunctionBeginUser;
  if (!db) PetscFunctionReturn(0);
  PetscCall(LamHeaderDestroy(&db->header));
  PetscCall(PetscFree(db->records));
  PetscCall(PetscFree(db->keys));
  PetscCall(PetscFree(db->expansions));
  PetscCall(PetscFree(db->info));
  PetscCall(PetscFree(*database));
  PetscFunctionReturn(0);
}

PetscErrorCode LamDatabaseGetRecords(LamDatabase database, PetscInt *n, const LamResponse *records[],
                                     const PetscInt64 *keys[])
{
  PetscFunctionBeginUser;
  if (n) *n = database->n;
  if (records) *records = database->records;
  if (keys) *keys = database->keys;
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

PetscErrorCode LamDatabaseGetInfo(LamDatabase database, const char *json[])
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(database->info));
  PetscCall(LamDatabaseDescribe(database, &database->info));
  *json = database->info;
  PetscFunctionReturn(0);
}

/* States of no grid get keys of their own, as a cache gives them. */
PetscErrorCode LamDatabaseAdd(LamDatabase database, PetscInt n, const PetscInt64 keys[], const LamResponse records[])
{
  PetscFunctionBeginUser;
  PetscCall(Reserve(database, database->n + n));
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt at = database->n++;

    database->records[at] = records[i];
    database->keys[at] = keys ? keys[i] : LAM_CACHE_KEY + at;
    LamExpansionMake(&records[i], &database->expansions[at]);
  }
  PetscFunctionReturn(0);
}
