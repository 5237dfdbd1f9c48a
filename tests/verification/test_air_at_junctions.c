/*
  Air at the junctions of turgid cells with thin walls, against Calbo & Nery (J. Am. Soc. Hort. Sci. 120, 1995): of
  hexagons whose corners are rounded the share alpha of a face that is in contact, the gas volume v_G and the pressure
  that holds the tissue together are

    alpha = 1 - sqrt(v_G / 0.0931),    pressure = alpha p,    0.0931 = 1 - pi / (2 sqrt 3),

  v_G of the tissue's volume, p the turgor. Walls that bend freely are arcs of circles between flat faces. They start
  with arcs of one radius, and turgor stretches them: faces grow, and the arcs get smaller.
*/
#include <lamella/tissue.h>
#include "support/rve_fixture.h"

#define RADIUS 0.6      /* apothems, of corners at rest */
#define THICKNESS 0.004 /* apothems: what thick walls change is of the order of thickness over radius */
#define TOLERANCE 5e-3
#define GAS_OF_CIRCLES (1.0 - PETSC_PI / (2.0 * sqrt(3.0)))
enum { PRESSURES = 4 };
static const double turgor[PRESSURES] = {0.01, 0.02, 0.04, 0.06}; /* C1 + C2 */

static struct {
  double share;    /* of a face in contact, from where walls part */
  double gas;      /* v_G */
  double pressure; /* over p */
} found[PRESSURES];

static LamMicrostructure RoundedTissue(void)
{
  LamMicrostructure micro = ContactTissue(40, 1);
  LamTissue tissue;

  micro.wall_thickness = THICKNESS;
  micro.wall.C4 = 125.0;
  assert_int_equal(LamTissueCreate(&micro, &tissue), 0);
  for (PetscInt k = 0; k < tissue->faces; k++) tissue->setback[k] = RADIUS / sqrt(3.0);
  micro.tissue = tissue; /* the copy of the RVE is its own */
  return micro;
}

/* A point of a wall beside air: along the face from its middle, and distance from it. */
typedef struct {
  double y, depth;
} Point;

/* Radius of an arc that leaves the face at `end` and passes through a point: depth = r - sqrt(r^2 - (y - end)^2). */
static double RadiusOf(Point p, double end)
{
  return 0.5 * ((p.y - end) * (p.y - end) / p.depth + p.depth);
}

/* Where the arc through two points leaves the face. */
static double EndOfContact(Point one, Point other)
{
  double low = 0.0, high = one.y;

  for (int k = 0; k < 60; k++) {
    const double end = 0.5 * (low + high);

    *(RadiusOf(one, end) < RadiusOf(other, end) ? &high : &low) = end;
  }
  return high;
}

/* Distance from the middle of a wall to where it parts from the other, in steps of `side` from there: from points that
   lie well on the arc. x [points]: face 0, along X2. */
static double HalfContact(int points, const double x[][2], int side)
{
  const double *middle = x[points / 2];
  Point on[2];
  int count = 0;

  for (int i = points / 2; i >= 0 && i < points && count < 2; i += side) {
    const Point p = {side * (x[i][1] - middle[1]), middle[0] - x[i][0]};

    if (p.depth > (count ? 0.04 : 0.01)) on[count++] = p;
  }
  assert_int_equal(count, 2);
  return EndOfContact(on[0], on[1]);
}

/* Both ends count: nothing holds a wall from sliding along its cell. */
static double ShareInContact(LamRVE rve, LamRVEState at)
{
  PetscInt faces, points;
  double(*from)[2], length;

  assert_int_equal(LamRVEGetInterfaceSize(rve, &faces, &points), 0);
  from = calloc((size_t)(faces * points), sizeof(*from));
  assert_int_equal(LamRVEGetInterface(rve, at, &from[0][0], NULL, NULL, NULL), 0);
  length = HalfContact(points, (const double(*)[2])from, 1) + HalfContact(points, (const double(*)[2])from, -1);
  free(from);
  return length / (2.0 / sqrt(3.0));
}

static int Solve(void **ctx)
{
  LamMicrostructure micro = RoundedTissue();
  LamRVE rve = NewRVE(&micro);
  LamRVEState at = NewState(rve);

  (void)ctx;
  for (int k = 0; k < PRESSURES; k++) {
    LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .turgor = turgor[k]};
    LamResponse response;
    double gas;

    assert_int_equal(LamRVESolve(rve, &load, at, &response), 0);
    if (response.status != LAM_CONVERGED) return 1;
    (void)LamGapAreaEvaluate(&rve->contact->gaps, load.F, at->y, &gas);
    found[k].gas = gas / rve->mesh.V0;
    found[k].share = ShareInContact(rve, at);
    found[k].pressure = -0.5 * (response.P[0] + response.P[4]) / turgor[k];
    if (getenv("LAMELLA_FIGURES"))
      printf("p %.3g: gas %.5f alpha %.5f contact %.5f pressure %.5f\n", turgor[k], found[k].gas,
             1.0 - sqrt(found[k].gas / GAS_OF_CIRCLES), found[k].share, found[k].pressure);
  }
  assert_int_equal(LamRVEStateDestroy(&at), 0);
  assert_int_equal(LamRVEDestroy(&rve), 0);
  return LamMicrostructureDestroy(&micro);
}

static double AlphaOf(int k)
{
  return 1.0 - sqrt(found[k].gas / GAS_OF_CIRCLES);
}

TEST(TheGasVolumeGivesTheShareInContact)
{
  for (int k = 0; k < PRESSURES; k++) assert_near(found[k].share / AlphaOf(k), 1.0, TOLERANCE);
}

TEST(ThatShareOfTurgorHoldsTheTissueTogether)
{
  for (int k = 0; k < PRESSURES; k++) assert_near(found[k].pressure / AlphaOf(k), 1.0, TOLERANCE);
}

/* Otherwise the states would not differ from that at rest. */
TEST(ArcsGetSmaller)
{
  for (int k = 1; k < PRESSURES; k++) assert_true(AlphaOf(k) > AlphaOf(k - 1) + 0.01);
}

TEST_GROUP(.petsc = 1, .setup = Solve);
