/*
  Settings of a scene: one parameter is varied at a time, the others are those of the scene and the planner. And the
  states solved with each setting: those of the scene's load; without a load, states of its sample box; without either,
  shears and stretches.

  All settings are solved at the same F. Where the load prescribes stress in place of components of F, these components
  are found first, on the planned mesh.
*/
#include "tradeoff.h"
#include "build.h"
#include "onset.h"
#include <stdio.h>
#include <string.h>

const char *const LamKnobNames[] = {LAM_KNOBS(LAM_NAME_ENTRY)};

enum { MOST_SETTINGS = 64 };

static const PetscInt Along[] = {4, 6, 8, 12, 16, 20}, Through[] = {1, 2, 4};
static const PetscReal Gradings[] = {0, 0.6};
static const PetscReal Tolerances[] = {1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 0};
static const PetscReal Widths[] = {0.01, LAM_USUAL_WIDTH, 0.001};
static const PetscInt Cells[][2] = {{1, 1}, {2, 1}, {2, 2}};
static const PetscReal Accuracies[] = {0.1, 0.03, 0.01, 0.003, 0.001};
#define COUNT(array) ((PetscInt)PETSC_STATIC_ARRAY_LENGTH(array))

/* ---- applicability ---- */

static const char *WhyNotCells(const LamMicrostructure *micro)
{
  if (micro->is_patch) return "a patch has the cells that it has";
  if (micro->tissue) return "the cells are those of a file";
  if (micro->cell) return "the cells differ";
  return NULL;
}

/* A table is for tissue at a prescribed turgor. */
static const char *WhyNotTable(const LamScene *scene)
{
  if (!scene->has_sample) return "the scene has no block sample";
  if (scene->sealed) return "a table has no responses of sealed cells";
  if (LamHasHistory(&scene->micro)) return "a table has no tissue with history";
  return NULL;
}

PetscBool LamKnobApplies(const LamScene *scene, LamKnob knob, const char **why)
{
  *why = NULL;
  if ((knob == LAM_KNOB_STRATEGY || knob == LAM_KNOB_SHARPNESS) && scene->micro.interface == LAM_INTERFACE_BONDED)
    *why = "the cells are bonded";
  if (knob == LAM_KNOB_CELLS) *why = WhyNotCells(&scene->micro);
  if (knob == LAM_KNOB_DATABASE) *why = WhyNotTable(scene);
  if (knob == LAM_KNOB_MACRO && !scene->has_macro) *why = "the scene has no block macro";
  if (knob == LAM_KNOB_MACRO && LamWallsRelax(&scene->micro)) *why = "steps of fe2 take no time";
  return (PetscBool)(*why == NULL);
}

/* ---- settings ---- */

/* A body of several tissues would need one table for each. */
static PetscBool OneTable(const LamScene *scene)
{
  return (PetscBool)(!WhyNotTable(scene) && !scene->region_count && !scene->fields.value[LAM_TISSUE_WALL_THICKNESS]);
}

/* Varies one parameter in settings that are those of the scene; returns their number. */
static PetscInt VaryMesh(LamSetting settings[])
{
  PetscInt n = 0;

  for (PetscInt g = 0; g < COUNT(Gradings); g++)
    for (PetscInt t = 0; t < COUNT(Through); t++)
      for (PetscInt a = 0; a < COUNT(Along); a++) {
        LamMicrostructure *micro = &settings[n++].micro;

        micro->along = Along[a];
        micro->through = Through[t];
        micro->grading = Gradings[g];
      }
  return n;
}

/* The exact law, then the smooth one. */
static PetscInt VarySharpness(LamSetting settings[])
{
  settings[0].micro.sharpness = LAM_SHARPNESS_EXACT;
  for (PetscInt k = 0; k < COUNT(Widths); k++) {
    settings[k + 1].micro.sharpness = LAM_SHARPNESS_SMOOTH;
    settings[k + 1].micro.contact_width = Widths[k];
  }
  return 1 + COUNT(Widths);
}

static PetscInt VaryResponse(const LamScene *scene, LamSetting settings[])
{
  PetscInt n = 1; /* the first one: direct */

  for (LamFE2Response response = LAM_FE2_CACHE; response <= LAM_FE2_DATABASE; response++)
    for (PetscInt k = 0; k < COUNT(Accuracies) && (response == LAM_FE2_CACHE || OneTable(scene)); k++) {
      settings[n].response = response;
      settings[n++].accuracy = Accuracies[k];
    }
  return n;
}

