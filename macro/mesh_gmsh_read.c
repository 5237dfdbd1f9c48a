/*
  Files of Gmsh: formats 2.2, 4.0 and 4.1, text and binary.

  Method
    One pass over the bytes of the file. The first mistake moves the reader to its end, so that all that follows fails
    and every loop over a number of items that the file states comes to an end. Lists grow with the items that are
  there, never by a number that the file states. Sections that say nothing of the mesh are skipped, as is what comes
  after the elements: periodic sides are not identified.

  References
    C. Geuzaine and J.-F. Remacle, Gmsh Reference Manual, Sections "MSH file format" and "MSH file format version 2".
*/
#include "mesh_gmsh.h"
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MOST_WORD = 128 };

static const LamGmshKind kinds[] = {{15, 1, 1, 0, DM_POLYTOPE_POINT, ""},
                                    {1, 2, 1, 1, DM_POLYTOPE_SEGMENT, "01"},
                                    {8, 3, 2, 1, DM_POLYTOPE_SEGMENT, "01"},
                                    {2, 3, 1, 2, DM_POLYTOPE_TRIANGLE, "011220"},
                                    {9, 6, 2, 2, DM_POLYTOPE_TRIANGLE, "011220"},
                                    {3, 4, 1, 2, DM_POLYTOPE_QUADRILATERAL, "01122330"},
                                    {16, 8, 2, 2, DM_POLYTOPE_QUADRILATERAL, "01122330"},
                                    {10, 9, 2, 2, DM_POLYTOPE_QUADRILATERAL, "01122330"}};

typedef struct {
  int64_t key[2];       /* dimension, tag */
  size_t first, groups; /* of its physical groups in LamGmsh.groups, and how many */
} Entity;

typedef struct {
  const char *begin, *at, *end;
  int format; /* 22, 40, 41 */
  PetscBool binary, swapped;
  LamGmsh *gmsh;
  LamGmshList entities; /* owned */
  char *why;            /* LAM_GMSH_WHY long; empty: all is well */
} Reader;

/* Keeps the first message, with the place of the last word or number. */
static void Wrong(Reader *r, const char format[], ...)
{
  int line = 1, length;
  va_list arguments;

  if (r->why[0]) return;
  for (const char *c = r->begin; c + 1 < r->at && !r->binary; c++) line += *c == '\n';
  length = r->binary ? snprintf(r->why, LAM_GMSH_WHY, "byte %lld: ", (long long)(r->at - r->begin))
                     : snprintf(r->why, LAM_GMSH_WHY, "line %d: ", line);
  va_start(arguments, format);
  vsnprintf(r->why + length, (size_t)(LAM_GMSH_WHY - length), format, arguments);
  va_end(arguments);
  r->at = r->end;
}

/* ---- lists ---- */

void *LamGmshAppend(LamGmshList *list, size_t size)
{
  if (list->count == list->room) {
    const size_t room = PetscMax(64, 2 * list->room);
    void *items = realloc(list->items, room * size);

    if (!items) return NULL;
    list->items = items;
    list->room = room;
  }
  return memset((char *)list->items + size * list->count++, 0, size);
}

static int CompareKeys(const void *a, const void *b)
{
  const int64_t *one = a, *other = b;

  for (int k = 0; k < 2; k++)
    if (one[k] != other[k]) return one[k] < other[k] ? -1 : 1;
  return 0;
}

void LamGmshSort(LamGmshList *list, size_t size)
{
  if (list->count) qsort(list->items, list->count, size, CompareKeys);
}

void *LamGmshFind(const LamGmshList *list, size_t size, int64_t first, int64_t second)
{
  const int64_t key[2] = {first, second};

  return list->count ? bsearch(key, list->items, list->count, size, CompareKeys) : NULL;
}

static void *Append(Reader *r, LamGmshList *list, size_t size)
{
  void *item = r->why[0] ? NULL : LamGmshAppend(list, size);

  if (!item) Wrong(r, "no memory for the mesh");
  return item;
}

/* ---- words and numbers: after a mistake "" and 0 ---- */

static PetscBool IsGap(char c)
{
  return (PetscBool)(c == ' ' || (c >= '\t' && c <= '\r'));
}

