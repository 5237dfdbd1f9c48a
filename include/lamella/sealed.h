/*
  A responder for sealed cells, based on one for prescribed turgor, such as a database. Each material point keeps its
  water, and its pressure is computed.

    LamSealedResponderCreate(comm, open, points, &sealed);
    LamResponderRespond(sealed, ...), ...     turgor is prescribed: the tissue is inflated
    LamResponderSeal(sealed, K_w);            from here on the cells are sealed
*/
#ifndef LAMELLA_SEALED_H
#define LAMELLA_SEALED_H

#include <lamella/response.h>
#include <lamella/export.h>

LAM_C_BEGIN

/*
  For tissue of equal cells, with one pressure. Borrows `open`, whose counters it reports. It queries `open` for all
  points of a batch together, several times, equally often on every rank of `comm`. Until it is sealed it returns the
  responses of `open`. accept and reject are also passed to `open`. Responses are those of LamRVESeal. If `open` is a
  database it must be of bonded cells: for cells that separate the lumens are not accurate enough, and the response is
  LAM_OUT_OF_REACH.
*/
LAM_EXPORT PetscErrorCode LamSealedResponderCreate(MPI_Comm comm, LamResponder open, PetscInt points,
                                                   LamResponder *responder);

/*
  Computes the sealed response from one at prescribed turgor p = response->load.turgor, at which v_lumen equals the
  water volume (water: v_w, at pressure p0): energy, stress, tangent and all couplings are derivatives of Psi_s
  (docs/theory/walls.md, Sealed lumens).
*/
LAM_EXPORT void LamResponseSeal(PetscReal p0, PetscReal water, PetscReal bulk_modulus, LamResponse *response);

LAM_C_END

#endif
