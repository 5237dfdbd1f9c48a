/*
  The RVE and its potential: shared by all solvers and measures.

    assembly.c     sums over elements: energy, residual, tangent
    turgor.c       areas of lumens, pressures of sealed ones
    smooth_contact.c    contact of all walls by a smooth potential; couplings of walls that meet
    antiplane.c    the third component of positions
    lamella.c      the lamella between facing walls, which breaks
    memory.c       walls with memory
    part.c         sums and linear systems of a part of the cells
    contact.c      the exact law between facing walls: pairs, junctions, active set
    interrupt.c    factorisations that check the interrupt; refusals
    stability.c    softest mode of a state
    smooth_pressures.c  contact pressures and penetrations of the smooth law
    interface.c    gaps, pressures and the lamella for pictures

  Unknowns are the current positions y of node classes; class 0 is prescribed, so unknown = 2 (class - 1) + component.
  An RVE that can be sealed also has the pressure of each lumen: in y after the positions, in the matrix after all
  other unknowns.
*/
#ifndef LAM_RVE_IMPL_H
#define LAM_RVE_IMPL_H

#include <lamella/rve.h>
#include "contact.h"
#include "lamella.h"
#include "linear.h"
#include "memory.h"
#include "smooth_contact.h"

#define LAM_LARGE 2000      /* elements, from which a coarser mesh is solved first and only one factor is kept */
#define LAM_ENERGY_COUNT 10 /* Psi, then its derivatives with respect to F11, F12, F21, F22, F33, p, g, F31, F32 */

/* Positions of one material point and the load they equilibrate. */
struct LamRVEState_s {
  PetscInt n;   /* length of y */
  PetscReal *y; /* [class][2], then [lumens]: the pressures */
  LamLoad load;
  PetscInt branch; /* number of saddle points left along the load path so far */
  /* contact tissue only */
  PetscInt multipliers;
  PetscReal *lambda; /* [multipliers] */
  PetscInt faces;
  PetscInt (*hats)[2]; /* [faces] junction status: first and last hat */
  PetscBool solved;    /* y and lambda are a solution, not the reference state */
  PetscReal width;     /* of the smooth law that it solves, apothems; 0: the exact law */
  /* law `lamella` only */
  PetscInt points;
  LamBondHistory *history;   /* [points] */
  PetscReal spent, released; /* energies per V0 so far: dissipated, lost in jumps */
  PetscReal juice;           /* volume per V0 of the lumens of burst cells, when they burst */
  PetscReal spilt;           /* work per V0 that `work` counts for their fluid, which no load has done */
  PetscInt cells;            /* of tissue whose walls tear, else 0 */
  PetscBool *burst;          /* [cells] */
  /* walls with memory only */
  PetscInt pairs;
  LamMemoryPair *past; /* [element][1 + terms] */
  LamMemoryLedger ledger;
  /* with contact or a history */
  PetscReal work;                     /* of the loads, per V0 so far; with a history only */
  PetscReal energy[LAM_ENERGY_COUNT]; /* Psi and its derivatives (contact_jump.c), with memory what is stored or
                                         dissipated instead of Psi; NaN: unknown */
  /* with a third component of positions only */
  PetscInt axial; /* [class], else 0 */
  PetscReal *z;   /* [axial] */
  LamLoad given;  /* `load` as it was given, before it was turned (out_of_plane.c) */
};

typedef struct {
  PetscInt iterations, factorisations;
  PetscInt escapes;  /* steps along a direction of negative curvature */
  PetscBool stopped; /* by the interrupt: no further factorisations or iterations */
} LamWork;

/* Sealed lumens. */
typedef struct {
  PetscBool allowed;      /* the matrix has rows for the pressures */
  PetscBool closed;       /* at present; otherwise turgor is prescribed */
  PetscReal bulk_modulus; /* K_w */
  PetscReal
      *water; /* [cell] V_w, apothems^2: volume of the lumen at the turgor of the load; not allocated unless allowed */
  PetscReal *area;   /* [cell] work space */
  PetscReal *factor; /* [cell] work space */
} LamSeal;

