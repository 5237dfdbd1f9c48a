/*
  The `process` block of a scene: tissue that changes in time.
*/
#include "scene_rows.h"
#include "quantity_text.h"
#include <math.h>
#include <string.h>

const char *const LamChangingNames[] = {LAM_CHANGING(LAM_NAME_ENTRY)};

static const LamKey process_keys[] = {
    {MAP("process"), .example = "{duration: 14 day, kinetics: [...]}",
     .help = "For `lamella process`: tissue that changes in time."},
    {TIME("process.duration"), REQUIRED, ABOVE(0), .example = "14 day", .help = "How long it is followed."},
    {TIME("process.output"), ABOVE(0), .default_words = "a hundredth of the duration", .example = "6 h",
     .help = "Time between the states that are told and written."},
    {REAL("process.tolerance"), FROM(1e-10), TO(0.1), .default_value = "1e-5", .example = "1e-6",
     .help = "Relative error of the integration in a step of time."},
    {BOOL("process.inflate"), .default_words = "true with turgor, else false", .example = "true",
     .help = "First find the tissue free of stress under its turgor; deformation then counts from there. Of a body "
             "`macro.inflate` says it."},
    {REAL("process.opening"), ABOVE(0), BELOW(1), .default_value = "0.01", .example = "0.02",
     .help =
         "What the volume between cells in contact, over that of the tissue, has grown by since the start when they "
         "count as coming apart."},
    {MAP("process.water"), .default_words = "the turgor is prescribed",
     .example = "{permeability: 1e-7 m/s/MPa, osmotic_pressure: 0.8 MPa}",
     .help = "Water passes the membranes of the cells; turgor at the start is that of `rve.turgor`."},
    {PERMEABILITY("process.water.permeability"), REQUIRED, FROM(0), .free_word = "infinite", .example = "1e-7 m/s/MPa",
     .help = "Hydraulic conductivity Lp of a membrane; `infinite`: always in equilibrium."},
    {MOLAR_ENERGY("process.water.activation"), FROM(0), .default_value = "0 kJ/mol", .example = "40 kJ/mol",
     .help = "Activation energy of Lp, which is that of the temperature at the start."},
    {REAL("process.water.reflection"), FROM(0), TO(1), .default_value = "1", .example = "0.9",
     .help = "Reflection coefficient of the membrane for the solutes."},
    {STRESS("process.water.osmotic_pressure"), FROM(0), .default_words = "in equilibrium with turgor and surroundings",
     .example = "0.8 MPa", .help = "Osmotic pressure in the cells at the start."},
    {REAL("process.water.non_osmotic"), FROM(0), BELOW(1), .default_value = "0", .example = "0.1",
     .help = "Share of the lumen at the start that is no solution."},
    {LIST("process.surroundings"), .default_words = "20 degC and pure water",
     .example = "[{time: 0 h, temperature: 20 degC}, {time: 1 h, temperature: 90 degC}]",
     .help =
         "What surrounds the tissue at times: straight in between, constant beyond; a time that is given twice is a "
         "jump."},
    {MAP("process.surroundings[]"), .example = "{time: 0 h, temperature: 20 degC}", .help = "At one time."},
    {TIME("process.surroundings[].time"), REQUIRED, FROM(0), .example = "1 h", .help = "Time, from the start."},
    {TEMPERATURE("process.surroundings[].temperature"), FROM(-270), TO(1000),
     .default_words = "straight between the entries that give it; 20 degC where none does", .example = "90 degC",
     .help = "Temperature of the tissue."},
    {STRESS("process.surroundings[].outside"), FROM(0),
     .default_words = "straight between the entries that give it; 0 MPa where none does", .example = "0.5 MPa",
     .help = "Osmotic pressure outside the cells, such as that of a bath of mannitol."},
    {REAL("process.surroundings[].humidity"), ABOVE(0), TO(1), .default_words = "none: `outside` instead",
     .example = "0.995",
     .help = "Relative humidity of air that the cells are in equilibrium with, instead of `outside`."},
    {STRESS("process.surroundings[].turgor"),
     .default_words = "straight between the entries that give it; that of `rve.turgor` where none does",
     .example = "0.1 MPa", .help = "Turgor, where there is no `water`."},
    {LIST("process.kinetics"), .default_words = "nothing changes",
     .example = "[{of: lamella, law: first_order, rate: 0.1 /day}]", .help = "What changes, each thing once."},
    {MAP("process.kinetics[]"), .example = "{of: lamella, law: first_order, rate: 0.1 /day}",
     .help = "One property, as a factor X(t) of what it is at the start."},
    {NAME("process.kinetics[].of", LamChangingNames), REQUIRED, .example = "lamella",
     .help =
         "`lamella`: cohesion and strengths of the lamella; `walls`: all moduli of the walls; `C1`, `C2`, `C4`: one "
         "of them, besides; `wall_strength`; `solutes` in a cell; `permeability` and `reflection` of its membrane."},
    {NAME_OF("process.kinetics[].law", LamKineticLawNames, LAM_KINETIC_LAW_COUNT), REQUIRED, .example = "first_order",
     .help = "`first_order`: X' = -k X; `fractional_conversion`: X' = -k (X - plateau), above 1 it stiffens; "
             "`two_fractions`: one decays with k, the other with k2; `autocatalytic`: an enzyme E' = k2 E (1 - E) acts "
             "by X' = -k E (X - plateau); `table`; `constant`."},
    {RATE("process.kinetics[].rate"), FROM(0), .default_words = "none: required by all laws with a rate",
     .example = "0.161 /min", .help = "k at the reference temperature."},
    {RATE("process.kinetics[].second_rate"), FROM(0),
     .default_words = "none: required by `two_fractions` and `autocatalytic`", .example = "0.01 /min",
     .help = "k2 at the reference temperature."},
    {MOLAR_ENERGY("process.kinetics[].activation"), FROM(0), .default_value = "0 kJ/mol", .example = "138 kJ/mol",
     .help = "Activation energy of k (Arrhenius)."},
    {MOLAR_ENERGY("process.kinetics[].second_activation"), FROM(0), .default_words = "that of `activation`",
     .example = "100 kJ/mol", .help = "Activation energy of k2."},
    {TEMPERATURE("process.kinetics[].reference"), FROM(-200), TO(1000), .default_value = "20 degC",
     .example = "100 degC", .help = "The temperature that the rates are given at."},
    {MOLAR_ENERGY("process.kinetics[].deactivation"), ABOVE(0), .default_words = "rates rise with temperature for good",
     .example = "250 kJ/mol", .help = "By it the rates fall again above `half_activity`."},
    {TEMPERATURE("process.kinetics[].half_activity"), FROM(-200), TO(1000),
     .default_words = "none: required with `deactivation`", .example = "35 degC",
     .help = "Temperature at which half of the enzyme has unfolded."},
    {REAL("process.kinetics[].plateau"), FROM(0), .default_words = "none: required by `fractional_conversion`; else 0",
     .example = "0.2", .help = "What X goes to."},
    {REAL("process.kinetics[].share"), ABOVE(0), BELOW(1), .default_words = "none: required by `two_fractions`",
     .example = "0.9", .help = "Share of the fraction that decays with k."},
    {REAL("process.kinetics[].enzyme"), ABOVE(0), TO(1), .default_words = "none: required by `autocatalytic`",
     .example = "0.01", .help = "E at the start, 1 is where it ends."},
    {LIST("process.kinetics[].table"), .default_words = "none: required by `table`",
     .example = "[[0, 1], [7, 0.6], [14, 0.5]]",
     .help = "Pairs of time and X, straight in between; the first is [0, 1]."},
    {REAL("process.kinetics[].table[]"), .size = 2, .example = "[7, 0.6]", .help = "Time and X."},
    {TEXT("process.kinetics[].time_unit"), .default_words = "none: required by `table`", .example = "day",
     .help = "Unit of its times."},
    {LIST("process.program"), .default_words = "free of stress; of a body: load parameter 0",
     .example = "[{for: 10 s, F: [[1, 0.1], [0, 1]]}, {for: 1 h}]",
     .help = "What deformation, stress or load is prescribed, one part after the other; after the last it is held."},
    {MAP("process.program[]"), .example = "{for: 10 s, F: [[1, 0.1], [0, 1]]}",
     .help = "One part: straight from where the tissue is to F and P, or to `load`; without them what is prescribed is "
             "held."},
    {TIME("process.program[].for"), REQUIRED, FROM(0), .example = "10 s", .help = "How long it takes; 0 s: a jump."},
    {TENSOR("process.program[].F"), FREE, .default_words = "held", .example = "[[free, 0.1], [0, free]]",
     .help = "Deformation gradient at its end, from the inflated tissue; `free` where P is given."},
    {STRESS_TENSOR("process.program[].P"), OPEN, .default_words = "F is given in full",
     .example = "[[0 MPa, x], [x, 0 MPa]]",
     .help = "First Piola-Kirchhoff stress at its end, of the reference area before inflation; `x` where F is given."},
    {REAL("process.program[].load"), FROM(-1000), TO(1000), .default_words = "held", .example = "1",
     .help = "Of a body (`macro`): its load parameter at the end, that of `macro.boundary`."},
    {INTEGER("process.repeat"), FROM(1), TO(100000), .default_value = "1", .example = "10",
     .help = "How often `program` is gone through."},
};
LAM_KEY_TABLE(LamProcessKeys, process_keys);

