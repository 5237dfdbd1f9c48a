/*
  Prescribed displacements of the body, and its loads at a load parameter.

  A node has up to two prescribed directions: components, or the normal of a side of symmetry.
*/
#include <math.h>
#include <stdlib.h>
#include "macro_impl.h"
#include "names.h"
#include <petscblaslapack.h>

/* ---- names ---- */

PetscBool LamMacroIsOn(LamMacro macro, PetscInt p, const char on[])
{
  const PetscInt set = LamMacroFindSet(macro, on);

  return set >= 0 && macro->sets[p - macro->mesh_start] >> set & 1 ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode CheckName(LamMacro macro, const char key[], const LamScenePlace *place, const char on[])
{
  char names[LAM_MESSAGE_LENGTH] = "";

  PetscFunctionBeginUser;
  if (LamMacroFindSet(macro, on) >= 0) PetscFunctionReturn(0);
  for (PetscInt s = 0; s < macro->set_count; s++) LamNamesAppend(sizeof(names), names, ", ", macro->set_name[s]);
  LamMacroRequire(PETSC_FALSE, macro, place, "%s: on: %s: no such boundary of the mesh; there %s %s", key, on,
                  macro->set_count == 1 ? "is" : "are",
                  macro->set_count ? names : "none; name its sides as physical groups of lines");
  PetscFunctionReturn(0);
}

/* Water passes the outside of the body alone. */
static PetscErrorCode CheckOutside(LamMacro macro, const LamSurface *surface)
{
  const PetscInt set = LamMacroFindSet(macro, surface->on);
  PetscInt facets = 0;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < macro->facet_count; f++) facets += macro->facets[f].sets >> set & 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &facets, 1, MPIU_INT, MPI_SUM, macro->comm));
  LamMacroRequire(facets > 0, macro, &surface->place,
                  "process.transport.surface: on: %s: is a point or lies inside the body; name a piece of its boundary",
                  surface->on);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroBoundaryCheck(LamMacro macro)
{
  const LamMacroSpec *spec = &macro->scene->macro;
  const LamTransportSpec *transport = &macro->scene->process.transport;

  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < spec->boundary_count; b++)
    PetscCall(CheckName(macro, "macro.boundary", &spec->boundary[b].place, spec->boundary[b].on));
  if (spec->control.on[0]) PetscCall(CheckName(macro, "macro.control", &spec->control.place, spec->control.on));
  for (PetscInt k = 0; k < transport->surface_count; k++) {
    const LamSurface *surface = &transport->surface[k];
    PetscCall(CheckName(macro, "process.transport.surface", &surface->place, surface->on));
    PetscCall(CheckOutside(macro, surface));
  }
  PetscFunctionReturn(0);
}

static const char *ReportedName(const LamBoundary *boundary)
{
  return boundary->name[0] ? boundary->name : boundary->on;
}

PetscInt LamMacroSideNumber(const LamMacroStep *step, const LamBoundary *boundary)
{
  for (PetscInt s = 0; s < step->boundary_count; s++) {
    if (!strcmp(step->boundary[s], ReportedName(boundary))) return s;
  }
  return -1;
}

PetscErrorCode LamMacroBoundaryNames(const LamMacroSpec *spec, LamMacroStep *step)
{
  PetscFunctionBeginUser;
  step->boundary_count = 0;
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    if (LamMacroSideNumber(step, &spec->boundary[b]) >= 0) continue;
    PetscCall(PetscStrncpy(step->boundary[step->boundary_count++], ReportedName(&spec->boundary[b]), LAM_NAME_LENGTH));
  }
  PetscFunctionReturn(0);
}

/* ---- prescribed directions of nodes ---- */

/* Whether two conditions in the same direction of a node prescribe the same displacement. */
static PetscBool Agree(LamMacro macro, const LamConstraint *one, const LamConstraint *other)
{
  const LamBoundary *boundary = macro->scene->macro.boundary;
  const PetscReal sign = one->normal[0] * other->normal[0] + one->normal[1] * other->normal[1] > 0 ? 1 : -1;

  if (one->border >= 0 || other->border >= 0) return one->border == other->border ? PETSC_TRUE : PETSC_FALSE;
  if (PetscAbsReal(one->end - sign * other->end) > 1e-14) return PETSC_FALSE;
  return one->end == 0 || LamHistoriesAgree(&boundary[one->entry].history, &boundary[other->entry].history)
             ? PETSC_TRUE
             : PETSC_FALSE;
}

