/*
  The `sample` block of a scene.
*/
#include "scene_rows.h"

static const LamKey sample_keys[] = {
    {MAP("sample"), .example = "{stretch: {min: -0.05, max: 0.25}}",
     .help = "States for `lamella build`: a box of deformations and turgor, to be answered by a table."},
    {MAP("sample.stretch"), REQUIRED, .example = "{min: -0.05, max: 0.25}",
     .help = "Principal logarithmic strains in the plane."},
    {REAL("sample.stretch.min"), REQUIRED, FROM(-2), TO(2), .example = "-0.05", .help = "Smallest."},
    {REAL("sample.stretch.max"), REQUIRED, FROM(-2), TO(2), .example = "0.25", .help = "Largest; not below `min`."},
    {MAP("sample.turgor"), .default_words = "the scene's turgor alone", .example = "{min: 0 MPa, max: 0.05 MPa}",
     .help = "Turgor."},
    {STRESS("sample.turgor.min"), REQUIRED, .example = "0 MPa", .help = "Smallest."},
    {STRESS("sample.turgor.max"), REQUIRED, .example = "0.05 MPa", .help = "Largest; not below `min`."},
    {INTEGER("sample.count"), FROM(1), TO(100000000), .default_words = "as many as the accuracy needs",
     .example = "1000", .help = "Number of nodes of the table; those where it is least accurate come first."},
    {REAL("sample.accuracy"), ABOVE(0), TO(0.5), .default_words = "the scene's `accuracy`", .example = "0.01",
     .help = "Add nodes until the estimated error is below this; instead of `count`."},
    {INTEGER("sample.round"), FROM(1), TO(1000000), .default_value = "32", .example = "1000",
     .help = "Nodes that are begun together, at least. More keep more ranks busy, but are chosen from an older table."},
};
LAM_KEY_TABLE(LamSampleKeys, sample_keys);

/* Reads <path>.min and <path>.max; *given is PETSC_FALSE where the file has neither. */
static PetscErrorCode GetRange(const LamDocument *document, const char min_path[], const char max_path[],
                               const LamNode *nodes[2], PetscReal range[2])
{
  LamValue value;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, min_path, &nodes[0], &value));
  range[0] = value.number[0];
  PetscCall(LamSceneGet(document->root, max_path, &nodes[1], &value));
  range[1] = value.number[0];
  if (nodes[0] && range[0] > range[1]) {
    PetscCall(LamSceneFail(document, nodes[0], "min is larger than max (%s in line %d); exchange them", nodes[1]->text,
                           nodes[1]->line));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildSampleTurgor(const LamDocument *document, LamScene *scene)
{
  const LamNode *nodes[2];
  PetscReal range[2];

  PetscFunctionBeginUser;
  PetscCall(GetRange(document, "sample.turgor.min", "sample.turgor.max", nodes, range));
  if (!nodes[0]) {
    scene->sample.turgor_min = scene->sample.turgor_max = scene->turgor;
    PetscFunctionReturn(0);
  }
  for (PetscInt i = 0; i < 2; i++) PetscCall(LamSceneCheckTurgor(document, nodes[i], range[i]));
  PetscCall(LamSceneScale(document, nodes[0], range[0], scene->scales.stress, &scene->sample.turgor_min));
  PetscCall(LamSceneScale(document, nodes[1], range[1], scene->scales.stress, &scene->sample.turgor_max));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildSample(const LamDocument *document, LamScene *scene)
{
  const LamNode *block, *count_node, *accuracy_node, *stretch_nodes[2];
  LamValue count, accuracy, round, unused;
  PetscReal stretch[2];

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "sample", &block, &unused));
  if (!block) PetscFunctionReturn(0);
  if (scene->sealed) {
    PetscCall(LamSceneFailName(document, block,
                               "contradicts turgor mode: sealed; a database holds states of prescribed turgor, from "
                               "which those of sealed cells follow: write mode: prescribed"));
  }
  scene->has_sample = PETSC_TRUE;
  PetscCall(GetRange(document, "sample.stretch.min", "sample.stretch.max", stretch_nodes, stretch));
  scene->sample.stretch_min = stretch[0];
  scene->sample.stretch_max = stretch[1];
  PetscCall(BuildSampleTurgor(document, scene));
  PetscCall(LamSceneGet(document->root, "sample.count", &count_node, &count));
  PetscCall(LamSceneGet(document->root, "sample.accuracy", &accuracy_node, &accuracy));
  if (count_node && accuracy_node) {
    PetscCall(LamSceneFailName(document, accuracy_node, "given together with count; a sample has one of them"));
  }
  if (count_node)
    scene->sample.count = (PetscInt)count.number[0];
  else
    scene->sample.accuracy = accuracy_node ? accuracy.number[0] : scene->accuracy;
  PetscCall(LamSceneGet(document->root, "sample.round", &block, &round));
  scene->sample.round = (PetscInt)round.number[0];
  PetscFunctionReturn(0);
}
