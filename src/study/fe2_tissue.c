/*
  The tissues of a macroscale run.

  Algorithm. Each material point is assigned the region that covers it and the values of the fields there. If the wall
  thickness varies, its region gets levels: thicknesses at equal ratios from the smallest to the largest at its points,
  rounded outwards. Responses of the levels are blended (blend.h). Equal tissues are merged.
*/
#include "fe2_tissue.h"
#include "names.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/*
  Largest error of a blend of 2, 3, and 4 or more levels, factor h^power, h the difference of the logarithms of adjacent
  levels; docs/results/verification.md. Contact opens or closes at particular thicknesses, so that smooth weights help
  less.
*/
typedef struct {
  PetscReal factor, power;
} BlendError;
static const BlendError BondedErrors[] = {{0.5, 2}, {0.8, 3}, {1.2, 4}};
static const BlendError ContactErrors[] = {{0.3, 2}, {0.1, 1}, {0.1, 1}};
enum { MOST_LEVELS = 8 };

/* Region and field values of a point, before tissues are determined. */
typedef struct {
  PetscInt region;                         /* -1: none */
  PetscReal value[LAM_TISSUE_FIELD_COUNT]; /* SI; from the field, or else from the region */
} Place;

/* The tissues of one region. */
typedef struct {
  PetscInt count;
  PetscReal thickness[MOST_LEVELS]; /* apothems */
  PetscInt tissue[MOST_LEVELS];
} Levels;

/* ---- regions ---- */

/* Finds the element group of the mesh with the region's name. PETSC_ERR_USER_INPUT if there is none. */
static PetscErrorCode FindGroup(LamMacro macro, const LamScene *scene, const LamRegion *region, PetscInt *group)
{
  const char(*names)[LAM_NAME_LENGTH];
  PetscInt count;

  char at[LAM_PLACE_TEXT], all[LAM_MESSAGE_LENGTH] = "";

  PetscFunctionBeginUser;
  PetscCall(LamMacroGetGroups(macro, &count, &names));
  for (*group = 0; *group < count; ++*group)
    if (!strcmp(names[*group], region->name)) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < count; k++) LamNamesAppend(sizeof(all), all, ", ", names[k]);
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
          "%s: macro.regions: %s: the mesh has no group of elements of this name%s%s; write where: with an expression "
          "of x and y in mm",
          LamScenePlaceText(scene, &region->place, at), region->name, count ? ", but " : "", all);
}

/* Warns of regions without a material point; an error if no region has one. covered: of each region, whether its place
   has points of this rank, and whether some of them are its own. */
static PetscErrorCode CheckRegions(MPI_Comm comm, const LamReporter *reporter, const LamScene *scene,
                                   PetscBool covered[][2])
{
  const PetscInt n = scene->region_count;
  char at[LAM_PLACE_TEXT];
  PetscInt used = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, covered, 2 * (PetscMPIInt)n, MPIU_BOOL, MPI_LOR, comm));
  for (PetscInt r = 0; r < n; r++) used += covered[r][1];
  PetscCheck(used || !n, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: macro.regions: %s: no region has a material point of the body; write expressions of x and y in mm "
             "that hold in it, or a finer macro.mesh",
             LamScenePlaceText(scene, &scene->regions[0].place, at), scene->regions[0].name);
  for (PetscInt r = 0; r < n && LamIsFirst(comm); r++) {
    if (covered[r][1]) continue;
    LamReportWarning(reporter, "%s: macro.regions[%d]: %s: %s; %s",
                     LamScenePlaceText(scene, &scene->regions[r].place, at), (int)r, scene->regions[r].name,
                     covered[r][0] ? "later regions cover all of it, so its tissue is nowhere"
                                   : "covers no material point, so its tissue is nowhere",
                     covered[r][0] ? "write it behind them, or leave it out"
                                   : "x and y are in mm; write another expression, or a finer macro.mesh");
  }
  PetscFunctionReturn(0);
}

