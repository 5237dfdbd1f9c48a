/*
  Method
    Of tissue that is free of stress, a section across the middle of the walls bears no force: s t' = p (a' - t'), s the
    stress along the wall, t' and a' its present thickness and the present apothem. Walls that keep their volume have t'
    = t/(l m) at a stretch l along them and m along the cells' axis; the corners, a share t of the apothem (a = 1), do
    not stretch, so that a' = (1 - t) l + t. The wall gives s + p = l dW/dl along F = diag(l, 1/(l m), m), W its energy
    density. Hence
      dW/dl = p m a'/t,
    In plane strain m = 1. Where tissue is free along its axis, too, a section across it bears no force: with the areas
    a'^2 of the tissue and (1 - (1 - t)^2)/m of the walls, s_3 + p = m dW/dm, and
      dW/dm = p a'^2 / (1 - (1 - t)^2).
    Both left sides less the right ones grow with l and m. Solved tissue has the same strain within 6 %, along the axis
    15 %, up to strains of 1 (tests/cli/warnings.sh).
*/
#include "turgor_stretch.h"
#include "wall_law.h"
#include <math.h>

#define LARGEST_STRETCH 10.0 /* more is no equilibrium that anyone means */
/* Walls of fruit and vegetables break at strains of 5 to 50 %; a larger one is more often a mistake than a tissue. */
#define DOUBTFUL_STRETCH 1.5
#define RESOLVED 1e-6 /* of a stretch: more digits than are printed */

/* dW/dl and dW/dm of a wall; infinite beyond what its law can give. */
static void Forces(const LamWallLaw *law, const LamWall *wall, PetscReal l, PetscReal m, PetscReal force[2])
{
  const PetscReal d = wall->dispersion, along = 1.0 - 3.0 * d, n = 1.0 / (l * m); /* n: across the wall */
  const PetscReal tilt = sin(wall->fibre_angle), c2 = 1.0 - tilt * tilt, s2 = tilt * tilt;
  LamPoints H[4] = {{0}}, strain;
  LamKernel matrix;
  LamKernel1 fibre = {0};

  LAM_EACH_POINT(g)
  {
    H[0][g] = l - 1.0;
    H[3][g] = n - 1.0;
    strain[g] = d * (l * l + n * n + m * m - 3.0) + along * (c2 * l * l + s2 * m * m - 1.0);
  }
  law->matrix(wall, (const LamPoints *)H, m - 1.0, PETSC_TRUE, &matrix);
  if (law->fibre) law->fibre(wall, strain, &fibre);
  force[0] = matrix.P[0][0] - matrix.P[3][0] * n / l + 2.0 * fibre.d[0] * (d * (l - n * n / l) + along * c2 * l);
  force[1] = matrix.P[4][0] - matrix.P[3][0] * n / m + 2.0 * fibre.d[0] * (d * (m - n * n / m) + along * s2 * m);
  if (!isfinite(fibre.W[0])) force[0] = force[1] = PETSC_INFINITY;
}

/* The wall of a cell, in tissue under its turgor. */
typedef struct {
  const LamWallLaw *law;
  const LamWall *wall;
  PetscReal thickness, turgor;
} Wall;

/* Present apothem. */
static PetscReal Apothem(const Wall *w, PetscReal l)
{
  return (1.0 - w->thickness) * l + w->thickness;
}

/* Least stretch along the wall at which it bears the turgor, at one along the axis; infinite: none. */
static PetscReal StretchAt(const Wall *w, PetscReal m)
{
  PetscReal lower = 1.0, upper = LARGEST_STRETCH, force[2];

  Forces(w->law, w->wall, upper, m, force);
  if (force[0] < w->turgor * m * Apothem(w, upper) / w->thickness) return PETSC_INFINITY;
  while (upper - lower > RESOLVED) {
    const PetscReal middle = 0.5 * (lower + upper);

    Forces(w->law, w->wall, middle, m, force);
    *(force[0] < w->turgor * m * Apothem(w, middle) / w->thickness ? &lower : &upper) = middle;
  }
  return upper;
}

