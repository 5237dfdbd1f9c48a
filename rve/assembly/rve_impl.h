/*
  The RVE and its potential: what all solvers and measures share.

    assembly.c     sums over elements: energy, residual, tangent
    turgor.c       areas of lumens, pressures of sealed ones
    contact.c      cell faces in contact: pairs, junctions, active set
    interrupt.c    factorisations that ask whether to go on
    stability.c    softest mode of a state
    overlap.c interface.c    cells that lie in each other; gaps and pressures for pictures

  Unknowns are the current positions y of node classes; class 0 is held, so unknown = 2 (class - 1) + component. An RVE
  that can be sealed has the pressure of each lumen, too: in y after the positions, in the matrix after all else.
*/
#ifndef LAM_RVE_IMPL_H
#define LAM_RVE_IMPL_H

#include <lamella/rve.h>
#include "contact.h"
#include "linear.h"

/* Positions of one material point and the load they balance. */
struct LamRVEState_s {
  PetscInt n;   /* length of y */
  PetscReal *y; /* [class][2], then [lumens]: the pressures */
  LamLoad load;
  PetscInt branch; /* number of saddles left on the way here */
  /* contact tissue only */
  PetscInt multipliers;
  PetscReal *lambda; /* [multipliers] */
  PetscInt faces;
  PetscInt (*hats)[2]; /* [faces] junction status: first and last hat */
  PetscBool solved;    /* y and lambda are a solution, not the reference */
  LamRVEState bonded;  /* of the bonded tissue; owned */
};

typedef struct {
  PetscInt iterations, factorisations;
  PetscInt escapes;  /* steps along a direction of negative curvature */
  PetscBool stopped; /* by the interrupt: no more is factored or iterated */
} LamWork;

/* What sealed cells keep. */
typedef struct {
  PetscBool allowed;      /* the matrix has room for the pressures */
  PetscBool closed;       /* now; else turgor is prescribed */
  PetscReal bulk_modulus; /* K_w */
  PetscReal *water;       /* [cell] V_w, apothems^2: the lumen with the turgor of the load; none where not allowed */
  PetscReal *area;        /* [cell] work space */
  PetscReal *factor;      /* [cell] work space */
} LamSeal;

struct LamRVE_s {
  MPI_Comm comm;
  LamMicrostructure micro;
  LamStrategy strategy;
  PetscReal tolerance; /* asked of solves; 0: rounding */
  LamWanted wanted;    /* of responses */
  PetscBool has_micro, is_set_up, monitor;
  const LamWallLaw **law; /* [cell]; owned, the laws are not */
  PetscReal stiffest;     /* bulk and fibre modulus, of the stiffest cell */
  PetscInt changes;       /* how often the moduli were changed */
  PetscReal thinnest;     /* wall, apothems */
  LamMesh mesh;
  LamElementGeometry *geometry; /* [element] */
  LamElementStress *stress;     /* [element]: independent stresses of the iteration under way */
  LamLinear linear;
  LamContact *contact;      /* NULL for bonded tissue; owned */
  LamRVE bonded;            /* contact tissue: the same tissue, bonded; owned */
  LamRVEState bonded_state; /* of `bonded`, work space; owned */
  LamSeal seal;
  PetscInt ndof;                          /* 2 class_count */
  PetscInt length;                        /* ndof + linear.lumens */
  PetscReal *y, *step, *trial, *residual; /* [length] each: position, Newton step, trial position, residual */
  LamWork work;                           /* of the solve under way */
  PetscInt budget;                        /* iterations that it may take until now */
  PetscBool (*interrupt)(void *ctx);      /* NULL: never */
  void *interrupt_ctx;                    /* borrowed */
  PetscBool consistent;                   /* residual and linear.values are those of y with its own wall stresses */
  PetscBool moved;                        /* y has been moved affinely since it was a solution */
  PetscReal lowest_eigenvalue;            /* of the last unstable state met */
  PetscInt zero_modes;                    /* of the consistent tangent last factored */
};

/* Of the cell that an element belongs to. */
static inline const LamWallLaw *LamLawOf(LamRVE rve, PetscInt element)
{
  return rve->law[rve->mesh.cell_of[element]];
}
static inline const LamWall *LamWallOf(LamRVE rve, PetscInt element)
{
  return rve->micro.cell ? &rve->micro.cell[rve->mesh.cell_of[element]].wall : &rve->micro.wall;
}
/* Turgor of a cell over that of the load. */
static inline PetscReal LamTurgorFactor(LamRVE rve, PetscInt cell)
{
  return rve->micro.cell ? rve->micro.cell[cell].turgor : 1.0;
}

/* Whether there is pressure in any lumen, whatever the positions. */
static inline PetscBool LamHasTurgor(LamRVE rve, const LamLoad *load)
{
  return (PetscBool)(rve->seal.closed || load->turgor != 0.0);
}

