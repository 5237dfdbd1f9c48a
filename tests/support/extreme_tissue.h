/* The large deformations that must be answered: what the test asserts and the bench program prints. */
#ifndef LAM_SUPPORT_EXTREME_TISSUE_H
#define LAM_SUPPORT_EXTREME_TISSUE_H

#include "tissue.h"

#define EXTREMES 6
typedef struct {
  const char *name;
  LamLoad load;
} Extreme;

/* Shear 1.0, stretch 1.5, compression 0.9 x 1.05, without and with turgor 0.02 MPa. */
void ListExtremes(Extreme list[EXTREMES]);

#endif
