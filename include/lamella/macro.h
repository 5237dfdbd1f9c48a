/*
  The macroscale solver: total Lagrangian finite elements in plane strain, or of an axisymmetric body (LamMacroSpec).
  The material is a responder.

    LamMacroCreate(comm, &macro); LamMacroSetScene(macro, scene); LamMacroSetUp(macro);
    LamMacroGetPointCount(macro, &points);             to create the responder
    LamMacroSetResponder(macro, responder); LamMacroSetMonitor(macro, step_done, ctx); LamMacroSetStop(macro, stop);
    LamMacroSolve(macro, &reason, message); LamMacroDestroy(&macro);
*/
#ifndef LAMELLA_MACRO_H
#define LAMELLA_MACRO_H

#include <petscsys.h>
#include <lamella/archive.h>
#include <lamella/scene.h>
#include <lamella/response.h>
#include <lamella/export.h>

LAM_C_BEGIN

typedef struct LamMacro_s *LamMacro;

/* Reactions of a step corrected by LamMacroSetReference. */
typedef struct {
  PetscBool made;
  PetscInt step;
  PetscReal load_factor;
  PetscInt points, of;                       /* points solved, of those whose responses are interpolated */
  PetscReal reaction[LAM_MAX_BOUNDARIES][2]; /* corrected; NaN: unknown */
  PetscReal margin[LAM_MAX_BOUNDARIES][2];   /* half the width of the interval that holds it with 99 % */
  char why[200];                             /* there is none, with the reason; empty: there is one */
} LamMacroCertificate;

typedef enum {
  LAM_CERTIFY_NONE,
  LAM_CERTIFY_SHARE, /* at the end of the run the last state and the one of the largest force, from a sample of points
                        that costs about a fifth of the run */
  LAM_CERTIFY_ALL    /* each step, from all points */
} LamCertify;

typedef struct {
  PetscInt step;         /* 1.. ; inflation, if requested, is step 0; otherwise turgor acts first in step 1 */
  PetscReal time;        /* s; NaN: quasi-static load steps */
  PetscReal load_factor; /* fraction of the boundary displacements: 0 (after inflation) to 1; the last step of a run
                            that failed or was stopped ends at the last converged increment */
  PetscBool complete;    /* PETSC_FALSE: ended at an increment before the end of the step */
  PetscInt boundary_count;
  char boundary[LAM_MAX_BOUNDARIES][LAM_NAME_LENGTH]; /* each named side once */
  /* force on the body, stress * macro length, per thickness; a corner's force is shared by the sides that prescribe
     it. Of an axisymmetric body stress * macro length^2, around the whole circle: along X2 the force, along X1 the
     integral of the radial traction, whose resultant is 0 */
  PetscReal reaction[LAM_MAX_BOUNDARIES][2];
  LamMacroCertificate certificate;               /* of these reactions */
  LamMacroCertificate peak;                      /* of an earlier step, whose force was larger; in the last report */
  PetscReal displacement[LAM_MAX_BOUNDARIES][2]; /* prescribed, relative to the start of the conditions; NaN: free */
  PetscInt obstacle_count;
  PetscReal obstacle[LAM_MAX_BOUNDARIES][6]; /* plates and indenters, macro lengths: a point of the plate, its normal
                                                into the body, 0, 0; the indenter's centre, that is of the sphere that
                                                rounds its edge where it were on the axis, direction, radius, and the
                                                radius of its edge, of a round one that of all of it */
  PetscReal work; /* of the boundary forces since the start, stress * length^2; axisymmetric: stress * length^3 */
  PetscReal debonded_fraction, max_gap; /* not finite if unknown to the responder */
  PetscReal turgor_mean;
  PetscReal ellipticity;            /* minimum over the material points (ellipticity.h); NaN: unknown */
  PetscReal localisation_normal[2]; /* reference normal of the critical band there, */
  PetscReal localisation_place[2];  /* and the reference position of the point, macro lengths */
  PetscInt localised_points;        /* number of points that have lost it, by more than the estimated error of A */
  /* of the points with law `lamella`; without any NaN and PETSC_FALSE */
  PetscReal stored, dissipated,
      released;               /* sums over the points since the undeformed tissue, stress * length^2 or ^3: */
  PetscReal tissue_work;      /* work of stress, turgor and suction, stored + dissipated + released */
  PetscReal broken_fraction;  /* mean of the share of the lamella's fracture energy that is spent */
  PetscBool mesh_dependent;   /* ellipticity has been lost in this or an earlier step: damage stays where
                                 that has put it, as narrow as elements, and so depends on the mesh */
  PetscInt newton_iterations; /* total of the step, cutbacks included */
  PetscInt cutbacks;
  PetscInt64 queries, hits, solves, failures; /* of this step, all ranks */
  PetscInt64 interpolated;                    /* responses from a database, likewise; some needed solves of nodes */
  PetscReal seconds;                          /* wall time */
  PetscReal query_seconds, solve_seconds;     /* part of it in database queries and in solves, mean over the ranks */
  PetscReal residuals[64]; /* of the last series of Newton iterations, over the norm of the element forces;
                              residual_count entries */
  PetscInt residual_count;
  PetscReal order; /* log(r2 / r1) / log(r1 / r0) of the last three residuals above 1e-8; NaN: fewer */
} LamMacroStep;