/* Displacement along `wanted` at factor 1 that follows from two other directions of its node. */
static PetscReal Implied(const LamConstraint *one, const LamConstraint *two, const LamConstraint *wanted)
{
  const PetscReal *m = one->normal, *n = two->normal, *w = wanted->normal, det = m[0] * n[1] - m[1] * n[0];

  return ((w[0] * n[1] - w[1] * n[0]) * one->end + (m[0] * w[1] - m[1] * w[0]) * two->end) / det;
}

/* Adds a direction to those of its node, which are the last ones. *other is set to an entry that contradicts it, else
   unchanged. */
static void AddConstraint(LamMacro macro, const LamConstraint *constraint, PetscInt *other)
{
  const PetscReal parallel = 1e-8;
  LamConstraint *of_node[2];
  PetscInt count = 0;

  for (PetscInt k = macro->constraint_count - 1; k >= 0 && macro->constraints[k].local == constraint->local; k--)
    of_node[count++] = &macro->constraints[k];
  for (PetscInt k = 0; k < count; k++) {
    const PetscReal *m = of_node[k]->normal, *n = constraint->normal;
    if (PetscAbsReal(m[0] * n[1] - m[1] * n[0]) > parallel) continue;
    if (!Agree(macro, of_node[k], constraint)) *other = of_node[k]->entry;
    of_node[k]->sides |= constraint->sides;
    return;
  }
  if (count == 2) {
    if (PetscAbsReal(Implied(of_node[0], of_node[1], constraint) - constraint->end) > 1e-14) *other = of_node[0]->entry;
    return;
  }
  macro->constraints[macro->constraint_count++] = *constraint;
}

/* Adds the constraints of all entries at a node; normals: those of sides of symmetry; *worst: a contradiction
   (AddNodes). */
static void AddNode(LamMacro macro, const LamMacroNode *node, const PetscScalar u[], const PetscReal normals[][2],
                    PetscBool symmetry_only, PetscInt *worst)
{
  const LamMacroSpec *spec = &macro->scene->macro;

  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    const LamBoundary *boundary = &spec->boundary[b];
    const PetscBool symmetry = boundary->kind == LAM_BOUNDARY_SYMMETRY ? PETSC_TRUE : PETSC_FALSE;
    if (!LamMacroIsOn(macro, node->point, boundary->on) || (symmetry_only && !symmetry)) continue;
    for (PetscInt i = 0; i < (symmetry ? 1 : macro->dim); i++) {
      const PetscInt border = boundary->kind == LAM_BOUNDARY_GRIP ? LamMacroFindBorder(macro, b, i) : -1;
      LamConstraint constraint = {.point = node->point, .local = node->local, .entry = b, .border = border};
      PetscInt other = -1;
      if (!symmetry && border < 0 &&
          (!boundary->given[i] || (boundary->kind != LAM_BOUNDARY_DISPLACEMENT && boundary->kind != LAM_BOUNDARY_GRIP)))
        continue;
      constraint.sides = 1u << LamMacroSideNumber(&macro->step, boundary);
      if (!symmetry && border < 0) constraint.end = boundary->displacement[i];
      for (PetscInt j = 0; j < 2; j++) {
        constraint.normal[j] = symmetry ? normals[b][j] : i == j;
        constraint.base += constraint.normal[j] * PetscRealPart(u[node->local + j]);
      }
      constraint.target = constraint.base;
      AddConstraint(macro, &constraint, &other);
      if (other >= 0) *worst = PetscMax(*worst, b * LAM_MAX_BOUNDARIES + other);
    }
  }
}

/* A node on the axis of an axisymmetric body stays there, which takes no force from any side; *moved: an entry that
   moves it. */
static void HoldOnAxis(LamMacro macro, const LamMacroNode *node, PetscInt *moved)
{
  const PetscReal rounding = 1e-9; /* of mesh files, as in mesh.c */
  const LamConstraint constraint = {
      .point = node->point, .local = node->local, .normal = {1, 0}, .entry = -1, .border = -1};

  if (!macro->axisymmetric || PetscAbsReal(node->X[0]) >= rounding) return;
  AddConstraint(macro, &constraint, moved);
  for (PetscInt k = macro->constraint_count - 1; k >= 0 && macro->constraints[k].local == node->local; k--)
    if (PetscAbsReal(macro->constraints[k].normal[0]) > 0.5) macro->constraints[k].sides = 0;
}

