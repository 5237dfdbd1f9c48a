/*
  The response of a material point: what one solve, one query or one cached answer gives.
*/
#ifndef LAMELLA_RESPONSE_H
#define LAMELLA_RESPONSE_H

#include <petscsys.h>
#include <lamella/scene.h>
#include <lamella/export.h>

LAM_C_BEGIN

#define LAM_STATUSES(X)                                                                                                \
  X(LAM_CONVERGED, "converged")           /* residual met, stable */                                                   \
  X(LAM_UNSTABLE, "unstable")             /* only an unstable branch was found; fields are given */                    \
  X(LAM_NO_EQUILIBRIUM, "no_equilibrium") /* with a certificate in `reason` */                                         \
  X(LAM_NOT_CONVERGED, "not_converged")                                                                                \
  X(LAM_INVALID_F, "invalid_F")                                                                                        \
  X(LAM_OUT_OF_REACH, "out_of_reach") /* a database cannot answer here, or a stop came before the end of the solve */
typedef enum { LAM_STATUSES(LAM_ENUM_ENTRY) LAM_STATUS_COUNT } LamStatus;
LAM_EXPORT extern const char *const LamStatusNames[];

#define LAM_SOURCES(X)                                                                                                 \
  X(LAM_SOURCE_SOLVE, "solve")                                                                                         \
  X(LAM_SOURCE_DATABASE, "database")
typedef enum { LAM_SOURCES(LAM_ENUM_ENTRY) LAM_SOURCE_COUNT } LamSource;
LAM_EXPORT extern const char *const LamSourceNames[];

#define LAM_VISIBLE_GAP 1e-3 /* apothems: a gap above it counts as open */
#define LAM_UNKNOWN_COUNT -1 /* a count that is not known; null in JSON */

