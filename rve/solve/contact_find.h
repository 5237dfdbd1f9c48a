/* Contact states at a load: sharpen.c, contact_start.c, contact_find.c, contact_path.c. */
#ifndef LAM_RVE_CONTACT_FIND_H
#define LAM_RVE_CONTACT_FIND_H

#include "solve.h"

/* ---- sharpen.c ---- */
#define LAM_NEAR_REACH 0.5 /* apothems: longer steps from a near solution end the iteration */
/* Solves for equilibrium with the exact law, which is in use, from rve->y, the independent stresses, the multipliers
   and the junction status. reach: longest step from a near solution; 0: from a smooth state, whose active set is taken
   over. border: as in LamNewtonFast. */
PetscErrorCode LamSharpen(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal reach,
                          LamNewtonOutcome *outcome);

/* ---- contact_start.c ---- */
/* Initial guess: a solution moved affinely to the new load. */
void LamContactStartNear(LamRVE rve, LamRVEState from, const LamLoad *load);
/* Initial guess: rve->y := F X with cells swollen by their clearance and stress-free walls. */
void LamContactStartAffine(LamRVE rve, const LamLoad *load);
/* Initial guess: the solution of the bonded tissue at the load. *ok: there is one. */
PetscErrorCode LamContactStartBonded(LamRVE rve, const LamLoad *load, PetscBool *ok);

/* ---- contact_find.c ---- */
typedef struct {
  PetscBool found;   /* a state, stable unless negative > 0, in rve->y with its law in use and its consistent tangent
                        factored */
  PetscInt negative; /* eigenvalues; > 0: a saddle */
  PetscInt branch;   /* saddles left */
  PetscInt shut;     /* cell whose lumen the last attempt has turned inside out; -1: none */
} LamContactOutcome;
#define LAM_NO_OUTCOME ((LamContactOutcome){.shut = -1})
static inline PetscBool LamContactIsStable(const LamContactOutcome *out)
{
  return (PetscBool)(out->found && out->negative <= 0);
}
/* Finds a state at `load` from the state before (rotated; not solved: none). border: as in LamNewtonFast. */
PetscErrorCode LamContactFind(LamRVE rve, const LamLoad *load, LamBorder *border, LamRVEState before,
                              LamContactOutcome *out);
/* The smooth law's part of it, from the present initial guess: a state at a width. */
#define LAM_SEARCH_WIDTH 0.02 /* apothems: far from a state, and to try the exact law from */
PetscErrorCode LamContactSearch(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal width,
                                PetscReal tolerance, LamContactOutcome *out);
/* From that state to the law that is wanted. */
PetscErrorCode LamContactFinish(LamRVE rve, const LamLoad *load, LamBorder *border, LamContactOutcome *out);

#endif
