/*
  YAML text to a tree of nodes, from libfyaml's events: unlike its documents they give every node's place, and leave
  duplicate keys and depth to be judged here.
*/
#include "scene_yaml.h"
#include <libfyaml.h>
#include <string.h>

/* A scene is a few levels deep and aliases may multiply: a file beyond these limits is an accident or an attack. */
enum { MAX_DEPTH = 32, MAX_NODES = 400000, MAX_KEYS = 256, MAX_EXCERPT = 80 };

typedef struct {
  LamDocument *document;
  LamNode *stack[MAX_DEPTH]; /* open maps and lists */
  size_t start[MAX_DEPTH];   /* where in the text they start */
  int depth;
  PetscInt documents;
  char *name; /* the key that was read last and waits for its value; owned until a node takes it */
  int name_line, name_column;
} Builder;

static PetscErrorCode NodeCreate(LamDocument *document, LamNodeKind kind, int line, int column, LamNode **node)
{
  PetscFunctionBeginUser;
  PetscCheck(document->node_count < MAX_NODES, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%.200s:%d:%d: more than %d values in one file; a scene is much smaller", document->name, line, column,
             (int)MAX_NODES);
  PetscCall(PetscNew(node));
  (*node)->document = document;
  (*node)->kind = kind;
  (*node)->line = line;
  (*node)->column = column;
  (*node)->allocated = document->allocated;
  document->allocated = *node;
  document->node_count++;
  PetscFunctionReturn(0);
}

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

static PetscErrorCode TextCopy(const char text[], size_t length, char **copy)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(length + 1, copy));
  PetscCall(PetscMemcpy(*copy, text, length));
  (*copy)[length] = '\0';
  PetscFunctionReturn(0);
}

/*
  The text of a token; the caller frees it. Of libfyaml 0.7 fy_token_get_text loses memory where a text has many escapes,
  and fy_token_iter_read writes the pieces of a text, such as its lines, over each other.
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

/* A place without a node yet, for messages. */
static LamNode Place(const LamDocument *document, struct fy_token *token)
{
  const struct fy_mark *mark = token ? fy_token_start_mark(token) : NULL;

  return (LamNode){.document = document, .line = mark ? mark->line + 1 : 1, .column = mark ? mark->column + 1 : 1};
}

/* Puts a node where the events have got to: the root, the next item of a list or the value of the waiting key. */
static PetscErrorCode BuilderPut(Builder *builder, LamNode *node)
{
  PetscFunctionBeginUser;
  if (builder->name) {
    node->name = builder->name;
    node->name_line = builder->name_line;
    node->name_column = builder->name_column;
    builder->name = NULL;
  }
  if (builder->depth)
    NodeAppend(builder->stack[builder->depth - 1], node);
  else
    builder->document->root = node;
  PetscFunctionReturn(0);
}

/* Is a key expected now? */
static PetscBool BuilderAtKey(const Builder *builder)
{
  return builder->depth && builder->stack[builder->depth - 1]->kind == LAM_NODE_MAP && !builder->name ? PETSC_TRUE
                                                                                                      : PETSC_FALSE;
}

static PetscErrorCode BuilderKey(Builder *builder, struct fy_token *token)
{
  LamNode *map = builder->stack[builder->depth - 1];
  LamNode key = Place(builder->document, token);
  const LamNode *earlier;

  PetscFunctionBeginUser;
  PetscCall(TokenText(token, &builder->name));
  builder->name_line = key.name_line = key.line;
  builder->name_column = key.name_column = key.column;
  key.name = builder->name;
  key.parent = map;
  LamSceneCheckName(strcmp(key.name, "<<"), &key, "merge keys are not read; write the keys out");
  earlier = LamNodeEntry(map, key.name, strlen(key.name));
  LamSceneCheckName(!earlier, &key, "given twice, first in line %d; give it once", earlier->name_line);
  LamSceneCheckName(map->count < MAX_KEYS, &key, "more than %d keys in one map; a scene is much smaller",
                    (int)MAX_KEYS);
  PetscFunctionReturn(0);
}

/* A node of the document, in its place; one with an anchor keeps its name. */
static PetscErrorCode BuilderAdd(Builder *builder, LamNodeKind kind, LamNode place, struct fy_token *tag,
                                 struct fy_token *anchor, LamNode **node)
{
  PetscFunctionBeginUser;
  LamSceneCheck(!tag, &place, "YAML tags (!...) are not read; write the value alone");
  PetscCall(NodeCreate(builder->document, kind, place.line, place.column, node));
  PetscCall(BuilderPut(builder, *node));
  if (!anchor) PetscFunctionReturn(0);
  PetscCall(TokenText(anchor, &(*node)->anchor));
  (*node)->anchored = builder->document->anchored;
  builder->document->anchored = *node;
  PetscFunctionReturn(0);
}

