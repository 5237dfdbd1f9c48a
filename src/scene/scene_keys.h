/*
  Private to scene reading: the tables of keys. One row per key says everything about it, also to which member of which
  struct its value goes; the reader, the messages and the scene reference (docs/reference/scene.md) follow the rows.

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

typedef enum {
  LAM_KEY_MAP,
  LAM_KEY_LIST,
  LAM_KEY_QUANTITY, /* a number with a unit */
  LAM_KEY_REAL,
  LAM_KEY_INTEGER,
  LAM_KEY_NAME, /* one of a few names */
  LAM_KEY_BOOL,
  LAM_KEY_TEXT,           /* the node's text is the value */
  LAM_KEY_PATH,           /* likewise, of a file; relative to the scene's folder */
  LAM_KEY_TENSOR,         /* 2x2 or 3x3 plain numbers; kept as 3x3 */
  LAM_KEY_QUANTITY_TENSOR /* likewise, each with a unit; 2x2: the others are left open */
} LamKeyType;

typedef struct {
  enum { LAM_BOUND_NONE, LAM_BOUND_INCLUDED, LAM_BOUND_EXCLUDED } kind;
  PetscReal value; /* in the key's unit */
} LamBound;

/* Whether a number, in the unit of the bounds, lies between them. */
PetscBool LamBoundsHold(const LamBound *lower, const LamBound *upper, PetscReal number);
const char *LamBoundWords(const LamBound *bound, PetscBool lower); /* "larger than" */

typedef struct LamKey_s {
  const char *path; /* "rve.wall.C1"; an item of a list is "load[]", what it holds "load[].F" */
  LamKeyType type;
  PetscInt size; /* components of a vector; 0: a single value */
  LamDimension dimension;
  const char *unit;      /* of a quantity, in messages, bounds and the reference */
  LamBound lower, upper; /* of each component */
  const char *const *names;
  PetscInt name_count;
  const char *record;        /* type of the struct that the value goes to, ... */
  size_t offset, room;       /* ... its place there; NULL: the block's own code reads the node */
  size_t given;              /* PetscBools there, PETSC_FALSE for components that are left free; 0: none */
  PetscBool required;        /* wherever the map it belongs to is given */
  const char *free_word;     /* leaves a component open; NULL: none may be */
  const char *default_value; /* as one would write it; NULL: none */
  const char *default_words; /* a default that depends on other keys, in words */
  const char *example;       /* of what is no name or truth value: messages list those */
  const char *help;          /* Markdown, without | */
} LamKey;

/* The keys of a block, or of a part of one, as its file lists them. */
typedef struct {
  const LamKey *key;
  PetscInt count;
} LamKeyTable;

extern const LamKeyTable LamCellKeys, LamWallKeys, LamVariationKeys, LamTissueKeys, LamStrengthKeys, LamLoadKeys,
    LamSampleKeys, LamMeshKeys, LamBoundaryKeys, LamProgramKeys, LamResponseKeys, LamRegionKeys, LamMapKeys,
    LamProcessKeys;

/* Key i = 0, 1, ... of all tables; NULL after the last one. */
const LamKey *LamKeyAt(PetscInt i);
const LamKey *LamKeyFind(const char path[]); /* NULL where there is none */
PetscBool LamKeyIsChild(const LamKey *key, const LamKey *map);
const char *LamKeyName(const LamKey *key); /* the last part of its path */

#define LAM_KEY_TEXT_LENGTH 400
/* "larger than 0 MPa", "" without bounds. */
void LamKeyBoundsText(const LamKey *key, char text[LAM_KEY_TEXT_LENGTH]);
/* What to write: "a stress with its unit larger than 0 MPa, such as 0.1 MPa"; of one component where single is set. */
void LamKeyExpectation(const LamKey *key, PetscBool single, char text[LAM_KEY_TEXT_LENGTH]);

/* Checks the whole document against the tables and sets every node's key and value. */
PetscErrorCode LamSceneCheckKeys(LamDocument *document);
/* The same of one node and all that it holds. */
PetscErrorCode LamSceneReadNode(LamNode *node, const LamKey *key);