#define ROOM_TEMPERATURE 293.15 /* K */
#define MOLAR_VOLUME 18.05e-6   /* of water at 20 degC, m3/mol */

enum { MAX_OUTPUTS = 1000000 };

PetscErrorCode LamSceneDestroyProcess(LamScene *scene)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < LAM_CHANGING_COUNT; k++) {
    PetscCall(PetscFree(scene->process.kinetics[k].time));
    PetscCall(PetscFree(scene->process.kinetics[k].factor));
  }
  PetscCall(PetscFree(scene->process.surroundings));
  PetscCall(PetscFree(scene->process.legs));
  PetscFunctionReturn(0);
}

/* ---- surroundings ---- */

enum { TEMPERATURE, OUTSIDE, TURGOR, SURROUNDING_COUNT };

static PetscReal *Member(LamSurroundings *at, PetscInt which)
{
  return which == TEMPERATURE ? &at->temperature : which == OUTSIDE ? &at->outside : &at->turgor;
}

/* One entry, where NaN stands for what it does not give; a humidity h is kept as `outside` = ln h, which is negative.
 */
static PetscErrorCode ReadSurroundings(const LamDocument *document, const LamNode *entry, const LamScene *scene,
                                       LamSurroundings *at)
{
  const LamNode *temperature_node, *outside_node, *humidity_node, *turgor_node;
  LamValue time, temperature, outside, humidity, turgor;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "process.surroundings[].time", NULL, &time));
  PetscCall(LamSceneGet(entry, "process.surroundings[].temperature", &temperature_node, &temperature));
  PetscCall(LamSceneGet(entry, "process.surroundings[].outside", &outside_node, &outside));
  PetscCall(LamSceneGet(entry, "process.surroundings[].humidity", &humidity_node, &humidity));
  PetscCall(LamSceneGet(entry, "process.surroundings[].turgor", &turgor_node, &turgor));
  *at = (LamSurroundings){time.number[0], NAN, NAN, NAN};
  if (temperature_node) at->temperature = temperature.number[0];
  if (outside_node)
    PetscCall(LamSceneScale(document, outside_node, outside.number[0], scene->scales.stress, &at->outside));
  if (outside_node && humidity_node)
    PetscCall(LamSceneFailName(document, humidity_node, "given together with outside; leave one of them out"));
  if (humidity_node) at->outside = log(humidity.number[0]);
  if (turgor_node && scene->process.has_water)
    PetscCall(LamSceneFailName(document, turgor_node,
                               "contradicts process.water, from which the turgor follows; leave one of them out"));
  if (turgor_node) {
    PetscCall(LamSceneCheckTurgor(document, turgor_node, turgor.number[0]));
    PetscCall(LamSceneScale(document, turgor_node, turgor.number[0], scene->scales.stress, &at->turgor));
  }
  PetscFunctionReturn(0);
}

