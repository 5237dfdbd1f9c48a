/*
  Load at which cells begin to separate, determined on two meshes (separation.h). For contact tissue.
*/
#ifndef LAM_ONSET_H
#define LAM_ONSET_H

#include "study.h"
#include "separation.h"

/* The tissue of a scene on its own mesh and, if count is 2, on one with twice the elements along a face. */
typedef struct {
  PetscInt count;
  LamRVE rve[2];
  LamRVEState state[2]; /* the last converged states */
  PetscReal F[9];       /* of the first mesh */
  LamStressScale scale; /* of errors of P */
  PetscBool stopped;    /* a solve was interrupted: its responses are LAM_OUT_OF_REACH and carry no information */
  LamResponse unsealed; /* reason if the cells could not be sealed: then nothing is solved. Else converged */
} LamMeshes;

/* `scene`: with along and through chosen; `comm` as for LamRVECreate. PETSC_ERR_USER_INPUT as
   LamRVESetMicrostructure. */
PetscErrorCode LamMeshesCreate(MPI_Comm comm, const LamScene *scene, PetscInt count, LamMeshes *meshes);
/* As LamRVESetInterrupt, but permanent: once `interrupt` returns true it must keep returning true. */
PetscErrorCode LamMeshesSetInterrupt(LamMeshes *meshes, PetscBool (*interrupt)(void *ctx), void *ctx);
/* As LamRVESetWanted, for the first mesh; the second never needs derivatives. */
PetscErrorCode LamMeshesSetWanted(LamMeshes *meshes, LamWanted wanted);
PetscErrorCode LamMeshesDestroy(LamMeshes *meshes);
/*
  For a scene with sealed cells, before the first solve; no effect otherwise. The cells get the water that they contain
  at F = I with the turgor and cohesion of `first`, and the states are set to that solution.
*/
PetscErrorCode LamMeshesSeal(LamMeshes *meshes, const LamScene *scene, const LamLoad *first);
/*
  Solves on every mesh from its last state. With two meshes, responses[0] gets the estimates from the second:
  error_estimate, debonded_spread, open_spread; they stay unknown if the second did not converge. control: NULL, or the
  stress components that the load prescribes; the second mesh is then solved at the F found on the first.
*/
PetscErrorCode LamMeshesSolve(LamMeshes *meshes, const LamLoad *load, const LamStressControl *control,
                              LamResponse responses[2]);
/* The next state of a ramp that is followed by what is dissipated, on one mesh (LamRVESolveDissipating). */
PetscErrorCode LamMeshesDissipate(LamMeshes *meshes, const LamDissipationPath *path, LamDissipationPoint *point,
                                  LamResponse *response);
/* Of contact tissue on one mesh: solves the load of the response again, from the undeformed tissue by both strategies.
   State and response become those of lowest energy; states of different laws of contact are not compared. */
PetscErrorCode LamMeshesSearch(LamMeshes *meshes, LamStrategy strategy, LamResponse *response);

#define LAM_ONSET_STATUSES(X)                                                                                          \
  X(LAM_ONSET_NOT_MET, "not_met")               /* every state converged and none is separated */                      \
  X(LAM_ONSET_UNKNOWN, "unknown")               /* no state is known to be separated, but some are not known */        \
  X(LAM_ONSET_FOUND, "found")                   /* bracketed */                                                        \
  X(LAM_ONSET_BEFORE_FIRST, "before_the_first") /* no unseparated state is known before the first separated one */     \
  X(LAM_ONSET_NOT_CONVERGED, "not_converged")   /* an intermediate load did not: the bracket stays wide */             \
  X(LAM_ONSET_STOPPED, "stopped")               /* by a signal: likewise */
typedef enum { LAM_ONSET_STATUSES(LAM_ENUM_ENTRY) LAM_ONSET_STATUS_COUNT } LamOnsetStatus;
extern const char *const LamOnsetStatusNames[];

typedef struct {
  LamOnsetStatus status;
  PetscInt last;            /* number of the last state watched */
  PetscInt states[2];       /* numbers of the states that bracket it: not separated, separated */
  LamLoad ends[2];          /* their loads */
  PetscReal bracket[2];     /* fractions of the load step between them: not separated, separated */
  LamLoad load;             /* at bracket[1] */
  LamSeparation criterion;  /* at `load` */
  LamResponse responses[2]; /* at `load`, on both meshes */
  char reason[256];         /* why it is not known, or not more precise; empty otherwise */
  LamRVEState closed[2];    /* on both meshes at bracket[0]; owned */
} LamOnset;

PetscErrorCode LamOnsetCreate(const LamMeshes *meshes, LamOnset *onset);
PetscErrorCode LamOnsetDestroy(LamOnset *onset);
/* Updates the onset with state `number`, which has just been solved on both meshes. */
PetscErrorCode LamOnsetWatch(LamOnset *onset, const LamMeshes *meshes, PetscInt number, const LamResponse responses[2]);
/* Call after the last of `count` states that was solved. Bisects the load between the two states that bracket the
   onset to 1e-3 of the step. Changes the states in `meshes`. */
PetscErrorCode LamOnsetFind(LamOnset *onset, LamMeshes *meshes, PetscInt count);
/* Whether a load that did not converge prevents the onset from being known, or known more precisely. */
PetscBool LamOnsetIsUnsolved(const LamOnset *onset);

#endif
