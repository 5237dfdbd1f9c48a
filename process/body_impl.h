/*
  Private parts of a body that changes in time.

    body.c            creation, and time loop
    body_water.c      water of the cells: prescribed volume of the lumens as a function of turgor
    body_integrate.c  one segment by IDA, with the body's own nonlinear solver
    body_events.c     events and their locations

  Program, surroundings and kinetics are those of process_impl.h.
*/
#ifndef LAM_BODY_IMPL_H
#define LAM_BODY_IMPL_H

#include "process_impl.h"
#include <lamella/body.h>

/* Dependence of a point's water on its turgor. */
typedef enum {
  LAM_WATER_GIVEN,  /* constant water: no time passes */
  LAM_WATER_PASSES, /* implicit time step */
  LAM_WATER_OSMOSIS /* in equilibrium with the surroundings */
} LamWaterMode;

/* At a point at the present time: osmotic pressure solutes / (V - dead), flow conductance (sigma (pi - outside) - p).
 */
typedef struct {
  PetscReal conductance, solutes, dead;
} LamDrive;

struct LamBody_s {
  MPI_Comm comm;
  PetscMPIInt rank;
  LamMacro macro;     /* borrowed */
  LamProcess process; /* program, surroundings, kinetics, time */
  LamBodyMonitor monitor;
  void *monitor_ctx; /* borrowed */

  LamMacroSizes sizes;
  PetscReal *share;       /* [point] volume fraction of the body */
  PetscReal *membrane;    /* [point] */
  LamCells *cells;        /* [point] */
  PetscReal *opening;     /* [point] opening volume at the start */
  PetscReal turgor_share; /* present prescribed turgor relative to that of the start */
  PetscReal sigma;        /* present reflection coefficient */
  LamDrive *drive;        /* [point] */
  LamWaterMode mode;
  PetscReal cj, *start, *slope; /* for LAM_WATER_PASSES: V' = slope + cj (V - start); borrowed */

  /* the present state */
  PetscReal *u, *pressures, *water;
  LamEvaluation now;   /* properties */
  PetscReal evaluated; /* time of the present responses of the macroscale solver; NaN: unknown */
  PetscReal clock;     /* clock at the start of the present state's report */
  PetscInt told;
  PetscInt steps; /* time steps in the segment */
};

/* ---- body_water.c ---- */
PetscErrorCode LamBodyWaterCreate(LamBody body);
/* LamWaterLaw */
void LamBodyWaterLaw(void *body, PetscInt point, PetscReal turgor, PetscReal *water, PetscReal *slope);
/* Protoplast volume at a nonnegative turgor, and its derivative. */
PetscReal LamBodyProtoplast(LamBody body, PetscInt point, PetscReal turgor, PetscReal *slope);
/* dV/dt at a turgor. */
PetscReal LamBodyFlow(LamBody body, PetscInt point, PetscReal water, PetscReal turgor);
/* Sets the drives of the water from the present properties. */
void LamBodyDrives(LamBody body);

/* ---- body.c ---- */
/* Sets the body's properties at a time from the kinetic states; *ok is PETSC_FALSE if the walls have no stiffness left.
 */
PetscErrorCode LamBodySetTime(LamBody body, PetscReal time, const PetscReal x[], PetscBool *ok);
LamMacroInstant LamBodyInstant(LamBody body, PetscReal time);
/*
  Equilibrium at a time, from approximate u, pressures, water and kinetic states; no water flows. If *ok, it becomes
  the state of the body and of the macroscale solver.
*/
PetscErrorCode LamBodySettle(LamBody body, PetscReal time, PetscBool *ok);
/*
  As LamBodySettle, if V and V' at the time are known to the accuracy of the integration: start and slope [point].
  Water may flow as in an implicit step with coefficient c, V' = slope + c (V - start). With constant water an error
  of V would be amplified to an error of the turgor by the stiffness of sealed cells.
*/
PetscErrorCode LamBodySettleStep(LamBody body, PetscReal time, PetscReal c, PetscReal start[], PetscReal slope[],
                                 PetscBool *ok);
/* Computes the water from the turgor of the present state. */
PetscErrorCode LamBodyFillWater(LamBody body);
/* Dependence of water on turgor when no time passes. */
LamWaterMode LamBodyAtOnce(LamBody body);
PetscErrorCode LamBodyTell(LamBody body, const PetscBool happened[LAM_EVENT_COUNT]);

/* ---- body_integrate.c ---- */
PetscErrorCode LamBodyIntegrate(LamBody body, PetscBool happened[LAM_EVENT_COUNT], PetscBool *ok);

/* ---- body_events.c ---- */
PetscInt LamBodyListEvents(LamBody body, LamEvent events[LAM_EVENT_COUNT]);
/* Evaluates the event functions at the last evaluation of the macroscale solver: the maximum over this rank's points;
   points [n]: where. The caller reduces over the ranks. */
PetscErrorCode LamBodyExcess(LamBody body, PetscInt n, const LamEvent events[], PetscReal excess[], PetscInt points[]);
/* Turgor below this counts as lost. */
PetscReal LamBodyNoTurgor(LamBody body);

#endif
