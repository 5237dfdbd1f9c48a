/*
  What a macroscale run comes to: where the tissue first separates and tears, stiffness, work, firmness. Rank 0.

    LamSummaryAdd(&summary, step, fields) after every step; LamSummaryFind(&summary) gives all the rest.

  Onset. Every material point has measures that reach 1 where its tissue fails: what its lamella and walls bear over
  their strengths, and in contact tissue what its faces have lost of the pressure that closes them. Where nothing closes
  them (p + g = 0) cells that have a gap are separated; else a gap is an opening: cells that swell freely round off and
  open at their junctions long before they come apart. (`rve --failure` counts gaps as separation, too: states that are
  held there.) Between two reported steps the measure of a point is taken as linear in what the curves are linear in;
  the point and place that reach 1 first are the onset. A gap is not measured while it is closed, so that its onset is
  the step at which it is found. An onset that is there at the first step has nothing to interpolate from, either.

  The shares of the body that are separated or torn at a step (in its curves) are those of the points at which any of
  these criteria is reached. They depend less on the mesh than onsets do, which sit at clamped corners where stress has
  no bound.

  The loaded side is the one that is moved furthest; displacement and reaction are the components along its direction.
*/
#ifndef LAM_FE2_SUMMARY_H
#define LAM_FE2_SUMMARY_H

#include <jansson.h>
#include "fe2_curve.h"
#include "json.h"

#define LAM_SUMMARY_CRITERIA(X)                                                                                        \
  X(LAM_SUMMARY_NORMAL, "lamella_normal")   /* separation: lamella_normal over its strength */                         \
  X(LAM_SUMMARY_SHEAR, "lamella_shear")     /* separation: likewise */                                                 \
  X(LAM_SUMMARY_UNLOADED, "face_unloading") /* separation, contact: a face family carries nothing any more */          \
  X(LAM_SUMMARY_GAP, "gap")                 /* opening, contact: a gap above LAM_VISIBLE_GAP, on the RVE's mesh */     \
  X(LAM_SUMMARY_WALL, "wall")               /* rupture: wall_tension over its strength */
typedef enum { LAM_SUMMARY_CRITERIA(LAM_ENUM_ENTRY) LAM_SUMMARY_CRITERION_COUNT } LamSummaryCriterion;
extern const char *const LamSummaryCriterionNames[];
#define LAM_SUMMARY_MODES(X)                                                                                           \
  X(LAM_SUMMARY_OPENING, "opening")                                                                                    \
  X(LAM_SUMMARY_SEPARATION, "separation")                                                                              \
  X(LAM_SUMMARY_RUPTURE, "rupture")
typedef enum { LAM_SUMMARY_MODES(LAM_ENUM_ENTRY) LAM_SUMMARY_MODE_COUNT } LamSummaryMode;
extern const char *const LamSummaryModeNames[];
LamSummaryMode LamSummaryModeOf(LamSummaryCriterion criterion);

/* Where a criterion is first reached. */
typedef struct {
  PetscBool judged, reached;
  PetscInt row;            /* of the curve, at which it is found reached */
  PetscReal share;         /* of the way to it from the row before; 1: not interpolated */
  PetscInt element, point; /* number of the element, and which of its points */
  PetscReal place[2];      /* reference position, mm */
} LamSummaryOnset;

/* Slopes of the reaction over the displacement, N/mm over mm and mm of thickness, which is MPa; NaN: too few steps. */
typedef struct {
  PetscReal initial, final; /* tangents: of the parabola through the first, and the last, three steps */
  PetscReal secant;         /* from the first step to that of the largest displacement */
} LamSummaryStiffness;

typedef struct {
  const LamScene *scene; /* borrowed */
  LamStrength strength;  /* of the step that is added; the scene's, unless it changes in time */
  LamCurve curve;
  LamSummaryOnset onset[LAM_SUMMARY_CRITERION_COUNT];
  PetscReal *before; /* [point][criterion] measures at the last step, before_count in all; owned */
  PetscInt before_count;

  /* LamSummaryFind */
  PetscInt side;          /* the loaded one; -1: none is moved */
  PetscReal direction[2]; /* of its displacement */
  LamSummaryStiffness stiffness;
  PetscReal height, length; /* mm, of a box: across and along the loaded side; moduli are stiffness * height / length;
                               NaN: the side has none */
  PetscInt firmest;         /* row of the largest force against the motion; -1: there is none */
} LamSummary;

/* Borrows the scene. */
PetscErrorCode LamSummaryCreate(const LamScene *scene, LamSummary *summary);
PetscErrorCode LamSummaryAdd(LamSummary *summary, const LamMacroStep *step, const LamMacroFields *fields);
/* May be called after any step, and again after others; nothing is found before the first. */
void LamSummaryFind(LamSummary *summary);
PetscErrorCode LamSummaryDestroy(LamSummary *summary);
/* Writes or reads all steps so far; collective, what is found is on rank 0. */
PetscErrorCode LamSummaryArchive(LamSummary *summary, LamArchive archive);
/* The first of a mode's criteria that is reached; NULL: none. */
const LamSummaryOnset *LamSummaryFirst(const LamSummary *summary, LamSummaryMode mode, LamSummaryCriterion *criterion);
/* Whether any of its criteria is judged: they apply to this tissue, and the strength is given. */
PetscBool LamSummaryIsJudged(const LamSummary *summary, LamSummaryMode mode);

/* How near a point is to separation or rupture: the largest of what is judged, 1 where it fails; what its walls bear
   where nothing is. `field` by LamPointField. */
PetscReal LamSummaryDanger(const LamSummary *summary, const PetscReal field[]);

/* Displacement (mm) or reaction (N/mm) of the loaded side along its direction, at a row. */
PetscReal LamSummaryDisplacement(const LamSummary *summary, PetscInt row);
PetscReal LamSummaryReaction(const LamSummary *summary, PetscInt row);

/* ---- fe2_summary_json.c ---- */
json_t *LamSummaryToJSON(const LamSummary *summary);

#endif
