/*
  The curves of a macroscale run: one row per reported step, for the HDF5 file, its CSV file and the summary.
*/
#ifndef LAM_FE2_CURVE_H
#define LAM_FE2_CURVE_H

#include "target.h"
#include <lamella/macro.h>

/* Units of forces and energies, of a body in plane strain per thickness, and their values in units of the macroscale.
 */
typedef struct {
  PetscReal force, energy;
  const char *force_name, *energy_name; /* "N/mm" and "N mm/mm", or "N" and "N mm" */
} LamMacroUnits;
LamMacroUnits LamMacroUnitsOf(const LamScene *scene);

#define LAM_ENERGY_UNIT "energy" /* stands for that of LamMacroUnits */
/* Columns of a row other than displacements and reactions: name and unit in both files; value (in LamCurveAdd) of a
   step and its fields. */
#define LAM_CURVE_COLUMNS(X)                                                                                           \
  X(LAM_CURVE_STEP, "step", "1", step->step)                                                                           \
  X(LAM_CURVE_LOAD_FACTOR, "load_factor", "1", step->load_factor)                                                      \
  X(LAM_CURVE_TIME, "time", "s", step->time) /* only for processes */                                                  \
  X(LAM_CURVE_WORK, "work", LAM_ENERGY_UNIT, (step->work) * energy)                                                    \
  X(LAM_CURVE_TURGOR, "turgor_mean", "MPa", (step->turgor_mean) * MPa)                                                 \
  X(LAM_CURVE_OPENING, "opening_fraction", "1", Mean(fields, LAM_POINT_OPENING)) /* mean over the body */              \
  X(LAM_CURVE_DEBONDED, "debonded_fraction", "1", step->debonded_fraction)       /* likewise */                        \
  X(LAM_CURVE_OPEN, "open_fraction", "1", Mean(fields, LAM_POINT_OPEN))          /* likewise */                        \
  X(LAM_CURVE_GAP, "max_gap", "apothem", step->max_gap) /* this and the next four: largest over all points */          \
  X(LAM_CURVE_UNLOADING, "face_unloading_max", "1", Largest(fields, LAM_POINT_UNLOADING))                              \
  X(LAM_CURVE_WALL, "wall_tension_max", "MPa", Largest(fields, LAM_POINT_WALL) * MPa)                                  \
  X(LAM_CURVE_NORMAL, "lamella_normal_max", "MPa", Largest(fields, LAM_POINT_NORMAL) * MPa)                            \
  X(LAM_CURVE_SHEAR, "lamella_shear_max", "MPa", Largest(fields, LAM_POINT_SHEAR) * MPa)                               \
  X(LAM_CURVE_ELLIPTICITY, "ellipticity_min", "MPa", (step->ellipticity) * MPa) /* smallest over all points */         \
  X(LAM_CURVE_LOCALISED, "localised_points", "1", step->localised_points) /* points that have lost ellipticity */      \
  /* sums over the points with law `lamella`, and their mean; these six only with that law */                          \
  X(LAM_CURVE_STORED, "stored", LAM_ENERGY_UNIT, (step->stored) * energy)                                              \
  X(LAM_CURVE_DISSIPATED, "dissipated", LAM_ENERGY_UNIT, (step->dissipated) * energy)                                  \
  X(LAM_CURVE_RELEASED, "released", LAM_ENERGY_UNIT, (step->released) * energy)                                        \
  X(LAM_CURVE_TISSUE_WORK, "tissue_work", LAM_ENERGY_UNIT, (step->tissue_work) * energy)                               \
  X(LAM_CURVE_BROKEN, "broken_fraction", "1", step->broken_fraction)                                                   \
  X(LAM_CURVE_MESH_DEPENDENT, "mesh_dependent", "1", step->mesh_dependent) /* 1: from here on; else 0 */               \
  X(LAM_CURVE_SEPARATED, "separated_share", "1", NAN) /* volume fraction, set by the summary; NaN: not evaluated */    \
  X(LAM_CURVE_RUPTURED, "ruptured_share", "1", NAN)   /* likewise */                                                   \
  X(LAM_CURVE_ERROR, "error_estimate_max", "1", Largest(fields, LAM_POINT_ERROR))                                      \
  X(LAM_CURVE_NEWTON, "newton_iterations", "1", step->newton_iterations)                                               \
  X(LAM_CURVE_CUTBACKS, "cutbacks", "1", step->cutbacks)                                                               \
  X(LAM_CURVE_QUERIES, "queries", "1", step->queries)                                                                  \
  X(LAM_CURVE_HITS, "hits", "1", step->hits)                                                                           \
  X(LAM_CURVE_SOLVES, "solves", "1", step->solves)                                                                     \
  X(LAM_CURVE_FAILURES, "failures", "1", step->failures)                                                               \
  X(LAM_CURVE_SECONDS, "seconds", "s", step->seconds)
#define LAM_CURVE_ENTRY(symbol, name, unit, value) symbol,
typedef enum { LAM_CURVE_COLUMNS(LAM_CURVE_ENTRY) LAM_CURVE_COLUMN_COUNT } LamCurveColumn;

/* All in physical units, those of energies as LamMacroUnits; NaN: not known, or (displacement) free. */
typedef struct {
  PetscReal value[LAM_CURVE_COLUMN_COUNT];
  PetscReal displacement[LAM_MAX_BOUNDARIES][2]; /* mm */
  PetscReal reaction[LAM_MAX_BOUNDARIES][2];     /* force on the body */
  PetscReal certified[LAM_MAX_BOUNDARIES][2];    /* the same, corrected by direct solves */
  PetscReal margin[LAM_MAX_BOUNDARIES][2];       /* half the width of its interval of 99 % */
} LamCurveRow;

typedef struct {
  LamMacroUnits units;
  PetscInt side_count;
  PetscBool has_certified; /* of any row */
  char side[LAM_MAX_BOUNDARIES][LAM_NAME_LENGTH];
  PetscInt count, capacity;
  LamCurveRow *rows; /* owned */
} LamCurve;

/* With the units of the curve. */
PetscErrorCode LamCurveAdd(LamCurve *curve, const LamMacroStep *step, const LamMacroFields *fields,
                           const LamScales *scales);
PetscErrorCode LamCurveDestroy(LamCurve *curve);
/* Whether the curve has this column. */
PetscBool LamCurveHas(const LamCurve *curve, LamCurveColumn column);
/* Writes /macro/curve/<name> [step] for every column but `step`, and /macro/curve/displacement, reaction and, where
   they are, certified and certified_margin [step][side][2]. */
PetscErrorCode LamCurveWrite(const LamCurve *curve, LamRecordWriter writer);
extern const LamTextKind LamCurveTable;
/* Writes the .csv file beside the HDF5 file: a header line of names with units, then a line per step; NaN is empty. */
PetscErrorCode LamCurveWriteCSV(const LamCurve *curve, const char hdf5[]);

#endif
