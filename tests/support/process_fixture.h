/* What tests of processes share: a scene's process followed with direct solves, and its states. */
#ifndef LAM_SUPPORT_PROCESS_FIXTURE_H
#define LAM_SUPPORT_PROCESS_FIXTURE_H

#include "test.h"
#include <lamella/lamella.h>
#include <string.h>

/* The default tissue of one cell; what follows stands in the same file. */
#define PROCESS_CELL                                                                                                   \
  "version: 1\n"                                                                                                       \
  "rve:\n"                                                                                                             \
  "  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"                                                               \
  "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"                                         \
  "  mesh: {along: 4, through: 1}\n"
typedef struct {
  LamScene *scene;
  LamRVE rve;
  LamResponder direct;
  LamProcess process;
  LamProcessReason reason;
  char message[LAM_PROCESS_MESSAGE];
  PetscInt count;
  LamProcessState *states; /* [FOLLOWED_STATES] */
} Followed;

Followed Follow(const char text[]);
/* The same, where it must come to its end. */
Followed FollowToEnd(const char text[]);
void Forget(Followed *f);
const LamProcessState *LastState(const Followed *f);
/* The first state at an event; NULL: it did not happen. */
const LamProcessState *FindEvent(const Followed *f, LamEvent event);

#endif
