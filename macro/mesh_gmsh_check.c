/*
  Validation of a Gmsh file before PETSc reads it.

  Method
    PETSc rejects truncated files, duplicate nodes, parametric coordinates and unknown element types. It does not check
    the numbers of nodes, elements and tags, the nodes and entities that an element refers to, or the length of a word:
    a wrong number makes it crash, hang or read other memory. These are checked here first, by the same grammar:
    MeshFormat, PhysicalNames, Entities (from 4.0 on), Nodes, Elements. Later sections are not read. Also rejected is
    what PETSc drops silently: a line of a side that is on no element.

  References
    C. Geuzaine and J.-F. Remacle, Gmsh Reference Manual, Sections "MSH file format" and "MSH file format version 2".
*/
#include "macro_impl.h"
#include "mesh_sources.h"
#include <petsc/private/hashsetij.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MOST_WORD = 128, MOST_NAME = 120, MOST_TAGS = 16, MOST_NODES = 10 };
#define MOST_SPAN ((int64_t)1 << 20) /* largest span of node tags; SPARSE times the number of nodes if larger */
#define SPARSE 64

typedef struct {
  const char *begin, *at, *end;
  int format; /* 22, 40, 41 */
  PetscBool binary, swapped;
  int64_t first, span;  /* node tags: smallest, range */
  unsigned char *known; /* [span] the node exists; owned */
  PetscHSetIJ groups;   /* physical groups with a name: dimension, tag; owned */
  PetscHSetIJ entities; /* dimension, tag; owned */
  PetscHSetIJ edges,
      segments; /* edges of two-dimensional and of one-dimensional elements: smaller node, larger node; owned */
  char *why;    /* LAM_GMSH_WHY long */
} Mesh;

/* Writes the message to m->why. Always returns PETSC_FALSE. */
static PetscBool Wrong(const Mesh *m, const char format[], ...)
{
  int line = 1, length;
  va_list arguments;

  for (const char *c = m->begin; c + 1 < m->at && !m->binary; c++) line += *c == '\n';
  length = m->binary ? snprintf(m->why, LAM_GMSH_WHY, "byte %lld: ", (long long)(m->at - m->begin))
                     : snprintf(m->why, LAM_GMSH_WHY, "line %d: ", line);
  va_start(arguments, format);
  vsnprintf(m->why + length, (size_t)(LAM_GMSH_WHY - length), format, arguments);
  va_end(arguments);
  return PETSC_FALSE;
}

/* ---- words and numbers ---- */

static PetscBool IsGap(char c)
{
  return (PetscBool)(c == ' ' || (c >= '\t' && c <= '\r'));
}

/* Reads a word and the one blank after it: binary numbers begin there. */
static PetscBool Word(Mesh *m, char word[MOST_WORD])
{
  size_t n = 0;

  while (m->at < m->end && IsGap(*m->at)) m->at++;
  for (; m->at < m->end && !IsGap(*m->at); n++) {
    if (n + 1 == MOST_WORD) return Wrong(m, "a word of more than %d bytes", MOST_WORD - 1);
    word[n] = *m->at++;
  }
  word[n] = '\0';
  if (!n) return Wrong(m, "the file ends early");
  if (m->at < m->end) m->at++;
  return PETSC_TRUE;
}

static PetscBool Expect(Mesh *m, const char wanted[])
{
  char word[MOST_WORD];

  if (!Word(m, word)) return PETSC_FALSE;
  return strcmp(word, wanted) ? Wrong(m, "%s is wanted, not %.40s", wanted, word) : PETSC_TRUE;
}

static PetscBool WordToInteger(Mesh *m, int64_t least, int64_t most, int64_t *value)
{
  char word[MOST_WORD], *end;

  if (!Word(m, word)) return PETSC_FALSE;
  errno = 0;
  *value = strtoll(word, &end, 10);
  if (*end || errno || *value < least || *value > most) return Wrong(m, "%.40s is not the whole number wanted", word);
  return PETSC_TRUE;
}

