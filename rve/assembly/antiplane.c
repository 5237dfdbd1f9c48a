#include "antiplane.h"

#define MOST_ITERATIONS 300 /* of conjugate gradients; ten are usual */
#define SOLVED 1e-13        /* of the right-hand side */
#define HOLDS 1e-12         /* of the largest diagonal entry: a lamella less stiff holds nothing */

static PetscInt Edges(LamRVE rve)
{
  return rve->layer ? rve->layer->count / LAM_EDGE_POINTS : 0;
}

static void PlacePieces(LamRVE rve)
{
  LamAntiplane t = rve->antiplane;
  const LamMesh *mesh = &rve->mesh;

  for (PetscInt k = 0; k < t->pieces; ++k) {
    LamAxialPiece *piece = &t->piece[k];
    const LamEdgeNodes *edge = k < mesh->element_count ? NULL : &rve->layer->nodes[k - mesh->element_count];

    piece->count = edge ? LAM_EDGE_NODES : LAM_ELEMENT_NODES;
    for (PetscInt a = 0; a < piece->count; ++a) {
      const PetscInt node = edge ? 0 : mesh->elements[LAM_ELEMENT_NODES * k + a];

      piece->class[a] = edge ? edge->class[a] : mesh->node_class[node];
      for (PetscInt l = 0; l < 2; ++l) piece->shift[a][l] = edge ? edge->shift[a][l] : mesh->shift[2 * node + l];
    }
  }
}

/* The pattern: keys i * n + j, i <= j, of unknowns of one piece. */
static PetscErrorCode MakePattern(LamAntiplane t)
{
  PetscInt64 *key;
  PetscInt count = 0, unique = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(45 * t->pieces + t->n, &key));
  for (PetscInt i = 0; i < t->n; ++i) key[count++] = (PetscInt64)i * t->n + i;
  for (PetscInt k = 0; k < t->pieces; ++k)
    for (PetscInt a = 0; a < t->piece[k].count; ++a)
      for (PetscInt b = a; b < t->piece[k].count; ++b) {
        const PetscInt i = t->piece[k].class[a] - 1, j = t->piece[k].class[b] - 1;

        if (i >= 0 && j >= 0) key[count++] = (PetscInt64)PetscMin(i, j) * t->n + PetscMax(i, j);
      }
  PetscCall(PetscSortInt64(count, key));
  for (PetscInt k = 0; k < count; ++k)
    if (k == 0 || key[k] != key[k - 1]) key[unique++] = key[k];
  PetscCall(PetscMalloc3(t->n + 1, &t->row, unique, &t->column, unique, &t->values));
  for (PetscInt k = 0, i = 0; k < unique; ++k) {
    for (; i <= key[k] / t->n; ++i) t->row[i] = k;
    t->column[k] = (PetscInt)(key[k] % t->n);
  }
  t->row[t->n] = unique;
  PetscCall(PetscFree(key));
  PetscFunctionReturn(0);
}

static void FindEntries(LamAntiplane t)
{
  for (PetscInt k = 0; k < t->pieces; ++k) {
    LamAxialPiece *piece = &t->piece[k];

    for (PetscInt a = 0, pair = 0; a < piece->count; ++a)
      for (PetscInt b = a; b < piece->count; ++b, ++pair) {
        const PetscInt i = PetscMin(piece->class[a], piece -> class[b]) - 1;
        const PetscInt j = PetscMax(piece->class[a], piece -> class[b]) - 1;

        piece->entry[pair] = i < 0 ? -1 : t->row[i];
        while (i >= 0 && t->column[piece->entry[pair]] != j) ++piece->entry[pair];
      }
  }
}

