# slow: lamella calibrate: the example of the reference; a fit of curves and figures of several scenes, its file, mistakes.
. "$(dirname "$0")/common.sh"
package scipy

uncertain='uncertain: [{key: rve.wall.C1, from: 0.02 MPa, to: 0.5 MPa}, {key: rve.turgor.pressure, from: 1 kPa, to: 100 kPa}]'
{ tissue <<<"load: [{inflate: true}, {ramp: {to: [[1.2, 0], [0, 1]], steps: 8}}]"; echo "$uncertain"; } >tension.yaml
{ tissue <<<"load: [{inflate: true}, {ramp: {to: [[1, 0.3], [0, 1]], steps: 6}}]"; echo "$uncertain"; } >shear.yaml
cat >tension.csv <<'END'
F11, P11 (kPa), scatter

1.00, 0.0, 0.6
1.02, 6.0, 0.6
1.04, 11.8, 0.6
1.06, 17.9, 0.6
1.08, 25.1, 0.6
1.10, 32.0, 0.6
1.12, 40.2, 0.6
1.15, 52.9, 0.6
1.18, 64.6, 0.6
1.20, 73.5, 0.6
END
cat >figures.csv <<'END'
figure, value, scatter
modulus (MPa), 0.041, 0.001
peak.stress (kPa), 19.9, 0.6
END

expect 0 "$lamella" calibrate tension.yaml tension.csv shear.yaml figures.csv --profile -o fit
grep -v ^wrote out.txt >told.txt
sed -n '/^    \$ lamella calibrate/,/^$/p' "$source/docs/reference/commands.md" | sed -n '2,$s/^    //p' >shown.txt
diff told.txt shown.txt || fail "the reference shows another fit"
python3 - <<'PYTHON' || fail "fit.json"
import json
told = json.load(open("fit/fit.json"))
assert [p["key"] for p in told["parameters"]] == ["rve.wall.C1", "rve.turgor.pressure"], told
for p in told["parameters"]:
    assert p["bounds"][0] < p["profiled"][0] < p["value"] < p["profiled"][1] < p["bounds"][1], p
    assert abs(min(p["profile"][1]) - told["chi2"]) < 1e-6 * told["chi2"] + 1e-9, p
curve, figures = told["experiments"]
assert len(curve["data"][0]) == 10 and figures["figures"] == ["modulus (MPa)", "peak.stress (kPa)"], told
PYTHON

# a key of one scene alone leaves the other as it is; keys of both are one parameter
sed 's/, {key: rve.turgor.pressure.*}\]/]/' tension.yaml >one.yaml
expect 0 "$lamella" calibrate one.yaml tension.csv shear.yaml figures.csv --starts 1
sed 's/to: 0.5 MPa/to: 0.4 MPa/' shear.yaml >other.yaml

# data that no values repeat are reported as such, scatter given or not
sed 's/^\(1.*\), \(.*\), 0.6/\1, -\2, 0.6/' tension.csv >turned.csv
expect 3 -o "the scenes do not repeat the data within their scatter" -o "the worst point is turned.csv:12: F11 = 1.2, P11 (kPa) = -73.5" \
  -o "rve.wall.C1: the best value is the lower bound, 0.02 MPa" "$lamella" calibrate tension.yaml turned.csv --starts 1
printf 'F11, P11 (MPa)\n1.0, -0.019\n1.05, 0.5\n1.1, 1.0\n' >wild.csv
expect 3 -o "the scenes miss the data by [0-9]* % of the largest value" -o "C1: the best value is the upper bound, 0.5 MPa" \
  "$lamella" calibrate one.yaml wild.csv --starts 1

refused() { # WORDS ARGUMENT...
  expect 2 "$lamella" calibrate "${@:2}" --starts 1
  has err.txt "$1"
}
refused "other.yaml: uncertain: rve.wall.C1: another scene has other bounds for it" tension.yaml tension.csv other.yaml figures.csv
sed '/^uncertain/d' tension.yaml >known.yaml
refused 'known.yaml: has no block `uncertain`' known.yaml tension.csv
sed 's/, 0.6$//; s/, scatter//' tension.csv >bare.csv
refused "bare.csv: has no scatter, and others have one" tension.yaml bare.csv shear.yaml figures.csv
sed 's/modulus (MPa)/modulus/' figures.csv >unit.csv
refused "unit.csv: modulus: a unit is missing, as (MPa)" shear.yaml unit.csv
sed 's/modulus/stiffness/' figures.csv >name.csv
refused "name.csv: a figure 'stiffness (MPa)'; wanted is one of modulus" shear.yaml name.csv
sed 's/^1.20/1.30/' tension.csv >far.csv
refused "F11 from 1 to 1.3; with parameters in the middle of their bounds the scene's states reach from 1 to 1.2" tension.yaml far.csv
sed 's/41, 0.001/41, 0/' figures.csv >certain.csv
refused "certain.csv:2: column scatter: 0: is not above 0" shear.yaml certain.csv
printf '\xef\xbb\xbf' | cat - tension.csv >bom.csv
expect 0 "$lamella" calibrate tension.yaml bom.csv --starts 1
for title in "P11 (um):um" "P (kPa):P is a tensor: write a component, as P11" "status:a response has no number status" \
  "P11:the unit is missing, as P11 (MPa)"; do
  sed "s/P11 (kPa)/${title%%:*}/" tension.csv >title.csv
  refused "${title#*:}" tension.yaml title.csv
done
sed 's/steps: 8}}/steps: 8}}, {F: [[1.1, 0], [0, 1]]}/' tension.yaml >back.yaml
refused "along the scene's load F11 goes back: give loading and unloading as experiments of their own" back.yaml tension.csv
sed 's/, stress.*//; s/^peak.stress.*/failure.strain, 0.1, 0.01/' figures.csv >fails.csv
sed '/^uncertain/i strength: {wall: 50 MPa, lamella_normal: 50 MPa}' shear.yaml >strong.yaml
refused "failure.strain: with parameters in the middle of their bounds the scene has none" strong.yaml fails.csv
expect 1 "$lamella" calibrate tension.yaml tension.csv shear.yaml
has err.txt "shear.yaml has no data"
expect 4 "$lamella" calibrate tension.yaml nothing.csv
has err.txt "nothing.csv"
