#!/usr/bin/env bash
# rve -o: OUT.xdmf names, of each state that has fields, datasets of OUT.h5 with their shapes; meshio, where it is, reads it.
. "$(dirname "$0")/common.sh"
set -e
/usr/bin/python3 -c 'import h5py' 2>/dev/null || exit 77

mkdir results
tissue mesh='along: 1, through: 1' >scene.yaml <<'YAML'
load: [{F: [[1, 0.1], [0, 1]]}, {F: [[1, 80], [0, 1]]}, {F: [[1, 0.2], [0, 1]]}]
YAML
expect 3 "$lamella" rve scene.yaml --quiet -o 'results/a & b.h5'
[ ! -e 'results/a & b.xdmf.tmp' ] || fail "a temporary file is left"
mv results moved # the reference between the files holds no folder
/usr/bin/python3 - <<'PYTHON' || fail "OUT.xdmf does not describe OUT.h5"
import xml.etree.ElementTree as XML
import h5py, numpy as np

with h5py.File("moved/a & b.h5") as h5:
    def read(item):
        file, dataset = item.text.split(":")
        assert file == "a & b.h5", file
        kind = {"Float": np.float64, "Int": np.int64}[item.get("NumberType")]
        assert h5[dataset].dtype == kind and item.get("Precision") == "8", dataset
        assert [int(n) for n in item.get("Dimensions").split()] == list(h5[dataset].shape), dataset
        return dataset, h5[dataset][()]

    series = XML.parse("moved/a & b.xdmf").find("Domain/Grid")
    assert series.get("GridType") == "Collection" and series.get("CollectionType") == "Temporal"
    states = series.findall("Grid")
    assert [state.find("Time").get("Value") for state in states] == ["1", "3"] # state 2 has no solution
    for k, state in zip((1, 3), states):
        topology = state.find("Topology")
        _, elements = read(topology.find("DataItem"))
        assert topology.get("TopologyType") == "Quadrilateral_9" and int(topology.get("NumberOfElements")) == len(elements)
        name, points = read(state.find("Geometry/DataItem"))
        assert name == f"/fields/{k}/x" and elements.max() == len(points) - 1
        fields = {a.get("Name"): (a.get("Center"), a.get("AttributeType"), *read(a.find("DataItem"))) for a in state.findall("Attribute")}
        assert set(fields) == {"cell_of"} | set(h5[f"fields/{k}"]), fields
        for name, (center, kind, _, values) in fields.items():
            assert center == ("Cell" if name == "cell_of" else "Node"), name
            assert len(values) == (len(elements) if center == "Cell" else len(points)), name
            assert kind == ("Scalar" if values.ndim == 1 else "Matrix"), name

    try:
        import meshio
    except ImportError:
        raise SystemExit
    with meshio.xdmf.TimeSeriesReader("moved/a & b.xdmf") as xdmf:
        points, cells = xdmf.read_points_cells()
        assert cells[0].type == "quad9" and np.array_equal(points, h5["fields/1/x"])
        time, point, cell = xdmf.read_data(1)
        assert time == 3 and np.array_equal(point["x"], h5["fields/3/x"]) and np.array_equal(cell["cell_of"][0], h5["mesh/cell_of"])
PYTHON
