#include "endurance.h"
#include "tissue.h"

#define ENDURANCE_POINTS 2

static PetscBool EnduranceInterrupt(void *ctx)
{
  Endurance *e = (Endurance *)ctx;

  if (e->calls_left < 0) return PETSC_FALSE;
  return (PetscBool)(e->calls_left-- == 0);
}

/* ---- memory ---- */

size_t MemoryInUse(void)
{
  const struct mallinfo2 info = mallinfo2();

  return info.uordblks + info.hblkhd;
}

size_t MemoryResident(void)
{
  long total = 0, resident = 0;
  FILE *file;

  malloc_trim(0);
  file = fopen("/proc/self/statm", "r");
  if (!file) return 0;
  if (fscanf(file, "%ld %ld", &total, &resident) != 2) resident = 0;
  fclose(file);
  return (size_t)resident * (size_t)sysconf(_SC_PAGESIZE);
}

/* ---- tissues ---- */

static PetscErrorCode EnduranceTissueCreate(const LamMicrostructure *micro, PetscBool sealable, Endurance *e,
                                            EnduranceTissue *t)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVECreate(PETSC_COMM_SELF, &t->rve));
  PetscCall(LamRVESetMicrostructure(t->rve, micro));
  PetscCall(LamRVESetSealable(t->rve, sealable));
  PetscCall(LamRVESetInterrupt(t->rve, EnduranceInterrupt, e));
  PetscCall(LamRVESetUp(t->rve));
  PetscCall(LamRVEStateCreate(t->rve, &t->state));
  PetscCall(LamRVEStateCreate(t->rve, &t->reference));
  PetscFunctionReturn(0);
}

static PetscErrorCode EnduranceTissueDestroy(EnduranceTissue *t)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStateDestroy(&t->state));
  PetscCall(DestroyTissue(&t->rve, &t->reference));
  PetscFunctionReturn(0);
}

PetscErrorCode EnduranceCreate(Endurance *e)
{
  LamMicrostructure bonded = DefaultTissue(), contact, coarse;
  LamLoad start = PlaneLoad(1, 0, 0, 1, 0.2);
  PetscReal water[1];
  LamResponse r;

  PetscFunctionBeginUser;
  *e = (Endurance){.calls_left = -1};
  bonded.along = 4;
  contact = bonded;
  contact.interface = LAM_INTERFACE_CONTACT;
  PetscCall(EnduranceTissueCreate(&bonded, PETSC_FALSE, e, &e->bonded));
  PetscCall(EnduranceTissueCreate(&contact, PETSC_FALSE, e, &e->contact));
  PetscCall(EnduranceTissueCreate(&bonded, PETSC_TRUE, e, &e->sealed));
  coarse = bonded;
  coarse.along = 2;
  coarse.through = 1;
  PetscCall(EnduranceTissueCreate(&coarse, PETSC_FALSE, e, &e->coarse));
  coarse.interface = LAM_INTERFACE_CONTACT;
  PetscCall(EnduranceTissueCreate(&coarse, PETSC_FALSE, e, &e->coarse_contact));
  PetscCall(LamRVESolve(e->sealed.rve, &start, e->sealed.state, &r));
  PetscCall(LamRVEGetLumens(e->sealed.rve, e->sealed.state, water));
  PetscCall(LamRVESeal(e->sealed.rve, 2200.0 / TISSUE_STRESS, water));
  PetscCall(LamRVEEstimateCreate(e->bonded.rve, &e->estimate));
  PetscCall(LamRVEResponderCreate(e->bonded.rve, ENDURANCE_POINTS, &e->responder));
  PetscCall(LamRVEStateSize(e->bonded.state, &e->size));
  PetscCall(PetscMalloc(e->size, &e->bytes));
  PetscFunctionReturn(0);
}

PetscErrorCode EnduranceDestroy(Endurance *e)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(e->bytes));
  PetscCall(LamResponderDestroy(&e->responder));
  PetscCall(LamRVEEstimateDestroy(&e->estimate));
  PetscCall(EnduranceTissueDestroy(&e->coarse_contact));
  PetscCall(EnduranceTissueDestroy(&e->coarse));
  PetscCall(EnduranceTissueDestroy(&e->sealed));
  PetscCall(EnduranceTissueDestroy(&e->contact));
  PetscCall(EnduranceTissueDestroy(&e->bonded));
  PetscFunctionReturn(0);
}

/* ---- states ---- */

