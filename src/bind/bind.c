/* Handles carry the units of their scene: loads and responses are converted here. */
#include "plan.h"
#include "quantity_text.h"
#include "query_source.h"
#include "rve_run.h"
#include "start.h"
#include <lamella/bind.h>
#include <lamella/error.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LOAD 11 /* numbers of a load: F, turgor, cohesion */

int LamBindStart(void)
{
  const PetscErrorCode kept = LamErrorsKeep();

  return kept ? (int)kept : (int)LamStartAlone();
}

int LamBindStartedAlone(void)
{
  return (int)LamStartedAlone();
}

char LamBindErrorKind(int code)
{
  switch (code) {
  case PETSC_ERR_USER_INPUT:
    return 'i';
  case PETSC_ERR_FILE_OPEN:
  case PETSC_ERR_FILE_READ:
  case PETSC_ERR_FILE_WRITE:
  case PETSC_ERR_FILE_UNEXPECTED:
    return 'f';
  case PETSC_ERR_MEM:
    return 'm';
  default:
    return ' ';
  }
}

/* A quantity of the first dimension that it has. */
static PetscErrorCode ReadQuantity(const char *text, double *value)
{
  char reason[LAM_REASON_LENGTH];

  PetscFunctionBeginUser;
  for (int d = 0; d < LAM_DIMENSION_COUNT; d++) {
    PetscCall(LamQuantityRead(text, (LamDimension)d, value, reason));
    if (!reason[0]) PetscFunctionReturn(0);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
          "\"%.60s\": %s; write a number with its unit, such as 0.02 MPa, 75 um, 4 degC, 0.1 /day", text,
          strstr(reason, "is not a unit of") ? "scenes have no quantity of this unit" : reason);
}

int LamBindQuantity(const char *text, int dimension, double *value)
{
  return (int)(dimension < 0 ? ReadQuantity(text, value) : LamQuantityParse(text, (LamDimension)dimension, value));
}

/* ---- responses ---- */

size_t LamBindResponseSize(void)
{
  return sizeof(LamResponse);
}

static int LengthPower(const LamMember *member)
{
  if (!member->unit) return 0;
  return !strcmp(member->unit, "apothem") ? 1 : !strcmp(member->unit, "apothem^2") ? 2 : 0;
}

static void ToSI(const LamScales *scales, LamResponse *response)
{
  const PetscReal factors[] = {1, scales->length, scales->length * scales->length};

  LamResponseScale(scales->stress, response);
  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    const int power = LengthPower(m);
    PetscReal *value = (PetscReal *)(void *)((char *)response + m->offset);

    for (PetscInt i = 0; i < (PetscInt)m->count && power; i++) value[i] *= factors[power];
  }
}

static const char *UnitOf(const LamMember *member)
{
  if (member->stress_power == 1) return "Pa";
  if (member->stress_power == -1) return "1/Pa";
  if (LengthPower(member)) return LengthPower(member) == 1 ? "m" : "m^2";
  return member->unit ? member->unit : "1";
}

const char *LamBindMember(int i, char *type, int *count, size_t *offset, const char **unit, const char **help)
{
  static const char types[] = {[LAM_MEMBER_REAL] = 'f',
                               [LAM_MEMBER_INT] = 'i',
                               [LAM_MEMBER_BOOL] = 'b',
                               [LAM_MEMBER_ENUM] = 'e',
                               [LAM_MEMBER_TEXT] = 's'};
  const LamMember *member = &LamResponseMembers[i];

  if (!member->name) return NULL;
  *type = types[member->type];
  *count = (int)member->count;
  *offset = member->offset;
  *unit = UnitOf(member);
  *help = member->help;
  return member->name;
}

const char *LamBindMemberName(int i, int value)
{
  return LamResponseMembers[i].names ? LamResponseMembers[i].names[value] : NULL;
}

static LamLoad LoadOf(const double row[LOAD], const LamScales *scales)
{
  LamLoad load = {.turgor = row[9] / scales->stress, .cohesion = row[10] / scales->stress};

  for (int i = 0; i < 9; i++) load.F[i] = row[i];
  return load;
}

