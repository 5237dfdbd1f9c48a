/* Databases to merge: shard_path[i], with nodes of one grid whose numbers are made up; the result is `path`. */
#ifndef LAM_MERGE_FIXTURE_H
#define LAM_MERGE_FIXTURE_H

#include "record_bytes.h"
#include "grid.h"

enum { SHARDS = 3 };
static char shard_path[SHARDS][160];
static LamMergeReport report;

static inline int EnterMerge(void **state)
{
  const int status = Enter(state);

  for (int s = 0; s < SHARDS; s++) snprintf(shard_path[s], sizeof(shard_path[s]), "%s/shard-%d.h5", directory, s);
  return status;
}

static inline int LeaveMerge(void **state)
{
  for (int s = 0; s < SHARDS; s++) unlink(shard_path[s]);
  return Leave(state);
}

static inline LamScene ShardScene(void)
{
  LamScene scene = Scene();

  scene.turgor = 0.2;
  return scene;
}

/* Place number `number` on the edge of the grid. */
static inline PetscInt64 Node(int number)
{
  const LamNodePlace place = {.i = {0, 0, number}};

  return LamNodeKeyOf(&place);
}

static inline LamGrid ShardGrid(const LamScene *scene)
{
  LamGrid grid;

  assert_int_equal(LamGridCreate(scene, NULL, &grid), 0);
  return grid;
}

/* An answer to the node, with numbers of its own. */
static inline LamResponse NodeResponse(PetscInt64 key)
{
  const LamNodePlace place = LamNodePlaceOf(key);
  const LamScene scene = ShardScene();
  LamGrid grid = ShardGrid(&scene);
  LamResponse r = Response(LAM_STATUS_COUNT * (place.i[2] + 1)); /* converged */

  LamGridNodeLoad(grid, key, &r.load);
  LamGridDestroy(&grid);
  return r;
}

/* records NULL: made up for the nodes. A grid is there where the first key is of a node. */
static inline void WriteOf(const LamScene *scene, int shard, PetscInt n, const PetscInt64 keys[],
                           const LamResponse records[])
{
  LamResponse *made = calloc((size_t)n, sizeof(*made));
  LamGrid grid = ShardGrid(scene);
  LamRecordWriter writer;
  char *text;

  for (PetscInt i = 0; i < n && !records; i++) made[i] = NodeResponse(keys[i]);
  LamGridGetText(grid, &text);
  assert_int_equal(LamRecordWriterOpen(shard_path[shard], "database", LAM_WRITE_CREATE, scene, &writer), 0);
  if (LamKeyIsNode(keys[0])) assert_int_equal(LamRecordWriterText(writer, LAM_GRID_NAME, text), 0);
  assert_int_equal(LamRecordWriterCommit(writer, n, keys, records ? records : made), 0);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  PetscFree(text);
  LamGridDestroy(&grid);
  free(made);
}

static inline void WriteRecords(int shard, PetscInt n, const PetscInt64 keys[], const LamResponse records[])
{
  const LamScene scene = ShardScene();

  WriteOf(&scene, shard, n, keys, records);
}

static inline void WriteShard(int shard, PetscInt n, const PetscInt64 keys[])
{
  WriteRecords(shard, n, keys, NULL);
}

/* n shards, the first of them number `first`, the others behind it, around the end. */
static inline PetscErrorCode TryShards(PetscInt n, PetscInt first, PetscBool salvage)
{
  const LamMergeOptions options = {.salvage = salvage};
  const char *files[SHARDS];

  for (PetscInt s = 0; s < n; s++) files[s] = shard_path[(first + s) % SHARDS];
  return LamDatabaseMerge(path, n, files, &options, &report);
}

static inline void MergeShards(PetscInt n, PetscInt first)
{
  const PetscErrorCode ierr = TryShards(n, first, PETSC_FALSE);

  if (ierr) fail_msg("error %d: %s", (int)ierr, ErrorMessage);
}

static inline void AssertNothingLeft(void)
{
  char temporary[160];

  snprintf(temporary, sizeof(temporary), "%s.tmp", path);
  assert_int_equal(access(path, F_OK), -1);
  assert_int_equal(access(temporary, F_OK), -1);
  assert_int_equal(access(lock_path, F_OK), -1);
}

static inline void AssertRecord(PetscInt i, PetscInt64 key, const LamResponse *wanted)
{
  const PetscInt64 *keys;
  PetscInt n;
  const LamResponse *records = OpenRecords(&n, &keys);

  assert_true(i < n);
  assert_true(keys[i] == key);
  AssertSame(&records[i], wanted);
}

static inline LamResponse OnlyRecord(void)
{
  PetscInt n;
  const LamResponse *records = OpenRecords(&n, NULL);

  assert_int_equal(n, 1);
  return records[0];
}

/* Makes the shard's only record one of a version without this member. */
static inline void RemoveMember(int shard, const char removed[], const PetscInt64 *key, const LamResponse *record)
{
  char word[80];

  snprintf(word, sizeof(word), " %s ", removed);
  ReplaceRecords(shard_path[shard], ChangedType(word, NULL), 1, key, record);
}

#define MERGE_TEST(name) TEST_WITH(name, EnterMerge, LeaveMerge)

#endif
