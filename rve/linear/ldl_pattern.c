/*
  The pattern of a factor: order, fill, and the list of all that the factorisation will do.
*/
#include "ldl_impl.h"
#include <stdint.h>
#include <petscmat.h>

#define MOST_PRODUCTS 50000000 /* of blocks, whose places take up to 100 MB; with more MUMPS is as fast */
#define LEAST_PER_BLOCK 50 /* products to expect of each block of unknowns: from 70 on one mesh to 1000 on patches */

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
  PetscInt *first, *head, *next, *other, *mark, size = 0, room = 8 * count, rows;

  PetscFunctionBeginUser;
  /* first, next: lists of the neighbours after each block in the order; head, other: of the columns that end in a row
   */
  PetscCall(PetscMalloc5(blocks, &first, count, &next, blocks, &head, blocks, &other, blocks, &mark));
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
    for (PetscInt i = head[j]; i >= 0; i = other[i])
      for (PetscInt k = ldl->start[i] + 1; k < ldl->start[i + 1]; ++k)
        if (mark[ldl->index[k]] != j) {
          mark[ldl->index[k]] = j;
          ldl->index[size++] = ldl->index[k];
        }
    PetscCall(PetscSortInt(size - begin, &ldl->index[begin]));
    ldl->start[j + 1] = size;
    rows = size - begin;
    *products += rows * (rows - 1) / 2;
    if (size > begin + 1) {
      other[j] = head[ldl->index[begin + 1]];
      head[ldl->index[begin + 1]] = j;
    }
  }
  PetscCall(PetscFree5(first, next, head, other, mark));
  PetscFunctionReturn(0);
}

/* Joins columns in pairs where the second has the rows of the first below it. */
static PetscErrorCode FindPanels(LamLDL ldl)
{
  const PetscInt blocks = ldl->blocks, *start = ldl->start;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(blocks + 1, &ldl->panel, blocks + 1, &ldl->first));
  for (PetscInt j = 0; j < blocks; ++ldl->panels) {
    const PetscInt below = start[j + 1] - start[j] - 1;
    /* the rows of a column below its first one are rows of that one, too */
    const PetscBool pair =
        (PetscBool)(below > 0 && ldl->index[start[j] + 1] == j + 1 && start[j + 2] - start[j + 1] == below);

    ldl->panel[ldl->panels] = j;
    j += pair ? 2 : 1;
  }
  ldl->panel[ldl->panels] = blocks;
  PetscFunctionReturn(0);
}

/* The sources that a panel is, one for each panel below in whose columns it has rows. Calls: with source NULL counts
   those of each panel in at [panels]; otherwise at holds where the next one of each panel belongs. */
static void ListSources(LamLDL ldl, PetscInt panel, const PetscInt panel_of[], PetscInt at[], LamSource source[])
{
  const PetscInt column = ldl->panel[panel], width = ldl->panel[panel + 1] - column, last = column + width - 1;
  const PetscInt *rows = &ldl->index[ldl->start[last] + 1], below = ldl->start[last + 1] - ldl->start[last] - 1;

  for (PetscInt k = 0; k < below; ++k) {
    const PetscInt to = panel_of[rows[k]], j = ldl->panel[to];
    const PetscBool both = (PetscBool)(rows[k] == j && k + 1 < below && panel_of[rows[k + 1]] == to);

    if (source)
      source[at[to]] =
          (LamSource){column, width, k, below - k, 0, both ? LAM_TO_BOTH : rows[k] == j ? LAM_TO_FIRST : LAM_TO_SECOND};
    ++at[to];
    if (both) ++k;
  }
}

/* Rows of a source. */
static const PetscInt *RowsOf(LamLDL ldl, const LamSource *source)
{
  return &ldl->index[ldl->start[source->column + source->width - 1] + 1 + source->skip];
}

/* Sets where the places of a source's rows begin; place: of all rows in the column that it changes; before: the source
   of the same columns before it, or NULL. Places that follow each other are part of the list of all numbers, which
   comes first; those of the source before serve again where it has the same rows. Others are listed from *end on. */
static PetscErrorCode Locate(LamLDL ldl, const PetscInt place[], const LamSource *before, LamSource *source,
                             PetscInt *end, PetscInt *room)
{
  const PetscInt *rows = RowsOf(ldl, source), count = source->count, begin = place[rows[0]];
  PetscBool same = PETSC_FALSE;

  PetscFunctionBeginUser;
  source->target = begin;
  if (place[rows[count - 1]] == begin + count - 1) PetscFunctionReturn(0);
  if (before && before->count == count) PetscCall(PetscArraycmp(RowsOf(ldl, before), rows, count, &same));
  source->target = same ? before->target : *end;
  if (same) PetscFunctionReturn(0);
  if (*end + count > *room) {
    *room = 2 * (*end + count);
    PetscCall(PetscRealloc((size_t)*room * sizeof(*ldl->target), &ldl->target));
  }
  for (PetscInt k = 0; k < count; ++k) ldl->target[(*end)++] = (unsigned short)place[rows[k]];
  PetscFunctionReturn(0);
}

