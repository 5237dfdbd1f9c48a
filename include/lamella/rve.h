/*
  The representative volume element: hexagonal cells with hyperelastic walls, periodic or a patch between grips.

    LamRVECreate(comm, &rve); LamRVESetMicrostructure(rve, &micro); LamRVESetUp(rve);
    LamRVEStateCreate(rve, &state);
    LamRVESolve(rve, &load, state, &response);       state: initial guess on entry, solution on return
    LamRVEStateDestroy(&state); LamRVEDestroy(&rve);
*/
#ifndef LAMELLA_RVE_H
#define LAMELLA_RVE_H

#include <petscsys.h>
#include <lamella/response.h>
#include <lamella/export.h>

LAM_C_BEGIN

typedef struct LamRVE_s *LamRVE;           /* mesh, matrix, factor: one per rank and microstructure */
typedef struct LamRVEState_s *LamRVEState; /* positions of one material point and the corresponding load */

/*
  `comm`: the ranks that solve the RVE together. If there are several, rank 0 makes all calls below. The others call
  LamRVEServe, which takes part in the factorisations of all RVEs of this communicator and returns when rank 0 calls
  LamRVEDismiss. `waiting` (or NULL) is called periodically while the rank is idle, so that it can communicate on
  other communicators; its return value has no effect. Several ranks are faster from about 20,000 unknowns.
*/
LAM_EXPORT PetscErrorCode LamRVECreate(MPI_Comm comm, LamRVE *rve);
LAM_EXPORT PetscErrorCode LamRVEServe(MPI_Comm comm, PetscBool (*waiting)(void *ctx), void *ctx);
LAM_EXPORT PetscErrorCode LamRVEDismiss(MPI_Comm comm);
/* Copies the description; along and through must be set. PETSC_ERR_USER_INPUT if it cannot be solved. */
LAM_EXPORT PetscErrorCode LamRVESetMicrostructure(LamRVE rve, const LamMicrostructure *micro);
/* Initial guess of contact without a state before: LAM_ONE_STEP (default) or LAM_TWO_STEP. No effect on bonded tissue.
 */
LAM_EXPORT PetscErrorCode LamRVESetStrategy(LamRVE rve, LamStrategy strategy);
/* Convergence tolerance for the residual, forces per thickness over (C1 + C2) apothem, and for the complementarity
   of contact. The limit of rounding is used if it is larger. Default 0: the limit of rounding. */
LAM_EXPORT PetscErrorCode LamRVESetTolerance(LamRVE rve, PetscReal tolerance);
/*
  Selects what responses contain; other numbers are not computed, and are unknown. Status, stability, work counts and
  the state are always computed. Default: LAM_WANT_ALL, i.e. all but jumps. Solves under prescribed stress always
  compute derivatives.
*/
typedef enum {
  LAM_WANT_STRESS = 1,      /* energy and its first derivatives, lumen and opening, turgor reached */
  LAM_WANT_DERIVATIVES = 2, /* with stress: tangent and its ellipticity, P_turgor, P_cohesion, second derivatives of
                               the energy */
  LAM_WANT_INDICATORS = 4,  /* tractions, debonding */
  LAM_WANT_WALLS = 8,       /* stretch, energy and tension of the walls, for comparison with strengths; kinks */
  LAM_WANT_JUMPS = 16,      /* with stress, of contact tissue: whether the branch of the state before has ended; costs
                               further solves where more energy is lost than the derivatives explain */
  LAM_WANT_ALL = LAM_WANT_STRESS | LAM_WANT_DERIVATIVES | LAM_WANT_INDICATORS | LAM_WANT_WALLS
} LamWanted;
LAM_EXPORT PetscErrorCode LamRVESetWanted(LamRVE rve, LamWanted wanted);
/* Prints each Newton iteration to stderr (residual, step, negative eigenvalues). Off by default. */
LAM_EXPORT PetscErrorCode LamRVESetMonitor(LamRVE rve, PetscBool on);
/*
  Interrupts solves: `interrupt` is called before every factorisation, and at the start of a solve that follows an
  interrupted one. If it returns PETSC_TRUE the solve returns with status LAM_OUT_OF_REACH, reason "stopped before it
  was solved", the state unchanged, and no error. It may use MPI on communicators other than the RVE's, but not the RVE.
  NULL: never (default).
*/
LAM_EXPORT PetscErrorCode LamRVESetInterrupt(LamRVE rve, PetscBool (*interrupt)(void *ctx), void *ctx);
/* Allows the lumens to be sealed, by reserving rows for their pressures in the matrix. Call before LamRVESetUp.
   Default: off. */
