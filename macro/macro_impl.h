/*
  Private parts of the macroscale solver.

  mesh.c      distribution, numbering, named sets, geometry of elements
  mesh_disc.c, mesh_gmsh.c   where meshes come from
  element.c   kinds of elements: shape functions, Gauss points
  facet.c     geometry of the boundary's pieces
  boundary.c  prescribed displacements, and which of them there are
  traction.c  dead and follower tractions
  obstacle.c  rigid plates and indenters
  rows.c      equations of nodes whose displacement is prescribed or that touch an obstacle
  border.c    unknowns that are no displacement of a node: of grips, and the factor of the tractions
  reaction.c  reactions and work
  assembly.c  gather F, ask the responder, assemble force and tangent
  sealed.c    pressures of sealed lumens
  inflation.c first guess of the inflated body
  stepping.c  Newton, load steps, cutback
  instant.c   equilibrium at an instant, for whoever follows the body in time
  localisation.c    ellipticity at the material points
  fields.c    what is kept of a response for the results, gathering of fields on rank 0
  checkpoint.c what a run goes on from

  The dimension `dim` of the body is that of its mesh; nothing but the responder knows that it is 2 (plane strain).
*/
#ifndef LAM_MACRO_IMPL_H
#define LAM_MACRO_IMPL_H

#include <petscdmplex.h>
#include <petscsf.h>
#include <petscsnes.h>
#include <lamella/macro.h>

enum {
  LAM_MACRO_DIM = 3, /* most of all that follows */
  LAM_MACRO_NODES = 27,
  LAM_MACRO_DOFS = LAM_MACRO_DIM * LAM_MACRO_NODES,
  LAM_MACRO_MODES = LAM_MACRO_DIM + 1, /* of an element's pressure */
  LAM_MACRO_KINDS = 2,
  LAM_MACRO_SETS = 32, /* named boundaries; a bit each */
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
  PetscInt number;   /* in the undistributed mesh, the same for any count of ranks */
  PetscInt first;    /* of its material points, which follow each other */
  PetscInt gradient; /* where its dN/dX begin in LamMacro.gradient: [points][nodes][dim] */
  PetscInt group;    /* the named region it belongs to; -1: none */
} LamMacroElement;

/* A piece of the body's boundary on this rank that belongs to a named set. */
typedef struct {
  PetscInt point;    /* of the mesh */
  PetscInt element;  /* inside */
  unsigned int sets; /* bit k: set k */
} LamMacroFacet;

/* What the solver keeps of a material point's response. */
typedef struct {
  PetscBool known; /* the rest belongs to `load` and `walls` */
  LamLoad load;
  PetscReal walls; /* moduli over those of the tissue that was asked; NaN: it may answer otherwise now */
  PetscReal P[9];
  PetscReal A[81]; /* [dim][dim][dim][dim] dP_ij/dF_kl */
  PetscReal field[LAM_POINT_FIELD_COUNT];
  PetscInt percolating; /* percolating_directions */
} LamMaterialPoint;

/* What lumens that are sealed need besides of it; it belongs to the same load. */
typedef struct {
  PetscReal P_turgor[LAM_MACRO_DIM * LAM_MACRO_DIM]; /* [dim][dim] dP/dp */
  PetscReal lumen;                                   /* -dPsi/dp */
  PetscReal curvature;                               /* d2Psi/dp2 */
} LamSealedPoint;

/* Lumens that keep their water; there where the scene has them. */
typedef struct {
  PetscBool closed; /* else the turgor is still prescribed: the body inflates */
  PetscInt modes;   /* 1 + dim */
  PetscReal *shape; /* [points][modes] of the pressure */
  PetscReal *water; /* [points] the lumen, -dPsi/dp, in which the water has the pressure p0 */
  PetscReal *change,
      *last_change;               /* [elements][modes] of p - p0, in the last evaluation and the last converged state */
  Vec u;                          /* displacement of the last evaluation */
  LamSealedPoint *now, *accepted; /* [points] */
} LamMacroSeal;

