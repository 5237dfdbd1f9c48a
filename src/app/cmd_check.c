/*
  lamella check: the model that a scene describes, and its predicted cost.
*/
#include "app.h"
#include "clock.h"
#include "lamella_zone.h"
#include "rounding.h"
#include "map.h"
#include "names.h"
#include "quantity_text.h"
#include "turgor_stretch.h"
#include <math.h>

typedef struct {
  LamScene *scene;
  LamPlan plan;
  LamPlan *regions; /* [region] of the body; owned */
  LamCost cost;
  PetscBool measure;             /* --measure: as long as it takes */
  char digits[256];              /* warning of rounding errors; empty: none */
  char turgor[LAM_TURGOR_TEXT];  /* warning of a turgor that the walls do not hold; empty: none */
  char zone[LAM_ZONE_TEXT + 80]; /* warning of elements too long for the lamella; empty: none */
  const char *why_direct;        /* why a process needs direct solves; NULL: a database can be used */
} Check;

/* The first warning of a region. */
static void FindZone(const LamPlan *plan, const LamRegion *region, Check *check)
{
  char text[LAM_ZONE_TEXT];

  LamZoneWarning(&plan->micro, &region->scales, text);
  if (text[0]) snprintf(check->zone, sizeof(check->zone), "macro.regions: %s: %s", region->name, text);
}

/* Of processor time since the command has begun: trials of meshes, */
#define TRIAL_SECONDS 1.1
#define TOTAL_SECONDS 1.5    /* and all: what is being factored, and the estimate of its error, still end */
#define MEASURE_SECONDS 60.0 /* with --measure, of the parts of commands that are run */

static PetscErrorCode Plan(const char path[], Check *check)
{
  const PetscReal begin = LamProcessorClock();

  PetscFunctionBeginUser;
  PetscCall(LamSceneRead(path, &check->scene));
  if (!check->measure) LamStopSetProcessorLimit(begin + TRIAL_SECONDS);
  PetscCall(LamPlanMake(check->scene, &check->plan));
  PetscCall(LamDigitsWarning(&check->plan.micro, check->scene->accuracy, check->digits, sizeof(check->digits)));
  LamTurgorWarning(check->scene, check->turgor);
  LamZoneWarning(&check->plan.micro, &check->scene->scales, check->zone);
  PetscCall(PetscMalloc1(check->scene->region_count, &check->regions));
  for (PetscInt k = 0; k < check->scene->region_count; k++) {
    LamScene own = *check->scene;

    own.micro = own.regions[k].micro;
    PetscCall(LamPlanMake(&own, &check->regions[k]));
    if (!check->zone[0]) FindZone(&check->regions[k], &own.regions[k], check);
  }
  LamStopSetProcessorLimit(PETSC_INFINITY);
  PetscCall(LamPlanCost(check->scene, &check->plan, check->regions,
                        check->measure ? MEASURE_SECONDS : begin + TOTAL_SECONDS - LamProcessorClock(), &check->cost));
  if (!LamProcessWallsStayAlike(check->scene))
    check->why_direct =
        "moduli of the walls do not change alike: solved directly, as a database would need them as an axis";
  PetscFunctionReturn(0);
}

/* ---- JSON output ---- */

static json_t *Cost(json_t *states, const LamPrediction *predicted)
{
  return json_pack("{s:o, s:o, s:o}", "states", states, "seconds", LamJSONReal(predicted->seconds), "share",
                   LamJSONReal(predicted->share));
}

static json_t *Mesh(const Check *check)
{
  const LamMicrostructure *given = &check->scene->micro, *micro = &check->plan.micro;

  return json_pack("{s:I, s:I, s:o, s:b}", "along", (json_int_t)micro->along, "through", (json_int_t)micro->through,
                   "grading", LamJSONReal(micro->grading), "chosen",
                   (!given->along || !given->through) && !check->plan.trial.stopped);
}

/* Traction over opening: MPa/mm of 1. */
static PetscReal StiffnessUnit(const LamScales *scales)
{
  return 1e-9 * scales->stress / scales->length;
}