typedef enum { LAM_MACRO_DONE, LAM_MACRO_STOPPED, LAM_MACRO_NOT_CONVERGED } LamMacroReason;

enum { LAM_MESSAGE_LENGTH = 1024 };

/* Called on all ranks after each converged step, and after an incomplete last one; sets *stop to end the run after
   it. */
typedef PetscErrorCode (*LamMacroMonitor)(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx);

/* Called on all ranks after each failed increment; `why` is the reason, with the material point. */
typedef PetscErrorCode (*LamMacroCutback)(LamMacro macro, const char why[], void *ctx);

/* Index of a condition's side among `boundary` of the step; -1: there is none. */
LAM_EXPORT PetscInt LamMacroSideNumber(const LamMacroStep *step, const LamBoundary *boundary);

LAM_EXPORT PetscErrorCode LamMacroCreate(MPI_Comm comm, LamMacro *macro);
LAM_EXPORT PetscErrorCode LamMacroSetScene(LamMacro macro, const LamScene *scene); /* borrows the scene */
LAM_EXPORT PetscErrorCode LamMacroSetUp(LamMacro macro);
LAM_EXPORT PetscErrorCode LamMacroGetComm(LamMacro macro, MPI_Comm *comm);
LAM_EXPORT PetscErrorCode LamMacroGetPointCount(LamMacro macro, PetscInt *points); /* material points on this rank */
/*
  Material points of this rank: X [point][2] reference positions in macro lengths; groups [point] the mesh's named
  regions that it is in, bit k: region k. LamMacroGetGroups: names of these regions, the physical groups of elements of a Gmsh file.
*/
LAM_EXPORT PetscErrorCode LamMacroGetPlaces(LamMacro macro, PetscReal X[], unsigned int groups[]);
LAM_EXPORT PetscErrorCode LamMacroGetGroups(LamMacro macro, PetscInt *count, const char (**names)[LAM_NAME_LENGTH]);
/* Sets turgor at full inflation and cohesion per point, [point] each. Default: the scene's values. */
LAM_EXPORT PetscErrorCode LamMacroSetPointTissue(LamMacro macro, const PetscReal turgor[], const PetscReal cohesion[]);
LAM_EXPORT PetscErrorCode LamMacroSetResponder(LamMacro macro, LamResponder responder); /* borrows it */
/*
  Reactions are corrected, to first order, by the stress P of a second responder at the converged F of material points
  (LamMacroStep.certificate, peak); it need not know more than P. Borrows it. Not for load control, free grips,
  sealed cells and friction: PETSC_ERR_USER_INPUT with LAM_CERTIFY_ALL, else certificates say why. Call after
  LamMacroSetUp.

  LAM_CERTIFY_ALL: the reference is asked for all points of this rank at once, in the inflated body and in each step,
  and accepts. LAM_CERTIFY_SHARE: for one point at a time, at different times on the ranks; `reject` makes it start from
  its first state. branches: tissue may have several stable states at one F; then the point is led through earlier
  states of the run, each accepted, and margins are wider.
*/
LAM_EXPORT PetscErrorCode LamMacroSetReference(LamMacro macro, LamResponder reference, LamCertify which,
                                               PetscBool branches);
