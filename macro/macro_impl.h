/*
  Private parts of the macroscale solver.

    mesh.c      distribution, numbering, named sets, geometry of elements
    mesh_box.c, mesh_disc.c, mesh_gmsh.c, mesh_gmsh_read.c   mesh generation and mesh files
    element.c, facet.c   shape functions and Gauss points of elements, geometry of the boundary facets
    boundary.c  prescribed displacements
    traction.c  dead and follower tractions
    obstacle.c  rigid plates and indenters
    rows.c      equations of nodes with prescribed displacement or in contact with an obstacle
    border.c, reaction.c   unknowns other than nodal displacements: grips, traction factor; reactions and work
    certify.c, correction.c, sensitivity.c, sample.c, waypoints.c   reactions corrected by another responder
    assembly.c  gather F, query the responder, assemble force and tangent
    sealed.c    pressures of sealed lumens
    transport.c, transport_create.c, transport_solve.c   water that moves through the body
    inflation.c initial guess of the inflated body
    stepping.c  Newton, load steps, cutback
    instant.c   equilibrium at an instant, for time integration
    localisation.c    ellipticity at the material points
    fields.c, checkpoint.c   response fields stored for output, gathering of fields on rank 0; restart data

  The dimension `dim` of the body is that of its mesh; only the responder assumes that it is 2 (plane strain, or the
  half plane of radius and axis of an axisymmetric body, whose F33 = 1 + u1 / X1).
*/
#ifndef LAM_MACRO_IMPL_H
#define LAM_MACRO_IMPL_H

#include <petscdmplex.h>
#include <petscsf.h>
#include <petscsnes.h>
#include <lamella/macro.h>

enum {
  LAM_MACRO_DIM = 3, /* upper bounds of all that follows */
  LAM_MACRO_NODES = 27,
  LAM_MACRO_DOFS = LAM_MACRO_DIM * LAM_MACRO_NODES,
  LAM_MACRO_STRAINS = LAM_MACRO_DIM * LAM_MACRO_DIM, /* components of F that vary */
  LAM_MACRO_MODES = LAM_MACRO_DIM + 1,               /* of an element's pressure */
  LAM_MACRO_KINDS = 2,
  LAM_MACRO_SETS = 32, /* named boundaries; one bit each */
  LAM_MACRO_GROUPS = 32
};

/* A kind of element: quadratic shape functions at its Gauss points, on DMPlex's reference cell. */
typedef struct {
  DMPolytopeType polytope;
  PetscInt nodes, points; /* nodes in the order of DMPlex closures: interior, (faces,) edges, vertices */
  PetscReal *gradient;    /* [points][nodes][dim] */
  PetscReal *value;       /* [points][nodes] */
  PetscReal *weight;      /* [points] */
} LamMacroKind;

/* An element of this rank. */
typedef struct {
  const LamMacroKind *kind;
  PetscInt number;   /* in the undistributed mesh, independent of the number of ranks */
  PetscInt first;    /* first material point; its points are contiguous */
  PetscInt gradient; /* offset of its dN/dX in LamMacro.gradient: [points][nodes][dim]; over dim: of its N/X1 in hoop */
  unsigned int groups; /* bit k: named region k */
} LamMacroElement;

/* A node that this rank owns. */
typedef struct {
  PetscInt point;     /* of the mesh */
  PetscInt local;     /* the node's first index in this rank's part of a global vector */
  PetscInt number;    /* in the undistributed mesh */
  const PetscReal *X; /* [dim] reference position; borrowed */
} LamMacroNode;

/* A boundary facet on this rank that belongs to a named set. */
typedef struct {
  PetscInt point;    /* of the mesh */
  PetscInt element;  /* adjacent element */
  unsigned int sets; /* bit k: set k */
} LamMacroFacet;

/* The stored response of a material point. */
typedef struct {
  PetscBool known; /* the data below are valid for `load` and `walls` */
  LamLoad load;
  PetscReal walls; /* factor on the moduli of the responder's tissue; NaN: outdated, the responder may respond
                      differently now */
  PetscReal P[9];
  PetscReal A[81]; /* [strains][strains] dP/dF of the components that vary */
  PetscReal tangent_error; /* estimated, of A over its size; 0: solved */
  PetscReal field[LAM_POINT_FIELD_COUNT];
  PetscInt percolating; /* percolating_directions */
} LamMaterialPoint;

