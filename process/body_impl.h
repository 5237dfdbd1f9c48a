/*
  Private parts of a body that changes in time.

  body.c            life, and the way through time
  body_water.c      water of the cells: what their lumens are to hold at a turgor
  body_integrate.c  one segment by IDA, whose nonlinear solver is the body's own
  body_events.c     what is looked for, and where it is

  Program, surroundings and kinetics are those of process_impl.h.
*/
#ifndef LAM_BODY_IMPL_H
#define LAM_BODY_IMPL_H

#include "process_impl.h"
#include <lamella/body.h>

/* How the water of a point follows from its turgor. */
typedef enum {
  LAM_WATER_GIVEN,  /* it does not: nothing has time to pass */
  LAM_WATER_PASSES, /* in an implicit step of time */
  LAM_WATER_OSMOSIS /* in equilibrium with the surroundings */
} LamWaterMode;

/* Of a point at the present time: osmotic pressure solutes / (V - dead), flow conductance (sigma (pi - outside) - p).
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
  PetscReal *share;       /* [point] of the body's volume */
  PetscReal *membrane;    /* [point] */
  LamCells *cells;        /* [point] */
  PetscReal *opening;     /* [point] opening volume at the start */
  PetscReal turgor_share; /* turgor that is prescribed now, over that of the start */
  PetscReal sigma;        /* reflection now */
  LamDrive *drive;        /* [point] */
  LamWaterMode mode;
  PetscReal cj, *start, *slope; /* LAM_WATER_PASSES: V' = slope + cj (V - start); borrowed */

  /* the present state */
  PetscReal *u, *pressures, *water;
  LamEvaluation now;   /* properties */
  PetscReal evaluated; /* time to which the responses of the macroscale solver belong; NaN: unknown */
  PetscReal clock;     /* when the report of the present state began */
  PetscInt told;
  PetscInt steps; /* of time in the segment */
};

/* ---- body_water.c ---- */
PetscErrorCode LamBodyWaterCreate(LamBody body);
/* LamWaterLaw */
void LamBodyWaterLaw(void *body, PetscInt point, PetscReal turgor, PetscReal *water, PetscReal *slope);
/* Volume of the protoplast at a turgor that is not negative, and its derivative. */
PetscReal LamBodyProtoplast(LamBody body, PetscInt point, PetscReal turgor, PetscReal *slope);
/* dV/dt at a turgor. */
PetscReal LamBodyFlow(LamBody body, PetscInt point, PetscReal water, PetscReal turgor);
/* What drives the water with the present properties. */
void LamBodyDrives(LamBody body);

/* ---- body.c ---- */
/* Properties at a time, from the kinetic states, for the body; *ok: PETSC_FALSE where nothing is left of the walls. */
PetscErrorCode LamBodySetTime(LamBody body, PetscReal time, const PetscReal x[], PetscBool *ok);
LamMacroInstant LamBodyInstant(LamBody body, PetscReal time);
/*
  The state at a time from u, pressures, water and kinetic states that are nearly so: in equilibrium, without water
  passing. *ok: found; it is then that of the body and of the macroscale solver.
*/
PetscErrorCode LamBodySettle(LamBody body, PetscReal time, PetscBool *ok);
/*
  The same where V and V' at the time are known as well as the integration knows them, start and slope [point]: water
  may still pass as in an implicit step of the coefficient c, V' = slope + c (V - start). An error of V would else
  become one of the turgor as large as cells are stiff that keep their water.
*/
PetscErrorCode LamBodySettleStep(LamBody body, PetscReal time, PetscReal c, PetscReal start[], PetscReal slope[],
                                 PetscBool *ok);
/* The water that follows from the turgor of the present state. */
PetscErrorCode LamBodyFillWater(LamBody body);
/* How water follows where nothing has time to pass. */
LamWaterMode LamBodyAtOnce(LamBody body);
PetscErrorCode LamBodyTell(LamBody body, const PetscBool happened[LAM_EVENT_COUNT]);

/* ---- body_integrate.c ---- */
PetscErrorCode LamBodyIntegrate(LamBody body, PetscBool happened[LAM_EVENT_COUNT], PetscBool *ok);

/* ---- body_events.c ---- */
PetscInt LamBodyListEvents(LamBody body, LamEvent events[LAM_EVENT_COUNT]);
/* How far events are exceeded where they are most, in what the macroscale solver has evaluated; points [n]: there on
   this rank. Not yet of all ranks. */
PetscErrorCode LamBodyExcess(LamBody body, PetscInt n, const LamEvent events[], PetscReal excess[], PetscInt points[]);
/* Turgor below this is lost. */
PetscReal LamBodyNoTurgor(LamBody body);

#endif
