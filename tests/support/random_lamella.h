/*
  Random tissues with a lamella and a program of loads for each, the same on every machine: t/a 0.05 to 0.25,
  C4/(C1 + C2) 0.5 to 30, strength 0.05 to 2 (C1 + C2), in shear 0.3 to 2 times that, 2G/strength 0.01 to 2 apothems,
  the energy of shear in each second tissue up to four times that of tension (all with uniform logarithms), any
  orientation, either softening, the stiffness that scenes have where none is given; one cell of 6 x 1 elements a face.
  A quarter of them is dry; the others have a turgor of up to 0.3 MPa, but of no more than the walls bear, a multiple of
  t/a (C1 + C2). Three times is what walls without fibres bear: a cell of circumference 2 pi a bursts at a turgor of
  about 2 t/a (C1 + C2), and neighbours share its load.
*/
#ifndef LAM_SUPPORT_RANDOM_LAMELLA_H
#define LAM_SUPPORT_RANDOM_LAMELLA_H

#include <stdint.h>
#include <lamella/lamella.h>

typedef enum {
  PROGRAM_SHEAR,
  PROGRAM_TENSION_1, /* lateral strain held */
  PROGRAM_TENSION_2,
  PROGRAM_PURE_SHEAR, /* area kept */
  PROGRAM_EQUIBIAXIAL,
  PROGRAM_COMPRESSION, /* half the strain, with lateral stretch */
  PROGRAM_COUNT
} LamellaProgram;
extern const char *const lamella_program_names[PROGRAM_COUNT];

typedef struct {
  LamMicrostructure micro;
  LamellaProgram program;
  double turgor; /* C1 + C2 */
} RandomLamella;

/* Tissue `number`, which depends on no other. most_turgor: in t/a (C1 + C2). */
RandomLamella DrawLamella(uint64_t seed, int number, double most_turgor);
/* Walls that tear at 0.5 to 5 (C1 + C2), over an opening of 0.03 to 3 thicknesses; contact is then smooth. */
void DrawTearing(uint64_t seed, int number, LamMicrostructure *micro);
/* The load of its program at a strain. */
LamLoad LamellaProgramLoad(const RandomLamella *sample, double strain);

#endif
