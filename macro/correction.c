/*
  The correction of the reactions of one state by a reference responder.

  Method. To first order the correction of a reaction is the sum over the material points of G : dP (sensitivity.c), dP
  the stress of the reference at the F that the run has reached less that of the run. The reference is asked at all
  points, or at a sample whose draws are in proportion to the correction that the error estimates let expect; then the
  sum has a confidence interval (sample.c). Points that the run has solved itself need no correction.

  Size of a point: (estimate + mean estimate) (|P| + floor) times |G|, for each component over its sum. The mean keeps
  points of too small an estimate in reach: half the draws go by the estimate, half do not.
*/
#include <math.h>
#include <stdlib.h>
#include "gather.h"
#include "macro_impl.h"
#include "sample.h"

enum { MOST = 2 * LAM_MAX_BOUNDARIES };
/* Parts of the margin beside that of the sample (docs/results/performance.md, Certified reactions).
   SECOND_ORDER: of the correction; chosen, some ten times what was measured.
   Of the force on the side, of cells that come apart: SPREAD, by which direct runs of more and fewer steps differ
   (1.4e-4 was measured), and UNSEEN for the few points in a hundred that are on another branch than the table, which a
   sample seldom meets (5e-4 was measured). */
static const PetscReal SECOND_ORDER = 0.05, SPREAD = 2e-4, UNSEEN = 1e-3;

/* ---- the points to solve ---- */

/* What the certificate of one state works on; points are those of this rank. */
typedef struct {
  LamSensitivity sensitivity;
  PetscBool *interpolated;  /* [points] */
  PetscInt64 *number;       /* [points] in the undistributed mesh, by which points are ordered on all ranks */
  PetscReal *size;          /* [points] expected share of the corrections */
  PetscReal *value;         /* [count][total] G : dP of the drawn points */
  PetscReal constant[MOST]; /* corrections that need no sample */
  PetscInt total, *place;   /* points of all ranks that are interpolated; [points] where this rank's are among them */
  PetscInt *draws, drawn;   /* [total] */
  PetscReal *share, *sizes; /* [total] */
} Work;

static PetscReal Norm(PetscInt n, const PetscReal values[])
{
  PetscReal square = 0;

  for (PetscInt k = 0; k < n; k++) square += values[k] * values[k];
  return PetscSqrtReal(square);
}

/* Whether the inflated body is sampled, too: it is not the same everywhere. */
static PetscBool SamplesInflated(LamMacro macro, const Work *work)
{
  return (PetscBool)(work->sensitivity.inflated && !macro->inflated.dP);
}

/* The told error of a response; 0: not told. */
static PetscReal Told(const LamMaterialPoint *point)
{
  return isfinite(point->field[LAM_POINT_ERROR]) ? point->field[LAM_POINT_ERROR] : 0;
}

/* The error of stress to expect at each point, [points]: told errors and stresses are raised by their means, so that no
   point is never drawn. */
static PetscErrorCode ExpectErrors(LamMacro macro, const LamMaterialPoint points[], PetscReal expected[])
{
  PetscReal sum[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < macro->point_count; p++) {
    if (points[p].field[LAM_POINT_INTERPOLATED] == 0) continue;
    sum[0] += Told(&points[p]);
    sum[1] += Norm(9, points[p].P);
    sum[2] += 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPIU_SUM, macro->comm));
  const PetscReal mean = sum[0] > 0 ? sum[0] / sum[2] : 1, stress = sum[1] / PetscMax(1, sum[2]);
  for (PetscInt p = 0; p < macro->point_count; p++)
    expected[p] =
        points[p].field[LAM_POINT_INTERPOLATED] == 0 ? 0 : (Told(&points[p]) + mean) * (Norm(9, points[p].P) + stress);
  PetscFunctionReturn(0);
}

static PetscErrorCode Sizes(LamMacro macro, Work *work)
{
  const LamSensitivity *s = &work->sensitivity;
  const PetscInt n = macro->point_count, entries = macro->strains;
  PetscReal *expected, *before, *size;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(n, &expected, n, &before, n, &size));
  PetscCall(ExpectErrors(macro, macro->now, expected));
  if (SamplesInflated(macro, work)) PetscCall(ExpectErrors(macro, macro->inflated.points, before));
  for (PetscInt k = 0; k < s->count; k++) {
    PetscReal sum = 0;
    for (PetscInt p = 0; p < n; p++) {
      size[p] = expected[p] * Norm(entries, &s->G[(k * n + p) * entries]);
      if (before[p] > 0) size[p] += before[p] * Norm(entries, &s->inflated[(k * n + p) * entries]);
      sum += size[p];
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPIU_SUM, macro->comm));
    for (PetscInt p = 0; p < n && sum > 0; p++) work->size[p] += size[p] / sum;
  }
  for (PetscInt p = 0; p < n; p++) work->interpolated[p] = (PetscBool)(expected[p] > 0 || before[p] > 0);
  PetscCall(PetscFree3(expected, before, size));
  PetscFunctionReturn(0);
}

