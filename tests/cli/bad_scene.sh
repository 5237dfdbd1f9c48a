# Scenes that are wrong: exit status 2, a message with file, line, key and value, nothing written.
. "$(dirname "$0")/common.sh"

# refused WORDS COMMAND...: status 2, the words on stderr, nothing on stdout
refused() {
  words=$1
  shift
  "$@" >out.txt 2>err.txt
  status=$?
  [ $status -eq 2 ] || fail "exit status $status instead of 2: $*: $(cat err.txt)"
  grep -qF -e "$words" err.txt || fail "no \"$words\": $*: $(cat err.txt)"
  [ "$(wc -l <err.txt)" -eq 1 ] || fail "more than one line: $*: $(cat err.txt)"
  [ -s out.txt ] && fail "writes to stdout: $*: $(cat out.txt)"
}

# The reader's own tests go through all of tests/scenes/bad; here, that its words arrive (their first line has them).
for name in F-huge angle-without-unit duplicate-key F-nan macro-unknown-side; do
  file=$source/tests/scenes/bad/$name.yaml
  words=$(sed -n '1s/^# expect: //p' "$file")
  refused "lamella: $file:${words%% *}" "$lamella" check "$file"
  refused "$words" "$lamella" check "$file"
done
refused "F-huge.yaml:8:11: load[1].F[1][1]: 1e200" "$lamella" rve "$source/tests/scenes/bad/F-huge.yaml" -o out.h5
[ -z "$(ls out.h5* 2>/dev/null)" ] || fail "a wrong scene leaves $(ls out.h5*)"

# blocks that a command needs
refused "no block \`load\`" "$lamella" rve "$source/tests/scenes/tissue-block.yaml" -o out.h5
refused "no block \`sample\`" "$lamella" build "$source/tests/scenes/shear-bonded.yaml" -d out.h5
[ -z "$(ls out.h5* 2>/dev/null)" ] || fail "a scene without a block leaves $(ls out.h5*)"