PetscErrorCode LamAntiplaneCreate(LamRVE rve, LamAntiplane *antiplane)
{
  LamAntiplane t;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&t));
  rve->antiplane = *antiplane = t;
  t->classes = rve->mesh.class_count;
  t->n = t->classes - 1 + (t->classes - 1) % 2;
  t->pieces = rve->mesh.element_count + Edges(rve);
  PetscCall(PetscCalloc3(t->classes, &t->z, t->classes, &t->f, t->classes, &t->root));
  PetscCall(PetscCalloc1(t->pieces, &t->piece));
  PetscCall(PetscCalloc1(rve->mesh.element_count, &t->shear));
  PlacePieces(rve);
  PetscCall(MakePattern(t));
  FindEntries(t);
  PetscCall(LamFactorCreate(PETSC_COMM_SELF, t->n, t->row, t->column, t->values, t->n, &t->factor));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAntiplaneDestroy(LamAntiplane *antiplane)
{
  LamAntiplane t = *antiplane;

  PetscFunctionBeginUser;
  if (!t) PetscFunctionReturn(0);
  PetscCall(LamFactorDestroy(&t->factor));
  PetscCall(PetscFree3(t->row, t->column, t->values));
  PetscCall(PetscFree3(t->z, t->f, t->root));
  PetscCall(PetscFree(t->piece));
  PetscCall(PetscFree(t->shear));
  PetscCall(PetscFree(*antiplane));
  PetscFunctionReturn(0);
}

/* Third components of the nodes of a piece. */
static void Gather(const LamAxialPiece *piece, const PetscReal z[], const PetscReal G[2],
                   PetscReal local[LAM_ELEMENT_NODES])
{
  for (PetscInt a = 0; a < piece->count; ++a)
    local[a] = z[piece->class[a]] + G[0] * piece->shift[a][0] + G[1] * piece->shift[a][1];
}

void LamAntiplanePlace(LamRVE rve, const LamLoad *load, PetscInt node, PetscReal z)
{
  LamAntiplane t = rve->antiplane;
  const PetscReal *S = &rve->mesh.shift[2 * node];

  for (PetscInt l = 0; l < 2; ++l) t->G[l] = load->F[6 + l];
  t->z[rve->mesh.node_class[node]] = z - t->G[0] * S[0] - t->G[1] * S[1];
  t->z[0] = 0.0; /* as on every mesh */
}

void LamAntiplaneUse(LamRVE rve)
{
  LamAntiplane t = rve->antiplane;
  PetscBool any = PETSC_FALSE;

  for (PetscInt c = 0; c < t->classes; ++c) any = (PetscBool)(any || t->z[c] != 0.0);
  any = (PetscBool)(any || t->G[0] != 0.0 || t->G[1] != 0.0);
  for (PetscInt k = 0; k < t->pieces; ++k) {
    const PetscInt elements = rve->mesh.element_count;
    PetscReal local[LAM_ELEMENT_NODES];

    Gather(&t->piece[k], t->z, t->G, local);
    for (PetscInt q = 0; k >= elements && q < LAM_EDGE_POINTS; ++q) {
      LamBond *bond = &rve->layer->bond[LAM_EDGE_POINTS * (k - elements) + q];
      PetscReal weight[LAM_EDGE_NODES];

      LamEdgeJumpWeights(q, weight);
      bond->axial = 0.0;
      for (PetscInt a = 0; a < LAM_EDGE_NODES; ++a) bond->axial += weight[a] * local[a];
    }
    if (k >= elements) continue;
    for (PetscInt l = 0; l < 2; ++l)
      for (PetscInt g = 0; g < LAM_POINTS; ++g) {
        t->shear[k][l][g] = 0.0;
        for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
          t->shear[k][l][g] += local[a] * rve->geometry[k].shape[l][a][g];
      }
    rve->geometry[k].shear = any ? t->shear[k] : NULL;
  }
  LamForgetTangent(rve);
}

