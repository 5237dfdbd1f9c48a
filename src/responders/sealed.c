/*
  Response of sealed lumens from a responder for prescribed turgor (docs/theory/walls.md, Sealed lumens).

  Method. At each point a Newton iteration finds the pressure p with
    c(p) = dPsi/dp + v_w (1 - (p - p0) / K_w) = 0,      dc/dp = Psi_pp - v_w / K_w < 0,
  starting at the pressure of the last response. c decreases with p, so each response bounds the root on one side, and a
  pressure without a response bounds the search. A step beyond a bound is replaced by bisection of the interval.
*/
#include <lamella/sealed.h>
#include <math.h>
#include <string.h>

#define MOST_QUESTIONS 40
#define MOST_FAILURES 8 /* pressures without a response */
#define TOLERANCE 1e-10 /* of p, relative and in units of C1 + C2 */

/* Of a material point. */
typedef struct {
  PetscReal lumen; /* of the last open response; 0: none */
  PetscReal pressure;
} State;

typedef struct {
  MPI_Comm comm;
  LamResponder open;             /* borrowed */
  LamResponderCounters counters; /* of `open` */
  PetscInt points;
  PetscReal bulk_modulus; /* 0: not sealed */
  PetscReal *water;       /* [points] */
  State *now, *accepted;  /* [points] */
} Sealed;

/* The search for one pressure. */
typedef struct {
  PetscReal pressure;  /* to be asked next */
  PetscReal low, high; /* bounds of the root */
  PetscReal answered;  /* the last pressure with a response; NaN: none yet */
  PetscInt failures;
  PetscBool done; /* converged if the last response has fields, else failed */
} Search;

void LamResponseSeal(PetscReal p0, PetscReal water, PetscReal bulk_modulus, LamResponse *r)
{
  const PetscReal p = r->load.turgor, compliance = water / bulk_modulus, over = p - p0;
  const PetscReal share = 1 / (compliance - r->energy_turgor2), follows = compliance * share; /* dp/dp0 */

  for (int i = 0; i < 9; i++)
    for (int j = 0; j < 9; j++) r->tangent[9 * i + j] += share * r->P_turgor[i] * r->P_turgor[j];
  for (int i = 0; i < 9; i++) {
    r->P_cohesion[i] += share * r->P_turgor[i] * r->energy_turgor_cohesion;
    r->P_turgor[i] *= follows;
  }
  r->energy += water * p - 0.5 * compliance * over * over;
  r->energy_cohesion2 += share * r->energy_turgor_cohesion * r->energy_turgor_cohesion;
  r->energy_turgor_cohesion *= follows;
  r->energy_turgor = compliance * over;
  r->energy_turgor2 = compliance * (follows - 1);
  r->load.turgor = p0;
  r->turgor_mean = p;
  r->turgor_spread = 0;
}

/* Processes the response at the pressure: sets the next one, or `done`. */
static void Advance(const Sealed *s, PetscReal p0, PetscReal water, const LamResponse *r, Search *search)
{
  const PetscReal p = search->pressure;
  PetscReal next = p;

  if (LamResponseHasFields(r)) {
    const PetscReal compliance = water / s->bulk_modulus;
    const PetscReal excess = r->energy_turgor + water - compliance * (p - p0);
    const PetscReal step = excess / (compliance - LamResponseConcavity(r));

    search->answered = p;
    search->done = (PetscBool)(fabs(step) <= TOLERANCE * (1 + fabs(p)));
    *(excess > 0 ? &search->low : &search->high) = p;
    next = p + step;
  } else {
    search->done = (PetscBool)(isnan(search->answered) || ++search->failures == MOST_FAILURES);
    *(p > search->answered ? &search->high : &search->low) = p;
  }
  if (search->done) return;
  search->pressure = next > search->low && next < search->high ? next : 0.5 * (search->low + search->high);
}

