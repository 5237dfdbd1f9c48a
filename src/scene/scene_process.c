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
    {TIME("process.duration"), INTO(LamProcessSpec, duration), ABOVE(0),
     .default_words = "up to the end of `program`, all its repetitions, and of `surroundings`", .example = "14 day",
     .help = "How long it is followed."},
    {TIME("process.output"), INTO(LamProcessSpec, output), ABOVE(0), .default_words = "a hundredth of the duration",
     .example = "6 h", .help = "Time between the states that are reported and written."},
    {REAL("process.tolerance"), INTO(LamProcessSpec, tolerance), FROM(1e-10), TO(0.1), .default_value = "1e-5",
     .example = "1e-6", .help = "Relative error of the integration in a step of time."},
    {BOOL("process.inflate"), INTO(LamProcessSpec, inflate), .default_words = "true with turgor, else false",
     .help = "First find the tissue free of stress under its turgor; deformation then counts from there. Of a body "
             "`macro.inflate` says it."},
    {NAME_OF("process.reference", LamAreaNames, LAM_AREA_COUNT), INTO(LamProcessSpec, area), .default_value = "rest",
     .help =
         "With `inflate`: whether P, given and told, is per area of the tissue at rest or of the inflated one. At one "
         "material point."},
    {REAL("process.opening"), INTO(LamProcessSpec, opening), ABOVE(0), BELOW(1), .default_value = "0.01",
     .example = "0.02",
     .help = "What the volume between cells in contact, over that of the tissue, has grown by since the start when "
             "they count as coming apart."},
    {MAP("process.water"), .default_words = "the turgor is prescribed",
     .example = "{permeability: 1e-7 m/s/MPa, osmotic_pressure: 0.8 MPa}",
     .help = "Water passes the membranes of the cells; turgor at the start is that of `rve.turgor`."},
    {PERMEABILITY("process.water.permeability"), INTO(LamWaterSpec, permeability), REQUIRED, FROM(0),
     .free_word = "infinite", .example = "1e-7 m/s/MPa",
     .help = "Hydraulic conductivity Lp of a membrane; `infinite`: always in equilibrium."},
    {MOLAR_ENERGY("process.water.activation"), INTO(LamWaterSpec, activation), FROM(0), .default_value = "0 kJ/mol",
     .example = "40 kJ/mol", .help = "Activation energy of Lp, which is that of the temperature at the start."},
    {REAL("process.water.reflection"), INTO(LamWaterSpec, reflection), FROM(0), TO(1), .default_value = "1",
     .example = "0.9", .help = "Reflection coefficient of the membrane for the solutes."},
    {STRESS("process.water.osmotic_pressure"), INTO(LamWaterSpec, osmotic), FROM(0),
     .default_words = "in equilibrium with turgor and surroundings", .example = "0.8 MPa",
     .help = "Osmotic pressure in the cells at the start."},
    {REAL("process.water.non_osmotic"), INTO(LamWaterSpec, non_osmotic), FROM(0), BELOW(1), .default_value = "0",
     .example = "0.1", .help = "Share of the lumen at the start that is no solution."},
    {LIST("process.surroundings"), .default_words = "20 degC and pure water",
     .example = "[{time: 0 h, temperature: 20 degC}, {time: 1 h, temperature: 90 degC}]",
     .help = "What surrounds the tissue at times: straight in between, constant beyond; a time that is given twice is "
             "a jump."},
    {MAP("process.surroundings[]"), .example = "{time: 0 h, temperature: 20 degC}", .help = "At one time."},
    {TIME("process.surroundings[].time"), INTO(LamSurroundings, time), REQUIRED, FROM(0), .example = "1 h",
     .help = "Time, from the start."},
    {TEMPERATURE("process.surroundings[].temperature"), INTO(LamSurroundings, temperature), FROM(-270), TO(1000),
     .default_words = "straight between the entries that give it; 20 degC where none does", .example = "90 degC",
     .help = "Temperature of the tissue."},
    {STRESS("process.surroundings[].outside"), INTO(LamSurroundings, outside), FROM(0),
     .default_words = "straight between the entries that give it; 0 MPa where none does", .example = "0.5 MPa",
     .help = "Osmotic pressure outside the cells, such as that of a bath of mannitol."},
    {REAL("process.surroundings[].humidity"), INTO(LamSurroundings, outside), ABOVE(0), TO(1),
     .default_words = "none: `outside` instead", .example = "0.995",
     .help = "Relative humidity of air that the cells are in equilibrium with, instead of `outside`."},
    {STRESS("process.surroundings[].turgor"), INTO(LamSurroundings, turgor),
     .default_words = "straight between the entries that give it; that of `rve.turgor` where none does",
     .example = "0.1 MPa", .help = "Turgor, where there is no `water`."},
    {LIST("process.kinetics"), .default_words = "nothing changes",
     .example = "[{of: lamella, law: first_order, rate: 0.1 /day}]", .help = "What changes, each thing once."},
    {MAP("process.kinetics[]"), .example = "{of: lamella, law: first_order, rate: 0.1 /day}",
     .help = "One property, as a factor X(t) of what it is at the start."},
    {NAME("process.kinetics[].of", LamChangingNames), REQUIRED,
     .help = "`lamella`: cohesion and strengths of the lamella, with law `lamella` strengths and energies; `walls`: "
             "all moduli of the walls; `C1`, `C2`, `C4`: "
             "one of them, besides; `wall_strength`; `solutes` in a cell; `permeability` and `reflection` of its "
             "membrane."},
    {NAME_OF("process.kinetics[].law", LamKineticLawNames, LAM_KINETIC_LAW_COUNT), INTO(LamKinetics, law), REQUIRED,
     .help = "`first_order`: X' = -k X; `fractional_conversion`: X' = -k (X - plateau), above 1 it stiffens; "
             "`two_fractions`: one decays with k, the other with k2; `autocatalytic`: an enzyme E' = k2 E (1 - E) acts "
             "by X' = -k E (X - plateau); `table`; `constant`."},
    {RATE("process.kinetics[].rate"), INTO(LamKinetics, rate.rate), FROM(0),
     .default_words = "none: required by all laws with a rate", .example = "0.161 /min",
     .help = "k at the reference temperature."},
    {RATE("process.kinetics[].second_rate"), INTO(LamKinetics, second.rate), FROM(0),
     .default_words = "none: required by `two_fractions` and `autocatalytic`", .example = "0.01 /min",
     .help = "k2 at the reference temperature."},
    {MOLAR_ENERGY("process.kinetics[].activation"), INTO(LamKinetics, rate.activation), FROM(0),
     .default_value = "0 kJ/mol", .example = "138 kJ/mol", .help = "Activation energy of k (Arrhenius)."},
    {MOLAR_ENERGY("process.kinetics[].second_activation"), INTO(LamKinetics, second.activation), FROM(0),
     .default_words = "that of `activation`", .example = "100 kJ/mol", .help = "Activation energy of k2."},
    {TEMPERATURE("process.kinetics[].reference"), INTO(LamKinetics, rate.reference), FROM(-200), TO(1000),
     .default_value = "20 degC", .example = "100 degC", .help = "The temperature that the rates are given at."},
    {MOLAR_ENERGY("process.kinetics[].deactivation"), INTO(LamKinetics, rate.deactivation), ABOVE(0),
     .default_words = "rates rise with temperature for good", .example = "250 kJ/mol",
     .help = "By it the rates fall again above `half_activity`."},
    {TEMPERATURE("process.kinetics[].half_activity"), INTO(LamKinetics, rate.half_activity), FROM(-200), TO(1000),
     .default_words = "none: required with `deactivation`", .example = "35 degC",
     .help = "Temperature at which half of the enzyme has unfolded."},
    {REAL("process.kinetics[].plateau"), INTO(LamKinetics, plateau), FROM(0),
     .default_words = "none: required by `fractional_conversion`; else 0", .example = "0.2", .help = "What X goes to."},
    {REAL("process.kinetics[].share"), INTO(LamKinetics, share), ABOVE(0), BELOW(1),
     .default_words = "none: required by `two_fractions`", .example = "0.9",
     .help = "Share of the fraction that decays with k."},
    {REAL("process.kinetics[].enzyme"), INTO(LamKinetics, enzyme), ABOVE(0), TO(1),
     .default_words = "none: required by `autocatalytic`", .example = "0.01",
     .help = "E at the start, 1 is where it ends."},
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
    {TIME("process.program[].for"), INTO(LamProcessLeg, duration), REQUIRED, FROM(0), .example = "10 s",
     .help = "How long it takes; 0 s: a jump."},
    {TIME("process.program[].output"), INTO(LamProcessLeg, output), ABOVE(0), .default_words = "that of the process",
     .example = "1 s", .help = "Time between states in this part, counted from its start; its end is one, too."},
    {TENSOR("process.program[].F"), INTO(LamProcessLeg, F), FREE, .default_words = "held",
     .example = "[[free, 0.1], [0, free]]",
     .help = "Deformation gradient at its end, from the inflated tissue; `free` where P is given."},
    {STRESS_TENSOR("process.program[].P"), OPEN, .default_words = "F is given in full",
     .example = "[[0 MPa, x], [x, 0 MPa]]",
     .help = "First Piola-Kirchhoff stress at its end, per area of `process.reference`; `x` where F is given."},
    {REAL("process.program[].load"), INTO(LamProcessLeg, load), FROM(-1000), TO(1000), .default_words = "held",
     .example = "1", .help = "Of a body (`macro`): its load parameter at the end, that of `macro.boundary`."},
    {INTEGER("process.repeat"), INTO(LamProcessSpec, repeat), FROM(1), TO(100000), .default_value = "1",
     .example = "10", .help = "How often `program` is gone through."},
};
LAM_KEY_TABLE(LamProcessKeys, process_keys);

