/*
  Mesh and fields of an RVE in a result file.
*/
#include "rve_fields.h"

static PetscErrorCode WriteReals(LamRecordWriter writer, const char group[], const char name[], PetscInt rank,
                                 const PetscInt dims[], const PetscReal values[], const char unit[])
{
  char path[2 * LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", group, name));
  PetscCall(LamRecordWriterReals(writer, path, rank, dims, values, unit));
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteInts(LamRecordWriter writer, const char group[], const char name[], PetscInt rank,
                                const PetscInt dims[], const PetscInt values[])
{
  char path[2 * LAM_NAME_LENGTH];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", group, name));
  PetscCall(LamRecordWriterInts(writer, path, rank, dims, values));
  PetscFunctionReturn(0);
}

/* Writes the faces to which the interface samples belong; bonded tissue has none. */
static PetscErrorCode WriteInterfaceFaces(LamRecordWriter writer, const char group[], LamRVE rve)
{
  PetscInt dims[2] = {0, 3}, points, *owner;

  PetscFunctionBeginUser;
  PetscCall(LamRVEGetInterfaceSize(rve, &dims[0], &points));
  if (!dims[0]) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(3 * dims[0], &owner));
  PetscCall(LamRVEGetInterfaceFaces(rve, owner));
  PetscCall(WriteInts(writer, group, "interface_faces", 2, dims, owner));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEWriteMesh(LamRecordWriter writer, const char group[], LamRVE rve)
{
  LamRVEMesh mesh;
  PetscInt nodes[2] = {0, 2}, elements[2] = {0, 9};
  const PetscInt period[2] = {2, 2};

  PetscFunctionBeginUser;
  PetscCall(LamRVEGetMesh(rve, &mesh));
  nodes[0] = mesh.node_count;
  elements[0] = mesh.element_count;
  PetscCall(WriteReals(writer, group, "nodes", 2, nodes, mesh.nodes, "apothem"));
  PetscCall(WriteInts(writer, group, "elements", 2, elements, mesh.elements));
  PetscCall(WriteInts(writer, group, "cell_of", 1, elements, mesh.cell_of));
  PetscCall(WriteReals(writer, group, "period", 2, period, &mesh.period[0][0], "apothem"));
  PetscCall(WriteInterfaceFaces(writer, group, rve));
  PetscFunctionReturn(0);
}

/* Writes samples along the faces of contact tissue; bonded tissue has none. */
static PetscErrorCode WriteInterface(LamRecordWriter writer, const char group[], LamRVE rve, LamRVEState state,
                                     PetscReal MPa)
{
  PetscReal *from, *to, *gap, *pressure;
  PetscInt dims[3] = {0, 0, 2}, n;

  PetscFunctionBeginUser;
  PetscCall(LamRVEGetInterfaceSize(rve, &dims[0], &dims[1]));
  if (!dims[0]) PetscFunctionReturn(0);
  n = dims[0] * dims[1];
  PetscCall(PetscMalloc4(2 * n, &from, 2 * n, &to, n, &gap, n, &pressure));
  PetscCall(LamRVEGetInterface(rve, state, from, to, gap, pressure));
  for (PetscInt i = 0; i < n; i++) pressure[i] *= MPa;
  PetscCall(WriteReals(writer, group, "interface/from", 3, dims, from, "apothem"));
  PetscCall(WriteReals(writer, group, "interface/to", 3, dims, to, "apothem"));
  PetscCall(WriteReals(writer, group, "interface/gap", 2, dims, gap, "apothem"));
  PetscCall(WriteReals(writer, group, "interface/pressure", 2, dims, pressure, "MPa"));
  PetscCall(PetscFree4(from, to, gap, pressure));
  PetscFunctionReturn(0);
}

/* Writes the lamella at these samples; other laws have none. */
static PetscErrorCode WriteLamella(LamRecordWriter writer, const char group[], LamRVE rve, LamRVEState state,
                                   const LamScales *scales)
{
  const PetscReal MPa = scales->stress * 1e-6, mm = scales->length * 1e3;
  LamRVELamella lamella;
  LamInterfaceLawType law;
  PetscInt dims[3] = {0, 0, 2}, n;

  PetscFunctionBeginUser;
  PetscCall(LamRVEGetInterfaceLaw(rve, &law));
  if (law != LAM_INTERFACE_LAMELLA) PetscFunctionReturn(0);
  PetscCall(LamRVEGetInterfaceSize(rve, &dims[0], &dims[1]));
  n = dims[0] * dims[1];
  PetscCall(PetscMalloc7(2 * n, &lamella.across, n, &lamella.damage, n, &lamella.broken, n, &lamella.opening, n,
                         &lamella.slip, n, &lamella.normal_traction, n, &lamella.shear_traction));
  PetscCall(PetscMalloc1(dims[0], &lamella.normal_force));
  PetscCall(LamRVEGetLamella(rve, state, &lamella));
  for (PetscInt i = 0; i < n; i++) {
    lamella.normal_traction[i] *= MPa;
    lamella.shear_traction[i] *= MPa;
  }
  for (PetscInt f = 0; f < dims[0]; f++) lamella.normal_force[f] *= MPa * mm;
  PetscCall(WriteReals(writer, group, "interface/across", 3, dims, lamella.across, "apothem"));
  PetscCall(WriteReals(writer, group, "interface/damage", 2, dims, lamella.damage, "1"));
  PetscCall(WriteReals(writer, group, "interface/broken", 2, dims, lamella.broken, "1"));
  PetscCall(WriteReals(writer, group, "interface/opening", 2, dims, lamella.opening, "apothem"));
  PetscCall(WriteReals(writer, group, "interface/slip", 2, dims, lamella.slip, "apothem"));
  PetscCall(WriteReals(writer, group, "interface/normal_traction", 2, dims, lamella.normal_traction, "MPa"));
  PetscCall(WriteReals(writer, group, "interface/shear_traction", 2, dims, lamella.shear_traction, "MPa"));
  PetscCall(WriteReals(writer, group, "interface/normal_force", 1, dims, lamella.normal_force, "N/mm"));
  PetscCall(PetscFree(lamella.normal_force));
  PetscCall(PetscFree7(lamella.across, lamella.damage, lamella.broken, lamella.opening, lamella.slip,
                       lamella.normal_traction, lamella.shear_traction));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEWriteMode(LamRecordWriter writer, const char group[], LamRVE rve, LamRVEState state,
                               PetscBool *written)
{
  PetscReal *mode, eigenvalue;
  PetscInt dims[2] = {0, 2};
  LamRVEMesh mesh;

  PetscFunctionBeginUser;
  PetscCall(LamRVEGetMesh(rve, &mesh));
  dims[0] = mesh.node_count;
  PetscCall(PetscMalloc1(2 * dims[0], &mode));
  PetscCall(LamRVEGetSoftestMode(rve, state, &eigenvalue, mode));
  *written = (PetscBool)(eigenvalue < 0.0);
  if (*written) PetscCall(WriteReals(writer, group, "softest_mode", 2, dims, mode, "1"));
  PetscCall(PetscFree(mode));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRVEWriteFields(LamRecordWriter writer, const char group[], LamRVE rve, LamRVEState state,
                                 const LamScales *scales)
{
  const PetscReal MPa = scales->stress * 1e-6;
  PetscReal *x, *fibre, *stress;
  LamRVEMesh mesh;
  PetscInt dims[2] = {0, 2};

  PetscFunctionBeginUser;
  PetscCall(LamRVEGetMesh(rve, &mesh));
  dims[0] = mesh.node_count;
  PetscCall(PetscMalloc3(2 * dims[0], &x, dims[0], &fibre, dims[0], &stress));
  PetscCall(LamRVEGetFields(rve, state, x, fibre, stress));
  for (PetscInt i = 0; i < dims[0]; i++) stress[i] *= MPa;
  PetscCall(WriteReals(writer, group, "x", 2, dims, x, "apothem"));
  PetscCall(WriteReals(writer, group, "fibre_stretch", 1, dims, fibre, "1"));
  PetscCall(WriteReals(writer, group, "wall_stress", 1, dims, stress, "MPa"));
  PetscCall(PetscFree3(x, fibre, stress));
  PetscCall(WriteInterface(writer, group, rve, state, MPa));
  PetscCall(WriteLamella(writer, group, rve, state, scales));
  PetscFunctionReturn(0);
}

static void DescribeNodes(LamXDMF *xdmf, const char group[], const char name[], PetscInt nodes, PetscInt columns)
{
  char path[2 * LAM_NAME_LENGTH];

  snprintf(path, sizeof(path), "%s/%s", group, name);
  LamXDMFField(xdmf, name, PETSC_TRUE, "Float", (LamXDMFData){path, nodes, columns});
}

PetscErrorCode LamRVEDescribeFields(LamXDMF *xdmf, const char group[], LamRVE rve, PetscInt number, PetscBool mode)
{
  char x[2 * LAM_NAME_LENGTH];
  LamRVEMesh mesh;

  PetscFunctionBeginUser;
  PetscCall(LamRVEGetMesh(rve, &mesh));
  snprintf(x, sizeof(x), "%s/x", group);
  LamXDMFBegin(xdmf, "state", number, (PetscReal)number, "Quadrilateral_9", mesh.element_count,
               (LamXDMFData){"/mesh/elements", mesh.element_count, 9}, (LamXDMFData){x, mesh.node_count, 2});
  LamXDMFField(xdmf, "cell_of", PETSC_FALSE, "Int", (LamXDMFData){"/mesh/cell_of", mesh.element_count, 1});
  DescribeNodes(xdmf, group, "x", mesh.node_count, 2); /* as readers take the positions of the first state for all */
  DescribeNodes(xdmf, group, "fibre_stretch", mesh.node_count, 1);
  DescribeNodes(xdmf, group, "wall_stress", mesh.node_count, 1);
  if (mode) DescribeNodes(xdmf, group, "softest_mode", mesh.node_count, 2);
  LamXDMFEnd(xdmf);
  PetscFunctionReturn(0);
}
