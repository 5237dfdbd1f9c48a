/*
  The representative volume element: whole hexagonal cells with hyperelastic walls, periodic or a patch between grips.

    LamRVECreate(comm, &rve); LamRVESetMicrostructure(rve, &micro); LamRVESetUp(rve);
    LamRVEStateCreate(rve, &state);
    LamRVESolve(rve, &load, state, &response);       state: in the start, out the solution
    LamRVEStateDestroy(&state); LamRVEDestroy(&rve);
*/
#ifndef LAMELLA_RVE_H
#define LAMELLA_RVE_H

#include <petscsys.h>
#include <lamella/response.h>
#include <lamella/export.h>

LAM_C_BEGIN

typedef struct LamRVE_s *LamRVE;           /* mesh, matrix, factor: one per rank and microstructure */
typedef struct LamRVEState_s *LamRVEState; /* positions of one material point and the load they belong to */

/*
  `comm`: the ranks that solve the RVE together. Of several, rank 0 makes all calls below; the others call LamRVEServe,
  which takes part in the factorisations of all RVEs of this communicator, and returns when rank 0 calls LamRVEDismiss.
  `waiting` (or NULL) is called now and then while there is nothing to do, so that the rank can talk to others on other
  communicators; what it returns has no effect.
  That pays from some 20,000 unknowns.
*/
LAM_EXPORT PetscErrorCode LamRVECreate(MPI_Comm comm, LamRVE *rve);
LAM_EXPORT PetscErrorCode LamRVEServe(MPI_Comm comm, PetscBool (*waiting)(void *ctx), void *ctx);
LAM_EXPORT PetscErrorCode LamRVEDismiss(MPI_Comm comm);
/* Copies the description. along and through must be chosen. PETSC_ERR_USER_INPUT where it cannot be solved. */
LAM_EXPORT PetscErrorCode LamRVESetMicrostructure(LamRVE rve, const LamMicrostructure *micro);
/* How contact is reached: LAM_TWO_STEP (default) or LAM_ONE_STEP. No effect on bonded tissue. */
LAM_EXPORT PetscErrorCode LamRVESetStrategy(LamRVE rve, LamStrategy strategy);
/* Ends solves once the residual, forces per thickness over (C1 + C2) apothem, and the complementarity of contact, are
   below `tolerance`; never below what rounding allows, which is the default, 0. */
LAM_EXPORT PetscErrorCode LamRVESetTolerance(LamRVE rve, PetscReal tolerance);
/*
  What responses are asked for; the rest of their numbers is not computed, and not known. Status and stability, counts
  of work and the state are always there. Everything by default. Solves under prescribed stress derive in any case.
*/
typedef enum {
  LAM_WANT_STRESS = 1,      /* energy and its first derivatives, lumen and opening, turgor reached */
  LAM_WANT_DERIVATIVES = 2, /* with stress: tangent and its ellipticity, P_turgor, P_cohesion, second derivatives of
                               the energy */
  LAM_WANT_INDICATORS = 4,  /* tractions, what has come apart */
  LAM_WANT_WALLS = 8,       /* stretch, energy and tension of the walls: what strengths are held against; kinks */
  LAM_WANT_ALL = LAM_WANT_STRESS | LAM_WANT_DERIVATIVES | LAM_WANT_INDICATORS | LAM_WANT_WALLS
} LamWanted;
LAM_EXPORT PetscErrorCode LamRVESetWanted(LamRVE rve, LamWanted wanted);
/* Prints each Newton iteration to stderr (residual, step, negative eigenvalues). Off by default. */
LAM_EXPORT PetscErrorCode LamRVESetMonitor(LamRVE rve, PetscBool on);
/*
  Gives solves up on demand: `interrupt` is asked before every factorisation of a solve, of whatever stage, and where it
  says PETSC_TRUE the solve ends at once: status LAM_OUT_OF_REACH, reason "stopped before it was solved", the state as
  it was, no error. It may use MPI on other communicators than the RVE's, but not the RVE. NULL: never (default).
*/
LAM_EXPORT PetscErrorCode LamRVESetInterrupt(LamRVE rve, PetscBool (*interrupt)(void *ctx), void *ctx);
/* Whether the lumens can be sealed: room for their pressures in the matrix. Before LamRVESetUp. Off by default. */
LAM_EXPORT PetscErrorCode LamRVESetSealable(LamRVE rve, PetscBool on);
/* Builds the mesh and the sparsity pattern; the factorisation is analysed at the first solve. */
LAM_EXPORT PetscErrorCode LamRVESetUp(LamRVE rve);
/*
  Other moduli (C1, C2, C4 and bulk modulus) of the walls of an RVE that is set up, from a description that is otherwise
  the same: what follows from walls alone. States stay what they are, as starts.
*/
LAM_EXPORT PetscErrorCode LamRVEChangeModuli(LamRVE rve, const LamMicrostructure *micro);
LAM_EXPORT PetscErrorCode LamRVEDestroy(LamRVE *rve);