/* Instead: the certificate at the end says why there is none. */
LAM_EXPORT PetscErrorCode LamMacroRefuseCertificate(LamMacro macro, const char why[]);
LAM_EXPORT PetscErrorCode LamMacroSetMonitor(LamMacro macro, LamMacroMonitor monitor, void *ctx);
LAM_EXPORT PetscErrorCode LamMacroSetCutback(LamMacro macro, LamMacroCutback cutback, void *ctx);
/*
  `stop` is called after each batch of responses, and while waiting for other ranks. If it is true on any rank, the
  current increment is abandoned and the run ends with LAM_MACRO_STOPPED. Once true it must stay true. A responder may
  then leave its batch unfinished (LAM_OUT_OF_REACH).
*/
LAM_EXPORT PetscErrorCode LamMacroSetStop(LamMacro macro, PetscBool (*stop)(void));
/*
  Runs inflation and load steps with cutback. If it ends early, the part of the step that converged is reported to the
  monitor; `message`: why it failed.
*/
LAM_EXPORT PetscErrorCode LamMacroSolve(LamMacro macro, LamMacroReason *reason, char message[LAM_MESSAGE_LENGTH]);
/*
  Writes or reads a checkpoint of the last complete step. Reading precedes LamMacroSolve, which then continues with
  the next step as in an uninterrupted run. Writing: call it from the monitor of a complete step. The number of ranks
  may differ.
*/
LAM_EXPORT PetscErrorCode LamMacroArchive(LamMacro macro, LamArchive archive);
LAM_EXPORT PetscErrorCode LamMacroDestroy(LamMacro *macro);

/* ---- a body that changes in time, instead of LamMacroSolve (body.h) ---- */

/* Fields of water potential at the nodes, between which and the lumens water moves (docs/theory/process.md, Water that
   moves through a body). Pressures in C1 + C2, lengths in macro lengths, times in s. */
enum { LAM_MACRO_POTENTIALS = 2 };
typedef struct {
  PetscInt count;                               /* at least 1 */
  PetscReal conductivity[LAM_MACRO_POTENTIALS]; /* per reference lengths */
  PetscBool
      has_membrane[LAM_MACRO_POTENTIALS]; /* between it and what is outside; otherwise it is that of the apoplast */
} LamMacroTransport;

/* Water of a material point, per V0. The members behind `slope` are only for bodies with transport. */
typedef struct {
  PetscReal water, slope; /* volume of the lumens, and its derivative by the turgor, which is not positive */
  PetscReal potential;    /* of the cells */
  PetscReal by_potential[LAM_MACRO_POTENTIALS]; /* derivatives of the volume by the potentials */
  PetscReal flow[LAM_MACRO_POTENTIALS];         /* from each potential into the cells, with derivatives */
  PetscReal flow_turgor[LAM_MACRO_POTENTIALS], flow_potential[LAM_MACRO_POTENTIALS][LAM_MACRO_POTENTIALS];
  PetscReal magnitude; /* of the terms whose differences are the flows */
} LamWater;
/* potential [transport.count]; NULL without transport. */
typedef void (*LamWaterLaw)(void *ctx, PetscInt point, PetscReal turgor, const PetscReal potential[], LamWater *water);
/* LamMacroStart raises the turgor; afterwards it follows from the law. Call before LamMacroSetUp. */
LAM_EXPORT PetscErrorCode LamMacroSetWaterLaw(LamMacro macro, LamWaterLaw law, void *ctx);
/* Likewise. The surface is that of the scene's process.transport. */
LAM_EXPORT PetscErrorCode LamMacroSetTransport(LamMacro macro, const LamMacroTransport *transport);

/* Conditions at an instant. */
typedef struct {
  PetscReal load;    /* the load parameter */
  PetscReal turgor;  /* fraction of the points' turgor; 1 if turgor follows from water */
  PetscReal lamella; /* factor of the points' cohesion */
  PetscReal walls;   /* factor of the moduli of their walls */
  PetscReal time;    /* s, from 0 at LamMacroStart, before which everything was for ever; for walls with memory */
  /* with transport */
  PetscReal outside;                        /* water potential at the surface */
  PetscReal membrane[LAM_MACRO_POTENTIALS]; /* conductance of the membranes there, in macro lengths; where there are */
} LamMacroInstant;

/* Sizes on this rank. A state is u [displacements], pressures [elements][modes]: turgor over that of LamMacroStart, for
   shape functions about the element's centre, of which the first is 1; and potentials [potentials]. */
