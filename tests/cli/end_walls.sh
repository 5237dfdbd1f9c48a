# End walls of irregular cells: those of the cells, not of the air between them; a database is of one length of cells; a body.
. "$(dirname "$0")/common.sh"
package scipy

"$lamella" tissue -o cells.json --cells 12 --size "150 um" --variation 0.3 --gas 0.1 --wall-thickness "6 um" >/dev/null || fail "tissue"
{ tissue turgor='mode: none' </dev/null | sed 's/^  cell: .*/  tissue: cells.json/'; } >open.yaml
sed 's/^  tissue.*/&\n  cell: {length: 200 um}/' open.yaml >closed.yaml
"$python" - <<'PYTHON' || fail "the air"
import numpy as np
import lamella
A = [lamella.RVE(f"{name}.yaml").solve(np.eye(3)).tangent for name in ("closed", "open")]
sheet = 2 * 6 / 200 * (0.11e6 + 0.25e6)  # 2 t/L (C1 + C2 + C4/4)
share = (A[0] - A[1])[0, 1, 0, 1] / sheet
assert abs(share - 0.9) < 0.002, share
PYTHON

tissue cell='apothem: 75 um, wall_thickness: 11.25 um, length: 150 um' <<<'sample: {stretch: {min: -0.02, max: 0.1}}
macro: {mesh: {box: [2 mm, 1 mm], elements: [2, 1]}, steps: 1, boundary: [{on: left, symmetry: true}, {on: bottom, symmetry: true}, {on: right, displacement: [0.1 mm, free]}]}' >box.yaml
expect 0 "$lamella" build box.yaml -d box.h5
sed 's/length: 150/length: 100/' box.yaml >short.yaml
expect 2 -e "rve.cell.length over apothem is" "$lamella" build short.yaml -d box.h5 --resume
expect 0 "$lamella" fe2 box.yaml -d box.h5 -o a.h5 --json
cp out.txt a.txt
expect 0 "$lamella" fe2 box.yaml --response direct -o b.h5 --json
"$python" - <<'PYTHON' || fail "the body"
import lamella
one, other = (lamella.Result(name).reaction[-1] for name in ("a.h5", "b.h5"))
assert abs(one - other).max() < 0.01 * abs(other).max(), (one, other)
PYTHON