/* Fills what entries do not give: straight between those that do, constant beyond; `otherwise` where none does. */
static void FillSurroundings(PetscInt n, LamSurroundings at[], PetscInt which, PetscReal otherwise)
{
  PetscInt before = -1;

  for (PetscInt i = 0; i < n; i++) {
    PetscInt after = i;

    if (!isnan(*Member(&at[i], which))) {
      before = i;
      continue;
    }
    while (after < n && isnan(*Member(&at[after], which))) after++;
    if (before < 0 && after == n) {
      *Member(&at[i], which) = otherwise;
    } else if (before < 0 || after == n) {
      *Member(&at[i], which) = *Member(&at[before < 0 ? after : before], which);
    } else {
      const PetscReal span = at[after].time - at[before].time;
      const PetscReal s = span > 0 ? (at[i].time - at[before].time) / span : 0;

      *Member(&at[i], which) = (1 - s) * *Member(&at[before], which) + s * *Member(&at[after], which);
    }
  }
}

static PetscErrorCode BuildSurroundings(const LamDocument *document, LamScene *scene)
{
  LamProcessSpec *spec = &scene->process;
  const LamNode *list;
  LamValue unused;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "process.surroundings", &list, &unused));
  spec->surroundings_count = list ? list->count : 1;
  PetscCall(PetscMalloc1(spec->surroundings_count, &spec->surroundings));
  spec->surroundings[0] = (LamSurroundings){0, NAN, NAN, NAN};
  for (const LamNode *entry = list ? list->first : NULL; entry; entry = entry->next, n++) {
    PetscCall(ReadSurroundings(document, entry, scene, &spec->surroundings[n]));
    if (n && spec->surroundings[n].time < spec->surroundings[n - 1].time)
      PetscCall(LamSceneFail(document, entry, "is earlier than the entry before; order them by time"));
  }
  FillSurroundings(spec->surroundings_count, spec->surroundings, TEMPERATURE, ROOM_TEMPERATURE);
  for (PetscInt i = 0; i < spec->surroundings_count; i++) /* of air at this temperature: -R T / V_w ln h */
    if (spec->surroundings[i].outside < 0)
      spec->surroundings[i].outside *=
          -LAM_GAS_CONSTANT * spec->surroundings[i].temperature / MOLAR_VOLUME / scene->scales.stress;
  FillSurroundings(spec->surroundings_count, spec->surroundings, OUTSIDE, 0);
  FillSurroundings(spec->surroundings_count, spec->surroundings, TURGOR, scene->turgor);
  PetscFunctionReturn(0);
}

