#!/usr/bin/env bash
# lamella build where one rank is held up all the time: the same records in the same order.
. "$(dirname "$0")/../cli/common.sh"
set -e -o pipefail
tissue interface='law: contact, cohesion: 0.002 MPa' turgor='pressure: 0 MPa' >s.yaml <<'YAML'
sample: {stretch: {min: 0, max: 0.06}, turgor: {min: 0.02 MPa, max: 0.03 MPa}, count: 60}
YAML
"$lamella" build s.yaml -d one.h5 --quiet >/dev/null

# the process of rank 1, found by what Open MPI tells it
rank_1() { for p in $(pgrep -f "build s.yaml -d three.h5"); do
  tr '\0' '\n' <"/proc/$p/environ" 2>/dev/null | grep -qx OMPI_COMM_WORLD_RANK=1 && echo "$p" && return
done; }

mpirun -n 3 "$lamella" build s.yaml -d three.h5 --quiet >/dev/null &
job=$!
while kill -0 $job 2>/dev/null; do
  slow=$(rank_1 || true)
  [ -n "$slow" ] || { sleep 0.05; continue; }
  kill -STOP "$slow" 2>/dev/null || true
  sleep 0.3
  kill -CONT "$slow" 2>/dev/null || true
  sleep 0.03
done
wait $job || fail "status $? with a slow rank"

same one.h5 three.h5 ordered || fail "a slow rank changes the records"
