/*
  Two strips of wall, joined by the lamella, that are peeled apart: known answers of beams.

  Each strip has height 1 and is clamped on the right; from the left end on both are free over `arm`, then joined.
    opening     moments M at both ends, one against the other: G = M^2/(E' I)
    sliding     the same moment at both: G = 3/4 M^2/(E' I); faces slide on each other
    cantilever  forces F at both ends, apart: G = F^2 a^2/(E' I), with the length a of two clamped beams that are as
                compliant, 2 a^3/(3 E' I) (shear and the root's rotation are in a)
  I = 1/12; E' of plane strain. The first two are exact for long arms, and steady: M does not depend on the crack's
  length. The energy is so small that strains are below 1e-3 and the walls linear.
*/
#ifndef LAM_SUPPORT_PEELING_H
#define LAM_SUPPORT_PEELING_H

#include "torn_blocks.h"

typedef enum { PEEL_OPENING, PEEL_SLIDING, PEEL_CANTILEVER } PeelLoading;

typedef struct {
  PeelLoading loading;
  LamSoftening softening;
  PetscReal zone;    /* process zone l = min(E' G/sigma^2, (E' G/sigma^2)^(1/4)), heights of a strip */
  PetscReal element; /* length of an element, in zones */
  PetscReal onset;   /* opening at the strength over that at which nothing holds */
  PetscReal arm;     /* longest of zone and height, that many times */
  PetscInt points;   /* of an edge */
  PetscInt steps;    /* per element that breaks */
  PetscReal advance; /* of the crack, while it is measured: elements, at least a zone */
} PeelSetup;

/* While the crack advances. */
typedef struct {
  PetscReal mean, ripple; /* M (or F): its mean, of G as above (or of F); largest deviation over the mean */
  PetscReal applied;      /* G of the mean loads over the law's energy */
  PetscReal released;     /* energy that no one got, in jumps: over what was dissipated */
  PetscReal by_length;    /* work less what is stored, per length that the place of full opening moved, over G */
  PetscReal pressed;      /* deepest place of faces pressed into each other, over the largest opening */
  PetscReal root;         /* cantilever: length of the clamped beams less that of the crack, heights */
  PetscInt steps, iterations, elements;
} PeelResult;

PeelSetup PeelDefault(PeelLoading loading);
PetscErrorCode Peel(const PeelSetup *setup, PeelResult *result);
/* Prints every step: for looking at curves. */
extern int PeelPrints;

#endif