/* Opening at which a lamella has failed in tension, in apothems. */
static PetscReal FailureOpening(const LamLamella *lamella)
{
  return 2.0 * lamella->energy / lamella->strength;
}

static PetscBool IsStiffnessChosen(const LamMicrostructure *micro)
{
  return (PetscBool)(micro->lamella.stiffness == LamLamellaDefaultStiffness(micro));
}

static json_t *Lamella(const LamMicrostructure *micro, const LamScales *scales)
{
  const PetscReal MPa = scales->stress * 1e-6, energy = scales->stress * scales->length;
  const LamLamella *l = &micro->lamella;

  return json_pack("{s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:b, s:o, s:o}", "softening", LamSofteningNames[l->softening],
                   "strength", LamJSONReal(l->strength * MPa), "fracture_energy", LamJSONReal(l->energy * energy),
                   "shear_strength", LamJSONReal(l->shear_strength * MPa), "shear_fracture_energy",
                   LamJSONReal(l->shear_energy * energy), "failure_opening", LamJSONReal(FailureOpening(l)),
                   "stiffness", LamJSONReal(l->stiffness * StiffnessUnit(scales)), "stiffness_chosen",
                   IsStiffnessChosen(micro), "compliance", LamJSONReal(LamLamellaCompliance(micro)), "zone",
                   LamJSONReal(LamLamellaZone(micro)));
}

static json_t *Tearing(const LamMicrostructure *micro, const LamScales *scales)
{
  const LamTearing *t = &micro->tearing;

  return json_pack("{s:o, s:o, s:o, s:o}", "strength", LamJSONReal(t->strength * scales->stress * 1e-6),
                   "fracture_energy", LamJSONReal(t->energy * scales->stress * scales->length), "stiffness",
                   LamJSONReal(t->stiffness * StiffnessUnit(scales)), "compliance",
                   LamJSONReal(LamTearingCompliance(micro)));
}

static json_t *Spread(const LamCellSpread *spread, PetscReal MPa)
{
  return json_pack("{s:I, s:o, s:o, s:o, s:o, s:o, s:o}", "kinds", (json_int_t)spread->kinds, "wall_thickness",
                   LamJSONReals(2, spread->wall_thickness, 1), "shear_modulus",
                   LamJSONReals(2, spread->shear_modulus, MPa), "turgor", LamJSONReals(2, spread->turgor, 1),
                   "cohesion", LamJSONReals(2, spread->cohesion, 1), "lamella_strength",
                   LamJSONReals(2, spread->lamella_strength, 1), "lamella_energy",
                   LamJSONReals(2, spread->lamella_energy, 1));
}

/* {name, apothem (um), wall_thickness (apothems), shear_modulus, turgor, cohesion (MPa), mesh, unknowns} of each, and
   the lamella of those with that law */
static json_t *Regions(const Check *check)
{
  json_t *list = json_array();

  for (PetscInt k = 0; k < check->scene->region_count; k++) {
    const LamRegion *region = &check->scene->regions[k];
    const LamPlan *plan = &check->regions[k];
    const PetscReal MPa = region->scales.stress * 1e-6;
    const PetscBool lamella = (PetscBool)(region->micro.interface == LAM_INTERFACE_LAMELLA);

    json_array_append_new(list,
                          json_pack("{s:s, s:o, s:o, s:o, s:o, s:o, s:{s:I, s:I}, s:I, s:o*}", "name", region->name,
                                    "apothem", LamJSONReal(1e6 * region->scales.length), "wall_thickness",
                                    LamJSONReal(region->micro.wall_thickness), "shear_modulus", LamJSONReal(MPa),
                                    "turgor", LamJSONReal(region->turgor * MPa), "cohesion",
                                    LamJSONReal(region->cohesion * MPa), "mesh", "along", (json_int_t)plan->micro.along,
                                    "through", (json_int_t)plan->micro.through, "unknowns", (json_int_t)plan->unknowns,
                                    "lamella", lamella ? Lamella(&region->micro, &region->scales) : NULL));
  }
  return list;
}