#define ROOM_TEMPERATURE 293.15 /* K */
#define MOLAR_VOLUME 18.05e-6   /* of water at 20 degC, m3/mol */

enum { MAX_OUTPUTS = 1000000 };
#define TOO_MANY_OUTPUTS "more than %d outputs in all; write a longer time"

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

/* Reads an entry; missing values are NaN. A humidity h is stored as `outside` = ln h, which is negative. */
static PetscErrorCode ReadSurroundings(const LamNode *entry, const LamScene *scene, LamSurroundings *at)
{
  const LamNode *outside = LamNodeFind(entry, "outside"), *humidity = LamNodeFind(entry, "humidity");
  const LamNode *turgor = LamNodeFind(entry, "turgor");

  PetscFunctionBeginUser;
  LamSceneCheckName(!outside || !humidity, humidity, "given together with outside; leave one of them out");
  LamSceneCheckName(!turgor || !scene->process.has_water, turgor,
                    "contradicts process.water, from which the turgor follows; leave one of them out");
  if (turgor) PetscCall(LamSceneCheckTurgor(turgor, turgor->value.number[0]));
  *at = (LamSurroundings){0, NAN, NAN, NAN};
  PetscCall(LamSceneFill(entry, &scene->scales, LamSurroundings, at));
  if (humidity) at->outside = log(at->outside);
  PetscFunctionReturn(0);
}

