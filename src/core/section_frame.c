/*
  The frame of the section (docs/theory/homogenisation.md, Out of the section).

  As Psi(QF) = Psi(F), F is turned until F_13 = F_23 = 0; there components 13 and 23 follow from objectivity, P F^T = F
  P^T and its rate.
*/
#include "section_frame.h"
#include <math.h>

/* Q with the third axis along F e3: the least rotation that brings it there. */
static void FindFrame(const PetscReal F[9], PetscReal Q[9])
{
  const PetscReal length = PetscSqrtReal(F[2] * F[2] + F[5] * F[5] + F[8] * F[8]);
  const PetscReal a = F[2] / length, b = F[5] / length, c = F[8] / length;
  const PetscReal d = c > -1.0 ? 1.0 / (1.0 + c) : 0.0;
  const PetscReal turned[9] = {1.0 - a * a * d, -a * b * d, -a, -a * b * d, 1.0 - b * b * d, -b, a, b, c};
  const PetscReal over[9] = {1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0};

  for (PetscInt k = 0; k < 9; k++) Q[k] = c > -1.0 ? turned[k] : over[k];
}

/* Q T, or Q^T T */
static void Turn(const PetscReal Q[9], PetscBool back, PetscReal T[9])
{
  PetscReal product[9];

  for (PetscInt i = 0; i < 3; i++)
    for (PetscInt J = 0; J < 3; J++) {
      product[3 * i + J] = 0.0;
      for (PetscInt k = 0; k < 3; k++) product[3 * i + J] += (back ? Q[3 * k + i] : Q[3 * i + k]) * T[3 * k + J];
    }
  for (PetscInt k = 0; k < 9; k++) T[k] = product[k];
}

/* Also an F that is refused later, which leaves no axis. */
static PetscBool IsSection(const PetscReal F[9])
{
  return (PetscBool)(F[2] == 0.0 && F[5] == 0.0 && F[8] >= 0.0);
}

LamLoad LamSectionLoad(const LamLoad *load)
{
  LamLoad section = *load;
  PetscReal Q[9];

  if (IsSection(load->F)) return section;
  FindFrame(load->F, Q);
  Turn(Q, PETSC_FALSE, section.F);
  section.F[2] = section.F[5] = 0.0;
  return section;
}

void LamSectionTurnBack(const LamLoad *load, LamResponse *response)
{
  PetscReal Q[9], column[9];

  response->load = *load;
  if (IsSection(load->F)) return;
  FindFrame(load->F, Q);
  Turn(Q, PETSC_TRUE, response->P);
  Turn(Q, PETSC_TRUE, response->P_turgor);
  Turn(Q, PETSC_TRUE, response->P_cohesion);
  for (PetscInt r = 0; r < 9; r++) Turn(Q, PETSC_TRUE, &response->tangent[9 * r]); /* of row r by F */
  for (PetscInt c = 0; c < 9; c++) {
    for (PetscInt r = 0; r < 9; r++) column[r] = response->tangent[9 * r + c];
    Turn(Q, PETSC_TRUE, column);
    for (PetscInt r = 0; r < 9; r++) response->tangent[9 * r + c] = column[r];
  }
  for (PetscInt i = 0; i < 3; i++) column[i] = response->localisation_mode[i];
  for (PetscInt i = 0; i < 3; i++)
    response->localisation_mode[i] = Q[i] * column[0] + Q[3 + i] * column[1] + Q[6 + i] * column[2];
}

void LamSectionCompleteStress(const PetscReal F[9], PetscReal P[9])
{
  for (PetscInt a = 0; a < 2; a++) {
    P[3 * a + 2] = 0.0;
    for (PetscInt b = 0; b < 2; b++) P[3 * a + 2] += (P[6 + b] * F[3 * a + b] - P[3 * a + b] * F[6 + b]) / F[8];
  }
}

/* dP [9] for a change dF without components 13 and 23, from the rows of the tangent for all others. */
static void Change(const PetscReal F[9], const PetscReal P[9], const PetscReal A[81], const PetscReal dF[9],
                   PetscReal dP[9])
{
  for (PetscInt r = 0; r < 9; r++) {
    dP[r] = 0.0;
    for (PetscInt c = 0; c < 9 && r != 2 && r != 5; c++)
      if (c != 2 && c != 5) dP[r] += A[9 * r + c] * dF[c];
  }
  for (PetscInt a = 0; a < 2; a++) {
    PetscReal sum = -P[3 * a + 2] * dF[8];

    for (PetscInt b = 0; b < 2; b++)
      sum += dP[6 + b] * F[3 * a + b] + P[6 + b] * dF[3 * a + b] - dP[3 * a + b] * F[6 + b] - P[3 * a + b] * dF[6 + b];
    dP[3 * a + 2] = sum / F[8];
  }
}

void LamSectionComplete(const PetscReal F[9], PetscReal P[9], PetscReal A[81])
{
  PetscReal full[81];

  LamSectionCompleteStress(F, P);
  for (PetscInt c = 0; c < 9; c++) {
    const PetscInt a = c / 3;
    PetscReal dF[9] = {0.0}, dP[9];

    dF[c] = 1.0;
    if (c == 2 || c == 5) { /* dF = W F + rest, W skew, W_a3 = 1/F33 */
      dF[c] = 0.0;
      for (PetscInt b = 0; b < 2; b++) {
        dF[3 * a + b] = -F[6 + b] / F[8];
        dF[6 + b] = F[3 * a + b] / F[8];
      }
    }
    Change(F, P, A, dF, dP);
    if (c == 2 || c == 5)
      for (PetscInt j = 0; j < 3; j++) { /* W P */
        dP[3 * a + j] += P[6 + j] / F[8];
        dP[6 + j] -= P[3 * a + j] / F[8];
      }
    for (PetscInt r = 0; r < 9; r++) full[9 * r + c] = dP[r];
  }
  for (PetscInt k = 0; k < 81; k++) A[k] = full[k];
}