/*
  Nondimensional (stresses in C1 + C2, lengths in apothems). A number that is not known is NaN in memory and null in
  JSON. In plane strain tangent entries that involve an out-of-plane shear component (13, 23, 31, 32) are NaN.
  Psi is the energy per reference volume, walls - p V_lumen + g V_gap, of which all else is a derivative.
*/
typedef struct {
  LamLoad load; /* the question: F, turgor, cohesion */
  LamStatus status;
  LamSource source;
  PetscReal energy;                 /* Psi */
  PetscReal P[9];                   /* dPsi/dF: effective first Piola-Kirchhoff stress, fluid included */
  PetscReal tangent[81];            /* dP_ij/dF_kl */
  PetscReal P_turgor[9];            /* dP/dp */
  PetscReal energy_turgor;          /* dPsi/dp: -lumen_fraction, where all cells have the same turgor */
  PetscReal energy_turgor2;         /* d2Psi/dp2 */
  PetscReal P_cohesion[9];          /* dP/dg; 0 for bonded tissue */
  PetscReal energy_cohesion;        /* dPsi/dg: opening_fraction, where all cells have the same cohesion */
  PetscReal energy_cohesion2;       /* d2Psi/dg2 */
  PetscReal energy_turgor_cohesion; /* d2Psi/dpdg */
  PetscReal turgor_mean;            /* pressure in the lumens, mean over the cells; of sealed cells that reached */
  PetscReal turgor_spread;          /* its largest over the cells minus its smallest */
  PetscReal lumen_fraction;         /* V_lumen / V0 */
  PetscReal opening_fraction;       /* V_gap / V0 */
  PetscReal opening_by_face[3];     /* area between facing walls of a face family / V0; junction voids left out */
  PetscReal debonded_fraction;      /* share of interface length without contact; 0 for bonded tissue */
  PetscReal debonded_by_face[3];
  PetscReal open_fraction; /* share of interface length with a gap above LAM_VISIBLE_GAP */
  PetscReal open_by_face[3];
  PetscReal debonded_spread, open_spread; /* change of the two fractions on a second mesh; NaN: not computed */
  PetscReal max_gap, mean_gap;            /* between facing walls; mean over the interface length */
  PetscReal min_gap;                      /* the smallest, where no walls touch; else 0; NaN: bonded tissue */
  PetscReal gap_place[3];                 /* of max_gap: cell, face 0..2, place along the face in [0, 1] */
  PetscReal max_penetration;              /* pointwise; goes to zero with the mesh */
  /* sum over closed faces of length n(x)n over the whole interface length: 11, 22, 12; its trace is the closed share */
  PetscReal fabric[3];
  /* mean over the interface length of jump(x)jump where walls have come apart, apothems^2: 11, 22, 12; jump: between
     points that were one. Its first axis is the direction in which cells come apart */
  PetscReal opening_moment[3];
  /* tractions are NaN where there is no face: in a patch that is too narrow for a family, or has one cell alone */
  PetscReal max_traction;      /* largest normal Cauchy traction averaged over one wall thickness, tension > 0 */
  PetscReal normal_place[3];   /* of max_traction: cell, face, place along the face in [0, 1] */
  PetscReal max_lamella_shear; /* the same of the shear traction, without sign; 0 for contact tissue */
  PetscReal shear_place[3];
  PetscReal mean_face_traction[3]; /* mean normal Cauchy traction per face family, tension > 0 */
  /* walls, averaged over the whole thickness t of a wall and a length t along it: fibre stretch, energy density
     without U, tension; the largest such means. Tension: Cauchy stress along the fibre plus the turgor of the wall's
     own cell, the fluid it stands in. The tractions above are absolute: a gap opens against air
     (docs/theory/failure.md)
   */
  PetscReal max_fibre_stretch, max_wall_energy, max_wall_tension;
  PetscReal wall_place[3];        /* of max_wall_tension: cell, face 0..5, place along the face in [0, 1] */
  PetscReal mean_wall_tension[3]; /* tension, mean over the walls of a face family; 0 on average: slack */
  /* whether the wall material still resists kinks: the smallest mean over such windows of its smallest stiffness
     against shear bands that keep the volume, and the share of the walls' volume where that is negative at the point.
     There walls wrinkle as finely as the mesh lets them, and error_estimate is no bound */
  PetscReal wall_ellipticity;
  PetscReal kink_place[3]; /* of wall_ellipticity: as wall_place */
  PetscReal kinked_fraction;
  /* strong ellipticity of the tangent in the plane (ellipticity.h): its smallest stiffness against a band, below 0
     where the tissue localises over lengths beyond the RVE; reference normal of that band and the direction in which
     its sides move. Not known where the tangent is not */
  PetscReal ellipticity, localisation_normal[3], localisation_mode[3];
  PetscReal lowest_eigenvalue;     /* estimate of the softest mode where it was computed (unstable states), else NaN */
  PetscInt floating_cells;         /* cells without any contact */
  PetscInt zero_modes;             /* motions of the cells that change no energy: cells slide or spin free */
  PetscInt cell_clusters;          /* groups of cells that contact joins */
  PetscInt percolating_directions; /* of the period, 0 to 2: how many independent ones a group spans */
  PetscInt negative_eigenvalues;   /* of the consistent tangent */
  PetscBool stable;
  PetscBool indicators_trusted; /* of a database's answer: what is not a derivative of Psi changes little between the
                                   states around; true for a solve */
  PetscInt branch;              /* 0: reached without leaving a saddle; n: after n branch switches */
  PetscInt newton_iterations;   /* all of them: rejected steps and substeps included */
  PetscInt factorisations;
  PetscInt unknowns;
  PetscReal seconds;
  PetscReal error_estimate; /* relative error of P, as LamStressError */
  PetscReal distance;       /* of a query to the record that answered, in strain; 0 for a solve */
  char reason[192];         /* why the status is not `converged`; empty otherwise */
} LamResponse;

/* F33 = 1 without out-of-plane shears. */
LAM_EXPORT PetscBool LamPlaneStrain(const PetscReal F[9]);
/* PETSC_FALSE, with status and reason of the response, for a load that no tissue in plane strain can have. */
LAM_EXPORT PetscBool LamLoadValidate(const LamLoad *load, LamResponse *response);

/* Clears a response to "nothing known": reals NaN, counts 0, status LAM_NOT_CONVERGED; copies the load. */
LAM_EXPORT PetscErrorCode LamResponseInit(const LamLoad *load, LamResponse *response);

/* True where the fields (stress, tangent) of the response may be used: converged or unstable. */
LAM_EXPORT PetscBool LamResponseHasFields(const LamResponse *response);

