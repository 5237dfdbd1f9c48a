/*
  The linear systems of the RVE: sparsity pattern, factorisation, inertia, solves.
*/
#ifndef LAM_RVE_LINEAR_H
#define LAM_RVE_LINEAR_H

#include "element.h"
#include "factor.h"

#define LAM_PAIRS (LAM_ELEMENT_DOFS * (LAM_ELEMENT_DOFS + 1) / 2)

/* Couplings of classes beyond elements: `count` sets of `size` classes; each set has `multipliers` unknowns of its own.
   Also single pairs of classes. */
typedef struct {
  PetscInt count, size, multipliers;
  const PetscInt *classes; /* [count][size] */
  PetscInt pair_count;
  const PetscInt (*pairs)[2]; /* [pair_count] */
} LamCouplings;

/*
  The symmetric matrix in upper compressed rows (values are written in place) and its factor. Order of the unknowns:
  positions, multipliers of the couplings set by set, pressures of the lumens that can be sealed.
*/
typedef struct {
  PetscInt n, nonzeros;
  PetscInt positions;     /* unknowns that are positions */
  PetscInt pressures;     /* the first unknown that is a pressure */
  PetscInt lumens;        /* unknowns that are pressures */
  PetscInt *row, *column; /* [n+1], [nonzeros]; the diagonal comes first in a row */
  PetscReal *values;      /* [nonzeros] */
  PetscInt *position;     /* [element][LAM_PAIRS] index into values, -1: prescribed; element dofs i <= j, row by row */
  LamFactor factor;       /* owned */
} LamLinear;

/* couplings: NULL for none; lumens: number of cells, or 0 if they cannot be sealed. */
PetscErrorCode LamLinearCreate(const LamMesh *mesh, const LamCouplings *couplings, PetscInt lumens, LamLinear *linear);
/* Index into values of the entry of unknowns i and j, which must be coupled; -1 if one of them is negative. */
PetscInt LamLinearEntry(const LamLinear *linear, PetscInt i, PetscInt j);
/* Index of the first entry of two classes; -1 if they are not coupled, or one is prescribed. */
PetscInt LamLinearBlock(const LamLinear *linear, PetscInt a, PetscInt b);
/* From it, the indices of component d of a with e of b; -1 if it is -1. */
static inline void LamLinearEntries(const LamLinear *linear, PetscInt a, PetscInt b, PetscInt first,
                                    PetscInt entry[2][2])
{
  const PetscInt row = LamUnknown(PetscMin(a, b), 0);
  /* both rows of a class have the same columns but for the diagonal */
  const PetscInt second = first < 0 ? -1 : first + linear->row[row + 1] - linear->row[row] - 1;
  const PetscInt step = first < 0 ? 0 : 1;

  entry[0][0] = first;
  entry[1][1] = second + step;
  entry[0][1] = a <= b ? first + step : second;
  entry[1][0] = a < b ? second : first + step;
}
PetscErrorCode LamLinearCreateMatrix(MPI_Comm comm, LamLinear *linear); /* needs PETSc; the rest above does not */
PetscErrorCode LamLinearDestroy(LamLinear *linear);
/* Factors values + shift times the identity (on positions). *ok is PETSC_FALSE if the matrix is singular to working
   precision. */
PetscErrorCode LamLinearFactor(LamLinear *linear, PetscReal shift, PetscInt *negative, PetscBool *ok);
/* The same if the matrix then has `expected` negative eigenvalues; otherwise *ok is PETSC_FALSE, and there may be no
   factor. Cheaper than LamLinearFactor where it has not. */
PetscErrorCode LamLinearFactorExpected(LamLinear *linear, PetscReal shift, PetscInt expected, PetscBool *ok);
/* solution = K^-1 rhs with the last factor, arrays of length n; count right-hand sides, one after the other. */
PetscErrorCode LamLinearSolve(LamLinear *linear, PetscInt count, const PetscReal rhs[], PetscReal solution[]);
void LamLinearMultiply(const LamLinear *linear, const PetscReal x[], PetscReal y[]);

static inline PetscReal LamLargestEntry(PetscInt n, const PetscReal v[])
{
  PetscReal largest = 0.0;

  for (PetscInt i = 0; i < n; ++i) largest = PetscMax(largest, PetscAbsReal(v[i]));
  return largest;
}

/* Largest absolute value on the diagonal of the positions. */
static inline PetscReal LamLargestDiagonal(const LamLinear *linear)
{
  PetscReal largest = 0.0;

  for (PetscInt i = 0; i < linear->positions; ++i)
    largest = PetscMax(largest, PetscAbsReal(linear->values[linear->row[i]]));
  return largest;
}

/* Four partial sums, so that it is vectorised. */
static inline PetscReal LamInnerProduct(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum[4] = {0.0};
  PetscInt i = 0;

  for (; i + 4 <= n; i += 4)
    for (PetscInt k = 0; k < 4; ++k) sum[k] += a[i + k] * b[i + k];
  for (; i < n; ++i) sum[0] += a[i] * b[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

#endif
