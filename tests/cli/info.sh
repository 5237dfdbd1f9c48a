#!/usr/bin/env bash
# lamella info: describes what lamella wrote, refuses what it did not write.
. "$(dirname "$0")/common.sh"
serve=1
set -e -o pipefail

tissue >s.yaml <<'YAML'
load:
  - {F: [[1, 0.1], [0, 1]]}
sample: {stretch: {min: 0, max: 0.05}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, count: 3}
YAML
"$lamella" build s.yaml -d db.h5 --quiet >/dev/null
"$lamella" rve s.yaml -o rve.h5 >/dev/null 2>&1
cp db.h5 three.h5

expect 0 "$lamella" info db.h5 --json
[ "$(wc -l <out.txt)" = 1 ] || fail "more than one line"
has out.txt '"kind": *"database"' '"records": *3' '"failed": *0' '"format_version": *1' '"microstructures": *\[{"hash"' \
  '"wall_thickness": *0.1[45]' '"PETSc"' '"HDF5"'
expect 0 -o 'nodes *3' -o 'grid of strains *step' -o 'records *3' "$lamella" info db.h5
expect 0 -o '"scattered": 0, "table": {"nodes": 3, ' "$lamella" info db.h5 --json
expect 0 -o '"kind": *"rve"' "$lamella" info rve.h5 --json
if grep -q '"table"' out.txt; then fail "a file of states has a table"; fi

# how far a macroscale run has come: the inflation and two steps
cat >macro.yaml <<'YAML'
macro:
  mesh: {box: [10 mm, 10 mm], elements: [1, 1]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [1 mm, 0 mm]}]
  steps: 2
YAML
cat s.yaml macro.yaml >fe2.yaml
"$lamella" fe2 fe2.yaml -d db.h5 -o fe2.h5 --quiet >/dev/null
expect 0 "$lamella" info fe2.h5 --json
grep -qE '"run": \{"steps": 3, "load_factor": 1\.0, "status": "done"\}' out.txt || fail "run: $(cat out.txt)"
expect 0 "$lamella" info fe2.h5
grep -qE '^steps +3$' out.txt && grep -qE '^load factor +1$' out.txt && grep -qE '^status +done$' out.txt || fail "table: $(cat out.txt)"
expect 0 "$lamella" info rve.h5 --json
if grep -q '"run"' out.txt; then fail "a file of states has a run"; fi

# cut short, of another program, not there
head -c 3000 db.h5 >cut.h5
expect 2 -e 'cut.h5' "$lamella" info cut.h5
expect 2 "$lamella" info s.yaml
mkfifo pipe.h5
expect 2 timeout 10 "$lamella" info pipe.h5 # and does not wait for someone to write into it
expect 4 "$lamella" info missing.h5
expect 1 "$lamella" info

# what of it is sound: a record and a text are changed
expect 0 -o '^sound records *3$' -o '^state *sound$' "$lamella" info three.h5 --check
cp three.h5 damaged.h5
place=$(LC_ALL=C grep -obUaF 'version: 1' damaged.h5 | head -1 | cut -d: -f1)
printf w | dd of=damaged.h5 bs=1 seek="$place" conv=notrunc status=none
place=$(/usr/bin/python3 -c 'import h5py; print(open("three.h5", "rb").read().index(h5py.File("three.h5")["records"][1]["energy"].tobytes()))')
printf '\377' | dd of=damaged.h5 bs=1 seek="$place" conv=notrunc status=none
expect 2 -e 'damaged.h5: record [0-2] is damaged.*lamella merge' "$lamella" info damaged.h5
expect 2 "$lamella" info damaged.h5 --check
grep -qE '^damaged +record [0-2] \(key [0-9]+\): its checksum differs$' out.txt && grep -qE '^damaged +/scene: ' out.txt &&
  grep -q '^sound records *2$' out.txt && grep -q 'lamella merge NEW.h5 damaged.h5 --salvage' out.txt || fail "damage: $(cat out.txt)"
expect 2 "$lamella" info damaged.h5 --check --json
[ "$(wc -l <out.txt)" = 1 ] && grep -q '"sound": false, "records": 3, "sound_records": 2' out.txt || fail "damage: $(cat out.txt)"
expect 2 "$lamella" info s.yaml --check
expect 4 "$lamella" info missing.h5 --check

# the checksums as docs/reference/files.md tells to test them
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
  sed -n '/^    # check all checksums/,/^$/s/^    //p' "$source/docs/reference/files.md" >check.py
  [ -s check.py ] || fail "docs/reference/files.md has no program"
  for file in db.h5 rve.h5 fe2.h5; do
    /usr/bin/python3 check.py $file >out.txt 2>&1 && [ ! -s out.txt ] || fail "$file is not sound in Python: $(cat out.txt)"
  done
  # units and axes of all members, and the program of the document that converts to MPa by them
  {
    sed -n '/^    # stress in MPa, by/,/^$/s/^    //p' "$source/docs/reference/files.md"
    cat <<'PYTHON'
import numpy as np
with h5py.File("db.h5") as f:
    table = f["records"]
    assert np.array_equal(P, table["P"][: table.attrs["committed"]] * (f.attrs["stress_unit_Pa"] * 1e-6))
    assert unit["max_gap"] == "apothem" and unit["energy_turgor2"] == "1/stress_unit" and unit["seconds"] == "s"
    axes = dict(line.split(": ") for line in table.attrs["axes"].decode().split("\n"))
    for name in table.dtype.names:
        base, shape = table.dtype[name].base, table.dtype[name].shape
        assert (name in unit) == (base == np.float64), name
        assert (name in axes) == (shape != ()), name
        assert axes.get(name) not in ("i j", "i j k l") or axes[name].split() == list("ijkl")[: len(shape)], name
PYTHON
  } >units.py
  expect 0 /usr/bin/python3 units.py
  /usr/bin/python3 check.py damaged.h5 >out.txt
  [ "$(cat out.txt)" = "record: damaged
/scene: damaged" ] || fail "damage in Python: $(cat out.txt)"
fi