/* A state at F = I without turgor: the stress-free reference. */
LAM_EXPORT PetscErrorCode LamRVEStateCreate(LamRVE rve, LamRVEState *state);
LAM_EXPORT PetscErrorCode LamRVEStateCopy(LamRVEState from, LamRVEState to);
LAM_EXPORT PetscErrorCode LamRVEStateReset(LamRVE rve, LamRVEState state);
LAM_EXPORT PetscErrorCode LamRVEStateDestroy(LamRVEState *state);
/*
  A state as plain bytes, for a rank that has the same RVE: a solve from the bytes is one from the state, bit for bit.
  LamRVEStatePack fills LamRVEStateSize bytes.
*/
LAM_EXPORT PetscErrorCode LamRVEStateSize(LamRVEState state, size_t *bytes);
LAM_EXPORT PetscErrorCode LamRVEStatePack(LamRVEState state, void *bytes);
LAM_EXPORT PetscErrorCode LamRVEStateUnpack(const void *bytes, LamRVEState state);

/*
  Finds the equilibrium at `load`, starting from `state`, which it replaces by the solution. Where none is found the
  state is left as it was, and the response says why. Errors only for faults of the program or of memory.
*/
LAM_EXPORT PetscErrorCode LamRVESolve(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);

/*
  The same with stress prescribed in place of components of F: load->F holds the given components and a first guess of
  the free ones, such as those of `state`; response->load.F is the solution (NaN where there is none). F12 and F21
  cannot both be free. A state is stable where it is so at its F and dP/dF of the free components is positive definite;
  an equilibrium that is not is LAM_UNSTABLE, with the reason.
*/
LAM_EXPORT PetscErrorCode LamRVESolveMixed(LamRVE rve, const LamLoad *load, const LamStressControl *control,
                                           LamRVEState state, LamResponse *response);

/* Share of the walls' volume: where more of them has kinked (kinked_fraction, of responses with LAM_WANT_WALLS) the
   estimate of bonded tissue is taken larger, and is a guess. */
#define LAM_KINKED_SHARE 0.005

/*
  An estimate of the error of a state's P, as LamStressError, from the same load on half as many elements: a sixth of
  the time of a bonded state, a tenth to four tenths of a contact one. It keeps the coarse state that it has found, from
  which the next one starts: one estimate for states that follow each other. LamRVEEstimateError sets
  response->error_estimate of the response that belongs to `state`, and adds its time; NaN where there is none: an odd
  number of elements along a face, sealed cells, no equilibrium on the coarser mesh, or elements far too long for the
  thinnest wall or too deep for the lumen (docs/results/extremes.md, "Worth of the error estimate"). Borrows `rve`.
*/
typedef struct LamRVEEstimate_s *LamRVEEstimate;
LAM_EXPORT PetscErrorCode LamRVEEstimateCreate(LamRVE rve, LamRVEEstimate *estimate);
LAM_EXPORT PetscErrorCode LamRVEEstimateError(LamRVEEstimate estimate, LamRVEState state, LamResponse *response);
LAM_EXPORT PetscErrorCode LamRVEEstimateDestroy(LamRVEEstimate *estimate);

/*
  Sealed lumens: in all solves from LamRVESeal to LamRVEUnseal each cell keeps its water of bulk modulus K_w (C1 + C2),
    V_lumen = V_w (1 - (p - p0) / K_w),    p0 = load->turgor times the turgor of the cell over that of the load,
  and finds its own pressure p. water[cell]: V_w over the V0 of the RVE, the lumen in which the water has the pressure
  p0; LamRVEGetLumens gives that of a state solved with prescribed p0. Who has many material points seals anew for each
  of them; that costs nothing. The energy of the response is then

    Psi_s(F) = stat_p [ Psi(F, p) + sum_c v_w (p_c - (p_c - p0)^2 / (2 K_w)) ],    v_w = water,

  all else derivatives of it, those by the turgor at fixed water; turgor_mean and turgor_spread tell the pressures
  reached. They may be negative: water is not kept from being pulled (docs/theory/walls.md, Sealed lumens). LamRVESeal:
  PETSC_ERR_ARG_OUTOFRANGE where K_w or water is not positive and finite.
*/
LAM_EXPORT PetscErrorCode LamRVEGetLumens(LamRVE rve, LamRVEState state, PetscReal lumen[]);
LAM_EXPORT PetscErrorCode LamRVESeal(LamRVE rve, PetscReal bulk_modulus, const PetscReal water[]);
LAM_EXPORT PetscErrorCode LamRVEUnseal(LamRVE rve);

