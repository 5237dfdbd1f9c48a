# A signal that reaches one rank alone ends the run on all of them, in the middle of a solve.
. "$(dirname "$0")/../cli/common.sh"

tissue interface='law: contact, cohesion: 0.001 MPa' turgor='mode: prescribed, pressure: 0.05 MPa' mesh='along: 24, through: 4' >fine.yaml <<'YAML'
  cells: [2, 2]
load:
  - {ramp: {to: [[1, 0.3], [0, 1]], steps: 20}}
YAML

for rank in 1 2; do
  rm -f out.h5 err.txt
  mpirun -n 2 "$lamella" rve fine.yaml --json --monitor -o out.h5 >out.txt 2>err.txt &
  run=$!
  until grep -qs 'exact   0' err.txt || ! kill -0 $run 2>/dev/null; do sleep 0.05; done
  ends TERM 143 $run "$(pgrep -P $run | sed -n ${rank}p)"
  [ "$(grep -c converged out.txt)" -lt 20 ] || fail "rank $rank: the run went on to its end"
  [ ! -e out.h5.lock ] || fail "rank $rank: the lock is left behind"
  [ ! -e out.h5 ] || "$lamella" info out.h5 >/dev/null || fail "rank $rank: the file cannot be read"
done