/* A direction in which a node's displacement is prescribed; kept by the rank that owns the node, sorted by `local`. */
typedef struct {
  PetscInt point;                  /* of the mesh */
  PetscInt local;                  /* the node's first index in this rank's part of a global vector */
  PetscReal normal[LAM_MACRO_DIM]; /* unit */
  PetscReal base;                  /* normal . u where the conditions count from */
  PetscReal end;                   /* what is added to it at factor 1 */
  PetscReal target;                /* normal . u wanted now */
  PetscInt entry;     /* of the scene's conditions, whose history the factor is; -1: the target stays at the base */
  PetscInt border;    /* whose unknown is added to the target; -1: none */
  unsigned int sides; /* bit s: the s-th name of the step's prescribes it; 0 where only rigid motions are held */
} LamConstraint;

/* How far the load program has come: the last complete step. */
typedef struct {
  PetscBool begun; /* a step is complete */
  PetscInt number;
  PetscReal load; /* share of the prescribed displacements; the turgor acts in full */
} LamMacroProgress;

/* A rigid obstacle: g(x) = n . x - height of a plate, |x - centre| - radius of an indenter; g >= 0 outside. */
typedef struct {
  PetscInt entry;               /* of the scene's conditions */
  PetscInt side;                /* the step's name */
  PetscReal normal[2], start;   /* of a plate: from it into the body; height where it first touches */
  PetscReal first[2], place[2]; /* centre of an indenter where it first touches, and now; of a plate place[0] is its
                                   height now */
} LamObstacle;

/* A node that may touch obstacles; kept by the rank that owns it. */
typedef struct {
  PetscInt local, point;
  unsigned int obstacles; /* bit o */
  PetscInt constraint;    /* its prescribed direction; -1: none */
  PetscBool active;       /* touched in the last residual */
  PetscBool accepted;     /* touched in the last converged state */
} LamObstacleNode;

/* The nearest obstacle of a node. */
typedef struct {
  PetscInt obstacle;
  PetscReal gap, normal[2], curvature; /* second derivative of the gap along its tangent */
} LamTouch;

/*
  New equations of a node: r'_i = sum_j combine_ij r_j + value_i, where r is the unbalanced force; their derivatives
  with respect to its own displacement have the further part add_ij.
*/
typedef struct {
  PetscInt local;
  PetscReal combine[4], add[4], value[2];
} LamNodeRows;

/*
  An unknown q beside the displacements, with an equation of its own: the free component of a grip (the total force
  there is zero), or the factor of all tractions (a mean displacement is prescribed).
*/
typedef struct {
  PetscInt entry, component; /* of the scene's conditions; entry -1: the factor of the tractions */
  Vec weight;                /* grip: 1 at its nodes; control: share of each node in the mean */
  Vec column, row, solved;   /* dr'/dq; derivative of the equation by the displacements; K'^-1 column */
  PetscReal now, accepted;   /* q */
  PetscReal equation, base, target;
} LamMacroBorder;

struct LamMacro_s {
  MPI_Comm comm;
  const LamScene *scene;   /* borrowed */
  LamResponder *responder; /* borrowed */
  LamMacroMonitor monitor;
  void *monitor_ctx;       /* borrowed */
  LamMacroCutback cutback; /* NULL: nobody listens */
  void *cutback_ctx;       /* borrowed */
  PetscBool (*stop)(void); /* NULL: never */
  PetscBool stopped;       /* it was asked for; the same on all ranks */

