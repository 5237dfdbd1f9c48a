/* Tissue at any F: the third component of positions, and the entries of the tangent with an index 3. */
#include "support/rve_fixture.h"
#include "support/lamella_tissue.h"
#include "support/turned_response.h"

#define TURGOR (0.02 / TISSUE_STRESS)
#define STEP 1e-4

static LamRVE NewPrism(const LamMicrostructure *micro, PetscBool sealable)
{
  LamRVE rve;

  CHECK(LamRVECreate(PETSC_COMM_SELF, &rve));
  CHECK(LamRVESetMicrostructure(rve, micro));
  CHECK(LamRVESetSealable(rve, sealable));
  CHECK(LamRVESetOutOfPlane(rve, PETSC_TRUE));
  CHECK(LamRVESetUp(rve));
  return rve;
}

static LamLoad Load(const double F[9], double cohesion)
{
  LamLoad load = {.turgor = TURGOR, .cohesion = cohesion};

  memcpy(load.F, F, sizeof(load.F));
  return load;
}

/* Fourth-order differences of P, and of Psi, against the response at a load, from `state`; errors over the largest
   entry of the tangent. */
static void CheckDifferences(LamRVE rve, LamRVEState state, const LamLoad *load, double tolerance)
{
  const double weight[5] = {1.0 / 12, -8.0 / 12, 0, 8.0 / 12, -1.0 / 12};
  OWNED(LamRVEState, LamRVEStateDestroy) at = NewState(rve);
  OWNED(LamRVEState, LamRVEStateDestroy) centre = NewState(rve);
  LamResponse r, q;
  double largest = 0.0, worst = 0.0, asymmetry = 0.0, slope = 0.0;

  CHECK(LamRVEStateCopy(state, centre));
  CHECK(LamRVESolve(rve, load, centre, &r));
  assert_string_equal(r.reason, "");
  assert_int_equal(r.status, LAM_CONVERGED);
  for (int k = 0; k < 9; k++) largest = fmax(largest, fabs(r.tangent[10 * k]));
  for (int k = 0; k < 9; k++) {
    double P[9] = {0}, energy = 0.0;

    for (int m = -2; m <= 2; m++) {
      LamLoad moved = *load;

      if (m == 0) continue;
      moved.F[k] += m * STEP;
      CHECK(LamRVEStateCopy(rve->layer ? state : centre, at));
      CHECK(LamRVESolve(rve, &moved, at, &q));
      assert_int_equal(q.status, LAM_CONVERGED);
      for (int i = 0; i < 9; i++) P[i] += weight[m + 2] * q.P[i] / STEP;
      energy += weight[m + 2] * q.energy / STEP;
    }
    slope = fmax(slope, fabs(energy - r.P[k]));
    for (int i = 0; i < 9; i++) worst = fmax(worst, fabs(P[i] - r.tangent[9 * i + k]) / largest);
    for (int i = 0; i < 9; i++)
      asymmetry = fmax(asymmetry, fabs(r.tangent[9 * i + k] - r.tangent[9 * k + i]) / largest);
  }
  assert_true(worst <= tolerance);
  assert_true(slope <= tolerance * largest);
  assert_true(asymmetry <= 1e-10);
}

static const double in_plane[9] = {1.06, 0.13, 0, -0.04, 0.99, 0, 0, 0, 1.03};
static const double any[9] = {1.06, 0.13, 0.08, -0.04, 0.99, -0.05, 0.12, 0.07, 1.03};

static void CheckTissue(const LamMicrostructure *micro, const double F[9], double cohesion, double tolerance)
{
  OWNED(LamRVE, LamRVEDestroy) rve = NewPrism(micro, PETSC_FALSE);
  OWNED(LamRVEState, LamRVEStateDestroy) state = NewState(rve);
  const LamLoad load = Load(F, cohesion);

  CheckDifferences(rve, state, &load, tolerance);
}

static LamMicrostructure TiltedTissue(void)
{
  LamMicrostructure micro = DefaultTissue();

  micro.wall.fibre_angle = 0.5;
  return micro;
}

