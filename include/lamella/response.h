/*
  The response of a material point: the result of a solve, a query or a cache lookup.
*/
#ifndef LAMELLA_RESPONSE_H
#define LAMELLA_RESPONSE_H

#include <petscsys.h>
#include <lamella/scene.h>
#include <lamella/export.h>

LAM_C_BEGIN

#define LAM_STATUSES(X)                                                                                                \
  X(LAM_CONVERGED, "converged")           /* residual below tolerance, stable */                                       \
  X(LAM_UNSTABLE, "unstable")             /* only an unstable branch was found; fields are available */                \
  X(LAM_NO_EQUILIBRIUM, "no_equilibrium") /* with a certificate in `reason` */                                         \
  X(LAM_NOT_CONVERGED, "not_converged")                                                                                \
  X(LAM_INVALID_F, "invalid_F")                                                                                        \
  X(LAM_OUT_OF_REACH, "out_of_reach") /* outside a database's range or accuracy, or the solve was stopped */
typedef enum { LAM_STATUSES(LAM_ENUM_ENTRY) LAM_STATUS_COUNT } LamStatus;
LAM_EXPORT extern const char *const LamStatusNames[];

#define LAM_SOURCES(X)                                                                                                 \
  X(LAM_SOURCE_SOLVE, "solve")                                                                                         \
  X(LAM_SOURCE_DATABASE, "database")
typedef enum { LAM_SOURCES(LAM_ENUM_ENTRY) LAM_SOURCE_COUNT } LamSource;
LAM_EXPORT extern const char *const LamSourceNames[];

#define LAM_VISIBLE_GAP 1e-3 /* apothems: larger gaps count as open */
#define LAM_BROKEN                                                                                                     \
  0.99 /* share of the fracture energy from which on a lamella counts as broken: some laws never end                   \
        */
#define LAM_UNKNOWN_COUNT -1 /* an unknown count; null in JSON */

