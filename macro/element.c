/*
  Kinds of elements: quadratic Lagrange elements of PetscFE.

  Gauss points: quadrilaterals 3 x 3 (hexahedra 3 x 3 x 3), triangles 3 (tetrahedra: the rule of degree 2). Both
  integrate the tangent of undistorted elements with constant material to the element's order.
*/
#include "macro_impl.h"

enum { SIMPLEX_DEGREE = 2, TENSOR_POINTS = 3 };

PetscBool LamMacroHasNode(DMPolytopeType type)
{
  switch (type) {
  case DM_POLYTOPE_POINT:
  case DM_POLYTOPE_SEGMENT:
  case DM_POLYTOPE_QUADRILATERAL:
  case DM_POLYTOPE_HEXAHEDRON:
    return PETSC_TRUE;
  default:
    return PETSC_FALSE;
  }
}

static PetscBool IsSimplex(DMPolytopeType type)
{
  return type == DM_POLYTOPE_TRIANGLE || type == DM_POLYTOPE_TETRAHEDRON ? PETSC_TRUE : PETSC_FALSE;
}

/* Fills value, gradient and weight from PetscFE's tables at the quadrature's points. */
static PetscErrorCode Tabulate(PetscInt dim, PetscFE fe, PetscQuadrature quadrature, LamMacroKind *kind)
{
  const PetscReal *points, *weights;
  PetscTabulation table;

  PetscFunctionBeginUser;
  PetscCall(PetscQuadratureGetData(quadrature, NULL, NULL, &kind->points, &points, &weights));
  PetscCall(PetscFECreateTabulation(fe, 1, kind->points, points, 1, &table));
  kind->nodes = table->Nb;
  PetscCheck(table->Nc == 1 && kind->nodes <= LAM_MACRO_NODES, PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "unexpected element: %d functions of %d components", (int)table->Nb, (int)table->Nc);
  PetscCall(PetscMalloc3(kind->points * kind->nodes, &kind->value, kind->points * kind->nodes * dim, &kind->gradient,
                         kind->points, &kind->weight));
  PetscCall(PetscArraycpy(kind->value, table->T[0], kind->points * kind->nodes));
  PetscCall(PetscArraycpy(kind->gradient, table->T[1], kind->points * kind->nodes * dim));
  PetscCall(PetscArraycpy(kind->weight, weights, kind->points));
  PetscCall(PetscTabulationDestroy(&table));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroKindGet(LamMacro macro, DMPolytopeType polytope, const LamMacroKind **kind)
{
  const PetscBool simplex = IsSimplex(polytope);
  PetscQuadrature quadrature;
  PetscFE fe;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < macro->kind_count; k++) {
    *kind = &macro->kinds[k];
    if ((*kind)->polytope == polytope) PetscFunctionReturn(0);
  }
  PetscCheck(simplex || polytope == DM_POLYTOPE_QUADRILATERAL || polytope == DM_POLYTOPE_HEXAHEDRON, PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT, "the mesh has an element of type %s; mesh the body with triangles or quadrilaterals",
             DMPolytopeTypes[polytope]);
  macro->kinds[macro->kind_count].polytope = polytope;
  *kind = &macro->kinds[macro->kind_count++];
  PetscCall(PetscFECreateLagrange(PETSC_COMM_SELF, macro->dim, 1, simplex, 2, TENSOR_POINTS - 1, &fe));
  if (simplex)
    PetscCall(PetscDTSimplexQuadrature(macro->dim, SIMPLEX_DEGREE, PETSCDTSIMPLEXQUAD_MINSYM, &quadrature));
  else
    PetscCall(PetscDTGaussTensorQuadrature(macro->dim, 1, TENSOR_POINTS, -1, 1, &quadrature));
  PetscCall(Tabulate(macro->dim, fe, quadrature, &macro->kinds[macro->kind_count - 1]));
  PetscCall(PetscQuadratureDestroy(&quadrature));
  PetscCall(PetscFEDestroy(&fe));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMacroKindsDestroy(LamMacro macro)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < macro->kind_count; k++)
    PetscCall(PetscFree3(macro->kinds[k].value, macro->kinds[k].gradient, macro->kinds[k].weight));
  macro->kind_count = 0;
  PetscFunctionReturn(0);
}
