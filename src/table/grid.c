/*
  The layout of a grid: creation from a scene, JSON text in the file, states of its nodes.
*/
#include "grid.h"
#include <lamella/tissue.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Edges of root cells. With fibres ten times as stiff as the matrix, root cells alone give P to 0.2 % at the 99th
   percentile (bonded), and to some percent in contact; docs/results/verification.md. */
#define BONDED_STEP 0.135
#define TURGOR_REACH 0.1 /* times the softest wall's bulk modulus: error of the second derivatives 1e-4 of P */
#define CONTACT_STEP 0.08
#define TAU_STEP 0.75
#define SUCTION_SCALE (1.0 / 32) /* times the largest suction */
#define Z_STEP 0.135             /* of ln F33, as of strains; docs/results/verification.md, The response table */
enum { LEAST_Z_CELLS = 2 };      /* three knots: slopes along z are those of a parabola */
enum { FREE_KNOTS = 17 };

/* Defaults for scenes without a sample box. */
static const LamSample default_box = {.stretch_min = -0.02, .stretch_max = 0.25};
#define LEAST_SUCTION 0.125 /* times the scene's suction */

/* Turgor of bonded tissue that depends on it: root intervals, and the scale over the range. */
enum { TURGOR_CELLS = 1 };
#define TURGOR_SCALE 0.25
#define ROUNDED_TURGOR 1e-9 /* C1 + C2: loads are rounded to 1e-10 */

/* ---- keys ---- */

PetscBool LamKeyIsNode(PetscInt64 key)
{
  return (PetscBool)(key >= LAM_NODE_KEY && key < 2 * LAM_NODE_KEY);
}

PetscBool LamKeyIsFreeCell(PetscInt64 key)
{
  const LamNodePlace place = LamNodePlaceOf(key);

  return (PetscBool)(LamKeyIsNode(key) && LamNodeIsFree(&place));
}

PetscInt64 LamNodeKeyOf(const LamNodePlace *place)
{
  PetscInt64 code = place->z;

  for (int k = 0; k < 3; k++) code = (code << 14) | (PetscInt64)(place->i[k] + LAM_GRID_REACH);
  return LAM_NODE_KEY | (code << 12) | (PetscInt64)place->j;
}

LamNodePlace LamNodePlaceOf(PetscInt64 key)
{
  const PetscInt64 code = key & (LAM_NODE_KEY - 1);
  LamNodePlace place = {.j = (int)(code & 4095), .z = (int)(code >> 54)};

  for (int k = 0; k < 3; k++) place.i[k] = (int)((code >> (40 - 14 * k)) & 16383) - LAM_GRID_REACH;
  return place;
}

/* The coarsest level with this coordinate: by the power of 2 in it. */
static int LevelOf(int i)
{
  return i ? PetscMax(0, LAM_FINEST - __builtin_ctz((unsigned)i)) : 0;
}

int LamNodeLevel(const LamNodePlace *place)
{
  int level = 0;

  for (int k = 0; k < 3; k++) level = PetscMax(level, LevelOf(place->i[k]));
  return level;
}

PetscBool LamNodeIsFree(const LamNodePlace *place)
{
  return (PetscBool)(place->i[0] == LAM_GRID_REACH - 1);
}

PetscBool LamPlaceIsFloating(const struct LamGrid_s *grid, const int i[3])
{
  return (PetscBool)(grid->free.n && i[0] >= 0 && i[1] >= 0 && i[2] >= 0);
}

/* ---- nodes ---- */

