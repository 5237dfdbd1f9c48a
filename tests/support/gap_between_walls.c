#include "gap_between_walls.h"

Gap ComputeGap(const LamWall *wall, double k)
{
  const double a = ShearFlow(wall, GAP_PSI, k), f = ShearProfile(wall, GAP_PSI, a, 0.0, 1.0);
  const double p0 = ShearPressure(wall, GAP_PSI, 0.0, 0.0), p1 = ShearPressure(wall, GAP_PSI, k, -a * f);

  return (Gap){.ratio = (wall->C1 + wall->C2) / (wall->C4 * k * k),
               .gap = 1.0 - f / k,
               .shear = InterfaceShear(wall, GAP_PSI, k),
               .spread = InterfaceNormal(wall, GAP_PSI, 0.0, p0) - InterfaceNormal(wall, GAP_PSI, k, p1),
               .scale = a};
}

/* Displacements x1 - X1 of the free face and its current heights. */
typedef struct {
  double u[FACE_NODES], height[FACE_NODES];
} Face;

static PetscErrorCode FreeFace(const LamWall *wall, double a, double b, Face *face)
{
  StripProblem problem = {.wall = *wall,
                          .psi = GAP_PSI,
                          .a = a,
                          .b = b,
                          .length = 1.0,
                          .columns = FACE_ELEMENTS,
                          .rows = FACE_ELEMENTS,
                          .free_face = PETSC_TRUE};
  PetscInt iterations;
  Strip strip;

  PetscFunctionBeginUser;
  PetscCall(StripCreate(&problem, &strip));
  PetscCall(StripSolve(&strip, &iterations));
  for (PetscInt j = 0; j < FACE_NODES; j++) {
    const PetscInt node = (j + 1) * FACE_NODES - 1;

    face->u[j] = strip.blocks.x[node][0] - strip.blocks.X[node][0];
    face->height[j] = strip.blocks.x[node][1];
  }
  PetscCall(StripDestroy(&strip));
  PetscFunctionReturn(0);
}

/* Displacement at a height, linear between nodes. */
static double FaceAt(const Face *face, double height)
{
  int j = 1;

  while (j < FACE_NODES - 1 && face->height[j] < height) j++;
  return face->u[j] -
         (face->height[j] - height) * (face->u[j] - face->u[j - 1]) / (face->height[j] - face->height[j - 1]);
}

PetscErrorCode ComputeFreeFaces(const LamWall *wall, double k, FreeFaces *faces)
{
  const double tau = ShearFlow(wall, GAP_PSI, k);
  Face left = {{0}, {0}}, right = {{0}, {0}};

  PetscFunctionBeginUser;
  PetscCall(FreeFace(wall, tau, 0.0, &left));
  PetscCall(FreeFace(wall, 0.0, tau, &right));
  for (int j = 0; j < FACE_NODES; j++) {
    const double height = j / (FACE_NODES - 1.0);

    faces->computed[j] = 1.0 - (FaceAt(&right, 1.0 - height) + FaceAt(&left, height)) / k;
    faces->sheared[j] = height - ShearProfile(wall, GAP_PSI, tau, 0.0, height) / k;
    faces->power[j] = height - 0.75 * pow(height, 4.0 / 3.0);
  }
  PetscFunctionReturn(0);
}