  /* mesh */
  DM dm;
  PetscInt dim;
  LamMacroKind kinds[LAM_MACRO_KINDS];
  PetscInt kind_count;
  PetscInt element_count; /* of this rank: the first mesh points */
  LamMacroElement *elements;
  PetscInt mesh_start, mesh_end; /* mesh points (cells, faces, edges, vertices) of this rank; most are nodes */
  PetscInt *node_number;         /* [mesh points] in the undistributed mesh; -1: no node */
  PetscReal *position;           /* [mesh points][dim] reference position of the node */
  PetscReal *gradient;           /* dN/dX, see LamMacroElement */
  PetscInt set_count;            /* named boundaries */
  char set_name[LAM_MACRO_SETS][LAM_NAME_LENGTH];
  unsigned int *sets; /* [mesh points] bit k: on set k */
  PetscInt facet_count;
  LamMacroFacet *facets;
  PetscInt group_count; /* named regions */
  char group_name[LAM_MACRO_GROUPS][LAM_NAME_LENGTH];

  /* material points */
  PetscInt point_count;
  PetscInt *point_element; /* [points] the element it is in */
  PetscReal *weight;       /* [points] area */
  PetscReal *place;        /* [points][dim] reference position */
  PetscReal *turgor_share; /* [points] turgor of the tissue there, which the program's share multiplies */
  PetscReal *cohesion;     /* [points] */
  PetscInt *point_index;   /* 0, 1, 2, ... for the responder */
  LamLoad *loads;
  LamResponse *responses;
  LamMaterialPoint *now, *accepted; /* of the last evaluation and of the last converged state */
  LamMacroSeal *seal;               /* NULL: turgor is prescribed */
  LamWaterLaw water_law;            /* of lumens that exchange water; NULL: they keep it */
  void *water_ctx;                  /* borrowed */

  /* unknowns */
  Vec u, trial, residual;    /* displacement: last converged, Newton iterate; residual of Newton */
  Vec origin;                /* the displacement that prescribed ones count from */
  Vec force, force_accepted; /* internal nodal forces of the last evaluation and of the last converged state */
  Mat tangent;
  SNES snes;
  Vec before;             /* displacement of the converged state before the last one */
  PetscReal passed;       /* load parameters from there to the last one; 0: not known, or on another path */
  PetscReal prediction;   /* increment of this series of iterations over `passed`, until it is used; 0: none */
  PetscBool extrapolates; /* predictions are made */
  PetscReal turgor;       /* share of the turgor that acts now */
  PetscReal lamella;      /* what the points' cohesion is multiplied by now, ... */
  PetscReal walls;        /* ... and the moduli of their walls */
  PetscReal force_scale;  /* largest norm of the element forces in this series of Newton iterations */
  PetscReal force_floor;  /* what counts at least as that where `lenient` */
  PetscReal history[64];
  char trouble[LAM_MESSAGE_LENGTH - 64]; /* why the last evaluation failed; how far it came is said before it */

  /* boundary */
  PetscReal parameter; /* load parameter that acts now */
  PetscBool loaded;    /* PETSC_FALSE while the body inflates: the scene's conditions do not act yet */
  Vec external;        /* nodal forces of the tractions; with load control at factor 1 */
  PetscInt constraint_count;
  LamConstraint *constraints;
  PetscInt obstacle_count;
  LamObstacle obstacles[LAM_MAX_BOUNDARIES];
  PetscInt obstacle_node_count;
  LamObstacleNode *obstacle_nodes;
  PetscBool lenient;   /* answers that jump a little may keep a residual that is next to none */
  PetscBool thorough;  /* at least one iteration, however small the first residual */
  PetscBool fresh;     /* no residual yet in this series of iterations */
  PetscReal violation; /* largest penetration or distance of nodes that are not as they should be, last residual */
  PetscInt row_count;
  LamNodeRows *rows; /* of the last residual */
  PetscInt border_count;
  LamMacroBorder borders[2 * LAM_MAX_BOUNDARIES + 1];
  KSP solver; /* of the unbordered tangent; NULL where the scene needs no border */

  LamMacroProgress progress;
  LamMacroStep step;    /* being filled */
  LamResponder counted; /* counters at the start of the step */
};

