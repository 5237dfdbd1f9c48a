/*
  The scene: the user's YAML file, read, checked and converted to nondimensional numbers.

  Nothing here requires MPI or PETSc to be initialised.
*/
#ifndef LAMELLA_SCENE_H
#define LAMELLA_SCENE_H

#include <petscsys.h>
#include <stdio.h>
#include <lamella/cohesive.h>
#include <lamella/kinetics.h>
#include <lamella/place_field.h>
#include <lamella/wall.h>
#include <lamella/export.h>

LAM_C_BEGIN

/* Each enumeration and its names in scene files are generated from one list. */
#define LAM_ENUM_ENTRY(symbol, name) symbol,
#define LAM_NAME_ENTRY(symbol, name) name,

#define LAM_INTERFACE_LAWS(X)                                                                                          \
  X(LAM_INTERFACE_BONDED, "bonded")                                                                                    \
  X(LAM_INTERFACE_CONTACT, "contact")                                                                                  \
  X(LAM_INTERFACE_LAMELLA, "lamella")
#define LAM_STRATEGIES(X)                                                                                              \
  X(LAM_TWO_STEP, "two_step") /* bonded tissue first, then release to contact */                                       \
  X(LAM_ONE_STEP, "one_step") /* contact from the affine state on */
#define LAM_SHARPNESSES(X)                                                                                             \
  X(LAM_SHARPNESS_AUTO, "auto") /* exact */                                                                            \
  X(LAM_SHARPNESS_EXACT, "exact")                                                                                      \
  X(LAM_SHARPNESS_SMOOTH, "smooth")
#define LAM_PATCH_SIDES(X)                                                                                             \
  X(LAM_SIDES_AFFINE, "affine") /* the lateral outer walls follow F, as those in the grips do */                       \
  X(LAM_SIDES_FREE, "free")

typedef enum { LAM_INTERFACE_LAWS(LAM_ENUM_ENTRY) LAM_INTERFACE_LAW_COUNT } LamInterfaceLawType;
/* Whether the cells of tissue with this law can part: all laws but `bonded`. */
static inline PetscBool LamCellsPart(LamInterfaceLawType law)
{
  return (PetscBool)(law != LAM_INTERFACE_BONDED);
}
typedef enum { LAM_STRATEGIES(LAM_ENUM_ENTRY) LAM_STRATEGY_COUNT } LamStrategy;
typedef enum { LAM_SHARPNESSES(LAM_ENUM_ENTRY) LAM_SHARPNESS_COUNT } LamSharpness;
typedef enum { LAM_PATCH_SIDES(LAM_ENUM_ENTRY) LAM_PATCH_SIDES_COUNT } LamPatchSides;

LAM_EXPORT extern const char *const LamInterfaceLawNames[]; /* "bonded", "contact" */
LAM_EXPORT extern const char *const LamStrategyNames[];     /* "two_step", "one_step" */
LAM_EXPORT extern const char *const LamSharpnessNames[];    /* "auto", "exact", "smooth" */
LAM_EXPORT extern const char *const LamPatchSidesNames[];   /* "affine", "free" */

#define LAM_USUAL_WIDTH 3e-3 /* apothems: of the smooth law of contact for single states (docs/theory/contact.md) */

/* Properties that may vary between cells. */
typedef struct {
  PetscReal wall_thickness;   /* in apothems */
  LamWall wall;               /* moduli in the C1 + C2 of the tissue */
  PetscReal turgor, cohesion; /* factors of the load's values; between two cells the smaller cohesion acts */
  PetscReal lamella_strength, lamella_energy; /* factors of the lamella's; between two cells the smaller ones act */
  PetscInt cluster;                           /* of cells that hold together (LamLamella, between) */
} LamCell;
/* Whether two cells are the same, to a relative tolerance. */
LAM_EXPORT PetscBool LamCellsAgree(const LamCell *a, const LamCell *b, PetscReal tolerance);

typedef struct LamTissue_s *LamTissue; /* cells of any shape (tissue.h) */

