/*
  Private parts of the RVE solver, in the order of the data flow:
    mesh.h element.h     geometry and pointwise physics
    assembly.c           sums over elements: energy, residual, tangent
    turgor.c             areas of lumens, pressures of sealed ones
    gap_area.c           area between the cells, on which cohesion works
    linear.c factor.c cholesky.c          sparsity pattern; factorisation, inertia, solves
    newton.c newton_flow.c newton.h       one equilibrium from a start: fast, flow and safe tier
    border.h             components of F that join the unknowns where stress is prescribed
    interrupt.c          factorisations that ask whether to go on
    stability.c          softest mode of a converged state
    path.c               start, substeps, leaving a saddle, what ends a way
    mortar.c mortar_segments.c            gaps between two chains of edges and their variations
    contact.c            cell faces in contact: pairs, junctions, active set
    contact_step.c contact_update.c contact_newton.c contact_safe.c    one contact equilibrium from a start
    contact_start.c contact_try.c contact_walk.c contact_path.c           starts, judging a solution, ways to it
    nested.c             a start from the solution of a coarser mesh
    lumen.c overlap.c    lumens whose walls have met, cells that lie in each other
    homogenise.c         stress, tangent and couplings by static condensation
    mixed.c mixed_fast.c mixed_safe.c     states of which some components of P are prescribed
    traction.c           largest means along faces; interface tractions of bonded faces
    failure.c            stretch, energy and tension of the walls, and whether they kink (wall_ellipticity.h)
    estimate.c           error of P from half as many elements
    indicators.c interface.c              how far cells have come apart; gaps and pressures for pictures

  Unknowns are the current positions y of node classes; class 0 is held, so unknown = 2 (class - 1) + component. An RVE
  that can be sealed has the pressure of each lumen, too: in y after the positions, in the matrix after all else.
*/
#ifndef LAM_RVE_IMPL_H
#define LAM_RVE_IMPL_H

#include <lamella/rve.h>
#include "border.h"
#include "contact.h"
#include "element.h"
#include "factor.h"

#define LAM_PAIRS (LAM_ELEMENT_DOFS * (LAM_ELEMENT_DOFS + 1) / 2)

/* Classes that are coupled beyond elements: `count` sets of `size` classes, each with unknowns of its own, multipliers.
 */
typedef struct {
  PetscInt count, size, multipliers;
  const PetscInt *classes; /* [count][size] */
} LamCouplings;

/*
  The symmetric matrix in upper compressed rows (values are written in place) and its factor. Its unknowns are the
  positions, then the multipliers of the couplings, set by set, then the pressures of lumens that can be sealed.
*/
typedef struct {
  PetscInt n, nonzeros;
  PetscInt positions;     /* unknowns that are positions */
  PetscInt lumens;        /* unknowns that are pressures */
  PetscInt *row, *column; /* [n+1], [nonzeros]; the diagonal comes first in a row */
  PetscReal *values;      /* [nonzeros] */
  PetscInt *position; /* [element][LAM_PAIRS] index into values, -1: held; pairs of element dofs i <= j, row by row */
  LamFactor factor;   /* owned */
  PetscInt negative;  /* eigenvalues of the matrix last factored */
  PetscReal rate;     /* how far the factor is from the matrix at the positions reached: about the share of a residual
                         that a step with it leaves; infinite: not known */
  PetscBool nearby;   /* the factor is of a matrix near `values`: solves refine */
} LamLinear;

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

static inline PetscReal LamLargestEntry(PetscInt n, const PetscReal v[])
{
  PetscReal largest = 0.0;

  for (PetscInt i = 0; i < n; ++i) largest = PetscMax(largest, PetscAbsReal(v[i]));
  return largest;
}

