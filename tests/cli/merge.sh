#!/usr/bin/env bash
# lamella merge: one database of several, all of it or nothing, whatever comes in between.
. "$(dirname "$0")/common.sh"
set -e -o pipefail

tissue >s.yaml <<'YAML'
sample: {stretch: {min: 0, max: 0.05}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, count: 10}
YAML
sed 's/count: 10/count: 60/' s.yaml >more.yaml
sed 's/count: 10/count: 30/' s.yaml >some.yaml
sed 's/11.25 um/12 um/' s.yaml >thick.yaml
for name in s some more thick; do "$lamella" build $name.yaml -d $name.h5 --quiet >/dev/null; done

# usage
expect 1 "$lamella" merge
expect 1 -e 'a file name is missing' "$lamella" merge out.h5

# the union is what one build of all would have been
expect 0 "$lamella" merge out.h5 some.h5 more.h5 --json
[ "$(wc -l <out.txt)" = 1 ] || fail "more than one line"
has out.txt '"records": 60' '"shards": 2' '"duplicates": 30' '"differing": 0' '"left_out": 0' '"seconds": '
for db in out more; do "$lamella" query $db.h5 -F "1.02 0.01 0 1.03" --json | sed 's/"seconds": [^,]*//' >$db.json; done
cmp -s out.json more.json || fail "another answer: $(cat out.json more.json)"
expect 0 -o '60 (0 new)' "$lamella" build more.yaml -d out.h5 --resume --quiet

# refused: what is there, other tissue, what is missing
cp out.h5 before.h5
expect 2 "$lamella" merge out.h5 some.h5
cmp -s out.h5 before.h5 || fail "the result is replaced"
expect 2 -e 's.h5' -e 'thick.h5' "$lamella" merge new.h5 s.h5 thick.h5
expect 4 "$lamella" merge new.h5 s.h5 missing.h5
[ ! -e new.h5 ] || fail "a refused merge leaves a file"

# the result among the files
cp s.h5 grows.h5
expect 0 -o '"records": 60' "$lamella" merge grows.h5 grows.h5 some.h5 more.h5 --json

# damage: refused, and what is sound is salvaged
cp more.h5 bad.h5
printf 'damaged.' | dd of=bad.h5 bs=1 seek=40000 conv=notrunc status=none
expect 2 -e 'bad.h5: record' "$lamella" merge new.h5 s.h5 bad.h5
expect 0 -o '"records": 59.*"left_out": 1' "$lamella" merge new.h5 bad.h5 --salvage --json
grep -q 'bad.h5: record [0-9]* is damaged' err.txt || fail "what is left out is not named: $(cat err.txt)"
expect 2 "$lamella" merge new.h5 bad.h5 --salvage
expect 0 -o '60 (1 new)' "$lamella" build more.yaml -d new.h5 --resume --quiet
head -c 70000 more.h5 >cut.h5
expect 2 -e 'cut.h5: the file is damaged or cut short' "$lamella" merge short.h5 cut.h5 --salvage

# a file that is being written is merged as far as it is committed
cp some.h5 busy.h5
echo "$(uname -n) $$ 0 2026-01-01T00:00:00Z" >busy.h5.lock
expect 0 -e 'busy.h5: process .* is writing' "$lamella" merge with-busy.h5 s.h5 busy.h5
rm busy.h5.lock

# a full disk
expect 4 -e 'File too large' bash -c "ulimit -f 60; exec '$lamella' merge full.h5 some.h5 more.h5"
if ls full.h5* >/dev/null 2>&1; then fail "files are left behind: $(ls full.h5*)"; fi

# killed at any instant, or stopped: the file is as it was, and the next merge works
cp s.h5 kept.h5
files=(kept.h5)
for ((i = 0; i < 60; i++)); do files+=(some.h5); done
for delay in 0.02 0.05 0.08 0.11 0.15; do
  "$lamella" merge kept.h5 "${files[@]}" more.h5 --quiet >/dev/null 2>&1 &
  pid=$!
  sleep $delay
  kill -9 $pid 2>/dev/null || true
  wait $pid 2>/dev/null || true
  expect 0 "$lamella" info kept.h5 --json
  grep -qE '"records": (10|60),' out.txt || fail "after a kill: $(cat out.txt)"
done
expect 0 -o '"records": 60' "$lamella" merge kept.h5 "${files[@]}" more.h5 --json
[ ! -e kept.h5.tmp ] && [ ! -e kept.h5.lock ] || fail "files are left behind: $(ls)"
for ((i = 0; i < 600; i++)); do files+=(some.h5); done
"$lamella" merge stopped.h5 "${files[@]}" >/dev/null 2>&1 &
pid=$!
sleep 0.3
ends TERM 143 $pid
if ls stopped.h5* >/dev/null 2>&1; then fail "files are left behind: $(ls stopped.h5*)"; fi
