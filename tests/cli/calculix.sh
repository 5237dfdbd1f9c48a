# slow: CalculiX with the tissue of integrations/calculix: a patch test, uniform states and history as `lamella` has them, the
# block of docs/reference/calculix.md as `fe2` has it, the same with any number of threads; what it cannot do is refused.
# CCX: a CalculiX with external behaviours, as integrations/calculix/build_ccx.sh makes it.
. "$(dirname "$0")/common.sh"

[ -n "${CCX:-}" ] || { echo "skipped: CCX names no CalculiX with external behaviours (integrations/calculix/build_ccx.sh)"; exit 77; }
library=$(dirname "$lamella")/integrations/calculix
! nm -D "$library/libLAMELLAUMAT.so" | grep -q __asan || { echo "skipped: the sanitizers are not loaded by CalculiX"; exit 77; }
example=$source/integrations/calculix

ccx() { # STATUS JOB: the lines of a message, which CalculiX breaks nowhere, are in out.txt
  expect "$1" env LD_LIBRARY_PATH="$library" "$CCX" "$2"
}

cp "$example/tissue.yaml" "$example/block.inp" .
expect 0 "$lamella" build tissue.yaml -d tissue.h5 --quiet
cat >lamella.yaml <<'YAML'
version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: 11.25 um}
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  interface: {law: lamella, strength: 0.05 MPa, fracture_energy: 0.5 J/m^2}
  mesh: {along: 9, through: 1}
load:
  - {F: [[1, 0], [0, 1]]}
  - {ramp: {to: [[1, 0.02], [0, 1.1]], steps: 5}}
  - {ramp: {to: [[1, 0.01], [0, 1.05]], steps: 5}}
YAML
cat >deck.py <<'PYTHON'
"""A deck of a block of 1 mm whose rim moves by F, one step for each: deck.py MATERIAL CONSTANTS TURGOR INCREMENT F11,F12,F21,F22 ..."""
import sys

material, constants, turgor, increment = sys.argv[1:5]
sets, name = {}, ""
for line in open("mesh.inp"):
    if line.startswith("*"):
        name = line.strip().split("=")[-1] if "SET=" in line else ""
    else:
        sets.setdefault(name, []).append(line.split(","))
nodes = {int(row[0]): (float(row[1]), float(row[2])) for row in sets["ALL"]}
print(f"""*INCLUDE, INPUT=mesh.inp
*MATERIAL, NAME=@LAMELLAUMAT_CALCULIX@{material}
*USER MATERIAL, CONSTANTS={1 + constants.count(",")}
{constants}
*DEPVAR
2
*SOLID SECTION, ELSET=BLOCK, MATERIAL=@LAMELLAUMAT_CALCULIX@{material}
1.
*INITIAL CONDITIONS, TYPE=TEMPERATURE
ALL, 0.""")
for gradient in sys.argv[5:]:
    F = [float(f) for f in gradient.split(",")]
    print(f"*STEP, NLGEOM\n*STATIC, DIRECT\n{increment}, 1.\n*TEMPERATURE\nALL, {turgor}\n*BOUNDARY")
    for node in (int(row[0]) for row in sets["RIM"]):
        x, y = nodes[node]
        print(f"{node}, 1, 1, {(F[0] - 1) * x + F[1] * y:.15g}\n{node}, 2, 2, {F[2] * x + (F[3] - 1) * y:.15g}")
    print("*EL PRINT, ELSET=BLOCK, FREQUENCY=100\nS\n*RESTART, WRITE\n*END STEP")
PYTHON
cat >stress.py <<'PYTHON'
"""The Cauchy stress of all points of the last step is that of a response's P, [MPa]: stress.py JOB.dat F11,F12,F21,F22 <JSON"""
import json
import sys

rows = [line.split() for line in open(sys.argv[1]).read().split("stresses")[-1].splitlines()]
points = [list(map(float, row[2:6])) for row in rows if row and row[0].isdigit()]
F = [float(f) for f in sys.argv[2].split(",")]
P, J = json.loads([line for line in sys.stdin if '"P"' in line][-1])["P"], F[0] * F[3] - F[1] * F[2]
wanted = [(P[0] * F[0] + P[1] * F[1]) / J, (P[3] * F[2] + P[4] * F[3]) / J, P[8] / J, (P[0] * F[2] + P[1] * F[3]) / J]
size = max(map(abs, wanted))
assert len(points) >= 4 and all(abs(s - w) < 2e-6 * size for row in points for s, w in zip(row, wanted)), (points[0], wanted)
PYTHON
mesh() {
  python3 "$example/mesh.py" "$@" | sed '/NSET=WIDTH/,$d' >mesh.inp
}

# patch test, of distorted elements
F=1.08,0.1,-0.02,1.03
mesh 4 1 0.15
python3 deck.py tissue.h5 "1e6, 0.02" 0.02 0.5 $F >patch.inp
ccx 0 patch
expect 0 "$lamella" query tissue.h5 -F $F --turgor "0.02 MPa" --json
python3 stress.py patch.dat $F <out.txt || fail "patch test"

