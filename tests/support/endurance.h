/* Many states in one process, of every kind and with failures among them: what the test asserts and the bench program
   prints of memory and time. */
#ifndef LAM_SUPPORT_ENDURANCE_H
#define LAM_SUPPORT_ENDURANCE_H

#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include "tissue.h"

#define ENDURANCE_KINDS(X)                                                                                             \
  X(ENDURANCE_BONDED, "bonded")                                                                                        \
  X(ENDURANCE_CONTACT, "contact")                                                                                      \
  X(ENDURANCE_MIXED, "mixed control")                                                                                  \
  X(ENDURANCE_SEALED, "sealed")                                                                                        \
  X(ENDURANCE_BYTES, "state as bytes")                                                                                 \
  X(ENDURANCE_ESTIMATE, "with estimate")                                                                               \
  X(ENDURANCE_RESPONDER, "responder")                                                                                  \
  X(ENDURANCE_REBUILD, "new tissue")                                                                                   \
  X(ENDURANCE_FAILURE, "failures")
typedef enum { ENDURANCE_KINDS(LAM_ENUM_ENTRY) ENDURANCE_KIND_COUNT } EnduranceKind;

#define ENDURANCE_FAILURES(X)                                                                                          \
  X(FAILURE_NAN, "F not a number")                                                                                     \
  X(FAILURE_INSIDE_OUT, "F inside out")                                                                                \
  X(FAILURE_ANTIPLANE, "out-of-plane shear")                                                                           \
  X(FAILURE_COHESION, "negative cohesion")                                                                             \
  X(FAILURE_CONTROL, "control that frees F12 and F21")                                                                 \
  X(FAILURE_INTERRUPT, "bonded, interrupted")                                                                          \
  X(FAILURE_INTERRUPT_CONTACT, "contact, interrupted")                                                                 \
  X(FAILURE_INTERRUPT_MIXED, "mixed control, interrupted")                                                             \
  X(FAILURE_COLLAPSE, "collapsed lumen")                                                                               \
  X(FAILURE_COLLAPSE_CONTACT, "contact, collapsed lumen")                                                              \
  X(FAILURE_OVERLAP, "contact, cells in each other")                                                                   \
  X(FAILURE_NO_EQUILIBRIUM, "stress that nothing bears")                                                               \
  X(FAILURE_UNSTABLE, "not stable under its stress")
typedef enum { ENDURANCE_FAILURES(LAM_ENUM_ENTRY) FAILURE_COUNT } EnduranceFailure;

typedef struct {
  LamRVE rve;
  LamRVEState state, reference;
} EnduranceTissue;

typedef struct {
  EnduranceTissue bonded, contact, sealed, coarse, coarse_contact; /* the coarse ones for what takes long to fail */
  LamRVEEstimate estimate;
  LamResponder responder; /* of `bonded` */
  void *bytes;
  size_t size;
  PetscInt calls_left; /* until the interrupt stops a solve; negative: never */
  PetscInt unexpected; /* states that failed, or did not, against what was meant */
  PetscInt statuses[FAILURE_COUNT][LAM_STATUS_COUNT];
} Endurance;

/* ---- memory ---- */

/* Bytes that the program holds of the heap. */
size_t MemoryInUse(void);
/* Resident bytes, without what free() keeps for later. */
size_t MemoryResident(void);

/* ---- tissues ---- */

PetscErrorCode EnduranceCreate(Endurance *e);
PetscErrorCode EnduranceDestroy(Endurance *e);

/* ---- states ---- */

/* State k of a clean kind. */
PetscErrorCode EnduranceSolve(Endurance *e, EnduranceKind kind, PetscInt k, LamResponse *r);

/* ---- failures ---- */

/* From the reference. */
PetscErrorCode EnduranceFail(Endurance *e, EnduranceFailure failure, PetscInt k, LamResponse *r);

/* ---- the program of states ---- */

/* Of ten states one is contact, the others bonded in some way; now and then there is another tissue. */
EnduranceKind EnduranceKindOf(PetscInt k, PetscInt rebuild_every);
/* Cheap failures every tenth state, in turns; one that takes thousands of iterations every `dear` of them. */
EnduranceFailure EnduranceFailureOf(PetscInt k, PetscInt dear);

/* of the responder */
static const char *const endurance_names[] = {ENDURANCE_KINDS(LAM_NAME_ENTRY)};

static const char *const failure_names[] = {ENDURANCE_FAILURES(LAM_NAME_ENTRY)};

#endif
