/*
  A responder for sealed cells on top of one for prescribed turgor, such as a database: each material point keeps its
  water, and its pressure follows.

    LamSealedResponderCreate(comm, &open, points, &sealed);
    sealed.respond, sealed.accept ...         turgor is prescribed: the tissue is inflated
    LamSealedResponderSeal(&sealed, K_w);     from here on the cells are sealed
*/
#ifndef LAMELLA_SEALED_H
#define LAMELLA_SEALED_H

#include <lamella/response.h>

/*
  Of tissue whose cells are alike, with one pressure. Borrows `open`, whose counters it shows, and asks it for all
  points of a batch together, some times over, as often on every rank of `comm`. Until it is sealed it passes on what
  `open` answers. accept and reject go to `open`, too.
*/
PetscErrorCode LamSealedResponderCreate(MPI_Comm comm, LamResponder *open, PetscInt points, LamResponder *responder);

/*
  Each point keeps the lumen v_w of its last accepted answer: from here on load.turgor is the pressure p0 of that water,
    v_lumen(F, p) = v_w (1 - (p - p0) / K_w),
  and answers are those of LamRVESeal: turgor_mean tells p. bulk_modulus: K_w, C1 + C2, positive and finite. Each point
  must have an accepted answer; questions without a point (-1) have no water: PETSC_ERR_ARG_OUTOFRANGE.
*/
PetscErrorCode LamSealedResponderSeal(LamResponder *responder, PetscReal bulk_modulus);

/*
  The sealed response from one at prescribed turgor p = response->load.turgor, where v_lumen is that of the water
  (water: v_w, of pressure p0): energy, stress, tangent and all couplings are derivatives of Psi_s (docs/theory.md,
  Section 6).
*/
void LamResponseSeal(PetscReal p0, PetscReal water, PetscReal bulk_modulus, LamResponse *response);

#endif
