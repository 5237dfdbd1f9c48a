/*
  Turgor: areas of the lumens, and the pressures of those that are sealed (docs/theory/walls.md, Sealed lumens).

  Method. The water in a sealed cell c is constant. With v = V / V_w the volume of its lumen relative to that at
  pressure p0,
    v = 1 - (p - p0) / K_w.
  The pressures p are additional unknowns, like multipliers with a compliance. Their term in the Lagrangian is
    sum_c -p V(y) + V_w (p - (p - p0)^2 / (2 K_w)),
  whose stationarity in p is that equation. It is linear in p, so K_w never multiplies a volume error in the residual
  of the positions. Elimination of the pressures gives the energy of the water, V_w ((1 - v) p0 + K_w (1 - v)^2 / 2),
  which descent uses.

  A cell that has burst has no pressure: its row is -p = 0.

  Each pressure adds one negative eigenvalue. For lumens that are not sealed its row is that of the unit matrix.
*/
#include "edge_area.h"
#include "rve_impl.h"

/* The edge at the lumen of an innermost element, counter-clockwise around the lumen. */
static const PetscInt inner_edge[3] = {0, 7, 3};

/* Positions of an innermost element; nodes of lumens have no shift. */
static void GatherInner(LamRVE rve, const PetscReal y[], PetscInt e, PetscReal x[LAM_ELEMENT_NODES][2])
{
  static const PetscReal no_shift[9] = {0};

  LamGatherElement(rve, no_shift, y, e, x);
}

/* The chord that closes the lumen at a cut: positions and classes of its ends. */
typedef struct {
  PetscInt class[2];
  PetscReal x[2][2];
} Chord;

static Chord ChordOf(LamRVE rve, const PetscReal y[], PetscInt cut)
{
  PetscInt side[2];
  Chord chord;

  LamMeshCut(&rve->mesh, cut, 0, side);
  for (PetscInt s = 0; s < 2; ++s) {
    chord.class[s] = rve->mesh.node_class[side[s]];
    for (PetscInt d = 0; d < 2; ++d) chord.x[s][d] = y[2 * chord.class[s] + d];
  }
  return chord;
}

/* Derivative of the chord's area, 1/2 x_0 x x_1, with respect to component d of end s. */
static PetscReal ChordGradient(const Chord *chord, PetscInt s, PetscInt d)
{
  return (s == d ? 0.5 : -0.5) * chord->x[1 - s][1 - d];
}

void LamLumenAreas(LamRVE rve, const PetscReal y[], PetscReal area[])
{
  const LamMesh *mesh = &rve->mesh;

  for (PetscInt c = 0; c < mesh->cell_count; ++c) area[c] = 0.0;
  for (PetscInt e = 0; e < mesh->element_count; e += mesh->through) {
    PetscReal x[LAM_ELEMENT_NODES][2];

    GatherInner(rve, y, e, x);
    area[mesh->cell_of[e]] += LamEdgeArea(inner_edge, (const PetscReal(*)[2])x);
  }
  for (PetscInt k = 0; k < mesh->tissue->faces * mesh->cuts; ++k) {
    const Chord chord = ChordOf(rve, y, k);

    area[LamMeshCellOfCut(mesh, k)] += 0.5 * (chord.x[0][0] * chord.x[1][1] - chord.x[0][1] * chord.x[1][0]);
  }
}

void LamLumenAddGradient(LamRVE rve, const PetscReal y[], const PetscReal factor[], PetscReal gradient[])
{
  const LamMesh *mesh = &rve->mesh;

  for (PetscInt e = 0; e < mesh->element_count; e += mesh->through) {
    PetscReal x[LAM_ELEMENT_NODES][2], f[LAM_ELEMENT_DOFS] = {0};

    GatherInner(rve, y, e, x);
    LamAddEdgeArea(inner_edge, (const PetscReal(*)[2])x, factor[mesh->cell_of[e]], f, NULL);
    for (PetscInt k = 0; k < 3; ++k)
      for (PetscInt d = 0; d < 2; ++d)
        gradient[2 * mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + inner_edge[k]]] + d] +=
            f[2 * inner_edge[k] + d];
  }
  for (PetscInt k = 0; k < mesh->tissue->faces * mesh->cuts; ++k) {
    const Chord chord = ChordOf(rve, y, k);

    for (PetscInt s = 0; s < 2; ++s)
      for (PetscInt d = 0; d < 2; ++d)
        gradient[2 * chord.class[s] + d] += factor[LamMeshCellOfCut(mesh, k)] * ChordGradient(&chord, s, d);
  }
}