/* mesh.c */
PetscErrorCode LamMacroMeshCreate(LamMacro macro);
PetscErrorCode LamMacroMeshDestroy(LamMacro macro);
/* A node's first index in this rank's part of a global vector; -1: no node, or another rank owns it. */
PetscErrorCode LamMacroOwnedIndex(LamMacro macro, PetscInt point, PetscInt *local);
/* The named set; -1: none. */
PetscInt LamMacroFindSet(LamMacro macro, const char name[]);

/* mesh_disc.c: a disc of radius 1 or a part of it about the origin, and the names of a facet's sides by its nodes. */
PetscErrorCode LamMacroDiscCreate(MPI_Comm comm, LamDiscPart part, const PetscInt elements[2], DM *dm);
/* mesh_gmsh.c */
PetscErrorCode LamMacroGmshCreate(MPI_Comm comm, const char path[], DM *dm);
/* Whether PETSc may read the file, which it does without looking; `why` says why not. */
#define LAM_GMSH_WHY 200
PetscBool LamGmshCheck(const char path[], char why[LAM_GMSH_WHY]);

/* element.c */
/* The kind for a polytope, made where it is not there yet. PETSC_ERR_SUP where there is none. */
PetscErrorCode LamMacroKindGet(LamMacro macro, DMPolytopeType polytope, const LamMacroKind **kind);
PetscErrorCode LamMacroKindsDestroy(LamMacro macro);
/* Whether a mesh point of this type carries a node of the elements. */
PetscBool LamMacroHasNode(LamMacro macro, DMPolytopeType type);

/* facet.c */
/*
  Nodes of a facet of a plane body, in the order of DMPlex closures: middle, ends; X [3][2] reference positions. *sense
  is 1 where the facet runs counter-clockwise around the body from its second node to its third, else -1.
*/
PetscErrorCode LamMacroFacetNodes(LamMacro macro, const LamMacroFacet *facet, PetscReal X[6], PetscReal *sense);
enum { LAM_FACET_POINTS = 3 };
/* Shape functions N [3] and their derivatives dN [3] at Gauss point q of a facet, xi = -1..1, and its weight. */
void LamMacroFacetShape(PetscInt q, PetscReal N[3], PetscReal dN[3], PetscReal *weight);
/* Outward unit normal of a named set whose facets lie on one straight line; *straight says whether they do. */
PetscErrorCode LamMacroStraightNormal(LamMacro macro, PetscInt set, PetscReal normal[2], PetscBool *straight);

/* boundary.c */
/* Refuses conditions that stand for no boundary of the mesh (PETSC_ERR_USER_INPUT). */
PetscErrorCode LamMacroBoundaryCheck(LamMacro macro);
/* Whether a mesh point lies on the boundary that a condition names. */
PetscBool LamMacroIsOn(LamMacro macro, PetscInt p, const char on[]);
/* Fills the names of the step's sides: each once. */
PetscErrorCode LamMacroBoundaryNames(const LamMacroSpec *spec, LamMacroStep *step);
/* The number among these of a condition. */
PetscInt LamMacroSideNumber(const LamMacroStep *step, const LamBoundary *boundary);
/* Holds sides of symmetry, and as few components as prevent the rigid motions that they leave. */
PetscErrorCode LamMacroHoldRigidMotions(LamMacro macro);
/*
  Prescribes the scene's displacements, counted from the present ones, and brings the obstacles into touch.
  PETSC_ERR_USER_INPUT where conditions contradict each other or leave a rigid motion free.
*/
PetscErrorCode LamMacroHoldBoundaries(LamMacro macro);
/* Targets, tractions and obstacles at a load parameter. */
PetscErrorCode LamMacroSetLoadFactor(LamMacro macro, PetscReal load_factor);

/* traction.c */
/* Nodal forces of the tractions at displacement u, as they act at macro->parameter; with load control at factor 1. */
PetscErrorCode LamMacroExternalForce(LamMacro macro, Vec u, Vec external);
/* Factor of all tractions beside their histories: the unknown of load control, else 1; 0 during inflation. */
PetscReal LamMacroTractionFactor(LamMacro macro);
/* Adds minus the derivative of the nodal forces. */
PetscErrorCode LamMacroAddTractionTangent(LamMacro macro, Mat tangent);
/* Total force of one condition's tractions at displacement u, all ranks. */
PetscErrorCode LamMacroTractionSum(LamMacro macro, PetscInt entry, Vec u, PetscReal sum[2]);