/*
  The error of the pressure is the error of the lumen divided by v_w / K_w - Psi_pp, about 1e-3. A table of bonded cells
  gives lumens to O(p/kappa) from F alone. Where cells separate, the gaps would have to be known far more accurately
  than for the stress.
*/
static PetscErrorCode Refuse(LamResponse *r)
{
  PetscFunctionBeginUser;
  if (r->energy_turgor2 <= 0 && (r->source != LAM_SOURCE_DATABASE || r->energy_cohesion == 0)) PetscFunctionReturn(0);
  r->status = LAM_OUT_OF_REACH;
  PetscCall(
      PetscStrncpy(r->reason,
                   "a database does not know the lumens of cells that part well enough for the pressure of sealed "
                   "ones: solve directly",
                   sizeof(r->reason)));
  PetscFunctionReturn(0);
}

static PetscErrorCode Finish(Sealed *s, PetscInt point, const LamLoad *load, LamResponse *r)
{
  char why[sizeof(r->reason)];

  PetscFunctionBeginUser;
  if (LamResponseHasFields(r)) PetscCall(Refuse(r));
  if (LamResponseHasFields(r)) {
    s->now[point].pressure = r->load.turgor;
    LamResponseSeal(load->turgor, s->water[point], s->bulk_modulus, r);
    PetscFunctionReturn(0);
  }
  PetscCall(PetscStrncpy(why, r->reason, sizeof(why)));
  PetscCall(PetscSNPrintf(r->reason, sizeof(r->reason), "sealed, at a pressure of %.4g (C1+C2): %s",
                          (double)r->load.turgor, why));
  r->load = *load;
  PetscFunctionReturn(0);
}

static PetscErrorCode Find(Sealed *s, PetscInt n, const LamLoad loads[], const PetscInt points[], Search search[],
                           LamResponse responses[])
{
  PetscInt *query_points, *from, most = 1;
  LamResponse *found;
  LamLoad *queries;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n, &queries, n, &query_points, n, &from, n, &found));
  for (PetscInt round = 0; round < MOST_QUESTIONS && most; round++) {
    PetscInt count = 0;

    for (PetscInt i = 0; i < n; i++) {
      if (search[i].done) continue;
      queries[count] = loads[i];
      queries[count].turgor = search[i].pressure;
      query_points[count] = points[i];
      from[count++] = i;
    }
    PetscCallMPI(MPI_Allreduce(&count, &most, 1, MPIU_INT, MPI_MAX, s->comm));
    if (!most) break;
    PetscCall(LamResponderRespond(s->open, count, queries, query_points, found));
    for (PetscInt k = 0; k < count; k++) {
      const PetscInt i = from[k];

      responses[i] = found[k];
      Advance(s, loads[i].turgor, s->water[points[i]], &found[k], &search[i]);
    }
  }
  PetscCall(PetscFree4(queries, query_points, from, found));
  PetscFunctionReturn(0);
}

static PetscErrorCode RespondSealed(Sealed *s, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                    LamResponse responses[])
{
  Search *search;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &search));
  for (PetscInt i = 0; i < n; i++) {
    PetscCheck(points && points[i] >= 0 && points[i] < s->points, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "a sealed response needs a material point below %d, whose water it is", (int)s->points);
    search[i] = (Search){.pressure = s->now[points[i]].pressure, .low = -INFINITY, .high = INFINITY, .answered = NAN};
  }
  PetscCall(Find(s, n, loads, points, search, responses));
  for (PetscInt i = 0; i < n; i++) {
    if (!search[i].done && LamResponseHasFields(&responses[i])) {
      responses[i].status = LAM_NOT_CONVERGED;
      PetscCall(PetscStrncpy(responses[i].reason, "the pressure is not found", sizeof(responses[i].reason)));
    }
    PetscCall(Finish(s, points[i], &loads[i], &responses[i]));
  }
  PetscCall(PetscFree(search));
  PetscFunctionReturn(0);
}

