#include <lamella/heterogeneous.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct {
  PetscInt tissue_count, n;
  LamHeterogeneousTissue *tissues;
  LamHeterogeneousPoint *points;
  PetscInt (*number)[LAM_BLEND_TERMS]; /* [point] its index in the tissue of each term */
  LamResponderCounters counters;
} Heterogeneous;

/* ---- rotation and scaling ---- */

/* The load in the axes and units of the tissue: F Q. */
static LamLoad ToTissue(const LamLoad *load, PetscReal angle, PetscReal stress)
{
  LamLoad own = {.turgor = load->turgor / stress, .cohesion = load->cohesion / stress, .duration = load->duration};
  const PetscReal c = cos(angle), s = sin(angle);

  memcpy(own.F, load->F, sizeof(own.F));
  for (int i = 0; i < 3 && angle != 0; i++) {
    own.F[3 * i] = c * load->F[3 * i] + s * load->F[3 * i + 1];
    own.F[3 * i + 1] = c * load->F[3 * i + 1] - s * load->F[3 * i];
  }
  return own;
}

/* Multiplies n rows of three by Q^T: rows are `stride` apart, the entries of a row `step` apart. */
static void TurnRows(PetscReal A[], PetscInt n, PetscInt stride, PetscInt step, PetscReal c, PetscReal s)
{
  for (PetscInt i = 0; i < n; i++) {
    PetscReal *a = &A[i * stride];
    const PetscReal first = a[0], second = a[step];

    a[0] = c * first - s * second;
    a[step] = s * first + c * second;
  }
}

static void Turn(PetscReal angle, LamResponse *r)
{
  const PetscReal c = cos(angle), s = sin(angle);

  TurnRows(r->P, 3, 3, 1, c, s);
  TurnRows(r->P_turgor, 3, 3, 1, c, s);
  TurnRows(r->P_cohesion, 3, 3, 1, c, s);
  TurnRows(r->tangent, 27, 3, 1, c, s);                                     /* kl: l */
  for (int i = 0; i < 3; i++) TurnRows(&r->tangent[27 * i], 9, 1, 9, c, s); /* ij: j */
}

/* ---- queries ---- */

/* at[k]: response of term k. Without fields in one term the response has none, with that term's status and reason. */
static PetscErrorCode Combine(const Heterogeneous *heterogeneous, const LamHeterogeneousPoint *point,
                              const LamResponse at[], LamResponse *response)
{
  PetscFunctionBeginUser;
  PetscCall(LamResponseInit(&at[0].load, response));
  for (PetscInt k = 0; k < point->count; k++) {
    const char *name = heterogeneous->tissues[point->term[k].knot].name;

    if (LamResponseHasFields(&at[k])) continue;
    response->status = at[k].status;
    response->source = at[k].source;
    snprintf(response->reason, sizeof(response->reason), "%s%s%.150s", name, name[0] ? ": " : "", at[k].reason);
    PetscFunctionReturn(0);
  }
  if (point->count == 1)
    *response = at[0];
  else
    LamBlend(heterogeneous->tissues[point->term[0].knot].scale, point->count, point->term, at, response);
  PetscFunctionReturn(0);
}

/* Sums the tissues' counters. */
static void SumCounters(Heterogeneous *heterogeneous)
{
  LamResponderCounters *sum = &heterogeneous->counters;

  *sum = (LamResponderCounters){0};
  for (PetscInt t = 0; t < heterogeneous->tissue_count; t++) {
    const LamResponderCounters part = LamResponderGetCounters(heterogeneous->tissues[t].responder);

    sum->queries += part.queries;
    sum->hits += part.hits;
    sum->interpolated += part.interpolated;
    sum->solves += part.solves;
    sum->failures += part.failures;
    sum->query_seconds += part.query_seconds;
    sum->solve_seconds += part.solve_seconds;
  }
}

/* Queries each tissue for all its terms. parts: responses of query i from start[i] on, one per term, in the axes and
   units of the body. */