/* A tissue microstructure, nondimensional. It determines the map (F, turgor, cohesion) -> response. */
typedef struct {
  PetscReal wall_thickness; /* of one cell's wall, in apothems; 0 < t < 1 */
  PetscReal orientation;    /* angle of face normal 0 to the X1 axis, radian */
  PetscReal length;         /* of cells along X3, which end walls close, in apothems; 0: prisms without ends */
  PetscBool is_patch;       /* a block of cells between grips; otherwise periodic */
  LamPatchSides sides;      /* of a patch */
  PetscInt cells[2];        /* per period along lattice vectors 0 and 1; of a patch: columns and rows; of polygons
                               their number and 1 */
  LamTissue tissue;         /* cells that are polygons; NULL: hexagons. Owned as `cell` is */
  PetscInt notch_row, notch_columns; /* of a patch with a lamella: none holds below the first cells of this row */
  LamWall wall;
  LamRelaxation relaxation; /* of all walls */
  LamCell *cell; /* [cells[0] cells[1]], cell = i cells[1] + j; NULL: all cells are equal. Owned by the original; copies
                    of the struct borrow it */
  LamInterfaceLawType interface;
  PetscReal clearance; /* gap between facing walls at rest, in apothems: each cell is smaller than its lattice site by
                          half of it */
  LamLamella lamella;  /* of law `lamella` */
  LamTearing tearing;  /* of the walls, with law `lamella` */
  LamSharpness sharpness;  /* law of contact */
  PetscReal contact_width; /* of the smooth law, in apothems; 0: LAM_USUAL_WIDTH */
  PetscInt along, through; /* elements per face and through one wall; 0: chosen by the planner */
  PetscReal grading; /* of the elements along a face towards its ends, in [0, 1); 0: uniform; negative: chosen by the
                        planner */
} LamMicrostructure;

/* Whether walls have a memory. */
static inline PetscBool LamWallsRelax(const LamMicrostructure *micro)
{
  return (PetscBool)(micro->relaxation.terms > 0);
}
/* Whether responses depend on the states before: a lamella that breaks, or walls with memory. */
static inline PetscBool LamHasHistory(const LamMicrostructure *micro)
{
  return (PetscBool)(micro->interface == LAM_INTERFACE_LAMELLA || LamWallsRelax(micro));
}
/* Whether fibres of any wall leave the section of the cells. */
LAM_EXPORT PetscBool LamWallsTilt(const LamMicrostructure *micro);
/* Whether walls can tear. */
static inline PetscBool LamWallsTear(const LamMicrostructure *micro)
{
  return (PetscBool)(micro->tearing.strength > 0.0);
}
/* Deep copy, which owns its cells; free it with LamMicrostructureDestroy. A scene destroys its own microstructure. */
LAM_EXPORT PetscErrorCode LamMicrostructureCopy(const LamMicrostructure *micro, LamMicrostructure *copy);
LAM_EXPORT PetscErrorCode LamMicrostructureDestroy(LamMicrostructure *micro);
/* The canonical, nondimensional description (JSON text) and its hash (16 hex digits). */
#define LAM_HASH_LENGTH 17
LAM_EXPORT PetscErrorCode LamMicrostructureDescribe(const LamMicrostructure *micro, char **json,
                                                    char hash[LAM_HASH_LENGTH]);
/* Hash of the tissue without its mesh. */
LAM_EXPORT PetscErrorCode LamMicrostructureHashTissue(const LamMicrostructure *micro, char hash[LAM_HASH_LENGTH]);
/* Parses a description. `path` names the file that contains it, for messages. The caller destroys *micro. */
LAM_EXPORT PetscErrorCode LamMicrostructureParse(const char path[], const char json[], LamMicrostructure *micro);

/* Stresses that errors are compared with where stresses are smaller (LamStressError), in C1 + C2. */
typedef struct {
  PetscReal plane, axial; /* of the in-plane components; of P33 */
} LamStressScale;
/*
  The stress of the tissue at a strain of 1 %, in C1 + C2 of its reference wall, from its stiffness at rest: in the
  plane the Frobenius norm of the tangent of thin bonded walls, |A| = t (4 + 2 C4/(C1 + C2)) / (1 - t)^1.2,    A_3333 =
  8 t, C4 of quadratic fibres; the mean over the cells. Within 35 % of the solved tangent for t up to 0.4 and C4 up to
  100 (C1 + C2), and for thin walls of any fibres (docs/results/performance.md, The norm of errors).
*/
LAM_EXPORT LamStressScale LamStressScaleOf(const LamMicrostructure *micro);

/* ---- of tissue with law `lamella` (src/core/lamella.c) ---- */

/* Factors of strength and energy of the lamella between a cell and that across its face, without those of
   junctions; PETSC_FALSE: of cells that differ none is there. */
LAM_EXPORT PetscBool LamLamellaFaceFactors(const LamMicrostructure *micro, PetscInt cell, PetscInt face,
                                           PetscReal *strength, PetscReal *energy);
