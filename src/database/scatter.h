/*
  Private to queries of scattered records: distances from the query.

    d^2 = |dc|^2 / 4 + (TURGOR_WEIGHT dp)^2, in contact tissue + (SUCTION_WEIGHT (dp + dg))^2
  dC/2 is the Green strain, so the distance is a strain.
*/
#ifndef LAM_SCATTER_H
#define LAM_SCATTER_H

#include "database_internal.h"

typedef PetscReal LamScatterVector[LAM_VARIABLES];
typedef PetscReal LamScatterMatrix[LAM_VARIABLES][LAM_VARIABLES];

/* The coefficients of |dc|^2, dp^2, 2 dp dg, dg^2 in the squared distance. */
typedef struct {
  PetscReal strain, pp, pg, gg;
} LamScatterMetric;

typedef struct {
  PetscInt state, image; /* state -1: none */
  PetscReal distance2;
} LamScatterNearest;

typedef struct {
  LamDatabase db;
  LamScatterMetric metric;
  LamScatterVector x; /* of the query */
  LamScatterPlace place;
  LamScatterVector turned[LAM_MAX_IMAGES];  /* x in the frame of each image */
  LamScatterNearest blends, alone, refuses; /* the nearest of each use */
} LamScatterSearch;

/* Initialises the search at a load, without looking at records. */
void LamScatterBegin(LamDatabase database, const LamLoad *load, LamScatterSearch *search);
/* Finds the nearest records of each use. */
void LamScatterFind(LamDatabase database, const LamLoad *load, LamScatterSearch *search);
/* v = M delta; returns delta . M delta. */
PetscReal LamScatterApply(const LamScatterMetric *metric, const LamScatterVector delta, LamScatterVector v);
PetscReal LamScatterDistance2(const LamScatterSearch *search, const LamScattered *state, PetscInt image);
/* Lower bound of the squared distance of all images of a state at `place`. */
PetscReal LamScatterLowerBound(const LamScatterSearch *search, const LamScatterPlace *place);

#endif