/* Whether walls bear less along the axis than the turgor asks of them. */
static PetscBool YieldsAlongAxis(const Wall *w, PetscReal m)
{
  const PetscReal l = StretchAt(w, m), inner = 1.0 - w->thickness;
  PetscReal force[2];

  if (l == PETSC_INFINITY) return PETSC_TRUE;
  Forces(w->law, w->wall, l, m, force);
  return (PetscBool)(force[1] < w->turgor * Apothem(w, l) * Apothem(w, l) / (1.0 - inner * inner));
}

/* Of a cell alone. */
static LamInflated Inflate(const LamWall *wall, PetscReal thickness, PetscReal turgor, PetscBool free_axis)
{
  Wall w = {.wall = wall, .thickness = thickness, .turgor = turgor};
  PetscReal lower = 1.0, upper = free_axis ? LARGEST_STRETCH : 1.0;
  LamInflated found = {.along = 1.0, .axial = 1.0};

  if (!(turgor > 0) || LamWallLawGet(wall->law, &w.law)) return found;
  if (free_axis && YieldsAlongAxis(&w, upper)) return (LamInflated){StretchAt(&w, 1.0), PETSC_INFINITY, PETSC_INFINITY};
  while (upper - lower > RESOLVED) {
    const PetscReal middle = 0.5 * (lower + upper);

    *(YieldsAlongAxis(&w, middle) ? &lower : &upper) = middle;
  }
  found.axial = upper;
  found.along = StretchAt(&w, upper);
  found.tension = turgor * upper * Apothem(&w, found.along) * found.along / thickness; /* s + p */
  return found;
}

LamInflated LamInflatedTissue(const LamMicrostructure *micro, PetscReal turgor, PetscBool free_axis)
{
  const PetscInt cells = micro->cell ? micro->cells[0] * micro->cells[1] : 1;
  LamInflated largest = {.along = 1.0, .axial = 1.0};

  for (PetscInt c = 0; c < cells; c++) {
    const LamWall *wall = micro->cell ? &micro->cell[c].wall : &micro->wall;
    const PetscReal factor = micro->cell ? micro->cell[c].turgor : 1.0;
    const LamInflated found = Inflate(wall, LamWallThickness(micro, c), factor * turgor, free_axis);

    largest.along = PetscMax(largest.along, found.along);
    largest.axial = PetscMax(largest.axial, found.axial);
    largest.tension = PetscMax(largest.tension, found.tension);
  }
  return largest;
}

/* Whether tissue of the scene is free along the cells' axis: that of a body around its axis, or under prescribed P33.
 */
static PetscBool HasFreeAxis(const LamScene *scene)
{
  PetscBool is_free = (PetscBool)(scene->has_macro && scene->macro.symmetry == LAM_AXISYMMETRIC);

  for (PetscInt k = 0; k < scene->load_count && scene->controls; k++)
    if (scene->controls[k].given[8]) is_free = PETSC_TRUE;
  for (PetscInt k = 0; k < scene->process.leg_count; k++)
    if (scene->process.legs[k].control.given[8]) is_free = PETSC_TRUE;
  return is_free;
}

/* Whether the scene's tissue is free of stress under its turgor, at the start at least. */
static PetscBool IsInflated(const LamScene *scene)
{
  return (PetscBool)(scene->inflate || (scene->has_macro && scene->macro.inflate) ||
                     (scene->has_process && scene->process.inflate));
}

/* One sentence if a turgor, of a place and a key, is doubtful for a tissue; else empty. MPa: of the tissue's unit.
   strength: of the walls, MPa; NaN: not judged. */
