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