/* Fills missing values of a member, given by its offset: linear between the entries that have it, constant outside;
   `otherwise` if none has it. */
static void FillSurroundings(LamProcessSpec *spec, size_t offset, PetscReal otherwise)
{
#define MEMBER(i) (*(PetscReal *)((char *)&spec->surroundings[i] + offset))
  const PetscInt n = spec->surroundings_count;
  PetscInt before = -1;

  for (PetscInt i = 0; i < n; i++) {
    PetscInt after = i;

    if (!isnan(MEMBER(i))) {
      before = i;
      continue;
    }
    while (after < n && isnan(MEMBER(after))) after++;
    if (before < 0 && after == n) {
      MEMBER(i) = otherwise;
    } else if (before < 0 || after == n) {
      MEMBER(i) = MEMBER(before < 0 ? after : before);
    } else {
      const PetscReal start = spec->surroundings[before].time, span = spec->surroundings[after].time - start;
      const PetscReal s = span > 0 ? (spec->surroundings[i].time - start) / span : 0;

      MEMBER(i) = (1 - s) * MEMBER(before) + s * MEMBER(after);
    }
  }
#undef MEMBER
}

static PetscErrorCode BuildSurroundings(const LamNode *list, LamScene *scene)
{
  LamProcessSpec *spec = &scene->process;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  spec->surroundings_count = list ? list->count : 1;
  PetscCall(PetscMalloc1(spec->surroundings_count, &spec->surroundings));
  spec->surroundings[0] = (LamSurroundings){0, NAN, NAN, NAN};
  for (const LamNode *entry = list ? list->first : NULL; entry; entry = entry->next, n++) {
    PetscCall(ReadSurroundings(entry, scene, &spec->surroundings[n]));
    LamSceneCheck(!n || spec->surroundings[n].time >= spec->surroundings[n - 1].time, entry,
                  "is earlier than the entry before; order them by time");
  }
  FillSurroundings(spec, offsetof(LamSurroundings, temperature), ROOM_TEMPERATURE);
  for (PetscInt i = 0; i < spec->surroundings_count; i++) /* air at this temperature: -R T / V_w ln h */
    if (spec->surroundings[i].outside < 0)
      spec->surroundings[i].outside *=
          -LAM_GAS_CONSTANT * spec->surroundings[i].temperature / MOLAR_VOLUME / scene->scales.stress;
  FillSurroundings(spec, offsetof(LamSurroundings, outside), 0);
  FillSurroundings(spec, offsetof(LamSurroundings, turgor), scene->turgor);
  PetscFunctionReturn(0);
}

