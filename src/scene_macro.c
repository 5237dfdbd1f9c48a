/*
  The `macro` block of a scene.
*/
#include "scene_keys.h"
#include <stdio.h>
#include <string.h>

/* The conditions side by side: which components are held, where. */
typedef struct {
  const LamNode *entry[LAM_BOX_COUNT]; /* NULL: nothing is said about this side */
  PetscBool given[LAM_BOX_COUNT][2];
  PetscReal displacement[LAM_BOX_COUNT][2];
} Sides;

/* The sides that a box or a disc has, by name; NULL: the mesh's file names them. */
static const char *const *SideNames(const LamMacroSpec *spec)
{
  static const char *const disc[][4] = {
      [LAM_DISC_WHOLE] = {"rim"}, [LAM_DISC_HALF] = {"rim", "bottom"}, [LAM_DISC_QUARTER] = {"rim", "bottom", "left"}};
  static const char *const box[] = {LAM_SIDES(LAM_NAME_ENTRY) NULL};

  if (spec->source == LAM_MESH_GMSH) return NULL;
  return spec->source == LAM_MESH_BOX ? box : disc[spec->disc];
}

/* Where the name is in the list; -1: not there, and `known` says which are. */
static PetscInt FindName(const char *const *names, const char name[], char known[80])
{
  known[0] = '\0';
  for (PetscInt k = 0; names[k]; k++) {
    if (!strcmp(names[k], name)) return k;
    snprintf(known + strlen(known), 80 - strlen(known), "%s%s", k ? ", " : "", names[k]);
  }
  return -1;
}

static PetscErrorCode CheckSide(const LamDocument *document, const LamNode *on, const LamNode *displacement,
                                const LamBoundary *boundary, const LamScene *scene, Sides *sides)
{
  const char *const *names = SideNames(&scene->macro);
  char known[80];
  PetscInt side;

  PetscFunctionBeginUser;
  if (!names) PetscFunctionReturn(0);
  side = FindName(names, boundary->on, known);
  if (side < 0) PetscCall(LamSceneFail(document, on, "is none of the names known here; write one of %s", known));
  if (sides->entry[side]) {
    PetscCall(LamSceneFail(document, on,
                           "this side has a condition already, in line %d; give one condition for each side",
                           sides->entry[side]->line));
  }
  sides->entry[side] = displacement;
  for (PetscInt c = 0; c < 2; c++) {
    sides->given[side][c] = boundary->given[c];
    sides->displacement[side][c] = boundary->displacement[c];
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildBoundary(const LamDocument *document, const LamNode *entry, LamScene *scene, Sides *sides)
{
  LamBoundary *boundary = &scene->macro.boundary[scene->macro.boundary_count++];
  const LamNode *on, *node;
  LamValue unused, displacement;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "macro.boundary[].on", &on, &unused));
  PetscCall(LamSceneGet(entry, "macro.boundary[].displacement", &node, &displacement));
  if (strlen(on->text) >= sizeof(boundary->on))
    PetscCall(LamSceneFail(document, on, "is too long; names have less than %d letters", LAM_NAME_LENGTH));
  PetscCall(PetscStrncpy(boundary->on, on->text, sizeof(boundary->on)));
  for (PetscInt c = 0; c < 2; c++) {
    boundary->given[c] = displacement.is_free[c] ? PETSC_FALSE : PETSC_TRUE;
    PetscCall(
        LamSceneScale(document, node, displacement.number[c], scene->scales.macro_length, &boundary->displacement[c]));
  }
  PetscCall(CheckSide(document, on, node, boundary, scene, sides));
  PetscFunctionReturn(0);
}

/* Sides that meet share a corner: both move it, so they agree. */
static PetscErrorCode CheckCorners(const LamDocument *document, const Sides *sides)
{
  PetscFunctionBeginUser;
  for (LamSide upright = LAM_BOX_LEFT; upright <= LAM_BOX_RIGHT; upright++) {
    for (LamSide level = LAM_BOX_BOTTOM; level <= LAM_BOX_TOP; level++) {
      for (PetscInt c = 0; c < 2; c++) {
        if (!sides->given[upright][c] || !sides->given[level][c]) continue;
        if (sides->displacement[upright][c] == sides->displacement[level][c]) continue;
        PetscCall(LamSceneFail(document, sides->entry[upright],
                               "%s and %s (line %d) move their common corner differently along X%d; write equal "
                               "displacements, or free in one of them",
                               LamSideNames[upright], LamSideNames[level], sides->entry[level]->line, (int)c + 1));
      }
    }
  }
  PetscFunctionReturn(0);
}

