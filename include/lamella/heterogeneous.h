/*
  A responder for a body whose material points are of different tissue.

  Every point is a blend of tissues, each with a responder of its own, turned by an angle:
    Psi(F, p, g) = sum_t w_t s_t Psi_t(F Q, p/s_t, g/s_t),   Q = [[cos a, -sin a], [sin a, cos a]],
  with s_t the C1 + C2 of tissue t in units of the body's, in which questions and answers are, and a the angle of the
  point's cells to the tissue's own. So P = sum w s P_t Q^T, and the tangent likewise in its second and fourth index.
  Q turns the reference alone: `fabric` and `opening_moment`, of the current state, need no turning; what goes by face,
  or names cells and faces, speaks of the cell's own. Lengths are in the apothem of the tissue itself, of blended tissue
  in that of any of them, for these are alike.
*/
#ifndef LAMELLA_HETEROGENEOUS_H
#define LAMELLA_HETEROGENEOUS_H

#include <lamella/blend.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* A material point; `knot` of its terms is the number of a tissue. */
typedef struct {
  PetscInt count;
  LamBlendTerm term[LAM_BLEND_TERMS];
  PetscReal angle; /* radian */
} LamHeterogeneousPoint;

typedef struct {
  const char *name;        /* said before the reason where it has no answer; "": nothing */
  PetscReal stress;        /* C1 + C2, in units of the body's */
  LamResponder *responder; /* its points 0, 1, ... are those of the body that have it, in their order */
} LamHeterogeneousTissue;

/* How many of the n points of this rank have the tissue. */
LAM_EXPORT PetscInt LamHeterogeneousPointCount(PetscInt n, const LamHeterogeneousPoint points[], PetscInt tissue);

/*
  Copies the points and tissues, borrows names and responders. Each `respond` asks the responder of every tissue once,
  also without questions, for it may be collective. Counters are the sums of the tissues': of a blended point every term
  is a query. A term without answer is the answer's status and reason. It can be sealed where all tissues can.
*/
LAM_EXPORT PetscErrorCode LamHeterogeneousCreate(PetscInt tissue_count, const LamHeterogeneousTissue tissues[],
                                                 PetscInt n, const LamHeterogeneousPoint points[],
                                                 LamResponder *responder);

LAM_C_END

#endif