/* A point in the order of all ranks. */
typedef struct {
  PetscInt64 number;
  PetscReal size;
} Item;

static int CompareItems(const void *a, const void *b)
{
  const PetscInt64 one = ((const Item *)a)->number, other = ((const Item *)b)->number;

  return (one > other) - (one < other);
}

/* Draws from the interpolated points of all ranks. */
static PetscErrorCode Draw(LamMacro macro, PetscInt wanted, PetscInt64 seed, Work *work)
{
  PetscInt own = 0;
  PetscReal *sizes;
  Item *mine, *all, *found;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(macro->point_count, &mine));
  for (PetscInt p = 0; p < macro->point_count; p++)
    if (work->interpolated[p]) mine[own++] = (Item){work->number[p], work->size[p]};
  PetscCall(LamGatherUnion(macro->comm, sizeof(Item), CompareItems, own, mine, &work->total, (void **)&all));
  PetscCall(PetscMalloc3(work->total, &work->draws, work->total, &work->share, work->total, &sizes));
  for (PetscInt i = 0; i < work->total; i++) sizes[i] = all[i].size;
  PetscCall(LamSampleDraw(work->total, sizes, wanted, seed, work->draws, work->share, &work->drawn));
  for (PetscInt p = 0; p < macro->point_count; p++) {
    const Item item = {work->number[p], 0};
    if (!work->interpolated[p]) continue;
    found = (Item *)bsearch(&item, all, (size_t)work->total, sizeof(Item), CompareItems);
    work->place[p] = (PetscInt)(found - all);
  }
  work->sizes = sizes;
  PetscCall(PetscFree(mine));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* ---- their stress ---- */

/* Points without an answer, and the first reason. */
typedef struct {
  PetscInt count;
  char why[sizeof(((LamResponse *)0)->reason)];
} Failed;

/* dP [strains] of a response against that of the run. */
static void Compare(LamMacro macro, const LamResponse *response, const LamMaterialPoint *point, PetscReal dP[],
                    Failed *failed)
{
  if (!LamResponseHasFields(response)) {
    if (!failed->count++) (void)PetscStrncpy(failed->why, response->reason, sizeof(failed->why));
    return;
  }
  for (PetscInt k = 0; k < macro->strains; k++) {
    const PetscInt entry = LamMacroEntry(macro, k);
    dP[k] = response->P[entry] - point->P[entry];
  }
}

/* All points at once: the reference keeps the state of each. dP [points][strains]. */
static PetscErrorCode SolveAll(LamMacro macro, const LamMaterialPoint points[], PetscReal dP[], Failed *failed)
{
  const PetscInt n = macro->point_count, entries = macro->strains;
  LamLoad *loads;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &loads));
  for (PetscInt p = 0; p < n; p++) loads[p] = points[p].load;
  PetscCall(LamResponderRespond(macro->reference, n, loads, macro->point_index, macro->responses));
  for (PetscInt p = 0; p < n; p++) Compare(macro, &macro->responses[p], &points[p], &dP[p * entries], failed);
  if (failed->count)
    PetscCall(LamResponderReject(macro->reference));
  else
    PetscCall(LamResponderAccept(macro->reference));
  PetscCall(PetscFree(loads));
  PetscFunctionReturn(0);
}

/* Whether all ranks have all answers, else the reason of one that lacks some, or that the run is to stop. */
static PetscErrorCode Judge(LamMacro macro, const Failed *failed, LamMacroCertificate *certificate)
{
  PetscBool stopped = (PetscBool)(macro->stop && macro->stop()), mine = PETSC_FALSE;
  PetscMPIInt rank = 0, any = failed->count > 0;
  char text[sizeof(certificate->why)] = "";

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, macro->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &stopped, 1, MPIU_BOOL, MPI_LOR, macro->comm));
  if (!any) PetscFunctionReturn(0);
  PetscCall(LamMacroFindRank(macro, failed->count ? 0 : 1, &rank, &mine));
  if (mine) PetscCall(PetscSNPrintf(text, sizeof(text), "a point is not solved: %.150s", failed->why));
  PetscCallMPI(MPI_Bcast(text, sizeof(text), MPI_CHAR, rank, macro->comm));
  LamMacroUncertified(certificate, stopped ? "stopped before its points were solved" : text);
  PetscFunctionReturn(0);
}

