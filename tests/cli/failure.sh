# lamella rve --failure: what walls and lamella bear, the verdict, and none where nothing allows it.
. "$(dirname "$0")/common.sh"
serve=1

example=$source/tests/scenes/failure.yaml

# verdict NAME: its value in the last line
verdict() { sed -n '$p' out.txt | grep -oE "\"$1\": *[^,}]+" | head -1 | sed 's/.*: *//'; }

# the last object is the verdict; states are told as without it
expect 0 "$lamella" rve "$example" --json
grep -v '"failure"' out.txt | sed 's/"seconds": [^,]*,//' >without.txt
grep -q '"failure"' out.txt && fail "a verdict that nobody asked for"
for name in max_fibre_stretch max_wall_energy max_wall_tension wall_place mean_wall_tension normal_place \
  max_lamella_shear shear_place; do
  grep -q "\"$name\":" out.txt || fail "no member $name"
done
expect 0 "$lamella" rve "$example" --json --failure
sed '$d' out.txt | sed 's/"seconds": [^,]*,//' | cmp -s - without.txt || fail "--failure changes the states"
[ "$(verdict mode)" = '"separation"' ] && [ "$(verdict criterion)" = '"lamella_normal"' ] ||
  fail "not the lamella: $(sed -n '$p' out.txt)"
verdict factor | awk '!($1 > 3.6 && $1 < 3.9) { exit 1 }' || fail "load factor $(verdict factor)"
for name in wall lamella_shear; do
  sed -n '$p' out.txt | grep -qE "\"$name\": \{\"judged\": true, \"factor\": [0-9]" || fail "$name is not reached"
done

# a person gets a line for each state, and the verdict
expect 0 "$lamella" rve "$example" --failure
[ "$(grep -c 'wall .* MPa (.* of its strength) at 0/' out.txt)" -ge 8 ] || fail "no measures: $(cat out.txt)"
grep -q '^failure: separation (lamella_normal) at load factor 3.7' out.txt || fail "no verdict: $(cat out.txt)"

# a stronger lamella lets the walls tear
sed 's/lamella_normal: 0.1 MPa/lamella_normal: 1 MPa/' "$example" >strong.yaml
expect 0 "$lamella" rve strong.yaml --json --failure
[ "$(verdict mode)" = '"rupture"' ] || fail "not the walls: $(sed -n '$p' out.txt)"

# without strengths there are measures and their ratio, and no verdict on what needs them
grep -v '^strength' "$example" >unknown.yaml
expect 0 "$lamella" rve unknown.yaml --json --failure
[ "$(verdict mode)" = '"none"' ] || fail "a verdict without strengths: $(sed -n '$p' out.txt)"
sed -n '$p' out.txt | grep -q '"wall": {"judged": false}' || fail "walls are judged without a strength"
sed -n '$p' out.txt | grep -qE '"wall_over_lamella": \[[0-9]' || fail "no ratio: $(sed -n '$p' out.txt)"

# cells in contact part by themselves, judged on two meshes
sed -e 's/law: bonded/law: contact, cohesion: 0.002 MPa/' -e '/^strength/d' -e 's/along: 6, through: 2/along: 4, through: 1/' \
  -e '/ramp/d' -e 's/\[\[1.02, 0\], \[0, 1.02\]\]/[[1.04, 0], [0, 1]]/' "$example" >contact.yaml
expect 0 "$lamella" rve contact.yaml --json --failure
[ "$(verdict criterion)" = '"contact"' ] || fail "cells do not part: $(sed -n '$p' out.txt)"
sed -n 1p out.txt | grep -q '"separated": true' || fail "contact is judged on one mesh"

# where --onset finds it, too
sed -e 's/  - {F: .*/  - {F: [[1, 0], [0, 1]]}\n  - {F: [[1.04, 0], [0, 1]]}/' contact.yaml >onset.yaml
expect 0 "$lamella" rve onset.yaml --json --failure --onset
onset=$(grep '"onset"' out.txt | grep -oE '"fraction": *[0-9.]+' | sed 's/.*: *//')
verdict factor | awk -v onset="$onset" '{ d = $1 - 1 - onset; if (onset == "" || d > 1e-3 || d < -1e-3) exit 1 }' ||
  fail "--onset says $onset, --failure $(verdict factor)"

# a load without an answer: the states are told, the verdict is unknown, and why
sed -e '/^strength/d' -e '/ramp/d' -e 's/{F: .*/{F: [[0.3, 0], [0, 2]]}/' "$example" >collapsed.yaml
expect 3 "$lamella" rve collapsed.yaml --json --failure
[ "$(verdict mode)" = '"unknown"' ] || fail "a verdict without an answer: $(sed -n '$p' out.txt)"
sed -n '$p' out.txt | grep -q '"reason": "load factor .* has no response: the lumen' || fail "no reason: $(sed -n '$p' out.txt)"
verdict followed | awk '!($1 > 0 && $1 < 1) { exit 1 }' || fail "not followed as far as there are answers"
