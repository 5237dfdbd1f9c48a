/*
  lamella tradeoff: error against time for every parameter that trades one for the other.

    tradeoff_settings.c   settings of a scene, and states to solve with each
    tradeoff_measure.c    one run of a setting, by an RVE, a table, or the macroscale problem
    tradeoff_reference.c  reference responses, finer than all settings
    tradeoff_judge.c      errors, spread of times, the best settings
    tradeoff_run.c        order of the runs and time budget

  In src/app: cmd_tradeoff.c (report and files), tradeoff_plot.c (the work-precision diagram).

  Errors and settings follow the work-precision diagrams of SciML (C. Rackauckas and Q. Nie, J. Open Res. Softw. 5
  (2017) 15): all settings get the same queries, start from scratch, in interleaved rounds on one machine; failed runs
  are left out and reported; the reference is finer than the settings that are ranked.
*/
#ifndef LAM_TRADEOFF_H
#define LAM_TRADEOFF_H

#include "fe2_run.h"
#include "mechanical_test.h"

#define LAM_KNOBS(X)                                                                                                   \
  X(LAM_KNOB_MESH, "mesh")           /* elements along a face, through a wall, grading */                              \
  X(LAM_KNOB_STRATEGY, "strategy")   /* contact reached in one step or two */                                          \
  X(LAM_KNOB_SHARPNESS, "sharpness") /* the exact law of contact, and widths of the smooth one */                      \
  X(LAM_KNOB_CELLS, "cells")         /* per period */                                                                  \
  X(LAM_KNOB_TOLERANCE, "tolerance") /* of the Newton iterations */                                                    \
  X(LAM_KNOB_DATABASE, "database")   /* accuracy of a table */                                                         \
  X(LAM_KNOB_MACRO, "macro")         /* responder of a body's material points */
typedef enum { LAM_KNOBS(LAM_ENUM_ENTRY) LAM_KNOB_COUNT } LamKnob;
extern const char *const LamKnobNames[];

#define LAM_ERROR_KINDS(X)                                                                                             \
  X(LAM_ERROR_P, "P")             /* LamStressError */                                                                 \
  X(LAM_ERROR_TANGENT, "tangent") /* relative, Frobenius norm */                                                       \
  X(LAM_ERROR_OPENING, "opening") /* difference of the opening fraction; for bonded tissue of the lumen fraction */    \
  X(LAM_ERROR_MACRO, "macro")     /* of reactions and work at the last step, relative */
typedef enum { LAM_ERROR_KINDS(LAM_ENUM_ENTRY) LAM_ERROR_KIND_COUNT } LamErrorKind;
extern const char *const LamErrorNames[];

/* A setting of one parameter. */
typedef struct {
  LamKnob knob;
  char label[48];          /* "12 x 4, graded 0.6" */
  char mark[16];           /* label of its point in the diagram: "12" */
  LamMicrostructure micro; /* its mesh and cells; borrows the cells of the scene */
  LamStrategy strategy;
  PetscReal tolerance;
  PetscReal accuracy;      /* of a table or a cache; 0: neither */
  LamFE2Response response; /* of a body's material points */
  PetscBool planned;       /* the values of the scene and the planner */
} LamSetting;

/* The states to be solved. */
typedef struct {
  PetscInt n;
  LamLoad *loads;     /* owned */
  PetscBool chained;  /* each starts from the previous one, else from the undeformed tissue */
  PetscInt dropped;   /* number of states of the scene's load omitted because the planned mesh cannot reach their
                         prescribed stress */
  const char *origin; /* "load", "sample", "default" */
  PetscBool *skip;    /* [n]: state is not solved; owned */
} LamStates;

/* The last step of a body. */
typedef struct {
  PetscInt boundaries;
  PetscReal reaction[LAM_MAX_BOUNDARIES][2], work;
} LamMacroOutcome;

typedef struct {
  PetscReal median, low, high;
} LamSpread;

typedef struct {
  PetscReal largest, mean; /* over the states; NaN: not known */
  PetscBool resolved;      /* error at least ten times that of the reference */
  PetscBool optimal;       /* no other resolved setting has a smaller error in less time */
} LamMeasuredError;

#define LAM_MOST_REPEATS 100
typedef struct {
  LamSetting setting;
  PetscInt unknowns;               /* of one RVE */
  PetscInt nodes;                  /* of a table; 0: none */
  PetscInt runs;                   /* number of runs; 0: left out */
  PetscReal *cpu, *wall;           /* [runs] seconds, everything included; owned, room for LAM_MOST_REPEATS */
  PetscReal *state_cpu;            /* [runs] CPU seconds per state for solves or queries, on average; owned, likewise */
  PetscReal build_cpu, build_wall; /* last construction of the table, or of the table that a body queries */
  PetscBool stopped;               /* by the time limit, or a signal */
  LamResponse *responses; /* [states], if runs > 0 all converged or, not solved, LAM_OUT_OF_REACH; NULL: none; owned */
  LamMacroOutcome outcome;
  char reason[192]; /* why it is left out; empty: it is not */

  /* set by LamJudge */
  LamSpread cpu_spread, wall_spread;
  LamMeasuredError error[LAM_ERROR_KIND_COUNT];
  PetscReal from_plan; /* largest difference of P to the planned setting, or for a body to the direct response */
} LamMeasurement;