static PetscBool Bytes(Mesh *m, size_t size, void *value)
{
  unsigned char *bytes = value;

  if ((size_t)(m->end - m->at) < size) return Wrong(m, "the file ends early");
  for (size_t i = 0; i < size; i++) bytes[m->swapped ? size - 1 - i : i] = (unsigned char)*m->at++;
  return PETSC_TRUE;
}

static PetscBool Integer(Mesh *m, int64_t least, int64_t most, int64_t *value)
{
  int32_t number;

  if (!m->binary) return WordToInteger(m, least, most, value);
  if (!Bytes(m, sizeof(number), &number)) return PETSC_FALSE;
  *value = number;
  return *value < least || *value > most ? Wrong(m, "%lld is not the whole number wanted", (long long)*value)
                                         : PETSC_TRUE;
}

/* A tag, or a number of items of at least `each` bytes: limited by the size of the rest of the file. */
static PetscBool Long(Mesh *m, int64_t each, int64_t *value)
{
  const int64_t most = each ? (m->end - m->at) / each : INT_MAX - 1;

  if (!m->binary) return WordToInteger(m, 0, PetscMin(most, INT_MAX - 1), value);
  if (!Bytes(m, sizeof(*value), value)) return PETSC_FALSE;
  return *value < 0 || *value > PetscMin(most, INT_MAX - 1) ? Wrong(m, "%lld of them", (long long)*value) : PETSC_TRUE;
}

/* Tag of a node or element; in formats before 4.1 a short integer. */
static PetscBool Tag(Mesh *m, int64_t least, int64_t most, int64_t *value)
{
  return m->format == 41 ? Long(m, 0, value) : Integer(m, least, most, value);
}

