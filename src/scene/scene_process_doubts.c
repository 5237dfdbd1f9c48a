/*
  Warnings of the `process` block: what is accepted and probably a mistake.
*/
#include "scene_keys.h"
#include "quantity_text.h"
#include <math.h>

/* ---- water ---- */

/* Osmotic pressure outside at the start; of two entries at time 0 the last one. */
static PetscReal OutsideAtStart(const LamProcessSpec *spec)
{
  PetscInt k = 0;

  while (k + 1 < spec->surroundings_count && spec->surroundings[k + 1].time <= 0) k++;
  return spec->surroundings[k].outside;
}

/* If the osmotic pressures hold another turgor than that of this tissue (C1 + C2 of the scene). others: whether the
   turgors of the body differ, so that no osmotic pressure holds all of them. */
static PetscErrorCode DoubtTurgor(const LamNode *node, LamScene *scene, const char whose[], PetscReal turgor,
                                  PetscBool others)
{
  const LamWaterSpec *water = &scene->process.water;
  const PetscReal MPa = scene->scales.stress * 1e-6, outside = OutsideAtStart(&scene->process);
  const PetscReal held = PetscMax(0, water->reflection * (water->osmotic - outside));
  char balance[LAM_REASON_LENGTH] = "";

  PetscFunctionBeginUser;
  if (fabs(held - turgor) <= scene->accuracy * PetscMax(held, turgor)) PetscFunctionReturn(0);
  if (others)
    snprintf(balance, sizeof(balance), "; leave it out for a start in equilibrium");
  else if (water->reflection > 0)
    snprintf(balance, sizeof(balance), "; leave it out, or write %.4g MPa, for a start in equilibrium",
             (double)((turgor / water->reflection + outside) * MPa));
  PetscCall(LamSceneWarn(scene, node, LAM_MISTAKE_VALUE, NULL,
                         "with %.4g MPa outside it holds a turgor of %.4g MPa, but that of %s is %.4g MPa: %s, "
                         "turgor %s by up to %.4g MPa%s",
                         (double)(outside * MPa), (double)(held * MPa), whose, (double)(turgor * MPa),
                         isfinite(water->permeability) ? "from the start" : "at once",
                         held > turgor ? "rises" : "falls", (double)(fabs(held - turgor) * MPa), balance));
  PetscFunctionReturn(0);
}

/* Turgor of a region, C1 + C2 of the scene. */
static PetscReal RegionTurgor(const LamScene *scene, const LamRegion *region)
{
  return region->turgor * region->scales.stress / scene->scales.stress;
}

static PetscBool Differs(const LamScene *scene, const LamRegion *region)
{
  return (PetscBool)(fabs(RegionTurgor(scene, region) - scene->turgor) > scene->accuracy * scene->turgor);
}

/* Of the tissue and of each region. */
static PetscErrorCode DoubtWater(const LamNode *block, LamScene *scene)
{
  const LamNode *node = LamNodeFind(block, "osmotic_pressure");
  PetscBool others = PETSC_FALSE;

  PetscFunctionBeginUser;
  if (!node || scene->process.water.permeability == 0) PetscFunctionReturn(0);
  if (scene->fields.value[LAM_TISSUE_TURGOR]) {
    PetscCall(LamSceneWarn(scene, node, LAM_MISTAKE_VALUE, NULL,
                           "holds one turgor, but macro.fields.turgor varies: turgor evens out %s; leave it out for a "
                           "start in equilibrium",
                           isfinite(scene->process.water.permeability) ? "from the start" : "at once"));
    PetscFunctionReturn(0);
  }
  for (PetscInt r = 0; r < scene->region_count; r++)
    if (Differs(scene, &scene->regions[r])) others = PETSC_TRUE;
  PetscCall(DoubtTurgor(node, scene, "rve.turgor", scene->turgor, others));
  for (PetscInt r = 0; r < scene->region_count; r++) {
    const LamRegion *region = &scene->regions[r];
    char whose[LAM_NAME_LENGTH + 40];

    snprintf(whose, sizeof(whose), "region %s", region->name);
    if (Differs(scene, region)) PetscCall(DoubtTurgor(node, scene, whose, RegionTurgor(scene, region), others));
  }
  PetscFunctionReturn(0);
}

