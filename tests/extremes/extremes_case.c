#include "extremes_case.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define EXTREMES_NAME(symbol, name) name,
const char *const ExtremesAxisNames[] = {EXTREMES_AXES(EXTREMES_NAME)};

typedef enum { LINEAR, LOGARITHMIC, FROM_ZERO } Scale; /* FROM_ZERO: 0, or logarithmic from `low` */

typedef struct {
  PetscReal low, high, usual;
  Scale scale;
  PetscReal least; /* of FROM_ZERO: the smallest that is not 0 */
} Axis;

static const Axis axes[EXTREMES_AXIS_COUNT] = {
    [EXTREMES_THICKNESS] = {0.005, 0.95, 0.15, LOGARITHMIC, 0},
    [EXTREMES_FIBRES] = {0.0, 1e5, 10.0, FROM_ZERO, 0.1},
    [EXTREMES_BULK] = {10.0, 1e7, 1100.0, LOGARITHMIC, 0},
    [EXTREMES_SHEAR] = {0.0, 3.0, 0.1, LINEAR, 0},
    [EXTREMES_STRAIN1] = {-0.5, 1.0, 0.0, LINEAR, 0},
    [EXTREMES_STRAIN2] = {-0.5, 1.0, 0.0, LINEAR, 0},
    [EXTREMES_TURGOR] = {-0.1, 10.0, 0.2, LINEAR, 0},
    [EXTREMES_COHESION] = {0.0, 1.0, 0.01, LINEAR, 0},
    [EXTREMES_CLEARANCE] = {0.0, 0.1, 0.0, LINEAR, 0},
    [EXTREMES_ORIENTATION] = {0.0, 60.0, 17.0, LINEAR, 0},
    [EXTREMES_UNITS] = {0.0, 1.0, 0.5, LINEAR, 0},
    [EXTREMES_INCREMENT] = {1e-12, 1.0, 1.0, LOGARITHMIC, 0},
    [EXTREMES_ELEMENTS] = {6.0, 1e5, 72.0, LOGARITHMIC, 0},
    [EXTREMES_CELLS] = {1.0, 8.0, 1.0, LINEAR, 0},
    [EXTREMES_VARIATION] = {0.0, 0.3, 0.0, LINEAR, 0},
};

#define LARGE_SHARE 0.002 /* of the random states that have more elements than USUAL_ELEMENTS */
#define USUAL_ELEMENTS 3000.0

/* SplitMix64: the same on every machine. */
static PetscReal Uniform(uint64_t *state)
{
  uint64_t z = (*state += 0x9e3779b97f4a7c15u);

  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return (PetscReal)(z >> 11) * 0x1p-53;
}

static PetscReal Between(const Axis *axis, PetscReal u)
{
  switch (axis->scale) {
  case LOGARITHMIC:
    return axis->low * PetscPowReal(axis->high / axis->low, u);
  case FROM_ZERO:
    return u < 0.1 ? 0.0 : axis->least * PetscPowReal(axis->high / axis->least, (u - 0.1) / 0.9);
  default:
    return axis->low + u * (axis->high - axis->low);
  }
}

/* Pairs of axes times four corners, bonded and in contact. */
static PetscInt AxisPairs(void)
{
  return EXTREMES_AXIS_COUNT * (EXTREMES_AXIS_COUNT - 1) / 2;
}

PetscInt ExtremesPairCount(void)
{
  return 8 * AxisPairs();
}

static void MakePair(PetscInt id, ExtremesCase *c)
{
  PetscInt pair = id / 8;

  for (PetscInt k = 0; k < EXTREMES_AXIS_COUNT; k++) c->value[k] = axes[k].usual;
  c->contact = (PetscBool)(id % 2);
  for (PetscInt a = 0; a < EXTREMES_AXIS_COUNT; a++) {
    const PetscInt partners = EXTREMES_AXIS_COUNT - 1 - a;

    if (pair >= partners) {
      pair -= partners;
      continue;
    }
    c->pair[0] = a;
    c->pair[1] = a + 1 + pair;
    break;
  }
  c->value[c->pair[0]] = id / 2 % 2 ? axes[c->pair[0]].high : axes[c->pair[0]].low;
  c->value[c->pair[1]] = id / 4 % 2 ? axes[c->pair[1]].high : axes[c->pair[1]].low;
}