/* Finds the last region that covers each point. X: [n][2] in mm. */
static PetscErrorCode FindRegions(MPI_Comm comm, const LamReporter *reporter, LamMacro macro, const LamScene *scene,
                                  PetscInt n, const PetscReal X[], const unsigned int groups[], Place places[])
{
  PetscBool covered[LAM_MAX_REGIONS][2] = {{PETSC_FALSE}};

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < n; p++) places[p].region = -1;
  for (PetscInt r = 0; r < scene->region_count; r++) {
    const LamRegion *region = &scene->regions[r];
    PetscInt group = -1;

    if (!region->where) PetscCall(FindGroup(macro, scene, region, &group));
    for (PetscInt p = 0; p < n; p++) {
      PetscReal inside = group >= 0 && groups[p] >> group & 1;

      if (region->where) PetscCall(LamPlaceFieldEvaluate(region->where, &X[2 * p], &inside));
      if (inside == 0) continue;
      places[p].region = r;
      covered[r][0] = PETSC_TRUE;
    }
  }
  for (PetscInt p = 0; p < n; p++)
    if (places[p].region >= 0) covered[places[p].region][1] = PETSC_TRUE;
  PetscCall(CheckRegions(comm, reporter, scene, covered));
  PetscFunctionReturn(0);
}

/* Sets a point's values to those of its region, or of the scene's own tissue; SI. */
static void SetDefaults(const LamScene *scene, Place *place)
{
  const LamRegion *region = place->region < 0 ? NULL : &scene->regions[place->region];
  const LamMicrostructure *micro = region ? &region->micro : &scene->micro;
  const LamScales *scales = region ? &region->scales : &scene->scales;

  place->value[LAM_TISSUE_ORIENTATION] = micro->orientation;
  place->value[LAM_TISSUE_TURGOR] = (region ? region->turgor : scene->turgor) * scales->stress;
  place->value[LAM_TISSUE_COHESION] = (region ? region->cohesion : scene->cohesion) * scales->stress;
  place->value[LAM_TISSUE_WALL_THICKNESS] = micro->wall_thickness * scales->length;
}

/* ---- fields ---- */

/* Checks the range of a field value. X in mm. */
static PetscErrorCode CheckValue(const LamScene *scene, LamTissueField field, const Place *place, const PetscReal X[2])
{
  const LamScales *scales = place->region < 0 ? &scene->scales : &scene->regions[place->region].scales;
  const LamMicrostructure *micro = place->region < 0 ? &scene->micro : &scene->regions[place->region].micro;
  const PetscReal value = place->value[field], outer = LamOuterApothem(micro) * scales->length;
  char text[120], at[LAM_PLACE_TEXT];

  PetscFunctionBeginUser;
  (void)LamScenePlaceText(scene, &scene->fields.place[field], at);
  if (field == LAM_TISSUE_COHESION && value < 0) {
    snprintf(text, sizeof(text), "is %g MPa at x = %g mm, y = %g mm", value * 1e-6, X[0], X[1]);
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: macro.fields.cohesion: %s; it must not be negative", at, text);
  }
  if (field == LAM_TISSUE_WALL_THICKNESS && !(value > 0 && value < outer)) {
    snprintf(text, sizeof(text), "is %g um at x = %g mm, y = %g mm; it must lie between 0 and the apothem, %g um",
             value * 1e6, X[0], X[1], outer * 1e6);
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: macro.fields.wall_thickness: %s", at, text);
  }
  PetscFunctionReturn(0);
}

