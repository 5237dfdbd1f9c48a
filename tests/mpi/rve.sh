# rve on two ranks: rank 0 solves the chain; output, mistakes and exit status as in serial.
. "$(dirname "$0")/../cli/common.sh"

scene=$source/tests/scenes/shear-bonded.yaml
"$lamella" rve "$scene" --json >one.txt || fail "serial: exit status $?"
mpirun -n 2 "$lamella" rve "$scene" --json -o two.h5 >two.txt || fail "two ranks: exit status $?"
sed 's/"seconds": [^,]*,//' one.txt >one.cut
sed 's/"seconds": [^,]*,//' two.txt >two.cut
cmp -s one.cut two.cut || fail "the states depend on the number of ranks: $(diff one.cut two.cut)"

# a mistake in the scene, and one in the usage, are told once
sed 's/\[\[1, 0.1/[[1e200, 0.1/' "$scene" >huge.yaml
expect 2 mpirun -n 2 "$lamella" rve huge.yaml
[ "$(grep -c 'huge.yaml:11:11' err.txt)" -eq 1 ] || fail "a wrong scene is not told once: $(cat err.txt)"
expect 2 mpirun -n 2 "$lamella" build huge.yaml -d db.h5
[ "$(grep -c 'huge.yaml:11:11' err.txt)" -eq 1 ] || fail "a wrong scene is not told once by all ranks: $(cat err.txt)"
expect 1 mpirun -n 2 "$lamella" rve --no-such-option
[ "$(grep -c 'is unknown' err.txt)" -eq 1 ] || fail "a mistake of usage is not told once: $(cat err.txt)"

# a rank that is alone with its error ends the job, and its words are seen
# (a script, since mpirun of Open MPI 5.0.7 crashes on two programs with a colon between them)
cat >alone.sh <<'SH'
if [ "$OMPI_COMM_WORLD_RANK" = 0 ]; then scene=$2; else scene=missing.yaml; fi
exec "$1" build "$scene" -d alone.h5
SH
expect 2 -e 'lamella: missing.yaml' mpirun -n 2 sh alone.sh "$lamella" "$source/tests/scenes/tissue-block.yaml"
