/*
  The scene: what the user describes in a YAML file, read, checked and made nondimensional.

  Nothing here needs MPI or PETSc to be initialised.
*/
#ifndef LAMELLA_SCENE_H
#define LAMELLA_SCENE_H

#include <petscsys.h>
#include <stdio.h>
#include <lamella/kinetics.h>
#include <lamella/place_field.h>
#include <lamella/wall.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* Enumerations and their names in scene files come from one list each. */
#define LAM_ENUM_ENTRY(symbol, name) symbol,
#define LAM_NAME_ENTRY(symbol, name) name,

#define LAM_INTERFACE_LAWS(X)                                                                                          \
  X(LAM_INTERFACE_BONDED, "bonded")                                                                                    \
  X(LAM_INTERFACE_CONTACT, "contact")
#define LAM_STRATEGIES(X)                                                                                              \
  X(LAM_TWO_STEP, "two_step") /* bonded tissue first, then release to contact */                                       \
  X(LAM_ONE_STEP, "one_step") /* contact at once from the affine state */
#define LAM_PATCH_SIDES(X)                                                                                             \
  X(LAM_SIDES_AFFINE, "affine") /* the lateral outer walls follow F, as those in the grips do */                       \
  X(LAM_SIDES_FREE, "free")

typedef enum { LAM_INTERFACE_LAWS(LAM_ENUM_ENTRY) LAM_INTERFACE_LAW_COUNT } LamInterfaceLawType;
typedef enum { LAM_STRATEGIES(LAM_ENUM_ENTRY) LAM_STRATEGY_COUNT } LamStrategy;
typedef enum { LAM_PATCH_SIDES(LAM_ENUM_ENTRY) LAM_PATCH_SIDES_COUNT } LamPatchSides;

LAM_EXPORT extern const char *const LamInterfaceLawNames[]; /* "bonded", "contact" */
LAM_EXPORT extern const char *const LamStrategyNames[];     /* "two_step", "one_step" */
LAM_EXPORT extern const char *const LamPatchSidesNames[];   /* "affine", "free" */

/* What may differ from cell to cell. */
typedef struct {
  PetscReal wall_thickness;   /* in apothems */
  LamWall wall;               /* moduli in the C1 + C2 of the tissue */
  PetscReal turgor, cohesion; /* times those of the load; between two cells the smaller cohesion holds */
} LamCell;

/* One tissue microstructure, nondimensional: all that fixes the map (F, turgor, cohesion) -> response. */
typedef struct {
  PetscReal wall_thickness; /* of one cell's wall, in apothems; 0 < t < 1 */
  PetscReal orientation;    /* angle of face normal 0 to the X1 axis, radian */
  PetscBool is_patch;       /* a block of cells between grips, else a periodic one */
  LamPatchSides sides;      /* of a patch */
  PetscInt cells[2];        /* per period along lattice vectors 0 and 1; of a patch: columns and rows */
  LamWall wall;
  LamCell *cell; /* [cells[0] cells[1]], cell = i cells[1] + j; NULL: all alike. Belongs to whoever holds the original:
                    copies of the struct borrow it */
  LamInterfaceLawType interface;
  PetscReal clearance;     /* of facing walls at rest, in apothems: cells are smaller than their places by half of it */
  PetscInt along, through; /* elements per face and through one wall; 0: not chosen yet (the planner does) */
  PetscReal grading;       /* of elements along a face towards its ends, in [0, 1); 0: all alike; negative: not chosen
                              yet */
} LamMicrostructure;

/* A copy that owns its cells; it is to be destroyed. A scene destroys its own microstructure. */
LAM_EXPORT PetscErrorCode LamMicrostructureCopy(const LamMicrostructure *micro, LamMicrostructure *copy);
LAM_EXPORT PetscErrorCode LamMicrostructureDestroy(LamMicrostructure *micro);
/* Hash (16 hex digits) of the canonical, nondimensional description, and the description itself (JSON text). */
#define LAM_HASH_LENGTH 17
LAM_EXPORT PetscErrorCode LamMicrostructureDescribe(const LamMicrostructure *micro, char **json,
                                                    char hash[LAM_HASH_LENGTH]);
