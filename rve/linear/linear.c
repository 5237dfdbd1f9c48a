/*
  The linear systems of the RVE: one fixed sparsity pattern; values are written in place. factor.c factors the matrix.
*/
#include "linear.h"

#define RESTS 1e-9      /* largest residual of a solve with a nearby factor, over the largest right-hand side entry */
#define LEFT_OUT 1e-10  /* largest rest.K^-1 rest, in C1 + C2: an error of the tangent */
#define LEAST_FALL 1e-3 /* lower bound of the assumed reduction of that work per refinement */
#define POOR 0.1        /* largest residual reduction of a useful refinement; above it the matrix is factored again */

static int CompareKeys(const void *a, const void *b)
{
  const PetscInt64 x = *(const PetscInt64 *)a, y = *(const PetscInt64 *)b;

  return x < y ? -1 : x > y;
}

/* Sorts keys and keeps one of each. */
static PetscInt SortUnique(PetscInt n, PetscInt64 keys[])
{
  PetscInt unique = 0;

  if (n == 0) return 0;
  qsort(keys, (size_t)n, sizeof(*keys), CompareKeys);
  for (PetscInt i = 0; i < n; ++i)
    if (i == 0 || keys[i] != keys[i - 1]) keys[unique++] = keys[i];
  return unique;
}

/* Appends the keys row * classes + column, row <= column, of all pairs of a set of classes. Class 0 is prescribed: no
   keys. */
static void AddClique(PetscInt classes, PetscInt size, const PetscInt members[], PetscInt *n, PetscInt64 keys[])
{
  for (PetscInt a = 0; a < size; ++a)
    for (PetscInt b = a; b < size; ++b) {
      const PetscInt ca = members[a], cb = members[b];

      if (ca > 0 && cb > 0) keys[(*n)++] = (PetscInt64)PetscMin(ca, cb) * classes + PetscMax(ca, cb);
    }
}

/* Sorted unique keys of coupled classes, from elements and from couplings. */
static PetscErrorCode CollectBlocks(const LamMesh *mesh, const LamCouplings *couplings, PetscInt *count,
                                    PetscInt64 **blocks)
{
  const PetscInt size = couplings->size;
  PetscInt n = 0, unique = 0;
  PetscInt64 *keys;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->element_count * 45 + couplings->count * size * (size + 1) / 2, &keys));
  for (PetscInt e = 0; e < mesh->element_count; ++e) {
    PetscInt members[LAM_ELEMENT_NODES];

    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
      members[a] = mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + a]];
    AddClique(mesh->class_count, LAM_ELEMENT_NODES, members, &n, keys);
  }
  unique = SortUnique(n, keys);
  n = unique;
  for (PetscInt g = 0; g < couplings->count; ++g)
    AddClique(mesh->class_count, size, &couplings->classes[g * size], &n, keys);
  *count = n > unique ? SortUnique(n, keys) : unique;
  *blocks = keys;
  PetscFunctionReturn(0);
}

/* Sorted unique keys class * couplings + coupling of the members of couplings. */
static PetscErrorCode CollectMembers(const LamCouplings *couplings, PetscInt *count, PetscInt64 **members)
{
  const PetscInt n = couplings->count * couplings->size;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, members));
  for (PetscInt i = 0; i < n; ++i)
    (*members)[i] = (PetscInt64)couplings->classes[i] * couplings->count + i / couplings->size;
  *count = SortUnique(n, *members);
  PetscFunctionReturn(0);
}

/*
  Fills the rows: 2 x 2 class blocks, the diagonal block first, then the multipliers of the couplings of the class,
  then the pressure of the lumen that the class bounds. Rows of multipliers and pressures hold only their diagonal.
  Returns the number of entries; only counts if linear->row is NULL.
*/
static PetscInt FillRows(const LamMesh *mesh, const LamCouplings *couplings, PetscInt count, const PetscInt64 blocks[],
                         PetscInt member_count, const PetscInt64 members[], const PetscInt lumen_of[],
                         LamLinear *linear)
{
  PetscInt at = 0, block = 0, member = 0;

  for (PetscInt c = 1; c < mesh->class_count; ++c) {
    PetscInt end = block, member_end;

    while (end < count && blocks[end] / mesh->class_count == c) ++end;
    while (member < member_count && members[member] / couplings->count < c) ++member;
    for (member_end = member; member_end < member_count && members[member_end] / couplings->count == c;) ++member_end;
    for (PetscInt d = 0; d < 2; ++d) {
      if (linear->row) linear->row[2 * (c - 1) + d] = at;
      for (PetscInt b = block; b < end; ++b) {
        const PetscInt column = 2 * ((PetscInt)(blocks[b] % mesh->class_count) - 1);

        for (PetscInt k = b > block || d == 0 ? 0 : 1; k < 2; ++k, ++at)
          if (linear->row) linear->column[at] = column + k;
      }
      for (PetscInt g = member; g < member_end; ++g)
        for (PetscInt k = 0; k < couplings->multipliers; ++k, ++at)
          if (linear->row)
            linear->column[at] =
                linear->positions + (PetscInt)(members[g] % couplings->count) * couplings->multipliers + k;
      if (lumen_of && lumen_of[c] >= 0) {
        if (linear->row) linear->column[at] = linear->n - linear->lumens + lumen_of[c];
        ++at;
      }
    }
    block = end;
  }
  for (PetscInt i = linear->positions; i < linear->n; ++i, ++at)
    if (linear->row) linear->row[i] = at, linear->column[at] = i;
  if (linear->row) linear->row[linear->n] = at;
  return at;
}