TEST(BondedInThePlane)
{
  const LamMicrostructure micro = DefaultTissue();

  CheckTissue(&micro, in_plane, 0, 1e-7);
}

TEST(BondedAtAnyF)
{
  const LamMicrostructure micro = DefaultTissue();

  CheckTissue(&micro, any, 0, 1e-7);
}

TEST(FibresThatLeaveTheSection)
{
  const LamMicrostructure micro = TiltedTissue();

  CheckTissue(&micro, in_plane, 0, 1e-7);
  CheckTissue(&micro, any, 0, 1e-7);
}

/* Cells that end walls close; fibres of both laws, dispersed ones too. */
static LamMicrostructure ClosedTissue(LamWallLawType law)
{
  LamMicrostructure micro = DefaultTissue();

  micro.length = 2;
  micro.wall.law = law;
  if (law == LAM_WALL_FIBRE_EXPONENTIAL) {
    micro.wall.k1 = 3;
    micro.wall.k2 = 2;
    micro.wall.dispersion = 0.1;
  }
  return micro;
}

static void CheckClosed(LamWallLawType law)
{
  const LamMicrostructure micro = ClosedTissue(law);

  CheckTissue(&micro, in_plane, 0, 1e-7);
  CheckTissue(&micro, any, 0, 1e-7);
}

TEST_IS(EndWallsWithQuadraticFibres, CheckClosed(LAM_WALL_FIBRE_MOONEY_RIVLIN));
TEST_IS(EndWallsWithExponentialFibres, CheckClosed(LAM_WALL_FIBRE_EXPONENTIAL));
TEST_IS(EndWallsWithoutFibres, CheckClosed(LAM_WALL_MOONEY_RIVLIN));

TEST(ContactInThePlane)
{
  const LamMicrostructure micro = ContactTissue(6, 2);

  CheckTissue(&micro, in_plane, 0.02, 1e-7);
}

TEST(ContactAtAnyF)
{
  const LamMicrostructure micro = ContactTissue(6, 2);

  CheckTissue(&micro, any, 0.02, 1e-7);
}

TEST(LamellaAtAnyF)
{
  const LamMicrostructure micro = LamellaTissue(0.1);

  CheckTissue(&micro, in_plane, 0, 1e-7);
  CheckTissue(&micro, any, 0, 1e-7);
}

/* P(QF) = Q P(F) and A likewise, for a turn about no axis of the tissue. */
TEST(Objectivity)
{
  const LamMicrostructure micros[2] = {TiltedTissue(), ContactTissue(6, 2)};
  const double c = cos(0.7), s = sin(0.7), d = cos(0.4), e = sin(0.4);
  const double Q[9] = {c * d, -s, c * e, s * d, c, s * e, -e, 0, d};

  for (int k = 0; k < 2; k++) {
    OWNED(LamRVE, LamRVEDestroy) rve = NewPrism(&micros[k], PETSC_FALSE);
    OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
    LamLoad load = Load(any, 0.02 * k);
    LamResponse a, b;
    double F[9];

    CHECK(LamRVESolve(rve, &load, point, &a));
    CHECK(LamRVEStateReset(rve, point));
    TurnTensor(Q, any, turned_identity, F);
    load = Load(F, 0.02 * k);
    CHECK(LamRVESolve(rve, &load, point, &b));
    assert_int_equal(b.status, LAM_CONVERGED);
    for (int i = 0; i < 9; i++) {
      double P = 0.0;

      for (int m = 0; m < 3; m++) P += Q[i - i % 3 + m] * a.P[3 * m + i % 3];
      assert_near(P, b.P[i], 1e-10);
      for (int j = 0; j < 9; j++) {
        double A = 0.0;

        for (int m = 0; m < 9; m++)
          A += Q[i - i % 3 + m / 3] * Q[j - j % 3 + m % 3] * a.tangent[9 * (3 * (m / 3) + i % 3) + 3 * (m % 3) + j % 3];
        assert_near(A, b.tangent[9 * i + j], 1e-10);
      }
    }
  }
}

