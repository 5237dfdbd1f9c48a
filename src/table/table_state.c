/*
  One solved state: Phi and its derivatives in the grid's coordinates, from the data of a record.
*/
#include "table.h"
#include <math.h>

static PetscReal Bilinear(const PetscReal A[16], const PetscReal a[4], const PetscReal b[4])
{
  PetscReal sum = 0;

  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) sum += 0.5 * (A[4 * i + j] + A[4 * j + i]) * a[i] * b[j];
  return sum;
}

static PetscReal Contract(const PetscReal a[4], const PetscReal b[4])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/* S : sym(a^T b), S = F^-1 P. */
static PetscReal Bending(const PetscReal F[4], const PetscReal P[4], const PetscReal a[4], const PetscReal b[4])
{
  const PetscReal J = F[0] * F[3] - F[1] * F[2];
  const PetscReal S[4] = {(F[3] * P[0] - F[1] * P[2]) / J, (F[3] * P[1] - F[1] * P[3]) / J,
                          (F[0] * P[2] - F[2] * P[0]) / J, (F[0] * P[3] - F[2] * P[1]) / J};
  const PetscReal t[4] = {a[0] * b[0] + a[2] * b[2], a[0] * b[1] + a[2] * b[3], a[1] * b[0] + a[3] * b[2],
                          a[1] * b[1] + a[3] * b[3]};

  return S[0] * t[0] + S[3] * t[3] + 0.5 * (S[1] + S[2]) * 0.5 * (t[1] + t[2]) * 2;
}

static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};

/* Psi + factor J, J in the plane, and its derivatives in x. */
static void StrainJet(const struct LamGrid_s *grid, const LamNodeData *r, PetscReal factor, LamJet *jet,
                      PetscReal dF[3][4], PetscReal J_x[3])
{
  const LamLatticeState at = LamLatticeStateOf(&grid->axes, r->F);
  PetscReal J_xx[6], J;

  J = LamLatticeVolume(&grid->axes, &at, J_x, J_xx);
  LamLatticeVariations(&grid->axes, &at, r->F, dF);
  jet->value = r->energy + factor * J;
  for (int k = 0; k < 3; k++) jet->gradient[k] = Contract(r->P, dF[k]) + factor * J_x[k];
  for (int m = 0; m < 6; m++) {
    const PetscReal *a = dF[row[m]], *b = dF[column[m]];

    jet->hessian[m] = Bilinear(r->tangent, a, b) - Bending(r->F, r->P, a, b) + factor * J_xx[m] +
                      (row[m] == column[m] ? 2 * Contract(r->P, a) : 0);
  }
}

static const int entry[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};

/* Change of variables from (x, s) to (y, s), x = y + a(s), then from s to tau. */
static void MoveAlong(const struct LamGrid_s *grid, PetscReal s, const PetscReal a[6], PetscReal phi_s,
                      PetscReal phi_ss, const PetscReal gradient_s[3], LamTableState *state)
{
  const PetscReal rate = LamGridSuctionRate(grid, s);

  for (int k = 0; k < 3; k++) {
    PetscReal moved = gradient_s[k];

    for (int l = 0; l < 3; l++) {
      moved += a[1] * state->phi.hessian[entry[k][l]];
      phi_ss += a[1] * a[1] * state->phi.hessian[entry[k][l]];
    }
    phi_s += a[1] * state->phi.gradient[k];
    state->turgor_tau += a[1] * state->turgor_gradient[k];
    phi_ss += 2 * a[1] * gradient_s[k] + a[2] * state->phi.gradient[k];
    state->gradient_tau[k] = moved * rate;
  }
  state->tau1 = phi_s * rate;
  state->tau2 = phi_ss * rate * rate + phi_s * rate;
  state->tau2_minus = state->tau2;
  state->turgor_tau *= rate;
}

/*
  Derivatives in z = ln F33 at fixed y = x - a(s, z); phi_s, gradient_s: in s, at fixed x; state: in y.
    at fixed x: Phi_z = F33 (P33 + c J), c = p or -g, and so on, with the volume F33 J.
*/
static void FillAxial(const struct LamGrid_s *grid, const LamNodeData *r, PetscReal F33, const PetscReal a[6],
                      const PetscReal gradient_s[3], PetscReal dF[3][4], const PetscReal J_x[3],
                      const LamTableState *state, LamTableAxial *axial)
{
  const PetscReal J = r->F[0] * r->F[3] - r->F[1] * r->F[2], c = grid->contact ? -r->cohesion : r->turgor;
  const PetscReal along_s = a[1], along_z = a[3];

  axial->first = F33 * (r->P33 + c * J);
  axial->second = F33 * F33 * r->P33_F33 + axial->first;
  axial->turgor = F33 * (r->P33_turgor - (grid->contact ? r->P33_cohesion : 0) + J);
  axial->mixed = F33 * (r->P33_turgor + (grid->contact ? 0 : J)) +
                 a[5] * (state->phi.gradient[0] + state->phi.gradient[1] + state->phi.gradient[2]);
  for (int k = 0; k < 3; k++) axial->gradient[k] = F33 * (Contract(r->P33_F, dF[k]) + c * J_x[k]);
  for (int k = 0; k < 3; k++) {
    axial->second += 2 * along_z * axial->gradient[k] + a[4] * state->phi.gradient[k];
    axial->mixed += along_z * gradient_s[k] + along_s * axial->gradient[k];
    axial->turgor += along_z * state->turgor_gradient[k];
    axial->first += along_z * state->phi.gradient[k];
    for (int l = 0; l < 3; l++) {
      axial->second += along_z * along_z * state->phi.hessian[entry[k][l]];
      axial->mixed += along_s * along_z * state->phi.hessian[entry[k][l]];
    }
  }
  for (int k = 0; k < 3; k++)
    for (int l = 0; l < 3; l++) axial->gradient[k] += along_z * state->phi.hessian[entry[k][l]];
  axial->second_minus = axial->second;
  axial->mixed *= LamGridSuctionRate(grid, LamGridSuctionOf(grid, r->turgor, r->cohesion));
}

