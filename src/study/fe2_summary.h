/*
  The summary of a macroscale run: onsets of separation and rupture, stiffness, work, firmness. Rank 0.

    LamSummaryCreate(scene, &summary); LamSummaryAdd(&summary, step, fields) after every step.

  Onset. Every material point has measures that reach 1 where its tissue fails: tractions of the lamella and tension of
  the walls over their strengths, and in contact tissue the fraction that its faces have lost of the closing pressure.
  With law `lamella` it is the share of the fracture energy that is spent along a face family, over LAM_BROKEN.
  If nothing closes the faces (p + g = 0), cells with a gap are separated; else a gap is an opening: freely swelling
  cells round off and open at their junctions long before they separate. (`rve --failure`, whose states are prescribed,
  counts gaps as separation, too.) Between two reported steps the measure of a point is interpolated linearly, as the
  curves are; the point and load at which 1 is reached first are the onset. A closed gap has no measure, so the onset of
  a gap is the step at which it is found. An onset at the first step is not interpolated, either.

  The separated and ruptured fractions of the body at a step (in the curves) are the volume fractions of the points at
  which any of these criteria is reached. They depend less on the mesh than onsets do, which occur at clamped corners
  where stress is unbounded.

  The loaded side is the side with the largest displacement; displacement and reaction are components along its
  direction.
*/
#ifndef LAM_FE2_SUMMARY_H
#define LAM_FE2_SUMMARY_H

#include <jansson.h>
#include "fe2_curve.h"
#include "json.h"
#include "mechanical_test.h"

#define LAM_SUMMARY_CRITERIA(X)                                                                                        \
  X(LAM_SUMMARY_NORMAL, "lamella_normal")   /* separation: lamella_normal over its strength */                         \
  X(LAM_SUMMARY_SHEAR, "lamella_shear")     /* separation: lamella_shear over its strength */                          \
  X(LAM_SUMMARY_UNLOADED, "face_unloading") /* separation, contact: a face family carries no load */                   \
  X(LAM_SUMMARY_BROKEN, "lamella_broken")   /* separation, law lamella: that of a face family is broken */             \
  X(LAM_SUMMARY_GAP, "gap")                 /* opening, contact: a gap above LAM_VISIBLE_GAP, on the RVE's mesh */     \
  X(LAM_SUMMARY_WALL, "wall")               /* rupture: wall_tension over its strength */
typedef enum { LAM_SUMMARY_CRITERIA(LAM_ENUM_ENTRY) LAM_SUMMARY_CRITERION_COUNT } LamSummaryCriterion;
#define LAM_SUMMARY_MODES(X)                                                                                           \
  X(LAM_SUMMARY_OPENING, "opening")                                                                                    \
  X(LAM_SUMMARY_SEPARATION, "separation")                                                                              \
  X(LAM_SUMMARY_RUPTURE, "rupture")
typedef enum { LAM_SUMMARY_MODES(LAM_ENUM_ENTRY) LAM_SUMMARY_MODE_COUNT } LamSummaryMode;

/* Onset of a criterion. */
typedef struct {
  PetscBool judged, reached;
  PetscInt row;    /* of the curve: first step at which it is reached */
  PetscReal share; /* onset as a fraction of the interval from the previous row to this one; 1: not interpolated */
  PetscInt element, point; /* number of the element, and which of its points */
  PetscReal place[2];      /* reference position, mm */
} LamSummaryOnset;

/* Slopes of reaction over displacement (mm): N/mm per mm, that is MPa, or N/mm of a whole body; NaN: too few steps. */
typedef struct {
  PetscReal initial, final; /* tangents of the parabolas through the first and the last three steps */
  PetscReal secant;         /* from the first step to that of the largest displacement */
} LamSummaryStiffness;

typedef struct {
  const LamScene *scene; /* borrowed */
  LamStrength strength;  /* at the step to be added; the scene's, unless it changes in time */
  LamCurve curve;
  LamSummaryOnset onset[LAM_SUMMARY_CRITERION_COUNT];
  PetscReal *before; /* [point][criterion] measures at the last step, before_count values; owned */
  PetscInt before_count;
  PetscReal F0[9]; /* of the inflated body, mean; without inflation the identity */

  /* at the last step */
  PetscInt side;          /* the loaded side; -1: none is moved */
  PetscReal direction[2]; /* of its displacement */
  LamSummaryStiffness stiffness;
  PetscReal height, length; /* of a box, perpendicular to and along the loaded side, mm, or of a cylinder the area of
                               that side, mm^2; moduli are stiffness * height / length; NaN: not a box, or not one of
                               its sides */
  PetscBool is_level;       /* the loaded side of the box is along X1 */
  PetscInt firmest;         /* row of the largest reaction along the displacement; -1: none is positive */
} LamSummary;

/* Borrows the scene. */
PetscErrorCode LamSummaryCreate(const LamScene *scene, LamSummary *summary);
PetscErrorCode LamSummaryAdd(LamSummary *summary, const LamMacroStep *step, const LamMacroFields *fields);
PetscErrorCode LamSummaryDestroy(LamSummary *summary);
/* Writes or reads all steps so far. Collective; results are on rank 0. */
PetscErrorCode LamSummaryArchive(LamSummary *summary, LamArchive archive);
/* The earliest onset among the criteria of a mode, and its criterion; NULL: none is reached. */
const LamSummaryOnset *LamSummaryFirst(const LamSummary *summary, LamSummaryMode mode, LamSummaryCriterion *criterion);
/* Proximity of a point to separation or rupture: the largest measure of the evaluated criteria, 1 at failure; its wall
   tension if there is none. `field`: values by LamPointField. */
PetscReal LamSummaryDanger(const LamSummary *summary, const PetscReal field[]);

/* The curve of the loaded side from where it begins to move, or from rest without turgor; borrows from the summary. */
PetscErrorCode LamSummaryTest(const LamSummary *summary, LamTest *test);
json_t *LamSummaryToJSON(const LamSummary *summary);

#endif
