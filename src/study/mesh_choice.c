/*
  The mesh of a scene. A body of cells in contact depends on their tangent, which is uneven because contact moves from
  node to node: 4-8 % with 6 elements along a face, 2 % with 12, below 1 % with BODY_ALONG (docs/results/performance.md,
  FE²). A lamella adds elements where they do not resolve its process zone.
*/
#include "mesh_choice.h"
#include "lamella_zone.h"
#include <jansson.h>
#include <math.h>
#include <string.h>

#define BODY_ALONG 16
#define FINEST_ALONG 40    /* for the zone in which a lamella breaks; finer ones must be asked for */
#define BODY_ACCURACY 0.01 /* not applied if the prescribed accuracy is coarser */

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

PetscErrorCode LamChooseMesh(LamScene *scene, LamMeshTrial *trial)
{
  LamMicrostructure *micro = &scene->micro;
  const PetscBool uneven = (PetscBool)(scene->has_macro && micro->interface == LAM_INTERFACE_CONTACT);
  LamMeshTrial choice = {.error = NAN};

  PetscFunctionBeginUser;
  if (!micro->along && scene->measured[0]) {
    char hash[LAM_HASH_LENGTH];

    PetscCall(LamMicrostructureHashTissue(micro, hash));
    PetscCall(LamMeasuredMesh(scene->measured, hash, scene->accuracy, &choice.along, &choice.through, &choice.grading));
  } else if (!micro->along || !micro->through) {
    PetscCall(LamTryMeshes(scene, &choice));
  }
  if (choice.tried) choice.along = PetscMax(choice.along, PetscMin(LamZoneAlong(micro, choice.grading), FINEST_ALONG));
  if (uneven && scene->accuracy <= BODY_ACCURACY) choice.along = PetscMax(choice.along, BODY_ALONG);
  if (LamWallsTear(micro)) choice.along += choice.along % 2; /* there is a cut in the middle of a face */
  if (micro->grading < 0.0) micro->grading = micro->along ? 0.0 : choice.grading;
  if (!micro->along) micro->along = choice.along;
  if (!micro->through) micro->through = choice.through;
  if (trial) *trial = choice;
  PetscFunctionReturn(0);
}

void LamWarnOfMesh(MPI_Comm comm, const LamReporter *reporter, const LamScene *scene, const LamMeshTrial *trial)
{
  if (!trial->tried || trial->stopped || trial->error <= scene->accuracy || !LamIsFirst(comm)) return;
  if (trial->loads)
    LamReportWarning(
        reporter,
        "no mesh of the planner reaches the accuracy of %.2g %%: its finest, %d x %d, has an error of %.2g %% "
        "at %d trial loads; write a larger `accuracy`, or a finer rve.mesh",
        (double)(100 * scene->accuracy), (int)trial->along, (int)trial->through, (double)(100 * trial->error),
        (int)trial->loads);
  else
    LamReportWarning(reporter,
                     "the planner cannot promise the accuracy of %.2g %%: it found no solution at its trial loads, and "
                     "takes %d x %d elements; see the estimated errors, or write rve.mesh",
                     (double)(100 * scene->accuracy), (int)trial->along, (int)trial->through);
}