typedef struct {
  PetscInt points, elements, displacements, modes; /* modes 0: turgor is prescribed */
  PetscInt potentials;                             /* 0 without transport */
} LamMacroSizes;
LAM_EXPORT PetscErrorCode LamMacroGetSizes(LamMacro macro, LamMacroSizes *sizes);
/* Reference volume of each point, [point]; of an axisymmetric body that of the whole circle. */
LAM_EXPORT PetscErrorCode LamMacroGetVolumes(LamMacro macro, PetscReal volume[]);
/* Element of a point: its number on this rank and in the undistributed mesh; index: of the point in the element. */
LAM_EXPORT PetscErrorCode LamMacroGetElement(LamMacro macro, PetscInt point, PetscInt *local, PetscInt *number,
                                             PetscInt *index);

/* Raises the turgor in the unloaded body, as LamMacroSolve does; *ok PETSC_FALSE: it failed, with the reason in
   `message`. */
LAM_EXPORT PetscErrorCode LamMacroStart(LamMacro macro, PetscBool *ok, char message[LAM_MESSAGE_LENGTH]);
/* Solves for the equilibrium under the conditions from an initial guess. *ok: converged; else LamMacroTrouble
   returns the reason. Call LamMacroAccept or LamMacroReject afterwards. */
LAM_EXPORT PetscErrorCode LamMacroBalance(LamMacro macro, const LamMacroInstant *instant, const PetscReal u[],
                                          const PetscReal pressures[], const PetscReal potentials[], PetscBool *ok);
LAM_EXPORT PetscErrorCode LamMacroAccept(LamMacro macro); /* the solution becomes the last converged state */
LAM_EXPORT PetscErrorCode LamMacroReject(LamMacro macro); /* restores the state before LamMacroBalance */
/* The state of the last LamMacroBalance. */
LAM_EXPORT PetscErrorCode LamMacroGetState(LamMacro macro, PetscReal u[], PetscReal pressures[],
                                           PetscReal potentials[]);
/* Water that flows in at the surface then, volume (of which lumens are shares of V0) per time, all ranks; NaN without
   transport. */
LAM_EXPORT PetscErrorCode LamMacroGetInflow(LamMacro macro, PetscReal *inflow);
LAM_EXPORT const char *LamMacroTrouble(LamMacro macro);
LAM_EXPORT PetscErrorCode LamMacroStopped(LamMacro macro,
                                          PetscBool *stopped); /* by LamMacroSetStop; equal on all ranks */

/* A material point in the state evaluated last. */
typedef struct {
  const LamLoad *load;
  const PetscReal *field;     /* [LAM_POINT_FIELD_COUNT], below */
  const PetscReal *potential; /* [transport.count]; NULL without transport */
  PetscReal lumen;            /* -dPsi/dp, per V0; NaN if turgor is prescribed */
  PetscInt percolating;       /* LamResponse.percolating_directions */
  PetscReal place[2];
} LamMacroPoint;
LAM_EXPORT PetscErrorCode LamMacroGetPoint(LamMacro macro, PetscInt point, LamMacroPoint *p);
/* Discards stored responses, after the tissue has changed. */
LAM_EXPORT PetscErrorCode LamMacroForget(LamMacro macro);
/* The report of the last converged state at a time, as for a load step that began at clock time `start`. Collective. */
LAM_EXPORT PetscErrorCode LamMacroDescribe(LamMacro macro, PetscInt number, PetscReal time, PetscReal start,
                                           LamMacroStep *step);

