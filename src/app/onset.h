/*
  Where cells begin to come apart along a load, judged on two meshes. For contact tissue.

  The tissue counts as separated where on both meshes
    gap            the largest gap between facing walls exceeds LAM_VISIBLE_GAP, or
    face_traction  the mean traction of a face family reaches the cohesion g, within 1e-3 of p + g, which presses the
                   faces together: contact carries nothing there any more.
  Two meshes, because one alone opens at its junctions by as much as its elements are long.
*/
#ifndef LAM_ONSET_H
#define LAM_ONSET_H

#include "app.h"

/* The tissue of a scene on its own mesh and, where count is 2, on one with twice the elements along a face. */
typedef struct {
  PetscInt count;
  LamRVE rve[2];
  LamRVEState state[2]; /* the last states that have an answer */
} LamMeshes;

/* `scene` holds the mesh to use (along and through chosen). PETSC_ERR_USER_INPUT as LamRVESetMicrostructure. */
PetscErrorCode LamMeshesCreate(const LamScene *scene, PetscInt count, LamMeshes *meshes);
PetscErrorCode LamMeshesDestroy(LamMeshes *meshes);
/*
  Solves on every mesh from its last state. With two, responses[0] gets what the second tells of it: error_estimate,
  debonded_spread, open_spread; they stay unknown where the second has no answer.
*/
PetscErrorCode LamMeshesSolve(LamMeshes *meshes, const LamLoad *load, LamResponse responses[2]);

#define LAM_SEPARATIONS(X)                                                                                             \
  X(LAM_SEPARATION_UNKNOWN, "unknown") /* a mesh has no answer */                                                      \
  X(LAM_SEPARATION_NONE, "none")                                                                                       \
  X(LAM_SEPARATION_GAP, "gap")                                                                                         \
  X(LAM_SEPARATION_TRACTION, "face_traction")
typedef enum { LAM_SEPARATIONS(LAM_ENUM_ENTRY) LAM_SEPARATION_COUNT } LamSeparation;
extern const char *const LamSeparationNames[];

/* Which criterion both meshes fulfil; of both the gap is named. */
LamSeparation LamSeparationOf(const LamResponse responses[2]);

#define LAM_ONSET_STATUSES(X)                                                                                          \
  X(LAM_ONSET_NOT_MET, "not_met")               /* no state is separated */                                            \
  X(LAM_ONSET_FOUND, "found")                   /* bracketed */                                                        \
  X(LAM_ONSET_BEFORE_FIRST, "before_the_first") /* no state that is not separated comes before one that is */          \
  X(LAM_ONSET_NOT_CONVERGED, "not_converged")   /* a load in between has no answer: the bracket is as wide as it is */ \
  X(LAM_ONSET_STOPPED, "stopped")               /* by a signal, before or after that */
typedef enum { LAM_ONSET_STATUSES(LAM_ENUM_ENTRY) LAM_ONSET_STATUS_COUNT } LamOnsetStatus;
extern const char *const LamOnsetStatusNames[];

typedef struct {
  LamOnsetStatus status;
  PetscInt states[2];       /* numbers of the states around it: not separated, separated */
  LamLoad ends[2];          /* their loads */
  PetscReal bracket[2];     /* shares of the way between them: not separated, separated */
  LamLoad load;             /* at bracket[1] */
  LamSeparation criterion;  /* there */
  LamResponse responses[2]; /* there, on both meshes */
  char reason[192];         /* of LAM_ONSET_NOT_CONVERGED */
  LamRVEState closed[2];    /* on both meshes at bracket[0]; owned */
} LamOnset;

PetscErrorCode LamOnsetCreate(const LamMeshes *meshes, LamOnset *onset);
PetscErrorCode LamOnsetDestroy(LamOnset *onset);
/* Takes note of state `number`, which has just been solved on both meshes. */
PetscErrorCode LamOnsetWatch(LamOnset *onset, const LamMeshes *meshes, PetscInt number, const LamResponse responses[2]);
/* After the last state: bisects the load between the two states around the onset to 1e-3 of the way. Leaves other
   states in `meshes`. */
PetscErrorCode LamOnsetFind(LamOnset *onset, LamMeshes *meshes);
/* One JSON object {"onset": {...}} or a few lines for a person, on stdout. */
PetscErrorCode LamOnsetPrint(const LamOnset *onset, const LamScales *scales, PetscBool json);

#endif
