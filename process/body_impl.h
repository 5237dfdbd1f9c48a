/*
  Private parts of a body that changes in time.

    body_water.c      water of the cells: volume of the lumens, and flows, as functions of turgor and water potentials
    body_state.c      properties and equilibrium at a time
    body_events.c     events and their locations, and reports of states
    body_integrate.c  one segment by IDA, with the body's own nonlinear solver
    body.c            creation, and time loop

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
  /* scenes with process.transport; otherwise, and where all cells meet the surroundings, no potentials */
  LamMacroTransport transport;
  PetscInt apoplast, cells_path; /* potentials: in the apoplast, from cell to cell; -1: none */
  PetscBool isolated;            /* no water reaches a cell */
  PetscReal exchange;            /* conductance between cells and the path from cell to cell, per V0 */
  PetscReal skin;                /* present conductance of a membrane, macro lengths */
  PetscReal volume;              /* of the body */
  LamWaterMode mode;
  PetscReal cj, *start, *slope;         /* for LAM_WATER_PASSES: V' = slope + cj (V - start); borrowed */
  PetscReal inflow_start, inflow_slope; /* likewise; on rank 0 */

  /* the present state */
  PetscReal *u, *pressures, *potentials, *water;
  PetscReal inflow;    /* water that has come in at the surface, over the body's volume; on rank 0 */
  LamEvaluation now;   /* properties */
  PetscReal evaluated; /* time of the present responses of the macroscale solver; NaN: unknown */
  PetscReal clock;     /* clock at the start of the present state's report */
  PetscInt told;
  PetscInt steps; /* time steps in the segment */
};

/* ---- body_water.c ---- */
PetscErrorCode LamBodyWaterCreate(LamBody body);
/* LamWaterLaw */
void LamBodyWaterLaw(void *body, PetscInt point, PetscReal turgor, const PetscReal potential[], LamWater *water);
/* Protoplast volume at a nonnegative turgor and the potentials there, and its derivative by the turgor. */
PetscReal LamBodyProtoplast(LamBody body, PetscInt point, PetscReal turgor, const PetscReal potential[],
                            PetscReal *slope);
/* dV/dt in the state evaluated last. */
PetscReal LamBodyFlow(LamBody body, PetscInt point, PetscReal water, const LamMacroPoint *at);
/* Which potentials the scene needs. Call before LamMacroSetUp. */
PetscErrorCode LamBodyTransportCreate(LamBody body);
/* Rate of the inflow in the state evaluated last. */
PetscErrorCode LamBodyInflowRate(LamBody body, PetscReal *rate);
/* Sets the drives of the water from the present properties. */
void LamBodyDrives(LamBody body);

/* ---- body_state.c ---- */
/* Sets the body's properties at a time from the kinetic states; *ok is PETSC_FALSE if the walls have no stiffness left.
 */
PetscErrorCode LamBodySetTime(LamBody body, PetscReal time, const PetscReal x[], PetscBool *ok);
LamMacroInstant LamBodyInstant(LamBody body, PetscReal time);
/* LamMacroBalance with the present surface. */
PetscErrorCode LamBodyAsk(LamBody body, const LamMacroInstant *instant, const PetscReal u[],
                          const PetscReal pressures[], const PetscReal potentials[], PetscBool *ok);
/* Dependence of water on turgor when no time passes. */
LamWaterMode LamBodyAtOnce(LamBody body);
/* Computes the water from the turgor of the present state. */
PetscErrorCode LamBodyFillWater(LamBody body);
/* Equilibrium under the conditions, from approximate u, pressures and water. If *ok, it becomes the state of the body
   and of the macroscale solver. */
PetscErrorCode LamBodyBalance(LamBody body, LamWaterMode mode, const LamMacroInstant *instant, PetscBool *ok);
/*
  The same at a time with the tissue's kinetic states. LAM_WATER_PASSES: if V and V' at the time are known to the
  accuracy of the integration, water may flow as in an implicit step. With constant water an error of V would be
  amplified to an error of the turgor by the stiffness of sealed cells.
*/
PetscErrorCode LamBodySettle(LamBody body, LamWaterMode mode, PetscReal time, PetscBool *ok);

/* ---- body_events.c ---- */
PetscInt LamBodyListEvents(LamBody body, LamEvent events[LAM_EVENT_COUNT]);
/* Event functions at the last evaluation of the macroscale solver: the maximum over the body's points. Collective. */
PetscErrorCode LamBodyExcess(LamBody body, PetscInt n, const LamEvent events[], PetscReal excess[]);
/* Turgor below this counts as lost. */
PetscReal LamBodyNoTurgor(LamBody body);
/* Reports the present state, for each of the events; NULL: at an output time. */
PetscErrorCode LamBodyReport(LamBody body, const PetscBool happened[LAM_EVENT_COUNT]);

/* ---- body_integrate.c ---- */
PetscErrorCode LamBodyIntegrate(LamBody body, PetscBool happened[LAM_EVENT_COUNT], PetscBool *ok);

#endif
