# lamella plot: draws what rve, build and fe2 write, in three formats; refuses what it cannot draw.
. "$(dirname "$0")/common.sh"

# starts FILE BYTES: the file exists and starts with the bytes
starts() {
  [ -s "$1" ] || { fail "$1 was not written"; return; }
  head -c 8 "$1" | grep -qaF -e "$2" || fail "$1 does not start with $2"
}

tissue >scene.yaml <<'SCENE'
load:
  - {ramp: {to: [[1, 0.2], [0, 1]], steps: 3}}
sample: {stretch: {min: 0, max: 0.1}, turgor: {min: 0 MPa, max: 0.02 MPa}, count: 4}
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, 0 mm]}]
  steps: 1
SCENE

expect 0 "$lamella" rve scene.yaml -o rve.h5
expect 0 "$lamella" build scene.yaml -d database.h5
expect 0 "$lamella" fe2 scene.yaml -o fe2.h5
for kind in rve database fe2; do
  expect 0 "$lamella" plot --dpi 40 $kind.h5
  starts $kind.png PNG
done
expect 0 "$lamella" plot --dpi 40 rve.h5 -o rve.svg
starts rve.svg "<?xml"
expect 0 "$lamella" plot --dpi 40 database.h5 --output=database.pdf
starts database.pdf %PDF

expect 0 "$lamella" plot --dpi 40 rve.h5 --state 1 --field fibre_stretch -o first.png
cmp -s first.png rve.png && fail "state 1 and the last state give the same picture"
expect 2 -e "states 1 to 3" "$lamella" plot --dpi 40 rve.h5 --state 9
expect 1 -e '--state "two"' "$lamella" plot --dpi 40 rve.h5 --state two
expect 2 -e "wall_stress" "$lamella" plot --dpi 40 rve.h5 --field colour
expect 2 -e ".png, .svg or .pdf" "$lamella" plot --dpi 40 rve.h5 -o figure.gif
expect 4 -e "no/such/folder.png" "$lamella" plot --dpi 40 rve.h5 -o no/such/folder.png

# slices through the table of a database, at an angle; or its records
expect 0 "$lamella" plot --dpi 40 database.h5 --angle "15 deg" --turgor "0.01 MPa" --accuracy 0.001 -o turned.png
cmp -s turned.png database.png && fail "slices at 0 and at 15 degrees give the same picture"
expect 0 "$lamella" plot --dpi 40 database.h5 --field stress -o records.png
cmp -s records.png database.png && fail "a table and its records give the same picture"
expect 2 -e "--suction 0.01 MPa" "$lamella" plot --dpi 40 database.h5 --suction "0.01 MPa"
expect 1 -e '--accuracy "-1"' "$lamella" plot --dpi 40 database.h5 --accuracy -1
expect 2 -e "--angle 15 deg" "$lamella" plot --dpi 40 rve.h5 --angle "15 deg"

expect 1 "$lamella" plot
"$lamella" plot --dpi 40 absent.h5 >out.txt 2>err.txt && fail "a file that is not there is drawn"
grep -qF absent.h5 err.txt || fail "the message does not name the file that is not there"
echo "not HDF5" >text.h5
"$lamella" plot --dpi 40 text.h5 >out.txt 2>err.txt && fail "a text file is drawn"
[ ! -e text.png ] || fail "a picture of a text file was written"

# the last state, and states side by side
expect 0 "$lamella" plot --dpi 40 rve.h5 --state last -o last.png
expect 0 "$lamella" plot --dpi 40 rve.h5 --strip -o strip.png
expect 0 "$lamella" plot --dpi 40 fe2.h5 --strip -o strip.pdf
expect 2 -e "--strip" "$lamella" plot --dpi 40 database.h5 --strip
