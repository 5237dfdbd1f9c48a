/*
  Bodies and material points of the synthetic material that change in time, and what they tell.
*/
#ifndef LAM_SUPPORT_TOLD_BODY_H
#define LAM_SUPPORT_TOLD_BODY_H

#include <lamella/lamella.h>
#include "support/synthetic_responder.h"

enum { BODY_STATES = 4000 };

/* All scenes begin with it. C1 + C2 is 0.11 MPa, the apothem 75 um; what the walls are the synthetic material does not
 * know. */
#define BODY_TISSUE                                                                                                    \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"                                                               \
  "  wall: {law: mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa}\n"                                                          \
  "  turgor: {pressure: 0.05 MPa}\n"                                                                                   \
  "strength: {lamella_normal: 0.1 MPa}\n"
#define BODY_RELAXES "# walls relax\n" /* in a text: they do */
typedef struct Told_s {
  LamScene *scene;
  LamResponder elastic, material; /* the same, or with walls that relax */
  LamProcessReason reason;
  char message[LAM_PROCESS_MESSAGE];
  LamProcessCounts counts;
  PetscInt count;
  LamBody body;                  /* while it is followed */
  LamMacro macro;                /* likewise */
  void (*look)(struct Told_s *); /* at each of its states, if it is set; `seen` is for it */
  void *seen;
  union {
    LamBodyState *bodies; /* [BODY_STATES] */
    LamProcessState *points;
  };
} Told;

/* Reads the scene, and changes its tolerance where one is given. */
void ReadScene(const char text[], PetscReal tolerance, Told *told);
void RunBody(Told *told);
Told FollowBody(const char text[], PetscReal tolerance);
/* The same, where it must come to its end. */
Told FollowBodyToEnd(const char text[], PetscReal tolerance);
/* One material point of the same tissue. */
Told FollowPoint(const char text[], PetscReal tolerance);
void ForgetTold(Told *told);
const LamBodyState *LastBody(const Told *told);
/* The first state at an event; NULL: it did not happen. */
const LamBodyState *FindBodyEvent(const Told *told, LamEvent event);
/* Force on the body at a named side, over C1 + C2 and the macro length. */
const PetscReal *BodyReaction(const LamBodyState *state, const char name[]);

/* TOLD body = FollowBody(text, 0): forgotten where the block ends. */
#define TOLD OWNED(Told, ForgetTold)

#endif
