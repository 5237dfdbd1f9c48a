# slow: the elements of fe2's files are VTK's: the gradient that VTK finds of u is the F that the file holds
# (VTK as Debian has it reads no XDMF: grids are made of what the XDMF file refers to. Skipped without python3-vtk9.)
. "$(dirname "$0")/common.sh"
set -e
/usr/bin/python3 -c 'import vtk, h5py, numpy' 2>/dev/null || exit 77

tissue >block.yaml <<'YAML'
macro:
  mesh: {box: [10 mm, 5 mm], elements: [3, 2]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [0.5 mm, 0 mm]}]
  steps: 2
YAML
# a square of 4 mm, a quadrilateral beside two triangles
cat >square.msh <<'MSH'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 "base"
1 2 "lid"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 2 0 0
3 4 0 0
4 0 4 0
5 2 4 0
6 4 4 0
$EndNodes
$Elements
7
1 1 2 1 1 1 2
2 1 2 1 1 2 3
3 1 2 2 2 4 5
4 1 2 2 2 5 6
5 3 2 0 1 1 2 5 4
6 2 2 0 2 2 3 6
7 2 2 0 2 2 6 5
$EndElements
MSH
sed -e 's/{box:.*/{gmsh: square.msh}/' -e 's/on: bottom/on: base/' -e 's/on: top/on: lid/' block.yaml >square.yaml
for body in block square; do "$lamella" fe2 $body.yaml --quiet -d db.h5 -o $body.h5 >/dev/null; done
/usr/bin/python3 - <<'PYTHON' || fail "VTK sees another body than the file holds"
import xml.etree.ElementTree as XML
import h5py, numpy as np, vtk
from vtk.util.numpy_support import numpy_to_vtk

TYPES = {"Quadrilateral_9": vtk.VTK_BIQUADRATIC_QUAD, "Triangle_6": vtk.VTK_QUADRATIC_TRIANGLE} # XDMF's names

def read(item):
    file, dataset = item.text.split(":")
    with h5py.File(file) as h5:
        array = h5[dataset][()]
    assert [int(n) for n in item.get("Dimensions").split()] == list(array.shape), item.text
    return array

def elements_of(topology):
    array = read(topology.find("DataItem"))
    if topology.get("TopologyType") != "Mixed":
        return [(TYPES[topology.get("TopologyType")], nodes) for nodes in array]
    elements, at = [], 0
    while at < len(array):
        kind, size = {0x23: (vtk.VTK_BIQUADRATIC_QUAD, 9), 0x24: (vtk.VTK_QUADRATIC_TRIANGLE, 6)}[array[at]]
        elements.append((kind, array[at + 1 : at + 1 + size]))
        at += 1 + size
    return elements

def grid_of(node):
    points = read(node.find("Geometry/DataItem"))
    grid, vtk_points = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
    vtk_points.SetData(numpy_to_vtk(np.column_stack([points, np.zeros(len(points))]), deep=True))
    grid.SetPoints(vtk_points)
    for kind, element in elements_of(node.find("Topology")):
        grid.InsertNextCell(kind, len(element), [int(n) for n in element])
    return grid, {a.get("Name"): read(a.find("DataItem")) for a in node.findall("Attribute")}

def rule(cell):
    "Places and weights of the points of an element whose map to VTK's is linear."
    if cell.GetNumberOfPoints() == 6:
        return [((a, b, 0), 1 / 3) for a, b in ((1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3))]
    place, weight = (0.5 - 0.15**0.5, 0.5, 0.5 + 0.15**0.5), (5 / 18, 8 / 18, 5 / 18)
    return [((place[i], place[j], 0), weight[i] * weight[j]) for i in range(3) for j in range(3)]

def mean_gradient(cell, u):
    values, sum = u[[cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]].ravel(), np.zeros(9)
    for place, weight in rule(cell):
        derivatives = [0.0] * 9
        cell.Derivatives(0, place, list(values), 3, derivatives)
        sum += weight * np.array(derivatives)
    return sum

for body, count in ("block", 6), ("square", 3):
    steps = XML.parse(f"{body}.xdmf").findall("Domain/Grid/Grid")
    assert len(steps) == 3
    for step in steps:
        grid, fields = grid_of(step)
        assert grid.GetNumberOfCells() == count
        for k in range(count):
            F = np.eye(3).ravel() + mean_gradient(grid.GetCell(k), fields["u"])
            assert np.allclose(F.reshape(3, 3)[:2, :2], fields["F"][k].reshape(3, 3)[:2, :2], rtol=0, atol=1e-12), F
PYTHON