/* A path that never repeats and does the same work everywhere: three frequencies that have no common period. */
static LamLoad EnduranceLoad(PetscInt k)
{
  const double t = (double)k;

  return PlaneLoad(1.04 + 0.04 * sin(0.11 * t), 0.1 + 0.1 * sin(0.1618034 * t), 0, 1.02 + 0.02 * sin(0.0732051 * t),
                   0.2 + 0.1 * sin(0.0414214 * t));
}

static PetscErrorCode EnduranceMixed(Endurance *e, PetscInt k, LamResponse *r)
{
  const LamStressControl control = {.given = {1, 0, 0, 0, 1, 0, 0, 0, 0}};
  LamLoad load = EnduranceLoad(k);

  PetscFunctionBeginUser;
  PetscCall(LamRVESolveMixed(e->bonded.rve, &load, &control, e->bonded.state, r));
  PetscFunctionReturn(0);
}

static PetscErrorCode EnduranceBytes(Endurance *e, const LamLoad *load, LamResponse *r)
{
  PetscFunctionBeginUser;
  PetscCall(LamRVEStatePack(e->bonded.state, e->bytes));
  PetscCall(LamRVESolve(e->bonded.rve, load, e->bonded.state, r));
  PetscCall(LamRVEStateUnpack(e->bytes, e->bonded.state));
  PetscFunctionReturn(0);
}

static PetscErrorCode EnduranceRespond(Endurance *e, const LamLoad *load, PetscInt k, LamResponse *r)
{
  const LamLoad loads[ENDURANCE_POINTS] = {*load, EnduranceLoad(k + 3)};
  const PetscInt points[ENDURANCE_POINTS] = {0, 1};
  LamResponse responses[ENDURANCE_POINTS];

  PetscFunctionBeginUser;
  PetscCall(LamResponderRespond(e->responder, ENDURANCE_POINTS, loads, points, responses));
  PetscCall(k % 4 ? LamResponderAccept(e->responder) : LamResponderReject(e->responder));
  *r = responses[0];
  PetscFunctionReturn(0);
}

/* Another microstructure: bonded, contact, several cells, by turns. */
static PetscErrorCode EnduranceRebuild(Endurance *e, const LamLoad *load, PetscInt k, LamResponse *r)
{
  LamMicrostructure micro = DefaultTissue();
  EnduranceTissue t;

  PetscFunctionBeginUser;
  micro.along = 4;
  micro.through = 1;
  micro.wall_thickness = 0.1 + 0.01 * (double)(k % 7);
  if (k % 3 == 1) micro.interface = LAM_INTERFACE_CONTACT;
  if (k % 3 == 2) micro.cells[1] = 2;
  PetscCall(EnduranceTissueCreate(&micro, PETSC_FALSE, e, &t));
  PetscCall(LamRVESolve(t.rve, load, t.state, r));
  PetscCall(EnduranceTissueDestroy(&t));
  PetscFunctionReturn(0);
}

PetscErrorCode EnduranceSolve(Endurance *e, EnduranceKind kind, PetscInt k, LamResponse *r)
{
  LamLoad load = EnduranceLoad(k);

  PetscFunctionBeginUser;
  if (kind == ENDURANCE_BONDED) PetscCall(LamRVESolve(e->bonded.rve, &load, e->bonded.state, r));
  if (kind == ENDURANCE_CONTACT) PetscCall(LamRVESolve(e->contact.rve, &load, e->contact.state, r));
  if (kind == ENDURANCE_SEALED) PetscCall(LamRVESolve(e->sealed.rve, &load, e->sealed.state, r));
  if (kind == ENDURANCE_MIXED) PetscCall(EnduranceMixed(e, k, r));
  if (kind == ENDURANCE_BYTES) PetscCall(EnduranceBytes(e, &load, r));
  if (kind == ENDURANCE_RESPONDER) PetscCall(EnduranceRespond(e, &load, k, r));
  if (kind == ENDURANCE_REBUILD) PetscCall(EnduranceRebuild(e, &load, k, r));
  if (kind == ENDURANCE_ESTIMATE) {
    PetscCall(LamRVESolve(e->bonded.rve, &load, e->bonded.state, r));
    PetscCall(LamRVEEstimateError(e->estimate, e->bonded.state, r));
  }
  if (r->status != LAM_CONVERGED) ++e->unexpected;
  PetscFunctionReturn(0);
}

/* ---- failures ---- */

