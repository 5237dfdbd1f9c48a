/*
  Responders of the material points of an FE2 run: RVE solves, a database, or both.
*/
#include "fe2_run.h"
#include <lamella/relaxing.h>
#include "mesh_choice.h"
#include "microstructure_compare.h"
#include "lamella_zone.h"
#include "rounding.h"
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "shared_grid.h"

PetscBool LamFE2HoldsModels(const LamFE2Run *run, const LamFE2Tissue *tissue)
{
  return (PetscBool)(run->response == LAM_FE2_CACHE && tissue->scene.micro.interface == LAM_INTERFACE_LAMELLA);
}

PetscBool LamFE2AllHoldModels(const LamFE2Run *run)
{
  PetscBool all = PETSC_TRUE;

  for (PetscInt t = 0; t < run->tissues.count; t++)
    all = (PetscBool)(all && LamFE2HoldsModels(run, &run->tissues.tissues[t]));
  return all;
}

/* ---- databases ---- */

/* Loads the database as the resumed run had it: the records listed in the checkpoint, in that order. */
static PetscErrorCode OpenAsItWas(LamFE2Tissue *tissue)
{
  LamKnownRecords *known = &tissue->known;
  PetscInt64 *keys;
  LamResponse *records;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseOpenFirst(tissue->database_path, known->first, &tissue->database, &n, &keys, &records));
  PetscCall(LamKnownRecordsSet(known, known->first, n, keys, records));
  for (PetscInt k = 0; k < tissue->row_count; k++) {
    const PetscInt at = tissue->rows[k] - known->first;
    PetscCheck(at < n, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: has no record %" PetscInt_FMT ", which --resume goes on from; it is another file than before",
               tissue->database_path, tissue->rows[k]);
    PetscCall(LamDatabaseAdd(tissue->database, 1, LamKeyIsNode(keys[at]) ? &keys[at] : NULL, &records[at]));
  }
  PetscFunctionReturn(0);
}

/* Loads the database, on all ranks. Mesh parameters of the RVE that the scene leaves open are set to the database's. */
static PetscErrorCode OpenDatabase(LamFE2Run *run, LamFE2Tissue *tissue)
{
  LamMicrostructure *micro = &tissue->scene.micro, stored;
  int exists = tissue->database_path[0] && !access(tissue->database_path, F_OK);

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&exists, 1, MPI_INT, 0, run->comm));
  if (run->archive) PetscCall(LamFE2CheckpointRows(run, run->archive, tissue));
  if (!exists && run->response != LAM_FE2_DATABASE && !(tissue->known.first + tissue->row_count))
    PetscFunctionReturn(0);
  if (run->archive)
    PetscCall(OpenAsItWas(tissue));
  else
    PetscCall(LamDatabaseOpen(tissue->database_path, &tissue->database));
  PetscCall(LamDatabaseGetMicrostructure(tissue->database, &stored, NULL, NULL));
  if (!micro->along) micro->along = stored.along;
  if (!micro->through) micro->through = stored.through;
  if (micro->grading < 0.0) micro->grading = stored.grading;
  PetscFunctionReturn(0);
}