/* Linear systems: of positions and pressures; of a contact that has met more walls; of the exact law, with multipliers.
   The last two are created when needed. */
enum { LAM_SYSTEM_BASE, LAM_SYSTEM_GROWN, LAM_SYSTEM_EXACT, LAM_SYSTEMS };

/* Cells to which sums over elements, edges of the lamella and walls are restricted (part.c). */
typedef struct {
  PetscInt moving, count;                       /* cells that move, and all: those beside them, too */
  PetscInt *cells;                              /* [count] those that move first */
  PetscBool *moves;                             /* [cell] */
  PetscBool *near;                              /* [cell] moves or is beside */
  PetscInt moving_unknowns, unknowns, *unknown; /* positions of those that move, and of all, in the same order */
} LamPart;

typedef struct LamAntiplane_s *LamAntiplane;

struct LamRVE_s {
  MPI_Comm comm;
  LamMicrostructure micro;
  LamStrategy strategy;
  PetscReal tolerance; /* requested tolerance of solves; 0: rounding */
  LamWanted wanted;    /* requested parts of responses */
  PetscBool has_micro, is_set_up, monitor;
  PetscBool out_of_plane; /* requested: any F, and a full tangent */
  const LamWallLaw **law; /* [cell]; the array is owned, the laws are not */
  PetscReal stiffest;     /* largest bulk or fibre modulus of any cell */
  PetscInt changes;       /* number of changes of the moduli */
  LamMesh mesh;
  LamElementGeometry *geometry; /* [element] */
  LamElementStress *stress;     /* [element]: independent stresses of the current iteration */
  LamLinear *linear;            /* in use; one of `systems` */
  LamLinear systems[LAM_SYSTEMS];
  LamSmooth *smooth;      /* the smooth law of contact; NULL for bonded tissue; owned */
  LamContact *contact;    /* the exact law; NULL for bonded tissue; owned */
  LamLayer *layer;        /* the lamella of law `lamella`, else NULL; owned */
  LamAntiplane antiplane; /* the third component of positions; NULL: they are plane; owned */
  LamMemory *memory;      /* NULL: walls have none; owned */
  LamBondRates *rates; /* solves are for the model of a material point, and set these; NULL: they are not; borrowed */
  LamRVE bonded;       /* two_step: the same tissue with bonded walls, created at its first use; owned */
  LamRVEState bonded_state; /* of `bonded`; owned */
  LamSeal seal;
  PetscInt ndof;                          /* 2 class_count */
  PetscInt length;                        /* ndof + linear.lumens */
  PetscReal *y, *step, *trial, *residual; /* [length] each: position, Newton step, trial position, residual */
  LamWork work;                           /* of the current solve */
  PetscInt budget;                        /* current limit of its iterations */
  PetscBool (*interrupt)(void *ctx);      /* NULL: never */
  void *interrupt_ctx;                    /* borrowed */
  PetscBool near_only;         /* a solve that does not continue the branch of the exact law ends, without a state */
  PetscBool looks_back;        /* the solve looks for the end of a branch before it: no further one does */
  const LamPart *part;         /* borrowed; NULL: all cells */
  PetscReal energy;            /* of the last assembly */
  PetscBool consistent;        /* residual and linear.values are evaluated at y with the wall stresses of y */
  PetscBool moved;             /* y has been moved affinely since the last solution */
  PetscReal lowest_eigenvalue; /* of the last unstable state found */
  PetscInt zero_modes;         /* of the consistent tangent last factored */
};