/* The hash of the tissue, whatever its mesh. */
LAM_EXPORT PetscErrorCode LamMicrostructureHashTissue(const LamMicrostructure *micro, char hash[LAM_HASH_LENGTH]);
/* From that description; `path`, the file that it stands in, is for messages. The caller destroys *micro. */
LAM_EXPORT PetscErrorCode LamMicrostructureParse(const char path[], const char json[], LamMicrostructure *micro);

/* Of a cell's wall, in apothems. */
static inline PetscReal LamWallThickness(const LamMicrostructure *micro, PetscInt cell)
{
  return micro->cell ? micro->cell[cell].wall_thickness : micro->wall_thickness;
}

/* Of a cell's outer walls: half the distance between neighbours' centres is 1. */
static inline PetscReal LamOuterApothem(const LamMicrostructure *micro)
{
  return micro->interface == LAM_INTERFACE_CONTACT ? 1.0 - 0.5 * micro->clearance : 1.0;
}

/* The units of the nondimensional numbers: multiply by these to get SI. */
typedef struct {
  PetscReal length;       /* apothem of the cell, m */
  PetscReal stress;       /* C1 + C2, Pa */
  PetscReal macro_length; /* first edge of the macroscale box, radius of a disc, unit of a Gmsh file, m; 0 without a
                             macro block */
} LamScales;

/* What a material point is asked. */
typedef struct {
  PetscReal F[9];     /* deformation gradient, row-major */
  PetscReal turgor;   /* lumen pressure p */
  PetscReal cohesion; /* suction g on separated outer walls; 0 for bonded tissue */
} LamLoad;

/* What the tissue bears, in C1 + C2; NaN: not given. */
typedef struct {
  PetscReal wall;           /* tension of a wall, averaged over its thickness and as long a stretch */
  PetscReal lamella_normal; /* traction that parts bonded cells, averaged over a length of one wall thickness */
  PetscReal lamella_shear;  /* likewise, along the face */
} LamStrength;

/*
  What else a load prescribes where F does not say it all: stress, and components that go on from the state before.
  P[i] and F[i] are alternatives; F12 and F21 are not both free. Row-major as F.
*/
typedef struct {
  PetscBool given[9]; /* P is prescribed; F is free, and in a load only the first guess */
  PetscReal P[9];
  PetscBool follows[9]; /* F goes from that of the state before, which reading does not know, by `share` of the way to
                           that of the load */
  PetscReal share;
} LamStressControl;

/* Box of states for `build`. */
typedef struct {
  PetscReal stretch_min, stretch_max; /* principal logarithmic strains */
  PetscReal turgor_min, turgor_max;
  PetscInt count;     /* number of samples; 0: until accuracy is reached */
  PetscReal accuracy; /* 0 where count is given */
  PetscInt round;     /* nodes that are begun together, at least */
} LamSample;

#define LAM_MAP_OF_WALL(X, name, ...) X(LAM_MAP_##name, #name)
#define LAM_MAP_QUANTITIES(X)                                                                                          \
  X(LAM_MAP_TURGOR, "turgor")                                                                                          \
  X(LAM_MAP_COHESION, "cohesion")                                                                                      \
  X(LAM_MAP_SHEAR, "shear")             /* F12 that the load has reached */                                            \
  X(LAM_MAP_LOAD_FACTOR, "load_factor") /* share of the load's states that has been passed */                          \
  X(LAM_MAP_WALL_STRENGTH, "wall_strength")                                                                            \
  X(LAM_MAP_LAMELLA_NORMAL, "lamella_normal")                                                                          \
  X(LAM_MAP_LAMELLA_SHEAR, "lamella_shear")                                                                            \
  LAM_WALL_OWN_PARAMETERS(LAM_MAP_OF_WALL, X)                                                                          \
  X(LAM_MAP_WALL_THICKNESS, "wall_thickness")
typedef enum { LAM_MAP_QUANTITIES(LAM_ENUM_ENTRY) LAM_MAP_QUANTITY_COUNT } LamMapQuantity;
LAM_EXPORT extern const char *const LamMapQuantityNames[]; /* "turgor", "cohesion", ... */

