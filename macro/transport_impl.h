/*
  Private parts of the macroscale solver: water that moves through the body.
*/
#ifndef LAM_TRANSPORT_IMPL_H
#define LAM_TRANSPORT_IMPL_H

#include <math.h>
#include "macro_impl.h"

/* Water that moves through the body; allocated if it does. */
struct LamMacroFlow_s {
  LamMacroTransport spec;
  DM dm;                     /* spec.count unknowns on every node */
  Vec psi, accepted;         /* potentials: in the last evaluation and in the last converged state */
  Vec balance, step;         /* G' of the last evaluation; last change of psi */
  Vec held;                  /* local; 1: prescribed */
  PetscReal *at;             /* [points][count] potentials there */
  Mat to_force, from_u, own; /* B, C', D' */
  PetscScalar *entries[2];   /* of B and C', element by element */
  KSP own_solver;
  PetscBool joined; /* whole_solver is that of `whole`, otherwise of the tangent alone */
  Mat whole;
  Vec whole_in, whole_out;
  KSP whole_solver;
  PetscReal outside, membrane[LAM_MACRO_POTENTIALS]; /* as in LamMacroInstant */
  PetscReal inflow, magnitude;                       /* of the last evaluation: what flows in; of the terms in G */
};

/* transport_create.c and transport.c: these functions do nothing if water does not move through the body (macro->flow
   is NULL) */
PetscErrorCode LamMacroFlowCreate(LamMacro macro);
PetscErrorCode LamMacroFlowDestroy(LamMacro macro);
/* Whether a side without skin prescribes the potential. */
static inline PetscBool LamMacroPrescribes(const LamMacroFlow *flow, const LamSurface *surface, PetscInt f)
{
  return (PetscBool)(isinf(surface->conductance) && !flow->spec.has_membrane[f]);
}

/* Whether water moves now: not as long as turgor is prescribed. */
PetscBool LamMacroFlows(LamMacro macro);
/* Sets conditions, and the potentials from this rank's values. */
PetscErrorCode LamMacroFlowStart(LamMacro macro, const LamMacroInstant *instant, const PetscReal potentials[]);
PetscErrorCode LamMacroFlowGet(LamMacro macro, PetscReal potentials[]);
PetscErrorCode LamMacroFlowAccept(LamMacro macro); /* also sets the points' fields; before `now` is accepted */
PetscErrorCode LamMacroFlowReject(LamMacro macro);
/* Assembles the equations at the last evaluation and eliminates the potentials from the forces; *ok: not singular. */
PetscErrorCode LamMacroFlowReduce(LamMacro macro, Vec force, PetscBool *ok);
/* Norm of their residual, relative to the terms that it is the difference of. */
PetscErrorCode LamMacroFlowResidual(LamMacro macro, PetscReal *residual);
/* Balances the water of the converged body to rounding, by the potentials alone. */
PetscErrorCode LamMacroFlowClose(LamMacro macro);
/* Finds the change of the potentials as displacements change by du from the last evaluation; adds the change of the
   water that it makes to an element's lumens [modes]; makes it. */
PetscErrorCode LamMacroFlowFollow(LamMacro macro, Vec du);
PetscErrorCode LamMacroFlowLumens(LamMacro macro, PetscInt e, PetscReal lumens[]);
PetscErrorCode LamMacroFlowMove(LamMacro macro);

/* transport_solve.c */
/* Creates a direct solver. */
PetscErrorCode LamMacroFactorise(LamMacro macro, const char prefix[], KSP *ksp);
/* Makes a linear solver that of the tangent; with potentials of that with the potentials eliminated. */
PetscErrorCode LamMacroDirectSolver(LamMacro macro, KSP ksp);
/* Adds the part of the potentials to a row weight^T tangent; before rows are combined. */
PetscErrorCode LamMacroFlowTranspose(LamMacro macro, Vec weight, Vec row);

#endif
