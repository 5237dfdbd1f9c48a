# slow: docs/reference/realisations.md: tissues of 25 to 100 cells are isotropic, without bias, and scatter as 1/sqrt(cells);
# periods of 12 cells are not large enough. With a folder as the third argument the realisations stay there.
. "$(dirname "$0")/common.sh"
package scipy

sed -n '/^    version: 1$/,/^    accuracy/s/^    //p' "$source/docs/reference/realisations.md" >scene.yaml
sed -n 's/^    lamella \(tissue .*\)/"$lamella" \1/p' "$source/docs/reference/realisations.md" >make.sh
. ./make.sh >out.txt || fail "no tissue"
expect 0 "$lamella" rve scene.yaml --realisations 24 --cells 12,25,50,100 -o "${3:-few}" --json
cp out.txt with-12.json
expect 0 "$lamella" rve scene.yaml --realisations 24 --cells 25,50,100 -o "${3:-few}" --json
cp out.txt from-25.json

"$python" - <<'PYTHON' || fail "the figures of docs/reference/realisations.md"
import json
told, small = json.load(open("from-25.json")), json.load(open("with-12.json"))

# scatter: 1.5 times the interval of the exponent holds -1/2, since there are several intervals
for of in [*told["rest"]["moduli"], *(state["stress"] for state in told["states"])]:
    low, high = of["fit"]["exponent_interval"]
    assert abs(of["fit"]["exponent"] + 0.5) < 0.75 * (high - low), of["fit"]
    deviation = [entry["deviation"] for entry in of["sizes"]]
    assert deviation[0] > 1.3 * deviation[2], of["name"]
for entry in told["rest"]["isotropy"]:
    assert entry["distance"] < entry["distance_by_scatter"] < 0.01, entry
E = {q["name"]: q for q in told["rest"]["quantities"]}["E1"]
assert not E["bias"]

# 12 cells: Young's modulus 5 % to 12 % low, shear modulus 10 % to 30 % high, and not isotropic
of = {q["name"]: {entry["cells"]: entry["mean"] for entry in q["sizes"]} for q in small["rest"]["quantities"]}
bias = {q["name"]: [b["cells"] for b in q["bias"]] for q in small["rest"]["quantities"]}
assert 0.88 < of["E1"][12] / of["E1"][100] < 0.95 and bias["E1"] == bias["E2"] == bias["A1212"] == [12], (of, bias)
assert 1.1 < of["A1212"][12] / of["A1212"][100] < 1.3
assert small["rest"]["isotropy"][0]["distance"] > small["rest"]["isotropy"][0]["distance_by_scatter"]
PYTHON
