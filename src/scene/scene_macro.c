/*
  The `macro` block of a scene.
*/
#include "scene_keys.h"
#include <stdio.h>
#include <string.h>

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

PetscErrorCode LamSceneResolvePath(const LamDocument *document, const LamNode *node, char path[PETSC_MAX_PATH_LEN])
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
    PetscCall(LamSceneResolvePath(document, node, spec->gmsh));
    PetscCall(LamSceneGet(document->root, "macro.mesh.unit", NULL, &size));
    scene->scales.macro_length = size.number[0];
    PetscCall(LamSceneCheckScale(document, LamNodeFindPath(mesh, "unit"), size.number[0]));
    PetscFunctionReturn(0);
  }
  if (!elements.count)
    PetscCall(LamSceneFailMissing(document, mesh, "elements", "missing; write two numbers, such as [8, 8]"));
  for (PetscInt i = 0; i < 2; i++) spec->elements[i] = (PetscInt)elements.number[i];
  PetscCall(
      LamSceneGet(document->root, spec->source == LAM_MESH_BOX ? "macro.mesh.box" : "macro.mesh.disc", &node, &size));
  scene->scales.macro_length = size.number[0];
  PetscCall(LamSceneCheckScale(document, node, size.number[0]));
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
  const LamNode *block, *inflate_node;
  LamValue inflate, unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "macro", &block, &unused));
  if (!block) PetscFunctionReturn(0);
  scene->has_macro = PETSC_TRUE;
  PetscCall(BuildMesh(document, scene));
  PetscCall(LamSceneGet(document->root, "macro.inflate", &inflate_node, &inflate));
  scene->macro.inflate = scene->turgor != 0.0 ? PETSC_TRUE : PETSC_FALSE;
  if (inflate_node) scene->macro.inflate = inflate.number[0] != 0.0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(CheckInflation(document, block, inflate_node, scene));
  PetscCall(LamSceneBuildBoundaries(document, scene));
  PetscCall(LamSceneBuildProgram(document, scene));
  PetscCall(BuildZoom(document, scene));
  PetscFunctionReturn(0);
}
