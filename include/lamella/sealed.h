/*
  A responder for sealed cells on top of one for prescribed turgor, such as a database: each material point keeps its
  water, and its pressure follows.

    LamSealedResponderCreate(comm, &open, points, &sealed);
    sealed.respond, sealed.accept ...         turgor is prescribed: the tissue is inflated
    sealed.seal(sealed.ctx, K_w);             from here on the cells are sealed
*/
#ifndef LAMELLA_SEALED_H
#define LAMELLA_SEALED_H

#include <lamella/response.h>
#include <lamella/export.h>

LAM_C_BEGIN

/*
  Of tissue whose cells are alike, with one pressure. Borrows `open`, whose counters it shows, and asks it for all
  points of a batch together, some times over, as often on every rank of `comm`. Until it is sealed it passes on what
  `open` answers. accept and reject go to `open`, too. Answers are those of LamRVESeal; where `open` is a database it
  must be of bonded cells: of cells that part its lumens are not known well enough, and the answer is LAM_OUT_OF_REACH.
*/
LAM_EXPORT PetscErrorCode LamSealedResponderCreate(MPI_Comm comm, LamResponder *open, PetscInt points,
                                                   LamResponder *responder);

/*
  The sealed response from one at prescribed turgor p = response->load.turgor, where v_lumen is that of the water
  (water: v_w, of pressure p0): energy, stress, tangent and all couplings are derivatives of Psi_s
  (docs/theory/walls.md, Sealed lumens).
*/
LAM_EXPORT void LamResponseSeal(PetscReal p0, PetscReal water, PetscReal bulk_modulus, LamResponse *response);

LAM_C_END

#endif
