# Studies and their files in Python: the numbers of the program, in SI units and in those asked for.
. "$(dirname "$0")/common.sh"
package h5py

cp "$source"/tests/scenes/{pressed-disc,storage,ripening,stiffening}.yaml .
cp "$source/tests/fuzz/files/contact-table.yaml" table.yaml

"$python" - <<'PYTHON' || fail "the package"
import sys, warnings
import numpy as np
import lamella
from raises import raises

assert not {"h5py", "yaml", "matplotlib"} & set(sys.modules)  # import is quick
warnings.simplefilter("ignore")

def close(one, other):
    assert np.allclose(one, other, rtol=1e-12, atol=1e-12, equal_nan=True), (one, other)

# units
assert lamella.quantity("0.02 MPa") == 2e4 and lamella.quantity("4 degC") == 277.15
close(lamella.to([[1e6, 2e6]], "MPa"), [[1, 2]])
close(lamella.to(300, "degC"), 26.85)
close(lamella.to(1e-7 / 1e6, "m/s/MPa"), 1e-7)
raises(lamella.InputError, '"0.02": has no unit', lambda: lamella.quantity("0.02"))
raises(lamella.InputError, "furlongs", lambda: lamella.to(1, "furlongs/pound"))

# a body: what the program tells of its steps, and its file
disc = lamella.scene_dict("pressed-disc.yaml")
disc["macro"]["program"] = [{"to": 1, "steps": 2}]
body = lamella.fe2(disc, "disc.h5", ranks=1)
with body:
    assert body.kind == "fe2" and body.status == "done" and list(body.steps) == [0, 1, 2] == body.states()
    assert body.boundaries == ["left", "bottom", "plate"] and body.summary["loaded"]["boundary"] == "plate"
    assert body.displacement.shape == body.reaction.shape == (3, 3, 2)
    close(body.displacement[-1, 2], [0, -1e-3])
    close(lamella.to(body.reaction, "N/mm"), body.file["macro/curve/reaction"][()])
    close(body.turgor_mean, 2e4)
    fields, mesh = body.fields(2), body.mesh
    assert fields["P"].shape == (len(mesh["elements"]), 3, 3) and fields["u"].shape == (len(mesh["nodes"]), 3)
    close(mesh["nodes"].max(), 5e-3)
    close(fields["P"], 1e6 * body.file["macro/step/2/P"][()].reshape(-1, 3, 3))
    close(fields["max_gap"], 75e-6 * body.file["macro/step/2/max_gap"][()])
    close(body["zoom/apothem"], 75e-6)
    raises(AttributeError, "no firmness", lambda: body.firmness)
    raises(lamella.InputError, "disc.h5: has no macro/step/7", lambda: body.fields(7))

# what did not go well are warnings, and flags
disc["macro"]["boundary"][2]["plate"]["displacement"] = ["0 mm", "-40 mm"]
with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    failed = lamella.fe2(disc, "failed.h5")
assert failed.status not in ("done", None) and said and said[0].filename == "<stdin>", (failed.status, said)
raises(lamella.InputError, "respose", lambda: lamella.fe2({**disc, "respose": 1}, "none.h5"))

# tissue in time
tissue = lamella.process(lamella.Scene("ripening.yaml"), "ripening.h5", frames=3)
told = lamella.run("process", "ripening.yaml")
close(tissue.time, [state["time"] for state in told])
close(tissue.firmness, [1e6 * state["firmness"] for state in told])
close(tissue.factor["walls"], [state["factors"]["walls"] for state in told])
close(tissue.responses.P.reshape(-1, 9), [1e6 * np.array(state["P"]) for state in told])
assert list(tissue.event[tissue.event != ""]) == [state["event"] for state in told if state.get("event")]
assert tissue.status == "done" and len(tissue.states()) >= 3
close(tissue.fields(0)["x"], 75e-6 * tissue.file["fields/0/x"][()])

# failure over two quantities
failure = lamella.map("stiffening.yaml", "map.h5")
assert list(failure.axes) == ["load_factor", "k2"] and [len(values) for values in failure.axes.values()] == [4, 3]
told = lamella.run("map", "stiffening.yaml", "-o", "other.h5")
assert list(failure.mode.ravel()) == [point["failure"]["mode"] for point in told]
assert failure.criterion[0, 3] == "wall" and failure.criterion[0, 0] == "" and failure.place.shape == (3, 4, 3)
close(failure.load_factor[:, 3], [told[3 + 4 * y]["failure"]["load_factor"] for y in range(3)])
points = {point["point"]: point for point in told}
close(failure.responses.P.reshape(-1, 9), [1e6 * np.array(points[key]["P"], dtype=float) for key in failure.keys])

# a database
database = lamella.Database.build("table.yaml", "table.h5")
assert database.query([[1.01, 0.02], [0, 0.99]], 2e4, 1e3, accuracy=0.05).converged
raises(lamella.InputError, "table.h5", lambda: lamella.Database.build("table.yaml", "table.h5"))  # it exists
lamella.Database.build("table.yaml", "table.h5", resume=True)
PYTHON
