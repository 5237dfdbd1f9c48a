# lamella verify under mpirun: its figures do not depend on the number of ranks.
. "$(dirname "$0")/../cli/common.sh"
set -e -o pipefail

tissue mesh='along: 2, through: 1' >s.yaml <<'YAML'
  cells: [2, 1]
  variation: {kinds: [{wall_thickness: 15 um}], list: [0, 1]}
sample:
  stretch: {min: 0, max: 0.04}
  count: 30
YAML
"$lamella" build s.yaml -d db.h5 --quiet >/dev/null
for n in 1 2 3; do
  mpirun -n $n "$lamella" verify db.h5 --samples 40 --accuracy inf --json >$n.txt || fail "status $? on $n ranks"
  sed -i 's/"[a-z_]*seconds": *[^,}]*//g' $n.txt
  [ "$(wc -l <$n.txt)" = 1 ] || fail "not one object on $n ranks: $(cat $n.txt)"
  grep -q '"compared": 40,' $n.txt || fail "not 40 answers compared on $n ranks: $(cat $n.txt)"
  cmp -s 1.txt $n.txt || fail "other figures on $n ranks: $(diff 1.txt $n.txt)"
done