/*
  Stores the values of all keys of a struct's type, nondimensional, in *target, which the macro checks to be of that
  type. `base` is the node that they are read from: a block or an item of a list. Where the file does not give a key its
  default is stored; without default the member stays as it is.
*/
#define LamSceneFill(base, scales, type, target) LamSceneFillRecord(base, scales, #type, 1 ? (target) : (type *)NULL)
PetscErrorCode LamSceneFillRecord(const LamNode *base, const LamScales *scales, const char record[], void *target);

#define LAM_BONDED_PARTS "contradicts law: bonded, whose cells never part; leave it out"

/* The value of a key: where it is given, *node is its place; else *node is NULL and the value the default. */
PetscErrorCode LamSceneGet(const LamNode *base, const char path[], const LamNode **node, LamValue *value);

/* The parts of a scene, in this order. */
PetscErrorCode LamSceneBuildRVE(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildStrength(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildLoad(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildSample(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildMacro(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildResponse(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildRegions(const LamNode *root, LamScene *scene);
/* scene_boundary.c, part of the block `macro`. */
PetscErrorCode LamSceneBuildBoundaries(const LamNode *root, LamScene *scene);
/* Refuses a name that is no side of a box or disc. `side` is its number, -1 of a Gmsh file. */
PetscErrorCode LamSceneCheckSide(const LamNode *on, const LamMacroSpec *spec, PetscInt *side);
PetscErrorCode LamSceneBuildMap(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneBuildProcess(const LamNode *root, LamScene *scene);
PetscErrorCode LamSceneDestroyProcess(LamScene *scene);
PetscErrorCode LamSceneDestroyRegions(LamScene *scene);

/* scene_cells.c, part of the RVE: what differs from cell to cell. */
PetscErrorCode LamSceneBuildCells(const LamNode *root, LamScene *scene);
/* Refuses a clearance, which is at the node, that leaves a cell no lumen. */
PetscErrorCode LamSceneCheckClearance(const LamNode *node, const LamScales *scales, const LamMicrostructure *micro);
/* Whether nothing but a cohesion holds cells of the tissue: those at the free sides of a patch in contact. */
PetscBool LamSceneNeedsCohesion(const LamMicrostructure *micro);
/* What a patch allows in the rest of a scene that is built. */
PetscErrorCode LamSceneCheckPatch(const LamNode *root, LamScene *scene);
/*
  The wall of a map. What is not given is that of `own`, its bulk modulus in proportion to C1 + C2; NULL: as the table
  of keys says.
*/
PetscErrorCode LamSceneReadWall(const LamNode *map, const LamScales *scales, const LamWall *own, LamWall *wall);
/* Refuses an F that is no deformation gradient of plane strain, where its components are given. */
PetscErrorCode LamSceneCheckF(const LamNode *node);
/* The control that the tensors of an entry say (P_node NULL: F alone), stresses over `scale`; refused where a component
   has neither or both of F and P, or the tissue can rotate. */
PetscErrorCode LamSceneReadControl(const LamNode *F_node, const LamNode *P_node, PetscReal scale,
                                   LamStressControl *control);
/* Step 1..steps of a ramp: prescribed stresses go straight from those before (0 where there was none), and F follows
   the state before where it was free there. */
void LamSceneRampControl(const LamStressControl *from, const LamStressControl *to, PetscInt step, PetscInt steps,
                         LamStressControl *control);

/* Of a text that names a file: a path in the file is relative to the scene's folder. */
PetscErrorCode LamSceneResolvePath(const LamNode *node, char path[PETSC_MAX_PATH_LEN]);
/* si / scale; refused where the ratio is beyond what doubles hold beside others. node may be NULL (a default: always
 * finite). */
PetscErrorCode LamSceneScale(const LamNode *node, PetscReal si, PetscReal scale, PetscReal *number);
/* Refuses an apothem, C1 + C2 or length of a body, in SI, that is beyond what doubles hold the squares and products of.
 */
PetscErrorCode LamSceneCheckScale(const LamNode *node, PetscReal si);
/* A turgor of the node's own (not the scene's) contradicts an explicit mode: none. */
PetscErrorCode LamSceneCheckTurgor(const LamNode *node, PetscReal turgor);

#endif