PetscErrorCode LamGridNodeLoad(LamGrid grid, PetscInt64 key, LamLoad *load)
{
  const LamNodePlace place = LamNodePlaceOf(key);
  PetscReal x[3], U[4] = {0}, shift = grid->origin;

  PetscFunctionBeginUser;
  PetscCheck(LamKeyIsNode(key), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "key %lld is not of a node", (long long)key);
  *load = (LamLoad){.F[8] = LamGridF33(grid, place.z), .turgor = grid->turgor};
  if (LamGridHasColumns(grid)) {
    const PetscReal s = LamGridSuction(grid, place.j);
    PetscReal strain[6];

    load->turgor = s - grid->cohesion;
    load->cohesion = grid->cohesion;
    LamGridFreeStrain(grid, s, place.z - 1, strain);
    shift += strain[0];
  }
  for (int k = 0; k < 3; k++) x[k] = shift + grid->step * (PetscReal)place.i[k] / LAM_ROOT;
  /* no F has these strains: return an F that a solver rejects */
  if (!LamLatticeStretch(&grid->axes, x, U)) U[0] = U[1] = U[2] = U[3] = 0;
  for (int i = 0; i < 4; i++) load->F[3 * (i / 2) + i % 2] = U[i];
  PetscFunctionReturn(0);
}

PetscInt LamGridNodeLevel(LamGrid grid, PetscInt64 key)
{
  const LamNodePlace place = LamNodePlaceOf(key);

  return LamNodeIsFree(&place) ? -1 : LamNodeLevel(&place);
}

/* Rounded down to a multiple of 2^bits. */
static int Floor(int i, int bits)
{
  return (i >> bits) * (1 << bits);
}

/* Moves a place towards coarser ones along one axis, the last one off these (and axes equal to it, which stay so): a
   step is no longer than an edge, and most of the places on the way are nodes of the same cell, needed with this one.
 */
static void MoveToCoarser(int bits, int i[3])
{
  int k = 2;

  while (Floor(i[k], bits) == i[k]) k--;
  for (int l = 0; l <= k; l++)
    if (i[l] == i[k]) i[l] = Floor(i[l], bits);
}

void LamGridNodePlace(LamGrid grid, PetscInt64 key, PetscReal place[4])
{
  const LamNodePlace at = LamNodePlaceOf(key);

  (void)grid;
  for (int k = 0; k < 3; k++) place[k] = (PetscReal)at.i[k] / LAM_ROOT;
  place[3] = (PetscReal)at.j / LAM_ROOT;
}

void LamGridGetF33(LamGrid grid, PetscReal range[2])
{
  range[0] = exp(grid->z_min);
  range[1] = exp(grid->z_min + grid->z_step * (PetscReal)grid->z_cells);
}

PetscInt64 LamGridNodeParent(LamGrid grid, PetscInt64 key)
{
  LamNodePlace place = LamNodePlaceOf(key);
  const int level = LamNodeLevel(&place), suction_level = LevelOf(place.j);

  if (!level && !suction_level) return -1;
  if (level >= suction_level)
    MoveToCoarser(LAM_FINEST - level + 1, place.i);
  else /* the higher suction, where cells hold together more firmly */
    place.j = Floor(place.j + (1 << (LAM_FINEST - suction_level)), LAM_FINEST - suction_level + 1);
  return LamNodeKeyOf(&place);
}

/* ---- creation ---- */

static void LayOutStrains(const LamScene *scene, const LamSample *box, LamGrid g)
{
  const PetscReal range = box->stretch_max - box->stretch_min;

  g->step = g->contact ? CONTACT_STEP : range / PetscMax(1, PetscCeilReal(range / BONDED_STEP - 1e-9));
  g->origin = g->contact ? 0 : box->stretch_min;
  g->turgor = scene->has_sample ? 0.5 * (box->turgor_min + box->turgor_max) : scene->turgor;
}

static PetscErrorCode SolveFreeCell(LamGrid g, const LamMicrostructure *micro, LamResponder solver, LamFreeCell *cell)
{
  const LamFreePlanes planes = {g->z_cells + 1, g->z_min, g->z_step};

  PetscFunctionBeginUser;
  PetscCall(LamFreeCellMake(micro, g->cohesion, LamGridSuction(g, 0), LamGridSuction(g, LAM_ROOT * g->tau_cells),
                            g->suction_scale, FREE_KNOTS, &planes, solver, cell));
  PetscFunctionReturn(0);
}

