/*
  Initial guess for large meshes: the solution on a mesh with half as many elements along the faces and through the
  walls.

  Method. Continuation to the load is done on the coarse mesh, recursively if that is large itself. Its solution is the
  initial guess of Newton's method on the fine mesh: positions, contact pressures and wall stresses are interpolated,
  the latter from a bilinear fit per element, as stresses computed from interpolated positions oscillate if walls are
  nearly incompressible. The result is the initial state of a solve at the same load. If the coarse solve fails, the
  fine mesh is not solved, and the response gives the reason and the mesh. Sealed tissue, whose pressures are unknowns,
  and tissue whose walls tear do not use this method.
*/
#include "antiplane.h"
#include "contact_find.h"
#include "mortar_impl.h"

/* Element that contains `place` (in elements) and local coordinate in [-1, 1]. */
static PetscReal Local(PetscReal place, PetscInt elements, PetscInt *element)
{
  *element = PetscMax(0, PetscMin((PetscInt)place, elements - 1));
  return 2.0 * (place - (PetscReal)*element) - 1.0;
}

/* Quadratic shape functions at `place`, in elements; first: index of the first of their three nodes. */
static void Quadratic(PetscReal place, PetscInt elements, PetscInt *first, PetscReal N[3])
{
  PetscReal dN[3];

  LamEdgeShape(Local(place, elements, first), N, dN);
  *first *= 2;
}

/* Position on `other`, in elements along a face, of node or hat `half` of a face of `mesh`, two per element. */
static PetscReal PlaceIn(const LamMesh *other, const LamMesh *mesh, PetscInt face, PetscInt half)
{
  return LamMeshPlace(other, face, LamMeshShare(mesh, face, 0.5 * (PetscReal)half));
}

/* Interpolates the coarse solution at a node of the fine mesh; x[2]: the third component, 0 where there is none. */
static void Interpolate(LamRVE coarse, const LamRVEState from, const LamMesh *fine, PetscInt node, PetscReal x[3])
{
  const LamMesh *mesh = &coarse->mesh;
  const PetscInt radial = node % fine->radial_nodes, around = node / fine->radial_nodes;
  const PetscInt face = around / fine->face_nodes;
  PetscInt first[2];
  PetscReal N[2][3];

  Quadratic(PlaceIn(mesh, fine, face, around % fine->face_nodes), mesh->along, &first[0], N[0]);
  Quadratic((PetscReal)(radial * mesh->through) / (PetscReal)(fine->radial_nodes - 1), mesh->through, &first[1], N[1]);
  x[0] = x[1] = x[2] = 0.0;
  for (PetscInt a = 0; a < 3; ++a)
    for (PetscInt b = 0; b < 3; ++b) {
      const PetscInt ring = LamMeshRing(mesh, face, first[0] / 2, a);
      const PetscInt of = LamMeshNode(mesh, ring, first[1] + b);
      PetscReal at[3] = {0.0};

      LamNodePosition(coarse, from->load.F, from->y, of, at);
      if (from->axial) at[2] = LamAxialPosition(&from->load, from->z, mesh->node_class[of], &mesh->shift[2 * of]);
      for (PetscInt d = 0; d < 3; ++d) x[d] += N[0][a] * N[1][b] * at[d];
    }
}

static void ProlongPositions(LamRVE coarse, const LamRVEState from, LamRVE rve)
{
  const LamMesh *mesh = &rve->mesh;

  for (PetscInt node = 0; node < mesh->node_count; ++node) {
    PetscReal x[3];

    Interpolate(coarse, from, mesh, node, x);
    LamPlaceNode(rve, from->load.F, node, x, rve->y);
    if (rve->antiplane) LamAntiplanePlace(rve, &from->load, node, x[2]);
  }
  if (rve->antiplane) LamAntiplaneUse(rve);
}

