#!/usr/bin/env bash
# lamella process: rows, JSON, files, pictures, databases, true reasons, refusals, signals.
. "$(dirname "$0")/common.sh"
set -e -o pipefail
example=$source/tests/scenes/ripening.yaml

# the lamella gives way: one event, at the same time whoever answers
expect 0 -o '"event": "lamella_normal"' "$lamella" process "$example" -o a.h5 --frames 4 --json
[ "$(grep -c '"time"' out.txt)" = 102 ] || fail "not one object per output and event"
grep '"event"' out.txt | grep -qE '"lamella_normal_ratio": (1\.0000|0\.9999)' || fail "stress over strength at the event"
[ -s err.txt ] && fail "says on stderr: $(cat err.txt)"
direct=$(grep '"event"' out.txt | sed 's/.*"time": \([0-9]*\).*/\1/')
expect 0 "$lamella" process "$example" -d d.h5 --json
cached=$(grep '"event"' out.txt | sed 's/.*"time": \([0-9]*\).*/\1/')
[ $((direct > cached ? direct - cached : cached - direct)) -lt $((direct / 500)) ] ||
  fail "the event is at $cached s from a database, at $direct s solved directly"
expect 0 -e 'events that rest on tractions' "$lamella" process "$example" -d d.h5 --response database --json

# a table for people
expect 0 "$lamella" process "$example"
grep -qE '^ +6\.9[0-9]+ .* lamella_normal$' out.txt || fail "the row of the event: $(grep lamella out.txt)"

# the file, and its pictures
expect 0 -o '"kind": "process"' "$lamella" info a.h5 --json
expect 0 "$lamella" info a.h5 --check
head -1 a.csv | grep -q '^state,event,time (s),.*,F11,F12,F21,F22,F33,P11 (MPa),' || fail "the table: $(head -1 a.csv)"
grep -q '^[0-9]*,lamella_normal,[0-9]' a.csv || fail "the table has no event: $(cut -c1-60 a.csv)"
expect 0 "$lamella" plot --dpi 40 a.h5 -o a.svg
grep -q svg a.svg || fail "no picture"
expect 0 "$lamella" plot --dpi 40 a.h5 --state 0 -o s.svg
expect 0 "$lamella" plot --dpi 40 a.h5 --film -o film.svg
[ "$(ls film-*.svg | wc -l)" -ge 5 ] || fail "numbered frames: $(ls)"
expect 2 -e '--frames N keeps them' "$lamella" plot --dpi 40 a.h5 --state 1 -o s.svg
expect 2 "$lamella" plot --dpi 40 a.h5 --map a.h5 -o s.svg

# walls that lose their fibres alone: no database serves, a solve does
sed 's/of: walls, law: fractional_conversion, rate: 0.1/of: C4, law: fractional_conversion, rate: 0.1/; s/7 day/1 day/; s/3 day/0.5 day/' \
  "$example" >fibres.yaml
expect 0 "$lamella" process fibres.yaml
expect 2 -e 'the parameters of the walls do not change alike' "$lamella" process fibres.yaml -d d.h5

# nothing is left of the walls: a true reason, and what was reached is kept
sed 's/plateau: 0.6/plateau: 0/; s/rate: 0.1/rate: 9/g; s/7 day/70 day/' "$example" >gone.yaml
expect 3 -e 'ended at' "$lamella" process gone.yaml -o gone.h5
expect 0 "$lamella" plot --dpi 40 gone.h5 -o gone.svg

# its way over a map of failure
sed -e 's/steps: 8/steps: 2/; s/points: [23]/points: 2/' -e 's/mesh: {along: 8, through: 2}/mesh: {along: 4, through: 1}/' \
  "$source/tests/scenes/map-turgor-cohesion.yaml" >map.yaml
expect 0 "$lamella" map map.yaml -o map.h5
tissue interface='law: contact, cohesion: 0.05 MPa' >loosening.yaml <<'YAML'
process:
  duration: 20 h
  output: 4 h
  kinetics: [{of: lamella, law: first_order, rate: 0.05 /h}]
YAML
expect 0 "$lamella" process loosening.yaml -o loosening.h5
expect 0 "$lamella" process loosening.yaml --response cache # without a file
expect 0 "$lamella" plot --dpi 40 loosening.h5 --map map.h5 -o way.svg
[ -s way.svg ] || fail "no picture of the way"

# cells in contact that exchange water, from a cache
sed -e 's/cohesion: 0.05/cohesion: 0.3/; s/0.02 MPa/0.2 MPa/; s/20 h/2 h/; s/along: 4/along: 6/' -e 's/  output: 4 h/  water: {permeability: 1e-7 m\/s\/MPa, osmotic_pressure: 0.5 MPa}\n  surroundings: [{time: 0 h, outside: 0.3 MPa}, {time: 2 h, outside: 0.31 MPa}]/' loosening.yaml >wet.yaml
expect 0 "$lamella" process wet.yaml -d w.h5

# the tissues of docs/results/tissues.md
for tissue in "$source"/tests/scenes/tissues/*.yaml; do
  expect 0 "$lamella" process "$tissue"
done

expect 1 "$lamella" process "$example" --frames 1
expect 1 "$lamella" process "$example" --response nonsense
expect 2 -e 'has no block `process`' "$lamella" process "$source/tests/scenes/shear-bonded.yaml"

# a signal: what is there is committed
sed 's/tolerance.*//; s/duration: 7 day/duration: 7 day\n  tolerance: 1e-10\n  output: 10 s/' "$example" >long.yaml
"$lamella" process long.yaml -o long.h5 --json >long.txt 2>&1 &
pid=$!
sleep 2
ends TERM 143 $pid
expect 0 "$lamella" info long.h5 --check
