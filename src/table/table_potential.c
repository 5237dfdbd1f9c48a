/*
  From the sum of a query to its response: from (y, tau, z) to (x, s, z), then to F, p and g.
*/
#include "table_place.h"

/* Psi and its derivatives in x, p and g, in the order of the lattice directions. */
typedef struct {
  LamJet psi, turgor; /* turgor: derivative in d at fixed s; value and gradient */
  PetscReal s1, s2, gradient_s[3], turgor_s;
  PetscReal z1, z2, gradient_z[3], turgor_z, s_z; /* z = ln F33 */
} Potential;

/* From (y, tau) in sorted axes to (x, s). */
static void Unsort(LamTable table, const LamTablePlace *place, Potential *p)
{
  const LamTableSum *sum = &place->sum;
  const int *axis = place->point.axis;

  p->psi.value = sum->phi.value;
  p->turgor.value = sum->turgor1.value;
  for (int k = 0; k < 3; k++) {
    p->psi.gradient[axis[k]] = sum->phi.gradient[k];
    p->psi.hessian[axis[k]] = sum->phi.hessian[k];
    p->psi.hessian[3 + axis[k]] = sum->phi.hessian[3 + k];
    p->turgor.gradient[axis[k]] = sum->turgor1.gradient[k];
    p->gradient_s[axis[k]] = sum->gradient_tau[k];
    p->gradient_z[axis[k]] = sum->gradient_z[k];
  }
  p->z1 = sum->z1;
  p->z2 = sum->z2;
  p->turgor_z = sum->turgor1_z;
  p->s_z = sum->tau_z;
  p->s1 = sum->tau1;
  p->s2 = sum->tau2;
  p->turgor_s = sum->turgor1_tau;
}

static const int entry[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};

/* x = y + a(s, z): at fixed x, y moves by -a_z dz. gradient_s, s_z: still at fixed y, but in s. */
static void MoveAlongZ(const LamTablePlace *place, Potential *p)
{
  const PetscReal *a = place->free_strain;

  for (int k = 0; k < 3; k++) {
    p->z2 -= 2 * a[3] * p->gradient_z[k] + a[4] * p->psi.gradient[k];
    p->s_z -= a[3] * p->gradient_s[k] + a[1] * p->gradient_z[k] + a[5] * p->psi.gradient[k];
    p->z1 -= a[3] * p->psi.gradient[k];
    p->turgor_z -= a[3] * p->turgor.gradient[k];
    for (int l = 0; l < 3; l++) {
      p->z2 += a[3] * a[3] * p->psi.hessian[entry[k][l]];
      p->s_z += a[1] * a[3] * p->psi.hessian[entry[k][l]];
    }
  }
  for (int k = 0; k < 3; k++)
    for (int l = 0; l < 3; l++) p->gradient_z[k] -= a[3] * p->psi.hessian[entry[k][l]];
}

static void TauToSuction(LamTable table, const LamTablePlace *place, Potential *p)
{
  const PetscReal rate = 1 / LamGridSuctionRate(table->grid, place->point.s), *a = place->free_strain; /* dtau/ds */

  p->s2 = p->s2 * rate * rate - p->s1 * rate * rate;
  p->s1 *= rate;
  p->turgor_s *= rate;
  p->s_z *= rate;
  for (int k = 0; k < 3; k++) p->gradient_s[k] *= rate;
  if (table->grid->z_cells) MoveAlongZ(place, p);
  /* x = y + a(s): at fixed x, y moves by -a' ds */
  for (int k = 0; k < 3; k++) {
    p->s2 -= 2 * a[1] * p->gradient_s[k] + a[2] * p->psi.gradient[k];
    p->s1 -= a[1] * p->psi.gradient[k];
    p->turgor_s -= a[1] * p->turgor.gradient[k];
    for (int l = 0; l < 3; l++) p->s2 += a[1] * a[1] * p->psi.hessian[entry[k][l]];
  }
  for (int k = 0; k < 3; k++)
    for (int l = 0; l < 3; l++) p->gradient_s[k] -= a[1] * p->psi.hessian[entry[k][l]];
}

static void PlaneToFull(const PetscReal a[4], PetscReal full[9])
{
  for (int i = 0; i < 9; i++) full[i] = 0; /* plane strain has no out-of-plane shear stress */
  for (int i = 0; i < 4; i++) full[3 * (i / 2) + i % 2] = a[i];
}