static inline const LamWall *LamCellWall(const LamMicrostructure *micro, PetscInt cell)
{
  return micro->cell ? &micro->cell[cell].wall : &micro->wall;
}
/* Law and wall of the cell that an element belongs to, and the history of its walls; in a step. */
static inline const LamWallLaw *LamLawOf(LamRVE rve, PetscInt element)
{
  return rve->law[rve->mesh.cell_of[element]];
}
static inline const LamWall *LamWallOf(LamRVE rve, PetscInt element)
{
  const PetscInt cell = rve->mesh.cell_of[element];

  return rve->memory ? &rve->memory->wall[cell] : LamCellWall(&rve->micro, cell);
}
static inline const LamPoints *LamHistoryOf(LamRVE rve, PetscInt element)
{
  return rve->memory ? (const LamPoints *)rve->memory->history[element] : NULL;
}
static inline PetscBool LamHasBurst(LamRVE rve, PetscInt cell)
{
  return (PetscBool)(rve->layer && rve->layer->burst && rve->layer->burst[cell]);
}
/* Turgor of a cell relative to that of the load; and of one that has not burst. */
static inline PetscReal LamWholeTurgorFactor(LamRVE rve, PetscInt cell)
{
  return rve->micro.cell ? rve->micro.cell[cell].turgor : 1.0;
}
static inline PetscReal LamTurgorFactor(LamRVE rve, PetscInt cell)
{
  return LamHasBurst(rve, cell) ? 0.0 : LamWholeTurgorFactor(rve, cell);
}

/* Whether a cell moves, in sums over a part. */
static inline PetscBool LamMoves(LamRVE rve, PetscInt cell)
{
  return (PetscBool)(!rve->part || rve->part->moves[cell]);
}

/* Whether any lumen can be under pressure, at any positions. */
static inline PetscBool LamHasTurgor(LamRVE rve, const LamLoad *load)
{
  return (PetscBool)(rve->seal.closed || load->turgor != 0.0);
}

/* Pressure in a lumen at y. */
static inline PetscReal LamTurgor(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscInt cell)
{
  return rve->seal.closed ? y[rve->ndof + cell] : load->turgor * LamTurgorFactor(rve, cell);
}

static inline void LamNodePosition(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt node, PetscReal x[2])
{
  LamImagePosition(F, y, rve->mesh.node_class[node], &rve->mesh.shift[2 * node], x);
}
/* Sets y so that a node of the mesh is at x. */
static inline void LamPlaceNode(LamRVE rve, const PetscReal F[9], PetscInt node, const PetscReal x[2], PetscReal y[])
{
  const PetscReal *S = &rve->mesh.shift[2 * node];

  for (PetscInt d = 0; d < 2; ++d) y[2 * rve->mesh.node_class[node] + d] = x[d] - F[3 * d] * S[0] - F[3 * d + 1] * S[1];
}

/* ---- assembly.c ---- */
PetscErrorCode LamGeometryCreate(LamRVE rve);
/* Positions of an element's nodes: x_a = y_class + F S. */
void LamGatherElement(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt e,
                      PetscReal x[LAM_ELEMENT_NODES][2]);
/* Displacements of an element's nodes, u_a = x_a - X_a, computed as y_class - X_class + (F - 1) S without cancellation.
 */
void LamGatherDisplacements(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt e,
                            PetscReal u[LAM_ELEMENT_NODES][2]);
/* Suction on walls with a facing wall, per reference thickness: g F33; 0 for bonded tissue. */
PetscReal LamSuction(LamRVE rve, const LamLoad *load);
/* Energy (walls - p V_lumen + g V_gap; for sealed lumens the energy of the water), not divided by V0; *valid as
   LamElementEnergy. */
PetscErrorCode LamAssembleEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                                 PetscBool *valid);
/* Energy, residual [length] and tangent with independent stresses, the latter in linear.values. */
PetscErrorCode LamAssemble(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                           PetscReal residual[], PetscBool *valid);
/* Updates the independent stresses by alpha along the displacement dy from y and the change dF from load->F. */
void LamUpdateStresses(LamRVE rve, const LamLoad *load, const PetscReal y[], const PetscReal dy[],
                       const PetscReal dF[9], PetscReal alpha);
/* Returns PETSC_FALSE if an element volume is not positive. */
PetscBool LamPositionsAreValid(LamRVE rve, const LamLoad *load, const PetscReal y[]);
/* Sets the independent stresses to those of positions y. Returns PETSC_FALSE if y is not valid. */
PetscBool LamSetConsistentStresses(LamRVE rve, const LamLoad *load, const PetscReal y[]);
/* Norm of the residual without the prescribed class. */
PetscReal LamResidualNorm(LamRVE rve, const PetscReal residual[]);

