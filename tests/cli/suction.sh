# The cohesion of law `contact` pulls at any gap: a run warns of it once, where cells have come apart and it holds them.
. "$(dirname "$0")/common.sh"

# scene COHESION LOAD...: writes scene.yaml
scene() {
  printf '  - %s\n' "${@:2}" | sed '1i load:' |
    tissue interface="law: contact, cohesion: $1" turgor='pressure: 0.002 MPa' >scene.yaml
}
# warned STATE: one warning in the run of scene.yaml, of that state
warned() {
  expect 0 "$lamella" rve scene.yaml --json --quiet
  [ "$(wc -l <err.txt)" = 1 ] || fail "not one warning: $(cat err.txt out.txt)"
  has err.txt "^lamella rve: scene.yaml: cohesion: 0.001 MPa: still pulls at cells that have come apart (state $1, .*suction.*any gap.*law: lamella, with strength and fracture_energy"
}
silent() {
  expect 0 "$lamella" rve scene.yaml --json --quiet
  [ ! -s err.txt ] || fail "warns: $(cat err.txt out.txt)"
}
# open LEAST: more than that share of the interface is open in the last state
open() {
  sed '$!d' out.txt | grep -oE '"open_fraction": *[-0-9.e+]+' | awk -v least="$1" '!($2 > least) { exit 1 }' ||
    fail "is not open: $(sed '$!d' out.txt)"
}

closed="{F: [[1, 0], [0, 1]]}"

# apart in all directions, and up to twice the distance
scene "0.001 MPa" "$closed" "{F: [[1.05, 0], [0, 1.05]]}" "{F: [[2, 0], [0, 2]]}"
warned 2
sed '$!d' out.txt | grep -qE '"P": \[0\.00(2|199999)[0-9]*, ' || fail "does not pull with g F22: $(sed '$!d' out.txt)"

# drawn out with free sides: rows of cells that still touch, with nothing but suction between them
scene "0.001 MPa" "$closed" "{ramp: {to: [[free, 0], [0, 1.2]], P: [[0 MPa, x], [x, x]], steps: 4}}"
warned 3

# cells that differ: the suction of the gaps that are open
scene "0.001 MPa" "$closed" "{F: [[1, 0], [0, 1.2]]}"
sed -i 's/^rve:/&\n  cells: [2, 1]\n  variation: {kinds: [{cohesion: 0.2}], list: [0, 1]}/' scene.yaml
warned 2

# closed; parted by less than counts as open; apart without cohesion; sheared, where most of the interface is open and
# cells hook into each other
scene "0.001 MPa" "$closed" "{F: [[1, 0.02], [0, 0.99]]}"
silent
scene "0.000001 MPa" "$closed" "{F: [[1.0003, 0], [0, 1.0003]], turgor: 0 MPa}"
silent
sed '$!d' out.txt | grep -qE '"debonded_fraction": (1|0\.8)' || fail "has not parted: $(sed '$!d' out.txt)"
scene "0 MPa" "$closed" "{F: [[1.05, 0], [0, 1.05]]}"
silent
open 0.9
scene "0.001 MPa" "$closed" "{ramp: {to: [[1, 0.2], [0, 1.02]], steps: 3}, turgor: 0 MPa}"
silent
open 0.5