static inline PetscReal LamInnerProduct(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0.0;

  for (PetscInt i = 0; i < n; ++i) sum += a[i] * b[i];
  return sum;
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
/* Sets the rows of the multipliers in linear.values: -dG and -compliance D for active hats, 0 and 1 for the others. */
void LamContactSetRows(LamRVE rve, PetscReal compliance);

/* ---- gap_area.c; the rest is in gap_area.h ---- */
void LamGapAreaSetMatrix(const LamLinear *linear, LamGapArea *area);

/* ---- linear.c ---- */
/* couplings: NULL for none; lumens: number of cells, or 0 where they cannot be sealed. */
PetscErrorCode LamLinearCreate(const LamMesh *mesh, const LamCouplings *couplings, PetscInt lumens, LamLinear *linear);
/* Index into values of the entry of unknowns i and j, which must be coupled; -1 where one of them is negative. */
PetscInt LamLinearEntry(const LamLinear *linear, PetscInt i, PetscInt j);
PetscErrorCode LamLinearCreateMatrix(MPI_Comm comm, LamLinear *linear); /* needs PETSc; the rest above does not */
PetscErrorCode LamLinearDestroy(LamLinear *linear);
/* Factors values + shift 1 (on the positions). *ok is PETSC_FALSE where the matrix is singular to working precision. */
PetscErrorCode LamLinearFactor(LamLinear *linear, PetscReal shift, PetscInt *negative, PetscBool *ok);
/* solution = K^-1 rhs with the last factor, arrays of length n; count right-hand sides, one after the other. */
PetscErrorCode LamLinearSolveOnce(LamLinear *linear, PetscInt count, const PetscReal rhs[], PetscReal solution[]);
/* The same where the factor may be a nearby one: refines until the rest, rhs - K solution, is small. */
PetscErrorCode LamLinearSolve(LamLinear *linear, PetscInt count, const PetscReal rhs[], PetscReal solution[],
                              PetscReal rest[]);
void LamLinearMultiply(const LamLinear *linear, const PetscReal x[], PetscReal y[]);

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

/* ---- newton.c ---- */
typedef enum { LAM_NEWTON_CONVERGED, LAM_NEWTON_NEAR_SADDLE, LAM_NEWTON_STALLED } LamNewtonOutcome;
/* From rve->y to equilibrium at `load`. Fast: full steps. Safe: inertia-corrected steps that lower the energy and leave
   saddles; never ends NEAR_SADDLE. border: NULL, or the free components of F; the load is then border->load. */
#define LAM_NEAR_RATE 1e-3 /* rate of a factor that serves for more than its own iteration */
PetscErrorCode LamNewtonFast(LamRVE rve, const LamLoad *load, LamBorder *border, LamNewtonOutcome *outcome);
PetscErrorCode LamNewtonSafe(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome);
/* The same by patience, from unstable starts; shut: the cell whose lumen it came down to shut, -1: none. */
PetscErrorCode LamNewtonFlow(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome, PetscInt *shut);
/* Tolerance of the residual norm: the rounding error of the stiff forces, but at least 1e-11. */
PetscReal LamNewtonTolerance(LamRVE rve);

/* ---- stability.c ---- */
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

/* ---- path.c ---- */
/* Rotation angle of the polar decomposition of the in-plane part of F. */
PetscReal LamRotationAngle(const PetscReal F[9]);
/* Rotates positions y[n] and the deformation gradient they belong to about the origin. */
void LamRotatePositions(PetscInt n, PetscReal y[], PetscReal F[9], PetscReal angle);
/* rve->y := from [length] + (F_to - F_from) X, with the independent stresses and pressures of `from`. */
void LamMoveAffinely(LamRVE rve, const PetscReal from[], const LamLoad *load_from, const LamLoad *load_to);
/* The load at the share t of the straight way from a to b. */
LamLoad LamLoadBetween(const LamLoad *a, const LamLoad *b, PetscReal t);
/* Finds a stable equilibrium at `load` from `state`; leaves it in rve->y with the consistent tangent factored. */
PetscErrorCode LamFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, PetscInt *branch, PetscInt *negative,
                             LamStatus *status, char reason[], size_t length);

/* " between 0.25 and 0.26 of the way"; empty where the second share is not above the first: not known. */
PetscErrorCode LamBracketText(const PetscReal between[2], char text[], size_t length);

/* ---- contact_step.c ---- */
#define LAM_CONTACT_PROXIMAL 1e-8 /* shift of every contact step: a cell that nothing holds must not be singular */
/* Of max |min(lambda, c gap)|. */
static inline PetscReal LamGapTolerance(LamRVE rve)
{
  return PetscMax(1e-10, rve->tolerance);
}
typedef struct {
  PetscReal *rhs, *solution, *image; /* work space */
  PetscReal *lambda;                 /* [multipliers] after the step */
  PetscReal *first;                  /* the solution with the last factor, ... */
  PetscBool *factored;               /* ... and its active set, [multipliers] */
  PetscBool updates;                 /* other sets may be solved with that factor */
  PetscReal shift;                   /* of the last factor */
  PetscReal floor;                   /* least shift: the larger, the shorter the step */
  PetscReal before;                  /* largest entry of the step before */
  LamBorder *border;                 /* borrowed; NULL: F is prescribed */
} LamContactStep;
PetscErrorCode LamContactStepCreate(LamRVE rve, LamContactStep *step);
PetscErrorCode LamContactStepDestroy(LamContactStep *step);
/* After LamAssemble: takes the held forces off rve->residual; norm: of the residual with contact forces. */
void LamContactResidual(LamRVE rve, LamContactStep *step, PetscReal *norm);
/* solution [n] of the present active set from `first`, that of the set `before`, whose matrix is factored. *ok is
   PETSC_FALSE where the sets differ in too many hats, or the new matrix has too many negative eigenvalues. */