/* X: [n][2] in mm. */
static PetscErrorCode EvaluateFields(const LamScene *scene, PetscInt n, const PetscReal X[], Place places[])
{
  const LamTissueFields *fields = &scene->fields;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < n; p++) {
    Place *place = &places[p];
    const LamMicrostructure *micro = place->region < 0 ? &scene->micro : &scene->regions[place->region].micro;

    SetDefaults(scene, place);
    for (LamTissueField k = 0; k < LAM_TISSUE_FIELD_COUNT; k++) {
      PetscReal value;

      if (!fields->value[k]) continue;
      if (k == LAM_TISSUE_COHESION && micro->interface == LAM_INTERFACE_BONDED) continue;
      PetscCall(LamPlaceFieldEvaluate(fields->value[k], &X[2 * p], &value));
      place->value[k] = value * fields->unit[k];
      PetscCall(CheckValue(scene, k, place, &X[2 * p]));
    }
  }
  PetscFunctionReturn(0);
}

/* Regions and fields at the points of this rank. The caller frees *places. */
static PetscErrorCode FindPlaces(MPI_Comm comm, const LamReporter *reporter, LamMacro macro, const LamScene *scene,
                                 PetscInt n, Place **places)
{
  PetscReal *X;
  unsigned int *groups;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, places));
  PetscCall(PetscMalloc2(2 * n, &X, n, &groups));
  PetscCall(LamMacroGetPlaces(macro, X, groups));
  for (PetscInt i = 0; i < 2 * n; i++) X[i] *= scene->scales.macro_length * 1e3;
  PetscCall(FindRegions(comm, reporter, macro, scene, n, X, groups, *places));
  PetscCall(EvaluateFields(scene, n, X, *places));
  PetscCall(PetscFree2(X, groups));
  PetscFunctionReturn(0);
}

/* ---- levels of wall thickness ---- */

/* Rounds to two digits, so that the levels do not depend on the mesh of the body. */
static PetscReal RoundOutwards(PetscReal value, PetscBool up)
{
  const PetscReal digit = pow(10, floor(log10(value)) - 1);
  const PetscReal count = value / digit, nearest = rint(count);

  if (fabs(count - nearest) < 1e-6) return nearest * digit;
  return (up ? ceil(count) : floor(count)) * digit;
}

/* Smallest number of levels with an error of the blend of at most a quarter of `accuracy`. */
static PetscInt LevelCount(PetscReal least, PetscReal most, LamInterfaceLawType interface, PetscReal accuracy)
{
  const BlendError *errors = LamCellsPart(interface) ? ContactErrors : BondedErrors;
  PetscInt count = 2;

  for (; count < MOST_LEVELS; count++) {
    const PetscReal h = log(most / least) / (PetscReal)(count - 1);
    const BlendError *error = &errors[PetscMin(count, (PetscInt)LAM_BLEND_TERMS) - 2];

    if (error->factor * pow(h, error->power) <= 0.25 * accuracy) break;
  }
  return count;
}

/* range: smallest and largest thickness (m) at the region's points on all ranks; range[1] < range[0]: no points. */
static void ChooseLevels(const LamScene *scene, PetscInt region, const PetscReal range[2], Levels *levels)
{
  const LamMicrostructure *micro = region < 0 ? &scene->micro : &scene->regions[region].micro;
  const PetscReal apothem = region < 0 ? scene->scales.length : scene->regions[region].scales.length;
  PetscReal least = range[0], most = range[1];

  *levels = (Levels){0};
  if (most < least) return;
  levels->count = 1;
  if (scene->fields.value[LAM_TISSUE_WALL_THICKNESS] && most > least * (1 + 1e-9)) {
    least = RoundOutwards(least, PETSC_FALSE);
    most = PetscMin(RoundOutwards(most, PETSC_TRUE), 0.5 * (most + apothem));
    levels->count =
        scene->fields.levels ? scene->fields.levels : LevelCount(least, most, micro->interface, scene->accuracy);
  }
  for (PetscInt k = 0; k < levels->count; k++)
    levels->thickness[k] =
        least / apothem * (levels->count > 1 ? pow(most / least, (PetscReal)k / (PetscReal)(levels->count - 1)) : 1);
}

