/*
  The `map` block of a scene: two varying quantities.
*/
#include "scene_rows.h"
#include "quantity_text.h"
#include <math.h>
#include <string.h>

const char *const LamMapQuantityNames[] = {LAM_MAP_QUANTITIES(LAM_NAME_ENTRY)};
static const char *const spacing_names[] = {"linear", "log"}; /* LamMapAxis.is_log 0 and 1 */

/* Both axes have the same keys. `from` and `to` have the unit of the quantity, so they are read as text. */
#define MAP_AXIS(axis, sample)                                                                                         \
  {MAP("map." axis), REQUIRED, .example = sample, .help = "The axis " axis "."},                                       \
      {NAME("map." axis ".quantity", LamMapQuantityNames), INTO(LamMapAxis, quantity), REQUIRED,                       \
       .help = "What varies. `shear` (F12) and `load_factor` (0 to 1) say how far the load is followed, the others "   \
               "replace what the scene says."},                                                                        \
      {TEXT("map." axis ".from"), REQUIRED, .example = "0 MPa",                                                        \
       .help = "The first value, with the unit of the quantity; `shear` and `load_factor` are plain numbers."},        \
      {TEXT("map." axis ".to"), REQUIRED, .example = "0.3 MPa", .help = "The last value; larger than `from`."},        \
      {INTEGER("map." axis ".points"),                                                                                 \
       INTO(LamMapAxis, points),                                                                                       \
       REQUIRED,                                                                                                       \
       FROM(2),                                                                                                        \
       TO(1000),                                                                                                       \
       .example = "13",                                                                                                \
       .help = "Number of values, the ends included."},                                                                \
  {                                                                                                                    \
    NAME("map." axis ".spacing", spacing_names), INTO(LamMapAxis, is_log),                                             \
        .default_value = "linear", .help = "`linear`: equal differences; `log`: equal ratios."                         \
  }

static const LamKey map_keys[] = {
    {MAP("map"), .example = "{x: {...}, y: {...}}",
     .help = "For `lamella map`: two quantities that vary; at each point the load is followed until the tissue fails."},
    MAP_AXIS("x", "{quantity: turgor, from: 0 MPa, to: 0.3 MPa, points: 13}"),
    MAP_AXIS("y", "{quantity: cohesion, from: 0 MPa, to: 0.05 MPa, points: 11}"),
};
LAM_KEY_TABLE(LamMapKeys, map_keys);

typedef enum { PLAIN, STRESS, LENGTH } Kind;
#define MAP_MODULUS STRESS
#define MAP_NUMBER PLAIN
#define MAP_ROW(X, name, law, kind, need, symbol, example, help, ...) [LAM_MAP_##name] = {MAP_##kind, __VA_ARGS__},

/* Admissible values of each quantity. Bounds in C1 + C2 and apothems. */
static const struct {
  Kind kind;
  LamBound lower, upper;
} Quantities[] = {
    [LAM_MAP_TURGOR] = {STRESS, {0}, {0}},
    [LAM_MAP_COHESION] = {STRESS, {LAM_BOUND_INCLUDED, 0}, {0}},
    [LAM_MAP_SHEAR] = {PLAIN, {0}, {0}},
    [LAM_MAP_LOAD_FACTOR] = {PLAIN, {LAM_BOUND_INCLUDED, 0}, {LAM_BOUND_INCLUDED, 1}},
    [LAM_MAP_WALL_STRENGTH] = {STRESS, {LAM_BOUND_EXCLUDED, 0}, {0}},
    [LAM_MAP_LAMELLA_NORMAL] = {STRESS, {LAM_BOUND_EXCLUDED, 0}, {0}},
    [LAM_MAP_LAMELLA_SHEAR] = {STRESS, {LAM_BOUND_EXCLUDED, 0}, {0}},
    LAM_WALL_OWN_PARAMETERS(MAP_ROW, ) /* of wall.h */
        [LAM_MAP_WALL_THICKNESS] = {LENGTH, {LAM_BOUND_EXCLUDED, 0}, {LAM_BOUND_EXCLUDED, 1}},
};

PetscReal LamMapAxisValue(const LamMapAxis *axis, PetscInt i)
{
  const PetscReal share = (PetscReal)i / (PetscReal)(axis->points - 1);

  if (i == axis->points - 1) return axis->to; /* exact */
  return axis->is_log ? axis->from * pow(axis->to / axis->from, share) : (1 - share) * axis->from + share * axis->to;
}