/* A database without a grid is given one (GiveGrid). */
static PetscErrorCode CheckF33(LamFE2Run *run, LamFE2Tissue *tissue)
{
  PetscReal range[2] = {1, 1};
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetGrid(tissue->database, &grid));
  if (grid) LamGridGetF33(grid, range);
  PetscCheck(run->scene->macro.symmetry != LAM_AXISYMMETRIC || !grid || range[1] > range[0], PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT,
             "%s: holds states of plane strain, and F33 varies in an axisymmetric body: build it of a scene with "
             "sample.F33, or give another name for a new one",
             tissue->database_path);
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckDatabase(LamFE2Run *run, LamFE2Tissue *tissue)
{
  char *json, wanted[LAM_HASH_LENGTH], difference[LAM_DIFFERENCE_LENGTH] = "";
  LamMicrostructure stored;
  const char *hash;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetMicrostructure(tissue->database, &stored, NULL, &hash));
  PetscCall(LamMicrostructureDescribe(&tissue->scene.micro, &json, wanted));
  PetscCall(PetscFree(json));
  if (strcmp(hash, wanted) != 0)
    PetscCall(LamMicrostructureCompare(&stored, &tissue->scene.micro, "the scene", difference));
  PetscCheck(!strcmp(hash, wanted), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds another microstructure than the scene %s%s%s: %s; give a database built from this scene, or "
             "another name "
             "for a new one",
             tissue->database_path, run->scene_path, tissue->name[0] ? " for " : "", tissue->name, difference);
  PetscCall(CheckF33(run, tissue));
  PetscCall(LamDatabaseGetRecords(tissue->database, &tissue->recorded, NULL, NULL));
  if (!run->archive) tissue->known.first = tissue->recorded;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2PrepareTissue(LamFE2Run *run, LamFE2Tissue *tissue)
{
  const PetscBool models = LamFE2HoldsModels(run, tissue);
  LamMeshTrial trial;

  PetscFunctionBeginUser;
  PetscCheck(
      !models || !LamWallsTilt(&tissue->scene.micro), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
      "%s: rve.wall.fibre_angle: models of a lamella are those of fibres in the section; choose --response direct",
      run->scene_path);
  PetscCheck(!models || run->scene->macro.symmetry != LAM_AXISYMMETRIC, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: macro.symmetry: axisymmetric: models of a lamella are those of one F33, which varies in such a body; "
             "choose --response direct",
             run->scene_path);
  PetscCheck(!models || !LamWallsRelax(&tissue->scene.micro), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: rve.wall.relaxation: models of a lamella know no time; choose --response direct", run->scene_path);
  if (run->response != LAM_FE2_DIRECT && LamWallsRelax(&tissue->scene.micro)) {
    tissue->relaxation = tissue->scene.micro.relaxation;
    tissue->scene.micro.relaxation.terms = 0;
    if (LamIsFirst(run->comm) && tissue == run->tissues.tissues)
      LamReportNote(&run->reporter,
                    "%s: rve.wall.relaxation: responses of a database are of elastic walls; those of walls that relax "
                    "are approximated from them%s (docs/theory/walls.md, Walls with memory in "
                    "tables); --response direct does not approximate",
                    run->scene_path,
                    tissue->scene.turgor > 0 ? ", and err most against fast loads after long turgor" : "");
  }
  if (run->response == LAM_FE2_DATABASE)
    PetscCall(
        LamRefuseHistory(run->scene_path, &tissue->scene.micro, "a table",
                         ", or choose --response cache, with which each material point holds a model, or direct"));
  if (run->response != LAM_FE2_DIRECT && !models) PetscCall(OpenDatabase(run, tissue));
  PetscCall(LamChooseMesh(&tissue->scene, &trial));
  LamWarnOfMesh(run->comm, &run->reporter, &tissue->scene, &trial);
  PetscCall(LamWarnOfDigits(run->comm, &run->reporter, &tissue->scene.micro, tissue->scene.accuracy));
  LamWarnOfZone(run->comm, &run->reporter, &tissue->scene.micro, &tissue->scene.scales);
  if (tissue->database)
    PetscCall(CheckDatabase(run, tissue));
  else if (run->response == LAM_FE2_CACHE && !models)
    PetscCall(LamDatabaseCreateEmpty(&tissue->scene, &tissue->database));
  PetscFunctionReturn(0);
}

void LamFE2TakeMesh(const LamFE2Tissue *tissue, LamScene *scene)
{
  const LamRelaxation relaxation = scene->micro.relaxation;

  scene->micro = tissue->scene.micro;
  scene->micro.relaxation = relaxation;
}

PetscErrorCode LamFE2PrepareResponse(LamFE2Run *run)
{
  LamFE2Tissues *tissues = &run->tissues;

  PetscFunctionBeginUser;
  PetscCall(LamFE2TissuesCreate(run->comm, &run->reporter, run->macro, run->scene, run->database_path, tissues));
  for (PetscInt t = 0; t < tissues->count; t++) PetscCall(LamFE2PrepareTissue(run, &tissues->tissues[t]));
  if (run->database_path && LamFE2AllHoldModels(run) && LamIsFirst(run->comm))
    LamReportNote(&run->reporter,
                  "%s: is not used: with a lamella that breaks each material point holds a model of its "
                  "own, since its response depends on what it has been through",
                  run->database_path);
  /* for the scene's own tissue, as written to the files */
  if (tissues->tissues[0].name[0])
    PetscCall(LamChooseMesh(run->scene, NULL));
  else
    LamFE2TakeMesh(&tissues->tissues[0], run->scene);
  if (tissues->turgor) PetscCall(LamMacroSetPointTissue(run->macro, tissues->turgor, tissues->cohesion));
  PetscFunctionReturn(0);
}

/* ---- responders ---- */

/* Creates a grid for a database without one: a new database, or one written before grids existed. */
static PetscErrorCode GiveGrid(LamFE2Run *run, LamFE2Tissue *tissue)
{
  LamScene scene = tissue->scene;
  PetscReal left = 1;
  PetscBool complete;
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetGrid(tissue->database, &grid));
  if (grid) PetscFunctionReturn(0);
  /* walls that have relaxed are those of the elastic tissue under this pressure (relaxing.h) */
  for (PetscInt i = 0; i < tissue->relaxation.terms; i++) left -= tissue->relaxation.share[i];
  if (tissue->relaxation.terms) scene.turgor = (scene.turgor + scene.cohesion) / left - scene.cohesion;
  if (LamIsFirst(run->comm) && tissue->recorded)
    LamReportNote(&run->reporter,
                  "%s: its %" PetscInt_FMT " records belong to no grid; a grid is added, on which new ones lie",
                  tissue->database_path, tissue->recorded);
  PetscCall(LamSharedGridMake(run->comm, &scene, tissue->direct, tissue->database, &tissue->grid_text, &complete));
  run->stopped = (PetscBool)!complete;
  PetscFunctionReturn(0);
}

