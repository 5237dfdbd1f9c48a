/*
  Contact with cohesion between the outer walls of neighbouring cells.

  Of the two walls at a face, one is the slave (LamTissueIsSlave); the master is its partner in the neighbouring cell or
  in its image.
  Terms of the potential (docs/theory/mortar.md, The discrete Lagrangian):
    - sum_A lambda_A G_A(x, F)     multipliers times weighted gaps, lambda >= 0, G >= 0, lambda G = 0
    + g F33 A_gap(x, F)            cohesion, in gap_area.c
  F enters only through the images' shifts F S.

  Junction rule. A hat whose centre lies too far outside the overlap is merged into the next inner hat: hat j has the
  multiplier of hat clamp(j, first, last), and its weight, gap and rows are added to that hat. This status
  follows the positions in the first iterations of a solve, and is then kept (sharpen.c).
*/
#ifndef LAM_RVE_CONTACT_H
#define LAM_RVE_CONTACT_H

#include "gap_area.h"
#include "mesh.h"
#include "mortar.h"

typedef struct {
  PetscInt face, partner; /* the slave and the master, of all faces (tissue.h) */
  PetscInt cell, other;   /* their cells */
  PetscInt family;        /* 0 to 2: direction of the slave */
  PetscReal shift[2];     /* of the master's image */
  PetscReal cohesion;     /* factor on the load's cohesion */
  const PetscReal *J0;    /* [along] reference lengths of the slave's edges; borrowed from the mesh */
  PetscInt low,
      high; /* range of hats that may have a multiplier: all except at corners where both walls are prescribed */
  PetscInt first, last; /* hats with a multiplier of their own; first > last: none */
} LamContactFace;

typedef struct {
  PetscBool exact;     /* the exact law is in use, else the smooth one (smooth_contact.h) */
  PetscInt face_count; /* faces with a partner */
  PetscInt hats;       /* per face: 2 along + 1 */
  PetscInt chain;      /* nodes of both chains of a face: slave 0.., then master */
  PetscInt dofs;       /* 2 chain */
  PetscInt count;      /* multipliers: face_count * hats; of face f: f * hats + j */
  LamContactFace *faces;
  PetscInt *classes; /* [face][chain] classes of the nodes, counter-clockwise each */
  PetscReal *shift;  /* [face][chain][2] of the nodes: x = y_class + F shift */
  LamGapArea gaps;
  PetscInt *at;               /* [face of the mesh] which face of these it belongs to, as slave or master; -1: none */
  PetscReal *lambda;          /* [count]; merged hats carry the value of the hat that they are merged into */
  PetscReal *gap;             /* [count] weighted gap / weight at the last evaluated positions; 0 where merged */
  PetscReal *weight;          /* [count] */
  PetscReal *rows;            /* [count][dofs] dG of unmerged hats */
  PetscReal *hessian;         /* [face][dofs][dofs] second derivative of sum lambda G */
  PetscBool *active;          /* [count]: in contact; false where merged */
  PetscBool *held;            /* [count]: no multiplier: an undamaged lamella resists compression, too (lamella.h) */
  PetscInt *position;         /* [face][dofs (dofs + 1)/2]: matrix index of pairs of dofs, row by row */
  PetscInt *coupling;         /* [count][dofs]: matrix index of dof and multiplier */
  PetscReal (*x)[2];          /* [chain] work space: chains of a face, ... */
  LamMortarSegments segments; /* ... their segments */
  LamMortarResult result;
} LamContact;

#endif
