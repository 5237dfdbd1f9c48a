/*
  Method. A crack along X1 that repeats with the tissue has a period of the lattice of periods, i P_0 + j P_1, and is
  there once in each period across it if i and j have no common divisor; the distance between two of them is the area of
  a period over its length.

  A straight crack at the height y separates the cells whose centres are above y from those below and so cuts the faces
  between them; of the heights between the rows of cells that with the least energy is taken.
*/
#include "tear.h"
#include <math.h>

#define MOST_PERIODS 12 /* along a crack; more, and they lie closer than rows of cells */
#define ROUNDING 1e-9   /* apothems, radian */
#define ABOVE 0.5       /* the centres of a row, apothems: rows are 1 or more apart */

/* X1 and X2 of a lattice point. */
static void Place(const LamMicrostructure *micro, PetscReal i, PetscReal j, PetscReal X[2])
{
  const PetscReal first = micro->orientation, second = first + PETSC_PI / 3.0;

  X[0] = 2.0 * (i * cos(first) + j * cos(second));
  X[1] = 2.0 * (i * sin(first) + j * sin(second));
}

/* X2 of a cell's centre. */
static PetscReal HeightOf(const LamMicrostructure *micro, PetscInt cell)
{
  PetscInt index[2];
  PetscReal X[2];

  LamLatticeIndex(micro, cell, index);
  Place(micro, (PetscReal)index[0], (PetscReal)index[1], X);
  return X[1];
}

/* Length of the shortest period along X1; 0: there is none. */
static PetscReal WidthOf(const LamMicrostructure *micro)
{
  PetscReal least = 0.0;

  for (PetscInt i = 0; i <= MOST_PERIODS; i++)
    for (PetscInt j = -MOST_PERIODS; j <= MOST_PERIODS; j++) {
      PetscReal X[2];

      Place(micro, (PetscReal)(i * micro->cells[0]), (PetscReal)(j * micro->cells[1]), X);
      if (fabs(X[1]) > ROUNDING || fabs(X[0]) < 1.0) continue;
      if (least == 0.0 || fabs(X[0]) < least) least = fabs(X[0]);
    }
  return least;
}

/* Energy of the lamella on a face, with that beside its corners. */
static PetscReal FaceEnergy(const LamMicrostructure *micro, PetscInt cell, PetscInt face)
{
  const LamLamella *lamella = &micro->lamella;
  const PetscReal length = 2.0 / sqrt(3.0), junctions = PetscMin(length, 2.0 * lamella->junction_length);
  PetscReal strength, energy = 0.0;

  (void)LamLamellaFaceFactors(micro, cell, face, &strength, &energy);
  return lamella->energy * energy * (length - junctions + junctions * lamella->junction_energy);
}

/* How often cracks at the height y, and in each layer above and below, pass between two heights. */
static PetscReal Passes(PetscReal from, PetscReal to, PetscReal y, PetscReal height)
{
  return floor((to - y) / height) - floor((from - y) / height);
}

/* Energy of a straight crack at the height y; *most: how often a face is cut. */
static PetscReal EnergyAt(const LamMicrostructure *micro, const LamTearLayer *layer, PetscReal y, PetscReal *most)
{
  const PetscInt cells = micro->cells[0] * micro->cells[1];
  PetscReal sum = 0.0;

  for (PetscInt cell = 0; cell < cells; cell++) {
    const PetscReal from = HeightOf(micro, cell);

    for (PetscInt face = 0; face < LAM_FACES / 2; face++) { /* each pair of cells once */
      const PetscReal up = 2.0 * sin(micro->orientation + PETSC_PI / 3.0 * (PetscReal)face);
      const PetscReal cut = fabs(Passes(from, from + up, y, layer->height));

      *most = PetscMax(*most, cut);
      sum += cut * FaceEnergy(micro, cell, face);
    }
  }
  return sum / layer->width;
}

PetscErrorCode LamTearLayerOf(const char path[], const LamMicrostructure *micro, LamTearLayer *layer)
{
  const PetscInt cells = micro->cells[0] * micro->cells[1];
  const PetscReal area = 2.0 * sqrt(3.0) * (PetscReal)cells;
  PetscReal most = 0.0;

  PetscFunctionBeginUser;
  PetscCheck(fabs(remainder(micro->orientation, PETSC_PI / 6.0)) < ROUNDING, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.cell.orientation: %.4g deg: no row of cells is along X1, so that no layer with the normal X2 "
             "repeats with the tissue; write a multiple of 30 deg",
             path, (double)(micro->orientation * 180.0 / PETSC_PI));
  layer->width = WidthOf(micro);
  layer->height = area / layer->width;
  layer->energy = INFINITY;
  for (PetscInt cell = 0; cell < cells && layer->width > 0.0; cell++) {
    const PetscReal y = HeightOf(micro, cell) + ABOVE;

    layer->energy = PetscMin(layer->energy, EnergyAt(micro, layer, y, &most));
  }
  PetscCheck(layer->width > 0.0 && most < 1.5, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.cells: [%d, %d]: one period along X1 is a layer of less than a row of cells, each cut by several "
             "cracks; write cells: [2, 1]",
             path, (int)micro->cells[0], (int)micro->cells[1]);
  PetscFunctionReturn(0);
}