/* One axis of a map, in C1 + C2 and apothems. */
typedef struct {
  LamMapQuantity quantity;
  PetscReal from, to; /* from < to */
  PetscInt points;    /* at least 2, the ends included */
  PetscBool is_log;   /* equal ratios instead of equal differences; from > 0 */
} LamMapAxis;
typedef enum { LAM_MAP_X, LAM_MAP_Y, LAM_MAP_AXIS_COUNT } LamMapDirection;

/* The value of point i = 0..points-1. */
LAM_EXPORT PetscReal LamMapAxisValue(const LamMapAxis *axis, PetscInt i);
/* "MPa", "um" or "1", and *scale the factor to it. */
LAM_EXPORT const char *LamMapQuantityUnit(LamMapQuantity quantity, const LamScales *scales, PetscReal *scale);
/* The parameter of the wall that it is; -1: none. */
LAM_EXPORT PetscInt LamMapQuantityParameter(LamMapQuantity quantity);
/* Whether it says how far the load is followed, not what tissue is loaded. */
LAM_EXPORT PetscBool LamMapQuantityIsLoad(LamMapQuantity quantity);

/* Where the mesh of the macroscale body comes from. */
#define LAM_DISC_PARTS(X)                                                                                              \
  X(LAM_DISC_WHOLE, "whole")                                                                                           \
  X(LAM_DISC_HALF, "half")       /* X2 >= 0 */                                                                         \
  X(LAM_DISC_QUARTER, "quarter") /* X1, X2 >= 0 */
typedef enum { LAM_DISC_PARTS(LAM_ENUM_ENTRY) LAM_DISC_PART_COUNT } LamDiscPart;
LAM_EXPORT extern const char *const LamDiscPartNames[];
typedef enum { LAM_MESH_BOX, LAM_MESH_DISC, LAM_MESH_GMSH } LamMeshSource;

#define LAM_MAX_BOUNDARIES 16
#define LAM_MAX_ZOOMS 3
#define LAM_NAME_LENGTH 64

/* What a named side of the macroscale body meets. */
#define LAM_BOUNDARY_KINDS(X)                                                                                          \
  X(LAM_BOUNDARY_DISPLACEMENT, "displacement")                                                                         \
  X(LAM_BOUNDARY_SYMMETRY, "symmetry") /* straight; no displacement along its normal, in inflation neither */          \
  X(LAM_BOUNDARY_TRACTION, "traction") /* dead, or `follower` */                                                       \
  X(LAM_BOUNDARY_PRESSURE, "pressure") /* a follower traction (0, -pressure) */                                        \
  X(LAM_BOUNDARY_PLATE, "plate")       /* rigid obstacles, frictionless and unilateral */                              \
  X(LAM_BOUNDARY_INDENTER, "indenter")                                                                                 \
  X(LAM_BOUNDARY_GRIP, "grip") /* all nodes move alike; components that are not given bear no total force */
typedef enum { LAM_BOUNDARY_KINDS(LAM_ENUM_ENTRY) LAM_BOUNDARY_KIND_COUNT } LamBoundaryKind;
LAM_EXPORT extern const char *const LamBoundaryKindNames[];

#define LAM_HISTORY_POINTS 32
/* The factor of a load over the load parameter: straight between points, constant beyond. count 0: the parameter. */
typedef struct {
  PetscInt count;
  PetscReal parameter[LAM_HISTORY_POINTS], factor[LAM_HISTORY_POINTS]; /* parameters rise */
} LamHistory;

/* A condition on a named side. What is prescribed is multiplied by the history's factor. */
typedef struct {
  char on[LAM_NAME_LENGTH];   /* box: left, right, bottom, top; disc: rim, left, bottom; Gmsh: a physical group */
  char name[LAM_NAME_LENGTH]; /* under which its force is reported; "": that of the side */
  LamBoundaryKind kind;
  PetscBool given[2];        /* of a displacement or grip; PETSC_FALSE: this component is free */
  PetscReal displacement[2]; /* of the side or obstacle, in macro lengths; counts from the inflated state */
  PetscReal traction[2];     /* along X1, X2 per reference area; or, of a follower, along the present tangent (the
                                outward normal turned by +90 degrees) and the outward normal, per present area */
  PetscBool follower;
  PetscReal normal[2]; /* unit, from a plate into the body; 0: that of the straight side */
  PetscReal radius;    /* of an indenter */
  PetscReal at[2];     /* reference point that the indenter's centre moves towards */
  LamHistory history;
} LamBoundary;

