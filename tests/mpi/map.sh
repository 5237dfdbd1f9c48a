# lamella map under mpirun: the points do not depend on the number of ranks, except times.
. "$(dirname "$0")/../cli/common.sh"
set -e -o pipefail

tissue turgor='pressure: 0 MPa' >s.yaml <<'YAML'
strength: {wall: 0.25 MPa, lamella_normal: 0.03 MPa, lamella_shear: 0.05 MPa}
load:
  - {ramp: {to: [[1, 0.4], [0, 1]], steps: 4}}
map:
  x: {quantity: turgor, from: 0 MPa, to: 0.1 MPa, points: 5}
  y: {quantity: C4, from: 0.5 MPa, to: 2 MPa, points: 3, spacing: log}
YAML
for n in 1 2 3; do
  mpirun -n $n "$lamella" map s.yaml -o $n.h5 --json --quiet >$n.out
  sed 's/"seconds": *[^,}]*//; s/.*"point": \([0-9]*\)/\1 &/' $n.out | sort -n >$n.sorted
  [ "$(wc -l <$n.sorted)" = 15 ] || fail "$(wc -l <$n.sorted) points from $n ranks"
  "$lamella" plot $n.h5 -o $n.svg >/dev/null
done
for n in 2 3; do
  cmp -s 1.sorted $n.sorted || fail "$n ranks give other points than one"
  cmp -s 1.svg $n.svg || fail "$n ranks give another picture than one"
done

# an error of the rank that keeps the file ends all of them
expect 1 timeout 60 mpirun -n 2 "$lamella" map s.yaml -o s.yaml --quiet