/* Adds all prescribed displacements of the scene, measured from the present displacement; or only its symmetry. */
static PetscErrorCode AddNodes(LamMacro macro, PetscBool symmetry_only)
{
  const LamMacroSpec *spec = &macro->scene->macro;
  PetscReal normals[LAM_MAX_BOUNDARIES][2];
  PetscInt worst = -1; /* pair of entries that contradict each other, as one number */
  PetscInt moved = -1; /* an entry that moves the axis */
  const PetscScalar *u;

  PetscFunctionBeginUser;
  macro->constraint_count = 0;
  for (PetscInt b = 0; b < spec->boundary_count; b++) {
    if (spec->boundary[b].kind == LAM_BOUNDARY_SYMMETRY)
      PetscCall(LamMacroStraightNormal(macro, &spec->boundary[b], normals[b]));
  }
  PetscCall(VecGetArrayRead(macro->u, &u));
  for (PetscInt k = 0; k < macro->node_count; k++) {
    if (macro->sets[macro->nodes[k].point - macro->mesh_start])
      AddNode(macro, &macro->nodes[k], u, (const PetscReal(*)[2])normals, symmetry_only, &worst);
    HoldOnAxis(macro, &macro->nodes[k], &moved);
  }
  PetscCall(VecRestoreArrayRead(macro->u, &u));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPIU_INT, MPI_MAX, macro->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &moved, 1, MPIU_INT, MPI_MAX, macro->comm));
  LamMacroRequire(moved < 0, macro, &spec->boundary[moved].place,
                  "macro.boundary: on: %s: prescribes a displacement of the axis along X1, where an axisymmetric body "
                  "cannot move; write 0 mm or free for it",
                  spec->boundary[moved].on);
  LamMacroRequire(worst < 0, macro, &spec->boundary[worst / LAM_MAX_BOUNDARIES].place,
                  "macro.boundary: %s and %s prescribe different displacements where they meet; "
                  "leave that component `free` on one of them",
                  spec->boundary[worst % LAM_MAX_BOUNDARIES].on, spec->boundary[worst / LAM_MAX_BOUNDARIES].on);
  PetscFunctionReturn(0);
}

/* ---- rigid motions ---- */

/* normal . motion for the three rigid motions at X: along X1, along X2, rotation. An axisymmetric body has only that
   along X2. */
static void RigidMotions(LamMacro macro, const PetscReal normal[2], const PetscReal X[2], PetscReal motion[3])
{
  motion[0] = macro->axisymmetric ? 0 : normal[0];
  motion[1] = normal[1];
  motion[2] = macro->axisymmetric ? 0 : normal[1] * X[0] - normal[0] * X[1];
}

/* Gram matrix of the rigid motions at all constraints of a part of the body. The component of a grip that is free, as
   `held` [border] says, still restrains the rotation. */
static PetscErrorCode RigidGram(LamMacro macro, PetscInt part, const PetscBool held[], PetscReal gram[9])
{
  PetscReal border[2 * LAM_MAX_BOUNDARIES + 1][3] = {{0}}; /* count, sum, sum of squares of the rotation */

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(gram, 9));
  for (PetscInt k = 0; k < macro->constraint_count; k++) {
    const LamConstraint *constraint = &macro->constraints[k];
    const PetscInt b = constraint->border, point = constraint->point - macro->mesh_start;
    PetscReal motion[3];

    if (macro->part[point] != part) continue;
    RigidMotions(macro, constraint->normal, &macro->position[macro->dim * point], motion);
    for (int m = 0; m < 9 && (b < 0 || held[b]); m++) gram[m] += motion[m / 3] * motion[m % 3];
    for (int power = 0; power < 3 && b >= 0 && !held[b]; power++) border[b][power] += PetscPowRealInt(motion[2], power);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, gram, 9, MPIU_REAL, MPIU_SUM, macro->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, border, 3 * (2 * LAM_MAX_BOUNDARIES + 1), MPIU_REAL, MPIU_SUM, macro->comm));
  for (PetscInt b = 0; b < macro->border_count; b++) {
    if (border[b][0] > 0) gram[8] += border[b][2] - PetscSqr(border[b][1]) / border[b][0];
  }
  PetscFunctionReturn(0);
}

/* Orthonormal basis of the rigid motions of a part that the constraints restrain. */
static PetscErrorCode HeldMotions(LamMacro macro, PetscInt part, const PetscBool held[], PetscReal basis[3][3],
                                  PetscInt *rank)
{
  const PetscReal tiny = 1e-10; /* relative to numbers of order one and more: lengths are in edges of the box */
  PetscReal gram[9], eigenvalue[3], work[32];
  PetscBLASInt n = 3, size = 32, info;

  PetscFunctionBeginUser;
  PetscCall(RigidGram(macro, part, held, gram));
  LAPACKsyev_("V", "U", &n, gram, &n, eigenvalue, work, &size, &info);
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK's syev: info %d", (int)info);
  *rank = 0;
  for (int k = 0; k < 3; k++) {
    if (eigenvalue[k] > tiny) PetscCall(PetscArraycpy(basis[(*rank)++], &gram[3 * k], 3));
  }
  PetscFunctionReturn(0);
}

