/* Handles carry the units of their scene: loads and responses are converted here. */
#include "mesh_choice.h"
#include "query_source.h"
#include <lamella/bind.h>
#include <lamella/error.h>
#include <math.h>
#include <stdlib.h>

#define LOAD 11 /* numbers of a load: F, turgor, cohesion */

#define SESSION_DIRS "OMPI_MCA_orte_create_session_dirs"

static PetscErrorCode Start(void)
{
  PetscBool without = PETSC_FALSE; /* session directories, of which processes remove each other's as they end */

  PetscFunctionBeginUser;
  if (PetscInitializeCalled) PetscFunctionReturn(0);
  if (!getenv("OMPI_COMM_WORLD_SIZE") && !getenv("PMIX_RANK") && !getenv("PMI_RANK")) { /* no other ranks to look for */
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
    setenv("OMPI_MCA_pml", "ob1", 0);
    without = (PetscBool)!getenv(SESSION_DIRS);
    if (without) setenv(SESSION_DIRS, "false", 0);
  }
  setenv("HWLOC_HIDE_ERRORS", "2", 0);
  PetscCall(PetscOptionsSetValue(NULL, "-no_signal_handler", "true")); /* signals are the program's */
  PETSC_MPI_THREAD_REQUIRED = MPI_THREAD_SERIALIZED;                   /* a host's threads may solve, one at a time */
  PetscCall(PetscInitializeNoArguments());
  if (without) unsetenv(SESSION_DIRS); /* an mpirun that this process starts needs them */
  PetscFunctionReturn(0);
}

int LamBindStart(void)
{
  const PetscErrorCode kept = LamErrorsKeep();

  return kept ? (int)kept : (int)Start();
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

/* ---- responses ---- */

size_t LamBindResponseSize(void)
{
  return sizeof(LamResponse);
}

static const char *UnitOf(const LamMember *member)
{
  if (member->stress_power == 1) return "Pa";
  if (member->stress_power == -1) return "1/Pa";
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

int LamBindQuantity(const char *text, int dimension, double *value)
{
  return (int)LamQuantityParse(text, (LamDimension)dimension, value);
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

void LamBindSceneScales(LamBindScene scene, double scales[2])
{
  scales[0] = scene->scene->scales.length;
  scales[1] = scene->scene->scales.stress;
}

int LamBindSceneLoads(LamBindScene scene, double loads[])
{
  const LamScales *scales = &scene->scene->scales;

  for (PetscInt k = 0; k < scene->scene->load_count && loads; k++) {
    const LamLoad *load = &scene->scene->loads[k];

    for (int i = 0; i < 9; i++) loads[LOAD * k + i] = load->F[i];
    loads[LOAD * k + 9] = load->turgor * scales->stress;
    loads[LOAD * k + 10] = load->cohesion * scales->stress;
  }
  return (int)scene->scene->load_count;
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

int LamBindSceneMaterial(LamBindScene scene, double *cohesion)
{
  *cohesion = scene->scene->cohesion * scene->scene->scales.stress;
  return (int)CheckMaterial(scene->scene);
}

void LamBindSceneDestroy(LamBindScene scene)
{
  (void)LamSceneDestroy(&scene->scene);
  (void)PetscFree(scene);
}

/* ---- RVE ---- */

struct LamBindRVE_s {
  LamRVE rve;
  LamRVEState state;
  LamScales scales;
};

static PetscErrorCode CreateRVE(LamScene *scene, LamBindRVE *out)
{
  LamRVEState state;
  LamRVE rve;

  PetscFunctionBeginUser;
  PetscCall(LamChooseMesh(scene, NULL));
  PetscCall(LamSceneRVECreate(PETSC_COMM_SELF, scene, &rve));
  PetscCall(LamRVEStateCreate(rve, &state));
  PetscCall(PetscNew(out));
  **out = (struct LamBindRVE_s){.rve = rve, .state = state, .scales = scene->scales};
  PetscFunctionReturn(0);
}

int LamBindRVECreate(LamBindScene scene, LamBindRVE *rve)
{
  return (int)CreateRVE(scene->scene, rve);
}

static PetscErrorCode SolveLoads(LamBindRVE bound, int n, const double loads[], int derivatives,
                                 LamResponse responses[])
{
  PetscFunctionBeginUser;
  PetscCall(LamRVESetWanted(bound->rve, derivatives ? LAM_WANT_ALL : LAM_WANT_ALL & ~LAM_WANT_DERIVATIVES));
  for (int k = 0; k < n; k++) {
    const LamLoad load = LoadOf(&loads[LOAD * k], &bound->scales);

    PetscCall(LamRVESolve(bound->rve, &load, bound->state, &responses[k]));
    LamResponseScale(bound->scales.stress, &responses[k]);
  }
  PetscFunctionReturn(0);
}

int LamBindRVESolve(LamBindRVE rve, int n, const double loads[], int derivatives, void *responses)
{
  return (int)SolveLoads(rve, n, loads, derivatives, (LamResponse *)responses);
}

int LamBindRVEStateSize(LamBindRVE rve, size_t *bytes)
{
  return (int)LamRVEStateSize(rve->state, bytes);
}

int LamBindRVEGetState(LamBindRVE rve, void *bytes)
{
  return (int)LamRVEStatePack(rve->state, bytes);
}

int LamBindRVESetState(LamBindRVE rve, const void *bytes)
{
  return (int)LamRVEStateUnpack(bytes, rve->state);
}

int LamBindRVEReset(LamBindRVE rve)
{
  return (int)LamRVEStateReset(rve->rve, rve->state);
}

void LamBindRVEDestroy(LamBindRVE rve)
{
  (void)LamRVEStateDestroy(&rve->state);
  (void)LamRVEDestroy(&rve->rve);
  (void)PetscFree(rve);
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

void LamBindDatabaseScales(LamBindDatabase database, double scales[2])
{
  scales[0] = database->source.scales.length;
  scales[1] = database->source.scales.stress;
}

void LamBindDatabaseMaterial(LamBindDatabase database, double *cohesion)
{
  *cohesion = database->source.cohesion * database->source.scales.stress;
}

static PetscErrorCode Query(LamBindDatabase bound, int n, const double loads[], double accuracy,
                            LamResponse responses[])
{
  PetscFunctionBeginUser;
  for (int k = 0; k < n; k++) {
    const LamLoad load = LoadOf(&loads[LOAD * k], &bound->source.scales);

    PetscCall(LamDatabaseQuery(bound->source.database, &load, accuracy, &responses[k]));
    LamResponseScale(bound->source.scales.stress, &responses[k]);
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