/* ---- scenes ---- */

struct LamBindScene_s {
  LamScene *scene;
};

static PetscErrorCode ReadScene(const char *path, const char *text, LamBindScene *out)
{
  LamScene *scene;

  PetscFunctionBeginUser;
  PetscCall(text ? LamSceneReadText(path, text, &scene) : LamSceneRead(path, &scene));
  PetscCall(PetscNew(out));
  (*out)->scene = scene;
  PetscFunctionReturn(0);
}

int LamBindSceneRead(const char *path, const char *text, LamBindScene *scene)
{
  return (int)ReadScene(path, text, scene);
}

void LamBindSceneNumbers(LamBindScene scene, double numbers[4])
{
  const LamScales *scales = &scene->scene->scales;

  numbers[0] = scales->length;
  numbers[1] = scales->stress;
  numbers[2] = scene->scene->turgor * scales->stress;
  numbers[3] = scene->scene->cohesion * scales->stress;
}

const char *LamBindSceneFile(LamBindScene bound, int k)
{
  return k < bound->scene->file_count ? bound->scene->files[k].path : NULL;
}

static void LoadToRow(const LamScene *scene, PetscInt k, double row[LOAD], double P[9])
{
  const LamStressControl *control = scene->controls ? &scene->controls[k] : NULL;
  const LamLoad *load = &scene->loads[k];

  for (int i = 0; i < 9; i++) {
    const PetscBool given = (PetscBool)(control && control->given[i]);

    row[i] = given || (control && control->follows[i]) ? NAN : load->F[i];
    P[i] = given ? control->P[i] * scene->scales.stress : NAN;
  }
  row[9] = load->turgor * scene->scales.stress;
  row[10] = load->cohesion * scene->scales.stress;
}

int LamBindSceneLoads(LamBindScene bound, double loads[], double P[])
{
  const LamScene *scene = bound->scene;

  for (PetscInt k = 0; k < scene->load_count && loads; k++) LoadToRow(scene, k, &loads[LOAD * k], &P[9 * k]);
  return (int)scene->load_count;
}

const char *LamBindSceneLoadsAreOpen(LamBindScene scene)
{
  if (scene->scene->inflate) return "F counts from the inflated tissue";
  if (scene->scene->dissipating) return "the ramp follows what is dissipated";
  return NULL;
}

static PetscErrorCode CheckMaterial(const LamScene *scene)
{
  PetscFunctionBeginUser;
  PetscCheck(!scene->micro.is_patch, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.patch: a patch between grips is a body of its own and no material point; take a period "
             "(rve.cells)",
             scene->path);
  PetscCheck(!scene->sealed, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.turgor.mode: sealed: the turgor of sealed cells depends on their water, and the program that "
             "takes this material prescribes it; write mode: prescribed",
             scene->path);
  PetscFunctionReturn(0);
}

int LamBindSceneIsMaterial(LamBindScene scene)
{
  return (int)CheckMaterial(scene->scene);
}

void LamBindSceneDestroy(LamBindScene scene)
{
  (void)LamSceneDestroy(&scene->scene);
  (void)PetscFree(scene);
}

/* ---- RVE ---- */

struct LamBindRVE_s {
  LamScene *scene; /* with its mesh chosen; owned */
  LamMeshes meshes;
  char *readings; /* of the scene's own loads, solved last; NULL: none; owned */
};

static PetscErrorCode CopyScene(const LamScene *scene, LamScene **copy)
{
  return LamSceneReadText(scene->path, scene->text, copy);
}

static void DestroyRVE(LamBindRVE bound)
{
  (void)LamMeshesDestroy(&bound->meshes);
  (void)LamSceneDestroy(&bound->scene);
  free(bound->readings);
  (void)PetscFree(bound);
}

/* Undeformed tissue. Sealed cells have their water from there, or from the inflated tissue that the scene's loads find.
 */