/* Lists the sources of all panels, and the places of their rows. */
static PetscErrorCode FindSources(LamLDL ldl)
{
  const PetscInt blocks = ldl->blocks, *start = ldl->start, *index = ldl->index;
  PetscInt *place, *at, *panel_of, end = 0, room;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(blocks, &place, blocks + 1, &at, blocks, &panel_of));
  for (PetscInt p = 0; p < ldl->panels; ++p)
    for (PetscInt j = ldl->panel[p]; j < ldl->panel[p + 1]; ++j) panel_of[j] = p;
  PetscCall(PetscArrayzero(at, ldl->panels));
  for (PetscInt p = 0; p < ldl->panels; ++p) ListSources(ldl, p, panel_of, at, NULL);
  ldl->first[0] = 0;
  for (PetscInt p = 0; p < ldl->panels; ++p) ldl->first[p + 1] = ldl->first[p] + at[p];
  PetscCall(PetscMalloc1(ldl->first[ldl->panels] + 1, &ldl->source));
  PetscCall(PetscArraycpy(at, ldl->first, ldl->panels));
  for (PetscInt p = 0; p < ldl->panels; ++p) ListSources(ldl, p, panel_of, at, ldl->source);
  for (PetscInt j = 0; j < blocks; ++j) end = PetscMax(end, start[j + 1] - start[j]);
  room = 2 * end;
  PetscCall(PetscMalloc1(room, &ldl->target));
  for (PetscInt k = 0; k < end; ++k) ldl->target[k] = (unsigned short)k;
  for (PetscInt p = 0; p < ldl->panels; ++p)
    for (PetscInt s = ldl->first[p]; s < ldl->first[p + 1]; ++s) {
      LamSource *source = &ldl->source[s], *before = s > ldl->first[p] ? source - 1 : NULL;
      const PetscInt j = ldl->panel[p] + (source->to == LAM_TO_SECOND ? 1 : 0);

      if (before && before->to != source->to) before = NULL;
      for (PetscInt k = start[j]; !before && k < start[j + 1]; ++k) place[index[k]] = k - start[j];
      PetscCall(Locate(ldl, place, before, source, &end, &room));
    }
  PetscCall(PetscRealloc((size_t)end * sizeof(*ldl->target), &ldl->target));
  PetscCall(PetscFree3(place, at, panel_of));
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
  LamConstraint *last;

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
        LamConstraint *c = &last[column[k]];

        c->at[c->size] = i;
        c->entry[c->size++] = k;
      }
  for (PetscInt h = positions; h < ldl->n; ++h) {
    LamConstraint *c = &last[h];

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
  PetscInt count, products = 0;
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
  PetscCall(PetscMalloc3(blocks, &ldl->place, row[n], &ldl->to, blocks + 1, &ldl->start));
  PetscCall(FindPairs(n, blocks, row, column, &count, &key));
  PetscCall(OrderPositions(ldl, positions / 2, count, key));
  PetscCall(InsertOthers(ldl, positions / 2, count, key));
  PetscCall(FindFill(ldl, count, key, &products));
  PetscCall(PetscFree(key));
  if (products > MOST_PRODUCTS) {
    PetscCall(LamLDLDestroy(created));
    PetscFunctionReturn(0);
  }
  PetscCall(FindPanels(ldl));
  PetscCall(FindSources(ldl));
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt k = row[i]; k < row[i + 1]; ++k) ldl->to[k] = FindEntry(ldl, i, column[k]);
  PetscCall(FindConstraints(ldl, column));
  PetscCall(PetscMalloc1(ldl->start[blocks] + 3 * blocks + 1, &ldl->memory));
  ldl->factor = (LamFour *)(((uintptr_t)ldl->memory + sizeof(LamFour) - 1) & ~(uintptr_t)(sizeof(LamFour) - 1));
  ldl->inverse = ldl->factor + ldl->start[blocks];
  ldl->work = ldl->inverse + blocks;
  PetscFunctionReturn(0);
}

PetscErrorCode LamLDLDestroy(LamLDL *ldl)
{
  PetscFunctionBeginUser;
  if (!*ldl) PetscFunctionReturn(0);
  for (PetscInt h = 0; (*ldl)->constraint && h < (*ldl)->n - (*ldl)->positions; ++h) {
    LamConstraint *c = &(*ldl)->constraint[h];

    if (!c->shares) PetscCall(PetscFree(c->pairs));
    PetscCall(PetscFree3(c->at, c->entry, c->v));
  }
  PetscCall(PetscFree((*ldl)->constraint));
  PetscCall(PetscFree3((*ldl)->place, (*ldl)->to, (*ldl)->start));
  PetscCall(PetscFree2((*ldl)->panel, (*ldl)->first));
  PetscCall(PetscFree((*ldl)->source));
  PetscCall(PetscFree((*ldl)->index));
  PetscCall(PetscFree((*ldl)->target));
  PetscCall(PetscFree((*ldl)->memory));
  PetscCall(PetscFree(*ldl));
  PetscFunctionReturn(0);
}
