/*
  A material law for other programs: a scene's responder, or a database, in SI units.
*/
#include <lamella/material.h>
#include "query_source.h"
#include "mesh_choice.h"
#include "rounding.h"
#include "start.h"
#include <math.h>

struct LamMaterial_s {
  LamScales scales;
  LamInterfaceLawType interface;
  PetscReal turgor, cohesion; /* of the scene, in C1 + C2 */
  int points;

  LamScene *scene; /* owned; for a scene */
  LamRVE rve;
  LamResponder responder;

  LamQuerySource database; /* owned; database.database NULL: for a scene */
  PetscReal accuracy;
};

/* ---- lifecycle ---- */

static PetscErrorCode CreateRVE(LamMaterial m)
{
  PetscFunctionBeginUser;
  PetscCall(LamSceneRVECreate(PETSC_COMM_SELF, m->scene, &m->rve));
  PetscCall(LamRVEResponderCreate(m->rve, m->points, &m->responder));
  PetscFunctionReturn(0);
}

static PetscErrorCode DestroyRVE(LamMaterial m)
{
  PetscFunctionBeginUser;
  PetscCall(LamResponderDestroy(&m->responder));
  PetscCall(LamRVEDestroy(&m->rve));
  PetscFunctionReturn(0);
}

static PetscErrorCode ConnectScene(const char path[], LamMaterial m)
{
  PetscFunctionBeginUser;
  PetscCall(LamSceneRead(path, &m->scene));
  PetscCheck(!m->scene->micro.is_patch, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.patch: a patch between grips is a body of its own and no material point; take a period "
             "(rve.cells)",
             path);
  PetscCall(LamRefuseHistory(path, &m->scene->micro, "a material", ""));
  PetscCall(LamChooseMesh(m->scene, NULL));
  PetscCall(CreateRVE(m));
  m->scales = m->scene->scales;
  m->interface = m->scene->micro.interface;
  m->turgor = m->scene->turgor;
  m->cohesion = m->scene->cohesion;
  PetscFunctionReturn(0);
}

static PetscErrorCode ConnectDatabase(const char path[], LamMaterial m)
{
  LamTable table;

  PetscFunctionBeginUser;
  PetscCall(LamQuerySourceOpen(path, &m->database));
  m->scales = m->database.scales;
  m->interface = m->database.micro.interface;
  m->turgor = m->database.turgor;
  m->cohesion = m->database.cohesion;
  m->accuracy = m->database.accuracy;
  PetscCall(LamDatabaseGetTable(m->database.database, &table)); /* built now, so that threads only read it */
  PetscCall(LamTableDestroy(&table));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMaterialCreateFromScene(const char path[], int points, LamMaterial *material)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *material = NULL;
  PetscCheck(points >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%d material points: 0 or more are wanted",
             points);
  PetscCall(LamStartAlone());
  PetscCall(PetscNew(material));
  (*material)->points = points;
  ierr = ConnectScene(path, *material);
  if (ierr) (void)LamMaterialDestroy(material);
  PetscFunctionReturn(ierr);
}

PetscErrorCode LamMaterialCreateFromDatabase(const char path[], LamMaterial *material)
{
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(LamStartAlone());
  PetscCall(PetscNew(material));
  ierr = ConnectDatabase(path, *material);
  if (ierr) (void)LamMaterialDestroy(material);
  PetscFunctionReturn(ierr);
}

