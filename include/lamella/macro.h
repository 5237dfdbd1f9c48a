/*
  The macroscale solver: total Lagrangian finite elements in plane strain whose material is a responder.

    LamMacroCreate(comm, &macro); LamMacroSetScene(macro, scene); LamMacroSetUp(macro);
    LamMacroGetPointCount(macro, &points);             to make the responder
    LamMacroSetResponder(macro, &responder); LamMacroSetMonitor(macro, step_done, ctx); LamMacroSetStop(macro, stop);
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

typedef struct {
  PetscInt step;         /* 1.. ; inflation, where asked for, is step 0; else turgor acts first in step 1 */
  PetscReal time;        /* s; NaN: load steps take none */
  PetscReal load_factor; /* share of the boundary displacements: 0 (after inflation) to 1; the last step of a run that
                            failed or was stopped in it ends at the last converged increment */
  PetscBool complete;    /* not one that came only part of its way */
  PetscInt boundary_count;
  char boundary[LAM_MAX_BOUNDARIES][LAM_NAME_LENGTH]; /* each named side once */
  PetscReal reaction[LAM_MAX_BOUNDARIES][2];          /* force on the body, stress * macro length, per thickness;
                                                         a corner's is shared among the sides that prescribe it */
  PetscReal displacement[LAM_MAX_BOUNDARIES][2];      /* prescribed, from where the conditions count; NaN: free */
  PetscReal work;                                     /* of the boundary forces since the start, stress * length^2 */
  PetscReal debonded_fraction, max_gap;               /* not finite where the responder does not know them */
  PetscReal turgor_mean;
  PetscReal ellipticity;            /* smallest of the material points (ellipticity.h); NaN: not known */
  PetscReal localisation_normal[2]; /* of the band that gives in first, there: its reference normal, */
  PetscReal localisation_place[2];  /* and the reference position of the point, macro lengths */
  PetscInt localised_points;        /* how many have lost it */
  PetscInt newton_iterations;       /* all of the step, cutbacks included */
  PetscInt cutbacks;
  PetscInt64 queries, hits, solves, failures; /* of this step, all ranks */
  PetscInt64 interpolated;                    /* answers from a database, likewise; some needed solves of nodes */
  PetscReal seconds;                          /* wall time */
  PetscReal query_seconds, solve_seconds;     /* of it in questions to databases and in solves, mean of the ranks */
  PetscReal residuals[64];                    /* of the last Newton iteration series, over the norm of the
                                                 element forces; residual_count entries */
  PetscInt residual_count;
  PetscReal order; /* log(r2 / r1) / log(r1 / r0) of its last three above 1e-8; NaN where there are fewer */
} LamMacroStep;

typedef enum { LAM_MACRO_DONE, LAM_MACRO_STOPPED, LAM_MACRO_NOT_CONVERGED } LamMacroReason;

enum { LAM_MESSAGE_LENGTH = 512 };

/* Called on all ranks after each converged step, and after one that came only part of its way; sets *stop to end the
   run after it. */
typedef PetscErrorCode (*LamMacroMonitor)(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx);

/* Called on all ranks after each attempt at an increment that failed; `why` is the reason, with the material point. */
typedef PetscErrorCode (*LamMacroCutback)(LamMacro macro, const char why[], void *ctx);

LAM_EXPORT PetscErrorCode LamMacroCreate(MPI_Comm comm, LamMacro *macro);
LAM_EXPORT PetscErrorCode LamMacroSetScene(LamMacro macro, const LamScene *scene); /* borrows the scene */
LAM_EXPORT PetscErrorCode LamMacroSetUp(LamMacro macro);
LAM_EXPORT PetscErrorCode LamMacroGetComm(LamMacro macro, MPI_Comm *comm);
LAM_EXPORT PetscErrorCode LamMacroGetPointCount(LamMacro macro, PetscInt *points); /* material points on this rank */
/*
  Of this rank's material points: X [point][2] reference positions in macro lengths, group [point] the index of the
  mesh's named region it lies in, -1: none. Names of these regions: of a Gmsh file's physical groups of elements.
*/
LAM_EXPORT PetscErrorCode LamMacroGetPlaces(LamMacro macro, PetscReal X[], PetscInt group[]);
LAM_EXPORT PetscErrorCode LamMacroGetGroups(LamMacro macro, PetscInt *count, const char (**names)[LAM_NAME_LENGTH]);
/* Tissue that differs from point to point, [point] each: the turgor at full inflation, and the cohesion; where this is
   not called they are the scene's. */
