/*
  Method. The unknowns are renumbered once by approximate minimum degree, so that the matrix is stored in elimination
  order; values are copied to the new order before each factorisation. The factorisation fails at a pivot that is not
  positive. If all pivots are positive, pivoting would not improve the accuracy.
*/
#include "cholesky.h"
#include <stdlib.h>
#include <petscmat.h>

#define FILL 8.0 /* estimated ratio of the nonzeros of the factor to those of the matrix */

struct LamCholesky_s {
  PetscInt n, nonzeros;
  PetscReal *values;      /* borrowed */
  PetscInt *place;        /* [n]: new number of an unknown */
  PetscInt *from;         /* [nonzeros]: source index of each entry of the renumbered matrix */
  PetscInt *row, *column; /* renumbered matrix, upper triangle; borrowed by `matrix`, as `entries` is */
  PetscReal *entries;
  Mat matrix, factor;
  Vec rhs, solution;
};

/* Numbers the unknowns by approximate minimum degree. */
static PetscErrorCode Order(LamCholesky c, PetscInt row[], PetscInt column[])
{
  Mat graph;
  IS order, same;
  const PetscInt *old;

  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqSBAIJWithArrays(PETSC_COMM_SELF, 1, c->n, c->n, row, column, c->values, &graph));
  PetscCall(MatSetOption(graph, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatConvert(graph, MATSEQAIJ, MAT_INPLACE_MATRIX, &graph));
  PetscCall(MatGetOrdering(graph, "amd", &order, &same));
  PetscCall(ISGetIndices(order, &old));
  for (PetscInt i = 0; i < c->n; ++i) c->place[old[i]] = i;
  PetscCall(ISRestoreIndices(order, &old));
  PetscCall(ISDestroy(&order));
  PetscCall(ISDestroy(&same));
  PetscCall(MatDestroy(&graph));
  PetscFunctionReturn(0);
}

typedef struct {
  PetscInt row, column, from;
} Entry;

static int CompareEntries(const void *a, const void *b)
{
  const Entry *x = a, *y = b;

  return x->row != y->row ? (x->row > y->row) - (x->row < y->row) : (x->column > y->column) - (x->column < y->column);
}

/* Pattern of the renumbered matrix: rows in order, columns sorted within a row, diagonal first. */
static PetscErrorCode Renumber(LamCholesky c, const PetscInt row[], const PetscInt column[])
{
  Entry *entry;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(c->nonzeros, &entry));
  for (PetscInt i = 0; i < c->n; ++i)
    for (PetscInt k = row[i]; k < row[i + 1]; ++k) {
      const PetscInt a = c->place[i], b = c->place[column[k]];

      entry[k] = (Entry){PetscMin(a, b), PetscMax(a, b), k};
    }
  qsort(entry, (size_t)c->nonzeros, sizeof(*entry), CompareEntries);
  for (PetscInt k = 0; k < c->nonzeros; ++k) {
    ++c->row[entry[k].row + 1];
    c->column[k] = entry[k].column;
    c->from[k] = entry[k].from;
  }
  for (PetscInt i = 0; i < c->n; ++i) c->row[i + 1] += c->row[i];
  PetscCall(PetscFree(entry));
  PetscFunctionReturn(0);
}

static PetscErrorCode Analyse(LamCholesky c)
{
  MatFactorInfo info;
  IS order;

  PetscFunctionBeginUser;
  PetscCall(MatCreateSeqSBAIJWithArrays(PETSC_COMM_SELF, 1, c->n, c->n, c->row, c->column, c->entries, &c->matrix));
  PetscCall(MatSetOption(c->matrix, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatFactorInfoInitialize(&info));
  info.fill = FILL;
  PetscCall(ISCreateStride(PETSC_COMM_SELF, c->n, 0, 1, &order));
  PetscCall(ISSetPermutation(order));
  PetscCall(ISSetIdentity(order));
  PetscCall(MatGetFactor(c->matrix, MATSOLVERPETSC, MAT_FACTOR_CHOLESKY, &c->factor));
  PetscCall(MatCholeskyFactorSymbolic(c->factor, c->matrix, order, &info));
  PetscCall(ISDestroy(&order));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, c->n, &c->rhs));
  PetscCall(VecDuplicate(c->rhs, &c->solution));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCholeskyCreate(PetscInt n, PetscInt row[], PetscInt column[], PetscReal values[],
                                 LamCholesky *cholesky)
{
  LamCholesky c;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  c->n = n;
  c->nonzeros = row[n];
  c->values = values;
  PetscCall(PetscCalloc5(n, &c->place, c->nonzeros, &c->from, n + 1, &c->row, c->nonzeros, &c->column, c->nonzeros,
                         &c->entries));
  PetscCall(Order(c, row, column));
  PetscCall(Renumber(c, row, column));
  PetscCall(Analyse(c));
  *cholesky = c;
  PetscFunctionReturn(0);
}

PetscErrorCode LamCholeskyNumeric(LamCholesky c, PetscBool *definite)
{
  MatFactorInfo info;
  MatFactorError error;
  PetscScalar *entries; /* c->entries, accessed through PETSc so that the change is registered */
  PetscInt negative = 1;

  PetscFunctionBeginUser;
  PetscCall(MatSeqSBAIJGetArray(c->matrix, &entries));
  for (PetscInt k = 0; k < c->nonzeros; ++k) entries[k] = c->values[c->from[k]];
  PetscCall(MatSeqSBAIJRestoreArray(c->matrix, &entries));
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatFactorClearError(c->factor));
  PetscCall(MatCholeskyFactorNumeric(c->factor, c->matrix, &info));
  PetscCall(MatFactorGetError(c->factor, &error));
  if (error == MAT_FACTOR_NOERROR) PetscCall(MatGetInertia(c->factor, &negative, NULL, NULL));
  *definite = (PetscBool)(negative == 0);
  PetscFunctionReturn(0);
}

PetscErrorCode LamCholeskySolve(LamCholesky c, PetscInt count, const PetscReal rhs[], PetscReal solution[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < count; ++k) {
    const PetscReal *b = rhs + k * c->n;
    PetscReal *x = solution + k * c->n;
    PetscScalar *to;
    const PetscScalar *found;

    PetscCall(VecGetArrayWrite(c->rhs, &to));
    for (PetscInt i = 0; i < c->n; ++i) to[c->place[i]] = b[i];
    PetscCall(VecRestoreArrayWrite(c->rhs, &to));
    PetscCall(MatSolve(c->factor, c->rhs, c->solution));
    PetscCall(VecGetArrayRead(c->solution, &found));
    for (PetscInt i = 0; i < c->n; ++i) x[i] = found[c->place[i]];
    PetscCall(VecRestoreArrayRead(c->solution, &found));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamCholeskyDestroy(LamCholesky *cholesky)
{
  LamCholesky c = *cholesky;

  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(0);
  PetscCall(MatDestroy(&c->factor));
  PetscCall(MatDestroy(&c->matrix));
  PetscCall(VecDestroy(&c->rhs));
  PetscCall(VecDestroy(&c->solution));
  PetscCall(PetscFree5(c->place, c->from, c->row, c->column, c->entries));
  PetscCall(PetscFree(c));
  *cholesky = NULL;
  PetscFunctionReturn(0);
}
