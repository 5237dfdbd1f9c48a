# slow: CalculiX with solids in three dimensions, of tissue that is solved: any uniform F, on distorted elements, and uniaxial
# stress across the cells and along them, as `lamella rve` has them; a database is refused where a shear leaves the plane.
# CCX: a CalculiX with external behaviours, as integrations/calculix/build_ccx.sh makes it.
. "$(dirname "$0")/common.sh"

[ -n "${CCX:-}" ] || { echo "skipped: CCX names no CalculiX with external behaviours (integrations/calculix/build_ccx.sh)"; exit 77; }
library=$(dirname "$lamella")/integrations/calculix
! nm -D "$library/libLAMELLAUMAT.so" | grep -q __asan || { echo "skipped: the sanitizers are not loaded by CalculiX"; exit 77; }

ccx() { # STATUS JOB
  expect "$1" env LD_LIBRARY_PATH="$library" "$CCX" "$2"
}

sed '/^sample/,$d' "$source/integrations/calculix/tissue.yaml" >tissue.yaml
cat >deck.py <<'PYTHON'
"""A cube of 1 mm of 2 x 2 x 2 distorted C3D8: deck.py MATERIAL CONSTANTS TURGOR then F, nine numbers, for the whole rim,
or `along AXIS STRETCH`, which pulls one side and leaves the others free."""
import sys

material, constants, turgor, *motion = sys.argv[1:]
places = [(i, j, k) for k in range(3) for j in range(3) for i in range(3)]
number = {place: 1 + n for n, place in enumerate(places)}
moved = {(1, 1, 1): (0.08, -0.06, 0.05)}
X = {place: [p / 2 + d for p, d in zip(place, moved.get(place, (0, 0, 0)))] for place in places}
corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
print("*NODE, NSET=ALL")
for place in places:
    print(number[place], *X[place], sep=", ")
