/* Gmsh files: one mesh in all formats, and what is no mesh, refused with the line or the node. */
#include "support/error_message.h"
#include "support/macro_fixture.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "macro_impl.h"
#include "mesh_sources.h"

#define FORMAT_22 "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
#define NAMES "$PhysicalNames\n1\n1 1 \"base\"\n$EndPhysicalNames\n"
#define NODES_22 "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
#define ELEMENTS_22 "$Elements\n2\n1 1 2 1 1 1 2\n2 3 2 5 5 1 2 3 4\n$EndElements\n"
#define FORMAT_40                                                                                                      \
  "$MeshFormat\n4 0 8\n$EndMeshFormat\n$Comments\nwords\n$EndComments\n$Entities\n0 1 1 0\n1 0 0 0 1 0 0 1 1 0\n"      \
  "1 0 0 0 1 1 0 0 1 1\n$EndEntities\n"
#define NODES_40 "$Nodes\n1 4\n1 2 0 4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
#define ELEMENTS_40 "$Elements\n2 2\n1 1 1 1\n1 1 2\n1 2 3 1\n2 1 2 3 4\n$EndElements\n"
#define FORMAT_41                                                                                                      \
  "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 1 1 0\n1 0 0 0 1 0 0 1 1 0\n1 0 0 0 1 1 0 0 1 1\n$EndEntities\n"
#define NODES_41 "$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n"
#define ELEMENTS_41 "$Elements\n2 2 1 2\n1 1 1 1\n1 1 2\n2 1 3 1\n2 1 2 3 4\n$EndElements\n"

static const char path[] = "lamella-gmsh.msh"; /* of this program alone */

static PetscErrorCode Read(const char text[], size_t size)
{
  FILE *file = fopen(path, "wb");
  PetscErrorCode code;
  DM dm;

  assert_true(file && fwrite(text, 1, size, file) == size && !fclose(file));
  CHECK(KeepErrorMessages());
  ErrorMessage[0] = '\0';
  code = LamMacroGmshCreate(PETSC_COMM_SELF, "mesh", path, &dm);
  CHECK(PetscPopErrorHandler());
  CHECK(DMDestroy(&dm));
  unlink(path);
  return code;
}

static void AssertSound(const char text[])
{
  if (Read(text, strlen(text))) fail_msg("%s", ErrorMessage);
}

static void AssertRefused(const char text[], const char part[])
{
  assert_int_equal(Read(text, strlen(text)), PETSC_ERR_USER_INPUT);
  if (!strstr(ErrorMessage, part)) fail_msg("\"%s\" lacks \"%s\"", ErrorMessage, part);
}

TEST(sound_files_pass)
{
  AssertSound(FORMAT_22 NAMES NODES_22 ELEMENTS_22);
  AssertSound(FORMAT_40 NODES_40 ELEMENTS_40);
  AssertSound(FORMAT_41 NODES_41 ELEMENTS_41);
}

TEST(a_node_that_is_not_there_is_refused)
{
  AssertRefused(FORMAT_22 NODES_22 "$Elements\n1\n1 3 2 5 5 1 2 3 5\n$EndElements\n",
                "mesh: lamella-gmsh.msh: line 13: an element has node 5, which is not in $Nodes");
  AssertRefused(FORMAT_41 NODES_41 "$Elements\n1 1 1 1\n2 1 3 1\n2 1 2 3 999999999\n$EndElements\n", "node 999999999");
}

TEST(an_entity_that_is_not_there_is_refused)
{
  AssertRefused(FORMAT_40 NODES_40 "$Elements\n1 1\n7 2 3 1\n2 1 2 3 4\n$EndElements\n", "not in $Entities");
}

TEST(more_than_the_file_has_room_for_is_refused)
{
  AssertRefused(FORMAT_22 "$Nodes\n1000000000\n1 0 0 0\n", "line 5: 1000000000 is not a whole number from 1 to 19");
  AssertRefused(FORMAT_41 "$Nodes\n1 900000000 1 4\n", "900000000 is not a whole number");
  AssertRefused(FORMAT_41 NODES_41 "$Elements\n1 2 1 2\n2 1 3 1\n2 1 2 3 4\n$EndElements\n", "not as many elements");
}