static void Judge(const LamScene *scene, const LamMicrostructure *micro, PetscReal turgor, PetscReal MPa,
                  PetscReal strength, const char at[], const char key[], char text[LAM_TURGOR_TEXT])
{
  const LamInflated found = LamInflatedTissue(micro, turgor, HasFreeAxis(scene));
  const PetscReal tension = found.tension * MPa;
  char words[160];

  if (found.along == PETSC_INFINITY || found.axial == PETSC_INFINITY)
    snprintf(words, sizeof(words), "is more than the walls hold, however far they stretch%s",
             found.along == PETSC_INFINITY ? "" : " along the cells' axis");
  else if (found.along > DOUBTFUL_STRETCH && found.along >= found.axial)
    snprintf(words, sizeof(words), "stretches the walls of free tissue by about %.0f %%",
             (double)(100.0 * (found.along - 1.0)));
  else if (found.axial > DOUBTFUL_STRETCH)
    snprintf(words, sizeof(words), "stretches free tissue by about %.0f %% along the cells' axis",
             (double)(100.0 * (found.axial - 1.0)));
  else if (tension > strength)
    snprintf(words, sizeof(words),
             "puts a mean tension of about %.3g MPa on the walls of free tissue, strength.wall is %.3g MPa",
             (double)tension, (double)strength);
  else
    return;
  snprintf(text, LAM_TURGOR_TEXT, "%.159s: %.120s: %.6g MPa: %s; check its unit, and thickness and moduli of the walls",
           at, key, (double)(turgor * MPa), words);
}

/* Largest turgors of the blocks that have their own. */
typedef struct {
  const char *key;
  PetscReal turgor;
} Block;
enum { LOAD, PROCESS, MAP, BLOCKS };

static void FindLargest(const LamScene *scene, Block block[BLOCKS])
{
  block[LOAD] = (Block){"load: turgor", 0};
  block[PROCESS] = (Block){"process.surroundings: turgor", 0};
  block[MAP] = (Block){"map: turgor", 0};
  for (PetscInt k = 0; k < scene->load_count; k++)
    block[LOAD].turgor = PetscMax(block[LOAD].turgor, scene->loads[k].turgor);
  for (PetscInt k = 0; k < scene->process.surroundings_count; k++)
    block[PROCESS].turgor = PetscMax(block[PROCESS].turgor, scene->process.surroundings[k].turgor);
  for (int a = 0; a < LAM_MAP_AXIS_COUNT && scene->has_map; a++)
    if (scene->map[a].quantity == LAM_MAP_TURGOR) block[MAP].turgor = PetscMax(block[MAP].turgor, scene->map[a].to);
}

void LamTurgorWarning(const LamScene *scene, char text[LAM_TURGOR_TEXT])
{
  const PetscReal MPa = scene->scales.stress * 1e-6, strength = IsInflated(scene) ? scene->strength.wall * MPa : NAN;
  const LamScenePlace none = {0};
  char at[LAM_PLACE_TEXT], key[LAM_NAME_LENGTH + 40];
  Block block[BLOCKS];

  text[0] = '\0';
  Judge(scene, &scene->micro, scene->turgor, MPa, strength, LamScenePlaceText(scene, &scene->turgor_place, at),
        "rve.turgor.pressure", text);
  FindLargest(scene, block);
  for (int b = 0; b < BLOCKS && !text[0]; b++)
    Judge(scene, &scene->micro, block[b].turgor, MPa, b == MAP ? NAN : strength, LamScenePlaceText(scene, &none, at),
          block[b].key, text);
  for (PetscInt r = 0; r < scene->region_count && !text[0]; r++) {
    const LamRegion *region = &scene->regions[r];

    snprintf(key, sizeof(key), "macro.regions[%d]: %s: turgor", (int)r, region->name);
    Judge(scene, &region->micro, region->turgor, region->scales.stress * 1e-6, strength,
          LamScenePlaceText(scene, &region->place, at), key, text);
  }
}

void LamWarnOfTurgor(const LamReporter *reporter, const LamScene *scene)
{
  char text[LAM_TURGOR_TEXT];

  LamTurgorWarning(scene, text);
  if (text[0]) LamReportWarning(reporter, "%s", text);
}
