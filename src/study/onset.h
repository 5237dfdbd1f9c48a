/*
  Where cells begin to come apart along a load, judged on two meshes (separation.h). For contact tissue.
*/
#ifndef LAM_ONSET_H
#define LAM_ONSET_H

#include "study.h"
#include "separation.h"

/* The tissue of a scene on its own mesh and, where count is 2, on one with twice the elements along a face. */
typedef struct {
  PetscInt count;
  LamRVE rve[2];
  LamRVEState state[2]; /* the last states that have an answer */
  PetscReal F[9];       /* of the first mesh's */
  PetscBool stopped;    /* a solve was, by the interrupt: its responses are LAM_OUT_OF_REACH and tell nothing */
  LamResponse unsealed; /* where the cells could not be sealed: why; then there are no answers. Else converged */
} LamMeshes;

/* `scene` holds the mesh to use (along and through chosen); `comm` as for LamRVECreate. PETSC_ERR_USER_INPUT as
   LamRVESetMicrostructure. */
PetscErrorCode LamMeshesCreate(MPI_Comm comm, const LamScene *scene, PetscInt count, LamMeshes *meshes);
/* As LamRVESetInterrupt, for good: once it has said to stop it must go on saying so. */
PetscErrorCode LamMeshesSetInterrupt(LamMeshes *meshes, PetscBool (*interrupt)(void *ctx), void *ctx);
/* As LamRVESetWanted; `wanted` on the first mesh, of the second no derivatives are ever needed. */
PetscErrorCode LamMeshesSetWanted(LamMeshes *meshes, LamWanted wanted);
PetscErrorCode LamMeshesDestroy(LamMeshes *meshes);
/*
  Before the first solve, of a scene whose cells are sealed; else without effect. The cells get the water that they have
  at F = I, with the turgor and cohesion of `first`, and the states are those.
*/
PetscErrorCode LamMeshesSeal(LamMeshes *meshes, const LamScene *scene, const LamLoad *first);
/*
  Solves on every mesh from its last state. With two, responses[0] gets what the second tells of it: error_estimate,
  debonded_spread, open_spread; they stay unknown where the second has no answer. control: NULL, or what else the load
  prescribes; the second mesh is then solved at the F that the first has found.
*/
PetscErrorCode LamMeshesSolve(LamMeshes *meshes, const LamLoad *load, const LamStressControl *control,
                              LamResponse responses[2]);

#define LAM_ONSET_STATUSES(X)                                                                                          \
  X(LAM_ONSET_NOT_MET, "not_met")               /* every state has an answer and none is separated */                  \
  X(LAM_ONSET_UNKNOWN, "unknown")               /* no state is known to be separated, but not all are known */         \
  X(LAM_ONSET_FOUND, "found")                   /* bracketed */                                                        \
  X(LAM_ONSET_BEFORE_FIRST, "before_the_first") /* no state that is not separated comes before one that is */          \
  X(LAM_ONSET_NOT_CONVERGED, "not_converged")   /* a load in between has no answer: the bracket is as wide as it is */ \
  X(LAM_ONSET_STOPPED, "stopped")               /* by a signal: likewise */
typedef enum { LAM_ONSET_STATUSES(LAM_ENUM_ENTRY) LAM_ONSET_STATUS_COUNT } LamOnsetStatus;
extern const char *const LamOnsetStatusNames[];

typedef struct {
  LamOnsetStatus status;
  PetscInt last;            /* number of the last state that was watched */
  PetscInt states[2];       /* numbers of the states around it: not separated, separated */
  LamLoad ends[2];          /* their loads */
  PetscReal bracket[2];     /* shares of the way between them: not separated, separated */
  LamLoad load;             /* at bracket[1] */
  LamSeparation criterion;  /* there */
  LamResponse responses[2]; /* there, on both meshes */
  char reason[256];         /* why it is not known, or not better; empty otherwise */
  LamRVEState closed[2];    /* on both meshes at bracket[0]; owned */
} LamOnset;

PetscErrorCode LamOnsetCreate(const LamMeshes *meshes, LamOnset *onset);
PetscErrorCode LamOnsetDestroy(LamOnset *onset);
/* Takes note of state `number`, which has just been solved on both meshes. */
PetscErrorCode LamOnsetWatch(LamOnset *onset, const LamMeshes *meshes, PetscInt number, const LamResponse responses[2]);
/* After the last state that was solved of `count`: bisects the load between the two states around the onset to 1e-3 of
   the way. Leaves other states in `meshes`. */
PetscErrorCode LamOnsetFind(LamOnset *onset, LamMeshes *meshes, PetscInt count);
/* Whether a load without an answer keeps the onset from being known, or known better. */
PetscBool LamOnsetIsUnsolved(const LamOnset *onset);

#endif
