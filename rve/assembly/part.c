#include "part.h"

struct LamPartSystem_s {
  const LamPart *part;           /* borrowed */
  PetscInt n, *unknown;          /* [n] of the whole matrix, increasing */
  PetscInt *index;               /* [unknowns of the whole matrix] among them; -1: does not move */
  PetscInt couplings;            /* of the smooth law, for which the pattern was made */
  PetscInt *row, *column, *from; /* upper rows, and where their values come from */
  PetscReal *values;
  LamFactor factor;
};

/* ---- cells ---- */

/* Adds the neighbours of the cells from `first` on; returns the first that was added. */
static PetscInt AddNeighbours(LamRVE rve, PetscInt first, LamPart *part)
{
  const PetscInt last = part->count;

  for (PetscInt k = first; k < last; ++k)
    for (PetscInt i = 0; i < LamMeshFaceCount(&rve->mesh, part->cells[k]); ++i) {
      const PetscInt other = LamMeshNeighbour(&rve->mesh, rve->mesh.tissue->first[part->cells[k]] + i);

      if (other < 0 || part->near[other]) continue;
      part->near[other] = PETSC_TRUE;
      part->cells[part->count++] = other;
    }
  return last;
}

/* Positions of the cells, each of which has nodes of its own. */
static PetscErrorCode ListUnknowns(const LamMesh *mesh, LamPart *part)
{
  PetscInt nodes = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < part->count; ++k) nodes += LamMeshRingNodes(mesh, part->cells[k]) * mesh->radial_nodes;
  PetscCall(PetscMalloc1(2 * nodes, &part->unknown));
  for (PetscInt k = 0; k < part->count; ++k) {
    const PetscInt end = LamMeshFirstRing(mesh, part->cells[k] + 1) * mesh->radial_nodes;

    for (PetscInt node = LamMeshFirstRing(mesh, part->cells[k]) * mesh->radial_nodes; node < end; ++node)
      for (PetscInt d = 0; d < 2 && mesh->node_class[node] > 0; ++d)
        part->unknown[part->unknowns++] = LamUnknown(mesh->node_class[node], d);
    if (k == part->moving - 1) part->moving_unknowns = part->unknowns;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamPartCreate(LamRVE rve, const PetscBool seed[], PetscInt layers, LamPart **out)
{
  const PetscInt cells = rve->mesh.cell_count;
  PetscInt first = 0;
  LamPart *part;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&part));
  PetscCall(PetscMalloc1(cells, &part->cells));
  PetscCall(PetscCalloc2(cells, &part->moves, cells, &part->near));
  for (PetscInt c = 0; c < cells; ++c)
    if (seed[c]) {
      part->near[c] = PETSC_TRUE;
      part->cells[part->count++] = c;
    }
  for (PetscInt k = 0; k < layers; ++k) first = AddNeighbours(rve, first, part);
  part->moving = part->count;
  for (PetscInt k = 0; k < part->moving; ++k) part->moves[part->cells[k]] = PETSC_TRUE;
  (void)AddNeighbours(rve, first, part);
  PetscCall(ListUnknowns(&rve->mesh, part));
  *out = part;
  PetscFunctionReturn(0);
}

PetscErrorCode LamPartDestroy(LamPart **part)
{
  PetscFunctionBeginUser;
  if (!*part) PetscFunctionReturn(0);
  PetscCall(PetscFree((*part)->cells));
  PetscCall(PetscFree((*part)->unknown));
  PetscCall(PetscFree2((*part)->moves, (*part)->near));
  PetscCall(PetscFree(*part));
  PetscFunctionReturn(0);
}

void LamPartUse(LamRVE rve, const LamPart *part)
{
  rve->part = part;
  if (rve->smooth) rve->smooth->walls.near = part ? part->near : NULL;
}

PetscErrorCode LamPartClear(LamRVE rve, PetscReal residual[])
{
  const LamLinear *linear = rve->linear;

  PetscFunctionBeginUser;
  if (!rve->part) {
    PetscCall(PetscArrayzero(residual, rve->length));
    PetscCall(PetscArrayzero(linear->values, linear->nonzeros));
    PetscFunctionReturn(0);
  }
  for (PetscInt k = 0; k < rve->part->unknowns; ++k) {
    const PetscInt i = rve->part->unknown[k];

    residual[i + 2] = 0.0;
    PetscCall(PetscArrayzero(linear->values + linear->row[i], linear->row[i + 1] - linear->row[i]));
  }
  PetscFunctionReturn(0);
}

/* ---- the matrix ---- */