/* Tags are names: nothing is as large as they are, or their range. */
TEST(tags_may_be_far_apart)
{
  AssertSound(FORMAT_22 "$Nodes\n3\n1 0 0 0\n2000000000 1 0 0\n40 1 1 0\n$EndNodes\n"
                        "$Elements\n1\n1 2 2 5 5 1 2000000000 40\n$EndElements\n");
  AssertSound(FORMAT_41 "$Nodes\n1 3 2817 4\n2 1 0 3\n1\n900000000000\n7\n0 0 0\n1 0 0\n1 1 0\n$EndNodes\n"
                        "$Elements\n1 1 1 1\n2 1 2 1\n1 1 900000000000 7\n$EndElements\n");
}

TEST(a_node_that_is_there_twice_is_refused)
{
  AssertRefused(FORMAT_22 "$Nodes\n3\n1 0 0 0\n2 1 0 0\n1 1 1 0\n$EndNodes\n", "node 1 is there twice");
}

TEST_IS(an_element_with_a_node_twice_is_refused,
        AssertRefused(FORMAT_22 NODES_22 "$Elements\n1\n1 3 2 5 5 1 2 3 3\n$EndElements\n", "has node 3 twice"));

/* Without a name it is one of construction. */
TEST(a_named_line_or_point_that_is_on_no_element_is_refused)
{
  AssertRefused(FORMAT_22 NAMES NODES_22 "$Elements\n2\n1 1 2 1 1 1 3\n2 3 2 5 5 1 2 3 4\n$EndElements\n",
                "the line from node 1 to 3 is on no element");
  AssertRefused(FORMAT_22 "$PhysicalNames\n1\n0 1 \"spot\"\n$EndPhysicalNames\n" NODES_22
                          "$Elements\n2\n1 15 2 1 1 4\n2 2 2 5 5 1 2 3\n$EndElements\n",
                "the point at node 4 is on no element");
  AssertSound(FORMAT_22 NODES_22 "$Elements\n2\n1 1 2 1 1 1 3\n2 3 2 5 5 1 2 3 4\n$EndElements\n");
}

TEST(what_leaves_the_plane_is_refused)
{
  AssertRefused(FORMAT_22 "$Nodes\n4\n1 0 0 0\n2 1 0 0\n7 1 1 0.25\n4 0 1 0\n$EndNodes\n"
                          "$Elements\n1\n2 3 2 5 5 1 2 7 4\n$EndElements\n",
                "node 7 lies at X3 = 0.25; the body is a surface in the plane X3 = 0: move or project it there");
  AssertRefused(FORMAT_22 "$Nodes\n3\n1 0 0 5\n2 1 0 5\n7 1 1 5\n$EndNodes\n"
                          "$Elements\n1\n2 2 2 5 5 1 2 7\n$EndElements\n",
                "node 1 lies at X3 = 5");
  /* rounding, and a node of no element, such as the centre of a circle */
  AssertSound(FORMAT_22 "$Nodes\n4\n1 0 0 1e-9\n2 1 0 0\n7 1 1 0\n4 0 1 3\n$EndNodes\n"
                        "$Elements\n1\n2 2 2 5 5 1 2 7\n$EndElements\n");
}