/* A part that the displacements leave free, or -1. A grip holds a part also where its component is free, if it holds
   another part that is held elsewhere. */
static PetscErrorCode FindLoose(LamMacro macro, PetscInt *loose)
{
  PetscBool held[2 * LAM_MAX_BOUNDARIES + 1] = {PETSC_FALSE}, changed = PETSC_TRUE, *done;
  PetscReal basis[3][3];
  PetscInt rank;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(macro->part_count, &done));
  while (changed) {
    changed = PETSC_FALSE;
    *loose = -1;
    for (PetscInt part = 0; part < macro->part_count; part++) {
      if (done[part]) continue;
      PetscCall(HeldMotions(macro, part, held, basis, &rank));
      if (rank == (macro->axisymmetric ? 1 : 3)) {
        done[part] = changed = PETSC_TRUE;
        for (PetscInt k = 0; k < macro->constraint_count; k++) {
          const LamConstraint *constraint = &macro->constraints[k];
          if (constraint->border >= 0 && macro->part[constraint->point - macro->mesh_start] == part)
            held[constraint->border] = PETSC_TRUE;
        }
        PetscCallMPI(
            MPI_Allreduce(MPI_IN_PLACE, held, PETSC_STATIC_ARRAY_LENGTH(held), MPIU_BOOL, MPI_LOR, macro->comm));
      } else if (*loose < 0)
        *loose = part;
    }
  }
  PetscCall(PetscFree(done));
  PetscFunctionReturn(0);
}

/* A node of the whole mesh. */
typedef struct {
  PetscMPIInt rank;
  PetscBool mine;           /* this rank */
  const LamMacroNode *node; /* on that rank */
  PetscReal X[LAM_MACRO_DIM];
} Place;

/* The owned node of a part that is farthest from a place; among equal ones that of the lowest number. */
static PetscErrorCode FindNode(LamMacro macro, PetscInt part, const Place *from, Place *found)
{
  PetscReal farthest = -1, best;
  double lowest = INFINITY;

  PetscFunctionBeginUser;
  for (int pass = 0; pass < 2; pass++) { /* first the greatest distance, then the rank that has it */
    for (PetscInt k = 0; k < macro->node_count; k++) {
      const LamMacroNode *node = &macro->nodes[k];
      PetscReal distance = 0;
      if (macro->part[node->point - macro->mesh_start] != part) continue;
      for (PetscInt i = 0; i < macro->dim; i++) distance += PetscSqr(node->X[i] - from->X[i]);
      if (pass == 0) farthest = PetscMax(farthest, distance);
      if (pass == 0 || distance < best * (1 - 1e-9) || (double)node->number >= lowest) continue;
      lowest = (double)node->number;
      found->node = node;
    }
    if (pass == 0) PetscCallMPI(MPI_Allreduce(&farthest, &best, 1, MPIU_REAL, MPIU_MAX, macro->comm));
  }
  PetscCall(LamMacroFindRank(macro, lowest, &found->rank, &found->mine));
  if (found->mine) PetscCall(PetscArraycpy(found->X, found->node->X, macro->dim));
  PetscCallMPI(MPI_Bcast(found->X, LAM_MACRO_DIM, MPIU_REAL, found->rank, macro->comm));
  PetscFunctionReturn(0);
}

/* Prescribes a component of a node if this restrains a rigid motion that is still free. basis [*rank][3]: restrained
   motions. */
static PetscErrorCode HoldNode(LamMacro macro, const Place *place, const PetscReal normal[2], PetscReal basis[][3],
                               PetscInt *rank)
{
  const PetscReal independent = 1e-6;
  PetscReal motion[3], square = 0;

  PetscFunctionBeginUser;
  RigidMotions(macro, normal, place->X, motion);
  for (PetscInt b = 0; b < *rank; b++) {
    PetscReal along = 0;
    for (int m = 0; m < 3; m++) along += motion[m] * basis[b][m];
    for (int m = 0; m < 3; m++) motion[m] -= along * basis[b][m];
  }
  for (int m = 0; m < 3; m++) square += PetscSqr(motion[m]);
  if (square < independent || *rank == 3) PetscFunctionReturn(0);
  for (int m = 0; m < 3; m++) basis[*rank][m] = motion[m] / PetscSqrtReal(square);
  (*rank)++;
  if (!place->mine) PetscFunctionReturn(0);
  macro->constraints[macro->constraint_count++] = (LamConstraint){.point = place->node->point,
                                                                  .local = place->node->local,
                                                                  .normal = {normal[0], normal[1]},
                                                                  .entry = -1,
                                                                  .border = -1};
  PetscFunctionReturn(0);
}

