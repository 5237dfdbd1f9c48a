# lamella.calibration: parameters are found again, with intervals; what the data do not tell; priors; files; mistakes.
. "$(dirname "$0")/common.sh"
package scipy

tissue turgor='pressure: 0.02 MPa' >tension.yaml <<'END'
load: [{ramp: {to: [[1.2, 0], [0, 1]], steps: 10}}]
END
sed 's/^load.*/load: [{inflate: true}, {ramp: {to: [[1, 0.3], [0, 1]], steps: 10}}]/' tension.yaml >shear.yaml

"$python" - "$lamella" <<'PYTHON' || fail "the package"
import csv, subprocess, sys
import numpy as np
import lamella
from lamella.calibration import Curve, Parameter, calibrate
from raises import raises

def data(scene, i, j):
    r = lamella.RVE(scene).solve()
    F = r.F @ np.linalg.inv(r.F[0]) if scene == "shear.yaml" else r.F
    return {f"F{i}{j}": F[1:, i - 1, j - 1], f"P{i}{j} (kPa)": r.P[1:, i - 1, j - 1] / 1e3}

tension, shear = data("tension.yaml", 1, 1), data("shear.yaml", 1, 2)
bounds = {"rve.wall.C1": ("0.02 MPa", "0.5 MPa"), "rve.wall.C4": ("0.1 MPa", "10 MPa"),
          "rve.turgor.pressure": ("1 kPa", "100 kPa")}
truth = [0.1, 1, 20]

# exact data give the parameters, from each start; the file that rve writes is data, and so is the dictionary
fit = calibrate(bounds, [Curve("tension.yaml", tension), Curve("shear.yaml", shear)], starts=2)
assert np.allclose(fit.values, truth, rtol=1e-6) and not fit.untold and fit.freedom == 16, fit
assert fit.chi2 < 1e-12 and "2 of 2 starts" in str(fit), fit
found = lamella.RVE(fit.scene("tension.yaml")).solve()
assert np.allclose(found.P[1:, 0, 0] / 1e3, tension["P11 (kPa)"], rtol=1e-6)
subprocess.run([sys.argv[1], "rve", "tension.yaml", "--no-estimate", "--quiet", "-o", "t.h5"], check=True, stdout=subprocess.DEVNULL)
rows = list(csv.DictReader(open("t.csv")))
with open("two.csv", "w") as file:
    file.write("F11, P11 (MPa)\n\n" + "".join(f"{row['F11']}, {row['P11 (MPa)']}\n" for row in rows))
assert np.allclose(Curve("tension.yaml", "two.csv").y[1:] / 1e3, tension["P11 (kPa)"][: len(rows) - 1], rtol=1e-5)

# with 2 % of noise they lie in their intervals; the scatter is found where it is not told
rng = np.random.default_rng(4)
noisy = [{x: v + 0.02 * np.abs(v).max() * rng.standard_normal(len(v)) * x.startswith("P") for x, v in d.items()}
         for d in (tension, shear)]
for scatter in (0.02, None):
    curves = [Curve(scene, d, scatter) for scene, d in zip(("tension.yaml", "shear.yaml"), noisy)]
    fit = calibrate(bounds, curves, starts=1)
    assert all(low < t < high for t, (low, high) in zip(truth, fit.intervals)), fit
    assert 0.01 < fit.intervals[1, 1] - fit.intervals[1, 0] < 0.5, fit

# modulus times thickness is told, not each; a prior on one tells the other
both = {"rve.wall.C4": ("0.1 MPa", "10 MPa"), "rve.cell.wall_thickness": ("5 um", "25 um"), "rve.wall.C1": ("0.02 MPa", "0.5 MPa")}
curve = Curve("tension.yaml", noisy[0], 0.02)
fit = calibrate(both, [curve], starts=1)
assert any("rve.cell.wall_thickness" in text and "apart" in text for text in fit.untold), fit
known = [Parameter(key, *ends, prior=("11.25 um", "0.1 um") if "um" in ends[0] else None) for key, ends in both.items()]
told = calibrate(known, [curve], starts=1)
assert abs(told.values[1] - 11.25) < 0.3 and np.ptp(told.intervals[0]) < np.ptp(fit.intervals[0]), told

# bounds and priors may have other units; ratios of temperatures in degC mean nothing; a prior lies between the bounds
mixed = Parameter("k", "100 kPa", "0.5 MPa", prior=("0.2 MPa", "20 kPa"))
assert mixed.logarithmic and np.allclose([mixed.value(0), mixed.value(1), mixed.misfit(220)], [100, 500, 1]), mixed
warm = Parameter("t", "2 degC", "20 degC", prior=("280 K", "3 K"))
assert not warm.logarithmic and np.isclose(warm.value(0.5), 11) and np.isclose(warm.misfit(9.85), 1), warm
raises(lamella.InputError, "is no mean between the bounds", lambda: Parameter("k", 1, 2, prior=(3, 1)))