/* Additional response data for sealed lumens, for the same load. */
typedef struct {
  PetscReal P_turgor[LAM_MACRO_STRAINS]; /* [strains] dP/dp */
  PetscReal lumen;                       /* -dPsi/dp */
  PetscReal curvature;                   /* d2Psi/dp2 */
} LamSealedPoint;

/* Sealed lumens; allocated if the scene has them. */
typedef struct {
  PetscBool closed; /* otherwise turgor is still prescribed: the body inflates */
  PetscInt modes;   /* 1 + dim */
  PetscReal *shape; /* [points][modes] shape functions of the pressure */
  PetscReal *water; /* [points] lumen -dPsi/dp at which the water has pressure p0 */
  PetscReal *change,
      *last_change; /* [elements][modes] coefficients of p - p0, in the last evaluation and the last converged state */
  Vec u;            /* displacement of the last evaluation */
  LamSealedPoint *now, *accepted; /* [points] */
} LamMacroSeal;

typedef struct LamMacroFlow_s LamMacroFlow; /* transport_impl.h */

/* The equations of an element's pressures. The columns of `coupling` belong to the element's displacements, the last
   one to R. */
typedef struct {
  PetscInt modes, dofs;
  PetscReal coupling[(LAM_MACRO_DOFS + 1) * LAM_MACRO_MODES]; /* [dofs + 1][modes] C, R */
  PetscReal solved[(LAM_MACRO_DOFS + 1) * LAM_MACRO_MODES];   /* K^-1 of it */
  PetscReal K[LAM_MACRO_MODES * LAM_MACRO_MODES];             /* its factors */
  int pivots[LAM_MACRO_MODES];
} LamCondensation;

/* A prescribed direction of a node; stored on the rank that owns the node, sorted by `local`. */
typedef struct {
  PetscInt point;                  /* of the mesh */
  PetscInt local;                  /* the node's first index in this rank's part of a global vector */
  PetscReal normal[LAM_MACRO_DIM]; /* unit */
  PetscReal base;                  /* normal . u in the configuration from which the conditions are measured */
  PetscReal end;                   /* increment of base at factor 1 */
  PetscReal target;                /* present target of normal . u */
  PetscInt entry;  /* index of the scene's condition whose history gives the factor; -1: the target stays at the base */
  PetscInt border; /* index of the border whose unknown is added to the target; -1: none */
  unsigned int sides; /* bit s: prescribed by the step's s-th name; 0 if it only holds rigid motions */
  PetscInt row;       /* its node's LamNodeRows in the last residual */
} LamConstraint;

/* Progress of the load program: the last complete step. */
typedef struct {
  PetscBool begun; /* a step is complete */
  PetscInt number;
  PetscReal load; /* fraction of the prescribed displacements; the turgor acts fully */
} LamMacroProgress;

/* A rigid obstacle: g(x) = n . x - height of a plate, distance from the core - radius of the edge of an indenter
   (obstacle.c); g >= 0 outside. */
typedef struct {
  PetscInt entry;               /* of the scene's conditions */
  PetscInt side;                /* the step's name */
  PetscReal normal[2], start;   /* plate: normal into the body, and height at first contact */
  PetscReal first[2], place[2]; /* indenter: centre at first contact, and now; plate: place[0] is its present height */
  PetscReal moved[2], accepted[2]; /* its displacement, now and in the last converged state */
} LamObstacle;

/* A node that may touch obstacles; stored on the rank that owns it. */
typedef struct {
  PetscInt local, point;
  unsigned int obstacles;       /* bit o */
  PetscInt constraint;          /* its prescribed direction; -1: none */
  PetscBool active;             /* in contact in the last residual */
  PetscBool accepted;           /* in contact in the last converged state */
  PetscInt slip, accepted_slip; /* sign of the force of friction where it slips, likewise; 0: it does not */
} LamObstacleNode;

/* The nearest obstacle of a node. */
typedef struct {
  PetscInt obstacle;
  PetscReal gap, normal[2], curvature; /* second derivative of the gap along its tangent */
  PetscReal friction;
  PetscReal slid[2]; /* motion along it since the last converged state; set with friction */
} LamTouch;

