/*
  The linear systems of the RVE: one sparsity pattern for life, values written in place, MUMPS LDL^T through PETSc,
  which pivots safely on indefinite matrices and counts negative eigenvalues (Sylvester's law of inertia).
*/
#include "rve_impl.h"

static int CompareKeys(const void *a, const void *b)
{
  const PetscInt64 x = *(const PetscInt64 *)a, y = *(const PetscInt64 *)b;

  return x < y ? -1 : x > y;
}

/* Sorted unique keys row * n + column, row <= column, of coupled classes (class 0, held, left out). */
static PetscErrorCode CollectBlocks(const LamMesh *mesh, PetscInt *count, PetscInt64 **blocks)
{
  const PetscInt classes = mesh->class_count;
  PetscInt n = 0, unique = 0;
  PetscInt64 *keys;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->element_count * 45, &keys));
  for (PetscInt e = 0; e < mesh->element_count; ++e)
    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
      for (PetscInt b = a; b < LAM_ELEMENT_NODES; ++b) {
        const PetscInt ca = mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + a]];
        const PetscInt cb = mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + b]];

        if (ca > 0 && cb > 0) keys[n++] = (PetscInt64)PetscMin(ca, cb) * classes + PetscMax(ca, cb);
      }
  qsort(keys, (size_t)n, sizeof(*keys), CompareKeys);
  for (PetscInt i = 0; i < n; ++i)
    if (i == 0 || keys[i] != keys[i - 1]) keys[unique++] = keys[i];
  *count = unique;
  *blocks = keys;
  PetscFunctionReturn(0);
}

/* Rows of unknowns from rows of 2 x 2 class blocks; within a row the diagonal block comes first. */
static PetscErrorCode FillRows(const LamMesh *mesh, PetscInt count, const PetscInt64 blocks[], LamLinear *linear)
{
  PetscInt at = 0, block = 0;

  PetscFunctionBeginUser;
  for (PetscInt c = 1; c < mesh->class_count; ++c) {
    PetscInt end = block;

    while (end < count && blocks[end] / mesh->class_count == c) ++end;
    for (PetscInt d = 0; d < 2; ++d) {
      linear->row[2 * (c - 1) + d] = at;
      for (PetscInt b = block; b < end; ++b) {
        const PetscInt column = 2 * ((PetscInt)(blocks[b] % mesh->class_count) - 1);

        if (b > block || d == 0) linear->column[at++] = column;
        linear->column[at++] = column + 1;
      }
    }
    block = end;
  }
  linear->row[linear->n] = at;
  PetscCheck(at == linear->nonzeros, PETSC_COMM_SELF, PETSC_ERR_PLIB, "sparsity pattern has %d entries, expected %d",
             (int)at, (int)linear->nonzeros);
  PetscFunctionReturn(0);
}

static PetscInt FindEntry(const LamLinear *linear, PetscInt i, PetscInt j)
{
  const PetscInt row = PetscMin(i, j), column = PetscMax(i, j);
  PetscInt low = linear->row[row], high = linear->row[row + 1];

  while (high - low > 1) {
    const PetscInt middle = (low + high) / 2;

    if (linear->column[middle] <= column)
      low = middle;
    else
      high = middle;
  }
  return low;
}

PetscErrorCode LamLinearCreate(const LamMesh *mesh, LamLinear *linear)
{
  PetscInt count = 0;
  PetscInt64 *blocks = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(linear, sizeof(*linear)));
  PetscCall(CollectBlocks(mesh, &count, &blocks));
  linear->n = 2 * (mesh->class_count - 1);
  linear->nonzeros = 4 * count - (mesh->class_count - 1); /* diagonal blocks keep three of four entries */
  PetscCall(PetscMalloc1(linear->n + 1, &linear->row));
  PetscCall(PetscMalloc1(linear->nonzeros, &linear->column));
  PetscCall(PetscCalloc1(linear->nonzeros, &linear->values));
  PetscCall(FillRows(mesh, count, blocks, linear));
  PetscCall(PetscFree(blocks));
  PetscCall(PetscMalloc1(LAM_PAIRS * mesh->element_count, &linear->position));
  for (PetscInt e = 0; e < mesh->element_count; ++e)
    for (PetscInt i = 0, pair = 0; i < LAM_ELEMENT_DOFS; ++i)
      for (PetscInt j = i; j < LAM_ELEMENT_DOFS; ++j, ++pair) {
        const PetscInt ci = mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + i / 2]];
        const PetscInt cj = mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + j / 2]];

        linear->position[LAM_PAIRS * e + pair] =
            ci == 0 || cj == 0 ? -1 : FindEntry(linear, 2 * (ci - 1) + i % 2, 2 * (cj - 1) + j % 2);
      }
  PetscFunctionReturn(0);
}

