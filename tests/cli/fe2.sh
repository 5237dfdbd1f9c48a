# slow: the command fe2: steps, exit statuses, warm databases
. "$(dirname "$0")/common.sh"
set -e

# scene NAME SHEAR STEPS: a body of 2 x 2 elements, inflated, then sheared
scene() {
  tissue >"$1" <<YAML
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  boundary: [{on: bottom, displacement: [0 mm, 0 mm]}, {on: top, displacement: [$2, 0 mm]}]
  steps: $3
YAML
}
# values KEY FILE: the numbers of a key, one per line
values() { sed -n "s/.*\"$1\": *\([-0-9.e+]*\).*/\1/p" "$2"; }
sum() { awk '{s += $1} END {printf "%d\n", s}'; }
# shear FILE: horizontal reactions of the top side
shear() { sed -n 's/.*"top": *\[ *\([-0-9.e+]*\),.*/\1/p' "$1"; }

scene small.yaml "1 mm" 2
"$lamella" fe2 small.yaml --json -o small.h5 >direct.jsonl
[ "$(values step direct.jsonl | tr '\n' ' ')" = "0 1 2 " ] || fail "inflation and two steps are not reported as 0 1 2"
[ "$(values load_factor direct.jsonl | tail -n 1 | cut -c1)" = 1 ] || fail "the last step's load factor is not 1"
for key in work debonded_fraction max_gap turgor_mean newton_iterations queries hits solves failures seconds peak_memory_mb; do
  [ "$(grep -c "\"$key\"" direct.jsonl)" = 3 ] || fail "--json lacks $key"
done
[ -f small.h5 ] && [ -f small.xdmf ] || fail "-o did not write small.h5 and small.xdmf"
"$lamella" info small.h5 --json | grep -q '"kind": *"fe2"' || fail "small.h5 is not of kind fe2"

# the cache answers within the scene's accuracy, and a second run solves nothing
"$lamella" fe2 small.yaml --json -d db.h5 >cold.jsonl
"$lamella" fe2 small.yaml --json -d db.h5 >warm.jsonl
[ "$(values solves cold.jsonl | sum)" -gt 0 ] || fail "a cold cache solved nothing"
[ "$(values solves warm.jsonl | sum)" = 0 ] || fail "a warm cache solved again"
for run in cold warm; do
  [ "$(echo "$(shear direct.jsonl | tail -n 1) $(shear $run.jsonl | tail -n 1)" |
    awk '{d = $1 - $2; print (d * d < 0.02 * 0.02 * $1 * $1)}')" = 1 ] || fail "the $run cache's reaction is off by more than 2 %"
done
"$lamella" fe2 small.yaml --json -d db.h5 --response database >database.jsonl || fail "a complete database does not answer"

# what the cache adds are nodes of a grid that the file holds, each once; keys from 2^62 on are states of no grid
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
  /usr/bin/python3 - <<'PYTHON' || fail "the cache's records have keys of samples, or the same twice, or there is no grid"
import h5py
with h5py.File("db.h5") as file:
    records = file["records"][: file["records"].attrs["committed"]]
    keys = sorted(int(key) for key in records["key"])
    assert "step" in file["table/grid"][()].decode()
nodes = [key for key in keys if 2**60 <= key < 2**61]
assert nodes and len(set(keys)) == len(keys), keys
assert [key for key in keys if key not in nodes] == list(range(2**62, 2**62 + len(keys) - len(nodes))), keys
PYTHON
  # a database older than grids is given one, and that is said once
  cp db.h5 old.h5
  /usr/bin/python3 - <<'PYTHON'
import h5py, zlib
with h5py.File("old.h5", "r+") as file:
    del file["table"]
    table = file["records"]
    records = table[: table.attrs["committed"]]
    records["key"] = range(len(records))
    records["checksum"] = [zlib.crc32(record.tobytes()[:-4]) for record in records]
    table[: len(records)] = records
    for name in "committed_check", "records_check", "type_check":
        del table.attrs[name]
PYTHON
  expect 0 -e 'old.h5: its [0-9]* records belong to no grid' "$lamella" fe2 small.yaml -d old.h5
  expect 0 "$lamella" fe2 small.yaml -d old.h5 --response database
  grep -q grid err.txt && fail "a grid is added twice"
fi

# an error on the way (a folder is where OUT.xdmf is written first) closes the files: the cache's solves are kept, no lock is left
mkdir error.xdmf.tmp
expect 4 -e 'error.xdmf' "$lamella" fe2 small.yaml -d kept.h5 -o error.h5
[ -z "$(ls -A | grep -E 'lock|h5.tmp' || true)" ] || fail "an error leaves $(ls -A | grep -E 'lock|h5.tmp')"
"$lamella" info error.h5 >/dev/null || fail "error.h5 cannot be read"
"$lamella" info kept.h5 --json | grep -q '"records": *[1-9]' || fail "an error loses what the cache solved: $("$lamella" info kept.h5 --json)"
rm -rf error.xdmf.tmp

# a database that cannot be written to: the results' lock is given back, and the file that was there stays
cp small.h5 before.h5
expect 4 "$lamella" fe2 small.yaml -d missing/db.h5 -o before.h5
[ -z "$(ls -A | grep -E 'lock|tmp' || true)" ] || fail "a missing folder leaves $(ls -A | grep -E 'lock|tmp')"
cmp -s small.h5 before.h5 || fail "a run that could not start changed the results of the last one"

# a state out of the database's reach: status 3, converged steps kept
scene far.yaml "3 mm" 3
expect 3 -e 'out_of_reach: .*element .* point' "$lamella" fe2 far.yaml --json -d db.h5 --response database -o far.h5
[ "$(values step out.txt | head -n 1)" = 0 ] && [ -f far.h5 ] || fail "the steps before the failure are lost"

# usage and input
for arguments in "small.yaml --response guess" "small.yaml --response database" "small.yaml -d db.h5 --response direct" \
  "small.yaml -d db.h5 -o ./db.h5" "small.yaml -d new.h5 -o $work/new.h5" "small.yaml -o new.xdmf"; do
  # shellcheck disable=SC2086
  expect 1 "$lamella" fe2 $arguments
done
sed 's/wall_thickness: 11.25/wall_thickness: 10/' small.yaml >other.yaml
expect 2 "$lamella" fe2 other.yaml -d db.h5
sed 's/on: top, displacement: \[1 mm, 0 mm\]/on: left, displacement: [1 mm, 0 mm]/' small.yaml >contradiction.yaml
expect 2 "$lamella" fe2 contradiction.yaml