/*
  Modified equations of a node: r'_i = sum_j combine_ij r_j + value_i, where r is the unbalanced force. Their
  derivatives with respect to the node's own displacement have the additional term add_ij.
*/
typedef struct {
  PetscInt local;
  PetscReal combine[4], add[4], value[2];
} LamNodeRows;

/* The inflated body, from which displacements are measured, for certificates. */
typedef struct {
  LamMaterialPoint *points; /* [points]; NULL: not kept */
  PetscBool uniform;        /* they are all alike */
  PetscReal *dP;            /* [points][strains] stress of the reference less that of the run; NULL: not known */
  KSP solver;               /* of its transposed tangent with its rows */
  PetscInt row_count;
  LamNodeRows *rows;
} LamMacroInflated;

/* F of the points at some complete steps, for direct solves that follow the run; evenly spread over its steps, at least
   half of them in use. Chosen: of a block in contact that is sheared in five steps, two suffice and none do not
   (docs/results/performance.md). */
enum { LAM_MACRO_WAYPOINTS = 4 };
typedef struct {
  PetscInt count, stride; /* every stride-th step */
  PetscInt step[LAM_MACRO_WAYPOINTS];
  LamLoad *loads[LAM_MACRO_WAYPOINTS]; /* [points]; owned */
} LamMacroWaypoints;

/* The complete step of the largest force so far, but for the last one. */
typedef struct {
  PetscBool known;
  LamMacroStep step;
  Vec u;
  LamMaterialPoint *points;
} LamMacroPeak;

/* Derivatives of the reactions by the stress of the material points of this rank, times their volumes. */
typedef struct {
  PetscInt count; /* components that depend on it */
  PetscInt side[2 * LAM_MAX_BOUNDARIES], component[2 * LAM_MAX_BOUNDARIES];
  PetscReal *G;        /* [count][points][strains], at most 2 boundary_count */
  PetscReal *inflated; /* likewise of the inflated body; NULL: there is none */
} LamSensitivity;

/*
  An unknown q in addition to the displacements, with its own equation: the free component of a grip (the total force
  there is zero), or the factor of all tractions (a mean displacement is prescribed).
*/
typedef struct {
  PetscInt entry, component; /* of the scene's conditions; entry -1: the factor of the tractions */
  Vec weight;                /* grip: 1 at its nodes; control: weight of each node in the mean */
  Vec column, row, solved;   /* dr'/dq; derivative of the equation with respect to the displacements; K'^-1 column */
  PetscReal now, accepted;   /* q */
  PetscReal equation, base, target;
} LamMacroBorder;

struct LamMacro_s {
  MPI_Comm comm;
  const LamScene *scene;  /* borrowed */
  LamResponder responder; /* borrowed */
  LamResponder reference; /* borrowed; NULL: reactions are not corrected */
  LamCertify certify;     /* which reactions are */
  PetscBool branches;     /* tissue may have several stable states at the same F */
  PetscBool follows;      /* points that are solved are led along the path of the run */
  char uncertified[96];   /* why they cannot be; empty: they can */
  PetscInt64 seed;        /* of samples, beside the number of the step; 0 but in tests */
  LamMacroMonitor monitor;
  void *monitor_ctx;       /* borrowed */
  LamMacroCutback cutback; /* NULL: no callback */
  void *cutback_ctx;       /* borrowed */
  PetscBool (*stop)(void); /* NULL: never */
  PetscBool stopped;       /* a stop was requested; the same on all ranks */

  /* mesh */
  DM dm;
  PetscInt dim;
  PetscBool axisymmetric;
  PetscInt strains; /* components of F that vary: dim * dim, then F33 of an axisymmetric body */
  LamMacroKind kinds[LAM_MACRO_KINDS];
  PetscInt kind_count;
  PetscInt element_count; /* of this rank: the first mesh points */
  LamMacroElement *elements;
  PetscInt mesh_start, mesh_end; /* mesh points (cells, faces, edges, vertices) of this rank; most are nodes */
  PetscInt *node_number;         /* [mesh points] in the undistributed mesh; -1: no node */
  PetscInt part_count;           /* of the body, which share no node */
  PetscInt *part;                /* [mesh points] the part that it is in */
  PetscReal *position;           /* [mesh points][dim] reference position of the node */
  PetscInt node_count;
  LamMacroNode *nodes; /* owned by this rank, in the order of their mesh points */
  PetscReal *gradient; /* dN/dX, see LamMacroElement */
  PetscReal *hoop;     /* N/X1 of an axisymmetric body, likewise; else NULL */
  PetscInt set_count;  /* named boundaries */
  char set_name[LAM_MACRO_SETS][LAM_NAME_LENGTH];
  unsigned int *sets; /* [mesh points] bit k: on set k */
  PetscInt facet_count;
  LamMacroFacet *facets;
  PetscInt group_count; /* number of named regions */
  char group_name[LAM_MACRO_GROUPS][LAM_NAME_LENGTH];