/* Derivatives of an edge: q = ... + beta^2 delta_3^2 in the potential phi(q). */
static void AddBond(void *ctx, const LamBondPoint *point)
{
  LamRVE rve = (LamRVE)ctx;
  const LamBond *bond = &rve->layer->bond[point->point];
  const PetscInt q = point->point % LAM_EDGE_POINTS;
  LamElementAxial *d = &rve->antiplane->piece[rve->mesh.element_count + point->point / LAM_EDGE_POINTS].d;
  const PetscReal dq = 2.0 * bond->law.beta * bond->law.beta * bond->axial, w = rve->layer->weight[point->point];
  const PetscReal second = 2.0 * bond->law.beta * bond->law.beta * point->step.d + point->step.dd * dq * dq;
  PetscReal weight[LAM_EDGE_NODES], gradient[LAM_EDGE_DOFS];

  LamEdgeJumpWeights(q, weight);
  LamEdgeSpread(q, w * point->step.dd * dq, point->jump.dq, gradient);
  for (PetscInt a = 0; a < LAM_EDGE_NODES; ++a) {
    d->f[a] += w * weight[a] * point->step.d * dq;
    for (PetscInt b = 0; b < LAM_EDGE_NODES; ++b) d->K[a][b] += w * weight[a] * second * weight[b];
    for (PetscInt j = 0; j < LAM_EDGE_DOFS; ++j) d->mixed[a][j] += weight[a] * gradient[j];
  }
}

static PetscInt Root(PetscInt root[], PetscInt c)
{
  while (root[c] != c) c = root[c] = root[root[c]];
  return c;
}

/* Holds one class of each set of pieces that hang together, but not on class 0: it slides freely along the cells. */
static void HoldFree(LamRVE rve, LamAntiplane t)
{
  PetscReal largest = 0.0;

  for (PetscInt i = 0; i < t->n; ++i) largest = PetscMax(largest, t->values[t->row[i]]);
  for (PetscInt c = 0; c < t->classes; ++c) t->root[c] = c;
  for (PetscInt k = 0; k < t->pieces; ++k) {
    const LamAxialPiece *piece = &t->piece[k];
    PetscReal holds = 0.0;

    for (PetscInt a = 0; a < piece->count; ++a) holds = PetscMax(holds, piece->d.K[a][a]);
    if (k >= rve->mesh.element_count && !(holds > HOLDS * largest)) continue;
    for (PetscInt a = 1; a < piece->count; ++a) {
      const PetscInt i = Root(t->root, piece->class[a]), j = Root(t->root, piece->class[0]);

      t->root[PetscMax(i, j)] = PetscMin(i, j);
    }
  }
  for (PetscInt c = 1; c < t->classes; ++c)
    if (Root(t->root, c) == c) t->values[t->row[c - 1]] += largest;
  if (t->n > t->classes - 1) t->values[t->row[t->n - 1]] = largest;
}

/* Sums the pieces. */
static void Sum(LamAntiplane t)
{
  for (PetscInt c = 0; c < t->classes; ++c) t->f[c] = 0.0;
  for (PetscInt p = 0; p < t->row[t->n]; ++p) t->values[p] = 0.0;
  t->LG[0] = t->LG[1] = 0.0;
  t->couples = PETSC_FALSE;
  for (PetscInt k = 0; k < t->pieces; ++k) {
    const LamAxialPiece *piece = &t->piece[k];

    for (PetscInt a = 0, pair = 0; a < piece->count; ++a) {
      t->f[piece->class[a]] += piece->d.f[a];
      for (PetscInt l = 0; l < 2; ++l) t->LG[l] += piece->d.f[a] * piece->shift[a][l];
      for (PetscInt b = a; b < piece->count; ++b, ++pair)
        if (piece->entry[pair] >= 0) t->values[piece->entry[pair]] += piece->d.K[a][b];
      for (PetscInt j = 0; j < LAM_ELEMENT_DOFS; ++j)
        t->couples = (PetscBool)(t->couples || piece->d.mixed[a][j] != 0.0);
      t->couples = (PetscBool)(t->couples || piece->d.f33[a] != 0.0);
    }
  }
}