/* Pressure in a lumen at y. */
static inline PetscReal LamTurgor(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscInt cell)
{
  return rve->seal.closed ? y[rve->ndof + cell] : load->turgor * LamTurgorFactor(rve, cell);
}

/* Thickness of the thinner wall between two cells. */
static inline PetscReal LamFaceThickness(LamRVE rve, PetscInt a, PetscInt b)
{
  return PetscMin(LamWallThickness(&rve->micro, a), LamWallThickness(&rve->micro, b));
}

static inline void LamNodePosition(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt node, PetscReal x[2])
{
  const PetscReal *S = &rve->mesh.shift[2 * node], *position = &y[2 * rve->mesh.node_class[node]];

  x[0] = position[0] + F[0] * S[0] + F[1] * S[1];
  x[1] = position[1] + F[3] * S[0] + F[4] * S[1];
}

/* ---- assembly.c ---- */
PetscErrorCode LamGeometryCreate(LamRVE rve);
/* Positions of an element's nodes: x_a = y_class + F S. */
void LamGatherElement(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt e,
                      PetscReal x[LAM_ELEMENT_NODES][2]);
/* Displacements of an element's nodes, u_a = x_a - X_a as y_class - X_class + (F - 1) S: with all digits of their own.
 */
void LamGatherDisplacements(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt e,
                            PetscReal u[LAM_ELEMENT_NODES][2]);
/* Suction on walls that have a partner, per reference thickness: g F33; 0 for bonded tissue. */
PetscReal LamSuction(LamRVE rve, const LamLoad *load);
/* Energy (walls - p V_lumen + g V_gap; in sealed lumens that of the water), not divided by V0; *valid as
   LamElementEnergy. */
PetscErrorCode LamAssembleEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                                 PetscBool *valid);
/* Energy, residual [length] and, into linear.values, the tangent with independent stresses. */
PetscErrorCode LamAssemble(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                           PetscReal residual[], PetscBool *valid);
/* Moves the independent stresses by alpha along the displacement dy from y and the change dF from load->F. */
void LamUpdateStresses(LamRVE rve, const LamLoad *load, const PetscReal y[], const PetscReal dy[],
                       const PetscReal dF[9], PetscReal alpha);
/* PETSC_FALSE where an element volume is not positive. */
PetscBool LamPositionsAreValid(LamRVE rve, const LamLoad *load, const PetscReal y[]);
/* Independent stresses := those of positions y; PETSC_FALSE where y is not valid. */
PetscBool LamSetConsistentStresses(LamRVE rve, const LamLoad *load, const PetscReal y[]);
/* Norm of the residual without the held class. */
PetscReal LamResidualNorm(LamRVE rve, const PetscReal residual[]);

/* ---- turgor.c ---- */
/* Areas inside the lumens, [cell]; the gradient of sum factor[cell] area[cell] is added to gradient [ndof]. */
void LamLumenAreas(LamRVE rve, const PetscReal y[], PetscReal area[]);
void LamLumenAddGradient(LamRVE rve, const PetscReal y[], const PetscReal factor[], PetscReal gradient[]);
/* Adds the potential -pressure area of an innermost element to its residual and tangent. */
void LamAddPressure(const PetscReal x[LAM_ELEMENT_NODES][2], PetscReal pressure, LamElementResult *element);
/* -p V_lumen, or of sealed lumens the energy of their water, from the positions in y alone. */
PetscReal LamTurgorEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[]);
/* Rows of the pressures in linear.values and in residual [length], where they have any. */
void LamSealAssemble(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal residual[]);
/* Rows of pressures that nothing moves. */
void LamSealSetOpen(LamRVE rve);
/* Pressures in y := those of the lumens at its positions. */
void LamSealSetConsistent(LamRVE rve, const LamLoad *load, PetscReal y[]);
/* Sum of the squares of the pressures' residuals, apothems^2 or, of soft water, its pressure. */
PetscReal LamSealError(LamRVE rve, const PetscReal residual[]);
/* Fills the turgor reached. */
void LamTurgorMeasures(LamRVE rve, const LamLoad *load, LamResponse *response);

/* ---- contact.c ---- */
#define LAM_CONTACT_SCALE 9.0   /* weighs gaps (apothems) against multipliers (C1 + C2): 1 MPa per apothem by default */
#define LAM_HYSTERESIS 0.2      /* of the junction status, in half-edges; ... */
#define LAM_MORE_HYSTERESIS 0.1 /* ... added each time a solution has changed it */
PetscErrorCode LamContactCreate(const LamMicrostructure *micro, const LamMesh *mesh, LamContact **contact);
PetscErrorCode LamContactSetMatrix(const LamLinear *linear, LamContact *contact);
PetscErrorCode LamContactDestroy(LamContact **contact);
/* Chains of face f at positions y; x[chain][2] is work space that they point into. */
LamMortarChains LamContactChains(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt f, PetscReal x[][2]);
/* Gaps, weights, rows and second derivatives at positions y with the present multipliers. follow: the junction status
   follows y, else it stays. */
