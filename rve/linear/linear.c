/*
  The linear systems of the RVE: one fixed sparsity pattern; values are written in place. factor.c factors the matrix.
*/
#include "linear.h"

/*
  Coupled pairs of groups of unknowns, sorted keys a * groups + b with a <= b. Groups are the classes, with two
  positions each, the couplings, with their multipliers, and the lumens, with one pressure. Class 0 is prescribed: no
  keys.
*/
typedef struct {
  PetscInt classes, couplings, groups, count;
  PetscInt64 *key;
} Pairs;

static void AddCoupled(PetscInt a, PetscInt b, Pairs *pairs)
{
  if (a > 0 && b > 0) pairs->key[pairs->count++] = (PetscInt64)PetscMin(a, b) * pairs->groups + PetscMax(a, b);
}

/* Adds all pairs of a set of classes. */
static void AddClique(PetscInt size, const PetscInt members[], Pairs *pairs)
{
  for (PetscInt a = 0; a < size; ++a)
    for (PetscInt b = a; b < size; ++b) AddCoupled(members[a], members[b], pairs);
}

static PetscErrorCode FindPairs(const LamMesh *mesh, const LamCouplings *couplings, PetscInt lumens, Pairs *pairs)
{
  const PetscInt size = couplings->size, inner = LamMeshFirstRing(mesh, mesh->cell_count); /* nodes at lumens */
  PetscInt unique = 0;

  PetscFunctionBeginUser;
  pairs->classes = mesh->class_count;
  pairs->couplings = couplings->count;
  pairs->groups = pairs->classes + pairs->couplings + lumens;
  PetscCall(PetscMalloc1(mesh->element_count * 45 + couplings->count * (size + 1) * (size + 2) / 2 + inner + lumens +
                             couplings->pair_count,
                         &pairs->key));
  for (PetscInt e = 0; e < mesh->element_count; ++e) {
    PetscInt members[LAM_ELEMENT_NODES];

    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
      members[a] = mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + a]];
    AddClique(LAM_ELEMENT_NODES, members, pairs);
  }
  for (PetscInt g = 0; g < couplings->count; ++g) {
    AddClique(size, &couplings->classes[g * size], pairs);
    for (PetscInt i = 0; i < size; ++i) AddCoupled(couplings->classes[g * size + i], pairs->classes + g, pairs);
  }
  for (PetscInt k = 0; k < couplings->pair_count; ++k)
    AddCoupled(couplings->pairs[k][0], couplings->pairs[k][1], pairs);
  for (PetscInt i = 0; i < inner && lumens; ++i)
    AddCoupled(mesh->node_class[i * mesh->radial_nodes], pairs->groups - lumens + LamMeshCellOfRing(mesh, i), pairs);
  for (PetscInt g = pairs->classes; g < pairs->groups; ++g) AddCoupled(g, g, pairs);
  PetscCall(PetscSortInt64(pairs->count, pairs->key));
  for (PetscInt k = 0; k < pairs->count; ++k)
    if (k == 0 || pairs->key[k] != pairs->key[k - 1]) pairs->key[unique++] = pairs->key[k];
  pairs->count = unique;
  PetscFunctionReturn(0);
}

/* First unknown of a group, and their number. */
static PetscInt FirstUnknown(const LamLinear *linear, const Pairs *pairs, PetscInt group, PetscInt *size)
{
  const PetscInt coupling = group - pairs->classes, lumen = coupling - pairs->couplings;

  *size = 2;
  if (coupling < 0) return LamUnknown(group, 0);
  *size = lumen < 0 ? (linear->pressures - linear->positions) / pairs->couplings : 1;
  return lumen < 0 ? linear->positions + coupling * *size : linear->pressures + lumen;
}

/* Fills the rows, the diagonal first. The multipliers and pressures of a group are not coupled with each other. Returns
   the number of entries; only counts if linear->row is NULL. */