/* Phi of bonded tissue: Psi + p J; of contact: Psi - g J = Psi + p J - s J. z: that of the place. */
static void FillState(const struct LamGrid_s *grid, const LamNodeData *r, int z, LamTableState *state,
                      LamTableAxial *axial)
{
  const PetscReal F33 = LamGridF33(grid, z), s = LamGridSuctionOf(grid, r->turgor, r->cohesion);
  const PetscReal factor = F33 * (grid->contact ? -r->cohesion : r->turgor);
  const PetscReal J = F33 * (r->F[0] * r->F[3] - r->F[1] * r->F[2]);
  PetscReal dF[3][4], J_x[3], along[3], at_rest[4], a[6] = {0};

  if (grid->contact) LamGridFreeStrain(grid, s, z - 1, a);
  StrainJet(grid, r, factor, &state->phi, dF, J_x);
  for (int k = 0; k < 3; k++) state->minus[k] = state->phi.hessian[k];
  /* dPhi/dp at fixed s: with contact, cohesion decreases by as much */
  for (int i = 0; i < 4; i++) at_rest[i] = r->P_turgor[i] - (grid->contact ? r->P_cohesion[i] : 0);
  state->turgor1 = r->energy_turgor + J - (grid->contact ? r->energy_cohesion : 0);
  state->turgor2 = r->energy_turgor2;
  if (grid->contact) state->turgor2 += r->energy_cohesion2 - 2 * r->energy_turgor_cohesion;
  for (int k = 0; k < 3; k++) {
    state->turgor_gradient[k] = Contract(at_rest, dF[k]) + F33 * J_x[k];
    along[k] = Contract(r->P_turgor, dF[k]) + (grid->contact ? 0 : F33 * J_x[k]);
  }
  if (axial) FillAxial(grid, r, F33, a, along, dF, J_x, state, axial);
  if (!LamGridHasColumns(grid)) return;
  /* in s, at fixed x; bonded tissue does not depend on cohesion, whose derivatives may be unknown */
  if (grid->contact) state->turgor_tau = r->energy_turgor2 - r->energy_turgor_cohesion;
  MoveAlong(grid, s, a, r->energy_turgor + (grid->contact ? 0 : J), r->energy_turgor2, along, state);
}

static PetscBool IsFinite(const LamTableState *s)
{
  PetscReal sum = s->phi.value + s->tau1 + s->tau2 + s->turgor1 + s->turgor2 + s->turgor_tau;

  for (int k = 0; k < 3; k++) sum += s->phi.gradient[k] + s->gradient_tau[k] + s->turgor_gradient[k];
  for (int m = 0; m < 6; m++) sum += s->phi.hessian[m];
  return (PetscBool)isfinite(sum);
}

/*
  Whether the walls are on another branch than at neighbouring strains. Cells that barely touch leave saddles of another
  kind, by rolling off each other, and end on the only branch that exists.
*/
#define BARELY_TOUCHING 0.75 /* share of the interface without contact */
static PetscBool HasBuckled(const LamNodeData *r)
{
  return (PetscBool)(r->branch > 0 && !(r->debonded_fraction > BARELY_TOUCHING));
}

static PetscBool IsFiniteAxial(const LamTableAxial *axial)
{
  const PetscReal *g = axial->gradient;

  return (PetscBool)isfinite(axial->first + axial->second + axial->mixed + axial->turgor + g[0] + g[1] + g[2]);
}

/* A solve has the symmetry of its state only to its tolerance: averages over the axes with equal coordinates. */
static void SymmetriseTriple(const int i[3], PetscReal triple[3])
{
  const PetscReal old[3] = {triple[0], triple[1], triple[2]};

  for (int k = 0; k < 3; k++) {
    PetscReal sum = 0;
    int count = 0;

    for (int l = 0; l < 3; l++)
      if (i[l] == i[k]) {
        sum += old[l];
        count++;
      }
    triple[k] = sum / count;
  }
}

static void Symmetrise(const int i[3], LamTableState *state, LamTableAxial *axial)
{
  PetscReal *const triples[] = {state->phi.gradient, state->phi.hessian,  state->phi.hessian + 3,
                                state->minus,        state->gradient_tau, state->turgor_gradient};

  for (size_t n = 0; n < PETSC_STATIC_ARRAY_LENGTH(triples); n++) SymmetriseTriple(i, triples[n]);
  if (axial) SymmetriseTriple(i, axial->gradient);
}

void LamTableMakeState(const struct LamGrid_s *grid, const LamNodeData *r, PetscInt data, LamTableState *state,
                       LamTableAxial *axial)
{
  const LamNodePlace place = LamNodePlaceOf(r->key);
  const LamTableState nothing = {.j = place.j, .z = place.z, .data = data};

  *state = nothing;
  if (axial) *axial = (LamTableAxial){0};
  if (r->status != LAM_CONVERGED && r->status != LAM_UNSTABLE) return;
  FillState(grid, r, place.z, state, axial);
  if (grid->symmetric) Symmetrise(place.i, state, axial);
  state->has_data = (PetscBool)(IsFinite(state) && (!axial || IsFiniteAxial(axial)));
  state->good = (PetscBool)(state->has_data && r->status == LAM_CONVERGED && r->stable && !HasBuckled(r));
  if (state->has_data) return;
  *state = nothing;
  if (axial) *axial = (LamTableAxial){0};
}