/* ---- turgor.c ---- */
/* Areas inside the lumens, area [cell]; LamLumenAddGradient adds the gradient of sum factor[cell] area[cell] to
   gradient [ndof]. */
void LamLumenAreas(LamRVE rve, const PetscReal y[], PetscReal area[]);
void LamLumenAddGradient(LamRVE rve, const PetscReal y[], const PetscReal factor[], PetscReal gradient[]);
/* Adds the potential -pressure area of an innermost element to its residual and tangent. */
void LamAddPressure(const PetscReal x[LAM_ELEMENT_NODES][2], PetscReal pressure, LamElementResult *element);
/* Adds that of the chords, which close lumens at cuts, to residual and linear.values. */
void LamAssembleChords(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal residual[]);
/* -p V_lumen, or for sealed lumens the energy of their water; uses only the positions in y. */
PetscReal LamTurgorEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[]);
/* Sets the rows of the pressures in linear.values and, if lumens are sealed, in residual [length]. */
void LamSealAssemble(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal residual[]);
/* Sets the rows of the pressures to those of the unit matrix. */
void LamSealSetOpen(LamRVE rve);
/* Sets the pressures in y to those of the lumens at its positions. */
void LamSealSetConsistent(LamRVE rve, const LamLoad *load, PetscReal y[]);
/* Sum of the squares of the pressure residuals: in apothems^2 or, for soft water, in pressure. */
PetscReal LamSealError(LamRVE rve, const PetscReal residual[]);
/* Sets the turgor measures of the response. */
void LamTurgorMeasures(LamRVE rve, const LamLoad *load, LamResponse *response);

/* ---- smooth_contact.c ---- */
PetscErrorCode LamSmoothCreate(LamRVE rve);
PetscErrorCode LamSmoothDestroy(LamSmooth **smooth);
/* The law of contact in use, with its linear system; the factor is forgotten. */
PetscErrorCode LamUseSmoothLaw(LamRVE rve, PetscReal width);
PetscErrorCode LamUseExactLaw(LamRVE rve);
static inline PetscBool LamIsExact(LamRVE rve)
{
  return (PetscBool)(rve->contact && rve->contact->exact);
}
/* Forgets the walls that the last solve has met. */
PetscErrorCode LamSmoothReset(LamRVE rve);
LamTouchStrength LamTouchStrengthOf(LamRVE rve, const LamLoad *load, PetscInt a, PetscInt b);
/* The law of a gap between walls. */
void LamTouchLawOf(LamRVE rve, PetscReal gap, LamTouchLaw *law);
/* Calls the visitor with the sums over all pairs of spans. */
void LamSmoothVisit(LamRVE rve, const LamLoad *load, const PetscReal y[], LamTouchWanted wanted,
                    LamTouchBlockVisitor visitor, void *ctx);
PetscReal LamSmoothEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[]);
/* Zeroes residual and linear.values, and adds energy, residual and tangent. */
PetscErrorCode LamSmoothAssemble(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy,
                                 PetscReal residual[]);

/* ---- lamella.c ---- */
/* Finds the layer's entries in the matrix in use. */
void LamLayerSetMatrix(LamRVE rve);
/* Calls the visitor for all edges, with energy, forces and tangent of the step. */
void LamLayerVisit(LamRVE rve, const PetscReal F[9], const PetscReal y[], LamEdgeVisitor visitor, void *ctx);
/* And for all points, without them. */
void LamLayerVisitPoints(LamRVE rve, const PetscReal F[9], const PetscReal y[], LamBondVisitor visitor, void *ctx);
/* The jump at place s in [0, 1] of an edge (first point over LAM_EDGE_POINTS). */
void LamLayerJump(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt edge, PetscReal s, LamJump *jump);
PetscReal LamLayerEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[]);
/* Adds energy, residual and tangent. */
void LamLayerAssemble(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal *energy, PetscReal residual[]);
/* Energy dissipated in the step, not divided by V0, its derivatives: gradient [length], and `slope` for a change
   `along` of F, and by_cell [cell], that at the faces of a cell. */
