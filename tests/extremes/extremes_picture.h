/* A picture of the pairs of a map. */
#ifndef LAM_EXTREMES_PICTURE_H
#define LAM_EXTREMES_PICTURE_H

#include "extremes_judge.h"

/* SVG on stdout of the verdicts, by number, of all pairs; below zero: none. */
void ExtremesPicture(const int verdicts[]);

#endif
