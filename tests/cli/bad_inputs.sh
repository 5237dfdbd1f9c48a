# Inputs that are wrong, as a newcomer makes them: the exit status that stands here, and one message that says what is
# wrong, where, and what would be right; what is accepted and probably a mistake is warned of. All mistakes of scenes are
# in tests/scenes/bad.txt (test_scene_bad); here are the usual ones of all commands, and that the words arrive. Most are
# tried in one process.
. "$(dirname "$0")/common.sh"
count=0 program=served

# bad STATUS WORDS COMMAND...: that exit status, the words (of grep) once on stderr, nothing on stdout
bad() {
  expect "$1" $program "${@:3}"
  [ "$(grep -c "^lamella\( [a-z0-9]*\)\?: \(.*: \)\?$2" err.txt)" = 1 ] || fail "not once \"$2\" from: ${*:3}: $(cat err.txt)"
  [ -s out.txt ] && fail "writes to stdout: ${*:3}: $(cat out.txt)"
  count=$((count + 1))
}
# edited SCENE EDIT: bad.yaml is the scene with this edit (of sed)
edited() {
  sed "$2" "$1.yaml" >bad.yaml
  cmp -s bad.yaml "$1.yaml" && fail "changes nothing: $2"
}
# wrong SCENE EDIT WORDS: `check` refuses it with one line
wrong() {
  edited "$1" "$2"
  bad 2 "bad.yaml:$3" check bad.yaml
  [ "$(wc -l <err.txt)" = 1 ] || fail "more than one line: $2: $(cat err.txt)"
}
# warned SCENE EDIT WORDS: `check` warns of it
warned() {
  edited "$1" "$2"
  expect 0 -o "^warning  *bad.yaml:$3" served check bad.yaml
  count=$((count + 1))
}

tissue mesh='along: 2, through: 1' >rve.yaml <<'YAML'
load:
  - {F: [[1, 0.1], [0, 1]]}
  - {ramp: {to: [[1, 0.2], [0, 1]], steps: 2}}
YAML
tissue mesh='along: 2, through: 1' >fe2.yaml <<'YAML'
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary:
    - {on: bottom, displacement: [0 mm, 0 mm]}
    - {on: top, displacement: [0 mm, 1 mm]}
  steps: 1
YAML
tissue mesh='along: 2, through: 1' >process.yaml <<'YAML'
process:
  duration: 2 h
  output: 1 h
  water: {permeability: 1e-7 m/s/MPa}
  surroundings: [{time: 0 h, outside: 0.4 MPa}]
  kinetics: [{of: walls, law: table, time_unit: h, table: [[0, 1], [2, 0.9]]}]
  program: [{for: 1 h}]
YAML
tissue mesh='along: 2, through: 1' >map.yaml <<'YAML'
load: [{ramp: {to: [[1, 0.2], [0, 1]], steps: 2}}]
strength: {wall: 1 MPa}
map:
  x: {quantity: turgor, from: 0 MPa, to: 0.1 MPa, points: 2}
  y: {quantity: shear, from: 0, to: 0.1, points: 2}
YAML
tissue mesh='along: 2, through: 1' >build.yaml <<'YAML'
sample: {stretch: {min: 0, max: 0.05}, count: 7}
YAML
sed '$a\  regions: [{name: skin, where: y > 5, cell: {wall_thickness: 20 um}}]' fe2.yaml >skin.yaml
sed '$a\  fields: {turgor: {table: turgor.csv, unit: MPa}}' fe2.yaml >field.yaml
for name in rve fe2 process map build skin; do
  expect 0 served check $name.yaml --json
  grep -q '"warnings": \[\]' out.txt || fail "$name.yaml is not right: $(cat out.txt)"
done