/* Reads a word and the one blank after it: binary numbers begin there. */
static void Word(Reader *r, char word[MOST_WORD])
{
  size_t n = 0;

  while (r->at < r->end && IsGap(*r->at)) r->at++;
  while (r->at < r->end && !IsGap(*r->at) && n + 1 < MOST_WORD) word[n++] = *r->at++;
  if (n + 1 == MOST_WORD) Wrong(r, "a word of more than %d bytes", MOST_WORD - 1);
  if (!n) Wrong(r, "the file ends early");
  if (r->at < r->end) r->at++;
  word[r->why[0] ? 0 : n] = '\0';
}

static void Expect(Reader *r, const char right[])
{
  char word[MOST_WORD];

  Word(r, word);
  if (strcmp(word, right)) Wrong(r, "%.40s stands where %s belongs", word, right);
}

/* A binary number. */
static void Bytes(Reader *r, size_t size, void *value)
{
  unsigned char *bytes = value;

  memset(value, 0, size);
  if ((size_t)(r->end - r->at) < size) Wrong(r, "the file ends early");
  for (size_t i = 0; i < size && !r->why[0]; i++) bytes[r->swapped ? size - 1 - i : i] = (unsigned char)*r->at++;
}

/* A whole number in text. */
static int64_t TextInteger(Reader *r, int64_t least, int64_t most)
{
  char word[MOST_WORD], *end;
  int64_t value;

  Word(r, word);
  errno = 0;
  value = strtoll(word, &end, 10);
  if (*end || errno || value < least || value > most)
    Wrong(r, "%.40s is not a whole number from %lld to %lld", word, (long long)least, (long long)most);
  return r->why[0] ? 0 : value;
}

static int64_t Integer(Reader *r, size_t size, int64_t least, int64_t most)
{
  int32_t narrow;
  int64_t value;

  if (!r->binary) return TextInteger(r, least, most);
  if (size == sizeof(narrow)) {
    Bytes(r, size, &narrow);
    value = narrow;
  } else
    Bytes(r, size, &value);
  if (value < least || value > most)
    Wrong(r, "%lld is not a whole number from %lld to %lld", (long long)value, (long long)least, (long long)most);
  return r->why[0] ? 0 : value;
}

static int64_t Int(Reader *r)
{
  return Integer(r, 4, INT_MIN, INT_MAX);
}

/* Tag of a node or element. */
static int64_t Tag(Reader *r)
{
  return Integer(r, r->format == 41 ? 8 : 4, 0, r->format == 41 ? INT64_MAX : INT_MAX);
}

/* A number of items, of which the rest of the file has room for. */
static int64_t Count(Reader *r)
{
  return Integer(r, 8, 0, r->end - r->at);
}

static double Real(Reader *r)
{
  char word[MOST_WORD], *end = word;
  double value;

  if (r->binary)
    Bytes(r, sizeof(value), &value);
  else {
    Word(r, word);
    value = strtod(word, &end);
    if (end == word || *end) value = NAN;
  }
  if (!isfinite(value)) Wrong(r, "a coordinate is no finite number");
  return value;
}

/* ---- sections ---- */

static void Format(Reader *r)
{
  char version[MOST_WORD];
  int32_t one = 1;

  Expect(r, "$MeshFormat");
  Word(r, version);
  r->format = !strcmp(version, "2.2") ? 22 : !strcmp(version, "4") || !strcmp(version, "4.0") ? 40 : 41;
  if (r->format == 41 && strcmp(version, "4.1")) Wrong(r, "format %.20s; 2.2, 4.0 and 4.1 are read", version);
  one = (int32_t)TextInteger(r, 0, 1);
  TextInteger(r, 8, 8); /* bytes of a double, or of a tag */
  r->binary = (PetscBool)(one == 1);
  if (r->binary) Bytes(r, sizeof(one), &one);
  r->swapped = (PetscBool)(r->binary && one != 1);
  if (r->swapped && one != 0x01000000) Wrong(r, "the order of bytes is unknown");
  Expect(r, "$EndMeshFormat");
}

