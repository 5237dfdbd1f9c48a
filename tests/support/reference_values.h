/* The independent values of the bonded cell (data/bonded.json) beside this program's: what the test asserts and the
   bench program prints. Errors are relative to the largest component. */
#ifndef LAM_SUPPORT_REFERENCE_VALUES_H
#define LAM_SUPPORT_REFERENCE_VALUES_H

#include <jansson.h>
#include <string.h>
#include "tissue.h"

#define REFERENCE_CASES_MAX 16
#define OTHERS_CASES 2
typedef struct {
  char name[64];
  int along, through;
  double energy, stress, tangent, lumen; /* relative errors */
} ReferenceError;

double MatrixEntry(const json_t *matrix, int i, int j);
double NumberAt(const json_t *object, const char key[]);
/* Solves every case of the file; errors[REFERENCE_CASES_MAX]. */
PetscErrorCode CompareWithReference(const char path[], int *count, ReferenceError errors[]);
/* FEBio's Cauchy stresses of simple shear (case 0) and stretch (case 1): the largest error of a component relative to
   itself, components that are zero left out. */
PetscErrorCode CompareWithOthers(const char path[], double error[OTHERS_CASES]);

#endif
