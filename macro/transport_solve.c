/*
  Linear equations of a body in which water moves (transport.c): displacements and potentials are factored together,

    ( A'  B  )
    ( C'  D' )

  with the rows of the nodes' conditions (rows.c) in A' and B. What is solved is the equation of the displacements after
  the potentials are eliminated, so the right-hand side of the potentials is 0.
*/
#include "transport_impl.h"

PetscErrorCode LamMacroFactorise(LamMacro macro, const char prefix[], KSP *ksp)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPCreate(macro->comm, ksp));
  PetscCall(KSPSetOptionsPrefix(*ksp, prefix));
  PetscCall(KSPSetType(*ksp, KSPPREONLY));
  PetscCall(KSPGetPC(*ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(KSPSetFromOptions(*ksp));
  PetscFunctionReturn(0);
}

/* Joins the matrices; displacements come first on each rank. */
static PetscErrorCode Join(LamMacroFlow *flow, Mat tangent)
{
  Mat blocks[4] = {tangent, flow->to_force, flow->from_u, flow->own}, nest;

  PetscFunctionBeginUser;
  PetscCall(MatCreateNest(PetscObjectComm((PetscObject)tangent), 2, NULL, 2, NULL, blocks, &nest));
  PetscCall(MatDestroy(&flow->whole));
  PetscCall(MatConvert(nest, MATAIJ, MAT_INITIAL_MATRIX, &flow->whole));
  PetscCall(MatDestroy(&nest));
  if (!flow->whole_in) PetscCall(MatCreateVecs(flow->whole, &flow->whole_out, &flow->whole_in));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetUp(PC pc)
{
  LamMacro macro;
  Mat tangent;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &macro));
  PetscCall(PCGetOperators(pc, NULL, &tangent));
  LamMacroFlow *flow = macro->flow;
  const PetscBool whole = LamMacroFlows(macro);
  if (whole) PetscCall(Join(flow, tangent));
  if (flow->joined != whole) PetscCall(KSPReset(flow->whole_solver)); /* another size */
  flow->joined = whole;
  PetscCall(KSPSetOperators(flow->whole_solver, whole ? flow->whole : tangent, whole ? flow->whole : tangent));
  PetscFunctionReturn(0);
}

static PetscErrorCode SolveWhole(LamMacroFlow *flow, Vec residual, Vec y)
{
  const PetscScalar *from;
  PetscScalar *to;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(residual, &n));
  PetscCall(VecZeroEntries(flow->whole_in));
  PetscCall(VecGetArrayRead(residual, &from));
  PetscCall(VecGetArray(flow->whole_in, &to));
  PetscCall(PetscArraycpy(to, from, n));
  PetscCall(VecRestoreArray(flow->whole_in, &to));
  PetscCall(VecRestoreArrayRead(residual, &from));
  PetscCall(KSPSolve(flow->whole_solver, flow->whole_in, flow->whole_out));
  PetscCall(VecGetArrayRead(flow->whole_out, &from));
  PetscCall(VecGetArray(y, &to));
  PetscCall(PetscArraycpy(to, from, n));
  PetscCall(VecRestoreArray(y, &to));
  PetscCall(VecRestoreArrayRead(flow->whole_out, &from));
  PetscFunctionReturn(0);
}

static PetscErrorCode Apply(PC pc, Vec residual, Vec y)
{
  KSPConvergedReason reason;
  LamMacro macro;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &macro));
  if (macro->flow->joined)
    PetscCall(SolveWhole(macro->flow, residual, y));
  else
    PetscCall(KSPSolve(macro->flow->whole_solver, residual, y));
  PetscCall(KSPGetConvergedReason(macro->flow->whole_solver, &reason));
  PetscCall(PCSetFailedReason(pc, reason < 0 ? PC_SUBPC_ERROR : PC_NOERROR));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroDirectSolver(LamMacro macro, KSP ksp)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  if (macro->flow) {
    PetscCall(PCSetType(pc, PCSHELL));
    PetscCall(PCShellSetContext(pc, macro));
    PetscCall(PCShellSetSetUp(pc, SetUp));
    PetscCall(PCShellSetApply(pc, Apply));
  } else {
    PetscCall(PCSetType(pc, PCLU));
    PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFlowTranspose(LamMacro macro, Vec weight, Vec row)
{
  LamMacroFlow *flow = macro->flow;
  Vec t, s;

  PetscFunctionBeginUser;
  if (!LamMacroFlows(macro)) PetscFunctionReturn(0);
  PetscCall(DMGetGlobalVector(flow->dm, &t));
  PetscCall(DMGetGlobalVector(flow->dm, &s));
  PetscCall(MatMultTranspose(flow->to_force, weight, t));
  PetscCall(KSPSolveTranspose(flow->own_solver, t, s));
  PetscCall(VecScale(s, -1));
  PetscCall(MatMultTransposeAdd(flow->from_u, s, row, row));
  PetscCall(DMRestoreGlobalVector(flow->dm, &s));
  PetscCall(DMRestoreGlobalVector(flow->dm, &t));
  PetscFunctionReturn(0);
}
