/*
  Method. Left-looking: block column j is what earlier columns i that reach row j leave of K(:, j),
    A(k, j) = K(k, j) - sum_i L(k, i) D(i) L(j, i)^T,  A(j, j) = L(j, j) D(j) L(j, j)^T,
    L(k, j) = A(k, j) L(j, j)^-T D(j)^-1,  L(j, j) = [1, 0; l, 1].
  Blocks are ordered by approximate minimum degree. For each pair (j, i) the places in column j of the blocks of column
  i are listed once.

  Constraints V^T x = b with multipliers, whose part of the diagonal is zero, may be all that holds soft motions. Pivots
  of the positions, which come first, would then nearly vanish. So a multiple of the constraints is added to the other
  rows,  [K + rho V V^T, V; V^T, 0] (x, lambda) = (a + rho V b, b),  which changes neither solution nor inertia.
*/
#include "ldl.h"
#include "clones.h"
#include <limits.h>
#include <stdint.h>
#include <petscmat.h>

#define MOST_GROWTH 1e4 /* largest |L| |D| |L|^T over the diagonal of K: rounding errors are this times eps */
#define MOST_PRODUCTS                                                                                                  \
  10000000                 /* of blocks; their places take 20 MB. With more MUMPS is as fast and needs less memory */
#define LEAST_PER_BLOCK 50 /* products to expect of each block of unknowns: from 70 on one mesh to 1000 on patches */
#define LANES 4            /* right-hand sides at a time */

typedef double Four __attribute__((vector_size(32))); /* a 2 x 2 block by columns; right-hand sides */
typedef long Mask __attribute__((vector_size(32)));

/* An unknown that comes last. */
typedef struct {
  PetscInt size;        /* positions that it is coupled with */
  PetscInt *at, *entry; /* [size] which they are, indices into values; owned, as `pairs` is, ... */
  PetscReal *v;         /* [size] column of V; zero if it is not a constraint at present */
  PetscInt *pairs;      /* [size][size] index into the entries of factor of a pair of them */
  PetscBool shares;     /* ... but `at` and `pairs` are those of the one before if it has the same positions */
} Constraint;

struct LamLDL_s {
  PetscInt n, blocks, nonzeros;
  PetscInt positions;
  const PetscInt *row; /* borrowed, as `values` is */
  const PetscReal *values;
  PetscReal rho;          /* of the present factor */
  Constraint *constraint; /* [n - positions] */
  PetscInt *place;        /* [blocks] column of the factor of a block of unknowns */
  PetscInt *to;           /* [nonzeros] index into the entries of factor */
  PetscInt *start;        /* [blocks+1] first block of a column; the one on the diagonal comes first */
  PetscInt *index;        /* [start[blocks]] its rows, increasing */
  PetscInt *source;       /* [blocks+1] first source of a column */
  PetscInt *owner, *from; /* [source[blocks]] of each source of column j: column i, block L(j, i) */
  unsigned short *target; /* for each source, of all blocks from L(j, i) on: their place in column j */
  Four *memory;           /* of the following, which start at a multiple of their size */
  Four *factor;           /* [start[blocks]] L, on the diagonal D: d0, d0, d1, d1 */
  Four *inverse;          /* [blocks] 1/d0, l, 1/d1 */
  Four *work;             /* [2 blocks] */
};

/* ---- the pattern ---- */

/* Blocks i <= j of unknowns that are coupled, sorted, keys i * blocks + j. */
static PetscErrorCode FindPairs(PetscInt n, PetscInt blocks, const PetscInt row[], const PetscInt column[],
                                PetscInt *count, PetscInt64 **key)
{
  PetscInt size = row[n] + blocks;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(size, key));
  *count = 0;
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt k = row[i]; k < row[i + 1]; ++k)
      if (k == row[i] || column[k] / 2 != column[k - 1] / 2)
        (*key)[(*count)++] = (PetscInt64)(i / 2) * blocks + column[k] / 2;
  PetscCall(PetscSortInt64(*count, *key));
  size = *count;
  *count = 0;
  for (PetscInt k = 0; k < size; ++k)
    if (k == 0 || (*key)[k] != (*key)[k - 1]) (*key)[(*count)++] = (*key)[k];
  PetscFunctionReturn(0);
}