# quantities
wrong rve 's/75 um/75/' '3:19: rve.cell.apothem: 75: has no unit; write .* such as 75 um'
wrong rve 's/75 um/75 MPa/' '3:19: rve.cell.apothem: 75 MPa: "MPa" is not a unit of length; write'
wrong rve 's/0.1 MPa/0.1 Mpa/' '4:40: rve.wall.C1: 0.1 Mpa: the unit "Mpa" is unknown (did you mean MPa?); write'
wrong rve 's/11.25 um/11,25 um/' '3:42: rve.cell.wall_thickness: 11: has a decimal comma, and the decimal sign is the point; write .* 11.25 um'
wrong rve 's/11.25 um/1125 um/' '3:42: rve.cell.wall_thickness: 1125 um: the wall fills the cell; write a thickness less than the apothem (75 um)'
wrong rve 's/11.25 um/-11.25 um/' '3:42: rve.cell.wall_thickness: -11.25 um: is out of range; write'
wrong rve 's/through: 1/&.5/' '7:29: rve.mesh.through: 1.5: is not a whole number; write'
wrong rve '$a accuracy: 1 %' '11:11: accuracy: 1 %: is not a plain number; write .* such as 0.01'
wrong rve '$a accuracy: 1' '11:11: accuracy: 1: is out of range; write .* at most 0.5'
wrong rve 's/0.1\], \[0, 1\]\]}$/.nan], [0, 1]]}/' '9:14: load\[0\].F\[0\]\[1\]: .nan: is not a finite number'
# keys and names
wrong rve 's/apothem/apotem/' '3:10: rve.cell.apotem: unknown key; did you mean apothem? known here'
wrong rve 's/^load/loads/' '8:1: loads: unknown key; did you mean load? known here'
wrong rve 's/C4: 1 MPa/C2: 1 MPa/' '4:63: rve.wall.C2: given twice, first in line 4; give it once'
wrong rve 's/, C4: 1 MPa//' '4:3: rve.wall.C4: missing; write the fibre modulus, such as 1 MPa, or law'
wrong rve 's/fibre_mooney_rivlin/neo_hooke/' '4:15: rve.wall.law: neo_hooke: is none of the names known here; write fibre_mooney'
wrong rve 's/law: bonded/&, cohesion: 0.1 MPa/' '5:38: rve.interface.cohesion: 0.1 MPa: contradicts law: bonded'
wrong rve 's/prescribed, pressure: 0.02 MPa/sealed/' '6:3: rve.turgor.pressure: missing; write'
wrong rve 's/version: 1/version: 2/' '1:10: version: 2: is out of range; write 1'
wrong rve '/version/d' '1:1: version: missing; write 1'
# YAML
wrong rve 's/^  - {F/\t- {F/' '9:1: not YAML: tab .*; check brackets, quotes and indentation in this line and above'
wrong rve 's/through: 1}/through: 1/' '8:5: not YAML: missing comma .* in this line and above'
wrong rve 's/\[\[1, 0.1\]/[[1, "0.1]/' '9:14: not YAML: '
# loads
wrong rve 's/\[\[1, 0.1\], \[0, 1\]\]/[1, 0.1, 0, 1]/' '9:9: load\[0\].F: \[1, 0.1, 0, 1\]: is no square tensor; write'
wrong rve 's/\[\[1, 0.1\], \[0, 1\]\]/[[1, 0.1], [0, -1]]/' '9:9: load\[0\].F: .*: F11 F22 - F12 F21 = -1; a deformation gradient has a positive'
wrong rve 's/\[\[1, 0.1\]/[[free, 0.1]/' '9:11: load\[0\].F\[0\]\[0\]: free: P11 is not given; write it into P'
wrong rve 's/, steps: 2//' '10:6: load\[1\].ramp.steps: missing; write'
wrong rve 's/F: \[\[1, 0.1\], \[0, 1\]\]/inflate: yes/' '9:15: load\[0\].inflate: yes: is not a truth value; write true or false'
wrong rve 's/F: \[\[1, 0.1\], \[0, 1\]\]/inflate: true, reference: inflate/' '9:32: load\[0\].reference: inflate: is none of the names known here; write rest or inflated'
wrong map 's/to: 0.1 MPa/to: -1 MPa/' '11:42: map.x.to: -1 MPa: is not larger than from (0 MPa in line 11); exchange them'
wrong map 's/to: 0.1, points/to: 0.5, points/' '12:37: map.y.to: 0.5: the load ends with F12 = 0.2; write at most that'
wrong build 's/min: 0/min: 0.1/' '8:25: sample.stretch.min: 0.1: min is larger than max (0.05 in line 8); exchange them'
# bodies
wrong fe2 's/on: top/on: upper/' '12:12: macro.boundary\[1\].on: upper: is none of the names known here; write one of left, right, bottom, top'
wrong fe2 's/box: \[10 mm, 10 mm\]/box: [10 mm]/' '9:15: macro.mesh.box: \[10 mm\]: has 1 entry; write a list of 2'
wrong fe2 's/, elements: \[2, 2\]//' '9:3: macro.mesh.elements: missing; write two numbers'
wrong fe2 's/\[0 mm, 1 mm\]/[0, 1]/' '12:32: macro.boundary\[1\].displacement\[0\]: 0: has no unit; write'
wrong fe2 's/on: bottom/on: top/' '12:12: macro.boundary\[1\].on: top: its displacement along X1 is prescribed already, in line 11; leave'
wrong skin 's/y > 5/z > 5/' '14:33: macro.regions\[0\].where: z > 5: is no expression of x and y: .*; write one, in mm'
wrong skin 's/name: skin/name: the skin/' '14:20: macro.regions\[0\].name: the skin: is part of a file.s name; write letters'
wrong field 's/unit/united/' '14:40: macro.fields.turgor.united: unknown key; did you mean unit?'
wrong field 's/turgor.csv/none.csv/' '14:28: macro.fields.turgor.table: none.csv: cannot be opened: .*; a relative path counts from the folder'
printf 'x;y;p\n0;0;0,1\n' >turgor.csv
wrong field 's/steps: 1/steps: 2/' '14:28: macro.fields.turgor.table: turgor.csv: line 2 is not three numbers .*; separate them by commas'
# processes
wrong process 's/law: table/law: tabel/' '13:31: process.kinetics\[0\].law: tabel: is none of the names known here; write'
wrong process 's/, time_unit: h//' '13:14: process.kinetics\[0\].time_unit: missing; law: table needs it, such as day'
wrong process 's/\[2, 0.9\]/[0, 0.9]/' '13:68: process.kinetics\[0\].table\[1\]: \[0, 0.9\]: its time is not later .*; order them'
wrong process 's/of: walls/of: lamella/' '13:19: process.kinetics\[0\].of: lamella: bonded cells have no cohesion'
wrong process 's/time: 0 h/time: 0/' '12:25: process.surroundings\[0\].time: 0: has no unit; write'
wrong process 's/for: 1 h/&, load: 1/' '14:24: process.program\[0\].load: is the load parameter of a body, but there is no block macro; write F and P'
wrong process 's/outside: 0.4 MPa/&, turgor: 0.1 MPa/' '12:48: process.surroundings\[0\].turgor: contradicts process.water'
# accepted, and probably a mistake
warned process 's/for: 1 h/for: 3 h/' '9:13: process.duration: 2 h: process.program takes 3 h, of which the last 1 h are cut off; write 3 h'
warned process 's/0.4 MPa}/&, {time: 5 h}/' '12:56: process.surroundings\[1\].time: 5 h: is never reached: .*; write 5 h there'
warned process 's/\[2, 0.9\]/[1, 0.9]/' '13:68: process.kinetics\[0\].table\[1\]: \[1, 0.9\]: the table ends at 1 h, the process at 2 h: .*; write'
warned process 's/\[2, 0.9\]/&, [9, 0]/' '13:78: process.kinetics\[0\].table\[2\]: \[9, 0\]: is never reached: .*; write'
warned process '/water:/s/MPa}/MPa, osmotic_pressure: 0.8 MPa}/' '11:57: process.water.osmotic_pressure: 0.8 MPa: .* rises by up to 0.38 MPa; leave it out, or write 0.42 MPa'
warned process '/water:/s/MPa}/MPa, osmotic_pressure: 0.42 MPa}/; $a macro: {mesh: {box: [1 mm, 1 mm], elements: [1, 1]}, boundary: [{on: top, displacement: [0 mm, 0 mm]}], regions: [{name: skin, where: 1, turgor: {pressure: 0.1 MPa}}]}' \
  '11:57: process.water.osmotic_pressure: 0.42 MPa: .* that of region skin is 0.1 MPa: .*; leave it out'