static PetscErrorCode BuilderScalar(Builder *builder, const struct fy_event *event)
{
  struct fy_token *token = event->scalar.value;
  const PetscBool empty = (PetscBool)(fy_token_get_text_length(token) == 0);
  LamNode place = Place(builder->document, token), *node;

  PetscFunctionBeginUser;
  if (BuilderAtKey(builder)) {
    LamSceneCheck(!event->scalar.tag, &place, "YAML tags (!...) are not read; write the key alone");
    PetscCall(BuilderKey(builder, token));
    PetscFunctionReturn(0);
  }
  /* where a value is left out its token has no place: it is missed at its key */
  if (empty && builder->name)
    place = (LamNode){.document = builder->document, .line = builder->name_line, .column = builder->name_column};
  PetscCall(BuilderAdd(builder, LAM_NODE_SCALAR, place, event->scalar.tag, event->scalar.anchor, &node));
  PetscCall(TokenText(token, &node->text));
  if (fy_token_scalar_style(token) == FYSS_PLAIN) {
    node->is_null = empty || !strcmp(node->text, "~") || !strcasecmp(node->text, "null") ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode BuilderOpen(Builder *builder, LamNodeKind kind, struct fy_token *token, struct fy_token *tag,
                                  struct fy_token *anchor)
{
  const struct fy_mark *mark = token ? fy_token_start_mark(token) : NULL;
  const LamNode place = Place(builder->document, token);
  LamNode *node;

  PetscFunctionBeginUser;
  LamSceneCheck(!BuilderAtKey(builder), &place, "a list or map stands where a key should; keys are plain words");
  LamSceneCheck(builder->depth < MAX_DEPTH, &place, "nested more than %d levels deep; a scene is much flatter",
                (int)MAX_DEPTH);
  PetscCall(BuilderAdd(builder, kind, place, tag, anchor, &node));
  builder->start[builder->depth] = mark ? mark->input_pos : 0;
  builder->stack[builder->depth++] = node;
  PetscFunctionReturn(0);
}

/* Closes a map or list; one written in brackets keeps its text for messages. */
static PetscErrorCode BuilderClose(Builder *builder, struct fy_token *token)
{
  const struct fy_mark *mark = token ? fy_token_end_mark(token) : NULL;
  const size_t start = builder->start[--builder->depth];
  LamNode *node = builder->stack[builder->depth];

  PetscFunctionBeginUser;
  if (mark && mark->input_pos > start && strchr("[{", builder->document->text[start])) {
    const char *text = builder->document->text + start;
    size_t length = PetscMin(PetscMin(mark->input_pos - start, strlen(text)), (size_t)MAX_EXCERPT);
    PetscCall(TextCopy(text, length, &node->text));
  }
  PetscFunctionReturn(0);
}

/* A copy of node and what is below it; all of it stands where the alias does. */
static PetscErrorCode NodeCopy(LamDocument *document, const LamNode *node, const LamNode *place, LamNode **copy)
{
  PetscFunctionBeginUser;
  PetscCall(NodeCreate(document, node->kind, place->line, place->column, copy));
  (*copy)->is_null = node->is_null;
  if (node->text) PetscCall(TextCopy(node->text, strlen(node->text), &(*copy)->text));
  for (const LamNode *child = node->first; child; child = child->next) {
    LamNode *child_copy;
    PetscCall(NodeCopy(document, child, place, &child_copy));
    if (child->name) PetscCall(TextCopy(child->name, strlen(child->name), &child_copy->name));
    child_copy->name_line = place->line;
    child_copy->name_column = place->column;
    NodeAppend(*copy, child_copy);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode BuilderAlias(Builder *builder, struct fy_token *token)
{
  const LamNode place = Place(builder->document, token);
  const LamNode *target = NULL;
  char name[48], *text;
  LamNode *copy;

  PetscFunctionBeginUser;
  LamSceneCheck(!BuilderAtKey(builder), &place, "an alias stands where a key should");
  PetscCall(TokenText(token, &text));
  snprintf(name, sizeof(name), "%.40s", text);
  for (LamNode *node = builder->document->anchored; node && !target; node = node->anchored)
    if (!strcmp(node->anchor, text)) target = node;
  PetscCall(PetscFree(text));
  for (int i = 0; i < builder->depth; i++) {
    if (builder->stack[i] == target) target = NULL; /* it would contain itself */
  }
  LamSceneCheck(target, &place, "*%s: no finished value has the anchor &%s before this line", name, name);
  PetscCall(NodeCopy(builder->document, target, &place, &copy));
  PetscCall(BuilderPut(builder, copy));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuilderEvent(Builder *builder, const struct fy_event *event)
{
  LamNode place;

  PetscFunctionBeginUser;
  switch (event->type) {
  case FYET_DOCUMENT_START:
    place = Place(builder->document, event->document_start.document_start);
    LamSceneCheck(!builder->documents++, &place, "a second YAML document starts here; a file holds one scene");
    break;
  case FYET_SCALAR:
    PetscCall(BuilderScalar(builder, event));
    break;
  case FYET_ALIAS:
    PetscCall(BuilderAlias(builder, event->alias.anchor));
    break;
  case FYET_MAPPING_START:
    PetscCall(BuilderOpen(builder, LAM_NODE_MAP, event->mapping_start.mapping_start, event->mapping_start.tag,
                          event->mapping_start.anchor));
    break;
  case FYET_SEQUENCE_START:
    PetscCall(BuilderOpen(builder, LAM_NODE_LIST, event->sequence_start.sequence_start, event->sequence_start.tag,
                          event->sequence_start.anchor));
    break;
  case FYET_MAPPING_END:
    PetscCall(BuilderClose(builder, event->mapping_end.mapping_end));
    break;
  case FYET_SEQUENCE_END:
    PetscCall(BuilderClose(builder, event->sequence_end.sequence_end));
    break;
  default:
    break;
  }
  PetscFunctionReturn(0);
}

/* Raises what libfyaml found wrong with the text. */
static PetscErrorCode RaiseSyntaxError(const LamDocument *document, struct fy_diag *diagnostics)
{
  void *previous = NULL;
  const struct fy_diag_error *error = fy_diag_errors_iterate(diagnostics, &previous);
  const LamNode place = {.document = document,
                         .line = error ? PetscMax(error->line, 1) : 1,
                         .column = error ? PetscMax(error->column, 1) : 1};

  PetscFunctionBeginUser;
  PetscCall(LamSceneRaise(&place, LAM_MISTAKE_VALUE, NULL,
                          "not YAML: %.200s; check brackets, quotes and indentation in this line",
                          error && error->msg ? error->msg : "it cannot be read"));
  PetscFunctionReturn(0);
}

static PetscErrorCode ParseEvents(Builder *builder, struct fy_parser *parser, struct fy_diag *diagnostics)
{
  PetscBool ended = PETSC_FALSE;
  struct fy_event *event;

  PetscFunctionBeginUser;
  PetscCheck(!fy_parser_set_string(parser, builder->document->text, FY_NT), PETSC_COMM_SELF, PETSC_ERR_LIB,
             "libfyaml does not take the text");
  while ((event = fy_parser_parse(parser))) {
    PetscErrorCode ierr = BuilderEvent(builder, event);
    ended = event->type == FYET_STREAM_END ? PETSC_TRUE : PETSC_FALSE;
    fy_parser_event_free(parser, event);
    PetscCall(ierr);
  }
  if (!ended || fy_diag_got_error(diagnostics)) PetscCall(RaiseSyntaxError(builder->document, diagnostics));
  PetscFunctionReturn(0);
}

/* libfyaml would write to stderr what it also collects. */
static void DiscardOutput(struct fy_diag *diagnostics, void *user, const char *text, size_t length) {}

PetscErrorCode LamDocumentParse(const char name[], const char text[], LamDocument *document)
{
  Builder builder = {.document = document};
  struct fy_diag_cfg diagnostics_config;
  struct fy_parse_cfg config = {.flags = FYPCF_QUIET | FYPCF_COLLECT_DIAG | FYPCF_JSON_NONE};
  struct fy_parser *parser;
  PetscErrorCode ierr = PETSC_ERR_MEM;

  PetscFunctionBeginUser;
  *document = (LamDocument){.name = name, .text = text};
  fy_diag_cfg_default(&diagnostics_config);
  diagnostics_config.fp = NULL;
  diagnostics_config.output_fn = DiscardOutput;
  config.diag = fy_diag_create(&diagnostics_config);
  PetscCheck(config.diag, PETSC_COMM_SELF, PETSC_ERR_MEM, "libfyaml: out of memory");
  fy_diag_set_collect_errors(config.diag, true);
  parser = fy_parser_create(&config);
  if (parser) {
    ierr = ParseEvents(&builder, parser, config.diag);
    fy_parser_destroy(parser);
  }
  fy_diag_destroy(config.diag);
  PetscCall(PetscFree(builder.name));
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
