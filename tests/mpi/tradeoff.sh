# lamella tradeoff under mpirun: on one rank as without it, on several it refuses, for they would share the processor.
. "$(dirname "$0")/../cli/common.sh"
set -e -o pipefail

mpirun -n 1 "$lamella" tradeoff "$source/tests/scenes/uneven-cells.yaml" --budget 3 --repeats 1 --only tolerance --quiet >out.txt ||
  [ $? = 3 ] || fail "one rank: $(cat out.txt)" # 3: no reference in so short a time
expect 1 mpirun -n 2 "$lamella" tradeoff "$source/tests/scenes/shear-bonded.yaml"
[ "$(grep -c 'without mpirun' err.txt)" = 1 ] || fail "two ranks: $(cat err.txt)"
[ ! -s out.txt ] || fail "two ranks measure: $(cat out.txt)"
