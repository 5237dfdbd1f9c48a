/*
  The rest of stress and tangent: components with an index 3 (docs/theory/homogenisation.md, Out of the section).

  Method. In the frame of the section q = (F11, F12, F21, F22, F33, p, g, width, G1, G2), G = (F31, F32), and z are
  condensed after the positions in the plane. With y_q the change of positions at fixed z,
    H_qr = L_qr + L_qy y_r  at fixed z;   r_q = L_zq + L_zy y_q;   S = L_zz - L_zy K^-1 L_yz;   H_qr -= r_q S^-1 r_r.
  Only walls and the lamella have derivatives with respect to z and G. To first order the solution is at z - S^-1 L_z.
  Components 13 and 23 follow from objectivity (src/core/section_frame.c).
*/
#include "antiplane.h"
#include "measure.h"

typedef struct {
  PetscReal *r, *z, G[2]; /* [class] r_q, S^-1 r_q; derivative with respect to G at fixed z */
} AxialColumn;

/* A column of the plane: y = -K^-1 R, `solution`. */
static void FindPlaneColumn(LamRVE rve, PetscInt q, const PetscReal solution[], PetscReal y[], AxialColumn *column)
{
  LamPlaneDirection d = {.y = y};

  y[0] = y[1] = 0.0;
  for (PetscInt i = 0; i < rve->linear->positions; ++i) y[i + 2] = -solution[i];
  if (q < 4) d.F[q] = 1.0;
  if (q == 4) d.F33 = 1.0;
  LamAntiplaneFromPlane(rve, &d, column->r, column->G);
}

/* That of a component of G; work [2 ndof]. */
static PetscErrorCode FindAxialColumn(LamRVE rve, PetscInt l, PetscReal work[], AxialColumn *column)
{
  const PetscReal G[2] = {l == 0, l == 1};
  LamPlaneGradient force = {.y = work};
  LamPlaneDirection back = {.y = work + rve->ndof};

  PetscFunctionBeginUser;
  LamAntiplaneApply(rve, column->z, G, column->r, column->G); /* z = 0 */
  if (!rve->antiplane->couples) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(work, rve->ndof));
  LamAntiplaneToPlane(rve, column->z, G, &force);
  for (PetscInt i = 0; i < rve->ndof; ++i) work[i] = -work[i];
  PetscCall(LamAntiplaneRelax(rve, work, work + rve->ndof));
  LamAntiplaneFromPlane(rve, &back, column->r, column->G);
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveColumns(LamRVE rve, PetscInt count, AxialColumn column[], PetscBool *ok)
{
  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  for (PetscInt k = 0; k < count && *ok; ++k) {
    column[k].r[0] = 0.0;
    PetscCall(LamAntiplaneSolve(rve, column[k].r, column[k].z, ok));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamCondenseAxial(LamRVE rve, const LamLoad *load, PetscInt nq, const PetscReal solutions[],
                                LamAxialDerivatives *out)
{
  const PetscInt n = rve->linear->n, classes = rve->antiplane->classes, count = nq + 2, residual = count;
  AxialColumn column[LAM_MOST_COLUMNS + 3] = {{0}};
  PetscReal *data, *work;

  PetscFunctionBeginUser;
  *out = (LamAxialDerivatives){0};
  PetscCall(LamAntiplaneAssemble(rve, load, &out->ok));
  PetscCall(PetscCalloc2(2 * (count + 1) * classes, &data, 2 * rve->ndof, &work));
  for (PetscInt k = 0; k <= count; ++k) {
    column[k].r = data + 2 * k * classes;
    column[k].z = column[k].r + classes;
  }
  for (PetscInt q = 0; q < nq && rve->antiplane->couples; ++q)
    FindPlaneColumn(rve, q, solutions + q * n, work, &column[q]);
  for (PetscInt l = 0; l < 2; ++l) PetscCall(FindAxialColumn(rve, l, work, &column[nq + l]));
  PetscCall(PetscArraycpy(column[residual].r, rve->antiplane->f, classes));
  if (out->ok) PetscCall(SolveColumns(rve, count + 1, column, &out->ok));
  for (PetscInt k = 0; k < count && out->ok; ++k) {
    const PetscInt q = k < nq ? k : k - nq + LAM_AXIAL_G;

    out->Lq[q] =
        (k < nq ? 0.0 : rve->antiplane->LG[k - nq]) - LamInnerProduct(classes, column[k].r, column[residual].z);
    for (PetscInt m = 0; m < count; ++m) {
      const PetscInt r = m < nq ? m : m - nq + LAM_AXIAL_G;
      const PetscReal fixed = m >= nq ? column[k].G[m - nq] : k >= nq ? column[m].G[k - nq] : 0.0;

      out->H[q][r] = fixed - LamInnerProduct(classes, column[k].r, column[m].z);
    }
  }
  PetscCall(PetscFree2(data, work));
  PetscFunctionReturn(0);
}