LAM_EXPORT PetscErrorCode LamRVESetSealable(LamRVE rve, PetscBool on);
/*
  Allows any F, as cells are prisms along X3, and makes all entries of the tangent known. Call before LamRVESetUp.
  Walls whose fibres leave the section (fibre_angle) turn it on. Default: off; F is that of plane strain with any F33,
  and entries of the tangent with an out-of-plane shear are unknown. Indicators, positions and wall measures are those
  in the section across the present axis of the cells, turned by the least rotation.
*/
LAM_EXPORT PetscErrorCode LamRVESetOutOfPlane(LamRVE rve, PetscBool on);
/* Builds the mesh and the sparsity pattern; symbolic factorisation takes place in the first solve. */
LAM_EXPORT PetscErrorCode LamRVESetUp(LamRVE rve);
/*
  Changes the moduli (C1, C2, C4 and bulk modulus) of the walls of an RVE that is set up, and strengths and energies of
  its lamella and of walls that tear; `micro` is otherwise unchanged. Existing states remain valid as initial guesses;
  their history is the integrity of each point of the lamella, the share of its stiffness that is left.
*/
LAM_EXPORT PetscErrorCode LamRVEChangeTissue(LamRVE rve, const LamMicrostructure *micro);
LAM_EXPORT PetscErrorCode LamRVEDestroy(LamRVE *rve);

/* Creates a state at F = I without turgor: the stress-free reference. */
LAM_EXPORT PetscErrorCode LamRVEStateCreate(LamRVE rve, LamRVEState *state);
LAM_EXPORT PetscErrorCode LamRVEStateCopy(LamRVEState from, LamRVEState to);
LAM_EXPORT PetscErrorCode LamRVEStateReset(LamRVE rve, LamRVEState state);
LAM_EXPORT PetscErrorCode LamRVEStateDestroy(LamRVEState *state);
/*
  Serialises a state for a rank with the same RVE: a solve from the bytes gives the same result bit for bit as one
  from the state. LamRVEStatePack fills LamRVEStateSize bytes.
*/
LAM_EXPORT PetscErrorCode LamRVEStateSize(LamRVEState state, size_t *bytes);
LAM_EXPORT PetscErrorCode LamRVEStatePack(LamRVEState state, void *bytes);
LAM_EXPORT PetscErrorCode LamRVEStateUnpack(const void *bytes, LamRVEState state);
/*
  Energy of the fluid of cells that have burst, per V0: the part of a response's `work` that no load has done. The loads'
  own ledger is (work - spilt) = (stored - spilt) + dissipated + released.
*/
LAM_EXPORT PetscErrorCode LamRVEStateGetSpilt(LamRVEState state, PetscReal *spilt);

/*
  Solves for the equilibrium at `load`, starting from `state`, which is replaced by the solution. If none is found the
  state is unchanged, and the response contains the reason. Errors only for program or memory faults.
*/
LAM_EXPORT PetscErrorCode LamRVESolve(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response);

/*
  As LamRVESolve, with stress prescribed instead of components of F. load->F holds the prescribed components and an
  initial guess of the free ones, such as those of `state`; response->load.F is the solution (NaN if there is none).
  F12 and F21 cannot both be free. A state is stable if it is stable at its F and dP/dF of the free components is
  positive definite; other equilibria are LAM_UNSTABLE, with the reason.
*/
LAM_EXPORT PetscErrorCode LamRVESolveMixed(LamRVE rve, const LamLoad *load, const LamStressControl *control,
                                           LamRVEState state, LamResponse *response);

/*
  The next state of tissue with a lamella on a straight path of F, controlled by what it dissipates: behind a limit F
  goes back along the path as far as equilibrium asks. A state dissipates the energy of fracture of `faces` faces, or is
  the step `most` farther along the path where that dissipates less. A state that would fall at its F is thus followed
  and converged: stable where F follows what is dissipated.
  point: in, of `state`; out, of the solution. `state` is replaced by it, as in LamRVESolve; it must be a solution. The
  contact law is the smooth one.
*/
typedef struct {
  LamLoad from, to; /* turgor and cohesion: those of `to` */
  PetscReal most;   /* share of the path, at most 1 */
  PetscReal faces;  /* energies of fracture in tension of a whole face */
} LamDissipationPath;
typedef struct {
  PetscReal share;      /* of the path */
  PetscBool dissipates; /* the energy decided how far the state went: it is tried first for the next one */
} LamDissipationPoint;
LAM_EXPORT PetscErrorCode LamRVESolveDissipating(LamRVE rve, const LamDissipationPath *path, LamDissipationPoint *point,
                                                 LamRVEState state, LamResponse *response);

