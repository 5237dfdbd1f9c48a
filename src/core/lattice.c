#include <lamella/lattice.h>

/* L_0 ... L_5 in terms of L_0 and L_1. */
static const PetscInt lattice[LAM_FACES][2] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};

/* n / 2 rounded down, also for negative n. */
static PetscInt HalfOf(PetscInt n)
{
  return n >= 0 ? n / 2 : -((1 - n) / 2);
}

/*
  Orientation of a patch in its lattice. For cells standing on a corner L_m is along the rows; for cells standing on
  an edge L_m is 30 degrees above them. In both cases L_{m+1} points to the row above.
*/
static PetscBool StandsOnEdge(const LamMicrostructure *micro, PetscInt *m)
{
  const PetscInt turns = (PetscInt)PetscFloorReal(micro->orientation / (PETSC_PI / 6.0) + 0.5); /* of 30 degrees */
  const PetscBool on_edge = (PetscBool)(turns % 2 != 0);

  *m = (((on_edge ? 1 - turns : -turns) / 2) % LAM_FACES + LAM_FACES) % LAM_FACES;
  return on_edge;
}

/* Column and row in a patch of lattice coordinates, which may lie outside the patch. */
static void PatchPlace(const LamMicrostructure *micro, const PetscInt index[2], PetscInt *column, PetscInt *row)
{
  PetscInt m, along, up;
  const PetscBool on_edge = StandsOnEdge(micro, &m);
  const PetscInt *a = lattice[m], *b = lattice[(m + 1) % LAM_FACES];

  along = index[0] * b[1] - index[1] * b[0]; /* a and b are L_0 and L_1 rotated: their determinant is 1 */
  up = a[0] * index[1] - a[1] * index[0];
  *column = on_edge ? along : along + HalfOf(up);
  *row = on_edge ? up + HalfOf(along) : up;
}

void LamLatticeIndex(const LamMicrostructure *micro, PetscInt cell, PetscInt index[2])
{
  const PetscInt i = cell / micro->cells[1], j = cell % micro->cells[1];
  PetscInt m, along, up;
  PetscBool on_edge;

  index[0] = i;
  index[1] = j;
  if (!micro->is_patch) return;
  on_edge = StandsOnEdge(micro, &m);
  along = on_edge ? i : i - HalfOf(j);
  up = on_edge ? j - HalfOf(i) : j;
  for (PetscInt d = 0; d < 2; ++d) index[d] = along * lattice[m][d] + up * lattice[(m + 1) % LAM_FACES][d];
}

PetscBool LamLatticeIsCut(const LamMicrostructure *micro, PetscInt cell, PetscInt other)
{
  const PetscInt rows = micro->cells[1], upper = cell % rows > other % rows ? cell : other;

  return (PetscBool)(upper / rows < micro->notch_columns && upper % rows == micro->notch_row &&
                     PetscMin(cell % rows, other % rows) == micro->notch_row - 1);
}

PetscInt LamLatticeNeighbour(const LamMicrostructure *micro, PetscInt cell, PetscInt face, PetscInt wraps[2],
                             PetscBool *held)
{
  PetscInt index[2], place[2];

  LamLatticeIndex(micro, cell, index);
  if (held) *held = PETSC_FALSE;
  for (PetscInt d = 0; d < 2; ++d) {
    const PetscInt n = micro->cells[d];
    PetscInt periods;

    index[d] += lattice[face][d];
    periods = index[d] < 0 ? -1 : index[d] / n; /* a neighbour is one lattice vector away */
    place[d] = index[d] - periods * n;
    if (wraps) wraps[d] = micro->is_patch ? 0 : periods;
  }
  if (micro->is_patch) {
    PatchPlace(micro, index, &place[0], &place[1]);
    if (place[0] < 0 || place[0] >= micro->cells[0] || place[1] < 0 || place[1] >= micro->cells[1]) {
      if (held) *held = (PetscBool)(micro->sides == LAM_SIDES_AFFINE || place[1] < 0 || place[1] >= micro->cells[1]);
      return -1;
    }
  }
  return place[0] * micro->cells[1] + place[1];
}

PetscReal LamLatticeDistance(PetscInt d0, PetscInt d1)
{
  return PetscSqrtReal((PetscReal)(d0 * d0 + d0 * d1 + d1 * d1));
}