  /* material points */
  PetscInt point_count;
  PetscInt *point_element; /* [points] element that contains the point */
  PetscReal *weight;       /* [points] area; of an axisymmetric body volume, of the whole circle */
  PetscReal *place;        /* [points][dim] reference position */
  PetscReal *turgor_share; /* [points] turgor of the tissue there, to be multiplied by `turgor` */
  PetscReal *cohesion;     /* [points] */
  PetscInt *point_index;   /* 0, 1, 2, ... for the responder */
  LamLoad *loads;
  LamResponse *responses;
  LamMaterialPoint *now, *accepted; /* at the last evaluation and at the last converged state */
  LamMacroSeal *seal;               /* NULL: turgor is prescribed */
  LamWaterLaw water_law;            /* of lumens that exchange water; NULL: their water is constant */
  void *water_ctx;                  /* borrowed */
  LamMacroFlow *flow;               /* NULL: water does not move through the body */

  /* unknowns */
  Vec u, trial, residual;    /* displacement: last converged, Newton iterate; residual of Newton */
  Vec origin;                /* displacement from which prescribed displacements are measured */
  Vec force, force_accepted; /* internal nodal forces at the last evaluation and at the last converged state */
  Mat tangent;
  SNES snes;
  Vec before;             /* displacement of the converged state before the last one */
  PetscReal passed;       /* load parameter increment from there to the last one; 0: unknown, or on another path */
  PetscReal prediction;   /* this increment divided by `passed`, until it is used; 0: no prediction */
  PetscBool extrapolates; /* predictions are enabled */
  PetscReal turgor;       /* present fraction of the turgor */
  PetscReal lamella;      /* present factor on the points' cohesion, ... */
  PetscReal walls;        /* ... and on the moduli of their walls */
  PetscBool relaxes;      /* walls have a memory, of accepted states */
  PetscReal time, accepted_time; /* s, of the present state and of the last accepted one */
  PetscReal duration;            /* of loads: between them; before LamMacroBalance for ever */
  PetscReal force_scale;         /* largest norm of the element forces in this series of Newton iterations */
  PetscReal force_floor;         /* lower bound of force_scale where `lenient` */
  PetscReal history[64];
  char trouble[LAM_MESSAGE_LENGTH - 64]; /* why the last evaluation failed; messages prefix how far it came */

  /* boundary */
  PetscReal parameter; /* present load parameter */
  PetscBool loaded;    /* PETSC_FALSE during inflation: the scene's conditions do not act yet */
  Vec external;        /* nodal forces of the tractions; with load control at factor 1 */
  PetscInt constraint_count;
  LamConstraint *constraints;
  PetscInt obstacle_count;
  LamObstacle obstacles[LAM_MAX_BOUNDARIES];
  PetscInt obstacle_node_count;
  LamObstacleNode *obstacle_nodes;
  PetscBool lenient;             /* responses with small jumps: a small residual may remain */
  PetscBool thorough;            /* at least one iteration, even if the first residual is small */
  PetscBool fresh;               /* no residual evaluated yet in this series of iterations */
  PetscInt pulled, released;     /* nodes: in contact though pulled, most of all; to leave at the next residual; -1 */
  PetscBool any_pulled;          /* on any rank */
  PetscBool any_regrip, regrips; /* nodes of a sealed body are to begin to slip or stick, on any rank; at the next
                                    residual they do */
  PetscReal violation; /* largest penetration or distance of nodes violating the contact conditions, last residual */
  PetscInt row_count;
  LamNodeRows *rows; /* of the last residual */
  PetscInt border_count;
  LamMacroBorder borders[2 * LAM_MAX_BOUNDARIES + 1];
  KSP solver; /* of the unbordered tangent; NULL if the scene needs no border */