warned rve 's/pressure: 0.02/pressure: 20000/' '6:40: rve.turgor.pressure: 20000 MPa: is more than the walls hold, .*; check its unit'
warned skin 's/wall_thickness: 20 um/apothem: 75 um}, turgor: {pressure: 0.4 MPa/' '14:33: macro.regions\[0\]: skin: turgor: 0.4 MPa: stretches the walls .*; check its unit'
warned map 's/to: 0.1 MPa/to: 0.4 MPa/' ' map: turgor: 0.4 MPa: stretches the walls'

# what only a command can see: blocks, bodies, Gmsh files
bad 2 'fe2.yaml: has no block `load`, which says' rve fe2.yaml -o out.h5
bad 2 'rve.yaml: has no block `sample`, which says' build rve.yaml -d out.h5
warned build 's/law: bonded/law: lamella, strength: 0.05 MPa, fracture_energy: 1 J\/m^2/' '[0-9]*:1: sample: lamella build will refuse law: lamella'
bad 2 'bad.yaml: rve.interface.law: lamella: its responses depend on history, which a table does not have; write' build bad.yaml -d out.h5
edited fe2 's/law: bonded/law: lamella, strength: 0.05 MPa, fracture_energy: 1 J\/m^2/'
bad 2 'bad.yaml: rve.interface.law: lamella: .*; write law: bonded or contact' fe2 bad.yaml --response database -d db.h5
sed 's/^macro:/strength: {wall: 1 MPa, wall_fracture_energy: 5 J\/m^2}\n&/' bad.yaml >tearing.yaml
bad 2 'tearing.yaml: strength.wall_fracture_energy: models of material points do not know cells that burst; choose' fe2 tearing.yaml --response cache
bad 2 'rve.yaml: has no block `macro`, which describes' fe2 rve.yaml -o out.h5
bad 2 'rve.yaml: has no block `process`, which says' process rve.yaml -o out.h5
bad 2 'rve.yaml: has no block `map`, which says' map rve.yaml -o out.h5
edited fe2 's/\[0 mm, /[free, /'
bad 2 'bad.yaml:10:3: macro.boundary: the body can still move along X1; give' fe2 bad.yaml -o out.h5
edited skin 's/y > 5/y > 50/'
bad 2 'bad.yaml:14:33: macro.regions: skin: no region has a material point of the body; write' fe2 bad.yaml -o out.h5
edited fe2 's/{box.*/{gmsh: none.msh}/'
bad 2 'bad.yaml:9:16: macro.mesh.gmsh: none.msh: No such file or directory; a relative path' fe2 bad.yaml
edited fe2 's/{box.*/{gmsh: bad.msh}/'
echo junk >bad.msh
bad 2 'bad.yaml:9:16: macro.mesh.gmsh: bad.msh: is no Gmsh mesh: it does not begin' fe2 bad.yaml
printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\nmany\n' >bad.msh
bad 2 'bad.yaml:9:16: macro.mesh.gmsh: bad.msh: line 5: many is not a whole number from 1 to ' fe2 bad.yaml
[ -z "$(ls out.h5* 2>/dev/null)" ] || fail "a wrong input leaves $(ls out.h5*)"

