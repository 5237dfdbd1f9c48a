/*
  Private to scene reading: the tables of keys. One row per key contains everything about it, including the struct
  member that stores its value; the reader, the messages and the scene reference (docs/reference/scene.md) use the
  rows.

  A new key is one row in the file of its block.
*/
#ifndef LAM_SCENE_KEYS_H
#define LAM_SCENE_KEYS_H

#include "scene_yaml.h"

#define LAM_TURGOR_MODES(X)                                                                                            \
  X(LAM_TURGOR_NONE, "none")                                                                                           \
  X(LAM_TURGOR_PRESCRIBED, "prescribed")                                                                               \
  X(LAM_TURGOR_SEALED, "sealed")
#define LAM_SIDES(X)                                                                                                   \
  X(LAM_BOX_LEFT, "left")                                                                                              \
  X(LAM_BOX_RIGHT, "right")                                                                                            \
  X(LAM_BOX_BOTTOM, "bottom")                                                                                          \
  X(LAM_BOX_TOP, "top")

typedef enum { LAM_TURGOR_MODES(LAM_ENUM_ENTRY) LAM_TURGOR_MODE_COUNT } LamTurgorMode;
typedef enum { LAM_SIDES(LAM_ENUM_ENTRY) LAM_BOX_COUNT } LamSide;

/* Types of keys: what the reference calls a value, and what a message asks for where the key has no unit. A name is one
   of a few; a text is the node's; a path is a text relative to the scene's folder; tensors are kept as 3x3, and of a
   2x2 one with units the other components are left open. */
#define LAM_KEY_TYPES(X)                                                                                               \
  X(MAP, "map", "keys and values")                                                                                     \
  X(LIST, "list", "a list")                                                                                            \
  X(QUANTITY, "", "")                                                                                                  \
  X(REAL, "number", "a plain number")                                                                                  \
  X(INTEGER, "whole number", "a whole number")                                                                         \
  X(NAME, "", "")                                                                                                      \
  X(BOOL, "true or false", "true or false")                                                                            \
  X(TEXT, "text", "a text")                                                                                            \
  X(PATH, "text", "a text")                                                                                            \
  X(TENSOR, "2x2 or 3x3 numbers", "a plain number")                                                                    \
  X(QUANTITY_TENSOR, "2x2 or 3x3 stresses", "")
#define LAM_KEY_TYPE_ENTRY(type, word, phrase) LAM_KEY_##type,
typedef enum { LAM_KEY_TYPES(LAM_KEY_TYPE_ENTRY) } LamKeyType;

typedef struct {
  enum { LAM_BOUND_NONE, LAM_BOUND_INCLUDED, LAM_BOUND_EXCLUDED } kind;
  PetscReal value; /* in the key's unit */
} LamBound;

/* True if a number, in the unit of the bounds, lies between them. */
PetscBool LamBoundsHold(const LamBound *lower, const LamBound *upper, PetscReal number);
const char *LamBoundWords(const LamBound *bound, PetscBool lower); /* "larger than" */

typedef struct LamKey_s {
  const char *path; /* "rve.wall.C1"; an item of a list is "load[]", a key in it "load[].F" */
  LamKeyType type;
  PetscInt size; /* components of a vector; 0: a single value */
  LamDimension dimension;
  const char *unit;      /* of a quantity, in messages, bounds and the reference */
  LamBound lower, upper; /* of each component */
  const char *const *names;
  PetscInt name_count;
  const char *record;        /* type of the struct that stores the value, ... */
  size_t offset, room;       /* ... offset and size of the member; NULL: the block's own code reads the node */
  size_t given;              /* offset of PetscBools, PETSC_FALSE for components that are left free; 0: none */
  PetscBool required;        /* required if its map is given */
  const char *free_word;     /* the word for an open component; NULL: none may be open */
  const char *default_value; /* as written in a file; NULL: none */
  const char *default_words; /* description of a default that depends on other keys */
  const char *example;       /* messages list names and truth values instead */
  const char *help;          /* Markdown, without | */
} LamKey;

/* The keys of a block or of a part of it, in the order of its file. */
typedef struct {
  const LamKey *key;
  PetscInt count;
} LamKeyTable;

extern const LamKeyTable LamCellKeys, LamWallKeys, LamVariationKeys, LamInterfaceKeys, LamLamellaKeys, LamTissueKeys,
    LamStrengthKeys, LamLoadKeys, LamSampleKeys, LamMeshKeys, LamBoundaryKeys, LamProgramKeys, LamResponseKeys,
    LamRegionKeys, LamMapKeys, LamProcessKeys, LamTransportKeys, LamUncertainKeys;

/* Key i = 0, 1, ... of all tables; NULL after the last one. */
const LamKey *LamKeyAt(PetscInt i);
const LamKey *LamKeyFind(const char path[]); /* NULL: not found */
PetscBool LamKeyIsChild(const LamKey *key, const LamKey *map);
const char *LamKeyName(const LamKey *key); /* the last part of its path */

