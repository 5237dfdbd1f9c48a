/*
  lamella tradeoff: error against time over the knobs that trade them.

    tradeoff_settings.c   which settings a scene has
    tradeoff_states.c     which states they are to answer
    tradeoff_measure.c    one setting, answered once, by an RVE
    tradeoff_table.c      likewise by a table, its building included
    tradeoff_macro.c      likewise the macroscale problem
    tradeoff_reference.c  answers that are finer than all of them
    tradeoff_judge.c      errors, spread of times, which settings are the best
    tradeoff_report.c     what is told of that, and written
    tradeoff_plot.c       the work-precision diagram
    cmd_tradeoff.c        in which order, and for how long

  Errors and settings follow the work-precision diagrams of SciML (C. Rackauckas and Q. Nie, J. Open Res. Softw. 5
  (2017) 15): all settings answer the same questions, from nothing, in interleaved rounds on one machine; what fails is
  left out and told; the reference is finer than what is ranked.
*/
#ifndef LAM_TRADEOFF_H
#define LAM_TRADEOFF_H

#include "fe2_run.h"

#define LAM_KNOBS(X)                                                                                                   \
  X(LAM_KNOB_MESH, "mesh")           /* elements along a face, through a wall, grading */                              \
  X(LAM_KNOB_STRATEGY, "strategy")   /* contact reached in one step or two */                                          \
  X(LAM_KNOB_CELLS, "cells")         /* per period */                                                                  \
  X(LAM_KNOB_TOLERANCE, "tolerance") /* of the Newton iterations */                                                    \
  X(LAM_KNOB_DATABASE, "database")   /* accuracy of a table */                                                         \
  X(LAM_KNOB_MACRO, "macro")         /* what answers the material points of a body */
typedef enum { LAM_KNOBS(LAM_ENUM_ENTRY) LAM_KNOB_COUNT } LamKnob;
extern const char *const LamKnobNames[];

#define LAM_ERROR_KINDS(X)                                                                                             \
  X(LAM_ERROR_P, "P")             /* LamStressError */                                                                 \
  X(LAM_ERROR_TANGENT, "tangent") /* relative, Frobenius norm */                                                       \
  X(LAM_ERROR_OPENING, "opening") /* difference of the opening fraction; of bonded tissue of the lumen fraction */     \
  X(LAM_ERROR_MACRO, "macro")     /* of reactions and work at the last step, relative */
typedef enum { LAM_ERROR_KINDS(LAM_ENUM_ENTRY) LAM_ERROR_KIND_COUNT } LamErrorKind;
extern const char *const LamErrorNames[];

/* One way to answer. */
typedef struct {
  LamKnob knob;
  char label[48];          /* "12 x 4, graded 0.6" */
  char mark[16];           /* beside its point in the diagram: "12" */
  LamMicrostructure micro; /* its mesh and cells; borrows the cells of the scene */
  LamStrategy strategy;
  PetscReal tolerance;
  PetscReal accuracy;      /* of a table or a cache; 0: neither */
  LamFE2Response response; /* of a body's points */
  PetscBool planned;       /* this is what the scene and the planner say */
} LamSetting;

/* The states that are to be answered. */
typedef struct {
  PetscInt n;
  LamLoad *loads;     /* owned */
  PetscBool chained;  /* each starts from the one before, else from the undeformed tissue */
  PetscInt dropped;   /* of the scene's load, which prescribes stress that the planned mesh cannot reach */
  const char *origin; /* "load", "sample", "default" */
  PetscBool *skip;    /* [n]: is not solved; owned */
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
  PetscBool resolved;      /* at least ten times the error of the reference */
  PetscBool optimal;       /* no other resolved setting has a smaller error in less time */
} LamMeasuredError;

#define LAM_MOST_REPEATS 100
typedef struct {
  LamSetting setting;
  PetscInt unknowns;               /* of one RVE */
  PetscInt nodes;                  /* of a table; 0: none */
  PetscInt runs;                   /* how often it was measured; 0: left out */
  PetscReal *cpu, *wall;           /* [runs] seconds, all included; owned, room for LAM_MOST_REPEATS */
  PetscReal *state_cpu;            /* [runs] of it, in solves or queries of one state on average; owned, likewise */
  PetscReal build_cpu, build_wall; /* of a table, or of the one that a body asks: of the last building */
  PetscBool stopped;               /* by the time, or a signal */
  LamResponse *responses; /* [states], where runs > 0 all converged; those that were not solved LAM_OUT_OF_REACH; NULL:
                             none; owned */
  LamMacroOutcome outcome;
  char reason[192]; /* why it is left out; empty: it is not */

  /* LamJudge */
  LamSpread cpu_spread, wall_spread;
  LamMeasuredError error[LAM_ERROR_KIND_COUNT];
  PetscReal from_plan; /* largest difference of P to the planned setting, or of a body to direct answers */
} LamMeasurement;

/* Answers on a fine mesh, and how far they are from those of the next coarser one. */
typedef struct {
  LamMicrostructure micro, other;        /* the finest mesh, and the one that its error is told from; borrow cells */
  LamResponse *responses;                /* [states]; owned */
  PetscBool *used;                       /* [states]: errors are taken there; owned */
  PetscInt used_count;                   /* 0: there is no reference */
  PetscInt known_count;                  /* states that have an answer on both meshes */
  PetscReal *difference;                 /* [states] of P between the two meshes; NaN: one has no answer; owned */
  PetscReal error[LAM_ERROR_KIND_COUNT]; /* largest difference between the two over the states used; NaN: not known */
  PetscReal cpu;                         /* seconds of the finest */
} LamReference;

