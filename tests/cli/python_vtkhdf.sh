# VTKHDF of states and steps: the meshes and fields of the file, and read by VTK where it can (9.3).
. "$(dirname "$0")/common.sh"
package h5py

cp "$source/tests/scenes/shear-contact.yaml" .
tissue mesh='along: 2, through: 1' >body.yaml <<'END'
macro:
  mesh: {gmsh: body.msh}
  boundary: [{on: base, displacement: [0 mm, 0 mm]}, {on: lid, displacement: [0.5 mm, 0 mm]}]
  steps: 2
END
# a square of 4 mm, a quadrilateral beside two triangles
cat >body.msh <<'END'
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
END
expect 0 "$lamella" rve shear-contact.yaml -o rve.h5 --no-estimate
expect 0 "$lamella" fe2 body.yaml -o body.h5
expect 0 -o 'wrote rve.vtkhdf' "$python" -m lamella.vtkhdf rve.h5
expect 0 -o 'wrote steps.vtkhdf' "$python" -m lamella.vtkhdf body.h5 steps.vtkhdf
expect 0 "$lamella" process "$source/tests/scenes/ripening.yaml" -o ripening.h5
expect 0 "$python" -m lamella.vtkhdf ripening.h5
expect 1 -e 'lamella.vtkhdf: body.yaml: is not an HDF5 file' "$python" -m lamella.vtkhdf body.yaml
expect 1 -e 'usage: python3 -m lamella.vtkhdf' "$python" -m lamella.vtkhdf

cat >common.py <<'PYTHON'
"""What is to be in the files: for each its states, and of a state points, cells and fields."""
import numpy as np
import lamella

def spatial(values):
    return np.pad(values, ((0, 0), (0, 1))) if values.shape[1:] == (2,) else values.reshape(len(values), -1).squeeze()

def expected():
    with lamella.Result("rve.h5") as file:
        yield "rve.vtkhdf", [float(n) for n in file.states()], [
            (spatial(f["x"]), file.mesh["elements"], {"wall_stress": f["wall_stress"]}, {"cell_of": file.mesh["cell_of"]})
            for f in map(file.fields, file.states())]
    with lamella.Result("body.h5") as file:
        yield "steps.vtkhdf", [float(n) for n in file.states()], [
            (spatial(file.mesh["nodes"]), file.mesh["elements"], {"u": f["u"]}, {"P": spatial(f["P"]), "turgor": f["turgor"]})
            for f in map(file.fields, file.states())]
PYTHON

"$python" - <<'PYTHON' || fail "the structure"
import h5py, numpy as np
from common import expected
for path, times, states in expected():
    with h5py.File(path) as file:
        root, steps = file["VTKHDF"], file["VTKHDF/Steps"]
        assert root.attrs["Type"] == b"UnstructuredGrid" and list(root.attrs["Version"]) == [2, 0]
        assert steps.attrs["NSteps"] == len(states) == len(times) > 2 and list(steps["Values"]) == times
        assert (steps["PartOffsets"][()] == 0).all() and (steps["CellOffsets"][()] == 0).all()
        for k, (points, elements, on_points, on_cells) in enumerate(states):
            at = steps["PointOffsets"][k]
            assert (root["Points"][at:at + root["NumberOfPoints"][0]] == points).all()
            assert root["NumberOfCells"][0] == len(elements)
            for i, nodes in enumerate(elements):
                begin, end = root["Offsets"][i:i + 2]
                assert list(root["Connectivity"][begin:end]) == list(nodes[nodes >= 0])
                assert root["Types"][i] == {9: 28, 6: 22}[end - begin]
            for where, fields, count in (("Point", on_points, len(points)), ("Cell", on_cells, len(elements))):
                for name, values in fields.items():
                    at = steps[f"{where}DataOffsets/{name}"][k]
                    assert np.array_equal(root[f"{where}Data/{name}"][at:at + count], values, equal_nan=True), name
with h5py.File("ripening.vtkhdf") as file:
    assert list(file["VTKHDF/Steps/Values"])[::len(file["VTKHDF/Steps/Values"]) - 1] == [0, 7 * 86400]
with h5py.File("steps.vtkhdf") as file:
    assert sorted(file["VTKHDF/Types"]) == [22, 22, 28]
PYTHON

"$python" - <<'PYTHON' || fail "VTK reads other states"
import numpy as np
try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    raise SystemExit
if (vtk.vtkVersion().GetVTKMajorVersion(), vtk.vtkVersion().GetVTKMinorVersion()) < (9, 3):
    raise SystemExit
from common import expected
STEPS = vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS()
for path, times, states in expected():
    reader = vtk.vtkHDFReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    information = reader.GetOutputInformation(0)
    assert [information.Get(STEPS, k) for k in range(information.Length(STEPS))] == times
    for time, (points, elements, on_points, on_cells) in zip(times, states):
        reader.UpdateTimeStep(time)
        grid = reader.GetOutputDataObject(0)
        assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), points)
        assert grid.GetNumberOfCells() == len(elements)
        for i, nodes in enumerate(elements):
            ids = grid.GetCell(i).GetPointIds()
            assert [ids.GetId(n) for n in range(ids.GetNumberOfIds())] == list(nodes[nodes >= 0])
            assert grid.GetCellType(i) == {9: vtk.VTK_BIQUADRATIC_QUAD, 6: vtk.VTK_QUADRATIC_TRIANGLE}[(nodes >= 0).sum()]
        for data, fields in ((grid.GetPointData(), on_points), (grid.GetCellData(), on_cells)):
            for name, values in fields.items():
                assert np.array_equal(vtk_to_numpy(data.GetArray(name)), values, equal_nan=True), name
PYTHON
