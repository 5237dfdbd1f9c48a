#include "random_contact.h"

#define DRY_SHARE 0.1
#define LEAST_PRESSURE 0.002 /* of p + g, MPa, of states that are not dry */

const char *const contact_box_names[BOX_COUNT + 1] = {"asked", "wide", "thin", NULL};
static const double wall_thickness[BOX_COUNT][2] = {{0.03, 0.4}, {0.03, 0.4}, {0.02, 0.05}};

static void DrawStrain(ContactBox box, uint64_t *seed, double e[2])
{
  double mean = 0.0, half;

  switch (box) {
  case BOX_ASKED:
    mean = RandomReal(seed, -0.05, 0.3), half = 0.5 * RandomReal(seed, -0.3, 0.3);
    break;
  case BOX_THIN:
    half = asinh(0.5 * RandomReal(seed, 0.0, 0.6));
    break;
  default:
    do {
      e[0] = RandomReal(seed, -0.3, 0.3);
      e[1] = RandomReal(seed, -0.3, 0.3);
    } while (0.5 * (e[0] + e[1]) < -0.05);
    return;
  }
  e[0] = mean + half;
  e[1] = mean - half;
}

/* F = R U, U with stretches exp(e) along the principal directions. */
static LamLoad StretchedAndTurned(const RandomContact *s)
{
  const double a = exp(s->strain[0]), b = exp(s->strain[1]), c = cos(s->direction), d = sin(s->direction);
  const double U11 = a * c * c + b * d * d, U22 = a * d * d + b * c * c, U12 = (a - b) * c * d;
  const double C = cos(s->rotation), S = sin(s->rotation);

  return ContactLoad(C * U11 - S * U12, C * U12 - S * U22, S * U11 + C * U12, S * U12 + C * U22, s->turgor,
                     s->cohesion);
}

RandomContact DrawContact(ContactBox box, int number, int along, int through, uint64_t *seed)
{
  RandomContact s = {.micro = ContactTissue(along, through)};

  DrawStrain(box, seed, s.strain);
  s.direction = RandomReal(seed, 0.0, PETSC_PI);
  s.rotation = RandomReal(seed, -PETSC_PI, PETSC_PI);
  s.micro.wall_thickness = RandomReal(seed, wall_thickness[box][0], wall_thickness[box][1]);
  s.micro.orientation = RandomReal(seed, 0.0, PETSC_PI);
  if (box == BOX_THIN) s.micro.cells[0] = s.micro.cells[1] = 1 + number % 2;
  s.dry = (PetscBool)(RandomReal(seed, 0.0, 1.0) < DRY_SHARE);
  do {
    s.turgor = RandomReal(seed, 0.0, 0.05);
    s.cohesion = RandomReal(seed, 0.0, 0.01);
  } while (s.turgor + s.cohesion < LEAST_PRESSURE);
  if (s.dry) s.turgor = s.cohesion = 0.0;
  s.load = StretchedAndTurned(&s);
  return s;
}