/* ---- times ---- */

/* The time in the unit of the longest of a message. */
static void TimeText(PetscReal time, PetscReal longest, char text[LAM_REASON_LENGTH])
{
  PetscReal seconds;
  const char *unit = LamTimeUnit(longest, &seconds);

  snprintf(text, LAM_REASON_LENGTH, "%.6g %s", (double)(time / seconds), unit);
}

static PetscBool Exceeds(const LamScene *scene, PetscReal time)
{
  return (PetscBool)(time > scene->process.duration * (1 + LAM_SAME_TIME));
}

/* Of a program and surroundings beyond the duration, which then is given. */
static PetscErrorCode DoubtDuration(const LamNode *block, LamScene *scene, PetscReal program)
{
  const LamNode *duration = LamNodeFind(block, "duration"), *surroundings = LamNodeFind(block, "surroundings");
  const LamProcessSpec *spec = &scene->process;
  const PetscReal bath = spec->surroundings[spec->surroundings_count - 1].time, end = PetscMax(program, bath);
  char own[LAM_REASON_LENGTH], wanted[LAM_REASON_LENGTH], cut[LAM_REASON_LENGTH];

  PetscFunctionBeginUser;
  TimeText(spec->duration, end, own);
  if (Exceeds(scene, program)) {
    TimeText(program, end, wanted);
    TimeText(program - spec->duration, end, cut);
    PetscCall(LamSceneWarn(scene, duration, LAM_MISTAKE_VALUE, NULL,
                           "process.program%s takes %s, of which the last %s are cut off; write %s, or leave it out",
                           spec->repeat > 1 ? ", with its repetitions," : "", wanted, cut, wanted));
  }
  if (Exceeds(scene, bath)) {
    TimeText(bath, end, wanted);
    PetscCall(LamSceneWarn(scene, LamNodeFind(surroundings->last, "time"), LAM_MISTAKE_VALUE, NULL,
                           "is never reached: the process ends at %s (process.duration, line %d); write %s there, or "
                           "leave that out",
                           own, duration->line, wanted));
  }
  PetscFunctionReturn(0);
}

/* Of a table that ends before the process, and of one whose last pair has no part in it. */
static PetscErrorCode DoubtTable(const LamNode *entry, LamScene *scene)
{
  const LamKinetics *law = &scene->process.kinetics[(PetscInt)LamNodeFind(entry, "of")->value.number[0]];
  const PetscReal duration = scene->process.duration, last = law->count ? law->time[law->count - 1] : duration;
  const PetscReal longest = PetscMax(duration, last);
  const LamNode *table = LamNodeFind(entry, "table");
  char end[LAM_REASON_LENGTH], at[LAM_REASON_LENGTH];

  PetscFunctionBeginUser;
  TimeText(duration, longest, end);
  TimeText(last, longest, at);
  if (last < duration * (1 - LAM_SAME_TIME))
    PetscCall(LamSceneWarn(scene, table->last, LAM_MISTAKE_VALUE, NULL,
                           "the table ends at %s, the process at %s: in between the factor stays at %.4g; write a pair "
                           "for the end of the process",
                           at, end, (double)law->factor[law->count - 1]));
  else if (law->count > 1 && law->time[law->count - 2] >= duration * (1 - LAM_SAME_TIME) && Exceeds(scene, last))
    PetscCall(LamSceneWarn(scene, table->last, LAM_MISTAKE_VALUE, NULL,
                           "is never reached: the process ends at %s, the table at %s; write a longer "
                           "process.duration, or leave the pair out",
                           end, at));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneDoubtProcess(const LamNode *block, LamScene *scene, PetscReal cycle)
{
  const LamNode *kinetics = LamNodeFind(block, "kinetics");

  PetscFunctionBeginUser;
  if (scene->process.has_water) PetscCall(DoubtWater(LamNodeFind(block, "water"), scene));
  PetscCall(DoubtDuration(block, scene, (PetscReal)scene->process.repeat * cycle));
  for (const LamNode *entry = kinetics ? kinetics->first : NULL; entry; entry = entry->next)
    PetscCall(DoubtTable(entry, scene));
  PetscFunctionReturn(0);
}