/* Number of unknowns of one solve (displacement components that are free). */
LAM_EXPORT PetscErrorCode LamRVEGetUnknowns(LamRVE rve, PetscInt *unknowns);

/*
  What a picture needs. Arrays are owned by the rve and valid until it is destroyed, except where said.
    nodes:     reference positions, [node][2], in apothems
    elements:  [element][9], node numbers: corners counter-clockwise, mid-edges, centre
    x (state): current positions, [node][2]
*/
typedef struct {
  PetscInt node_count, element_count, cell_count;
  const PetscReal *nodes;   /* [node_count][2] */
  const PetscInt *elements; /* [element_count][9] */
  const PetscInt *cell_of;  /* [element_count]: the cell of an element */
  PetscReal period[2][2];   /* period vectors (rows), reference, in apothems */
} LamRVEMesh;
LAM_EXPORT PetscErrorCode LamRVEGetMesh(LamRVE rve, LamRVEMesh *mesh);
/* Fields of a state, at mesh nodes; the caller provides the arrays. Any may be NULL.
     x          [node][2]  current positions
     fibre      [node]     fibre stretch sqrt(I4) along the wall
     stress     [node]     largest principal Cauchy stress of the wall, in C1 + C2 */
LAM_EXPORT PetscErrorCode LamRVEGetFields(LamRVE rve, LamRVEState state, PetscReal x[], PetscReal fibre[],
                                          PetscReal stress[]);
/* The lowest eigenvalue of a state's consistent tangent at fixed F, C1 + C2 (as lowest_eigenvalue of the response), and
   its mode, which the caller provides: mode [node][2], displacements whose largest component is 1. Of contact on
   motions that keep closed gaps closed. NaN, and a mode of zeros: the state has no factor. */
LAM_EXPORT PetscErrorCode LamRVEGetSoftestMode(LamRVE rve, LamRVEState state, PetscReal *eigenvalue, PetscReal mode[]);
/* Largest component of what the positions of cells differ by, apart from the motion by F from cell to cell, apothems:
   0 where the pattern has the period of one cell. */
LAM_EXPORT PetscErrorCode LamRVEGetCellDifference(LamRVE rve, LamRVEState state, PetscReal *difference);

/*
  Samples along the interfaces of a contact state, for pictures and profiles; the caller provides the arrays, any may be
  NULL. LamRVEGetInterfaceSize: `faces` = 3 per cell (face families 0, 1, 2 of cell 0, then of cell 1, ...; of a patch
  those that have a neighbour), `points` per face, evenly spaced in the reference along the slave wall,
  counter-clockwise around its cell; bonded tissue has none.
  LamRVEGetInterfaceFaces: owner [face][3], the cell, its face (0, 1 or 2) and the cell across it.

    from      [face][point][2]  current position on the wall of the face's cell
    to        [face][point][2]  nearest point of the facing wall (in the image that faces it); NaN: it faces none
    gap       [face][point]     distance, in apothems (< 0: penetration); NaN: it faces none
    pressure  [face][point]     contact pressure (Cauchy, >= 0), in C1 + C2; the traction is cohesion - pressure
*/
LAM_EXPORT PetscErrorCode LamRVEGetInterfaceSize(LamRVE rve, PetscInt *faces, PetscInt *points);
LAM_EXPORT PetscErrorCode LamRVEGetInterfaceFaces(LamRVE rve, PetscInt owner[]);
LAM_EXPORT PetscErrorCode LamRVEGetInterface(LamRVE rve, LamRVEState state, PetscReal from[], PetscReal to[],
                                             PetscReal gap[], PetscReal pressure[]);

/*
  A responder that solves one RVE per question. Borrows `rve`, which must outlive it. Of material points 0..points-1 it
  keeps two states each (LamRVEStateSize), from which their next solves start; those of others start from the
  reference. It can be sealed where `rve` can, and then answers for the points that it keeps alone.
*/
LAM_EXPORT PetscErrorCode LamRVEResponderCreate(LamRVE rve, PetscInt points, LamResponder *responder);
/* Time of one assembly of residual and tangent on this machine, s; needs no MPI (used to predict cost). */
LAM_EXPORT PetscErrorCode LamRVETimeAssembly(const LamMicrostructure *micro, PetscInt *unknowns, PetscReal *seconds);

LAM_C_END

#endif