/* ---- water ---- */

/* The membrane model assumes that all cells have the turgor of the load, which must not be negative. */
static PetscErrorCode CheckTissue(const LamNode *block, const LamMicrostructure *micro, PetscReal turgor)
{
  PetscFunctionBeginUser;
  LamSceneCheckName(turgor >= 0, block,
                    "begins with a negative turgor, but membranes leave the walls at 0; write a pressure of at least 0 "
                    "MPa in rve.turgor");
  for (PetscInt c = 0; micro->cell && c < micro->cells[0] * micro->cells[1]; c++)
    LamSceneCheckName(micro->cell[c].turgor == 1, block,
                      "finds one turgor for all cells, but in rve.variation their turgors differ; leave that out "
                      "there");
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildWater(const LamNode *block, LamScene *scene)
{
  LamWaterSpec *water = &scene->process.water;

  PetscFunctionBeginUser;
  scene->process.has_water = (PetscBool)(block != NULL);
  if (!block) PetscFunctionReturn(0);
  water->osmotic = NAN;
  PetscCall(LamSceneFill(block, &scene->scales, LamWaterSpec, water));
  if (LamNodeFind(block, "permeability")->value.is_free[0]) water->permeability = INFINITY;
  PetscCall(CheckTissue(block, &scene->micro, scene->turgor));
  for (PetscInt r = 0; r < scene->region_count; r++)
    PetscCall(CheckTissue(block, &scene->regions[r].micro, scene->regions[r].turgor));
  LamSceneRequire(!isnan(water->osmotic) || water->reflection != 0 || !(scene->turgor > 0), block, "osmotic_pressure",
                  "missing: with reflection: 0 no osmotic pressure holds the turgor; write one, such as 0.8 MPa");
  LamSceneCheckName(!scene->has_macro || water->reflection != 0 || isfinite(water->permeability), block,
                    "has membranes that hold back neither water nor solutes, so no cell of the body has a turgor; "
                    "leave the block out, with rve.turgor: {pressure: 0 MPa}");
  PetscFunctionReturn(0);
}

/* ---- kinetics ---- */

/* Which laws need a key beside their name, and which allow it; the others ignore it. */
static const struct {
  const char *key;
  unsigned int need, have;
} uses[] = {
#define LAW(name) (1u << LAM_KINETIC_##name)
#define SECOND (LAW(TWO_FRACTIONS) | LAW(AUTOCATALYTIC))
#define RATED (LAW(FIRST_ORDER) | LAW(FRACTIONAL) | SECOND)
    {"rate", RATED, RATED},
    {"activation", 0, RATED},
    {"reference", 0, RATED},
    {"deactivation", 0, RATED},
    {"half_activity", 0, RATED},
    {"second_rate", SECOND, SECOND},
    {"second_activation", 0, SECOND},
    {"plateau", LAW(FRACTIONAL), LAW(FRACTIONAL) | LAW(AUTOCATALYTIC)},
    {"share", LAW(TWO_FRACTIONS), LAW(TWO_FRACTIONS)},
    {"enzyme", LAW(AUTOCATALYTIC), LAW(AUTOCATALYTIC)},
    {"table", LAW(TABLE), LAW(TABLE)},
    {"time_unit", LAW(TABLE), LAW(TABLE)},
};

static PetscErrorCode CheckUses(const LamNode *entry, LamKineticLaw law)
{
  const char *name = LamKineticLawNames[law];
  char path[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(uses); k++) {
    const LamNode *node = LamNodeFind(entry, uses[k].key);

    snprintf(path, sizeof(path), "process.kinetics[].%s", uses[k].key);
    LamSceneRequire(node || !(uses[k].need & (1u << law)), entry, uses[k].key, "missing; law: %s needs it, such as %s",
                    name, LamKeyFind(path)->example);
    LamSceneCheckName(!node || (uses[k].have & (1u << law)), node, "law: %s has no use for it; leave it out", name);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadTable(const LamNode *entry, LamKinetics *kinetics)
{
  const LamNode *list = LamNodeFind(entry, "table"), *unit_node = LamNodeFind(entry, "time_unit");
  char one[60], reason[LAM_REASON_LENGTH];
  PetscReal unit;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  snprintf(one, sizeof(one), "1 %.50s", unit_node->text);
  PetscCall(LamQuantityRead(one, LAM_DIMENSION_TIME, &unit, reason));
  LamSceneCheck(!reason[0], unit_node, "is not a unit of time; write one, such as day");
  kinetics->count = list->count;
  PetscCall(PetscMalloc1(list->count, &kinetics->time));
  PetscCall(PetscMalloc1(list->count, &kinetics->factor));
  for (const LamNode *item = list->first; item; item = item->next, n++) {
    kinetics->time[n] = item->value.number[0] * unit;
    kinetics->factor[n] = item->value.number[1];
    LamSceneCheck(n || (kinetics->time[0] == 0 && kinetics->factor[0] == 1), item,
                  "a table begins with what the property is at the start; write [0, 1]");
    LamSceneCheck(!n || kinetics->time[n] > kinetics->time[n - 1], item,
                  "its time is not later than that of the pair before; order them by time");
    LamSceneCheck(kinetics->factor[n] >= 0, item, "a factor cannot be negative; write at least 0");
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadKinetics(const LamNode *entry, LamKinetics *kinetics)
{
  const LamNode *deactivation = LamNodeFind(entry, "deactivation"), *half = LamNodeFind(entry, "half_activity");
  LamRate *rate = &kinetics->rate, *second = &kinetics->second;

  PetscFunctionBeginUser;
  rate->half_activity = ROOM_TEMPERATURE;
  PetscCall(LamSceneFill(entry, NULL, LamKinetics, kinetics));
  PetscCall(CheckUses(entry, kinetics->law));
  LamSceneRequire(!deactivation || half, entry, "half_activity", "missing; deactivation needs it");
  LamSceneRequire(!half || deactivation, entry, "deactivation", "missing; half_activity needs it");
  if (!LamNodeFind(entry, "second_activation")) second->activation = rate->activation;
  second->reference = rate->reference;
  second->deactivation = rate->deactivation;
  second->half_activity = rate->half_activity;
  if (kinetics->law == LAM_KINETIC_TABLE) PetscCall(ReadTable(entry, kinetics));
  PetscFunctionReturn(0);
}

/* Rejects properties that the tissue does not have. */
static PetscErrorCode CheckChanging(const LamNode *of, LamChanging changing, const LamScene *scene)
{
  const PetscBool of_water = (PetscBool)(changing == LAM_CHANGING_SOLUTES || changing == LAM_CHANGING_PERMEABILITY ||
                                         changing == LAM_CHANGING_REFLECTION);
  PetscBool contact = LamCellsPart(scene->micro.interface);

  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < scene->region_count; r++)
    if (LamCellsPart(scene->regions[r].micro.interface)) contact = PETSC_TRUE;
  LamSceneCheck(!of_water || scene->process.has_water, of,
                "belongs to process.water, which is missing; write that block, or leave it out");
  LamSceneCheck(!LamSceneLacksChanging(scene, changing), of,
                "no wall of the scene has it; leave it out, or choose another law");
  LamSceneCheck(changing != LAM_CHANGING_WALL_STRENGTH || !isnan(scene->strength.wall), of,
                "strength.wall is not given; write it, or leave this out");
  LamSceneCheck(changing != LAM_CHANGING_LAMELLA || contact || !isnan(scene->strength.lamella_normal) ||
                    !isnan(scene->strength.lamella_shear),
                of,
                "bonded cells have no cohesion, and strength.lamella_normal and lamella_shear are not given; write one "
                "of them, or law: contact");
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildKinetics(const LamNode *list, LamScene *scene)
{
  PetscBool given[LAM_CHANGING_COUNT] = {PETSC_FALSE};

  PetscFunctionBeginUser;
  for (const LamNode *entry = list ? list->first : NULL; entry; entry = entry->next) {
    const LamNode *of = LamNodeFind(entry, "of");
    const LamChanging changing = (LamChanging)of->value.number[0];
    const PetscInt parameter = (PetscInt)changing - (PetscInt)LAM_CHANGING_OF_PARAMETER(0);

    LamSceneCheck(!given[changing], of, "has an entry already; leave one of them out");
    given[changing] = PETSC_TRUE;
    PetscCall(CheckChanging(of, changing, scene));
    LamSceneCheck(parameter < 0 || parameter >= LAM_WALL_PARAMETER_COUNT || !LamWallsRelax(&scene->micro), of,
                  "would change walls with memory, rve.wall.relaxation, in part, and what of their past would change "
                  "with it is not known; write walls, with which all of it changes");
    PetscCall(ReadKinetics(entry, &scene->process.kinetics[changing]));
    if (parameter >= 0 && parameter < LAM_WALL_PARAMETER_COUNT)
      PetscCall(LamSceneCheckFactor(of, scene, parameter, LamKineticsLargest(&scene->process.kinetics[changing])));
  }
  PetscFunctionReturn(0);
}

/* ---- program ---- */

static PetscErrorCode ReadLeg(const LamNode *entry, const LamScene *scene, LamProcessLeg *leg)
{
  const LamNode *F = LamNodeFind(entry, "F"), *P = LamNodeFind(entry, "P"), *point = F ? F : P;
  const LamNode *load = LamNodeFind(entry, "load");

  PetscFunctionBeginUser;
  LamSceneCheckName(!load || scene->has_macro, load,
                    "is the load parameter of a body, but there is no block macro; write F and P, or that block");
  LamSceneCheckName(!point || !scene->has_macro, point,
                    "is for one material point, but the block macro describes a body; write load, or leave that block "
                    "out");
  LamSceneRequire(F || !P, entry, "F", "missing; write F: [[free, 0], [0, free]] beside P, or leave out both");
  if (F) {
    PetscCall(LamSceneReadControl(F, P, scene->scales.stress, &leg->control));
    PetscCall(LamSceneCheckF(F, PETSC_FALSE));
  }
  PetscCall(LamSceneFill(entry, &scene->scales, LamProcessLeg, leg));
  PetscFunctionReturn(0);
}

/* *cycle: the time that the program takes once. */
static PetscErrorCode BuildLegs(const LamNode *block, LamScene *scene, PetscReal *cycle)
{
  /* stress-free in the plane; F21 prevents rotation */
  LamProcessLeg leg = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .control = {.given = {1, 1, 0, 0, 1}, .share = 1}};
  const LamNode *list = LamNodeFind(block, "program"), *repeat = LamNodeFind(block, "repeat");
  LamProcessSpec *spec = &scene->process;

  PetscFunctionBeginUser;
  *cycle = 0;
  PetscCall(PetscMalloc1(list ? list->count : 1, &spec->legs));
  if (!list) spec->legs[spec->leg_count++] = leg;
  for (const LamNode *entry = list ? list->first : NULL; entry; entry = entry->next) {
    leg.output = 0;
    PetscCall(ReadLeg(entry, scene, &leg));
    spec->legs[spec->leg_count++] = leg;
    *cycle += leg.duration;
    LamSceneCheck(!(leg.output > 0) || (PetscReal)spec->repeat * leg.duration / leg.output <= MAX_OUTPUTS,
                  LamNodeFind(entry, "output"), TOO_MANY_OUTPUTS, MAX_OUTPUTS);
  }
  LamSceneCheckName(!repeat || *cycle > 0, repeat, "repeats a program that takes no time; give its parts a time");
  PetscFunctionReturn(0);
}

/* ---- duration ---- */

/* A jump at the end of the process is not seen. */
static PetscErrorCode CheckJumps(const LamNode *list, const LamProcessSpec *spec, PetscReal cycle)
{
  PetscReal at = 0;
  PetscInt k = 0;

  PetscFunctionBeginUser;
  for (const LamNode *entry = list ? list->first : NULL; entry; entry = entry->next, k++) {
    const PetscReal before = cycle > 0 && at > 0 ? rint((spec->duration - at) / cycle) : 0; /* repetitions */
    const PetscReal last = PetscMax(0, PetscMin(before, (PetscReal)(spec->repeat - 1))) * cycle + at;

    LamSceneCheck(spec->legs[k].duration != 0 || fabs(last - spec->duration) > LAM_SAME_TIME * spec->duration, entry,
                  "is a jump at the very end, of which nothing is seen; make process.duration longer");
    at += spec->legs[k].duration;
  }
  PetscFunctionReturn(0);
}

/* The duration, where it is not given. */
static PetscErrorCode BuildDuration(const LamNode *block, LamScene *scene, PetscReal cycle)
{
  const LamNode *duration = LamNodeFind(block, "duration");
  LamProcessSpec *spec = &scene->process;
  const PetscReal bath = spec->surroundings[spec->surroundings_count - 1].time;
  const PetscReal end = PetscMax((PetscReal)spec->repeat * cycle, bath);

  PetscFunctionBeginUser;
  LamSceneRequire(
      duration || end > 0, block, "duration",
      "missing; write a time with its unit, larger than 0 s, such as 14 day, or a program or surroundings that "
      "take time");
  if (!duration) spec->duration = end;
  PetscCall(CheckJumps(LamNodeFind(block, "program"), spec, cycle));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildProcess(const LamNode *root, LamScene *scene)
{
  const LamNode *block = LamNodeFind(root, "process"), *inflate = LamNodeFind(block, "inflate");
  const LamNode *output = LamNodeFind(block, "output"), *reference = LamNodeFind(block, "reference");
  LamProcessSpec *spec = &scene->process;
  PetscReal cycle;

  PetscFunctionBeginUser;
  if (!block) PetscFunctionReturn(0);
  scene->has_process = PETSC_TRUE;
  spec->inflate = (PetscBool)(scene->turgor != 0);
  PetscCall(LamSceneFill(block, &scene->scales, LamProcessSpec, spec));
  LamSceneCheckName(!scene->has_macro || !inflate, inflate, "is for one material point; of a body write macro.inflate");
  LamSceneCheckName(!scene->has_macro || !reference, reference,
                    "is for one material point; of a body write macro.reference");
  LamSceneCheck(spec->area != LAM_AREA_INFLATED || spec->inflate, reference,
                "needs the inflated tissue; write a turgor, and no inflate: false");
  LamSceneCheckName(!scene->sealed, block,
                    "contradicts turgor mode: sealed; write mode: prescribed there, and process.water with "
                    "permeability: 0 m/s/MPa for cells that keep their water");
  LamSceneCheckName(
      !scene->has_macro || scene->micro.interface != LAM_INTERFACE_LAMELLA, block,
      "this version of Lamella has processes of law: lamella at a material point only; leave macro out, or "
      "write law: bonded or contact");
  PetscCall(BuildWater(LamNodeFind(block, "water"), scene));
  PetscCall(BuildSurroundings(LamNodeFind(block, "surroundings"), scene));
  PetscCall(LamSceneBuildTransport(block, scene));
  PetscCall(BuildKinetics(LamNodeFind(block, "kinetics"), scene));
  PetscCall(BuildLegs(block, scene, &cycle));
  PetscCall(BuildDuration(block, scene, cycle));
  if (!output) spec->output = spec->duration / 100;
  LamSceneCheck(spec->duration / spec->output <= MAX_OUTPUTS, output, TOO_MANY_OUTPUTS, MAX_OUTPUTS);
  PetscCall(LamSceneDoubtProcess(block, scene, cycle));
  PetscFunctionReturn(0);
}
