/*
  Private parts of the macroscale solver.

  mesh.c      box mesh, numbering, shape function gradients
  boundary.c  displacement conditions, reactions, work
  assembly.c  gather F, ask the responder, assemble force and tangent
  stepping.c  Newton, load steps, cutback
  fields.c    gathering of fields on rank 0
*/
#ifndef LAM_MACRO_IMPL_H
#define LAM_MACRO_IMPL_H

#include <petscdmplex.h>
#include <petscsf.h>
#include <petscsnes.h>
#include <lamella/macro.h>

enum {
  LAM_MACRO_NODES = 9,  /* nodes of an element: centre, edges, corners (order of DMPlex closures) */
  LAM_MACRO_POINTS = 9, /* Gauss points of an element */
  LAM_MACRO_DOFS = 2 * LAM_MACRO_NODES
};

/* Sides of the body, as bits; DMPlex's label "Face Sets" numbers the sides of a box 1..4 in this order. */
enum { LAM_SIDE_BOTTOM = 1, LAM_SIDE_RIGHT = 2, LAM_SIDE_TOP = 4, LAM_SIDE_LEFT = 8 };

/* What the solver keeps of a material point's response. */
typedef struct {
  PetscBool known; /* the rest belongs to `load` */
  LamLoad load;
  PetscReal P[9];
  PetscReal A[2][2][2][2]; /* dP_ij/dF_kl in the plane */
  PetscReal lumen_fraction, opening_fraction, debonded_fraction, max_gap;
} LamMaterialPoint;

/* A displacement component that is prescribed; kept by the rank that owns it. */
typedef struct {
  PetscInt local;     /* index in this rank's part of a global vector */
  PetscReal base;     /* displacement where the conditions count from */
  PetscReal end;      /* what is added to it at load factor 1 */
  PetscReal target;   /* displacement wanted now */
  unsigned int sides; /* bit s: the s-th named side prescribes it; 0 where only rigid motions are held */
} LamConstraint;

struct LamMacro_s {
  MPI_Comm comm;
  const LamScene *scene;   /* borrowed */
  LamResponder *responder; /* borrowed */
  LamMacroMonitor monitor;
  void *monitor_ctx;       /* borrowed */
  PetscBool (*stop)(void); /* NULL: never */
  PetscBool stopped;       /* it was asked for; the same on all ranks */

  /* mesh */
  DM dm;
  PetscInt cell_start, cell_end; /* elements of this rank */
  PetscInt mesh_start, mesh_end; /* mesh points (cells, edges, vertices) of this rank: the nodes */
  PetscInt *number;              /* [mesh points] number in the undistributed mesh, the same for any count of ranks */
  PetscReal *position;           /* [mesh points][2] reference position of the node */
  unsigned char *sides;          /* [mesh points] LAM_SIDE_ bits */
  PetscReal *gradient;           /* [elements][points][nodes][2] dN/dX */
  PetscReal *weight;             /* [elements][points] area of a Gauss point */

  /* material points, element * 9 + Gauss point */
  PetscInt point_count;
  PetscInt *point_index; /* 0, 1, 2, ... for the responder */
  LamLoad *loads;
  LamResponse *responses;
  LamMaterialPoint *now, *accepted; /* of the last evaluation and of the last converged state */

  /* unknowns */
  Vec u, trial, residual;    /* displacement: last converged, Newton iterate; residual of Newton */
  Vec force, force_accepted; /* internal nodal forces of the last evaluation and of the last converged state */
  Mat tangent;
  SNES snes;
  PetscReal turgor;      /* turgor of the tissue now */
  PetscReal force_scale; /* largest norm of the element forces in this series of Newton iterations */
  PetscReal history[64];
  char trouble[LAM_MESSAGE_LENGTH - 64]; /* why the last evaluation failed; how far it came is said before it */

  /* boundary */
  PetscInt constraint_count;
  LamConstraint *constraints;

  LamMacroStep step;    /* being filled */
  LamResponder counted; /* counters at the start of the step */
};

/* mesh.c */
PetscErrorCode LamMacroMeshCreate(LamMacro macro);
PetscErrorCode LamMacroMeshDestroy(LamMacro macro);

/* boundary.c */
/* Refuses conditions that contradict each other (PETSC_ERR_USER_INPUT). */
PetscErrorCode LamMacroBoundaryCheck(const LamMacroSpec *spec);
/* Fills the names of the step's sides: each named side once. */
PetscErrorCode LamMacroBoundaryNames(const LamMacroSpec *spec, LamMacroStep *step);
/* Holds one corner, and one component of the next, so that only rigid motions are prevented. */
PetscErrorCode LamMacroHoldRigidMotions(LamMacro macro);
/* Prescribes the scene's displacements, counted from the present ones; PETSC_ERR_USER_INPUT where they leave a rigid
 * motion free. */
PetscErrorCode LamMacroHoldBoundaries(LamMacro macro);
PetscErrorCode LamMacroSetLoadFactor(LamMacro macro, PetscReal load_factor);
/* Replaces the force residual of prescribed components by (displacement - target), in units of C1 + C2. */
PetscErrorCode LamMacroConstrainResidual(LamMacro macro, Vec u, Vec residual);
PetscErrorCode LamMacroConstrainTangent(LamMacro macro, Mat tangent);
/* Adds the work of the boundary forces between the last converged state and `trial` (trapezoidal rule). */
PetscErrorCode LamMacroAddWork(LamMacro macro);
PetscErrorCode LamMacroReactions(LamMacro macro, LamMacroStep *step);

/* assembly.c */
/*
  Responses of all points at displacement u. *ok is PETSC_FALSE on all ranks where one is missing (`trouble` says which)
  or a stop was asked for (`stopped`).
  Nothing is asked where deformation and turgor are those of the last evaluation.
*/
PetscErrorCode LamMacroEvaluate(LamMacro macro, Vec u, PetscBool *ok);
/* Internal nodal forces of the evaluated state; *scale is the norm of the element forces, before they cancel. */
PetscErrorCode LamMacroAssembleForce(LamMacro macro, Vec force, PetscReal *scale);
PetscErrorCode LamMacroAssembleTangent(LamMacro macro, Mat tangent);

/* stepping.c */
PetscErrorCode LamMacroNewtonCreate(LamMacro macro);

#endif