PetscErrorCode LamContactEvaluate(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscBool follow);
/* Whether the junction status is the one of positions y. */
PetscErrorCode LamContactStatusHolds(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscBool *holds);
/* Active set of the last evaluation: lambda - c (gap + compliance lambda) > 0. Returns the number of changes. */
PetscInt LamContactFindActive(LamContact *contact, PetscReal compliance);
PetscInt LamContactCountActive(const LamContact *contact);
/* max |min(lambda, c gap)| over all hats. */
PetscReal LamContactComplementarity(const LamContact *contact);
/* residual [ndof] += -B^T lambda. */
void LamContactAddForce(LamRVE rve, PetscReal residual[]);
/* The active set that positions after `step` [ndof], F after dF and multipliers lambda would have, by the present
   linearisation. Returns the number of changes. */
PetscErrorCode LamContactPredictActive(LamRVE rve, const PetscReal step[], const PetscReal dF[9],
                                       const PetscReal lambda[], PetscReal compliance, PetscInt *changes);
/* Adds the second derivative of -sum lambda G to linear.values. */
void LamContactAddCurvature(LamRVE rve);
/* Junction statuses become those of the state, not those that the solve before has left. */
void LamTakeJunctions(LamRVE rve, LamRVEState state);
/* Sets the rows of the multipliers in linear.values: -dG and -compliance D for active hats, 0 and 1 for the others. */
void LamContactSetRows(LamRVE rve, PetscReal compliance);

/* ---- interrupt.c ---- */
/* As LamLinearFactor of rve->linear, and counts it. Once the interrupt has stopped the solve *ok is PETSC_FALSE, and
   there may be no factor to solve with. */
PetscErrorCode LamRVEFactor(LamRVE rve, PetscReal shift, PetscInt *negative, PetscBool *ok);
/* Adds the work of a part of the solve, which ends with it where it was stopped. */
void LamAddWork(LamRVE rve, const LamResponse *part);
static inline PetscBool LamWasStopped(const LamResponse *response)
{
  return (PetscBool)(response->status == LAM_OUT_OF_REACH);
}
/* The response of a solve that was stopped. */
PetscErrorCode LamGiveUp(LamResponse *response);
/* Iterations that one state may take in all, substeps included: some seconds on the default mesh. */
#define LAM_ITERATION_BUDGET 2000
static inline PetscBool LamMayIterate(LamRVE rve)
{
  return (PetscBool)(rve->work.iterations < rve->budget && !rve->work.stopped);
}

/* Of the thinnest wall, per square of an apothem's length of it, C1 + C2: shifts that are larger from the start hide
   how it buckles. */
static inline PetscReal LamBendingStiffness(LamRVE rve)
{
  return PetscPowReal(rve->thinnest, 3.0);
}

/* ---- stability.c ---- */
#define LAM_NEAR_RATE 1e-3 /* rate of a factor that serves for more than its own iteration */
/* Negative eigenvalues that the matrix of a stable state has: one for each active multiplier and sealed lumen. */
PetscInt LamExpectedNegative(LamRVE rve);
/* Sets rve->zero_modes, too. Assembles and factors the consistent tangent at rve->y and counts its negative
   eigenvalues beyond the expected ones. */
PetscErrorCode LamFactorConsistent(LamRVE rve, const LamLoad *load, PetscInt *negative, PetscBool *ok);
/* A start for the softest mode without the symmetry of the cell, so that no mode is missed, the same in every run. */
void LamStartMode(LamRVE rve, PetscReal mode[]);
/* Inverse iterations with the present factor; a unit vector of positions, its largest entry positive, so that the
   branch taken is the same in every run, the change of pressures that goes with it, and no part of the multipliers. */
PetscErrorCode LamImproveSoftestMode(LamRVE rve, PetscInt iterations, PetscReal mode[]);
/* to [length] += factor mode */
void LamAddMode(LamRVE rve, PetscReal factor, const PetscReal mode[], PetscReal to[]);
/* mode . residual [length] */
PetscReal LamModeSlope(LamRVE rve, const PetscReal mode[], const PetscReal residual[]);
/* mode . K mode with the matrix in linear.values; image [n] is work space. */
PetscReal LamModeCurvature(LamRVE rve, const PetscReal mode[], PetscReal image[]);
/* The lowest eigenvalue of the matrix in linear.values and its unit eigenvector, mode[n]; where the solve is
   stopped, NaN and some vector. */
PetscErrorCode LamSoftestMode(LamRVE rve, PetscReal *eigenvalue, PetscReal mode[]);

/* ---- overlap.c ---- */
/* How deep an outer wall lies inside another cell, apothems, the two cells, and whether that wall faces that cell; 0
   and -1, -1 where none does. */
PetscErrorCode LamFindOverlap(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscReal *depth, PetscInt pair[2],
                              PetscBool *facing);

/* ---- interface.c ---- */
/* How deep walls lie in each other across from each other, apothems; >= 0. */
PetscErrorCode LamFacingDepth(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscReal *depth);

#endif