static PetscInt FillRows(const Pairs *pairs, LamLinear *linear)
{
  PetscInt at = 0;

  for (PetscInt k = 0, end; k < pairs->count; k = end) {
    const PetscInt group = (PetscInt)(pairs->key[k] / pairs->groups);
    PetscInt size;
    const PetscInt first = FirstUnknown(linear, pairs, group, &size);

    for (end = k; end < pairs->count && pairs->key[end] / pairs->groups == group;) ++end;
    for (PetscInt d = 0; d < size; ++d) {
      if (linear->row) linear->row[first + d] = at;
      for (PetscInt p = k; p < end; ++p) {
        PetscInt width;
        const PetscInt column = FirstUnknown(linear, pairs, (PetscInt)(pairs->key[p] % pairs->groups), &width);

        if (p == k && group >= pairs->classes) width = d + 1;
        for (PetscInt i = p == k ? d : 0; i < width; ++i, ++at)
          if (linear->row) linear->column[at] = column + i;
      }
    }
  }
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

PetscInt LamLinearBlock(const LamLinear *linear, PetscInt a, PetscInt b)
{
  const PetscInt i = LamUnknown(a, 0), j = LamUnknown(b, 0), entry = LamLinearEntry(linear, i, j);

  return entry >= 0 && linear->column[entry] == PetscMax(i, j) ? entry : -1;
}

/* Indices of the values of an element. */
static void Locate(const LamMesh *mesh, const LamLinear *linear, PetscInt e, PetscInt position[LAM_PAIRS])
{
  PetscInt all[LAM_ELEMENT_DOFS][LAM_ELEMENT_DOFS], pair = 0;

  for (PetscInt i = 0; i < LAM_ELEMENT_NODES; ++i)
    for (PetscInt j = i; j < LAM_ELEMENT_NODES; ++j) {
      const PetscInt *nodes = &mesh->elements[LAM_ELEMENT_NODES * e];
      const PetscInt a = mesh->node_class[nodes[i]], b = mesh->node_class[nodes[j]];
      PetscInt entry[2][2];

      LamLinearEntries(linear, a, b, LamLinearBlock(linear, a, b), entry);
      for (PetscInt d = 0; d < 2; ++d)
        for (PetscInt f = 0; f < 2; ++f) all[2 * i + d][2 * j + f] = entry[d][f];
    }
  for (PetscInt i = 0; i < LAM_ELEMENT_DOFS; ++i)
    for (PetscInt j = i; j < LAM_ELEMENT_DOFS; ++j) position[pair++] = all[i][j];
}

PetscErrorCode LamLinearCreate(const LamMesh *mesh, const LamCouplings *couplings, PetscInt lumens, LamLinear *linear)
{
  static const LamCouplings none = {0};
  Pairs pairs = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(linear, sizeof(*linear)));
  if (!couplings) couplings = &none;
  linear->positions = 2 * (mesh->class_count - 1);
  linear->pressures = linear->positions + couplings->count * couplings->multipliers;
  linear->lumens = lumens;
  linear->n = linear->pressures + lumens;
  PetscCall(FindPairs(mesh, couplings, lumens, &pairs));
  linear->nonzeros = FillRows(&pairs, linear);
  PetscCall(PetscMalloc1(linear->nonzeros, &linear->column));
  PetscCall(PetscCalloc1(linear->nonzeros, &linear->values));
  PetscCall(PetscMalloc1(linear->n + 1, &linear->row));
  (void)FillRows(&pairs, linear);
  PetscCall(PetscFree(pairs.key));
  PetscCall(PetscMalloc1(LAM_PAIRS * mesh->element_count, &linear->position));
  for (PetscInt e = 0; e < mesh->element_count; ++e) Locate(mesh, linear, e, &linear->position[LAM_PAIRS * e]);
  PetscFunctionReturn(0);
}

PetscErrorCode LamLinearCreateMatrix(MPI_Comm comm, LamLinear *linear)
{
  PetscFunctionBeginUser;
  PetscCall(LamFactorCreate(comm, linear->n, linear->row, linear->column, linear->values, linear->positions,
                            &linear->factor));
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

static void Shift(LamLinear *linear, PetscReal shift)
{
  for (PetscInt i = 0; i < linear->positions && shift != 0.0; ++i) linear->values[linear->row[i]] += shift;
}

PetscErrorCode LamLinearFactor(LamLinear *linear, PetscReal shift, PetscInt *negative, PetscBool *ok)
{
  PetscFunctionBeginUser;
  Shift(linear, shift);
  PetscCall(LamFactorNumeric(linear->factor, negative, ok));
  Shift(linear, -shift);
  PetscFunctionReturn(0);
}

PetscErrorCode LamLinearFactorExpected(LamLinear *linear, PetscReal shift, PetscInt expected, PetscBool *ok)
{
  PetscFunctionBeginUser;
  Shift(linear, shift);
  PetscCall(LamFactorExpected(linear->factor, expected, ok));
  Shift(linear, -shift);
  PetscFunctionReturn(0);
}

PetscErrorCode LamLinearSolve(LamLinear *linear, PetscInt count, const PetscReal rhs[], PetscReal solution[])
{
  PetscFunctionBeginUser;
  PetscCall(LamFactorSolve(linear->factor, count, rhs, solution));
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
