/*
  A run of the RVE along the scene's load: its states, their file, and the onset of separation and the failure on the
  way.

  Each state starts from the last converged one, so the states are sequential and one rank solves them.

    LamRVERun run = {.out_path = ..., ...};   options below
    LamSceneRead(path, &run.scene); LamRVERunPrepare(&run); LamRVERunSolve(&run); LamRVERunDestroy(&run);
*/
#ifndef LAM_RVE_RUN_H
#define LAM_RVE_RUN_H

#include "beside.h"
#include "crack.h"
#include "failure.h"
#include "mechanical_test.h"
#include "study.h"
#include "xdmf.h"
#include <lamella/database.h>

typedef struct LamRVERun_s {
  /* options; all borrowed */
  const char *out_path;               /* states and fields; NULL: none */
  PetscBool overwrite;                /* files that Lamella did not write, too */
  PetscBool derivatives, walls;       /* wanted of each state, in addition to what the file and the studies need */
  PetscBool find_onset, find_failure; /* of contact tissue on two meshes */
  PetscBool second_mesh;              /* of contact tissue */
  PetscBool global;                   /* contact tissue, one mesh, prescribed F: from other starts, too */
  PetscBool readings;                 /* of the mechanical test; always with a load from the inflated tissue */
  PetscBool no_estimate, monitor;     /* no estimate of the error; each Newton iteration on stderr */
  LamReporter reporter;
  /* Called after each state, number `solved`; ctx: that of the reporter. */
  PetscErrorCode (*state)(void *ctx, const struct LamRVERun_s *run, const LamResponse responses[2]);

  LamScene *scene;         /* set by the caller; owned */
  LamMeshes meshes;        /* the scene's, and with second_mesh a finer one */
  LamRVEEstimate estimate; /* NULL: no estimate */
  LamOnset onset;
  LamFailure failure;
  LamCrack crack;         /* of a patch with a notch */
  LamTest test;           /* curve of the states with a solution, with `readings` */
  LamRecordWriter writer; /* NULL without a file */
  LamBeside csv;          /* with a file: its table for spreadsheets */
  LamXDMF xdmf;           /* with a file: its description for ParaView */
  PetscInt solved, failed;
  PetscReal time, missed;      /* s, of the last state; since the last one that was found */
  LamDissipationPoint reached; /* of a ramp that is followed by what is dissipated */
  PetscInt inaccurate;         /* number of states whose estimated error exceeds the prescribed accuracy */
  PetscInt unknown;            /* number of states without an error estimate */
  PetscInt kinked;             /* number of states in which walls wrinkle on the scale of the mesh */
  PetscReal most_kinked;
  PetscBool warned_of_suction; /* of contact tissue that has come apart */
  PetscReal start;             /* set by the caller */
} LamRVERun;

/* Chooses what the scene leaves open, and makes the meshes. PETSC_ERR_USER_INPUT if the scene has no load. */
PetscErrorCode LamRVERunPrepare(LamRVERun *run);
/* The next state of the scene's load, number `solved`, with its estimate of the error. meshes.stopped: there is none.
 */
PetscErrorCode LamRVERunNext(LamRVERun *run, LamResponse responses[2]);
/* Solves the states until a stop is requested, and finds onset and failure. Reports notes on doubtful states. */
PetscErrorCode LamRVERunSolve(LamRVERun *run);
PetscErrorCode LamRVERunDestroy(LamRVERun *run);
/* The prescribed stress of state `number`; NULL: none. */
const LamStressControl *LamRVERunControl(const LamRVERun *run, PetscInt number);

/* ---- rve_csv.c ---- */
extern const LamTextKind LamRVETable;
PetscErrorCode LamRVECSVOpen(LamRVERun *run);
/* A line for the state just solved. */
void LamRVECSVAdd(LamRVERun *run, const LamResponse *response);

#endif
