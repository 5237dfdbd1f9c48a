# What the scripts here begin with; no test. A script sources it with its own arguments and then is in an empty folder:
#   . "$(dirname "$0")/common.sh"
#   $lamella, $source           the program and the folder of the sources
#   fail WORDS                  tells what is wrong; the script goes on, and ends with status 1, as it does where its
#                               last command fails
#   expect STATUS COMMAND...    the command ends with that status; what it says is in out.txt and err.txt
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
