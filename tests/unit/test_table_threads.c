/* Threads that ask one table at the same time are answered as one that asks alone. */
#include "support/test.h"
#include "support/table_fixture.h"
#include "database_internal.h"
#include <pthread.h>
#include <unistd.h>

enum { QUESTIONS = 2000, THREADS = 4, FILLED = 60 };
#define ACCURACY 1e-3

static const char scene_text[] = "version: 1\n"
                                 "rve:\n"
                                 "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
                                 "  wall: {law: mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa}\n"
                                 "  mesh: {along: 4, through: 1}\n"
                                 "sample:\n"
                                 "  stretch: {min: -0.05, max: 0.1}\n"
                                 "  turgor: {min: 0 MPa, max: 0.02 MPa}\n";

static LamDatabase database;
static LamLoad questions[QUESTIONS];
static LamResponse alone[QUESTIONS];

static PetscReal Uniform(unsigned *seed, PetscReal least, PetscReal most)
{
  *seed = *seed * 1664525u + 1013904223u;
  return least + (most - least) * (PetscReal)(*seed >> 8) / 16777216.0;
}

/* Some of them beyond what the table answers. */
static void DrawQuestions(void)
{
  unsigned seed = 11;

  for (PetscInt i = 0; i < QUESTIONS; i++) {
    const PetscReal F11 = Uniform(&seed, 0.97, 1.1), F12 = Uniform(&seed, -0.05, 0.05);

    questions[i] = (LamLoad){.F = {F11, F12, 0, Uniform(&seed, -0.05, 0.05), Uniform(&seed, 0.97, 1.1), 0, 0, 0, 1},
                             .turgor = Uniform(&seed, 0, 0.2)};
  }
}

static void Ask(LamTable table, PetscInt i, LamResponse *answer)
{
  if (table)
    (void)LamTableQuery(table, &questions[i], ACCURACY, answer);
  else
    (void)LamDatabaseQuery(database, &questions[i], ACCURACY, answer);
  answer->seconds = 0;
}

static int Setup(void **state)
{
  const Synthetic material = {.mu = 0.5, .lambda = 2};
  char path[] = "/tmp/lamella-threads-XXXXXX";
  const int fd = mkstemp(path);
  PetscErrorCode ierr;
  LamScene *scene;

  if (fd < 0) return 1;
  close(fd);
  DrawQuestions();
  if (LamSceneReadText("test_table_threads", scene_text, &scene)) return 1;
  ierr = TableFixtureWrite(path, scene, &material, FILLED, questions, ACCURACY);
  if (!ierr) ierr = LamDatabaseOpen(path, &database);
  unlink(path);
  LamSceneDestroy(&scene);
  return ierr ? 1 : 0;
}

static int Teardown(void **state)
{
  return LamDatabaseClose(&database) ? 1 : 0;
}

typedef struct {
  LamTable table; /* NULL: the database is asked */
  PetscInt first;
  PetscInt different;
} Reader;

/* All questions, each thread from another one on. */
static void *Read(void *ctx)
{
  Reader *reader = ctx;

  for (PetscInt k = 0; k < QUESTIONS; k++) {
    const PetscInt i = (reader->first + k) % QUESTIONS;
    LamResponse answer;

    Ask(reader->table, i, &answer);
    reader->different += memcmp(&answer, &alone[i], sizeof(answer)) != 0;
  }
  return NULL;
}

static void AskAlone(LamTable table)
{
  PetscInt answered = 0;

  for (PetscInt i = 0; i < QUESTIONS; i++) {
    Ask(table, i, &alone[i]);
    answered += alone[i].status == LAM_CONVERGED;
  }
  assert_true(answered > QUESTIONS / 2 && answered < QUESTIONS);
}

static void ReadInThreads(LamTable table)
{
  Reader readers[THREADS];
  pthread_t threads[THREADS];

  for (int t = 0; t < THREADS; t++) {
    readers[t] = (Reader){.table = table, .first = t * QUESTIONS / THREADS};
    assert_int_equal(pthread_create(&threads[t], NULL, Read, &readers[t]), 0);
  }
  for (int t = 0; t < THREADS; t++) {
    assert_int_equal(pthread_join(threads[t], NULL), 0);
    assert_int_equal(readers[t].different, 0);
  }
}

TEST(threads_that_ask_a_table_are_answered_alike)
{
  OWNED(LamTable, LamTableDestroy) table;

  assert_int_equal(LamDatabaseGetTable(database, &table), 0);
  AskAlone(table);
  ReadInThreads(table);
}

/* The first question, asked by one thread alone, makes the table. */
TEST(threads_that_ask_a_database_are_answered_alike)
{
  AskAlone(NULL);
  ReadInThreads(NULL);
}

/* No node of this table has been made before the threads ask. */
TEST(threads_that_make_the_nodes_of_a_table_are_answered_alike)
{
  OWNED(LamTable, LamTableDestroy) table;

  AskAlone(NULL);
  assert_int_equal(LamTableMake(&database->nodes, database->grid, &database->header.micro, &table), 0);
  ReadInThreads(table);
}

TEST_GROUP(.setup = Setup, .teardown = Teardown);