/* Interpolates contact pressures and junction status. */
static void ProlongContact(LamRVE coarse, const LamRVEState from, LamRVE rve)
{
  const PetscInt hats = rve->contact->hats, coarse_hats = coarse->contact->hats;

  for (PetscInt f = 0; f < rve->contact->face_count; ++f) {
    LamContactFace *face = &rve->contact->faces[f];

    for (PetscInt j = 0; j < hats; ++j) {
      const PetscReal at = 2.0 * PlaceIn(&coarse->mesh, &rve->mesh, face->face, j);
      const PetscInt k = PetscMin((PetscInt)at, coarse_hats - 2);
      const PetscReal *lambda = &from->lambda[f * coarse_hats + k];

      rve->contact->lambda[f * hats + j] = lambda[0] + (at - (PetscReal)k) * (lambda[1] - lambda[0]);
    }
    if (from->hats[f][0] > from->hats[f][1]) continue;
    face->first = (PetscInt)(2.0 * PlaceIn(&rve->mesh, &coarse->mesh, face->face, from->hats[f][0]) + 0.5);
    face->last = (PetscInt)(2.0 * PlaceIn(&rve->mesh, &coarse->mesh, face->face, from->hats[f][1]) + 0.5);
  }
}

/* Bilinear fits to pressure and fibre stress of an element. */
static void FitStresses(LamRVE rve, PetscInt e, PetscReal p[4], PetscReal s[4])
{
  const LamElementStress *stress = &rve->stress[e];
  PetscReal pressure[LAM_GAUSS];

  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    pressure[g] = 0.0;
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k) pressure[g] += rve->geometry[e].psi[k][g] * stress->p[k];
  }
  LamFitBilinear(pressure, p);
  LamFitBilinear(stress->s, s);
}

/* Interpolates the independent stresses of element (i, m) of a face of the fine mesh. */
static void ProlongStress(LamRVE coarse, const PetscReal (*fits)[2][4], LamRVE rve, PetscInt face, PetscInt i,
                          PetscInt m)
{
  const LamMesh *mesh = &coarse->mesh;
  const PetscInt e = LamMeshElement(&rve->mesh, face, i, m);
  LamElementStress *stress = &rve->stress[e];

  for (PetscInt k = 0; k < LAM_PRESSURES; ++k) stress->p[k] = 0.0;
  for (PetscInt g = 0; g < LAM_GAUSS; ++g) {
    const PetscReal ratio = (PetscReal)mesh->through / (PetscReal)rve->mesh.through;
    PetscReal xi, eta, weight, p = 0.0;
    PetscInt i0, m0;

    LamGaussPoint(g, &xi, &eta, &weight);
    xi = Local(ratio * ((PetscReal)m + 0.5 * (1.0 + xi)), mesh->through, &m0);
    eta = Local(LamMeshPlace(mesh, face, LamMeshShare(&rve->mesh, face, (PetscReal)i + 0.5 * (1.0 + eta))), mesh->along,
                &i0);

    const PetscReal base[4] = {1.0, xi, eta, xi * eta};
    const PetscReal(*fit)[4] = fits[LamMeshElement(mesh, face, i0, m0)];

    stress->s[g] = 0.0;
    for (PetscInt k = 0; k < 4; ++k) {
      p += base[k] * fit[0][k];
      stress->s[g] += base[k] * fit[1][k];
    }
    for (PetscInt k = 0; k < LAM_PRESSURES; ++k)
      stress->p[k] += rve->geometry[e].weight[g] * rve->geometry[e].psi[k][g] * p;
  }
}

static PetscErrorCode ProlongStresses(LamRVE coarse, LamRVE rve)
{
  PetscReal(*fits)[2][4];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(coarse->mesh.element_count, &fits));
  for (PetscInt e = 0; e < coarse->mesh.element_count; ++e) FitStresses(coarse, e, fits[e][0], fits[e][1]);
  for (PetscInt face = 0; face < rve->mesh.tissue->faces; ++face)
    for (PetscInt i = 0; i < rve->mesh.along; ++i)
      for (PetscInt m = 0; m < rve->mesh.through; ++m) ProlongStress(coarse, fits, rve, face, i, m);
  PetscCall(PetscFree(fits));
  PetscFunctionReturn(0);
}

/* Contact from interpolated positions: by the exact law if the coarse state is exact, by the smooth one otherwise, or
   if that fails. */
