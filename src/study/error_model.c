/*
  The mesh of a scene. The cheapest one whose error of P stays below the prescribed accuracy for the scene's walls and
  loads, by the model below. A body of cells in contact depends on their tangent, which is uneven because contact moves
  from node to node: 4-8 % with 6 elements along a face, 2 % with 12, below 1 % with BODY_ALONG
  (docs/results/performance.md, FE²).
*/
#include "error_model.h"
#include "wall_law.h"
#include <jansson.h>
#include <math.h>
#include <string.h>

/* error = 10^constant along^a through^b thickness^c fibres^d strain^e; 90 % of the states are below 10^margin error. */
typedef struct {
  double constant, along, through, thickness, fibres, strain, margin;
  PetscReal grading; /* of the meshes of the fit */
} Fit;

static const Fit Fits[] = {
    [LAM_INTERFACE_BONDED] = {-1.20, -2.05, -0.88, 0.68, 1.24, 0.55, 0.50, 0.7},
    [LAM_INTERFACE_CONTACT] = {-0.85, -0.96, -0.69, 0.57, 0.16, 0.51, 0.45, 0.0},
};

/* By increasing cost. `along` is even, so that a mesh of half as many elements gives an error estimate. */
static const struct {
  PetscInt along, through;
} Meshes[] = {{4, 1}, {4, 2}, {6, 2}, {8, 2}, {10, 2}, {12, 2}, {8, 4}, {12, 4}, {16, 4}, {20, 6}, {28, 8}};
enum { MESH_COUNT = PETSC_STATIC_ARRAY_LENGTH(Meshes) };

#define BODY_ALONG 16
#define BODY_ACCURACY 0.01 /* not applied if the prescribed accuracy is coarser */
#define USUAL_STRAIN 0.2   /* for bodies, whose strains are not known in advance */
#define LEAST_STRAIN 0.02  /* smallest strain of the fit */
#define LEAST_FIBRES 1.0

PetscReal LamStrainSize(const PetscReal F[9])
{
  /* eigenvalues of C = F^T F are the squares of the principal stretches */
  const PetscReal C11 = F[0] * F[0] + F[3] * F[3], C22 = F[1] * F[1] + F[4] * F[4], C12 = F[0] * F[1] + F[3] * F[4];
  const PetscReal mean = 0.5 * (C11 + C22), radius = hypot(0.5 * (C11 - C22), C12);

  return hypot(0.5 * log(mean + radius), 0.5 * log(mean - radius));
}

PetscReal LamErrorOfMesh(const LamErrorCase *c, PetscInt along, PetscInt through)
{
  const Fit *fit = &Fits[c->interface];
  const double strain = fmax(c->strain, LEAST_STRAIN), fibres = fmax(c->fibres, LEAST_FIBRES);

  return pow(10.0, fit->constant + fit->margin) * pow((double)along, fit->along) * pow((double)through, fit->through) *
         pow(c->thickness, fit->thickness) * pow(fibres, fit->fibres) * pow(strain, fit->strain);
}

void LamCheapestMesh(const LamErrorCase *c, PetscReal accuracy, PetscInt *along, PetscInt *through, PetscReal *grading)
{
  int m = 0;

  while (m < MESH_COUNT - 1 && LamErrorOfMesh(c, Meshes[m].along, Meshes[m].through) > accuracy) m++;
  *along = Meshes[m].along;
  *through = Meshes[m].through;
  *grading = Fits[c->interface].grading;
}

/* ---- measured errors ---- */

static PetscErrorCode CheckModel(const char path[], json_t *root, const json_error_t *error, const char hash[],
                                 json_t **list)
{
  const char *tissue = "";
  int format = 0;

  PetscFunctionBeginUser;
  PetscCheck(root, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: cannot be read: %s; `lamella tradeoff SCENE -o DIR` "
             "writes DIR/model.json",
             path, error->text);
  PetscCheck(!json_unpack(root, "{s:i, s:s, s:o}", "format", &format, "tissue", &tissue, "meshes", list) &&
                 json_is_array(*list) && format == 1,
             PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: is no file of measured meshes that this version knows", path);
  PetscCheck(!strcmp(tissue, hash), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: was measured for another tissue than the scene's; run `lamella tradeoff` again", path);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMeasuredMesh(const char path[], const char hash[], PetscReal accuracy, PetscInt *along,
                               PetscInt *through, PetscReal *grading)
{
  json_error_t error;
  json_t *root = json_load_file(path, 0, &error), *list = NULL, *entry;
  double fastest = INFINITY, least = INFINITY;
  size_t i;
  PetscErrorCode ierr = CheckModel(path, root, &error, hash, &list);

  PetscFunctionBeginUser;
  json_array_foreach(list, i, entry)
  {
    int a, t;
    double g, e, seconds;

    if (ierr || json_unpack(entry, "{s:i, s:i, s:F, s:F, s:F}", "along", &a, "through", &t, "grading", &g,
                            "error_P_max", &e, "seconds_per_state", &seconds))
      continue;
    least = fmin(least, e);
    if (a < 1 || t < 1 || !(e <= accuracy) || !(seconds < fastest)) continue;
    fastest = seconds;
    *along = a;
    *through = t;
    *grading = g;
  }
  json_decref(root);
  PetscCall(ierr);
  PetscCheck(isfinite(fastest), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: none of its meshes has an error below the accuracy of %g; the least is %g. Write a larger accuracy, "
             "or leave "
             "`measured` out",
             path, (double)accuracy, least);
  PetscFunctionReturn(0);
}

/* ---- the mesh of a scene ---- */

/* The largest strain for which the scene queries an RVE. */
static PetscReal LargestStrain(const LamScene *scene)
{
  PetscReal strain = scene->has_macro || (!scene->load_count && !scene->has_sample) ? USUAL_STRAIN : 0.0;

  for (PetscInt i = 0; i < scene->load_count; i++) strain = PetscMax(strain, LamStrainSize(scene->loads[i].F));
  if (scene->has_sample)
    strain = PetscMax(strain, PetscSqrtReal(2.0) * PetscMax(PetscAbsReal(scene->sample.stretch_min),
                                                            PetscAbsReal(scene->sample.stretch_max)));
  return strain;
}

PetscErrorCode LamChooseMesh(LamScene *scene)
{
  LamMicrostructure *micro = &scene->micro;
  const PetscBool uneven = (PetscBool)(scene->has_macro && micro->interface == LAM_INTERFACE_CONTACT);
  LamErrorCase c = {micro->interface, micro->wall_thickness, LamWallFibreModulus(&micro->wall) / micro->wall.C1,
                    LargestStrain(scene)};
  PetscInt along, through;
  PetscReal grading;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; micro->cell && k < micro->cells[0] * micro->cells[1]; k++)
    c.thickness = PetscMax(c.thickness, micro->cell[k].wall_thickness);
  if (scene->measured[0] && !micro->along) {
    char hash[LAM_HASH_LENGTH];

    PetscCall(LamMicrostructureHashTissue(micro, hash));
    PetscCall(LamMeasuredMesh(scene->measured, hash, scene->accuracy, &along, &through, &grading));
  } else {
    LamCheapestMesh(&c, scene->accuracy, &along, &through, &grading);
  }
  if (uneven && scene->accuracy <= BODY_ACCURACY) along = PetscMax(along, BODY_ALONG);
  if (micro->grading < 0.0) micro->grading = micro->along ? 0.0 : grading;
  if (!micro->along) micro->along = along;
  if (!micro->through) micro->through = through;
  PetscFunctionReturn(0);
}