PetscInt LamLinearEntry(const LamLinear *linear, PetscInt i, PetscInt j)
{
  const PetscInt row = PetscMin(i, j), column = PetscMax(i, j);
  PetscInt low, high;

  if (row < 0) return -1;
  low = linear->row[row];
  high = linear->row[row + 1];
  while (high - low > 1) {
    const PetscInt middle = (low + high) / 2;

    if (linear->column[middle] <= column)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* The cell whose lumen a class bounds, -1: none. */
static PetscErrorCode FindLumens(const LamMesh *mesh, PetscInt **lumen_of)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->class_count, lumen_of));
  for (PetscInt c = 0; c < mesh->class_count; ++c) (*lumen_of)[c] = -1;
  for (PetscInt i = 0; i < mesh->cell_count * mesh->ring_nodes; ++i)
    (*lumen_of)[mesh->node_class[i * mesh->radial_nodes]] = i / mesh->ring_nodes;
  PetscFunctionReturn(0);
}

PetscErrorCode LamLinearCreate(const LamMesh *mesh, const LamCouplings *couplings, PetscInt lumens, LamLinear *linear)
{
  static const LamCouplings none = {0};
  PetscInt count = 0, member_count = 0, *lumen_of = NULL;
  PetscInt64 *blocks = NULL, *members = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(linear, sizeof(*linear)));
  if (!couplings) couplings = &none;
  PetscCall(CollectBlocks(mesh, couplings, &count, &blocks));
  PetscCall(CollectMembers(couplings, &member_count, &members));
  linear->rate = PETSC_INFINITY;
  linear->positions = 2 * (mesh->class_count - 1);
  linear->lumens = lumens;
  linear->n = linear->positions + couplings->count * couplings->multipliers + lumens;
  if (lumens) PetscCall(FindLumens(mesh, &lumen_of));
  linear->nonzeros = FillRows(mesh, couplings, count, blocks, member_count, members, lumen_of, linear);
  PetscCall(PetscMalloc1(linear->nonzeros, &linear->column));
  PetscCall(PetscCalloc1(linear->nonzeros, &linear->values));
  PetscCall(PetscMalloc1(linear->n + 1, &linear->row));
  (void)FillRows(mesh, couplings, count, blocks, member_count, members, lumen_of, linear);
  PetscCall(PetscFree(lumen_of));
  PetscCall(PetscFree(blocks));
  PetscCall(PetscFree(members));
  PetscCall(PetscMalloc1(LAM_PAIRS * mesh->element_count, &linear->position));
  for (PetscInt e = 0; e < mesh->element_count; ++e)
    for (PetscInt i = 0, pair = 0; i < LAM_ELEMENT_DOFS; ++i)
      for (PetscInt j = i; j < LAM_ELEMENT_DOFS; ++j, ++pair) {
        const PetscInt ci = mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + i / 2]];
        const PetscInt cj = mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + j / 2]];

        linear->position[LAM_PAIRS * e + pair] =
            ci == 0 || cj == 0 ? -1 : LamLinearEntry(linear, 2 * (ci - 1) + i % 2, 2 * (cj - 1) + j % 2);
      }
  PetscFunctionReturn(0);
}

PetscErrorCode LamLinearCreateMatrix(MPI_Comm comm, LamLinear *linear)
{
  PetscFunctionBeginUser;
  PetscCall(LamFactorCreate(comm, linear->n, linear->row, linear->column, linear->values,
                            (PetscBool)(linear->positions == linear->n), &linear->factor));
  PetscFunctionReturn(0);
}