/* W of a wall in three dimensions, from the invariants of a 3 x 3 F without any frame. */
static double WallEnergy(const LamWall *wall, const double m[2], const double F[9])
{
  const double c = cos(wall->fibre_angle), s = sin(wall->fibre_angle), M[3] = {c * m[0], c * m[1], s};
  double C[9] = {0}, I1, I2, I4 = 0.0, J;

  for (int i = 0; i < 9; i++)
    for (int k = 0; k < 3; k++) C[i] += F[3 * k + i / 3] * F[3 * k + i % 3];
  I1 = C[0] + C[4] + C[8];
  I2 = C[0] * C[4] + C[4] * C[8] + C[8] * C[0] - C[1] * C[1] - C[2] * C[2] - C[5] * C[5];
  J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
  for (int i = 0; i < 9; i++) I4 += M[i / 3] * M[i % 3] * C[i];
  return 0.5 * wall->C1 * (I1 * pow(J, -2.0 / 3) - 3.0) + 0.5 * wall->C2 * (I2 * pow(J, -4.0 / 3) - 3.0) +
         0.25 * wall->C4 * (I4 - 1.0) * (I4 - 1.0);
}

/* Energy of all walls at nodes y + share dy and an F of nine components in the laboratory's frame. */
static double BodyEnergy(LamRVE rve, const double F[9], const double *nodes)
{
  const LamMesh *mesh = &rve->mesh;
  double energy = 0.0;

  for (int e = 0; e < mesh->element_count; e++) {
    const LamElementGeometry *geometry = &rve->geometry[e];
    const LamWall *wall = LamWallOf(rve, e);
    double J[LAM_GAUSS], moment[LAM_PRESSURES] = {0};

    for (int g = 0; g < LAM_GAUSS; g++) {
      double local[9] = {0, 0, F[2], 0, 0, F[5], 0, 0, F[8]};

      for (int a = 0; a < LAM_ELEMENT_NODES; a++) {
        const int node = mesh->elements[LAM_ELEMENT_NODES * e + a], at = mesh->node_class[node];

        for (int i = 0; i < 3; i++) {
          const double x =
              nodes[3 * at + i] + F[3 * i] * mesh->shift[2 * node] + F[3 * i + 1] * mesh->shift[2 * node + 1];

          for (int l = 0; l < 2; l++) local[3 * i + l] += x * geometry->dN[2 * g + l][a];
        }
      }
      J[g] = local[0] * (local[4] * local[8] - local[5] * local[7]) -
             local[1] * (local[3] * local[8] - local[5] * local[6]) +
             local[2] * (local[3] * local[7] - local[4] * local[6]);
      energy += geometry->weight[g] * WallEnergy(wall, geometry->fibre, local);
      for (int k = 0; k < LAM_PRESSURES; k++) moment[k] += geometry->weight[g] * geometry->psi[k][g] * J[g];
    }
    for (int g = 0; g < LAM_GAUSS; g++) {
      double theta = 0.0;

      for (int k = 0; k < LAM_PRESSURES; k++) theta += geometry->psi[k][g] * moment[k];
      energy += geometry->weight[g] * 0.25 * wall->bulk_modulus * (theta * theta - 1.0 - 2.0 * log(theta));
    }
  }
  return energy / mesh->V0;
}

/* The same energy, written down in three dimensions, is stationary at the solution, turned back to the laboratory's
   frame, and its derivative by F is P: with F_13 and F_23, which the solver does not know. */