# with one thread and with two: by no more than rounding
OMP_NUM_THREADS=2 ccx 0 patch
has out.txt "Using up to 2 cpu(s) for the stress calculation"
expect 0 "$lamella" query tissue.h5 -F $F --turgor "0.02 MPa" --json
python3 stress.py patch.dat $F <out.txt || fail "patch test with two threads"

# uniform states with a history: what has broken in the first step is broken in the second
mesh 1 1
python3 deck.py lamella.yaml 1e6 0 0.2 1,0.02,0,1.1 1,0.01,0,1.05 >history.inp
OMP_NUM_THREADS=2 ccx 0 history
expect 0 "$lamella" rve lamella.yaml --no-estimate --json
python3 stress.py history.dat 1,0.01,0,1.05 <out.txt || fail "history"

# out of reach: the increment is halved until it is smaller than the least
python3 deck.py tissue.h5 "1e6, 0.02" 0.02 0.5 1.6,0,0,1 | sed 's/, DIRECT//; s/^0.5, 1./&, 0.1/' >reach.inp
ccx 201 reach
has out.txt "INFO from Lamella: the increment is halved: element 1, point 1, F = " "out_of_reach" "increment size smaller than minimum"

# refused: a restart of a scene, an F33 that a database lacks, no NLGEOM, thermal strain, a file that is not there
awk '/^\*STEP/ {step++; if (step == 2) print "*RESTART, READ, STEP=1"} step >= 2' history.inp >again.inp
sed '/^\*STEP/,$!d' history.inp | awk '/^\*STEP/ {step++} step <= 1' | cat <(sed '/^\*STEP/,$d' history.inp) - >first.inp
ccx 0 first
mv first.rout again.rin
ccx 201 again
has out.txt "which is not the last accepted one" "a run cannot be restarted from a file"
refused() { # WORDS EDIT
  sed "$2" patch.inp >refused.inp
  ccx 201 refused
  has out.txt "$1"
}
mesh 4 1
refused "write \*STEP, NLGEOM" 's/, NLGEOM//'
refused "neither \*EXPANSION" 's/^\*DEPVAR/*EXPANSION\n1e-3\n&/'
refused "there is no file TISSU.H5" 's/tissue.h5/tissu.h5/'
refused "0 state variables; write \*DEPVAR" '/^\*DEPVAR/,+1d'
refused "temperature is turgor" '/^\*INITIAL/,+1d; /^\*TEMPERATURE/,+1d'
sed -i 's/CPE8R/CPS8R/' mesh.inp
refused "the database covers 1 alone (plane strain)" ''

# the block of the documents: rows of the table there
cp "$example/mesh.py" .
sed 's/tissue.h5/tissue.yaml/; s/CONSTANTS=2/CONSTANTS=1/; s/^1e6, .*/1e6/' block.inp >solved.inp
for n in 4 8; do
  python3 mesh.py $n 10 >mesh.inp
  sed "s/elements: .8, 8./elements: [$n, $n]/" tissue.yaml >fe2.yaml
  expect 0 "$lamella" fe2 fe2.yaml --response direct --quiet --json
  mv out.txt direct$n.json
  cp tissue.h5 added.h5
  expect 0 "$lamella" fe2 fe2.yaml --response cache -d added.h5 --quiet --json
  mv out.txt cache$n.json
  OMP_NUM_THREADS=2 ccx 0 block
  mv block.dat block$n.dat
done
OMP_NUM_THREADS=2 ccx 0 solved
mv solved.dat solved8.dat
python3 - "$source/docs/reference/calculix.md" <<'PYTHON' || fail "the block"
import json, os, re, sys

def of_calculix(job):
    return [float(f) for f in re.findall(r"total force.*\n\n *(\S+) +(\S+)", open(job).read())[-1]]

def of_fe2(job):
    return [json.loads(line) for line in open(job) if '"reaction"' in line][-1]["reaction"]["top"]

rows = {tuple(cells[:2]): [float(c.strip("% ")) for c in cells[2:]]
        for cells in ([c.strip() for c in line.strip("| \n").split("|")] for line in open(sys.argv[1]) if " x " in line)
        if len(cells) == 6}
for n in (4, 8):
    reference = of_fe2(f"direct{n}.json")
    forces = {"`fe2`, direct": reference, "`fe2`, database": of_fe2(f"cache{n}.json"), "CalculiX, database": of_calculix(f"block{n}.dat")}
    if os.path.exists(f"solved{n}.dat"):
        forces["CalculiX, direct"] = of_calculix(f"solved{n}.dat")
    for name, force in forces.items():
        off = [100 * abs(f / r - 1) for f, r in zip(force, reference)]
        row = rows.pop((f"{n} x {n}", name), [9] * 4)
        assert max(off) < 1, (name, off)
        assert all(abs(r - v) < d for r, v, d in zip(row, force + off, (1e-5, 1e-5, 0.01, 0.01))), (n, name, force, off, row)
assert not rows, rows
PYTHON
