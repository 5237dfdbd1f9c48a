/*
  The onset of separation along the states of a scene.

  Method. While the states are solved, the last one that is not separated is kept, on both meshes, until one is. The
  load between the two, linear in F, turgor and cohesion, is then bisected: each load in between is solved from the
  nearest one below that is not separated, because contact is easier lost than found again.
*/
#include "onset.h"

const char *const LamOnsetStatusNames[] = {LAM_ONSET_STATUSES(LAM_NAME_ENTRY)};

/* Width of the bracket, as a share of the way between two states. */
#define RESOLUTION 1e-3

PetscErrorCode LamOnsetCreate(const LamMeshes *meshes, LamOnset *onset)
{
  PetscFunctionBeginUser;
  *onset = (LamOnset){.status = LAM_ONSET_NOT_MET, .bracket = {0, 1}};
  for (PetscInt m = 0; m < 2; m++) PetscCall(LamRVEStateCreate(meshes->rve[m], &onset->closed[m]));
  PetscFunctionReturn(0);
}

PetscErrorCode LamOnsetDestroy(LamOnset *onset)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < 2; m++) PetscCall(LamRVEStateDestroy(&onset->closed[m]));
  PetscFunctionReturn(0);
}

/* The present states are not separated: the onset lies behind them. */
static PetscErrorCode KeepClosed(LamOnset *onset, const LamMeshes *meshes)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < 2; m++) PetscCall(LamRVEStateCopy(meshes->state[m], onset->closed[m]));
  PetscFunctionReturn(0);
}

static void KeepSeparated(LamOnset *onset, const LamResponse responses[2], LamSeparation separation)
{
  onset->load = responses[0].load;
  onset->criterion = separation;
  for (PetscInt m = 0; m < 2; m++) onset->responses[m] = responses[m];
}

/* `where`: the load that has no answer. */
static PetscErrorCode KeepReason(LamOnset *onset, const char where[], const LamResponse responses[2])
{
  const PetscInt m = LamResponseHasFields(&responses[0]) ? 1 : 0;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(onset->reason, sizeof(onset->reason), "%s has no answer on the %s mesh: %s", where,
                          m ? "second" : "first", responses[m].reason));
  PetscFunctionReturn(0);
}

