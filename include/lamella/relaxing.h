/*
  A responder for tissue whose walls have a memory (LamRelaxation), based on one for the same tissue with elastic walls
  of the moduli at once, such as a database.

    LamRelaxingResponderCreate(elastic, &micro.relaxation, points, &relaxing);
    LamResponderRespond(relaxing, ...)     each load has a duration, since the last accepted state of its point
    LamResponderAccept(relaxing)
*/
#ifndef LAMELLA_RELAXING_H
#define LAMELLA_RELAXING_H

#include <lamella/response.h>
#include <lamella/wall.h>
#include <lamella/export.h>

LAM_C_BEGIN

/*
  Exact at once, and where everything is held for ever, but for volume changes, which do not relax; exact at any time
  where strains are small; else an approximation (docs/theory/walls.md, Walls with memory in tables). Stress, tangent
  and couplings are derivatives of `energy`, the potential of the step. Tractions and tensions are those of the places
  where the elastic ones are; energies of the past, stored and dissipated, are unknown. A query without a point is of
  tissue without a past. Borrows `elastic`, whose counters it reports; responses of sealed cells: sealed.h, on top.
*/
LAM_EXPORT PetscErrorCode LamRelaxingResponderCreate(LamResponder elastic, const LamRelaxation *relaxation,
                                                     PetscInt points, LamResponder *responder);

LAM_C_END

#endif
