#!/usr/bin/env bash
# -o replaces an older result of the same command, and nothing else; with --overwrite any plain file but an input.
. "$(dirname "$0")/common.sh"
set -e -o pipefail

tissue >s.yaml <<'YAML'
load:
  - {F: [[1, 0.1], [0, 1]]}
sample: {stretch: {min: 0, max: 0.05}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, count: 3}
YAML
cp s.yaml before.yaml

# the scene, a name of another kind, a database, a pipe
expect 1 -e 's.yaml: an HDF5 file is written there; name it s.h5' "$lamella" rve s.yaml -o s.yaml
expect 1 -e 'out.csv: an HDF5 file is written there; name it out.h5' "$lamella" rve s.yaml -o out.csv
cp s.yaml scene
for overwrite in "" --overwrite; do
  expect 2 -e 'scene: is an input of this command' "$lamella" rve scene -o scene $overwrite
done
cmp -s scene before.yaml && cmp -s s.yaml before.yaml && [ ! -e out.csv ] || fail "the scene is destroyed"
"$lamella" build s.yaml -d tissue.db.h5 --quiet >/dev/null
cp tissue.db.h5 before.h5
expect 2 -e 'tissue.db.h5: exists and is of kind "database"' "$lamella" rve s.yaml -o tissue.db.h5
cmp -s tissue.db.h5 before.h5 || fail "the database is destroyed"
mkfifo pipe
expect 2 timeout 60 "$lamella" rve s.yaml -o pipe
[ -p pipe ] || fail "the pipe is replaced"
[ -z "$(find . -name '*.lock' -o -name '*.tmp')" ] || fail "files are left behind: $(ls)"

# a result of its own, also behind a link, and an empty file
mkdir results
expect 0 "$lamella" rve s.yaml -o results/rve.h5
expect 0 "$lamella" rve s.yaml -o results/rve.h5
ln -s results/rve.h5 link.h5
expect 0 "$lamella" rve s.yaml -o link.h5
[ -L link.h5 ] || fail "the link is replaced"
expect 0 "$lamella" info results/rve.h5
: >empty.h5
expect 0 "$lamella" rve s.yaml -o empty.h5

# texts beside it: what was measured, pictures of other programs; refused before anything is solved
printf 'strain, stress (MPa)\n0, 0\n' >measured.csv
cp measured.csv tension.csv
cp measured.csv fem.csv
cp measured.csv time.csv
cp measured.csv law.csv
echo '<?xml version="1.0"?><Xdmf Version="3.0"><Domain/></Xdmf>' >body.xdmf
cp body.xdmf other.xdmf
tissue mesh='along: 1, through: 1' >body.yaml <<'YAML'
macro:
  mesh: {gmsh: body.msh}
  boundary: [{on: base, displacement: [0 mm, 0 mm]}, {on: lid, displacement: [0.1 mm, 0 mm]}]
  steps: 1
process: {duration: 1 d}
YAML
cat >body.msh <<'MSH'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 "base"
1 2 "lid"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 4 0 0
3 4 4 0
4 0 4 0
$EndNodes
$Elements
3
1 1 2 1 1 1 2
2 1 2 2 2 4 3
3 3 2 0 1 1 2 3 4
$EndElements
MSH
grep -v ^process body.yaml >fem.yaml
{ tissue interface='law: lamella, strength: 0.1 MPa, fracture_energy: 1 J/m^2' </dev/null; } >layer.yaml
expect 2 -e 'tension.csv: exists and is not a table of lamella rve' "$lamella" rve s.yaml -o tension.h5
expect 2 -e 'body.xdmf: exists and is not an XDMF file' "$lamella" rve s.yaml -o body.h5
expect 2 -e 'fem.csv: exists and is not a table of lamella fe2' "$lamella" fe2 fem.yaml -o fem.h5
expect 2 -e 'body.xdmf: exists and is not an XDMF file' "$lamella" fe2 fem.yaml -o body.h5
expect 2 -e 'time.csv: exists and is not a table of lamella fe2' "$lamella" process body.yaml -o time.h5
expect 2 -e 'law.csv: exists and is not a table of lamella tear' "$lamella" tear layer.yaml -o law.csv
for file in tension fem time law; do cmp -s measured.csv $file.csv || fail "$file.csv is destroyed"; done
cmp -s other.xdmf body.xdmf || fail "body.xdmf is destroyed"
[ -z "$(find . -name '*.lock' -o -name '*.tmp')" ] && [ ! -e tension.h5 ] && [ ! -e fem.h5 ] || fail "files are left behind: $(ls)"

# what Lamella wrote itself, with other columns, too; --overwrite replaces the rest, but no input
expect 0 "$lamella" rve s.yaml -o tension.h5 --overwrite
expect 0 "$lamella" rve s.yaml -o tension.h5 --readings
expect 0 "$lamella" rve s.yaml -o tension.h5
has tension.csv '^state,status,F11'
expect 0 "$lamella" fe2 fem.yaml -o fem.h5 --overwrite
expect 0 "$lamella" fe2 fem.yaml -o fem.h5
has fem.csv '^step,load_factor'
ln fem.yaml fem2.h5
expect 2 -e 'fem2.h5: is an input of this command' "$lamella" fe2 fem.yaml -o fem2.h5 --overwrite
ln -f body.msh fem3.xdmf
expect 2 -e 'fem3.xdmf: is an input of this command' "$lamella" fe2 fem.yaml -o fem3.h5 --overwrite
expect 4 -e 'none/a.h5: cannot be made: .*make the folder first' "$lamella" fe2 fem.yaml -o none/a.h5

# what Python writes: a tissue, the results of studies; before they begin
/usr/bin/python3 -c 'import scipy, cffi' 2>/dev/null || exit $((failures > 0))
made='tissue --size 150um --wall-thickness 6um --cells 8'
expect 2 -e 's.yaml: exists and is not a tissue' "$lamella" $made -o s.yaml
cmp -s s.yaml before.yaml || fail "the scene is destroyed by a tissue"
expect 0 "$lamella" $made -o law.csv --overwrite
expect 0 "$lamella" $made -o law.csv
{ cat s.yaml; echo 'uncertain: [{key: rve.wall.C1, from: 0.09 MPa, to: 0.11 MPa}]'; } >u.yaml
printf 'figure, value, scatter\nmodulus (MPa), 3.6, 0.4\n' >data.csv
mkdir own
for file in fit uncertainty sensitivity validation; do echo '{"mine": 1}' >own/$file.json; done
cp own/fit.json own/samples.csv
cp own/fit.json own/validation.md
expect 2 -e 'own/fit.json: exists and is not a fit' "$lamella" calibrate u.yaml data.csv -o own
expect 2 -e 'own/uncertainty.json: exists and is not the result of --uncertainty' "$lamella" rve u.yaml --uncertainty 60 -o own
expect 2 -e 'own/sensitivity.json: exists and is not the result' "$lamella" sensitivity u.yaml -o own
expect 2 -e 'own/validation.md: exists and is not the page' "$lamella" validate -o own
for study in "calibrate u.yaml data.csv" "rve u.yaml --uncertainty 60" validate; do
  expect 4 -e "data.csv: cannot be made: File exists" timeout 60 "$lamella" $study -o data.csv
done
grep -q mine own/fit.json own/samples.csv own/validation.md || fail "files of others are destroyed"
cp u.yaml own/fit.json
expect 2 -e 'own/fit.json: is an input of this command' "$lamella" calibrate own/fit.json data.csv -o own --overwrite
