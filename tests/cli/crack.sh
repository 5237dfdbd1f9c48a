# slow: A patch with a notch: the crack that grows from it, its resistance and the toughness, in table, text and JSON.
. "$(dirname "$0")/common.sh"

patch() { # END DISSIPATION
  cat <<YAML
version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: 11.25 um}
  patch: {columns: 5, rows: 4, sides: free, notch: {row: 2, columns: 2}}
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  interface: {law: lamella, strength: 0.02 MPa, fracture_energy: 0.2 J/m^2, sharpness: smooth}
  turgor: {mode: prescribed, pressure: 0 MPa}
  mesh: {along: 4, through: 1}
load:
  - {F: [[1, 0], [0, 1]]}
  - {ramp: {to: [[1, 0], [0, $1]], steps: 25$2}}
YAML
}

patch 1.2 ', dissipation: {faces: 0.4}' >torn.yaml
expect 0 -o '^crack: grows from the notch from state [0-9]*' -o '^  resistance: .* J/m^2' -o 'toughness: K = .* kPa m^(1/2)' \
  "$lamella" rve torn.yaml --no-estimate -o torn.h5
cp out.txt text.txt
expect 0 "$lamella" rve torn.yaml --no-estimate --json -o again.h5
cmp -s torn.csv again.csv || fail "the table depends on what is printed"
/usr/bin/python3 - <<'PYTHON' || fail "the crack: $(grep -A2 '^crack' text.txt)"
import csv, json, math, re
rows = list(csv.DictReader(open("torn.csv")))
crack = [json.loads(line) for line in open("out.txt")][-1]["crack"]
length = [float(r["crack_length (um)"]) for r in rows]
grows = [k for k in range(1, len(rows)) if length[k] > max(length[:k])]
first, last = grows[0], grows[-1]
assert last > first and (first + 1, last + 1) == (crack["begins"], crack["last"])
assert abs(length[last] - crack["length"]) < 1e-6 and int(float(rows[last]["crack_faces"])) == crack["faces"]
# kJ/m^3 times the area of 20 cells, um^2, over the growth, um
spent = [float(rows[k]["dissipated (kJ/m^3)"]) * 20 * 2 * 3 ** 0.5 * 75 ** 2 * 1e-3 for k in (first, last)]
resistance = (spent[1] - spent[0]) / (length[last] - length[first])
assert abs(resistance - crack["resistance"]) < 1e-8 * resistance
assert abs(math.sqrt(crack["modulus"] * 1e6 * resistance) * 1e-3 - crack["toughness"]) < 1e-8 * crack["toughness"]
# of a straight crack through this tissue
assert 0.8 < resistance / (0.2 * 2 / 3 ** 0.5) < 1.4, resistance
told = re.search(r"resistance: ([0-9.]+)", open("text.txt").read())
assert abs(float(told[1]) - resistance) < 1e-3 * resistance
PYTHON

patch 1.01 '' >whole.yaml
expect 0 -o '^crack: it has not grown from the notch' "$lamella" rve whole.yaml --no-estimate
