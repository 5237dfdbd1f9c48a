/* Turgid cells without bending stiffness and cohesion, against the geometry of Calbo & Nery, J. Amer. Soc. Hort. Sci.
   126 (2001): hexagons of apothem a whose corners are arcs of radius r. Gas is r^2/a^2 of that between circles, contact
   covers a share 1 - r/a of the hexagon, in which it bears the turgor. Nothing of the walls enters. */
#include "support/rve_fixture.h"

#define THICKNESS 0.0025 /* apothems; walls bend over lengths of this size */
#define TURGOR 0.002     /* C1: walls stretch by some per cent */

static LamMicrostructure ThinTissue(void)
{
  LamMicrostructure micro = ContactTissue(40, 1);

  micro.wall = (LamWall){.law = LAM_WALL_MOONEY_RIVLIN, .C1 = 1, .bulk_modulus = 1000};
  micro.wall_thickness = THICKNESS;
  micro.grading = 0.6;
  return micro;
}

TEST(pressure_between_cells_is_the_turgor_times_the_share_in_contact)
{
  const double circles = 1 - M_PI / (2 * sqrt(3));
  const LamMicrostructure micro = ThinTissue();
  OWNED(LamRVE, LamRVEDestroy) rve = NewRVE(&micro);
  OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);

  for (double F = 1.06; F < 1.25; F += 0.02) {
    const LamLoad load = PlaneLoad(F, 0, 0, F, TURGOR);
    LamResponse r;

    CHECK(LamRVESolve(rve, &load, at, &r));
    assert_int_equal(r.status, LAM_CONVERGED);
    {
      const double contact = 1 - sqrt(r.opening_fraction / (F * F) / circles);
      const double walls = 4 * sqrt(3) * contact / (4 * sqrt(3) * contact + 2 * M_PI * (1 - contact));

      assert_near(-r.P[0] / F, TURGOR * contact, 0.001 * TURGOR * contact);
      assert_near(-r.P[4] / F, TURGOR * contact, 0.001 * TURGOR * contact);
      assert_near(1 - r.debonded_fraction, walls, 0.02); /* an element is 0.01 to 0.04 of a face */
    }
  }
}