static PetscErrorCode QueryTissues(const Heterogeneous *heterogeneous, PetscInt n, const LamLoad loads[],
                                   const PetscInt points[], const PetscInt start[], LamResponse parts[])
{
  PetscInt *numbers, *query, *part;
  LamResponse *responses;
  LamLoad *own;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(n, &own, n, &numbers, n, &query, n, &part, n, &responses));
  for (PetscInt t = 0; t < heterogeneous->tissue_count; t++) {
    const LamHeterogeneousTissue *tissue = &heterogeneous->tissues[t];
    PetscInt count = 0;

    for (PetscInt i = 0; i < n; i++) {
      const LamHeterogeneousPoint *point = &heterogeneous->points[points[i]];

      for (PetscInt k = 0; k < point->count; k++) {
        if (point->term[k].knot != t) continue;
        own[count] = ToTissue(&loads[i], point->angle, tissue->stress);
        numbers[count] = heterogeneous->number[points[i]][k];
        query[count] = i;
        part[count++] = start[i] + k;
      }
    }
    PetscCall(LamResponderRespond(tissue->responder, count, own, numbers, responses));
    for (PetscInt q = 0; q < count; q++) {
      const PetscReal angle = heterogeneous->points[points[query[q]]].angle;
      LamResponse *r = &parts[part[q]];

      *r = responses[q];
      LamResponseScale(tissue->stress, r);
      if (angle != 0) Turn(angle, r);
      r->load = loads[query[q]];
    }
  }
  PetscCall(PetscFree5(own, numbers, query, part, responses));
  PetscFunctionReturn(0);
}

/* ---- responder ---- */

static PetscErrorCode HeterogeneousRespond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                                           LamResponse responses[])
{
  Heterogeneous *heterogeneous = (Heterogeneous *)ctx;
  PetscInt *start;
  LamResponse *parts;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n + 1, &start));
  start[0] = 0;
  for (PetscInt i = 0; i < n; i++) {
    PetscCheck(points[i] >= 0 && points[i] < heterogeneous->n, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "material point %" PetscInt_FMT ", of %" PetscInt_FMT, points[i], heterogeneous->n);
    start[i + 1] = start[i] + heterogeneous->points[points[i]].count;
  }
  PetscCall(PetscMalloc1(start[n], &parts));
  PetscCall(QueryTissues(heterogeneous, n, loads, points, start, parts));
  for (PetscInt i = 0; i < n; i++)
    PetscCall(Combine(heterogeneous, &heterogeneous->points[points[i]], &parts[start[i]], &responses[i]));
  PetscCall(PetscFree(parts));
  PetscCall(PetscFree(start));
  SumCounters(heterogeneous);
  PetscFunctionReturn(0);
}

static PetscErrorCode HeterogeneousAccept(void *ctx)
{
  Heterogeneous *heterogeneous = (Heterogeneous *)ctx;

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < heterogeneous->tissue_count; t++)
    PetscCall(LamResponderAccept(heterogeneous->tissues[t].responder));
  PetscFunctionReturn(0);
}

static PetscErrorCode HeterogeneousReject(void *ctx)
{
  Heterogeneous *heterogeneous = (Heterogeneous *)ctx;

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < heterogeneous->tissue_count; t++)
    PetscCall(LamResponderReject(heterogeneous->tissues[t].responder));
  PetscFunctionReturn(0);
}

/* All tissues have the same bulk modulus of water; each term of a blend keeps its own water. */
static PetscErrorCode HeterogeneousSeal(void *ctx, PetscReal bulk_modulus)
{
  Heterogeneous *heterogeneous = (Heterogeneous *)ctx;

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < heterogeneous->tissue_count; t++) {
    const LamHeterogeneousTissue *tissue = &heterogeneous->tissues[t];

    PetscCall(LamResponderSeal(tissue->responder, bulk_modulus / tissue->stress));
  }
  PetscFunctionReturn(0);
}

/* ---- saved state: those of a point's terms, concatenated ---- */

