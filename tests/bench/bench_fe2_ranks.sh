# fe2 with direct responses on 1 and 2 ranks: speed-up, share of the time outside RVE solves, cost of checkpoints
set -eu
lamella=$1
source=$2
command -v mpirun >/dev/null || exit 77
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

sed 's/steps: 5/steps: 2/; s/displacement: .2 mm, 0 mm./displacement: [1 mm, 0 mm]/' "$source/tests/scenes/tissue-block.yaml" >bonded.yaml
sed 's/law: bonded/law: contact, cohesion: 0.005 MPa/' bonded.yaml >contact.yaml

# column NAME FILE: sum of a number over the steps
column() { grep -o "\"$1\": *[0-9.e+-]*" "$2" | awk -F: '{s += $2} END {print s}'; }

for tissue in bonded contact; do
  for ranks in 1 2; do
    mpirun -n $ranks "$lamella" fe2 $tissue.yaml --json --quiet -o out.h5 >$ranks.jsonl
    awk -v tissue=$tissue -v n=$ranks -v s="$(column seconds $ranks.jsonl)" -v solving="$(column solve_seconds $ranks.jsonl)" \
      'BEGIN {printf "%-8s %d rank(s): %8.2f s in steps, outside RVE solves %.1f %%\n", tissue, n, s, 100 * (1 - solving / s)}'
  done
  awk -v one="$(column seconds 1.jsonl)" -v two="$(column seconds 2.jsonl)" 'BEGIN {printf "         2 ranks against 1: %.2f\n", one / two}'
  "$lamella" fe2 $tissue.yaml --quiet -o out.h5 | tail -n 1
done