/*
  Nondimensional (stresses in C1 + C2, lengths in apothems). Unknown numbers are NaN in memory and null in JSON. In
  plane strain, tangent entries that involve an out-of-plane shear component (13, 23, 31, 32) are NaN. Psi is the
  energy per reference volume, walls - p V_lumen + g V_gap; stress and tangent are its derivatives.
*/
typedef struct {
  LamLoad load; /* F, turgor, cohesion */
  LamStatus status;
  LamSource source;
  PetscReal energy;                 /* Psi */
  PetscReal P[9];                   /* dPsi/dF: effective first Piola-Kirchhoff stress, fluid included */
  PetscReal tangent[81];            /* dP_ij/dF_kl */
  PetscReal P_turgor[9];            /* dP/dp */
  PetscReal energy_turgor;          /* dPsi/dp: -lumen_fraction if all cells have the same turgor */
  PetscReal energy_turgor2;         /* d2Psi/dp2 */
  PetscReal P_cohesion[9];          /* dP/dg; 0 for bonded tissue */
  PetscReal energy_cohesion;        /* dPsi/dg: opening_fraction if all cells have the same cohesion */
  PetscReal energy_cohesion2;       /* d2Psi/dg2 */
  PetscReal energy_turgor_cohesion; /* d2Psi/dpdg */
  PetscReal turgor_mean;            /* lumen pressure, mean over the cells; for sealed cells the pressure reached */
  PetscReal turgor_spread;          /* largest minus smallest lumen pressure */
  PetscReal lumen_fraction;         /* V_lumen / V0 */
  PetscReal opening_fraction;       /* V_gap / V0 */
  PetscReal opening_by_face[3];     /* area between facing walls of a face family / V0, without junction voids */
  PetscReal debonded_fraction;      /* fraction of the interface length without contact, and without a lamella that
                                       holds, i.e. of which less than 99 % is spent; 0 for bonded tissue */
  PetscReal debonded_by_face[3];
  PetscReal open_fraction; /* fraction of the interface length with a gap above LAM_VISIBLE_GAP */
  PetscReal open_by_face[3];
  PetscReal debonded_spread, open_spread; /* change of the two fractions on a second mesh; NaN: not computed */
  PetscReal max_gap, mean_gap;            /* between facing walls; mean over the interface length */
  PetscReal min_gap;                      /* smallest gap if no walls touch; else 0; NaN: bonded tissue */
  PetscReal gap_place[3];                 /* location of max_gap: cell, face 0..2, position along the face in [0, 1] */
  PetscReal max_penetration;              /* pointwise; vanishes as the mesh is refined */
  PetscReal contact_width;                /* of the smooth law of contact, apothems; 0: the exact law */
  PetscReal
      contact_error; /* relative change of P from this width to none, to first order, as LamStressError; 0: exact */
  PetscReal third_fraction; /* share of the contact force between walls that do not face each other at rest */
  PetscReal lumen_contact;  /* share of the contact force within lumens */
  /* sum over closed faces of length n(x)n, over the whole interface length: 11, 22, 12; its trace is the closed
     fraction */
  PetscReal fabric[3];
  /* mean over the interface length of jump(x)jump where walls have separated, apothems^2: 11, 22, 12; jump: between
     points that coincided. Its first principal axis is the direction of cell separation */
  PetscReal opening_moment[3];
  /* tractions are NaN if there is no such face: in a patch too narrow for a face family, or of a single cell */
  PetscReal max_traction;      /* largest normal Cauchy traction averaged over one wall thickness, tension > 0 */
  PetscReal normal_place[3];   /* location of max_traction: cell, face, position along the face in [0, 1] */
  PetscReal max_lamella_shear; /* magnitude of the shear traction, likewise; 0 for law `contact` */
  PetscReal shear_place[3];
  PetscReal mean_face_traction[3]; /* mean normal Cauchy traction per face family, tension > 0 */
  /* wall averages over the thickness t and a length t along the wall: fibre stretch, energy density without U,
     tension; the largest such averages. Tension: Cauchy stress along the fibre plus the turgor of the wall's own
     cell, because the wall is surrounded by that fluid. The tractions above are absolute: a gap opens against air
     (docs/theory/failure.md) */
  PetscReal max_fibre_stretch, max_wall_energy, max_wall_tension;
  PetscReal wall_place[3];        /* location of max_wall_tension: cell, face 0..5, position along the face in [0, 1] */
  PetscReal mean_wall_tension[3]; /* mean tension over the walls of a face family; 0 on average: slack */
  /* ellipticity of the wall material: minimum over such windows of the mean of its smallest stiffness against
     volume-preserving shear bands; kinked_fraction: fraction of the walls' volume where that stiffness is negative
     at the point. There walls wrinkle at the mesh scale, and error_estimate is no bound */
  PetscReal wall_ellipticity;
  PetscReal kink_place[3]; /* location of wall_ellipticity, as wall_place */
  PetscReal kinked_fraction;
  /* strong ellipticity of the tangent in the plane (ellipticity.h): its smallest stiffness against a band, negative
     where the tissue localises over lengths beyond the RVE; reference normal of that band and direction of the
     relative motion of its sides. Unknown if the tangent is unknown */
  PetscReal ellipticity, localisation_normal[3], localisation_mode[3];
  PetscReal lowest_eigenvalue;     /* estimate for the softest mode if computed (unstable states), else NaN */
  PetscInt floating_cells;         /* cells without any contact or lamella */
  PetscInt zero_modes;             /* zero-energy motions of the cells: sliding or spinning */
  PetscInt cell_clusters;          /* groups of cells connected by contact or a lamella */
  PetscInt percolating_directions; /* number of independent period directions, 0 to 2, that a group spans */
  PetscInt negative_eigenvalues;   /* of the consistent tangent */
  PetscBool stable;
  /* Of law `lamella`; unknown for other laws. Energies per V0 since the undeformed tissue; energy = stored +
     dissipated; work and released are known if all states so far were solved with LAM_WANT_STRESS */
  PetscReal stored;           /* energy without what was spent: walls, fluid, and the lamella's elastic energy */
  PetscReal dissipated;       /* spent in the lamella and in walls that tear, ... */
  PetscReal dissipated_walls; /* ... and in these alone */
  PetscReal work;     /* of stress, turgor and suction, by the trapezoidal rule: stored + dissipated + released */
  PetscReal released; /* lost in jumps, i.e. to sound and heat */
  PetscReal broken_fraction; /* share of the lamella's fracture energy that is spent */
  PetscReal broken_by_face[3];
  PetscReal burst_fraction; /* share of the cells that have burst: a wall is torn through, and turgor is lost */
  PetscReal juice;          /* volume per V0 of their lumens, when they burst */
  /* Of a patch with a notch: the broken faces that hang together with it, and how far they run beyond it along X1, in
     apothems; a face is broken once more than half of its energy is spent. */
  PetscInt crack_faces;
  PetscReal crack_length;
  PetscBool jumped;             /* the branch of the state before ends: this is the next minimum */
  PetscReal energy_released;    /* Psi that the jump has lost; NaN: no jump */
  PetscBool indicators_trusted; /* of a response from a database: quantities that are not derivatives of Psi vary little
                                   between the surrounding states; true for a solve */
  PetscInt branch;              /* 0: reached without leaving a saddle; n: after n branch switches */
  PetscInt newton_iterations;   /* total, including rejected steps and substeps */
  PetscInt factorisations;
  PetscInt unknowns;
  PetscReal seconds;
  PetscReal error_estimate;         /* relative error of P, as LamStressError */
  PetscReal tangent_error_estimate; /* of an interpolated response: of the tangent, as LamTangentError; else NaN */
  PetscReal distance;               /* strain distance of a query to the record that was used; 0 for a solve */
  char reason[192];                 /* why the status is not `converged`; otherwise empty */
} LamResponse;