PetscReal LamLayerSpent(LamRVE rve, const LamLoad *load, const PetscReal y[], const PetscReal along[9],
                        PetscReal gradient[], PetscReal *slope, PetscReal by_cell[]);
/* The history at the start of the step: that of a state. */
void LamLayerTake(LamRVE rve, const LamRVEState state);
/*
  Lets the cells burst whose wall is torn through at rve->y, an iterate of the step: under constant pressure a torn cell
  has no equilibrium. The cut stays torn, and the energy spent in it, the fluid and its work are those until here: the
  fluid is free, its potential -p V_lumen is taken out as work. *any: there is one.
*/
PetscErrorCode LamLayerBurst(LamRVE rve, const LamLoad *load, PetscBool *any);
/* Stores the history at the end of the step, at rve->y. */
void LamLayerKeep(LamRVE rve, const LamLoad *load, LamRVEState state);

/* ---- memory.c ---- */
/* Nothing without memory. Take: before the solves of a step; Keep: stores the past and the ledger at rve->y. */
PetscErrorCode LamMemoryCreate(LamRVE rve);
PetscErrorCode LamMemoryDestroy(LamMemory **memory);
PetscInt LamMemoryPairs(LamRVE rve);
void LamMemoryTake(LamRVE rve, const LamRVEState state, PetscReal duration);
void LamMemoryKeep(LamRVE rve, const LamLoad *load, LamRVEState state);

/* ---- smooth_pressures.c ---- */
/* Forces of the smooth law at rve->y, per reference thickness. */
typedef struct {
  PetscReal facing, third, lumen; /* sums of normal forces between facing walls, others, and within lumens */
} LamTouchForces;
/* Sets the junction status, multipliers and active set of the exact law from the smooth law at rve->y, as its initial
   guess and for the indicators. */
PetscErrorCode LamSmoothPressures(LamRVE rve, const LamLoad *load, LamTouchForces *forces);
/* Deepest penetrations of walls at rve->y, apothems, >= 0: of facing walls, of others; cell: those of the latter. */
typedef struct {
  PetscReal facing, other;
  PetscInt cell[2];
} LamDepths;
LamDepths LamFindDepths(LamRVE rve, const LamLoad *load);

/* ---- contact.c ---- */
#define LAM_CONTACT_SCALE 9.0 /* scale of gaps (apothems) to multipliers (C1 + C2): 1 MPa per apothem by default */
PetscErrorCode LamContactCreate(const LamMicrostructure *micro, const LamMesh *mesh, LamContact **contact);
PetscErrorCode LamContactSetMatrix(const LamLinear *linear, LamContact *contact);
PetscErrorCode LamContactDestroy(LamContact **contact);
/* Chains of face f at positions y, in contact->x; their segments are in contact->segments. */
LamMortarChains LamContactChains(LamRVE rve, const PetscReal F[9], const PetscReal y[], PetscInt f);
/* Sets the junction status to that of positions y. Returns the number of faces at which it has changed. */
PetscInt LamContactMerge(LamRVE rve, const LamLoad *load, const PetscReal y[]);
/* Gaps, weights, rows and second derivatives at positions y with the present multipliers and junction status. */
PetscErrorCode LamContactEvaluate(LamRVE rve, const LamLoad *load, const PetscReal y[]);
/* Updates the active set from the last evaluation: lambda - c gap > 0. Returns the number of changes. */
PetscInt LamContactFindActive(LamContact *contact);
PetscInt LamContactCountActive(const LamContact *contact);
/* Whether a hat has a multiplier of its own, and is not merged into another or held by a lamella. */
PetscBool LamContactCarries(const LamContact *contact, PetscInt hat);
/* max |min(lambda, c gap)| over all hats. */
PetscReal LamContactComplementarity(const LamContact *contact);
/* residual [ndof] += -B^T lambda. */
void LamContactAddForce(LamRVE rve, PetscReal residual[]);
/* Adds the second derivative of -sum lambda G to linear.values. */
void LamContactAddCurvature(LamRVE rve);
/* Sets the junction statuses to those of the state; the previous solve may have left others. */
void LamTakeJunctions(LamRVE rve, LamRVEState state);
/* Sets the rows of the multipliers in linear.values: -dG and 0 for active hats, 0 and 1 for others. */
void LamContactSetRows(LamRVE rve);