static PetscErrorCode LayOutSuction(const LamScene *scene, const LamSample *box, LamResponder solver, LamGrid g)
{
  PetscReal s_min = box->turgor_min + scene->cohesion, s_max = box->turgor_max + scene->cohesion;

  PetscFunctionBeginUser;
  if (!scene->has_sample) {
    s_max = scene->turgor + scene->cohesion;
    s_min = LEAST_SUCTION * s_max;
  }
  PetscCheck(s_max > 0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: cells in contact without turgor or cohesion touch each other only where they are pressed; a database "
             "needs turgor + cohesion > 0: give sample.turgor or rve.interface.cohesion",
             scene->path);
  g->cohesion = scene->cohesion;
  g->suction_scale = SUCTION_SCALE * s_max;
  g->tau_min = LamGridTau(g, s_min);
  g->tau_cells = PetscMax(1, (PetscInt)PetscCeilReal((LamGridTau(g, s_max) - g->tau_min) / TAU_STEP - 1e-9));
  g->tau_step = PetscMax((LamGridTau(g, s_max) - g->tau_min) / (PetscReal)g->tau_cells, 1e-3);
  if (!scene->micro.cell) PetscCall(SolveFreeCell(g, &scene->micro, solver, &g->free));
  PetscFunctionReturn(0);
}

/* Of tissue whose response depends on turgor; without a sample box from no turgor to the scene's. */
static void LayOutTurgor(const LamScene *scene, const LamSample *box, LamGrid g)
{
  const PetscReal least = scene->has_sample ? box->turgor_min : PetscMin(0, scene->turgor);
  const PetscReal most = scene->has_sample ? box->turgor_max : PetscMax(0, scene->turgor);

  g->suction_zero = PetscMin(0, least);
  g->suction_scale = most > g->suction_zero ? TURGOR_SCALE * (most - g->suction_zero) : 1;
  g->tau_min = LamGridTau(g, least);
  g->tau_cells = TURGOR_CELLS;
  g->tau_step = PetscMax((LamGridTau(g, most) - g->tau_min) / TURGOR_CELLS, 1e-3);
}

/* Of scenes without a sample box too. */
static void LayOutF33(const LamSample *box, LamGrid g)
{
  const PetscReal range = log(box->F33_max / box->F33_min);

  g->z_cells = PetscMax(LEAST_Z_CELLS, (PetscInt)PetscCeilReal(range / Z_STEP - 1e-9));
  g->z_min = log(box->F33_min);
  g->z_step = range / (PetscReal)g->z_cells;
}

/* Knot m of the free cell lies at j = m 64 cells / (knots - 1), an integer; plane after plane. */
static PetscErrorCode MakeFreeKeys(LamGrid g)
{
  const int reach = LAM_GRID_REACH - 1;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(LamFreeCellStates(&g->free) + 1, &g->free_keys));
  for (PetscInt m = 0; m < LamFreeCellStates(&g->free); m++) {
    const LamNodePlace place = {.i = {reach, reach, reach},
                                .j = (int)(m % g->free.n * LAM_ROOT * g->tau_cells / (g->free.n - 1)),
                                .z = g->z_cells ? (int)(1 + m / g->free.n) : 0};

    g->free_keys[m] = LamNodeKeyOf(&place);
  }
  PetscFunctionReturn(0);
}

/* Sets the members that follow from the tissue alone. */
static PetscErrorCode SetTissue(const LamMicrostructure *micro, LamGrid g)
{
  PetscReal softest = micro->wall.bulk_modulus;
  LamSymmetry symmetry;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; micro->cell && c < micro->cells[0] * micro->cells[1]; c++)
    softest = PetscMin(softest, micro->cell[c].wall.bulk_modulus);
  g->contact = LamCellsPart(micro->interface);
  /* the order of the three strains is free with all motions of a hexagon; fewer of them are not used */
  PetscCall(LamMicrostructureSymmetry(micro, &symmetry));
  g->symmetric = LamSymmetryIsHexagonal(&symmetry);
  g->axes = LamLatticeAxesOf(micro->orientation);
  PetscCall(LamFluidFills(micro, &g->filled));
  g->turgor_reach = g->contact || g->filled ? TURGOR_REACH * softest : ROUNDED_TURGOR;
  PetscFunctionReturn(0);
}