/* obstacle.c */
/* Obstacles where they first touch the present body. */
PetscErrorCode LamMacroObstaclesCreate(LamMacro macro);
void LamMacroObstaclesMove(LamMacro macro);
LamTouch LamMacroNearest(LamMacro macro, const LamObstacleNode *node, const PetscScalar u[]);

/* rows.c */
/* Turns the unbalanced force at displacement u into the residual; the rows stay for the tangent of the same state. */
PetscErrorCode LamMacroConstrainResidual(LamMacro macro, Vec u, Vec residual);
PetscErrorCode LamMacroConstrainTangent(LamMacro macro, Mat tangent);
/* The linear part of the change alone, for a derivative of the unbalanced force. */
PetscErrorCode LamMacroCombineRows(LamMacro macro, Vec force);

/* border.c */
/* Borders of the scene's free grips and load control; without `scene` none. */
PetscErrorCode LamMacroBordersCreate(LamMacro macro, PetscBool scene);
PetscErrorCode LamMacroBordersDestroy(LamMacro macro);
/* The border of a grip's component; -1: none. */
PetscInt LamMacroFindBorder(LamMacro macro, PetscInt entry, PetscInt component);
/* Fills weights, and where the equations count from; after the constraints. */
PetscErrorCode LamMacroBordersStart(LamMacro macro);
/* Residuals of the borders' equations, from the unbalanced force; then, after the rows, the columns. */
PetscErrorCode LamMacroBorderEquations(LamMacro macro, Vec u, Vec unbalanced);
PetscErrorCode LamMacroBorderColumns(LamMacro macro);
/* Derivatives of the equations, from the tangent before its rows change. */
PetscErrorCode LamMacroBorderRows(LamMacro macro, Mat tangent);
/* Makes Newton's linear solver one of the bordered system, where the scene needs it. */
PetscErrorCode LamMacroBorderSolver(LamMacro macro, KSP ksp);

/* reaction.c */
/* Adds the work of the boundary forces between the last converged state and `trial` (trapezoidal rule). */
PetscErrorCode LamMacroAddWork(LamMacro macro);
/* What the sides prescribe at the step's load factor. */
void LamMacroDisplacements(LamMacro macro, LamMacroStep *step);
/* Forces on the body at the named sides, in the last converged state at the parameter that is set. */
PetscErrorCode LamMacroReactions(LamMacro macro, LamMacroStep *step);

/* assembly.c */
/* dN/dX [nodes][dim] at Gauss point q of an element. */
static inline const PetscReal *LamMacroGradient(LamMacro macro, const LamMacroElement *element, PetscInt q)
{
  return &macro->gradient[element->gradient + q * element->kind->nodes * macro->dim];
}
/*
  Responses of all points at displacement u. *ok is PETSC_FALSE on all ranks where one is missing (`trouble` says which)
  or a stop was asked for (`stopped`).
  Nothing is asked where deformation and turgor are those of the last evaluation.
*/
PetscErrorCode LamMacroEvaluate(LamMacro macro, Vec u, PetscBool *ok);
/* Internal nodal forces of the evaluated state; *scale is the norm of the element forces, before they cancel. */
PetscErrorCode LamMacroAssembleForce(LamMacro macro, Vec force, PetscReal *scale);
/* The same norm of a body whose stress is LAM_STRESS_FLOOR everywhere, in all directions alike. */
PetscErrorCode LamMacroForceFloor(LamMacro macro, PetscReal *scale);
PetscErrorCode LamMacroAssembleTangent(LamMacro macro, Mat tangent);

