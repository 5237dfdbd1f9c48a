# lamella rve: states in order, JSON and table, the file, failed states, signals, errors of writing.
. "$(dirname "$0")/common.sh"

# scene MESH LOAD...: writes scene.yaml
scene() {
  printf '  - %s\n' "${@:2}" | sed '1i load:' | tissue mesh="$1" >scene.yaml
}

# JSON Lines and nothing else; every member of the contract
scene "along: 3, through: 1" "{F: [[1, 0.1], [0, 1]]}" "{ramp: {to: [[1, 0.3], [0, 1]], steps: 2}, turgor: 0.01 MPa}"
echo "accuracy: 0.1" >>scene.yaml
expect 0 "$lamella" rve scene.yaml --json -o out.h5
[ "$(wc -l <out.txt)" -eq 3 ] || fail "not one line per state: $(cat out.txt)"
[ -s err.txt ] && fail "says something on stderr: $(cat err.txt)"
for name in state F turgor cohesion status energy P lumen_fraction opening_fraction debonded_fraction debonded_by_face \
  open_fraction max_gap max_traction mean_face_traction floating_cells stable newton_iterations factorisations seconds \
  unknowns error_estimate source branch negative_eigenvalues; do
  [ "$(grep -c "\"$name\":" out.txt)" -eq 3 ] || fail "no member $name"
done
grep -q '"tangent"' out.txt && fail "a tangent that nobody asked for"
grep -q '"reason"' out.txt && fail "a reason for a converged state"
sed -n 1p out.txt | grep -q '"state": 1, .*"turgor": 0.02[,0]' || fail "the first state is wrong: $(sed -n 1p out.txt)"
sed -n 3p out.txt | grep -q '"state": 3, .*"turgor": 0.01[,0]' || fail "the last state is wrong: $(sed -n 3p out.txt)"
expect 0 "$lamella" rve scene.yaml --json --tangent
/usr/bin/python3 -c 'import json, sys
for line in sys.stdin: assert None not in json.loads(line)["tangent"]' <out.txt || fail "entries of the tangent are not known"
grep -qiE '\b(nan|inf)' out.txt && fail "numbers that are not finite"

# the file
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
  /usr/bin/python3 - <<'PYTHON' || fail "the file is not what docs/reference/files.md says"
import h5py, numpy as np
with h5py.File("out.h5") as f:
    records = f["records"][: f["records"].attrs["committed"]]
    assert list(records["key"]) == [1, 2, 3]
    nodes, elements, period = f["mesh/nodes"][()], f["mesh/elements"][()], f["mesh/period"][()]
    assert elements.shape == (18, 9) and elements.max() == len(nodes) - 1 and f["mesh/cell_of"].shape == (18,)
    assert np.allclose(np.linalg.norm(period, axis=1), 2)
    for k in (1, 2, 3):
        x = f[f"fields/{k}/x"][()]
        stretch, stress = f[f"fields/{k}/fibre_stretch"][()], f[f"fields/{k}/wall_stress"]
        assert x.shape == nodes.shape and stretch.shape == stress.shape == (len(nodes),)
        assert 0.5 < stretch.min() < 1 < stretch.max() < 2 and stress.attrs["unit"] in ("MPa", b"MPa")
        F = records["F"][k - 1][:2, :2]
        assert np.abs(x - x.mean(0) - (nodes - nodes.mean(0)) @ F.T).max() < 0.3
PYTHON
fi

# the table
expect 0 "$lamella" rve scene.yaml --tangent
grep -qE '^ +2 .* converged ' out.txt || fail "no row of state 2: $(cat out.txt)"
grep -q 'dP/dF' out.txt || fail "no tangent in the table"
grep -q '3 of 3 states solved, 0 failed' out.txt || fail "no summary"
expect 0 -e '[0-9]e-[01]' "$lamella" rve scene.yaml --json --monitor

# a state without answer is kept with its reason, the next starts from the last answer
scene "along: 1, through: 1" "{F: [[1, 0.1], [0, 1]]}" "{F: [[1, 80], [0, 1]]}" "{F: [[1, 0.2], [0, 1]]}"
expect 3 "$lamella" rve scene.yaml --json -o failed.h5
[ "$(grep -c '"status": "converged"' out.txt)" -eq 2 ] || fail "not two states converged: $(cat out.txt)"
sed -n 2p out.txt | grep -q '"reason": "[^"]' || fail "a failed state without a reason: $(sed -n 2p out.txt)"
sed -n 2p out.txt | grep -qE '"energy": null, "P": \[null' || fail "a failed state with a stress: $(sed -n 2p out.txt)"
"$lamella" info failed.h5 --json >info.txt
grep -q '"records": 3' info.txt && grep -q '"failed": 1' info.txt || fail "the failed state is not on disk: $(cat info.txt)"

# a signal: what is solved stays, the rest is left
scene "along: 12, through: 4" "{ramp: {to: [[1, 0.3], [0, 1]], steps: 2000}}"
"$lamella" rve scene.yaml --json -o stopped.h5 >out.txt 2>err.txt &
pid=$!
for _ in $(seq 100); do
  [ -s out.txt ] && break
  sleep 0.05
done
ends TERM 143 $pid
"$lamella" info stopped.h5 --json | grep -q "\"records\": $(wc -l <out.txt)[,}]" || fail "not all told states are on disk"
[ -e stopped.h5.lock ] && [ -s stopped.h5.lock ] && fail "the lock is left behind"

# output that cannot be written
expect 4 -e 'no/such/folder' "$lamella" rve "$source/tests/scenes/shear-bonded.yaml" -o no/such/folder/out.h5
if [ -w /dev/full ]; then
  "$lamella" rve "$source/tests/scenes/shear-bonded.yaml" --json 2>err.txt >/dev/full
  [ $? -eq 4 ] || fail "a full disk goes unnoticed: $(cat err.txt)"
fi

# states one behind the other that have no solution for one reason: it is printed once
tissue turgor='mode: none' mesh='along: 4, through: 1' >collapse.yaml <<<'load: [{ramp: {to: [[0.6, 0], [0, 0.4]], steps: 15}}]'
expect 3 -o 'the lumen of cell 0 collapses' -o '^      as in state 6$' "$lamella" rve collapse.yaml --no-estimate
[ "$(grep -c 'the lumen of cell 0 collapses' out.txt)" = 1 ] || fail "a reason is repeated: $(cat out.txt)"
