/*
  Parses YAML text into a tree of nodes, from libfyaml's events: unlike its documents they contain the position of
  every node, and leave duplicate keys and depth to this code.
*/
#include "scene_yaml.h"
#include <libfyaml.h>
#include <string.h>

/* Scenes have few levels, and aliases can multiply nodes: a file beyond these limits is an accident or an attack. */
enum { MAX_DEPTH = 32, MAX_NODES = 400000, MAX_KEYS = 256, MAX_EXCERPT = 80 };

/* The parser with its current event. */
typedef struct {
  LamDocument *document;
  struct fy_parser *parser;
  struct fy_diag *diagnostics;
  struct fy_event *event; /* owned */
  int depth;              /* nesting depth of maps and lists */
} Reader;

static void NodeAppend(LamNode *parent, LamNode *node)
{
  node->parent = parent;
  if (parent->last)
    parent->last->next = node;
  else
    parent->first = node;
  parent->last = node;
  parent->count++;
  if (parent->kind == LAM_NODE_LIST) node->index = parent->count;
}

/* Creates an empty scalar at a position; appends it to its parent unless that is NULL. */
static PetscErrorCode NodeCreate(LamDocument *document, LamNode *parent, int line, int column, LamNode **node)
{
  PetscFunctionBeginUser;
  PetscCheck(document->node_count < MAX_NODES, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%.200s:%d:%d: more than %d values in one file; a scene is much smaller", document->name, line, column,
             (int)MAX_NODES);
  PetscCall(PetscNew(node));
  **node = (LamNode){.document = document,
                     .line = line,
                     .column = column,
                     .name_line = line,
                     .name_column = column,
                     .allocated = document->allocated};
  document->allocated = *node;
  document->node_count++;
  if (parent) NodeAppend(parent, *node);
  PetscFunctionReturn(0);
}

LamNode *LamNodeEntry(const LamNode *map, const char name[], size_t length)
{
  if (!map || map->kind != LAM_NODE_MAP) return NULL;
  for (LamNode *node = map->first; node; node = node->next) {
    if (strlen(node->name) == length && !strncmp(node->name, name, length)) return node;
  }
  return NULL;
}

const LamNode *LamNodeFind(const LamNode *base, const char path[])
{
  while (base && *path) {
    const size_t length = strcspn(path, ".");

    base = LamNodeEntry(base, path, length);
    path += length + (path[length] ? 1 : 0);
  }
  return base;
}

/*
  The text of a token; the caller frees it. In libfyaml 0.7 fy_token_get_text leaks memory for texts with many
  escapes, and fy_token_iter_read overwrites parts of a text, such as its lines, with each other.
*/
static PetscErrorCode TokenText(struct fy_token *token, char **text)
{
  const size_t room = fy_token_get_text_length(token);
  struct fy_token_iter *pieces = fy_token_iter_create(token);
  const struct fy_iter_chunk *piece = NULL;
  size_t length = 0;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCheck(pieces, PETSC_COMM_SELF, PETSC_ERR_MEM, "libfyaml gives no text");
  ierr = PetscMalloc1(room + 1, text);
  while (!ierr && (piece = fy_token_iter_chunk_next(pieces, piece, NULL))) {
    const size_t n = PetscMin(piece->len, room - length);

    memcpy(*text + length, piece->str, n);
    length += n;
  }
  fy_token_iter_destroy(pieces);
  PetscCall(ierr);
  (*text)[length] = '\0';
  PetscFunctionReturn(0);
}

/* The position of the current event without a node, for messages. */
static LamNode Place(const Reader *reader)
{
  const struct fy_mark *mark = fy_event_start_mark(reader->event);

  return (LamNode){
      .document = reader->document, .line = mark ? mark->line + 1 : 1, .column = mark ? mark->column + 1 : 1};
}

/* Advances to the next event, or raises libfyaml's error. */
static PetscErrorCode Next(Reader *reader)
{
  const struct fy_diag_error *error;
  void *previous = NULL;
  LamNode place = {.document = reader->document};

  PetscFunctionBeginUser;
  if (reader->event) fy_parser_event_free(reader->parser, reader->event);
  reader->event = fy_parser_parse(reader->parser);
  if (reader->event && !fy_diag_got_error(reader->diagnostics)) PetscFunctionReturn(0);
  error = fy_diag_errors_iterate(reader->diagnostics, &previous);
  place.line = error ? PetscMax(error->line, 1) : 1;
  place.column = error ? PetscMax(error->column, 1) : 1;
  LamSceneCheck(PETSC_FALSE, &place, "not YAML: %.200s; check brackets, quotes and indentation in this line and above",
                error && error->msg ? error->msg : "it cannot be read");
  PetscFunctionReturn(0);
}

