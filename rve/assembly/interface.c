/* Gaps and contact pressures along the interfaces, for pictures and profiles. */
#include "rve_impl.h"
#include "mortar_impl.h"

#define POINTS_PER_EDGE 4

PetscErrorCode LamRVEGetInterfaceSize(LamRVE rve, PetscInt *faces, PetscInt *points)
{
  PetscFunctionBeginUser;
  *faces = rve->contact ? rve->contact->face_count : 0;
  *points = POINTS_PER_EDGE * rve->mesh.along + 1;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEGetInterfaceFaces(LamRVE rve, PetscInt owner[])
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; rve->contact && f < rve->contact->face_count; ++f) {
    const LamContactFace *face = &rve->contact->faces[f];

    owner[3 * f] = face->cell;
    owner[3 * f + 1] = face->face;
    owner[3 * f + 2] = face->other;
  }
  PetscFunctionReturn(0);
}

/* The master edge facing slave coordinate s; -1: none. */
static PetscInt FacingEdge(const LamMortarSegments *segments, PetscReal s)
{
  for (PetscInt k = 0; k + 1 < segments->count; ++k)
    if (s >= segments->s[k] && s <= segments->s[k + 1]) return segments->master[k];
  return -1;
}

static PetscReal PressureAt(const LamContact *contact, const PetscReal lambda[], PetscReal s, const PetscReal Xs[2],
                            PetscReal F33)
{
  const PetscInt piece = PetscMin((PetscInt)(2.0 * s), contact->hats - 2);
  const PetscReal u = 2.0 * s - (PetscReal)piece;

  return contact->J0[piece / 2] * ((1.0 - u) * lambda[piece] + u * lambda[piece + 1]) /
         (PetscSqrtReal(LamDot(Xs, Xs)) * F33);
}

PetscErrorCode LamRVEGetInterface(LamRVE rve, LamRVEState state, PetscReal from[], PetscReal to[], PetscReal gap[],
                                  PetscReal pressure[])
{
  LamContact *contact = rve->contact;
  PetscInt faces, points;

  PetscFunctionBeginUser;
  PetscCall(LamRVEGetInterfaceSize(rve, &faces, &points));
  if (faces == 0) PetscFunctionReturn(0);
  for (PetscInt f = 0; f < faces; ++f) {
    const LamMortarChains chains = LamContactChains(rve, state->load.F, state->y, f);

    for (PetscInt i = 0; i < points; ++i) {
      const PetscInt k = f * points + i;
      const PetscReal s = (PetscReal)i / POINTS_PER_EDGE;
      const PetscInt edge = FacingEdge(&contact->segments, s);
      PetscReal X[2], Xs[2], nearest[2] = {NAN, NAN}, distance = NAN;

      LamMortarSlavePoint(&chains, s, X, Xs);
      if (edge >= 0) distance = LamMortarGap(&chains, s, edge, nearest);
      for (PetscInt d = 0; d < 2; ++d) {
        if (from) from[2 * k + d] = X[d];
        if (to) to[2 * k + d] = nearest[d];
      }
      if (gap) gap[k] = distance;
      if (pressure)
        pressure[k] = edge < 0 ? 0.0 : PressureAt(contact, &state->lambda[f * contact->hats], s, Xs, state->load.F[8]);
    }
  }
  PetscFunctionReturn(0);
}