#define LAM_MAX_LEGS 64
/* A part of the load program: the parameter goes to `to` in equal steps. */
typedef struct {
  PetscReal to;
  PetscInt steps;
} LamLeg;

/* The mean of one displacement component over a side is prescribed, and the common factor of all tractions unknown. */
typedef struct {
  char on[LAM_NAME_LENGTH]; /* "": tractions follow their histories */
  PetscInt component;
  PetscReal displacement; /* at load parameter 1 */
} LamLoadControl;

typedef struct {
  LamMeshSource source;
  PetscReal box[2];     /* edges, in macro lengths (box[0] = 1) */
  LamDiscPart disc;     /* of a disc about the origin, whose radius is the macro length */
  PetscInt elements[2]; /* box: along X1, X2; disc: along an eighth of the rim, and between rim and inner square */
  char gmsh[PETSC_MAX_PATH_LEN]; /* file; a unit of length there is the macro length */
  PetscInt boundary_count;
  LamBoundary boundary[LAM_MAX_BOUNDARIES];
  LamLoadControl control;
  PetscBool inflate;                /* first bring turgor up with only rigid motions and symmetry held */
  PetscInt steps;                   /* load steps after inflation, of the whole program */
  PetscInt leg_count;               /* 0: the parameter goes from 0 to 1 in `steps` */
  LamLeg legs[LAM_MAX_LEGS];        /* from 0 on, gone through again and again until all steps are done */
  PetscInt zoom_count;              /* places at which the RVE is kept for pictures; 0: chosen by the results */
  PetscReal zoom[LAM_MAX_ZOOMS][2]; /* reference positions, in macro lengths */
} LamMacroSpec;

#define LAM_MAX_REGIONS 16

/* A part of the body with tissue of its own. Where several cover a point the last one holds. */
typedef struct {
  char name[LAM_NAME_LENGTH]; /* letters, digits, - and _ */
  LamPlaceField where; /* covers the points where it is not 0; NULL: the mesh's physical group of this name; owned */
  LamMicrostructure micro; /* its orientation is that of the region; owns its cells */
  LamScales scales;        /* its own apothem and C1 + C2, in which micro, turgor and cohesion are */
  PetscReal turgor, cohesion;
} LamRegion;

#define LAM_TISSUE_FIELDS(X)                                                                                           \
  X(LAM_TISSUE_ORIENTATION, "orientation")                                                                             \
  X(LAM_TISSUE_TURGOR, "turgor")                                                                                       \
  X(LAM_TISSUE_COHESION, "cohesion")                                                                                   \
  X(LAM_TISSUE_WALL_THICKNESS, "wall_thickness")
typedef enum { LAM_TISSUE_FIELDS(LAM_ENUM_ENTRY) LAM_TISSUE_FIELD_COUNT } LamTissueField;
LAM_EXPORT extern const char *const LamTissueFieldNames[]; /* "orientation", ... */

/* What varies from point to point: replaces what the tissue and the regions say. */
typedef struct {
  LamPlaceField value[LAM_TISSUE_FIELD_COUNT]; /* NULL: does not vary; owned */
  PetscReal unit[LAM_TISSUE_FIELD_COUNT];      /* SI (rad, Pa, Pa, m) of 1 */
  PetscInt levels;                             /* wall thicknesses that are solved; 0: not chosen */
} LamTissueFields;

/* What a cache does with a question that its table cannot be refined to answer. */
#define LAM_OUTSIDES(X)                                                                                                \
  X(LAM_OUTSIDE_SOLVE, "solve")                                                                                        \
  X(LAM_OUTSIDE_STOP, "stop")
typedef enum { LAM_OUTSIDES(LAM_ENUM_ENTRY) LAM_OUTSIDE_COUNT } LamOutside;
LAM_EXPORT extern const char *const LamOutsideNames[]; /* "solve", "stop" */