LAM_EXPORT PetscErrorCode LamMacroSetPointTissue(LamMacro macro, const PetscReal turgor[], const PetscReal cohesion[]);
LAM_EXPORT PetscErrorCode LamMacroSetResponder(LamMacro macro, LamResponder *responder); /* borrows it */
LAM_EXPORT PetscErrorCode LamMacroSetMonitor(LamMacro macro, LamMacroMonitor monitor, void *ctx);
LAM_EXPORT PetscErrorCode LamMacroSetCutback(LamMacro macro, LamMacroCutback cutback, void *ctx);
/*
  `stop` is asked after each batch of responses, and while other ranks are still at theirs; true on any rank, the
  increment under way is given up and the run ends with LAM_MACRO_STOPPED. Once true it must stay so. A responder may
  then leave its batch unfinished (LAM_OUT_OF_REACH).
*/
LAM_EXPORT PetscErrorCode LamMacroSetStop(LamMacro macro, PetscBool (*stop)(void));
/*
  Runs inflation and load steps with cutback. What was reached when it ends early is reported to the monitor as a step;
  `message` says why it failed.
*/
LAM_EXPORT PetscErrorCode LamMacroSolve(LamMacro macro, LamMacroReason *reason, char message[LAM_MESSAGE_LENGTH]);
/*
  Writes what a run needs to go on from the last complete step, or reads it, before LamMacroSolve: that goes on then
  with the next step, as if it had done all before. To be called from the monitor of a complete step, after which
  nothing else is to be kept. The archive may come from another number of ranks.
*/
LAM_EXPORT PetscErrorCode LamMacroArchive(LamMacro macro, LamArchive archive);
LAM_EXPORT PetscErrorCode LamMacroDestroy(LamMacro *macro);

/* ---- a body that is followed in time, instead of LamMacroSolve (body.h) ---- */

/* What the lumens of a material point are to hold at a turgor, per V0, and its derivative, which is not positive. */
typedef void (*LamWaterLaw)(void *ctx, PetscInt point, PetscReal turgor, PetscReal *water, PetscReal *slope);
/* The turgor is brought up by LamMacroStart and follows from the law then. To be called before LamMacroSetUp. */
LAM_EXPORT PetscErrorCode LamMacroSetWaterLaw(LamMacro macro, LamWaterLaw law, void *ctx);

/* Conditions at an instant. */
typedef struct {
  PetscReal load;    /* the load parameter */
  PetscReal turgor;  /* share of the points' turgor; 1 where it follows from water */
  PetscReal lamella; /* factor of the points' cohesion */
  PetscReal walls;   /* factor of the moduli of their walls */
} LamMacroInstant;

/* Of this rank. A state is u [displacements] and pressures [elements][modes]: turgor over that of LamMacroStart, for
   shape functions about the element's centre, of which the first is 1. */
typedef struct {
  PetscInt points, elements, displacements, modes; /* modes 0: the turgor is prescribed */
} LamMacroSizes;
LAM_EXPORT PetscErrorCode LamMacroGetSizes(LamMacro macro, LamMacroSizes *sizes);
/* [point] the reference volume that each stands for. */
LAM_EXPORT PetscErrorCode LamMacroGetVolumes(LamMacro macro, PetscReal volume[]);
/* Of a point's element: its number on this rank and in the undistributed mesh, and which of its points it is. */
LAM_EXPORT PetscErrorCode LamMacroGetElement(LamMacro macro, PetscInt point, PetscInt *local, PetscInt *number,
                                             PetscInt *index);

/* Brings the turgor up in the unloaded body, as LamMacroSolve does; *ok: PETSC_FALSE, and `message` says why not. */
LAM_EXPORT PetscErrorCode LamMacroStart(LamMacro macro, PetscBool *ok, char message[LAM_MESSAGE_LENGTH]);
/* Equilibrium under the conditions from a guess. *ok: found; else LamMacroTrouble says why not. Then one of the next.
 */
LAM_EXPORT PetscErrorCode LamMacroBalance(LamMacro macro, const LamMacroInstant *instant, const PetscReal u[],
                                          const PetscReal pressures[], PetscBool *ok);
LAM_EXPORT PetscErrorCode LamMacroAccept(LamMacro macro); /* it is the last converged state */
LAM_EXPORT PetscErrorCode LamMacroReject(LamMacro macro); /* all is as before it */
/* The state of the last LamMacroBalance. */
LAM_EXPORT PetscErrorCode LamMacroGetState(LamMacro macro, PetscReal u[], PetscReal pressures[]);
LAM_EXPORT const char *LamMacroTrouble(LamMacro macro);
LAM_EXPORT PetscErrorCode LamMacroStopped(LamMacro macro,
                                          PetscBool *stopped); /* LamMacroSetStop said so; on all ranks */

/* A material point in the last state that was evaluated. */
typedef struct {
  const LamLoad *load;
  const PetscReal *field; /* [LAM_POINT_FIELD_COUNT], below */
  PetscReal lumen;        /* -dPsi/dp, per V0; NaN where the turgor is prescribed */
  PetscInt percolating;   /* LamResponse.percolating_directions */
  PetscReal place[2];
} LamMacroPoint;
LAM_EXPORT PetscErrorCode LamMacroGetPoint(LamMacro macro, PetscInt point, LamMacroPoint *p);
/* What is kept of responses is void: the tissue has changed. */
LAM_EXPORT PetscErrorCode LamMacroForget(LamMacro macro);
/* The report of the last converged state at a time, as of a load step that began at the clock time `start`.
   Collective. */