/* ---- water ---- */

/* Membranes of one kind: all cells have the turgor of the load. */
static PetscErrorCode CheckCells(const LamDocument *document, const LamNode *block, const LamMicrostructure *micro)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; micro->cell && c < micro->cells[0] * micro->cells[1]; c++)
    if (micro->cell[c].turgor != 1)
      PetscCall(
          LamSceneFailName(document, block,
                           "finds one turgor for all cells, but in rve.variation their turgors differ; leave that "
                           "out there"));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckTurgor(const LamDocument *document, const LamNode *block, PetscReal turgor)
{
  PetscFunctionBeginUser;
  if (turgor < 0)
    PetscCall(LamSceneFailName(document, block,
                               "begins with a negative turgor, but membranes leave the walls at 0; write a pressure of "
                               "at least 0 MPa in rve.turgor"));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildWater(const LamDocument *document, LamScene *scene)
{
  LamWaterSpec *water = &scene->process.water;
  const LamNode *block, *permeability_node, *osmotic_node;
  LamValue unused, permeability, activation, reflection, osmotic, non_osmotic;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "process.water", &block, &unused));
  scene->process.has_water = (PetscBool)(block != NULL);
  if (!block) PetscFunctionReturn(0);
  PetscCall(LamSceneGet(document->root, "process.water.permeability", &permeability_node, &permeability));
  PetscCall(LamSceneGet(document->root, "process.water.activation", NULL, &activation));
  PetscCall(LamSceneGet(document->root, "process.water.reflection", NULL, &reflection));
  PetscCall(LamSceneGet(document->root, "process.water.osmotic_pressure", &osmotic_node, &osmotic));
  PetscCall(LamSceneGet(document->root, "process.water.non_osmotic", NULL, &non_osmotic));
  if (permeability.is_free[0])
    water->permeability = INFINITY;
  else
    PetscCall(LamSceneScale(document, permeability_node, permeability.number[0] * scene->scales.stress,
                            scene->scales.length, &water->permeability));
  water->activation = activation.number[0];
  water->reflection = reflection.number[0];
  water->non_osmotic = non_osmotic.number[0];
  water->osmotic = NAN;
  if (osmotic_node)
    PetscCall(LamSceneScale(document, osmotic_node, osmotic.number[0], scene->scales.stress, &water->osmotic));
  PetscCall(CheckTurgor(document, block, scene->turgor));
  for (PetscInt r = 0; r < scene->region_count; r++) PetscCall(CheckTurgor(document, block, scene->regions[r].turgor));
  if (!osmotic_node && water->reflection == 0 && scene->turgor > 0)
    PetscCall(
        LamSceneFailMissing(document, block, "osmotic_pressure",
                            "missing: with reflection: 0 no osmotic pressure holds the turgor; write one, such as "
                            "0.8 MPa"));
  PetscCall(CheckCells(document, block, &scene->micro));
  for (PetscInt r = 0; r < scene->region_count; r++) PetscCall(CheckCells(document, block, &scene->regions[r].micro));
  if (scene->has_macro && water->reflection == 0 && permeability.is_free[0])
    PetscCall(
        LamSceneFailName(document, block,
                         "has membranes that hold back neither water nor solutes, so no cell of the body has a turgor; "
                         "leave the block out, with rve.turgor: {pressure: 0 MPa}"));
  PetscFunctionReturn(0);
}