PetscErrorCode LamGridCreate(const LamScene *scene, LamResponder solver, LamGrid *grid)
{
  const LamMicrostructure *micro = &scene->micro;
  const LamSample *box = scene->has_sample ? &scene->sample : &default_box;
  LamGrid g;

  PetscFunctionBeginUser;
  PetscCheck(
      !micro->is_patch, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
      "%s: rve.patch: a patch between grips is a body of its own and no material point; a database needs a period "
      "(rve.cells)",
      scene->path);
  PetscCall(PetscNew(&g));
  *grid = g;
  PetscCall(SetTissue(micro, g));
  LayOutStrains(scene, box, g);
  if (scene->sample.F33_max > scene->sample.F33_min) LayOutF33(&scene->sample, g);
  if (g->contact)
    PetscCall(LayOutSuction(scene, box, solver, g));
  else if (!g->filled)
    LayOutTurgor(scene, box, g);
  PetscCall(MakeFreeKeys(g));
  PetscFunctionReturn(0);
}

PetscErrorCode LamGridDestroy(LamGrid *grid)
{
  PetscFunctionBeginUser;
  if (!*grid) PetscFunctionReturn(0);
  PetscCall(LamFreeCellDestroy(&(*grid)->free));
  PetscCall(PetscFree((*grid)->free_keys));
  PetscCall(PetscFree(*grid));
  PetscFunctionReturn(0);
}

PetscErrorCode LamGridGetRecords(LamGrid grid, PetscInt *n, const PetscInt64 *keys[], const LamResponse *records[])
{
  PetscFunctionBeginUser;
  *n = grid->free.records ? LamFreeCellStates(&grid->free) : 0;
  *keys = grid->free_keys;
  *records = grid->free.records;
  PetscFunctionReturn(0);
}

PetscErrorCode LamGridGetFreeKeys(LamGrid grid, PetscInt *n, const PetscInt64 *keys[])
{
  PetscFunctionBeginUser;
  *n = LamFreeCellStates(&grid->free);
  *keys = grid->free_keys;
  PetscFunctionReturn(0);
}

PetscErrorCode LamGridSolveRecords(LamGrid grid, const LamMicrostructure *micro, LamResponder solver)
{
  LamFreeCell again = {0};

  PetscFunctionBeginUser;
  if (!grid->free.n || grid->free.records) PetscFunctionReturn(0);
  PetscCall(SolveFreeCell(grid, micro, solver, &again));
  PetscCheck(again.n == grid->free.n, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "the grid has free cells, and none are found now; it was made by another version of lamella");
  grid->free.records = again.records;
  again.records = NULL;
  PetscCall(LamFreeCellDestroy(&again));
  PetscFunctionReturn(0);
}

/* ---- text ---- */

PetscErrorCode LamGridGetText(LamGrid g, char **text)
{
  json_t *object, *cell;
  char *dumped;

  PetscFunctionBeginUser;
  object = json_pack("{s:f, s:f, s:f}", "origin", g->origin, "step", g->step, "turgor", g->turgor);
  if (g->z_cells)
    json_object_update_new(object, json_pack("{s:f, s:f, s:I}", "z_min", g->z_min, "z_step", g->z_step, "z_cells",
                                             (json_int_t)g->z_cells));
  if (LamGridHasColumns(g))
    json_object_update_new(object,
                           json_pack("{s:f, s:f, s:f, s:I}", "suction_scale", g->suction_scale, "tau_min", g->tau_min,
                                     "tau_step", g->tau_step, "tau_cells", (json_int_t)g->tau_cells));
  if (g->contact) {
    PetscCall(LamFreeCellToJSON(&g->free, &cell));
    json_object_update_new(object, json_pack("{s:f, s:o}", "cohesion", g->cohesion, "free_cell", cell));
  } else if (LamGridHasColumns(g))
    json_object_set_new(object, "suction_zero", json_real(g->suction_zero));
  dumped = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17));
  json_decref(object);
  PetscCall(PetscStrallocpy(dumped, text));
  free(dumped);
  PetscFunctionReturn(0);
}

