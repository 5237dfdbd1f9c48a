#include "contact_checks.h"

PetscErrorCode CompareContact(const char path[], PetscInt along, PetscInt through, int *count,
                              ContactReferenceCase list[CONTACT_CASES_MAX])
{
  json_t *root = json_load_file(path, 0, NULL), *cases = json_object_get(root, "cases");

  PetscFunctionBeginUser;
  *count = (int)json_array_size(cases);
  PetscCheck(*count > 0 && *count <= CONTACT_CASES_MAX, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s: %d cases", path,
             *count);
  for (int k = 0; k < *count; k++) {
    static const int component[4] = {0, 1, 3, 4};
    const json_t *entry = json_array_get(cases, (size_t)k), *F = json_object_get(entry, "F");
    LamMicrostructure micro = ContactTissue(along, through);
    ContactReferenceCase *c = &list[k];
    LamLoad load;
    double largest = 0.0;

    *c = (ContactReferenceCase){.shear = NumberAt(entry, "shear"), .turgor = NumberAt(entry, "turgor_MPa")};
    micro.wall_thickness = NumberAt(entry, "wall_thickness_over_apothem");
    micro.orientation = NumberAt(entry, "orientation_deg") * PETSC_PI / 180.0;
    micro.wall.bulk_modulus = 100.0 / TISSUE_STRESS;
    load = ContactLoad(MatrixEntry(F, 0, 0), MatrixEntry(F, 0, 1), MatrixEntry(F, 1, 0), MatrixEntry(F, 1, 1),
                       c->turgor, NumberAt(entry, "cohesion_MPa"));
    PetscCall(SolveOnce(&micro, &load, &c->response));
    for (int i = 0; i < 4; i++) {
      const double P = json_number_value(json_array_get(json_object_get(entry, "P_MPa"), (size_t)i));

      c->error = fmax(c->error, fabs(TISSUE_STRESS * c->response.P[component[i]] - P));
      largest = fmax(largest, fabs(P));
    }
    c->allowed = 0.02 * largest + 2e-5;
    c->lumen = fabs(c->response.lumen_fraction - NumberAt(entry, "lumen_fraction"));
  }
  json_decref(root);
  PetscFunctionReturn(0);
}

LamLoad PenetrationLoad(int k)
{
  const LamLoad loads[PENETRATION_LOADS] = {ContactLoad(1, 0.1, 0, 1, 0.02, 0),
                                            ContactLoad(1.02, 0.15, 0, 1, 0.01, 0.002),
                                            ContactLoad(1, 0.2, 0, 1, 0.05, 0)};

  return loads[k];
}

/* Norm of the residual at the solution of `load`, over the tolerance. */
static PetscErrorCode ContactResidual(LamRVE rve, const LamLoad *load, double *residual)
{
  double energy;
  PetscBool valid;

  PetscFunctionBeginUser;
  if (LamIsExact(rve)) PetscCall(LamContactEvaluate(rve, load, rve->y));
  PetscCall(LamAssemble(rve, load, rve->y, &energy, rve->residual, &valid));
  if (LamIsExact(rve)) LamContactAddForce(rve, rve->residual);
  *residual = valid ? LamResidualNorm(rve, rve->residual) / LamNewtonTolerance(rve) : PETSC_INFINITY;
  PetscFunctionReturn(0);
}

PetscErrorCode ComputeComplementarity(const LamMicrostructure *micro, const LamLoad *load, Complementarity *out)
{
  LamRVE rve;
  LamRVEState state;

  PetscFunctionBeginUser;
  out->product = out->tension = out->overlap = out->residual = 0.0;
  PetscCall(NewTissue(micro, &rve, &state));
  PetscCall(LamRVESolve(rve, load, state, &out->response));
  for (PetscInt h = 0; h < rve->contact->count; h++) {
    const double lambda = rve->contact->lambda[h], gap = rve->contact->gap[h];

    out->product = fmax(out->product, fabs(lambda * gap));
    out->tension = fmax(out->tension, 0.0 - lambda);
    out->overlap = fmax(out->overlap, -gap);
  }
  if (LamResponseHasFields(&out->response)) PetscCall(ContactResidual(rve, load, &out->residual));
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}

/* ---- tractions that statics alone fixes ---- */

double TractionError(const LamResponse *r, const double t[3])
{
  double error = 0.0;

  for (int k = 0; k < 3; k++) error = fmax(error, fabs(r->mean_face_traction[k] - t[k]));
  return error / (fmax(t[0], fmax(t[1], t[2])) - fmin(t[0], fmin(t[1], t[2])));
}

static double ReferenceTractionError(const LamResponse *r, double orientation)
{
  const double *F = r->load.F, J = F[0] * F[4] - F[1] * F[3];
  const double S11 = (r->P[0] * F[0] + r->P[1] * F[1]) / J, S22 = (r->P[3] * F[3] + r->P[4] * F[4]) / J;
  const double S12 = (r->P[0] * F[3] + r->P[1] * F[4]) / J;
  double t[3];

  for (int k = 0; k < 3; k++) {
    const double angle = orientation + k * PETSC_PI / 3.0, c = cos(angle), s = sin(angle);

    t[k] = 2.0 * (c * c * S11 + 2.0 * c * s * S12 + s * s * S22) - 0.5 * (S11 + S22);
  }
  return TractionError(r, t);
}

