/*
  Kinds of elements: quadratic Lagrange elements of PetscFE; in sealed tissue (sealed.c) triangles have a cubic
  bubble; without it an element-wise linear pressure is not stable.

  Gauss points: quadrilaterals 3 x 3 (hexahedra 3 x 3 x 3), triangles 3 (tetrahedra: the rule of degree 2). Both
  integrate the tangent of undistorted elements with constant material to the element's order. Triangles with a bubble
  have the 6 points of the rule of degree 4, the degree of the bubble's tangent.

  Reference: Crouzeix & Raviart, RAIRO R-3 (1973) 33-75, Example 5.
*/
#include "macro_impl.h"

enum { SIMPLEX_DEGREE = 2, BUBBLE_DEGREE = 4, TENSOR_POINTS = 3 };

/* Whether elements of this type have a bubble node. */
static PetscBool HasBubble(LamMacro macro, DMPolytopeType type)
{
  return type == DM_POLYTOPE_TRIANGLE && LamMacroHasPressures(macro) ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool LamMacroHasNode(LamMacro macro, DMPolytopeType type)
{
  switch (type) {
  case DM_POLYTOPE_POINT:
  case DM_POLYTOPE_SEGMENT:
  case DM_POLYTOPE_QUADRILATERAL:
  case DM_POLYTOPE_HEXAHEDRON:
    return PETSC_TRUE;
  default:
    return HasBubble(macro, type);
  }
}

static PetscBool IsSimplex(DMPolytopeType type)
{
  return type == DM_POLYTOPE_TRIANGLE || type == DM_POLYTOPE_TETRAHEDRON ? PETSC_TRUE : PETSC_FALSE;
}

/*
  Inserts the bubble b = 27 l1 l2 l3 of a triangle before its six functions and subtracts the functions' values at the
  centre: N_a - N_a(centre) b. Each function is then 1 at its own node and 0 at the others.
*/
static PetscErrorCode AddBubble(PetscFE fe, const PetscReal points[], LamMacroKind *kind)
{
  const PetscReal centre[2] = {-1. / 3, -1. / 3};
  PetscTabulation table;

  PetscFunctionBeginUser;
  PetscCall(PetscFECreateTabulation(fe, 1, 1, centre, 0, &table));
  for (PetscInt q = 0; q < kind->points; q++) {
    PetscReal *N = &kind->value[q * kind->nodes], *dN = &kind->gradient[2 * q * kind->nodes];
    const PetscReal l[3] = {-0.5 * (points[2 * q] + points[2 * q + 1]), 0.5 * (1 + points[2 * q]),
                            0.5 * (1 + points[2 * q + 1])};
    N[0] = 27 * l[0] * l[1] * l[2];
    dN[0] = 13.5 * l[2] * (l[0] - l[1]);
    dN[1] = 13.5 * l[1] * (l[0] - l[2]);
    for (PetscInt a = 1; a < kind->nodes; a++) {
      const PetscReal share = table->T[0][a - 1];
      N[a] -= share * N[0];
      for (int i = 0; i < 2; i++) dN[2 * a + i] -= share * dN[i];
    }
  }
  PetscCall(PetscTabulationDestroy(&table));
  PetscFunctionReturn(0);
}

/* Sets value, gradient and weight from PetscFE's tables at the quadrature points. */
static PetscErrorCode Tabulate(PetscInt dim, PetscFE fe, PetscQuadrature quadrature, PetscBool bubble,
                               LamMacroKind *kind)
{
  const PetscReal *points, *weights;
  const PetscInt first = bubble ? 1 : 0; /* first of PetscFE's functions */
  PetscTabulation table;

  PetscFunctionBeginUser;
  PetscCall(PetscQuadratureGetData(quadrature, NULL, NULL, &kind->points, &points, &weights));
  PetscCall(PetscFECreateTabulation(fe, 1, kind->points, points, 1, &table));
  kind->nodes = first + table->Nb;
  PetscCheck(table->Nc == 1 && kind->nodes <= LAM_MACRO_NODES, PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "unexpected element: %d functions of %d components", (int)table->Nb, (int)table->Nc);
  PetscCall(PetscMalloc3(kind->points * kind->nodes, &kind->value, kind->points * kind->nodes * dim, &kind->gradient,
                         kind->points, &kind->weight));
  for (PetscInt q = 0; q < kind->points; q++) {
    PetscReal *N = &kind->value[q * kind->nodes + first], *dN = &kind->gradient[dim * (q * kind->nodes + first)];
    PetscCall(PetscArraycpy(N, &table->T[0][q * table->Nb], table->Nb));
    PetscCall(PetscArraycpy(dN, &table->T[1][dim * q * table->Nb], dim * table->Nb));
  }
  PetscCall(PetscArraycpy(kind->weight, weights, kind->points));
  if (bubble) PetscCall(AddBubble(fe, points, kind));
  PetscCall(PetscTabulationDestroy(&table));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroKindGet(LamMacro macro, DMPolytopeType polytope, const LamMacroKind **kind)
{
  const PetscBool simplex = IsSimplex(polytope), bubble = HasBubble(macro, polytope);
  PetscQuadrature quadrature;
  PetscFE fe;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < macro->kind_count; k++) {
    *kind = &macro->kinds[k];
    if ((*kind)->polytope == polytope) PetscFunctionReturn(0);
  }
  LamMacroRequire(simplex || polytope == DM_POLYTOPE_QUADRILATERAL || polytope == DM_POLYTOPE_HEXAHEDRON, macro,
                  &macro->scene->macro.mesh_place,
                  "macro.mesh: the mesh has an element of type %s; mesh the body with triangles or quadrilaterals",
                  DMPolytopeTypes[polytope]);
  macro->kinds[macro->kind_count].polytope = polytope;
  *kind = &macro->kinds[macro->kind_count++];
  PetscCall(PetscFECreateLagrange(PETSC_COMM_SELF, macro->dim, 1, simplex, 2, TENSOR_POINTS - 1, &fe));
  if (simplex)
    PetscCall(PetscDTSimplexQuadrature(macro->dim, bubble ? BUBBLE_DEGREE : SIMPLEX_DEGREE, PETSCDTSIMPLEXQUAD_MINSYM,
                                       &quadrature));
  else
    PetscCall(PetscDTGaussTensorQuadrature(macro->dim, 1, TENSOR_POINTS, -1, 1, &quadrature));
  PetscCall(Tabulate(macro->dim, fe, quadrature, bubble, &macro->kinds[macro->kind_count - 1]));
  PetscCall(PetscQuadratureDestroy(&quadrature));
  PetscCall(PetscFEDestroy(&fe));
  PetscFunctionReturn(0);
}
