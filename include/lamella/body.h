/*
  A body whose tissue changes in time: kinetics, water exchange and a load program as at one material point
  (process.h), coupled by the equilibrium of the body (macro.h) and integrated together by IDA of SUNDIALS.

    LamMacroCreate(comm, &macro); LamMacroSetScene(macro, scene);
    LamBodyCreate(scene, macro, &body); LamMacroSetUp(macro);
    LamMacroSetResponder(macro, &responder); LamBodySetMonitor(body, monitor, ctx);
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

/* State of the body at a time. Stresses in the initial C1 + C2. */
typedef struct {
  PetscInt number; /* of the report, from 0 */
  PetscReal time;  /* s */
  PetscReal temperature, outside;
  PetscReal factor[LAM_CHANGING_COUNT]; /* relative to the initial value; all tissue follows the same laws */
  PetscReal walls;                      /* C1 + C2 over the initial value */
  PetscReal load;                       /* load parameter */
  PetscReal water;  /* volume of all protoplasts over the initial value; NaN without a water balance */
  PetscReal inflow; /* water that has come in at the surface, over that of all protoplasts at the start; NaN unless
                       water moves through the body (process.transport) */
  PetscReal water_balance;          /* water - 1 - inflow: error of the balance */
  PetscReal turgor_min, turgor_max; /* over the material points */
  PetscReal plasmolysed; /* fraction of the body's volume that has lost turgor; NaN without a water balance */
  PetscReal ratio[LAM_RATIO_COUNT]; /* maximum over the material points */
  LamEvent event;                   /* LAM_EVENT_COUNT: an output time without event */
  PetscInt element, point; /* location of the event: element of the undistributed mesh, index of the point in it, */
  PetscReal place[2];      /* and its reference position, macro lengths */
  LamMacroStep step;       /* reactions, indicators, counts since the previous state */
} LamBodyState;

/* Called on all ranks for each output time and each event, in order of time; the body is in this state. */
typedef PetscErrorCode (*LamBodyMonitor)(const LamBodyState *state, void *ctx);

/* Borrows both; the scene must have the blocks `process` and `macro`. Call before LamMacroSetUp. */
LAM_EXPORT PetscErrorCode LamBodyCreate(const LamScene *scene, LamMacro macro, LamBody *body);
/* Sets the membrane area over V0 at this rank's points, [point], in 1 over the scene's apothem. Default: that of the
   scene's tissue. Call after LamMacroSetUp; collective. */
LAM_EXPORT PetscErrorCode LamBodySetMembranes(LamBody body, const PetscReal membrane[]);
/* Membrane area over V0 of a tissue, in 1 over its own apothem. */
LAM_EXPORT PetscReal LamMembraneArea(const LamMicrostructure *micro);
/* As LamProcessSetTissue. */
LAM_EXPORT PetscErrorCode LamBodySetTissue(LamBody body,
                                           PetscErrorCode (*set)(void *ctx, const LamTissueFactors *factors),
                                           void *ctx);
LAM_EXPORT PetscErrorCode LamBodySetMonitor(LamBody body, LamBodyMonitor monitor, void *ctx);
/* Integrates from time 0; LamMacroSetStop can stop it. `message`: why it ended early. Collective. */
LAM_EXPORT PetscErrorCode LamBodyRun(LamBody body, LamProcessReason *reason, char message[LAM_PROCESS_MESSAGE]);
/* `questions`: number of evaluations of all material points. */
LAM_EXPORT PetscErrorCode LamBodyGetCounts(LamBody body, LamProcessCounts *counts);
LAM_EXPORT PetscErrorCode LamBodyDestroy(LamBody *body);

LAM_C_END

#endif
