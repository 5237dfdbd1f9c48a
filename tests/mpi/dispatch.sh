# tasks that rank 0 hands out are done once each, and errors and signals end all ranks, on 2, 3 and 7 ranks
set -eu
test=$(dirname "$1")/tests/test_dispatch
command -v mpirun >/dev/null || exit 77
[ -x "$test" ] || exit 77
output=$(mktemp)
trap 'rm -f "$output"' EXIT
for ranks in 2 3 7; do
  timeout 120 mpirun -n $ranks "$test" >"$output" 2>&1 || { cat "$output" >&2; exit 1; }
done
