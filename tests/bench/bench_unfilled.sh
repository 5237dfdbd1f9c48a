#!/usr/bin/env bash
# Tables of tissue that the fluid does not fill, and of some that it fills: nodes, processor time of the build, and 500
# random queries of each against fresh solves. Prints figures; asserts nothing (docs/results/verification.md).
#   bash tests/bench/bench_unfilled.sh build/lamella . [TISSUE...]
set -eu
lamella=$(realpath "$1")
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

/usr/bin/python3 - "$lamella" <<'PYTHON'
import json, math, subprocess, sys

a = 71.0  # um, apothem
R = 2 * a / math.sqrt(3)
steps = [(2 * a, 0.0), (a, math.sqrt(3) * a)]
hexagon = [(R * math.cos(math.pi / 6 + k * math.pi / 3), R * math.sin(math.pi / 6 + k * math.pi / 3)) for k in range(6)]


def hexagons(name, n, missing, setback):
    """n x n cells less some; walls leave faces at the distance `setback` from the corners, in edges."""
    places = [(i, j) for i in range(n) for j in range(n) if (i, j) not in missing]
    centres = [[i * steps[0][d] + j * steps[1][d] for d in (0, 1)] for i, j in places]
    json.dump({"lamella_tissue": 1, "unit": "um", "period": [[n * x for x in step] for step in steps], "wall_thickness": 11,
               "corner_radius": setback * R * math.sqrt(3),
               "vertices": [[c[0] + x, c[1] + y] for c in centres for x, y in hexagon],
               "cells": [list(range(6 * k, 6 * k + 6)) for k in range(len(places))]}, open(name, "w"))


def irregular(name, cells, gas):
    subprocess.run([sys.argv[1], "tissue", "-o", name, "--cells", str(cells), "--size", "150 um", "--variation", "0.2", "--gas",
                    str(gas), "--wall-thickness", "11 um", "--seed", "3"], check=True, stdout=subprocess.DEVNULL)


hexagons("air-3.json", 1, [], 0.19)
hexagons("air-10.json", 1, [], 0.36)
hexagons("air-25.json", 2, [(0, 0)], 0.1)
hexagons("missing-cell.json", 2, [(0, 0)], 0.0)
irregular("irregular-air.json", 8, 0.03)
irregular("irregular.json", 4, 0)
cell = "cell: {apothem: 75 um, wall_thickness: 11.25 um}"
kinds = cell + "\n  cells: [2, 1]\n  variation: {kinds: [{turgor: %s}], list: [0, 1]}"
uneven = cell + "\n  cells: [3, 3]\n  variation: {field: {wall: 0.2, wall_thickness: 0.1, turgor: 0.3, correlation: 1, seed: 7}}"
contact = "tissue: %s\n  interface: {law: contact, cohesion: 0.01 MPa}"
rows = [(name, f"tissue: {name}.json", 0, 0.2, 0.01) for name in ("air-3", "air-10", "air-25", "missing-cell")]
rows += [("turgor-0-1", kinds % 0, 0, 0.02, 0.01), ("turgor-0.5-1", kinds % 0.5, 0, 0.06, 0.01),
         ("irregular-air", "tissue: irregular-air.json", 0, 0.2, 0.01),
         ("irregular-air-contact", contact % "irregular-air.json", 0.01, 0.04, 0.03),
         ("hexagons", cell, 0, 0.2, 0.01), ("irregular", "tissue: irregular.json", 0, 0.2, 0.01), ("uneven", uneven, 0, 0.04, 0.01),
         ("contact", cell + "\n  interface: {law: contact, cohesion: 0 MPa}", 0.015, 0.04, 0.03)]
for name, what, low, high, accuracy in rows:
    with open(f"{name}.yaml", "w") as out:
        out.write(f"version: 1\nrve:\n  {what}\n"
                  "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n  mesh: {along: 6, through: 2}\n"
                  f"sample: {{stretch: {{min: -0.02, max: 0.2}}, turgor: {{min: {low} MPa, max: {high} MPa}}}}\naccuracy: {accuracy}\n")
print(*(row[0] for row in rows), file=open("names", "w"))
PYTHON
[ $# -gt 0 ] || set -- $(cat names)
printf '%-22s %6s %8s %9s %7s %7s %8s  %s\n' tissue nodes 'build, s' answered beyond holds tangent 'error of P, %: median, 95, 99 %, largest'
for name in "$@"; do
  seconds=$({ TIMEFORMAT='%U %S'; time "$lamella" build $name.yaml -d $name.h5 --json >build.json 2>/dev/null || true; } 2>&1 | awk '{print $1 + $2}')
  "$lamella" verify $name.h5 --samples 500 --json --quiet >verify.json || true
  /usr/bin/python3 - $name $seconds <<'PYTHON'
import json, sys
nodes = json.loads(open("build.json").read().splitlines()[-1])["records"]
found = json.load(open("verify.json"))
share = lambda name: f"{100 * found[name]:.1f} %"
errors = " ".join(f"{100 * found['measured']['P'][q]:.2g}" for q in ("median", "q95", "q99", "max"))
print(f"{sys.argv[1]:22} {nodes:6} {float(sys.argv[2]):8.2f} {share('share_answered'):>9} {share('share_beyond_accuracy'):>7} "
      f"{share('share_estimate_holds'):>7} {share('share_tangent_estimate_holds'):>8}  {errors}", flush=True)
PYTHON
done
