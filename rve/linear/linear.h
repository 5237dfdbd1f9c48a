/*
  The linear systems of the RVE: sparsity pattern, factorisation, inertia, solves.
*/
#ifndef LAM_RVE_LINEAR_H
#define LAM_RVE_LINEAR_H

#include "element.h"
#include "factor.h"

#define LAM_PAIRS (LAM_ELEMENT_DOFS * (LAM_ELEMENT_DOFS + 1) / 2)

/* Classes that are coupled beyond elements: `count` sets of `size` classes, each with unknowns of its own, multipliers.
 */
typedef struct {
  PetscInt count, size, multipliers;
  const PetscInt *classes; /* [count][size] */
} LamCouplings;

/*
  The symmetric matrix in upper compressed rows (values are written in place) and its factor. Its unknowns are the
  positions, then the multipliers of the couplings, set by set, then the pressures of lumens that can be sealed.
*/
typedef struct {
  PetscInt n, nonzeros;
  PetscInt positions;     /* unknowns that are positions */
  PetscInt lumens;        /* unknowns that are pressures */
  PetscInt *row, *column; /* [n+1], [nonzeros]; the diagonal comes first in a row */
  PetscReal *values;      /* [nonzeros] */
  PetscInt *position; /* [element][LAM_PAIRS] index into values, -1: held; pairs of element dofs i <= j, row by row */
  LamFactor factor;   /* owned */
  PetscInt negative;  /* eigenvalues of the matrix last factored */
  PetscReal rate;     /* how far the factor is from the matrix at the positions reached: about the share of a residual
                         that a step with it leaves; infinite: not known */
  PetscBool nearby;   /* the factor is of a matrix near `values`: solves refine */
} LamLinear;

/* couplings: NULL for none; lumens: number of cells, or 0 where they cannot be sealed. */
PetscErrorCode LamLinearCreate(const LamMesh *mesh, const LamCouplings *couplings, PetscInt lumens, LamLinear *linear);
/* Index into values of the entry of unknowns i and j, which must be coupled; -1 where one of them is negative. */
PetscInt LamLinearEntry(const LamLinear *linear, PetscInt i, PetscInt j);
PetscErrorCode LamLinearCreateMatrix(MPI_Comm comm, LamLinear *linear); /* needs PETSc; the rest above does not */
PetscErrorCode LamLinearDestroy(LamLinear *linear);
/* Factors values + shift 1 (on the positions). *ok is PETSC_FALSE where the matrix is singular to working precision. */
PetscErrorCode LamLinearFactor(LamLinear *linear, PetscReal shift, PetscInt *negative, PetscBool *ok);
/* solution = K^-1 rhs with the last factor, arrays of length n; count right-hand sides, one after the other. */
PetscErrorCode LamLinearSolveOnce(LamLinear *linear, PetscInt count, const PetscReal rhs[], PetscReal solution[]);
/* The same where the factor may be a nearby one: refines until the rest, rhs - K solution, is small. */
PetscErrorCode LamLinearSolve(LamLinear *linear, PetscInt count, const PetscReal rhs[], PetscReal solution[],
                              PetscReal rest[]);
void LamLinearMultiply(const LamLinear *linear, const PetscReal x[], PetscReal y[]);

static inline PetscReal LamLargestEntry(PetscInt n, const PetscReal v[])
{
  PetscReal largest = 0.0;

  for (PetscInt i = 0; i < n; ++i) largest = PetscMax(largest, PetscAbsReal(v[i]));
  return largest;
}

static inline PetscReal LamInnerProduct(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0.0;

  for (PetscInt i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

#endif
