/*
  How long pieces of work take, and what was predicted: pairs of a database's records, drawn from again.

  The prediction of a record is that of `lamella build`: the geometric mean of the factorisations of the four nearest
  records that stand before it in the file; times the mean time of a factorisation. Records are sorted by prediction
  into WORK_CLASSES classes of like number; a class keeps its mean prediction and the times of its records. So
  prediction and time are drawn jointly.
*/
#ifndef LAM_WORK_TABLE_H
#define LAM_WORK_TABLE_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <grid.h>

enum { WORK_CLASSES = 16, WORK_NEIGHBOURS = 4 };

typedef struct {
  PetscReal predicted; /* s */
  PetscInt n;
  PetscReal *seconds; /* [n]; owned */
} WorkClass;

typedef struct {
  WorkClass classes[WORK_CLASSES];
  PetscReal mean;          /* s */
  PetscReal factorisation; /* mean time of one, s */
} WorkTable;

typedef struct {
  PetscReal predicted, seconds;
} WorkPair;

static inline int CompareWork(const void *a, const void *b)
{
  const WorkPair *x = a, *y = b;

  return (x->predicted > y->predicted) - (x->predicted < y->predicted);
}

/* Squared, in root cells of the grid; far where one of them has no place in it. */
static inline PetscReal NodeDistance(PetscInt64 a, PetscInt64 b)
{
  const LamNodePlace x = LamNodePlaceOf(a), y = LamNodePlaceOf(b);
  PetscReal sum = PetscSqr((PetscReal)(x.j - y.j) / LAM_ROOT);

  for (int i = 0; i < 3; i++) sum += PetscSqr((PetscReal)(x.i[i] - y.i[i]) / LAM_ROOT);
  return sum;
}

/* Factorisations of record n, from the nearest of those before it. */
static inline PetscReal PredictWork(PetscInt n, const PetscInt64 keys[], const LamResponse records[])
{
  PetscReal nearest[WORK_NEIGHBOURS + 1], cost[WORK_NEIGHBOURS + 1], sum = 0;
  PetscInt have = 0;

  for (PetscInt i = 0; i < n; i++) {
    const PetscReal distance = NodeDistance(keys[i], keys[n]);
    PetscInt k = have;

    for (; k && nearest[k - 1] > distance; k--) {
      nearest[k] = nearest[k - 1];
      cost[k] = cost[k - 1];
    }
    nearest[k] = distance;
    cost[k] = log(PetscMax(1, (PetscReal)records[i].factorisations));
    have = PetscMin(have + 1, WORK_NEIGHBOURS);
  }
  for (PetscInt k = 0; k < have; k++) sum += cost[k];
  return have ? exp(sum / (PetscReal)have) : records[n].factorisations;
}

static inline PetscErrorCode FillWorkTable(PetscInt n, WorkPair pairs[], WorkTable *table)
{
  PetscFunctionBeginUser;
  qsort(pairs, (size_t)n, sizeof(*pairs), CompareWork);
  table->mean = 0;
  for (PetscInt i = 0; i < n; i++) table->mean += pairs[i].seconds / (PetscReal)n;
  for (PetscInt c = 0; c < WORK_CLASSES; c++) {
    const PetscInt first = c * n / WORK_CLASSES, last = (c + 1) * n / WORK_CLASSES;
    WorkClass *class = &table->classes[c];

    *class = (WorkClass){.n = last - first};
    PetscCall(PetscMalloc1(class->n, &class->seconds));
    for (PetscInt i = first; i < last; i++) {
      class->predicted += pairs[i].predicted / (PetscReal) class->n;
      class->seconds[i - first] = pairs[i].seconds;
    }
  }
  PetscFunctionReturn(0);
}

static inline PetscErrorCode ReadWorkTable(const char path[], WorkTable *table)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  PetscReal seconds = 0, cost = 0;
  LamDatabase database;
  WorkPair *pairs;
  PetscInt n, used = 0;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseOpen(path, &database));
  PetscCall(LamDatabaseGetRecords(database, &n, &records, &keys));
  PetscCheck(n >= WORK_CLASSES, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: has %" PetscInt_FMT " records, too few",
             path, n);
  PetscCall(PetscMalloc1(n, &pairs));
  for (PetscInt i = 0; i < n; i++) {
    if (LamKeyIsFreeCell(keys[i])) continue;
    pairs[used++] = (WorkPair){PredictWork(i, keys, records), records[i].seconds};
    seconds += records[i].seconds;
    cost += records[i].factorisations;
  }
  table->factorisation = seconds / cost;
  for (PetscInt i = 0; i < used; i++) pairs[i].predicted *= table->factorisation;
  PetscCall(FillWorkTable(used, pairs, table));
  PetscCall(PetscFree(pairs));
  PetscCall(LamDatabaseClose(&database));
  PetscFunctionReturn(0);
}

/* figures[n]: prediction and time, ms; `factorisation` in s. */
static inline PetscErrorCode FiguresWorkTable(PetscInt n, const float figures[][2], PetscReal factorisation,
                                              WorkTable *table)
{
  WorkPair *pairs;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &pairs));
  for (PetscInt i = 0; i < n; i++) pairs[i] = (WorkPair){1e-3 * (double)figures[i][0], 1e-3 * (double)figures[i][1]};
  table->factorisation = factorisation;
  PetscCall(FillWorkTable(n, pairs, table));
  PetscCall(PetscFree(pairs));
  PetscFunctionReturn(0);
}

/* All pieces take this long, as predicted, in 30 factorisations. */
static inline PetscErrorCode EqualWorkTable(PetscReal seconds, WorkTable *table)
{
  WorkPair pairs[WORK_CLASSES];

  PetscFunctionBeginUser;
  for (int c = 0; c < WORK_CLASSES; c++) pairs[c] = (WorkPair){seconds, seconds};
  table->factorisation = seconds / 30;
  PetscCall(FillWorkTable(WORK_CLASSES, pairs, table));
  PetscFunctionReturn(0);
}

static inline void DestroyWorkTable(WorkTable *table)
{
  for (int c = 0; c < WORK_CLASSES; c++) (void)PetscFree(table->classes[c].seconds);
}

/* S. Vigna's splitmix64: a number that looks random, always the same for the same x. */
static inline uint64_t MixBits(uint64_t x)
{
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/* Of so many pieces those of the class, in proportion to its records. */
static inline PetscInt64 ShareOfClass(const WorkTable *table, PetscInt64 pieces, int class)
{
  PetscInt64 before = 0, records = 0;

  for (int c = 0; c < WORK_CLASSES; c++) {
    records += table->classes[c].n;
    before += c < class ? table->classes[c].n : 0;
  }
  return (before + table->classes[class].n) * pieces / records - before * pieces / records;
}

/* Piece `number` of the class, s. */
static inline PetscReal DrawWork(const WorkTable *table, int class, uint64_t number)
{
  const WorkClass *c = &table->classes[class];

  return c->seconds[(MixBits(number) >> 32) * (uint64_t)c->n >> 32];
}

#endif
