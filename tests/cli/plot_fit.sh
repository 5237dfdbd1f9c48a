# lamella plot of fits: curves, figures and profiles; what is drawn is what the file holds; broken files.
. "$(dirname "$0")/common.sh"
package scipy matplotlib

cat >check.py <<'PYTHON'
import json
import numpy as np
import lamella
from raises import raises

curve = {"name": "pull.csv", "x": "F11", "y": "P11 (kPa)", "data": [[1, 1.1, 1.2], [0, 4, 9]], "scatter": None,
         "model": [[1, 1.1, 1.2, 1.3], [0.1, 4.2, 8.8, 14]]}
figures = {"name": "read.csv", "figures": ["modulus (MPa)", "peak.stress (MPa)"], "data": [3.6, 0.5], "scatter": [0.4, 0.05],
           "model": [3.3, None]}
x = np.geomspace(0.02, 2, 9)
parameter = {"key": "rve.wall.C1", "unit": "MPa", "bounds": [0.02, 2.0], "value": 0.2, "interval": [0.1, 0.4],
             "profile": [x.tolist(), (5 + 10 * np.log(x / 0.2) ** 2).tolist()], "profiled": [0.107, None]}
fit = {"lamella_calibration": 1, "parameters": [parameter], "correlation": [[1]], "chi2": 5.0, "freedom": 4,
       "scatter_known": True, "starts": [5.0], "limit": 5 + 3.84, "untold": [], "experiments": [curve, figures]}
json.dump(fit, open("fit.json", "w"))
page = lamella.plot.draw("fit.json")
pull, read, profile = page.axes
assert pull.get_xlabel() == "$F_{11}$" and pull.get_ylabel() == "$P_{11}$ (kPa)"
found = next(line for line in pull.lines if line.get_label() == "model")
assert np.allclose(found.get_xydata().T, curve["model"])
bars = read.containers[0][2][0].get_segments()  # 1.96 * 0.4 / 3.6
assert np.allclose(np.abs(bars[0][:, 0]), 100 * 1.96 * 0.4 / 3.6), bars
model = next(line for line in read.lines if line.get_label() == "model").get_xdata()
assert np.isclose(model[0], 100 * (3.3 / 3.6 - 1)) and np.isnan(model[1])
line = profile.lines[0].get_xydata()  # a parabola in the logarithm
assert np.allclose(line[:, 1], 5 + 10 * np.log(line[:, 0] / 0.2) ** 2, rtol=1e-6, atol=1e-6)
limit = next(line for line in profile.lines if line.get_label() == "95 %").get_ydata()
best = next(line for line in profile.lines if line.get_label() == "best").get_xdata()
assert np.allclose(limit, fit["limit"]) and np.allclose(best, 0.2) and profile.get_xlabel() == "rve.wall.C1 (MPa)"
assert profile.get_xlim()[0] < 0.107 and profile.get_ylim()[0] < 5 < fit["limit"] < profile.get_ylim()[1]

curve["scatter"] = [0.5, 0.5, 0.5]
del parameter["profile"], parameter["profiled"], fit["experiments"][1]
json.dump(fit, open("curve.json", "w"))
page = lamella.plot.calibration("curve.json", title=False)
assert len(page.axes) == 1 and np.allclose(np.ptp(page.axes[0].containers[0][2][0].get_segments()[1][:, 1]), 2 * 1.96 * 0.5)
page.save("curve.svg")
for broken, why in (({"lamella_calibration": 1}, "is not of lamella calibrate: chi2 is missing"),
                    (fit | {"experiments": [{"x": "F11"}]}, "or damaged: data is missing")):
    json.dump(broken, open("broken.json", "w"))
    raises(lamella.InputError, why, lambda: lamella.plot.draw("broken.json"))
PYTHON
"$python" -W error::RuntimeWarning check.py || fail "the page"

expect 0 "$lamella" plot fit.json --dpi 40
[ -s fit.png ] || fail "no picture"
expect 2 -e "a fit is drawn as a whole" "$lamella" plot fit.json --state 1

# files that are no results
tissue </dev/null >scene.yaml
printf 'F11, P11 (MPa)\n1, 2\n' >data.csv
head -c 200 /dev/urandom >bytes.h5
mkdir folder
for case in "2 scene.yaml:is a scene; plot draws" "2 data.csv:is a CSV file; plot draws" "2 bytes.h5:is not an HDF5 file; give" \
  "4 folder:cannot be read: Is a directory" "4 none.json:No such file or directory" "4 none.h5:cannot be read: No such file"; do
  file=${case%%:*}
  expect "${case%% *}" -e "^lamella: ${file#* }: ${case#*:}" "$lamella" plot "${file#* }"
done
