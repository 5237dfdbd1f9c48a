/*
  A responder for a body of heterogeneous tissue.

  Every point is a blend of tissues, each with its own responder, rotated by an angle:
    Psi(F, p, g) = sum_t w_t s_t Psi_t(F Q, p/s_t, g/s_t),   Q = [[cos a, -sin a], [sin a, cos a]],
  where s_t is the C1 + C2 of tissue t in units of the body's, which loads and responses have, and a is the angle from
  the tissue's cells to the point's cells. Hence P = sum w s P_t Q^T, and likewise for the second and fourth index of
  the tangent. Q rotates the reference only: `fabric` and `opening_moment` are in the current configuration and are
  not rotated; quantities by face, and indices of cells and faces, refer to the cell's own. Lengths are in the
  tissue's own apothem; blended tissues have equal apothems.
*/
#ifndef LAMELLA_HETEROGENEOUS_H
#define LAMELLA_HETEROGENEOUS_H

#include <lamella/blend.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* A material point; `knot` of its terms is the index of a tissue. */
typedef struct {
  PetscInt count;
  LamBlendTerm term[LAM_BLEND_TERMS];
  PetscReal angle; /* radian */
} LamHeterogeneousPoint;

typedef struct {
  const char *name;       /* precedes the reason if there is no response; "": nothing */
  PetscReal stress;       /* C1 + C2, in units of the body's */
  LamStressScale scale;   /* of errors, in units of the body */
  LamResponder responder; /* its points 0, 1, ... are the body's points that contain this tissue, in their order */
} LamHeterogeneousTissue;

/* Number of the n points of this rank that contain the tissue. */
LAM_EXPORT PetscInt LamHeterogeneousPointCount(PetscInt n, const LamHeterogeneousPoint points[], PetscInt tissue);

/*
  Copies the points and tissues, borrows names and responders. Each `respond` calls the responder of every tissue
  once, even without queries, because it may be collective. Counters are sums over the tissues: each term of a blended
  point is a query. If a term has no response, its status and reason are returned. Sealing requires that all tissues
  can be sealed.
*/
LAM_EXPORT PetscErrorCode LamHeterogeneousCreate(PetscInt tissue_count, const LamHeterogeneousTissue tissues[],
                                                 PetscInt n, const LamHeterogeneousPoint points[],
                                                 LamResponder *responder);

LAM_C_END

#endif
