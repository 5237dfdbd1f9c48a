#include "random_lamella.h"
#include "random_reals.h"
#include "tissue.h"

#define DRY_SHARE 0.25
#define MOST_TURGOR (0.3 / TISSUE_STRESS)

const char *const lamella_program_names[PROGRAM_COUNT] = {"shear",      "tension along 1", "tension along 2",
                                                          "pure shear", "equibiaxial",     "compression"};

static double RandomMagnitude(uint64_t *seed, double low, double high)
{
  return exp(RandomReal(seed, log(low), log(high)));
}

static LamLamella DrawLaw(uint64_t *seed)
{
  LamLamella law = LAM_LAMELLA_UNIFORM;

  law.strength = RandomMagnitude(seed, 0.05, 2.0);
  law.energy = 0.5 * law.strength * RandomMagnitude(seed, 0.01, 2.0);
  law.shear_strength = law.strength * RandomMagnitude(seed, 0.3, 2.0);
  law.shear_energy = law.energy;
  if (RandomReal(seed, 0.0, 1.0) < 0.5) law.shear_energy *= RandomMagnitude(seed, 1.0, 4.0);
  law.softening = RandomReal(seed, 0.0, 1.0) < 0.5 ? LAM_SOFTENING_BILINEAR : LAM_SOFTENING_EXPONENTIAL;
  return law;
}

/* A seed for each tissue: congruential numbers of seeds in a row would lie on a lattice (the finaliser of splitmix64,
   Steele, Lea & Flood, OOPSLA 2014). */
static uint64_t SeedOf(uint64_t seed, int number)
{
  uint64_t z = (seed << 32) + (uint64_t)number;

  for (int k = 0; k < 2; k++) {
    z += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    z ^= z >> 31;
  }
  return z;
}

RandomLamella DrawLamella(uint64_t seed, int number, double most_turgor)
{
  RandomLamella s = {.micro = DefaultTissue()};

  seed = SeedOf(seed, number);
  s.micro.along = 6;
  s.micro.through = 1;
  s.micro.wall_thickness = RandomMagnitude(&seed, 0.05, 0.25);
  s.micro.wall.C4 = RandomMagnitude(&seed, 0.5, 30.0);
  s.micro.orientation = RandomReal(&seed, 0.0, PETSC_PI / 3.0);
  s.turgor = RandomReal(&seed, 0.0, PetscMin(MOST_TURGOR, most_turgor * s.micro.wall_thickness));
  if (RandomReal(&seed, 0.0, 1.0) < DRY_SHARE) s.turgor = 0.0;
  s.micro.interface = LAM_INTERFACE_LAMELLA;
  s.micro.lamella = DrawLaw(&seed);
  s.micro.lamella.stiffness = LamLamellaDefaultStiffness(&s.micro);
  s.program = (LamellaProgram)RandomReal(&seed, 0.0, PROGRAM_COUNT);
  return s;
}

void DrawTearing(uint64_t seed, int number, LamMicrostructure *micro)
{
  LamTearing *tearing = &micro->tearing;

  seed = SeedOf(~seed, number);
  tearing->strength = RandomMagnitude(&seed, 0.5, 5.0);
  tearing->energy = 0.5 * tearing->strength * micro->wall_thickness * RandomMagnitude(&seed, 0.03, 3.0);
  tearing->stiffness = LamTearingDefaultStiffness(micro);
  micro->sharpness = LAM_SHARPNESS_SMOOTH;
  micro->contact_width = LAM_USUAL_WIDTH;
}

LamLoad LamellaProgramLoad(const RandomLamella *sample, double strain)
{
  switch (sample->program) {
  case PROGRAM_SHEAR:
    return PlaneLoad(1.0, strain, 0.0, 1.0, sample->turgor);
  case PROGRAM_TENSION_1:
    return PlaneLoad(1.0 + strain, 0.0, 0.0, 1.0, sample->turgor);
  case PROGRAM_TENSION_2:
    return PlaneLoad(1.0, 0.0, 0.0, 1.0 + strain, sample->turgor);
  case PROGRAM_PURE_SHEAR:
    return PlaneLoad(1.0 + strain, 0.0, 0.0, 1.0 / (1.0 + strain), sample->turgor);
  case PROGRAM_EQUIBIAXIAL:
    return PlaneLoad(1.0 + strain, 0.0, 0.0, 1.0 + strain, sample->turgor);
  default:
    return PlaneLoad(1.0 + strain, 0.0, 0.0, 1.0 - 0.5 * strain, sample->turgor);
  }
}