static int CompareConstraints(const void *a, const void *b)
{
  const PetscInt one = ((const LamConstraint *)a)->local, other = ((const LamConstraint *)b)->local;

  return (one > other) - (one < other);
}

/* A distant point from which the lower left of the body is farthest. */
static const Place far = {.X = {1e3, 1e3}};

PetscErrorCode LamMacroHoldRigidMotions(LamMacro macro)
{
  const PetscBool held[2 * LAM_MAX_BOUNDARIES + 1] = {PETSC_FALSE};

  PetscFunctionBeginUser;
  PetscCheck(macro->dim == 2, macro->comm, PETSC_ERR_SUP, "rigid motions are those of the plane");
  macro->loaded = PETSC_FALSE;
  macro->obstacle_count = macro->obstacle_node_count = 0;
  PetscCall(LamMacroBordersCreate(macro, PETSC_FALSE));
  PetscCall(AddNodes(macro, PETSC_TRUE));
  for (PetscInt part = 0; part < macro->part_count; part++) {
    PetscReal basis[3][3];
    PetscInt rank = 0;
    Place one, other;

    PetscCall(HeldMotions(macro, part, held, basis, &rank));
    PetscCall(FindNode(macro, part, &far, &one));
    PetscCall(FindNode(macro, part, &one, &other));
    const PetscReal line[2] = {other.X[0] - one.X[0], other.X[1] - one.X[1]}, length = hypot(line[0], line[1]);
    const PetscReal directions[4][2] = {
        {1, 0}, {0, 1}, {-line[1] / length, line[0] / length}, {line[0] / length, line[1] / length}};
    /* the other node stays on its line with the first one, so a swelling body does not rotate */
    for (int k = 0; k < 4; k++) PetscCall(HoldNode(macro, k < 2 ? &one : &other, directions[k], basis, &rank));
  }
  qsort(macro->constraints, (size_t)macro->constraint_count, sizeof(*macro->constraints), CompareConstraints);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroHoldBoundaries(LamMacro macro)
{
  char what[LAM_PLACE_TEXT] = "the body";
  PetscInt loose = -1;
  Place place;

  PetscFunctionBeginUser;
  macro->loaded = PETSC_TRUE;
  PetscCall(LamMacroBordersCreate(macro, PETSC_TRUE));
  PetscCall(AddNodes(macro, PETSC_FALSE));
  PetscCall(FindLoose(macro, &loose));
  if (loose >= 0 && macro->part_count > 1) {
    PetscCall(FindNode(macro, loose, &far, &place));
    snprintf(what, sizeof(what), "one of %d separate parts of the body, that at (%g, %g) in the mesh's unit,",
             (int)macro->part_count, (double)place.X[0], (double)place.X[1]);
  }
  LamMacroRequire(loose < 0, macro, &macro->scene->macro.boundary[0].place,
                  "macro.boundary: the displacements leave %s free to move %s", what,
                  macro->axisymmetric
                      ? "along X2, its axis; prescribe that component somewhere (plates and indenters do not count)"
                      : "or turn as a whole; prescribe both components somewhere, and enough to prevent rotation "
                        "(plates and indenters do not count)");
  PetscCall(LamMacroBordersStart(macro));
  PetscCall(LamMacroObstaclesCreate(macro));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroSetLoadFactor(LamMacro macro, PetscReal load_factor)
{
  const LamBoundary *boundary = macro->scene->macro.boundary;

  PetscFunctionBeginUser;
  macro->parameter = load_factor;
  for (PetscInt k = 0; k < macro->constraint_count; k++) {
    LamConstraint *constraint = &macro->constraints[k];
    if (constraint->entry < 0) continue;
    constraint->target =
        constraint->base + LamHistoryFactor(&boundary[constraint->entry].history, load_factor) * constraint->end;
  }
  for (PetscInt k = 0; k < macro->border_count; k++) {
    LamMacroBorder *border = &macro->borders[k];
    if (border->entry < 0) border->target = border->base + load_factor * macro->scene->macro.control.displacement;
  }
  LamMacroObstaclesMove(macro);
  PetscFunctionReturn(0);
}
