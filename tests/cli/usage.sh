# The command line: help, versions, mistakes of usage, errors of writing.
. "$(dirname "$0")/common.sh"

# expect STATUS WORDS COMMAND...: the exit status, and words in what is said on stdout or stderr
expect() {
  wanted=$1 words=$2
  shift 2
  "$@" >out.txt 2>err.txt </dev/null
  status=$?
  [ $status -eq "$wanted" ] || fail "exit status $status instead of $wanted: $*: $(cat err.txt)"
  grep -qF -e "$words" out.txt err.txt || fail "no \"$words\" from: $*: $(cat out.txt err.txt)"
}

expect 1 "Usage: lamella COMMAND" "$lamella"
[ -s out.txt ] && fail "a mistake of usage writes to stdout"
expect 0 "Usage: lamella COMMAND" "$lamella" --help
[ -s err.txt ] && fail "help goes to stderr"
cp out.txt help.txt
expect 0 "Usage: lamella COMMAND" "$lamella" help
cmp -s out.txt help.txt || fail "help differs from --help"
expect 1 "did you mean 'query'" "$lamella" help qeury
expect 1 "one argument too many" "$lamella" help rve fe2
expect 0 "Usage: lamella help" "$lamella" help help
for command in check rve build query verify fe2 process tradeoff map tear plot info; do
  grep -q "^  $command " help.txt || fail "--help does not name $command"
  expect 0 "Usage: lamella $command" served $command --help
  [ -s err.txt ] && fail "$command --help goes to stderr"
  cp out.txt command.txt
  expect 0 "Usage: lamella $command" served help $command
  cmp -s out.txt command.txt || fail "help $command differs from $command --help"
  expect 1 "lamella $command --help" served $command
  expect 1 "lamella $command --help" served $command a b
  expect 1 "--no-such-option" served $command --no-such-option
done

# numbers that may have a decimal comma, options of other commands, a tissue file in place of a scene
tissue <<<'load: [{F: [[1.01, 0], [0, 1]]}]' >scene.yaml
expect 1 "--at 0,01: give at most 16 strains, such as --at 0.01,0.05; the decimal sign" "$lamella" rve scene.yaml --at 0,01
expect 1 "--at abc: give at most 16 strains" "$lamella" rve scene.yaml --at abc
expect 1 '--turgor "abc MPa": is not a number with a unit; write a stress such as 0.1 MPa' "$lamella" tear scene.yaml --turgor "0,abc MPa"
expect 1 '--turgor "0,3 MPa": one turgor with a decimal comma, or two?' "$lamella" tear scene.yaml --turgor "0,3 MPa"
expect 1 "option '--uncertainty' is of lamella rve and lamella process; lamella fe2 does not" "$lamella" fe2 scene.yaml --uncertainty 3
expect 1 "option '--realisations' is of lamella rve; lamella map does not" "$lamella" map scene.yaml --realisations 3
echo '{"lamella_tissue": 1}' >tissue.json
expect 2 "tissue.json:1:3: lamella_tissue: this is a tissue file, not a scene; write a scene with rve: {tissue: FILE}" "$lamella" rve tissue.json

version=$(sed -n 's/^project(lamella VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
expect 0 "lamella $version" "$lamella" --version
for library in PETSc HDF5 SUNDIALS MPI; do
  grep -qE "^$library .*[0-9]+\.[0-9]+" out.txt || fail "--version does not name $library: $(cat out.txt)"
done

expect 1 "did you mean 'query'" "$lamella" qeury db.h5
expect 1 "did you mean '--version'" "$lamella" --versoin
expect 1 "'frobnicate' is unknown" "$lamella" frobnicate
expect 1 "did you mean '--json'" "$lamella" check --jsom scene.yaml
expect 1 "option '-o' needs a value" "$lamella" rve scene.yaml -o
expect 1 "option '--output' needs a value" "$lamella" rve scene.yaml --output
expect 1 "option '--output' needs a value" "$lamella" rve scene.yaml --output=
expect 1 "option '--json=yes' takes no value" "$lamella" check scene.yaml --json=yes
expect 1 "a whole number from 1 on" "$lamella" verify db.h5 --samples 1.5
expect 1 "a whole number from 0 on" "$lamella" verify db.h5 --seed -1
expect 1 "a relative error is wanted" "$lamella" verify db.h5 --accuracy none
expect 2 "missing.yaml" "$lamella" check missing.yaml
expect 4 "missing.h5" "$lamella" info missing.h5

# what follows -- is for PETSc alone, and PETSc sees nothing else
scene=$source/tests/scenes/shear-bonded.yaml
expect 0 '"unknowns": 644' "$lamella" check "$scene" --json -- --no-such-option
expect 1 "one argument too many" "$lamella" check "$scene" extra -- more
expect 0 "Petsc Release Version" "$lamella" rve "$scene" --quiet -- -version

# stdout that cannot be written
if [ -w /dev/full ]; then
  "$lamella" --help >/dev/full 2>err.txt
  [ $? -eq 4 ] && grep -q "standard output" err.txt || fail "a full disk goes unnoticed: $(cat err.txt)"
  "$lamella" check "$scene" --json >/dev/full 2>err.txt
  [ $? -eq 4 ] && grep -q "standard output" err.txt || fail "JSON on a full disk goes unnoticed: $(cat err.txt)"
fi
("$lamella" check "$scene" 2>err.txt; echo $? >status.txt) | true
case $(cat status.txt) in
0) ;; # written before the reader was gone
4) grep -q "standard output" err.txt || fail "a closed pipe is not told: $(cat err.txt)" ;;
*) fail "a closed pipe ends with status $(cat status.txt)" ;;
esac

# options and blocks that do nothing by themselves
expect 1 "--direction: is of --elongation RATIO, which is missing" "$lamella" tissue -o t.json --cells 9 --size "60 um" --direction "30 deg"
expect 0 "failure.yaml: strength: is not used without --failure" "$lamella" rve "$source/tests/scenes/failure.yaml"
expect 0 "failure" "$lamella" rve "$source/tests/scenes/failure.yaml" --failure
! grep -q "not used" err.txt || fail "strengths that --failure uses are said not to be used: $(cat err.txt)"