/* Two squares side by side, the second with nodes of its own; further up they have one in common, as along a crack. */
TEST(parts_that_lie_on_each_other_are_refused)
{
  AssertRefused(FORMAT_22 "$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
                          "5 1 0 0\n6 2 0 0\n7 2 1 0\n8 1.0000000001 1 0\n$EndNodes\n"
                          "$Elements\n2\n1 3 2 5 5 1 2 3 4\n2 3 2 5 5 5 6 7 8\n$EndElements\n",
                "2 nodes of one part of the body lie on nodes of another");
  AssertRefused(FORMAT_22 "$Nodes\n8\n1 0 0 0\n2 4 0 0\n3 4 1 0\n4 0 1 0\n"
                          "5 1 1 0\n6 2 1 0\n7 2 2 0\n8 1 2 0\n$EndNodes\n"
                          "$Elements\n2\n1 3 2 5 5 1 2 3 4\n2 3 2 5 5 5 6 7 8\n$EndElements\n",
                "node 5 of one part of the body lies on the edge from node 3 to 4 of another");
  AssertSound(FORMAT_22 "$Nodes\n7\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 1 0 0\n6 2 0 0\n7 2 1 0\n$EndNodes\n"
                        "$Elements\n2\n1 3 2 5 5 1 2 3 4\n2 3 2 5 5 5 6 7 3\n$EndElements\n");
}

TEST(elements_that_overlap_are_refused)
{
  AssertRefused(FORMAT_22 "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 2 0\n$EndNodes\n"
                          "$Elements\n2\n1 2 2 5 5 1 2 3\n2 2 2 5 5 1 2 4\n$EndElements\n",
                "two elements lie on the same side of the edge from node 1 to 2");
  AssertRefused(FORMAT_22 "$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0.5 0 0\n5 1 0.5 0\n6 0.5 0.5 0\n7 1 -1 0\n"
                          "8 0.4 0 0\n$EndNodes\n$Elements\n2\n1 9 2 5 5 1 2 3 4 5 6\n2 9 2 5 5 2 1 7 8 5 6\n"
                          "$EndElements\n",
                "the edge from node 1 to 2 has two middle nodes, ");
}

TEST(what_is_no_plane_body_is_refused)
{
  AssertRefused(FORMAT_22 NODES_22 "$Elements\n1\n1 4 2 5 5 1 2 3 4\n$EndElements\n", "type 4 are not read");
  AssertRefused(FORMAT_22 NODES_22 "$Elements\n1\n1 1 2 1 1 1 2\n$EndElements\n", "no element of a surface");
  AssertRefused(FORMAT_22 NODES_22 "$Elements\n1\n1 21 2 5 5 1 2 3 4\n$EndElements\n", "type 21 are not read");
}

/* Labels of PETSc's own, and what its reader does not take. */
TEST(names_may_be_any)
{
  AssertSound(FORMAT_22
              "$PhysicalNames\n3\n1 1 \"depth\"\n1 2 \"celltype\"\n2 5   \"a: \"b\"\"\n$EndPhysicalNames\n" NODES_22
                  ELEMENTS_22);
  AssertRefused(FORMAT_22 "$PhysicalNames\n2\n1 1 \"a\"\n1 1 \"b\"\n$EndPhysicalNames\n" NODES_22 ELEMENTS_22,
                "physical group 1 of dimension 1 has two names");
}

TEST(long_words_are_refused)
{
  char *text = calloc(1, 20000);

  strcpy(text, FORMAT_22 "$Nodes\n");
  memset(text + strlen(text), 'x', 10000);
  AssertRefused(text, "a word of more than 127 bytes");
  strcpy(text, FORMAT_22 "$PhysicalNames\n1\n1 1 \"");
  memset(text + strlen(text), 'x', 10000);
  strcat(text, "\"\n$EndPhysicalNames\n");
  AssertRefused(text, "of 1 to 63 bytes");
  free(text);
}

TEST_IS(a_place_that_is_no_number_is_refused,
        AssertRefused(FORMAT_22 "$Nodes\n1\n1 nan 0 0\n$EndNodes\n", "line 6: a coordinate is no finite number"));

TEST(a_file_cut_anywhere_is_refused)
{
  const char whole[] = FORMAT_41 NODES_41 ELEMENTS_41;
  char text[sizeof(whole)];

  for (size_t n = 0; n + 2 < sizeof(whole); n++) {
    snprintf(text, n + 1, "%s", whole);
    AssertRefused(text, "");
  }
}