#define LAM_KEY_TEXT_LENGTH 400
/* "larger than 0 MPa"; "" without bounds. */
void LamKeyBoundsText(const LamKey *key, char text[LAM_KEY_TEXT_LENGTH]);
/* Description of the expected value: "a stress with its unit larger than 0 MPa, such as 0.1 MPa"; of one component
   if single is set. */
void LamKeyExpectation(const LamKey *key, PetscBool single, char text[LAM_KEY_TEXT_LENGTH]);

/* Validates the whole document against the tables and sets every node's key and value. */
PetscErrorCode LamSceneCheckKeys(LamDocument *document);
/* The same for one node and its descendants. */
PetscErrorCode LamSceneReadNode(LamNode *node, const LamKey *key);

/*
  Stores the values of all keys of a struct type, nondimensional, in *target; the macro checks the type. `base` is the
  node from which they are read: a block or an item of a list. A key that is not in the file gets its default; without
  default the member is unchanged.
*/
#define LamSceneFill(base, scales, type, target) LamSceneFillRecord(base, scales, #type, 1 ? (target) : (type *)NULL)
PetscErrorCode LamSceneFillRecord(const LamNode *base, const LamScales *scales, const char record[], void *target);

/* Rejects a map without the key `path`, as if that were always required. */
PetscErrorCode LamSceneNeed(const LamNode *map, const char path[]);

#define LAM_NOT_LAMELLA "says nothing with law: %s; write law: lamella, or leave it out" /* LamInterfaceLawNames */
#define LAM_BONDED_PARTS "contradicts law: bonded, whose cells never part; leave it out"

/* The value of a key. If it is given *node is its node; otherwise *node is NULL and the value is the default. */
PetscErrorCode LamSceneGet(const LamNode *base, const char path[], const LamNode **node, LamValue *value);