/* The stiffness, in (C1 + C2)/a, above which the traction of the lamella can fall without a jump: strength^2/(2
   energy), the largest of all faces of the tissue and of tension and shear. Infinite where an energy is 0. */
LAM_EXPORT PetscReal LamLamellaLeastStiffness(const LamMicrostructure *micro);
#define LAM_LAMELLA_STIFFEST                                                                                           \
  1e7 /* (C1 + C2)/a: rounding of a coordinate is then a traction of about 1e-9 (C1 + C2)                              \
       */
/* The stiffness where none is given: the lamella costs 0.08 % of the tissue's stiffness, or less where 50 times the
   least stiffness is more; at most the stiffest. */
LAM_EXPORT PetscReal LamLamellaDefaultStiffness(const LamMicrostructure *micro);
/* The same of the cuts across walls that tear: least stiffness strength^2/(2 energy), and the one where none is given,
   at the same price of the stiffness of walls in bending. */
LAM_EXPORT PetscReal LamTearingLeastStiffness(const LamTearing *tearing);
LAM_EXPORT PetscReal LamTearingDefaultStiffness(const LamMicrostructure *micro);
LAM_EXPORT PetscReal LamTearingCompliance(const LamMicrostructure *micro); /* that price */
/* What the compliance of the lamella costs of the tissue's stiffness, as a share of it: the change of the tangent at
   rest against that of bonded tissue, Frobenius norms. */
LAM_EXPORT PetscReal LamLamellaCompliance(const LamMicrostructure *micro);
/*
  Length of the process zone, in apothems: that part of a wall beside the tip of a crack on which the lamella softens,
  and which elements have to resolve. The shorter of those of a thick body and of a beam of thickness t,
    E' G/sigma^2    and    t^(3/4) (E' G/sigma^2)^(1/4),    E' = 4 (C1 + C2) + 2 C4,
  (Yang & Cox, Int. J. Fracture 133, 2005), E' of a wall along itself at rest, at the smallest G/sigma^2 of the tissue;
  the smallest of all cells. An estimate: factors before both, which authors give as 0.1 to 1, are taken as 1.
*/
LAM_EXPORT PetscReal LamLamellaZone(const LamMicrostructure *micro);

/* Wall thickness of a cell, in apothems. */
static inline PetscReal LamWallThickness(const LamMicrostructure *micro, PetscInt cell)
{
  return micro->cell ? micro->cell[cell].wall_thickness : micro->wall_thickness;
}

/* Apothem of a cell's outer walls; 1 is half the distance between the centres of neighbours. */
static inline PetscReal LamOuterApothem(const LamMicrostructure *micro)
{
  return LamCellsPart(micro->interface) ? 1.0 - 0.5 * micro->clearance : 1.0;
}

/* Units of the nondimensional numbers: multiply by these to obtain SI. */
typedef struct {
  PetscReal length;       /* apothem of the cell, m */
  PetscReal stress;       /* C1 + C2, Pa */
  PetscReal macro_length; /* first edge of the macroscale box, radius of a disc, unit of a Gmsh file, m; 0 without a
                             macro block */
} LamScales;

/* The load of a material point. */
typedef struct {
  PetscReal F[9];     /* deformation gradient, row-major */
  PetscReal turgor;   /* lumen pressure p */
  PetscReal cohesion; /* suction g on separated outer walls; 0 for bonded tissue */
  PetscReal duration; /* s, of the way from the state before; counts for walls with memory alone. 0: at once */
} LamLoad;

/* Strengths, in C1 + C2; NaN: not given. */
typedef struct {
  PetscReal wall;           /* wall tension, averaged over the wall thickness and an equal length along the wall */
  PetscReal lamella_normal; /* normal traction that separates bonded cells, averaged over one wall thickness */
  PetscReal lamella_shear;  /* shear traction, averaged likewise */
} LamStrength;

/*
  Mixed control of a load: prescribed stresses, and components of F that start from the previous state. Either P[i] or
  F[i] is prescribed; F12 and F21 are not both free. Row-major as F.
*/
typedef struct {
  PetscBool given[9]; /* P is prescribed; F is free, and its value in a load is only the initial guess */
  PetscReal P[9];
  PetscBool follows[9]; /* F is interpolated from the previous state, unknown when the scene is read, to the load by the
                           fraction `share` */
  PetscReal share;
} LamStressControl;

/* The areas that a prescribed stress counts on. */
#define LAM_AREAS(X)                                                                                                   \
  X(LAM_AREA_REST, "rest")                                                                                             \
  X(LAM_AREA_INFLATED, "inflated")
