# What a body shows to be a mistake: with file, line, key, value and remedy; and what a table and an interrupt tell.
. "$(dirname "$0")/common.sh"

# body BOUNDARY MORE...: a body of 2 x 2 elements
body() {
  tissue mesh='along: 2, through: 1' <<YAML
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [0 mm, 1 mm]}]
  steps: 1
YAML
  printf '  %s\n' "$@"
}
# told STATUS SCENE WORDS: once, on stderr
told() {
  expect "$1" "$lamella" fe2 "$2" --json --quiet
  [ "$(grep -c -- "^lamella\( fe2\)\?: $2:$3" err.txt)" = 1 ] || fail "$2 does not tell \"$3\": $(cat err.txt)"
}

# regions without a material point
body 'regions: [{name: skin, where: y > 5, cell: {wall_thickness: 20 um}}, {name: far, where: y > 50, cell: {wall_thickness: 30 um}}]' >far.yaml
told 0 far.yaml '12:91: macro.regions\[1\]: far: covers no material point, so its tissue is nowhere; x and y are in mm; write another'
body 'regions: [{name: core, where: y > 5, cell: {wall_thickness: 20 um}}, {name: all, where: 1, cell: {wall_thickness: 30 um}}]' >under.yaml
told 0 under.yaml '12:33: macro.regions\[0\]: core: later regions cover all of it, so its tissue is nowhere; write it behind them'
body 'regions: [{name: far, where: y > 50, cell: {wall_thickness: 30 um}}]' >none.yaml
told 2 none.yaml '12:32: macro.regions: far: no region has a material point of the body; write expressions of x and y in mm'
body 'regions: [{name: skin, where: y > 5, cell: {wall_thickness: 20 um}}]' >right.yaml
expect 0 "$lamella" fe2 right.yaml --json
[ ! -s err.txt ] || fail "warns without need: $(cat err.txt)"

body 'fields: {wall_thickness: {expression: 10 * y - 5, unit: um}}' >thin.yaml
told 2 thin.yaml '12:41: macro.fields.wall_thickness: is [-0-9.]* um at x = [0-9.]* mm, y = [0-9.]* mm; it must lie between 0 and the apothem'

# Gmsh files: the line of the scene, and that of the file
body | sed 's/{box.*/{gmsh: body.msh}/' >gmsh.yaml
told 2 gmsh.yaml '9:16: macro.mesh.gmsh: body.msh: No such file or directory; a relative path counts from the folder of the scene'
printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\nmany\n' >body.msh
told 2 gmsh.yaml '9:16: macro.mesh.gmsh: body.msh: line 5: many is not a whole number from 1 to '
square() { # [ENTITY OF LID]: a square of two triangles, whose lines are `base` and `lid`
  printf '%s\n' '$MeshFormat' '2.2 0 8' '$EndMeshFormat' '$PhysicalNames' 2 '1 1 "base"' '1 2 "lid"' '$EndPhysicalNames' \
    '$Nodes' 4 '1 0 0 0' '2 10 0 0' '3 10 10 0' '4 0 10 0' '$EndNodes' \
    '$Elements' 4 '1 1 2 1 1 1 2' "2 1 2 2 ${1:-2} 3 4" '3 2 2 3 1 1 2 3' '4 2 2 3 1 1 3 4' '$EndElements'
}
square >body.msh
told 2 gmsh.yaml '10:19: macro.boundary: on: bottom: no such boundary of the mesh; there are base, lid'
sed -i 's/on: bottom/on: base/; s/on: top/on: lid/' gmsh.yaml
expect 0 "$lamella" fe2 gmsh.yaml --json
grep -o '"reaction": {[^}]*}' out.txt >same.txt
square 1 >body.msh # the entity of one group has the tag of another
expect 0 "$lamella" fe2 gmsh.yaml --json
grep -o '"reaction": {[^}]*}' out.txt | cmp -s - same.txt || fail "tags of entities are taken for those of groups"
sed -i 's/^3 10 10 0/3 10 10 1/' body.msh
told 2 gmsh.yaml '9:16: macro.mesh.gmsh: body.msh: node 3 lies at X3 = 1; the body is a surface in the plane X3 = 0'
square >body.msh
sed 's/steps: 1/&\n  regions: [{name: skin, cell: {wall_thickness: 20 um}}]/' gmsh.yaml >group.yaml
told 2 group.yaml '12:20: macro.regions: skin: the mesh has no group of elements of this name; write where'
# a group of all elements besides: a triangle is the skin all the same
square | sed '5s/.*/4/; 7s/$/\n2 1 "skin"\n2 7 "all"/; s/^3 2 2 3/3 2 2 1/' >body.msh
expect 0 "$lamella" fe2 group.yaml --json --quiet
grep -o '"reaction": {[^}]*}' out.txt >same.txt
sed -i '19s/.*/5/; s/^3 2 2 1\(.*\)/&\n3 2 2 7\1/; s/^4 2 2 3\(.*\)/4 2 2 7\1/' body.msh
expect 0 "$lamella" fe2 group.yaml --json --quiet
grep -o '"reaction": {[^}]*}' out.txt | cmp -s - same.txt || fail "an element in two groups: $(cat body.msh)"