/* dimension, tag, and behind them the name in quotation marks up to the end of the line */
static void Names(Reader *r)
{
  const int64_t n = TextInteger(r, 0, r->end - r->at);

  for (int64_t i = 0; i < n && !r->why[0]; i++) {
    const int64_t dimension = TextInteger(r, 0, 3), tag = TextInteger(r, INT_MIN, INT_MAX);
    const char *from = r->at, *line = from < r->end ? memchr(from, '\n', (size_t)(r->end - from)) : NULL, *to = line;
    LamGmshName *name;

    while (line && from < line && *from != '"') from++;
    while (line && to > from && *to != '"') to--;
    if (!line || to - from < 2 || to - from > LAM_NAME_LENGTH || memchr(from, '\0', (size_t)(to - from)))
      Wrong(r, "a name in quotation marks belongs here, of 1 to %d bytes", LAM_NAME_LENGTH - 1);
    name = Append(r, &r->gmsh->names, sizeof(*name));
    if (!name) return;
    name->key[0] = dimension;
    name->key[1] = tag;
    memcpy(name->name, from + 1, (size_t)(to - from - 1));
    r->at = line + 1;
  }
  LamGmshSort(&r->gmsh->names, sizeof(LamGmshName));
  for (size_t k = 1; k < r->gmsh->names.count; k++) {
    const LamGmshName *name = (const LamGmshName *)r->gmsh->names.items + k;

    if (!CompareKeys(name, name - 1))
      Wrong(r, "physical group %lld of dimension %lld has two names", (long long)name->key[1], (long long)name->key[0]);
  }
}

static void AddGroup(Reader *r, int64_t tag)
{
  int64_t *group = Append(r, &r->gmsh->groups, sizeof(*group));

  if (group) *group = llabs(tag); /* the sign is a direction */
}

/* Entities, or pieces of them on partitions, which are in the groups of their parents, too. */
static void Entities(Reader *r, PetscBool partitioned)
{
  LamGmshList *list = &r->entities;
  const size_t parents = list->count;
  int64_t n[4];

  if (partitioned) {
    Count(r); /* of partitions */
    for (int64_t ghosts = 2 * Count(r); ghosts > 0 && !r->why[0]; ghosts--) Int(r);
  }
  for (int k = 0; k < 4; k++) n[k] = Count(r);
  for (int k = 0; k < 4; k++)
    for (int64_t i = 0; i < n[k] && !r->why[0]; i++) {
      Entity entity = {.key = {k, Int(r)}, .first = r->gmsh->groups.count}, *place;

      if (partitioned) {
        const int64_t dimension = Int(r), tag = Int(r);
        const LamGmshList whole = {.count = parents, .items = list->items};
        const Entity *parent = dimension == k ? LamGmshFind(&whole, sizeof(*parent), k, tag) : NULL;

        for (size_t g = 0; parent && g < parent->groups; g++)
          AddGroup(r, ((const int64_t *)r->gmsh->groups.items)[parent->first + g]);
        for (int64_t on = Count(r); on > 0 && !r->why[0]; on--) Int(r);
      }
      for (int c = 0; c < (r->format == 41 && !k ? 3 : 6); c++) Real(r);
      for (int64_t groups = Count(r); groups > 0 && !r->why[0]; groups--) AddGroup(r, Int(r));
      for (int64_t around = k ? Count(r) : 0; around > 0 && !r->why[0]; around--) Int(r);
      entity.groups = r->gmsh->groups.count - entity.first;
      place = Append(r, list, sizeof(*place));
      if (place) *place = entity;
    }
  LamGmshSort(list, sizeof(Entity));
}

/* Header of a block: its entity; a number; how many items. */
static void Block(Reader *r, int64_t entity[2], int64_t *number, int64_t *n)
{
  const int first = r->format == 40 ? 1 : 0; /* the tag comes before the dimension */

  entity[first] = Int(r);
  entity[1 - first] = Int(r);
  *number = Int(r);
  *n = Count(r);
}

/* Formats 2.2 and 4.0: each tag with its coordinates; 4.1: all tags first. `parameters`: their number behind the
   coordinates, in format 2.2 given with each node. */
static void NodeBlock(Reader *r, int64_t n, int64_t parameters, PetscBool parametric)
{
  LamGmshList *list = &r->gmsh->nodes;
  const size_t first = list->count;

  for (int pass = 0; pass < 2; pass++)
    for (int64_t i = 0; i < n && !r->why[0]; i++) {
      LamGmshNode *node = pass ? (LamGmshNode *)list->items + first + i : Append(r, list, sizeof(*node));

      if (!node) return;
      if (!pass) node->key[0] = Tag(r);
      if (pass != (r->format == 41)) continue;
      for (int c = 0; c < 3; c++) node->X[c] = Real(r);
      if (parametric) {
        parameters = Int(r) % 3; /* of the entity's dimension; points of volumes have none */
        Int(r);
      }
      for (int64_t c = 0; c < parameters; c++) Real(r);
    }
}