/* Numbers stored for each material point beside stress and deformation; NaN: unknown. */
#define LAM_POINT_FIELDS(X)                                                                                            \
  X(LAM_POINT_TURGOR, "turgor")                                                                                        \
  X(LAM_POINT_LUMEN, "lumen_fraction")                                                                                 \
  X(LAM_POINT_OPENING, "opening_fraction")                                                                             \
  X(LAM_POINT_DEBONDED, "debonded_fraction")                                                                           \
  X(LAM_POINT_OPEN, "open_fraction")                                                                                   \
  X(LAM_POINT_GAP, "max_gap")              /* apothems */                                                              \
  X(LAM_POINT_UNLOADING, "face_unloading") /* fraction of the closing pressure p + g that the face family with the     \
                                              least contact pressure has lost; 1: contact carries nothing; NaN if      \
                                              p + g is 0, and for bonded tissue */                                     \
  X(LAM_POINT_WALL, "wall_tension")        /* LamResponse.max_wall_tension */                                          \
  X(LAM_POINT_NORMAL, "lamella_normal")    /* max_traction */                                                          \
  X(LAM_POINT_SHEAR, "lamella_shear")      /* max_lamella_shear */                                                     \
  X(LAM_POINT_ELLIPTICITY, "ellipticity")  /* of the tangent (ellipticity.h), for sealed cells at fixed water; minimum \
                                              over an element's points */                                              \
  X(LAM_POINT_ERROR, "error_estimate")     /* of an interpolated response; 0: solved */                                \
  X(LAM_POINT_INTERPOLATED, "interpolated") /* 1: from a database; 0: solved */                                        \
  X(LAM_POINT_DOUBTFUL, "doubtful")         /* 1: indicators are not trusted; else 0 */                                \
  X(LAM_POINT_POTENTIAL,                                                                                               \
    "water_potential") /* of the cells, and of the apoplast; of bodies with transport, else NaN */                     \
  X(LAM_POINT_APOPLAST, "apoplast_potential")                                                                          \
  /* of law `lamella`, else NaN; LamResponse */                                                                        \
  X(LAM_POINT_BROKEN, "broken_fraction")                                                                               \
  X(LAM_POINT_BROKEN_FACE, "broken_face") /* the largest of broken_by_face */                                          \
  X(LAM_POINT_STORED, "stored")           /* energies per reference volume */                                          \
  X(LAM_POINT_DISSIPATED, "dissipated")                                                                                \
  X(LAM_POINT_RELEASED, "released")                                                                                    \
  X(LAM_POINT_WORK, "work")
typedef enum { LAM_POINT_FIELDS(LAM_ENUM_ENTRY) LAM_POINT_FIELD_COUNT } LamPointField;
LAM_EXPORT extern const char *const LamPointFieldNames[];
LAM_EXPORT PetscBool LamPointFieldIsStress(LamPointField field); /* in C1 + C2; otherwise a number without unit */
LAM_EXPORT PetscBool LamPointFieldIsEnergy(LamPointField field); /* per volume, in C1 + C2, too */
/* The more critical of two values, when one stands for several points: the larger, or the smaller for quantities
   whose decrease is critical. NaN is propagated. */
LAM_EXPORT PetscReal LamPointFieldWorse(LamPointField field, PetscReal a, PetscReal b);

/*
  Fields of the last converged step, gathered on rank 0 of the communicator (others get NULL), in the numbering of the
  undistributed mesh; free them with LamMacroFieldsDestroy. All nondimensional. n: LAM_POINT_FIELD_COUNT.
    nodes       [node_count][2]       reference positions
    u           [node_count][2]       displacement
    gripped     [node_count]              1: on a side all of whose displacement is prescribed, or with a grip; else 0
    elements    [element_count][LAM_FIELD_NODES]  VTK's order: corners, mid-edges, centre; of a triangle six, then -1
    F, P        [element_count][9]    mean over the element's points, row-major 3x3
    cauchy      [element_count][9]    mean of P F^T / J over the element's current volume
    mean        [element_count][n]    mean over the element's points, by their reference volume
    largest     [element_count][n]    maximum over the element's points, minimum for the ellipticity; NaN if one of them
                                      is NaN
    first_point [element_count + 1]   material points of element e: first_point[e] <= p < first_point[e + 1]
    point       [point_count][n]      fields of each point
    load        [point_count]         its deformation gradient, turgor and cohesion
    point_P     [point_count][9]      its first Piola-Kirchhoff stress
    place       [point_count][2]      its reference position
    position    [point_count][2]      its current position
    volume      [point_count]         its reference volume
*/
enum { LAM_FIELD_NODES = 9 };
typedef struct {
  PetscInt node_count, element_count, point_count;
  PetscReal *nodes, *u, *F, *P, *cauchy, *mean, *largest, *point, *point_P, *place, *position, *volume;
  LamLoad *load;
  PetscInt *gripped, *elements, *first_point;
} LamMacroFields;
LAM_EXPORT PetscErrorCode LamMacroGetFields(LamMacro macro, LamMacroFields *fields);
LAM_EXPORT PetscErrorCode LamMacroFieldsDestroy(LamMacroFields *fields);
/* Number on this rank of point `index` of an element of the undistributed mesh; -1: it is on another rank. */
LAM_EXPORT PetscErrorCode LamMacroFindPoint(LamMacro macro, PetscInt element, PetscInt index, PetscInt *point);

LAM_C_END

#endif