/* Components of F that differ by less are the same: what the arithmetic of a program that calls leaves of a 0, seen up
   to 2e-10, with room. An error of F of this size is one of some 1e-6 of the tissue's moduli. */
#define LAM_ROUNDED_F 1e-6
/* True if F33 = 1 and there are no out-of-plane shears. */
LAM_EXPORT PetscBool LamPlaneStrain(const PetscReal F[9]);
/* Sets out-of-plane shears to 0, if all are that small. */
LAM_EXPORT void LamRoundToPlane(PetscReal F[9]);
/* Returns PETSC_FALSE, and sets status and reason of the response, if the load is not admissible in plane strain;
   LamLoadValidateInPlane: likewise with any F33. */
LAM_EXPORT PetscBool LamLoadValidateInPlane(const LamLoad *load, LamResponse *response);
LAM_EXPORT PetscBool LamLoadValidate(const LamLoad *load, LamResponse *response);

/* Initialises a response: reals NaN, counts 0, status LAM_NOT_CONVERGED; copies the load. */
LAM_EXPORT PetscErrorCode LamResponseInit(const LamLoad *load, LamResponse *response);

/* True if the fields (stress, tangent) of the response are valid: converged or unstable. */
LAM_EXPORT PetscBool LamResponseHasFields(const LamResponse *response);

/*
  d2Psi/dp2 bounded away from zero, for division. It is negative in all stable states, but values from a database
  contain interpolation errors (docs/theory/database.md, Cells and nodes).
*/
#define LAM_LEAST_CONCAVITY (-1e-8) /* V0 over C1 + C2, chosen; closed cells have -2.8e-4 at kappa = 1000 (C1 + C2) */
static inline PetscReal LamResponseConcavity(const LamResponse *response)
{
  return PetscMin(response->energy_turgor2, LAM_LEAST_CONCAVITY);
}

/* Error of stress P against P_ref in the plane: |P - P_ref| / max(|P_ref|, scale.plane), Frobenius norms. */
LAM_EXPORT PetscReal LamStressError(LamStressScale scale, const PetscReal P[9], const PetscReal P_ref[9]);
/* The same of P33, with scale.axial. */
LAM_EXPORT PetscReal LamAxialError(LamStressScale scale, const PetscReal P[9], const PetscReal P_ref[9]);
/* The larger one of both. */
LAM_EXPORT PetscReal LamWholeError(LamStressScale scale, const PetscReal P[9], const PetscReal P_ref[9]);
/* LamStressError for an error of this norm. */
LAM_EXPORT PetscReal LamStressErrorOfSize(LamStressScale scale, PetscReal size, const PetscReal P_ref[9]);
/* Error of tangent A against A_ref in the plane: |A - A_ref| / (|A_ref| + scale.plane), Frobenius norms. */
LAM_EXPORT PetscReal LamTangentError(LamStressScale scale, const PetscReal A[81], const PetscReal A_ref[81]);
/* LamTangentError for an error of this norm. */
LAM_EXPORT PetscReal LamTangentErrorOfSize(LamStressScale scale, PetscReal size, const PetscReal A_ref[81]);