static PetscErrorCode Forget(LamPartSystem system)
{
  PetscFunctionBeginUser;
  PetscCall(LamFactorDestroy(&system->factor));
  PetscCall(PetscFree(system->column));
  PetscCall(PetscFree(system->from));
  PetscCall(PetscFree(system->values));
  PetscFunctionReturn(0);
}

/* The pattern is that of the rows and columns that move. */
static PetscErrorCode MakePattern(LamRVE rve, LamPartSystem system)
{
  const LamLinear *linear = rve->linear;
  PetscInt size = 0;

  PetscFunctionBeginUser;
  PetscCall(Forget(system));
  for (PetscInt pass = 0; pass < 2; ++pass) {
    if (pass == 1) {
      PetscCall(PetscMalloc1(size, &system->column));
      PetscCall(PetscMalloc1(size, &system->from));
      PetscCall(PetscMalloc1(size, &system->values));
    }
    size = 0;
    for (PetscInt k = 0; k < system->n; ++k) {
      system->row[k] = size;
      for (PetscInt p = linear->row[system->unknown[k]]; p < linear->row[system->unknown[k] + 1]; ++p) {
        const PetscInt column = system->index[linear->column[p]];

        if (column < 0) continue;
        if (pass == 1) system->column[size] = column;
        if (pass == 1) system->from[size] = p;
        ++size;
      }
    }
    system->row[system->n] = size;
  }
  system->couplings = rve->smooth->count;
  PetscCall(LamFactorCreate(PETSC_COMM_SELF, system->n, system->row, system->column, system->values, system->n,
                            &system->factor));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPartSystemCreate(LamRVE rve, const LamPart *part, LamPartSystem *out)
{
  const PetscInt n = rve->linear->n;
  LamPartSystem system;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&system));
  system->part = part;
  PetscCall(PetscMalloc1(n, &system->index));
  for (PetscInt i = 0; i < n; ++i) system->index[i] = -1;
  for (PetscInt k = 0; k < part->moving_unknowns; ++k) system->index[part->unknown[k]] = 0;
  for (PetscInt i = 0; i < n; ++i)
    if (system->index[i] == 0) system->index[i] = system->n++;
  PetscCall(PetscMalloc2(system->n, &system->unknown, system->n + 1, &system->row));
  for (PetscInt i = 0; i < n; ++i)
    if (system->index[i] >= 0) system->unknown[system->index[i]] = i;
  *out = system;
  PetscFunctionReturn(0);
}

PetscErrorCode LamPartSystemDestroy(LamPartSystem *system)
{
  PetscFunctionBeginUser;
  if (!*system) PetscFunctionReturn(0);
  PetscCall(Forget(*system));
  PetscCall(PetscFree((*system)->index));
  PetscCall(PetscFree2((*system)->unknown, (*system)->row));
  PetscCall(PetscFree(*system));
  PetscFunctionReturn(0);
}

PetscInt LamPartSystemUnknowns(const LamPartSystem system, const PetscInt **unknown)
{
  *unknown = system->unknown;
  return system->n;
}

PetscErrorCode LamPartSystemFactor(LamRVE rve, LamPartSystem system, PetscReal shift, PetscInt *negative, PetscBool *ok)
{
  PetscFunctionBeginUser;
  if (!system->factor || system->couplings != rve->smooth->count) PetscCall(MakePattern(rve, system));
  for (PetscInt k = 0; k < system->row[system->n]; ++k) system->values[k] = rve->linear->values[system->from[k]];
  for (PetscInt k = 0; k < system->n; ++k) system->values[system->row[k]] += shift;
  PetscCall(LamFactorNumeric(system->factor, negative, ok));
  PetscFunctionReturn(0);
}

PetscErrorCode LamPartSystemSolve(LamPartSystem system, PetscInt count, const PetscReal rhs[], PetscReal solution[])
{
  PetscFunctionBeginUser;
  PetscCall(LamFactorSolve(system->factor, count, rhs, solution));
  PetscFunctionReturn(0);
}

void LamPartSystemMultiply(LamRVE rve, const LamPartSystem system, const PetscReal x[], PetscReal image[])
{
  const LamLinear *linear = rve->linear;

  for (PetscInt k = 0; k < system->n; ++k) image[k] = 0.0;
  for (PetscInt u = 0; u < system->part->unknowns; ++u) {
    const PetscInt i = system->part->unknown[u], k = system->index[i];

    for (PetscInt p = linear->row[i]; p < linear->row[i + 1]; ++p) {
      const PetscInt j = linear->column[p];

      if (k >= 0) image[k] += linear->values[p] * x[j];
      if (j != i && system->index[j] >= 0) image[system->index[j]] += linear->values[p] * x[i];
    }
  }
}