static PetscInt Vary(const LamScene *scene, LamKnob knob, LamSetting settings[])
{
  switch (knob) {
  case LAM_KNOB_MESH:
    return VaryMesh(settings);
  case LAM_KNOB_STRATEGY:
    for (int k = 0; k < LAM_STRATEGY_COUNT; k++) settings[k].strategy = (LamStrategy)k;
    return LAM_STRATEGY_COUNT;
  case LAM_KNOB_SHARPNESS:
    return VarySharpness(settings);
  case LAM_KNOB_CELLS:
    for (PetscInt k = 0; k < COUNT(Cells); k++)
      for (int d = 0; d < 2; d++) settings[k].micro.cells[d] = Cells[k][d];
    return COUNT(Cells);
  case LAM_KNOB_TOLERANCE:
    for (PetscInt k = 0; k < COUNT(Tolerances); k++) settings[k].tolerance = Tolerances[k];
    return COUNT(Tolerances);
  case LAM_KNOB_DATABASE:
    for (PetscInt k = 0; k < COUNT(Accuracies); k++) settings[k].accuracy = Accuracies[k];
    return COUNT(Accuracies);
  default:
    return VaryResponse(scene, settings);
  }
}

/* Of the smooth law of contact; 0: the exact one. */
static PetscReal WidthOf(const LamMicrostructure *micro)
{
  if (micro->sharpness != LAM_SHARPNESS_SMOOTH) return 0;
  return micro->contact_width > 0 ? micro->contact_width : LAM_USUAL_WIDTH;
}

/* Of a body direct responses: also the reference of the others. */
static PetscBool IsPlanned(const LamScene *scene, const LamSetting *s)
{
  const LamMicrostructure *a = &s->micro, *b = &scene->micro;

  return (PetscBool)(a->along == b->along && a->through == b->through && a->grading == b->grading &&
                     a->cells[0] == b->cells[0] && a->cells[1] == b->cells[1] && WidthOf(a) == WidthOf(b) &&
                     s->strategy == scene->strategy && s->tolerance == scene->tolerance && s->accuracy == 0);
}

static void NameMesh(LamSetting *s)
{
  const LamMicrostructure *m = &s->micro;

  snprintf(s->label, sizeof(s->label), "%" PetscInt_FMT " x %" PetscInt_FMT, m->along, m->through);
  if (m->grading > 0)
    snprintf(s->label + strlen(s->label), sizeof(s->label) - strlen(s->label), ", graded %g", (double)m->grading);
  snprintf(s->mark, sizeof(s->mark), "%" PetscInt_FMT, m->along);
}

static void Name(LamSetting *s)
{
  const char *response = s->knob == LAM_KNOB_DATABASE ? "table" : LamFE2ResponseNames[s->response];
  const PetscInt *cells = s->micro.cells;

  if (s->knob == LAM_KNOB_MESH) {
    NameMesh(s);
  } else if (s->knob == LAM_KNOB_STRATEGY) {
    snprintf(s->label, sizeof(s->label), "%s", LamStrategyNames[s->strategy]);
    snprintf(s->mark, sizeof(s->mark), "%s", s->strategy == LAM_TWO_STEP ? "two steps" : "one step");
  } else if (s->knob == LAM_KNOB_SHARPNESS) {
    const PetscReal width = WidthOf(&s->micro);

    snprintf(s->label, sizeof(s->label), width > 0 ? "smooth, width %g" : "exact", (double)width);
    snprintf(s->mark, sizeof(s->mark), width > 0 ? "%g" : "exact", (double)width);
  } else if (s->knob == LAM_KNOB_CELLS) {
    snprintf(s->label, sizeof(s->label), "%" PetscInt_FMT " x %" PetscInt_FMT " cells", cells[0], cells[1]);
    snprintf(s->mark, sizeof(s->mark), "%" PetscInt_FMT "x%" PetscInt_FMT, cells[0], cells[1]);
  } else if (s->accuracy > 0) {
    snprintf(s->label, sizeof(s->label), "%s, %g %%", response, 100 * (double)s->accuracy);
    snprintf(s->mark, sizeof(s->mark), "%g %%", 100 * (double)s->accuracy);
  } else {
    snprintf(s->label, sizeof(s->label), "%s", s->knob == LAM_KNOB_TOLERANCE ? "rounding" : response);
    if (s->knob == LAM_KNOB_TOLERANCE && s->tolerance > 0)
      snprintf(s->label, sizeof(s->label), "%g", (double)s->tolerance);
    snprintf(s->mark, sizeof(s->mark), "%.15s", s->label);
  }
}