/* A load that the failure has in it. */
static LamLoad FailingLoad(EnduranceFailure failure, PetscInt k)
{
  LamLoad load = EnduranceLoad(k);

  if (failure == FAILURE_NAN) load.F[0] = NAN;
  if (failure == FAILURE_INSIDE_OUT) load.F[0] = -1;
  if (failure == FAILURE_ANTIPLANE) load.F[2] = 0.1;
  if (failure == FAILURE_COHESION) load.cohesion = -1;
  if (failure == FAILURE_COLLAPSE) load = PlaneLoad(0.4, 0, 0, 1, 0);
  if (failure == FAILURE_COLLAPSE_CONTACT) load = PlaneLoad(0.2, 0, 0, 1, 0); /* less room than the walls take */
  if (failure == FAILURE_OVERLAP) load = PlaneLoad(0.2, 2, 0, 1, 0.2);
  if (failure == FAILURE_NO_EQUILIBRIUM || failure == FAILURE_UNSTABLE) load = PlaneLoad(1, 0, 0, 1, 0);
  return load;
}

/* What is prescribed beside the load; NULL: nothing. */
static const LamStressControl *FailingControl(EnduranceFailure failure)
{
  static const LamStressControl spins = {.given = {0, 1, 0, 1, 0, 0, 0, 0, 0}},
                                swells = {.given = {1, 0, 0, 0, 1, 0, 0, 0, 0}},
                                crushed = {.given = {1, 1, 0, 0, 1, 0, 0, 0, 0}, .P = {0, 0, 0, 0, -0.45, 0, 0, 0, 0}},
                                pressed = {.given = {1, 1, 0, 0, 1, 0, 0, 0, 0}, .P = {0, 0, 0, 0, -0.09, 0, 0, 0, 0}};

  if (failure == FAILURE_CONTROL) return &spins;
  if (failure == FAILURE_INTERRUPT_MIXED) return &swells;
  if (failure == FAILURE_NO_EQUILIBRIUM) return &crushed;
  if (failure == FAILURE_UNSTABLE) return &pressed;
  return NULL;
}

static EnduranceTissue *FailingTissue(Endurance *e, EnduranceFailure failure)
{
  if (failure == FAILURE_INTERRUPT_CONTACT) return &e->contact;
  if (failure == FAILURE_COLLAPSE_CONTACT || failure == FAILURE_OVERLAP) return &e->coarse_contact;
  return failure < FAILURE_COLLAPSE ? &e->bonded : &e->coarse;
}

PetscErrorCode EnduranceFail(Endurance *e, EnduranceFailure failure, PetscInt k, LamResponse *r)
{
  const LamStressControl *control = FailingControl(failure);
  EnduranceTissue *t = FailingTissue(e, failure);
  const LamLoad load = FailingLoad(failure, k);

  PetscFunctionBeginUser;
  if (failure >= FAILURE_INTERRUPT && failure <= FAILURE_INTERRUPT_MIXED) e->calls_left = k / 10 % 3;
  PetscCall(LamRVEStateReset(t->rve, t->reference));
  if (control)
    PetscCall(LamRVESolveMixed(t->rve, &load, control, t->reference, r));
  else
    PetscCall(LamRVESolve(t->rve, &load, t->reference, r));
  e->calls_left = -1;
  ++e->statuses[failure][r->status];
  if (r->status == LAM_CONVERGED) ++e->unexpected;
  PetscFunctionReturn(0);
}

/* ---- the program of states ---- */

EnduranceKind EnduranceKindOf(PetscInt k, PetscInt rebuild_every)
{
  static const EnduranceKind kinds[10] = {ENDURANCE_BONDED, ENDURANCE_CONTACT,  ENDURANCE_BONDED, ENDURANCE_MIXED,
                                          ENDURANCE_BONDED, ENDURANCE_SEALED,   ENDURANCE_BYTES,  ENDURANCE_BONDED,
                                          ENDURANCE_BONDED, ENDURANCE_RESPONDER};

  if (rebuild_every && k % rebuild_every == rebuild_every - 1) return ENDURANCE_REBUILD;
  if (k % 50 == 4) return ENDURANCE_ESTIMATE;
  return kinds[k % 10];
}

EnduranceFailure EnduranceFailureOf(PetscInt k, PetscInt dear)
{
  const PetscInt n = k / 10;

  if (n % dear == dear - 1) return (EnduranceFailure)(FAILURE_COLLAPSE + n / dear % (FAILURE_COUNT - FAILURE_COLLAPSE));
  return (EnduranceFailure)(n % FAILURE_COLLAPSE);
}