TEST(AgainstThreeDimensions)
{
  const LamMicrostructure micro = TiltedTissue();
  OWNED(LamRVE, LamRVEDestroy) rve = NewPrism(&micro, PETSC_FALSE);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  const int classes = rve->mesh.class_count;
  const double h = 1e-5, length = sqrt(any[2] * any[2] + any[5] * any[5] + any[8] * any[8]);
  const double n[3] = {any[2] / length, any[5] / length, any[8] / length}, d = 1.0 / (1.0 + n[2]);
  const double Q[9] = {
      1 - n[0] * n[0] * d, -n[0] * n[1] * d, -n[0], -n[0] * n[1] * d, 1 - n[1] * n[1] * d, -n[1], n[0], n[1], n[2]};
  LamLoad load = Load(any, 0);
  double *nodes, *moved;
  LamResponse r;

  load.turgor = 0;
  CHECK(LamRVESolve(rve, &load, point, &r));
  CHECK(PetscMalloc2(3 * classes, &nodes, 3 * classes, &moved));
  for (int c = 0; c < classes; c++) {
    const double section[3] = {point->y[2 * c], point->y[2 * c + 1], point->z[c]};

    for (int i = 0; i < 3; i++) nodes[3 * c + i] = Q[i] * section[0] + Q[3 + i] * section[1] + Q[6 + i] * section[2];
  }
  assert_near(BodyEnergy(rve, any, nodes), r.energy, 1e-12);
  for (int k = 0; k < 9; k++) {
    double F[9], slope = 0.0;

    memcpy(F, any, sizeof(F));
    for (int side = -1; side <= 1; side += 2) { /* nodes move along, which changes nothing to first order */
      F[k] = any[k] + side * h;
      memcpy(moved, nodes, 3 * (size_t)classes * sizeof(*moved));
      for (int c = 0; c < classes && k % 3 < 2; c++)
        moved[3 * c + k / 3] += side * h * rve->mesh.class_X[2 * c + k % 3];
      slope += side * BodyEnergy(rve, F, moved) / (2.0 * h);
    }
    assert_near(slope, r.P[k], 1e-7);
  }
  for (int trial = 0; trial < 5; trial++) {
    double slope = 0.0;

    for (int side = -1; side <= 1; side += 2) {
      for (int i = 0; i < 3 * classes; i++)
        moved[i] = nodes[i] + (i < 3 ? 0.0 : side * 1e-7 * sin(1.0 + trial + i * (1.3 + trial)));
      slope += side * BodyEnergy(rve, any, moved) / 2e-7;
    }
    assert_near(slope, 0.0, 1e-6);
  }
  CHECK(PetscFree2(nodes, moved));
}

/* Frictionless contact without a lamella slides along the cells: no shear of the axis costs energy. */
TEST(ContactSlidesAlongTheCells)
{
  const LamMicrostructure micro = ContactTissue(6, 2);
  OWNED(LamRVE, LamRVEDestroy) rve = NewPrism(&micro, PETSC_FALSE);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  const LamLoad load = Load(in_plane, 0.02);
  LamResponse r;

  CHECK(LamRVESolve(rve, &load, point, &r));
  for (int k = 0; k < 4; k++) assert_near(r.tangent[9 * (6 + k / 2) + 6 + k % 2], 0.0, 1e-12);
}

/* Stress prescribed out of the plane: F31 follows. */
TEST(PrescribedStressOutOfThePlane)
{
  const LamMicrostructure micro = TiltedTissue();
  OWNED(LamRVE, LamRVEDestroy) rve = NewPrism(&micro, PETSC_FALSE);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  LamLoad load = Load((const double[9]){1, 0, 0, 0, 1, 0, 0, 0, 1.05}, 0);
  const LamStressControl control = {.given = {[0] = PETSC_TRUE, [4] = PETSC_TRUE, [6] = PETSC_TRUE, [7] = PETSC_TRUE}};
  LamResponse r;

  CHECK(LamRVESolveMixed(rve, &load, &control, point, &r));
  assert_int_equal(r.status, LAM_CONVERGED);
  for (int k = 0; k < 9; k++)
    if (control.given[k]) assert_near(r.P[k], 0.0, 1e-8);
}

/* Gibson & Ashby, Cellular Solids, ch. 4: regular hexagons of thin walls. Wall thickness 2t of two cells, edge
   l = 2a/sqrt(3): G13* = G23* = (1/sqrt 3) (2t/l) G, E3* = (2/sqrt 3) (2t/l) E. */
