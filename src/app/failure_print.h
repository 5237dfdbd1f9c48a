/*
  What the program prints of failure and of the onset of separation.
*/
#ifndef LAM_FAILURE_PRINT_H
#define LAM_FAILURE_PRINT_H

#include "app.h"
#include "failure.h"

/* A line for a person on what walls and lamella bear in a state, over their strengths where these are given. */
PetscErrorCode LamFailurePrintState(const LamResponse *response, const LamStrength *strength, const LamScales *scales);
/* {"cell": 0, "face": 0, "along": 0.06}; null where there is no place. */
json_t *LamPlaceToJSON(const PetscReal place[3]);
/* One JSON object {"failure": {...}} or a few lines for a person, on stdout. */
PetscErrorCode LamFailurePrint(const LamFailure *failure, const LamScales *scales, PetscBool json);
/* One JSON object {"onset": {...}} or a few lines for a person, on stdout. */
PetscErrorCode LamOnsetPrint(const LamOnset *onset, const LamScales *scales, PetscBool json);

#endif
