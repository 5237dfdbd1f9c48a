/*
  Tractions on the bonded interfaces between cells.

  Method. In equilibrium the internal forces of a cell at the nodes of an outer face equal the loads exerted by its
  neighbour. Where n cells meet, the forces f_i (sum zero) are shared among the faces by the split of least norm, in the
  order around the junction t_i = sum_j ((n - 1)/2 - j)/n f_{i+j}; of three cells t_AB = (f_A - f_B)/3. The traction
  field t = sum N_j t_j on the face solves the mass system int N_i N_j ds t_j = f_i on the current quadratic edges, so
  it is exactly equivalent to the nodal forces. Exceptions are face ends that a patch prescribes: their forces contain
  the reaction, so the traction there is extrapolated. Normal component in tension positive, shear component without
  sign, per current length (Cauchy). Point values at the lumen corners diverge under refinement; averages over a length
  of one wall thickness converge.
*/
#include "measure.h"
#include "mortar_impl.h"
#include <petscblaslapack.h>

#define SAMPLES 8 /* per edge: sub-intervals of the running integrals */

/* Internal forces of the walls at all mesh nodes, not summed over classes: force[node][2]. */
static void NodeForces(LamRVE rve, const LamLoad *load, PetscReal force[])
{
  const LamMesh *mesh = &rve->mesh;

  (void)PetscArrayzero(force, 2 * mesh->node_count);
  for (PetscInt e = 0; e < mesh->element_count; ++e) {
    PetscReal u[LAM_ELEMENT_NODES][2];
    PetscReal f[LAM_ELEMENT_DOFS];

    if (!LamMeshElementIsOuter(mesh, e)) continue; /* only the outermost elements touch a face */
    LamGatherDisplacements(rve, load->F, rve->y, e, u);
    LamElementForces(&rve->geometry[e], LamLawOf(rve, e), LamWallOf(rve, e), LamHistoryOf(rve, e),
                     (const PetscReal(*)[2])u, load->F[8], f);
    for (PetscInt a = 0; a < LAM_ELEMENT_NODES; ++a)
      for (PetscInt d = 0; d < 2; ++d) force[2 * mesh->elements[LAM_ELEMENT_NODES * e + a] + d] += f[2 * a + d];
  }
}

/* The load on the cell of a face at its start, which its neighbour there exerts. */
static void JunctionLoad(const LamMesh *mesh, const PetscReal force[], PetscInt face, PetscReal f[2])
{
  const LamJunction j = LamMeshJunction(mesh, face);

  f[0] = f[1] = 0.0;
  for (PetscInt i = 0; i < j.count; ++i) {
    const PetscInt node = LamMeshOuterNode(mesh, j.face[i], 0);
    const PetscReal share = j.closed   ? (0.5 * (PetscReal)(j.count - 1) - (PetscReal)i) / (PetscReal)j.count
                            : i < j.at ? -0.5
                                       : 0.5;

    for (PetscInt d = 0; d < 2; ++d) f[d] += share * force[2 * node + d];
  }
}

/* Positions x[2 along + 1][2] and loads f likewise of one face, counter-clockwise. */
static void FaceLoads(LamRVE rve, const LamLoad *load, const PetscReal force[], PetscInt face, PetscReal x[][2],
                      PetscReal f[][2])
{
  const LamMesh *mesh = &rve->mesh;
  const PetscInt last = 2 * mesh->along, partner = mesh->tissue->partner[face];
  PetscReal end[2];

  for (PetscInt i = 0; i <= last; ++i) {
    const PetscInt node = LamMeshOuterNode(mesh, face, i), opposite = LamMeshOuterNode(mesh, partner, last - i);

    LamNodePosition(rve, load->F, rve->y, node, x[i]);
    for (PetscInt d = 0; d < 2; ++d) f[i][d] = 0.5 * (force[2 * node + d] - force[2 * opposite + d]);
  }
  if (mesh->flat[face][0] == 0) JunctionLoad(mesh, force, face, f[0]);
  if (mesh->flat[face][1] < mesh->along) return;
  JunctionLoad(mesh, force, partner, end); /* on the other cell */
  for (PetscInt d = 0; d < 2; ++d) f[last][d] = -end[d];
}