static PetscErrorCode StateSize(void *ctx, size_t *bytes)
{
  Heterogeneous *heterogeneous = (Heterogeneous *)ctx;

  PetscFunctionBeginUser;
  *bytes = 0;
  for (PetscInt p = 0; p < heterogeneous->n; p++) {
    size_t sum = 0;

    for (PetscInt k = 0; k < heterogeneous->points[p].count; k++) {
      const LamResponder responder = heterogeneous->tissues[heterogeneous->points[p].term[k].knot].responder;
      size_t size;

      PetscCall(LamResponderGetStateSize(responder, &size));
      sum += size;
    }
    *bytes = PetscMax(*bytes, sum);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Save(void *ctx, PetscInt point, void *bytes)
{
  Heterogeneous *heterogeneous = (Heterogeneous *)ctx;
  char *at = bytes;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < heterogeneous->points[point].count; k++) {
    const LamResponder responder = heterogeneous->tissues[heterogeneous->points[point].term[k].knot].responder;
    size_t size;

    PetscCall(LamResponderSave(responder, heterogeneous->number[point][k], at));
    PetscCall(LamResponderGetStateSize(responder, &size));
    at += size;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Load(void *ctx, PetscInt point, const void *bytes)
{
  Heterogeneous *heterogeneous = (Heterogeneous *)ctx;
  const char *at = bytes;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < heterogeneous->points[point].count; k++) {
    const LamResponder responder = heterogeneous->tissues[heterogeneous->points[point].term[k].knot].responder;
    size_t size;

    PetscCall(LamResponderLoad(responder, heterogeneous->number[point][k], at));
    PetscCall(LamResponderGetStateSize(responder, &size));
    at += size;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode HeterogeneousDestroy(void **ctx)
{
  Heterogeneous *heterogeneous = (Heterogeneous *)*ctx;

  PetscFunctionBeginUser;
  if (!heterogeneous) PetscFunctionReturn(0);
  PetscCall(PetscFree3(heterogeneous->tissues, heterogeneous->points, heterogeneous->number));
  PetscCall(PetscFree(*ctx));
  PetscFunctionReturn(0);
}

PetscInt LamHeterogeneousPointCount(PetscInt n, const LamHeterogeneousPoint points[], PetscInt tissue)
{
  PetscInt count = 0;

  for (PetscInt p = 0; p < n; p++)
    for (PetscInt k = 0; k < points[p].count; k++) count += points[p].term[k].knot == tissue;
  return count;
}

/* Numbers the points of each tissue in the order of the body's points. */
static PetscErrorCode NumberPoints(Heterogeneous *heterogeneous)
{
  PetscInt *next;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(heterogeneous->tissue_count, &next));
  for (PetscInt p = 0; p < heterogeneous->n; p++)
    for (PetscInt k = 0; k < heterogeneous->points[p].count; k++)
      heterogeneous->number[p][k] = next[heterogeneous->points[p].term[k].knot]++;
  PetscCall(PetscFree(next));
  PetscFunctionReturn(0);
}

PetscErrorCode LamHeterogeneousCreate(PetscInt tissue_count, const LamHeterogeneousTissue tissues[], PetscInt n,
                                      const LamHeterogeneousPoint points[], LamResponder *responder)
{
  static const LamResponderFunctions functions = {.respond = HeterogeneousRespond,
                                                  .accept = HeterogeneousAccept,
                                                  .reject = HeterogeneousReject,
                                                  .seal = HeterogeneousSeal,
                                                  .destroy = HeterogeneousDestroy,
                                                  .state_size = StateSize,
                                                  .save = Save,
                                                  .load = Load};
  Heterogeneous *heterogeneous;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&heterogeneous));
  heterogeneous->tissue_count = tissue_count;
  heterogeneous->n = n;
  PetscCall(PetscMalloc3(tissue_count, &heterogeneous->tissues, n, &heterogeneous->points, n, &heterogeneous->number));
  PetscCall(PetscArraycpy(heterogeneous->tissues, tissues, tissue_count));
  PetscCall(PetscArraycpy(heterogeneous->points, points, n));
  PetscCall(NumberPoints(heterogeneous));
  PetscCall(LamResponderCreate(&functions, heterogeneous, &heterogeneous->counters, responder));
  PetscFunctionReturn(0);
}