PetscErrorCode LamContactUpdateStep(LamRVE rve, const PetscBool before[], const PetscReal first[], PetscReal compliance,
                                    PetscReal solution[], PetscBool *ok);
/* rve->step and step->lambda from the assembled state with its contact curvature; norm: of its residual. *ok is
   PETSC_FALSE where no shift helps. */
PetscErrorCode LamContactSolveStep(LamRVE rve, PetscReal norm, PetscReal compliance, LamContactStep *step,
                                   PetscBool *ok);
/* Moves positions, wall stresses, multipliers and a free F by alpha. */
void LamContactTakeStep(LamRVE rve, const LamLoad *load, PetscReal alpha, const LamContactStep *step);

/* ---- contact_newton.c, contact_safe.c, contact_path.c ---- */
/* From rve->y, contact->lambda and the independent stresses to equilibrium at `load`. Fast: full steps; one larger than
   `reach` (apothems) ends it as stalled; LAM_FAR: the start may be far from contact, steps are shortened. Safe: descent
   on the energy, from consistent stresses. border: as in LamNewtonFast. */
#define LAM_FAR 0.0
PetscErrorCode LamContactNewton(LamRVE rve, const LamLoad *load, LamBorder *border, PetscReal reach,
                                LamNewtonOutcome *outcome);
PetscErrorCode LamContactNewtonSafe(LamRVE rve, const LamLoad *load, LamNewtonOutcome *outcome);
/* As LamFollowPath; the solution is in rve->y and contact->lambda. */
PetscErrorCode LamContactFollowPath(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);

/* ---- fields.c ---- */
/* Coefficients of 1, xi, eta, xi eta in the least-squares fit to the values at the Gauss points of an element. */
void LamFitBilinear(const PetscReal gauss[LAM_GAUSS], PetscReal c[4]);

/* ---- nested.c ---- */
/* Whether a solve from `state` is to start from a coarser mesh. */
PetscBool LamIsNested(LamRVE rve, const LamRVEState state);
/* Solves on a coarser mesh, whose response is given; where it converged, `start` becomes its solution on this one. */
PetscErrorCode LamNestedStart(LamRVE rve, const LamLoad *load, LamRVEState start, LamResponse *coarse_response);

/* ---- lumen.c, overlap.c ---- */
/* The first cell whose inner loop crosses itself or is inside out at positions y, -1: none. */
PetscErrorCode LamFindCollapsedLumen(LamRVE rve, const PetscReal y[], PetscInt *cell);
/* between: shares of the way to the load between which its walls first touch, as LamBracketText. */
PetscErrorCode LamCollapseReason(PetscInt cell, const PetscReal between[2], char reason[], size_t length);
/* How deep an outer wall lies inside another cell, apothems, the two cells, and whether that wall faces that cell; 0
   and -1, -1 where none does. */
PetscErrorCode LamFindOverlap(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscReal *depth, PetscInt pair[2],
                              PetscBool *facing);

/* ---- interface.c ---- */
/* How deep walls lie in each other across from each other, apothems; >= 0. */
PetscErrorCode LamFacingDepth(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscReal *depth);

/* ---- homogenise.c, traction.c, failure.c ---- */
/* L_q, L_qq and R = L_yq [LAM_F_COUNT][n] of the components of F at rve->y, after LamAssemble there; rows of R for all
   multipliers, as if they were active. */
PetscErrorCode LamAssembleGradient(LamRVE rve, const LamLoad *load, PetscReal Lq[LAM_F_COUNT],
                                   PetscReal Lqq[LAM_F_COUNT][LAM_F_COUNT], PetscReal R[]);
/* Copies a column [n] with zeros for multipliers that are not active. */
void LamCopyActive(LamRVE rve, const PetscReal column[], PetscReal copy[]);
/* Fills energy, P and lumen fraction from rve->y and, where they are wanted, tangent and couplings with the factored
   consistent tangent. */
