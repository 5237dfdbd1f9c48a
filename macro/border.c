/*
  Unknowns other than nodal displacements: the free displacement component of a grip, and the factor of all tractions
  under load control.

  With r' the residual, h the equations of the unknowns q, Newton's method solves

    (K' B) (du)     (r')
    (C  D) (dq) = - (h )

  by block elimination: a = K'^-1 r', b_l = K'^-1 B_l, (D - C b) dq = -h + C a, du = -a - b dq: one additional solve
  per unknown with the same factor. This is done in the linear solver that SNES calls once per iteration, which also
  updates q by dq. K' is singular only at a limit point, which no iterate hits exactly; the bordered matrix is regular
  there.

  Grip: its nodes' equations are n . u - target - q = 0, h the total force on them, r the unbalanced force:
    B = -1 at these rows,  h = w . r,  C = w . K,  w = 1 at these rows.
  Load control: r = f - q t; the mean displacement over a side is prescribed:
    B = -t with its rows combined as r',  h = m . u - target,  C = m.

  Reference: Wriggers, Nonlinear Finite Element Methods, sec. 5.3; Keller, Appl. Bifurcation Theory (1977) 359-384.
*/
#include "transport_impl.h"
#include <petscblaslapack.h>

PetscInt LamMacroFindBorder(LamMacro macro, PetscInt entry, PetscInt component)
{
  for (PetscInt k = 0; k < macro->border_count; k++) {
    const LamMacroBorder *border = &macro->borders[k];
    if (border->entry == entry && (entry < 0 || border->component == component)) return k;
  }
  return -1;
}

static PetscBool IsFreeGrip(const LamBoundary *boundary, PetscInt component)
{
  return boundary->kind == LAM_BOUNDARY_GRIP && !boundary->given[component] ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode AddBorder(LamMacro macro, PetscInt entry, PetscInt component)
{
  LamMacroBorder *border = &macro->borders[macro->border_count++];

  PetscFunctionBeginUser;
  *border = (LamMacroBorder){.entry = entry, .component = component};
  PetscCall(VecDuplicate(macro->u, &border->weight));
  PetscCall(VecDuplicate(macro->u, &border->column));
  PetscCall(VecDuplicate(macro->u, &border->row));
  PetscCall(VecDuplicate(macro->u, &border->solved));
  PetscCall(VecZeroEntries(border->weight));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroBordersDestroy(LamMacro macro)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < macro->border_count; k++) {
    PetscCall(VecDestroy(&macro->borders[k].weight));
    PetscCall(VecDestroy(&macro->borders[k].column));
    PetscCall(VecDestroy(&macro->borders[k].row));
    PetscCall(VecDestroy(&macro->borders[k].solved));
  }
  macro->border_count = 0;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroBordersCreate(LamMacro macro, PetscBool scene)
{
  const LamMacroSpec *spec = &macro->scene->macro;

  PetscFunctionBeginUser;
  PetscCall(LamMacroBordersDestroy(macro));
  if (!scene) PetscFunctionReturn(0);
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    for (PetscInt i = 0; i < 2; i++) {
      if (IsFreeGrip(&spec->boundary[b], i)) PetscCall(AddBorder(macro, b, i));
    }
  }
  if (spec->control.on[0]) PetscCall(AddBorder(macro, -1, spec->control.component));
  PetscFunctionReturn(0);
}

/* Adds the integrals of N_a over a facet of the controlled side to its nodes, and its length to *length; of an
   axisymmetric body over its area. */
static PetscErrorCode AddMean(LamMacro macro, const LamMacroFacet *facet, PetscInt component, Vec local,
                              PetscReal *length)
{
  PetscReal X[6], sense;
  PetscScalar share[6] = {0};

  PetscFunctionBeginUser;
  PetscCall(LamMacroFacetNodes(macro, facet, X, &sense));
  for (PetscInt q = 0; q < LAM_FACET_POINTS; q++) {
    PetscReal N[3], dN[3], weight, tau[2] = {0, 0};
    LamMacroFacetShape(q, N, dN, &weight);
    for (PetscInt a = 0; a < 6; a++) tau[a % 2] += dN[a / 2] * X[a];
    weight *= PetscSqrtReal(PetscSqr(tau[0]) + PetscSqr(tau[1]));
    if (macro->axisymmetric) weight *= N[0] * X[0] + N[1] * X[2] + N[2] * X[4];
    for (PetscInt a = 0; a < 3; a++) share[2 * a + component] += weight * N[a];
    *length += weight;
  }
  PetscCall(DMPlexVecSetClosure(macro->dm, NULL, local, facet->point, share, ADD_VALUES));
  PetscFunctionReturn(0);
}