# files
expect 0 "$lamella" build build.yaml -d db.h5 --json
expect 0 "$lamella" fe2 fe2.yaml -d body.h5 -o steps.h5 --json
: >empty.yaml
bad 2 'rve.yml: the scene cannot be opened: No such file' rve rve.yml
bad 2 'db.h5: is an HDF5 file, no scene; `lamella info` says' check db.h5
bad 2 'empty.yaml:1:1: the file holds no scene; a scene starts with version: 1' check empty.yaml
bad 2 'rve.yaml: is not an HDF5 file; a file written by lamella' info rve.yaml
bad 2 'fig.jpg: a picture.s name must end in .png, .svg or .pdf' plot db.h5 -o fig.jpg
bad 1 '-o rve.yaml: an HDF5 file is written there; name it rve.h5' rve rve.yaml --json -o rve.yaml
bad 2 'db.h5: exists and is of kind "database"' rve rve.yaml --json -o db.h5
bad 4 'none/out.h5: cannot be made: No such file or directory; make the folder first' rve rve.yaml --json -o none/out.h5
bad 2 'db.h5: exists; give --resume to go on with it, or remove it' build build.yaml -d db.h5
bad 2 '--state 9: steps.h5 holds' plot steps.h5 --state 9
bad 2 'steps.h5: is of kind "fe2"; only databases are merged' merge all.h5 steps.h5 db.h5
edited fe2 's/C4: 1 MPa/C4: 2 MPa/; s/through: 1/through: 2/'
bad 2 'body.h5: holds another microstructure than the scene bad.yaml: rve.mesh.through is 1, in the scene 2; rve.wall.C4 over C1 + C2 is 9.09091, in the scene 18.1818; give' fe2 bad.yaml -d body.h5

