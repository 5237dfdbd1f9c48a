# Law lamella on the command line: columns, fields and pictures of tissue that is sheared until it is half torn.
. "$(dirname "$0")/common.sh"

tissue interface='law: lamella, strength: 0.02 MPa, fracture_energy: 0.02 J/m^2' mesh='along: 6, through: 1' \
  turgor='pressure: 0.01 MPa' >scene.yaml <<'YAML'
load: [{F: [[1, 0], [0, 1]]}, {ramp: {to: [[1, 0.3], [0, 1]], steps: 4}}]
YAML
expect 0 -o 'debonded *broken *open' "$lamella" rve scene.yaml --no-estimate
sed -n 3p out.txt | grep -q ' 0.0000' || fail "the first state is damaged: $(cat out.txt)"
expect 0 "$lamella" rve scene.yaml --no-estimate --json -o torn.h5
for name in broken_fraction broken_by_face stored dissipated released; do
  [ "$(grep -c "\"$name\":" out.txt)" -eq 5 ] || fail "no member $name"
done
head -1 torn.csv | grep -qF 'broken_fraction,burst_fraction,juice,stored (kJ/m^3),dissipated (kJ/m^3),dissipated_walls (kJ/m^3),released (kJ/m^3)' || fail "$(head -1 torn.csv)"
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
  /usr/bin/python3 - <<'PYTHON' || fail "the file is not what docs/reference/files.md says"
import h5py, numpy as np
with h5py.File("torn.h5") as f:
    for k, broken in zip(range(1, 6), f["records"]["broken_fraction"]):
        group = f[f"fields/{k}/interface"]
        at = {name: group[name][()] for name in group}
        assert at["across"].shape == at["from"].shape and at["broken"].shape == at["gap"].shape
        for name in ("damage", "broken"):
            assert (at[name] >= 0).all() and (at[name] <= 1).all()
        jump = np.hypot(at["opening"], at["slip"])
        assert np.allclose(np.linalg.norm(at["across"] - at["from"], axis=2), jump, atol=1e-12)
        assert np.hypot(np.maximum(at["normal_traction"], 0), at["shear_traction"]).max() <= 0.02 * (1 + 1e-9)
        assert abs(at["broken"].mean() - broken) < 0.05
    assert 0.1 < broken < 0.9
PYTHON
fi
expect 0 "$lamella" plot --dpi 40 torn.h5 --state last -o torn.png
expect 0 "$lamella" plot --dpi 40 torn.h5 --strip -o torn.svg

# of one law of contact, the smooth one, unless the scene asks for the other: a held F is a held state
held() { # SHARPNESS
  tissue interface="law: lamella, strength: 0.02 MPa, fracture_energy: 0.1 J/m^2$1" <<'YAML'
load: [{ramp: {to: [[1.05, 0.15], [0, 1]], steps: 6}}, {F: [[1.05, 0.15], [0, 1]]}]
process: {output: 1 h, program: [{for: 1 h, F: [[1.05, 0.15], [0, 1]]}, {for: 1 h}]}
YAML
}
held '' >held.yaml
held ', sharpness: exact' >exact.yaml
for command in "rve --no-estimate" process; do
  expect 0 "$lamella" $command held.yaml --json
  sed -i '/"F"/!d' out.txt
  [ "$(grep -c '"contact_width": 0.003' out.txt)" = "$(wc -l <out.txt)" ] || fail "$command: $(cat out.txt)"
done
expect 0 "$lamella" rve exact.yaml --no-estimate --json
grep -q '"contact_width": 0' out.txt || fail "the exact law is not used where it is chosen"