/* ---- interrupt.c ---- */
/* As LamLinearFactor for rve->linear; counts the factorisation. Once the interrupt has stopped the solve, *ok is
   PETSC_FALSE and there may be no factor. */
PetscErrorCode LamRVEFactor(LamRVE rve, PetscReal shift, PetscInt *negative, PetscBool *ok);
/* The same if the matrix has the number of negative eigenvalues of a stable state; cheaper where it has not. */
PetscErrorCode LamRVEFactorExpected(LamRVE rve, PetscReal shift, PetscBool *ok);
/* Adds the work of a part of the solve; if the part was stopped, the solve is stopped, too. */
void LamAddWork(LamRVE rve, const LamResponse *part);
static inline PetscBool LamWasStopped(const LamResponse *response)
{
  return (PetscBool)(response->status == LAM_OUT_OF_REACH);
}
/* Sets status and reason of a response without a stable state; format as for PetscSNPrintf. */
PetscErrorCode LamRefuse(LamResponse *response, LamStatus status, const char format[], ...)
    __attribute__((format(printf, 3, 4)));
/* Sets the response of a solve that was stopped. */
PetscErrorCode LamGiveUp(LamResponse *response);
/* Limit of the iterations for one state, including substeps: some seconds on the default mesh. */
#define LAM_ITERATION_BUDGET 8000
static inline PetscBool LamMayIterate(LamRVE rve)
{
  return (PetscBool)(rve->work.iterations < rve->budget && !rve->work.stopped);
}

/* Marks the assembled values as outdated. */
static inline void LamForgetTangent(LamRVE rve)
{
  rve->consistent = PETSC_FALSE;
}

/* Bending stiffness of the thinnest wall over a length of one apothem, in C1 + C2. A larger initial shift would hide
   its buckling. */
static inline PetscReal LamBendingStiffness(LamRVE rve)
{
  return PetscPowReal(rve->mesh.thinnest, 3.0);
}

/* ---- stability.c ---- */
#define LAM_ZERO_MODE 1e-9 /* eigenvalues of modes of unit length that count as zero, C1 + C2 */
/* Number of negative eigenvalues of the matrix at a stable state: one for each active multiplier and sealed lumen. */
PetscInt LamExpectedNegative(LamRVE rve);
/* Assembles and factors the consistent tangent at rve->y and counts its negative eigenvalues beyond the expected ones.
   Also sets rve->zero_modes. */
PetscErrorCode LamFactorConsistent(LamRVE rve, const LamLoad *load, PetscInt *negative, PetscBool *ok);
/* Initial vector for the softest mode, the same in every run. It lacks the symmetry of the cell, so that no mode is
   missed. */
void LamStartMode(LamRVE rve, PetscReal mode[]);
/* Inverse iterations with the present factor. On return the positions of mode form a unit vector whose largest entry is
   positive, so that the branch taken is the same in every run; the pressures are the corresponding changes; the
   multiplier entries are not changed. */
PetscErrorCode LamImproveSoftestMode(LamRVE rve, PetscInt iterations, PetscReal mode[]);
/* to [length] += factor mode */
void LamAddMode(LamRVE rve, PetscReal factor, const PetscReal mode[], PetscReal to[]);
/* mode . residual [length] */
PetscReal LamModeSlope(LamRVE rve, const PetscReal mode[], const PetscReal residual[]);
/* mode . K mode with the matrix in linear.values; image [n] is work space. */
PetscReal LamModeCurvature(LamRVE rve, const PetscReal mode[], PetscReal image[]);
/* Lowest eigenvalue of the matrix in linear.values and its unit eigenvector, mode[n]. If the solve is stopped, the
   eigenvalue is NaN and the mode arbitrary. */
PetscErrorCode LamSoftestMode(LamRVE rve, PetscReal *eigenvalue, PetscReal mode[]);

#endif