typedef enum { LAM_AREAS(LAM_ENUM_ENTRY) LAM_AREA_COUNT } LamArea;
LAM_EXPORT extern const char *const LamAreaNames[]; /* "rest", "inflated" */

/* The box of states that `build` covers. */
typedef struct {
  PetscReal stretch_min, stretch_max; /* principal logarithmic strains */
  PetscReal turgor_min, turgor_max;
  PetscReal F33_min, F33_max; /* without a sample block too; both 1: plane strain */
  PetscInt count;             /* number of samples; 0: until the accuracy is reached */
  PetscReal accuracy;         /* 0 if count is given */
  PetscInt round;             /* minimum number of nodes that are started together */
} LamSample;

#define LAM_MAP_OF_WALL(X, name, ...) X(LAM_MAP_##name, #name)
#define LAM_MAP_QUANTITIES(X)                                                                                          \
  X(LAM_MAP_TURGOR, "turgor")                                                                                          \
  X(LAM_MAP_COHESION, "cohesion")                                                                                      \
  X(LAM_MAP_SHEAR, "shear")             /* F12 reached by the load */                                                  \
  X(LAM_MAP_LOAD_FACTOR, "load_factor") /* fraction of the load's states that has been passed */                       \
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
  PetscInt points;    /* at least 2, including the ends */
  PetscBool is_log;   /* equal ratios instead of equal differences; requires from > 0 */
} LamMapAxis;
typedef enum { LAM_MAP_X, LAM_MAP_Y, LAM_MAP_AXIS_COUNT } LamMapDirection;

/* The value of point i = 0..points-1. */
LAM_EXPORT PetscReal LamMapAxisValue(const LamMapAxis *axis, PetscInt i);
/* Returns "MPa", "um" or "1"; *scale is the factor to that unit. */
LAM_EXPORT const char *LamMapQuantityUnit(LamMapQuantity quantity, const LamScales *scales, PetscReal *scale);
/* Index of the wall parameter that the quantity represents; -1: none. */
LAM_EXPORT PetscInt LamMapQuantityParameter(LamMapQuantity quantity);
/* True if the quantity is the extent of the load, not a property of the tissue. */
LAM_EXPORT PetscBool LamMapQuantityIsLoad(LamMapQuantity quantity);

/* Where a value stands in the scene's file, for messages of what only its use shows to be wrong; line 0: the file does
   not give it. */
typedef struct {
  int line, column;
} LamScenePlace;

/* Source of the macroscale mesh. */
#define LAM_DISC_PARTS(X)                                                                                              \
  X(LAM_DISC_WHOLE, "whole")                                                                                           \
  X(LAM_DISC_HALF, "half")       /* X2 >= 0 */                                                                         \
  X(LAM_DISC_RIGHT, "right")     /* X1 >= 0 */                                                                         \
  X(LAM_DISC_QUARTER, "quarter") /* X1, X2 >= 0 */
typedef enum { LAM_DISC_PARTS(LAM_ENUM_ENTRY) LAM_DISC_PART_COUNT } LamDiscPart;
LAM_EXPORT extern const char *const LamDiscPartNames[];
typedef enum { LAM_MESH_BOX, LAM_MESH_DISC, LAM_MESH_GMSH } LamMeshSource;

/* What the mesh is a section of. */
#define LAM_MACRO_SYMMETRIES(X)                                                                                        \
  X(LAM_PLANE_STRAIN, "plane_strain")                                                                                  \
  X(LAM_AXISYMMETRIC, "axisymmetric") /* X1 is the radius, X2 the axis; forces and energies are those of the whole     \
                                         circle */
typedef enum { LAM_MACRO_SYMMETRIES(LAM_ENUM_ENTRY) LAM_MACRO_SYMMETRY_COUNT } LamMacroSymmetry;
LAM_EXPORT extern const char *const LamMacroSymmetryNames[];

#define LAM_MAX_BOUNDARIES 16
#define LAM_MAX_ZOOMS 3
#define LAM_NAME_LENGTH 64

/* Boundary condition on a named side of the macroscale body. */
#define LAM_BOUNDARY_KINDS(X)                                                                                          \
  X(LAM_BOUNDARY_DISPLACEMENT, "displacement")                                                                         \
  X(LAM_BOUNDARY_SYMMETRY, "symmetry") /* straight side; no normal displacement, during inflation either */            \
  X(LAM_BOUNDARY_TRACTION, "traction") /* dead load, or `follower` */                                                  \
  X(LAM_BOUNDARY_PRESSURE, "pressure") /* a follower traction (0, -pressure) */                                        \
  X(LAM_BOUNDARY_PLATE, "plate")       /* rigid, unilateral obstacles */                                               \
  X(LAM_BOUNDARY_INDENTER, "indenter")                                                                                 \
  X(LAM_BOUNDARY_GRIP, "grip") /* all nodes move alike; the total force is 0 in components that are not given */
