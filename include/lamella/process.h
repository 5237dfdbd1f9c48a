/*
  Tissue that changes in time at one material point: kinetics of lamella, walls and membranes, exchange of water, and a
  program of load, integrated by IDA of SUNDIALS.

    LamProcessCreate(scene, &process); LamProcessSetResponder(process, &responder);
    LamProcessSetMonitor(process, told, ctx); LamProcessSetStop(process, stop);
    LamProcessRun(process, &reason, message); LamProcessDestroy(&process);

  Equations: docs/theory/process.md.
*/
#ifndef LAMELLA_PROCESS_H
#define LAMELLA_PROCESS_H

#include <petscsys.h>
#include <lamella/response.h>
#include <lamella/scene.h>
#include <lamella/export.h>

LAM_C_BEGIN

typedef struct LamProcess_s *LamProcess;

/* What is found in time, each where it happens first; turgor may be lost and found again. */
#define LAM_EVENTS(X)                                                                                                  \
  X(LAM_EVENT_LAMELLA_NORMAL, "lamella_normal") /* bonded: max_traction reaches the strength of the lamella */         \
  X(LAM_EVENT_LAMELLA_SHEAR, "lamella_shear")   /* bonded: max_lamella_shear does */                                   \
  X(LAM_EVENT_WALL, "wall_rupture")             /* max_wall_tension reaches the strength of the walls */               \
  X(LAM_EVENT_OPENING, "opening")               /* contact: opening_fraction has grown by process.opening */           \
  X(LAM_EVENT_PERCOLATION, "percolation")       /* contact: cells that hang together no longer span the tissue */      \
  X(LAM_EVENT_TURGOR_LOST, "turgor_lost")       /* turgor has fallen to 0: membranes leave the walls */                \
  X(LAM_EVENT_TURGOR_FOUND, "turgor_found")     /* the protoplast fills the lumen again */                             \
  X(LAM_EVENT_SNAP, "snap")                     /* the tissue jumps to another equilibrium; may recur */               \
  X(LAM_EVENT_LIMIT, "limit_point")             /* the stiffness against what is free falls to 0 */
#define LAM_EVENT_ENTRY(symbol, name) symbol,
typedef enum { LAM_EVENTS(LAM_EVENT_ENTRY) LAM_EVENT_COUNT } LamEvent;
#undef LAM_EVENT_ENTRY
LAM_EXPORT extern const char *const LamEventNames[];

/* What walls and lamella bear over their strengths at the time; 1: they give way. NaN where no strength is given. */
#define LAM_RATIOS(X)                                                                                                  \
  X(LAM_RATIO_LAMELLA_NORMAL, "lamella_normal")                                                                        \
  X(LAM_RATIO_LAMELLA_SHEAR, "lamella_shear")                                                                          \
  X(LAM_RATIO_WALL, "wall")
#define LAM_RATIO_ENTRY(symbol, name) symbol,
typedef enum { LAM_RATIOS(LAM_RATIO_ENTRY) LAM_RATIO_COUNT } LamRatio;
#undef LAM_RATIO_ENTRY
LAM_EXPORT extern const char *const LamRatioNames[];

/* The tissue at a time. Stresses in the C1 + C2 of the start, which the scene's scales tell. */
typedef struct {
  PetscReal time;                       /* s */
  PetscReal temperature;                /* K */
  PetscReal factor[LAM_CHANGING_COUNT]; /* of what it was at the start */
  PetscReal walls;                      /* C1 + C2 over that at the start */
  PetscReal F[9];                       /* from the inflated state */
  PetscReal turgor, cohesion;
  PetscReal water;    /* volume of the protoplasts over V0; NaN where water is not followed */
  PetscReal osmotic;  /* pressure in them; likewise */
  PetscReal outside;  /* osmotic pressure outside */
  PetscReal firmness; /* dP11/dF11 at constant P22, without water passing: Young's modulus of a quick test */
  PetscReal ratio[LAM_RATIO_COUNT];
  LamResponse response;
  LamEvent event; /* LAM_EVENT_COUNT: none, a time of the output */
} LamProcessState;

typedef struct {
  PetscInt64 steps, residuals, jacobians, restarts; /* of the integrator */
  PetscInt64 questions;                             /* to the responder */
} LamProcessCounts;

typedef enum { LAM_PROCESS_DONE, LAM_PROCESS_STOPPED, LAM_PROCESS_ENDED } LamProcessReason;

#define LAM_PROCESS_MESSAGE 400

/* Called for each output time and each event, in the order of time. */
typedef PetscErrorCode (*LamProcessMonitor)(const LamProcessState *state, void *ctx);

/* Borrows the scene, which has a block `process`. */
LAM_EXPORT PetscErrorCode LamProcessCreate(const LamScene *scene, LamProcess *process);
/* Borrows it; asked with point 0. */
LAM_EXPORT PetscErrorCode LamProcessSetResponder(LamProcess process, LamResponder *responder);
/*
  Solves where the answers of the responder have indicators that are not to be trusted (indicators_trusted), for events
  and for what is told. Borrows it; NULL: they are taken as they are, and told so.
*/
LAM_EXPORT PetscErrorCode LamProcessSetReferenceResponder(LamProcess process, LamResponder *judge);
/*
  How the responder learns of walls whose moduli do not change alike: `set` is told each parameter over that at the
  start, moduli without the common factor, before it is asked. Without it such a process is PETSC_ERR_USER_INPUT.
*/
LAM_EXPORT PetscErrorCode LamProcessSetWalls(
    LamProcess process, PetscErrorCode (*set)(void *ctx, const PetscReal factor[LAM_WALL_PARAMETER_COUNT]), void *ctx);
LAM_EXPORT PetscErrorCode LamProcessSetMonitor(LamProcess process, LamProcessMonitor monitor, void *ctx);
/* Asked after each step of the integrator; NULL: never. */
LAM_EXPORT PetscErrorCode LamProcessSetStop(LamProcess process, PetscBool (*stop)(void));
/* Follows the tissue from time 0; `message` says why it ended before the end: a true reason, or none that is known. */
LAM_EXPORT PetscErrorCode LamProcessRun(LamProcess process, LamProcessReason *reason,
                                        char message[LAM_PROCESS_MESSAGE]);
LAM_EXPORT PetscErrorCode LamProcessGetCounts(LamProcess process, LamProcessCounts *counts);
LAM_EXPORT PetscErrorCode LamProcessDestroy(LamProcess *process);

/* Whether all moduli of the walls change alike, so that one database serves at all times (docs/theory/process.md). */
LAM_EXPORT PetscBool LamProcessWallsStayAlike(const LamScene *scene);

LAM_C_END

#endif