/* The parts of a scene, in this order. */
PetscErrorCode LamSceneBuildRVE(const LamNode *root, LamScene *scene);
/* What cells with end walls cannot be yet; node: of their length. */
PetscErrorCode LamSceneCheckLength(const LamNode *node, const LamMicrostructure *micro);
/* Of walls that tear: sets the stiffness of cuts; the nodes of their energy and of the elements along a face. */
PetscErrorCode LamSceneCheckTearing(const LamNode *energy, const LamNode *along, LamMicrostructure *micro);
PetscErrorCode LamSceneBuildStrength(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildLoad(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildSample(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildMacro(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildResponse(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildRegions(const LamNode *root, LamScene *scene);
/* scene_boundary.c, part of the block `macro`. */
PetscErrorCode LamSceneBuildBoundaries(const LamNode *root, LamScene *scene);
/* Rejects a name that is not a side of a box or disc. `side` is its number, -1 for a Gmsh file. */
PetscErrorCode LamSceneCheckSide(const LamNode *on, const LamMacroSpec *spec, PetscInt *side);
PetscErrorCode LamSceneBuildMap(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneCheckUncertain(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildFiles(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildProcess(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneDestroyProcess(LamScene *scene);
/* scene_transport.c, part of the block `process`: after its water and surroundings. */
PetscErrorCode LamSceneBuildTransport(const LamNode *process, LamScene *scene);
#define LAM_SAME_TIME 1e-9 /* of the duration: above the rounding of a sum of times, below what anyone writes */
/* scene_process_doubts.c: warns of what a complete process accepts and nobody means. cycle: the time that the program
   takes once. */
PetscErrorCode LamSceneDoubtProcess(const LamNode *block, LamScene *scene, PetscReal cycle);
PetscErrorCode LamSceneDestroyRegions(LamScene *scene);
PetscErrorCode LamSceneDestroyFiles(LamScene *scene);

/* scene_tissue.c, part of the RVE: cells of a file (`rve.tissue`), with their number and the scale of lengths, before
   anything is nondimensional; then the thicknesses of their walls. Only with the key. */
typedef struct {
  PetscReal *thickness; /* [cell] m; NULL: the scene gives it; owned */
  PetscInt *class;      /* [cell] kind of variation; NULL: the file gives none; owned */
} LamSceneTissue;
PetscErrorCode LamSceneReadTissue(const LamNode *root, LamScene *scene, LamSceneTissue *tissue);
/* Of a region, for its cells; nothing without a file of its own. */
PetscErrorCode LamSceneReadRegionTissue(const LamNode *entry, LamRegion *region, LamSceneTissue *tissue);
/* The mean thickness of walls; node: of the file, or NULL. */
PetscErrorCode LamSceneBuildTissue(const LamNode *node, const LamSceneTissue *tissue, const LamScales *scales,
                                   LamMicrostructure *micro);
PetscErrorCode LamSceneDestroyTissue(LamSceneTissue *tissue);

/* scene_cells.c, part of the RVE: variation between cells, and those of a tissue file. */
#define LAM_MAX_CELLS 64 /* in one direction */
PetscErrorCode LamSceneBuildCells(const LamNode *root, const LamSceneTissue *tissue, LamScene *scene);
/* Gives each cell of a file its thickness (m), times what a field makes of the mean; cells that are alike have none. */
PetscErrorCode LamSceneSetThickness(const LamNode *node, const PetscReal thickness[], PetscReal length,
                                    LamMicrostructure *micro);
/* True if only cohesion holds some cells of the tissue: those at the free sides of a patch in contact. */
PetscBool LamSceneNeedsCohesion(const LamMicrostructure *micro);
/* Checks the rest of a complete scene for compatibility with a patch. */
PetscErrorCode LamSceneCheckPatch(const LamNode *root, LamScene *scene);

/* scene_interface.c, part of the RVE, after its cells. */
PetscErrorCode LamSceneBuildInterface(const LamNode *root, LamScene *scene);
/* Rejects a clearance, given at the node, that leaves a cell no lumen. */
PetscErrorCode LamSceneCheckClearance(const LamNode *node, const LamScales *scales, const LamMicrostructure *micro);
/* scene_lamella.c, part of the interface. */
PetscErrorCode LamSceneBuildLamella(const LamNode *interface, LamScene *scene);
/* Rejects keys of an interface, of rve or of a region, that its law does not have; interface may be NULL. */
PetscErrorCode LamSceneCheckLaw(const LamNode *interface, LamInterfaceLawType law);
/* Sets the default stiffness of a lamella, or rejects the `given` one (NULL: none); nodes for messages. */
PetscErrorCode LamSceneSetStiffness(const LamNode *given, const LamNode *energy, const LamScales *scales,
                                    LamMicrostructure *micro);

/*
  Reads the wall of a map. Missing values are those of `own`, with the bulk modulus in proportion to C1 + C2; `own`
  NULL: the defaults of the keys.
*/
PetscErrorCode LamSceneReadWall(const LamNode *map, const LamScales *scales, const LamWall *own, LamWall *wall);
/* Reads the relaxation of the walls, none where it is not given. */
PetscErrorCode LamSceneBuildRelaxation(const LamNode *root, LamRelaxation *relaxation);
/* Rejects a factor that takes a wall parameter beyond the upper bound of its key in some wall of the scene. */
PetscErrorCode LamSceneCheckFactor(const LamNode *node, const LamScene *scene, PetscInt parameter, PetscReal factor);
/* Rejects an F that is not a deformation gradient, if its components are given; any: shears out of the plane are
 * allowed.
 */
PetscErrorCode LamSceneCheckF(const LamNode *node, PetscBool any);
/* Reads the control from the tensors of an entry (P_node NULL: F alone), stresses over `scale`. Rejects components
   that have neither or both of F and P, and tissue that can rotate. */
PetscErrorCode LamSceneReadControl(const LamNode *F_node, const LamNode *P_node, PetscReal scale,
                                   LamStressControl *control);
/* Step 1..steps of a ramp: prescribed stresses change linearly from the previous ones (0 if there were none); F
   starts from the previous state in components that were free. */
void LamSceneRampControl(const LamStressControl *from, const LamStressControl *to, PetscInt step, PetscInt steps,
                         LamStressControl *control);

/* ---- scene_random.c: random numbers that are equal on all machines ---- */

/* Random permutation with uniform probability (Fisher and Yates). */
void LamRandomShuffle(PetscInt seed, PetscInt n, PetscInt values[]);

/*
  Lognormal factors with mean 1 and the coefficients of variation variation[properties], independent between
  properties: factors[property][cell] (row-major, all cells of `micro`). They are exp(s z - s^2/2), s^2 = ln(1 +
  variation^2), with z standard normal. correlation 0: z of all cells are independent. Otherwise white noise is
  weighted with exp(-2 (r/correlation)^2), r in neighbour distances, and scaled to unit variance, so that the
  correlation of z between two cells is about exp(-(r/correlation)^2); in a period the noise is periodic. Properties
  without variation have the factor 1 and do not affect the noise of the others.
*/
PetscErrorCode LamRandomFactors(const LamMicrostructure *micro, PetscInt seed, PetscReal correlation,
                                PetscInt properties, const PetscReal variation[], PetscReal factors[]);

/* ---- the rest ---- */

/* Resolves a file name: a path in the file is relative to the scene's folder. */
PetscErrorCode LamSceneResolvePath(const LamNode *node, char path[PETSC_MAX_PATH_LEN]);
/* si / scale; rejects ratios beyond the limits of double precision. node may be NULL for a default, which is always
   finite. */
PetscErrorCode LamSceneScale(const LamNode *node, PetscReal si, PetscReal scale, PetscReal *number);
/* Rejects an apothem, C1 + C2 or length of a body, in SI, whose squares and products exceed the range of doubles. */
PetscErrorCode LamSceneCheckScale(const LamNode *node, PetscReal si);
/* Rejects a turgor of the node's own (not the scene's) in contradiction to an explicit mode: none. */
PetscErrorCode LamSceneCheckTurgor(const LamNode *node, PetscReal turgor);

#endif