typedef enum { LAM_BOUNDARY_KINDS(LAM_ENUM_ENTRY) LAM_BOUNDARY_KIND_COUNT } LamBoundaryKind;
LAM_EXPORT extern const char *const LamBoundaryKindNames[];

#define LAM_HISTORY_POINTS 32
/* Load factor as a function of the load parameter: piecewise linear, constant outside. count 0: the parameter
   itself. */
typedef struct {
  PetscInt count;
  PetscReal parameter[LAM_HISTORY_POINTS], factor[LAM_HISTORY_POINTS]; /* parameters ascend */
} LamHistory;

/* A condition on a named side. Prescribed values are multiplied by the history's factor. */
typedef struct {
  LamScenePlace place;        /* of `on` */
  char on[LAM_NAME_LENGTH];   /* box: left, right, bottom, top; disc: rim, left, bottom; Gmsh: a physical group */
  char name[LAM_NAME_LENGTH]; /* names the reported force; "": the name of the side */
  LamBoundaryKind kind;
  PetscBool given[2];        /* displacement or grip; PETSC_FALSE: this component is free */
  PetscReal displacement[2]; /* of the side or obstacle, in macro lengths, relative to the inflated state */
  PetscReal traction[2];     /* along X1, X2 per reference area; follower: along the current tangent (the outward normal
                                turned by +90 degrees) and the outward normal, per current area */
  PetscBool follower;
  PetscReal normal[2]; /* unit vector from a plate into the body; 0: the normal of the straight side */
  PetscReal radius;    /* of an indenter */
  PetscBool shaft;     /* the indenter is the flat end of a cylinder, with its shaft; else it is round */
  PetscReal edge;      /* radius of the rounding between its end and its shaft */
  PetscReal friction;  /* of a plate or an indenter: coefficient; infinite: stuck */
  PetscReal at[2];     /* reference point towards which the indenter's centre moves */
  LamHistory history;
} LamBoundary;

#define LAM_MAX_LEGS 64
/* A leg of the load program: the parameter changes to `to` in equal steps. */
typedef struct {
  PetscReal to;
  PetscInt steps;
} LamLeg;

/* Displacement control: the mean of one displacement component over a side is prescribed, and the common factor of
   all tractions is unknown. */
typedef struct {
  LamScenePlace place;      /* of `on` */
  char on[LAM_NAME_LENGTH]; /* "": tractions follow their histories */
  PetscInt component;
  PetscReal displacement; /* at load parameter 1 */
} LamLoadControl;

typedef struct {
  LamMacroSymmetry symmetry;
  LamMeshSource source;
  LamScenePlace mesh_place; /* of the key that says it */
  PetscReal box[2];         /* edges, in macro lengths (box[0] = 1) */
  LamDiscPart disc;         /* part of a disc about the origin; its radius is the macro length */
  PetscInt elements[2];     /* box: along X1, X2; disc: along an eighth of the rim, and between rim and inner square */
  PetscReal grading[2];     /* box: edge of the last element over that of the first, along X1, X2; 0: alike */
  char gmsh[PETSC_MAX_PATH_LEN]; /* file; its unit of length is the macro length */
  PetscInt boundary_count;
  LamBoundary boundary[LAM_MAX_BOUNDARIES];
  LamLoadControl control;
  LamArea area;                     /* that readings' stresses are per, with inflate */
  PetscBool inflate;                /* first raise the turgor with only rigid motions and symmetry constrained */
  PetscInt steps;                   /* load steps after inflation, of the whole program */
  PetscInt leg_count;               /* 0: the parameter increases from 0 to 1 in `steps` */
  LamLeg legs[LAM_MAX_LEGS];        /* start at parameter 0; repeated until all steps are done */
  PetscInt zoom_count;              /* positions at which the RVE is stored for pictures; 0: chosen from the results */
  PetscReal zoom[LAM_MAX_ZOOMS][2]; /* reference positions, in macro lengths */
} LamMacroSpec;

#define LAM_MAX_REGIONS 16

