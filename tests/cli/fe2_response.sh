# slow: macro.response: a cache that stops outside its table, warm starts without memory, what is told of the answers
. "$(dirname "$0")/common.sh"
set -e

# scene NAME TURGOR PRESS RESPONSE: a body of 2 x 2 elements between frictionless walls, pressed in two steps
scene() {
  tissue turgor="$2" >"$1" <<YAML
macro:
  mesh: {box: [10 mm, 10 mm], elements: [2, 2]}
  response: {$4}
  boundary:
    - {on: bottom, displacement: [free, 0 mm]}
    - {on: left, displacement: [0 mm, free]}
    - {on: right, displacement: [0 mm, free]}
    - {on: top, displacement: [free, $3]}
  inflate: false
  steps: 2
YAML
}
# press FILE: vertical reaction of the top side in the last step
press() { sed -n 's/.*"top": *\[[^,]*, *\([-0-9.e+]*\)\].*/\1/p' "$1" | tail -n 1; }

# dry cells buckle before 10 % compression, where no table helps: the run ends there, and names the first point each time
scene stop.yaml "mode: none" "-1 mm" "outside: stop"
expect 3 "$lamella" fe2 stop.yaml -d stop.h5 --json
grep -q 'stop.yaml: cut back: out_of_reach: .* in element 0, point 0 at (0.5635, 0.5635) mm: F = ' err.txt ||
  fail "a cutback does not name its point: $(head -n 1 err.txt)"
[ "$(grep -c 'cut back' err.txt)" = "$(grep -o '"cutbacks": *[0-9]*' out.txt | awk '{s += $2} END {print s}')" ] ||
  fail "cutbacks are not counted as they are told"
for key in interpolated query_seconds solve_seconds other_seconds; do
  grep -q "\"$key\": *[0-9]" out.txt || fail "--json lacks $key"
done

# who starts from the reference gets where others do
scene warm.yaml "pressure: 0.02 MPa" "-0.5 mm" ""
scene cold.yaml "pressure: 0.02 MPa" "-0.5 mm" "warm_start_memory: 0 kB"
for name in warm cold; do "$lamella" fe2 $name.yaml --json >$name.jsonl; done
awk -v a="$(press warm.jsonl)" -v b="$(press cold.jsonl)" 'BEGIN {exit !(a < 0 && (a - b) ^ 2 < 1e-14 * a ^ 2)}' ||
  fail "without warm starts the reaction is $(press cold.jsonl), not $(press warm.jsonl)"

scene bad.yaml "mode: none" "-1 mm" "warm_start_memory: 2"
expect 2 -e 'bad.yaml:10:.*warm_start_memory: 2: is no size of memory' "$lamella" fe2 bad.yaml