static PetscErrorCode ResetRVE(LamBindRVE bound)
{
  const PetscReal unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const LamScene *scene = bound->scene;
  LamLoad first = {.turgor = scene->turgor, .cohesion = scene->cohesion};

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateReset(bound->meshes.rve[0], bound->meshes.state[0]));
  PetscCall(PetscArraycpy(bound->meshes.F, unit, 9));
  if (!scene->sealed) PetscFunctionReturn(0);
  PetscCall(LamRVEUnseal(bound->meshes.rve[0]));
  bound->meshes.unsealed = (LamResponse){.status = scene->inflate ? LAM_NOT_CONVERGED : LAM_CONVERGED};
  if (scene->inflate) {
    PetscCall(PetscStrncpy(bound->meshes.unsealed.reason,
                           "cells are sealed in the inflated tissue: solve the scene's loads first",
                           sizeof(bound->meshes.unsealed.reason)));
    PetscFunctionReturn(0);
  }
  if (scene->load_count) first = scene->loads[0];
  PetscCall(LamMeshesSeal(&bound->meshes, scene, &first));
  PetscFunctionReturn(0);
}

static PetscErrorCode SetUpRVE(LamBindRVE bound)
{
  LamPlan plan;

  PetscFunctionBeginUser;
  PetscCall(LamPlanMake(bound->scene, &plan));
  bound->scene->micro = plan.micro;
  bound->scene->out_of_plane = PETSC_TRUE; /* any F, and all entries of the tangent */
  PetscCall(LamMeshesCreate(PETSC_COMM_SELF, bound->scene, 1, &bound->meshes));
  PetscCall(ResetRVE(bound));
  PetscFunctionReturn(0);
}

static PetscErrorCode CreateRVE(const LamScene *scene, LamBindRVE *out)
{
  LamBindRVE bound;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&bound));
  ierr = CopyScene(scene, &bound->scene);
  if (!ierr) ierr = SetUpRVE(bound);
  if (ierr) DestroyRVE(bound);
  PetscCall(ierr);
  *out = bound;
  PetscFunctionReturn(0);
}

int LamBindRVECreate(LamBindScene scene, LamBindRVE *rve)
{
  return (int)CreateRVE(scene->scene, rve);
}

/* P is given where F is not. P NULL: F alone. */
static PetscErrorCode ControlOf(int state, const LamLoad *load, const double P[9], PetscReal stress,
                                LamStressControl *control)
{
  static const char *const names[] = {"11", "12", "13", "21", "22", "23", "31", "32", "33"};

  PetscFunctionBeginUser;
  *control = (LamStressControl){.share = 1};
  for (int i = 0; i < 9 && P; i++) {
    control->given[i] = (PetscBool)!isnan(P[i]);
    PetscCheck(!control->given[i] || isnan(load->F[i]), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "state %d: F%s and P%s are both given; write NaN for one of them", state, names[i], names[i]);
    PetscCheck(control->given[i] || !isnan(load->F[i]), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "state %d: F%s and P%s are both NaN; give one of them", state, names[i], names[i]);
    if (control->given[i]) control->P[i] = P[i] / stress;
  }
  PetscFunctionReturn(0);
}

/* Sealed cells find their pressure: a load has that at which they were sealed. */
static PetscErrorCode CheckTurgor(const LamScene *scene, int state, const LamLoad *load)
{
  const PetscReal rounding = 10 * PETSC_MACHINE_EPSILON * fabs(scene->turgor); /* of the way to Pa and back */

  PetscFunctionBeginUser;
  PetscCheck(!scene->sealed || fabs(load->turgor - scene->turgor) <= rounding, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.turgor.mode: sealed: the cells find their pressure; state %d prescribes %g Pa, leave it out",
             scene->path, state, (double)(load->turgor * scene->scales.stress));
  PetscFunctionReturn(0);
}

static LamWanted Wanted(int derivatives)
{
  return (derivatives ? LAM_WANT_ALL : LAM_WANT_ALL & ~LAM_WANT_DERIVATIVES) | LAM_WANT_JUMPS;
}

