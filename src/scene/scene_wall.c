/*
  Walls in a scene: `rve.wall`, and the walls of kinds of cells and of regions.
*/
#include "scene_rows.h"

#define LAW_HELP(symbol, name, fibres, help) "`" name "`: " help
#define NEED_ALWAYS(law) REQUIRED
#define NEED_BY_LAW(law) .default_words = "none: required by law `" #law "`"
#define NEED_OPTIONAL(law) .default_value = "0"
#define ONLY_ALWAYS(law) "."
#define ONLY_BY_LAW(law) "; only with law `" #law "`."
#define ONLY_OPTIONAL(law) ONLY_BY_LAW(law)
#define WALL_KEY(X, name, law, kind, need, symbol, sample, about, ...)                                                 \
  {WALL_##kind("rve.wall." #name), INTO(LamWall, name), NEED_##need(law), .example = sample,                           \
   .help = about ONLY_##need(law), __VA_ARGS__},

static const LamKey wall_keys[] = {
    {MAP("rve.wall"), REQUIRED, .example = "{law: mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa}",
     .help = "Material of the cell walls. The small-strain shear modulus without fibres is C1 + C2."},
    {NAME_OF("rve.wall.law", LamWallLawNames, LAM_WALL_LAW_COUNT), INTO(LamWall, law), REQUIRED,
     .help = LAM_WALL_LAWS(LAW_HELP)},
    LAM_WALL_PARAMETERS(WALL_KEY, ) /* the parameters of wall.h */
    {STRESS("rve.wall.bulk_modulus"), INTO(LamWall, bulk_modulus), ABOVE(0), .default_words = "1000 (C1 + C2)",
     .example = "110 MPa", .help = "Bulk modulus, larger than C1 + C2: walls are nearly incompressible."},
    {NAME_OF("rve.wall.fibres", LamFibresNames, LAM_FIBRES_COUNT), INTO(LamWall, fibres), .default_value = "both",
     .help = "Whether fibres also resist compression along the wall (`both`) or stretch alone (`tension`)."},
    {ANGLE("rve.wall.fibre_angle"), INTO(LamWall, fibre_angle), FROM(-90), TO(90), .default_value = "0 deg",
     .help = "Angle between the fibres and the section of the cells: 0 along the wall in the section, 90 deg along the "
             "cells' axis, X3. Between them fibres wind around the cells as a helix, which couples stretch and twist."},
    {LIST("rve.wall.relaxation"), .default_words = "walls have no memory",
     .example = "[{share: 0.3, time: 10 s}, {share: 0.2, time: 10 min}]",
     .help =
         "How stress relaxes in walls whose strain is held, in all of them alike: a Prony series of 1 to 3 terms on "
         "the stress of matrix and fibres. C1, C2 and those of the fibres are the moduli at once; a change of volume "
         "is resisted as ever. For `rve` and `process`; a database is of the walls at once, from whose responses `process` "
         "approximates those of walls that relax."},
    {MAP("rve.wall.relaxation[]"), .example = "{share: 0.3, time: 10 s}", .help = "One term."},
    {REAL("rve.wall.relaxation[].share"), REQUIRED, ABOVE(0), BELOW(1), .example = "0.3",
     .help = "Share of the moduli that is lost; all terms together less than 1."},
    {TIME("rve.wall.relaxation[].time"), REQUIRED, FROM(0), .example = "10 s",
     .help = "Relaxation time: after it 1/e of this share is left."},
};
LAM_KEY_TABLE(LamWallKeys, wall_keys);

PetscErrorCode LamSceneBuildRelaxation(const LamNode *root, LamRelaxation *relaxation)
{
  const LamNode *list = LamNodeFind(root, "rve.wall.relaxation"), *tilted = LamNodeFind(root, "rve.wall.fibre_angle");
  PetscReal sum = 0.0;

  PetscFunctionBeginUser;
  LamSceneCheck(!list || list->count > 0, list, "has no term; write one, such as %s, or leave it out",
                LamKeyFind("rve.wall.relaxation[]")->example);
  LamSceneCheck(!list || list->count <= LAM_RELAXATION_TERMS, list, "has %d terms; at most %d are kept in mind",
                (int)(list ? list->count : 0), LAM_RELAXATION_TERMS);
  for (const LamNode *term = list ? list->first : NULL; term; term = term->next) {
    const LamNode *share = LamNodeFind(term, "share"), *time = LamNodeFind(term, "time");
    const PetscInt i = relaxation->terms++;

    LamSceneCheck(!tilted || tilted->value.number[0] == 0.0, list,
                  "does not go with fibre_angle: walls with memory have fibres in the section; leave one of them out");
    relaxation->share[i] = share->value.number[0];
    relaxation->time[i] = time->value.number[0];
    LamSceneCheck(relaxation->time[i] > 0.0, time,
                  "is no time in which this share could be felt; leave the term out, and the share out of the moduli");
    sum += relaxation->share[i];
    LamSceneCheck(sum < 1.0, share,
                  "leaves nothing in the end, %g of the moduli being lost: walls would flow, without a shape to return "
                  "to; write shares of less than 1 in all",
                  (double)sum);
  }
  PetscFunctionReturn(0);
}

/* Checks whether a parameter, given or missing, agrees with the law; `own` as in LamSceneReadWall. */
static PetscErrorCode CheckParameter(const LamNode *map, PetscInt k, const LamWall *own, LamWall *wall)
{
  const char *name = LamWallParameterNames[k], *law = LamWallLawNames[wall->law];
  const LamNode *node = LamNodeFind(map, name);
  char path[LAM_NAME_LENGTH], words[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  snprintf(path, sizeof(path), "rve.wall.%s", name);
  const LamKey *key = LamKeyFind(path);

  if (LamWallLawHas(wall->law, k)) {
    LamSceneRequire(node || (own && LamWallLawHas(own->law, k)) || key->default_value, map, name,
                    "missing; write the %s, such as %s, or law: mooney_rivlin",
                    LamWallParameterWords(k, sizeof(words), words), key->example);
    PetscFunctionReturn(0);
  }
  LamSceneCheck(!node || LamWallGet(wall, k) == 0.0, node, "law %s has no %s; leave %s out, or write law: %s", law,
                LamWallLacking(wall->law, k), name, LamWallLawNames[LamWallOwner(k)]);
  *LamWallAt(wall, k) = 0.0;
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneReadWall(const LamNode *map, const LamScales *scales, const LamWall *own, LamWall *wall)
{
  const PetscReal bulk_ratio = own ? own->bulk_modulus / (own->C1 + own->C2) : 1000.0;
  const LamNode *bulk = LamNodeFind(map, "bulk_modulus");

  PetscFunctionBeginUser;
  *wall = own ? *own : (LamWall){0};
  PetscCall(LamSceneFill(map, scales, LamWall, wall));
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++) PetscCall(CheckParameter(map, k, own, wall));
  LamSceneCheck(wall->fibre_angle == 0.0 || LamWallLawHasFibres(wall->law), LamNodeFind(map, "fibre_angle"),
                "law %s has no fibres; leave fibre_angle out, or write law: %s", LamWallLawNames[wall->law],
                LamWallLawNames[LAM_WALL_FIBRE_MOONEY_RIVLIN]);
  if (!bulk) wall->bulk_modulus = bulk_ratio * (wall->C1 + wall->C2);
  LamSceneCheck(wall->bulk_modulus > wall->C1 + wall->C2, bulk ? bulk : map,
                "cell walls are nearly incompressible; write a bulk modulus of more than C1 + C2 = %g MPa",
                (double)((wall->C1 + wall->C2) * scales->stress) * 1e-6);
  PetscFunctionReturn(0);
}

/* Wall i = 0, 1, ... of the scene's tissue, its cells and its regions, some of them more than once; NULL after the
 * last. */
static const LamWall *WallAt(const LamScene *scene, PetscInt i)
{
  for (PetscInt r = -1; r < scene->region_count; r++) {
    const LamMicrostructure *micro = r < 0 ? &scene->micro : &scene->regions[r].micro;
    const PetscInt cells = micro->cell ? micro->cells[0] * micro->cells[1] : 0;

    if (i <= cells) return i == cells ? &micro->wall : &micro->cell[i].wall;
    i -= cells + 1;
  }
  return NULL;
}

PetscErrorCode LamSceneCheckFactor(const LamNode *node, const LamScene *scene, PetscInt parameter, PetscReal factor)
{
  PetscReal largest = 0;
  const LamWall *wall;
  char path[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; (wall = WallAt(scene, i)); i++) largest = PetscMax(largest, LamWallGet(wall, parameter));
  snprintf(path, sizeof(path), "rve.wall.%s", LamWallParameterNames[parameter]);
  const LamBound *upper = &LamKeyFind(path)->upper;

  LamSceneCheck(upper->kind == LAM_BOUND_NONE || factor * largest <= upper->value, node,
                "%s grows to %g times its value, %g, beyond %g; choose a smaller factor",
                LamWallParameterNames[parameter], (double)factor, (double)(factor * largest), (double)upper->value);
  PetscFunctionReturn(0);
}

PetscBool LamSceneHasParameter(const LamScene *scene, PetscInt parameter)
{
  const LamWall *wall;

  for (PetscInt i = 0; (wall = WallAt(scene, i)); i++)
    if (LamWallLawHas(wall->law, parameter)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool LamSceneLacksChanging(const LamScene *scene, LamChanging changing)
{
  const PetscInt k = (PetscInt)changing - (PetscInt)LAM_CHANGING_OF_PARAMETER(0);

  return (PetscBool)(k >= 0 && k < LAM_WALL_PARAMETER_COUNT && !LamSceneHasParameter(scene, k));
}
