#!/usr/bin/env bash
# Scenes in other units tell the same, and tissue of another size and stiffness the same but for its scales.
. "$(dirname "$0")/common.sh"
/usr/bin/python3 -c 'import json' 2>/dev/null || exit 77

# measured LENGTH STRESS [MODE MORE]: the example's tissue; LENGTH such as "e6 pm", behind numbers of um; STRESS behind MPa
measured() {
  tissue cell="apothem: 75$1, wall_thickness: 11.25$1" turgor="mode: ${3:-prescribed}, pressure: 0.02$2${4:-}" \
    wall="law: fibre_mooney_rivlin, C1: 0.1$2, C2: 0.01$2, C4: 1$2, bulk_modulus: 110$2" mesh='along: 2, through: 1'
}

# write FOLDER LENGTH STRESS: the scenes of all commands
write() {
  mkdir -p "$1"
  measured "$2" "$3" >"$1/rve.yaml" <<YAML
strength: {wall: 0.5$3, lamella_normal: 0.1$3, lamella_shear: 0.05$3}
load:
  - {F: [[1.02, 0.1], [0, 1]]}
  - {F: [[free, 0.1], [0, free]], P: [[0.001$3, x], [x, 0.003$3]], turgor: 0.03$3}
YAML
  measured "$2" "$3" sealed ", water_bulk_modulus: 2200$3" >"$1/sealed.yaml" <<YAML
load:
  - {F: [[free, 0.1], [0, 1.05]], P: [[0.001$3, x], [x, x]]}
YAML
  measured "$2" "$3" >"$1/map.yaml" <<YAML
strength: {wall: 0.25$3, lamella_normal: 0.03$3, lamella_shear: 0.05$3}
load:
  - {ramp: {to: [[1, 0.4], [0, 1]], steps: 2}}
map:
  x: {quantity: shear, from: 0.1, to: 0.4, points: 2}
  y: {quantity: turgor, from: 0$3, to: 0.1$3, points: 2}
YAML
  measured "$2" "$3" >"$1/fe2.yaml" <<YAML
macro:
  mesh: {box: [10000$2, 10000$2], elements: [2, 1]}
  boundary:
    - {on: bottom, displacement: [0$2, 0$2]}
    - {on: top, displacement: [500$2, free]}
    - {on: right, traction: [0.001$3, 0$3]}
  inflate: true
  steps: 1
YAML
}

# answer FOLDER: what the commands tell, in files of one object a line
answer() {
  for name in rve sealed; do
    expect 0 "$lamella" rve "$1/$name.yaml" --json --tangent --failure --quiet
    cp out.txt "$1/$name.json"
  done
  expect 0 "$lamella" map "$1/map.yaml" -o "$1/map.h5" --json --quiet
  cp out.txt "$1/map.json"
  expect 0 "$lamella" fe2 "$1/fe2.yaml" --json --quiet
  cp out.txt "$1/fe2.json"
}

# alike FOLDER SIZE STIFFNESS: the answers are those of `usual`, forces, work and stresses with their scales
alike() {
  /usr/bin/python3 - "$@" <<'PYTHON' || fail "$1 differs from the usual units"
import json, sys
folder, size, stiffness = sys.argv[1], float(sys.argv[2]), float(sys.argv[3])
STRESS = set("""turgor cohesion energy P P_prescribed tangent turgor_mean turgor_spread max_traction max_lamella_shear
    mean_face_traction max_wall_energy max_wall_tension mean_wall_tension ellipticity wall_ellipticity ellipticity_min
    strength measures y""".split())
FORCE, WORK, COMPLIANCE, LENGTH = {"reaction"}, {"work"}, {"energy_turgor2"}, {"localisation_place"}
LEFT_OUT = set("""seconds solve_seconds query_seconds other_seconds peak_memory_mb residuals convergence_order file scene factorisations
    output newton_iterations""".split())  # rounding and time

def factor_of(key, factor):
    if key in LENGTH: return size
    if key in STRESS: return stiffness
    if key in FORCE: return stiffness * size
    if key in WORK: return stiffness * size**2
    if key in COMPLIANCE: return 1 / stiffness
    return factor

def compare(where, a, b, factor, floor):
    if isinstance(a, dict):
        assert a.keys() == b.keys(), where
        for key in a.keys() - LEFT_OUT:
            compare(f"{where}.{key}", a[key], b[key], factor_of(key, factor), floor)
    elif isinstance(a, list):
        assert len(a) == len(b), where
        numbers = [abs(x) for x in a if isinstance(x, float)]
        for k, (x, y) in enumerate(zip(a, b)):
            compare(f"{where}[{k}]", x, y, factor, max(numbers + [floor]))
    elif isinstance(a, float) and isinstance(b, float):
        assert abs(b / factor - a) <= 1e-9 * max(abs(a), floor), f"{where}: {a} and {b} / {factor}"
    else:
        assert a == b, f"{where}: {a} and {b}"

for name in ["rve", "sealed", "map", "fe2"]:
    with open(f"usual/{name}.json") as one, open(f"{folder}/{name}.json") as other:
        pairs = list(zip(one.readlines(), other.readlines(), strict=True))
    for k, (a, b) in enumerate(pairs):
        compare(f"{name} {k + 1}", json.loads(a), json.loads(b), 1, 1e-2)
PYTHON
}

write usual " um" " MPa"
answer usual
write fine "e6 pm" "e12 uPa"
write coarse "e-9 km" "e-6 TPa"
write hard "e6 pm" "e-3 GPa"
for folder in fine coarse hard; do
  answer $folder
  alike $folder 1 1
done
write picometres " pm" " GPa"
answer picometres
alike picometres 1e-6 1e3
write kilometres " km" " uPa"
answer kilometres
alike kilometres 1e9 1e-12