  LamMacroProgress progress;
  LamMacroInflated inflated;
  LamMacroPeak peak;
  LamMacroWaypoints waypoints;
  struct {
    PetscInt64 solves, queries;
  } cost;                       /* of the steps so far, all ranks */
  LamMacroStep step;            /* report in progress */
  LamResponderCounters counted; /* counters at the start of the step */
};

/* The rank with the smallest value; among equal ones the lowest. Collective. */
static inline PetscErrorCode LamMacroFindRank(LamMacro macro, double value, PetscMPIInt *rank, PetscBool *mine)
{
  struct {
    double value;
    int rank;
  } own = {value, 0}, least;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(macro->comm, &own.rank));
  PetscCallMPI(MPI_Allreduce(&own, &least, 1, MPI_DOUBLE_INT, MPI_MINLOC, macro->comm));
  *rank = least.rank;
  *mine = (PetscBool)(own.rank == least.rank);
  PetscFunctionReturn(0);
}

/* mesh.c */
PetscErrorCode LamMacroMeshCreate(LamMacro macro);
PetscErrorCode LamMacroMeshDestroy(LamMacro macro);
/* Lists the nodes of this rank, once there are vectors. */
PetscErrorCode LamMacroListNodes(LamMacro macro);
/* PetscCheck of input that only the mesh shows to be wrong: the message begins with the place in the scene's file.
   `format` is a literal. */