/* The range of wall thicknesses of each region over all ranks; ranges[0] is for the scene's own tissue. */
static PetscErrorCode FindRanges(MPI_Comm comm, PetscInt regions, PetscInt n, const Place places[],
                                 PetscReal ranges[][2])
{
  PetscFunctionBeginUser;
  for (PetscInt r = 0; r <= regions; r++)
    ranges[r][0] = ranges[r][1] = -PETSC_INFINITY; /* [0]: negative of the minimum */
  for (PetscInt p = 0; p < n; p++) {
    const PetscReal thickness = places[p].value[LAM_TISSUE_WALL_THICKNESS];
    PetscReal *range = ranges[places[p].region + 1];

    range[0] = PetscMax(range[0], -thickness);
    range[1] = PetscMax(range[1], thickness);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, ranges, 2 * (PetscMPIInt)(regions + 1), MPIU_REAL, MPIU_MAX, comm));
  for (PetscInt r = 0; r <= regions; r++) ranges[r][0] = -ranges[r][0];
  PetscFunctionReturn(0);
}

/* ---- tissues ---- */

/* The orientation at which the tissue of a region is solved. */
static PetscReal ReferenceOf(const LamScene *scene, PetscInt region)
{
  return region < 0 ? scene->micro.orientation : scene->regions[region].reference;
}

/* The scene of one tissue alone, in its reference orientation; points have angles relative to that. */
static LamScene SceneOf(const LamScene *scene, PetscInt region, PetscReal thickness)
{
  LamScene own = *scene;
  PetscReal stress;

  if (region >= 0) {
    own.micro = scene->regions[region].micro;
    own.scales = scene->regions[region].scales;
  }
  own.micro.orientation = ReferenceOf(scene, region);
  own.micro.wall_thickness = thickness;
  stress = own.scales.stress / scene->scales.stress;
  own.water_bulk_modulus /= stress;
  own.sample.turgor_min /= stress;
  own.sample.turgor_max /= stress;
  return own;
}

static PetscErrorCode SameTissue(const LamScene *a, const LamScene *b, PetscBool *same)
{
  char hash[2][LAM_HASH_LENGTH], *json;

  PetscFunctionBeginUser;
  PetscCall(LamMicrostructureDescribe(&a->micro, &json, hash[0]));
  PetscCall(PetscFree(json));
  PetscCall(LamMicrostructureDescribe(&b->micro, &json, hash[1]));
  PetscCall(PetscFree(json));
  *same = (PetscBool)(!strcmp(hash[0], hash[1]) && a->scales.stress == b->scales.stress &&
                      a->scales.length == b->scales.length);
  PetscFunctionReturn(0);
}

/* DB.h5, DB.NAME.h5; empty without a database. */
static void NameDatabase(const char database_path[], LamFE2Tissue *tissue)
{
  const size_t length = database_path ? strlen(database_path) : 0;
  const int stem = (int)(length > 3 && !strcmp(database_path + length - 3, ".h5") ? length - 3 : length);

  tissue->database_path[0] = '\0';
  if (!database_path) return;
  snprintf(tissue->database_path, sizeof(tissue->database_path), "%.*s%s%s%s", stem, database_path,
           tissue->name[0] ? "." : "", tissue->name, database_path + stem);
}

/* Finds the number of the tissue of a region at one of its levels; adds the tissue if it is new. */
static PetscErrorCode AddTissue(const LamScene *scene, PetscInt region, const Levels *levels, PetscInt level,
                                const char database_path[], LamFE2Tissues *tissues, PetscInt *number)
{
  const LamScene own = SceneOf(scene, region, levels->thickness[level]);
  LamFE2Tissue *tissue = &tissues->tissues[tissues->count];
  const char *name = region < 0 ? "" : scene->regions[region].name;
  PetscBool same;

  PetscFunctionBeginUser;
  for (*number = 0; *number < tissues->count; ++*number) {
    PetscCall(SameTissue(&own, &tissues->tissues[*number].scene, &same));
    if (same) PetscFunctionReturn(0);
  }
  tissue->scene = own;
  tissue->stress = own.scales.stress / scene->scales.stress;
  if (levels->count > 1)
    snprintf(tissue->name, sizeof(tissue->name), "%s%st%d", name, name[0] ? "." : "", (int)level + 1);
  else
    snprintf(tissue->name, sizeof(tissue->name), "%s", name);
  NameDatabase(database_path, tissue);
  tissues->count++;
  PetscFunctionReturn(0);
}