const char *LamMapQuantityUnit(LamMapQuantity quantity, const LamScales *scales, PetscReal *scale)
{
  static const char *const units[] = {"1", "MPa", "um"};
  const PetscReal factors[] = {1.0, scales->stress * 1e-6, scales->length * 1e6};

  *scale = factors[Quantities[quantity].kind];
  return units[Quantities[quantity].kind];
}

PetscInt LamMapQuantityParameter(LamMapQuantity quantity)
{
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++)
    if (!strcmp(LamMapQuantityNames[quantity], LamWallParameterNames[k])) return k;
  return -1;
}

PetscBool LamMapQuantityIsLoad(LamMapQuantity quantity)
{
  return (PetscBool)(quantity == LAM_MAP_SHEAR || quantity == LAM_MAP_LOAD_FACTOR);
}

/* The nodes of an axis in the file. */
typedef struct {
  const LamNode *quantity, *from, *to;
} AxisNodes;

/* Reads an end of an axis, with unit and bounds of its quantity. */
static PetscErrorCode ReadEnd(const LamNode *node, LamMapQuantity quantity, const LamScales *scales, PetscReal *number)
{
  const LamBound *lower = &Quantities[quantity].lower, *upper = &Quantities[quantity].upper, none = {0};
  const Kind kind = Quantities[quantity].kind;
  const LamDimension dimension = kind == STRESS ? LAM_DIMENSION_STRESS : LAM_DIMENSION_LENGTH;
  const char *name = LamMapQuantityNames[quantity], *unit, *end;
  char reason[LAM_REASON_LENGTH];
  PetscReal scale, si;

  PetscFunctionBeginUser;
  unit = LamMapQuantityUnit(quantity, scales, &scale);
  if (kind == PLAIN) {
    *number = LamNumberScan(node->text, &end);
    LamSceneCheck(end > node->text && !*end && isfinite(*number), node,
                  "is not a plain number; write one, such as 0.1");
  } else {
    PetscCall(LamQuantityRead(node->text, dimension, &si, reason));
    LamSceneCheck(!reason[0], node, "%s; write a %s with its unit, such as %s", reason, LamDimensionNames[dimension],
                  LamDimensionExamples[dimension]);
    PetscCall(LamSceneScale(node, si, kind == STRESS ? scales->stress : scales->length, number));
  }
  LamSceneCheck(LamBoundsHold(lower, &none, *number), node, "is out of range; %s is %s %g", name,
                LamBoundWords(lower, PETSC_TRUE), (double)lower->value);
  LamSceneCheck(LamBoundsHold(&none, upper, *number), node, "is out of range; %s is %s %g%s%s", name,
                LamBoundWords(upper, PETSC_FALSE), (double)(upper->value * scale), kind == PLAIN ? "" : " ",
                kind == PLAIN ? "" : unit);
  PetscFunctionReturn(0);
}

/* ---- compatibility with the rest of the scene ---- */

/* A turgor or cohesion of a load entry would override the axis. */
static PetscErrorCode CheckEntries(const char key[], const AxisNodes *nodes)
{
  const LamNode *list = LamNodeFind(nodes->quantity->document->root, "load");

  PetscFunctionBeginUser;
  for (const LamNode *entry = list->first; entry; entry = entry->next) {
    const LamNode *own = LamNodeFind(entry, key);

    LamSceneCheck(!own, own, "the map varies it (line %d); leave it out here", nodes->quantity->line);
  }
  PetscFunctionReturn(0);
}

