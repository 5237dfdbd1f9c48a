/*
  Tissue that changes in time at one material point: kinetics of lamella, walls and membranes, water exchange, and a
  load program, integrated by IDA of SUNDIALS.

    LamProcessCreate(scene, &process); LamProcessSetResponder(process, &responder);
    LamProcessSetMonitor(process, monitor, ctx); LamProcessSetStop(process, stop);
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

/* Events. Each is located where it first occurs; turgor may be lost and regained repeatedly. */
#define LAM_EVENTS(X)                                                                                                  \
  X(LAM_EVENT_LAMELLA_NORMAL, "lamella_normal") /* bonded: max_traction reaches the strength of the lamella */         \
  X(LAM_EVENT_LAMELLA_SHEAR, "lamella_shear")   /* bonded: max_lamella_shear reaches the strength */                   \
  X(LAM_EVENT_WALL, "wall_rupture")             /* max_wall_tension reaches the strength of the walls */               \
  X(LAM_EVENT_OPENING, "opening")               /* contact: opening_fraction has increased by process.opening */       \
  X(LAM_EVENT_PERCOLATION, "percolation")       /* contact: connected cells no longer span the tissue */               \
  X(LAM_EVENT_TURGOR_LOST, "turgor_lost")       /* turgor has fallen to 0: membranes leave the walls */                \
  X(LAM_EVENT_TURGOR_FOUND, "turgor_found")     /* the protoplast fills the lumen again */                             \
  X(LAM_EVENT_SNAP, "snap")                     /* the tissue jumps to another equilibrium; may recur */               \
  X(LAM_EVENT_LIMIT, "limit_point")             /* the stiffness of the free components falls to 0 */
#define LAM_EVENT_ENTRY(symbol, name) symbol,
typedef enum { LAM_EVENTS(LAM_EVENT_ENTRY) LAM_EVENT_COUNT } LamEvent;
#undef LAM_EVENT_ENTRY
LAM_EXPORT extern const char *const LamEventNames[];

/* Stresses of walls and lamella over their current strengths; 1: failure. NaN if no strength is given. */
#define LAM_RATIOS(X)                                                                                                  \
  X(LAM_RATIO_LAMELLA_NORMAL, "lamella_normal")                                                                        \
  X(LAM_RATIO_LAMELLA_SHEAR, "lamella_shear")                                                                          \
  X(LAM_RATIO_WALL, "wall")
#define LAM_RATIO_ENTRY(symbol, name) symbol,
typedef enum { LAM_RATIOS(LAM_RATIO_ENTRY) LAM_RATIO_COUNT } LamRatio;
#undef LAM_RATIO_ENTRY
LAM_EXPORT extern const char *const LamRatioNames[];

/* State of the tissue at a time. Stresses in the initial C1 + C2, which is in the scene's scales. */
typedef struct {
  PetscReal time;                       /* s */
  PetscReal temperature;                /* K */
  PetscReal factor[LAM_CHANGING_COUNT]; /* relative to the initial value */
  PetscReal walls;                      /* C1 + C2 over the initial value */
  PetscReal F[9];                       /* relative to the inflated state */
  PetscReal turgor, cohesion;
  PetscReal water;    /* volume of the protoplasts over V0; NaN without a water balance */
  PetscReal osmotic;  /* osmotic pressure in the protoplasts; likewise */
  PetscReal outside;  /* osmotic pressure outside */
  PetscReal firmness; /* dP11/dF11 at constant P22, without water exchange: Young's modulus of a fast test */
  PetscReal ratio[LAM_RATIO_COUNT];
  LamResponse response;
  LamEvent event; /* LAM_EVENT_COUNT: an output time without event */
} LamProcessState;

typedef struct {
  PetscInt64 steps, residuals, jacobians, restarts; /* of the integrator */
  PetscInt64 questions;                             /* queries of the responder */
} LamProcessCounts;

typedef enum { LAM_PROCESS_DONE, LAM_PROCESS_STOPPED, LAM_PROCESS_ENDED } LamProcessReason;

#define LAM_PROCESS_MESSAGE 400

/* Called for each output time and each event, in order of time. */
typedef PetscErrorCode (*LamProcessMonitor)(const LamProcessState *state, void *ctx);

/* Borrows the scene, which must have a block `process`. */
LAM_EXPORT PetscErrorCode LamProcessCreate(const LamScene *scene, LamProcess *process);
/* Borrows it; queries use point 0. */
LAM_EXPORT PetscErrorCode LamProcessSetResponder(LamProcess process, LamResponder responder);
/*
  A second responder that solves. It replaces responses whose indicators are not trusted (indicators_trusted), for
  events and output. Borrows it; NULL: such responses are used and reported as not trusted.
*/
LAM_EXPORT PetscErrorCode LamProcessSetReferenceResponder(LamProcess process, LamResponder reference);
/* Properties over their values at the start. */
typedef struct {
  PetscReal walls[LAM_WALL_PARAMETER_COUNT];
  PetscReal lamella, wall_strength; /* of strengths and energies of the lamella and of walls that tear */
} LamTissueFactors;
/* Of a tissue at factors of what changes. Returns the unit of its stresses, in C1 + C2 at the start: its own C1 + C2,
   and factors->walls is without that common factor; with law `lamella` 1. */
LAM_EXPORT PetscReal LamProcessTissueFactors(const LamScene *scene, const PetscReal factor[LAM_CHANGING_COUNT],
                                             LamTissueFactors *factors);
/*
  Sets the callback for walls whose moduli do not change by a common factor, and for tissue with law `lamella`: before
  queries `set` receives the factors; without a lamella, moduli without the common factor. Without the callback such a
  process is PETSC_ERR_USER_INPUT.
*/
LAM_EXPORT PetscErrorCode LamProcessSetTissue(LamProcess process,
                                              PetscErrorCode (*set)(void *ctx, const LamTissueFactors *factors),
                                              void *ctx);
LAM_EXPORT PetscErrorCode LamProcessSetMonitor(LamProcess process, LamProcessMonitor monitor, void *ctx);
/* Called after each step of the integrator; NULL: never. */
LAM_EXPORT PetscErrorCode LamProcessSetStop(LamProcess process, PetscBool (*stop)(void));
/* Integrates from time 0. `message`: why it ended early, as far as known. */
LAM_EXPORT PetscErrorCode LamProcessRun(LamProcess process, LamProcessReason *reason,
                                        char message[LAM_PROCESS_MESSAGE]);
LAM_EXPORT PetscErrorCode LamProcessGetCounts(LamProcess process, LamProcessCounts *counts);
LAM_EXPORT PetscErrorCode LamProcessDestroy(LamProcess *process);

/* True if all wall moduli change by a common factor, so that one database is valid at all times
   (docs/theory/process.md). */
LAM_EXPORT PetscBool LamProcessWallsStayAlike(const LamScene *scene);

LAM_C_END

#endif