static void Nodes(Reader *r, PetscBool parametric)
{
  const LamGmshList *list = &r->gmsh->nodes;
  const LamGmshNode *node;

  if (r->format == 22)
    NodeBlock(r, TextInteger(r, 1, r->end - r->at), 0, parametric);
  else {
    const int64_t blocks = Count(r), all = Count(r);

    for (int k = 0; k < 2 && r->format == 41; k++) Integer(r, 8, 0, INT64_MAX); /* range of tags */
    for (int64_t b = 0; b < blocks && !r->why[0]; b++) {
      int64_t entity[2], has_parameters, n;

      Block(r, entity, &has_parameters, &n);
      NodeBlock(r, n, has_parameters ? PetscMax(0, PetscMin(entity[0], 3)) : 0, PETSC_FALSE);
    }
    if ((int64_t)list->count != all)
      Wrong(r, "there are %zu nodes, not %lld as $Nodes says", list->count, (long long)all);
  }
  if (!list->count) Wrong(r, "there is no node");
  LamGmshSort(&r->gmsh->nodes, sizeof(*node));
  node = list->items;
  for (size_t i = 1; i < list->count; i++)
    if (node[i].key[0] == node[i - 1].key[0]) Wrong(r, "node %lld is there twice", (long long)node[i].key[0]);
}

static const LamGmshKind *FindKind(Reader *r, int64_t type)
{
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(kinds); k++)
    if (kinds[k].type == type) return &kinds[k];
  Wrong(r,
        "elements of type %lld are not read; mesh a surface in the plane X3 = 0 with triangles or quadrilaterals, "
        "straight or quadratic",
        (long long)type);
  return NULL;
}

/* `first`, `groups`: of its physical groups. */
static void Element(Reader *r, const LamGmshKind *kind, size_t first, size_t groups)
{
  LamGmshElement element = {.kind = kind, .first = first, .groups = groups}, *place;

  for (int i = 0; i < kind->nodes && !r->why[0]; i++) {
    const int64_t tag = Tag(r);
    const LamGmshNode *node = LamGmshFind(&r->gmsh->nodes, sizeof(*node), tag, 0);

    if (!node) {
      Wrong(r, "an element has node %lld, which is not in $Nodes", (long long)tag);
      return;
    }
    element.node[i] = (size_t)(node - (const LamGmshNode *)r->gmsh->nodes.items);
    for (int j = 0; j < i; j++)
      if (element.node[j] == element.node[i]) Wrong(r, "an element has node %lld twice", (long long)tag);
  }
  place = Append(r, &r->gmsh->elements, sizeof(*place));
  if (place) *place = element;
}

/* Format 2.2: each element (text) or each block of elements (binary) states its type and number of tags: of its
   physical group, its entity, its partitions. */
static void OldElements(Reader *r, int64_t n)
{
  const LamGmshList *groups = &r->gmsh->groups;

  for (int64_t e = 0; e < n && !r->why[0];) {
    const int64_t first = Int(r), second = Int(r), tags = Integer(r, 4, 0, r->end - r->at);
    const int64_t count = r->binary ? second : 1;
    const LamGmshKind *kind = FindKind(r, r->binary ? first : second);

    if (count < 1 || count > n - e) Wrong(r, "there are not as many elements as $Elements says");
    for (int64_t i = 0; i < count && !r->why[0]; i++, e++) {
      int64_t group = 0;

      if (r->binary) Int(r); /* number of the element */
      if (tags) group = llabs(Int(r));
      for (int64_t t = 1; t < tags && !r->why[0]; t++) Int(r);
      if (group && (!groups->count || ((const int64_t *)groups->items)[groups->count - 1] != group)) AddGroup(r, group);
      Element(r, kind, groups->count - (group ? 1 : 0), group ? 1 : 0);
    }
  }
}

