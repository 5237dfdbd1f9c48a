# A signal ends a run in the middle of a solve: the state under way is given up and not recorded.
. "$(dirname "$0")/common.sh"

tissue interface='law: contact, cohesion: 0.001 MPa' turgor='mode: prescribed, pressure: 0.05 MPa' mesh='along: 16, through: 4' >fine.yaml <<'YAML'
  cells: [2, 2]
load:
  - {F: [[1, 0.2], [0, 1]]}
strength: {wall: 0.25 MPa}
YAML

# stop SIGNAL STATUS ITERATION: sends it when the first solve has come so far
stop() {
  rm -f out.h5 err.txt
  "$lamella" rve fine.yaml --json --monitor -o out.h5 >out.txt 2>err.txt &
  pid=$!
  until grep -qs "$3" err.txt || ! kill -0 $pid 2>/dev/null; do sleep 0.01; done
  ends "$1" "$2" $pid
  [ ! -s out.txt ] || fail "$1: a state is told: $(cat out.txt)"
  [ ! -e out.h5 ] || "$lamella" info out.h5 --json | grep -q '"records": 0[,}]' || fail "$1: a state is recorded"
  [ ! -e out.h5.lock ] || fail "$1: the lock is left behind"
}

stop TERM 143 '^  least   0'
stop INT 130 '^  least   2'
stop USR1 143 '^  exact   0'

# a fault of memory is told in words (by the sanitizer in its own) before it ends the program
"$lamella" rve fine.yaml --quiet >out.txt 2>err.txt &
pid=$!
until grep -q state out.txt || ! kill -0 $pid 2>/dev/null; do sleep 0.01; done
kill -s SEGV $pid || fail "the run had ended: $(tail -1 err.txt)"
status=0
wait $pid || status=$?
[ $status -ne 0 ] || fail "a fault of memory ends with status 0"
grep -q -e 'lamella: a fault of memory, in Lamella or in a library' -e AddressSanitizer err.txt || fail "$(cat err.txt)"