static void MakeRandom(PetscInt id, ExtremesCase *c)
{
  uint64_t state = (uint64_t)id * 0x2545f4914f6cdd1du;
  PetscReal large;

  c->contact = (PetscBool)(Uniform(&state) < 0.5);
  for (PetscInt k = 0; k < EXTREMES_AXIS_COUNT; k++) c->value[k] = Between(&axes[k], Uniform(&state));
  large = Uniform(&state);
  if (large > LARGE_SHARE) { /* most are small, for time */
    const Axis some = {axes[EXTREMES_ELEMENTS].low, USUAL_ELEMENTS, 0, LOGARITHMIC, 0};

    c->value[EXTREMES_ELEMENTS] = Between(&some, Uniform(&state));
  }
  c->value[EXTREMES_CELLS] = PetscFloorReal(Between(&(Axis){1.0, 9.0, 0, LOGARITHMIC, 0}, Uniform(&state)));
  if (Uniform(&state) < 0.5) c->value[EXTREMES_VARIATION] = 0.0;
  if (Uniform(&state) < 0.5) c->value[EXTREMES_INCREMENT] = 1.0;
  if (Uniform(&state) < 0.5) c->value[EXTREMES_CLEARANCE] = 0.0;
}

void ExtremesCaseMake(PetscInt id, ExtremesCase *c)
{
  *c = (ExtremesCase){.id = id, .pair = {-1, -1}};
  if (id < ExtremesPairCount())
    MakePair(id, c);
  else
    MakeRandom(id, c);
  if (c->value[EXTREMES_VARIATION] > 0.0 && c->value[EXTREMES_CELLS] < 2.0) c->value[EXTREMES_CELLS] = 2.0;
  if (c->contact) /* the clearance is taken from the cells, and the lumen stays */
    c->value[EXTREMES_THICKNESS] =
        PetscMin(c->value[EXTREMES_THICKNESS], axes[EXTREMES_THICKNESS].high - 0.5 * c->value[EXTREMES_CLEARANCE]);
}

/* ---- the scene ---- */

typedef struct {
  char *text;
  size_t length, used;
} Writer;

static void Write(Writer *w, const char format[], ...)
{
  va_list arguments;

  va_start(arguments, format);
  w->used += (size_t)vsnprintf(w->text + w->used, w->length - w->used, format, arguments);
  va_end(arguments);
  if (w->used >= w->length) w->used = w->length - 1;
}

/* Units between picometres with gigapascals and kilometres with micropascals; the tissue is the same in numbers. */
static void ChooseUnits(PetscReal u, const char *names[2])
{
  static const char *const lengths[] = {"pm", "nm", "um", "mm", "m", "km"};
  static const char *const stresses[] = {"GPa", "MPa", "kPa", "Pa", "mPa", "uPa"};
  const PetscInt k = PetscMin(5, (PetscInt)(6.0 * u));

  names[0] = lengths[k];
  names[1] = stresses[k];
}

/* Elements along a face and through a wall: as square as the wall allows, no more than a scene may ask. */
static void ChooseMesh(const ExtremesCase *c, PetscInt finer, PetscInt *along, PetscInt *through)
{
  const PetscReal cells = PetscSqr(c->value[EXTREMES_CELLS]), per_face = c->value[EXTREMES_ELEMENTS] / (6.0 * cells);
  const PetscReal thickness = c->value[EXTREMES_THICKNESS], aspect = thickness / 1.1547;

  *through = (PetscInt)PetscMax(1.0, PetscMin(50.0, round(PetscSqrtReal(per_face * aspect))));
  if (per_face >= 8.0 && *through < 2) *through = 2;
  *along = (PetscInt)PetscMax(1.0, PetscMin(200.0, round(per_face / (PetscReal)*through)));
  if (*along > 1 && *along % 2) ++*along; /* so that the error can be estimated */
  *along = PetscMin(200, *along * finer);
  *through = PetscMin(50, *through * finer);
}

