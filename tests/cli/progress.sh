#!/usr/bin/env bash
# Commands that may take seconds show their progress on a terminal, and there alone; not with --quiet.
. "$(dirname "$0")/common.sh"
set -e -o pipefail
command -v script >/dev/null || exit 77
script -qec true probe.txt >/dev/null 2>&1 </dev/null || exit 77 # no pseudo-terminals here

tissue >s.yaml <<'YAML'
sample: {stretch: {min: 0, max: 0.05}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, accuracy: 0.1}
process:
  duration: 1 day
  kinetics: [{of: walls, law: first_order, rate: 0.1 /day}]
YAML
"$lamella" build s.yaml -d db.h5 --quiet >/dev/null
"$lamella" process s.yaml -o p.h5 --frames 3 --quiet >/dev/null
for i in 1 2 3; do echo "1.01 0.01 0 1.02 ; 0.02 MPa"; done >lines

# shows COMMAND: it draws a line over the one before, and removes it; elsewhere and with --quiet there is none
shows() {
  SHELL=$BASH script -qec "$1" screen.txt >/dev/null </dev/null || fail "$1: $(cat screen.txt)"
  has screen.txt $'\r\033\\[K.*[0-9].*\r\033\\[K'
  SHELL=$BASH script -qec "$1 --quiet" screen.txt >/dev/null </dev/null
  ! grep -q $'\033' screen.txt || fail "progress despite --quiet: $1: $(cat screen.txt)"
  bash -c "$1" >/dev/null 2>err.txt </dev/null
  ! grep -q $'\033' err.txt || fail "progress without a terminal: $1: $(cat err.txt)"
}

shows "rm -f m.h5; '$lamella' merge m.h5 db.h5"
shows "'$lamella' info db.h5 --check"
shows "'$lamella' query db.h5 -F - <lines >rows.txt"
shows "'$lamella' plot --film p.h5 -o film.pdf"
[ "$(grep -c converged rows.txt)" = 3 ] || fail "rows: $(cat rows.txt)"
# rows on the terminal are the progress
script -qec "'$lamella' query db.h5 -F - <lines" screen.txt >/dev/null </dev/null
! grep -q $'\033' screen.txt || fail "a bar between rows: $(cat screen.txt)"

# rows on the terminal, and what is done beside them; nothing of it stays
script -qec "'$lamella' rve '$source/tests/scenes/shear-bonded.yaml'" screen.txt >/dev/null </dev/null
has screen.txt $'\r\033\\[Klamella rve: states \\[#*\\.*\\] [0-3]/3' $'\r\033\\[K *3  *1.0000'
script -qec "'$lamella' check '$source/tests/scenes/apple-tear.yaml'" screen.txt >/dev/null </dev/null
has screen.txt $'\r\033\\[Klamella check: predicts rve' "^rve "

# commands of the Python package
package scipy
tissue cell='apothem: 75 um, wall_thickness: 11.25 um' mesh='along: 2, through: 1' >fit.yaml <<'YAML'
load:
  - {ramp: {to: [[1.1, 0], [0, 1]], steps: 2}}
uncertain:
  - {key: rve.wall.C1, from: 0.05 MPa, to: 0.2 MPa}
YAML
shown() { # COMMAND WORDS: on the terminal
  SHELL=$BASH script -qec "$1" screen.txt >/dev/null </dev/null || fail "$1: $(cat screen.txt)"
  has screen.txt $'\r\033\\[K'"$2"
  bash -c "$1" >/dev/null 2>err.txt </dev/null
  ! grep -q $'\033' err.txt || fail "progress without a terminal: $1: $(cat err.txt)"
}
shown "'$lamella' rve fit.yaml --uncertainty 4 --processes 2" "lamella rve: samples \\[#*\\.*\\] [0-9]*/5 .*/s .* left"
shown "'$lamella' sensitivity fit.yaml --evaluations 24 --processes 2" "lamella sensitivity: evaluations \\[#*\\.*\\] [0-9]*/[0-9]* .*/s .* left"
