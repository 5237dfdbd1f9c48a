/*
  Water that moves through the body: fields of water potential at the nodes.

  Method. Each potential psi_f gives the cells of a material point the flow m_f, by the water law (body.h), and is
  conducted through the body; its nodal equations are

    G_fI = int [ N_I m_f + grad N_I . k_f grad psi_f ] dV - int_surface N_I g_f (psi_out - psi_f) dA = 0

  in the reference, dV and dA around the whole circle of an axisymmetric body. At nodes of sides without resistance
  psi_f is prescribed, and G_fI is what flows in. The lumens' water depends on the potentials, so with the matrices of
  sealed.c, E = dR/dpsi, H = dG/dq, D = dG/dpsi, and the pressures eliminated element by element, Newton's method has

    ( A'  B  ) ( du   )     ( f' )     B = -C^T K^-1 E    C' = -H K^-1 C
    ( C'  D' ) ( dpsi ) = - ( G' )     D' = D - H K^-1 E  G' = G - H K^-1 R

  SNES solves for u: its residual is f' - B D'^-1 G', its linear solver factors the whole matrix, and the potentials
  follow by dpsi = -D'^-1 (G' + C' du), as the pressures do.

  References: Philip, Plant Physiol. 33 (1958) 264-271; Molz & Ikenberry, Soil Sci. Soc. Am. J. 38 (1974) 699-704.
*/
#include "transport_impl.h"

enum { FLOWS = LAM_MACRO_POTENTIALS * LAM_MACRO_NODES, MODES = LAM_MACRO_MODES };

/* An element's equations of its potentials, [node][potential] each. */
typedef struct {
  PetscInt n;
  PetscReal lumen[FLOWS * MODES], flow[FLOWS * MODES]; /* [n][modes] E; [n][modes] H, transposed */
  PetscScalar balance[FLOWS], own[FLOWS * FLOWS];      /* G; D, row-major */
  PetscReal magnitude;                                 /* of the terms in G, per time */
} Flows;

PetscBool LamMacroFlows(LamMacro macro)
{
  return (PetscBool)(macro->flow && macro->seal->closed);
}

/* ---- states ---- */