/* A part of the body with its own tissue. Where regions overlap the last one applies. */
typedef struct {
  char name[LAM_NAME_LENGTH]; /* letters, digits, - and _ */
  LamScenePlace place;        /* of its expression, or of its name where it has none */
  LamPlaceField where; /* region where the field is nonzero; NULL: the mesh's physical group of this name; owned */
  char tissue[PETSC_MAX_PATH_LEN]; /* file of its own cells; empty: those of the scene */
  LamMicrostructure micro;         /* with the orientation of the region; owns its cells */
  PetscReal reference; /* orientation at which its tissue is solved; that of micro is the result of a turn */
  LamScales scales;    /* the region's apothem and C1 + C2, the units of micro, turgor and cohesion */
  PetscReal turgor, cohesion;
} LamRegion;

#define LAM_TISSUE_FIELDS(X)                                                                                           \
  X(LAM_TISSUE_ORIENTATION, "orientation")                                                                             \
  X(LAM_TISSUE_TURGOR, "turgor")                                                                                       \
  X(LAM_TISSUE_COHESION, "cohesion")                                                                                   \
  X(LAM_TISSUE_WALL_THICKNESS, "wall_thickness")
typedef enum { LAM_TISSUE_FIELDS(LAM_ENUM_ENTRY) LAM_TISSUE_FIELD_COUNT } LamTissueField;
LAM_EXPORT extern const char *const LamTissueFieldNames[]; /* "orientation", ... */

/* Fields that vary between material points; they override the values of the tissue and of the regions. */
typedef struct {
  LamPlaceField value[LAM_TISSUE_FIELD_COUNT]; /* NULL: does not vary; owned */
  LamScenePlace place[LAM_TISSUE_FIELD_COUNT]; /* of its expression or table */
  PetscReal unit[LAM_TISSUE_FIELD_COUNT];      /* the SI value (rad, Pa, Pa, m) of 1 */
  PetscInt levels;                             /* number of wall thicknesses that are solved; 0: not chosen */
} LamTissueFields;

/* Treatment of queries for which the table of a cache cannot be refined. */
#define LAM_OUTSIDES(X)                                                                                                \
  X(LAM_OUTSIDE_SOLVE, "solve")                                                                                        \
  X(LAM_OUTSIDE_STOP, "stop")
typedef enum { LAM_OUTSIDES(LAM_ENUM_ENTRY) LAM_OUTSIDE_COUNT } LamOutside;
LAM_EXPORT extern const char *const LamOutsideNames[]; /* "solve", "stop" */

/* How responses of the body's material points are obtained. */
typedef struct {
  LamOutside outside;
  PetscReal accuracy;          /* relative error of P of a response from a database; 0: chosen by the program */
  PetscReal warm_start_memory; /* bytes per rank, for the states from which direct solves start */
} LamResponsePolicy;
#define LAM_WARM_START_MEMORY 2e9 /* default */

/* Properties that follow a kinetic law, as factors of their initial values. */
#define LAM_CHANGING_OF_WALL(X, name, ...) X(LAM_CHANGING_##name, #name)
#define LAM_CHANGING(X)                                                                                                \
  X(LAM_CHANGING_LAMELLA, "lamella")           /* cohesion, and the strengths of the lamella */                        \
  X(LAM_CHANGING_WALLS, "walls")               /* all moduli of the walls */                                           \
  LAM_WALL_PARAMETERS(LAM_CHANGING_OF_WALL, X) /* one parameter, in addition */                                        \
  X(LAM_CHANGING_WALL_STRENGTH, "wall_strength")                                                                       \
  X(LAM_CHANGING_SOLUTES, "solutes") /* amount in a cell */                                                            \
  X(LAM_CHANGING_PERMEABILITY, "permeability")                                                                         \
  X(LAM_CHANGING_REFLECTION, "reflection")
typedef enum { LAM_CHANGING(LAM_ENUM_ENTRY) LAM_CHANGING_COUNT } LamChanging;
LAM_EXPORT extern const char *const LamChangingNames[]; /* "lamella", ... */
#define LAM_CHANGING_OF_PARAMETER(k) ((LamChanging)(LAM_CHANGING_WALLS + 1 + (k)))

/* Water transport through the cell membranes; pressures in C1 + C2. */
typedef struct {
  PetscReal permeability; /* Lp (C1 + C2) / apothem, 1/s; infinite: water is always in equilibrium */
  PetscReal activation;   /* activation energy of Lp, J/mol, relative to the initial temperature */
  PetscReal reflection;   /* sigma */
  PetscReal osmotic;      /* initial pi of the cells; NaN: in equilibrium with turgor and surroundings */
  PetscReal non_osmotic;  /* non-solution fraction of the initial lumen volume */
} LamWaterSpec;

