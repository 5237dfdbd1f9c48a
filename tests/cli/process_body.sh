#!/usr/bin/env bash
# slow: lamella process of a body: rows, JSON, files, pictures, databases, regions, contact, true reasons, refusals, signals.
. "$(dirname "$0")/common.sh"
set -e -o pipefail
example=$source/tests/scenes/storage.yaml

# two weeks of storage and a shear test from a database: the event is where a coarse mesh solved directly has it
expect 0 -o '"event": "lamella_normal"' "$lamella" process "$example" -d d.h5 -o a.h5 --json
[ "$(grep -c '"time"' out.txt)" = 17 ] || fail "not one object per output and event: $(grep -c '"time"' out.txt)"
grep '"event"' out.txt | grep -qE '"lamella_normal_ratio": (1\.0000|0\.9999)' || fail "stress over strength at the event"
grep -q '"load_factor": 1.0,' out.txt || fail "no shear test"
expect 0 "$lamella" process "$example" -d d.h5 --response database
grep -qE '^ +14.0001 .* 1 .*' out.txt || fail "the row of the test: $(tail -3 out.txt)"
grep -q '0 solves' out.txt || fail "solves: $(tail -1 out.txt)"

# files and pictures
expect 0 "$lamella" info a.h5 --check
expect 0 -o 'separation .* lamella_normal' "$lamella" info a.h5
grep -q '1209600' a.xdmf || fail "times of the XDMF file"
head -1 a.csv | grep -q 'time (s)' || fail "times of the CSV file: $(head -1 a.csv)"
expect 0 "$lamella" plot --dpi 40 a.h5 -o a.svg
expect 0 "$lamella" plot --dpi 40 a.h5 --state 3 --field turgor -o s.svg
grep -q svg s.svg || fail "no picture"
expect 2 "$lamella" plot --dpi 40 a.h5 --map a.h5 -o s.svg

# the small body of the further runs
small() { sed -e 's/^  turgor: .*/&\n  mesh: {along: 4, through: 1}/; s/elements: \[8, 8\]/elements: [1, 1]/; s/1209610 s/2 day/; s/output: 1 day/output: 1 day\n  tolerance: 1e-3/' -e '/time: 7 day/d; s/14 day/1 day/' "$@"; }
small "$example" >small.yaml
expect 0 -o 'response direct' "$lamella" process small.yaml -o small.h5
expect 0 "$lamella" plot --dpi 40 small.h5 --film -o film.pdf
grep -qa "/Count [2-9]" film.pdf || fail "pages of the film"

# walls that lose their fibres alone: no database serves, solves do
small -e 's/of: walls/of: C4/' "$example" >fibres.yaml
expect 0 "$lamella" process fibres.yaml -o f.h5
expect 2 -e 'the parameters of the walls do not change alike' "$lamella" process fibres.yaml -d f-new.h5

# walls in other proportions in a region are not alike, whichever is the region
small -e 's/law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa/law: mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa/' \
  -e 's/pressure: 0.1 MPa}/pressure: 0.01 MPa}/; s/, osmotic_pressure: 0.6 MPa//; s/of: walls/of: C4/' \
  -e 's/^process:/  regions: [{name: core, where: "y < 5", wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}}]\nprocess:/' "$example" >parts.yaml
expect 0 "$lamella" process parts.yaml
expect 2 "$lamella" process parts.yaml -d p.h5

# nothing moves where no part of the program says so
sed '/load: 1/d' small.yaml >still.yaml
expect 0 -e 'the load parameter stays 0' "$lamella" process still.yaml

# what a jump does not reach: what was before is told
small -e 's/{for: 10 s, load: 1}/{for: 0 s, load: 90}/' "$example" >beyond.yaml
expect 3 "$lamella" process beyond.yaml
grep -qE '^ +1 .*' out.txt || fail "the state before the jump: $(cat out.txt)"

# a skin of smaller cells, whose membranes have more area
small -e 's/^process:/  regions: [{name: skin, where: "y > 5", cell: {apothem: 40 um}}]\nprocess:/' "$example" >skin.yaml
expect 0 "$lamella" process skin.yaml -d k.h5
[ -s k.skin.h5 ] || fail "no database of the region: $(ls)"

# cells in contact: with water and with prescribed turgor, solved directly and from a cache
small -e 's/law: bonded/law: contact, cohesion: 0.05 MPa/; s/0.1 MPa}/0.05 MPa}/' -e '/strength/d' \
  -e 's/osmotic_pressure: 0.6/osmotic_pressure: 0.55/' "$example" >contact.yaml
expect 0 "$lamella" process contact.yaml
expect 0 "$lamella" process contact.yaml -d c.h5
sed -e '/water:/d; s/, outside: 0.5 MPa/, turgor: 0.05 MPa/; s/, outside: 0.55 MPa/, turgor: 0.04 MPa/' contact.yaml >given.yaml
expect 0 "$lamella" process given.yaml -d c.h5

# nothing is left of the walls: a true reason, and what was reached is kept
small -e 's/plateau: 0.6/plateau: 0/; s/rate: 0.1/rate: 900/g' "$example" >gone.yaml
expect 3 -e 'ended at' "$lamella" process gone.yaml -d g.h5 -o gone.h5
expect 0 "$lamella" plot --dpi 40 gone.h5 -o gone.svg

# a signal ends it between two states, and the file has what was told
"$lamella" process "$example" -o long.h5 >long.txt 2>&1 &
pid=$!
for _ in $(seq 300); do
  [ -s long.h5 ] && break
  sleep 0.1
done
ends TERM 143 $pid
expect 0 "$lamella" info long.h5 --check

expect 1 "$lamella" process small.yaml --frames 4
expect 1 "$lamella" process small.yaml -d d.h5 -o d.h5
expect 2 -e 'has no block `process`' "$lamella" process "$source/tests/scenes/tissue-block.yaml"

# a slice in baths: fields in the files, and what flows in is what the cells take up
expect 0 "$lamella" process "$source/tests/scenes/slice-baths.yaml" -d slice.h5 -o slice-baths.h5 --json
/usr/bin/python3 - <<'PYTHON' || fail "inflow and balance"
import json, sys
states = [json.loads(line) for line in open("out.txt")]
good = all(abs(s["water_balance"]) < 1e-10 and abs(s["water"] - 1 - s["inflow"]) < 1e-10 for s in states)
sys.exit(0 if good and max(s["inflow"] for s in states) > 0.05 and states[-1]["inflow"] < -0.02 else 1)
PYTHON
grep -q 'Name="water_potential"' slice-baths.xdmf && grep -q 'Name="apoplast_potential"' slice-baths.xdmf || fail "potentials in XDMF"
expect 0 "$lamella" info slice-baths.h5 --check
expect 0 "$lamella" plot --dpi 40 slice-baths.h5 --field apoplast_potential --state 3 -o slice.svg