/* ---- kinetics ---- */

/* What a law needs beside its name. */
static const char *const needs[LAM_KINETIC_LAW_COUNT][5] = {
    [LAM_KINETIC_FIRST_ORDER] = {"rate"},
    [LAM_KINETIC_FRACTIONAL] = {"rate", "plateau"},
    [LAM_KINETIC_TWO_FRACTIONS] = {"rate", "second_rate", "share"},
    [LAM_KINETIC_AUTOCATALYTIC] = {"rate", "second_rate", "enzyme"},
    [LAM_KINETIC_TABLE] = {"table", "time_unit"},
};
/* Keys that belong to some laws alone; the others take no notice of them, so they are refused there. */
static const struct {
  const char *key;
  unsigned int laws;
} belongs[] = {
#define LAW(name) (1u << LAM_KINETIC_##name)
#define RATED (LAW(FIRST_ORDER) | LAW(FRACTIONAL) | LAW(TWO_FRACTIONS) | LAW(AUTOCATALYTIC))
    {"rate", RATED},
    {"activation", RATED},
    {"reference", RATED},
    {"deactivation", RATED},
    {"half_activity", RATED},
    {"second_rate", LAW(TWO_FRACTIONS) | LAW(AUTOCATALYTIC)},
    {"second_activation", LAW(TWO_FRACTIONS) | LAW(AUTOCATALYTIC)},
    {"plateau", LAW(FRACTIONAL) | LAW(AUTOCATALYTIC)},
    {"share", LAW(TWO_FRACTIONS)},
    {"enzyme", LAW(AUTOCATALYTIC)},
    {"table", LAW(TABLE)},
    {"time_unit", LAW(TABLE)},
};