PetscErrorCode LamAntiplaneAssemble(LamRVE rve, const LamLoad *load, PetscBool *ok)
{
  LamAntiplane t = rve->antiplane;
  PetscInt negative;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < t->pieces; ++k) {
    PetscReal u[LAM_ELEMENT_NODES][2];

    t->piece[k].d = (LamElementAxial){0};
    if (k >= rve->mesh.element_count) continue;
    LamGatherDisplacements(rve, load->F, rve->y, k, u);
    LamElementShear(&rve->geometry[k], LamLawOf(rve, k), LamWallOf(rve, k), LamHistoryOf(rve, k),
                    (const PetscReal(*)[2])u, load->F[8], &rve->stress[k], &t->piece[k].d);
  }
  if (rve->layer) LamLayerVisitPoints(rve, load->F, rve->y, AddBond, rve);
  Sum(t);
  HoldFree(rve, t);
  PetscCall(LamFactorNumeric(t->factor, &negative, ok));
  if (negative > 0) *ok = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Displacement of a node in the plane. */
static void GatherPlane(const LamAxialPiece *piece, const LamPlaneDirection *d, PetscReal local[LAM_ELEMENT_DOFS])
{
  for (PetscInt b = 0; b < piece->count; ++b)
    for (PetscInt i = 0; i < 2; ++i)
      local[2 * b + i] = (d->y ? d->y[2 * piece->class[b] + i] : 0.0) + d->F[2 * i] * piece->shift[b][0] +
                         d->F[2 * i + 1] * piece->shift[b][1];
}

void LamAntiplaneFromPlane(LamRVE rve, const LamPlaneDirection *d, PetscReal z[], PetscReal G[2])
{
  const LamAntiplane t = rve->antiplane;

  for (PetscInt k = 0; k < t->pieces && t->couples; ++k) {
    const LamAxialPiece *piece = &t->piece[k];
    PetscReal local[LAM_ELEMENT_DOFS];

    GatherPlane(piece, d, local);
    for (PetscInt a = 0; a < piece->count; ++a) {
      PetscReal sum = piece->d.f33[a] * d->F33;

      for (PetscInt j = 0; j < 2 * piece->count; ++j) sum += piece->d.mixed[a][j] * local[j];
      z[piece->class[a]] += sum;
      for (PetscInt l = 0; l < 2; ++l) G[l] += sum * piece->shift[a][l];
    }
  }
}

void LamAntiplaneToPlane(LamRVE rve, const PetscReal z[], const PetscReal G[2], LamPlaneGradient *out)
{
  const LamAntiplane t = rve->antiplane;

  for (PetscInt k = 0; k < t->pieces && t->couples; ++k) {
    const LamAxialPiece *piece = &t->piece[k];
    PetscReal local[LAM_ELEMENT_NODES];

    Gather(piece, z, G, local);
    for (PetscInt a = 0; a < piece->count; ++a) out->F33 += piece->d.f33[a] * local[a];
    for (PetscInt j = 0; j < 2 * piece->count; ++j) {
      PetscReal sum = 0.0;

      for (PetscInt a = 0; a < piece->count; ++a) sum += piece->d.mixed[a][j] * local[a];
      out->y[2 * piece->class[j / 2] + j % 2] += sum;
      for (PetscInt l = 0; l < 2; ++l) out->F[2 * (j % 2) + l] += sum * piece->shift[j / 2][l];
    }
  }
}

void LamAntiplaneApply(LamRVE rve, const PetscReal z[], const PetscReal G[2], PetscReal out[], PetscReal outG[2])
{
  const LamAntiplane t = rve->antiplane;

  for (PetscInt k = 0; k < t->pieces; ++k) {
    const LamAxialPiece *piece = &t->piece[k];
    PetscReal local[LAM_ELEMENT_NODES];

    Gather(piece, z, G, local);
    for (PetscInt a = 0; a < piece->count; ++a) {
      PetscReal sum = 0.0;

      for (PetscInt b = 0; b < piece->count; ++b) sum += piece->d.K[a][b] * local[b];
      out[piece->class[a]] += sum;
      for (PetscInt l = 0; l < 2; ++l) outG[l] += sum * piece->shift[a][l];
    }
  }
}

/* ---- the condensed system ---- */