static json_t *Warnings(const Check *check)
{
  const LamScene *scene = check->scene;
  json_t *list = json_array();

  for (PetscInt k = 0; k < scene->warning_count; k++) json_array_append_new(list, json_string(scene->warnings[k]));
  if (check->turgor[0]) json_array_append_new(list, json_string(check->turgor));
  if (check->zone[0]) json_array_append_new(list, json_string(check->zone));
  return list;
}

static json_t *Relaxation(const LamRelaxation *relaxation)
{
  json_t *terms = json_array();

  for (PetscInt i = 0; i < relaxation->terms; i++)
    json_array_append_new(
        terms, json_pack("{s:f, s:f}", "share", (double)relaxation->share[i], "time", (double)relaxation->time[i]));
  return terms;
}

/* Whether the scene's body is around an axis, so that F33 is the hoop stretch. */
static PetscBool IsAround(const LamScene *scene)
{
  return (PetscBool)(scene->has_macro && scene->macro.symmetry == LAM_AXISYMMETRIC);
}

static PetscErrorCode PrintObject(const Check *check)
{
  const LamPlan *plan = &check->plan;
  const LamScene *scene = check->scene;
  const LamMicrostructure *micro = &plan->micro;
  const PetscReal MPa = scene->scales.stress * 1e-6;
  const LamPrediction *cost = check->cost.of;
  json_t *o;

  PetscFunctionBeginUser;
  o = json_pack("{s:s, s:b, s:[I,I], s:s, s:s, s:o, s:b, s:o, s:o, s:I, s:o}", "scene", scene->path, "plane_strain",
                !IsAround(scene), "cells", (json_int_t)micro->cells[0], (json_int_t)micro->cells[1], "interface",
                LamInterfaceLawNames[micro->interface], "wall_law", LamWallLawNames[micro->wall.law], "turgor",
                LamJSONReal(scene->turgor * MPa), "sealed", scene->sealed, "accuracy", LamJSONReal(scene->accuracy),
                "mesh", Mesh(check), "unknowns", (json_int_t)plan->unknowns, "memory_mb",
                LamJSONReal(check->cost.memory));
  PetscCheck(o, PETSC_COMM_SELF, PETSC_ERR_LIB, "the plan cannot be written as JSON");
  json_object_set_new(o, "rounding", /* a bound of that of the tangent; a warning if it is beyond the accuracy */
                      json_pack("{s:o, s:s?}", "tangent", LamJSONReal(LamTangentRounding(micro)), "warning",
                                check->digits[0] ? check->digits : NULL));
  json_object_set_new(o, "warnings", Warnings(check));
  if (micro->is_patch && !micro->tissue)
    json_object_set_new(o, "patch",
                        json_pack("{s:I, s:I, s:s}", "columns", (json_int_t)micro->cells[0], "rows",
                                  (json_int_t)micro->cells[1], "sides", LamPatchSidesNames[micro->sides]));
  if (plan->spread.kinds) json_object_set_new(o, "variation", Spread(&plan->spread, MPa));
  if (LamCellsPart(micro->interface)) {
    json_object_set_new(o, "cohesion", LamJSONReal(scene->cohesion * MPa));
    json_object_set_new(o, "clearance", LamJSONReal(micro->clearance));
    json_object_set_new(o, "strategy", json_string(LamStrategyNames[scene->strategy]));
  }
  if (micro->interface == LAM_INTERFACE_LAMELLA) json_object_set_new(o, "lamella", Lamella(micro, &scene->scales));
  if (LamWallsRelax(micro)) json_object_set_new(o, "relaxation", Relaxation(&micro->relaxation));
  if (LamWallsTear(micro)) json_object_set_new(o, "tearing", Tearing(micro, &scene->scales));
  if (plan->load_states) json_object_set_new(o, "load", Cost(json_integer(plan->load_states), &cost[LAM_PLANNED_RVE]));
  if (scene->has_sample)
    json_object_set_new(
        o, "sample",
        Cost(plan->sample_states ? json_integer(plan->sample_states) : json_null(), &cost[LAM_PLANNED_BUILD]));
  if (scene->has_map) {
    json_t *map = Cost(json_integer(plan->map_states), &cost[LAM_PLANNED_MAP]);

    json_object_set_new(map, "points", json_integer(plan->map_points));
    json_object_set_new(o, "map", map);
  }
  if (scene->has_process)
    json_object_set_new(o, "process",
                        json_pack("{s:o, s:b, s:o, s:o}", "duration", LamJSONReal(scene->process.duration), "database",
                                  !check->why_direct, "seconds", LamJSONReal(cost[LAM_PLANNED_PROCESS].seconds),
                                  "share", LamJSONReal(cost[LAM_PLANNED_PROCESS].share)));
  if (scene->has_macro) {
    json_t *macro = json_pack("{s:I, s:I, s:o, s:o}", "steps", (json_int_t)scene->macro.steps, "points",
                              (json_int_t)plan->macro_points, "seconds", LamJSONReal(cost[LAM_PLANNED_FE2].seconds),
                              "share", LamJSONReal(cost[LAM_PLANNED_FE2].share));

    if (scene->region_count) json_object_set_new(macro, "regions", Regions(check));
    json_object_set_new(o, "macro", macro);
  }
  PetscCall(LamPrintJSON(o));
  PetscFunctionReturn(0);
}

