/*
  The `sample` block of a scene.
*/
#include "scene_rows.h"

static const LamKey sample_keys[] = {
    {MAP("sample"), .example = "{stretch: {min: -0.05, max: 0.25}}",
     .help = "States for `lamella build`: a box of deformations and turgor that a table covers."},
    {MAP("sample.stretch"), REQUIRED, .example = "{min: -0.05, max: 0.25}",
     .help = "Principal logarithmic strains in the plane."},
    {REAL("sample.stretch.min"), INTO(LamSample, stretch_min), REQUIRED, FROM(-2), TO(2), .example = "-0.05",
     .help = "Smallest."},
    {REAL("sample.stretch.max"), INTO(LamSample, stretch_max), REQUIRED, FROM(-2), TO(2), .example = "0.25",
     .help = "Largest; not below `min`."},
    {MAP("sample.turgor"), .default_words = "the scene's turgor alone", .example = "{min: 0 MPa, max: 0.05 MPa}",
     .help = "Turgor."},
    {STRESS("sample.turgor.min"), INTO(LamSample, turgor_min), REQUIRED, .example = "0 MPa", .help = "Smallest."},
    {STRESS("sample.turgor.max"), INTO(LamSample, turgor_max), REQUIRED, .example = "0.05 MPa",
     .help = "Largest; not below `min`."},
    {MAP("sample.F33"), .default_words = "1 alone; 0.7 to 1.5 with an axisymmetric body",
     .example = "{min: 0.8, max: 1.2}",
     .help = "Stretch along the cells' axis, as that around the axis of an axisymmetric body."},
    {REAL("sample.F33.min"), INTO(LamSample, F33_min), REQUIRED, FROM(0.2), TO(5), .example = "0.8",
     .help = "Smallest."},
    {REAL("sample.F33.max"), INTO(LamSample, F33_max), REQUIRED, FROM(0.2), TO(5), .example = "1.2",
     .help = "Largest; above `min`."},
    {INTEGER("sample.count"), INTO(LamSample, count), FROM(1), TO(100000000),
     .default_words = "as many as the accuracy needs", .example = "1000",
     .help = "Number of nodes of the table; those where it is least accurate come first."},
    {REAL("sample.accuracy"), INTO(LamSample, accuracy), ABOVE(0), TO(0.5), .default_words = "the scene's `accuracy`",
     .example = "0.01", .help = "Add nodes until the estimated error is below this; instead of `count`."},
    {INTEGER("sample.round"), INTO(LamSample, round), FROM(1), TO(1000000), .default_value = "32", .example = "1000",
     .help = "Nodes that are begun together, at least. More keep more ranks busy, but are chosen from an older table."},
};
LAM_KEY_TABLE(LamSampleKeys, sample_keys);

/* A range must have both ends. */
static PetscErrorCode CheckRange(const LamNode *range)
{
  const LamNode *min = LamNodeFind(range, "min"), *max = LamNodeFind(range, "max");

  PetscFunctionBeginUser;
  LamSceneCheck(!range || min->value.number[0] <= max->value.number[0], min,
                "min is larger than max (%s in line %d); exchange them", max->text, max->line);
  PetscFunctionReturn(0);
}

/* Without `F33`. That of a cylinder at 30 % and of a fruit at a probe, with turgor, is 1.05 to 1.39. */
static void DefaultF33(const LamScene *scene, LamSample *sample)
{
  const PetscBool around = (PetscBool)(scene->macro.symmetry == LAM_AXISYMMETRIC);

  sample->F33_min = around ? 0.7 : 1;
  sample->F33_max = around ? 1.5 : 1;
}

/* One F33 would be another plane strain, for which there is no axis. */
static PetscErrorCode CheckF33(const LamNode *range, const LamSample *sample)
{
  PetscFunctionBeginUser;
  PetscCall(CheckRange(range));
  LamSceneCheck(!range || sample->F33_max > sample->F33_min, LamNodeFind(range, "max"),
                "is not above min; write a range, or leave `F33` out for plane strain");
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildSample(const LamNode *root, LamScene *scene)
{
  const LamNode *block = LamNodeFind(root, "sample"), *turgor = LamNodeFind(block, "turgor");
  const LamNode *count = LamNodeFind(block, "count"), *accuracy = LamNodeFind(block, "accuracy");
  LamSample *sample = &scene->sample;

  PetscFunctionBeginUser;
  DefaultF33(scene, sample);
  if (!block) PetscFunctionReturn(0);
  LamSceneCheckName(!scene->sealed, block,
                    "contradicts turgor mode: sealed; a database holds states of prescribed turgor, from which those "
                    "of sealed cells follow: write mode: prescribed");
  LamSceneCheckName(!count || !accuracy, accuracy, "given together with count; a sample has one of them");
  if (scene->micro.interface == LAM_INTERFACE_LAMELLA)
    PetscCall(
        LamSceneWarn(scene, block, LAM_MISTAKE_NAME, NULL,
                     "lamella build will refuse law: lamella, whose responses depend on history; leave it out, or "
                     "write law: bonded or contact"));
  scene->has_sample = PETSC_TRUE;
  sample->turgor_min = sample->turgor_max = scene->turgor;
  sample->accuracy = count ? 0.0 : scene->accuracy;
  PetscCall(LamSceneFill(block, &scene->scales, LamSample, sample));
  PetscCall(CheckRange(LamNodeFind(block, "stretch")));
  PetscCall(CheckRange(turgor));
  PetscCall(CheckF33(LamNodeFind(block, "F33"), sample));
  for (const LamNode *end = turgor ? turgor->first : NULL; end; end = end->next)
    PetscCall(LamSceneCheckTurgor(end, end->value.number[0]));
  PetscFunctionReturn(0);
}
