#!/usr/bin/env bash
# lamella rve --monitor: Newton's steps fall quadratically, as its log shows.
. "$(dirname "$0")/common.sh"
set -e -o pipefail

tissue mesh='along: 6, through: 2' >s.yaml <<'YAML'
load:
  - {F: [[1, 0.3], [0, 1]]}
YAML
"$lamella" rve s.yaml --monitor --quiet --json >out 2>log
grep -q '"status": *"converged"' out || fail "not converged: $(cat out)"

# lines "fast K  residual R  largest step S  shift C"; the last one, at the solution, has no step
steps=$(awk '/largest step/ { for (i = 1; i < NF; i++) if ($i == "step") print $(i + 1) }' log | sed '$d')
[ "$(echo "$steps" | wc -l)" -ge 4 ] || fail "too few iterations to judge: $(cat log)"
# each of the last three steps is at most a constant times the square of the one before
echo "$steps" | tail -4 | awk 'NR > 1 && !($1 <= 20 * before * before) { exit 1 } { before = $1 }' ||
  fail "the steps do not fall quadratically: $(cat log)"
# and the residual ends at rounding
awk '/residual/ { for (i = 1; i < NF; i++) if ($i == "residual") last = $(i + 1) } END { exit !(last < 1e-10) }' log ||
  fail "the last residual is too large: $(cat log)"
# without --monitor the log is silent
"$lamella" rve s.yaml --quiet --json >out 2>log
[ ! -s log ] || fail "messages without being asked: $(cat log)"