/* Fraction of the walls' volume: if kinked_fraction of a response with LAM_WANT_WALLS exceeds it, walls wrinkle on the
   scale of the mesh, and the error estimate of bonded tissue is increased and a guess. */
#define LAM_KINKED_SHARE 0.005

/* Solves the load of `from`, a state of `rve` with a solution, on another mesh of the same tissue, from the
   interpolated solution. LAM_NOT_CONVERGED if Newton's method does not converge from there: the branch of `from` is
   another one or has ended on that mesh. `state` belongs to `finer`. Not for sealed cells. */
LAM_EXPORT PetscErrorCode LamRVESolveFiner(LamRVE rve, LamRVEState from, LamRVE finer, LamRVEState state,
                                           LamResponse *response);

/*
  Estimates the error of a state's P, as LamWholeError, from the same load on a mesh with half as many
  elements again along the faces and through the walls. It costs three to four times a bonded state, twice a contact
  state. LamRVEEstimateError sets response->error_estimate of the response that belongs to `state`, and adds its time.
  The estimate is NaN for sealed cells and where the finer mesh has no state near. With a lamella it solves all states
  of a program on its own mesh: call it for each of them, in order, from the first one. Borrows `rve`.
*/
typedef struct LamRVEEstimate_s *LamRVEEstimate;
LAM_EXPORT PetscErrorCode LamRVEEstimateCreate(LamRVE rve, LamRVEEstimate *estimate);
LAM_EXPORT PetscErrorCode LamRVEEstimateError(LamRVEEstimate estimate, LamRVEState state, LamResponse *response);
LAM_EXPORT PetscErrorCode LamRVEEstimateDestroy(LamRVEEstimate *estimate);

/*
  Sealed lumens: in all solves between LamRVESeal and LamRVEUnseal each cell keeps its water. With its bulk modulus
  K_w, in C1 + C2,
    V_lumen = V_w (1 - (p - p0) / K_w),    p0 = load->turgor times the turgor of the cell over that of the load,
  and its pressure p is an unknown. water[cell]: V_w over the V0 of the RVE, the lumen volume at which the water has
  the pressure p0; LamRVEGetLumens returns it for a state solved with prescribed p0. With many material points, seal
  again for each of them; the cost is negligible. The energy of the response is then

    Psi_s(F) = stat_p [ Psi(F, p) + sum_c v_w (p_c - (p_c - p0)^2 / (2 K_w)) ],    v_w = water,

  and all else its derivatives; those with respect to turgor are at fixed water. turgor_mean and turgor_spread
  describe the pressures reached. They may be negative: water can be under tension (docs/theory/walls.md, Sealed
  lumens). LamRVESeal: PETSC_ERR_ARG_OUTOFRANGE unless K_w and water are positive and finite.
*/
LAM_EXPORT PetscErrorCode LamRVEGetLumens(LamRVE rve, LamRVEState state, PetscReal lumen[]);
LAM_EXPORT PetscErrorCode LamRVESeal(LamRVE rve, PetscReal bulk_modulus, const PetscReal water[]);
LAM_EXPORT PetscErrorCode LamRVEUnseal(LamRVE rve);

/* Number of unknowns of a solve: free displacement components, multipliers of contact, pressures that can be sealed. */
LAM_EXPORT PetscErrorCode LamRVEGetUnknowns(LamRVE rve, PetscInt *unknowns);
/* Likewise of an RVE that is not set up, without pressures of sealed lumens. */
LAM_EXPORT PetscErrorCode LamRVECountUnknowns(const LamMicrostructure *micro, PetscInt *unknowns);

/*
  Mesh data for output. Arrays are owned by the rve and valid until it is destroyed.
    nodes:     reference positions, [node][2], in apothems
    elements:  [element][9], node numbers: corners counter-clockwise, mid-edges, centre
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
/* Lowest eigenvalue of a state's consistent tangent at fixed F, C1 + C2 (as lowest_eigenvalue of the response), and
   its mode, in an array of the caller: mode [node][2], displacements whose largest component is 1. In contact,
   restricted to motions that keep closed gaps closed. NaN and a mode of zeros: the state has no factor. */