PetscErrorCode LamHomogenise(LamRVE rve, const LamLoad *load, LamResponse *response);
/* Whether a value is larger than that of the place named so far by more than rounding (C1 + C2 or apothems): of places
   that symmetry makes alike the first one is named, whatever the last digits. Anything exceeds -PETSC_MAX_REAL. */
static inline PetscBool LamExceeds(PetscReal value, PetscReal named)
{
  return (PetscBool)(value > named + 1e-8 * PetscAbsReal(named) + 1e-10);
}
/* The largest mean over a stretch of a face that is as long as the wall of its cell is thick, and where it is. */
typedef struct {
  PetscReal value, named; /* named: at the place */
  PetscReal place[3]; /* cell, face, middle of the stretch as a share of the face, counter-clockwise around the cell */
} LamLargestMean;
#define LAM_NO_MEAN                                                                                                    \
  {                                                                                                                    \
    .value = -PETSC_MAX_REAL, .named = -PETSC_MAX_REAL, .place = { NAN, NAN, NAN }                                     \
  }
/* A patch of one cell has no face between cells: its largest mean is unknown. */
static inline PetscReal LamLargestMeanValue(const LamLargestMean *largest)
{
  return largest->value > -PETSC_MAX_REAL ? largest->value : NAN;
}
/* Takes a face into account, with windows of length `thickness`: running integrals [count + 1] over sub-intervals, of
   which all elements along the face have as many. */
void LamTakeLargestMean(const LamMesh *mesh, PetscReal thickness, PetscInt cell, PetscInt face, PetscInt count,
                        const PetscReal integral[], const PetscReal length[], LamLargestMean *largest);
/* Bonded tissue: mean normal traction per face family, largest normal and shear traction (Cauchy) and their places. */
PetscErrorCode LamFaceTractions(LamRVE rve, const LamLoad *load, LamResponse *response);
/* Fills the measures of the walls from rve->y. */
PetscErrorCode LamWallMeasures(LamRVE rve, const LamLoad *load, LamResponse *response);
/* Share of the walls' volume that has lost ellipticity at positions y (wall_ellipticity.h). */
void LamFindKinks(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *share);
/* Walls along a way of loads: between which shares of it they lose their ellipticity, and how many have at the last
   stable state. Walls that kink answer for the end of a way, wherever the mesh lets it be. */
typedef struct {
  PetscReal between[2]; /* equal: they do not; the first below 0: they had lost it before */
  PetscReal share;      /* of the walls' volume */
} LamKinking;
#define LAM_NO_KINKING                                                                                                 \
  {                                                                                                                    \
    .between = { -1.0, -1.0 }                                                                                          \
  }
#define LAM_KINKED_SUBSTEP (1.0 / 64.0) /* then this is the smallest substep */
static inline PetscBool LamIsKinking(const LamKinking *kinking)
{
  return (PetscBool)(kinking->between[1] > kinking->between[0]);
}
/* Takes note of a stable state y, a share t of the way. */
void LamWatchKinks(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal t, LamKinking *kinking);
/* reached: the share of the last stable state. */
PetscErrorCode LamKinkReason(const LamKinking *kinking, PetscReal reached, char reason[], size_t length);

/* ---- rve.c ---- */
/* Empty where the load can be asked of plane-strain tissue, else why not. */
PetscErrorCode LamCheckLoad(const LamLoad *load, char reason[], size_t length);
/* A response without answer, no work yet, and nothing left of the solve before: a solve depends on load and state
 * alone. */
PetscErrorCode LamBeginResponse(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);
/* Fills the fields of a response whose status says that rve->y (and the multipliers) are a solution at `load`, with its
   consistent tangent factored, and stores it in `state`; refuses it where a lumen has collapsed. */
PetscErrorCode LamAcceptSolution(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);
/* Junction statuses become those of the state, not those that the solve before has left. */
void LamTakeJunctions(LamRVE rve, LamRVEState state);
/* The solution that rve holds becomes the state. */
void LamKeepState(LamRVE rve, const LamLoad *load, PetscInt branch, LamRVEState state);

/* ---- indicators.c ---- */
/* Fills the debonding indicators from rve->y and the multipliers; of contact tissue the tractions, too. */
PetscErrorCode LamContactIndicators(LamRVE rve, const LamLoad *load, LamResponse *response);
PetscErrorCode LamBondedIndicators(LamRVE rve, const LamLoad *load, LamResponse *response);

#endif