/* Where water enters or leaves a body. */
typedef struct {
  LamScenePlace place;      /* of `on` */
  char on[LAM_NAME_LENGTH]; /* as that of a LamBoundary */
  PetscReal conductance;    /* of a skin, (C1 + C2) / apothem, 1/s; infinite: there is none */
} LamSurface;

/* Transport of water in a body: fluxes per reference area, down gradients of the water potential in the reference. */
typedef struct {
  PetscBool given;        /* otherwise each cell exchanges water with the surroundings directly */
  PetscReal apoplast;     /* conductivity, (C1 + C2) / macro length^2, 1/s; infinite: as if not `given` */
  PetscReal cell_to_cell; /* likewise */
  PetscInt surface_count; /* sides that are not sealed */
  LamSurface surface[LAM_MAX_BOUNDARIES];
} LamTransportSpec;

/* The surroundings at a time: linear between entries, constant outside; two entries at one time are a jump. */
typedef struct {
  PetscReal time;        /* s */
  PetscReal temperature; /* K */
  PetscReal outside;     /* osmotic pressure outside the cells, C1 + C2 */
  PetscReal turgor;      /* of cells without a water balance, C1 + C2 */
} LamSurroundings;

/* A leg of the load program: the prescribed values change linearly to these. */
typedef struct {
  PetscReal duration;       /* s; 0: a jump */
  PetscReal output;         /* s; interval between outputs in this leg; 0: that of the process */
  PetscReal F[9];           /* relative to the inflated state; an initial guess where P is given */
  LamStressControl control; /* P: per LamProcessSpec.area */
  PetscReal load;           /* body: load parameter at the end of the leg */
} LamProcessLeg;

/* Tissue that changes in time. */
typedef struct {
  PetscReal duration, output; /* s; output: interval between outputs */
  PetscReal tolerance;        /* relative tolerance of the time integration */
  PetscBool inflate;          /* the program is relative to the tissue that is stress-free under its turgor, ... */
  LamArea area;               /* ... and its P is per this area */
  PetscBool has_water;
  LamWaterSpec water;
  LamTransportSpec transport;
  LamKinetics kinetics[LAM_CHANGING_COUNT]; /* these own their tables */
  PetscInt surroundings_count;              /* at least 1 */
  LamSurroundings *surroundings;            /* owned */
  PetscInt leg_count, repeat;               /* leg_count 0: stress-free */
  LamProcessLeg *legs;                      /* owned; run `repeat` times, then held constant */
  PetscReal opening;                        /* event: increase of the opening volume over V0 since the start */
} LamProcessSpec;

/* A file that a scene names. */
typedef struct {
  char *name;                 /* as in the scene; owned */
  char *path;                 /* as it is opened; owned */
  char hash[LAM_HASH_LENGTH]; /* of its content when the scene was read; empty: it could not be read */
} LamSceneFile;

/* A scene: plain data, read-only after LamSceneRead. Blocks absent from the file have count 0 or PETSC_FALSE. */
typedef struct {
  char path[PETSC_MAX_PATH_LEN];
  char *text; /* the file's text, for provenance; owned */
  PetscInt file_count;
  LamSceneFile *files; /* mesh, tissues, tables: all that it names; owned */
  PetscInt warning_count;
  char **warnings; /* what is accepted and probably a mistake, in the form of LamSceneRead's messages; owned */
  LamScales scales;
  LamMicrostructure micro;
  PetscReal turgor;             /* default turgor of a load; in C1 + C2 */
  LamScenePlace turgor_place;   /* of rve.turgor.pressure */
  PetscBool sealed;             /* the cells keep the water that they contain at F = I with this turgor, ... */
  PetscReal water_bulk_modulus; /* ... with this bulk modulus, C1 + C2 */
  PetscReal cohesion;           /* as turgor */
  LamStrategy strategy;         /* how contact is reached */
  PetscReal tolerance;          /* of the Newton iterations of an RVE; 0: rounding */
  LamStrength strength;
  PetscReal accuracy;                /* requested relative error of the effective stress */
  char tissue[PETSC_MAX_PATH_LEN];   /* file of its cells; empty: hexagons */
  char measured[PETSC_MAX_PATH_LEN]; /* mesh measurements by `tradeoff` for this tissue; empty: not given */
  PetscInt load_count;
  LamLoad *loads;             /* states 1..load_count with ramps expanded; owned */
  LamStressControl *controls; /* of the loads; NULL: F is given in all of them; owned */
  PetscBool out_of_plane;     /* one of them has a shear out of the plane */
  PetscInt dissipating;       /* number of the last loads, a ramp that is followed by what is dissipated; 0: none */
  PetscReal dissipated_faces; /* in each of its states */
  PetscBool inflate;          /* the first load is P = 0, in the plane; F of the others counts from there, ... */
  LamArea area;               /* ... and their P is per this area */
  PetscBool has_sample;
  LamSample sample;
  PetscBool has_macro;
  LamMacroSpec macro;
  PetscInt region_count;
  LamRegion *regions;     /* of the body; owned */
  LamTissueFields fields; /* of the body; owned */
  LamResponsePolicy response;
  PetscBool has_process;
  LamProcessSpec process;
  PetscBool has_map;
  LamMapAxis map[LAM_MAP_AXIS_COUNT]; /* at most one is a load quantity */
} LamScene;