/* Orders the blocks of positions, which are those before `last`, by approximate minimum degree. */
static PetscErrorCode OrderPositions(LamLDL ldl, PetscInt last, PetscInt count, const PetscInt64 key[])
{
  const PetscInt blocks = ldl->blocks;
  PetscInt *row, *column, pairs = 0;
  PetscScalar *zero;
  Mat graph;
  IS order, same;
  const PetscInt *old;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(last + 1, &row, count, &column, count, &zero));
  for (PetscInt k = 0; k < count; ++k)
    if (key[k] % blocks < last) {
      column[pairs++] = (PetscInt)(key[k] % blocks);
      row[key[k] / blocks + 1] = pairs;
    }
  PetscCall(MatCreateSeqSBAIJWithArrays(PETSC_COMM_SELF, 1, last, last, row, column, zero, &graph));
  PetscCall(MatSetOption(graph, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatConvert(graph, MATSEQAIJ, MAT_INPLACE_MATRIX, &graph));
  PetscCall(MatGetOrdering(graph, "amd", &order, &same));
  PetscCall(ISGetIndices(order, &old));
  for (PetscInt i = 0; i < last; ++i) ldl->place[old[i]] = i;
  PetscCall(ISRestoreIndices(order, &old));
  PetscCall(ISDestroy(&order));
  PetscCall(ISDestroy(&same));
  PetscCall(MatDestroy(&graph));
  PetscCall(PetscFree3(row, column, zero));
  PetscFunctionReturn(0);
}

/* Inserts each of the other blocks right after the last position that it is coupled with. */
static PetscErrorCode InsertOthers(LamLDL ldl, PetscInt last, PetscInt count, const PetscInt64 key[])
{
  const PetscInt blocks = ldl->blocks;
  PetscInt *after, *before; /* [blocks] positions before a block; [last+1] blocks before that many positions */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(blocks, &after, last + 1, &before));
  for (PetscInt k = 0; k < count; ++k)
    if (key[k] % blocks >= last && key[k] / blocks < last)
      after[key[k] % blocks] = PetscMax(after[key[k] % blocks], ldl->place[key[k] / blocks] + 1);
  for (PetscInt i = last; i < blocks; ++i) ++before[after[i]];
  for (PetscInt i = 1; i <= last; ++i) before[i] += before[i - 1];
  for (PetscInt i = blocks - 1; i >= last; --i) ldl->place[i] = after[i] + --before[after[i]];
  for (PetscInt i = 0; i < last; ++i) ldl->place[i] += before[ldl->place[i] + 1];
  PetscCall(PetscFree2(after, before));
  PetscFunctionReturn(0);
}

/* Rows of the columns of L: those of K, and those of each column whose first row below the diagonal is this one.
 *products: of blocks, that the factorisation needs; ends as soon as they are too many. */
