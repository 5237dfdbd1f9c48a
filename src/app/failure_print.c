/*
  Failure and separation, human-readable and as JSON: wall and lamella stresses of a state, the failure mode of a load
  path, and the onset of separation.
*/
#include "app.h"
#include "failure.h"

#define NO_SHEAR 1e-9 /* C1 + C2: rounding */

/* ---- a state ---- */

/* Prints cell, face, fraction of the face. */
static void PrintPlace(const PetscReal place[3])
{
  if (isfinite(place[0])) printf(" at %.0f/%.0f/%.2f", (double)place[0], (double)place[1], (double)place[2]);
}

/* "wall 0.143 MPa (0.29 of its strength) at 0/2/0.44" */
static void PrintMeasure(const char name[], PetscReal value, PetscReal strength, const PetscReal place[3],
                         PetscReal MPa)
{
  printf("%s %.4g MPa", name, (double)(value * MPa));
  if (isfinite(strength)) printf(" (%.3g of its strength)", (double)(value / strength));
  PrintPlace(place);
}

static void PrintMeasures(const LamResponse *r, const LamStrength *strength, PetscReal MPa)
{
  PrintMeasure("wall", r->max_wall_tension, strength->wall, r->wall_place, MPa);
  PrintMeasure(", lamella normal", r->max_traction, strength->lamella_normal, r->normal_place, MPa);
  if (r->max_lamella_shear > NO_SHEAR)
    PrintMeasure(", shear", r->max_lamella_shear, strength->lamella_shear, r->shear_place, MPa);
  putchar('\n');
}

void LamFailurePrintState(const LamResponse *response, const LamStrength *strength, const LamScales *scales)
{
  if (!LamResponseHasFields(response)) return;
  printf("      ");
  PrintMeasures(response, strength, scales->stress * 1e-6);
}

static void PrintLoad(const LamLoad *load, PetscReal MPa)
{
  printf("  F = [%.6g, %.6g; %.6g, %.6g], ", (double)load->F[0], (double)load->F[1], (double)load->F[3],
         (double)load->F[4]);
  if (load->F[8] != 1) printf("F33 %.6g, ", (double)load->F[8]);
  printf("turgor %.6g MPa, cohesion %.6g MPa\n", (double)(load->turgor * MPa), (double)(load->cohesion * MPa));
}

static void AddLoad(json_t *o, const LamLoad *load, PetscReal MPa)
{
  json_object_set_new(o, "F", LamJSONReals(9, load->F, 1));
  json_object_set_new(o, "turgor", LamJSONReal(load->turgor * MPa));
  json_object_set_new(o, "cohesion", LamJSONReal(load->cohesion * MPa));
}

/* ---- failure mode, JSON output ---- */

json_t *LamPlaceToJSON(const PetscReal place[3])
{
  if (!isfinite(place[0])) return json_null();
  return json_pack("{s:I, s:I, s:f}", "cell", (json_int_t)place[0], "face", (json_int_t)place[1], "along",
                   (double)place[2]);
}

static json_t *OnsetToJSON(const LamCriterionOnset *onset)
{
  json_t *o = json_object();

  json_object_set_new(o, "judged", json_boolean(onset->judged));
  if (!onset->judged) return o;
  json_object_set_new(o, "factor", LamJSONReal(onset->factor));
  if (isnan(onset->factor)) return o;
  json_object_set_new(o, "bracket", LamJSONReals(2, onset->bracket, 1));
  json_object_set_new(o, "place", LamPlaceToJSON(onset->place));
  return o;
}

/* Strength of the wall relative to the lamella below which the wall fails first; NaN if one of them is not in
   tension. */
static PetscReal Ratio(PetscReal wall, PetscReal lamella)
{
  return wall > 0 && lamella > NO_SHEAR ? wall / lamella : NAN;
}

static json_t *ThreeToJSON(PetscReal wall, PetscReal normal, PetscReal shear, PetscReal scale)
{
  return json_pack("{s:o, s:o, s:o}", "wall", LamJSONReal(wall * scale), "lamella_normal", LamJSONReal(normal * scale),
                   "lamella_shear", LamJSONReal(shear * scale));
}

