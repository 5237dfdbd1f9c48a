/*
  The middle lamella of law `lamella`: a cohesive law with irreversible damage (docs/theory/lamella.md).

  Nondimensional: stresses in C1 + C2 of the wall, lengths in apothems a; so energies per reference area are in
  (C1 + C2) a, stiffnesses in (C1 + C2)/a.
*/
#ifndef LAMELLA_COHESIVE_H
#define LAMELLA_COHESIVE_H

#include <petscsys.h>
#include <lamella/export.h>

LAM_C_BEGIN

#define LAM_SOFTENINGS(X)                                                                                              \
  X(LAM_SOFTENING_BILINEAR, "bilinear")       /* traction falls to zero linearly in the opening */                     \
  X(LAM_SOFTENING_EXPONENTIAL, "exponential") /* and exponentially */
#define LAM_SOFTENING_ENTRY(symbol, name) symbol,
typedef enum { LAM_SOFTENINGS(LAM_SOFTENING_ENTRY) LAM_SOFTENING_COUNT } LamSoftening;
LAM_EXPORT extern const char *const LamSofteningNames[]; /* "bilinear", "exponential" */

typedef struct {
  LamSoftening softening;
  PetscReal stiffness;                    /* traction over opening of undamaged lamella */
  PetscReal strength, energy;             /* largest traction in tension, and the energy spent until nothing holds */
  PetscReal shear_strength, shear_energy; /* the same in shear; strength 0: shear is not resisted */
  PetscReal mixing;                       /* exponent of Benzeggagh and Kenane between the two energies */
  /* Factors of strength and energy: within a distance (apothems) of corners, where three cells meet; of the face
     families 0, 1, 2; between clusters of cells (LamCell) */
  PetscReal junction_length, junction_strength, junction_energy;
  PetscReal face_strength[3], face_energy[3];
  PetscReal between_strength, between_energy;
} LamLamella;

/* Walls that tear across, by the same law with bilinear softening, in shear as in tension; a cell that is torn bursts.
   Strength 0: they do not. */
typedef struct {
  PetscReal strength, energy,
      stiffness; /* nominal tension, energy per area of the cut at rest, traction over opening */
} LamTearing;

/* A lamella without variation: all factors 1, shear as tension, no junctions. */
#define LAM_LAMELLA_UNIFORM                                                                                            \
  ((LamLamella){.mixing = 2.0,                                                                                         \
                .junction_strength = 1.0,                                                                              \
                .junction_energy = 1.0,                                                                                \
                .face_strength = {1.0, 1.0, 1.0},                                                                      \
                .face_energy = {1.0, 1.0, 1.0},                                                                        \
                .between_strength = 1.0,                                                                               \
                .between_energy = 1.0})

LAM_C_END

#endif
