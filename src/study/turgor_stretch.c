/*
  Method
    Of tissue that is free of stress, a section across the middle of the walls bears no force: s t' = p (a' - t'), s the
    stress along the wall, t' and a' its present thickness and the present apothem. Walls that keep their area have t' =
    t/l at a stretch l; the corners, a share t of the apothem (a = 1), do not stretch, so that a' = (1 - t) l + t. In
    plane strain the wall gives s + p = l dW/dl along F = diag(l, 1/l, 1), W its energy density. Hence
      dW/dl / ((1 - t) l + t) = p / t,
    whose left side grows with l. Solved tissue has the same strain within 6 %, up to strains of 1
  (tests/cli/warnings.sh).
*/
#include "turgor_stretch.h"
#include "wall_law.h"
#include <math.h>

#define LARGEST_STRETCH 10.0 /* more is no equilibrium that anyone means */
/* Walls of fruit and vegetables break at strains of 5 to 50 %; a larger one is more often a mistake than a tissue. */
#define DOUBTFUL_STRETCH 1.5

/* dW/dl of a wall; infinite beyond what its law can tell. */
static PetscReal Force(const LamWallLaw *law, const LamWall *wall, PetscReal l)
{
  const PetscReal d = wall->dispersion;
  LamPoints H[4] = {{0}}, strain;
  LamKernel matrix;
  LamKernel1 fibre = {0};

  LAM_EACH_POINT(g)
  {
    H[0][g] = l - 1.0;
    H[3][g] = 1.0 / l - 1.0;
    strain[g] = d * (l * l + 1.0 / (l * l) - 2.0) + (1.0 - 3.0 * d) * (l * l - 1.0);
  }
  law->matrix(wall, (const LamPoints *)H, 0.0, PETSC_TRUE, &matrix);
  if (law->fibre) law->fibre(wall, strain, &fibre);
  if (!isfinite(fibre.W[0])) return PETSC_INFINITY;
  return matrix.P[0][0] - matrix.P[3][0] / (l * l) +
         2.0 * fibre.d[0] * (d * (l - 1.0 / (l * l * l)) + (1.0 - 3.0 * d) * l);
}

/* Whether a wall at a stretch bears less than the turgor asks of it. */
static PetscBool Yields(const LamWallLaw *law, const LamWall *wall, PetscReal t, PetscReal turgor, PetscReal l)
{
  return (PetscBool)(Force(law, wall, l) < turgor / t * ((1.0 - t) * l + t));
}

/* Of a cell alone. */
static PetscReal CellStretch(const LamWall *wall, PetscReal thickness, PetscReal turgor)
{
  PetscReal lower = 1.0, upper = LARGEST_STRETCH;
  const LamWallLaw *law;

  if (!(turgor > 0) || LamWallLawGet(wall->law, &law)) return 1.0;
  if (Yields(law, wall, thickness, turgor, upper)) return PETSC_INFINITY;
  while (upper - lower > 1e-6) { /* more digits than are printed */
    const PetscReal middle = 0.5 * (lower + upper);

    if (Yields(law, wall, thickness, turgor, middle))
      lower = middle;
    else
      upper = middle;
  }
  return upper;
}

PetscReal LamTurgorStretch(const LamMicrostructure *micro, PetscReal turgor)
{
  const PetscInt cells = micro->cell ? micro->cells[0] * micro->cells[1] : 1;
  PetscReal largest = 1.0;

  for (PetscInt c = 0; c < cells; c++) {
    const LamWall *wall = micro->cell ? &micro->cell[c].wall : &micro->wall;
    const PetscReal factor = micro->cell ? micro->cell[c].turgor : 1.0;

    largest = PetscMax(largest, CellStretch(wall, LamWallThickness(micro, c), factor * turgor));
  }
  return largest;
}

static void Sentence(const char at[], const char key[], PetscReal stretch, PetscReal MPa, char text[LAM_TURGOR_TEXT])
{
  char words[80];

  if (stretch == PETSC_INFINITY)
    snprintf(words, sizeof(words), "is more than the walls hold, however far they stretch");
  else
    snprintf(words, sizeof(words), "stretches the walls of free tissue by about %.0f %%",
             (double)(100.0 * (stretch - 1.0)));
  snprintf(text, LAM_TURGOR_TEXT, "%.159s: %.120s: %.6g MPa: %s; check its unit, and thickness and moduli of the walls",
           at, key, (double)MPa, words);
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
  PetscReal stretch = LamTurgorStretch(&scene->micro, scene->turgor);
  const LamScenePlace none = {0};
  char at[LAM_PLACE_TEXT], key[LAM_NAME_LENGTH + 40];
  Block block[BLOCKS];

  text[0] = '\0';
  if (stretch > DOUBTFUL_STRETCH)
    Sentence(LamScenePlaceText(scene, &scene->turgor_place, at), "rve.turgor.pressure", stretch,
             scene->turgor * scene->scales.stress * 1e-6, text);
  FindLargest(scene, block);
  for (int b = 0; b < BLOCKS && !text[0]; b++) {
    stretch = LamTurgorStretch(&scene->micro, block[b].turgor);
    if (stretch > DOUBTFUL_STRETCH)
      Sentence(LamScenePlaceText(scene, &none, at), block[b].key, stretch,
               block[b].turgor * scene->scales.stress * 1e-6, text);
  }
  for (PetscInt r = 0; r < scene->region_count && !text[0]; r++) {
    const LamRegion *region = &scene->regions[r];

    stretch = LamTurgorStretch(&region->micro, region->turgor);
    if (!(stretch > DOUBTFUL_STRETCH)) continue;
    snprintf(key, sizeof(key), "macro.regions[%d]: %s: turgor", (int)r + 1, region->name);
    Sentence(LamScenePlaceText(scene, &region->place, at), key, stretch, region->turgor * region->scales.stress * 1e-6,
             text);
  }
}

void LamWarnOfTurgor(const LamReporter *reporter, const LamScene *scene)
{
  char text[LAM_TURGOR_TEXT];

  LamTurgorWarning(scene, text);
  if (text[0]) LamReportWarning(reporter, "%s", text);
}
