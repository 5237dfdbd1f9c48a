#include "reference_values.h"

double MatrixEntry(const json_t *matrix, int i, int j)
{
  return json_number_value(json_array_get(json_array_get(matrix, (size_t)i), (size_t)j));
}

double NumberAt(const json_t *object, const char key[])
{
  return json_number_value(json_object_get(object, key));
}

/* Largest |value - reference| over the largest |reference|, n x n; value(i, j) = values[at[i] * stride + at[j]]. */
static double MatrixError(const json_t *reference, int n, const int at[], const double values[], int stride)
{
  double error = 0.0, largest = 0.0;

  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      const double r = MatrixEntry(reference, i, j), v = TISSUE_STRESS * values[at[i] * stride + at[j]];

      error = PetscMax(error, PetscAbsReal(v - r));
      largest = PetscMax(largest, PetscAbsReal(r));
    }
  return error / largest;
}

static PetscErrorCode CompareCase(const json_t *reference, ReferenceError *error)
{
  static const int plane[2] = {0, 1}, components[4] = {0, 1, 3, 4};
  const json_t *mesh = json_object_get(reference, "mesh"), *F = json_object_get(reference, "F");
  const LamLoad load = PlaneLoad(MatrixEntry(F, 0, 0), MatrixEntry(F, 0, 1), MatrixEntry(F, 1, 0), MatrixEntry(F, 1, 1),
                                 NumberAt(reference, "turgor_MPa") / TISSUE_STRESS);
  LamMicrostructure micro = DefaultTissue();
  LamResponse response;

  PetscFunctionBeginUser;
  micro.wall_thickness = NumberAt(reference, "wall_thickness_over_apothem");
  micro.orientation = NumberAt(reference, "orientation_deg") * PETSC_PI / 180.0;
  micro.wall.bulk_modulus = 1000.0 / TISSUE_STRESS;
  micro.along = error->along = (int)NumberAt(mesh, "along");
  micro.through = error->through = (int)NumberAt(mesh, "through");
  PetscCall(SolveOnce(&micro, &load, &response));
  PetscCall(PetscStrncpy(error->name, json_string_value(json_object_get(reference, "name")), sizeof(error->name)));
  error->energy = PetscAbsReal(TISSUE_STRESS * response.energy / NumberAt(reference, "energy_MPa") - 1.0);
  error->lumen = PetscAbsReal(response.lumen_fraction / NumberAt(reference, "lumen_fraction") - 1.0);
  error->stress = MatrixError(json_object_get(reference, "P_MPa"), 2, plane, response.P, 3);
  error->tangent = MatrixError(json_object_get(reference, "tangent_MPa"), 4, components, response.tangent, 9);
  PetscFunctionReturn(0);
}

PetscErrorCode CompareWithReference(const char path[], int *count, ReferenceError errors[])
{
  json_t *root = json_load_file(path, 0, NULL), *cases = json_object_get(root, "cases");

  PetscFunctionBeginUser;
  *count = (int)json_array_size(cases);
  PetscCheck(*count > 0 && *count <= REFERENCE_CASES_MAX, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s: %d cases", path,
             *count);
  for (int k = 0; k < *count; k++) PetscCall(CompareCase(json_array_get(cases, (size_t)k), &errors[k]));
  json_decref(root);
  PetscFunctionReturn(0);
}

PetscErrorCode CompareWithOthers(const char path[], double error[OTHERS_CASES])
{
  json_t *root = json_load_file(path, 0, NULL);
  const json_t *cases = json_object_get(json_object_get(root, "finite_element_program_of_others"), "cases");
  LamMicrostructure micro = DefaultTissue();

  PetscFunctionBeginUser;
  PetscCheck(json_array_size(cases) == OTHERS_CASES, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s: unexpected cases",
             path);
  micro.orientation = PETSC_PI / 6.0;
  micro.wall.bulk_modulus = 100.0 / TISSUE_STRESS;
  micro.along = 20;
  micro.through = 6;
  for (int k = 0; k < OTHERS_CASES; k++) {
    const json_t *entry = json_array_get(cases, (size_t)k), *G = json_object_get(entry, "F");
    const json_t *cauchy = json_object_get(entry, "cauchy_MPa");
    const LamLoad load =
        PlaneLoad(MatrixEntry(G, 0, 0), MatrixEntry(G, 0, 1), MatrixEntry(G, 1, 0), MatrixEntry(G, 1, 1), 0);
    const double *F = load.F, J = F[0] * F[4] - F[1] * F[3];
    LamResponse r;
    double sigma[3];

    PetscCall(SolveOnce(&micro, &load, &r));
    sigma[0] = TISSUE_STRESS * (r.P[0] * F[0] + r.P[1] * F[1]) / J;
    sigma[1] = TISSUE_STRESS * (r.P[3] * F[3] + r.P[4] * F[4]) / J;
    sigma[2] = TISSUE_STRESS * (r.P[0] * F[3] + r.P[1] * F[4]) / J;
    error[k] = 0.0;
    for (int c = 0; c < 3; c++) {
      const double reference = json_number_value(json_array_get(cauchy, (size_t)c));

      if (reference != 0.0) error[k] = PetscMax(error[k], PetscAbsReal(sigma[c] / reference - 1.0));
    }
  }
  json_decref(root);
  PetscFunctionReturn(0);
}