/* Skips n short integers. */
static PetscBool Skip(Mesh *m, int64_t n)
{
  int64_t ignored;

  for (int64_t i = 0; i < n; i++)
    if (!Integer(m, INT_MIN, INT_MAX, &ignored)) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscBool Reals(Mesh *m, int64_t n)
{
  for (int64_t i = 0; i < n; i++) {
    char word[MOST_WORD], *end = word;
    double value = 0;

    if (m->binary ? !Bytes(m, sizeof(value), &value) : !Word(m, word)) return PETSC_FALSE;
    if (!m->binary) value = strtod(word, &end);
    if ((!m->binary && (end == word || *end)) || !isfinite(value)) return Wrong(m, "a coordinate is no finite number");
  }
  return PETSC_TRUE;
}

/* ---- pairs ---- */

static PetscBool Add(Mesh *m, PetscHSetIJ set, int64_t a, int64_t b)
{
  const PetscHashIJKey key = {(PetscInt)a, (PetscInt)b};

  return PetscHSetIJAdd(set, key) ? Wrong(m, "no memory for the mesh") : PETSC_TRUE;
}

static PetscBool Has(PetscHSetIJ set, int64_t a, int64_t b)
{
  const PetscHashIJKey key = {(PetscInt)a, (PetscInt)b};
  PetscBool has;

  return (PetscBool)(!PetscHSetIJHas(set, key, &has) && has);
}

/* ---- header ---- */

static PetscBool Format(Mesh *m)
{
  char version[MOST_WORD];
  int64_t binary, size;
  int32_t one = 1;

  if (!Expect(m, "$MeshFormat") || !Word(m, version)) return PETSC_FALSE;
  m->format = !strcmp(version, "2.2") ? 22 : !strcmp(version, "4") || !strcmp(version, "4.0") ? 40 : 41;
  if (m->format == 41 && strcmp(version, "4.1")) return Wrong(m, "format %.20s; 2.2, 4.0 and 4.1 are read", version);
  if (!WordToInteger(m, 0, 1, &binary) || !WordToInteger(m, 8, 8, &size)) return PETSC_FALSE;
  m->binary = (PetscBool)binary;
  if (binary && !Bytes(m, sizeof(one), &one)) return PETSC_FALSE;
  m->swapped = (PetscBool)(binary && one != 1);
  if (m->swapped && one != 0x01000000) return Wrong(m, "the order of bytes is unknown");
  return Expect(m, "$EndMeshFormat");
}

/* Label names used by PETSc itself. */
static PetscBool IsTaken(const char *name, size_t n)
{
  return (PetscBool)((n == 5 && !memcmp(name, "depth", n)) || (n == 8 && !memcmp(name, "celltype", n)));
}

/* PETSc expects the name to begin right here, and ends it at a colon. */
static PetscBool PhysicalName(Mesh *m)
{
  const char *from, *to, *line;
  int64_t dimension, tag;

  if (!WordToInteger(m, 0, 3, &dimension) || !WordToInteger(m, INT_MIN, INT_MAX, &tag)) return PETSC_FALSE;
  line = memchr(m->at, '\n', (size_t)(m->end - m->at));
  if (!line) return Wrong(m, "the file ends early");
  from = m->at;
  for (to = line; to > from && *to != '"';) to--;
  if (*from != '"' || to - from < 2 || to - from > MOST_NAME || line - to > MOST_NAME)
    return Wrong(m, "a name in quotation marks is wanted behind one blank, of 1 to %d bytes", MOST_NAME - 1);
  if (memchr(from, '\0', (size_t)(line - from)) || memchr(from, ':', (size_t)(line - from)))
    return Wrong(m, "the name of a physical group holds a colon or a zero; give it another");
  if (IsTaken(from + 1, (size_t)(to - from - 1)))
    return Wrong(m, "a physical group cannot have the name %.*s; give it another", (int)(to - from - 1), from + 1);
  m->at = line + 1;
  return Add(m, m->groups, dimension, tag);
}

static PetscBool PhysicalNames(Mesh *m)
{
  int64_t n;

  if (!WordToInteger(m, 0, m->end - m->at, &n)) return PETSC_FALSE;
  for (int64_t i = 0; i < n; i++)
    if (!PhysicalName(m)) return PETSC_FALSE;
  return Expect(m, "$EndPhysicalNames");
}

static PetscBool Entity(Mesh *m, int dimension)
{
  int64_t tag, n;

  if (!Integer(m, INT_MIN, INT_MAX, &tag) || !Reals(m, m->format == 41 && !dimension ? 3 : 6)) return PETSC_FALSE;
  for (int list = 0; list < (dimension ? 2 : 1); list++) { /* physical groups, bounding entities */
    if (!Long(m, 1, &n)) return PETSC_FALSE;
    if (!list && n > MOST_TAGS) return Wrong(m, "more than %d physical groups of one entity", MOST_TAGS);
    if (!Skip(m, n)) return PETSC_FALSE;
  }
  return Add(m, m->entities, dimension, tag);
}

static PetscBool Entities(Mesh *m)
{
  int64_t n[4];

  for (int k = 0; k < 4; k++)
    if (!Long(m, 1, &n[k])) return PETSC_FALSE;
  for (int k = 0; k < 4; k++)
    for (int64_t i = 0; i < n[k]; i++)
      if (!Entity(m, k)) return PETSC_FALSE;
  return Expect(m, "$EndEntities");
}

/* Header of a block: its entity, and for elements their type. */
static PetscBool Block(Mesh *m, PetscBool of_elements, int64_t *third, int64_t *n)
{
  const PetscBool tag_first = (PetscBool)(m->format == 40);
  int64_t first, second;

  if (!Integer(m, INT_MIN, INT_MAX, &first) || !Integer(m, INT_MIN, INT_MAX, &second) ||
      !Integer(m, 0, INT_MAX, third) || !Long(m, 1, n))
    return PETSC_FALSE;
  if ((of_elements || m->format == 41) && !Has(m->entities, tag_first ? second : first, tag_first ? first : second))
    return Wrong(m, "a block of an entity that is not in $Entities");
  return PETSC_TRUE;
}

/* ---- nodes ---- */

/* Formats 2.2 and 4.0: each tag with its coordinates; 4.1: all tags first. */
static PetscBool NodeBlock(Mesh *m, int64_t count, int64_t tags[], int64_t room, int64_t *n)
{
  int64_t tag;

  for (int64_t i = 0; i < count; i++) {
    if (!Tag(m, 0, INT_MAX - 1, &tag)) return PETSC_FALSE;
    if (*n == room) return Wrong(m, "there are more nodes than $Nodes says");
    tags[(*n)++] = tag;
    if (m->format < 41 && !Reals(m, 3)) return PETSC_FALSE;
  }
  return m->format == 41 ? Reals(m, 3 * count) : PETSC_TRUE;
}

static PetscBool NodeBlocks(Mesh *m, int64_t blocks, int64_t tags[], int64_t room)
{
  int64_t n = 0, count, parametric;

  for (int64_t b = 0; b < blocks; b++) {
    if (!Block(m, PETSC_FALSE, &parametric, &count)) return PETSC_FALSE;
    if (m->format == 41 && parametric) return Wrong(m, "parametric coordinates are not read");
    if (!NodeBlock(m, count, tags, room, &n)) return PETSC_FALSE;
  }
  return n < room ? Wrong(m, "there are fewer nodes than $Nodes says") : PETSC_TRUE;
}

static PetscBool MarkNodes(Mesh *m, int64_t n, const int64_t tags[])
{
  int64_t last = 0;

  m->first = INT_MAX;
  for (int64_t i = 0; i < n; i++) {
    m->first = PetscMin(m->first, tags[i]);
    last = PetscMax(last, tags[i]);
  }
  m->span = last - m->first + 1;
  if (m->span < 1 || m->span > PetscMax(MOST_SPAN, SPARSE * n))
    return Wrong(m, "tags of nodes from %lld to %lld", (long long)m->first, (long long)last);
  m->known = calloc((size_t)m->span, 1);
  if (!m->known) return Wrong(m, "no memory for the mesh");
  for (int64_t i = 0; i < n; i++) m->known[tags[i] - m->first] = 1; /* PETSc rejects duplicate nodes */
  return PETSC_TRUE;
}

/* Checks the range of node tags given by format 4.1. */
static PetscBool RangeHolds(const Mesh *m, int64_t least, int64_t most)
{
  if (least <= m->first && most >= m->first + m->span - 1 && most - least < m->span + MOST_SPAN) return PETSC_TRUE;
  return Wrong(m, "tags of nodes are said to be from %lld to %lld", (long long)least, (long long)most);
}

static PetscBool Nodes(Mesh *m)
{
  int64_t blocks = 0, n = 0, least = 0, most = 0, *tags, read = 0;
  PetscBool good;

  if (m->format == 22) {
    if (!WordToInteger(m, 1, (m->end - m->at) / 8, &n)) return PETSC_FALSE;
  } else if (!Long(m, 1, &blocks) || !Long(m, 8, &n) ||
             (m->format == 41 && (!Long(m, 0, &least) || !Long(m, 0, &most))))
    return PETSC_FALSE;
  if (!n) return Wrong(m, "there is no node");
  tags = malloc((size_t)n * sizeof(*tags));
  if (!tags) return Wrong(m, "no memory for the mesh");
  good = m->format == 22 ? NodeBlock(m, n, tags, n, &read) : NodeBlocks(m, blocks, tags, n);
  if (good) good = MarkNodes(m, n, tags);
  if (good && m->format == 41) good = RangeHolds(m, least, most);
  free(tags);
  return good ? Expect(m, "$EndNodes") : PETSC_FALSE;
}

/* ---- elements ---- */

static const struct {
  int type, corners, nodes;
} kinds[] = {{15, 1, 1}, {1, 2, 2}, {8, 2, 3}, {2, 3, 3}, {9, 3, 6}, {3, 4, 4}, {10, 4, 9}, {16, 4, 8}};

/* Index of an element type in kinds; -1: not supported. */
static int FindKind(const Mesh *m, int64_t type)
{
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(kinds); k++)
    if (kinds[k].type == type) return (int)k;
  (void)Wrong(m,
              "elements of type %lld are not read; mesh a surface in the plane X3 = 0 with triangles or "
              "quadrilaterals, straight or quadratic",
              (long long)type);
  return -1;
}

