/*
  A body whose tissue changes in time: kinetics, exchange of water and a load program as at one material point
  (process.h), coupled by the equilibrium of the body (macro.h) and integrated together by IDA of SUNDIALS.

    LamMacroCreate(comm, &macro); LamMacroSetScene(macro, scene);
    LamBodyCreate(scene, macro, &body); LamMacroSetUp(macro);
    LamMacroSetResponder(macro, &responder); LamBodySetMonitor(body, told, ctx);
    LamBodyRun(body, &reason, message); LamBodyDestroy(&body); LamMacroDestroy(&macro);

  Equations: docs/theory/process.md, Processes of bodies.
*/
#ifndef LAMELLA_BODY_H
#define LAMELLA_BODY_H

#include <lamella/macro.h>
#include <lamella/process.h>
#include <lamella/export.h>

LAM_C_BEGIN

typedef struct LamBody_s *LamBody;

/* The body at a time. Stresses in the C1 + C2 of the start. */
typedef struct {
  PetscInt number; /* of what is told, from 0 */
  PetscReal time;  /* s */
  PetscReal temperature, outside;
  PetscReal factor[LAM_CHANGING_COUNT]; /* of what it was at the start; all tissue follows the same laws */
  PetscReal walls;                      /* C1 + C2 over that at the start */
  PetscReal load;                       /* load parameter */
  PetscReal water;                      /* of all protoplasts over that at the start; NaN where it is not followed */
  PetscReal turgor_min, turgor_max;     /* of the material points */
  PetscReal plasmolysed;                /* share of the body's volume whose turgor is lost; NaN as water */
  PetscReal ratio[LAM_RATIO_COUNT];     /* largest of the material points */
  LamEvent event;                       /* LAM_EVENT_COUNT: none, a time of the output */
  PetscInt element, point;              /* where it happens: element of the undistributed mesh, which of its points, */
  PetscReal place[2];                   /* and its reference place, macro lengths */
  LamMacroStep step;                    /* reactions, indicators, counts since the state before */
} LamBodyState;

/* Called on all ranks for each output time and each event, in the order of time; the body is in this state. */
typedef PetscErrorCode (*LamBodyMonitor)(const LamBodyState *state, void *ctx);

/* Borrows both; the scene has the blocks `process` and `macro`. Before LamMacroSetUp. */
LAM_EXPORT PetscErrorCode LamBodyCreate(const LamScene *scene, LamMacro macro, LamBody *body);
/* Area of the membranes over V0 at this rank's points, [point] in 1 over the scene's apothem; where this is not called
   it is that of the scene's tissue. After LamMacroSetUp; collective. */
LAM_EXPORT PetscErrorCode LamBodySetMembranes(LamBody body, const PetscReal membrane[]);
/* That of a tissue, in 1 over its own apothem. */
LAM_EXPORT PetscReal LamMembraneArea(const LamMicrostructure *micro);
/* As LamProcessSetWalls. */
LAM_EXPORT PetscErrorCode LamBodySetWalls(
    LamBody body, PetscErrorCode (*set)(void *ctx, const PetscReal factor[LAM_WALL_PARAMETER_COUNT]), void *ctx);
LAM_EXPORT PetscErrorCode LamBodySetMonitor(LamBody body, LamBodyMonitor monitor, void *ctx);
/* Follows the body from time 0; a stop is that of LamMacroSetStop. `message` says why it ended before the end.
   Collective. */
LAM_EXPORT PetscErrorCode LamBodyRun(LamBody body, LamProcessReason *reason, char message[LAM_PROCESS_MESSAGE]);
/* `questions`: evaluations of all material points together. */
LAM_EXPORT PetscErrorCode LamBodyGetCounts(LamBody body, LamProcessCounts *counts);
LAM_EXPORT PetscErrorCode LamBodyDestroy(LamBody *body);

LAM_C_END

#endif
