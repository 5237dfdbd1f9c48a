/*
  Reactions corrected by another responder, such as direct solves where the run interpolates.

  Method. One Newton step of the body with the reference responder, from the last converged state u of the run:
    K du = -r(u),  reactions of f(u) + K_f du,
  with r, the internal forces f and the tangents of the reference. The error left is of second order in du. The state of
  the run does not change. Displacements are prescribed from the inflated body: du of the inflation moves them.
*/
#include <math.h>
#include "macro_impl.h"

/* Moves the targets of the prescribed displacements by `factor` times the correction of the inflated body. */
static PetscErrorCode MoveTargets(LamMacro macro, PetscReal factor)
{
  const PetscScalar *moved;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(macro->moved, &moved));
  for (PetscInt k = 0; k < macro->constraint_count && macro->loaded; k++) {
    LamConstraint *c = &macro->constraints[k];
    for (PetscInt i = 0; i < LAM_MACRO_DIM; i++)
      c->target += factor * c->normal[i] * PetscRealPart(moved[c->local + i]);
  }
  PetscCall(VecRestoreArrayRead(macro->moved, &moved));
  PetscFunctionReturn(0);
}

/* Assembles residual and tangent of the reference at u; the internal part of the tangent in *internal. */
static PetscErrorCode Assemble(LamMacro macro, Mat *internal)
{
  PetscReal scale;

  PetscFunctionBeginUser;
  PetscCall(LamMacroAssembleForce(macro, macro->force, &scale));
  PetscCall(LamMacroExternalForce(macro, macro->u, macro->external));
  PetscCall(VecWAXPY(macro->residual, -LamMacroTractionFactor(macro), macro->external, macro->force));
  PetscCall(MoveTargets(macro, 1));
  PetscCall(LamMacroConstrainResidual(macro, macro->u, macro->residual));
  PetscCall(MoveTargets(macro, -1));
  PetscCall(LamMacroAssembleTangent(macro, macro->tangent));
  PetscCall(MatDuplicate(macro->tangent, MAT_COPY_VALUES, internal));
  PetscCall(LamMacroAddTractionTangent(macro, macro->tangent));
  PetscCall(LamMacroConstrainTangent(macro, macro->tangent));
  PetscFunctionReturn(0);
}

/* Reactions at u + du with the forces f + K_f du. */
static PetscErrorCode Correct(LamMacro macro, Mat internal, Vec du, LamMacroStep *step)
{
  LamMacroStep corrected = *step;
  Vec force;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(macro->force, &force));
  PetscCall(MatMultAdd(internal, du, macro->force, force));
  PetscCall(VecSwap(force, macro->force_accepted));
  PetscCall(VecAXPY(macro->u, 1, du));
  PetscCall(LamMacroReactions(macro, &corrected));
  PetscCall(VecAXPY(macro->u, -1, du));
  PetscCall(VecSwap(force, macro->force_accepted));
  PetscCall(VecDestroy(&force));
  PetscCall(PetscArraycpy(&step->certified[0][0], &corrected.reaction[0][0], 2 * LAM_MAX_BOUNDARIES));
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(LamMacro macro, LamMacroStep *step)
{
  KSPConvergedReason reason;
  Mat internal;
  KSP ksp;
  Vec du;

  PetscFunctionBeginUser;
  PetscCall(Assemble(macro, &internal));
  PetscCall(VecDuplicate(macro->u, &du));
  PetscCall(SNESGetKSP(macro->snes, &ksp));
  PetscCall(KSPSetOperators(ksp, macro->tangent, macro->tangent));
  PetscCall(KSPSolve(ksp, macro->residual, du));
  PetscCall(VecScale(du, -1));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  if (reason > 0) PetscCall(Correct(macro, internal, du, step));
  if (reason > 0 && !macro->loaded) {
    PetscCall(VecCopy(du, macro->moved));
    macro->knows_moved = PETSC_TRUE;
  }
  if (reason <= 0)
    PetscCall(PetscStrncpy(step->uncertified, "the tangent of the body is singular", sizeof(step->uncertified)));
  PetscCall(VecDestroy(&du));
  PetscCall(MatDestroy(&internal));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroCertify(LamMacro macro, LamMacroStep *step)
{
  LamResponder own = macro->responder;
  LamObstacleNode *nodes;
  LamMaterialPoint *now;
  PetscBool ok;

  PetscFunctionBeginUser;
  step->uncertified[0] = '\0';
  for (PetscInt s = 0; s < LAM_MAX_BOUNDARIES; s++) step->certified[s][0] = step->certified[s][1] = NAN;
  if (!macro->reference) PetscFunctionReturn(0);
  if (macro->loaded && macro->scene->macro.inflate && !macro->knows_moved) {
    PetscCall(PetscStrncpy(step->uncertified, "the inflated body is not certified", sizeof(step->uncertified)));
    PetscFunctionReturn(0);
  }
  PetscCall(PetscMalloc2(macro->point_count, &now, macro->obstacle_node_count, &nodes));
  PetscCall(PetscArraycpy(now, macro->now, macro->point_count));
  PetscCall(PetscArraycpy(nodes, macro->obstacle_nodes, macro->obstacle_node_count));
  for (PetscInt p = 0; p < macro->point_count; p++) macro->now[p].known = PETSC_FALSE;
  macro->responder = macro->reference;
  PetscCall(LamMacroEvaluate(macro, macro->u, &ok));
  macro->responder = own;
  if (ok) {
    PetscCall(LamResponderAccept(macro->reference));
    PetscCall(Solve(macro, step));
  } else {
    PetscCall(LamResponderReject(macro->reference));
    PetscCall(PetscStrncpy(step->uncertified, macro->trouble, sizeof(step->uncertified)));
  }
  PetscCall(PetscArraycpy(macro->now, now, macro->point_count));
  PetscCall(PetscArraycpy(macro->obstacle_nodes, nodes, macro->obstacle_node_count));
  PetscCall(PetscFree2(now, nodes));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSetReference(LamMacro macro, LamResponder reference)
{
  PetscFunctionBeginUser;
  PetscCheck(
      !reference || (!macro->border_count && !macro->scene->sealed && !macro->water_law), macro->comm,
      PETSC_ERR_USER_INPUT,
      "%s: reactions of bodies with load control, free grips or sealed cells cannot be certified; leave that out",
      macro->scene->path);
  macro->reference = reference;
  PetscFunctionReturn(0);
}