/* ---- one mesh in all formats ---- */

typedef struct {
  int format; /* 22, 40, 41 */
  PetscBool binary, swapped, parametric, partitioned, clockwise;
} Form;

/* Four squares in a row, bent: nine nodes, eight, and two triangles of six twice, the last of them straight-edged in
   the file's words. Tags of entities are those of other physical groups. */
enum { COLUMNS = 9, NODES = 3 * COLUMNS, PIECE = 50, ENTITIES = 5 };
typedef struct {
  int dimension, tag, groups, group[2];
} TestEntity;
static const TestEntity entities[ENTITIES] = {
    {0, 4, 1, {3}}, {1, 9, 1, {1}}, {1, 1, 1, {9}}, {2, 6, 1, {5}}, {2, 5, 2, {6, 5}}};
typedef struct {
  int entity, type, nodes, at[9];
} TestElement;
#define ELEMENTS 9
static const TestElement elements[ELEMENTS] = {{0, 15, 1, {0}},
                                               {1, 8, 3, {0, 2, 1}},
                                               {1, 8, 3, {2, 4, 3}},
                                               {2, 8, 3, {18, 0, 9}},
                                               {3, 10, 9, {0, 2, 20, 18, 1, 11, 19, 9, 10}},
                                               {3, 16, 8, {2, 4, 22, 20, 3, 13, 21, 11}},
                                               {4, 9, 6, {4, 6, 24, 5, 15, 14}},
                                               {4, 9, 6, {4, 24, 22, 14, 23, 13}},
                                               {4, 3, 4, {6, 8, 26, 24}}};

static FILE *out;
static Form form;

static void Int(int64_t value, size_t size)
{
  unsigned char bytes[8];

  if (!form.binary) {
    fprintf(out, "%lld ", (long long)value);
    return;
  }
  for (size_t k = 0; k < size; k++) bytes[form.swapped ? size - 1 - k : k] = (unsigned char)(value >> 8 * k);
  fwrite(bytes, 1, size, out);
}

static void Reals(int n, double first, double second, double rest)
{
  for (int k = 0; k < n; k++) {
    const double value = k == 0 ? first : k == 1 ? second : rest;
    int64_t bits;

    memcpy(&bits, &value, sizeof(bits));
    if (form.binary)
      Int(bits, 8);
    else
      fprintf(out, "%.17g ", value);
  }
}

static void Line(void)
{
  if (!form.binary) fputc('\n', out);
}

static int64_t Tag(int node)
{
  return 1000 - 7 * ((node * 5) % NODES); /* in no order */
}

static void Place(int node)
{
  const double x = 0.5 * (node % COLUMNS), y = 0.5 * (node / COLUMNS);

  Reals(3, x + 0.05 * sin(3 * y), y + 0.1 * sin(2 * x), 0);
}

static void WriteEntities(PetscBool pieces)
{
  fprintf(out, pieces ? "$PartitionedEntities\n" : "$Entities\n");
  if (pieces) {
    Int(2, 8);
    Int(1, 8);
    Int(77, 4);
    Int(2, 4);
  }
  for (int dimension = 0, k = 0; dimension < 4; dimension++, k = 0) {
    for (int e = 0; e < ENTITIES; e++) k += entities[e].dimension == dimension;
    Int(k, 8);
  }
  Line();
  for (int e = 0; e < ENTITIES; e++) {
    const TestEntity *entity = &entities[e];

    Int(entity->tag + (pieces ? PIECE : 0), 4);
    if (pieces) {
      Int(entity->dimension, 4);
      Int(entity->tag, 4);
      Int(2, 8);
      Int(1, 4);
      Int(2, 4);
    }
    Reals(form.format == 41 && !entity->dimension ? 3 : 6, 0, 0, 1);
    Int(pieces ? 0 : entity->groups, 8);
    for (int g = 0; g < entity->groups && !pieces; g++) Int(g ? -entity->group[g] : entity->group[g], 4);
    if (entity->dimension) Int(0, 8);
    Line();
  }
  fprintf(out, pieces ? "\n$EndPartitionedEntities\n" : "\n$EndEntities\n");
}