static void Elements(Reader *r)
{
  if (r->format == 22) {
    OldElements(r, TextInteger(r, 0, r->end - r->at));
    return;
  }
  const int64_t blocks = Count(r), all = Count(r);

  for (int k = 0; k < 2 && r->format == 41; k++) Integer(r, 8, 0, INT64_MAX);
  for (int64_t b = 0; b < blocks && !r->why[0]; b++) {
    int64_t at[2], type, n;

    Block(r, at, &type, &n);
    const LamGmshKind *kind = FindKind(r, type);
    const Entity *entity = LamGmshFind(&r->entities, sizeof(*entity), at[0], at[1]);

    if (!entity) Wrong(r, "a block of an entity that is not in $Entities");
    for (int64_t i = 0; i < n && !r->why[0]; i++) {
      Tag(r);
      Element(r, kind, entity->first, entity->groups);
    }
  }
  if ((int64_t)r->gmsh->elements.count != all) Wrong(r, "there are not as many elements as $Elements says");
}

/* Goes behind the end of a section that is not read, which may be binary. */
static void Skip(Reader *r, const char section[])
{
  char end[MOST_WORD + 4];
  const size_t n = (size_t)snprintf(end, sizeof(end), "$End%s", section + 1);
  const char *at = r->at;

  if (section[0] != '$') Wrong(r, "%.40s stands where a section such as $Nodes begins", section);
  while (r->end - at >= (ptrdiff_t)n && memcmp(at, end, n))
    if (!(at = memchr(at + 1, '$', (size_t)(r->end - at - 1)))) at = r->end;
  if (r->end - at < (ptrdiff_t)n) Wrong(r, "%.40s has no end", section);
  if (!r->why[0]) r->at = at;
}

static void Sections(Reader *r)
{
  char section[MOST_WORD] = "", end[MOST_WORD + 4];

  Format(r);
  while (!r->why[0] && strcmp(section, "$Elements")) {
    Word(r, section);
    if (!strcmp(section, "$PhysicalNames"))
      Names(r);
    else if (!strcmp(section, "$Entities") && r->format > 22)
      Entities(r, PETSC_FALSE);
    else if (!strcmp(section, "$PartitionedEntities") && r->format > 22)
      Entities(r, PETSC_TRUE);
    else if (!strcmp(section, "$Nodes"))
      Nodes(r, PETSC_FALSE);
    else if (!strcmp(section, "$ParametricNodes") && r->format == 22)
      Nodes(r, PETSC_TRUE);
    else if (!strcmp(section, "$Elements"))
      Elements(r);
    else
      Skip(r, section);
    snprintf(end, sizeof(end), "$End%s", section + PetscMin(1, strlen(section)));
    Expect(r, end);
  }
}

/* ---- the file ---- */

/* Reads the whole file; returns NULL with the reason in why. */
static char *Load(const char path[], size_t *size, char why[LAM_GMSH_WHY])
{
  FILE *file = fopen(path, "rb");
  struct stat status;
  char *bytes = NULL;

  if (!file || fstat(fileno(file), &status)) {
    snprintf(why, LAM_GMSH_WHY, "%s; a relative path counts from the folder of the scene", strerror(errno));
  } else if (!S_ISREG(status.st_mode)) {
    snprintf(why, LAM_GMSH_WHY, "is no file");
  } else {
    *size = (size_t)status.st_size;
    bytes = malloc(*size + 1);
    if (!bytes || fread(bytes, 1, *size, file) != *size) snprintf(why, LAM_GMSH_WHY, "cannot be read");
  }
  if (file) fclose(file);
  if (!why[0]) return bytes;
  free(bytes);
  return NULL;
}

PetscBool LamGmshRead(const char path[], LamGmsh *gmsh, char why[LAM_GMSH_WHY])
{
  size_t size = 0;
  char *bytes;

  memset(gmsh, 0, sizeof(*gmsh));
  why[0] = '\0';
  bytes = Load(path, &size, why);
  if (bytes && (size < 11 || strncmp(bytes, "$MeshFormat", 11)))
    snprintf(why, LAM_GMSH_WHY, "is no Gmsh mesh: it does not begin with $MeshFormat");
  else if (bytes) {
    Reader r = {.begin = bytes, .at = bytes, .end = bytes + size, .gmsh = gmsh, .why = why};

    Sections(&r);
    free(r.entities.items);
  }
  free(bytes);
  return (PetscBool)!why[0];
}

void LamGmshFree(LamGmsh *gmsh)
{
  free(gmsh->nodes.items);
  free(gmsh->names.items);
  free(gmsh->elements.items);
  free(gmsh->groups.items);
  memset(gmsh, 0, sizeof(*gmsh));
}