static PetscErrorCode CheckNeeds(const LamDocument *document, const LamNode *entry, LamKineticLaw law)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 5 && needs[law][k]; k++)
    if (!LamNodeFind(entry, needs[law][k], strlen(needs[law][k])))
      PetscCall(
          LamSceneFailMissing(document, entry, needs[law][k], "missing; law: %s needs it", LamKineticLawNames[law]));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(belongs); k++) {
    const LamNode *node = LamNodeFind(entry, belongs[k].key, strlen(belongs[k].key));

    if (node && !(belongs[k].laws & (1u << law)))
      PetscCall(LamSceneFailName(document, node, "law: %s has no use for it; leave it out", LamKineticLawNames[law]));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode GetNumber(const LamNode *entry, const char key[], PetscReal otherwise, PetscReal *number)
{
  char path[80];
  const LamNode *node;
  LamValue value;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof(path), "process.kinetics[].%s", key));
  PetscCall(LamSceneGet(entry, path, &node, &value));
  *number = value.count ? value.number[0] : otherwise;
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadTable(const LamDocument *document, const LamNode *entry, LamKinetics *kinetics)
{
  const LamNode *list, *unit_node;
  PetscReal unit;
  PetscInt n = 0;
  LamValue unused;
  char one[60], reason[LAM_REASON_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "process.kinetics[].table", &list, &unused));
  PetscCall(LamSceneGet(entry, "process.kinetics[].time_unit", &unit_node, &unused));
  snprintf(one, sizeof(one), "1 %.50s", unit_node->text);
  PetscCall(LamQuantityRead(one, LAM_DIMENSION_TIME, &unit, reason));
  if (reason[0]) PetscCall(LamSceneFail(document, unit_node, "is not a unit of time; write one, such as day"));
  kinetics->count = list->count;
  PetscCall(PetscMalloc1(list->count, &kinetics->time));
  PetscCall(PetscMalloc1(list->count, &kinetics->factor));
  for (const LamNode *item = list->first; item; item = item->next, n++) {
    kinetics->time[n] = item->value.number[0] * unit;
    kinetics->factor[n] = item->value.number[1];
    if (!n && (kinetics->time[0] != 0 || kinetics->factor[0] != 1))
      PetscCall(LamSceneFail(document, item, "a table begins with what the property is at the start; write [0, 1]"));
    if (n && kinetics->time[n] <= kinetics->time[n - 1])
      PetscCall(LamSceneFail(document, item, "its time is not later than that of the pair before; order them by time"));
    if (kinetics->factor[n] < 0)
      PetscCall(LamSceneFail(document, item, "a factor cannot be negative; write at least 0"));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadKinetics(const LamDocument *document, const LamNode *entry, LamKinetics *kinetics)
{
  LamRate *rate = &kinetics->rate;
  const LamNode *deactivation, *half;
  LamValue value;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "process.kinetics[].law", NULL, &value));
  kinetics->law = (LamKineticLaw)value.number[0];
  PetscCall(CheckNeeds(document, entry, kinetics->law));
  PetscCall(GetNumber(entry, "rate", 0, &rate->rate));
  PetscCall(GetNumber(entry, "activation", 0, &rate->activation));
  PetscCall(GetNumber(entry, "reference", ROOM_TEMPERATURE, &rate->reference));
  PetscCall(LamSceneGet(entry, "process.kinetics[].deactivation", &deactivation, &value));
  PetscCall(LamSceneGet(entry, "process.kinetics[].half_activity", &half, &value));
  if (deactivation && !half)
    PetscCall(LamSceneFailMissing(document, entry, "half_activity", "missing; deactivation needs it"));
  if (half && !deactivation)
    PetscCall(LamSceneFailMissing(document, entry, "deactivation", "missing; half_activity needs it"));
  PetscCall(GetNumber(entry, "deactivation", 0, &rate->deactivation));
  PetscCall(GetNumber(entry, "half_activity", ROOM_TEMPERATURE, &rate->half_activity));
  kinetics->second = *rate;
  PetscCall(GetNumber(entry, "second_rate", 0, &kinetics->second.rate));
  PetscCall(GetNumber(entry, "second_activation", rate->activation, &kinetics->second.activation));
  PetscCall(GetNumber(entry, "plateau", 0, &kinetics->plateau));
  PetscCall(GetNumber(entry, "share", 0, &kinetics->share));
  PetscCall(GetNumber(entry, "enzyme", 0, &kinetics->enzyme));
  if (kinetics->law == LAM_KINETIC_TABLE) PetscCall(ReadTable(document, entry, kinetics));
  PetscFunctionReturn(0);
}