/* ---- human-readable output ---- */

static void PrintSeconds(PetscReal seconds)
{
  /* switch units at 99.5, so that two digits need no exponent */
  if (seconds < 0.0995)
    printf("%.2g ms", (double)(1e3 * seconds));
  else if (seconds < 99.5)
    printf("%.2g s", (double)seconds);
  else if (seconds < 99.5 * 60)
    printf("%.2g min", (double)(seconds / 60));
  else
    printf("%.*f h", seconds < 36000, (double)(seconds / 3600));
}

static void PrintSpread(const LamCellSpread *spread, LamInterfaceLawType interface, PetscReal MPa)
{
  printf("%-12s %" PetscInt_FMT
         " different: wall %.4g to %.4g of the apothem, C1 + C2 %.4g to %.4g MPa, turgor %.4g to "
         "%.4g and cohesion %.4g to %.4g times the load's",
         "cells", spread->kinds, (double)spread->wall_thickness[0], (double)spread->wall_thickness[1],
         (double)(spread->shear_modulus[0] * MPa), (double)(spread->shear_modulus[1] * MPa), (double)spread->turgor[0],
         (double)spread->turgor[1], (double)spread->cohesion[0], (double)spread->cohesion[1]);
  if (interface == LAM_INTERFACE_LAMELLA)
    printf(", strength of the lamella %.4g to %.4g and its energy %.4g to %.4g times that of the scene",
           (double)spread->lamella_strength[0], (double)spread->lamella_strength[1], (double)spread->lamella_energy[0],
           (double)spread->lamella_energy[1]);
  printf("\n");
}

static void PrintLamella(const LamScene *scene, const LamMicrostructure *micro)
{
  const LamScales *scales = &scene->scales;
  const PetscReal MPa = scales->stress * 1e-6, energy = scales->stress * scales->length;
  const LamLamella *l = &micro->lamella;
  const PetscReal opening = FailureOpening(l), zone = LamLamellaZone(micro);

  printf("%-12s lamella, %s: strength %.4g MPa, energy of fracture %.4g J/m^2", "interface",
         LamSofteningNames[l->softening], (double)(l->strength * MPa), (double)(l->energy * energy));
  if (l->shear_strength != l->strength || l->shear_energy != l->energy)
    printf("; in shear %.4g MPa, %.4g J/m^2", (double)(l->shear_strength * MPa), (double)(l->shear_energy * energy));
  if (scene->cohesion > 0) printf("; residual cohesion %.4g MPa", (double)(scene->cohesion * MPa));
  printf("\n  failure    %s an opening of %.3g um, %.3g of the apothem; over about %.3g um along a wall\n",
         l->softening == LAM_SOFTENING_EXPONENTIAL ? "mostly until" : "at", (double)(1e6 * opening * scales->length),
         (double)opening, (double)(1e6 * zone * scales->length));
  printf("  stiffness  %.4g MPa/mm (%s): costs about %.2g %% of the tissue's stiffness\n",
         (double)(l->stiffness * StiffnessUnit(scales)), IsStiffnessChosen(micro) ? "chosen" : "as the scene says",
         (double)(100 * LamLamellaCompliance(micro)));
}