/* Quadratic edge functions at xi in [-1, 1], and the current tangent dx/dxi. */
static void EdgePoint(const PetscReal x[][2], PetscReal xi, PetscReal N[3], PetscReal tangent[2])
{
  PetscReal dN[3];

  LamEdgeShape(xi, N, dN);
  LamEdgeSum(x, dN, tangent);
}

/* Whether node i of a face is prescribed at F X: its force then contains the reaction, which does not belong to the
   face. */
static PetscBool IsHeld(const LamRVE rve, PetscInt face, PetscInt i)
{
  const PetscInt node = LamMeshOuterNode(&rve->mesh, face, i);

  return (PetscBool)(rve->micro.is_patch && rve->mesh.node_class[node] == 0);
}

/* Replaces the equation of end node i: its traction is extrapolated linearly from the next two nodes. On a face of one
   element, whose ends may both be prescribed, it equals that of the middle node. */
static void ExtrapolateEnd(PetscInt n, PetscInt i, PetscInt inwards, PetscReal M[], PetscReal b[])
{
  const PetscReal slope = n > 3 ? 1.0 : 0.0;

  for (PetscInt j = 0; j < n; ++j) M[j * n + i] = 0.0;
  M[i * n + i] = 1.0;
  M[(i + inwards) * n + i] = -1.0 - slope;
  M[(i + 2 * inwards) * n + i] = slope;
  b[i] = b[n + i] = 0.0;
}

/* Solves the mass system of one face. f becomes the nodal tractions; M is work space of size n x n; held: whether the
   ends are prescribed. */
static PetscErrorCode FaceTraction(PetscInt along, const PetscBool held[2], const PetscReal x[][2], PetscReal f[][2],
                                   PetscReal M[], PetscReal b[], PetscBLASInt pivots[])
{
  const PetscReal point[4] = {-0.861136311594053, -0.339981043584856, 0.339981043584856, 0.861136311594053};
  const PetscReal weight[4] = {0.347854845137454, 0.652145154862546, 0.652145154862546, 0.347854845137454};
  const PetscInt n = 2 * along + 1;
  PetscBLASInt bn, columns = 2, info;

  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &bn));
  PetscCall(PetscArrayzero(M, n * n));
  for (PetscInt e = 0; e < along; ++e)
    for (PetscInt g = 0; g < 4; ++g) {
      PetscReal N[3], tangent[2], ds;

      EdgePoint(&x[2 * e], point[g], N, tangent);
      ds = weight[g] * PetscSqrtReal(tangent[0] * tangent[0] + tangent[1] * tangent[1]);
      for (PetscInt i = 0; i < 3; ++i)
        for (PetscInt j = 0; j < 3; ++j) M[(2 * e + i) * n + 2 * e + j] += ds * N[i] * N[j];
    }
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt d = 0; d < 2; ++d) b[d * n + i] = f[i][d];
  if (held[0]) ExtrapolateEnd(n, 0, 1, M, b);
  if (held[1]) ExtrapolateEnd(n, n - 1, -1, M, b);
  PetscCallBLAS("LAPACKgesv", LAPACKgesv_(&bn, &columns, M, &bn, pivots, b, &bn, &info));
  PetscCheck(info == 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "face mass matrix is singular (LAPACK gesv: %d)", (int)info);
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt d = 0; d < 2; ++d) f[i][d] = b[d * n + i];
  PetscFunctionReturn(0);
}

/* Running integrals along a face at sample ends [along*SAMPLES + 1]. */
typedef struct {
  PetscReal *normal, *shear, *back; /* forces; back = -shear */
  PetscReal *length;                /* current */
} FaceSums;