PetscErrorCode LamAntiplaneRelax(LamRVE rve, const PetscReal rhs[], PetscReal y[])
{
  const PetscInt n = rve->linear->n;
  PetscReal *from, *to;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &from, n, &to));
  PetscCall(PetscArraycpy(from, rhs + 2, rve->linear->positions));
  PetscCall(LamLinearSolve(rve->linear, 1, from, to));
  y[0] = y[1] = 0.0;
  PetscCall(PetscArraycpy(y + 2, to, rve->linear->positions));
  PetscCall(PetscFree2(from, to));
  PetscFunctionReturn(0);
}

/* image := S z, z_0 = 0; work [2 ndof] */
static PetscErrorCode ApplyCondensed(LamRVE rve, const PetscReal z[], PetscReal image[], PetscReal work[])
{
  static const PetscReal none[2] = {0.0, 0.0};
  const LamAntiplane t = rve->antiplane;
  PetscReal G[2];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(image, t->classes));
  LamAntiplaneApply(rve, z, none, image, G);
  if (t->couples) {
    LamPlaneGradient force = {.y = work};
    LamPlaneDirection back = {.y = work + rve->ndof};

    PetscCall(PetscArrayzero(work, rve->ndof));
    LamAntiplaneToPlane(rve, z, none, &force);
    for (PetscInt i = 0; i < rve->ndof; ++i) work[i] = -work[i];
    PetscCall(LamAntiplaneRelax(rve, work, work + rve->ndof));
    LamAntiplaneFromPlane(rve, &back, image, G);
  }
  image[0] = 0.0;
  PetscFunctionReturn(0);
}

/* p := L_zz^-1 r, r and p [class] */
static PetscErrorCode Precondition(LamAntiplane t, const PetscReal r[], PetscReal p[])
{
  PetscReal *rhs, *to;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(t->n, &rhs, t->n, &to));
  PetscCall(PetscArraycpy(rhs, r + 1, t->classes - 1));
  PetscCall(LamFactorSolve(t->factor, 1, rhs, to));
  p[0] = 0.0;
  PetscCall(PetscArraycpy(p + 1, to, t->classes - 1));
  PetscCall(PetscFree2(rhs, to));
  PetscFunctionReturn(0);
}

PetscErrorCode LamAntiplaneSolve(LamRVE rve, const PetscReal rhs[], PetscReal z[], PetscBool *ok)
{
  const LamAntiplane t = rve->antiplane;
  const PetscInt n = t->classes;
  PetscReal *r, *p, *image, *better, *work, rho, first;

  PetscFunctionBeginUser;
  *ok = PETSC_TRUE;
  PetscCall(PetscMalloc5(n, &r, n, &p, n, &image, n, &better, 2 * rve->ndof, &work));
  PetscCall(PetscArrayzero(z, n));
  PetscCall(PetscArraycpy(r, rhs, n));
  r[0] = 0.0;
  PetscCall(Precondition(t, r, better));
  PetscCall(PetscArraycpy(p, better, n));
  rho = first = LamInnerProduct(n, r, better);
  if (!(first >= 0.0)) *ok = PETSC_FALSE;
  for (PetscInt it = 0; it < MOST_ITERATIONS && rho > SOLVED * SOLVED * first; ++it) {
    PetscReal curvature, alpha, next;

    PetscCall(ApplyCondensed(rve, p, image, work));
    curvature = LamInnerProduct(n, p, image);
    if (!(curvature > 0.0)) {
      *ok = PETSC_FALSE;
      break;
    }
    alpha = rho / curvature;
    for (PetscInt i = 0; i < n; ++i) {
      z[i] += alpha * p[i];
      r[i] -= alpha * image[i];
    }
    PetscCall(Precondition(t, r, better));
    next = LamInnerProduct(n, r, better);
    for (PetscInt i = 0; i < n; ++i) p[i] = better[i] + next / rho * p[i];
    rho = next;
  }
  PetscCall(PetscFree5(r, p, image, better, work));
  PetscFunctionReturn(0);
}
