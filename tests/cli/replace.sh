#!/usr/bin/env bash
# -o replaces an older result of the same command, and nothing else.
. "$(dirname "$0")/common.sh"
set -e -o pipefail

tissue >s.yaml <<'YAML'
load:
  - {F: [[1, 0.1], [0, 1]]}
sample: {stretch: {min: 0, max: 0.05}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, count: 3}
YAML
cp s.yaml before.yaml

# the scene, a database, a pipe
expect 2 -e 's.yaml: exists and is not a file' "$lamella" rve s.yaml -o s.yaml
cmp -s s.yaml before.yaml || fail "the scene is destroyed"
"$lamella" build s.yaml -d tissue.db.h5 --quiet >/dev/null
cp tissue.db.h5 before.h5
expect 2 -e 'tissue.db.h5: exists and is of kind "database"' "$lamella" rve s.yaml -o tissue.db.h5
cmp -s tissue.db.h5 before.h5 || fail "the database is destroyed"
mkfifo pipe
expect 2 timeout 60 "$lamella" rve s.yaml -o pipe
[ -p pipe ] || fail "the pipe is replaced"
[ -z "$(find . -name '*.lock' -o -name '*.tmp')" ] || fail "files are left behind: $(ls)"

# a result of its own, also behind a link, and an empty file
mkdir results
expect 0 "$lamella" rve s.yaml -o results/rve.h5
expect 0 "$lamella" rve s.yaml -o results/rve.h5
ln -s results/rve.h5 link.h5
expect 0 "$lamella" rve s.yaml -o link.h5
[ -L link.h5 ] || fail "the link is replaced"
expect 0 "$lamella" info results/rve.h5
: >empty.h5
expect 0 "$lamella" rve s.yaml -o empty.h5
