/*
  Method. Left-looking: block column j is what earlier columns i that reach row j leave of K(:, j),
    A(k, j) = K(k, j) - sum_i L(k, i) D(i) L(j, i)^T,  A(j, j) = L(j, j) D(j) L(j, j)^T,
    L(k, j) = A(k, j) L(j, j)^-T D(j)^-1,  L(j, j) = [1, 0; l, 1].
  Blocks are ordered by approximate minimum degree. Columns that have the same rows are taken in pairs, both where they
  are subtracted and where they are subtracted from, so that numbers stay in registers.

  Constraints V^T x = b with multipliers, whose part of the diagonal is zero, may be all that holds soft motions. Pivots
  of the positions, which come first, would then nearly vanish. So a multiple of the constraints is added to the other
  rows,  (K + rho V V^T) x + V lambda = a + rho V b,  V^T x = b,  which changes neither solution nor inertia.
*/
#include "ldl_impl.h"
#include "clones.h"
#include <limits.h>

#define MOST_GROWTH 1e4 /* largest |L| |D| |L|^T over the diagonal of K: rounding errors are this times eps */
#define LANES 4         /* right-hand sides at a time */

typedef long Mask __attribute__((vector_size(32)));
typedef double Two __attribute__((vector_size(16)));

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
    LamConstraint *c = &ldl->constraint[h - ldl->positions];
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
    const LamConstraint *c = &ldl->constraint[h - ldl->positions];

    for (PetscInt a = 0; a < c->size; ++a)
      for (PetscInt b = a; c->v[a] != 0.0 && b < c->size; ++b)
        if (c->v[b] != 0.0) entries[c->pairs[a * c->size + b]] += ldl->rho * c->v[a] * c->v[b];
  }
}

/* What `width` columns subtract from one column, or from two, whose rows are places in it and, one less, in the next.
   L: their blocks from the row of the first on; D: on their diagonals. Adds to sum[0..1] the absolute values that the
   diagonals receive. */
LAM_INLINE void Subtract(PetscInt targets, PetscInt width, const LamFour *const L[], const LamFour D[], PetscInt count,
                         const unsigned short target[], LamFour *const column[], LamFour sum[])
{
  LamFour left[2][2], right[2][2]; /* [target][source]: columns of D L^T of the rows of the targets, repeated */

  for (PetscInt t = 0; t < targets; ++t)
    for (PetscInt s = 0; s < width; ++s) {
      const LamFour A = L[s][t] * D[s], size = A * L[s][t];

      left[t][s] = __builtin_shufflevector(A, A, 0, 0, 1, 1);
      right[t][s] = __builtin_shufflevector(A, A, 2, 2, 3, 3);
      sum[t] += (LamFour)((Mask)size & LONG_MAX); /* absolute values */
    }
  for (PetscInt k = 0; k < count; ++k) {
    LamFour change[2] = {{0.0}, {0.0}};

    for (PetscInt s = 0; s < width; ++s) {
      const LamFour a = __builtin_shufflevector(L[s][k], L[s][k], 0, 1, 0, 1);
      const LamFour b = __builtin_shufflevector(L[s][k], L[s][k], 2, 3, 2, 3);

      for (PetscInt t = 0; t < targets; ++t) change[t] += a * left[t][s] + b * right[t][s];
    }
    column[0][target[k]] -= change[0];
    if (targets == 2 && k > 0) column[1][target[k] - 1] -= change[1];
  }
}

/* Subtracts a source from the columns of a panel. */
LAM_INLINE void SubtractSource(const LamLDL ldl, const LamSource *source, LamFour *const column[], LamFour sum[])
{
  const unsigned short *target = ldl->target + source->target;
  const PetscInt i = source->column, *start = ldl->start;
  const PetscBool pair = (PetscBool)(source->width == 2);
  /* rows below the panel: of the first of two columns they start one block later */
  const LamFour *const L[2] = {ldl->factor + start[i] + source->width + source->skip,
                               pair ? ldl->factor + start[i + 1] + 1 + source->skip : NULL};
  const LamFour D[2] = {ldl->factor[start[i]], pair ? ldl->factor[start[i + 1]] : (LamFour){0.0}};
  const PetscInt second = source->to == LAM_TO_SECOND;

  if (source->to == LAM_TO_BOTH) {
    if (pair)
      Subtract(2, 2, L, D, source->count, target, column, sum);
    else
      Subtract(2, 1, L, D, source->count, target, column, sum);
  } else {
    if (pair)
      Subtract(1, 2, L, D, source->count, target, column + second, sum + second);
    else
      Subtract(1, 1, L, D, source->count, target, column + second, sum + second);
  }
}