static PetscBool ReadSuction(json_t *object, LamGrid g)
{
  json_int_t cells;

  if (json_unpack(object, "{s:F, s:F, s:F, s:I}", "suction_scale", &g->suction_scale, "tau_min", &g->tau_min,
                  "tau_step", &g->tau_step, "tau_cells", &cells) ||
      json_unpack(object, "{s:F}", g->contact ? "cohesion" : "suction_zero",
                  g->contact ? &g->cohesion : &g->suction_zero))
    return PETSC_FALSE;
  g->tau_cells = (PetscInt)PetscMin(PetscMax(cells, 0), LAM_GRID_REACH);
  return (PetscBool)(g->suction_scale > 0 && g->tau_min >= 0 && g->tau_step > 0 && g->tau_cells > 0 &&
                     g->tau_cells < 4096 / LAM_ROOT);
}

/* Of grids with the axis F33 alone. */
static PetscBool ReadF33(json_t *object, LamGrid g)
{
  json_int_t cells;

  if (!json_object_get(object, "z_cells")) return PETSC_TRUE;
  if (json_unpack(object, "{s:F, s:F, s:I}", "z_min", &g->z_min, "z_step", &g->z_step, "z_cells", &cells))
    return PETSC_FALSE;
  g->z_cells = (PetscInt)PetscMin(PetscMax(cells, 0), LAM_MOST_Z_CELLS + 1);
  return (PetscBool)(g->z_step > 0 && g->z_cells >= LEAST_Z_CELLS && g->z_cells <= LAM_MOST_Z_CELLS &&
                     isfinite(LamGridF33(g, (int)g->z_cells + 1)) && LamGridF33(g, 1) > 0);
}

/* Whether the free cell's suctions and cohesion are those of the grid. */
static PetscBool FreeCellFits(const struct LamGrid_s *g)
{
  const LamFreeCell *free_cell = &g->free;
  const PetscReal last = LamGridSuction(g, LAM_ROOT * g->tau_cells);

  if (!free_cell->n) return PETSC_TRUE;
  return (PetscBool)(free_cell->scale == g->suction_scale && free_cell->cohesion == g->cohesion &&
                     free_cell->planes == g->z_cells + 1 && free_cell->z_step == g->z_step &&
                     fabs(free_cell->suction[0] - LamGridSuction(g, 0)) < 1e-9 * last &&
                     fabs(free_cell->suction[free_cell->n - 1] - last) < 1e-9 * last);
}

static PetscErrorCode ReadText(const char path[], json_t *object, LamGrid g)
{
  PetscBool good = (PetscBool)(!json_unpack(object, "{s:F, s:F, s:F}", "origin", &g->origin, "step", &g->step, "turgor",
                                            &g->turgor) &&
                               g->step > 0);

  PetscFunctionBeginUser;
  /* bonded tissue that needs it may lack it in a file of version 0.1: its table serves its own turgor alone */
  if (good && (g->contact || (!g->filled && json_object_get(object, "tau_cells")))) good = ReadSuction(object, g);
  if (good) good = ReadF33(object, g);
  PetscCheck(good, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: %s is not the layout of a grid; the file is damaged",
             path, LAM_GRID_NAME);
  if (g->contact) PetscCall(LamFreeCellFromJSON(path, json_object_get(object, "free_cell"), &g->free));
  PetscCheck(FreeCellFits(g), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the free cell of %s is not of this grid; the file is damaged", path, LAM_GRID_NAME);
  PetscCall(MakeFreeKeys(g));
  PetscFunctionReturn(0);
}

PetscErrorCode LamGridFromText(const char path[], const LamMicrostructure *micro, const char text[], LamGrid *grid)
{
  json_t *object = json_loads(text, 0, NULL);
  PetscErrorCode ierr;
  LamGrid g;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&g));
  ierr = SetTissue(micro, g);
  if (!ierr) ierr = ReadText(path, object, g);
  json_decref(object);
  if (ierr) (void)LamGridDestroy(&g);
  PetscCall(ierr);
  *grid = g;
  PetscFunctionReturn(0);
}
