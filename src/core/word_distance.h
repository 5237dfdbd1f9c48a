/*
  Edit distance of two words, for "did you mean".
*/
#ifndef LAM_WORD_DISTANCE_H
#define LAM_WORD_DISTANCE_H

#include <petscsys.h>

/* Damerau-Levenshtein distance: substitutions, insertions, deletions, transpositions of neighbours. The distance of
   words of more than 40 letters is 40. */
PetscInt LamWordDistance(const char a[], const char b[]);

#endif
