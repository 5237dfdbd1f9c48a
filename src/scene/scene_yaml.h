/*
  Private to scene reading: a YAML document as a tree of nodes with positions.

  Anchors and aliases are resolved (an alias becomes a copy at the position of the alias); tags, multiple documents
  and keys that are not plain words are rejected.
*/
#ifndef LAM_SCENE_YAML_H
#define LAM_SCENE_YAML_H

#include <lamella/scene.h>

typedef enum { LAM_NODE_SCALAR, LAM_NODE_MAP, LAM_NODE_LIST } LamNodeKind;

#define LAM_VALUE_SIZE 9

/* The value of a node, set by the scene reader. */
typedef struct {
  PetscInt count;
  PetscReal number[LAM_VALUE_SIZE];  /* SI; index of a name; 0 or 1 for a truth value */
  PetscBool is_free[LAM_VALUE_SIZE]; /* the component was left open */
} LamValue;

struct LamKey_s;

typedef struct LamNode_s LamNode;
typedef struct LamDocument_s LamDocument;
struct LamNode_s {
  const LamDocument *document;
  LamNodeKind kind;
  int line, column;  /* of the value, from 1 */
  char *text;        /* text of a scalar; otherwise the shortened text of the value in the file, or NULL */
  PetscBool is_null; /* a scalar without text, or the plain words null and ~ */
  char *name;        /* key, if the node is an entry of a map; else NULL */
  int name_line, name_column;
  PetscInt index; /* of an item of a list from 1, else 0; in messages and keys of `uncertain` from 0 */
  PetscInt count; /* number of entries of a map or items of a list */
  LamNode *parent, *first, *last, *next;
  LamNode *allocated; /* the node allocated before this one */
  char *anchor;       /* its YAML anchor, or NULL */
  LamNode *anchored;  /* previous node with an anchor, if this one has an anchor */
  /* set by the scene reader */
  const struct LamKey_s *key;
  LamValue value;
};

struct LamDocument_s {
  const char *name; /* borrowed: name of the file in messages */
  const char *text; /* borrowed */
  LamNode *root;
  LamNode *allocated; /* the newest node; the document owns them all */
  LamNode *anchored;  /* the newest one with an anchor */
  PetscInt node_count;
};

/* Parses text. The document must be destroyed even after an error. */
PetscErrorCode LamDocumentParse(const char name[], const char text[], LamDocument *document);
PetscErrorCode LamDocumentDestroy(LamDocument *document);

/* An entry of a map, or NULL; `map` may be NULL. */
LamNode *LamNodeEntry(const LamNode *map, const char name[], size_t length);
/* The node at a path of keys below `base`, such as "cell.apothem"; NULL: not found. */
const LamNode *LamNodeFind(const LamNode *base, const char path[]);

static inline LamScenePlace LamNodePlace(const LamNode *node)
{
  return (LamScenePlace){node->line, node->column};
}

/* Raises PETSC_ERR_USER_INPUT with the message "file:line:column: key: value: ...". */
typedef enum {
  LAM_MISTAKE_VALUE,  /* position and text of the node's value */
  LAM_MISTAKE_NAME,   /* position of its key */
  LAM_MISTAKE_MISSING /* a key that is missing in the map `node` */
} LamMistake;
PetscErrorCode LamSceneRaise(const LamNode *node, LamMistake mistake, const char key[], const char format[], ...)
    PETSC_ATTRIBUTE_FORMAT(4, 5);

/* Adds the same message to the warnings of the scene. */
PetscErrorCode LamSceneWarn(LamScene *scene, const LamNode *node, LamMistake mistake, const char key[],
                            const char format[], ...) PETSC_ATTRIBUTE_FORMAT(5, 6);

/* PetscCheck for scenes: if the condition is false the message refers to the value, to the key, or to a missing key. */
#define LamSceneUnless(condition, ...)                                                                                 \
  do {                                                                                                                 \
    if (!(condition)) PetscCall(LamSceneRaise(__VA_ARGS__));                                                           \
  } while (0)
#define LamSceneCheck(condition, node, ...) LamSceneUnless(condition, node, LAM_MISTAKE_VALUE, NULL, __VA_ARGS__)
#define LamSceneCheckName(condition, node, ...) LamSceneUnless(condition, node, LAM_MISTAKE_NAME, NULL, __VA_ARGS__)
#define LamSceneRequire(condition, node, ...) LamSceneUnless(condition, node, LAM_MISTAKE_MISSING, __VA_ARGS__)

#endif