PetscErrorCode LamLinearCreateMatrix(LamLinear *linear)
{
  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqSBAIJWithArrays(PETSC_COMM_SELF, 1, linear->n, linear->n, linear->row, linear->column,
                                        linear->values, &linear->matrix));
  PetscCall(MatSetOption(linear->matrix, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, linear->n, NULL, &linear->rhs));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, linear->n, NULL, &linear->solution));
  PetscFunctionReturn(0);
}

PetscErrorCode LamLinearDestroy(LamLinear *linear)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&linear->factor));
  PetscCall(MatDestroy(&linear->matrix));
  PetscCall(VecDestroy(&linear->rhs));
  PetscCall(VecDestroy(&linear->solution));
  PetscCall(PetscFree(linear->row));
  PetscCall(PetscFree(linear->column));
  PetscCall(PetscFree(linear->values));
  PetscCall(PetscFree(linear->position));
  PetscFunctionReturn(0);
}

static PetscErrorCode Analyse(LamLinear *linear)
{
  MatFactorInfo info;

  PetscFunctionBeginUser;
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatGetFactor(linear->matrix, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &linear->factor));
  PetscCall(MatMumpsSetIcntl(linear->factor, 14, 50)); /* workspace margin, per cent */
  PetscCall(MatMumpsSetIcntl(linear->factor, 10, 0));  /* no iterative refinement: Newton refines */
  PetscCall(MatMumpsSetIcntl(linear->factor, 8, 0)); /* no scaling: the unknowns are alike; saves a fifth of the time */
  PetscCall(
      MatMumpsSetIcntl(linear->factor, 7, 4)); /* PORD: the fastest factor of those tried from 600 to 6000 unknowns */
  PetscCall(MatCholeskyFactorSymbolic(linear->factor, linear->matrix, NULL, &info));
  linear->analysed = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode LamLinearFactor(LamLinear *linear, PetscReal shift, PetscInt *negative, PetscBool *ok)
{
  MatFactorInfo info;
  MatFactorError error;
  PetscScalar *values; /* = linear->values; taken through PETSc so that it knows of the change */

  PetscFunctionBeginUser;
  PetscCall(MatSeqSBAIJGetArray(linear->matrix, &values));
  if (shift != 0.0)
    for (PetscInt i = 0; i < linear->n; ++i) values[linear->row[i]] += shift;
  PetscCall(MatSeqSBAIJRestoreArray(linear->matrix, &values));
  if (!linear->analysed) PetscCall(Analyse(linear));
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatCholeskyFactorNumeric(linear->factor, linear->matrix, &info));
  PetscCall(MatFactorGetError(linear->factor, &error));
  *ok = (PetscBool)(error == MAT_FACTOR_NOERROR);
  *negative = 0;
  if (*ok) PetscCall(MatGetInertia(linear->factor, negative, NULL, NULL));
  if (shift != 0.0)
    for (PetscInt i = 0; i < linear->n; ++i) linear->values[linear->row[i]] -= shift;
  PetscFunctionReturn(0);
}

PetscErrorCode LamLinearSolve(LamLinear *linear, PetscInt count, const PetscReal rhs[], PetscReal solution[])
{
  PetscFunctionBeginUser;
  if (count == 1) {
    PetscCall(VecPlaceArray(linear->rhs, rhs));
    PetscCall(VecPlaceArray(linear->solution, solution));
    PetscCall(MatSolve(linear->factor, linear->rhs, linear->solution));
    PetscCall(VecResetArray(linear->rhs));
    PetscCall(VecResetArray(linear->solution));
  } else {
    Mat B, X;

    PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, linear->n, count, (PetscScalar *)rhs, &B));
    PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, linear->n, count, solution, &X));
    PetscCall(MatMatSolve(linear->factor, B, X));
    PetscCall(MatDestroy(&B));
    PetscCall(MatDestroy(&X));
  }
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