/*
  d2Psi/dp2 as what divides by it needs it: no stable state has it at zero or above, but an answer from a database has
  the errors of its strains in it (docs/theory/database.md, Cells and nodes).
*/
#define LAM_LEAST_CONCAVITY (-1e-8) /* V0 over C1 + C2, chosen; closed cells have -2.8e-4 at kappa = 1000 (C1 + C2) */
static inline PetscReal LamResponseConcavity(const LamResponse *response)
{
  return PetscMin(response->energy_turgor2, LAM_LEAST_CONCAVITY);
}

/* Error of stress P against P_ref: |P - P_ref| / (|P_ref| + floor), Frobenius norms, nondimensional. The floor is
   2.5e-3 MPa of the reference wall (C1 + C2 = 0.11 MPa): below it stress counts as zero. */
#define LAM_STRESS_FLOOR 0.0227
LAM_EXPORT PetscReal LamStressError(const PetscReal P[9], const PetscReal P_ref[9]);

/*
  One named number (or array) of a response: the single list from which HDF5 records, JSON and the docs are made.
*/
typedef enum { LAM_MEMBER_REAL, LAM_MEMBER_INT, LAM_MEMBER_BOOL, LAM_MEMBER_ENUM, LAM_MEMBER_TEXT } LamMemberType;
typedef struct {
  const char *name;
  LamMemberType type;
  PetscInt count;           /* numbers, or bytes of text */
  size_t offset;            /* in LamResponse */
  PetscReal stress_power;   /* physical value = number * (C1 + C2)^stress_power */
  const char *const *names; /* of an enumeration, else NULL */
  const char *help;
} LamMember;
LAM_EXPORT extern const LamMember LamResponseMembers[]; /* ends with a NULL name */
#define LAM_NOT_IN_FILE ((size_t)-1)                    /* the place of a member that a record has not got */
/* Index into LamResponseMembers of the member that begins at this offset of LamResponse; there must be one. */
LAM_EXPORT size_t LamResponseMemberIndex(size_t offset);

/* Expresses a response in another unit of stress, of which its present one is `stress`. */
LAM_EXPORT void LamResponseScale(PetscReal stress, LamResponse *response);

/*
  The responder table: all that the macroscale solver knows of the tissue. `respond` is collective over the
  communicator of the macroscale problem. Point indices are local to a rank, 0..n-1, and name a material point for
  good, so that a responder can keep a state for each; -1: none. A responder that is stopped in the middle of a batch
  answers the rest with LAM_OUT_OF_REACH.
*/
typedef struct LamResponder_s {
  void *ctx; /* owned by the responder */
  PetscErrorCode (*respond)(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                            LamResponse responses[]);
  PetscErrorCode (*accept)(void *ctx); /* the load step has converged: its states become the starting points */
  PetscErrorCode (*reject)(void *ctx); /* the load step is given up: go back to the last accepted one */
  /* Once, after accept: the cells of each point keep the water that they have in its accepted state, of bulk modulus
     K_w (C1 + C2, positive and finite); from here on the turgor of a load is the pressure of that water, and
     turgor_mean of the response that reached (rve.h, LamRVESeal). A question without a point is then
     PETSC_ERR_ARG_OUTOFRANGE, as is sealing before each point has an answer PETSC_ERR_ORDER. NULL: turgor is prescribed
     for good. */
  PetscErrorCode (*seal)(void *ctx, PetscReal bulk_modulus);
  PetscErrorCode (*destroy)(void **ctx);
  /*
    The states that the last `accept` left, as bytes, for a run that goes on from them; state_size: of the point on this
    rank that needs most. NULL: there are none to keep. `load` makes a point's bytes its accepted state, which is sealed
    if it was.
  */
  PetscErrorCode (*state_size)(void *ctx, size_t *bytes);
  PetscErrorCode (*save)(void *ctx, PetscInt point, void *bytes);
  PetscErrorCode (*load)(void *ctx, PetscInt point, const void *bytes);
  /*
    Counted on this rank since creation. A question is a hit (the database as it was answers it), or a failure (no
    fields in the answer), or else something had to be solved for it: queries - hits - failures. `solves` are the solves
    made: with a cache those of the nodes, which many questions share, and of states where no node helps, failed or not.
    `interpolated` are the answers from a database, as it was or with the nodes that were solved for them.
  */
  PetscInt64 queries, hits, interpolated, solves, failures;
  PetscReal query_seconds, solve_seconds; /* in questions to a database, and in solves */
} LamResponder;

LAM_C_END

#endif