/*
  Rigid motions of a box: along X1, along X2, and the rotation u = w (-X2, X1). A side holds a translation where its
  component is given. The rotation changes u1 along the upright sides and u2 along the level ones, so one of these holds
  it; a component that is constant along its side holds it only together with the opposite side.
*/
static PetscErrorCode CheckRigidMotions(const LamDocument *document, const LamNode *list, const Sides *sides)
{
  const PetscBool(*given)[2] = sides->given;
  PetscBool held[3] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
  static const char *const names[] = {"along X1", "along X2", "by a rotation"};
  static const char *const remedies[] = {
      "give the first displacement component on a side", "give the second displacement component on a side",
      "give the first component on left or right, or the second on bottom or top, or one on both opposite sides"};

  PetscFunctionBeginUser;
  for (LamSide side = 0; side < LAM_BOX_COUNT; side++) {
    for (PetscInt c = 0; c < 2; c++) held[c] = held[c] || given[side][c] ? PETSC_TRUE : PETSC_FALSE;
  }
  held[2] = given[LAM_BOX_LEFT][0] || given[LAM_BOX_RIGHT][0] || given[LAM_BOX_BOTTOM][1] || given[LAM_BOX_TOP][1] ||
                    (given[LAM_BOX_LEFT][1] && given[LAM_BOX_RIGHT][1]) ||
                    (given[LAM_BOX_BOTTOM][0] && given[LAM_BOX_TOP][0])
                ? PETSC_TRUE
                : PETSC_FALSE;
  for (PetscInt i = 0; i < 3; i++) {
    if (!held[i]) PetscCall(LamSceneFailName(document, list, "the body can still move %s; %s", names[i], remedies[i]));
  }
  PetscFunctionReturn(0);
}

/* Exactly one of box, disc and gmsh says where the mesh comes from. */
static PetscErrorCode ChooseSource(const LamDocument *document, LamMacroSpec *spec, const LamNode **node)
{
  static const char *const paths[] = {"macro.mesh.box", "macro.mesh.disc", "macro.mesh.gmsh"};
  const LamNode *mesh, *given[3];
  LamValue unused;
  int count = 0;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro.mesh", &mesh, &unused));
  for (int k = 0; k < 3; k++) {
    PetscCall(LamSceneGet(document->root, paths[k], &given[k], &unused));
    if (!given[k]) continue;
    spec->source = (LamMeshSource)k;
    *node = given[k];
    count++;
  }
  if (!count)
    PetscCall(LamSceneFailMissing(document, mesh, "box",
                                  "missing; write box: [10 mm, 10 mm], or disc: 5 mm, or gmsh: file.msh"));
  if (count > 1)
    PetscCall(LamSceneFail(document, *node, "the mesh is one of box, disc and gmsh; leave the others out"));
  PetscFunctionReturn(0);
}

/* A key that belongs to one source of meshes alone. */
static PetscErrorCode CheckBelongs(const LamDocument *document, const char path[], LamMeshSource source,
                                   const char owner[], const LamMacroSpec *spec)
{
  const LamNode *node;
  LamValue unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, path, &node, &unused));
  if (node && spec->source != source)
    PetscCall(LamSceneFail(document, node, "belongs to %s, which this mesh is not; leave it out", owner));
  PetscFunctionReturn(0);
}

