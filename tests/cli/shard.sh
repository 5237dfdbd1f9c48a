#!/usr/bin/env bash
# lamella build --shard: parts of a box, built apart, merged and gone on with, hold the nodes of the whole.
. "$(dirname "$0")/common.sh"
set -e -o pipefail
tissue interface='law: contact, cohesion: 0.005 MPa' turgor='pressure: 0 MPa' >s.yaml <<'YAML'
sample: {stretch: {min: -0.02, max: 0.08}, turgor: {min: 0.005 MPa, max: 0.03 MPa}, accuracy: 0.1}
YAML
expect 0 "$lamella" build s.yaml -d whole.h5 --quiet
for i in 1 2 3; do expect 0 "$lamella" build s.yaml -d part.$i.h5 --shard $i/3 --quiet; done
expect 0 -o '"shards": 3' -o '"differing": 0' "$lamella" merge merged.h5 part.?.h5 --json
expect 0 "$lamella" build s.yaml -d merged.h5 --resume --quiet
same whole.h5 merged.h5 known || fail "the parts together differ from the whole"

expect 1 -e '--shard 4/3' "$lamella" build s.yaml -d other.h5 --shard 4/3