/*
  A named number or array of a response. HDF5 records, JSON and the docs are generated from this list.
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
  const char *unit; /* of a real without a power of stress: "apothem", "s"; NULL: 1 */
  const char *axes; /* what three numbers are: "face family", "11 22 12"; NULL: tensors, single numbers */
} LamMember;
LAM_EXPORT extern const LamMember LamResponseMembers[]; /* ends with a NULL name */
#define LAM_NOT_IN_FILE ((size_t)-1)                    /* offset of a member that a record does not contain */
/* Index into LamResponseMembers of the member at this offset of LamResponse; it must exist. */
LAM_EXPORT size_t LamResponseMemberIndex(size_t offset);

/* Converts a response to another unit of stress; `stress` is the present unit in terms of the new one. */
LAM_EXPORT void LamResponseScale(PetscReal stress, LamResponse *response);

/*
  A responder: the object through which the macroscale solver obtains responses of the tissue. Its functions, of which
  only `respond` is needed; the others may be NULL. `respond` is collective over the communicator of the macroscale
  problem. Point indices are local to a rank, 0..n-1, and identify a material point permanently, so that a responder
  can keep a state for each; -1: none. A responder that is stopped during a batch returns LAM_OUT_OF_REACH for the rest.
*/
typedef struct {
  PetscErrorCode (*respond)(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                            LamResponse responses[]);
  PetscErrorCode (*accept)(void *ctx); /* the load step has converged: its states become the new starting points */
  PetscErrorCode (*reject)(void *ctx); /* the load step is abandoned: restore the last accepted states */
  /* Once, after accept: the cells of each point keep the water of its accepted state, with bulk modulus K_w (C1 +
     C2, positive and finite). From then on the turgor of a load is the pressure of that water, and turgor_mean of
     the response is the pressure reached (rve.h, LamRVESeal). A query without a point is then
     PETSC_ERR_ARG_OUTOFRANGE; sealing before each point has a response is PETSC_ERR_ORDER. NULL: turgor is always
     prescribed, and sealing is PETSC_ERR_SUP. */
  PetscErrorCode (*seal)(void *ctx, PetscReal bulk_modulus);
  PetscErrorCode (*destroy)(void **ctx); /* NULL: ctx is not owned */
  /*
    Serialisation of the states of the last `accept`, for a restart. state_size: maximum over the points of this rank.
    NULL: there are no states, 0 bytes. `load` makes the bytes the accepted state of the point; it is sealed if it was.
  */
  PetscErrorCode (*state_size)(void *ctx, size_t *bytes);
  PetscErrorCode (*save)(void *ctx, PetscInt point, void *bytes);
  PetscErrorCode (*load)(void *ctx, PetscInt point, const void *bytes);
} LamResponderFunctions;

/*
  Counters of this rank since creation. A query is a hit (answered from the database as it was), a failure (a
  response without fields), or it required a solve: queries - hits - failures. `solves` counts solves, failed ones
  included; with a cache those of nodes, each used by many queries, and of states for which no node helps.
  `interpolated` counts responses from a database, as it was or with nodes solved for the query.
*/
typedef struct {
  PetscInt64 queries, hits, interpolated, solves, failures;
  PetscReal query_seconds, solve_seconds; /* time in database queries, and in solves */
} LamResponderCounters;

typedef struct LamResponder_s *LamResponder;

/* Copies the functions. Borrows the counters, which `respond` updates; NULL: none are kept. */
LAM_EXPORT PetscErrorCode LamResponderCreate(const LamResponderFunctions *functions, void *ctx,
                                             const LamResponderCounters *counters, LamResponder *responder);
LAM_EXPORT PetscErrorCode LamResponderDestroy(LamResponder *responder);
LAM_EXPORT LamResponderCounters LamResponderGetCounters(LamResponder responder);
/* Call the functions above. */
LAM_EXPORT PetscErrorCode LamResponderRespond(LamResponder responder, PetscInt n, const LamLoad *loads,
                                              const PetscInt *points, LamResponse *responses);
LAM_EXPORT PetscErrorCode LamResponderAccept(LamResponder responder);
LAM_EXPORT PetscErrorCode LamResponderReject(LamResponder responder);
LAM_EXPORT PetscErrorCode LamResponderSeal(LamResponder responder, PetscReal bulk_modulus);
LAM_EXPORT PetscErrorCode LamResponderGetStateSize(LamResponder responder, size_t *bytes);
LAM_EXPORT PetscErrorCode LamResponderSave(LamResponder responder, PetscInt point, void *bytes);
LAM_EXPORT PetscErrorCode LamResponderLoad(LamResponder responder, PetscInt point, const void *bytes);

LAM_C_END

#endif