static json_t *FailureToJSON(const LamFailure *failure, PetscReal MPa)
{
  const LamResponse *r = &failure->response;
  const LamStrength *strength = failure->program.strength;
  const PetscReal wall = r->max_wall_tension, normal = r->max_traction, shear = r->max_lamella_shear;
  const PetscReal ratios[2] = {Ratio(wall, normal), Ratio(wall, shear)};
  json_t *o = json_object(), *criteria = json_object();

  json_object_set_new(o, "mode", json_string(LamFailureModeNames[failure->mode]));
  json_object_set_new(o, "criterion",
                      failure->criterion == LAM_CRITERION_COUNT ? json_null()
                                                                : json_string(LamCriterionNames[failure->criterion]));
  json_object_set_new(o, "factor", LamJSONReal(failure->factor));
  json_object_set_new(o, "followed", LamJSONReal(failure->followed));
  if (failure->reason[0]) json_object_set_new(o, "reason", json_string(failure->reason));
  AddLoad(o, &failure->load, MPa);
  json_object_set_new(o, "strength",
                      ThreeToJSON(strength->wall, strength->lamella_normal, strength->lamella_shear, MPa));
  json_object_set_new(o, "measures", ThreeToJSON(wall, normal, shear, MPa));
  json_object_set_new(o, "wall_over_lamella", LamJSONReals(2, ratios, 1));
  for (int c = 0; c < LAM_CRITERION_COUNT; c++)
    json_object_set_new(criteria, LamCriterionNames[c], OnsetToJSON(&failure->onset[c]));
  json_object_set_new(o, "criteria", criteria);
  return o;
}

/* ---- failure mode, human-readable output ---- */

static void PrintVerdict(const LamFailure *failure)
{
  if (isnan(failure->followed))
    printf("failure: unknown from the beginning\n");
  else if (failure->mode == LAM_FAILURE_NONE)
    printf("failure: none; no criterion that can be judged is reached up to load factor %.4g\n",
           (double)failure->followed);
  else if (failure->mode == LAM_FAILURE_UNKNOWN)
    printf("failure: unknown; no criterion is reached up to load factor %.4g\n", (double)failure->followed);
  else
    printf("failure: %s (%s) at load factor %.4f\n", LamFailureModeNames[failure->mode],
           LamCriterionNames[failure->criterion], (double)failure->factor);
  if (failure->reason[0]) printf("  %s\n", failure->reason);
}

/* Why a criterion is not evaluated: the other interface, or a strength that the scene does not give. */
static const char *WhyNotJudged(LamCriterion criterion, LamInterfaceLawType interface)
{
  if (criterion == LAM_CRITERION_CONTACT) return "the cells are bonded";
  if (criterion == LAM_CRITERION_WALL) return "the scene has no strength.wall";
  if (LamCellsPart(interface)) return "cells in contact part by their cohesion";
  return criterion == LAM_CRITERION_LAMELLA_NORMAL ? "the scene has no strength.lamella_normal"
                                                   : "the scene has no strength.lamella_shear";
}

static void PrintOnset(LamCriterion criterion, const LamCriterionOnset *onset, LamInterfaceLawType interface)
{
  printf("  %-15s", LamCriterionNames[criterion]);
  if (!onset->judged)
    printf("not judged: %s\n", WhyNotJudged(criterion, interface));
  else if (isnan(onset->factor))
    printf("not reached\n");
  else {
    printf("reached at %.4f (bracket %.4f to %.4f)", (double)onset->factor, (double)onset->bracket[0],
           (double)onset->bracket[1]);
    PrintPlace(onset->place);
    putchar('\n');
  }
}

static void PrintFailure(const LamFailure *failure, PetscReal MPa)
{
  const LamResponse *r = &failure->response;

  PrintVerdict(failure);
  if (!LamResponseHasFields(r)) return;
  PrintLoad(&failure->load, MPa);
  printf("  ");
  PrintMeasures(r, failure->program.strength, MPa);
  if (isfinite(Ratio(r->max_wall_tension, r->max_traction)))
    printf("  there a wall less than %.4g times as strong as the lamella in normal direction tears first\n",
           (double)Ratio(r->max_wall_tension, r->max_traction));
  for (int c = 0; c < LAM_CRITERION_COUNT; c++)
    PrintOnset((LamCriterion)c, &failure->onset[c], failure->program.interface);
  printf(
      "  (load factor 2.5: half-way from state 2 to state 3; at 0/1/0.94: cell 0, face 1, 0.94 of the way along it)\n");
}

PetscErrorCode LamFailurePrint(const LamFailure *failure, const LamScales *scales, PetscBool json)
{
  const PetscReal MPa = scales->stress * 1e-6;

  PetscFunctionBeginUser;
  if (json)
    PetscCall(LamPrintJSON(json_pack("{s:o}", "failure", FailureToJSON(failure, MPa))));
  else
    PrintFailure(failure, MPa);
  PetscFunctionReturn(0);
}

/* ---- onset of separation ---- */

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
  AddLoad(o, &onset->load, MPa);
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
  printf("onset of separation: between states %" PetscInt_FMT " and %" PetscInt_FMT
         ", at %.4f of the way (bracket %.4f "
         "to %.4f)\n",
         onset->states[0], onset->states[1], (double)onset->bracket[1], (double)onset->bracket[0],
         (double)onset->bracket[1]);
  PrintLoad(&onset->load, MPa);
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
