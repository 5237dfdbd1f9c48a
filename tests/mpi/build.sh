# lamella build under mpirun: the records do not depend on the number of ranks, except times, and checksums over them.
. "$(dirname "$0")/../cli/common.sh"
command -v mpirun >/dev/null || exit 77
set -e -o pipefail

cat >bonded.yaml <<'YAML'
version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: 11.25 um}
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  interface: {law: bonded}
  turgor: {mode: prescribed, pressure: 0.02 MPa}
  mesh: {along: 4, through: 1}
sample:
  stretch: {min: 0, max: 0.1}
  turgor: {min: 0.01 MPa, max: 0.03 MPa}
  count: 40
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

if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
  /usr/bin/python3 - <<'PYTHON' || fail "the records depend on the number of ranks"
import h5py, sys

def records(path):
    with h5py.File(path) as f:
        return f["records"][: f["records"].attrs["committed"]], f["table/grid"][()]

same = True
for scene in ("bonded", "contact"):
    one, grid = records(f"{scene}.1.h5")
    for path in (f"{scene}.2.h5", f"{scene}.3.h5", f"{scene}.5.h5", f"{scene}.8.h5"):
        other, its = records(path)
        assert other.dtype == one.dtype and len(other) == len(one) and its == grid
        for name in one.dtype.names:
            if name in ("seconds", "checksum"):
                continue
            if one[name].tobytes() != other[name].tobytes():  # bytes: a NaN equals itself
                print(f"{path}: {name} differs from one rank's", file=sys.stderr)
                same = False
sys.exit(not same)
PYTHON
fi

# answers depend on all nodes around, so they compare the files without h5py, too
for i in $(seq 0 5); do echo "1.0$i 0.0$i 0 1.02 ; 0.025 MPa"; done >lines
for scene in bonded contact; do
  for n in 1 2 3 5 8; do
    { "$lamella" query $scene.$n.h5 -F - --json --tangent <lines || [ $? = 3 ]; } | sed 's/"seconds": *[^,}]*//' >$n.json
  done
  for n in 2 3 5 8; do cmp -s 1.json $n.json || fail "$scene: $n ranks give other answers than one"; done
done

# an error of the rank that keeps the file ends all of them
status=0
timeout 60 mpirun -n 2 "$lamella" build bonded.yaml -d bonded.1.h5 --quiet >/dev/null 2>err || status=$?
[ "$status" = 2 ] || fail "status $status for an existing file"