/* True if water moves through the body: it has a path, in the apoplast by membranes that let it pass. */
LAM_EXPORT PetscBool LamTransportHasPotentials(const LamScene *scene);
/* True if the law of any wall in the scene has the parameter. */
LAM_EXPORT PetscBool LamSceneHasParameter(const LamScene *scene, PetscInt parameter);
/* True if the property belongs to a wall law that no wall of the scene has. */
LAM_EXPORT PetscBool LamSceneLacksChanging(const LamScene *scene, LamChanging changing);
#define LAM_PLACE_TEXT 160
/* Writes "scene.yaml:12:7", the beginning of a message, to `text`, and returns it. */
LAM_EXPORT const char *LamScenePlaceText(const LamScene *scene, const LamScenePlace *place, char text[LAM_PLACE_TEXT]);
/* The factor of a history at a load parameter. */
LAM_EXPORT PetscReal LamHistoryFactor(const LamHistory *history, PetscReal parameter);
/* True if two histories have equal factors at all parameters. */
LAM_EXPORT PetscBool LamHistoriesAgree(const LamHistory *one, const LamHistory *other);
/* The load parameter at the end of load step 0 (the start) to spec->steps. */
LAM_EXPORT PetscReal LamMacroParameter(const LamMacroSpec *spec, PetscInt step);

/*
  Reads and checks a scene file. Invalid input is PETSC_ERR_USER_INPUT with a message
    "file:line:column: key: value: what is wrong; what would be right".
*/
LAM_EXPORT PetscErrorCode LamSceneRead(const char path[], LamScene **scene);
/* The files that it names, a line "HASH NAME" each. The caller frees the text. */
LAM_EXPORT PetscErrorCode LamSceneDescribeFiles(const LamScene *scene, char **text);
/* As LamSceneRead, from text; `name` is the file name in messages. */
LAM_EXPORT PetscErrorCode LamSceneReadText(const char name[], const char text[], LamScene **scene);
LAM_EXPORT PetscErrorCode LamSceneDestroy(LamScene **scene);

/* The load that follows a state at F = before: that F is the initial guess of free components, and the start of
   those that are interpolated. control may be NULL. */
LAM_EXPORT LamLoad LamLoadAfter(const LamLoad *load, const LamStressControl *control, const PetscReal before[9]);

/* Writes the scene reference (Markdown), generated from the reader's table of keys. */
LAM_EXPORT PetscErrorCode LamSceneReference(FILE *out);

/* Physical dimensions in scene files and on the command line. */
typedef enum {
  LAM_DIMENSION_LENGTH,
  LAM_DIMENSION_STRESS,
  LAM_DIMENSION_ANGLE,
  LAM_DIMENSION_TIME,
  LAM_DIMENSION_TEMPERATURE,
  LAM_DIMENSION_RATE,
  LAM_DIMENSION_MOLAR_ENERGY,
  LAM_DIMENSION_PERMEABILITY,
  LAM_DIMENSION_AREAL_ENERGY,
  LAM_DIMENSION_STIFFNESS,
  LAM_DIMENSION_CONDUCTIVITY,
  LAM_DIMENSION_COUNT
} LamDimension;

/*
  Converts text such as "0.02 MPa" to SI (m, Pa, rad, s, K, 1/s, J/mol, m/s/Pa, J/m2, Pa/m, m2/s/Pa).
  PETSC_ERR_USER_INPUT, with the reason, if the unit is missing, unknown or of another dimension, or the number is not
  finite.
*/
LAM_EXPORT PetscErrorCode LamQuantityParse(const char text[], LamDimension dimension, PetscReal *si);

LAM_C_END

#endif
