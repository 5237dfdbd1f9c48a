/* Gaps, contact pressures and the lamella along the interfaces, for pictures and profiles. */
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

PetscErrorCode LamRVEGetInterfaceLaw(LamRVE rve, LamInterfaceLawType *law)
{
  PetscFunctionBeginUser;
  *law = rve->micro.interface;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEGetInterfaceFaces(LamRVE rve, PetscInt owner[])
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; rve->contact && f < rve->contact->face_count; ++f) {
    const LamContactFace *face = &rve->contact->faces[f];

    owner[3 * f] = face->cell;
    owner[3 * f + 1] = LamMeshLocalFace(&rve->mesh, face->face);
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

static PetscReal PressureAt(const LamMortarChains *chains, const PetscReal lambda[], PetscReal s, const PetscReal Xs[2],
                            PetscReal F33)
{
  const PetscInt piece = PetscMin((PetscInt)(2.0 * s), 2 * chains->n - 1);
  const PetscReal u = 2.0 * s - (PetscReal)piece;

  return chains->J0[piece / 2] * ((1.0 - u) * lambda[piece] + u * lambda[piece + 1]) /
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
        pressure[k] = edge < 0 ? 0.0 : PressureAt(&chains, &state->lambda[f * contact->hats], s, Xs, state->load.F[8]);
    }
  }
  PetscFunctionReturn(0);
}

/* ---- the lamella ---- */

/* What is known at Gauss points. */
enum { DAMAGE, BROKEN, NORMAL, SHEAR, POINT_FIELDS };

typedef struct {
  const LamLayer *layer;
  LamRVEState state;
  PetscReal *value[POINT_FIELDS]; /* [point] */
} LayerPoints;

/* Of the state's own history: the layer's is that of the last solve. */
static void KeepPoint(void *ctx, const LamBondPoint *at)
{
  const LayerPoints *points = (const LayerPoints *)ctx;
  const LamBondHistory *history = &points->state->history[at->point];
  LamBond bond = points->layer->bond[at->point];
  PetscReal integrity, secant, traction[2];

  LamBondTake(history, &bond);
  integrity = bond.now.strength > 0.0 ? history->integrity : 0.0;
  secant = integrity * bond.law.stiffness;
  points->value[DAMAGE][at->point] = 1.0 - integrity;
  points->value[BROKEN][at->point] =
      bond.now.strength > 0.0 ? LamEnvelopeSpent(&bond.now, bond.kappa) / bond.now.energy : 1.0;
  LamBondTraction(&bond, &at->jump, secant, traction);
  points->value[NORMAL][at->point] = traction[0];
  points->value[SHEAR][at->point] = traction[1];
}

static PetscReal PointPlace(PetscInt p)
{
  return (PetscReal)(p / LAM_EDGE_POINTS) + LamEdgePlace(p % LAM_EDGE_POINTS);
}

/* value [LAM_EDGE_POINTS along] of the points of a face: linear between them, constant towards the ends. */
static PetscReal Between(const PetscReal value[], PetscInt along, PetscReal s)
{
  const PetscInt count = LAM_EDGE_POINTS * along;
  PetscInt next = 0;
  PetscReal u;

  while (next < count && PointPlace(next) < s) ++next;
  if (next == 0 || next == count) return value[next ? count - 1 : 0];
  u = (s - PointPlace(next - 1)) / (PointPlace(next) - PointPlace(next - 1));
  return (1.0 - u) * value[next - 1] + u * value[next];
}

/* Gauss's rule along face f. */
static PetscReal NormalForce(LamRVE rve, const LayerPoints *points, PetscInt f)
{
  const LamMesh *mesh = &rve->mesh;
  const PetscReal *edge = &mesh->edge[rve->contact->faces[f].face * mesh->along];
  PetscReal force = 0.0;

  for (PetscInt p = 0; p < LAM_EDGE_POINTS * mesh->along; ++p)
    force += edge[p / LAM_EDGE_POINTS] * LamEdgeWeight(p % LAM_EDGE_POINTS) *
             points->value[NORMAL][LAM_EDGE_POINTS * mesh->along * f + p];
  return force;
}

static void SampleFace(LamRVE rve, const LayerPoints *points, PetscInt f, const LamRVELamella *fields)
{
  const LamRVEState state = points->state;
  const LamMortarChains chains = LamContactChains(rve, state->load.F, state->y, f);
  const LamMortarChains other = {.n = chains.m, .x = chains.y}; /* runs the other way */
  const PetscInt along = rve->mesh.along, samples = POINTS_PER_EDGE * along + 1;
  PetscReal *const sampled[POINT_FIELDS] = {fields->damage, fields->broken, fields->normal_traction,
                                            fields->shear_traction};

  for (PetscInt i = 0; i < samples; ++i) {
    const PetscReal s = (PetscReal)i / POINTS_PER_EDGE;
    const PetscInt edge = PetscMin(i / POINTS_PER_EDGE, along - 1), to = f * samples + i;
    PetscReal tangent[2], x[2];
    LamJump jump;

    LamMortarSlavePoint(&other, (PetscReal)along - s, x, tangent);
    for (PetscInt d = 0; d < 2 && fields->across; ++d) fields->across[2 * to + d] = x[d];
    LamLayerJump(rve, state->load.F, state->y, f * along + edge, s - (PetscReal)edge, &jump);
    if (fields->opening) fields->opening[to] = jump.normal;
    if (fields->slip) fields->slip[to] = jump.shear;
    for (PetscInt k = 0; k < POINT_FIELDS; ++k)
      if (sampled[k]) sampled[k][to] = Between(&points->value[k][LAM_EDGE_POINTS * along * f], along, s);
  }
}

PetscErrorCode LamRVEGetLamella(LamRVE rve, LamRVEState state, const LamRVELamella *fields)
{
  LayerPoints points = {.layer = rve->layer, .state = state};

  PetscFunctionBeginUser;
  PetscCheck(rve->layer, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "the tissue has no lamella: law %s",
             LamInterfaceLawNames[rve->micro.interface]);
  PetscCall(PetscMalloc1(POINT_FIELDS * rve->layer->count, &points.value[0]));
  for (PetscInt k = 1; k < POINT_FIELDS; ++k) points.value[k] = points.value[0] + k * rve->layer->count;
  LamLayerVisitPoints(rve, state->load.F, state->y, KeepPoint, &points);
  for (PetscInt f = 0; f < rve->contact->face_count; ++f) {
    SampleFace(rve, &points, f, fields);
    if (fields->normal_force) fields->normal_force[f] = NormalForce(rve, &points, f);
  }
  PetscCall(PetscFree(points.value[0]));
  PetscFunctionReturn(0);
}