/* flat: elements of the face that lie on the other wall; others carry nothing. */
static void Accumulate(PetscInt along, const PetscInt flat[2], const PetscReal x[][2], const PetscReal t[][2],
                       FaceSums *sums)
{
  const PetscReal half = 1.0 / SAMPLES; /* of a sub-interval */

  sums->normal[0] = sums->shear[0] = sums->back[0] = sums->length[0] = 0.0;
  for (PetscInt e = 0; e < along; ++e)
    for (PetscInt s = 0; s < SAMPLES; ++s) {
      const PetscInt k = e * SAMPLES + s;
      const PetscBool carries = (PetscBool)(e >= flat[0] && e < flat[1]);
      PetscReal tn = 0.0, ts = 0.0, ds = 0.0;

      for (PetscInt side = -1; side <= 1; side += 2) { /* two Gauss points: exact for t.n and t.tangent, cubics */
        const PetscReal xi = -1.0 + half * (2.0 * (PetscReal)s + 1.0 + (PetscReal)side / PetscSqrtReal(3.0));
        PetscReal N[3], tangent[2];

        EdgePoint(&x[2 * e], xi, N, tangent);
        /* outward normal times ds/dxi is (tangent_2, -tangent_1): the face runs counter-clockwise around its cell */
        for (PetscInt i = 0; i < 3 && carries; ++i) {
          tn += N[i] * (t[2 * e + i][0] * tangent[1] - t[2 * e + i][1] * tangent[0]);
          ts += N[i] * (t[2 * e + i][0] * tangent[0] + t[2 * e + i][1] * tangent[1]);
        }
        ds += PetscSqrtReal(tangent[0] * tangent[0] + tangent[1] * tangent[1]);
      }
      sums->normal[k + 1] = sums->normal[k] + half * tn;
      sums->shear[k + 1] = sums->shear[k] + half * ts;
      sums->back[k + 1] = -sums->shear[k + 1];
      sums->length[k + 1] = sums->length[k] + half * ds;
    }
}

/* Value of a running integral at coordinate s of the face, in sub-intervals. */
static PetscReal RunningAt(PetscInt count, const PetscReal integral[], PetscReal s)
{
  const PetscInt k = PetscMin((PetscInt)s, count - 1);

  return integral[k] + (s - (PetscReal)k) * (integral[k + 1] - integral[k]);
}

/* Largest mean over windows, and the window's middle. window: fraction of the face, at most the whole. Each window
   begins or ends at an end of a sub-interval, so those flush with either end of the face are included. */
static PetscReal LargestWindowMean(const LamMesh *mesh, PetscInt face, PetscInt count, PetscReal window,
                                   const PetscReal integral[], const PetscReal length[], PetscReal *middle)
{
  const PetscReal samples = (PetscReal)count / (PetscReal)mesh->along;
  PetscReal largest = -PETSC_MAX_REAL, named = -PETSC_MAX_REAL;

  *middle = 0.5;
  if (window >= 1.0) return integral[count] / length[count];
  for (PetscInt k = 0; k <= count; ++k)
    for (PetscInt side = -1; side <= 1; side += 2) {
      const PetscReal share = LamMeshShare(mesh, face, (PetscReal)k / samples),
                      other = share + (PetscReal)side * window;
      PetscReal at, mean;

      if (other < 0.0 || other > 1.0) continue;
      at = samples * LamMeshPlace(mesh, face, other);
      mean = (RunningAt(count, integral, at) - integral[k]) / (RunningAt(count, length, at) - length[k]);
      largest = PetscMax(largest, mean);
      if (!LamExceeds(mean, named)) continue;
      named = mean;
      *middle = 0.5 * (share + other);
    }
  return largest;
}