# the command line
bad 1 "command 'rvee' is unknown; did you mean 'rve'?" rvee rve.yaml
bad 1 "option '--jsn' is unknown or ambiguous; did you mean '--json'?" rve rve.yaml --jsn
bad 1 'a file name is missing' rve
bad 1 'the output is missing; give -o OUT.h5' map map.yaml
bad 1 '--at 5%: give at most 16 strains, such as --at 0.01,0.05' rve rve.yaml --at 5%
bad 1 '--response fast: unknown; there are direct, cache, database' fe2 fe2.yaml --response fast
bad 1 '--response database needs a database; give -d DB.h5' fe2 fe2.yaml --response database
bad 1 '--resume goes on with the results of a run; give -o OUT.h5' fe2 fe2.yaml --resume
bad 1 '--shard 3/2: which part of how many is wanted, such as 1/4' build build.yaml -d new.h5 --shard 3/2
bad 1 '-F "1 0 0": 3 numbers; 4 or 9 numbers are wanted' query db.h5 -F '1 0 0'
bad 1 '-F "1,05 0 0 1": 5 numbers (the decimal sign is the point); 4 or 9' query db.h5 -F '1,05 0 0 1'
bad 1 '-p "0.02": a stress with its unit is wanted, such as "0.02 MPa"' query db.h5 -F '1 0 0 1' -p 0.02

# a process of its own says the same
edited rve 's/75 um/75/'
program=$lamella
bad 2 'bad.yaml:3:19: rve.cell.apothem: 75: has no unit' check bad.yaml
bad 1 'a file name is missing' rve

# sealed bodies without a database: solved, with a note; rounding noise: 0 in the table
edited fe2 's/mode: prescribed/mode: sealed/'
expect 0 -e '^lamella fe2: sealed cells are solved at each material point.*; -d DB.h5' "$lamella" fe2 bad.yaml --json
expect 0 "$lamella" fe2 fe2.yaml
grep -qE '^ +1  1.0000  0.0000e\+00 ' out.txt || fail "noise in the table: $(cat out.txt)"
count=$((count + 2))
# interrupted SCENE EDIT WORDS COMMAND [OPTION...]: how to go on
interrupted() {
  edited "$1" "$2"
  rm -f long.*
  "$lamella" "$4" bad.yaml --json "${@:5}" >long.jsonl 2>err.txt &
  pid=$!
  until [ -s long.jsonl ] || ! kill -0 $pid 2>/dev/null; do sleep 0.05; done
  ends INT 130 $pid
  grep -q "^lamella $4: stopped: $3" err.txt || fail "the interrupt of $4 does not say \"$3\": $(cat err.txt)"
  count=$((count + 1))
}
interrupted fe2 's/steps: 1/steps: 5000/' 'the same command with --resume goes on behind the last complete step of long.h5' fe2 -o long.h5
interrupted map 's/points: 2/points: 500/g' 'the same command with --resume goes on with long.h5' map -o long.h5
interrupted rve 's/steps: 2/steps: 10000/' 'long.h5 has what came before; the same command begins anew' rve -o long.h5
interrupted process 's/output: 1 h/output: 0.01 s/' 'without -o OUT.h5 nothing is kept' process

[ $count -ge 97 ] || fail "$count bad inputs"