/* Of a uniform inflated body one point stands for all: that of the rank with the lowest element. */
static PetscErrorCode SolveUniform(LamMacro macro, PetscReal dP[], Failed *failed)
{
  const PetscInt entries = macro->strains, point = 0;
  PetscReal lowest = INFINITY, one[LAM_MACRO_STRAINS] = {0};
  PetscMPIInt rank = 0;
  PetscBool mine = PETSC_FALSE;
  LamResponse response;

  PetscFunctionBeginUser;
  for (PetscInt e = 0; e < macro->element_count; e++) lowest = PetscMin(lowest, (PetscReal)macro->elements[e].number);
  PetscCall(LamMacroFindRank(macro, lowest, &rank, &mine));
  if (mine) {
    PetscCall(LamResponderReject(macro->reference));
    PetscCall(LamResponderRespond(macro->reference, 1, &macro->inflated.points[point].load, &point, &response));
    Compare(macro, &response, &macro->inflated.points[point], one, failed);
  }
  PetscCallMPI(MPI_Bcast(one, (int)entries, MPIU_REAL, rank, macro->comm));
  for (PetscInt k = 0; k < macro->point_count * entries; k++) dP[k] = one[k % entries];
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSolveInflated(LamMacro macro, LamMacroCertificate *certificate)
{
  LamMacroInflated *inflated = &macro->inflated;
  const PetscBool all = (PetscBool)(macro->certify == LAM_CERTIFY_ALL);
  Failed failed = {0};
  PetscReal *dP;

  PetscFunctionBeginUser;
  if (!inflated->points || inflated->dP || !(all || inflated->uniform)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(macro->point_count * macro->strains, &dP));
  if (all)
    PetscCall(SolveAll(macro, inflated->points, dP, &failed));
  else
    PetscCall(SolveUniform(macro, dP, &failed));
  PetscCall(Judge(macro, &failed, certificate));
  if (certificate->why[0])
    PetscCall(PetscFree(dP));
  else
    inflated->dP = dP;
  PetscFunctionReturn(0);
}

static PetscReal Dot(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0;

  for (PetscInt k = 0; k < n; k++) sum += a[k] * b[k];
  return sum;
}

/* The part of the inflated body where its dP is known at all points. */
static PetscErrorCode AddConstants(LamMacro macro, Work *work)
{
  const LamSensitivity *s = &work->sensitivity;
  const PetscInt values = macro->point_count * macro->strains;

  PetscFunctionBeginUser;
  if (!s->inflated || !macro->inflated.dP) PetscFunctionReturn(0);
  for (PetscInt c = 0; c < s->count; c++) work->constant[c] = Dot(values, &s->inflated[c * values], macro->inflated.dP);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, work->constant, MOST, MPIU_REAL, MPIU_SUM, macro->comm));
  PetscFunctionReturn(0);
}

/* Adds G : dP of a drawn point to its value. */
static void AddValue(LamMacro macro, const PetscReal G[], PetscInt p, const PetscReal dP[], Work *work)
{
  const PetscInt entries = macro->strains;

  for (PetscInt c = 0; c < work->sensitivity.count; c++)
    work->value[c * work->total + work->place[p]] += Dot(entries, &G[(c * macro->point_count + p) * entries], dP);
}

/* Leads a drawn point to its present state. */
static PetscErrorCode AskPoint(LamMacro macro, PetscInt p, PetscInt step, Work *work, Failed *failed)
{
  const PetscBool samples = SamplesInflated(macro, work);
  PetscReal dP[LAM_MACRO_STRAINS], before[LAM_MACRO_STRAINS];
  LamResponse response, inflated;

  PetscFunctionBeginUser;
  PetscCall(LamMacroLead(macro, p, step, &macro->now[p].load, samples ? &inflated : NULL, &response));
  Compare(macro, &response, &macro->now[p], dP, failed);
  if (samples) Compare(macro, &inflated, &macro->inflated.points[p], before, failed);
  if (failed->count) PetscFunctionReturn(0);
  AddValue(macro, work->sensitivity.G, p, dP, work);
  if (samples) AddValue(macro, work->sensitivity.inflated, p, before, work);
  PetscFunctionReturn(0);
}

