#include "antiplane.h"
#include "solve.h"
#include "clock.h"
#include "section_frame.h"

PetscErrorCode LamRVECreate(MPI_Comm comm, LamRVE *rve)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(rve));
  (*rve)->comm = comm;
  (*rve)->linear = &(*rve)->systems[0];
  (*rve)->wanted = LAM_WANT_ALL;
  (*rve)->strategy = LAM_ONE_STEP;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESetMicrostructure(LamRVE rve, const LamMicrostructure *micro)
{
  PetscFunctionBeginUser;
  PetscCheck(!rve->is_set_up, PETSC_COMM_SELF, PETSC_ERR_ORDER, "the microstructure is set before LamRVESetUp");
  PetscCall(LamMicrostructureDestroy(&rve->micro));
  PetscCall(LamMicrostructureCopy(micro, &rve->micro));
  rve->has_micro = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESetStrategy(LamRVE rve, LamStrategy strategy)
{
  PetscFunctionBeginUser;
  rve->strategy = strategy;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESetTolerance(LamRVE rve, PetscReal tolerance)
{
  PetscFunctionBeginUser;
  PetscCheck(tolerance >= 0.0 && tolerance < 1.0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "tolerance of the solves is %g; it must lie between 0 and 1", (double)tolerance);
  rve->tolerance = tolerance;
  if (rve->bonded) PetscCall(LamRVESetTolerance(rve->bonded, tolerance));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESetWanted(LamRVE rve, LamWanted wanted)
{
  PetscFunctionBeginUser;
  rve->wanted = wanted;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESetMonitor(LamRVE rve, PetscBool on)
{
  PetscFunctionBeginUser;
  rve->monitor = on;
  if (rve->bonded) PetscCall(LamRVESetMonitor(rve->bonded, on));
  PetscFunctionReturn(0);
}

/* Sets the wall law of each cell and the extremes over the cells. */
static PetscErrorCode SetUpWalls(LamRVE rve)
{
  PetscFunctionBeginUser;
  rve->stiffest = 0.0;
  for (PetscInt cell = 0; cell < rve->mesh.cell_count; ++cell) {
    const LamWall *wall = LamCellWall(&rve->micro, cell);

    PetscCall(LamWallLawGet(wall->law, &rve->law[cell]));
    rve->stiffest = PetscMax(rve->stiffest, wall->bulk_modulus + LamWallFibreModulus(wall));
  }
  if (rve->micro.interface == LAM_INTERFACE_LAMELLA)
    rve->stiffest = PetscMax(rve->stiffest,
                             PetscMax(rve->micro.lamella.stiffness, rve->micro.tearing.stiffness) * rve->mesh.longest);
  PetscFunctionReturn(0);
}

static void CopyModuli(const LamWall *from, LamWall *to)
{
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; ++k) *LamWallAt(to, k) = LamWallGet(from, k);
  to->bulk_modulus = from->bulk_modulus;
}

static PetscErrorCode ChangeLayer(LamRVE rve, const LamMicrostructure *micro)
{
  LamLamella *lamella = &rve->micro.lamella;

  PetscFunctionBeginUser;
  lamella->strength = micro->lamella.strength;
  lamella->shear_strength = micro->lamella.shear_strength;
  lamella->energy = micro->lamella.energy;
  lamella->shear_energy = micro->lamella.shear_energy;
  rve->micro.tearing.strength = micro->tearing.strength;
  rve->micro.tearing.energy = micro->tearing.energy;
  PetscCheck(lamella->stiffness > LamLamellaLeastStiffness(&rve->micro), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "the lamella has become so strong that its traction would fall in a jump; a larger stiffness is needed");
  LamLayerSetLaws(&rve->micro, &rve->mesh, rve->contact, rve->layer);
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEChangeTissue(LamRVE rve, const LamMicrostructure *micro)
{
  PetscFunctionBeginUser;
  PetscCheck(rve->is_set_up, PETSC_COMM_SELF, PETSC_ERR_ORDER, "LamRVESetUp comes before LamRVEChangeTissue");
  CopyModuli(&micro->wall, &rve->micro.wall);
  for (PetscInt cell = 0; rve->micro.cell && cell < rve->mesh.cell_count; ++cell)
    CopyModuli(LamCellWall(micro, cell), &rve->micro.cell[cell].wall);
  PetscCall(SetUpWalls(rve));
  if (rve->layer) PetscCall(ChangeLayer(rve, micro));
  LamForgetTangent(rve);
  rve->changes++;
  if (rve->bonded) PetscCall(LamRVEChangeTissue(rve->bonded, micro));
  PetscFunctionReturn(0);
}

/* Set-up that needs no MPI: mesh, element geometry, sparsity pattern, work arrays. */
static PetscErrorCode SetUpArrays(LamRVE rve)
{
  PetscInt cells, lumens;

  PetscFunctionBeginUser;
  PetscCall(LamMeshCreate(&rve->micro, &rve->mesh));
  cells = rve->mesh.cell_count;
  lumens = rve->seal.allowed ? cells : 0;
  rve->budget = LAM_ITERATION_BUDGET;
  PetscCall(PetscMalloc1(cells, &rve->law));
  PetscCall(SetUpWalls(rve));
  PetscCall(LamGeometryCreate(rve));
  if (LamCellsPart(rve->micro.interface)) {
    PetscCall(LamContactCreate(&rve->micro, &rve->mesh, &rve->contact));
    if (rve->micro.interface == LAM_INTERFACE_LAMELLA)
      PetscCall(LamLayerCreate(&rve->micro, &rve->mesh, rve->contact, &rve->layer));
    PetscCall(LamSmoothCreate(rve));
  } else {
    PetscCall(LamLinearCreate(&rve->mesh, NULL, lumens, rve->linear));
  }
  PetscCall(LamMemoryCreate(rve));
  rve->ndof = 2 * rve->mesh.class_count;
  rve->length = rve->ndof + lumens;
  PetscCall(PetscCalloc4(rve->length, &rve->y, rve->length, &rve->step, rve->length, &rve->trial, rve->length,
                         &rve->residual));
  if (LamWallsTilt(&rve->micro)) rve->out_of_plane = PETSC_TRUE;
  PetscCheck(!LamWallsTilt(&rve->micro) || !LamWallsRelax(&rve->micro), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "walls with memory have no fibres that leave the section: leave `relaxation` or `fibre_angle` out");
  if (rve->out_of_plane) PetscCall(LamAntiplaneCreate(rve, &rve->antiplane));
  PetscCall(PetscMalloc3(lumens, &rve->seal.water, cells, &rve->seal.area, cells, &rve->seal.factor));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESetOutOfPlane(LamRVE rve, PetscBool on)
{
  PetscFunctionBeginUser;
  PetscCheck(!rve->is_set_up, PETSC_COMM_SELF, PETSC_ERR_ORDER, "LamRVESetOutOfPlane comes before LamRVESetUp");
  rve->out_of_plane = on;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESetUp(LamRVE rve)
{
  PetscFunctionBeginUser;
  if (rve->is_set_up) PetscFunctionReturn(0);
  PetscCheck(rve->has_micro, PETSC_COMM_SELF, PETSC_ERR_ORDER, "LamRVESetMicrostructure comes before LamRVESetUp");
  PetscCall(SetUpArrays(rve));
  rve->is_set_up = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVECreateLike(LamRVE rve, const LamMicrostructure *micro, LamWanted wanted, LamRVE *like)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVECreate(rve->comm, like));
  PetscCall(LamRVESetMicrostructure(*like, micro));
  (*like)->strategy = rve->strategy;
  (*like)->tolerance = rve->tolerance;
  (*like)->wanted = wanted;
  (*like)->monitor = rve->monitor;
  (*like)->interrupt = rve->interrupt;
  (*like)->interrupt_ctx = rve->interrupt_ctx;
  (*like)->seal.allowed = rve->seal.allowed;
  (*like)->out_of_plane = rve->out_of_plane;
  PetscCall(LamRVESetUp(*like));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEDestroy(LamRVE *rve)
{
  PetscFunctionBeginUser;
  if (!*rve) PetscFunctionReturn(0);
  PetscCall(LamRVEStateDestroy(&(*rve)->bonded_state));
  PetscCall(LamRVEDestroy(&(*rve)->bonded));
  PetscCall(LamAntiplaneDestroy(&(*rve)->antiplane));
  PetscCall(LamLayerDestroy(&(*rve)->layer));
  PetscCall(LamMemoryDestroy(&(*rve)->memory));
  PetscCall(LamContactDestroy(&(*rve)->contact));
  PetscCall(LamSmoothDestroy(&(*rve)->smooth));
  for (PetscInt k = 0; k < LAM_SYSTEMS; ++k) PetscCall(LamLinearDestroy(&(*rve)->systems[k]));
  PetscCall(LamMeshDestroy(&(*rve)->mesh));
  PetscCall(PetscFree((*rve)->law));
  PetscCall(LamMicrostructureDestroy(&(*rve)->micro));
  PetscCall(PetscFree((*rve)->geometry));
  PetscCall(PetscFree((*rve)->stress));
  PetscCall(PetscFree3((*rve)->seal.water, (*rve)->seal.area, (*rve)->seal.factor));
  PetscCall(PetscFree4((*rve)->y, (*rve)->step, (*rve)->trial, (*rve)->residual));
  PetscCall(PetscFree(*rve));
  PetscFunctionReturn(0);
}

/* Those of the exact law: positions, pressures, multipliers. */
static PetscInt CountUnknowns(LamRVE rve)
{
  return rve->systems[LAM_SYSTEM_BASE].n + (rve->contact ? rve->contact->count : 0);
}

PetscErrorCode LamRVEGetUnknowns(LamRVE rve, PetscInt *unknowns)
{
  PetscFunctionBeginUser;
  *unknowns = CountUnknowns(rve);
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVECountUnknowns(const LamMicrostructure *micro, PetscInt *unknowns)
{
  LamMesh mesh;
  const PetscErrorCode ierr = LamMeshCreate(micro, &mesh);
  PetscInt pairs = 0;

  PetscFunctionBeginUser;
  if (ierr) PetscCall(LamMeshDestroy(&mesh));
  PetscCall(ierr);
  for (PetscInt face = 0; face < mesh.tissue->faces; ++face) pairs += LamTissueIsSlave(mesh.tissue, face);
  *unknowns = 2 * (mesh.class_count - 1) + (LamCellsPart(micro->interface) ? pairs * (2 * mesh.along + 1) : 0);
  PetscCall(LamMeshDestroy(&mesh));
  PetscFunctionReturn(0);
}

PetscErrorCode LamCheckLoad(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  const PetscReal *F = load->F, det = F[0] * F[4] - F[1] * F[3];
  PetscBool finite = PETSC_TRUE;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 9; ++i) finite = (PetscBool)(finite && !PetscIsInfOrNanReal(F[i]));
  if (!finite)
    PetscCall(LamRefuse(response, LAM_INVALID_F, "F has a component that is not finite"));
  else if (PetscIsInfOrNanReal(load->turgor))
    PetscCall(LamRefuse(response, LAM_INVALID_F, "turgor is not finite"));
  else if (!(load->cohesion >= 0.0) || PetscIsInfOrNanReal(load->cohesion))
    PetscCall(LamRefuse(response, LAM_INVALID_F, "cohesion is %g; it must be finite and not negative",
                        (double)load->cohesion));
  else if (!(load->duration >= 0.0))
    PetscCall(
        LamRefuse(response, LAM_INVALID_F, "the duration is %g s; it must not be negative", (double)load->duration));
  else if (!rve->antiplane && (F[2] != 0.0 || F[5] != 0.0 || F[6] != 0.0 || F[7] != 0.0))
    PetscCall(LamRefuse(response, LAM_INVALID_F,
                        "F has out-of-plane shear, which is not allowed for this RVE (LamRVESetOutOfPlane)"));
  else if (rve->memory && (F[6] != 0.0 || F[7] != 0.0))
    PetscCall(LamRefuse(response, LAM_INVALID_F, "F has out-of-plane shear, which walls with memory do not carry"));
  else if (!(det > 0.0) || !(F[8] > 0.0))
    PetscCall(LamRefuse(response, LAM_INVALID_F,
                        "F turns the tissue inside out: in-plane determinant %g, F33 %g; both must be positive",
                        (double)det, (double)F[8]));
  PetscFunctionReturn(0);
}

/* Sets what tells the laws of contact apart, and the contact pressures of the smooth one. */
static PetscErrorCode FillContact(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  const LamDepths depths = LamFindDepths(rve, load);
  LamTouchForces forces = {.facing = 1.0};
  PetscReal sum;

  PetscFunctionBeginUser;
  response->contact_width = LamIsExact(rve) ? 0.0 : rve->smooth->width;
  if (!LamIsExact(rve)) PetscCall(LamSmoothPressures(rve, load, &forces));
  sum = forces.facing + forces.third + forces.lumen;
  response->third_fraction = sum > 0.0 ? forces.third / sum : 0.0;
  response->lumen_contact = sum > 0.0 ? forces.lumen / sum : 0.0;
  /* of facing walls in the exact law, the indicators measure it between the walls themselves */
  response->max_penetration = LamIsExact(rve) ? depths.other : PetscMax(depths.facing, depths.other);
  PetscFunctionReturn(0);
}

/* Energies of walls with memory, from the ledger of the solution. */
static void MemoryMeasures(const LamRVEState state, LamResponse *response)
{
  const LamMemoryLedger *ledger = &state->ledger;
  const PetscReal relaxed = ledger->elastic + ledger->retarded - ledger->dissipated; /* stored in springs */

  if (!state->points) {
    response->stored = response->energy;
    response->dissipated = response->dissipated_walls = 0.0;
  }
  response->stored += relaxed - ledger->step;
  response->dissipated += ledger->dissipated;
  response->dissipated_walls += ledger->dissipated;
}

/* Fills the fields of the solution in rve->y, whose consistent tangent is factored. */
static PetscErrorCode FillFields(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  PetscFunctionBeginUser;
  if (rve->contact) PetscCall(FillContact(rve, load, response));
  if (rve->wanted & (LAM_WANT_STRESS | LAM_WANT_DERIVATIVES)) PetscCall(LamHomogenise(rve, load, response));
  if (rve->layer) LamLayerMeasures(rve, load, response);
  if (rve->layer) PetscCall(LamCrackMeasure(rve, load, response));
  if (rve->wanted & LAM_WANT_WALLS) PetscCall(LamWallMeasures(rve, load, response));
  if (!(rve->wanted & LAM_WANT_INDICATORS)) PetscFunctionReturn(0);
  if (rve->contact) {
    PetscCall(LamContactIndicators(rve, load, response));
    PetscFunctionReturn(0);
  }
  PetscCall(LamFaceTractions(rve, load, response));
  LamBondedIndicators(rve, load, response);
  PetscFunctionReturn(0);
}

/* Rejects a bonded state in which walls have passed through each other. */
static PetscErrorCode RefuseCollapsedLumen(LamRVE rve, LamResponse *response)
{
  const PetscReal unknown[2] = {0.0, 0.0};
  PetscInt cell;

  PetscFunctionBeginUser;
  if (!LamResponseHasFields(response) || rve->contact) PetscFunctionReturn(0); /* contact solves have checked */
  PetscCall(LamFindCollapsedLumen(rve, rve->y, &cell));
  if (cell >= 0) PetscCall(LamRefuseCollapse(cell, unknown, LAM_NOT_CONVERGED, response));
  PetscFunctionReturn(0);
}

PetscErrorCode LamEndResponse(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response)
{
  PetscFunctionBeginUser;
  response->newton_iterations = rve->work.iterations;
  response->factorisations = rve->work.factorisations;
  if (rve->work.stopped) PetscCall(LamGiveUp(response));
  PetscCall(RefuseCollapsedLumen(rve, response));
  if (!LamResponseHasFields(response)) PetscFunctionReturn(0);
  PetscCall(FillFields(rve, load, response));
  response->stable = (PetscBool)(response->status == LAM_CONVERGED);
  if (!response->stable || response->zero_modes > 0) response->lowest_eigenvalue = rve->lowest_eigenvalue;
  LamKeepState(rve, load, response->branch, state);
  if (rve->memory) MemoryMeasures(state, response);
  if (rve->contact || rve->memory) LamKeepEnergy(response, state);
  PetscFunctionReturn(0);
}

PetscErrorCode LamBeginResponse(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(load, response));
  response->source = LAM_SOURCE_SOLVE;
  response->unknowns = CountUnknowns(rve);
  response->distance = 0.0;
  rve->work = (LamWork){0};
  rve->lowest_eigenvalue = NAN;
  LamForgetTangent(rve);
  if (rve->contact) PetscCall(LamSmoothReset(rve));
  LamTakeJunctions(rve, state);
  LamLayerTake(rve, state);
  LamTakeAxial(rve, state);
  LamMemoryTake(rve, state, load->duration);
  PetscFunctionReturn(0);
}

/* Continuation from a state to a load. */
static PetscErrorCode Follow(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response)
{
  PetscFunctionBeginUser;
  LamTakeJunctions(rve, state);
  if (rve->contact)
    PetscCall(LamContactFollowPath(rve, load, state, response));
  else
    PetscCall(LamFollowPath(rve, load, state, response));
  PetscFunctionReturn(0);
}

/* Continuation from the solution on a coarser mesh; from `state` if that fails. */
static PetscErrorCode FollowNested(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response)
{
  LamRVEState start;
  LamResponse coarse;

  PetscFunctionBeginUser;
  PetscCall(LamRVEStateCreate(rve, &start));
  PetscCall(LamRVEStateCopy(state, start));
  PetscCall(LamNestedStart(rve, load, start, &coarse));
  if (start->solved) PetscCall(Follow(rve, load, start, response));
  PetscCall(LamRVEStateDestroy(&start));
  if (LamResponseHasFields(&coarse)) {
    if (response->status != LAM_CONVERGED && !rve->work.stopped) PetscCall(Follow(rve, load, state, response));
  } else {
    PetscCall(LamRefuse(response, coarse.status, "%s", coarse.reason));
  }
  PetscFunctionReturn(0);
}

/* A load in the frame of the section. */
static PetscErrorCode SolveSection(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response)
{
  const PetscReal begin = LamClock();
  const PetscBool interrupted = rve->work.stopped; /* the solve before this one */
  const PetscBool has_history = (PetscBool)(rve->layer || rve->memory);
  const PetscBool looks =
      (PetscBool)((has_history || ((rve->wanted & LAM_WANT_JUMPS) && rve->contact && state->solved)) &&
                  !rve->looks_back);
  LamRVEState before = NULL;

  PetscFunctionBeginUser;
  if (looks) PetscCall(LamRVEStateCreate(rve, &before));
  if (looks) PetscCall(LamRVEStateCopy(state, before));
  PetscCall(LamBeginResponse(rve, load, state, response));
  PetscCall(LamCheckLoad(rve, load, response));
  if (response->status == LAM_INVALID_F) {
    PetscCall(LamRVEStateDestroy(&before));
    PetscFunctionReturn(0);
  }
  /* after an interrupted solve, before the first assembly: the rest of an interrupted batch costs nothing */
  rve->work.stopped = (PetscBool)(interrupted && rve->interrupt && rve->interrupt(rve->interrupt_ctx));
  if (!rve->work.stopped && LamIsOutOfPlane(rve, load, state))
    PetscCall(LamSolveOutOfPlane(rve, load, state, response));
  else if (!rve->work.stopped)
    PetscCall(LamIsNested(rve, state) ? FollowNested(rve, load, state, response) : Follow(rve, load, state, response));
  PetscCall(LamEndResponse(rve, load, state, response));
  if (looks && has_history) PetscCall(LamHistoryStep(rve, before, NULL, state, response));
  if (looks && !has_history) PetscCall(LamSeeJump(rve, before, state, response));
  PetscCall(LamRVEStateDestroy(&before));
  response->seconds = LamClock() - begin;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESolve(LamRVE rve, const LamLoad *load, LamRVEState state, LamResponse *response)
{
  const LamLoad given = *load;
  LamLoad section = *load;

  PetscFunctionBeginUser;
  if (rve->antiplane) section = LamSectionLoad(load);
  PetscCall(SolveSection(rve, &section, state, response));
  if (!rve->antiplane) PetscFunctionReturn(0);
  LamSectionTurnBack(&given, response);
  if (LamResponseHasFields(response)) state->given = given;
  PetscFunctionReturn(0);
}
