/*
  Private parts of the process at a material point.

    process.c    creation, and time loop: segments between the times at which something changes abruptly
    program.c    prescribed quantities and surroundings at a time
    evaluate.c   the tissue at a state: properties, response, flow of water, each with its derivatives
    events.c     events, and reports of states
    settle.c     equilibrium at an instant
    integrator.c what a point and a body have in common in their use of IDA
    integrate.c  one segment by IDA: residual, Jacobian, roots
*/
#ifndef LAM_PROCESS_IMPL_H
#define LAM_PROCESS_IMPL_H

#include <lamella/process.h>

enum {
  LAM_PROCESS_KINETIC = LAM_CHANGING_COUNT * LAM_KINETIC_STATES, /* largest number of kinetic states */
  LAM_PROCESS_UNKNOWNS = LAM_PROCESS_KINETIC + 2 + 9
};

/* A quantity that varies linearly in time; `from`: at the start of the segment. */
typedef struct {
  PetscReal from, slope;
} LamRamp;

/* Conditions between two times without any jump or kink. */
typedef struct {
  PetscReal start, end;
  LamRamp temperature, outside, turgor; /* turgor: if it is prescribed */
  LamRamp F[9], P[9];
  LamRamp load;       /* load parameter, for a body */
  PetscBool given[9]; /* P is prescribed, F free */
} LamSegment;

/* The state of the tissue between segments. */
typedef struct {
  PetscReal time;
  PetscReal x[LAM_PROCESS_KINETIC]; /* states of the kinetic laws, two entries each */
  PetscReal F[9];                   /* relative to the inflated state */
  PetscReal turgor, water;
  PetscReal temperature, outside; /* of the surroundings at that time */
  PetscReal load;                 /* for a body */
} LamProcessTissue;

/* A property and its derivatives with respect to the two states of its own law. */
typedef struct {
  PetscReal value, slope[LAM_KINETIC_STATES];
} LamProcessFactor;

/* Evaluation of a state for the equations. */
typedef struct {
  PetscReal time, temperature, outside;
  LamProcessFactor factor[LAM_CHANGING_COUNT];
  PetscReal walls, cohesion; /* walls: C1 + C2 over that at the start */
  PetscReal unit;            /* of the responder's stresses, C1 + C2 at the start: `walls`, or 1 with law lamella */
  LamLoad load;              /* total F, turgor, cohesion */
  LamResponse response;      /* in units of C1 + C2 at the start */
  PetscBool ok;              /* the response has fields */
} LamEvaluation;

/* The flow of water into the cells per V0 and time, and its derivatives. */
typedef struct {
  PetscReal conductance; /* of the membranes: flow = conductance * drive; infinite: drive = 0 is the equation */
  PetscReal drive, drive_water, drive_turgor, drive_solutes, drive_reflection;
  PetscReal osmotic, osmotic_water, osmotic_solutes; /* osmotic pressure in the protoplasts, and its derivatives */
} LamFlow;

/* Properties of the cells at the start. */
typedef struct {
  PetscReal membrane;       /* area over V0, 1 / apothem */
  PetscReal water, osmotic; /* protoplast volume over V0, and osmotic pressure in it */
} LamCells;

struct LamProcess_s {
  const LamScene *scene; /* borrowed */
  const LamProcessSpec *spec;
  LamResponder responder; /* borrowed */
  LamResponder reference; /* borrowed; NULL: none */
  PetscErrorCode (*set_tissue)(void *ctx, const LamTissueFactors *factors);
  void *tissue_ctx;        /* borrowed */
  LamTissueFactors passed; /* last ones */
  LamProcessMonitor monitor;
  void *monitor_ctx; /* borrowed */
  PetscBool (*stop)(void);

  PetscBool changes_tissue; /* responses are of tissue that changes by more than a common factor of its walls */
  PetscBool breaks;         /* law `lamella`: responses are in C1 + C2 of the start */
  PetscBool has_history;    /* this or walls with memory: responses are of the states accepted before, ... */
  PetscReal accepted;       /* ... at this time; before the start for ever */
  PetscReal inflation[9];   /* F of the stress-free tissue under its turgor at the start */
  LamCells cells;
  PetscReal temperature, opening; /* at the start */

  PetscReal pressure; /* scale of pressures */

  /* time integration */
  LamProcessTissue tissue;
  LamSegment segment;
  PetscBool plasmolysed; /* the membranes are detached from the walls */
  PetscInt leg,
      cycle; /* part of the program, and its repetition; cycle = repeat: it is over, and its last part is held */
  PetscReal leg_start, leg_F[9], leg_P[9], leg_load; /* state at which the present part began */
  PetscBool found[LAM_EVENT_COUNT];                  /* events that are no longer searched for */
  PetscReal next_output;
  LamEvaluation last;  /* last evaluation for which the responder was queried */
  PetscReal last_unit; /* of that evaluation */
  PetscBool last_known;
  LamResponse reference_response; /* last one of the reference responder, valid if reference_response_known */
  PetscBool reference_response_known;
  PetscReal reference_response_unit;
  PetscBool stopped;
  PetscErrorCode error; /* of the library, raised inside IDA */
  char trouble[192];    /* why a state has no response */
  PetscInt snaps;
  LamProcessCounts counts;
};

/* Plasmolysis tolerance, relative to the scale: by how much turgor falls below 0 before membranes leave the walls, and
   by how much water exceeds the lumen before they meet again. It exceeds the integration error, so that cells without
   turgor do not alternate between both states. */