static void PrintTearing(const LamMicrostructure *micro, const LamScales *scales)
{
  const LamTearing *t = &micro->tearing;
  const PetscReal opening = 2.0 * t->energy / t->strength;

  printf("  tear at %.4g MPa and spend %.4g J/m^2, up to an opening of %.3g um, %.3g of the thickness; cuts of %.4g "
         "MPa/mm cost about %.2g %% of their stiffness\n",
         (double)(t->strength * scales->stress * 1e-6), (double)(t->energy * scales->stress * scales->length),
         (double)(1e6 * opening * scales->length), (double)(opening / micro->wall_thickness),
         (double)(t->stiffness * StiffnessUnit(scales)), (double)(100 * LamTearingCompliance(micro)));
}

static void PrintInterface(const LamScene *scene, const LamMicrostructure *micro)
{
  if (micro->interface == LAM_INTERFACE_LAMELLA)
    PrintLamella(scene, micro);
  else if (micro->interface == LAM_INTERFACE_BONDED)
    printf("%-12s bonded: no unknowns of its own\n", "interface");
  else
    printf("%-12s contact: cohesion %.4g MPa, clearance %.4g um, strategy %s\n", "interface",
           (double)(scene->cohesion * scene->scales.stress * 1e-6),
           (double)(1e6 * micro->clearance * scene->scales.length), LamStrategyNames[scene->strategy]);
}

static void PrintWall(const LamWall *wall, PetscReal MPa)
{
  printf("%-12s %s:", "wall", LamWallLawNames[wall->law]);
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++)
    if (LamWallLawHas(wall->law, k))
      printf("%s %s %.4g%s", k ? "," : "", LamWallParameterNames[k],
             (double)(LamWallGet(wall, k) * (LamWallParameterIsModulus(k) ? MPa : 1.0)),
             LamWallParameterIsModulus(k) ? "" : " (a number)");
  if (LamWallLawHasFibres(wall->law)) printf(" (fibres: %s)", LamFibresNames[wall->fibres]);
  printf(", bulk modulus %.4g MPa\n", (double)(wall->bulk_modulus * MPa));
}

static void PrintRelaxation(const LamRelaxation *relaxation)
{
  PetscReal left = 1;

  if (!relaxation->terms) return;
  printf("  relaxes    ");
  for (PetscInt i = 0; i < relaxation->terms; i++) {
    printf("%.4g %% with %.4g s, ", (double)(100 * relaxation->share[i]), (double)relaxation->time[i]);
    left -= relaxation->share[i];
  }
  printf("%.4g %% stay\n", (double)(100 * left));
}

static void PrintChoice(const LamScene *scene, const LamMeshTrial *trial)
{
  printf(" (chosen for an accuracy of %.2g %%", (double)(100 * scene->accuracy));
  if (trial->stopped)
    printf("; not tried to the end: --measure finds the mesh that commands take");
  else if (trial->loads)
    printf("; error %.2g %% at %d trial loads", (double)(100 * trial->error), (int)trial->loads);
  printf(")\n");
}