# plates and indenters that never touch the body
cp "$source/tests/scenes/pressed-disc.yaml" disc.yaml
sed 's/normal: \[0, -1\]/normal: [0, 1]/' disc.yaml >turned.yaml
told 2 turned.yaml '13:12: macro.boundary: on: rim: plate: no part of this side faces it; write its normal from the plate into the body'
sed 's/plate: {displacement.*}}/indenter: {radius: 1 mm, at: [0 mm, 5 mm], displacement: [0 mm, 1 mm]}}/' disc.yaml >leaves.yaml
told 2 leaves.yaml '13:12: macro.boundary: on: rim: indenter: no part of this side faces it; write a displacement into the body'
sed 's/displacement: \[0 mm, -1 mm\]/displacement: [0 mm, 1 mm]/' disc.yaml >away.yaml
told 0 away.yaml '13:12: macro.boundary: on: rim: the plate has not touched the body in any step, and its forces are 0; write'
expect 0 "$lamella" fe2 disc.yaml --json
[ ! -s err.txt ] || fail "warns of a plate that presses: $(cat err.txt)"

# a database of other tissue: the keys that differ, with both values
expect 0 "$lamella" fe2 right.yaml -d part.h5 --json
sed 's/C4: 1 MPa/C4: 2 MPa/; s/through: 1/through: 2/' right.yaml >other.yaml
expect 2 -e '^lamella: part.h5: holds another microstructure than the scene other.yaml: rve.mesh.through is 1, in the scene 2; rve.wall.C4 over C1 + C2 is 9.09091, in the scene 18.1818; give a database built from this scene' \
  "$lamella" fe2 other.yaml -d part.h5
sed 's/thickness: 20 um/thickness: 21 um/' right.yaml >skin.yaml
expect 2 -e '^lamella: part.skin.h5: holds another microstructure than the scene skin.yaml for skin: rve.cell.wall_thickness over apothem is 0.266667, in the scene 0.28; give' \
  "$lamella" fe2 skin.yaml -d part.h5
sed '/^macro/,$d; s/bonded/contact/' right.yaml >grown.yaml
echo 'sample: {stretch: {min: 0, max: 0.1}, count: 7}' >>grown.yaml
expect 2 -e '^lamella: part.h5: holds another microstructure than the scene grown.yaml: rve.interface.law is bonded, in the scene contact; ' \
  "$lamella" build grown.yaml -d part.h5 --resume

expect 2 -e '^lamella: part.skin.h5: holds another microstructure than part.h5: rve.cell.wall_thickness over apothem is 0.266667, in part.h5 0.15; only' \
  "$lamella" merge all.h5 part.h5 part.skin.h5

# sealed cells without a database: which option helps
body | sed 's/mode: prescribed/mode: sealed/' >sealed.yaml
expect 0 -e 'sealed cells are solved at each material point.*; -d DB.h5' "$lamella" fe2 sealed.yaml --json
expect 0 "$lamella" fe2 sealed.yaml --json --response cache
[ ! -s err.txt ] || fail "advises a cache to use one: $(cat err.txt)"

# rounding noise is 0 in the tables
body >stretch.yaml
expect 0 "$lamella" fe2 stretch.yaml
grep -qE '^ +1  1.0000  0.0000e\+00 -[0-9.]+e-0[0-9]  0.0000e\+00 ' out.txt || fail "noise in the table: $(cat out.txt)"
tissue mesh='along: 2, through: 1' interface='law: contact, cohesion: 0.1 MPa' >slack.yaml <<'YAML'
process:
  output: 1 h
  surroundings: [{time: 0 h}, {time: 1 h, turgor: 0 MPa}]
YAML
expect 0 "$lamella" process slack.yaml
grep -qE 'e-1[2-9]' out.txt && fail "noise in the table of a process: $(cat out.txt)"

# an interrupt says how to go on
body | sed 's/steps: 1/steps: 5000/' >long.yaml
# interrupted WORDS OPTIONS: after the first step
interrupted() {
  rm -f long.jsonl
  "$lamella" fe2 long.yaml --json "${@:2}" >long.jsonl 2>err.txt &
  pid=$!
  until [ -s long.jsonl ] || ! kill -0 $pid 2>/dev/null; do sleep 0.05; done
  ends INT 130 $pid
  grep -q "$1" err.txt || fail "the interrupt does not tell \"$1\": $(cat err.txt)"
}
interrupted 'fe2: stopped: the same command with --resume goes on behind the last complete step of long.h5' -o long.h5
interrupted 'fe2: stopped: without -o OUT.h5 no step is kept$'
interrupted 'fe2: stopped: without -o OUT.h5 no step is kept; what was solved is in the database' -d long-db.h5
