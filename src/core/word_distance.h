/*
  How far apart two words are, for "did you mean".
*/
#ifndef LAM_WORD_DISTANCE_H
#define LAM_WORD_DISTANCE_H

#include <petscsys.h>

/* The distance of Damerau and Levenshtein: letters changed, inserted, removed, neighbours swapped. Words of more than
   40 letters are 40 apart. */
PetscInt LamWordDistance(const char a[], const char b[]);

#endif