/* Sets the position of a value, checks its tag, and stores its anchor name. */
static PetscErrorCode Start(Reader *reader, LamNode *node)
{
  const LamNode place = Place(reader);
  struct fy_token *anchor = fy_event_get_anchor_token(reader->event);

  PetscFunctionBeginUser;
  LamSceneCheck(!fy_event_get_tag_token(reader->event), &place, "YAML tags (!...) are not read; write the value alone");
  node->line = place.line;
  node->column = place.column;
  if (!anchor) PetscFunctionReturn(0);
  PetscCall(TokenText(anchor, &node->anchor));
  node->anchored = reader->document->anchored;
  reader->document->anchored = node;
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadScalar(Reader *reader, LamNode *node)
{
  struct fy_token *token = reader->event->scalar.value;
  const PetscBool empty = (PetscBool)(fy_token_get_text_length(token) == 0);

  PetscFunctionBeginUser;
  PetscCall(Start(reader, node));
  if (empty && node->name) { /* the token of a missing value has no position: use that of its key */
    node->line = node->name_line;
    node->column = node->name_column;
  }
  PetscCall(TokenText(token, &node->text));
  node->is_null = (PetscBool)(fy_token_scalar_style(token) == FYSS_PLAIN &&
                              (empty || !strcmp(node->text, "~") || !strcasecmp(node->text, "null")));
  PetscFunctionReturn(0);
}

/* Copies a node and its descendants to `copy`; all get the position of the alias. */
static PetscErrorCode NodeCopy(LamDocument *document, const LamNode *node, LamNode *copy)
{
  PetscFunctionBeginUser;
  copy->kind = node->kind;
  copy->is_null = node->is_null;
  if (node->text) PetscCall(PetscStrallocpy(node->text, &copy->text));
  for (const LamNode *child = node->first; child; child = child->next) {
    LamNode *child_copy;

    PetscCall(NodeCreate(document, copy, copy->line, copy->column, &child_copy));
    if (child->name) PetscCall(PetscStrallocpy(child->name, &child_copy->name));
    PetscCall(NodeCopy(document, child, child_copy));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadAlias(Reader *reader, LamNode *node)
{
  const LamNode place = Place(reader), *target = reader->document->anchored;
  char name[48], *text;

  PetscFunctionBeginUser;
  node->line = place.line;
  node->column = place.column;
  PetscCall(TokenText(reader->event->alias.anchor, &text));
  snprintf(name, sizeof(name), "%.40s", text);
  while (target && strcmp(target->anchor, text) != 0) target = target->anchored;
  PetscCall(PetscFree(text));
  for (const LamNode *outer = node->parent; outer; outer = outer->parent)
    if (outer == target) target = NULL; /* it would contain itself */
  LamSceneCheck(target, &place, "*%s: no finished value has the anchor &%s before this line", name, name);
  PetscCall(NodeCopy(reader->document, target, node));
  PetscFunctionReturn(0);
}

/* Reads a key of a map and creates the node of its value, still empty. */
static PetscErrorCode ReadKey(Reader *reader, LamNode *map, LamNode **entry)
{
  const struct fy_event *event = reader->event;
  const LamNode key = Place(reader);
  const LamNode *earlier;

  PetscFunctionBeginUser;
  LamSceneCheck(event->type != FYET_ALIAS, &key, "an alias stands where a key should");
  LamSceneCheck(event->type == FYET_SCALAR, &key, "a list or map stands where a key should; keys are plain words");
  LamSceneCheck(!event->scalar.tag, &key, "YAML tags (!...) are not read; write the key alone");
  PetscCall(NodeCreate(reader->document, NULL, key.line, key.column, entry));
  PetscCall(TokenText(event->scalar.value, &(*entry)->name));
  (*entry)->parent = map; /* for messages */
  LamSceneCheckName(strcmp((*entry)->name, "<<"), *entry, "merge keys are not read; write the keys out");
  earlier = LamNodeEntry(map, (*entry)->name, strlen((*entry)->name));
  LamSceneCheckName(!earlier, *entry, "given twice, first in line %d; give it once", earlier->name_line);
  LamSceneCheckName(map->count < MAX_KEYS, *entry, "more than %d keys in one map; a scene is much smaller",
                    (int)MAX_KEYS);
  NodeAppend(map, *entry);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadValue(Reader *reader, LamNode *node);

/* Reads a map or list; one in brackets keeps its text for messages. */
static PetscErrorCode ReadCollection(Reader *reader, LamNode *node)
{
  const enum fy_event_type end = node->kind == LAM_NODE_MAP ? FYET_MAPPING_END : FYET_SEQUENCE_END;
  const struct fy_mark *mark = fy_event_start_mark(reader->event);
  const size_t start = mark ? mark->input_pos : 0;
  const char *text = reader->document->text + start;
  const LamNode place = Place(reader);

  PetscFunctionBeginUser;
  LamSceneCheck(reader->depth++ < MAX_DEPTH, &place, "nested more than %d levels deep; a scene is much flatter",
                (int)MAX_DEPTH);
  PetscCall(Start(reader, node));
  PetscCall(Next(reader));
  while (reader->event->type != end) {
    LamNode *entry;

    if (node->kind == LAM_NODE_MAP) {
      PetscCall(ReadKey(reader, node, &entry));
      PetscCall(Next(reader));
    } else {
      PetscCall(NodeCreate(reader->document, node, 0, 0, &entry));
    }
    PetscCall(ReadValue(reader, entry));
    PetscCall(Next(reader));
  }
  reader->depth--;
  mark = fy_event_end_mark(reader->event);
  if (mark && mark->input_pos > start && strchr("[{", *text)) {
    const size_t length = PetscMin(PetscMin(mark->input_pos - start, strlen(text)), (size_t)MAX_EXCERPT);

    PetscCall(PetscCalloc1(length + 1, &node->text));
    PetscCall(PetscMemcpy(node->text, text, length));
  }
  PetscFunctionReturn(0);
}

/* Reads the value that begins at the current event. */
static PetscErrorCode ReadValue(Reader *reader, LamNode *node)
{
  const enum fy_event_type type = reader->event->type;

  PetscFunctionBeginUser;
  if (type == FYET_SCALAR) PetscCall(ReadScalar(reader, node));
  if (type == FYET_ALIAS) PetscCall(ReadAlias(reader, node));
  if (type == FYET_MAPPING_START || type == FYET_SEQUENCE_START) {
    node->kind = type == FYET_MAPPING_START ? LAM_NODE_MAP : LAM_NODE_LIST;
    PetscCall(ReadCollection(reader, node));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadDocument(Reader *reader)
{
  LamDocument *document = reader->document;

  PetscFunctionBeginUser;
  PetscCheck(!fy_parser_set_string(reader->parser, document->text, FY_NT), PETSC_COMM_SELF, PETSC_ERR_LIB,
             "libfyaml does not take the text");
  do {
    PetscCall(Next(reader));
    if (reader->event->type == FYET_DOCUMENT_START) {
      const LamNode place = Place(reader);

      LamSceneCheck(!document->root, &place, "a second YAML document starts here; a file holds one scene");
      PetscCall(NodeCreate(document, NULL, 1, 1, &document->root));
      PetscCall(Next(reader));
      PetscCall(ReadValue(reader, document->root));
    }
  } while (reader->event->type != FYET_STREAM_END);
  PetscFunctionReturn(0);
}

/* Suppresses libfyaml's output to stderr; the messages are also collected. */
static void DiscardOutput(struct fy_diag *diagnostics, void *user, const char *text, size_t length) {}

PetscErrorCode LamDocumentParse(const char name[], const char text[], LamDocument *document)
{
  Reader reader = {.document = document};
  struct fy_diag_cfg diagnostics_config;
  struct fy_parse_cfg config = {.flags = FYPCF_QUIET | FYPCF_COLLECT_DIAG | FYPCF_JSON_NONE};
  PetscErrorCode ierr = PETSC_ERR_MEM;

  PetscFunctionBeginUser;
  *document = (LamDocument){.name = name, .text = text};
  fy_diag_cfg_default(&diagnostics_config);
  diagnostics_config.fp = NULL;
  diagnostics_config.output_fn = DiscardOutput;
  config.diag = fy_diag_create(&diagnostics_config);
  PetscCheck(config.diag, PETSC_COMM_SELF, PETSC_ERR_MEM, "libfyaml: out of memory");
  fy_diag_set_collect_errors(config.diag, true);
  reader.diagnostics = config.diag;
  reader.parser = fy_parser_create(&config);
  if (reader.parser) ierr = ReadDocument(&reader);
  if (reader.event) fy_parser_event_free(reader.parser, reader.event);
  fy_parser_destroy(reader.parser);
  fy_diag_destroy(config.diag);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamDocumentDestroy(LamDocument *document)
{
  PetscFunctionBeginUser;
  for (LamNode *node = document->allocated; node;) {
    LamNode *next = node->allocated;
    PetscCall(PetscFree(node->text));
    PetscCall(PetscFree(node->name));
    PetscCall(PetscFree(node->anchor));
    PetscCall(PetscFree(node));
    node = next;
  }
  *document = (LamDocument){0};
  PetscFunctionReturn(0);
}
