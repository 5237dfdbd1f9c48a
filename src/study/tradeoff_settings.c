/*
  Settings of a scene: one parameter is varied at a time, the others are those of the scene and the planner.
*/
#include "tradeoff.h"
#include <stdio.h>
#include <string.h>

const char *const LamKnobNames[] = {LAM_KNOBS(LAM_NAME_ENTRY)};

enum { MOST_SETTINGS = 64 };

static const PetscInt Along[] = {4, 6, 8, 12, 16, 20}, Through[] = {1, 2, 4};
static const PetscReal Gradings[] = {0, 0.6};
static const PetscReal Tolerances[] = {1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 0};
static const PetscInt Cells[][2] = {{1, 1}, {2, 1}, {2, 2}};
static const PetscReal Accuracies[] = {0.1, 0.03, 0.01, 0.003, 0.001};
#define COUNT(array) ((PetscInt)PETSC_STATIC_ARRAY_LENGTH(array))

/* ---- applicability ---- */

static const char *WhyNotCells(const LamMicrostructure *micro)
{
  if (micro->is_patch) return "a patch has the cells that it has";
  if (micro->cell) return "the cells differ";
  return NULL;
}

/* A table is for tissue at a prescribed turgor. */
static const char *WhyNotTable(const LamScene *scene)
{
  if (!scene->has_sample) return "the scene has no block sample";
  if (scene->sealed) return "a table does not answer for sealed cells";
  return NULL;
}

PetscBool LamKnobApplies(const LamScene *scene, LamKnob knob, const char **why)
{
  *why = NULL;
  if (knob == LAM_KNOB_STRATEGY && scene->micro.interface == LAM_INTERFACE_BONDED) *why = "the cells are bonded";
  if (knob == LAM_KNOB_CELLS) *why = WhyNotCells(&scene->micro);
  if (knob == LAM_KNOB_DATABASE) *why = WhyNotTable(scene);
  if (knob == LAM_KNOB_MACRO && !scene->has_macro) *why = "the scene has no block macro";
  return (PetscBool)(*why == NULL);
}

/* ---- settings ---- */

typedef struct {
  PetscInt n;
  LamSetting *settings;
} List;

static LamSetting *Add(const LamScene *scene, LamKnob knob, List *list)
{
  LamSetting *s = &list->settings[list->n++];

  *s = (LamSetting){.knob = knob, .micro = scene->micro, .strategy = scene->strategy, .tolerance = scene->tolerance};
  return s;
}

static void NameMesh(LamSetting *s)
{
  const LamMicrostructure *m = &s->micro;

  snprintf(s->label, sizeof(s->label), "%" PetscInt_FMT " x %" PetscInt_FMT, m->along, m->through);
  if (m->grading > 0)
    snprintf(s->label + strlen(s->label), sizeof(s->label) - strlen(s->label), ", graded %g", (double)m->grading);
  snprintf(s->mark, sizeof(s->mark), "%" PetscInt_FMT, m->along);
}

static PetscBool SameMesh(const LamMicrostructure *a, const LamMicrostructure *b)
{
  return (PetscBool)(a->along == b->along && a->through == b->through && a->grading == b->grading);
}

