# slow: the job scripts of docs/reference/batch under a real SLURM: preempted, signalled, killed, at the time limit, as an array
. "$(dirname "$0")/../cli/common.sh"
. "$source/tests/batch/common.sh"
trap 'status=$?; cluster_stop; rm -rf "$work"; [ $failures -eq 0 ] || status=1; exit $status' EXIT

export LAMELLA=$lamella
# what a rank leaves behind that is killed goes into this folder, too
export TMPDIR=$work/tmp OMPI_MCA_btl_vader_backing_directory=$work/tmp
# both nodes are this machine, which need not have a network
export OMPI_MCA_oob_tcp_if_include=lo OMPI_MCA_btl_tcp_if_include=lo
mkdir tmp
build=$source/docs/reference/batch/build.sbatch merge=$source/docs/reference/batch/merge.sbatch

# by SECONDS COMMAND...: the command succeeds by then; else the script ends
by() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    if [ $SECONDS -ge $end ]; then
      fail "in vain: $* ($(squeue -h -o '%i %T %r') $(tail -n 4 ./*.log))"
      exit 1
    fi
    sleep 0.2
  done
}
# job NAME OPTIONS... SCRIPT ARGUMENTS...: its number; what it prints is in NAME.log
job() { sbatch --parsable --time=30 --job-name="$1" --output="$1.log" "${@:2}" || fail "sbatch $*"; }
# of JOB MEMBER: as `scontrol show job` has it
of() { scontrol show job "$1" | grep -o -m 1 "\<$2=[^ ]*" | sed 's/.*=//'; }
is() { [ "$(of "$1" JobState)" = "$2" ]; }
runs_again() { is "$1" RUNNING && [ "$(of "$1" Restarts)" = "$2" ]; }
# records FILE: committed; 0 where there is no file yet
records() { "$lamella" info "$1" --json 2>/dev/null | sed 's/.*"records":\s*\([0-9]*\).*/\1/' | grep . || echo 0; }
more() { [ "$(records "$1")" -gt "$2" ]; }

tissue mesh='along: 9, through: 3' >bonded.yaml <<'YAML'
sample: {stretch: {min: 0, max: 0.1}, turgor: {min: 0.01 MPa, max: 0.03 MPa}, count: 60}
YAML
sed 's/law: bonded/law: contact, cohesion: 0.002 MPa/; s/max: 0.1}/max: 0.06}/; s/min: 0.01/min: 0.02/; s/count: 60/count: 120/' \
  bonded.yaml | sed 's/along: 9, through: 3/along: 12, through: 4/' >contact.yaml
# never over before SLURM looks at its time limit, which it does every half minute
sed 's/count: 120/count: 20000/; s/along: 12, through: 4/along: 15, through: 5/; $a accuracy: 1e-5' contact.yaml >long.yaml

cluster_start

# ---- a job that comes to its time limit saves and goes on; a cancelled one does not come back ----
limited=$(job limited --ntasks=1 --time=1 --signal=B:USR1@50 "$build" long.yaml long.h5)
for scene in bonded contact; do
  "$lamella" build $scene.yaml -d $scene.h5 --quiet >$scene.txt || fail "$scene: $(cat $scene.txt)"
done
by 90 runs_again "$limited" 1
grep -q 'stopped by a signal' limited.log || fail "not saved before the time limit: $(cat limited.log)"
kept=$(records long.h5)
by 60 more long.h5 "$kept"
scancel "$limited"
by 30 is "$limited" CANCELLED

# ---- one job on both nodes, disturbed in every way ----
one=$(job one --nodes=2 --ntasks=2 "$build" contact.yaml one.h5)
restarts=0 kept=0
# disturb NAME COMMAND...: once more is committed than before, and the job is on its way again afterwards
disturb() {
  by 60 more one.h5 "$kept"
  is "$one" RUNNING || fail "$1: the build has ended before"
  kept=$(records one.h5)
  restarts=$((restarts + 1))
  "${@:2}" >/dev/null || fail "$1: $*"
  by 90 runs_again "$one" $restarts
  [ "$(records one.h5)" -ge "$kept" ] || fail "$1: $kept records, then $(records one.h5)"
  kept=$(records one.h5)
}
preempt() { sbatch --partition=high --nodes=2 --ntasks=4 --output=/dev/null --wrap true; }
requeue_killed() {
  scancel --signal=KILL "$one"
  by 30 is "$one" CANCELLED
  scontrol requeue "$one"
}
saved() { grep -c 'stopped by a signal' one.log; }

disturb "preempted with a warning" preempt
[ "$(saved)" = 1 ] || fail "not saved at a warning: $(cat one.log)"
disturb "USR1 to the steps" scancel --signal=USR1 "$one"
disturb "USR1 to all processes" scancel --signal=USR1 --full "$one"
[ "$(saved)" = 3 ] || fail "not saved at USR1: $(cat one.log)"
disturb "killed and requeued" requeue_killed
sed -i '/preempt_send_user_signal/d' "$SLURM_CONF"
scontrol reconfigure
disturb "preempted without a warning" preempt
by 120 is "$one" COMPLETED
same one.h5 contact.h5 || fail "the disturbed build differs from an undisturbed one: $(cat one.log)"

# ---- ranks started by srun get signals themselves ----
if srun --mpi=list 2>&1 | grep -q pmix; then
  steps=$(LAUNCH="srun --mpi=pmix" job steps --ntasks=2 --nodes=1 "$build" bonded.yaml steps.h5)
  by 60 more steps.h5 0
  scancel --signal=TERM "$steps"
  by 120 is "$steps" COMPLETED
  grep -q 'stopped by a signal' steps.log || fail "not saved at TERM: $(cat steps.log)"
  same steps.h5 bonded.h5 || fail "ranks started by srun: the build differs from an undisturbed one"
fi

# ---- an array of shards, one of which is stopped; their union waits for it, and gets what it lacks ----
shards=$(job part --array=1-3 --ntasks=1 --output=part.%a.log "$build" contact.yaml part.%a.h5 --shard %a/3)
union=$(job union --dependency=afterany:"$shards" "$merge" union.h5 part.{1..3}.h5)
whole=$(job whole --dependency=afterok:"$union" --ntasks=2 --nodes=1 "$build" contact.yaml union.h5)
by 60 more part.2.h5 0
scancel --signal=USR1 --batch "${shards}_2"
by 120 is "$whole" COMPLETED
[ "$(of "${shards}_2" Restarts)" = 1 ] || fail "the stopped shard was not started again: $(cat part.2.log)"
[[ ! $(of "$union" StartTime) < $(of "${shards}_2" EndTime) ]] || fail "the merge has not waited for the stopped shard"
same contact.h5 union.h5 known || fail "the union of shards differs from a build in one: $(cat union.log whole.log)"