/* Eliminates a column from which all others are subtracted. */
LAM_INLINE void Eliminate(PetscInt rows, LamFour column[], LamFour *inverse, Outcome *out)
{
  const double d0 = column[0][0], l = column[0][1] / d0, d1 = column[0][3] - l * column[0][1];
  LamFour left, scale;

  out->negative += (d0 < 0.0) + (d1 < 0.0);
  if (!(PetscAbsReal(d0 * d1) > 0.0) || !isfinite(d0 + d1)) out->ok = PETSC_FALSE;
  column[0] = (LamFour){d0, d0, d1, d1};
  *inverse = (LamFour){1.0 / d0, l, 1.0 / d1, 0.0};
  left = (LamFour){0.0, 0.0, l, l};
  scale = 1.0 / column[0];
  for (PetscInt k = 1; k < rows; ++k)
    column[k] = (column[k] - __builtin_shufflevector(column[k], column[k], 0, 1, 0, 1) * left) * scale;
}

LAM_CLONES static Outcome Factor(LamLDL ldl, PetscInt most, PetscReal diagonal)
{
  const PetscInt *start = ldl->start;
  LamFour *factor = ldl->factor;
  double *entries = (double *)factor;
  Outcome out = {0, PETSC_TRUE, 0.0};

  for (PetscInt k = 0; k < start[ldl->blocks]; ++k) factor[k] = (LamFour){0.0};
  for (PetscInt k = 0; k < ldl->nonzeros; ++k) entries[ldl->to[k]] = ldl->values[k];
  AddConstraints(ldl, diagonal);
  if (ldl->n % 2) entries[4 * start[ldl->place[ldl->blocks - 1]] + 3] = 1.0;
  for (PetscInt p = 0; p < ldl->panels; ++p) {
    const PetscInt j = ldl->panel[p], width = ldl->panel[p + 1] - j;
    LamFour *column[2] = {factor + start[j], factor + start[j + width - 1]}, sum[2] = {{0.0}, {0.0}};

    for (PetscInt t = 0; t < width; ++t) column[t][0][2] = column[t][0][1] = column[t][0][1] + column[t][0][2];
    for (PetscInt s = ldl->first[p]; s < ldl->first[p + 1]; ++s) SubtractSource(ldl, &ldl->source[s], column, sum);
    for (PetscInt t = 0; t < width; ++t) {
      const PetscInt rows = start[j + t + 1] - start[j + t];

      if (t == 1) /* the first column of the panel from the second */
        Subtract(1, 1, (const LamFour *const[2]){column[0] + 1, NULL}, column[0], rows, ldl->target, column + 1,
                 sum + 1);
      Eliminate(rows, column[t], &ldl->inverse[j + t], &out);
      out.growth = PetscMax(out.growth, PetscMax(sum[t][0] + sum[t][2], sum[t][1] + sum[t][3]));
      if (out.negative > most) out.ok = PETSC_FALSE;
      if (!out.ok) return out;
    }
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
LAM_CLONES static void Substitute(LamLDL ldl, LamFour x[])
{
  const PetscInt *start = ldl->start, *index = ldl->index;
  const LamFour *factor = ldl->factor;

  for (PetscInt j = 0; j < ldl->blocks; ++j) {
    const LamFour a = x[2 * j], b = x[2 * j + 1] - ldl->inverse[j][1] * a;

    for (PetscInt k = start[j] + 1; k < start[j + 1]; ++k) {
      x[2 * index[k]] -= factor[k][0] * a + factor[k][2] * b;
      x[2 * index[k] + 1] -= factor[k][1] * a + factor[k][3] * b;
    }
    x[2 * j] = ldl->inverse[j][0] * a;
    x[2 * j + 1] = ldl->inverse[j][2] * b;
  }
  for (PetscInt j = ldl->blocks - 1; j >= 0; --j) {
    LamFour a = x[2 * j], b = x[2 * j + 1];

    for (PetscInt k = start[j] + 1; k < start[j + 1]; ++k) {
      a -= factor[k][0] * x[2 * index[k]] + factor[k][1] * x[2 * index[k] + 1];
      b -= factor[k][2] * x[2 * index[k]] + factor[k][3] * x[2 * index[k] + 1];
    }
    x[2 * j] = a - ldl->inverse[j][1] * b;
    x[2 * j + 1] = b;
  }
}

/* The same for one right-hand side. */
LAM_CLONES static void SubstituteOne(LamLDL ldl, Two x[])
{
  const PetscInt *start = ldl->start, *index = ldl->index;
  const LamFour *factor = ldl->factor;

  for (PetscInt j = 0; j < ldl->blocks; ++j) {
    const double a = x[j][0], b = x[j][1] - ldl->inverse[j][1] * a;
    const LamFour ab = {a, a, b, b};

    for (PetscInt k = start[j] + 1; k < start[j + 1]; ++k) {
      const LamFour change = factor[k] * ab;

      x[index[k]] -= __builtin_shufflevector(change, change, 0, 1) + __builtin_shufflevector(change, change, 2, 3);
    }
    x[j][0] = ldl->inverse[j][0] * a;
    x[j][1] = ldl->inverse[j][2] * b;
  }
  for (PetscInt j = ldl->blocks - 1; j >= 0; --j) {
    LamFour sum = {0.0};

    for (PetscInt k = start[j] + 1; k < start[j + 1]; ++k) {
      const Two below = x[index[k]];

      sum += factor[k] * __builtin_shufflevector(below, below, 0, 1, 0, 1);
    }
    x[j][1] -= sum[2] + sum[3];
    x[j][0] -= sum[0] + sum[1] + ldl->inverse[j][1] * x[j][1];
  }
}

/* `lanes` right-hand sides in the order of the factor, with what the constraints add: work [2 blocks][stride]. */
static void Gather(const LamLDL ldl, PetscInt lanes, PetscInt stride, const PetscReal rhs[], double work[])
{
  if (ldl->n % 2)
    for (PetscInt l = 0; l < stride; ++l) work[(2 * ldl->place[ldl->blocks - 1] + 1) * stride + l] = 0.0;
  for (PetscInt i = 0; i < ldl->n; ++i) {
    double *x = &work[(2 * ldl->place[i / 2] + i % 2) * stride];

    for (PetscInt l = 0; l < stride; ++l) x[l] = l < lanes ? rhs[l * ldl->n + i] : 0.0;
  }
  for (PetscInt h = ldl->positions; h < ldl->n && ldl->rho > 0.0; ++h) {
    const LamConstraint *c = &ldl->constraint[h - ldl->positions];
    const double *b = &work[(2 * ldl->place[h / 2] + h % 2) * stride];

    for (PetscInt k = 0; k < c->size; ++k)
      for (PetscInt l = 0; l < lanes && c->v[k] != 0.0; ++l)
        work[(2 * ldl->place[c->at[k] / 2] + c->at[k] % 2) * stride + l] += ldl->rho * c->v[k] * b[l];
  }
}

static void Scatter(const LamLDL ldl, PetscInt lanes, PetscInt stride, const double work[], PetscReal solution[])
{
  for (PetscInt i = 0; i < ldl->n; ++i)
    for (PetscInt l = 0; l < lanes; ++l) solution[l * ldl->n + i] = work[(2 * ldl->place[i / 2] + i % 2) * stride + l];
}

PetscErrorCode LamLDLSolve(LamLDL ldl, PetscInt count, const PetscReal rhs[], PetscReal solution[])
{
  double *work = (double *)ldl->work;

  PetscFunctionBeginUser;
  for (PetscInt first = 0; first < count; first += LANES) {
    const PetscInt lanes = PetscMin(LANES, count - first), stride = lanes == 1 ? 1 : LANES;

    Gather(ldl, lanes, stride, rhs + first * ldl->n, work);
    if (lanes == 1)
      SubstituteOne(ldl, (Two *)work);
    else
      Substitute(ldl, ldl->work);
    Scatter(ldl, lanes, stride, work, solution + first * ldl->n);
  }
  PetscFunctionReturn(0);
}