static PetscBool HasMesh(const List *list, const LamMicrostructure *mesh)
{
  for (PetscInt i = 0; i < list->n; i++)
    if (SameMesh(&list->settings[i].micro, mesh)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void AddMeshes(const LamScene *scene, List *list)
{
  LamSetting *s;

  for (PetscInt g = 0; g < COUNT(Gradings); g++)
    for (PetscInt t = 0; t < COUNT(Through); t++)
      for (PetscInt a = 0; a < COUNT(Along); a++) {
        s = Add(scene, LAM_KNOB_MESH, list);
        s->micro.along = Along[a];
        s->micro.through = Through[t];
        s->micro.grading = Gradings[g];
        s->planned = SameMesh(&s->micro, &scene->micro);
        NameMesh(s);
      }
  if (HasMesh(list, &scene->micro)) return;
  s = Add(scene, LAM_KNOB_MESH, list);
  s->planned = PETSC_TRUE;
  NameMesh(s);
}

static void AddStrategies(const LamScene *scene, List *list)
{
  for (int k = 0; k < LAM_STRATEGY_COUNT; k++) {
    LamSetting *s = Add(scene, LAM_KNOB_STRATEGY, list);

    s->strategy = (LamStrategy)k;
    s->planned = (PetscBool)(s->strategy == scene->strategy);
    snprintf(s->label, sizeof(s->label), "%s", LamStrategyNames[k]);
    snprintf(s->mark, sizeof(s->mark), "%s", k == LAM_TWO_STEP ? "two steps" : "one step");
  }
}

static void AddCells(const LamScene *scene, List *list)
{
  PetscBool planned = PETSC_FALSE;

  for (PetscInt k = 0; k <= COUNT(Cells); k++) {
    const PetscInt *cells = k < COUNT(Cells) ? Cells[k] : scene->micro.cells;
    LamSetting *s;

    if (k == COUNT(Cells) && planned) return;
    s = Add(scene, LAM_KNOB_CELLS, list);
    for (int d = 0; d < 2; d++) s->micro.cells[d] = cells[d];
    s->planned = (PetscBool)(cells[0] == scene->micro.cells[0] && cells[1] == scene->micro.cells[1]);
    planned = (PetscBool)(planned || s->planned);
    snprintf(s->label, sizeof(s->label), "%" PetscInt_FMT " x %" PetscInt_FMT " cells", cells[0], cells[1]);
    snprintf(s->mark, sizeof(s->mark), "%" PetscInt_FMT "x%" PetscInt_FMT, cells[0], cells[1]);
  }
}

static void AddTolerances(const LamScene *scene, List *list)
{
  PetscBool planned = PETSC_FALSE;

  for (PetscInt k = 0; k <= COUNT(Tolerances); k++) {
    LamSetting *s;

    if (k == COUNT(Tolerances) && planned) return;
    s = Add(scene, LAM_KNOB_TOLERANCE, list);
    if (k < COUNT(Tolerances)) s->tolerance = Tolerances[k];
    s->planned = (PetscBool)(s->tolerance == scene->tolerance);
    planned = (PetscBool)(planned || s->planned);
    if (s->tolerance > 0)
      snprintf(s->label, sizeof(s->label), "%g", (double)s->tolerance);
    else
      snprintf(s->label, sizeof(s->label), "rounding");
    snprintf(s->mark, sizeof(s->mark), "%.15s", s->label);
  }
}

static void NameAnswer(const char how[], LamSetting *s)
{
  snprintf(s->label, sizeof(s->label), "%s, %g %%", how, 100 * (double)s->accuracy);
  snprintf(s->mark, sizeof(s->mark), "%g %%", 100 * (double)s->accuracy);
}

static void AddTables(const LamScene *scene, List *list)
{
  for (PetscInt k = 0; k < COUNT(Accuracies); k++) {
    LamSetting *s = Add(scene, LAM_KNOB_DATABASE, list);

    s->accuracy = Accuracies[k];
    NameAnswer("table", s);
  }
}

/* A body of several tissues would need one table for each. */
static PetscBool OneTable(const LamScene *scene)
{
  return (PetscBool)(!WhyNotTable(scene) && !scene->region_count && !scene->fields.value[LAM_TISSUE_WALL_THICKNESS]);
}

static void AddResponses(const LamScene *scene, List *list)
{
  LamSetting *s = Add(scene, LAM_KNOB_MACRO, list);

  s->planned = PETSC_TRUE; /* and the reference of the others */
  snprintf(s->label, sizeof(s->label), "direct");
  snprintf(s->mark, sizeof(s->mark), "direct");
  for (PetscInt k = 0; k < COUNT(Accuracies); k++) {
    s = Add(scene, LAM_KNOB_MACRO, list);
    s->response = LAM_FE2_CACHE;
    s->accuracy = Accuracies[k];
    NameAnswer("cache", s);
  }
  for (PetscInt k = 0; k < COUNT(Accuracies) && OneTable(scene); k++) {
    s = Add(scene, LAM_KNOB_MACRO, list);
    s->response = LAM_FE2_DATABASE;
    s->accuracy = Accuracies[k];
    NameAnswer("database", s);
  }
}

PetscErrorCode LamSettingsMake(const LamScene *scene, LamKnob knob, PetscInt *n, LamSetting **settings)
{
  static void (*const make[])(const LamScene *, List *) = {
      [LAM_KNOB_MESH] = AddMeshes,          [LAM_KNOB_STRATEGY] = AddStrategies, [LAM_KNOB_CELLS] = AddCells,
      [LAM_KNOB_TOLERANCE] = AddTolerances, [LAM_KNOB_DATABASE] = AddTables,     [LAM_KNOB_MACRO] = AddResponses};
  List list = {0};

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(MOST_SETTINGS, &list.settings));
  make[knob](scene, &list);
  *n = list.n;
  *settings = list.settings;
  PetscFunctionReturn(0);
}
