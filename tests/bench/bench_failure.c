/* What walls and lamella bear on finer and finer meshes, beside point values; onset load factors likewise; the cost of
   the measures over that of a solve. Prints figures, asserts nothing. */
#include <petsctime.h>
#include <stdio.h>
#include "failure.h"
#include "support/failing_tissue.h"
#include "solve.h"

#define MESHES 5
#define CONTACT_MESHES 4
#define REPEATS 50

static const int meshes[MESHES][2] = {{6, 2}, {12, 2}, {12, 4}, {24, 4}, {36, 6}};

static LamMicrostructure Tissue(LamInterfaceLawType interface, int m)
{
  LamMicrostructure micro = DefaultTissue();

  micro.interface = interface;
  micro.along = meshes[m][0];
  micro.through = meshes[m][1];
  return micro;
}

/* Largest fibre stretch and principal stress at a node. */
static PetscErrorCode PointValues(LamRVE rve, LamRVEState state, PetscReal *fibre, PetscReal *stress)
{
  PetscReal *fibres, *stresses;
  LamRVEMesh mesh;

  PetscFunctionBeginUser;
  PetscCall(LamRVEGetMesh(rve, &mesh));
  PetscCall(PetscMalloc2(mesh.node_count, &fibres, mesh.node_count, &stresses));
  PetscCall(LamRVEGetFields(rve, state, NULL, fibres, stresses));
  *fibre = *stress = 0;
  for (PetscInt i = 0; i < mesh.node_count; i++) {
    *fibre = PetscMax(*fibre, fibres[i]);
    *stress = PetscMax(*stress, stresses[i]);
  }
  PetscCall(PetscFree2(fibres, stresses));
  PetscFunctionReturn(0);
}

/* Time of the measures of walls over that of the whole solve. */
static PetscErrorCode Cost(LamRVE rve, const LamLoad *load, LamResponse *response, PetscReal *share)
{
  PetscLogDouble begin, end;
  const PetscReal seconds = response->seconds;

  PetscFunctionBeginUser;
  PetscCall(PetscTime(&begin));
  for (int k = 0; k < REPEATS; k++) PetscCall(LamWallMeasures(rve, load, response));
  PetscCall(PetscTime(&end));
  *share = (end - begin) / REPEATS / seconds;
  PetscFunctionReturn(0);
}

static PetscErrorCode PrintMeasures(LamInterfaceLawType interface, int m, const LamLoad *load)
{
  const LamMicrostructure micro = Tissue(interface, m);
  PetscReal fibre = 0, stress = 0, share = 0;
  LamRVE rve;
  LamRVEState state;
  LamResponse r;

  PetscFunctionBeginUser;
  PetscCall(NewTissue(&micro, &rve, &state));
  PetscCall(LamRVESolve(rve, load, state, &r));
  PetscCall(PointValues(rve, state, &fibre, &stress));
  PetscCall(Cost(rve, load, &r, &share));
  printf("  %2dx%d  %.4f  %7.4f   %.5f %.5f %8.5f %8.5f %8.5f %8.5f  %.1f %%\n", meshes[m][0], meshes[m][1], fibre,
         stress, r.max_fibre_stretch, r.max_wall_energy, r.max_wall_tension, LamMeanTension(&r), r.max_traction,
         r.max_lamella_shear, 100 * share);
  PetscCall(DestroyTissue(&rve, &state));
  PetscFunctionReturn(0);
}

static PetscErrorCode Measures(void)
{
  const struct {
    const char *name;
    LamInterfaceLawType interface;
    int meshes;
    LamLoad load;
  } cases[] = {
      {"bonded, shear 0.2, 0.02 MPa", LAM_INTERFACE_BONDED, MESHES, PlaneLoad(1, 0.2, 0, 1, 0.02 / TISSUE_STRESS)},
      {"bonded, 1.1 x 0.95, 0.02 MPa", LAM_INTERFACE_BONDED, MESHES, PlaneLoad(1.1, 0, 0, 0.95, 0.02 / TISSUE_STRESS)},
      {"contact, shear 0.2, 0.02 MPa", LAM_INTERFACE_CONTACT, CONTACT_MESHES,
       PlaneLoad(1, 0.2, 0, 1, 0.02 / TISSUE_STRESS)},
  };

  PetscFunctionBeginUser;
  printf("measures, C1 + C2; point: largest fibre stretch and principal stress at a node\n"
         "  mesh  point   point     stretch energy   tension  mean     normal   shear    cost\n");
  for (size_t c = 0; c < PETSC_STATIC_ARRAY_LENGTH(cases); c++) {
    printf("%s\n", cases[c].name);
    for (int m = 0; m < cases[c].meshes; m++) PetscCall(PrintMeasures(cases[c].interface, m, &cases[c].load));
  }
  PetscFunctionReturn(0);
}

/* Load factors at which each criterion is reached on the meshes. */
static PetscErrorCode PrintOnsets(const char name[], LamInterfaceLawType interface, int used_meshes,
                                  const LamFailureProgram *program)
{
  PetscFunctionBeginUser;
  printf("%s\n", name);
  for (int m = 0; m < used_meshes; m++) {
    const LamMicrostructure micro = Tissue(interface, m);
    PetscLogDouble begin, end;
    LamFailure failure;

    PetscCall(PetscTime(&begin));
    PetscCall(FollowProgram(&micro, *program, &failure));
    PetscCall(PetscTime(&end));
    printf("  %2dx%d  %-11s", meshes[m][0], meshes[m][1], LamFailureModeNames[failure.mode]);
    for (int c = 0; c < LAM_CRITERION_COUNT; c++) printf(" %7.4f", failure.onset[c].factor);
    printf("  %5.2f s\n", end - begin);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Onsets(void)
{
  LamLoad pull[PULL_STATES], shear[SHEAR_STATES], slip[SHEAR_STATES], shrink[3];
  const LamStrength wall = {.wall = 0.02 / TISSUE_STRESS, .lamella_normal = NAN, .lamella_shear = NAN};
  const LamFailureProgram pulled = {.strength = &failing_strength, .count = PULL_STATES, .loads = pull};
  const LamFailureProgram sheared = {.strength = &failing_strength, .count = SHEAR_STATES, .loads = shear};
  const LamFailureProgram slipped = {.strength = &wall, .count = 3, .loads = slip};
  const LamFailureProgram shrunk = {.count = 3, .loads = shrink};

  PetscFunctionBeginUser;
  PullLoads(pull);
  ShearLoads(0, shear);
  ShearLoads(0.002, slip);
  for (int k = 0; k < 3; k++) shrink[k] = PlaneLoad(1.02 - 0.03 * k, 0, 0, 1.02 - 0.03 * k, 0.02 / TISSUE_STRESS);
  printf("\nonset load factors\n  mesh  mode        normal  shear   contact wall    stable  turgor\n");
  PetscCall(PrintOnsets("bonded, pulled", LAM_INTERFACE_BONDED, MESHES, &pulled));
  PetscCall(PrintOnsets("bonded, sheared", LAM_INTERFACE_BONDED, MESHES, &sheared));
  PetscCall(PrintOnsets("bonded, shrunk", LAM_INTERFACE_BONDED, MESHES - 1, &shrunk));
  PetscCall(PrintOnsets("contact, sheared, on this and on one with twice the elements along", LAM_INTERFACE_CONTACT,
                        CONTACT_MESHES, &slipped));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(Measures());
  PetscCall(Onsets());
  PetscCall(PetscFinalize());
  return 0;
}