/* Refuses what the tissue does not have. */
static PetscErrorCode CheckChanging(const LamDocument *document, const LamNode *of, LamChanging changing,
                                    const LamScene *scene)
{
  const PetscBool of_water = (PetscBool)(changing == LAM_CHANGING_SOLUTES || changing == LAM_CHANGING_PERMEABILITY ||
                                         changing == LAM_CHANGING_REFLECTION);

  PetscFunctionBeginUser;
  if (of_water && !scene->process.has_water)
    PetscCall(
        LamSceneFail(document, of, "belongs to process.water, which is missing; write that block, or leave it out"));
  if (changing == LAM_CHANGING_WALL_STRENGTH && isnan(scene->strength.wall))
    PetscCall(LamSceneFail(document, of, "strength.wall is not given; write it, or leave this out"));
  PetscBool contact = (PetscBool)(scene->micro.interface == LAM_INTERFACE_CONTACT);

  for (PetscInt r = 0; r < scene->region_count; r++)
    contact = (PetscBool)(contact || scene->regions[r].micro.interface == LAM_INTERFACE_CONTACT);
  if (changing == LAM_CHANGING_LAMELLA && !contact && isnan(scene->strength.lamella_normal) &&
      isnan(scene->strength.lamella_shear))
    PetscCall(
        LamSceneFail(document, of,
                     "bonded cells have no cohesion, and strength.lamella_normal and lamella_shear are not given; "
                     "write one of them, or law: contact"));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildKinetics(const LamDocument *document, LamScene *scene)
{
  PetscBool given[LAM_CHANGING_COUNT] = {PETSC_FALSE};
  const LamNode *list;
  LamValue unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "process.kinetics", &list, &unused));
  for (const LamNode *entry = list ? list->first : NULL; entry; entry = entry->next) {
    const LamNode *of;
    LamValue value;

    PetscCall(LamSceneGet(entry, "process.kinetics[].of", &of, &value));
    const LamChanging changing = (LamChanging)value.number[0];
    if (given[changing]) PetscCall(LamSceneFail(document, of, "has an entry already; leave one of them out"));
    given[changing] = PETSC_TRUE;
    PetscCall(CheckChanging(document, of, changing, scene));
    PetscCall(ReadKinetics(document, entry, &scene->process.kinetics[changing]));
  }
  PetscFunctionReturn(0);
}

/* ---- program ---- */