static PetscErrorCode SolveLoads(LamBindRVE bound, LamRVEEstimate estimate, int n, const double loads[],
                                 const double P[], LamResponse responses[])
{
  const PetscReal stress = bound->scene->scales.stress;

  PetscFunctionBeginUser;
  for (int k = 0; k < n; k++) {
    const LamLoad load = LoadOf(&loads[LOAD * k], &bound->scene->scales);
    LamResponse solved[2];
    LamStressControl control;

    PetscCall(CheckTurgor(bound->scene, k, &load));
    PetscCall(ControlOf(k, &load, P ? &P[9 * k] : NULL, stress, &control));
    PetscCall(LamMeshesSolve(&bound->meshes, &load, &control, solved));
    if (estimate) PetscCall(LamRVEEstimateError(estimate, bound->meshes.state[0], &solved[0]));
    responses[k] = solved[0];
    ToSI(&bound->scene->scales, &responses[k]);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Solve(LamBindRVE bound, int n, const double loads[], const double P[], int derivatives,
                            int estimate, LamResponse responses[])
{
  LamRVEEstimate made = NULL;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCheck(
      !estimate || bound->scene->micro.interface != LAM_INTERFACE_LAMELLA, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
      "%s: rve.interface.law: lamella: the error is estimated along the scene's own loads alone, whose history is "
      "known",
      bound->scene->path);
  PetscCheck(!LamWallsRelax(&bound->scene->micro), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.wall.relaxation: loads given here have no time, on which walls with memory depend; solve the "
             "scene's own loads",
             bound->scene->path);
  PetscCall(LamMeshesSetWanted(&bound->meshes, Wanted(derivatives)));
  if (estimate) PetscCall(LamRVEEstimateCreate(bound->meshes.rve[0], &made));
  ierr = SolveLoads(bound, made, n, loads, P, responses);
  PetscCall(LamRVEEstimateDestroy(&made));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

int LamBindRVESolve(LamBindRVE rve, int n, const double loads[], const double P[], int derivatives, int estimate,
                    void *responses)
{
  return (int)Solve(rve, n, loads, P, derivatives, estimate, (LamResponse *)responses);
}

/* The states of a run as `lamella rve` makes it, which borrows the meshes. */
static PetscErrorCode RunStates(LamRVERun *run, LamResponse responses[])
{
  PetscFunctionBeginUser;
  while (run->solved < run->scene->load_count) {
    LamResponse solved[2];

    PetscCall(LamRVERunNext(run, solved));
    responses[run->solved - 1] = solved[0];
    ToSI(&run->scene->scales, &responses[run->solved - 1]);
  }
  PetscFunctionReturn(0);
}

static void KeepReadings(LamBindRVE bound, const LamTest *test)
{
  json_t *read = test->count < 2 ? NULL : LamTestToJSON(test, 0, NULL);

  free(bound->readings);
  bound->readings = json_dumps(read, 0);
  json_decref(read);
}

static PetscErrorCode SolveOwnLoads(LamBindRVE bound, int derivatives, int estimate, LamResponse responses[],
                                    int *count)
{
  LamRVERun run = {0};
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(ResetRVE(bound));
  PetscCall(LamMeshesSetWanted(&bound->meshes, Wanted(derivatives)));
  PetscCall(CopyScene(bound->scene, &run.scene)); /* its loads are replaced by those that are found */
  run.meshes = bound->meshes;
  if (run.scene->inflate) run.meshes.unsealed.status = LAM_CONVERGED; /* not yet */
  run.readings = PETSC_TRUE;
  LamTestCreate(run.scene, &run.test);
  ierr = estimate && !run.scene->dissipating ? LamRVEEstimateCreate(run.meshes.rve[0], &run.estimate) : 0;
  if (!ierr) ierr = RunStates(&run, responses);
  bound->meshes = run.meshes;
  *count = (int)run.solved;
  KeepReadings(bound, &run.test);
  (void)LamTestDestroy(&run.test);
  if (!ierr && run.scene->inflate && !LamResponseHasFields(&responses[0]))
    ierr = ResetRVE(bound); /* nothing is sealed */
  (void)LamRVEEstimateDestroy(&run.estimate);
  (void)LamSceneDestroy(&run.scene);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

int LamBindRVESolveOwnLoads(LamBindRVE rve, int derivatives, int estimate, void *responses, int *count)
{
  return (int)SolveOwnLoads(rve, derivatives, estimate, (LamResponse *)responses, count);
}

const char *LamBindRVEReadings(LamBindRVE rve)
{
  return rve->readings;
}

int LamBindRVEStateSize(LamBindRVE rve, size_t *bytes)
{
  const PetscErrorCode ierr = LamRVEStateSize(rve->meshes.state[0], bytes);

  *bytes += sizeof(rve->meshes.F);
  return (int)ierr;
}

int LamBindRVEGetState(LamBindRVE rve, void *bytes)
{
  memcpy(bytes, rve->meshes.F, sizeof(rve->meshes.F));
  return (int)LamRVEStatePack(rve->meshes.state[0], (char *)bytes + sizeof(rve->meshes.F));
}

int LamBindRVESetState(LamBindRVE rve, const void *bytes)
{
  memcpy(rve->meshes.F, bytes, sizeof(rve->meshes.F));
  return (int)LamRVEStateUnpack((const char *)bytes + sizeof(rve->meshes.F), rve->meshes.state[0]);
}

int LamBindRVEReset(LamBindRVE rve)
{
  return (int)ResetRVE(rve);
}

void LamBindRVEDestroy(LamBindRVE rve)
{
  DestroyRVE(rve);
}

/* ---- databases ---- */

struct LamBindDatabase_s {
  LamQuerySource source;
};

static PetscErrorCode OpenDatabase(const char *path, LamBindDatabase *out)
{
  LamQuerySource source;
  LamTable table;

  PetscFunctionBeginUser;
  PetscCall(LamQuerySourceOpen(path, &source));
  PetscCall(LamDatabaseGetTable(source.database, &table)); /* now: queries are then free of each other */
  if (table) PetscCall(LamTableDestroy(&table));           /* the database keeps it */
  PetscCall(PetscNew(out));
  (*out)->source = source;
  PetscFunctionReturn(0);
}

int LamBindDatabaseOpen(const char *path, LamBindDatabase *database)
{
  return (int)OpenDatabase(path, database);
}

void LamBindDatabaseNumbers(LamBindDatabase database, double numbers[5])
{
  const LamQuerySource *source = &database->source;

  numbers[0] = source->scales.length;
  numbers[1] = source->scales.stress;
  numbers[2] = source->turgor * source->scales.stress;
  numbers[3] = source->cohesion * source->scales.stress;
  numbers[4] = source->accuracy;
}

static PetscErrorCode Query(LamBindDatabase bound, int n, const double loads[], double accuracy,
                            LamResponse responses[])
{
  PetscFunctionBeginUser;
  for (int k = 0; k < n; k++) {
    const LamLoad load = LoadOf(&loads[LOAD * k], &bound->source.scales);

    PetscCall(LamDatabaseQuery(bound->source.database, &load, accuracy, &responses[k]));
    ToSI(&bound->source.scales, &responses[k]);
  }
  PetscFunctionReturn(0);
}

int LamBindDatabaseQuery(LamBindDatabase database, int n, const double loads[], double accuracy, void *responses)
{
  return (int)Query(database, n, loads, accuracy, (LamResponse *)responses);
}

int LamBindDatabaseLevels(LamBindDatabase database, int levels[])
{
  const LamResponse *records;
  const PetscInt64 *keys;
  LamGrid grid = NULL;
  PetscInt n = 0;

  (void)LamDatabaseGetRecords(database->source.database, &n, &records, &keys);
  (void)LamDatabaseGetGrid(database->source.database, &grid);
  for (PetscInt i = 0; levels && i < n; i++)
    levels[i] = grid && LamKeyIsNode(keys[i]) ? (int)LamGridNodeLevel(grid, keys[i]) : -1;
  return (int)n;
}

void LamBindDatabaseClose(LamBindDatabase database)
{
  (void)LamQuerySourceClose(&database->source);
  (void)PetscFree(database);
}