/* Fills the values of the drawn points. */
static PetscErrorCode Ask(LamMacro macro, PetscInt step, Work *work, Failed *failed)
{
  const PetscInt entries = macro->strains;
  const LamSensitivity *s = &work->sensitivity;
  PetscReal *dP = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->count * work->total, &work->value));
  if (macro->certify == LAM_CERTIFY_ALL) {
    PetscCall(PetscMalloc1(macro->point_count * entries, &dP));
    PetscCall(SolveAll(macro, macro->now, dP, failed));
  }
  for (PetscInt p = 0; p < macro->point_count && !failed->count; p++) {
    if (!work->interpolated[p] || !work->draws[work->place[p]]) continue;
    if (dP)
      AddValue(macro, s->G, p, &dP[p * entries], work);
    else
      PetscCall(AskPoint(macro, p, step, work, failed));
  }
  PetscCall(PetscFree(dP));
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, work->value, (int)(s->count * work->total), MPIU_REAL, MPIU_SUM, macro->comm));
  PetscFunctionReturn(0);
}

/* ---- the corrected reactions ---- */

static PetscErrorCode WorkCreate(LamMacro macro, Work *work)
{
  const PetscInt n = macro->point_count;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(n, &work->interpolated, n, &work->number, n, &work->size, n, &work->place));
  for (PetscInt p = 0; p < n; p++) {
    const LamMacroElement *element = &macro->elements[macro->point_element[p]];
    work->number[p] = (PetscInt64)element->number * LAM_MACRO_NODES + p - element->first; /* fewer points than nodes */
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode WorkDestroy(Work *work)
{
  PetscFunctionBeginUser;
  PetscCall(LamMacroSensitivityDestroy(&work->sensitivity));
  PetscCall(PetscFree4(work->interpolated, work->number, work->size, work->place));
  PetscCall(PetscFree3(work->draws, work->share, work->sizes));
  PetscCall(PetscFree(work->value));
  PetscFunctionReturn(0);
}

/* Reactions with their corrections, and margins. */
static void Add(LamMacro macro, const Work *work, LamMacroCertificate *certificate)
{
  const LamSensitivity *s = &work->sensitivity;
  PetscReal force[LAM_MAX_BOUNDARIES];

  for (PetscInt k = 0; k < LAM_MAX_BOUNDARIES; k++) force[k] = Norm(2, certificate->reaction[k]);
  for (PetscInt c = 0; c < s->count; c++) {
    PetscReal *reaction = &certificate->reaction[s->side[c]][s->component[c]], sum, margin;

    LamSampleSum(work->total, work->draws, work->share, work->drawn, &work->value[c * work->total], &sum, &margin);
    sum += work->constant[c];
    *reaction += sum;
    margin += SECOND_ORDER * PetscAbsReal(sum);
    if (macro->branches) margin += (work->drawn ? UNSEEN : SPREAD) * force[s->side[c]];
    certificate->margin[s->side[c]][s->component[c]] = margin;
  }
  certificate->of = work->total;
  for (PetscInt i = 0; i < work->total; i++) certificate->points += work->draws[i] != 0;
}

PetscErrorCode LamMacroCorrect(LamMacro macro, PetscInt wanted, PetscInt64 seed, LamMacroCertificate *certificate)
{
  Failed failed = {0};
  Work work = {0};
  PetscBool ok;

  PetscFunctionBeginUser;
  PetscCall(LamMacroSolveInflated(macro, certificate));
  if (certificate->why[0]) PetscFunctionReturn(0);
  PetscCall(WorkCreate(macro, &work));
  PetscCall(LamMacroSensitivityCreate(macro, &work.sensitivity, &ok));
  if (ok) {
    PetscCall(Sizes(macro, &work));
    PetscCall(Draw(macro, wanted, seed, &work));
    PetscCall(AddConstants(macro, &work));
    PetscCall(Ask(macro, certificate->step, &work, &failed));
    PetscCall(Judge(macro, &failed, certificate));
  } else
    LamMacroUncertified(certificate, "the tangent of the body is singular");
  if (!certificate->why[0]) Add(macro, &work, certificate);
  PetscCall(WorkDestroy(&work));
  PetscFunctionReturn(0);
}
