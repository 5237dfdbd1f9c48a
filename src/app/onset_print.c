/*
  The onset of separation, as JSON and human-readable.
*/
#include "app.h"
#include "failure_print.h"

/* The face family with the largest mean traction, of those present in a patch. */
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