static void PrintModel(const Check *check)
{
  const LamScene *scene = check->scene;
  const LamMicrostructure *given = &scene->micro, *micro = &check->plan.micro;
  const PetscReal MPa = scene->scales.stress * 1e-6;

  printf("%-12s %s\n", "scene", scene->path);
  printf("%-12s %s, ", "model", IsAround(scene) ? "axisymmetric, cells along the hoop" : "plane strain");
  if (micro->tissue)
    printf("%s of %" PetscInt_FMT " cells of any shape, mean apothem %.4g um", micro->is_patch ? "a patch" : "periods",
           micro->cells[0], (double)(1e6 * scene->scales.length));
  else if (micro->is_patch)
    printf("a patch of %" PetscInt_FMT " columns and %" PetscInt_FMT " rows of cells between grips, lateral sides %s",
           micro->cells[0], micro->cells[1], LamPatchSidesNames[micro->sides]);
  else
    printf("%" PetscInt_FMT " x %" PetscInt_FMT " cells per period", micro->cells[0], micro->cells[1]);
  printf(", wall %.4g of the apothem (%.4g um), face normal 0 at %.4g deg\n", (double)micro->wall_thickness,
         (double)(1e6 * scene->scales.length), (double)(micro->orientation * 180 / PETSC_PI));
  PrintWall(&micro->wall, MPa);
  PrintRelaxation(&micro->relaxation);
  if (LamWallsTear(micro)) PrintTearing(micro, &scene->scales);
  if (check->plan.spread.kinds) PrintSpread(&check->plan.spread, micro->interface, MPa);
  PrintInterface(scene, micro);
  if (scene->turgor != 0 || scene->sealed)
    printf("%-12s %.4g MPa %s%s\n", "turgor", (double)(scene->turgor * MPa),
           check->plan.spread.kinds ? "times the factor of each cell" : "in every lumen",
           !scene->sealed     ? ""
           : scene->has_macro ? "; the cells are sealed once the body has it"
                              : " at F = I, where the cells are sealed");
  else
    printf("%-12s none, where no load says otherwise\n", "turgor");
  printf("%-12s %" PetscInt_FMT " elements along a face, %" PetscInt_FMT " through a wall", "mesh", micro->along,
         micro->through);
  if (micro->grading > 0) printf(", graded by %.2g towards the corners", (double)micro->grading);
  if (!given->along || !given->through)
    PrintChoice(scene, &check->plan.trial);
  else
    printf(" (as the scene says)\n");
}

/* The time of a command, and what it is known from. */
static void PrintTime(const Check *check, const LamPrediction *predicted)
{
  if (!predicted->has) {
    putchar('\n');
    return;
  }
  if (isfinite(predicted->seconds)) {
    printf(", about ");
    PrintSeconds(predicted->seconds);
    if (predicted->share < 1) printf(" (%.2g %% of the time measured)", (double)(100 * predicted->share));
  } else {
    printf(", time unknown");
    if (!check->measure) printf(": --measure runs a longer part");
  }
  putchar('\n');
}

static void PrintStates(const Check *check, LamPlanned command, PetscInt states)
{
  printf("%-12s %" PetscInt_FMT " state%s", LamPlannedNames[command], states, states == 1 ? "" : "s");
  PrintTime(check, &check->cost.of[command]);
}

static void PrintRegions(const Check *check)
{
  const LamScene *scene = check->scene;
  char fields[LAM_TISSUE_FIELD_COUNT * LAM_NAME_LENGTH] = "";

  for (PetscInt k = 0; k < scene->region_count; k++) {
    const LamRegion *region = &scene->regions[k];
    const LamPlan *plan = &check->regions[k];
    const PetscReal MPa = region->scales.stress * 1e-6;

    printf("  %-10s wall %.4g of the apothem (%.4g um), C1 + C2 %.4g MPa, turgor %.4g MPa", region->name,
           (double)region->micro.wall_thickness, (double)(1e6 * region->scales.length), (double)MPa,
           (double)(region->turgor * MPa));
    if (region->micro.interface == LAM_INTERFACE_LAMELLA)
      printf(", lamella %.4g MPa and %.4g J/m^2", (double)(region->micro.lamella.strength * MPa),
             (double)(region->micro.lamella.energy * region->scales.stress * region->scales.length));
    else if (LamCellsPart(region->micro.interface))
      printf(", cohesion %.4g MPa", (double)(region->cohesion * MPa));
    printf("; %" PetscInt_FMT " x %" PetscInt_FMT " elements, %" PetscInt_FMT " unknowns\n", plan->micro.along,
           plan->micro.through, plan->unknowns);
  }
  for (int f = 0; f < LAM_TISSUE_FIELD_COUNT; f++)
    if (scene->fields.value[f]) LamNamesAppend(sizeof(fields), fields, ", ", LamTissueFieldNames[f]);
  if (fields[0]) printf("  fields     %s by position\n", fields);
}