PetscErrorCode LamMaterialDestroy(LamMaterial *material)
{
  LamMaterial m = *material;

  PetscFunctionBeginUser;
  *material = NULL;
  if (!m) PetscFunctionReturn(0);
  PetscCall(DestroyRVE(m));
  PetscCall(LamSceneDestroy(&m->scene));
  PetscCall(LamQuerySourceClose(&m->database));
  PetscCall(PetscFree(m));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMaterialSetOutOfPlane(LamMaterial m, int on)
{
  PetscFunctionBeginUser;
  PetscCheck(m->rve, PETSC_COMM_SELF, PETSC_ERR_SUP, "a database has no states with out-of-plane shear; take a scene");
  m->scene->out_of_plane = on ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(DestroyRVE(m));
  PetscCall(CreateRVE(m));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMaterialGetLoads(LamMaterial m, double *turgor, double *cohesion)
{
  PetscFunctionBeginUser;
  *turgor = m->turgor * m->scales.stress;
  *cohesion = m->cohesion * m->scales.stress;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMaterialSetAccuracy(LamMaterial m, double accuracy)
{
  PetscFunctionBeginUser;
  PetscCheck(accuracy > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "accuracy %g: above 0 is wanted", accuracy);
  m->accuracy = accuracy;
  PetscFunctionReturn(0);
}

/* ---- evaluation ---- */

static PetscErrorCode EvaluateOne(LamMaterial m, int point, const LamLoad *load, LamResponse *response)
{
  const PetscInt number = point;
  LamLoad rounded = *load;

  PetscFunctionBeginUser;
  if (m->rve) {
    if (!m->scene->out_of_plane) LamRoundToPlane(rounded.F);
    PetscCall(LamResponderRespond(m->responder, 1, &rounded, &number, response));
  } else {
    PetscCall(LamDatabaseQuery(m->database.database, load, m->accuracy, response));
  }
  PetscFunctionReturn(0);
}

static void FillInfo(const LamMaterial m, const LamResponse *r, LamMaterialInfo *info)
{
  *info = (LamMaterialInfo){.status = (int)r->status,
                            .trusted = m->rve ? 1 : (int)r->indicators_trusted,
                            .error_estimate = r->error_estimate,
                            .debonded_fraction = LamCellsPart(m->interface) ? r->debonded_fraction : NAN,
                            .max_gap = r->max_gap * m->scales.length,
                            .turgor = r->turgor_mean * m->scales.stress};
  (void)PetscStrncpy(info->reason, r->reason, sizeof(info->reason));
}

/* Scales the numbers by `factor`; NaN if the response has no fields. */
static void Scale(PetscInt n, const PetscReal from[], PetscReal factor, PetscBool known, double to[])
{
  for (PetscInt i = 0; i < n; i++) to[i] = known ? factor * from[i] : NAN;
}

PetscErrorCode LamMaterialEvaluate(LamMaterial m, int n, const int points[], const double F[], const double turgor[],
                                   const double cohesion[], double P[], double tangent[], LamMaterialInfo info[])
{
  const PetscReal stress = m->scales.stress;

  PetscFunctionBeginUser;
  for (int i = 0; i < n; i++) {
    const int point = points ? points[i] : -1;
    LamLoad load = {.turgor = turgor ? turgor[i] / stress : m->turgor,
                    .cohesion = cohesion ? cohesion[i] / stress : m->cohesion};
    LamResponse response;
    PetscBool known;

    PetscCheck(point < m->points || !m->rve, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "material point %d: there are %d, numbered from 0", point, m->points);
    PetscCall(PetscArraycpy(load.F, &F[9 * i], 9));
    PetscCall(EvaluateOne(m, point, &load, &response));
    known = LamResponseHasFields(&response);
    Scale(9, response.P, stress, known, &P[9 * i]);
    if (tangent) Scale(81, response.tangent, stress, known, &tangent[81 * (size_t)i]);
    if (info) FillInfo(m, &response, &info[i]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMaterialAccept(LamMaterial m)
{
  PetscFunctionBeginUser;
  if (m->rve) PetscCall(LamResponderAccept(m->responder));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMaterialReject(LamMaterial m)
{
  PetscFunctionBeginUser;
  if (m->rve) PetscCall(LamResponderReject(m->responder));
  PetscFunctionReturn(0);
}

/* ---- states ---- */

PetscErrorCode LamMaterialGetStateSize(LamMaterial m, size_t *bytes)
{
  PetscFunctionBeginUser;
  *bytes = 0;
  if (m->rve) PetscCall(LamResponderGetStateSize(m->responder, bytes));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckPoint(LamMaterial m, int point)
{
  PetscFunctionBeginUser;
  PetscCheck(m->rve, PETSC_COMM_SELF, PETSC_ERR_SUP, "a database keeps no states");
  PetscCheck(point >= 0 && point < m->points, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "material point %d: there are %d, numbered from 0", point, m->points);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMaterialSaveState(LamMaterial m, int point, void *bytes)
{
  PetscFunctionBeginUser;
  PetscCall(CheckPoint(m, point));
  PetscCall(LamResponderSave(m->responder, point, bytes));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMaterialRestoreState(LamMaterial m, int point, const void *bytes)
{
  PetscFunctionBeginUser;
  PetscCall(CheckPoint(m, point));
  PetscCall(LamResponderLoad(m->responder, point, bytes));
  PetscFunctionReturn(0);
}