LAM_EXPORT PetscErrorCode LamRVEGetSoftestMode(LamRVE rve, LamRVEState state, PetscReal *eigenvalue, PetscReal mode[]);
/* Largest component of the differences between the positions of cells, apart from the motion by F from cell to cell,
   in apothems: 0 if the pattern has the period of one cell. */
LAM_EXPORT PetscErrorCode LamRVEGetCellDifference(LamRVE rve, LamRVEState state, PetscReal *difference);

/*
  Samples along the interfaces of a contact state, for output; arrays are the caller's, and any may be NULL.
  LamRVEGetInterfaceSize: `faces` = 3 per cell (face families 0, 1, 2 of cell 0, then of cell 1, ...; in a patch those
  with a neighbour), `points` per face, equidistant in the reference along the slave wall, counter-clockwise around
  its cell. Bonded tissue has none. LamRVEGetInterfaceFaces: owner [face][3], the cell, its face (0, 1 or 2) and the
  cell across it.

    from      [face][point][2]  current position on the wall of the face's cell
    to        [face][point][2]  nearest point of the facing wall (in the facing image); NaN: no facing wall
    gap       [face][point]     distance, in apothems (< 0: penetration); NaN: no facing wall
    pressure  [face][point]     contact pressure (Cauchy, >= 0), in C1 + C2; the traction is cohesion - pressure
*/
LAM_EXPORT PetscErrorCode LamRVEGetInterfaceSize(LamRVE rve, PetscInt *faces, PetscInt *points);
LAM_EXPORT PetscErrorCode LamRVEGetInterfaceFaces(LamRVE rve, PetscInt owner[]);
LAM_EXPORT PetscErrorCode LamRVEGetInterface(LamRVE rve, LamRVEState state, PetscReal from[], PetscReal to[],
                                             PetscReal gap[], PetscReal pressure[]);

/*
  The lamella of a state at the same samples. It joins the points of both walls that coincide at rest. Any array may be
  NULL.

    across           [face][point][2]  current position of the point that `from` is joined to
    damage           [face][point]  1 - integrity: share of the stiffness that is lost; 1: broken
    broken           [face][point]  share of the fracture energy that is spent; its mean, weighted by that energy, is
                                    broken_fraction of the response. A stiff lamella has lost most of its stiffness
                                    long before
    opening          [face][point]  jump across the face, in apothems (< 0: penetration)
    slip             [face][point]  jump along the face, in apothems; > 0: the wall of the face's cell has moved
                                    counter-clockwise around its cell, with respect to the wall across
    normal_traction  [face][point]  traction of the lamella alone, without contact pressure, nominal (per reference
    shear_traction   [face][point]  length), in C1 + C2: >= 0, and with the sign of the slip
    normal_force     [face]  integral of the normal traction by the Gauss points, per thickness, in C1 + C2 times
  apothem

  Jumps are those of the nodes; the others are interpolated linearly between Gauss points. PETSC_ERR_ARG_WRONGSTATE:
  the law of the interface is another one, which LamRVEGetInterfaceLaw tells.
*/
typedef struct {
  PetscReal *across, *damage, *broken, *opening, *slip, *normal_traction, *shear_traction,
      *normal_force; /* the caller's */
} LamRVELamella;
LAM_EXPORT PetscErrorCode LamRVEGetInterfaceLaw(LamRVE rve, LamInterfaceLawType *law);
LAM_EXPORT PetscErrorCode LamRVEGetLamella(LamRVE rve, LamRVEState state, const LamRVELamella *fields);

/*
  A responder that solves one RVE per query. Borrows `rve`, which must outlive it. It keeps two states
  (LamRVEStateSize) for each of the material points 0..points-1, from which their next solves start; other points
  start from the reference. It can be sealed if `rve` can, and then only responds for the points that it keeps.
*/
LAM_EXPORT PetscErrorCode LamRVEResponderCreate(LamRVE rve, PetscInt points, LamResponder *responder);
/*
  The same of tissue with law `lamella`, whose points hold second-order models of their last solves, at the history that
  they have accepted: a query is solved where the model's estimated error of P, as LamStressError, exceeds `accuracy`.
  Responses of models have the source LAM_SOURCE_DATABASE and the indicators of their solve, which are not trusted. For
  material points alone; cannot be sealed. PETSC_ERR_ARG_WRONGSTATE for another law.
*/
LAM_EXPORT PetscErrorCode LamRVEModelResponderCreate(LamRVE rve, PetscInt points, PetscReal accuracy,
                                                     LamResponder *responder);

LAM_C_END

#endif
