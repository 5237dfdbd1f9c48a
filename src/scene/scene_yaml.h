/*
  Private to scene reading: a YAML document as a tree of nodes that know where they stand.

  Anchors and aliases are resolved (an alias becomes a copy that stands where the alias does); tags, several documents
  and keys that are not plain words are refused.
*/
#ifndef LAM_SCENE_YAML_H
#define LAM_SCENE_YAML_H

#include <lamella/scene.h>

typedef enum { LAM_NODE_SCALAR, LAM_NODE_MAP, LAM_NODE_LIST } LamNodeKind;

#define LAM_VALUE_SIZE 9

/* What the scene reader makes of a node. */
typedef struct {
  PetscInt count;
  PetscReal number[LAM_VALUE_SIZE];  /* SI; the index of a name; 0 or 1 of a truth value */
  PetscBool is_free[LAM_VALUE_SIZE]; /* the component was left open */
} LamValue;

struct LamKey_s;

typedef struct LamNode_s LamNode;
typedef struct LamDocument_s LamDocument;
struct LamNode_s {
  const LamDocument *document;
  LamNodeKind kind;
  int line, column;  /* of the value, from 1 */
  char *text;        /* a scalar's text; else how the value looks in the file, shortened, or NULL */
  PetscBool is_null; /* a scalar without text, or the plain words null and ~ */
  char *name;        /* a map's entry: its key; else NULL */
  int name_line, name_column;
  PetscInt index; /* a list's item: from 1; else 0 */
  PetscInt count; /* of a map's entries or a list's items */
  LamNode *parent, *first, *last, *next;
  LamNode *allocated; /* the node allocated before this one */
  char *anchor;       /* its YAML anchor, or NULL */
  LamNode *anchored;  /* of one with an anchor: that with an anchor before it */
  /* set by the scene reader */
  const struct LamKey_s *key;
  LamValue value;
};

struct LamDocument_s {
  const char *name; /* borrowed: what messages call the file */
  const char *text; /* borrowed */
  LamNode *root;
  LamNode *allocated; /* the newest node; the document owns them all */
  LamNode *anchored;  /* the newest one with an anchor */
  PetscInt node_count;
};

/* Parses text. The document must be destroyed also after an error. */
PetscErrorCode LamDocumentParse(const char name[], const char text[], LamDocument *document);
PetscErrorCode LamDocumentDestroy(LamDocument *document);

/* A map's entry or NULL; `map` may be NULL. */
LamNode *LamNodeEntry(const LamNode *map, const char name[], size_t length);
/* What stands at a path of keys below `base`, such as "cell.apothem"; NULL where there is nothing. */
const LamNode *LamNodeFind(const LamNode *base, const char path[]);

/* Raises PETSC_ERR_USER_INPUT with the message "file:line:column: key: value: ...". */
typedef enum {
  LAM_MISTAKE_VALUE,  /* points at the node's value and shows it */
  LAM_MISTAKE_NAME,   /* points at its key */
  LAM_MISTAKE_MISSING /* of a key that the map `node` lacks */
} LamMistake;
PetscErrorCode LamSceneRaise(const LamNode *node, LamMistake mistake, const char key[], const char format[], ...)
    PETSC_ATTRIBUTE_FORMAT(4, 5);

/* PetscCheck for scenes: unless the condition holds the message points at the value, at the key, or says what lacks. */
#define LamSceneUnless(condition, ...)                                                                                 \
  do {                                                                                                                 \
    if (!(condition)) PetscCall(LamSceneRaise(__VA_ARGS__));                                                           \
  } while (0)
#define LamSceneCheck(condition, node, ...) LamSceneUnless(condition, node, LAM_MISTAKE_VALUE, NULL, __VA_ARGS__)
#define LamSceneCheckName(condition, node, ...) LamSceneUnless(condition, node, LAM_MISTAKE_NAME, NULL, __VA_ARGS__)
#define LamSceneRequire(condition, node, ...) LamSceneUnless(condition, node, LAM_MISTAKE_MISSING, __VA_ARGS__)

#endif