/* sealed.c: does nothing, and takes no time, where turgor is prescribed (macro->seal is NULL) */
/* Whether pressures are unknowns of the body. */
PetscBool LamMacroHasPressures(LamMacro macro);
PetscErrorCode LamMacroSealCreate(LamMacro macro);
PetscErrorCode LamMacroSealDestroy(LamMacro macro);
/*
  Seals the lumens: their water is that of the last converged state, or where the body is not to inflate that of F = 1
  under the whole turgor, which then becomes the last converged state. *ok: PETSC_FALSE where a point has no response
  there (`trouble` says which).
*/
PetscErrorCode LamMacroSealLumens(LamMacro macro, PetscBool *ok);
/* The pressures go with the displacement from the last evaluation to u, by their linearised equation; LamMacroFollow:
   where it has changed. */
PetscErrorCode LamMacroFollow(LamMacro macro, Vec u);
PetscErrorCode LamMacroMovePressures(LamMacro macro, Vec u);
/* Turgor of a point over that with which it was sealed. */
PetscReal LamMacroTurgorChange(LamMacro macro, const LamMacroElement *element, PetscInt point);
/* Keeps what pressures need of the point's response; one that does not know it becomes LAM_OUT_OF_REACH. */
PetscErrorCode LamMacroKeepSealed(LamMacro macro, PetscInt point);
/* Takes the pressures out of an element's forces fe and tangent Ke (NULL: not wanted), of the last evaluation. */
PetscErrorCode LamMacroCondense(LamMacro macro, const LamMacroElement *element, PetscScalar fe[], PetscScalar Ke[]);
/* Derivative by the turgor of what the water law lets a point hold, in the last converged state. */
PetscReal LamMacroWaterSlope(LamMacro macro, PetscInt point);
/* Norm of the pressures' equations in the last evaluation, over that of the water; 0 where nothing is sealed. */
PetscErrorCode LamMacroSealedResidual(LamMacro macro, PetscReal *residual);
PetscErrorCode LamMacroAcceptPressures(LamMacro macro);
PetscErrorCode LamMacroRejectPressures(LamMacro macro);
/* Of the last converged state, which is the present one; points [points]: their numbers in the undistributed mesh. */
PetscErrorCode LamMacroArchiveSeal(LamMacro macro, LamArchive archive, const PetscInt points[]);

/* checkpoint.c */
/* Nodal values of a vector, [node][dim]. */
PetscErrorCode LamMacroArchiveVec(LamMacro macro, LamArchive archive, const char name[], Vec vec);

/* fields.c */
/* What is kept of a response, by LamPointField. */
/* localisation.c: of the last converged state, for the report of its step; fills LAM_POINT_ELLIPTICITY of its points.
   Collective. */
PetscErrorCode LamMacroFindLocalisation(LamMacro macro, LamMacroStep *step);
void LamMacroKeepFields(const LamResponse *response, PetscReal field[LAM_POINT_FIELD_COUNT]);

/* inflation.c */
/* Fills u with the homogeneous inflated state of the tissue at the turgor that acts now, where one is found. */
PetscErrorCode LamMacroGuessInflated(LamMacro macro, Vec u, PetscBool *found);

/* stepping.c */
PetscErrorCode LamMacroNewtonCreate(LamMacro macro);
/* Starts the report of a step; the work adds up over the steps. */
PetscErrorCode LamMacroStartStep(LamMacro macro, PetscReal *start);
/* Completes the report of a converged step. */
PetscErrorCode LamMacroFinishStep(LamMacro macro, PetscInt number, PetscReal load_factor, PetscReal start);
/* Brings the turgor up, with `inflate` in a body that is not loaded yet, and seals lumens; *converged else `trouble`.
   The load program acts then from macro->origin on, once boundaries are held. */
PetscErrorCode LamMacroBringUpTurgor(LamMacro macro, PetscReal *reached, PetscBool *converged);
/* Newton from macro->trial, under what acts now; where it fails `trouble` says why. */
PetscErrorCode LamMacroIterate(LamMacro macro, PetscBool *converged);

#endif