static PetscErrorCode FindFill(LamLDL ldl, PetscInt count, const PetscInt64 key[], PetscInt *products)
{
  const PetscInt blocks = ldl->blocks;
  PetscInt *first, *head, *next, *mark, size = 0, room = 8 * count, rows;

  PetscFunctionBeginUser;
  /* first, next: lists of the neighbours after each block in the order; head: of the columns that end in a row */
  PetscCall(PetscMalloc4(blocks, &first, PetscMax(count, blocks), &next, blocks, &head, blocks, &mark));
  for (PetscInt i = 0; i < blocks; ++i) first[i] = head[i] = mark[i] = -1;
  for (PetscInt k = 0; k < count; ++k) {
    const PetscInt a = ldl->place[key[k] / blocks], b = ldl->place[key[k] % blocks], i = PetscMin(a, b);

    next[k] = first[i];
    first[i] = k;
  }
  PetscCall(PetscMalloc1(room, &ldl->index));
  *products = 0;
  for (PetscInt j = 0; j < blocks && *products <= MOST_PRODUCTS; ++j) {
    const PetscInt begin = size;

    ldl->start[j] = begin;
    if (room < size + blocks) {
      room = 2 * (size + blocks);
      PetscCall(PetscRealloc((size_t)room * sizeof(*ldl->index), &ldl->index));
    }
    ldl->index[size++] = j;
    mark[j] = j;
    for (PetscInt k = first[j]; k >= 0; k = next[k]) {
      const PetscInt a = ldl->place[key[k] / blocks], b = ldl->place[key[k] % blocks], i = PetscMax(a, b);

      if (mark[i] != j) ldl->index[size++] = i;
      mark[i] = j;
    }
    for (PetscInt i = head[j]; i >= 0; i = ldl->source[i])
      for (PetscInt k = ldl->start[i] + 1; k < ldl->start[i + 1]; ++k)
        if (mark[ldl->index[k]] != j) {
          mark[ldl->index[k]] = j;
          ldl->index[size++] = ldl->index[k];
        }
    PetscCall(PetscSortInt(size - begin, &ldl->index[begin]));
    ldl->start[j + 1] = size;
    rows = size - begin;
    *products += rows * (rows - 1) / 2;
    if (size > begin + 1) { /* `source` holds the lists until it is filled */
      ldl->source[j] = head[ldl->index[begin + 1]];
      head[ldl->index[begin + 1]] = j;
    }
  }
  PetscCall(PetscFree4(first, next, head, mark));
  PetscFunctionReturn(0);
}

/* Lists the sources of all columns, and the places of their blocks. */
static PetscErrorCode FindTargets(LamLDL ldl, PetscInt products)
{
  const PetscInt blocks = ldl->blocks, *start = ldl->start, *index = ldl->index;
  PetscInt *place, *at, end = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(blocks, &place, blocks + 1, &at));
  PetscCall(PetscArrayzero(at, blocks + 1));
  PetscCall(PetscMalloc2(start[blocks], &ldl->owner, start[blocks], &ldl->from));
  for (PetscInt i = 0; i < blocks; ++i)
    for (PetscInt k = start[i] + 1; k < start[i + 1]; ++k) ++at[index[k] + 1];
  for (PetscInt j = 0; j < blocks; ++j) at[j + 1] += at[j];
  PetscCall(PetscArraycpy(ldl->source, at, blocks + 1));
  for (PetscInt i = 0; i < blocks; ++i)
    for (PetscInt k = start[i] + 1; k < start[i + 1]; ++k) {
      ldl->owner[at[index[k]]] = i;
      ldl->from[at[index[k]]++] = k;
    }
  PetscCall(PetscMalloc1(products, &ldl->target));
  for (PetscInt j = 0; j < blocks; ++j) {
    for (PetscInt k = start[j]; k < start[j + 1]; ++k) place[index[k]] = k - start[j];
    for (PetscInt s = ldl->source[j]; s < ldl->source[j + 1]; ++s)
      for (PetscInt k = ldl->from[s]; k < start[ldl->owner[s] + 1]; ++k)
        ldl->target[end++] = (unsigned short)place[index[k]];
  }
  PetscCall(PetscFree2(place, at));
  PetscFunctionReturn(0);
}

/* Where the entry of unknowns i and k belongs. */
static PetscInt FindEntry(LamLDL ldl, PetscInt i, PetscInt k)
{
  const PetscInt a = ldl->place[i / 2], b = ldl->place[k / 2], in_row = a >= b ? i : k, in_column = a >= b ? k : i;
  PetscInt at = ldl->start[PetscMin(a, b)];

  while (ldl->index[at] != PetscMax(a, b)) ++at;
  return 4 * at + 2 * (in_column % 2) + in_row % 2;
}