PetscErrorCode LamLinearDestroy(LamLinear *linear)
{
  PetscFunctionBeginUser;
  PetscCall(LamFactorDestroy(&linear->factor));
  PetscCall(PetscFree(linear->row));
  PetscCall(PetscFree(linear->column));
  PetscCall(PetscFree(linear->values));
  PetscCall(PetscFree(linear->position));
  PetscFunctionReturn(0);
}

PetscErrorCode LamLinearFactor(LamLinear *linear, PetscReal shift, PetscInt *negative, PetscBool *ok)
{
  PetscFunctionBeginUser;
  linear->nearby = PETSC_FALSE;
  linear->rate = PETSC_INFINITY;
  for (PetscInt i = 0; i < linear->positions && shift != 0.0; ++i) linear->values[linear->row[i]] += shift;
  PetscCall(LamFactorNumeric(linear->factor, negative, ok));
  linear->negative = *negative;
  for (PetscInt i = 0; i < linear->positions && shift != 0.0; ++i) linear->values[linear->row[i]] -= shift;
  PetscFunctionReturn(0);
}

PetscErrorCode LamLinearSolveOnce(LamLinear *linear, PetscInt count, const PetscReal rhs[], PetscReal solution[])
{
  PetscFunctionBeginUser;
  PetscCall(LamFactorSolve(linear->factor, count, rhs, solution));
  PetscFunctionReturn(0);
}

/* rest := b - K x. */
static void FindRest(const LamLinear *linear, PetscInt count, const PetscReal rhs[], const PetscReal solution[],
                     PetscReal rest[])
{
  for (PetscInt k = 0; k < count; ++k) LamLinearMultiply(linear, solution + k * linear->n, rest + k * linear->n);
  for (PetscInt i = 0; i < count * linear->n; ++i) rest[i] = rhs[i] - rest[i];
}

/* Largest of rest.change of the right-hand sides. */
static PetscReal LargestWork(PetscInt count, PetscInt n, const PetscReal rest[], const PetscReal change[])
{
  PetscReal largest = 0.0;

  for (PetscInt k = 0; k < count; ++k)
    largest = PetscMax(largest, PetscAbsReal(LamInnerProduct(n, rest + k * n, change + k * n)));
  return largest;
}

/* A residual that is small relative to stiff forces may still move soft walls, so its work is limited, too. The work is
   known for the previous residual. The present one is estimated by the last reduction factor, but not below LEAST_FALL,
   since the work in soft modes decreases more slowly. */
PetscErrorCode LamLinearSolve(LamLinear *linear, PetscInt count, const PetscReal rhs[], PetscReal solution[],
                              PetscReal rest[])
{
  const PetscInt length = count * linear->n;
  const PetscReal enough = RESTS * LamLargestEntry(length, rhs);
  PetscReal *change, before = PETSC_INFINITY, left, work = PETSC_INFINITY, fall = 1.0;
  PetscBool ok = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(LamLinearSolveOnce(linear, count, rhs, solution));
  PetscCall(PetscArrayzero(rest, length));
  if (!linear->nearby) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(length, &change));
  for (;;) {
    FindRest(linear, count, rhs, solution, rest);
    left = LamLargestEntry(length, rest);
    if ((left <= enough && work * fall <= LEFT_OUT) || !(left <= POOR * before)) break;
    before = left;
    PetscCall(LamLinearSolveOnce(linear, count, rest, change));
    fall = 1.0 / work;
    work = LargestWork(count, linear->n, rest, change);
    fall = fall > 0.0 ? PetscMax(LEAST_FALL, PetscMin(1.0, fall * work)) : 1.0;
    for (PetscInt i = 0; i < length; ++i) solution[i] += change[i];
  }
  PetscCall(PetscFree(change));
  if (left <= enough && work * fall <= LEFT_OUT) PetscFunctionReturn(0);
  PetscCall(LamLinearFactor(linear, 0.0, &linear->negative, &ok));
  PetscCheck(ok, PETSC_COMM_SELF, PETSC_ERR_MAT_LU_ZRPVT, "the tangent of a converged state is singular");
  PetscCall(LamLinearSolveOnce(linear, count, rhs, solution));
  PetscCall(PetscArrayzero(rest, length));
  PetscFunctionReturn(0);
}

void LamLinearMultiply(const LamLinear *linear, const PetscReal x[], PetscReal y[])
{
  for (PetscInt i = 0; i < linear->n; ++i) y[i] = 0.0;
  for (PetscInt i = 0; i < linear->n; ++i)
    for (PetscInt k = linear->row[i]; k < linear->row[i + 1]; ++k) {
      const PetscInt j = linear->column[k];

      y[i] += linear->values[k] * x[j];
      if (j != i) y[j] += linear->values[k] * x[i];
    }
}