LAM_EXPORT PetscErrorCode LamMacroDescribe(LamMacro macro, PetscInt number, PetscReal time, PetscReal start,
                                           LamMacroStep *step);

/* What is kept of a material point's response beside stress and deformation, one number each; NaN: not known. */
#define LAM_POINT_FIELDS(X)                                                                                            \
  X(LAM_POINT_TURGOR, "turgor")                                                                                        \
  X(LAM_POINT_LUMEN, "lumen_fraction")                                                                                 \
  X(LAM_POINT_OPENING, "opening_fraction")                                                                             \
  X(LAM_POINT_DEBONDED, "debonded_fraction")                                                                           \
  X(LAM_POINT_OPEN, "open_fraction")                                                                                   \
  X(LAM_POINT_GAP, "max_gap")               /* apothems */                                                             \
  X(LAM_POINT_UNLOADING, "face_unloading")  /* what the least pressed face family has lost of the pressure p + g that  \
                                               holds it closed: 1: contact carries nothing; NaN where p + g is 0, and  \
                                               of bonded tissue */                                                     \
  X(LAM_POINT_WALL, "wall_tension")         /* LamResponse.max_wall_tension */                                         \
  X(LAM_POINT_NORMAL, "lamella_normal")     /* max_traction */                                                         \
  X(LAM_POINT_SHEAR, "lamella_shear")       /* max_lamella_shear */                                                    \
  X(LAM_POINT_ELLIPTICITY, "ellipticity")   /* of the tangent (ellipticity.h); sealed cells: with their water. Of an   \
                                               element's points the smallest counts */                                 \
  X(LAM_POINT_ERROR, "error_estimate")      /* of an interpolated answer; 0: solved */                                 \
  X(LAM_POINT_INTERPOLATED, "interpolated") /* 1: answered by a database; 0: solved */                                 \
  X(LAM_POINT_DOUBTFUL, "doubtful")         /* 1: indicators that are not to be trusted; else 0 */
typedef enum { LAM_POINT_FIELDS(LAM_ENUM_ENTRY) LAM_POINT_FIELD_COUNT } LamPointField;
LAM_EXPORT extern const char *const LamPointFieldNames[];
LAM_EXPORT PetscBool LamPointFieldIsStress(LamPointField field); /* in C1 + C2; else a bare number */
/* Which of two values counts where one stands for several points: the larger; of what is lost as it falls, the smaller.
   A NaN is passed on. */
LAM_EXPORT PetscReal LamPointFieldWorse(LamPointField field, PetscReal a, PetscReal b);

/*
  Fields of the last converged step, gathered on rank 0 of the communicator (others get NULL), in the numbering of the
  undistributed mesh; the caller frees them with LamMacroFieldsDestroy. All nondimensional. n: LAM_POINT_FIELD_COUNT.
    nodes       [node_count][2]       reference positions
    u           [node_count][2]       displacement
    elements    [element_count][LAM_FIELD_NODES]  VTK's order: corners, mid-edges, centre; of a triangle six, then -1
    F, P        [element_count][9]    mean over the element's points, row-major 3x3
    cauchy      [element_count][9]    mean of P F^T / J over the element's present volume
    mean        [element_count][n]    mean over the element's points, by their reference volume
    largest     [element_count][n]    largest of the element's points, of the ellipticity the smallest; NaN where one of
                                      them is
    first_point [element_count + 1]   material points of element e: first_point[e] <= p < first_point[e + 1]
    point       [point_count][n]      of each point
    load        [point_count]         its deformation gradient, turgor and cohesion
    point_P     [point_count][9]      its first Piola-Kirchhoff stress
    place       [point_count][2]      its reference position
    position    [point_count][2]      its present position
    volume      [point_count]         the reference volume it stands for
*/
enum { LAM_FIELD_NODES = 9 };
typedef struct {
  PetscInt node_count, element_count, point_count;
  PetscReal *nodes, *u, *F, *P, *cauchy, *mean, *largest, *point, *point_P, *place, *position, *volume;
  LamLoad *load;
  PetscInt *elements, *first_point;
} LamMacroFields;
LAM_EXPORT PetscErrorCode LamMacroGetFields(LamMacro macro, LamMacroFields *fields);
LAM_EXPORT PetscErrorCode LamMacroFieldsDestroy(LamMacroFields *fields);
/* The number on this rank of point `index` of an element of the undistributed mesh; -1: another rank has it. */
LAM_EXPORT PetscErrorCode LamMacroFindPoint(LamMacro macro, PetscInt element, PetscInt index, PetscInt *point);

LAM_C_END

#endif
