# slow: 1,000 cells in contact, one state on one rank and on two (docs/results/performance.md): the same response, in less
# than 3 GB. Times are printed.
. "$(dirname "$0")/common.sh"

package scipy
command -v mpirun >/dev/null || exit 77
expect 0 "$lamella" tissue -o thousand.json --cells 1000 --size "150 um" --variation 0.3 --wall-thickness "8 um" --seed 1
cat >thousand.yaml <<'YAML'
version: 1
rve:
  tissue: thousand.json
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  interface: {law: contact, cohesion: 0.005 MPa}
  turgor: {mode: prescribed, pressure: 0.02 MPa}
  mesh: {along: 4, through: 1}
load: [{F: [[1, 0.1], [0, 1]]}]
YAML
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
cat >measure.py <<'PYTHON'
import json, resource, subprocess, sys, time

start = time.time()
run = subprocess.run(sys.argv[2:], stdout=subprocess.PIPE, text=True, check=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
response = next(json.loads(line) for line in run.stdout.splitlines() if line.startswith("{"))
print(f"{sys.argv[1]} ranks: {time.time() - start:.1f} s, processor {used.ru_utime:.1f} s, "
      f"largest process {used.ru_maxrss / 1e6:.2f} GB, {response['unknowns']} unknowns")
assert response["status"] == "converged" and used.ru_maxrss < 3e6
json.dump(response["P"], open(f"P{sys.argv[1]}.json", "w"))
PYTHON
for ranks in 1 2; do
  "$python" measure.py $ranks mpirun --oversubscribe -n $ranks "$lamella" rve thousand.yaml --no-estimate --json --quiet ||
    fail "$ranks ranks"
done
"$python" - <<'PYTHON' || fail "two ranks give another stress"
import json
import numpy as np
one, two = (np.array(json.load(open(f"P{n}.json")), dtype=float).ravel() for n in (1, 2))
assert np.abs(one - two).max() < 1e-8 * np.abs(one).max()
PYTHON
