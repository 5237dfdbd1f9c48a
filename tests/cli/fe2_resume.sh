# fe2 --resume: what is there is not solved again, what does not belong to it is refused
. "$(dirname "$0")/common.sh"
set -e

tissue >block.yaml <<'YAML'
macro:
  mesh: {box: [10 mm, 10 mm], elements: [1, 1]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, 0.2 mm]}]
  steps: 2
YAML

# status ARGUMENTS: of fe2, which must tell something
status() {
  code=0
  "$lamella" fe2 "$@" >out.jsonl 2>out.err || code=$?
  echo $code
}

[ "$(status block.yaml --resume)" = 1 ] || fail "--resume without -o is not a usage error"
[ "$(status block.yaml -o out.h5 --resume --json)" = 0 ] || fail "nothing to resume: the run does not start afresh"
[ "$(wc -l <out.jsonl)" = 3 ] || fail "nothing to resume: not all steps are told"
[ -z "$(ls -A | grep ckpt || true)" ] || fail "a complete run leaves its checkpoint"
[ "$(status block.yaml -o out.h5 --resume --json)" = 0 ] && [ ! -s out.jsonl ] || fail "a complete run is done again"
sed 's/1 mm, 0.2/1 mm, 0.3/' block.yaml >other.yaml
[ "$(status other.yaml -o out.h5 --resume)" = 2 ] || fail "results of another scene are gone on with"
grep -q 'line 10 was .*0.2 mm.* and is .*0.3 mm' out.err || fail "what differs is not named: $(cat out.err)"

# lines FILE COUNT: waits until the file has so many
lines() {
  until [ "$(wc -l <"$1")" -ge "$2" ]; do kill -0 $! 2>/dev/null || { fail "the run ends early"; break; }; sleep 0.05; done
}

# files that the scene names: with another content neither a complete nor a stopped run is gone on with
printf 'x, y, turgor\n0, 0, 0.02\n10, 0, 0.02\n0, 10, 0.02\n10, 10, 0.02\n' >turgor.csv
sed 's/^macro:/macro:\n  fields: {turgor: {table: turgor.csv, unit: MPa}}/' block.yaml >field.yaml
[ "$(status field.yaml -o field.h5)" = 0 ] || fail "$(cat out.err)"
[ "$(status field.yaml -o field.h5 --resume --json)" = 0 ] && [ ! -s out.jsonl ] || fail "a complete run is done again"
sed -i 's/10, 10, 0.02/10, 10, 0.021/' turgor.csv
[ "$(status field.yaml -o field.h5 --resume)" = 2 ] || fail "a complete run with another table is gone on with"
grep -q 'field.h5: was begun with another content of turgor.csv, which field.yaml names' out.err || fail "$(cat out.err)"
sed 's/steps: 2/steps: 400/' field.yaml >long.yaml
"$lamella" fe2 long.yaml -o long.h5 --json >long.jsonl 2>/dev/null &
lines long.jsonl 4
{ kill -KILL $!; wait $! || true; } 2>/dev/null
told=$(wc -l <long.jsonl)
sed -i 's/10, 10, 0.021/10, 10, 0.02/' turgor.csv
[ "$(status long.yaml -o long.h5 --resume)" = 2 ] || fail "a run with another table is gone on with"
grep -q 'another content of turgor.csv' out.err || fail "$(cat out.err)"

# no step that was told is solved again, after a kill and after a stop
sed -i 's/10, 10, 0.02$/10, 10, 0.021/' turgor.csv
"$lamella" fe2 long.yaml -o long.h5 --resume --json >rest.jsonl 2>rest.err &
lines rest.jsonl 3
kill -TERM $!
wait $! || true
first=$(sed -n '1s/.*"step": *\([0-9]*\).*/\1/p' rest.jsonl) last=$(sed -n '$s/.*"step": *\([0-9]*\).*/\1/p' rest.jsonl)
[ "$first" -ge $((told - 1)) ] || fail "$told steps were told, and the resumed run begins with step $first"
"$lamella" fe2 long.yaml -o long.h5 --resume --json >rest.jsonl 2>rest.err &
lines rest.jsonl 1
{ kill -KILL $!; wait $! || true; } 2>/dev/null
first=$(sed -n '1s/.*"step": *\([0-9]*\).*/\1/p' rest.jsonl)
[ "$first" = $((last + 1)) ] || fail "step $last was the last before a stop, and the resumed run begins with step $first"