#define LamMacroRequire(condition, macro, scene_place, format, ...)                                                    \
  do {                                                                                                                 \
    char at_[LAM_PLACE_TEXT];                                                                                          \
    PetscCheck(condition, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: " format,                                        \
               LamScenePlaceText((macro)->scene, scene_place, at_), __VA_ARGS__);                                      \
  } while (0)
/* The named set; -1: none. */
PetscInt LamMacroFindSet(LamMacro macro, const char name[]);

/* element.c */
/* The kind of a polytope, created at its first use. Error PETSC_ERR_SUP if there is none. */
PetscErrorCode LamMacroKindGet(LamMacro macro, DMPolytopeType polytope, const LamMacroKind **kind);
/* Whether a mesh point of this type has a node of the elements. */
PetscBool LamMacroHasNode(LamMacro macro, DMPolytopeType type);

/* facet.c */
/*
  Nodes of a facet of a plane body, in the order of DMPlex closures: middle, ends; X [3][2] reference positions.
  *sense is 1 if the facet runs counter-clockwise around the body from its second node to its third, else -1.
*/
PetscErrorCode LamMacroFacetNodes(LamMacro macro, const LamMacroFacet *facet, PetscReal X[6], PetscReal *sense);
enum { LAM_FACET_POINTS = 3 };
/* Shape functions N [3] and their derivatives dN [3] at Gauss point q of a facet, xi = -1..1, and its weight. */
void LamMacroFacetShape(PetscInt q, PetscReal N[3], PetscReal dN[3], PetscReal *weight);
/* 2 pi times the radius of a point of a facet at positions x [3][2], of an axisymmetric body; else 1. */
PetscReal LamMacroAround(LamMacro macro, const PetscReal N[3], const PetscReal x[6]);
/* Outward unit normal of a condition's side; PETSC_ERR_USER_INPUT if it is not straight. */
PetscErrorCode LamMacroStraightNormal(LamMacro macro, const LamBoundary *boundary, PetscReal normal[2]);
/* Whether the outward normal of some part of a side points against a direction. Collective. */
PetscErrorCode LamMacroFaces(LamMacro macro, const char on[], const PetscReal direction[2], PetscBool *faces);

/* boundary.c */
/* Checks that each condition names a boundary of the mesh (else PETSC_ERR_USER_INPUT). */
PetscErrorCode LamMacroBoundaryCheck(LamMacro macro);
/* Whether a mesh point lies on the boundary that a condition names. */
PetscBool LamMacroIsOn(LamMacro macro, PetscInt p, const char on[]);
/* Sets the names of the step's sides, each once. */
PetscErrorCode LamMacroBoundaryNames(const LamMacroSpec *spec, LamMacroStep *step);
/* Prescribes sides of symmetry, the axis, and the minimum of components that prevents the remaining rigid motions. */
PetscErrorCode LamMacroHoldRigidMotions(LamMacro macro);
/*
  Prescribes the scene's displacements, measured from the present ones, and places the obstacles at first contact.
  PETSC_ERR_USER_INPUT if conditions contradict each other or leave a rigid motion free.
*/
PetscErrorCode LamMacroHoldBoundaries(LamMacro macro);
/* Sets targets, tractions and obstacles for a load parameter. */
PetscErrorCode LamMacroSetLoadFactor(LamMacro macro, PetscReal load_factor);

/* traction.c */
/* Nodal forces of the tractions at displacement u and macro->parameter; with load control at factor 1. */
PetscErrorCode LamMacroExternalForce(LamMacro macro, Vec u, Vec external);
/* Factor of all tractions in addition to their histories: the unknown of load control, else 1; 0 during inflation. */
PetscReal LamMacroTractionFactor(LamMacro macro);
/* Adds minus the derivative of the nodal forces of the tractions at displacement u. */
PetscErrorCode LamMacroAddTractionTangent(LamMacro macro, Vec u, Mat tangent);
/* Total force of one condition's tractions at displacement u, all ranks. */
PetscErrorCode LamMacroTractionSum(LamMacro macro, PetscInt entry, Vec u, PetscReal sum[2]);

/* obstacle.c */
static inline PetscBool LamMacroIsObstacle(const LamBoundary *boundary)
{
  return (PetscBool)(boundary->kind == LAM_BOUNDARY_PLATE || boundary->kind == LAM_BOUNDARY_INDENTER);
}
/* Places the obstacles at first contact with the present body. */
PetscErrorCode LamMacroObstaclesCreate(LamMacro macro);
void LamMacroObstaclesMove(LamMacro macro);
/* Slip counts from where they are. */
void LamMacroObstaclesAccept(LamMacro macro);
void LamMacroObstaclesDescribe(LamMacro macro, LamMacroStep *step);
/* before: displacement of the last converged state, from which slip counts; NULL: of the converged state itself. */
LamTouch LamMacroNearest(LamMacro macro, const LamObstacleNode *node, const PetscScalar u[],
                         const PetscScalar before[]);

/* rows.c */
/* Converts the unbalanced force at displacement u into the residual. The rows are kept for the tangent at the same
   state. */
PetscErrorCode LamMacroConstrainResidual(LamMacro macro, Vec u, Vec residual);
PetscErrorCode LamMacroConstrainTangent(LamMacro macro, Mat tangent);
/* The same rows of the derivative of the unbalanced force by other unknowns. */
PetscErrorCode LamMacroConstrainColumns(LamMacro macro, Mat columns);
/* Applies only the linear part of the rows, for a derivative of the unbalanced force. */
PetscErrorCode LamMacroCombineRows(LamMacro macro, Vec force);

/* border.c */
/* Creates the borders of the scene's free grips and load control; none if `scene` is PETSC_FALSE. */
PetscErrorCode LamMacroBordersCreate(LamMacro macro, PetscBool scene);
PetscErrorCode LamMacroBordersDestroy(LamMacro macro);
/* The border of a grip's component; -1: none. */
PetscInt LamMacroFindBorder(LamMacro macro, PetscInt entry, PetscInt component);
/* Sets the weights and the base of the equations; call after the constraints are set. */
PetscErrorCode LamMacroBordersStart(LamMacro macro);
/* Residuals of the borders' equations from the unbalanced force. */
PetscErrorCode LamMacroBorderEquations(LamMacro macro, Vec u, Vec unbalanced);
/* Rows and columns of the bordered tangent at the last residual, from the tangent before its rows are modified. */
PetscErrorCode LamMacroBorderDerivatives(LamMacro macro, Mat tangent);
/* Makes Newton's linear solver that of the bordered system, if the scene needs it. */
PetscErrorCode LamMacroBorderSolver(LamMacro macro, KSP ksp);

/* reaction.c */
/* Adds the work of the boundary forces between the last converged state and `trial` (trapezoidal rule). */
PetscErrorCode LamMacroAddWork(LamMacro macro);
/* Displacements prescribed at the sides at the step's load factor. */
void LamMacroDisplacements(LamMacro macro, LamMacroStep *step);
/* Forces on the body at the named sides, in the last converged state at the present parameter. */
PetscErrorCode LamMacroReactions(LamMacro macro, LamMacroStep *step);

/* Index of the first constraint of the node behind that of constraint k. */
PetscInt LamMacroNextHeld(LamMacro macro, PetscInt k);
/* Add the force on one node to the reactions [sides][2]: of a node whose first constraint is k; of one at an obstacle.
 */
void LamMacroShareHeld(LamMacro macro, PetscInt k, const PetscReal force[2], PetscReal reaction[][2]);
void LamMacroShareTouched(LamMacro macro, const LamObstacleNode *node, const LamTouch *touch, const PetscReal force[2],
                          PetscReal reaction[][2]);

/* certify.c */
/* Corrects reactions of the last converged state, and at the end of a run that of the peak, by the reference. */
PetscErrorCode LamMacroCertify(LamMacro macro, LamMacroStep *step);
PetscErrorCode LamMacroPeakCreate(LamMacro macro); /* allocates it, unless that is done */
PetscErrorCode LamMacroPeakDestroy(LamMacro macro);
void LamMacroUncertified(LamMacroCertificate *certificate, const char why[]);

/* correction.c */
/* Corrects the reactions of the present state with about `wanted` of its points. */
PetscErrorCode LamMacroCorrect(LamMacro macro, PetscInt wanted, PetscInt64 seed, LamMacroCertificate *certificate);
/* Finds dP of the inflated body, unless it is known or can only be sampled. */
PetscErrorCode LamMacroSolveInflated(LamMacro macro, LamMacroCertificate *certificate);

/* waypoints.c */
PetscErrorCode LamMacroAddWaypoint(LamMacro macro, PetscInt step); /* the present state, a complete step */
PetscErrorCode LamMacroWaypointsDestroy(LamMacro macro);
PetscInt LamMacroCountWaypoints(LamMacro macro, PetscInt step); /* those before a step */
/* Leads a point to a load at a step; inflated: its response in the inflated body, NULL: not wanted. */
PetscErrorCode LamMacroLead(LamMacro macro, PetscInt p, PetscInt step, const LamLoad *load, LamResponse *inflated,
                            LamResponse *response);

/* sensitivity.c */
/* Keeps the present state as the inflated body, held against rigid motions. */
PetscErrorCode LamMacroKeepInflated(LamMacro macro);
PetscErrorCode LamMacroInflatedDestroy(LamMacro macro);
/* At the present state (now, u, load factor). *ok: the tangent is not singular. */
PetscErrorCode LamMacroSensitivityCreate(LamMacro macro, LamSensitivity *s, PetscBool *ok);
PetscErrorCode LamMacroSensitivityDestroy(LamSensitivity *s);

/* assembly.c */
/* Row-major entry of F of component k = 0..strains-1. */
static inline PetscInt LamMacroEntry(LamMacro macro, PetscInt k)
{
  return k < macro->dim * macro->dim ? 3 * (k / macro->dim) + k % macro->dim : 8;
}
/* N/X1 [nodes] at Gauss point q of an element of an axisymmetric body, dF33/du1; else NULL. */
static inline const PetscReal *LamMacroHoop(LamMacro macro, const LamMacroElement *element, PetscInt q)
{
  return macro->axisymmetric ? &macro->hoop[element->gradient / macro->dim + q * element->kind->nodes] : NULL;
}
/* dN/dX [nodes][dim] at Gauss point q of an element. */
static inline const PetscReal *LamMacroGradient(LamMacro macro, const LamMacroElement *element, PetscInt q)
{
  return &macro->gradient[element->gradient + q * element->kind->nodes * macro->dim];
}
/*
  Evaluates the responses of all points at displacement u. *ok is PETSC_FALSE on all ranks if one is missing
  (`trouble` says which) or a stop was requested (`stopped`). The responder is not queried if deformation and turgor
  are those of the last evaluation.
*/
PetscErrorCode LamMacroEvaluate(LamMacro macro, Vec u, PetscBool *ok);
/* Internal nodal forces of the evaluated state; *scale: norm of the element forces before summation at the nodes. */
PetscErrorCode LamMacroAssembleForce(LamMacro macro, Vec force, PetscReal *scale);
/* The same norm for a body whose stress is that of a strain of 1 % times the identity everywhere. */
PetscErrorCode LamMacroForceFloor(LamMacro macro, PetscReal *scale);
PetscErrorCode LamMacroAssembleTangent(LamMacro macro, Mat tangent);

/* sealed.c: these functions do nothing if turgor is prescribed (macro->seal is NULL) */
/* Whether pressures are unknowns. */
PetscBool LamMacroHasPressures(LamMacro macro);
PetscErrorCode LamMacroSealCreate(LamMacro macro);
PetscErrorCode LamMacroSealDestroy(LamMacro macro);
/*
  Seals the lumens with the water of the last converged state. Without inflation it is that of F = 1 under the full
  turgor, which then becomes the last converged state. *ok is PETSC_FALSE if a point has no response there (`trouble`
  says which).
*/
PetscErrorCode LamMacroSealLumens(LamMacro macro, PetscBool *ok);
/* Update the pressures by their linearised equation for the displacement from the last evaluation to u; LamMacroFollow
   only if u has changed. */
PetscErrorCode LamMacroFollow(LamMacro macro, Vec u);
PetscErrorCode LamMacroMovePressures(LamMacro macro, Vec u);
/* Turgor of a point minus that at which it was sealed. */
PetscReal LamMacroTurgorChange(LamMacro macro, const LamMacroElement *element, PetscInt point);
/* Stores the part of a point's response that pressures need. A response without it gets status LAM_OUT_OF_REACH. */
PetscErrorCode LamMacroKeepSealed(LamMacro macro, PetscInt point);
/* Condenses the pressures out of an element's forces fe and tangent Ke (NULL: not needed), at the last evaluation. */
PetscErrorCode LamMacroCondense(LamMacro macro, const LamMacroElement *element, PetscScalar fe[], PetscScalar Ke[]);
/* The equations of an element's pressures at the last evaluation; and K^-1 of further columns x [columns][modes]. */
PetscErrorCode LamMacroCondensationCreate(LamMacro macro, const LamMacroElement *element, LamCondensation *c);
PetscErrorCode LamMacroCondensationSolve(LamCondensation *c, PetscInt columns, PetscReal x[]);
/* Water of a point at its present turgor and potentials. */
void LamMacroFindWater(LamMacro macro, PetscInt point, LamWater *water);
/* Derivative with respect to turgor of the lumen prescribed by the water law at a point, in the last converged state.
 */
PetscReal LamMacroWaterSlope(LamMacro macro, PetscInt point);
/* Norm of the residual of the pressures' equations at the last evaluation, relative to the water; 0 if nothing is
   sealed. */
PetscErrorCode LamMacroSealedResidual(LamMacro macro, PetscReal *residual);
PetscErrorCode LamMacroAcceptPressures(LamMacro macro);
PetscErrorCode LamMacroRejectPressures(LamMacro macro);
/* Archives the last converged state, which must be the present one; points [points]: their numbers in the undistributed
   mesh. */
PetscErrorCode LamMacroArchiveSeal(LamMacro macro, LamArchive archive, const PetscInt points[]);

/* checkpoint.c */
/* Nodal values of a vector, [node][dim]. */
PetscErrorCode LamMacroArchiveVec(LamMacro macro, LamArchive archive, const char name[], Vec vec);

/* fields.c */
/* localisation.c: ellipticity at the last converged state, for the step's report; sets LAM_POINT_ELLIPTICITY of its
   points. Collective. */
PetscErrorCode LamMacroFindLocalisation(LamMacro macro, LamMacroStep *step);
void LamMacroKeepFields(const LamResponse *response, PetscReal field[LAM_POINT_FIELD_COUNT]);

/* inflation.c */
/* Sets u to the homogeneous inflated state of the tissue at the present turgor, if one is found. */
PetscErrorCode LamMacroGuessInflated(LamMacro macro, Vec u, PetscBool *found);

/* stepping.c */
PetscErrorCode LamMacroNewtonCreate(LamMacro macro);
/* Starts the report of a step; work accumulates over the steps. */
PetscErrorCode LamMacroStartStep(LamMacro macro, PetscReal *start);
/* Completes the report of a converged step. */
PetscErrorCode LamMacroFinishStep(LamMacro macro, PetscInt number, PetscReal load_factor, PetscReal start);
/* Applies the turgor (with `inflate`: to the unloaded body) and seals lumens. If not *converged, `trouble` says why.
   The load program then starts from macro->origin, once boundaries are prescribed. */
PetscErrorCode LamMacroBringUpTurgor(LamMacro macro, PetscReal *reached, PetscBool *converged);
/* Newton's method from macro->trial at the present loads; if it fails, `trouble` says why. */
PetscErrorCode LamMacroIterate(LamMacro macro, PetscBool *converged);

#endif
