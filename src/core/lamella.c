/*
  What follows from the parameters of a lamella: stiffnesses, and the length over which it breaks.
*/
#include <lamella/tissue.h>
#include <lamella/scene.h>
#include <math.h>

#define SOFT 8e-4  /* share of the tissue's stiffness that a lamella may cost where its own is not given */
#define STEEP 50.0 /* times the least stiffness: softening is then spread over 98 % of the opening at failure */

/* strength^2/energy; 0 where nothing holds. */
static PetscReal Brittleness(PetscReal strength, PetscReal energy)
{
  return strength > 0.0 ? strength * strength / energy : 0.0;
}

PetscBool LamLamellaFaceFactors(const LamMicrostructure *micro, PetscInt cell, PetscInt face, PetscReal *strength,
                                PetscReal *energy)
{
  const LamLamella *lamella = &micro->lamella;
  const LamCell *one, *other;
  PetscInt neighbour;

  const PetscInt family = LamCellDirection(micro, cell, face) % (LAM_DIRECTIONS / 2);

  *strength = lamella->face_strength[family];
  *energy = lamella->face_energy[family];
  if (!micro->cell) return PETSC_TRUE;
  neighbour = LamCellAcross(micro, cell, face);
  if (neighbour < 0) return PETSC_FALSE;
  one = &micro->cell[cell];
  other = &micro->cell[neighbour];
  *strength *= PetscMin(one->lamella_strength, other->lamella_strength);
  *energy *= PetscMin(one->lamella_energy, other->lamella_energy);
  if (one->cluster == other->cluster) return PETSC_TRUE;
  *strength *= lamella->between_strength;
  *energy *= lamella->between_energy;
  return PETSC_TRUE;
}

/* The largest of the factors on a face and beside its corners, over the faces of the tissue. */
static PetscReal WorstFactors(const LamMicrostructure *micro)
{
  const LamLamella *lamella = &micro->lamella;
  const PetscInt cells = micro->cell || micro->tissue ? micro->cells[0] * micro->cells[1] : 1;
  PetscReal worst = 0.0;

  for (PetscInt cell = 0; cell < cells; cell++)
    for (PetscInt k = 0; k < LamCellFaces(micro, cell); k++) {
      PetscReal strength, energy;

      if (!LamLamellaFaceFactors(micro, cell, k, &strength, &energy)) continue;
      worst = PetscMax(worst, Brittleness(strength, energy));
      if (lamella->junction_length > 0.0)
        worst = PetscMax(worst, Brittleness(strength * lamella->junction_strength, energy * lamella->junction_energy));
    }
  return worst;
}

PetscReal LamLamellaLeastStiffness(const LamMicrostructure *micro)
{
  const LamLamella *lamella = &micro->lamella;
  const PetscReal energy =
      lamella->shear_strength > 0.0 ? PetscMin(lamella->energy, lamella->shear_energy) : lamella->energy;

  return 0.5 * Brittleness(lamella->strength, energy) * WorstFactors(micro);
}

/*
  Relative change of the tangent of tissue, in its Frobenius norm, times the stiffness of the lamella. Measured for
  walls of 0.04 to 0.35 apothems and C4 up to 30 (C1 + C2): within 15 % of what a stiff lamella adds, 8 % on average
  (docs/theory/lamella.md, Stiffness). Forces pass from wall to wall near the corners, so that it hardly depends on how
  little wall there is.
*/
static PetscReal PriceTimesStiffness(const LamMicrostructure *micro)
{
  const PetscInt cells = micro->cell ? micro->cells[0] * micro->cells[1] : 1;
  PetscReal price = 0.0;

  for (PetscInt c = 0; c < cells; c++) {
    const LamWall *wall = micro->cell ? &micro->cell[c].wall : &micro->wall;

    price = PetscMax(price, (wall->C1 + wall->C2 + 0.8 * LamWallFibreModulus(wall)) *
                                (1.0 + 2.0 * LamWallThickness(micro, c)));
  }
  return price;
}

PetscReal LamLamellaDefaultStiffness(const LamMicrostructure *micro)
{
  const PetscReal stiff = PriceTimesStiffness(micro) / SOFT, steep = STEEP * LamLamellaLeastStiffness(micro);

  return PetscMin(PetscMax(stiff, steep), LAM_LAMELLA_STIFFEST);
}

/* Modulus of a wall along itself at rest, E'. */
static PetscReal ModulusAlong(const LamWall *wall)
{
  return 4.0 * (wall->C1 + wall->C2) + 2.0 * LamWallFibreModulus(wall);
}

PetscReal LamTearingLeastStiffness(const LamTearing *tearing)
{
  return 0.5 * Brittleness(tearing->strength, tearing->energy);
}

/*
  Share of the stiffness of walls that their cuts cost, times the stiffness of these. A face of length l has one cut in
  its middle and half of one at each end: in tension they add 2 E'/(k l) to its compliance. Bent by a moment that
  changes its sign in the middle, where that cut is, the ends add 1 over a mean square of 1/3, 3 E'/(k l).
*/
static PetscReal CutPriceTimesStiffness(const LamMicrostructure *micro)
{
  const PetscInt cells = micro->cell ? micro->cells[0] * micro->cells[1] : 1;
  const PetscReal length = 2.0 / sqrt(3.0);
  PetscReal stiffest = 0.0;

  for (PetscInt c = 0; c < cells; c++)
    stiffest = PetscMax(stiffest, ModulusAlong(micro->cell ? &micro->cell[c].wall : &micro->wall));
  return 3.0 * stiffest / length;
}

PetscReal LamTearingDefaultStiffness(const LamMicrostructure *micro)
{
  const PetscReal steep = STEEP * LamTearingLeastStiffness(&micro->tearing);

  return PetscMin(PetscMax(CutPriceTimesStiffness(micro) / SOFT, steep), LAM_LAMELLA_STIFFEST);
}

PetscReal LamTearingCompliance(const LamMicrostructure *micro)
{
  return CutPriceTimesStiffness(micro) / micro->tearing.stiffness;
}

PetscReal LamLamellaCompliance(const LamMicrostructure *micro)
{
  return PriceTimesStiffness(micro) / micro->lamella.stiffness;
}

PetscReal LamLamellaZone(const LamMicrostructure *micro)
{
  const PetscInt cells = micro->cell ? micro->cells[0] * micro->cells[1] : 1;
  const PetscReal ductility = 0.5 / LamLamellaLeastStiffness(micro); /* energy/strength^2, the smallest */
  PetscReal zone = INFINITY;

  for (PetscInt c = 0; c < cells; c++) {
    const LamWall *wall = micro->cell ? &micro->cell[c].wall : &micro->wall;
    const PetscReal t = LamWallThickness(micro, c);
    const PetscReal thick = ModulusAlong(wall) * ductility;

    zone = PetscMin(zone, PetscMin(thick, pow(t, 0.75) * pow(thick, 0.25)));
  }
  return zone;
}