static void WriteNodes(void)
{
  const char *section = form.format == 22 && form.parametric ? "ParametricNodes" : "Nodes";
  const int piece = form.partitioned ? PIECE : 0;

  fprintf(out, "$%s\n", section);
  if (form.format == 22)
    fprintf(out, "%d\n", NODES);
  else {
    for (int k = 0; k < (form.format == 41 ? 4 : 2); k++) Int((int[]){1, NODES, 1, 1000}[k], 8);
    Line();
    Int(form.format == 40 ? 6 + piece : 2, 4);
    Int(form.format == 40 ? 2 : 6 + piece, 4);
    Int(form.parametric, 4);
    Int(NODES, 8);
    Line();
  }
  for (int n = 0; n < NODES && form.format == 41; n++) {
    Int(Tag(n), 8);
    Line();
  }
  for (int n = 0; n < NODES; n++) {
    if (form.format != 41) Int(Tag(n), 4);
    Place(n);
    if (form.parametric && form.format == 22) {
      Int(2, 4);
      Int(6, 4);
    }
    if (form.parametric) Reals(2, 7, 8, 0);
    Line();
  }
  fprintf(out, "\n$End%s\n", section);
}

static void WriteElementNodes(const TestElement *element)
{
  static const int turned[][9] = {{0, 3, 2, 1, 7, 6, 5, 4, 8}, {0, 2, 1, 5, 4, 3}};

  for (int i = 0; i < element->nodes; i++) {
    const int triangle = element->type == 9, as = form.clockwise && element->nodes > 3 ? turned[triangle][i] : i;

    Int(Tag(element->at[as]), form.format == 41 ? 8 : 4);
  }
  Line();
}

/* In format 2.2 an element stands there once for each of its groups. */
static void WriteElements(void)
{
  int number = 0;

  fprintf(out, "$Elements\n");
  if (form.format == 22)
    fprintf(out, "%d\n", ELEMENTS + 3);
  else
    for (int k = 0; k < (form.format == 41 ? 4 : 2); k++) Int((int[]){ELEMENTS, ELEMENTS, 1, 99}[k], 8);
  Line();
  for (int e = 0; e < ELEMENTS; e++) {
    const TestElement *element = &elements[e];
    const TestEntity *entity = &entities[element->entity];

    if (form.format > 22) {
      const int tag = entity->tag + (form.partitioned ? PIECE : 0);

      Int(form.format == 40 ? tag : entity->dimension, 4);
      Int(form.format == 40 ? entity->dimension : tag, 4);
      Int(element->type, 4);
      Int(1, 8);
      Line();
      Int(++number, form.format == 41 ? 8 : 4);
      WriteElementNodes(element);
    } else
      for (int g = 0; g < entity->groups; g++) {
        if (!form.binary) Int(++number, 4);
        Int(element->type, 4);
        if (form.binary) Int(1, 4);
        Int(form.partitioned ? 5 : 2, 4);
        if (form.binary) Int(++number, 4);
        Int(entity->group[g], 4);
        Int(entity->tag, 4);
        for (int k = 0; k < 3 && form.partitioned; k++) Int((int[]){2, 1, -2}[k], 4);
        WriteElementNodes(element);
      }
  }
  fprintf(out, "\n$EndElements\n");
}

static void Write(void)
{
  out = fopen(path, "wb");
  fprintf(out, "$MeshFormat\n%s %d 8\n", form.format == 22 ? "2.2" : form.format == 40 ? "4" : "4.1", form.binary);
  if (form.binary) Int(1, 4);
  fprintf(out,
          "\n$EndMeshFormat\n$Comments\nwords\n$EndComments\n$PhysicalNames\n6\n"
          "2 5 \"skin\"\n2 6 \"core\"\n1 1 \"skin\"\n1 9 \"left\"\n0 3 \"spot\"\n1 5 \"nowhere\"\n$EndPhysicalNames\n");
  if (form.format > 22) WriteEntities(PETSC_FALSE);
  if (form.format > 22 && form.partitioned) WriteEntities(PETSC_TRUE);
  WriteNodes();
  WriteElements();
  assert_int_equal(fclose(out), 0);
}