static PetscErrorCode FindConstraints(LamLDL ldl, const PetscInt column[])
{
  const PetscInt positions = ldl->positions;
  Constraint *last;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(ldl->n - positions + 1, &ldl->constraint));
  last = ldl->constraint - positions;
  for (PetscInt k = 0; k < ldl->row[positions]; ++k)
    if (column[k] >= positions) ++last[column[k]].size;
  for (PetscInt h = positions; h < ldl->n; ++h) {
    PetscCall(PetscMalloc3(last[h].size, &last[h].at, last[h].size, &last[h].entry, last[h].size, &last[h].v));
    last[h].size = 0;
  }
  for (PetscInt i = 0; i < positions; ++i)
    for (PetscInt k = ldl->row[i]; k < ldl->row[i + 1]; ++k)
      if (column[k] >= positions) {
        Constraint *c = &last[column[k]];

        c->at[c->size] = i;
        c->entry[c->size++] = k;
      }
  for (PetscInt h = positions; h < ldl->n; ++h) {
    Constraint *c = &last[h];

    if (h > positions && c[-1].size == c->size) PetscCall(PetscArraycmp(c[-1].at, c->at, c->size, &c->shares));
    if (c->shares) {
      c->pairs = c[-1].pairs;
      continue;
    }
    PetscCall(PetscMalloc1(c->size * c->size, &c->pairs));
    for (PetscInt a = 0; a < c->size; ++a)
      for (PetscInt b = a; b < c->size; ++b) c->pairs[a * c->size + b] = FindEntry(ldl, c->at[a], c->at[b]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamLDLCreate(PetscInt n, PetscInt positions, const PetscInt row[], const PetscInt column[],
                            const PetscReal values[], LamLDL *created)
{
  const PetscInt blocks = (n + 1) / 2;
  PetscInt64 *key;
  PetscInt count, products;
  LamLDL ldl;

  PetscFunctionBeginUser;
  *created = NULL;
  if (blocks > MOST_PRODUCTS / LEAST_PER_BLOCK) PetscFunctionReturn(0);
  PetscCall(PetscNew(&ldl));
  *created = ldl;
  ldl->n = n;
  ldl->blocks = blocks;
  ldl->positions = positions;
  ldl->nonzeros = row[n];
  ldl->row = row;
  ldl->values = values;
  PetscCall(PetscMalloc4(blocks, &ldl->place, row[n], &ldl->to, blocks + 1, &ldl->start, blocks + 1, &ldl->source));
  PetscCall(FindPairs(n, blocks, row, column, &count, &key));
  PetscCall(OrderPositions(ldl, positions / 2, count, key));
  PetscCall(InsertOthers(ldl, positions / 2, count, key));
  PetscCall(FindFill(ldl, count, key, &products));
  PetscCall(PetscFree(key));
  if (products > MOST_PRODUCTS) {
    PetscCall(LamLDLDestroy(created));
    PetscFunctionReturn(0);
  }
  PetscCall(FindTargets(ldl, products));
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt k = row[i]; k < row[i + 1]; ++k) ldl->to[k] = FindEntry(ldl, i, column[k]);
  PetscCall(FindConstraints(ldl, column));
  PetscCall(PetscMalloc1(ldl->start[blocks] + 3 * blocks + 1, &ldl->memory));
  ldl->factor = (Four *)(((uintptr_t)ldl->memory + sizeof(Four) - 1) & ~(uintptr_t)(sizeof(Four) - 1));
  ldl->inverse = ldl->factor + ldl->start[blocks];
  ldl->work = ldl->inverse + blocks;
  PetscFunctionReturn(0);
}

PetscErrorCode LamLDLDestroy(LamLDL *ldl)
{
  PetscFunctionBeginUser;
  if (!*ldl) PetscFunctionReturn(0);
  for (PetscInt h = 0; (*ldl)->constraint && h < (*ldl)->n - (*ldl)->positions; ++h) {
    Constraint *c = &(*ldl)->constraint[h];

    if (!c->shares) PetscCall(PetscFree(c->pairs));
    PetscCall(PetscFree3(c->at, c->entry, c->v));
  }
  PetscCall(PetscFree((*ldl)->constraint));
  PetscCall(PetscFree4((*ldl)->place, (*ldl)->to, (*ldl)->start, (*ldl)->source));
  PetscCall(PetscFree2((*ldl)->owner, (*ldl)->from));
  PetscCall(PetscFree((*ldl)->index));
  PetscCall(PetscFree((*ldl)->target));
  PetscCall(PetscFree((*ldl)->memory));
  PetscCall(PetscFree(*ldl));
  PetscFunctionReturn(0);
}

/* ---- the numbers ---- */

typedef struct {
  PetscInt negative;
  PetscBool ok;
  double growth; /* largest diagonal entry of |L| |D| |L|^T */
} Outcome;

/* Adds rho V V^T, whose largest entry on the diagonal is that of K, `diagonal`. */
static void AddConstraints(LamLDL ldl, PetscReal diagonal)
{
  double *entries = (double *)ldl->factor;
  PetscReal largest = 0.0;

  for (PetscInt h = ldl->positions; h < ldl->n; ++h) {
    Constraint *c = &ldl->constraint[h - ldl->positions];
    const PetscBool is_constraint = (PetscBool)(ldl->values[ldl->row[h]] == 0.0);

    for (PetscInt k = 0; k < c->size; ++k) {
      c->v[k] = is_constraint ? ldl->values[c->entry[k]] : 0.0;
      largest = PetscMax(largest, PetscAbsReal(c->v[k]));
    }
  }
  ldl->rho = 0.0;
  if (largest == 0.0) return;
  ldl->rho = diagonal / (largest * largest);
  for (PetscInt h = ldl->positions; h < ldl->n; ++h) {
    const Constraint *c = &ldl->constraint[h - ldl->positions];

    for (PetscInt a = 0; a < c->size; ++a)
      for (PetscInt b = a; c->v[a] != 0.0 && b < c->size; ++b)
        if (c->v[b] != 0.0) entries[c->pairs[a * c->size + b]] += ldl->rho * c->v[a] * c->v[b];
  }
}

LAM_CLONES static Outcome Factor(LamLDL ldl, PetscInt most, PetscReal diagonal)
{
  const PetscInt *start = ldl->start;
  const unsigned short *target = ldl->target;
  Four *factor = ldl->factor;
  double *entries = (double *)factor;
  Outcome out = {0, PETSC_TRUE, 0.0};

  for (PetscInt k = 0; k < start[ldl->blocks]; ++k) factor[k] = (Four){0.0};
  for (PetscInt k = 0; k < ldl->nonzeros; ++k) entries[ldl->to[k]] = ldl->values[k];
  AddConstraints(ldl, diagonal);
  if (ldl->n % 2) entries[4 * start[ldl->place[ldl->blocks - 1]] + 3] = 1.0;
  for (PetscInt j = 0; j < ldl->blocks; ++j) {
    Four *column = factor + start[j], sum = {0.0};
    const PetscInt rows = start[j + 1] - start[j];
    Four left, scale;
    double d0, d1, l;

    column[0][2] = column[0][1] = column[0][1] + column[0][2];
    for (PetscInt s = ldl->source[j]; s < ldl->source[j + 1]; ++s) {
      const PetscInt i = ldl->owner[s], count = start[i + 1] - ldl->from[s];
      const Four *L = factor + ldl->from[s], A = L[0] * factor[start[i]];
      const Four A0 = __builtin_shuffle(A, (Mask){0, 0, 1, 1}), A1 = __builtin_shuffle(A, (Mask){2, 2, 3, 3});
      const Four size = A * L[0];

      sum += (Four)((Mask)size & LONG_MAX); /* absolute values */
      for (PetscInt k = 0; k < count; ++k)
        column[target[k]] -=
            __builtin_shuffle(L[k], (Mask){0, 1, 0, 1}) * A0 + __builtin_shuffle(L[k], (Mask){2, 3, 2, 3}) * A1;
      target += count;
    }
    for (PetscInt k = 0; k < 2; ++k) out.growth = PetscMax(out.growth, sum[k] + sum[k + 2]);
    d0 = column[0][0];
    l = column[0][1] / d0;
    d1 = column[0][3] - l * column[0][1];
    out.negative += (d0 < 0.0) + (d1 < 0.0);
    if (!(PetscAbsReal(d0 * d1) > 0.0) || !isfinite(d0 + d1) || out.negative > most) {
      out.ok = PETSC_FALSE;
      return out;
    }
    column[0] = (Four){d0, d0, d1, d1};
    ldl->inverse[j] = (Four){1.0 / d0, l, 1.0 / d1, 0.0};
    left = (Four){0.0, 0.0, l, l};
    scale = 1.0 / column[0];
    for (PetscInt k = 1; k < rows; ++k)
      column[k] = (column[k] - __builtin_shuffle(column[k], (Mask){0, 1, 0, 1}) * left) * scale;
  }
  return out;
}

PetscErrorCode LamLDLNumeric(LamLDL ldl, PetscInt most, PetscInt *negative, PetscBool *ok, PetscBool *unsure)
{
  PetscReal diagonal = 0.0; /* largest entry there */
  Outcome out;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < ldl->positions; ++i) diagonal = PetscMax(diagonal, PetscAbsReal(ldl->values[ldl->row[i]]));
  out = Factor(ldl, most, diagonal);
  *negative = out.negative;
  *unsure = (PetscBool)(out.growth > MOST_GROWTH * diagonal);
  *ok = (PetscBool)(out.ok && !*unsure);
  PetscFunctionReturn(0);
}