/* Solves a symmetric positive definite 3 x 3 system A x = b; b becomes x. */
static void SolveThree(double A[3][3], double b[3])
{
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 3; i++) {
      const double factor = i == k ? 0.0 : A[i][k] / A[k][k];

      for (int j = 0; j < 3; j++) A[i][j] -= factor * A[k][j];
      b[i] -= factor * b[k];
    }
  for (int k = 0; k < 3; k++) b[k] /= A[k][k];
}

/* m[k]: unit direction of the contact force on the neighbour across face k. */
static double CurrentTractionError(const LamResponse *r, double orientation, const double m[3][2],
                                   const double length[3])
{
  const double *F = r->load.F, *P = r->P, g = r->load.cohesion, V0 = 2.0 * sqrt(3.0);
  const double M[2][2] = {{(P[0] - g * F[4]) * V0, (P[1] + g * F[3]) * V0},
                          {(P[3] + g * F[1]) * V0, (P[4] - g * F[0]) * V0}};
  double L[3][2], A[3][3], t[3];

  for (int k = 0; k < 3; k++) {
    const double angle = orientation + k * PETSC_PI / 3.0;

    L[k][0] = 2.0 * cos(angle);
    L[k][1] = 2.0 * sin(angle);
  }
  for (int k = 0; k < 3; k++) { /* least squares: four equations for three forces */
    t[k] = 0.0;
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) t[k] += m[k][i] * M[i][j] * L[k][j];
    for (int l = 0; l < 3; l++)
      A[k][l] = (m[k][0] * m[l][0] + m[k][1] * m[l][1]) * (L[k][0] * L[l][0] + L[k][1] * L[l][1]);
  }
  SolveThree(A, t);
  for (int k = 0; k < 3; k++) t[k] = g + t[k] / length[k];
  return TractionError(r, t);
}

/* Directions of the contact forces of the three faces of one cell, and the lengths of the faces' chords. */
static void FaceForces(LamRVE rve, double m[3][2], double length[3])
{
  const LamContact *contact = rve->contact;

  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt *classes = &contact->classes[k * contact->chain];
    const double *start = &rve->y[2 * classes[0]], *end = &rve->y[2 * classes[contact->hats - 1]];
    double size;

    m[k][0] = m[k][1] = 0.0;
    for (PetscInt h = k * contact->hats; h < (k + 1) * contact->hats; h++)
      for (PetscInt i = 0; i < 2 * contact->hats; i++) /* the slave pushes with minus the force that it gets */
        m[k][i % 2] -= contact->lambda[h] * contact->rows[h * contact->dofs + i];
    size = hypot(m[k][0], m[k][1]);
    for (int d = 0; d < 2; d++) m[k][d] /= size;
    length[k] = hypot(end[0] - start[0], end[1] - start[1]);
  }
}

PetscErrorCode ComputeStaticTractions(double strain, double turgor, double cohesion, StaticTractions *out)
{
  LamMicrostructure micro = ContactTissue(12, 4);
  const LamLoad load = ContactLoad(1.0 + 0.4 * strain, strain, 0.2 * strain, 1.0 - 0.3 * strain, turgor, cohesion);
  LamRVE rve;
  LamRVEState state;
  double m[3][2], length[3];

  PetscFunctionBeginUser;
  micro.orientation = 0.1;
  PetscCall(NewTissue(&micro, &rve, &state));
  PetscCall(LamRVESolve(rve, &load, state, &out->response));
  FaceForces(rve, m, length);
  out->reference = ReferenceTractionError(&out->response, micro.orientation);
  out->current = CurrentTractionError(&out->response, micro.orientation, (const double(*)[2])m, length);
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}

PetscErrorCode ComputePrinciple(LamMicrostructure micro, double bulk_modulus, double difference[PRINCIPLE_LOADS],
                                int *converged)
{
  static const double F[PRINCIPLE_LOADS][4] = {{1, 0.1, 0, 1}, {1.05, 0.05, 0, 1}, {1, 0.2, 0, 1}};
  static const double s = 0.025, cohesion[PRINCIPLE_PAIRS] = {0.005, 0.015, 0.02};

  PetscFunctionBeginUser;
  micro.wall.bulk_modulus = bulk_modulus * micro.wall.C1;
  *converged = 0;
  for (int k = 0; k < PRINCIPLE_LOADS; k++) {
    double first[9];

    difference[k] = 0.0;
    for (int i = 0; i < PRINCIPLE_PAIRS; i++) {
      const LamLoad load = ContactLoad(F[k][0], F[k][1], F[k][2], F[k][3], s - cohesion[i], cohesion[i]);
      LamResponse r;
      double S[9];

      PetscCall(SolveOnce(&micro, &load, &r));
      *converged += r.status == LAM_CONVERGED;
      EffectiveStress(&r, i == 0 ? first : S);
      for (int c = 0; c < 9 && i > 0; c++)
        difference[k] = fmax(difference[k], fabs(S[c] - first[c]) * TISSUE_STRESS / s);
    }
  }
  PetscFunctionReturn(0);
}