/* Responses on a fine mesh, and their difference to those of the next coarser one. */
typedef struct {
  LamMicrostructure micro, other;        /* the finest mesh, and the one used for its error estimate; borrow cells */
  LamResponse *responses;                /* [states]; owned */
  PetscBool *used;                       /* [states]: included in the errors; owned */
  PetscInt used_count;                   /* 0: there is no reference */
  PetscInt known_count;                  /* states that converged on both meshes */
  PetscReal *difference;                 /* [states] of P between the two meshes; NaN: one did not converge; owned */
  PetscReal error[LAM_ERROR_KIND_COUNT]; /* largest difference between the two over the states used; NaN: not known */
  PetscReal cpu;                         /* seconds on the finest mesh */
} LamReference;

/* ---- tradeoff_settings.c ---- */
/* Whether a parameter trades error for time in the scene (with mesh chosen); *why gives the reason if not. */
PetscBool LamKnobApplies(const LamScene *scene, LamKnob knob, const char **why);
/* All settings of a parameter; the caller frees. */
PetscErrorCode LamSettingsMake(const LamScene *scene, LamKnob knob, PetscInt *n, LamSetting **settings);
PetscErrorCode LamStatesMake(LamScene *scene, LamStates *states);
PetscInt LamStatesCount(const LamStates *states); /* without those skipped */

/* ---- tradeoff_measure.c ---- */
PetscErrorCode LamMeasurementInit(const LamSetting *setting, LamMeasurement *m);
PetscErrorCode LamMeasurementDestroy(LamMeasurement *m);
/* Adds a run to m: for a repeat its times; an interrupted one is dropped. Destroys or moves `run`. */
PetscErrorCode LamMeasurementTake(LamMeasurement *run, LamMeasurement *m);
/* CPU time of all threads of the process, and wall time. */
typedef struct {
  PetscReal cpu, wall;
} LamStopwatch;
LamStopwatch LamStopwatchRead(void);
/*
  Measures the setting of m once more, until LamStopRequested (a signal, or the deadline). A first run without results
  sets m->reason; a repeat without results leaves m unchanged.

  table: file of the table, for LAM_KNOB_DATABASE (written) or for a body that queries it, whose build time m has
*/
PetscErrorCode LamMeasure(const LamScene *scene, const LamStates *states, const char table[], LamMeasurement *m);
/* The same by an RVE, with an m that has no runs; m->responses also of states after one that failed. */
PetscErrorCode LamMeasureRVE(const LamScene *scene, const LamStates *states, LamMeasurement *m);

/* ---- tradeoff_reference.c ---- */
/*
  Refines the mesh until the last two differ by a hundredth of the scene's accuracy in P, or the time is over: errors
  from a tenth of the accuracy on are then resolved. States that take too long are dropped. States at which the two
  meshes differ by more than a tenth of the scene's accuracy are not used, unless all do. Sets `skip` of states that
  are not used.
*/
PetscErrorCode LamReferenceMake(const LamScene *scene, LamStates *states, PetscReal deadline, LamReference *reference);

/* ---- tradeoff_judge.c ---- */
LamSpread LamSpreadOf(PetscInt n, const PetscReal values[]);
/* Error of a response; NaN if not known. Not for LAM_ERROR_MACRO. */
PetscReal LamErrorOf(LamErrorKind kind, const LamMicrostructure *micro, const LamResponse *answer,
                     const LamResponse *reference);
/* Errors of the reactions of all sides together, and of the work. */
void LamMacroErrors(const LamMacroOutcome *answer, const LamMacroOutcome *reference, PetscReal errors[2]);
/* Marks the points for which no other is at least as good in both and better in one; NaN: never. */
void LamParetoMark(PetscInt n, const PetscReal cost[], const PetscReal error[], PetscBool optimal[]);
/* Computes the errors and spreads of all measurements, and the best settings. */
PetscErrorCode LamJudge(const LamReference *reference, const LamStates *states, PetscInt n, LamMeasurement measured[]);

/* ---- tradeoff_run.c ---- */
enum { LAM_TRADEOFF_PARTS = 5 };
typedef struct {
  const char *scene_path;
  PetscBool chosen[LAM_KNOB_COUNT]; /* parameters that are varied */
  PetscInt repeats;
  PetscReal budget; /* s */
  LamReporter reporter;

  LamScene *scene; /* mesh chosen; owned */
  LamStates states;
  LamReference reference;
  PetscInt n;
  LamMeasurement *measured;        /* [n]; owned */
  const char *why[LAM_KNOB_COUNT]; /* why a parameter is not varied; NULL: it is */
  char folder[PETSC_MAX_PATH_LEN]; /* for tables; removed at the end */
  PetscReal start, ends[LAM_TRADEOFF_PARTS];
  PetscInt done, failed;
  PetscReal seconds;
  PetscBool stopped;
} LamTradeoff;
/* Measures and judges all settings, on one rank. */
PetscErrorCode LamTradeoffRun(LamTradeoff *tradeoff);
/* Whether the planned setting has a result, and the reference exists if one is needed. */
PetscBool LamTradeoffIsSolved(const LamTradeoff *tradeoff);
PetscErrorCode LamTradeoffDestroy(LamTradeoff *tradeoff);

#endif
