/*
  The state of a body at a time: its properties, and its equilibrium.
*/
#include "body_impl.h"
#include <math.h>
#include <string.h>

PetscErrorCode LamBodySetTime(LamBody body, PetscReal time, const PetscReal x[], PetscBool *ok)
{
  LamProcess process = body->process;
  LamEvaluation *now = &body->now;
  LamTissueFactors factors;

  PetscFunctionBeginUser;
  LamProcessProperties(process, time, x, now, &factors);
  *ok = (PetscBool)(now->walls > 0 && isfinite(now->walls));
  if (!*ok) {
    PetscCall(PetscStrncpy(process->trouble, "nothing is left of the walls", sizeof(process->trouble)));
    PetscFunctionReturn(0);
  }
  if (process->changes_tissue && memcmp(&process->passed, &factors, sizeof(factors)))
    PetscCall(LamMacroForget(body->macro));
  PetscCall(LamProcessPassTissue(process, &factors));
  if (process->spec->has_water) LamBodyDrives(body);
  PetscFunctionReturn(0);
}

LamMacroInstant LamBodyInstant(LamBody body, PetscReal time)
{
  const LamSegment *segment = &body->process->segment;
  const PetscReal elapsed = time - segment->start, turgor = body->process->scene->turgor;
  LamMacroInstant instant = {.load = LamRampAt(&segment->load, elapsed),
                             .turgor = 1,
                             .lamella = body->now.factor[LAM_CHANGING_LAMELLA].value,
                             .walls = body->now.walls,
                             .time = time};

  if (!body->process->spec->has_water && turgor != 0) instant.turgor = LamRampAt(&segment->turgor, elapsed) / turgor;
  return instant;
}

LamWaterMode LamBodyAtOnce(LamBody body)
{
  return isfinite(body->process->spec->water.permeability) ? LAM_WATER_GIVEN : LAM_WATER_OSMOSIS;
}

PetscErrorCode LamBodyFillWater(LamBody body)
{
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < body->sizes.points && body->process->spec->has_water; p++) {
    LamMacroPoint point;
    PetscReal slope;

    PetscCall(LamMacroGetPoint(body->macro, p, &point));
    body->water[p] = LamBodyProtoplast(body, p, PetscMax(point.load->turgor, 0), point.potential, &slope);
  }
  if (body->transport.count && body->mode == LAM_WATER_PASSES) {
    PetscReal rate;

    PetscCall(LamBodyInflowRate(body, &rate));
    body->inflow = body->inflow_start + (rate - body->inflow_slope) / body->cj;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyAsk(LamBody body, const LamMacroInstant *instant, const PetscReal u[],
                          const PetscReal pressures[], const PetscReal potentials[], PetscBool *ok)
{
  LamMacroInstant now = *instant;

  PetscFunctionBeginUser;
  now.outside = -body->sigma * body->now.outside;
  if (body->cells_path >= 0) now.membrane[body->cells_path] = body->skin;
  PetscCall(LamMacroBalance(body->macro, &now, u, pressures, potentials, ok));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodyBalance(LamBody body, LamWaterMode mode, const LamMacroInstant *instant, PetscBool *ok)
{
  LamProcess process = body->process;

  PetscFunctionBeginUser;
  body->evaluated = NAN;
  body->mode = mode;
  PetscCall(LamBodyAsk(body, instant, body->u, body->pressures, body->potentials, ok));
  process->counts.questions++;
  if (!*ok) {
    PetscCall(PetscStrncpy(process->trouble, LamMacroTrouble(body->macro), sizeof(process->trouble)));
    PetscCall(LamMacroStopped(body->macro, &process->stopped));
    PetscCall(LamMacroReject(body->macro));
    body->mode = LamBodyAtOnce(body);
    PetscFunctionReturn(0);
  }
  PetscCall(LamMacroAccept(body->macro));
  PetscCall(LamMacroGetState(body->macro, body->u, body->pressures, body->potentials));
  PetscCall(LamBodyFillWater(body));
  body->mode = LamBodyAtOnce(body);
  PetscFunctionReturn(0);
}

PetscErrorCode LamBodySettle(LamBody body, LamWaterMode mode, PetscReal time, PetscBool *ok)
{
  PetscFunctionBeginUser;
  PetscCall(LamBodySetTime(body, time, body->process->tissue.x, ok));
  if (!*ok) PetscFunctionReturn(0);
  const LamMacroInstant instant = LamBodyInstant(body, time);
  PetscCall(LamBodyBalance(body, mode, &instant, ok));
  if (*ok) body->evaluated = time;
  PetscFunctionReturn(0);
}
