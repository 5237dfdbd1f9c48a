# Scenes that are wrong: exit status 2, a message with file, line, key and value, nothing written.
. "$(dirname "$0")/common.sh"

# refused WORDS COMMAND...: status 2, the words on stderr, nothing on stdout
refused() {
  expect 2 -e "$(sed 's/[]*.[]/\\&/g' <<<"$1")" "${@:2}"
  [ "$(wc -l <err.txt)" -eq 1 ] || fail "more than one line: $*: $(cat err.txt)"
  [ -s out.txt ] && fail "writes to stdout: $*: $(cat out.txt)"
}

# The reader's own tests go through all of tests/scenes/bad.txt; here, that its words arrive.
# wrong SCENE EDIT WORDS: that scene of tests/scenes, edited
wrong() {
  sed "$2" "$source/tests/scenes/$1.yaml" >bad.yaml
  refused "lamella: bad.yaml:$3" "$lamella" check bad.yaml
}
wrong shear-bonded 's/0 deg/30/' '4:65: rve.cell.orientation: 30: has no unit'
wrong shear-bonded 's/C4: 1/C2: 1/' '6:63: rve.wall.C2: given twice, first in line 6'
wrong shear-bonded 's/F: \[\[1, 0.3/F: [[.nan, 0.3/' '12:11: load[2].F[1][1]: .nan: is not a finite number'
wrong tissue-block 's/top/front/' '16:12: macro.boundary[2].on: front: is none of the names known here'
wrong shear-bonded 's/F: \[\[1, 0.1/F: [[1e200, 0.1/' '11:11: load[1].F[1][1]: 1e200: is out of range'
refused "bad.yaml:11:11: load[1].F[1][1]: 1e200" "$lamella" rve bad.yaml -o out.h5
[ -z "$(ls out.h5* 2>/dev/null)" ] || fail "a wrong scene leaves $(ls out.h5*)"

# blocks that a command needs
refused "no block \`load\`" "$lamella" rve "$source/tests/scenes/tissue-block.yaml" -o out.h5
refused "no block \`sample\`" "$lamella" build "$source/tests/scenes/shear-bonded.yaml" -d out.h5
[ -z "$(ls out.h5* 2>/dev/null)" ] || fail "a scene without a block leaves $(ls out.h5*)"