static PetscErrorCode ReadLeg(const LamDocument *document, const LamNode *entry, const LamScene *scene,
                              const LamProcessLeg *before, LamProcessLeg *leg)
{
  const LamNode *F_node, *P_node, *load_node;
  LamValue duration, F, P, load;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(entry, "process.program[].for", NULL, &duration));
  PetscCall(LamSceneGet(entry, "process.program[].F", &F_node, &F));
  PetscCall(LamSceneGet(entry, "process.program[].P", &P_node, &P));
  PetscCall(LamSceneGet(entry, "process.program[].load", &load_node, &load));
  *leg = *before;
  leg->duration = duration.number[0];
  if (load_node) leg->load = load.number[0];
  if (load_node && !scene->has_macro)
    PetscCall(LamSceneFailName(document, load_node,
                               "is the load parameter of a body, but there is no block macro; write F and P, or that "
                               "block"));
  if (scene->has_macro && (F_node || P_node))
    PetscCall(LamSceneFailName(document, F_node ? F_node : P_node,
                               "is for one material point, but the block macro describes a body; write load, or leave "
                               "that block out"));
  if (!F_node && !P_node) PetscFunctionReturn(0);
  if (!F_node)
    PetscCall(LamSceneFailMissing(document, entry, "F",
                                  "missing; write F: [[free, 0], [0, free]] beside P, or leave out both"));
  PetscCall(LamSceneReadControl(document, F_node, P_node, scene->scales.stress, &leg->control));
  PetscCall(LamSceneCheckF(document, F_node));
  PetscCall(PetscArraycpy(leg->F, F.number, 9));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildLegs(const LamDocument *document, LamScene *scene)
{
  /* free of stress in the plane, held against rotation by F21 */
  LamProcessLeg leg = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .control = {.given = {1, 1, 0, 0, 1}, .share = 1}};
  LamProcessSpec *spec = &scene->process;
  const LamNode *list, *repeat_node;
  LamValue repeat, unused;
  PetscReal cycle = 0;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "process.program", &list, &unused));
  PetscCall(LamSceneGet(document->root, "process.repeat", &repeat_node, &repeat));
  spec->repeat = (PetscInt)repeat.number[0];
  PetscCall(PetscMalloc1(list ? list->count : 1, &spec->legs));
  if (!list) {
    spec->leg_count = 1;
    spec->legs[0] = leg;
  }
  for (const LamNode *entry = list ? list->first : NULL; entry; entry = entry->next) {
    PetscCall(ReadLeg(document, entry, scene, &leg, &spec->legs[spec->leg_count]));
    leg = spec->legs[spec->leg_count++];
    if (leg.duration == 0 && fabs(cycle - spec->duration) <= 1e-9 * spec->duration)
      PetscCall(LamSceneFail(document, entry,
                             "is a jump at the very end, of which nothing is seen; make process.duration "
                             "longer"));
    cycle += leg.duration;
  }
  if (repeat_node && !(cycle > 0))
    PetscCall(LamSceneFailName(document, repeat_node, "repeats a program that takes no time; give its parts a time"));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildProcess(const LamDocument *document, LamScene *scene)
{
  LamProcessSpec *spec = &scene->process;
  const LamNode *block, *inflate_node, *output_node;
  LamValue duration, output, tolerance, inflate, opening, unused;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(document->root, "process", &block, &unused));
  if (!block) PetscFunctionReturn(0);
  scene->has_process = PETSC_TRUE;
  PetscCall(LamSceneGet(document->root, "process.duration", NULL, &duration));
  PetscCall(LamSceneGet(document->root, "process.output", &output_node, &output));
  PetscCall(LamSceneGet(document->root, "process.tolerance", NULL, &tolerance));
  PetscCall(LamSceneGet(document->root, "process.inflate", &inflate_node, &inflate));
  PetscCall(LamSceneGet(document->root, "process.opening", NULL, &opening));
  spec->duration = duration.number[0];
  spec->output = output_node ? output.number[0] : spec->duration / 100;
  spec->tolerance = tolerance.number[0];
  spec->inflate = inflate_node ? (PetscBool)(inflate.number[0] != 0) : (PetscBool)(scene->turgor != 0);
  spec->opening = opening.number[0];
  if (scene->has_macro && inflate_node)
    PetscCall(LamSceneFailName(document, inflate_node, "is for one material point; of a body write macro.inflate"));
  if (scene->sealed)
    PetscCall(LamSceneFailName(document, block,
                               "contradicts turgor mode: sealed; write mode: prescribed there, and process.water with "
                               "permeability: 0 m/s/MPa for cells that keep their water"));
  if (spec->duration / spec->output > MAX_OUTPUTS)
    PetscCall(LamSceneFail(document, output_node, "more than %d outputs in all; write a longer time", MAX_OUTPUTS));
  PetscCall(BuildWater(document, scene));
  PetscCall(BuildSurroundings(document, scene));
  PetscCall(BuildKinetics(document, scene));
  PetscCall(BuildLegs(document, scene));
  PetscFunctionReturn(0);
}