void LamAssembleChords(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal residual[])
{
  LamLinear *linear = rve->linear;

  for (PetscInt k = 0; k < rve->mesh.tissue->faces * rve->mesh.cuts; ++k) {
    const Chord chord = ChordOf(rve, y, k);
    const PetscReal p = LamTurgor(rve, load, y, LamMeshCellOfCut(&rve->mesh, k)) * load->F[8];
    const PetscInt one = chord.class[0], other = chord.class[1];
    PetscInt entry[2][2];

    for (PetscInt s = 0; s < 2; ++s)
      for (PetscInt d = 0; d < 2; ++d) residual[2 * chord.class[s] + d] -= p * ChordGradient(&chord, s, d);
    if (one == 0 || other == 0) continue;
    LamLinearEntries(linear, one, other, LamLinearBlock(linear, one, other), entry);
    linear->values[entry[0][1]] -= 0.5 * p;
    linear->values[entry[1][0]] += 0.5 * p;
  }
}

void LamAddPressure(const PetscReal x[LAM_ELEMENT_NODES][2], PetscReal pressure, LamElementResult *element)
{
  LamAddEdgeArea(inner_edge, x, -pressure, element->f, element->K);
}

PetscReal LamTurgorEnergy(LamRVE rve, const LamLoad *load, const PetscReal y[])
{
  const LamSeal *seal = &rve->seal;
  PetscReal energy = 0.0;

  if (!LamHasTurgor(rve, load)) return 0.0;
  LamLumenAreas(rve, y, seal->area);
  for (PetscInt c = 0; c < rve->mesh.cell_count; ++c) {
    const PetscReal p0 = load->turgor * LamTurgorFactor(rve, c), volume = load->F[8] * seal->area[c];

    if (seal->closed && LamHasBurst(rve, c)) continue;
    if (seal->closed) {
      const PetscReal loss = 1.0 - volume / seal->water[c];

      energy += seal->water[c] * (loss * p0 + 0.5 * seal->bulk_modulus * loss * loss);
    } else {
      energy -= p0 * volume;
    }
  }
  return energy;
}

/* Adds the position-pressure entries of the lumens' areas: the last entry of a position's row. */
static void AddAreaRows(LamRVE rve, const PetscReal y[], PetscReal factor)
{
  const LamMesh *mesh = &rve->mesh;
  const PetscInt *row = rve->linear->row;

  for (PetscInt e = 0; e < mesh->element_count; e += mesh->through) {
    PetscReal x[LAM_ELEMENT_NODES][2], f[LAM_ELEMENT_DOFS] = {0};

    if (LamHasBurst(rve, mesh->cell_of[e])) continue;
    GatherInner(rve, y, e, x);
    LamAddEdgeArea(inner_edge, (const PetscReal(*)[2])x, factor, f, NULL);
    for (PetscInt k = 0; k < 3; ++k) {
      const PetscInt class = mesh->node_class[mesh->elements[LAM_ELEMENT_NODES * e + inner_edge[k]]];

      for (PetscInt d = 0; d < 2 && class > 0; ++d)
        rve->linear->values[row[2 * (class - 1) + d + 1] - 1] += f[2 * inner_edge[k] + d];
    }
  }
  for (PetscInt k = 0; k < mesh->tissue->faces * mesh->cuts; ++k) {
    const Chord chord = ChordOf(rve, y, k);

    for (PetscInt s = 0; s < 2 && !LamHasBurst(rve, LamMeshCellOfCut(mesh, k)); ++s)
      for (PetscInt d = 0; d < 2 && chord.class[s] > 0; ++d)
        rve->linear->values[row[2 * (chord.class[s] - 1) + d + 1] - 1] += factor * ChordGradient(&chord, s, d);
  }
}

void LamSealSetOpen(LamRVE rve)
{
  for (PetscInt i = rve->linear->pressures; i < rve->linear->n; ++i) rve->linear->values[rve->linear->row[i]] = 1.0;
}

