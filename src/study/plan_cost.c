/*
  What the plan of a scene costs.

  Method. One assembly is timed on this machine; all other costs are multiples of it. The multiples are measured
  (docs/reference/commands.md has the figures): they hold within a factor of two from 236 to 10,000 unknowns.
*/
#include "map.h"
#include "plan.h"
#include <lamella/rve.h>

/* Cost of an iteration (assembly, factorisation, solve) in assemblies; the second value is for many cells, whose
   factors are fuller. */
#define ITERATION_ASSEMBLIES 2.5
#define LARGE_ITERATION_ASSEMBLIES 7.0
#define LARGE_UNKNOWNS 6000
/* Factorisations of a single state, and of a material point during a load step; including the tangent. */
#define STATE_FACTORISATIONS 6.0
#define POINT_FACTORISATIONS 5.0
/* Cost of a state of contact tissue relative to a bonded one, in assemblies: these are themselves three times as long.
 */
#define CONTACT_FACTOR 1.5
/* For a map: states that bracket the failure of one path; cost of a state of contact tissue on two meshes relative
   to the first mesh alone. */
#define BRACKET_STATES 10
#define TWO_MESHES 5.0
/* Resident memory, MB: the program with its libraries; matrix, factor and mesh per unknown; for contact tissue
   including the bonded RVE from which it starts. */
#define PROGRAM_MB 50.0
#define UNKNOWN_MB 0.0015
#define CONTACT_UNKNOWN_MB 0.003

/* One cell is timed, whatever the period: its cost is proportional to the number of cells, and a large scene must
   not be built. */
PetscErrorCode LamPlanCost(const LamScene *scene, const LamPlan *plan, LamCost *cost)
{
  const PetscReal n = (PetscReal)plan->unknowns;
  LamMicrostructure cell = plan->micro;
  const PetscReal cells = (PetscReal)cell.cells[0] * (PetscReal)cell.cells[1];
  const PetscBool contact = LamCellsPart(cell.interface);
  PetscReal iteration;
  PetscInt unknowns;

  PetscFunctionBeginUser;
  cell.cells[0] = cell.cells[1] = 1;
  cell.is_patch = PETSC_FALSE;
  cell.cell = NULL;
  cell.tissue = NULL;
  PetscCall(LamRVETimeAssembly(&cell, &unknowns, &cost->assembly));
  cost->assembly *= cells;
  iteration = n <= LARGE_UNKNOWNS ? ITERATION_ASSEMBLIES : LARGE_ITERATION_ASSEMBLIES;
  iteration *= cost->assembly * (contact ? CONTACT_FACTOR : 1);
  cost->state = STATE_FACTORISATIONS * iteration;
  cost->point = POINT_FACTORISATIONS * iteration;
  /* each material point stores its positions, accepted and trial */
  cost->memory = PROGRAM_MB + (contact ? CONTACT_UNKNOWN_MB : UNKNOWN_MB) * n +
                 (PetscReal)plan->macro_points * 2 * sizeof(PetscReal) * n / 1e6;
  cost->map = (PetscReal)(plan->map_states + BRACKET_STATES * (scene->has_map ? LamMapPathCount(scene) : 0)) *
              (contact ? TWO_MESHES : 1) * cost->state;
  PetscFunctionReturn(0);
}