static inline PetscReal LamPlasmolysisTolerance(LamProcess process)
{
  return 3 * process->spec->tolerance;
}

/* Time tolerance: times closer than this count as equal, since sums of times are rounded. */
static inline PetscReal LamTimeTolerance(LamProcess process)
{
  return 1e-12 * process->spec->duration;
}

static inline PetscReal LamRampAt(const LamRamp *ramp, PetscReal elapsed)
{
  return ramp->from + ramp->slope * elapsed;
}

/* program.c */
/* Checks the walls, resets to the tissue at the start, without events or counts, and enters the first segment. */
PetscErrorCode LamProcessBegin(LamProcess process);
/* Starts the first part of the program at the present state of the tissue, with stress P. */
void LamProcessStartProgram(LamProcess process, const PetscReal P[9]);
/*
  The next segment from the tissue's time on; its length is zero if the program jumps there. In that case, and if the
  segment is integrated to its end, LamProcessEndSegment advances to the next part of the program. P: stress of the
  tissue.
*/
void LamProcessNextSegment(LamProcess process, LamSegment *segment);
void LamProcessEndSegment(LamProcess process, const PetscReal P[9]);

/* evaluate.c */
/* Sets all of `evaluation` except load and response, at a time of the present segment. factors: those of the tissue in
   the evaluation's unit. */
void LamProcessProperties(LamProcess process, PetscReal time, const PetscReal x[], LamEvaluation *evaluation,
                          LamTissueFactors *factors);
/* Passes changed factors to set_tissue, if more changes than the unit. They invalidate the stored response. */
PetscErrorCode LamProcessPassTissue(LamProcess process, const LamTissueFactors *factors);
/* Accepts the responder's states at the present state of the tissue, at which it is queried once more if it has a
   history: the last query may have been another. */
PetscErrorCode LamProcessAccept(LamProcess process);
/* Properties and response at a time of the present segment; evaluation->ok: the response has fields. */
PetscErrorCode LamProcessEvaluate(LamProcess process, PetscReal time, const PetscReal x[], const PetscReal F[9],
                                  PetscReal turgor, LamEvaluation *evaluation);
/* Replaces the response by that of the reference responder if its indicators are not trusted and the reference has a
   response. */
PetscErrorCode LamProcessQueryReference(LamProcess process, LamEvaluation *evaluation);
/* Flow of water into the cells at a water content and turgor. */
void LamProcessFlow(LamProcess process, const LamCells *cells, const LamEvaluation *evaluation, PetscReal water,
                    PetscReal turgor, LamFlow *flow);
/* dP_i/dF_k, with F relative to the inflated state. */
PetscReal LamProcessStiffness(LamProcess process, const LamEvaluation *evaluation, PetscInt i, PetscInt k);
/* dv/dF_k of the lumen, with F relative to the inflated state. */
PetscReal LamProcessLumenSlope(LamProcess process, const LamEvaluation *evaluation, PetscInt k);
/* rate [LAM_PROCESS_KINETIC]: dx/dt of all laws; J [LAM_CHANGING_COUNT]: its derivatives, not set without states. */
void LamProcessRates(LamProcess process, PetscReal temperature, const PetscReal x[], PetscReal rate[],
                     PetscReal J[][LAM_KINETIC_STATES][LAM_KINETIC_STATES]);

/* settle.c */
typedef enum {
  LAM_SETTLE_TURGOR, /* turgor is prescribed, water follows */
  LAM_SETTLE_WATER,  /* the water content is constant: no time passes */
  LAM_SETTLE_OSMOSIS /* water is in equilibrium with the surroundings */
} LamSettle;
/*
  Equilibrium of the tissue at its present time, from its present state, under the conditions at the start of
  process->segment; in steps from the conditions `from` if not NULL. If not *ok, process->trouble says why and the
  tissue is unchanged. If turgor is lost during the steps, it stops there with a turgor below 0.
*/
PetscErrorCode LamProcessSettle(LamProcess process, LamSettle kind, const LamSegment *from, PetscBool *ok);

/* integrate.c */
/* Integrates the tissue to the end of the segment, or to the next event. */
PetscErrorCode LamProcessIntegrate(LamProcess process, PetscBool happened[LAM_EVENT_COUNT], PetscBool *ok);

/* events.c */
/* Lists the events that are searched for in this segment. */
PetscInt LamProcessListEvents(LamProcess process, LamEvent events[LAM_EVENT_COUNT]);
/* Indicators of a material point that events and ratios are about. */
typedef struct {
  PetscReal normal, shear, wall, opening;
  PetscInt percolating;
} LamEventMeasures;
void LamProcessRatios(LamProcess process, const LamProcessFactor factor[], const LamEventMeasures *measures,
                      PetscReal ratio[LAM_RATIO_COUNT]);
/* Event function: the event occurs when it rises through 0. Of the measures alone, `opening` at the start; -1 for other
   events. */
PetscReal LamProcessMeasureExcess(LamProcess process, LamEvent event, const LamProcessFactor factor[],
                                  const LamEventMeasures *measures, PetscReal opening);
/* Of a material point. */
PetscReal LamProcessExcess(LamProcess process, LamEvent event, const LamEvaluation *evaluation, PetscReal water,
                           PetscReal turgor);
/* Reports a state to the monitor. */
PetscErrorCode LamProcessReport(LamProcess process, const LamProcessTissue *tissue, LamEvent event);
/* Advances to the next output time; infinite after the last one. */
void LamProcessNextOutput(LamProcess process);
/* Between outputs in the present part of the program; s. */
PetscReal LamProcessOutputInterval(LamProcess process);

#endif
