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

/* Psi + factor J and its derivatives in x. */
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

/* Change of variables from (x, s) to (y, s), x = y + a(s), then from s to tau. */
static void MoveAlong(const struct LamGrid_s *grid, PetscReal s, PetscReal phi_s, PetscReal phi_ss,
                      const PetscReal gradient_s[3], LamTableState *state)
{
  static const int entry[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
  const PetscReal rate = s + grid->suction_scale; /* ds/dtau = d2s/dtau2 */
  PetscReal a[3] = {0};

  if (grid->free.n) LamFreeCellStrain(&grid->free, s, a);
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

/* Bonded: Psi + p J; contact: Psi - g J = Psi + p J - s J. */
static void FillState(const struct LamGrid_s *grid, const LamNodeData *r, LamTableState *state)
{
  const PetscReal factor = grid->contact ? -r->cohesion : r->turgor, J = r->F[0] * r->F[3] - r->F[1] * r->F[2];
  PetscReal dF[3][4], J_x[3], along[3], at_rest[4];

  StrainJet(grid, r, factor, &state->phi, dF, J_x);
  for (int k = 0; k < 3; k++) state->minus[k] = state->phi.hessian[k];
  /* dPhi/dp at fixed s: with contact, cohesion decreases by as much */
  for (int i = 0; i < 4; i++) at_rest[i] = r->P_turgor[i] - (grid->contact ? r->P_cohesion[i] : 0);
  state->turgor1 = r->energy_turgor + J - (grid->contact ? r->energy_cohesion : 0);
  state->turgor2 = r->energy_turgor2;
  if (grid->contact) state->turgor2 += r->energy_cohesion2 - 2 * r->energy_turgor_cohesion;
  for (int k = 0; k < 3; k++) {
    state->turgor_gradient[k] = Contract(at_rest, dF[k]) + J_x[k];
    along[k] = Contract(r->P_turgor, dF[k]);
  }
  if (!grid->contact) return; /* bonded: no dependence on cohesion, whose derivatives may be unknown */
  state->turgor_tau = r->energy_turgor2 - r->energy_turgor_cohesion; /* in s, at fixed x */
  MoveAlong(grid, r->turgor + r->cohesion, r->energy_turgor, r->energy_turgor2, along, state);
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

/* A solve has the symmetry of its state only to its tolerance: averages over the axes with equal coordinates. */
static void Symmetrise(const int i[3], LamTableState *state)
{
  PetscReal *const triples[] = {state->phi.gradient, state->phi.hessian,  state->phi.hessian + 3,
                                state->minus,        state->gradient_tau, state->turgor_gradient};

  for (size_t n = 0; n < PETSC_STATIC_ARRAY_LENGTH(triples); n++) {
    const PetscReal old[3] = {triples[n][0], triples[n][1], triples[n][2]};

    for (int k = 0; k < 3; k++) {
      PetscReal sum = 0;
      int count = 0;

      for (int l = 0; l < 3; l++)
        if (i[l] == i[k]) {
          sum += old[l];
          count++;
        }
      triples[n][k] = sum / count;
    }
  }
}

void LamTableMakeState(const struct LamGrid_s *grid, const LamNodeData *r, PetscInt data, LamTableState *state)
{
  const LamNodePlace place = LamNodePlaceOf(r->key);
  const int j = place.j;

  *state = (LamTableState){.j = j, .data = data};
  if (r->status != LAM_CONVERGED && r->status != LAM_UNSTABLE) return;
  FillState(grid, r, state);
  if (grid->symmetric) Symmetrise(place.i, state);
  state->has_data = IsFinite(state);
  state->good = (PetscBool)(state->has_data && r->status == LAM_CONVERGED && r->stable && !HasBuckled(r));
  if (!state->has_data) *state = (LamTableState){.j = j, .data = data};
}
