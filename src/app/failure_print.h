/*
  Output of failure and of the onset of separation.
*/
#ifndef LAM_FAILURE_PRINT_H
#define LAM_FAILURE_PRINT_H

#include "app.h"
#include "failure.h"

/* Prints one line: stresses of walls and lamella in a state, relative to their strengths if these are given. */
void LamFailurePrintState(const LamResponse *response, const LamStrength *strength, const LamScales *scales);
/* {"cell": 0, "face": 0, "along": 0.06}; null if there is no place. */
json_t *LamPlaceToJSON(const PetscReal place[3]);
/* Prints one JSON object {"failure": {...}} or a few human-readable lines on stdout. */
PetscErrorCode LamFailurePrint(const LamFailure *failure, const LamScales *scales, PetscBool json);
/* Prints one JSON object {"onset": {...}} or a few human-readable lines on stdout. */
PetscErrorCode LamOnsetPrint(const LamOnset *onset, const LamScales *scales, PetscBool json);

#endif
