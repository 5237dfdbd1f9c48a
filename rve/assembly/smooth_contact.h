/*
  Contact of all walls by one smooth potential (docs/theory/contact.md, The smooth law).

    F33 1/2 sum_q w_q s phi(gap_q; width)

  over all points of walls near another wall (touching.h), phi the law of smooth.h. The strength s is the pressure that
  holds walls together, so that walls pressed by turgor and suction lie at a gap of zero:
    s^2 = (p + g)^2 + LAM_LEAST_STRENGTH^2,    p the mean turgor of the two cells, g their cohesion.
  A lamella holds walls at a gap of zero without being pressed, and must not be torn by the law: with it the law is
  phi(gap + width; width), which begins at a gap of zero.
*/
#ifndef LAM_RVE_SMOOTH_CONTACT_H
#define LAM_RVE_SMOOTH_CONTACT_H

#include "touching.h"

#define LAM_LEAST_STRENGTH 0.02 /* C1 + C2: of dry, loose tissue; a smaller one needs deeper penetrations */

/* s of two cells and its derivatives with respect to turgor and cohesion of the load. */
typedef struct {
  PetscReal s, p, g, pp, pg, gg;
} LamTouchStrength;

/* Sums over the points of one span against one other span, per strength and per F33. Nodes: those of the point's span,
   then those of the other one in its image. K is symmetric; the rows of the other span's nodes in the columns of the
   point's are set with LAM_TOUCH_WIDTH only. */
typedef struct {
  PetscInt class[LAM_BLOCK_NODES];
  PetscReal shift[LAM_BLOCK_NODES][2]; /* x = y_class + F shift */
  LamTouchStrength strength;
  PetscReal energy, energy_width; /* and its derivative with respect to the width */
  PetscReal f[LAM_BLOCK_DOFS], f_width[LAM_BLOCK_DOFS];
  PetscReal K[LAM_BLOCK_DOFS][LAM_BLOCK_DOFS];
  PetscBool facing, lumen; /* the walls face each other in the undeformed tissue; they belong to a lumen */
  PetscInt loop, span, other, at;
} LamTouchBlock;

typedef enum { LAM_TOUCH_ENERGY, LAM_TOUCH_TANGENT, LAM_TOUCH_WIDTH } LamTouchWanted; /* and all before */
typedef void (*LamTouchBlockVisitor)(void *ctx, const LamTouchBlock *block);

#define LAM_KEPT 4 /* blocks of a span whose entries are kept: it meets up to two spans of each of two walls */
#define LAM_BLOCK_PAIRS (LAM_BLOCK_NODES * (LAM_BLOCK_NODES + 1) / 2)
/* Where a block belongs in the matrix in use. */
typedef struct {
  PetscInt block[4];               /* loop, span, other and at; the first is -1 if nothing is kept */
  PetscInt first[LAM_BLOCK_PAIRS]; /* of nodes i <= j, row by row: first entry of their classes, -1: prescribed */
} LamBlockEntries;

typedef struct {
  LamWalls walls;
  PetscReal width;          /* apothems */
  PetscInt base_count;      /* couplings of facing walls that have hardly slid, ... */
  PetscInt count, room;     /* ... and all at present, those of walls met since included */
  PetscInt (*pairs)[2];     /* [count] classes */
  LamBlockEntries *entries; /* [loop][span][LAM_KEPT] of blocks met last; NULL before the first assembly */
} LamSmooth;

#endif