void LamSealAssemble(LamRVE rve, const LamLoad *load, const PetscReal y[], PetscReal residual[])
{
  const LamSeal *seal = &rve->seal;
  const PetscInt first = rve->linear->pressures;

  LamSealSetOpen(rve);
  if (!seal->closed) return;
  LamLumenAreas(rve, y, seal->area);
  AddAreaRows(rve, y, -load->F[8]);
  for (PetscInt c = 0; c < rve->linear->lumens; ++c) {
    const PetscBool burst = LamHasBurst(rve, c);
    const PetscReal p = y[rve->ndof + c], over = p - load->turgor * LamTurgorFactor(rve, c);

    residual[rve->ndof + c] =
        burst ? -p : seal->water[c] * (1.0 - over / seal->bulk_modulus) - load->F[8] * seal->area[c];
    rve->linear->values[rve->linear->row[first + c]] = burst ? -1.0 : -seal->water[c] / seal->bulk_modulus;
  }
}

void LamSealSetConsistent(LamRVE rve, const LamLoad *load, PetscReal y[])
{
  const LamSeal *seal = &rve->seal;

  if (!seal->closed) return;
  LamLumenAreas(rve, y, seal->area);
  for (PetscInt c = 0; c < rve->linear->lumens; ++c)
    y[rve->ndof + c] = LamHasBurst(rve, c)
                           ? 0.0
                           : load->turgor * LamTurgorFactor(rve, c) +
                                 seal->bulk_modulus * (1.0 - load->F[8] * seal->area[c] / seal->water[c]);
}

PetscReal LamSealError(LamRVE rve, const PetscReal residual[])
{
  const LamSeal *seal = &rve->seal;
  PetscReal sum = 0.0;

  for (PetscInt c = 0; c < rve->linear->lumens && seal->closed; ++c)
    sum += PetscSqr(residual[rve->ndof + c] / (1.0 + seal->water[c] / seal->bulk_modulus));
  return sum;
}

void LamTurgorMeasures(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  PetscReal lowest = PETSC_MAX_REAL, highest = -PETSC_MAX_REAL, sum = 0.0;

  for (PetscInt c = 0; c < rve->mesh.cell_count; ++c) {
    const PetscReal p = LamTurgor(rve, load, rve->y, c);

    sum += p;
    lowest = PetscMin(lowest, p);
    highest = PetscMax(highest, p);
  }
  response->turgor_mean = sum / (PetscReal)rve->mesh.cell_count;
  response->turgor_spread = highest - lowest;
}

/* ---- the interface ---- */

PetscErrorCode LamRVESetSealable(LamRVE rve, PetscBool on)
{
  PetscFunctionBeginUser;
  PetscCheck(!rve->is_set_up, PETSC_COMM_SELF, PETSC_ERR_ORDER, "LamRVESetSealable comes before LamRVESetUp");
  rve->seal.allowed = on;
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVESeal(LamRVE rve, PetscReal bulk_modulus, const PetscReal water[])
{
  LamSeal *seal = &rve->seal;

  PetscFunctionBeginUser;
  PetscCheck(rve->is_set_up && seal->allowed, PETSC_COMM_SELF, PETSC_ERR_ORDER,
             "LamRVESetSealable and LamRVESetUp come before LamRVESeal");
  PetscCheck(bulk_modulus > 0.0 && !PetscIsInfOrNanReal(bulk_modulus), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "bulk modulus of water %g; it must be positive and finite", (double)bulk_modulus);
  for (PetscInt c = 0; c < rve->mesh.cell_count; ++c) {
    PetscCheck(water[c] > 0.0 && !PetscIsInfOrNanReal(water[c]), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "water of cell %d is %g; it must be positive and finite", (int)c, (double)water[c]);
    seal->water[c] = water[c] * rve->mesh.V0;
  }
  seal->bulk_modulus = bulk_modulus;
  seal->closed = PETSC_TRUE;
  if (rve->bonded) PetscCall(LamRVESeal(rve->bonded, bulk_modulus, water));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEUnseal(LamRVE rve)
{
  PetscFunctionBeginUser;
  rve->seal.closed = PETSC_FALSE;
  if (rve->bonded) PetscCall(LamRVEUnseal(rve->bonded));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEGetLumens(LamRVE rve, LamRVEState state, PetscReal lumen[])
{
  PetscFunctionBeginUser;
  LamLumenAreas(rve, state->y, lumen);
  for (PetscInt c = 0; c < rve->mesh.cell_count; ++c) lumen[c] *= state->load.F[8] / rve->mesh.V0;
  PetscFunctionReturn(0);
}