/* A path in the file is relative to the scene's folder. */
static PetscErrorCode ResolvePath(const LamDocument *document, const LamNode *node, char path[PETSC_MAX_PATH_LEN])
{
  const char *slash = strrchr(document->name, '/');
  const int folder = node->text[0] == '/' || !slash ? 0 : (int)(slash - document->name) + 1;

  PetscFunctionBeginUser;
  if (folder + strlen(node->text) >= PETSC_MAX_PATH_LEN)
    PetscCall(LamSceneFail(document, node, "the path is too long"));
  snprintf(path, PETSC_MAX_PATH_LEN, "%.*s%s", folder, document->name, node->text);
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildMesh(const LamDocument *document, LamScene *scene)
{
  LamMacroSpec *spec = &scene->macro;
  const LamNode *node = NULL, *mesh;
  LamValue size, elements, other;

  PetscFunctionBeginUser;
  PetscCall(ChooseSource(document, spec, &node));
  PetscCall(CheckBelongs(document, "macro.mesh.part", LAM_MESH_DISC, "a disc", spec));
  PetscCall(CheckBelongs(document, "macro.mesh.unit", LAM_MESH_GMSH, "a Gmsh file", spec));
  PetscCall(LamSceneGet(document->root, "macro.mesh", &mesh, &other));
  PetscCall(LamSceneGet(document->root, "macro.mesh.elements", NULL, &elements));
  if (spec->source == LAM_MESH_GMSH) {
    if (elements.count)
      PetscCall(
          LamSceneFail(document, LamNodeFindPath(mesh, "elements"), "a Gmsh file has its own elements; leave it out"));
    PetscCall(ResolvePath(document, node, spec->gmsh));
    PetscCall(LamSceneGet(document->root, "macro.mesh.unit", NULL, &size));
    scene->scales.macro_length = size.number[0];
    PetscFunctionReturn(0);
  }
  if (!elements.count)
    PetscCall(LamSceneFailMissing(document, mesh, "elements", "missing; write two numbers, such as [8, 8]"));
  for (PetscInt i = 0; i < 2; i++) spec->elements[i] = (PetscInt)elements.number[i];
  PetscCall(
      LamSceneGet(document->root, spec->source == LAM_MESH_BOX ? "macro.mesh.box" : "macro.mesh.disc", &node, &size));
  scene->scales.macro_length = size.number[0];
  for (PetscInt i = 0; i < size.count; i++)
    PetscCall(LamSceneScale(document, node, size.number[i], scene->scales.macro_length, &spec->box[i]));
  PetscCall(LamSceneGet(document->root, "macro.mesh.part", NULL, &other));
  spec->disc = (LamDiscPart)other.number[0];
  PetscFunctionReturn(0);
}

/*
  A body that inflates freely ends at zero total stress, where every mean face traction is zero, whatever the turgor is:
  contact alone then holds no cell.
*/
static PetscErrorCode CheckInflation(const LamDocument *document, const LamNode *block, const LamNode *inflate_node,
                                     const LamScene *scene)
{
  static const char *const remedy =
      "free tissue is held together only by the lamella; give interface.cohesion > 0, or inflate: false";

  PetscFunctionBeginUser;
  if (!scene->macro.inflate || scene->micro.interface != LAM_INTERFACE_CONTACT || scene->cohesion > 0.0)
    PetscFunctionReturn(0);
  if (inflate_node)
    PetscCall(LamSceneFail(document, inflate_node, "law: contact has no cohesion; %s", remedy));
  else
    PetscCall(LamSceneFailMissing(document, block, "inflate",
                                  "missing, so true with turgor, but law: contact has no cohesion; %s", remedy));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildZoom(const LamDocument *document, LamScene *scene)
{
  const LamNode *list;
  LamValue unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro.zoom", &list, &unused));
  if (!list) PetscFunctionReturn(0);
  if (list->count > LAM_MAX_ZOOMS)
    PetscCall(LamSceneFail(document, list, "has more than %d places; leave some out", LAM_MAX_ZOOMS));
  for (const LamNode *item = list->first; item; item = item->next) {
    PetscReal *place = scene->macro.zoom[scene->macro.zoom_count++];
    for (int i = 0; i < 2; i++)
      PetscCall(LamSceneScale(document, item, item->value.number[i], scene->scales.macro_length, &place[i]));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildMacro(const LamDocument *document, LamScene *scene)
{
  const LamNode *block, *list, *inflate_node;
  LamValue inflate, steps, unused;
  Sides sides = {0};

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro", &block, &unused));
  if (!block) PetscFunctionReturn(0);
  scene->has_macro = PETSC_TRUE;
  PetscCall(BuildMesh(document, scene));
  PetscCall(LamSceneGet(document->root, "macro.inflate", &inflate_node, &inflate));
  scene->macro.inflate = scene->turgor != 0.0 ? PETSC_TRUE : PETSC_FALSE;
  if (inflate_node) scene->macro.inflate = inflate.number[0] != 0.0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(CheckInflation(document, block, inflate_node, scene));
  PetscCall(LamSceneGet(document->root, "macro.steps", NULL, &steps));
  scene->macro.steps = (PetscInt)steps.number[0];
  PetscCall(LamSceneGet(document->root, "macro.boundary", &list, &unused));
  for (const LamNode *entry = list->first; entry; entry = entry->next) {
    PetscCall(BuildBoundary(document, entry, scene, &sides));
  }
  PetscCall(BuildZoom(document, scene));
  if (scene->macro.source == LAM_MESH_BOX) { /* of other bodies the macroscale solver checks it */
    PetscCall(CheckCorners(document, &sides));
    PetscCall(CheckRigidMotions(document, list, &sides));
  }
  PetscFunctionReturn(0);
}
