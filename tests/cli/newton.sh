#!/usr/bin/env bash
# lamella rve --monitor: Newton's steps fall quadratically, as its log shows.
set -euo pipefail
lamella=$1
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"

fail() { echo "FAILED: $*" >&2; cat log >&2; exit 1; }

cat >s.yaml <<'YAML'
version: 1
rve:
  cell: {apothem: 75 um, wall_thickness: 11.25 um}
  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}
  interface: {law: bonded}
  turgor: {mode: prescribed, pressure: 0.02 MPa}
  mesh: {along: 6, through: 2}
load:
  - {F: [[1, 0.3], [0, 1]]}
YAML
"$lamella" rve s.yaml --monitor --quiet --json >out 2>log
grep -q '"status": *"converged"' out || fail "not converged: $(cat out)"

# lines "fast K  residual R  largest step S  shift C"; the last one, at the solution, has no step
steps=$(awk '/largest step/ { for (i = 1; i < NF; i++) if ($i == "step") print $(i + 1) }' log | sed '$d')
[ "$(echo "$steps" | wc -l)" -ge 4 ] || fail "too few iterations to judge"
# each of the last three steps is at most a constant times the square of the one before
echo "$steps" | tail -4 | awk 'NR > 1 && !($1 <= 20 * before * before) { exit 1 } { before = $1 }' ||
  fail "the steps do not fall quadratically"
# and the residual ends at rounding
awk '/residual/ { for (i = 1; i < NF; i++) if ($i == "residual") last = $(i + 1) } END { exit !(last < 1e-10) }' log ||
  fail "the last residual is too large"
# without --monitor the log is silent
"$lamella" rve s.yaml --quiet --json >out 2>log
[ ! -s log ] || fail "messages without being asked"