static PetscErrorCode MeanWeights(LamMacro macro, LamMacroBorder *border)
{
  const PetscInt set = LamMacroFindSet(macro, macro->scene->macro.control.on);
  PetscReal length = 0;
  Vec local;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(macro->dm, &local));
  PetscCall(VecZeroEntries(local));
  for (PetscInt f = 0; f < macro->facet_count; f++) {
    if (macro->facets[f].sets >> set & 1)
      PetscCall(AddMean(macro, &macro->facets[f], border->component, local, &length));
  }
  PetscCall(DMLocalToGlobal(macro->dm, local, ADD_VALUES, border->weight));
  PetscCall(DMRestoreLocalVector(macro->dm, &local));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &length, 1, MPIU_REAL, MPIU_SUM, macro->comm));
  LamMacroRequire(length > 0, macro, &macro->scene->macro.control.place,
                  "macro.control: on: %s: is a point or lies inside the body; name a piece of its boundary",
                  macro->scene->macro.control.on);
  PetscCall(VecScale(border->weight, 1 / length));
  PetscCall(VecCopy(border->weight, border->row));
  PetscCall(VecDot(border->weight, macro->u, &border->base));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroBordersStart(LamMacro macro)
{
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < macro->border_count; b++) {
    LamMacroBorder *border = &macro->borders[b];
    PetscScalar *weight;
    if (border->entry < 0) {
      PetscCall(MeanWeights(macro, border));
      continue;
    }
    PetscCall(VecGetArray(border->weight, &weight));
    for (PetscInt k = 0; k < macro->constraint_count; k++) {
      if (macro->constraints[k].border == b) weight[macro->constraints[k].local + border->component] = 1;
    }
    PetscCall(VecRestoreArray(border->weight, &weight));
    PetscCall(VecCopy(border->weight, border->column));
    PetscCall(VecScale(border->column, -1));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroBorderEquations(LamMacro macro, Vec u, Vec unbalanced)
{
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < macro->border_count; b++) {
    LamMacroBorder *border = &macro->borders[b];
    PetscCall(VecDot(border->weight, border->entry < 0 ? u : unbalanced, &border->equation));
    if (border->entry < 0) border->equation -= border->target;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroBorderDerivatives(LamMacro macro, Mat tangent)
{
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < macro->border_count; b++) {
    LamMacroBorder *border = &macro->borders[b];
    if (border->entry >= 0) { /* a grip's column is constant, and so is the row of the traction factor */
      PetscCall(MatMultTranspose(tangent, border->weight, border->row));
      PetscCall(LamMacroFlowTranspose(macro, border->weight, border->row));
      continue;
    }
    PetscCall(VecCopy(macro->external, border->column));
    PetscCall(VecScale(border->column, -1));
    PetscCall(LamMacroCombineRows(macro, border->column));
  }
  PetscFunctionReturn(0);
}

/* D_kl: derivative of the equation of border k with respect to the unknown l. Nonzero only for a grip and the traction
   factor, since grips may carry tractions. */
static PetscErrorCode OwnDerivative(LamMacro macro, PetscInt k, PetscInt l, PetscReal *D)
{
  PetscFunctionBeginUser;
  *D = 0;
  if (macro->borders[k].entry < 0 || macro->borders[l].entry >= 0) PetscFunctionReturn(0);
  PetscCall(VecDot(macro->borders[k].weight, macro->external, D));
  *D = -*D;
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveBordered(PC pc, Vec residual, Vec y)
{
  PetscReal S[PetscSqr(2 * LAM_MAX_BOUNDARIES + 1)], dq[2 * LAM_MAX_BOUNDARIES + 1];
  PetscBLASInt n, one = 1, info, pivots[2 * LAM_MAX_BOUNDARIES + 1];
  KSPConvergedReason reason;
  LamMacro macro;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &macro));
  PetscCall(KSPSolve(macro->solver, residual, y));
  PetscCall(KSPGetConvergedReason(macro->solver, &reason));
  PetscCall(PCSetFailedReason(pc, reason < 0 ? PC_SUBPC_ERROR : PC_NOERROR));
  if (reason < 0 || !macro->border_count) PetscFunctionReturn(0);
  n = (PetscBLASInt)macro->border_count;
  for (PetscInt l = 0; l < n; l++) {
    PetscCall(KSPSolve(macro->solver, macro->borders[l].column, macro->borders[l].solved));
    PetscCall(VecDot(macro->borders[l].row, y, &dq[l]));
    dq[l] -= macro->borders[l].equation;
    for (PetscInt k = 0; k < n; k++) {
      PetscReal D;
      PetscCall(OwnDerivative(macro, k, l, &D));
      PetscCall(VecDot(macro->borders[k].row, macro->borders[l].solved, &S[l * n + k]));
      S[l * n + k] = D - S[l * n + k];
    }
  }
  LAPACKgesv_(&n, &one, S, &n, pivots, dq, &n, &info);
  PetscCall(PCSetFailedReason(pc, info ? PC_SUBPC_ERROR : PC_NOERROR));
  for (PetscInt l = 0; l < n && !info; l++) {
    PetscCall(VecAXPY(y, dq[l], macro->borders[l].solved));
    macro->borders[l].now += dq[l];
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode SetUpBordered(PC pc)
{
  LamMacro macro;
  Mat tangent;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &macro));
  PetscCall(PCGetOperators(pc, NULL, &tangent));
  PetscCall(KSPSetOperators(macro->solver, tangent, tangent));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroBorderSolver(LamMacro macro, KSP ksp)
{
  const LamMacroSpec *spec = &macro->scene->macro;
  PetscBool needed = spec->control.on[0] ? PETSC_TRUE : PETSC_FALSE;
  PC pc;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2 * spec->boundary_count; k++)
    needed = needed || IsFreeGrip(&spec->boundary[k / 2], k % 2) ? PETSC_TRUE : PETSC_FALSE;
  if (!needed) PetscFunctionReturn(0);
  PetscCall(KSPCreate(macro->comm, &macro->solver));
  PetscCall(KSPSetOptionsPrefix(macro->solver, "macro_"));
  PetscCall(LamMacroDirectSolver(macro, macro->solver));
  PetscCall(KSPSetFromOptions(macro->solver));
  PetscCall(KSPSetOptionsPrefix(ksp, "macro_bordered_"));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, macro));
  PetscCall(PCShellSetSetUp(pc, SetUpBordered));
  PetscCall(PCShellSetApply(pc, SolveBordered));
  PetscFunctionReturn(0);
}
