# lamella build under mpirun: the records do not depend on the number of ranks, except times, and checksums over them.
. "$(dirname "$0")/../cli/common.sh"
set -e -o pipefail

tissue >bonded.yaml <<'YAML'
sample: {stretch: {min: 0, max: 0.1}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, count: 40}
YAML
# nodes in contact start from others, which may have been solved on another rank
sed 's/law: bonded/law: contact, cohesion: 0.002 MPa/; s/max: 0.1}/max: 0.06}/; s/min: 0.01/min: 0.02/; s/count: 40/count: 50/' \
  bonded.yaml >contact.yaml

for scene in bonded contact; do
  "$lamella" build $scene.yaml -d $scene.1.h5 --quiet >1.out
  mpirun -n 2 "$lamella" build $scene.yaml -d $scene.2.h5 --quiet >2.out
  mpirun -n 3 "$lamella" build $scene.yaml -d $scene.3.h5 --json >3.out
  mpirun -n 5 "$lamella" build $scene.yaml -d $scene.5.h5 --quiet >5.out
  mpirun -n 8 "$lamella" build $scene.yaml -d $scene.8.h5 --quiet >8.out
  tail -n 1 3.out | grep -q '"records": *[45]0, *"failed": *0' || fail "progress: $(tail -n 1 3.out)"
done

for scene in bonded contact; do
  for n in 2 3 5 8; do same $scene.1.h5 $scene.$n.h5 ordered || fail "$scene: the records of $n ranks differ from one's"; done
done

# an error of the rank that keeps the file ends all of them
expect 2 timeout 60 mpirun -n 2 "$lamella" build bonded.yaml -d bonded.1.h5 --quiet