/* The shear is identified by its value along the load, so it must increase from 0. */
static PetscErrorCode CheckShear(const AxisNodes *nodes, const LamScene *scene, const LamMapAxis *axis)
{
  PetscReal last = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < scene->load_count; i++) {
    LamSceneCheck(!scene->controls || (!scene->controls[i].given[1] && !scene->controls[i].follows[1]), nodes->quantity,
                  "F12 of the load is free at state %d; write quantity: load_factor", (int)i + 1);
    LamSceneCheck(scene->loads[i].F[1] > last, nodes->quantity,
                  "F12 of the load does not grow at state %d; write quantity: load_factor", (int)i + 1);
    last = scene->loads[i].F[1];
  }
  LamSceneCheck(axis->from >= 0, nodes->from, "the load starts with F12 = 0; write 0 or more");
  LamSceneCheck(axis->to <= last, nodes->to, "the load ends with F12 = %g; write at most that, or a longer load",
                (double)last);
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckAxis(const AxisNodes *nodes, const LamScene *scene, const LamMapAxis *axis)
{
  const LamMicrostructure *micro = &scene->micro;
  const PetscInt k = LamMapQuantityParameter(axis->quantity);

  PetscFunctionBeginUser;
  switch (axis->quantity) {
  case LAM_MAP_TURGOR:
    PetscCall(LamSceneCheckTurgor(nodes->to, PetscMax(fabs(axis->from), fabs(axis->to))));
    PetscCall(CheckEntries("turgor", nodes));
    break;
  case LAM_MAP_COHESION:
    LamSceneCheck(micro->interface != LAM_INTERFACE_BONDED, nodes->quantity,
                  "law: bonded has no cohesion; write interface: {law: contact}, or another quantity");
    LamSceneCheck(!LamSceneNeedsCohesion(micro) || axis->from > 0.0, nodes->from,
                  "without cohesion nothing holds the outer cells of a patch whose sides are free; write more than 0 "
                  "MPa, or sides: affine");
    PetscCall(CheckEntries("cohesion", nodes));
    break;
  case LAM_MAP_SHEAR:
    PetscCall(CheckShear(nodes, scene, axis));
    break;
  case LAM_MAP_LAMELLA_NORMAL:
  case LAM_MAP_LAMELLA_SHEAR:
    LamSceneCheck(!LamCellsPart(micro->interface), nodes->quantity,
                  "law: contact has a cohesion instead; write cohesion, or interface: {law: bonded}");
    break;
  default: /* wall quantities, or without conditions */
    LamSceneCheck(!micro->cell || (axis->quantity != LAM_MAP_WALL_THICKNESS && k < 0), nodes->quantity,
                  "the cells differ, and a map varies all alike; choose another quantity");
    LamSceneCheck(k < 0 || LamWallLawHas(micro->wall.law, k), nodes->quantity,
                  "law %s has no %s; write law: %s, or another quantity", LamWallLawNames[micro->wall.law],
                  LamWallLacking(micro->wall.law, k), LamWallLawNames[LamWallOwner(k)]);
    break;
  }
  PetscFunctionReturn(0);
}

/* ---- the block ---- */

static PetscErrorCode BuildAxis(const LamNode *block, const LamScene *scene, AxisNodes *nodes, LamMapAxis *axis)
{
  PetscFunctionBeginUser;
  *nodes = (AxisNodes){LamNodeFind(block, "quantity"), LamNodeFind(block, "from"), LamNodeFind(block, "to")};
  PetscCall(LamSceneFill(block, &scene->scales, LamMapAxis, axis));
  PetscCall(ReadEnd(nodes->from, axis->quantity, &scene->scales, &axis->from));
  PetscCall(ReadEnd(nodes->to, axis->quantity, &scene->scales, &axis->to));
  LamSceneCheck(axis->from < axis->to, nodes->to, "is not larger than from (%s in line %d); exchange them",
                nodes->from->text, nodes->from->line);
  LamSceneCheck(!axis->is_log || axis->from > 0, LamNodeFind(block, "spacing"),
                "needs values above 0; from is %s in line %d", nodes->from->text, nodes->from->line);
  PetscCall(CheckAxis(nodes, scene, axis));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildMap(const LamNode *root, LamScene *scene)
{
  static const char *const axes[LAM_MAP_AXIS_COUNT] = {"x", "y"};
  const LamNode *block = LamNodeFind(root, "map");
  LamMapQuantity x, y;
  AxisNodes nodes;

  PetscFunctionBeginUser;
  if (!block) PetscFunctionReturn(0);
  LamSceneCheckName(scene->load_count, block, "needs a block load, along which the tissue is followed; add one");
  LamSceneCheckName(!scene->inflate, block,
                    "follows a load from the tissue at rest, and this one begins with inflate: "
                    "true; give F and P from rest");
  LamSceneCheckName(scene->micro.interface != LAM_INTERFACE_LAMELLA, block,
                    "this version of Lamella does not have maps of law: lamella yet; leave it out, or write law: "
                    "bonded or contact");
  LamSceneCheckName(!LamWallsRelax(&scene->micro), block,
                    "follows loads without time, on which walls with memory, rve.wall.relaxation, depend; leave one of "
                    "them out");
  scene->has_map = PETSC_TRUE;
  for (int a = 0; a < LAM_MAP_AXIS_COUNT; a++)
    PetscCall(BuildAxis(LamNodeFind(block, axes[a]), scene, &nodes, &scene->map[a]));
  x = scene->map[LAM_MAP_X].quantity;
  y = scene->map[LAM_MAP_Y].quantity;
  LamSceneCheck(x != y, nodes.quantity, "is on the axis x already; write another quantity");
  LamSceneCheck(!LamMapQuantityIsLoad(x) || !LamMapQuantityIsLoad(y), nodes.quantity,
                "says how far the load is followed, as the axis x does; write another quantity");
  PetscFunctionReturn(0);
}
