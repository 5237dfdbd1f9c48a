# What the scripts here begin with; no test. A script sources it with its own arguments and then is in an empty folder:
#   . "$(dirname "$0")/common.sh"
#   $lamella, $source           the program and the folder of the sources
#   fail WORDS                  tells what is wrong; the script goes on, and ends with status 1, as it does where its
#                               last command fails
#   expect STATUS COMMAND...    the command ends with that status; what it says is in out.txt and err.txt
#   same FILE FILE              databases whose records of the same keys are the same, but for times
set -u
lamella=$(realpath "$1") source=$(realpath "$2")
work=$(mktemp -d)
failures=0
trap 'status=$?; rm -rf "$work"; [ $failures -eq 0 ] || status=1; exit $status' EXIT
cd "$work" || exit 1

fail() {
  echo "$(basename "$0" .sh): $*" >&2
  failures=$((failures + 1))
}

expect() {
  wanted=$1
  shift
  status=0
  "$@" >out.txt 2>err.txt || status=$?
  [ $status -eq "$wanted" ] || fail "exit status $status instead of $wanted: $*: $(cat out.txt err.txt)"
}

# same FILE FILE [known]: the records with the same keys are the same, but for times; their order may differ; with `known`
# the second file may have others besides
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
  same() {
    /usr/bin/python3 - "$@" <<'PYTHON'
import h5py, numpy, sys

def records(path):
    with h5py.File(path) as f:
        all = f["records"][: f["records"].attrs["committed"]]
    return all[all["key"].argsort()]

one, other = records(sys.argv[1]), records(sys.argv[2])
if sys.argv[3:]:
    other = other[numpy.isin(other["key"], one["key"])]
assert len(one) == len(other), f"{len(one)} and {len(other)} records"
for name in set(one.dtype.names) - {"seconds", "checksum"}:
    assert one[name].tobytes() == other[name].tobytes(), name  # bytes: a NaN equals itself
PYTHON
  }
else
  same() {
    [ $# = 2 ] || return 0 # answers depend on all nodes around
    for file in "$1" "$2"; do
      printf '1 0.02 0 1\n1.04 0.01 0.02 1.07 ; 0.015 MPa\n' >lines
      { "$lamella" query "$file" -F - --json --tangent <lines || [ $? = 3 ]; } | sed 's/"seconds": *[^,}]*//' >"$file.json"
    done
    cmp -s "$1.json" "$2.json"
  }
fi