/* How the material points of the body are answered. */
typedef struct {
  LamOutside outside;
  PetscReal accuracy;          /* of an answer from a database, relative error of P; 0: the program chooses */
  PetscReal warm_start_memory; /* bytes on a rank, of states that direct solves start from */
} LamResponsePolicy;
#define LAM_WARM_START_MEMORY 2e9 /* of scenes that do not say it */

/* What changes by a kinetic law, as a factor of what it is at the start. */
#define LAM_CHANGING_OF_WALL(X, name, ...) X(LAM_CHANGING_##name, #name)
#define LAM_CHANGING(X)                                                                                                \
  X(LAM_CHANGING_LAMELLA, "lamella")           /* cohesion, and the strengths of the lamella */                        \
  X(LAM_CHANGING_WALLS, "walls")               /* all moduli of the walls */                                           \
  LAM_WALL_PARAMETERS(LAM_CHANGING_OF_WALL, X) /* one parameter, beside that */                                        \
  X(LAM_CHANGING_WALL_STRENGTH, "wall_strength")                                                                       \
  X(LAM_CHANGING_SOLUTES, "solutes") /* amount in a cell */                                                            \
  X(LAM_CHANGING_PERMEABILITY, "permeability")                                                                         \
  X(LAM_CHANGING_REFLECTION, "reflection")
typedef enum { LAM_CHANGING(LAM_ENUM_ENTRY) LAM_CHANGING_COUNT } LamChanging;
LAM_EXPORT extern const char *const LamChangingNames[]; /* "lamella", ... */
#define LAM_CHANGING_OF_PARAMETER(k) ((LamChanging)(LAM_CHANGING_WALLS + 1 + (k)))

/* Water that passes the membranes of the cells; pressures in C1 + C2. */
typedef struct {
  PetscReal permeability; /* Lp (C1 + C2) / apothem, 1/s; infinite: water is in equilibrium at any time */
  PetscReal activation;   /* of Lp, J/mol, from the temperature at the start */
  PetscReal reflection;   /* sigma */
  PetscReal osmotic;      /* pi of the cells at the start; NaN: in equilibrium with turgor and surroundings */
  PetscReal non_osmotic;  /* share of the lumen at the start that is no solution */
} LamWaterSpec;

/* The surroundings at a time; straight between such, constant beyond; two at one time: a jump. */
typedef struct {
  PetscReal time;        /* s */
  PetscReal temperature; /* K */
  PetscReal outside;     /* osmotic pressure outside the cells, C1 + C2 */
  PetscReal turgor;      /* of cells whose water is not followed, C1 + C2 */
} LamSurroundings;

/* A part of the load program: what is prescribed goes straight to these values. */
typedef struct {
  PetscReal duration;       /* s; 0: a jump */
  PetscReal F[9];           /* counted from the inflated state; where P is given a first guess */
  LamStressControl control; /* P: of the reference area before inflation */
  PetscReal load;           /* of a body: load parameter at the end */
} LamProcessLeg;

/* Tissue that changes in time. */
typedef struct {
  PetscReal duration, output; /* s; between outputs */
  PetscReal tolerance;        /* relative, of the integration in time */
  PetscBool inflate;          /* the program counts from the tissue that is free of stress under its turgor */
  PetscBool has_water;
  LamWaterSpec water;
  LamKinetics kinetics[LAM_CHANGING_COUNT]; /* own their tables */
  PetscInt surroundings_count;              /* at least 1 */
  LamSurroundings *surroundings;            /* owned */
  PetscInt leg_count, repeat;               /* 0: free of stress */
  LamProcessLeg *legs;                      /* owned; gone through `repeat` times, then held */
  PetscReal opening;                        /* event: growth of the opening volume over V0 since the start */
} LamProcessSpec;

