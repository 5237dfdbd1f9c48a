# slow: the claims about the macroscale solver and the cache hold on two and three ranks
set -eu
programs=$(dirname "$1")/tests
command -v mpirun >/dev/null || exit 77
[ -x "$programs/test_macro" ] || exit 77
output=$(mktemp)
trap 'rm -f "$output"' EXIT
for ranks in 2 3; do
  for test in test_macro test_macro_axisymmetric test_macro_friction test_macro_fields test_macro_mesh test_macro_exact test_cache; do
    mpirun -n $ranks "$programs/$test" >"$output" 2>&1 || {
      cat "$output" >&2
      exit 1
    }
  done
done
