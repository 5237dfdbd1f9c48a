# slow: lamella rve --realisations: means and deviations are those of the single responses; a second call goes on; the fit,
# isotropy and what an accuracy needs, against cases that are known; failures are told; refusals; a picture.
. "$(dirname "$0")/common.sh"
package scipy

"$lamella" tissue -o made.json --cells 7 --size 150um --variation 0.2 --wall-thickness 11um >made.txt || fail "no tissue"
scene() {
  printf '%s\n' 'version: 1' 'rve:' "  tissue: ${1:-made.json}" \
    '  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}' \
    '  turgor: {mode: prescribed, pressure: 0.02 MPa}' '  mesh: {along: 4, through: 1}' "${2:-}"
}
load='load: [{F: [[1.02, 0.01], [0, 1]]}, {F: [[free, 0], [0, 1]], P: [[0 MPa, x], [x, x]]}]'
scene made.json "$load" >scene.yaml

expect 0 -o '^for accuracy 1 % of the stress' -o "^    1 P11 .* 6      2 " "$lamella" rve scene.yaml --realisations 2 --cells 8,6 -o all
touch -d @1 all/*-*
expect 0 "$lamella" rve scene.yaml --realisations 3 --cells 6,8 -o all --processes 1 --json
mv out.txt all.txt
[ "$(find all -name '*-*' -newermt @2 | wc -l)" = 8 ] || fail "the second call has solved anew: $(ls -l all)"
[ "$(find all -name '*-0003*' -newermt @2 | wc -l)" = 8 ] || fail "the second call has not solved what was not there"

cat >check.py <<'PYTHON'
import json, subprocess, sys
import numpy as np
from lamella.tissue import Tissue, scatter
told = json.load(open("all.txt"))
assert told == json.load(open("all/realisations.json")) and not told["failed"]

# the single responses, solved again one by one
lamella, STUDENT = sys.argv[1], 4.30265272974946  # of 0.975, two degrees of freedom
def states(name):
    lines = subprocess.run([lamella, "rve", name, "--json", "--tangent"], capture_output=True, text=True, check=True).stdout
    return [json.loads(line) for line in lines.splitlines()]
single = {n: [states(f"all/{n}-000{k}.yaml") for k in (1, 2, 3)] for n in (6, 8)}
of = {"P11": lambda s: s["P"][0], "P12": lambda s: s["P"][1], "P21": lambda s: s["P"][3], "P22": lambda s: s["P"][4],
      "A1111": lambda s: s["tangent"][0], "A2222": lambda s: s["tangent"][9 * 4 + 4],
      "A1212": lambda s: s["tangent"][9 * 1 + 1], "F11": lambda s: s["F"][0], "lumen_fraction": lambda s: s["lumen_fraction"]}
for number, state in enumerate(told["states"]):
    names = {q["name"] for q in state["quantities"]}
    assert ("F11" in names) == (number == 1) and "F22" not in names, "F is told where it is found"
    for q in state["quantities"]:
        if q["name"] not in of:
            continue
        for entry in q["sizes"]:
            values = np.array([of[q["name"]](r[number]) for r in single[entry["cells"]]])
            close = dict(rtol=1e-9, atol=1e-12)
            assert np.allclose(entry["values"], values, **close) and entry["count"] == 3, (q["name"], entry, values)
            deviation = np.sqrt(((values - values.mean())**2).sum() / 2)
            assert np.allclose([entry["mean"], entry["deviation"]], [values.mean(), deviation], **close)
            assert np.allclose(np.diff(entry["interval"]) / 2, STUDENT * deviation / 3**0.5, **close)
    for entry in state["stress"]["sizes"]:
        P = np.array([[r[number]["P"][k] for k in (0, 1, 3, 4)] for r in single[entry["cells"]]])
        size = max(np.linalg.norm(P.mean(0)), 0.01 * told["rest"]["stiffness"])
        assert np.isclose(entry["deviation"], np.sqrt(((P - P.mean(0))**2).sum() / 2) / size, rtol=1e-9)

# tissues have what was asked, are not the same, and have the seeds that are told
tissues = {(n, k): Tissue.read(f"all/{n}-000{k}.json") for n in (6, 8) for k in (1, 2, 3)}
for (n, k), t in tissues.items():
    assert len(t.cells) == n and t.made_by["asked"]["seed"] == 10000 * n + k
    assert abs(t.made_by["got"]["area_variation"] - 0.2) < 1e-9 and t.wall_thickness == 11
assert len({t.text() for t in tissues.values()}) == 6

# Young's moduli of linear elastic isotropic tissue in plane strain, E/(1 - nu^2); of the tissue by two states
E, nu = 3.0, 0.3
lame, mu, one = E * nu / (1 + nu) / (1 - 2 * nu), E / 2 / (1 + nu), np.eye(2)
A = lame * np.einsum("ij,kl->ijkl", one, one) + mu * (np.einsum("ik,jl->ijkl", one, one) + np.einsum("il,jk->ijkl", one, one))
turned = A + 0.1 * np.einsum("ik,jl->ijkl", one, one)  # a rotation is resisted, as by stress
assert np.allclose([scatter.young(A, 0), scatter.young(A, 1)], E / (1 - nu**2))
assert np.allclose(scatter.isotropic(turned), turned)
rng = np.random.default_rng(2)
B, angles = rng.standard_normal((2, 2, 2, 2)), rng.uniform(0, 2 * np.pi, 40000)
c, s = np.cos(angles), np.sin(angles)
Q = np.array([[c, -s], [s, c]]).transpose(2, 0, 1)
turns = np.einsum("nia,njb,nkc,nld,abcd->ijkl", Q, Q, Q, Q, B, optimize=True) / len(Q)
assert np.abs(turns - scatter.isotropic(B)).max() < 0.05, "a mean over random rotations"
assert np.isnan(scatter.young(np.zeros((2, 2, 2, 2)), 0))
noisy = A + 0.2 * rng.standard_normal((200, 12, 2, 2, 2, 2))
distances = [scatter.isotropy(9, some) for some in noisy]
assert np.mean([d["distance"] < d["distance_by_scatter"] for d in distances]) > 0.95
first, last = A.copy(), A.copy()
first[0, 0, 0, 0] *= 1.5
assert scatter.isotropy(9, np.array([first, first + 1e-3 * last]))["distance"] > 0.1

# deviations that fall as 2/sqrt(n), or as 1/n
def entries(power):
    return [{"cells": n, "count": 5, "deviation": 2 * n**power} for n in (10, 20, 80)]
good, bad = scatter.fit(entries(-0.5)), scatter.fit(entries(-1.5))
assert np.isclose(good["s1"], 2) and np.isclose(good["exponent"], -0.5) and good["holds"] and good["freedom"] == 12
assert np.isclose(bad["exponent"], -1.5) and not bad["holds"]
assert scatter.needed(good, [50], 0.1)["cells"] == np.ceil((2.178812829663418 * 2 / 0.1)**2), "Student, 0.975, twelve"

# of means of as many tissues as are said to be needed 95 % are as right as asked; by trials, scatter 2/sqrt(cells)
right = 0
for trial in range(500):
    tissue = lambda n, count: 1 + 2 / n**0.5 * rng.standard_normal((count, 1))
    need = scatter.relative("", {n: tissue(n, 8) for n in (100, 400)}, 0.1)["need"]
    right += abs(tissue(400, need["realisations"][1]["count"]).mean() - 1) < 0.1
assert 0.93 < right / 500 < 0.985, right

# means that differ between sizes
biased = scatter.quantity("q", "1", {10: [1, 1.01, 0.99], 40: [1.1, 1.101, 1.099], 90: [1.1, 1.101, 1.1]})
assert [b["cells"] for b in biased["bias"]] == [10] and np.isclose(biased["bias"][0]["difference"], 1 - 1.1003333333333)
off = scatter.relative("", {10: np.array([[1.0], [1.01], [0.99]]), 40: np.array([[1.1], [1.101], [1.099]])}, 0.01)
assert np.allclose([e["bias"] for e in off["sizes"]], [0.1, 0]), off
assert np.isclose(scatter.deviation_interval(1.0, 3)[1], np.sqrt(2 / 0.0506356159685))  # a table of chi square
assert scatter.relative("", {5: np.zeros((3, 4)), 9: np.ones((1, 4))}, 0.01) == {"name": "", "need": None, "fit": None,
       "sizes": [{"cells": 5, "count": 3, "deviation": None, "deviation_interval": None, "bias": None},
                 {"cells": 9, "count": 1, "deviation": None, "deviation_interval": None, "bias": None}]}
PYTHON
"$python" check.py "$lamella" || fail "the numbers"

# failures are told and counted, those of some tissues alone, too; with a strength how tissues fail
scene made.json 'load: [{F: [[1.01, 0], [0, 1]]}, {F: [[0.3, 0], [0, 1]]}]' >fails.yaml
echo 'strength: {lamella_normal: 0.012 MPa}' >>fails.yaml
expect 3 -o "^failed: 6 cells, realisation 1 (seed 60001), state 2: no_equilibrium: the lumen" \
  -o "^failure of 6 cells: .* 2; the curve" -o "load_factor  .* 6      2" -o "^    2 stress *- *-" \
  "$lamella" rve fails.yaml --realisations 2 --cells 6 -o fails
for k in 1 2; do sed -i 's/"vertices": \[/&[0, 0],/' all/8-000$k.json; done
rm all/8-000[12].states.json
expect 3 -o "^failed: 8 cells, realisation 2 (seed 80002): " -o "^    1 P11 .* 8      1 .* -   -" -o "^means are those of the others" \
  "$lamella" rve scene.yaml --realisations 3 --cells 6,8 -o all

# a signal stops it, and the same command goes on
scene made.json "$load" | sed 's/along: 4, through: 1/along: 12, through: 2/' >slow.yaml
"$lamella" rve slow.yaml --realisations 9 --cells 60 -o slow 2>stopped.txt &
for _ in $(seq 100); do [ ! -e slow/60-0001.yaml ] || break; sleep 0.1; done
ends TERM 143 $!
for _ in $(seq 100); do [ ! -s stopped.txt ] || break; sleep 0.1; done
has stopped.txt "stopped: the same command goes on with what is in slow"

# a picture
if "$python" -c 'import matplotlib' 2>/dev/null; then
  expect 0 "$lamella" plot --dpi 40 fails/realisations.json
  cp all.txt all.json
  expect 0 "$lamella" plot --dpi 40 all.json
  [ -s all.png ] || fail "no picture"
  echo '{"lamella_realisations": 1}' >broken.json
  expect 2 -e "is not of lamella rve --realisations" "$lamella" plot broken.json
fi

# refusals
"$python" - <<'PYTHON'
import json
told = json.load(open("made.json"))
told["made_by"] = {"program": "by hand"}
json.dump(told, open("hand.json", "w"))
PYTHON
scene hand.json "$load" >hand.yaml
scene >noload.yaml
tissue <<<"$load" >hexagons.yaml
scene made.json "$load" | sed 's/^load/  variation: {kinds: [{turgor: 2}], list: [0, 1, 0, 1, 0, 1, 0]}\n&/' >list.yaml
expect 2 -e "hexagons.yaml: rve.tissue is missing" "$lamella" rve hexagons.yaml --realisations 2
expect 2 -e "hand.json: was not made by .lamella tissue" "$lamella" rve hand.yaml --realisations 2
expect 2 -e "noload.yaml: has no block" "$lamella" rve noload.yaml --realisations 2
expect 2 -e "list.yaml: rve.variation.list: is of the cells of one tissue" "$lamella" rve list.yaml --realisations 2
expect 2 -e "all: has realisations of another scene" "$lamella" rve fails.yaml --realisations 2 -o all
expect 2 -e "--cells 3: 4 to 4096" "$lamella" rve scene.yaml --realisations 2 --cells 8,3
expect 2 -e "--cells 8;9: numbers of cells" "$lamella" rve scene.yaml --realisations 2 --cells '8;9'
expect 1 -e "a whole number from 2 on" "$lamella" rve scene.yaml --realisations 1
expect 1 -e "--cells is of --realisations" "$lamella" rve scene.yaml --cells 8
expect 1 -e "--onset does not go with --realisations" "$lamella" rve scene.yaml --realisations 2 --onset
expect 4 -e "scene.yaml/no: cannot be made" "$lamella" rve scene.yaml --realisations 2 -o scene.yaml/no
[ ! -e realisations ] || fail "refused, but a folder was made"