print("*ELEMENT, TYPE=C3D8, ELSET=CUBE")
for e in range(8):
    base = (e % 2, e // 2 % 2, e // 4)
    print(e + 1, *(number[tuple(b + c for b, c in zip(base, corner))] for corner in corners), sep=", ")
print(f"""*MATERIAL, NAME=@LAMELLAUMAT_CALCULIX@{material}
*USER MATERIAL, CONSTANTS={1 + constants.count(",")}
{constants}
*DEPVAR
2
*SOLID SECTION, ELSET=CUBE, MATERIAL=@LAMELLAUMAT_CALCULIX@{material}
*INITIAL CONDITIONS, TYPE=TEMPERATURE
ALL, 0.
*STEP, NLGEOM, INC=50
*STATIC, DIRECT
0.2, 1.
*TEMPERATURE
ALL, {turgor}
*BOUNDARY""")
if motion[0] == "along":
    axis, stretch = int(motion[1]), float(motion[2])
    for place in places:
        for a in range(3):
            if place[a] == 0:
                print(f"{number[place]}, {a + 1}, {a + 1}")
        if place[axis - 1] == 2:
            print(f"{number[place]}, {axis}, {axis}, {stretch - 1}")
else:
    F = [float(f) for f in motion]
    for place in places:
        if place == (1, 1, 1):
            continue
        for a in range(3):
            print(f"{number[place]}, {a + 1}, {a + 1}, {sum(F[3 * a + b] * X[place][b] for b in range(3)) - X[place][a]:.15g}")
print("*EL PRINT, ELSET=CUBE, FREQUENCY=100\nS\n*NODE PRINT, NSET=ALL, FREQUENCY=100\nU\n*END STEP")
PYTHON
cat >same.py <<'PYTHON'
"""Stress of all points, and displacement of the far corner, of JOB.dat are those of the last response in the JSON that follows."""
import json
import sys

text = open(sys.argv[1]).read()
rows = [line.split() for line in text.split("stresses")[-1].split("displacements")[0].splitlines()]
points = [list(map(float, row[2:8])) for row in rows if row and row[0].isdigit()]
corner = [list(map(float, line.split()[1:])) for line in text.split("displacements")[-1].splitlines() if line.split()[:1] == ["27"]][0]
response = [json.loads(line) for line in open(sys.argv[2]) if '"P"' in line][-1]
F, P = response["F"], response["P"]
rows = lambda a: [a[:3], a[3:6], a[6:]]
F, P = (a if isinstance(a[0], list) else rows(a) for a in (F, P))
J = sum(F[0][i] * (F[1][(i + 1) % 3] * F[2][(i + 2) % 3] - F[1][(i + 2) % 3] * F[2][(i + 1) % 3]) for i in range(3))
sigma = [sum(P[i][k] * F[j][k] for k in range(3)) / J for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
size = max(map(abs, sigma))
assert len(points) == 64 and all(abs(s - w) < 5e-6 * size for point in points for s, w in zip(point, sigma)), (points[0], sigma)
assert all(abs(corner[i] - (sum(F[i]) - 1)) < 1e-5 for i in range(3)), (corner, F)
print(f"{len(points)} points, stress {max(abs(s - w) for point in points for s, w in zip(point, sigma)) / size:.1e}")
PYTHON
rve() { # LOAD
  { cat tissue.yaml; printf 'load:\n  - %s\n' "$1"; } >load.yaml
  expect 0 "$lamella" rve load.yaml --no-estimate --json
  mv out.txt rve.json
}

# shear along the cells and across them, with the stretch of both
python3 deck.py tissue.yaml 1e6 0.02 1.03 0.06 0.05 0.02 0.98 -0.04 0.03 0.01 1.04 >shear.inp
ccx 0 shear
rve '{F: [[1.03, 0.06, 0.05], [0.02, 0.98, -0.04], [0.03, 0.01, 1.04]]}'
python3 same.py shear.dat rve.json || fail "shear in space"

# uniaxial stress: the other two stretches are those of the tissue
python3 deck.py tissue.yaml 1e6 0.02 along 1 1.06 >across.inp
ccx 0 across
rve '{F: [[1.06, 0, 0], [0, free, 0], [0, 0, free]], P: [[x, x, x], [x, 0 MPa, x], [x, x, 0 MPa]]}'
python3 same.py across.dat rve.json || fail "uniaxial stress across the cells"
python3 deck.py tissue.yaml 1e6 0.02 along 3 1.06 >lengthwise.inp
ccx 0 lengthwise
rve '{F: [[free, 0, 0], [0, free, 0], [0, 0, 1.06]], P: [[0 MPa, x, x], [x, 0 MPa, x], [x, x, x]]}'
python3 same.py lengthwise.dat rve.json || fail "uniaxial stress along the cells"

# a database with F33 serves a solid whose iterations leave small out-of-plane shears, from tissue under turgor on
printf 'sample: {stretch: {min: -0.01, max: 0.12}, F33: {min: 0.98, max: 1.12}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, accuracy: 0.005}\n' |
  cat tissue.yaml - >sample.yaml
expect 0 "$lamella" build sample.yaml -d served.h5 --quiet
python3 deck.py served.h5 "1e6, 0.5" 0.02 along 3 1.06 | sed 's/^ALL, 0\.$/ALL, 0.02/' >served.inp
ccx 0 served
sed 's/5e-6 \* size/1e-3 * size/; s/< 1e-5/< 1e-3/' same.py >roughly.py
python3 roughly.py served.dat rve.json || fail "uniaxial stress along the cells, of a database"

# a database answers no such shear, and the run ends with it
printf 'sample: {stretch: {min: 0, max: 0.02}, turgor: {min: 0 MPa, max: 0.02 MPa}, count: 20}\n' | cat tissue.yaml - >sample.yaml
expect 0 "$lamella" build sample.yaml -d tissue.h5 --quiet
sed 's/@TISSUE.YAML/@TISSUE.H5/; s/@tissue.yaml/@tissue.h5/; s/CONSTANTS=1/CONSTANTS=2/; s/^1e6$/1e6, 0.5/' shear.inp >database.inp
ccx 201 database
has out.txt "out-of-plane shear of 0.0[0-9]*; the database answers up to 0.0001"