static PetscErrorCode AddTissues(MPI_Comm comm, const LamScene *scene, const Place places[], const char database_path[],
                                 LamFE2Tissues *tissues, Levels levels[])
{
  PetscReal ranges[LAM_MAX_REGIONS + 1][2];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1((scene->region_count + 1) * MOST_LEVELS, &tissues->tissues));
  PetscCall(FindRanges(comm, scene->region_count, tissues->points, places, ranges));
  for (PetscInt r = -1; r < scene->region_count; r++) {
    Levels *own = &levels[r + 1];

    ChooseLevels(scene, r, ranges[r + 1], own);
    if (!scene->fields.value[LAM_TISSUE_WALL_THICKNESS]) /* exactly the scene's value */
      own->thickness[0] = r < 0 ? scene->micro.wall_thickness : scene->regions[r].micro.wall_thickness;
    for (PetscInt k = 0; k < own->count; k++)
      PetscCall(AddTissue(scene, r, own, k, database_path, tissues, &own->tissue[k]));
  }
  PetscFunctionReturn(0);
}

/* ---- points ---- */

static void PlacePoint(const LamScene *scene, const Place *place, const Levels *levels, LamHeterogeneousPoint *point)
{
  const LamScales *scales = place->region < 0 ? &scene->scales : &scene->regions[place->region].scales;

  point->count = LamBlendAt(levels->count, levels->thickness, place->value[LAM_TISSUE_WALL_THICKNESS] / scales->length,
                            point->term);
  for (PetscInt k = 0; k < point->count; k++) point->term[k].knot = levels->tissue[point->term[k].knot];
  point->angle = place->value[LAM_TISSUE_ORIENTATION] - ReferenceOf(scene, place->region);
}

/* Sets the turgor and cohesion for which each tissue's table is built, from those of its points. */
static PetscErrorCode SetLoads(MPI_Comm comm, LamFE2Tissues *tissues)
{
  PetscReal(*most)[3]; /* maxima of turgor, cohesion and -turgor */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(tissues->count, &most));
  for (PetscInt t = 0; t < tissues->count; t++) most[t][0] = most[t][1] = most[t][2] = -PETSC_INFINITY;
  for (PetscInt p = 0; p < tissues->points; p++)
    for (PetscInt k = 0; k < tissues->point[p].count; k++) {
      PetscReal *of = most[tissues->point[p].term[k].knot];

      of[0] = PetscMax(of[0], tissues->turgor[p]);
      of[1] = PetscMax(of[1], tissues->cohesion[p]);
      of[2] = PetscMax(of[2], -tissues->turgor[p]);
    }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 3 * (PetscMPIInt)tissues->count, MPIU_REAL, MPIU_MAX, comm));
  for (PetscInt t = 0; t < tissues->count; t++) {
    LamFE2Tissue *tissue = &tissues->tissues[t];
    const PetscBool contact = LamCellsPart(tissue->scene.micro.interface);

    /* tables of contact tissue extend downwards from the largest suction; nodes of bonded tissue have one turgor, and
       derivatives in it */
    tissue->scene.turgor = (contact ? most[t][0] : 0.5 * (most[t][0] - most[t][2])) / tissue->stress;
    tissue->scene.cohesion = most[t][1] / tissue->stress;
    tissue->body_points = tissue->points = LamHeterogeneousPointCount(tissues->points, tissues->point, t);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &tissue->body_points, 1, MPIU_INT64, MPI_SUM, comm));
  }
  PetscCall(PetscFree(most));
  PetscFunctionReturn(0);
}