static PetscErrorCode Respond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                              LamResponse responses[])
{
  Sealed *s = (Sealed *)ctx;

  PetscFunctionBeginUser;
  if (s->bulk_modulus > 0) {
    PetscCall(RespondSealed(s, n, loads, points, responses));
  } else {
    PetscCall(LamResponderRespond(s->open, n, loads, points, responses));
    for (PetscInt i = 0; i < n; i++)
      if (points && points[i] >= 0 && LamResponseHasFields(&responses[i]))
        s->now[points[i]] = (State){-responses[i].energy_turgor, loads[i].turgor};
  }
  s->counters = LamResponderGetCounters(s->open);
  PetscFunctionReturn(0);
}

static PetscErrorCode Accept(void *ctx)
{
  Sealed *s = (Sealed *)ctx;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(s->accepted, s->now, s->points));
  PetscCall(LamResponderAccept(s->open));
  PetscFunctionReturn(0);
}

static PetscErrorCode Reject(void *ctx)
{
  Sealed *s = (Sealed *)ctx;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(s->now, s->accepted, s->points));
  PetscCall(LamResponderReject(s->open));
  PetscFunctionReturn(0);
}

static PetscErrorCode Seal(void *ctx, PetscReal bulk_modulus)
{
  Sealed *s = (Sealed *)ctx;

  PetscFunctionBeginUser;
  PetscCheck(bulk_modulus > 0 && isfinite(bulk_modulus), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "bulk modulus of water %g; it must be positive and finite", (double)bulk_modulus);
  for (PetscInt i = 0; i < s->points; i++) {
    PetscCheck(s->accepted[i].lumen > 0, PETSC_COMM_SELF, PETSC_ERR_ORDER,
               "material point %d has no accepted response whose water it could keep", (int)i);
    s->water[i] = s->accepted[i].lumen;
  }
  s->bulk_modulus = bulk_modulus;
  PetscFunctionReturn(0);
}

/* Saved state of a point, in front of the bytes of `open`. */
typedef struct {
  PetscReal bulk_modulus; /* 0: not sealed */
  PetscReal water;
  State state;
} Kept;

static PetscErrorCode StateSize(void *ctx, size_t *bytes)
{
  Sealed *s = (Sealed *)ctx;

  PetscFunctionBeginUser;
  PetscCall(LamResponderGetStateSize(s->open, bytes));
  *bytes += sizeof(Kept);
  PetscFunctionReturn(0);
}

static PetscErrorCode Save(void *ctx, PetscInt point, void *bytes)
{
  Sealed *s = (Sealed *)ctx;
  const Kept kept = {s->bulk_modulus, s->water[point], s->accepted[point]};

  PetscFunctionBeginUser;
  memcpy(bytes, &kept, sizeof(kept));
  PetscCall(LamResponderSave(s->open, point, (char *)bytes + sizeof(kept)));
  PetscFunctionReturn(0);
}

static PetscErrorCode Load(void *ctx, PetscInt point, const void *bytes)
{
  Sealed *s = (Sealed *)ctx;
  Kept kept;

  PetscFunctionBeginUser;
  memcpy(&kept, bytes, sizeof(kept));
  s->bulk_modulus = kept.bulk_modulus;
  s->water[point] = kept.water;
  s->now[point] = s->accepted[point] = kept.state;
  PetscCall(LamResponderLoad(s->open, point, (const char *)bytes + sizeof(kept)));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **ctx)
{
  Sealed *s = (Sealed *)*ctx;

  PetscFunctionBeginUser;
  PetscCall(PetscFree3(s->water, s->now, s->accepted));
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSealedResponderCreate(MPI_Comm comm, LamResponder open, PetscInt points, LamResponder *responder)
{
  static const LamResponderFunctions functions = {.respond = Respond,
                                                  .accept = Accept,
                                                  .reject = Reject,
                                                  .seal = Seal,
                                                  .destroy = Destroy,
                                                  .state_size = StateSize,
                                                  .save = Save,
                                                  .load = Load};
  Sealed *s;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *s = (Sealed){.comm = comm, .open = open, .points = points};
  PetscCall(PetscCalloc3(points, &s->water, points, &s->now, points, &s->accepted));
  PetscCall(LamResponderCreate(&functions, s, &s->counters, responder));
  PetscFunctionReturn(0);
}
