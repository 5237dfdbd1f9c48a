# The example scenes that the documentation cites: each is read and described, and those that no other test solves do
# what their first line says.
. "$(dirname "$0")/common.sh"

scenes=$source/tests/scenes

for scene in "$scenes"/*.yaml; do
  expect 0 "$lamella" check "$scene" --json
  grep -rq "tests/scenes/$(basename "$scene")" "$source/docs" || fail "no document cites $(basename "$scene")"
done

# number NAME: its value in the last line
number() { sed -n '$p' out.txt | grep -oE "\"$1\": *[-0-9.e+]+" | sed 's/.*: *//'; }

expect 0 "$lamella" rve "$scenes/uneven-cells.yaml" --json

# 3 x 3 of the cells: empty ones come apart, those under turgor stay together
small() { sed -e 's/columns: 6, rows: 6/columns: 3, rows: 3/' -e 's/0.3\], \[0, 1\]\], steps: 10/0.1], [0, 1]], steps: 2/' "$1"; }
small "$scenes/hexagons-dry.yaml" >dry.yaml
expect 0 "$lamella" rve dry.yaml --json
[ "$(wc -l <out.txt)" -eq 2 ] || fail "not two states: $(cat out.txt)"
number open_fraction | awk '!($1 > 0.5) { exit 1 }' || fail "empty cells stay together: $(number open_fraction) open"
small "$scenes/hexagons-turgid.yaml" >turgid.yaml
expect 0 "$lamella" rve turgid.yaml --json
number open_fraction | awk '!($1 < 0.05) { exit 1 }' || fail "turgid cells part: $(number open_fraction) open"

# thin walls: the branch ends, and the cells go on with other neighbours
expect 0 "$lamella" rve "$scenes/thin-snap.yaml" --no-estimate --json
[ "$(grep -c '"status": *"converged"' out.txt)" -eq 12 ] || fail "not twelve states: $(cat out.txt)"
grep -q '"jumped": *true' out.txt || fail "no branch ends: $(cat out.txt)"
number third_fraction | awk '!($1 > 0.02) { exit 1 }' || fail "no third cell is met: $(number third_fraction)"

# maps: from separation to rupture as turgor rises at given strain; both modes under given stress and in contact
expect 0 "$lamella" map "$scenes/map-shear-turgor.yaml" -o shear.h5
grep -qE '^ +0 .* S$' out.txt || fail "flaccid cells do not separate: $(cat out.txt)"
grep -qE '^ +0\.1 .* R$' out.txt || fail "turgid cells do not tear: $(cat out.txt)"
for map in map-stress map-turgor-cohesion; do
  expect 0 "$lamella" map "$scenes/$map.yaml" -o "$map.h5"
  grep -qE '^  S separation +[1-9]' out.txt || fail "$map: no separation: $(cat out.txt)"
  grep -qE '^  R rupture +[1-9]' out.txt || fail "$map: no rupture: $(cat out.txt)"
done

# walls that could tear hold, and the lamella gives way (docs/results/tearing.md)
expect 0 "$lamella" tear "$scenes/walls-tear.yaml" --modes opening --turgor "0.05 MPa" --json --quiet
number strength | awk '!($1 > 0.0243 && $1 < 0.0249) { exit 1 }' || fail "strength: $(number strength)"
number energy | awk '!($1 > 0.46 && $1 < 0.475) { exit 1 }' || fail "energy: $(number energy)"
grep -q '"burst_fraction": *0\.0' out.txt && ! grep -q '"burst_fraction": *[1-9]' out.txt || fail "cells burst"