TEST(ThinWalledPrisms)
{
  LamMicrostructure micro = DefaultTissue();
  LamLoad load = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  const LamStressControl free = {.given = {[0] = PETSC_TRUE, [4] = PETSC_TRUE}};

  micro.wall.C4 = 0;
  micro.wall_thickness = 0.02; /* 2t/l = 0.035 */
  OWNED(LamRVE, LamRVEDestroy) rve = NewPrism(&micro, PETSC_FALSE);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  const double thin = micro.wall_thickness * sqrt(3), G = 1.0,
               E = 9.0 * micro.wall.bulk_modulus / (3.0 * micro.wall.bulk_modulus + 1.0);
  LamResponse r;

  CHECK(LamRVESolve(rve, &load, point, &r));
  assert_near(r.tangent[60] / (thin / sqrt(3) * G), 1.0, 0.02);
  assert_near(r.tangent[70] / (thin / sqrt(3) * G), 1.0, 0.02);
  load.F[8] = 1.0 + 1e-4;
  CHECK(LamRVESolveMixed(rve, &load, &free, point, &r));
  assert_near(r.P[8] / 1e-4 / (2.0 / sqrt(3) * thin * E), 1.0, 0.02);
}

/* Sealed lumens: their pressures are unknowns beside z. */
TEST(SealedAtAnyF)
{
  const LamMicrostructure micro = TiltedTissue();
  OWNED(LamRVE, LamRVEDestroy) rve = NewPrism(&micro, PETSC_TRUE);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  LamLoad load = Load((const double[9]){1, 0, 0, 0, 1, 0, 0, 0, 1}, 0);
  LamResponse r;
  double water;

  CHECK(LamRVESolve(rve, &load, point, &r));
  CHECK(LamRVEGetLumens(rve, point, &water));
  CHECK(LamRVESeal(rve, 100.0, &water));
  load = Load(any, 0);
  CheckDifferences(rve, point, &load, 1e-7);
}

/* Fibres that are dispersed and stiffen; a period of several cells; a patch, whose grips hold z. */
TEST(OtherTissueAtAnyF)
{
  LamMicrostructure micro = TiltedTissue();

  micro.wall.law = LAM_WALL_FIBRE_EXPONENTIAL;
  micro.wall.C4 = 0;
  micro.wall.k1 = 2;
  micro.wall.k2 = 3;
  micro.wall.dispersion = 0.1;
  CheckTissue(&micro, any, 0, 1e-7);
  micro = ContactTissue(4, 1);
  micro.cells[0] = 2;
  micro.cells[1] = 2;
  micro.is_patch = PETSC_TRUE;
  micro.sides = LAM_SIDES_AFFINE;
  CheckTissue(&micro, any, 0.02, 1e-7);
}

/* Fibres that are pressed beyond C4 (1 - I4) > C1 + C2 give way along the cells where the plane does not hold them:
   then the tangent has no entry that is wrong. */
TEST(FibresThatGiveWayAlongTheCells)
{
  const LamMicrostructure micro = DefaultTissue();
  OWNED(LamRVE, LamRVEDestroy) rve = NewPrism(&micro, PETSC_FALSE);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  const LamLoad load = {.F = {0.9, 0, 0, 0, 0.9, 0, 0, 0, 1}};
  LamResponse r;

  CHECK(LamRVESolve(rve, &load, point, &r));
  assert_int_equal(r.status, LAM_CONVERGED);
  for (int k = 0; k < 81; k++) {
    const int i = k / 9, j = k % 9, plane[9] = {1, 1, 0, 1, 1, 0, 0, 0, 1};

    assert_true(isfinite(r.tangent[k]) == (plane[i] && plane[j]));
  }
}

TEST(NoAxisIsNoDeformation)
{
  const LamMicrostructure micro = DefaultTissue();
  OWNED(LamRVE, LamRVEDestroy) rve = NewPrism(&micro, PETSC_FALSE);
  OWNED(LamRVEState, LamRVEStateDestroy) point = NewState(rve);
  const double bad[2][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 0}, {1, 0, 1, 0, 1, 0, 1, 0, 0.5}};

  for (int k = 0; k < 2; k++) {
    const LamLoad load = Load(bad[k], 0);
    LamResponse r;

    CHECK(LamRVESolve(rve, &load, point, &r));
    assert_int_equal(r.status, LAM_INVALID_F);
    assert_non_null(strstr(r.reason, "inside out"));
  }
}