PetscErrorCode LamSettingsMake(const LamScene *scene, LamKnob knob, PetscInt *n, LamSetting **settings)
{
  const LamSetting plan = {
      .knob = knob, .micro = scene->micro, .strategy = scene->strategy, .tolerance = scene->tolerance};
  PetscBool planned = (PetscBool)(knob == LAM_KNOB_DATABASE); /* there is no table without an accuracy */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(MOST_SETTINGS, settings));
  for (PetscInt i = 0; i < MOST_SETTINGS; i++) (*settings)[i] = plan;
  *n = Vary(scene, knob, *settings);
  for (PetscInt i = 0; i < *n; i++) planned = (PetscBool)(planned || IsPlanned(scene, &(*settings)[i]));
  if (!planned) ++*n;
  for (PetscInt i = 0; i < *n; i++) {
    (*settings)[i].planned = IsPlanned(scene, &(*settings)[i]);
    Name(&(*settings)[i]);
  }
  PetscFunctionReturn(0);
}

/* ---- states ---- */

enum { SAMPLED = 8 }; /* number of states of the sample box */

static const PetscReal Shears[] = {0.05, 0.1, 0.15, 0.2};
static const PetscReal Stretches[][2] = {{1.05, 1}, {1, 1.05}, {1.03, 1.03}};
enum { SHEARS = PETSC_STATIC_ARRAY_LENGTH(Shears), STRETCHES = PETSC_STATIC_ARRAY_LENGTH(Stretches) };

static void Default(const LamScene *scene, LamStates *states)
{
  const LamLoad undeformed = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .turgor = scene->turgor, .cohesion = scene->cohesion};

  for (PetscInt s = 0; s < SHEARS + STRETCHES; s++) {
    LamLoad *load = &states->loads[states->n++];

    *load = undeformed;
    if (s < SHEARS) {
      load->F[1] = Shears[s];
    } else {
      load->F[0] = Stretches[s - SHEARS][0];
      load->F[4] = Stretches[s - SHEARS][1];
    }
  }
  states->origin = "default";
}

/* Finds the free components of F; states that do not converge are dropped. */
static PetscErrorCode FindFree(LamScene *scene, LamStates *states)
{
  LamResponse responses[2];
  LamMeshes meshes;

  PetscFunctionBeginUser;
  PetscCall(LamMeshesCreate(PETSC_COMM_SELF, scene, 1, &meshes));
  PetscCall(LamMeshesSetInterrupt(&meshes, LamStopInterrupt, NULL));
  if (!scene->inflate) PetscCall(LamMeshesSeal(&meshes, scene, &scene->loads[0]));
  for (PetscInt s = 0; s < scene->load_count && !meshes.stopped; s++) {
    PetscCall(LamMeshesSolve(&meshes, &scene->loads[s], &scene->controls[s], responses));
    if (LamResponseHasFields(&responses[0])) states->loads[states->n++] = responses[0].load;
    if (!scene->inflate || s > 0) continue;
    if (!states->n) break; /* what follows counts from the inflated tissue */
    LamLoadsFromInflated(scene, states->loads[0].F);
    PetscCall(LamMeshesSeal(&meshes, scene, &states->loads[0]));
  }
  PetscCall(LamMeshesDestroy(&meshes));
  states->dropped = scene->load_count - states->n;
  PetscFunctionReturn(0);
}

PetscErrorCode LamStatesMake(LamScene *scene, LamStates *states)
{
  PetscReal wedge;

  PetscFunctionBeginUser;
  *states = (LamStates){.origin = "load", .chained = PETSC_TRUE};
  PetscCall(PetscCalloc1(PetscMax(scene->load_count, SAMPLED), &states->loads));
  if (scene->load_count && scene->controls) {
    PetscCall(FindFree(scene, states));
  } else if (scene->load_count) {
    PetscCall(PetscArraycpy(states->loads, scene->loads, scene->load_count));
    states->n = scene->load_count;
  } else if (scene->has_sample) {
    PetscCall(LamSampleWedge(&scene->micro, &wedge));
    for (; states->n < SAMPLED; states->n++) LamSampleLoad(scene, wedge, states->n, &states->loads[states->n]);
    states->origin = "sample";
    states->chained = PETSC_FALSE;
  } else {
    Default(scene, states);
    states->chained = PETSC_FALSE;
  }
  PetscCall(PetscCalloc1(PetscMax(states->n, 1), &states->skip));
  PetscFunctionReturn(0);
}

PetscInt LamStatesCount(const LamStates *states)
{
  PetscInt count = 0;

  for (PetscInt s = 0; s < states->n; s++) count += !states->skip[s];
  return count;
}