/* Potentials of the material points from those of the nodes. */
static PetscErrorCode SpreadPotentials(LamMacro macro)
{
  LamMacroFlow *flow = macro->flow;
  const PetscInt count = flow->spec.count;
  Vec local;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(flow->dm, &local));
  PetscCall(DMGlobalToLocal(flow->dm, flow->psi, INSERT_VALUES, local));
  for (PetscInt e = 0; e < macro->element_count; e++) {
    const LamMacroElement *element = &macro->elements[e];
    PetscScalar *psi = NULL;
    PetscCall(DMPlexVecGetClosure(flow->dm, NULL, local, macro->mesh_start + e, NULL, &psi));
    for (PetscInt q = 0; q < element->kind->points; q++) {
      PetscReal *at = &flow->at[count * (element->first + q)];
      const PetscReal *N = &element->kind->value[q * element->kind->nodes];
      for (PetscInt f = 0; f < count; f++) {
        at[f] = 0;
        for (PetscInt a = 0; a < element->kind->nodes; a++) at[f] += N[a] * PetscRealPart(psi[count * a + f]);
      }
    }
    PetscCall(DMPlexVecRestoreClosure(flow->dm, NULL, local, macro->mesh_start + e, NULL, &psi));
  }
  PetscCall(DMRestoreLocalVector(flow->dm, &local));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFlowStart(LamMacro macro, const LamMacroInstant *instant, const PetscReal potentials[])
{
  LamMacroFlow *flow = macro->flow;
  PetscScalar *psi;
  PetscInt n;
  Vec held;

  PetscFunctionBeginUser;
  if (!flow) PetscFunctionReturn(0);
  flow->outside = instant->outside;
  for (PetscInt f = 0; f < flow->spec.count; f++) flow->membrane[f] = instant->membrane[f];
  PetscCall(DMGetGlobalVector(flow->dm, &held));
  PetscCall(DMLocalToGlobal(flow->dm, flow->held, INSERT_VALUES, held));
  PetscCall(VecGetLocalSize(flow->psi, &n));
  PetscCall(VecGetArray(flow->psi, &psi));
  PetscCall(PetscArraycpy(psi, potentials, n));
  PetscCall(VecRestoreArray(flow->psi, &psi));
  PetscCall(VecPointwiseMult(flow->step, held, flow->psi)); /* prescribed ones come off ... */
  PetscCall(VecAXPY(flow->psi, -1, flow->step));
  PetscCall(VecAXPY(flow->psi, flow->outside, held)); /* ... and have the potential outside */
  PetscCall(DMRestoreGlobalVector(flow->dm, &held));
  PetscCall(SpreadPotentials(macro));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFlowGet(LamMacro macro, PetscReal potentials[])
{
  const PetscScalar *psi;
  PetscInt n;

  PetscFunctionBeginUser;
  if (!macro->flow) PetscFunctionReturn(0);
  PetscCall(VecGetLocalSize(macro->flow->psi, &n));
  PetscCall(VecGetArrayRead(macro->flow->psi, &psi));
  PetscCall(PetscArraycpy(potentials, psi, n));
  PetscCall(VecRestoreArrayRead(macro->flow->psi, &psi));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroGetInflow(LamMacro macro, PetscReal *inflow)
{
  PetscFunctionBeginUser;
  *inflow = macro->flow ? macro->flow->inflow : NAN;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFlowAccept(LamMacro macro)
{
  LamMacroFlow *flow = macro->flow;

  PetscFunctionBeginUser;
  if (!flow) PetscFunctionReturn(0);
  PetscCall(VecCopy(flow->psi, flow->accepted));
  if (!macro->seal->closed) PetscFunctionReturn(0);
  for (PetscInt p = 0; p < macro->point_count; p++) {
    PetscReal *field = macro->now[p].field;
    LamWater water;
    LamMacroFindWater(macro, p, &water);
    field[LAM_POINT_POTENTIAL] = water.potential;
    for (PetscInt f = 0; f < flow->spec.count; f++)
      if (!flow->spec.has_membrane[f]) field[LAM_POINT_APOPLAST] = flow->at[flow->spec.count * p + f];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFlowReject(LamMacro macro)
{
  PetscFunctionBeginUser;
  if (!macro->flow) PetscFunctionReturn(0);
  PetscCall(VecCopy(macro->flow->accepted, macro->flow->psi));
  PetscCall(SpreadPotentials(macro));
  PetscFunctionReturn(0);
}

/* ---- the equations of an element ---- */

/* Adds Gauss point q; psi [node][potential]. */
static void AddPoint(LamMacro macro, const LamMacroElement *element, PetscInt q, const PetscScalar psi[], Flows *e)
{
  const LamMacroFlow *flow = macro->flow;
  const PetscInt count = flow->spec.count, dim = macro->dim, modes = macro->seal->modes, point = element->first + q,
                 nodes = element->kind->nodes;
  const PetscReal *N = &element->kind->value[q * nodes], *dN = LamMacroGradient(macro, element, q),
                  *shape = &macro->seal->shape[modes * point], w = macro->weight[point];
  PetscReal slope[LAM_MACRO_POTENTIALS][LAM_MACRO_DIM] = {{0}}; /* k grad psi */
  LamWater water;

  LamMacroFindWater(macro, point, &water);
  e->magnitude += w * water.magnitude;
  for (PetscInt k = 0; k < e->n; k++)
    for (PetscInt j = 0; j < dim; j++) {
      const PetscReal kdN = flow->spec.conductivity[k % count] * dN[dim * (k / count) + j];
      slope[k % count][j] += kdN * PetscRealPart(psi[k]);
      e->magnitude += w * PetscAbsReal(kdN * dN[dim * (k / count) + j] * PetscRealPart(psi[k]));
    }
  for (PetscInt k = 0; k < e->n; k++) {
    const PetscInt a = k / count, f = k % count;
    e->balance[k] += w * N[a] * water.flow[f];
    for (PetscInt j = 0; j < dim; j++) e->balance[k] += w * dN[dim * a + j] * slope[f][j];
    for (PetscInt m = 0; m < modes; m++) {
      e->lumen[modes * k + m] += w * N[a] * shape[m] * water.by_potential[f];
      e->flow[modes * k + m] += w * N[a] * shape[m] * water.flow_turgor[f];
    }
    for (PetscInt l = 0; l < e->n; l++) {
      const PetscInt b = l / count, g = l % count;
      PetscReal D = N[a] * N[b] * water.flow_potential[f][g];
      for (PetscInt j = 0; j < dim && f == g; j++) D += flow->spec.conductivity[f] * dN[dim * a + j] * dN[dim * b + j];
      e->own[k * e->n + l] += w * D;
    }
  }
}

/* Takes out the rows of prescribed potentials: balance 0, and each follows nothing but itself. What flows in there is
   added to *inflow. */
static void HoldRows(PetscInt n, const PetscScalar held[], PetscScalar balance[], PetscScalar own[], PetscReal flow[],
                     PetscInt modes, PetscReal *inflow)
{
  for (PetscInt k = 0; k < n; k++) {
    if (held[k] == 0) continue;
    *inflow += PetscRealPart(balance[k]);
    balance[k] = 0;
    for (PetscInt l = 0; l < n; l++) own[k * n + l] = k == l;
    for (PetscInt m = 0; m < modes; m++) flow[modes * k + m] = 0;
  }
}

/* Eliminates the pressures: G' and D' in place; B [dofs][n] and C' [dofs][n], transposed. */
static PetscErrorCode Eliminate(LamMacro macro, const LamMacroElement *element, Flows *e, PetscScalar B[],
                                PetscScalar C[])
{
  const PetscInt modes = macro->seal->modes;
  PetscReal solved[FLOWS * MODES];
  LamCondensation c;

  PetscFunctionBeginUser;
  PetscCall(LamMacroCondensationCreate(macro, element, &c));
  PetscCall(PetscArraycpy(solved, e->lumen, modes * e->n));
  PetscCall(LamMacroCondensationSolve(&c, e->n, solved));
  for (PetscInt k = 0; k < e->n; k++) {
    for (PetscInt m = 0; m < modes; m++) {
      const PetscReal H = e->flow[modes * k + m];
      e->balance[k] -= H * c.solved[modes * c.dofs + m];
      for (PetscInt l = 0; l < e->n; l++) e->own[k * e->n + l] -= H * solved[modes * l + m];
    }
    for (PetscInt i = 0; i < c.dofs; i++) {
      PetscReal b = 0, from = 0;
      for (PetscInt m = 0; m < modes; m++) {
        b -= c.coupling[modes * i + m] * solved[modes * k + m];
        from -= e->flow[modes * k + m] * c.solved[modes * i + m];
      }
      B[i * e->n + k] = b;
      C[i * e->n + k] = from;
    }
  }
  PetscFunctionReturn(0);
}

/* ---- the equations of the body ---- */

/* Of the elements on this rank; eliminates: G' and D' instead of G and D, and `entries`, from the first on. */
static PetscErrorCode AddElements(LamMacro macro, PetscBool eliminates, Vec psi, Vec balance, PetscReal sums[2])
{
  LamMacroFlow *flow = macro->flow;
  PetscInt at = 0;
  Flows *e;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&e));
  for (PetscInt k = 0; k < macro->element_count; k++) {
    const LamMacroElement *element = &macro->elements[k];
    const PetscInt cell = macro->mesh_start + k;
    PetscScalar *own = NULL, *held = NULL;
    PetscCall(PetscMemzero(e, sizeof(*e)));
    e->n = element->kind->nodes * flow->spec.count;
    PetscCall(DMPlexVecGetClosure(flow->dm, NULL, psi, cell, NULL, &own));
    for (PetscInt q = 0; q < element->kind->points; q++) AddPoint(macro, element, q, own, e);
    PetscCall(DMPlexVecRestoreClosure(flow->dm, NULL, psi, cell, NULL, &own));
    sums[1] += e->magnitude;
    PetscCall(DMPlexVecGetClosure(flow->dm, NULL, flow->held, cell, NULL, &held));
    HoldRows(e->n, held, e->balance, e->own, e->flow, macro->seal->modes, &sums[0]);
    PetscCall(DMPlexVecRestoreClosure(flow->dm, NULL, flow->held, cell, NULL, &held));
    if (eliminates) PetscCall(Eliminate(macro, element, e, &flow->entries[0][at], &flow->entries[1][at]));
    at += element->kind->nodes * macro->dim * e->n;
    PetscCall(DMPlexVecSetClosure(flow->dm, NULL, balance, cell, e->balance, ADD_VALUES));
    PetscCall(DMPlexMatSetClosure(flow->dm, NULL, NULL, flow->own, cell, e->own, ADD_VALUES));
  }
  PetscCall(PetscFree(e));
  PetscFunctionReturn(0);
}

/* Conductance between potential f and outside at a side. */
static PetscReal Conductance(const LamMacroFlow *flow, const LamSurface *surface, PetscReal length, PetscInt f)
{
  const PetscReal skin = 1 / (surface->conductance * length);

  return 1 / (skin + (flow->spec.has_membrane[f] ? 1 / flow->membrane[f] : 0));
}

/* Adds int N_I g (psi - psi_out) over a facet; *inflow: what flows in. */
static PetscErrorCode AddFacet(LamMacro macro, const LamMacroFacet *facet, const LamSurface *surface,
                               const PetscScalar psi[], PetscScalar balance[], PetscScalar own[], PetscReal *inflow)
{
  const LamMacroFlow *flow = macro->flow;
  const PetscInt count = flow->spec.count, n = 3 * count;
  const PetscReal length = macro->scene->scales.length / macro->scene->scales.macro_length;
  PetscReal X[6], sense;

  PetscFunctionBeginUser;
  PetscCall(LamMacroFacetNodes(macro, facet, X, &sense));
  for (PetscInt q = 0; q < LAM_FACET_POINTS; q++) {
    PetscReal N[3], dN[3], w, tau[2] = {0, 0};
    LamMacroFacetShape(q, N, dN, &w);
    for (PetscInt k = 0; k < 6; k++) tau[k % 2] += dN[k / 2] * X[k];
    w *= PetscSqrtReal(PetscSqr(tau[0]) + PetscSqr(tau[1])) * LamMacroAround(macro, N, X);
    for (PetscInt f = 0; f < count; f++) {
      const PetscReal g = LamMacroPrescribes(flow, surface, f) ? 0 : w * Conductance(flow, surface, length, f);
      PetscReal over = -flow->outside;
      for (PetscInt a = 0; a < 3; a++) over += N[a] * PetscRealPart(psi[count * a + f]);
      *inflow -= g * over;
      for (PetscInt a = 0; a < 3; a++) {
        balance[count * a + f] += N[a] * g * over;
        for (PetscInt b = 0; b < 3; b++) own[(count * a + f) * n + count * b + f] += N[a] * N[b] * g;
      }
    }
  }
  PetscFunctionReturn(0);
}

/* The first entry of `surface` that a facet belongs to; NULL: it is sealed. */
static const LamSurface *SurfaceOf(LamMacro macro, const LamMacroFacet *facet)
{
  const LamTransportSpec *spec = &macro->scene->process.transport;

  for (PetscInt k = 0; k < spec->surface_count; k++)
    if (facet->sets >> LamMacroFindSet(macro, spec->surface[k].on) & 1) return &spec->surface[k];
  return NULL;
}

static PetscErrorCode AddFacets(LamMacro macro, Vec psi, Vec balance, PetscReal *inflow)
{
  LamMacroFlow *flow = macro->flow;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < macro->facet_count; k++) {
    const LamMacroFacet *facet = &macro->facets[k];
    const LamSurface *surface = SurfaceOf(macro, facet);
    PetscScalar fe[3 * LAM_MACRO_POTENTIALS] = {0}, De[9 * LAM_MACRO_POTENTIALS * LAM_MACRO_POTENTIALS] = {0};
    PetscScalar *own = NULL, *held = NULL;
    if (!surface) continue;
    PetscCall(DMPlexVecGetClosure(flow->dm, NULL, psi, facet->point, NULL, &own));
    PetscCall(AddFacet(macro, facet, surface, own, fe, De, inflow));
    PetscCall(DMPlexVecRestoreClosure(flow->dm, NULL, psi, facet->point, NULL, &own));
    PetscCall(DMPlexVecGetClosure(flow->dm, NULL, flow->held, facet->point, NULL, &held));
    HoldRows(3 * flow->spec.count, held, fe, De, NULL, 0, inflow);
    PetscCall(DMPlexVecRestoreClosure(flow->dm, NULL, flow->held, facet->point, NULL, &held));
    PetscCall(DMPlexVecSetClosure(flow->dm, NULL, balance, facet->point, fe, ADD_VALUES));
    PetscCall(DMPlexMatSetClosure(flow->dm, NULL, NULL, flow->own, facet->point, De, ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

/* G', D', B, C' and the inflow at the present state; without `eliminates` G, D and the inflow. */
static PetscErrorCode Assemble(LamMacro macro, PetscBool eliminates)
{
  LamMacroFlow *flow = macro->flow;
  PetscReal sums[2] = {0, 0}; /* inflow, magnitude */
  Vec psi, balance;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(flow->dm, &psi));
  PetscCall(DMGetLocalVector(flow->dm, &balance));
  PetscCall(DMGlobalToLocal(flow->dm, flow->psi, INSERT_VALUES, psi));
  PetscCall(VecZeroEntries(balance));
  PetscCall(MatZeroEntries(flow->own));
  PetscCall(AddElements(macro, eliminates, psi, balance, sums));
  PetscCall(AddFacets(macro, psi, balance, &sums[0]));
  PetscCall(MatAssemblyBegin(flow->own, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(flow->own, MAT_FINAL_ASSEMBLY));
  if (eliminates) {
    PetscCall(MatSetValuesCOO(flow->to_force, flow->entries[0], INSERT_VALUES));
    PetscCall(MatSetValuesCOO(flow->from_u, flow->entries[1], INSERT_VALUES));
  }
  PetscCall(VecZeroEntries(flow->balance));
  PetscCall(DMLocalToGlobal(flow->dm, balance, ADD_VALUES, flow->balance));
  PetscCall(DMRestoreLocalVector(flow->dm, &balance));
  PetscCall(DMRestoreLocalVector(flow->dm, &psi));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPIU_REAL, MPIU_SUM, macro->comm));
  flow->inflow = sums[0];
  flow->magnitude = sums[1];
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFlowReduce(LamMacro macro, Vec force, PetscBool *ok)
{
  LamMacroFlow *flow = macro->flow;
  KSPConvergedReason reason;

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  if (!LamMacroFlows(macro)) PetscFunctionReturn(0);
  PetscCall(Assemble(macro, PETSC_TRUE));
  PetscCall(KSPSetOperators(flow->own_solver, flow->own, flow->own));
  PetscCall(KSPSolve(flow->own_solver, flow->balance, flow->step));
  PetscCall(KSPGetConvergedReason(flow->own_solver, &reason));
  *ok = (PetscBool)(reason > 0);
  if (!*ok)
    PetscCall(PetscStrncpy(macro->trouble, "the equations of the water that moves through the body are singular",
                           sizeof(macro->trouble)));
  PetscCall(VecScale(flow->step, -1));
  PetscCall(MatMultAdd(flow->to_force, flow->step, force, force));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFlowResidual(LamMacro macro, PetscReal *residual)
{
  PetscFunctionBeginUser;
  *residual = 0;
  if (!LamMacroFlows(macro) || macro->flow->magnitude == 0) PetscFunctionReturn(0);
  PetscCall(VecNorm(macro->flow->balance, NORM_2, residual));
  *residual /= macro->flow->magnitude;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFlowClose(LamMacro macro)
{
  LamMacroFlow *flow = macro->flow;

  PetscFunctionBeginUser;
  if (!LamMacroFlows(macro)) PetscFunctionReturn(0);
  PetscCall(Assemble(macro, PETSC_FALSE));
  PetscCall(KSPSetOperators(flow->own_solver, flow->own, flow->own));
  PetscCall(KSPSolve(flow->own_solver, flow->balance, flow->step));
  PetscCall(VecScale(flow->step, -1));
  PetscCall(LamMacroFlowMove(macro));
  PetscCall(Assemble(macro, PETSC_FALSE));
  PetscFunctionReturn(0);
}

/* ---- steps of Newton's method ---- */

#define STEP "step" /* name of the local vector that has flow->step */

PetscErrorCode LamMacroFlowFollow(LamMacro macro, Vec du)
{
  LamMacroFlow *flow = macro->flow;
  Vec local;

  PetscFunctionBeginUser;
  if (!LamMacroFlows(macro)) PetscFunctionReturn(0);
  PetscCall(MatMultAdd(flow->from_u, du, flow->balance, flow->balance));
  PetscCall(KSPSolve(flow->own_solver, flow->balance, flow->step));
  PetscCall(VecScale(flow->step, -1));
  PetscCall(DMGetNamedLocalVector(flow->dm, STEP, &local));
  PetscCall(DMGlobalToLocal(flow->dm, flow->step, INSERT_VALUES, local));
  PetscCall(DMRestoreNamedLocalVector(flow->dm, STEP, &local));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFlowLumens(LamMacro macro, PetscInt e, PetscReal lumens[])
{
  const LamMacroFlow *flow = macro->flow;
  const LamMacroElement *element = &macro->elements[e];
  const PetscInt modes = macro->seal->modes, nodes = element->kind->nodes;
  PetscScalar *step = NULL;
  Vec local;

  PetscFunctionBeginUser;
  if (!LamMacroFlows(macro)) PetscFunctionReturn(0);
  PetscCall(DMGetNamedLocalVector(flow->dm, STEP, &local));
  PetscCall(DMPlexVecGetClosure(flow->dm, NULL, local, macro->mesh_start + e, NULL, &step));
  for (PetscInt q = 0; q < element->kind->points; q++) {
    const PetscInt point = element->first + q, count = flow->spec.count;
    PetscReal change = 0;
    LamWater water;
    LamMacroFindWater(macro, point, &water);
    for (PetscInt k = 0; k < nodes * count; k++)
      change += element->kind->value[q * nodes + k / count] * water.by_potential[k % count] * PetscRealPart(step[k]);
    for (PetscInt m = 0; m < modes; m++)
      lumens[m] += macro->weight[point] * macro->seal->shape[modes * point + m] * change;
  }
  PetscCall(DMPlexVecRestoreClosure(flow->dm, NULL, local, macro->mesh_start + e, NULL, &step));
  PetscCall(DMRestoreNamedLocalVector(flow->dm, STEP, &local));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroFlowMove(LamMacro macro)
{
  PetscFunctionBeginUser;
  if (!LamMacroFlows(macro)) PetscFunctionReturn(0);
  PetscCall(VecAXPY(macro->flow->psi, 1, macro->flow->step));
  PetscCall(SpreadPotentials(macro));
  PetscFunctionReturn(0);
}
