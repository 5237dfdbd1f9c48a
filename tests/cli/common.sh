# What the scripts here and in ../mpi begin with; no test. A script sources it with its own arguments and then is in an
# empty folder; those of ../mpi are skipped without mpirun:
#   . "$(dirname "$0")/common.sh"
#   $lamella, $source           the program and the folder of the sources
#   fail WORDS                  tells what is wrong; the script goes on, and ends with status 1, as it does where its
#                               last command fails
#   expect STATUS [-o WORDS] [-e WORDS] COMMAND...
#                               the command ends with that status; what it says is in out.txt and err.txt, and each of
#                               -o and -e tells of words (of grep) that stand there
#                               with serve=1 before, commands of "$lamella" go to one process (served)
#   has FILE WORDS...           the file has all of these words (of grep)
#   ends SIGNAL STATUS PID [RECEIVER]
#                               a process of this shell ends with that status when it, or RECEIVER, is sent the signal
#   tissue [BLOCK=KEYS]...      a scene that begins with bonded tissue under turgor, but for the blocks of rve told, and
#                               goes on with what comes on standard input
#   package [MODULE...]         $python runs the Python package of the sources with the library beside $lamella; the script is
#                               skipped where they, or modules that it needs, are not there
#   served ARGUMENTS...         "$lamella" ARGUMENTS, but with all such commands in one process, which takes a fiftieth of the
#                               time of a start; for commands that read no standard input
#   same FILE FILE [known|ordered]
#                               databases whose records of the same keys are the same, but for times; with known the
#                               second may have others besides, with ordered the order and the grid are the same, too
[[ $0 != */mpi/* ]] || command -v mpirun >/dev/null || exit 77
set -u
lamella=$(realpath "$1") source=$(realpath "$2")
work=$(mktemp -d)
failures=0
trap 'status=$?; [ -z "${SERVER_PID:-}" ] || dismiss; rm -rf "$work"; [ $failures -eq 0 ] || status=1; exit $status' EXIT
cd "$work" || exit 1

fail() {
  echo "$(basename "$0" .sh): $*" >&2
  failures=$((failures + 1))
}

has() {
  local words file=$1
  for words in "${@:2}"; do
    grep -q -e "$words" "$file" || fail "no \"$words\" in $file: $(cat "$file")"
  done
}

expect() {
  local wanted=$1 status=0 OPTIND=2 option words file
  local -A told=()
  while getopts o:e: option; do
    [ "$option" = o ] && told["$OPTARG"]=out.txt || told["$OPTARG"]=err.txt
  done
  shift $((OPTIND - 1))
  # not what reads standard input or has options of PETSc
  [[ -z ${serve:-} || $1 != "$lamella" || " ${*:2} " =~ \ --?\  || $PWD != "$work" ]] || set -- served "${@:2}"
  "$@" >out.txt 2>err.txt || status=$?
  [ $status -eq "$wanted" ] || fail "exit status $status instead of $wanted: $*: $(cat out.txt err.txt)"
  for words in "${!told[@]}"; do
    file=${told[$words]}
    grep -q -e "$words" "$file" || fail "no \"$words\" in the $file of $*: $(cat "$file")"
  done
}

served() {
  local status
  [ -n "${SERVER_PID:-}" ] || coproc SERVER { exec "$(dirname "$lamella")/lamella_served"; }
  printf '%s\n' "$@" '' >&"${SERVER[1]}"
  read -r status <&"${SERVER[0]}" || { fail "the process of all commands has ended at: $*"; return 70; }
  cat served.out
  cat served.err >&2
  return "$status"
}

# The process of all commands ends, in good order.
dismiss() {
  local pid=$SERVER_PID input=${SERVER[1]}
  exec {input}>&-
  wait "$pid" || fail "the process of all commands ends with status $?"
}

ends() {
  local status=0
  kill -s "$1" "${4:-$3}" || fail "the run had ended before SIG$1"
  wait "$3" || status=$?
  [ $status -eq "$2" ] || fail "exit status $status instead of $2 after SIG$1"
}

tissue() {
  local cell='apothem: 75 um, wall_thickness: 11.25 um' wall='law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa'
  local interface='law: bonded' turgor='mode: prescribed, pressure: 0.02 MPa' mesh='along: 4, through: 1'
  [ $# = 0 ] || local "$@"
  printf 'version: 1\nrve:\n'
  printf '  %s\n' "cell: {$cell}" "wall: {$wall}" "interface: {$interface}" "turgor: {$turgor}" "mesh: {$mesh}"
  cat
}

package() {
  local module
  python=/usr/bin/python3
  export PYTHONPATH=$source/python:$source/tests/support LAMELLA_LIBRARY
  LAMELLA_LIBRARY=$(dirname "$lamella")
  for module in cffi numpy yaml "$@"; do
    "$python" -c "import $module" 2>/dev/null || { echo "skipped: no Python module $module"; exit 77; }
  done
  [ -f "$LAMELLA_LIBRARY/liblamella.so" ] || { echo "skipped: no shared library in this build"; exit 77; }
  ! nm -D "$LAMELLA_LIBRARY/liblamella.so" | grep -q __asan || { echo "skipped: the sanitizers are not loaded by Python"; exit 77; }
}

if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
  same() {
    /usr/bin/python3 - "$@" <<'PYTHON'
import h5py, numpy, sys

def records(path):
    with h5py.File(path) as f:
        all = f["records"][: f["records"].attrs["committed"]]
        return (all, f["table/grid"][()]) if how == "ordered" else (all[all["key"].argsort()], None)

how = sys.argv[3] if sys.argv[3:] else None
(one, grid), (other, its_grid) = records(sys.argv[1]), records(sys.argv[2])
if how == "known":
    other = other[numpy.isin(other["key"], one["key"])]
assert grid == its_grid, "the grids differ"
assert len(one) == len(other), f"{len(one)} and {len(other)} records"
for name in set(one.dtype.names) - {"seconds", "checksum"}:
    assert one[name].tobytes() == other[name].tobytes(), name  # bytes: a NaN equals itself
PYTHON
  }
else
  same() {
    [ "${3:-}" != known ] || return 0 # answers depend on all nodes around
    for file in "$1" "$2"; do
      printf '%s ; 0.025 MPa\n' '1 0.02 0 1' '1.04 0.01 0.02 1.07' '1.01 0.01 0 1.02' '1.05 0.05 0 1.02' >lines
      { "$lamella" query "$file" -F - --json --tangent <lines || [ $? = 3 ]; } | sed 's/"seconds": *[^,}]*//' >"$file.json"
    done
    cmp -s "$1.json" "$2.json"
  }
fi