/* Between two texts. */
static void WriteF(Writer *w, const char before[], const PetscReal F[4], const char after[])
{
  Write(w, "%s[[%.17g, %.17g], [%.17g, %.17g]]%s", before, (double)F[0], (double)F[1], (double)F[2], (double)F[3],
        after);
}

static void WriteLoad(const ExtremesCase *c, const ExtremesRoute *route, Writer *w)
{
  const PetscReal increment = c->value[EXTREMES_INCREMENT], s2 = PetscExpReal(c->value[EXTREMES_STRAIN2]);
  const PetscReal F[4] = {PetscExpReal(c->value[EXTREMES_STRAIN1]), c->value[EXTREMES_SHEAR] * s2, 0.0, s2};
  PetscReal before[4];

  Write(w, "load:\n");
  if (route->ramp > 1) {
    WriteF(w, "  - {ramp: {to: ", F, "");
    Write(w, ", steps: %d}}\n", (int)route->ramp);
    return;
  }
  if (increment < 1.0) {
    for (PetscInt i = 0; i < 4; i++) before[i] = F[i] + increment * ((i == 0 || i == 3 ? 1.0 : 0.0) - F[i]);
    WriteF(w, "  - {F: ", before, "}\n");
  }
  WriteF(w, "  - {F: ", F, "}\n");
}

static void WriteVariation(const ExtremesCase *c, Writer *w)
{
  const PetscReal spread = c->value[EXTREMES_VARIATION];

  if (spread == 0.0) return;
  /* a wall is thinner than the apothem */
  Write(w, "  variation: {field: {wall: %.6g, turgor: %.6g", (double)spread, (double)spread);
  if (c->value[EXTREMES_THICKNESS] < 0.25) Write(w, ", wall_thickness: %.6g", (double)spread);
  if (c->contact) Write(w, ", cohesion: %.6g", (double)spread);
  Write(w, ", correlation: 1, seed: %d}}\n", (int)(c->id % 1000));
}

void ExtremesSceneWrite(const ExtremesCase *c, const ExtremesRoute *route, size_t length, char text[])
{
  const PetscInt cells = (PetscInt)c->value[EXTREMES_CELLS];
  Writer w = {text, length, 0};
  const char *unit[2];
  PetscInt along, through;

  ChooseUnits(c->value[EXTREMES_UNITS], unit);
  ChooseMesh(c, route->finer, &along, &through);
  Write(&w, "# state %d of the map of extremes\nversion: 1\nrve:\n", (int)c->id);
  Write(&w, "  cell: {apothem: 1 %s, wall_thickness: %.17g %s, orientation: %.17g deg}\n", unit[0],
        (double)c->value[EXTREMES_THICKNESS], unit[0], (double)c->value[EXTREMES_ORIENTATION]);
  Write(&w, "  cells: [%d, %d]\n", (int)cells, (int)cells);
  Write(&w, "  wall: {law: fibre_mooney_rivlin, C1: 1 %s, C2: 0.1 %s, C4: %.17g %s, bulk_modulus: %.17g %s}\n", unit[1],
        unit[1], (double)c->value[EXTREMES_FIBRES], unit[1], (double)c->value[EXTREMES_BULK], unit[1]);
  WriteVariation(c, &w);
  if (c->contact)
    Write(&w, "  interface: {law: contact, cohesion: %.17g %s, clearance: %.17g %s}\n",
          (double)c->value[EXTREMES_COHESION], unit[1], (double)c->value[EXTREMES_CLEARANCE], unit[0]);
  Write(&w, "  turgor: {mode: prescribed, pressure: %.17g %s}\n", (double)c->value[EXTREMES_TURGOR], unit[1]);
  Write(&w, "  mesh: {along: %d, through: %d}\n", (int)along, (int)through);
  if (c->contact && route->one_step) Write(&w, "  strategy: one_step\n");
  WriteLoad(c, route, &w);
}
