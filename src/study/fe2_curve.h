/*
  The curves of a macroscale run: one row per reported step, for the HDF5 file, its CSV file and the summary.
*/
#ifndef LAM_FE2_CURVE_H
#define LAM_FE2_CURVE_H

#include <lamella/database.h>
#include <lamella/macro.h>

/* Columns of a row other than displacements and reactions: name and unit in both files. */
#define LAM_CURVE_COLUMNS(X)                                                                                           \
  X(LAM_CURVE_STEP, "step", "1")                                                                                       \
  X(LAM_CURVE_LOAD_FACTOR, "load_factor", "1")                                                                         \
  X(LAM_CURVE_TIME, "time", "s") /* only for processes */                                                              \
  X(LAM_CURVE_WORK, "work", "N mm/mm")                                                                                 \
  X(LAM_CURVE_TURGOR, "turgor_mean", "MPa")                                                                            \
  X(LAM_CURVE_OPENING, "opening_fraction", "1")   /* mean over the body */                                             \
  X(LAM_CURVE_DEBONDED, "debonded_fraction", "1") /* likewise */                                                       \
  X(LAM_CURVE_OPEN, "open_fraction", "1")         /* likewise */                                                       \
  X(LAM_CURVE_GAP, "max_gap", "apothem")          /* this and the next four: largest over all points */                \
  X(LAM_CURVE_UNLOADING, "face_unloading_max", "1")                                                                    \
  X(LAM_CURVE_WALL, "wall_tension_max", "MPa")                                                                         \
  X(LAM_CURVE_NORMAL, "lamella_normal_max", "MPa")                                                                     \
  X(LAM_CURVE_SHEAR, "lamella_shear_max", "MPa")                                                                       \
  X(LAM_CURVE_ELLIPTICITY, "ellipticity_min", "MPa") /* smallest over all points */                                    \
  X(LAM_CURVE_LOCALISED, "localised_points", "1")    /* points that have lost ellipticity */                           \
  X(LAM_CURVE_SEPARATED, "separated_share", "1")     /* volume fraction: fe2_summary.h; NaN: not evaluated */          \
  X(LAM_CURVE_RUPTURED, "ruptured_share", "1")       /* likewise */                                                    \
  X(LAM_CURVE_ERROR, "error_estimate_max", "1")                                                                        \
  X(LAM_CURVE_NEWTON, "newton_iterations", "1")                                                                        \
  X(LAM_CURVE_CUTBACKS, "cutbacks", "1")                                                                               \
  X(LAM_CURVE_QUERIES, "queries", "1")                                                                                 \
  X(LAM_CURVE_HITS, "hits", "1")                                                                                       \
  X(LAM_CURVE_SOLVES, "solves", "1")                                                                                   \
  X(LAM_CURVE_FAILURES, "failures", "1")                                                                               \
  X(LAM_CURVE_SECONDS, "seconds", "s")
#define LAM_CURVE_ENTRY(symbol, name, unit) symbol,
typedef enum { LAM_CURVE_COLUMNS(LAM_CURVE_ENTRY) LAM_CURVE_COLUMN_COUNT } LamCurveColumn;

/* All in physical units; NaN: not known, or (displacement) free. */
typedef struct {
  PetscReal value[LAM_CURVE_COLUMN_COUNT];
  PetscReal displacement[LAM_MAX_BOUNDARIES][2]; /* mm */
  PetscReal reaction[LAM_MAX_BOUNDARIES][2];     /* force on the body, N per mm of thickness */
} LamCurveRow;

typedef struct {
  PetscInt side_count;
  char side[LAM_MAX_BOUNDARIES][LAM_NAME_LENGTH];
  PetscInt count, capacity;
  LamCurveRow *rows; /* owned */
} LamCurve;

PetscErrorCode LamCurveAdd(LamCurve *curve, const LamMacroStep *step, const LamMacroFields *fields,
                           const LamScales *scales);
PetscErrorCode LamCurveDestroy(LamCurve *curve);
/* Whether the curve has this column. */
PetscBool LamCurveHas(const LamCurve *curve, LamCurveColumn column);
/* Returns a column as an array [count]; the caller frees it. */
PetscErrorCode LamCurveGetColumn(const LamCurve *curve, LamCurveColumn column, PetscReal **values);
/* Writes /macro/curve/<name> [step] for every column but `step`, and /macro/curve/displacement and reaction
   [step][side][2]. */
PetscErrorCode LamCurveWrite(const LamCurve *curve, LamRecordWriter writer);
/* Writes the .csv file beside the HDF5 file: a header line of names with units, then a line per step; NaN is empty. */
PetscErrorCode LamCurveWriteCSV(const LamCurve *curve, const char hdf5[]);

#endif