/* The first state without an answer is the one to look at. */
static PetscErrorCode KeepUnknown(LamOnset *onset, PetscInt number, const LamResponse responses[2])
{
  char where[LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  if (onset->status == LAM_ONSET_UNKNOWN) PetscFunctionReturn(0);
  onset->status = LAM_ONSET_UNKNOWN;
  PetscCall(PetscSNPrintf(where, sizeof(where), "state %" PetscInt_FMT, number));
  PetscCall(KeepReason(onset, where, responses));
  PetscFunctionReturn(0);
}

PetscErrorCode LamOnsetWatch(LamOnset *onset, const LamMeshes *meshes, PetscInt number, const LamResponse responses[2])
{
  const LamSeparation separation = LamSeparationOf(responses);

  PetscFunctionBeginUser;
  onset->last = number;
  if (onset->states[1]) PetscFunctionReturn(0);
  if (separation == LAM_SEPARATION_UNKNOWN) {
    PetscCall(KeepUnknown(onset, number, responses));
    PetscFunctionReturn(0);
  }
  if (separation == LAM_SEPARATION_NONE) {
    onset->states[0] = number;
    onset->ends[0] = responses[0].load;
    PetscCall(KeepClosed(onset, meshes));
    PetscFunctionReturn(0);
  }
  onset->states[1] = number;
  onset->ends[1] = responses[0].load;
  onset->status = onset->states[0] ? LAM_ONSET_FOUND : LAM_ONSET_BEFORE_FIRST;
  if (onset->status == LAM_ONSET_FOUND) onset->reason[0] = '\0'; /* states without an answer are passed over */
  KeepSeparated(onset, responses, separation);
  PetscFunctionReturn(0);
}

static LamLoad Between(const LamLoad ends[2], PetscReal share)
{
  LamLoad load;

  for (int i = 0; i < 9; i++) load.F[i] = (1 - share) * ends[0].F[i] + share * ends[1].F[i];
  load.turgor = (1 - share) * ends[0].turgor + share * ends[1].turgor;
  load.cohesion = (1 - share) * ends[0].cohesion + share * ends[1].cohesion;
  return load;
}

/* Solves in the middle of the bracket and halves it; a load without an answer ends the search. */
static PetscErrorCode Halve(LamOnset *onset, LamMeshes *meshes)
{
  const PetscReal middle = 0.5 * (onset->bracket[0] + onset->bracket[1]);
  const LamLoad load = Between(onset->ends, middle);
  LamSeparation separation;
  LamResponse responses[2];

  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < 2; m++) PetscCall(LamRVEStateCopy(onset->closed[m], meshes->state[m]));
  PetscCall(LamMeshesSolve(meshes, &load, NULL, responses));
  if (meshes->stopped) {
    onset->status = LAM_ONSET_STOPPED;
    PetscCall(PetscStrncpy(onset->reason, "stopped by a signal", sizeof(onset->reason)));
    PetscFunctionReturn(0);
  }
  separation = LamSeparationOf(responses);
  if (separation == LAM_SEPARATION_UNKNOWN) {
    onset->status = LAM_ONSET_NOT_CONVERGED;
    PetscCall(KeepReason(onset, "a load in between", responses));
  } else if (separation == LAM_SEPARATION_NONE) {
    onset->bracket[0] = middle;
    PetscCall(KeepClosed(onset, meshes));
  } else {
    onset->bracket[1] = middle;
    KeepSeparated(onset, responses, separation);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamOnsetFind(LamOnset *onset, LamMeshes *meshes, PetscInt count)
{
  PetscFunctionBeginUser;
  if (onset->status == LAM_ONSET_NOT_MET && onset->last < count) {
    onset->status = LAM_ONSET_UNKNOWN;
    PetscCall(PetscSNPrintf(onset->reason, sizeof(onset->reason), "stopped by a signal before state %" PetscInt_FMT,
                            onset->last + 1));
  }
  while (onset->status == LAM_ONSET_FOUND && onset->bracket[1] - onset->bracket[0] > RESOLUTION)
    PetscCall(Halve(onset, meshes));
  PetscFunctionReturn(0);
}

PetscBool LamOnsetIsUnsolved(const LamOnset *onset)
{
  return (PetscBool)(onset->reason[0] != '\0');
}

/* ---- what is told ---- */

/* The family with the largest mean traction, of those that a patch has. */
static PetscInt LoosestFace(const LamResponse *r)
{
  PetscInt face = 0;

  for (PetscInt k = 1; k < 3; k++)
    if (isnan(r->mean_face_traction[face]) || r->mean_face_traction[k] > r->mean_face_traction[face]) face = k;
  return face;
}

static json_t *BracketToJSON(const LamOnset *onset, PetscReal MPa)
{
  json_t *o = json_object(), *gaps, *tractions;

  json_object_set_new(o, "status", json_string(LamOnsetStatusNames[onset->status]));
  if (onset->reason[0]) json_object_set_new(o, "reason", json_string(onset->reason));
  if (!onset->states[1]) return o;
  json_object_set_new(o, "states", json_pack("[I, I]", (json_int_t)onset->states[0], (json_int_t)onset->states[1]));
  json_object_set_new(o, "fraction", json_real(onset->bracket[1]));
  json_object_set_new(o, "bracket", LamJSONReals(2, onset->bracket, 1));
  json_object_set_new(o, "F", LamJSONReals(9, onset->load.F, 1));
  json_object_set_new(o, "turgor", LamJSONReal(onset->load.turgor * MPa));
  json_object_set_new(o, "cohesion", LamJSONReal(onset->load.cohesion * MPa));
  json_object_set_new(o, "criterion", json_string(LamSeparationNames[onset->criterion]));
  json_object_set_new(o, "face", json_integer(LoosestFace(&onset->responses[1])));
  gaps = json_array();
  tractions = json_array();
  for (PetscInt m = 0; m < 2; m++) {
    json_array_append_new(gaps, LamJSONReal(onset->responses[m].max_gap));
    json_array_append_new(tractions, LamJSONReals(3, onset->responses[m].mean_face_traction, MPa));
  }
  json_object_set_new(o, "max_gap", gaps);
  json_object_set_new(o, "mean_face_traction", tractions);
  return o;
}

static void PrintBracket(const LamOnset *onset, PetscReal MPa)
{
  const LamLoad *load = &onset->load;

  printf("onset of separation: between states %" PetscInt_FMT " and %" PetscInt_FMT
         ", at %.4f of the way (bracket %.4f "
         "to %.4f)\n",
         onset->states[0], onset->states[1], (double)onset->bracket[1], (double)onset->bracket[0],
         (double)onset->bracket[1]);
  printf("  F = [%.6g, %.6g; %.6g, %.6g], turgor %.6g MPa, cohesion %.6g MPa\n", (double)load->F[0], (double)load->F[1],
         (double)load->F[3], (double)load->F[4], (double)(load->turgor * MPa), (double)(load->cohesion * MPa));
  if (onset->criterion == LAM_SEPARATION_GAP)
    printf("  largest gap %.3g and %.3g apothems on the two meshes, above %g\n", (double)onset->responses[0].max_gap,
           (double)onset->responses[1].max_gap, LAM_VISIBLE_GAP);
  else
    printf("  mean traction of face family %" PetscInt_FMT " reaches the cohesion on both meshes\n",
           LoosestFace(&onset->responses[1]));
  if (onset->reason[0]) printf("  not bracketed further: %s\n", onset->reason);
}

PetscErrorCode LamOnsetPrint(const LamOnset *onset, const LamScales *scales, PetscBool json)
{
  const PetscReal MPa = scales->stress * 1e-6;

  PetscFunctionBeginUser;
  if (json) {
    PetscCall(LamPrintJSON(json_pack("{s:o}", "onset", BracketToJSON(onset, MPa))));
    PetscFunctionReturn(0);
  }
  if (onset->status == LAM_ONSET_NOT_MET) {
    printf("onset of separation: not met, no state is separated\n");
  } else if (onset->status == LAM_ONSET_UNKNOWN) {
    printf("onset of separation: unknown, no state is known to be separated; %s\n", onset->reason);
  } else if (onset->status == LAM_ONSET_BEFORE_FIRST) {
    printf("onset of separation: before state %" PetscInt_FMT ", the first that is known, which is separated\n",
           onset->states[1]);
    if (onset->reason[0]) printf("  %s\n", onset->reason);
  } else {
    PrintBracket(onset, MPa);
  }
  PetscFunctionReturn(0);
}
