/*
  Loads and responses in the frame of the section, in which the third axis of the cells is that of space.
*/
#ifndef LAM_SECTION_FRAME_H
#define LAM_SECTION_FRAME_H

#include <lamella/response.h>

/* A load in the frame of the section: turned so that F_13 = F_23 = 0. */
LamLoad LamSectionLoad(const LamLoad *load);
/* Turns a response from the frame of the section to that of its load. */
void LamSectionTurnBack(const LamLoad *load, LamResponse *response);
/* Components 13 and 23 of P, and of a tensor that is linear in it, from the others in the frame of the section. */
void LamSectionCompleteStress(const PetscReal F[9], PetscReal P[9]);
/* The same of P, and rows and columns 13 and 23 of the tangent A. */
void LamSectionComplete(const PetscReal F[9], PetscReal P[9], PetscReal A[81]);

#endif