/* dP/dp and dP/dg in the plane, and the other derivatives with respect to p and g; J, J_x: in the plane. */
static void FillPressures(LamTable table, const LamTablePlace *place, const Potential *p, PetscReal plane_J,
                          const PetscReal J_x[3], LamResponse *r)
{
  const PetscBool contact = table->grid->contact, columns = LamGridHasColumns(table->grid);
  const PetscReal F33 = place->F33, J = F33 * plane_J;
  const PetscReal p1 = p->turgor.value, p2 = place->sum.turgor2;
  PetscReal g[3], P[4];

  /* contact: s = p + g, d = g0 - g; Psi depends on p through s, on g through both. Bonded: on p through s or d. */
  r->energy_turgor = (columns ? p->s1 : p1) - (contact ? 0 : J);
  r->energy_turgor2 = columns ? p->s2 : p2;
  r->energy_cohesion = contact ? p->s1 - p1 + J : 0;
  r->energy_cohesion2 = contact ? p->s2 + p2 - 2 * p->turgor_s : 0;
  r->energy_turgor_cohesion = contact ? p->s2 - p->turgor_s : 0;
  for (int k = 0; k < 3; k++)
    g[k] = (columns ? p->gradient_s[k] : p->turgor.gradient[k]) - (contact ? 0 : F33 * J_x[k]);
  LamLatticeStress(&table->grid->axes, &place->lattice, g, P);
  PlaneToFull(P, r->P_turgor);
  for (int k = 0; k < 3; k++) g[k] = contact ? p->gradient_s[k] - p->turgor.gradient[k] + F33 * J_x[k] : 0;
  LamLatticeStress(&table->grid->axes, &place->lattice, g, P);
  PlaneToFull(P, r->P_cohesion);
}

/* P33, its row and column of the tangent, and its derivatives in p and g; J, J_x: in the plane. */
static void FillAxial(LamTable table, const LamTablePlace *place, const Potential *p, PetscReal c, PetscReal J,
                      const PetscReal J_x[3], LamResponse *r)
{
  const PetscBool contact = table->grid->contact, columns = LamGridHasColumns(table->grid);
  const PetscReal F33 = place->F33;
  PetscReal g[3], row[4];

  r->P[8] = p->z1 / F33 + c * J;
  r->P_turgor[8] = (columns ? p->s_z : p->turgor_z) / F33 - (contact ? 0 : J);
  r->P_cohesion[8] = contact ? (p->s_z - p->turgor_z) / F33 + J : 0;
  for (int k = 0; k < 3; k++) g[k] = p->gradient_z[k] / F33 + c * J_x[k];
  LamLatticeStress(&table->grid->axes, &place->lattice, g, row);
  for (int i = 0; i < 4; i++) {
    const int at = 3 * (i / 2) + i % 2;

    r->tangent[72 + at] = r->tangent[9 * at + 8] = row[i];
  }
  r->tangent[80] = (p->z2 - p->z1) / (F33 * F33);
}

void LamTableFillPotential(LamTable table, const LamTablePlace *place, LamResponse *r)
{
  const LamLoad *load = &r->load;
  const PetscBool contact = table->grid->contact;
  const PetscReal pressure = contact ? load->cohesion : -load->turgor, c = place->F33 * pressure;
  PetscReal J, J_x[3], J_xx[6], P[4], A[4][4];
  Potential potential, *p = &potential;

  Unsort(table, place, p);
  if (LamGridHasColumns(table->grid)) TauToSuction(table, place, p);
  J = LamLatticeVolume(&table->grid->axes, &place->lattice, J_x, J_xx);
  FillPressures(table, place, p, J, J_x, r);
  r->energy = p->psi.value + c * J;
  for (int k = 0; k < 3; k++) p->psi.gradient[k] += c * J_x[k];
  for (int m = 0; m < 6; m++) p->psi.hessian[m] += c * J_xx[m];
  LamLatticeStress(&table->grid->axes, &place->lattice, p->psi.gradient, P);
  LamLatticeTangent(&table->grid->axes, &place->lattice, p->psi.gradient, p->psi.hessian, A);
  PlaneToFull(P, r->P);
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) r->tangent[9 * (3 * (a / 2) + a % 2) + 3 * (b / 2) + b % 2] = A[a][b];
  if (table->grid->z_cells) FillAxial(table, place, p, pressure, J, J_x, r);
}