static PetscBool ElementNodes(Mesh *m, int kind)
{
  const int corners = kinds[kind].corners;
  int64_t node[MOST_NODES];

  for (int i = 0; i < kinds[kind].nodes; i++) {
    if (!Tag(m, 0, INT_MAX - 1, &node[i])) return PETSC_FALSE;
    if (node[i] < m->first || node[i] - m->first >= m->span || !m->known[node[i] - m->first])
      return Wrong(m, "an element has node %lld, which is not in $Nodes", (long long)node[i]);
    for (int j = 0; j < i; j++)
      if (node[j] == node[i]) return Wrong(m, "an element has node %lld twice", (long long)node[i]);
  }
  for (int i = 0; i < (corners > 2 ? corners : corners - 1); i++) {
    const int64_t a = node[i], b = node[(i + 1) % corners];

    if (!Add(m, corners > 2 ? m->edges : m->segments, PetscMin(a, b), PetscMax(a, b))) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Tags of an element of format 2.2: of its physical group, its entity, its partitions. PETSc takes each for one of a
   physical group. */
static PetscBool OldTags(Mesh *m, int kind, int64_t tags)
{
  const int64_t dimension = PetscMin(kinds[kind].corners - 1, 2);
  int64_t group = 0, tag;

  if (m->binary && !Skip(m, 1)) return PETSC_FALSE; /* number of the element */
  for (int64_t i = 0; i < tags; i++) {
    if (!Integer(m, INT_MIN, INT_MAX, &tag)) return PETSC_FALSE;
    if (!i) group = tag;
    if (tag != group && Has(m->groups, dimension, tag))
      return Wrong(
          m,
          "an element of physical group %lld has the tag %lld of another group as that of its entity, and would "
          "belong to both; write the file with gmsh -format msh41",
          (long long)group, (long long)tag);
  }
  return PETSC_TRUE;
}

/* Format 2.2: each element (text) or each block of elements (binary) states its type and number of tags. */
static PetscBool OldElements(Mesh *m, int64_t n)
{
  int64_t first, second, tags;

  for (int64_t e = 0; e < n;) {
    int64_t count = 1, type;
    int kind;

    if (!Integer(m, INT_MIN, INT_MAX, &first) || !Integer(m, 0, INT_MAX, &second) || !Integer(m, 0, MOST_TAGS, &tags))
      return PETSC_FALSE;
    type = m->binary ? first : second;
    if (m->binary) count = second;
    if (!count || count > n - e) return Wrong(m, "there are not as many elements as $Elements says");
    kind = FindKind(m, type);
    for (int64_t i = 0; kind >= 0 && i < count; i++, e++) {
      if (!OldTags(m, kind, tags) || !ElementNodes(m, kind)) return PETSC_FALSE;
    }
    if (kind < 0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscBool ElementBlocks(Mesh *m, int64_t blocks, int64_t n)
{
  int64_t type, count, ignored, read = 0;

  for (int64_t b = 0; b < blocks; b++) {
    int kind;

    if (!Block(m, PETSC_TRUE, &type, &count)) return PETSC_FALSE;
    kind = FindKind(m, type);
    if (kind < 0) return PETSC_FALSE;
    read += count;
    if (read > n) break;
    for (int64_t i = 0; i < count; i++)
      if (!Tag(m, INT_MIN, INT_MAX, &ignored) || !ElementNodes(m, kind)) return PETSC_FALSE;
  }
  return read == n ? PETSC_TRUE : Wrong(m, "there are not as many elements as $Elements says");
}

static PetscBool Elements(Mesh *m)
{
  int64_t blocks, n, ignored;

  if (m->format == 22) {
    if (!WordToInteger(m, 0, (m->end - m->at) / 4, &n) || !OldElements(m, n)) return PETSC_FALSE;
  } else if (!Long(m, 1, &blocks) || !Long(m, 4, &n) ||
             (m->format == 41 && (!Long(m, 0, &ignored) || !Long(m, 0, &ignored))) || !ElementBlocks(m, blocks, n)) {
    return PETSC_FALSE;
  }
  return Expect(m, "$EndElements");
}

/* Checks that there are surface elements, and that every line is an edge of one. */
static PetscBool Body(Mesh *m)
{
  PetscHashIJKey *lines;
  PetscInt edges = 0, n, first = 0, i = 0;
  PetscBool good;

  if (PetscHSetIJGetSize(m->edges, &edges) || !edges) return Wrong(m, "there is no element of a surface");
  if (PetscHSetIJGetSize(m->segments, &n) || PetscMalloc1(n, &lines)) return Wrong(m, "no memory for the mesh");
  (void)PetscHSetIJGetElems(m->segments, &first, lines);
  while (i < n && Has(m->edges, lines[i].i, lines[i].j)) i++;
  good =
      i == n ? PETSC_TRUE : Wrong(m, "the line from node %d to %d is on no element", (int)lines[i].i, (int)lines[i].j);
  (void)PetscFree(lines);
  return good;
}

/* ---- the file ---- */

/* Next section name; comments between sections are skipped. */
static PetscBool Section(Mesh *m, char word[MOST_WORD])
{
  if (!Word(m, word)) return PETSC_FALSE;
  while (!strcmp(word, "$Comments")) {
    while (strcmp(word, "$EndComments"))
      if (!Word(m, word)) return PETSC_FALSE;
    if (!Word(m, word)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscBool Read(Mesh *m)
{
  char word[MOST_WORD];

  if (!Format(m) || !Section(m, word)) return PETSC_FALSE;
  if (!strcmp(word, "$PhysicalNames") && (!PhysicalNames(m) || !Section(m, word))) return PETSC_FALSE;
  if (m->format >= 40) {
    if (strcmp(word, "$Entities")) return Wrong(m, "$Entities is wanted, not %.40s", word);
    if (!Entities(m) || !Section(m, word)) return PETSC_FALSE;
  }
  if (strcmp(word, "$Nodes")) return Wrong(m, "$Nodes is wanted, not %.40s", word);
  if (!Nodes(m) || !Section(m, word)) return PETSC_FALSE;
  if (strcmp(word, "$Elements")) return Wrong(m, "$Elements is wanted, not %.40s", word);
  return (PetscBool)(Elements(m) && Body(m));
}

/* Reads the whole file; returns NULL with the reason in why. */
static char *Load(const char path[], size_t *size, char why[LAM_GMSH_WHY])
{
  FILE *file = fopen(path, "rb");
  struct stat status;
  char *bytes = NULL;

  why[0] = '\0';
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

PetscBool LamGmshCheck(const char path[], char why[LAM_GMSH_WHY])
{
  size_t size = 0;
  char *bytes = Load(path, &size, why);
  Mesh m = {.begin = bytes, .at = bytes, .end = bytes + size, .why = why};
  PetscBool good;

  if (!bytes) return PETSC_FALSE;
  if (size < 11 || strncmp(bytes, "$MeshFormat", 11)) {
    snprintf(why, LAM_GMSH_WHY, "is no Gmsh mesh: it does not begin with $MeshFormat");
    good = PETSC_FALSE;
  } else if (PetscHSetIJCreate(&m.groups) || PetscHSetIJCreate(&m.entities) || PetscHSetIJCreate(&m.edges) ||
             PetscHSetIJCreate(&m.segments))
    good = Wrong(&m, "no memory for the mesh");
  else
    good = Read(&m);
  free(bytes);
  free(m.known);
  (void)PetscHSetIJDestroy(&m.groups);
  (void)PetscHSetIJDestroy(&m.entities);
  (void)PetscHSetIJDestroy(&m.edges);
  (void)PetscHSetIJDestroy(&m.segments);
  return good;
}