/* x := (L D L^T)^-1 x; x [2 blocks]. */
LAM_CLONES static void Substitute(LamLDL ldl, Four x[])
{
  const PetscInt *start = ldl->start, *index = ldl->index;
  const Four *factor = ldl->factor;

  for (PetscInt j = 0; j < ldl->blocks; ++j) {
    const Four a = x[2 * j], b = x[2 * j + 1] - ldl->inverse[j][1] * a;

    for (PetscInt k = start[j] + 1; k < start[j + 1]; ++k) {
      x[2 * index[k]] -= factor[k][0] * a + factor[k][2] * b;
      x[2 * index[k] + 1] -= factor[k][1] * a + factor[k][3] * b;
    }
    x[2 * j] = ldl->inverse[j][0] * a;
    x[2 * j + 1] = ldl->inverse[j][2] * b;
  }
  for (PetscInt j = ldl->blocks - 1; j >= 0; --j) {
    Four a = x[2 * j], b = x[2 * j + 1];

    for (PetscInt k = start[j] + 1; k < start[j + 1]; ++k) {
      a -= factor[k][0] * x[2 * index[k]] + factor[k][1] * x[2 * index[k] + 1];
      b -= factor[k][2] * x[2 * index[k]] + factor[k][3] * x[2 * index[k] + 1];
    }
    x[2 * j] = a - ldl->inverse[j][1] * b;
    x[2 * j + 1] = b;
  }
}

