/*
  Private parts of the RVE solver, in the order of the data flow:
    mesh.h element.h     geometry and pointwise physics
    assembly.c           sums over elements: energy, residual, tangent
    linear.c             factorisation, inertia, solves
    newton.c             one equilibrium from a start: fast and safe tier
    stability.c          softest mode of a converged state
    path.c               start, substeps, leaving a saddle
    lumen.c              lumens whose walls have met
    homogenise.c         stress, tangent and couplings by static condensation
    traction.c           interface tractions of bonded faces

  Unknowns are the current positions y of node classes; class 0 is held, so unknown = 2 (class - 1) + component.
*/
#ifndef LAM_RVE_IMPL_H
#define LAM_RVE_IMPL_H

#include <petscmat.h>
#include <lamella/rve.h>
#include "element.h"

#define LAM_PAIRS (LAM_ELEMENT_DOFS * (LAM_ELEMENT_DOFS + 1) / 2)

/* The symmetric matrix in upper compressed rows (values are written in place) and its factor. */
typedef struct {
  PetscInt n, nonzeros;
  PetscInt *row, *column; /* [n+1], [nonzeros]; the diagonal comes first in a row */
  PetscReal *values;      /* [nonzeros] */
  PetscInt *position; /* [element][LAM_PAIRS] index into values, -1: held; pairs of element dofs i <= j, row by row */
  Mat matrix, factor;
  Vec rhs, solution; /* placeholders for the callers' arrays */
  PetscBool analysed;
} LamLinear;

/* Positions of one material point and the load they balance. */
struct LamRVEState_s {
  PetscInt n;   /* length of y */
  PetscReal *y; /* [class][2] */
  LamLoad load;
  PetscInt branch; /* number of saddles left on the way here */
};

typedef struct {
  PetscInt iterations, factorisations;
  PetscInt escapes; /* steps along a direction of negative curvature */
} LamWork;

struct LamRVE_s {
  MPI_Comm comm;
  LamMicrostructure micro;
  LamStrategy strategy;
  PetscBool has_micro, is_set_up, monitor;
  const LamWallLaw *law;
  LamMesh mesh;
  LamElementGeometry *geometry; /* [element] */
  LamElementStress *stress;     /* [element]: independent stresses of the iteration under way */
  LamLinear linear;
  PetscInt ndof;                          /* 2 class_count */
  PetscReal *y, *step, *trial, *residual; /* [ndof] each: position, Newton step, trial position, residual */
  LamWork work;                           /* of the solve under way */
  PetscReal lowest_eigenvalue;            /* of the last unstable state met */
};

/* ---- assembly.c ---- */
PetscErrorCode LamGeometryCreate(LamRVE rve);
/* Positions of an element's nodes: x_a = y_class + F S. */
void LamGatherElement(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt e,
                      PetscReal x[LAM_ELEMENT_NODES][2]);
/* Energy (walls - turgor x lumen), not divided by V0; *valid as LamElementEnergy. */
PetscErrorCode LamAssembleEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                                 PetscBool *valid);
/* Energy, residual [ndof] and, into linear.values, the tangent with independent stresses. */
PetscErrorCode LamAssemble(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                           PetscReal residual[], PetscBool *valid);
/* Moves the independent stresses by alpha along the displacement dy from y. */
void LamUpdateStresses(LamRVE rve, const LamLoad *load, const PetscReal y[], const PetscReal dy[], PetscReal alpha);
/* PETSC_FALSE where an element volume is not positive. */
PetscBool LamPositionsAreValid(LamRVE rve, const LamLoad *load, const PetscReal y[]);
/* Independent stresses := those of positions y; PETSC_FALSE where y is not valid. */
PetscBool LamSetConsistentStresses(LamRVE rve, const LamLoad *load, const PetscReal y[]);
/* Area inside the lumens and its gradient (added to gradient [ndof], may be NULL) times `factor`. */
PetscReal LamLumenArea(LamRVE rve, const PetscReal y[], PetscReal factor, PetscReal gradient[]);
/* Norm of the residual without the held class. */
PetscReal LamResidualNorm(LamRVE rve, const PetscReal residual[]);

/* ---- linear.c ---- */
PetscErrorCode LamLinearCreate(const LamMesh *mesh, LamLinear *linear);
PetscErrorCode LamLinearCreateMatrix(LamLinear *linear); /* needs PETSc; the rest above does not */
PetscErrorCode LamLinearDestroy(LamLinear *linear);
/* Factors values + shift 1. *ok is PETSC_FALSE where the matrix is singular to working precision. */
PetscErrorCode LamLinearFactor(LamLinear *linear, PetscReal shift, PetscInt *negative, PetscBool *ok);
/* solution = K^-1 rhs, arrays of length n; count right-hand sides, one after the other. */
PetscErrorCode LamLinearSolve(LamLinear *linear, PetscInt count, const PetscReal rhs[], PetscReal solution[]);
void LamLinearMultiply(const LamLinear *linear, const PetscReal x[], PetscReal y[]);

/* ---- newton.c ---- */
/* Iterations that one state may take in all, substeps included: some seconds on the default mesh. */
#define LAM_ITERATION_BUDGET 2000
typedef enum { LAM_NEWTON_CONVERGED, LAM_NEWTON_NEAR_SADDLE, LAM_NEWTON_STALLED } LamNewtonOutcome;
/* From rve->y to equilibrium at `load`. Fast: full steps. Safe: inertia-corrected steps that lower the energy and leave
   saddles; never ends NEAR_SADDLE. */
PetscErrorCode LamNewtonFast(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome);
PetscErrorCode LamNewtonSafe(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome);
/* Tolerance of the residual norm: the rounding error of the stiff forces, but at least 1e-11. */
PetscReal LamNewtonTolerance(LamRVE rve);

/* ---- stability.c ---- */
/* Assembles and factors the consistent tangent at rve->y and counts its negative eigenvalues. */
PetscErrorCode LamFactorConsistent(LamRVE rve, const LamLoad *load, PetscInt *negative, PetscBool *ok);
/* A start for the softest mode without the symmetry of the cell, so that no mode is missed, the same in every run. */
void LamStartMode(LamRVE rve, PetscReal mode[]);
/* Inverse iterations with the present factor; unit vector, its largest entry positive, so that the branch taken is the
   same in every run. */
PetscErrorCode LamImproveSoftestMode(LamRVE rve, PetscInt iterations, PetscReal mode[]);
/* The most negative eigenvalue of the matrix in linear.values and its unit eigenvector, mode[n]. */
PetscErrorCode LamSoftestMode(LamRVE rve, PetscReal *eigenvalue, PetscReal mode[]);

/* ---- path.c ---- */
/* Finds a stable equilibrium at `load` from `state`; leaves it in rve->y with the consistent tangent factored. */
PetscErrorCode LamFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, PetscInt *branch, PetscInt *negative,
                             LamStatus *status, char reason[], size_t length);

/* ---- lumen.c ---- */
/* The first cell whose inner loop crosses itself at positions y, -1: none. */
PetscErrorCode LamFindCollapsedLumen(LamRVE rve, const PetscReal y[], PetscInt *cell);

/* ---- homogenise.c, traction.c ---- */
/* Fills energy, P, tangent, couplings and lumen fraction from rve->y and the factored consistent tangent. */
PetscErrorCode LamHomogenise(LamRVE rve, const LamLoad *load, LamResponse *response);
/* Mean normal traction per face family and the largest one averaged over a wall thickness (Cauchy). */
PetscErrorCode LamFaceTractions(LamRVE rve, const LamLoad *load, PetscReal mean[3], PetscReal *largest);

#endif