/* ---- tradeoff_settings.c ---- */
/* Whether a knob of the scene, whose mesh is chosen, trades anything; *why not, otherwise. */
PetscBool LamKnobApplies(const LamScene *scene, LamKnob knob, const char **why);
/* All settings of a knob; the caller frees. */
PetscErrorCode LamSettingsMake(const LamScene *scene, LamKnob knob, PetscInt *n, LamSetting **settings);

/* ---- tradeoff_states.c ---- */
PetscErrorCode LamStatesMake(const LamScene *scene, LamStates *states);
PetscInt LamStatesCount(const LamStates *states); /* without those that are skipped */
PetscErrorCode LamStatesDestroy(LamStates *states);

/* ---- tradeoff_measure.c ---- */
PetscErrorCode LamMeasurementInit(const LamSetting *setting, LamMeasurement *m);
PetscErrorCode LamMeasurementDestroy(LamMeasurement *m);
/*
  Measures the setting of m once more, until LamStopRequested (a signal, or the deadline). A first run without results
  sets m->reason; a repeat without results leaves m unchanged.

  table: file of the table, of LAM_KNOB_DATABASE (written) or of a body that queries it, whose build time m has
*/
PetscErrorCode LamMeasure(const LamScene *scene, const LamStates *states, const char table[], LamMeasurement *m);
/* Adds a run to m: of a repeat its times; one that was cut short is dropped. Destroys or moves `run`. */
PetscErrorCode LamMeasurementTake(LamMeasurement *run, LamMeasurement *m);

/* What LamMeasure calls, by the kind of setting, with an m that has no runs: they add one, or set the reason. */
PetscErrorCode LamMeasureRVE(const LamScene *scene, const LamStates *states, LamMeasurement *m);
PetscErrorCode LamMeasureTable(const LamScene *scene, const LamStates *states, const char table[], LamMeasurement *m);
PetscErrorCode LamMeasureMacro(const LamScene *scene, const char table[], LamMeasurement *m);

/* Time of all threads of the process, and time that passes. */
typedef struct {
  PetscReal cpu, wall;
} LamStopwatch;
LamStopwatch LamStopwatchRead(void);
/* Keeps the times since `start`; state_share: of it in the states, each. */
void LamMeasurementAddRun(LamMeasurement *m, LamStopwatch start, PetscReal state_cpu);

/* ---- tradeoff_reference.c ---- */
/*
  Finer and finer meshes, until the last two differ by a hundredth of the scene's accuracy in P, or the time is over:
  errors from a tenth of the accuracy on can then be told. States that take too long are given up on the way. States at
  which the two differ by more than a tenth of the scene's accuracy are not used, unless all are such.
*/
PetscErrorCode LamReferenceMake(const LamScene *scene, const LamStates *states, PetscReal deadline,
                                LamReference *reference);
/* The states that it does not use are answered by no setting. */
PetscErrorCode LamReferenceSkipUnused(const LamReference *reference, LamStates *states);
PetscErrorCode LamReferenceDestroy(LamReference *reference);

/* ---- tradeoff_judge.c ---- */
LamSpread LamSpreadOf(PetscInt n, const PetscReal values[]);
/* Of an answer; NaN where it is not known. Not of LAM_ERROR_MACRO. */
PetscReal LamErrorOf(LamErrorKind kind, LamInterfaceLawType interface, const LamResponse *answer,
                     const LamResponse *reference);
/* Errors of the reactions of all sides together, and of the work. */
void LamMacroErrors(const LamMacroOutcome *answer, const LamMacroOutcome *reference, PetscReal errors[2]);
/* Which points have no other that is at least as good in both, and better in one; NaN: never. */
void LamParetoMark(PetscInt n, const PetscReal cost[], const PetscReal error[], PetscBool optimal[]);
/* Fills in what is judged of all measurements. */
PetscErrorCode LamJudge(const LamReference *reference, const LamStates *states, PetscInt n, LamMeasurement measured[]);

/* ---- tradeoff_run.c ---- */
enum { LAM_TRADEOFF_PARTS = 5 };
typedef struct {
  const char *scene_path;
  PetscBool chosen[LAM_KNOB_COUNT]; /* which knobs are turned */
  PetscInt repeats;
  PetscReal budget; /* s */
  LamReporter reporter;

  LamScene *scene; /* mesh chosen; owned */
  LamStates states;
  LamReference reference;
  PetscInt n;
  LamMeasurement *measured;        /* [n]; owned */
  const char *why[LAM_KNOB_COUNT]; /* a knob is not there; NULL: it is */
  char folder[PETSC_MAX_PATH_LEN]; /* of tables; removed at the end */
  PetscReal start, ends[LAM_TRADEOFF_PARTS];
  PetscInt done, failed;
  PetscReal seconds;
  PetscBool stopped;
} LamTradeoff;
/* Measures and judges all settings, on one rank. */
PetscErrorCode LamTradeoffRun(LamTradeoff *tradeoff);
/* Whether the planned setting has a result, and there is something to compare with. */
PetscBool LamTradeoffIsSolved(const LamTradeoff *tradeoff);
PetscErrorCode LamTradeoffDestroy(LamTradeoff *tradeoff);

#endif
