/* A folder of its own for each test of record files, and files to put into it. */
#ifndef LAM_RECORD_FIXTURE_H
#define LAM_RECORD_FIXTURE_H

#include "support/error_message.h"
#include "support/test.h"
#include <lamella/database.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char directory[64], path[128], lock_path[160];
static LamDatabase opened; /* by OpenRecords */

/* ---- fixtures ---- */

static inline int Enter(void **state)
{
  snprintf(directory, sizeof(directory), "/tmp/lamella-records-XXXXXX");
  if (!mkdtemp(directory)) return -1;
  snprintf(path, sizeof(path), "%s/file.h5", directory);
  snprintf(lock_path, sizeof(lock_path), "%s.lock", path);
  return KeepErrorMessages();
}

static inline int Leave(void **state)
{
  char other[160];

  if (opened) LamDatabaseClose(&opened);
  PetscPopErrorHandler();
  unlink(path);
  unlink(lock_path);
  snprintf(other, sizeof(other), "%s.tmp", path);
  unlink(other);
  return rmdir(directory);
}

static inline LamScene Scene(void)
{
  LamScene scene = {.text = "version: 1\n",
                    .micro = {.wall_thickness = 0.15,
                              .cells = {1, 1},
                              .along = 6,
                              .through = 2,
                              .wall = {.C1 = 10.0 / 11, .C2 = 1.0 / 11, .C4 = 100.0 / 11, .bulk_modulus = 1000}},
                    .scales = {.length = 75e-6, .stress = 0.11e6},
                    .accuracy = 0.01};
  return scene;
}

/* Responses with a different number in every member. */
static inline LamResponse Response(PetscInt seed)
{
  const LamLoad load = {.F = {1, 0.1, 0, 0, 1, 0, 0, 0, 1}, .turgor = 0.1};
  PetscReal next = 1.0 / 3 + seed;
  LamResponse r;

  LamResponseInit(&load, &r);
  for (const LamMember *m = LamResponseMembers; m->name; m++)
    for (PetscInt i = 0; m->type == LAM_MEMBER_REAL && i < m->count; i++)
      ((PetscReal *)((char *)&r + m->offset))[i] = next++;
  r.tangent[2] = NAN;
  r.status = (LamStatus)(seed % LAM_STATUS_COUNT);
  r.stable = (PetscBool)(seed % 2);
  r.newton_iterations = seed + 7;
  r.unknowns = 644;
  snprintf(r.reason, sizeof(r.reason), "reason %d", (int)seed);
  return r;
}

static inline void Commit(LamRecordWriter writer, PetscInt64 first, PetscInt n)
{
  LamResponse *r = calloc((size_t)n, sizeof(*r));
  PetscInt64 *keys = calloc((size_t)n, sizeof(*keys));

  for (PetscInt i = 0; i < n; i++) {
    keys[i] = first + i;
    r[i] = Response((PetscInt)keys[i]);
  }
  assert_int_equal(LamRecordWriterCommit(writer, n, keys, r), 0);
  free(r);
  free(keys);
}

static inline LamRecordWriter Open(LamWriteMode mode)
{
  LamScene scene = Scene();
  LamRecordWriter writer;

  assert_int_equal(LamRecordWriterOpen(path, "database", mode, &scene, &writer), 0);
  return writer;
}

/* Nodes are of a grid, which a file of them must have. */
static inline void WriteGrid(LamRecordWriter writer)
{
  assert_int_equal(LamRecordWriterText(writer, LAM_GRID_NAME, "{\"origin\":0,\"step\":0.05,\"turgor\":0.1}"), 0);
}

static inline void WriteFile(PetscInt n)
{
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);

  Commit(writer, 0, n);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
}

/* Of the file; they are there until the next call or the end of the test. */
static inline const LamResponse *OpenRecords(PetscInt *n, const PetscInt64 **keys)
{
  const LamResponse *records;

  if (opened) LamDatabaseClose(&opened);
  assert_int_equal(LamDatabaseOpen(path, &opened), 0);
  LamDatabaseGetRecords(opened, n, &records, keys);
  return records;
}

static inline PetscInt CountRecords(void)
{
  PetscInt n = -1;

  OpenRecords(&n, NULL);
  return n;
}

static inline void AssertMessage(const char part[])
{
  if (!strstr(ErrorMessage, part)) fail_msg("message: %s", ErrorMessage);
}

static inline void AssertUnreadable(const char part[])
{
  LamDatabase db;

  assert_int_equal(LamDatabaseOpen(path, &db), PETSC_ERR_USER_INPUT);
  AssertMessage(part);
  AssertMessage(path);
}

static inline void AssertNotOpened(LamWriteMode mode, PetscErrorCode code, const char part[])
{
  LamScene scene = Scene();
  LamRecordWriter writer;

  assert_int_equal(LamRecordWriterOpen(path, "database", mode, &scene, &writer), code);
  AssertMessage(part);
}

static inline void AssertSame(const LamResponse *a, const LamResponse *b)
{
  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    const char *p = (const char *)a + m->offset, *q = (const char *)b + m->offset;
    const size_t size = m->type == LAM_MEMBER_REAL ? sizeof(PetscReal) : m->type == LAM_MEMBER_TEXT ? 1 : sizeof(int);

    if (m->type == LAM_MEMBER_TEXT)
      assert_string_equal(p, q);
    else if (memcmp(p, q, size * (size_t)m->count))
      fail_msg("%s differs", m->name);
  }
}

#define FILE_TEST(name) TEST_WITH(name, Enter, Leave)

#endif