static PetscErrorCode ProlongContactState(LamRVE coarse, const LamRVEState from, LamRVE rve, LamNewtonOutcome *outcome)
{
  const LamLoad *load = &from->load;
  LamContactOutcome out;

  PetscFunctionBeginUser;
  *outcome = LAM_NEWTON_STALLED;
  if (from->width == 0.0) {
    PetscCall(LamUseExactLaw(rve));
    ProlongContact(coarse, from, rve);
    PetscCall(LamSharpen(rve, load, NULL, LAM_NEAR_REACH, outcome));
    if (*outcome == LAM_NEWTON_CONVERGED) PetscFunctionReturn(0);
    ProlongPositions(coarse, from, rve);
    PetscCall(ProlongStresses(coarse, rve));
  }
  PetscCall(LamContactSearch(rve, load, NULL, LAM_SEARCH_WIDTH, LamNewtonTolerance(rve), &out));
  if (out.found) *outcome = LAM_NEWTON_CONVERGED;
  PetscFunctionReturn(0);
}

PetscErrorCode LamProlong(LamRVE coarse, const LamRVEState from, LamRVE rve, LamRVEState to)
{
  const LamLoad *load = &from->load;
  LamNewtonOutcome outcome;

  PetscFunctionBeginUser;
  ProlongPositions(coarse, from, rve);
  PetscCall(ProlongStresses(coarse, rve));
  rve->moved = PETSC_TRUE;
  rve->budget = LAM_ITERATION_BUDGET;
  if (rve->contact) {
    PetscCall(ProlongContactState(coarse, from, rve, &outcome));
  } else {
    PetscCall(LamNewtonFast(rve, load, NULL, &outcome));
    if (outcome == LAM_NEWTON_STALLED) {
      ProlongPositions(coarse, from, rve);
      PetscCall(ProlongStresses(coarse, rve));
      PetscCall(LamMinimise(rve, load, NULL, LamNewtonTolerance(rve), &outcome));
    }
  }
  if (outcome != LAM_NEWTON_CONVERGED) PetscFunctionReturn(0);
  LamKeepState(rve, load, from->branch, to);
  PetscFunctionReturn(0);
}

/* Prepends the mesh to a reason. */
static PetscErrorCode NameMesh(LamRVE rve, LamResponse *response)
{
  char reason[sizeof(response->reason)];

  PetscFunctionBeginUser;
  if (!response->reason[0]) PetscFunctionReturn(0);
  PetscCall(PetscStrncpy(reason, response->reason, sizeof(reason)));
  PetscCall(LamRefuse(response, response->status, "on %d x %d elements: %s", (int)rve->micro.along,
                      (int)rve->micro.through, reason));
  PetscFunctionReturn(0);
}

/* Elements along a face of the coarsest mesh: where air rounds corners there are two arcs, too. */
static PetscInt LeastAlong(LamRVE rve)
{
  PetscInt arcs = 0;

  for (PetscInt face = 0; face < rve->mesh.tissue->faces; ++face)
    arcs += rve->mesh.flat[face][1] - rve->mesh.flat[face][0] < rve->mesh.along;
  return arcs ? 4 : 1; /* halved: 3 and 1 */
}

PetscBool LamIsNested(LamRVE rve, const LamRVEState state)
{
  return (PetscBool)(rve->mesh.element_count >= LAM_LARGE && rve->micro.along > LeastAlong(rve) && !rve->seal.allowed &&
                     !rve->mesh.cuts && !state->solved);
}

PetscErrorCode LamNestedStart(LamRVE rve, const LamLoad *load, LamRVEState start, LamResponse *coarse_response)
{
  LamMicrostructure micro = rve->micro;
  LamRVE coarse;
  LamRVEState state;
  PetscBool nested;

  PetscFunctionBeginUser;
  micro.along = (micro.along + 1) / 2;
  micro.through = (micro.through + 1) / 2;
  PetscCall(LamRVECreateLike(rve, &micro, LAM_WANT_STRESS, &coarse));
  PetscCall(LamRVEStateCreate(coarse, &state));
  nested = LamIsNested(coarse, state);
  PetscCall(LamRVESolve(coarse, load, state, coarse_response));
  if (!nested) PetscCall(NameMesh(coarse, coarse_response));
  for (PetscInt k = 0; k < LAM_SYSTEMS; ++k) PetscCall(LamFactorDestroy(&coarse->systems[k].factor)); /* for memory */
  if (coarse_response->status == LAM_CONVERGED) PetscCall(LamProlong(coarse, state, rve, start));
  if (LamWasStopped(coarse_response)) rve->work.stopped = PETSC_TRUE;
  PetscCall(LamRVEStateDestroy(&state));
  PetscCall(LamRVEDestroy(&coarse));
  PetscFunctionReturn(0);
}