/* A scene: plain data, read-only after LamSceneRead. Blocks that the file does not hold have count 0 or PETSC_FALSE. */
typedef struct {
  char path[PETSC_MAX_PATH_LEN];
  char *text; /* the file's text, for provenance; owned */
  LamScales scales;
  LamMicrostructure micro;
  PetscReal turgor;                  /* of the tissue, where a load does not say otherwise; in C1 + C2 */
  PetscBool sealed;                  /* the cells keep the water that they have at F = I with this turgor, ... */
  PetscReal water_bulk_modulus;      /* ... of this bulk modulus, C1 + C2 */
  PetscReal cohesion;                /* likewise */
  LamStrategy strategy;              /* how contact is reached */
  PetscReal tolerance;               /* of the Newton iterations of an RVE; 0: rounding */
  LamStrength strength;              /* what walls and lamella bear */
  PetscReal accuracy;                /* wanted relative error of the effective stress */
  char measured[PETSC_MAX_PATH_LEN]; /* what `tradeoff` has measured of this tissue's meshes; empty: not given */
  PetscInt load_count;
  LamLoad *loads;             /* ramps expanded: states 1..load_count; owned */
  LamStressControl *controls; /* of the loads; NULL where F is given in all of them; owned */
  PetscBool has_sample;
  LamSample sample;
  PetscBool has_macro;
  LamMacroSpec macro;
  PetscInt region_count;
  LamRegion *regions;     /* of the body; owned */
  LamTissueFields fields; /* likewise */
  LamResponsePolicy response;
  PetscBool has_process;
  LamProcessSpec process;
  PetscBool has_map;
  LamMapAxis map[LAM_MAP_AXIS_COUNT]; /* at most one of them is of the load */
} LamScene;

/* Whether the law of any wall of the scene has a parameter. */
LAM_EXPORT PetscBool LamSceneHasParameter(const LamScene *scene, PetscInt parameter);
/* Whether what changes is that of a wall that the scene does not have. */
LAM_EXPORT PetscBool LamSceneLacksChanging(const LamScene *scene, LamChanging changing);
/* The factor of a history at a load parameter. */
LAM_EXPORT PetscReal LamHistoryFactor(const LamHistory *history, PetscReal parameter);
/* Whether two histories have equal factors at all parameters. */
LAM_EXPORT PetscBool LamHistoriesAgree(const LamHistory *one, const LamHistory *other);
/* The load parameter at the end of load step 0 (the start) to spec->steps. */
LAM_EXPORT PetscReal LamMacroParameter(const LamMacroSpec *spec, PetscInt step);

/*
  Reads and checks a scene file. Any mistake is PETSC_ERR_USER_INPUT with a message
  "file:line:column: key: value: what is wrong; what would be right".
*/
LAM_EXPORT PetscErrorCode LamSceneRead(const char path[], LamScene **scene);
/* The same from text; `name` stands for the file in messages. */
LAM_EXPORT PetscErrorCode LamSceneReadText(const char name[], const char text[], LamScene **scene);
LAM_EXPORT PetscErrorCode LamSceneDestroy(LamScene **scene);

/* A load after a state at F = before: free components have that for their guess, others follow it. control may be NULL.
 */
LAM_EXPORT LamLoad LamLoadAfter(const LamLoad *load, const LamStressControl *control, const PetscReal before[9]);

/* Writes the scene reference (Markdown), generated from the same table of keys that the reader uses. */
LAM_EXPORT PetscErrorCode LamSceneReference(FILE *out);

/* Physical dimensions known to scene files and the command line. */
typedef enum {
  LAM_DIMENSION_LENGTH,
  LAM_DIMENSION_STRESS,
  LAM_DIMENSION_ANGLE,
  LAM_DIMENSION_TIME,
  LAM_DIMENSION_TEMPERATURE,
  LAM_DIMENSION_RATE,
  LAM_DIMENSION_MOLAR_ENERGY,
  LAM_DIMENSION_PERMEABILITY
} LamDimension;

/*
  Converts text such as "0.02 MPa" to SI (m, Pa, rad, s, K, 1/s, J/mol, m/s/Pa). PETSC_ERR_USER_INPUT, with the reason,
  where the unit is missing, unknown or of another dimension, or the number is not finite.
*/
LAM_EXPORT PetscErrorCode LamQuantityParse(const char text[], LamDimension dimension, PetscReal *si);

LAM_C_END

#endif
