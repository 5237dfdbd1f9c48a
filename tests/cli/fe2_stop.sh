# slow: a signal ends fe2 at once, in good order
. "$(dirname "$0")/common.sh"
set -e

# inflated in a few seconds; the load step takes longer: a run that waits for its end is late
sed 's/^  steps: 5/  steps: 1/; s/elements: \[8, 8\]/elements: [5, 5]/' "$source/tests/scenes/tissue-block.yaml" >slow.yaml

# a cache solves less often: here it is asked for much accuracy of slow solves, but for no states that buckle, each of
# which takes seconds
sed 's/^  turgor: {mode.*/&\n  mesh: {along: 24, through: 8}/; s/displacement: .2 mm, 0 mm./displacement: [0 mm, 0.6 mm]/
  s/^accuracy: .*/accuracy: 0.000002/' slow.yaml >slower.yaml

# stop SIGNAL STATUS LIMIT FILE ARGUMENTS: sends it half a second after the first step is in the file; ms to end in
stop() {
  signal=$1 wanted=$2 limit=$3 file=$4
  shift 4
  "$lamella" fe2 --json --quiet "$@" >out.jsonl 2>out.err &
  pid=$!
  until [ -f "$file" ] || ! kill -0 $pid 2>/dev/null; do sleep 0.1; done
  sleep 0.5
  kill -s "$signal" $pid || fail "$signal $*: the run had ended: $(cat out.err)"
  sent=$(date +%s%N)
  status=0
  wait $pid || status=$?
  taken=$((($(date +%s%N) - sent) / 1000000))
  [ $status = "$wanted" ] || fail "$signal $*: status $status instead of $wanted: $(cat out.err)"
  [ $taken -lt $limit ] || fail "$signal $*: the run took $taken ms to end"
  [ -z "$(ls -A | grep -E 'lock|tmp' || true)" ] || fail "$signal $*: $(ls -A | grep -E 'lock|tmp') is left"
}

stop TERM 143 2000 direct.h5 slow.yaml -o direct.h5
"$lamella" info direct.h5 >/dev/null || fail "the file of a stopped run cannot be read"
[ "$(grep -o '"step": *[0-9]*' out.jsonl | tr -dc '0-9\n' | head -n 1)" = 0 ] || fail "the converged step was not reported"
stop INT 130 5000 cache.h5 slower.yaml -d db.h5 -o cache.h5
"$lamella" info db.h5 --json | grep -q '"records": *[1-9]' || fail "what the cache had solved is lost"
"$lamella" info db.h5 --json >info.json
grep -q out_of_reach info.json && ! grep -q '"out_of_reach": *0' info.json && fail "questions that were not solved are recorded"
exit 0
