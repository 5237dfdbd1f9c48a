# slow: a signal to one of two ranks ends fe2 on both in good order
. "$(dirname "$0")/../cli/common.sh"
set -e

sed 's/elements: \[8, 8\]/elements: [5, 5]/' "$source/tests/scenes/tissue-block.yaml" >direct.yaml
# a cache solves less often: here its solves take longer
sed 's/^  turgor: {mode.*/&\n  mesh: {along: 12, through: 4}/' direct.yaml >cache.yaml
for response in direct cache; do
  mpirun -n 2 "$lamella" fe2 $response.yaml --json --quiet --response $response -o $response.h5 >out.jsonl 2>out.err &
  run=$!
  until [ -f $response.h5 ] || ! kill -0 $run 2>/dev/null; do sleep 0.1; done
  ends TERM 143 $run "$(pgrep -P $run | tail -n 1)"
  [ "$(wc -l <out.jsonl)" -lt 6 ] || fail "$response: the run went on to its end"
  [ -z "$(ls -A | grep -E 'lock|tmp' || true)" ] || fail "$response: $(ls -A | grep -E 'lock|tmp') is left"
  "$lamella" info $response.h5 >/dev/null || fail "$response: the file of a stopped run cannot be read"
done