/* Nodes are solved as `build` solves them, so the file's nodes are equal to those of `build`. */
static PetscErrorCode CreateNodeSolver(LamFE2Tissue *tissue)
{
  LamGrid grid;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseGetGrid(tissue->database, &grid));
  PetscCall(LamNodeChainCreate(tissue->rve, tissue->scene.micro.interface, grid, LAM_NODE_MEMORY, &tissue->chain));
  tissue->solved = (LamNodeSolver){tissue->chain, LamNodeChainSolve, LamNodeChainSolveNear};
  tissue->known.solver = &tissue->solved;
  tissue->nodes = (LamNodeSolver){&tissue->known, LamKnownRecordsSolve, LamKnownRecordsSolveNear};
  PetscFunctionReturn(0);
}

static void MultiplyLamella(const LamTissueFactors *factors, LamMicrostructure *micro)
{
  LamLamella *lamella = &micro->lamella;

  lamella->strength *= factors->lamella;
  lamella->shear_strength *= factors->lamella;
  lamella->energy *= factors->lamella;
  lamella->shear_energy *= factors->lamella;
  micro->tearing.strength *= factors->wall_strength;
  micro->tearing.energy *= factors->wall_strength;
}

PetscErrorCode LamFE2ChangeRVE(LamRVE rve, const LamMicrostructure *micro, const LamTissueFactors *factors)
{
  LamMicrostructure changed;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCall(LamMicrostructureCopy(micro, &changed));
  const PetscInt cells = changed.cell ? changed.cells[0] * changed.cells[1] : 0;
  for (PetscInt c = -1; c < cells; c++) LamWallMultiply(c < 0 ? &changed.wall : &changed.cell[c].wall, factors->walls);
  MultiplyLamella(factors, &changed);
  ierr = LamRVEChangeTissue(rve, &changed);
  PetscCall(LamMicrostructureDestroy(&changed));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2ChangeTissue(void *ctx, const LamTissueFactors *factors)
{
  LamFE2Tissue *tissue = (LamFE2Tissue *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamFE2ChangeRVE(tissue->rve, &tissue->scene.micro, factors));
  PetscFunctionReturn(0);
}

/* *kept: number of points for which two states fit in this tissue's share of warm_start_memory; with a history, whose
   responses are of their states, all. */
static PetscErrorCode CountKept(const LamFE2Run *run, const LamFE2Tissue *tissue, PetscInt *kept)
{
  const PetscReal memory = run->scene->response.warm_start_memory;
  LamRVEState state;
  PetscReal share = 0;
  size_t bytes;

  PetscFunctionBeginUser;
  *kept = tissue->points;
  if (LamHasHistory(&tissue->scene.micro)) PetscFunctionReturn(0);
  for (PetscInt t = 0; t < run->tissues.count; t++) share += (PetscReal)run->tissues.tissues[t].points;
  PetscCall(LamRVEStateCreate(tissue->rve, &state));
  PetscCall(LamRVEStateSize(state, &bytes));
  PetscCall(LamRVEStateDestroy(&state));
  if (share > 0) share = (PetscReal)tissue->points / share;
  *kept = (PetscInt)PetscMin((PetscReal)tissue->points, share * memory / (2 * (PetscReal)bytes));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2CreateDirect(LamFE2Run *run, LamFE2Tissue *tissue, LamResponder *responder)
{
  PetscInt kept = 0;

  PetscFunctionBeginUser;
  PetscCall(CountKept(run, tissue, &kept));
  PetscCall(LamRVEResponderCreate(tissue->rve, kept, responder));
  PetscFunctionReturn(0);
}

/*
  In contact tissue nearly all of abs(P) is P33, from turgor; the part that deforms the body is small, and its relative
  error is ten times as large. Wall meshes coarser than EVEN_ALONG are not that accurate. docs/results/performance.md,
  FE².
*/
#define EVEN_ALONG 12 /* elements along a face */
static PetscReal QueryAccuracy(const LamFE2Run *run, const LamFE2Tissue *tissue)
{
  const LamScene *scene = &tissue->scene;
  const PetscBool contact = (PetscBool)(LamCellsPart(scene->micro.interface) && scene->micro.along >= EVEN_ALONG);

  if (scene->response.accuracy > 0) return scene->response.accuracy;
  if (LamFE2HoldsModels(run, tissue)) return scene->accuracy; /* docs/results/performance.md, Bodies that tear */
  return run->response == LAM_FE2_CACHE && contact ? 0.1 * scene->accuracy : scene->accuracy;
}

PetscErrorCode LamFE2CreateSolver(LamFE2Run *run, LamFE2Tissue *tissue)
{
  PetscFunctionBeginUser;
  PetscCall(LamSceneRVECreate(PETSC_COMM_SELF, &tissue->scene, &tissue->rve));
  PetscCall(LamRVESetInterrupt(tissue->rve, LamStopInterrupt, NULL));
  if (run->response == LAM_FE2_DIRECT)
    PetscCall(LamFE2CreateDirect(run, tissue, &tissue->direct));
  else if (LamFE2HoldsModels(run, tissue))
    PetscCall(LamRVEModelResponderCreate(tissue->rve, tissue->points, QueryAccuracy(run, tissue), &tissue->direct));
  else /* all solves start from the reference, so that they do not depend on the order of the queries */
    PetscCall(LamRVEResponderCreate(tissue->rve, 0, &tissue->direct));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2ConnectTissue(LamFE2Run *run, LamFE2Tissue *tissue, LamResponder *responder)
{
  PetscFunctionBeginUser;
  if (run->response != LAM_FE2_DATABASE) PetscCall(LamFE2CreateSolver(run, tissue));
  *responder = tissue->direct;
  if (run->response == LAM_FE2_DIRECT || LamFE2HoldsModels(run, tissue)) PetscFunctionReturn(0);
  if (run->response == LAM_FE2_CACHE) {
    PetscCall(GiveGrid(run, tissue));
    if (run->stopped) PetscFunctionReturn(0);
    PetscCall(CreateNodeSolver(tissue));
  }
  PetscCall(LamCacheResponderCreate(run->comm, tissue->database, tissue->direct, &tissue->nodes,
                                    tissue->scene.response.outside, QueryAccuracy(run, tissue), tissue->points,
                                    &tissue->cache));
  *responder = tissue->cache;
  if (!tissue->relaxation.terms) PetscFunctionReturn(0);
  PetscCall(LamRelaxingResponderCreate(tissue->cache, &tissue->relaxation, tissue->points, &tissue->relaxing));
  *responder = tissue->relaxing;
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2Connect(LamFE2Run *run)
{
  LamFE2Tissues *tissues = &run->tissues;
  LamHeterogeneousTissue *parts;
  LamResponder responder = NULL;

  PetscFunctionBeginUser;
  PetscCall(LamMacroSetStop(run->macro, LamStopRequested));
  PetscCall(PetscMalloc1(tissues->count, &parts));
  for (PetscInt t = 0; t < tissues->count && !run->stopped; t++) {
    LamFE2Tissue *tissue = &tissues->tissues[t];

    PetscCall(LamFE2ConnectTissue(run, tissue, &responder));
    parts[t] = (LamHeterogeneousTissue){tissue->name, tissue->stress, LamFE2StressScale(tissue), responder};
  }
  if (!run->stopped && !tissues->plain) {
    PetscCall(LamHeterogeneousCreate(tissues->count, parts, tissues->points, tissues->point, &run->heterogeneous));
    responder = run->heterogeneous;
  }
  PetscCall(PetscFree(parts));
  if (!run->stopped) PetscCall(LamMacroSetResponder(run->macro, responder));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2DisconnectTissue(LamFE2Tissue *tissue)
{
  PetscFunctionBeginUser;
  PetscCall(LamResponderDestroy(&tissue->relaxing));
  PetscCall(LamResponderDestroy(&tissue->cache));
  PetscCall(LamNodeChainDestroy(&tissue->chain));
  PetscCall(LamResponderDestroy(&tissue->direct));
  PetscCall(LamResponderDestroy(&tissue->reference));
  PetscCall(LamRVEDestroy(&tissue->rve));
  PetscCall(LamDatabaseClose(&tissue->database));
  PetscCall(LamKnownRecordsDestroy(&tissue->known));
  PetscCall(PetscFree(tissue->rows));
  PetscCall(PetscFree(tissue->grid_text));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFE2Disconnect(LamFE2Run *run)
{
  PetscFunctionBeginUser;
  PetscCall(LamResponderDestroy(&run->heterogeneous));
  PetscCall(LamResponderDestroy(&run->reference));
  for (PetscInt t = 0; t < run->tissues.count; t++) PetscCall(LamFE2DisconnectTissue(&run->tissues.tissues[t]));
  PetscCall(LamFE2TissuesDestroy(&run->tissues));
  PetscFunctionReturn(0);
}