void LamTakeLargestMean(const LamMesh *mesh, PetscReal thickness, PetscInt face, PetscInt count,
                        const PetscReal integral[], const PetscReal length[], LamLargestMean *largest)
{
  PetscReal middle;
  const PetscReal window = thickness / mesh->length[face];
  const PetscReal mean = LargestWindowMean(mesh, face, count, window, integral, length, &middle);

  largest->value = PetscMax(largest->value, mean);
  if (!LamExceeds(mean, largest->named)) return;
  largest->named = mean;
  largest->place[0] = (PetscReal)mesh->tissue->cell[face];
  largest->place[1] = (PetscReal)LamMeshLocalFace(mesh, face);
  largest->place[2] = middle;
}

/* The tractions t of the part of a face that lies on the other wall, from the loads on its nodes. */
static PetscErrorCode FlatTraction(LamRVE rve, PetscInt face, const PetscReal x[][2], PetscReal t[][2], PetscReal M[],
                                   PetscReal b[], PetscBLASInt pivots[])
{
  const PetscInt *flat = rve->mesh.flat[face], first = 2 * flat[0];
  const PetscBool held[2] = {IsHeld(rve, face, first), IsHeld(rve, face, 2 * flat[1])};

  PetscFunctionBeginUser;
  PetscCall(FaceTraction(flat[1] - flat[0], held, &x[first], &t[first], M, b, pivots));
  PetscFunctionReturn(0);
}

PetscErrorCode LamFaceTractions(LamRVE rve, const LamLoad *load, LamResponse *response)
{
  const LamMesh *mesh = &rve->mesh;
  const PetscInt n = 2 * mesh->along + 1, count = mesh->along * SAMPLES;
  PetscReal *force, (*x)[2], (*t)[2], *M, *b;
  PetscBLASInt *pivots;
  LamLargestMean normal = LAM_NO_MEAN, shear = LAM_NO_MEAN;
  FaceSums sums;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc6(2 * mesh->node_count, &force, n, &x, n, &t, n * n, &M, 2 * n, &b, n, &pivots));
  PetscCall(
      PetscMalloc4(count + 1, &sums.normal, count + 1, &sums.shear, count + 1, &sums.back, count + 1, &sums.length));
  NodeForces(rve, load, force);
  for (PetscInt family = 0; family < 3; ++family) {
    PetscReal total = 0.0, length = 0.0;

    for (PetscInt face = 0; face < mesh->tissue->faces; ++face) {
      const PetscReal thickness = LamMeshThinner(mesh, face);

      if (!LamTissueIsSlave(mesh->tissue, face) || mesh->tissue->direction[face] != family) continue;
      FaceLoads(rve, load, force, face, x, t);
      PetscCall(FlatTraction(rve, face, (const PetscReal(*)[2])x, t, M, b, pivots));
      Accumulate(mesh->along, mesh->flat[face], (const PetscReal(*)[2])x, (const PetscReal(*)[2])t, &sums);
      total += sums.normal[count];
      length += sums.length[count];
      LamTakeLargestMean(mesh, thickness, face, count, sums.normal, sums.length, &normal);
      LamTakeLargestMean(mesh, thickness, face, count, sums.shear, sums.length, &shear);
      LamTakeLargestMean(mesh, thickness, face, count, sums.back, sums.length, &shear);
    }
    response->mean_face_traction[family] = length > 0.0 ? total / length : NAN; /* a narrow patch may lack a family */
  }
  response->max_traction = LamLargestMeanValue(&normal);
  response->max_lamella_shear = LamLargestMeanValue(&shear);
  PetscCall(PetscArraycpy(response->normal_place, normal.place, 3));
  PetscCall(PetscArraycpy(response->shear_place, shear.place, 3));
  PetscCall(PetscFree6(force, x, t, M, b, pivots));
  PetscCall(PetscFree4(sums.normal, sums.shear, sums.back, sums.length));
  PetscFunctionReturn(0);
}
