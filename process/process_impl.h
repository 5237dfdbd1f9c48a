/*
  Private parts of the process at a material point.

  process.c    life, and the way through time: segments between the times at which something changes abruptly
  program.c    what is prescribed and surrounds the tissue at a time
  evaluate.c   the tissue in a state: properties, response, flow of water, each with its derivatives
  settle.c     equilibrium at an instant
  integrate.c  one segment by IDA: residual, Jacobian, roots
  events.c     what is looked for
*/
#ifndef LAM_PROCESS_IMPL_H
#define LAM_PROCESS_IMPL_H

#include <lamella/process.h>

enum {
  LAM_PROCESS_KINETIC = LAM_CHANGING_COUNT * LAM_KINETIC_STATES, /* most states of the kinetics */
  LAM_PROCESS_UNKNOWNS = LAM_PROCESS_KINETIC + 2 + 9
};

/* A number that changes straight from `from`, at the start of the segment. */
typedef struct {
  PetscReal from, slope;
} LamRamp;

/* What happens between two times without any jump or kink. */
typedef struct {
  PetscReal start, end;
  LamRamp temperature, outside, turgor; /* turgor: where it is prescribed */
  LamRamp F[9], P[9];
  LamRamp load;       /* of a body: its load parameter */
  PetscBool given[9]; /* P is prescribed, F free */
} LamSegment;

/* The tissue, as it is kept from segment to segment. */
typedef struct {
  PetscReal time;
  PetscReal x[LAM_PROCESS_KINETIC]; /* states of the kinetic laws, two places each */
  PetscReal F[9];                   /* from the inflated state */
  PetscReal turgor, water;
  PetscReal temperature, outside; /* of what surrounds it then */
  PetscReal load;                 /* of a body */
} LamProcessTissue;

/* A property and its derivatives by the two states of its own law. */
typedef struct {
  PetscReal value, slope[LAM_KINETIC_STATES];
} LamProcessFactor;

/* All of a state that the equations need. */
typedef struct {
  PetscReal time, temperature, outside;
  LamProcessFactor factor[LAM_CHANGING_COUNT];
  PetscReal walls, cohesion;
  LamLoad load;         /* F in full, turgor, cohesion */
  LamResponse response; /* in C1 + C2 of the start */
  PetscBool ok;         /* it has fields */
} LamEvaluation;

/* The flow of water into the cells per V0 and time, and its derivatives. */
typedef struct {
  PetscReal conductance; /* of the membranes: flow = conductance * drive; infinite: drive = 0 */
  PetscReal drive, drive_water, drive_turgor, drive_solutes, drive_reflection;
  PetscReal osmotic, osmotic_water, osmotic_solutes; /* pressure in the protoplasts, and its derivatives */
} LamFlow;

/* What cells are at the start. */
typedef struct {
  PetscReal membrane;       /* area over V0, 1 / apothem */
  PetscReal water, osmotic; /* volume of the protoplasts over V0, and pressure in them */
} LamCells;

struct LamProcess_s {
  const LamScene *scene; /* borrowed */
  const LamProcessSpec *spec;
  LamResponder *responder; /* borrowed */
  LamResponder *judge;     /* borrowed; NULL: none */
  PetscErrorCode (*set_walls)(void *ctx, const PetscReal factor[LAM_WALL_PARAMETER_COUNT]);
  void *walls_ctx; /* borrowed */
  PetscReal told_walls[LAM_WALL_PARAMETER_COUNT];
  LamProcessMonitor monitor;
  void *monitor_ctx; /* borrowed */
  PetscBool (*stop)(void);

  PetscBool walls_alike;
  PetscReal inflation[9]; /* F of the tissue that is free of stress under its turgor at the start */
  LamCells cells;
  PetscReal temperature, opening; /* at the start */

  PetscReal pressure; /* the scale of pressures */

  /* on the way */
  LamProcessTissue tissue;
  LamSegment segment;
  PetscBool plasmolysed; /* the membranes have left the walls */
  PetscInt leg, cycle;   /* of the program; cycle = repeat: it is over, and its last part held */
  PetscReal leg_start, leg_F[9], leg_P[9], leg_load; /* where the present part began */
  PetscBool found[LAM_EVENT_COUNT];                  /* no longer looked for */
  PetscReal next_output;
  PetscInt64 outputs;
  LamEvaluation last;   /* the last one that the responder was asked for */
  PetscReal last_scale; /* wall factor of that */
  PetscBool last_known;
  LamResponse judged; /* the judge's last answer, where it has one (judged_known) */
  PetscBool judged_known;
  PetscReal judged_scale;
  PetscBool stopped;
  PetscErrorCode error; /* of the library, raised inside IDA */
  char trouble[192];    /* why a state had no answer */
  PetscInt snaps;
  LamProcessCounts counts;
};

