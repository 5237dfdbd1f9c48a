/* Gmsh files: sound ones of each format pass, and what PETSc would believe without looking is refused with the line. */
#include "support/test.h"
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

static PetscBool Check(const char text[], char why[LAM_GMSH_WHY])
{
  char path[] = "lamella-gmsh-XXXXXX";
  const int file = mkstemp(path);
  PetscBool good;

  assert_true(file >= 0);
  assert_int_equal(write(file, text, strlen(text)), strlen(text));
  close(file);
  good = LamGmshCheck(path, why);
  unlink(path);
  return good;
}

static void AssertSound(const char text[])
{
  char why[LAM_GMSH_WHY] = "";

  if (!Check(text, why)) fail_msg("%s", why);
}

static void AssertRefused(const char text[], const char part[])
{
  char why[LAM_GMSH_WHY] = "";

  assert_false(Check(text, why));
  if (!strstr(why, part)) fail_msg("\"%s\" lacks \"%s\"", why, part);
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
                "line 13: an element has node 5, which is not in $Nodes");
  AssertRefused(FORMAT_41 NODES_41 "$Elements\n1 1 1 1\n2 1 3 1\n2 1 2 3 999999999\n$EndElements\n", "node 999999999");
}

TEST(an_entity_that_is_not_there_is_refused)
{
  AssertRefused(FORMAT_41 "$Nodes\n1 1 1 1\n2 7 0 1\n1\n0 0 0\n$EndNodes\n", "not in $Entities");
  AssertRefused(FORMAT_40 NODES_40 "$Elements\n1 1\n7 2 3 1\n2 1 2 3 4\n$EndElements\n", "not in $Entities");
}

TEST(more_than_the_file_has_room_for_is_refused)
{
  AssertRefused(FORMAT_22 "$Nodes\n1000000000\n1 0 0 0\n", "1000000000 is not the whole number wanted");
  AssertRefused(FORMAT_41 "$Nodes\n1 900000000 1 4\n", "900000000 is not");
  AssertRefused(FORMAT_41 NODES_41 "$Elements\n1 2 1 2\n2 1 3 1\n2 1 2 3 4\n$EndElements\n", "not as many elements");
}

/* PETSc takes memory from the least to the largest. */
TEST(tags_that_are_far_apart_are_refused)
{
  AssertRefused(FORMAT_22 "$Nodes\n2\n1 0 0 0\n2000000000 1 0 0\n$EndNodes\n" ELEMENTS_22, "from 1 to 2000000000");
  AssertRefused(FORMAT_41 "$Nodes\n1 1 2817 4\n2 1 0 1\n1\n0 0 0\n$EndNodes\n", "said to be from 2817 to 4");
}

TEST_IS(an_element_with_a_node_twice_is_refused,
        AssertRefused(FORMAT_22 NODES_22 "$Elements\n1\n1 3 2 5 5 1 2 3 3\n$EndElements\n", "has node 3 twice"));

TEST(a_line_that_is_on_no_element_is_refused)
{
  AssertRefused(FORMAT_22 NODES_22 "$Elements\n2\n1 1 2 1 1 1 3\n2 3 2 5 5 1 2 3 4\n$EndElements\n",
                "the line from node 1 to 3 is on no element");
}

TEST(what_is_no_plane_body_is_refused)
{
  AssertRefused(FORMAT_22 NODES_22 "$Elements\n1\n1 4 2 5 5 1 2 3 4\n$EndElements\n", "type 4 are not read");
  AssertRefused(FORMAT_22 NODES_22 "$Elements\n1\n1 1 2 1 1 1 2\n$EndElements\n", "no element of a surface");
  AssertRefused(FORMAT_22 NODES_22 "$Elements\n1\n1 21 2 5 5 1 2 3 4\n$EndElements\n", "type 21 are not read");
}

/* These are labels of PETSc's own. */
TEST(names_that_are_taken_are_refused)
{
  AssertRefused(FORMAT_22 "$PhysicalNames\n1\n1 1 \"depth\"\n$EndPhysicalNames\n", "cannot have the name depth");
  AssertRefused(FORMAT_22 "$PhysicalNames\n1\n1 1 \"celltype\"\n$EndPhysicalNames\n", "cannot have the name celltype");
}

TEST(names_that_PETSc_misreads_are_refused)
{
  AssertRefused(FORMAT_22 "$PhysicalNames\n1\n1 1  \"base\"\n$EndPhysicalNames\n", "behind one blank");
  AssertRefused(FORMAT_22 "$PhysicalNames\n1\n1 1 \"a:b\"\n$EndPhysicalNames\n", "holds a colon");
}

TEST(long_words_are_refused)
{
  char *text = calloc(1, 20000);

  strcpy(text, FORMAT_22 "$Comments\n");
  memset(text + strlen(text), 'x', 10000);
  AssertRefused(text, "a word of more than 127 bytes");
  strcpy(text, FORMAT_22 "$PhysicalNames\n1\n1 1 \"");
  memset(text + strlen(text), 'x', 10000);
  strcat(text, "\"\n$EndPhysicalNames\n");
  AssertRefused(text, "of 1 to 119 bytes");
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