PetscErrorCode LamLDLSolve(LamLDL ldl, PetscInt count, const PetscReal rhs[], PetscReal solution[])
{
  const PetscInt n = ldl->n;

  PetscFunctionBeginUser;
  if (n % 2) ldl->work[2 * ldl->place[ldl->blocks - 1] + 1] = (Four){0.0};
  for (PetscInt first = 0; first < count; first += LANES) {
    const PetscInt lanes = PetscMin(LANES, count - first);

    for (PetscInt i = 0; i < n; ++i) {
      Four *x = &ldl->work[2 * ldl->place[i / 2] + i % 2];

      *x = (Four){0.0};
      for (PetscInt l = 0; l < lanes; ++l) (*x)[l] = rhs[(first + l) * n + i];
    }
    for (PetscInt h = ldl->positions; h < n && ldl->rho > 0.0; ++h) {
      const Constraint *c = &ldl->constraint[h - ldl->positions];
      const Four b = ldl->work[2 * ldl->place[h / 2] + h % 2];

      for (PetscInt k = 0; k < c->size; ++k)
        ldl->work[2 * ldl->place[c->at[k] / 2] + c->at[k] % 2] += ldl->rho * c->v[k] * b;
    }
    Substitute(ldl, ldl->work);
    for (PetscInt i = 0; i < n; ++i)
      for (PetscInt l = 0; l < lanes; ++l) solution[(first + l) * n + i] = ldl->work[2 * ldl->place[i / 2] + i % 2][l];
  }
  PetscFunctionReturn(0);
}