/* By how much turgor falls below 0, or water exceeds the lumen, before membranes leave the walls or meet them: more
   than what the integration leaves uncertain, so that cells without turgor do not do both for ever. As a share of the
   scale. */
static inline PetscReal LamPlasmolysisTolerance(LamProcess process)
{
  return 3 * process->spec->tolerance;
}

/* Times that are nearer to each other are one: what rounding makes of sums of them. */
static inline PetscReal LamTimeTolerance(LamProcess process)
{
  return 1e-12 * process->spec->duration;
}

static inline PetscReal LamRampAt(const LamRamp *ramp, PetscReal elapsed)
{
  return ramp->from + ramp->slope * elapsed;
}

/* program.c */
/* Begins the first part of the program where the tissue is, with stress P. */
void LamProcessStartProgram(LamProcess process, const PetscReal P[9]);
/*
  The next segment from the tissue's time on, of no length where the program jumps there: in that case, and where it is
  followed to its end, LamProcessEndSegment makes what comes next the present part. P: stress of the tissue.
*/
void LamProcessNextSegment(LamProcess process, LamSegment *segment);
void LamProcessEndSegment(LamProcess process, const PetscReal P[9]);

/* evaluate.c */
/* What the tissue has become at a time of the present segment: all of `evaluation` but load and response. ratio: moduli
   C1, C2, C4 over those of the start, without the factor that they share. */
void LamProcessProperties(LamProcess process, PetscReal time, const PetscReal x[], LamEvaluation *evaluation,
                          PetscReal ratio[LAM_WALL_PARAMETER_COUNT]);
/* Tells what solves directly where moduli do not change alike; a new ratio makes all that was known of the response
   void. */
PetscErrorCode LamProcessTellWalls(LamProcess process, const PetscReal ratio[LAM_WALL_PARAMETER_COUNT]);
/* Properties and response at a time of the present segment; evaluation->ok where the response has fields. */
PetscErrorCode LamProcessEvaluate(LamProcess process, PetscReal time, const PetscReal x[], const PetscReal F[9],
                                  PetscReal turgor, LamEvaluation *evaluation);
/* The same by the judge, where the indicators of the response are not to be trusted and it has an answer. */
PetscErrorCode LamProcessQueryReference(LamProcess process, LamEvaluation *evaluation);
/* The flow into cells at a water content and turgor. */
void LamProcessFlow(LamProcess process, const LamCells *cells, const LamEvaluation *evaluation, PetscReal water,
                    PetscReal turgor, LamFlow *flow);
/* dP_i/dF_k, F counted from the inflated state. */
PetscReal LamProcessStiffness(LamProcess process, const LamEvaluation *evaluation, PetscInt i, PetscInt k);
/* dv/dF_k of the lumen, likewise. */
PetscReal LamProcessLumenSlope(LamProcess process, const LamEvaluation *evaluation, PetscInt k);
/* The whole state for the monitor. */
PetscErrorCode LamProcessDescribe(LamProcess process, const LamProcessTissue *tissue, LamProcessState *state);

/* settle.c */
typedef enum {
  LAM_SETTLE_TURGOR, /* the turgor is given, water follows */
  LAM_SETTLE_WATER,  /* the water is given: nothing has time to pass */
  LAM_SETTLE_OSMOSIS /* water is in equilibrium with the surroundings */
} LamSettle;
/*
  Equilibrium of the tissue at its time, from where it is, under the conditions of process->segment at its start; in
  steps from those of `from` where it is not NULL. *ok: found; else process->trouble says why, and the tissue is as it
  was. Where turgor is lost on the way it ends there, with a turgor below 0.
*/
PetscErrorCode LamProcessSettle(LamProcess process, LamSettle kind, const LamSegment *from, PetscBool *ok);

/* integrate.c */
/* Follows the tissue to the end of the segment, or to the next time at which something happens. */
PetscErrorCode LamProcessIntegrate(LamProcess process, PetscBool happened[LAM_EVENT_COUNT], PetscBool *ok);

/* Goes on to the next output time; infinite behind the last one. */
void LamProcessNextOutput(LamProcess process);

/* events.c */
/* The events that are looked for in this segment. */
PetscInt LamProcessListEvents(LamProcess process, LamEvent events[LAM_EVENT_COUNT]);
void LamProcessRatios(LamProcess process, const LamEvaluation *evaluation, PetscReal ratio[LAM_RATIO_COUNT]);
/* How far an event is exceeded: it happens where this rises through 0. */
PetscReal LamProcessExcess(LamProcess process, LamEvent event, const LamEvaluation *evaluation, PetscReal water,
                           PetscReal turgor);

/* process.c */
/* The tissue as it is at the start; nothing has been found or told. */
void LamProcessClear(LamProcess process);
/* Tells the monitor. */
PetscErrorCode LamProcessTell(LamProcess process, const LamProcessTissue *tissue, LamEvent event);

#endif