static void SetUp(Fixture *fixture)
{
  FixtureScene(fixture, 1, 1, 1, 1);
  fixture->scene.macro.source = LAM_MESH_GMSH;
  strcpy(fixture->scene.macro.gmsh, path);
  FixtureBoundary(fixture, "skin", 0, 0);
  Write();
  FixtureSetUp(fixture, PETSC_COMM_SELF);
  unlink(path);
}

/* Names and places of what it holds. */
TEST(a_mesh_of_all_elements)
{
  FIXTURE fixture;
  PetscInt on[3] = {0, 0, 0}, in[2] = {0, 0};

  form = (Form){.format = 22};
  SetUp(&fixture);
  const LamMacro macro = fixture.macro;
  assert_int_equal(macro->set_count, 3);
  assert_int_equal(macro->group_count, 2);
  assert_int_equal(macro->element_count, 5);
  for (PetscInt k = 0; k < macro->node_count; k++)
    for (int s = 0; s < 3; s++)
      on[s] += LamMacroIsOn(macro, macro->nodes[k].point, (const char *[]){"spot", "skin", "left"}[s]);
  for (PetscInt e = 0; e < macro->element_count; e++)
    for (int g = 0; g < 2; g++) in[g] += macro->elements[e].groups >> g & 1;
  assert_int_equal(on[0], 1);
  assert_int_equal(on[1], 5);
  assert_int_equal(on[2], 3);
  assert_string_equal(macro->group_name[0], "skin");
  assert_int_equal(in[0], 5);
  assert_int_equal(in[1], 3);
  for (PetscInt k = 0; k < macro->node_count; k++) { /* all are where the map puts them, but on the straight edges */
    const PetscReal *X = macro->nodes[k].X;
    PetscReal nearest = 1;

    for (int n = 0; n < NODES; n++) {
      const double x = 0.5 * (n % COLUMNS), y = 0.5 * (n / COLUMNS);
      nearest = PetscMin(nearest, hypot(x + 0.05 * sin(3 * y) - X[0], y + 0.1 * sin(2 * x) - X[1]));
    }
    if (X[0] < 3.1) assert_true(nearest < 1e-15 || (X[0] > 1.4 && X[0] < 1.6)); /* eight nodes: no centre */
  }
}

/* Formats, bytes in either order, parameters, partitions, clockwise elements: it is the same mesh. */
TEST(all_formats_are_one_mesh)
{
  FIXTURE first;

  form = (Form){.format = 22};
  SetUp(&first);
  for (int k = 0; k < 3 * 3 * 8; k++) {
    const int bytes = k / 3 % 3, more = k / 9;
    FIXTURE other;

    form = (Form){.format = (int[]){22, 40, 41}[k % 3],
                  .binary = bytes > 0,
                  .swapped = bytes > 1,
                  .parametric = more & 1,
                  .partitioned = more >> 1 & 1,
                  .clockwise = more >> 2 & 1};
    SetUp(&other);
    const LamMacro a = first.macro, b = other.macro;
    assert_int_equal(a->mesh_end, b->mesh_end);
    assert_int_equal(a->point_count, b->point_count);
    assert_memory_equal(a->position, b->position, sizeof(PetscReal) * 2 * (size_t)a->mesh_end);
    assert_memory_equal(a->weight, b->weight, sizeof(PetscReal) * (size_t)a->point_count);
    assert_memory_equal(a->sets, b->sets, sizeof(*a->sets) * (size_t)a->mesh_end);
    for (PetscInt e = 0; e < a->element_count; e++) assert_int_equal(a->elements[e].groups, b->elements[e].groups);
  }
}