/* Sets tissues->plain: queries need no rotation or scaling, on all ranks. */
static PetscErrorCode FindPlain(MPI_Comm comm, LamFE2Tissues *tissues)
{
  PetscBool plain = (PetscBool)(tissues->count == 1 && tissues->tissues[0].stress == 1);

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < tissues->points && plain; p++) plain = (PetscBool)(tissues->point[p].angle == 0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &plain, 1, MPIU_BOOL, MPI_LAND, comm));
  tissues->plain = plain;
  PetscFunctionReturn(0);
}

/* Whether the scene has regions or fields, so that points may differ from the scene's own tissue and turgor. */
static PetscBool Varies(const LamScene *scene)
{
  PetscBool varies = (PetscBool)(scene->region_count > 0);

  for (int k = 0; k < LAM_TISSUE_FIELD_COUNT; k++) varies = (PetscBool)(varies || scene->fields.value[k]);
  return varies;
}

PetscErrorCode LamFE2TissuesCreateOne(MPI_Comm comm, const LamScene *scene, const char database_path[], PetscInt points,
                                      LamFE2Tissues *tissues)
{
  LamFE2Tissue *tissue;

  PetscFunctionBeginUser;
  *tissues = (LamFE2Tissues){.count = 1, .points = points, .plain = PETSC_TRUE};
  PetscCall(PetscCalloc1(1, &tissues->tissues));
  tissue = tissues->tissues;
  tissue->scene = *scene;
  tissue->stress = 1;
  NameDatabase(database_path, tissue);
  tissue->body_points = tissue->points = points;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &tissue->body_points, 1, MPIU_INT64, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2TissuesCreate(MPI_Comm comm, const LamReporter *reporter, LamMacro macro, const LamScene *scene,
                                   const char database_path[], LamFE2Tissues *tissues)
{
  Levels levels[LAM_MAX_REGIONS + 1];
  Place *places;

  PetscFunctionBeginUser;
  *tissues = (LamFE2Tissues){0};
  PetscCall(LamMacroGetPointCount(macro, &tissues->points));
  if (!Varies(scene)) {
    PetscCall(LamFE2TissuesCreateOne(comm, scene, database_path, tissues->points, tissues));
    PetscFunctionReturn(0);
  }
  PetscCall(FindPlaces(comm, reporter, macro, scene, tissues->points, &places));
  PetscCall(AddTissues(comm, scene, places, database_path, tissues, levels));
  PetscCall(PetscMalloc3(tissues->points, &tissues->point, tissues->points, &tissues->turgor, tissues->points,
                         &tissues->cohesion));
  for (PetscInt p = 0; p < tissues->points; p++) {
    PlacePoint(scene, &places[p], &levels[places[p].region + 1], &tissues->point[p]);
    tissues->turgor[p] = places[p].value[LAM_TISSUE_TURGOR] / scene->scales.stress;
    tissues->cohesion[p] = places[p].value[LAM_TISSUE_COHESION] / scene->scales.stress;
  }
  PetscCall(PetscFree(places));
  PetscCall(SetLoads(comm, tissues));
  PetscCall(FindPlain(comm, tissues));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2TissuesDestroy(LamFE2Tissues *tissues)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(tissues->point, tissues->turgor, tissues->cohesion));
  PetscCall(PetscFree(tissues->tissues));
  tissues->count = 0;
  PetscFunctionReturn(0);
}

LamStressScale LamFE2StressScale(const LamFE2Tissue *tissue)
{
  const LamStressScale own = LamStressScaleOf(&tissue->scene.micro);

  return (LamStressScale){own.plane * tissue->stress, own.axial * tissue->stress};
}
