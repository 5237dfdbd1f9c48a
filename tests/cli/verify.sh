#!/usr/bin/env bash
# lamella verify: fresh solves beside the answers of a database, errors measured and estimated, the same for one seed.
. "$(dirname "$0")/common.sh"
set -e -o pipefail

tissue >s.yaml <<'YAML'
load:
  - {F: [[1.02, 0], [0, 1.01]]}
  - {F: [[1.03, 0.01], [0, 1.01]]}
sample: {stretch: {min: 0, max: 0.06}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, count: 40}
YAML
"$lamella" build s.yaml -d db.h5 --quiet >/dev/null
# value NAME: the number of a member at the top of out.txt's object
value() { grep -oE "\"$1\": [-0-9.e]+" out.txt | head -n 1 | sed 's/.*: //'; }

# a database is as good as it says, and `verify` finds out
expect 0 "$lamella" verify db.h5 --samples 30 --json
[ "$(wc -l <out.txt)" = 1 ] || fail "more than one line"
[ "$(value compared)" = 30 ] || fail "not 30 answers compared: $(cat out.txt)"
has out.txt '"holds": true' '"refused": {' '"measured": {"P": {"median": ' '"tangent": {' '"estimated": {"P": {"median": ' \
  '"share_beyond_accuracy": 0.0' '"share_estimate_holds": 1.0' '"share_tangent_estimate_holds": [0-9]' '"worst": {"F": '

# one seed draws one set of states
cp out.txt first.txt
strip() { sed 's/"[a-z_]*seconds": *[^,}]*//g' "$1"; }
expect 0 "$lamella" verify db.h5 --samples 30 --json
cmp -s <(strip first.txt) <(strip out.txt) || fail "the same seed gives other figures"
expect 0 "$lamella" verify db.h5 --samples 30 --seed 7 --json
if cmp -s <(strip first.txt) <(strip out.txt); then fail "another seed draws the same states"; fi

# the error that it tells of the worst state is what `rve` and `query` differ by
worst=$(grep -oE '"worst": .*' out.txt)
F=$(sed -E 's/.*"F": \[([^]]*)\].*/\1/' <<<"$worst")
turgor=$(sed -E 's/.*"turgor": ([-0-9.e]+).*/\1/' <<<"$worst")
read -r a b _ c d _ <<<"${F//,/}"
sed '/^load/,/^sample/d' s.yaml >one.yaml
echo "load: [{F: [[$a, $b], [$c, $d]], turgor: $turgor MPa}]" >>one.yaml
expect 0 "$lamella" rve one.yaml --json
grep -oE '"P": \[[^]]*' out.txt | tr -cd '0-9.e, -' >solve.txt
expect 0 "$lamella" query db.h5 -F "$F" -p "$turgor MPa" --accuracy inf --json
grep -oE '"P": \[[^]]*' out.txt | tr -cd '0-9.e, -' >answer.txt
measured=$(paste -d, answer.txt solve.txt | awk -F, '{
  for (i = 1; i <= 5; i++) if (i != 3) { d += ($i - $(i + 9)) ^ 2; r += $(i + 9) ^ 2 }
  printf "%.3e", sqrt(d / r) }') # P is larger than that of 1 % strain
told=$(sed -E 's/.*"error": ([-0-9.e]+).*/\1/' <<<"$worst")
awk "BEGIN { exit !(sqrt(($measured / $told - 1) ^ 2) < 1e-2) }" || fail "error of the worst: $measured, told $told"

# what cannot be held to is told; for a person a table with a verdict
expect 0 "$lamella" verify db.h5 --samples 20
has out.txt 'error of P, %' 'estimated, %' '^verdict  *holds'
expect 3 -o '"answered": 0,.*"holds": false' "$lamella" verify db.h5 --samples 2 --accuracy 1e-13 --json
[ "$(value asked)" = 2000 ] || fail "not 1000 states asked for each wanted: $(cat out.txt)"
grep -qE '"refused": \{"[^}]*": [0-9]+' out.txt || fail "no reasons: $(cat out.txt)"

# states of no box: what the records span
grep -v '^sample' s.yaml >states.yaml
expect 0 "$lamella" rve states.yaml -o rve.h5
expect 0 -o '"origin": "what its records span"' "$lamella" verify rve.h5 --samples 5 --json

# stopped by a signal: what is done is told
"$lamella" verify db.h5 --samples 100000 --json >stopped.txt 2>/dev/null &
pid=$!
listens() { (((0x$(sed -n 's/^SigCgt:\s*//p' /proc/$pid/status) >> 14) & 1)); } # to SIGTERM
for _ in $(seq 400); do listens && break || sleep 0.05; done
sleep 0.3
ends TERM 143 $pid
grep -q '"solved": [0-9]' stopped.txt || fail "nothing is told after SIGTERM: $(cat stopped.txt)"

# wrong files
expect 2 "$lamella" verify s.yaml
expect 4 "$lamella" verify missing.h5