# data that no model can follow: misfit, a value on its bound, points that contradict each other, scatter given or not
wild = {"F11": [1.02, 1.05, 1.1, 1.05], "P11 (MPa)": [-0.019, 0.5, 1.0, 0.1]}
for scatter, words in ((None, "the scenes miss the data by"), (0.01, "the scenes do not repeat the data within their scatter")):
    wrong = calibrate({"rve.wall.C1": ("0.02 MPa", "0.5 MPa")}, [Curve("tension.yaml", wild, scatter)], starts=1)
    assert words in wrong.misfit and "the worst point is data, point 3: F11 = 1.1, P11 (MPa) = 1 (the model: -" in wrong.misfit, wrong
    assert "rve.wall.C1: the best value is the upper bound, 0.5 MPa" in wrong.doubts[0], wrong
    assert wrong.doubts[1] == ("data, point 2: F11 = 1.05, P11 (MPa) = 0.5, and data, point 4: F11 = 1.05, P11 (MPa) = 0.1: "
                               "they contradict each other"), wrong
    assert all(text in str(wrong) for text in (wrong.misfit, *wrong.doubts)) and wrong.told()["doubts"] == wrong.doubts
# of many points one off, and a curve of another form
x = np.linspace(1.04, 1.2, 30)
y = np.interp(x, tension["F11"], tension["P11 (kPa)"])
for change, words in ((0.3 * (x == x[6]), f"data, point 7: F11 = {x[6]:.6g}"), (0.05 * np.sin((x - 1) * 50), "the model's curve has another form")):
    off = Curve("tension.yaml", {"F11": x, "P11 (kPa)": y + change * y.max()})
    assert words in str(calibrate({"rve.wall.C1": ("0.02 MPa", "0.5 MPa")}, [off], starts=1).doubts), words
assert not fit.misfit and not fit.doubts, fit

# a model that does not reach is far off; mistakes
far = Curve("tension.yaml", {"F11": [1.0, 1.5], "P11 (kPa)": [0, 1]}, 0.02)
assert np.isnan(far.model(far.scene)).all()  # the scene has no undeformed state
few = Curve("tension.yaml", {"F11": [1.1, 1.2], "P11 (kPa)": [1, 2]})
for wrong, of, why in (({"rve.C5.x": (1, 2)}, curve, "no block C5"), ({"rve.wall.C5": (1, 2)}, curve, "unknown key"),
                       ({"rve.wall.C1": ("1 MPa", "0.5 MPa")}, curve, "is not below"),
                       ({"rve.wall.C1": (1, "0.5 MPa")}, curve, "one has a unit, the other none"),
                       ({"rve.wall.C1": ("soft", "0.5 MPa")}, curve, "is no number with a unit"),
                       (bounds, few, "give the scatter"),
                       (bounds, far, "F11 from 1 to 1.5; with parameters in the middle of their bounds the scene's states reach from 1.02 to 1.2")):
    raises(lamella.InputError, why, lambda: calibrate(wrong, [of], starts=1))
head = "F11, P11 (MPa)"
for text, why in (("F11\n1\n", "bad.csv: has 1 column (F11); a curve has two"), (head, "has no numbers"), ("", "bad.csv: is empty; save"),
                  (f"{head}\n1, x\n", "bad.csv:2: column P11 (MPa): x: is not a finite number"),
                  (f"{head}\n1, nan\n", "nan: is not a finite number"), (f"{head}\n1, \n", "bad.csv:2: column P11 (MPa): is empty"),
                  (f"{head}\n1\n", "bad.csv:2: 1: 1 cells under 2 titles; save"), (f"{head}\n1,05,0,5\n", "is the decimal sign a comma"),
                  (f"{head}\n1, '1_0'\n", "is not a finite number"), (f'{head}\n1.0, "0,5"\n', "0,5: has a decimal comma"),
                  ("F11; P11 (MPa)\n1,05;0,5\n", "bad.csv:1: columns are separated by semicolons"), (f"{head}\0\n", "is not text"),
                  ("\ufeffF11\tP11 (MPa)\n1\t2\n", "bad.csv:1: columns are separated by tabs"), ("PK\3\4", "is a spreadsheet or archive"),
                  ("F11, F11\n1, 2\n", "bad.csv:1: two columns are called F11"), ("1, 2\n1, 2\n", "a column '1'; its title is"),
                  ("F11, stress (MPa)\n1, 2\n", "stress"), ("F11, P11 (MPb)\n1, 2\n", "MPb"), (f"{head}\n1, 0\n", "all values are 0"),
                  (f"{head}, scatter\n1, 2, 1\n1, 2, 0\n", "bad.csv:3: a scatter is not above 0")):
    open("bad.csv", "w").write(text)
    raises(lamella.InputError, why, lambda: Curve("tension.yaml", "bad.csv"))
for ends in "\r\n", "\r":  # of other systems; spreadsheets leave cells behind the last
    open("ends.csv", "w", newline="").write(ends.join((head + ",", "1.05,0.5,,", "", "1.1,0.6,,", "")))
    assert Curve("tension.yaml", "ends.csv").y.tolist() == [0.5e6, 0.6e6]
PYTHON
