/*
  Method. A crack along X1 that repeats with the tissue has a period of the lattice of periods, i P_0 + j P_1, and is
  there once in each period across it if i and j have no common divisor; the distance between two of them is the area of
  a period over its length.

  A straight crack at the height y separates the cells whose centres are above y from those below and so cuts the faces
  between them; of the heights just above the centre of a cell that with the least energy is taken.
*/
#include <lamella/tissue.h>
#include "tear.h"
#include <math.h>

#define MOST_PERIODS 12 /* along a crack; more, and they lie closer than rows of cells */
#define ROUNDING 1e-9   /* apothems, radian */
#define ABOVE 0.5       /* the centres of a row, apothems: rows are 1 or more apart */

/* Length of the shortest period along X1; 0: there is none. */
static PetscReal WidthOf(LamTissue tissue)
{
  PetscReal least = 0.0;

  for (PetscInt i = 0; i <= MOST_PERIODS; i++)
    for (PetscInt j = -MOST_PERIODS; j <= MOST_PERIODS; j++) {
      PetscReal X[2];

      for (int d = 0; d < 2; d++) X[d] = (PetscReal)i * tissue->period[0][d] + (PetscReal)j * tissue->period[1][d];
      if (fabs(X[1]) > ROUNDING || fabs(X[0]) < 1.0) continue;
      if (least == 0.0 || fabs(X[0]) < least) least = fabs(X[0]);
    }
  return least;
}

/* X2 of a cell's centre. */
static PetscReal HeightOf(LamTissue tissue, PetscInt cell)
{
  PetscReal X[2];

  LamTissueCentre(tissue, cell, X);
  return X[1];
}

/* X2 of the centre of the cell across a face, in its image. */
static PetscReal HeightAcross(LamTissue tissue, PetscInt face)
{
  const PetscInt *wraps = tissue->wraps[face];

  return HeightOf(tissue, tissue->cell[tissue->partner[face]]) + (PetscReal)wraps[0] * tissue->period[0][1] +
         (PetscReal)wraps[1] * tissue->period[1][1];
}

/* Energy of the lamella on a face, with that beside its corners, where there is no air. */
static PetscReal FaceEnergy(const LamMicrostructure *micro, LamTissue tissue, PetscInt face)
{
  const LamLamella *lamella = &micro->lamella;
  const PetscInt next = LamTissueNext(tissue, face), cell = tissue->cell[face];
  const PetscReal *a = tissue->corner[face], *b = tissue->corner[next];
  const PetscReal air[2] = {tissue->setback[face], tissue->setback[next]};
  const PetscReal length = hypot(b[0] - a[0], b[1] - a[1]) - air[0] - air[1];
  PetscReal strength, energy = 0.0, junctions = 0.0;

  for (int k = 0; k < 2; k++) junctions += PetscMax(0.0, lamella->junction_length - air[k]);
  junctions = PetscMin(length, junctions);
  (void)LamLamellaFaceFactors(micro, cell, face - tissue->first[cell], &strength, &energy);
  return lamella->energy * energy * (length - junctions + junctions * lamella->junction_energy);
}

/* How often cracks at the height y, and in each layer above and below, pass between two heights. */
static PetscReal Passes(PetscReal from, PetscReal to, PetscReal y, PetscReal height)
{
  return floor((to - y) / height) - floor((from - y) / height);
}

/* Energy of a straight crack at the height y; *most: how often a face is cut. */
static PetscReal EnergyAt(const LamMicrostructure *micro, LamTissue tissue, const LamTearLayer *layer, PetscReal y,
                          PetscReal *most)
{
  PetscReal sum = 0.0;

  for (PetscInt face = 0; face < tissue->faces; face++) { /* each pair of cells once */
    PetscReal cut;

    if (!LamTissueIsSlave(tissue, face)) continue;
    cut = fabs(Passes(HeightOf(tissue, tissue->cell[face]), HeightAcross(tissue, face), y, layer->height));
    *most = PetscMax(*most, cut);
    sum += cut * FaceEnergy(micro, tissue, face);
  }
  return sum / layer->width;
}

/* The layer of a tissue, and how often a straight crack at some height cuts a face of it. */
static PetscReal Layer(const LamMicrostructure *micro, LamTissue tissue, LamTearLayer *layer)
{
  PetscReal most = 0.0;

  *layer = (LamTearLayer){.width = WidthOf(tissue), .energy = INFINITY};
  layer->height = tissue->area / layer->width;
  for (PetscInt cell = 0; cell < tissue->cells && layer->width > 0.0; cell++) {
    const PetscReal y = HeightOf(tissue, cell) + ABOVE;

    layer->energy = PetscMin(layer->energy, EnergyAt(micro, tissue, layer, y, &most));
  }
  return most;
}

PetscErrorCode LamTearLayerOf(const char path[], const LamMicrostructure *micro, LamTearLayer *layer)
{
  const PetscReal turn = remainder(micro->orientation, PETSC_PI / 6.0);
  LamTissue tissue;
  PetscReal most;

  PetscFunctionBeginUser;
  PetscCheck(micro->tissue || fabs(turn) < ROUNDING, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.cell.orientation: %.4g deg: no row of cells is along X1, so that no layer with the normal X2 "
             "repeats with the tissue; write a multiple of 30 deg",
             path, (double)(micro->orientation * 180.0 / PETSC_PI));
  PetscCall(LamTissueCreate(micro, &tissue));
  most = Layer(micro, tissue, layer);
  PetscCall(LamTissueDestroy(&tissue));
  PetscCheck(!micro->tissue || layer->width > 0.0, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.tissue: none of its periods is along X1, so that no layer with the normal X2 repeats with it; "
             "take a tissue whose first period vector is along X1",
             path);
  PetscCheck(layer->width > 0.0 && most < 1.5, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.cells: [%d, %d]: one period along X1 is a layer of less than a row of cells, each cut by several "
             "cracks; write cells: [2, 1]",
             path, (int)micro->cells[0], (int)micro->cells[1]);
  PetscFunctionReturn(0);
}