static void PrintMacro(const Check *check)
{
  const LamPlan *plan = &check->plan;
  const LamMacroSpec *macro = &check->scene->macro;

  printf("%-12s ", "fe2");
  if (macro->source == LAM_MESH_GMSH)
    printf("elements of %s", macro->gmsh);
  else
    printf("%" PetscInt_FMT " elements, %" PetscInt_FMT " material points", plan->macro_elements, plan->macro_points);
  printf(", %" PetscInt_FMT " load steps%s", macro->steps, macro->inflate ? " after inflation" : "");
  PrintTime(check, &check->cost.of[LAM_PLANNED_FE2]);
  PrintRegions(check);
}

static void PrintProcess(const Check *check)
{
  PetscReal seconds;
  const char *unit = LamTimeUnit(check->scene->process.duration, &seconds);

  printf("%-12s %.4g %s%s", "process", (double)(check->scene->process.duration / seconds), unit,
         check->scene->has_macro ? ", of the body" : "");
  PrintTime(check, &check->cost.of[LAM_PLANNED_PROCESS]);
  printf("  %s\n", check->why_direct ? check->why_direct : "one database serves at all times");
}

static void PrintCost(const Check *check)
{
  const LamPlan *plan = &check->plan;
  const LamScene *scene = check->scene;

  printf("%-12s %" PetscInt_FMT "\n", "unknowns", plan->unknowns);
  printf("%-12s about %.0f MB per rank\n", "memory", (double)check->cost.memory);
  if (plan->load_states) PrintStates(check, LAM_PLANNED_RVE, plan->load_states);
  if (plan->sample_states) {
    PrintStates(check, LAM_PLANNED_BUILD, plan->sample_states);
  } else if (scene->has_sample) {
    printf("%-12s states until the error is below %.2g %%", "build", (double)(100 * scene->sample.accuracy));
    PrintTime(check, &check->cost.of[LAM_PLANNED_BUILD]);
  }
  if (scene->has_map) {
    printf("%-12s %" PetscInt_FMT " points, %" PetscInt_FMT " paths", "map", plan->map_points, LamMapPathCount(scene));
    PrintTime(check, &check->cost.of[LAM_PLANNED_MAP]);
  }
  if (scene->has_process) PrintProcess(check);
  if (scene->has_macro) PrintMacro(check);
}

static void PrintWarnings(const Check *check)
{
  for (PetscInt k = 0; k < check->scene->warning_count; k++) printf("%-12s %s\n", "warning", check->scene->warnings[k]);
  if (check->turgor[0]) printf("%-12s %s\n", "warning", check->turgor);
  if (check->zone[0]) printf("%-12s %s\n", "warning", check->zone);
}

PetscErrorCode LamCommandCheck(LamArgs *args, int *exit_status)
{
  PetscBool json = PETSC_FALSE, done;
  LamConsole console = {.command = "check"};
  Check check = {0};
  const char *path;
  const LamOption options[] = {
      {0, "measure", LAM_OPTION_FLAG, NULL,
       "take the time to find the mesh, and a minute to predict how long commands take, instead of 2 s in all",
       &check.measure},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object on stdout", &json},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "check SCENE [--measure] [--json]",
                            "Reads and checks a scene; prints what will be modelled and its predicted cost.", options,
                            1, &path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  PetscCall(args->start(args));
  (void)LamConsoleReporter(&console);
  PetscCall(Plan(path, &check));
  LamConsoleClear();
  *exit_status = LamStopExitStatus();
  if (!LamAppIsRoot() || LamStopSignal()) {
    /* ranks plan alike */
  } else if (json) {
    PetscCall(PrintObject(&check));
  } else {
    PrintModel(&check);
    if (check.digits[0]) printf("%-12s %s\n", "rounding", check.digits);
    PrintCost(&check);
    PrintWarnings(&check);
  }
  PetscCall(PetscFree(check.regions));
  PetscCall(LamSceneDestroy(&check.scene));
  PetscFunctionReturn(0);
}
