# A SLURM of two nodes of two processors each, all on this machine, in the folder "$cluster"; no test. For scripts that
# have sourced ../cli/common.sh. Works as root and as any user that has a name; touches nothing outside the folder.
#   cluster_start               or ends the script: with status 77 where SLURM or munge are not installed
#   cluster_stop                what it has started has ended; call it from a trap
#   $SLURM_CONF                 its configuration, for sbatch and the others
# Jobs of partition `low` are preempted by those of `high`, after a warning by their --signal where it has one.

# free_port FIRST: a port of this machine that nobody listens to, from FIRST on
free_port() {
  port=$1
  while (exec 3<>/dev/tcp/127.0.0.1/"$port") 2>/dev/null; do port=$((port + 1)); done
  echo "$port"
}

cluster_configure() {
  local host first user
  host=$(hostname) user=$(id -un)
  first=$(free_port $((20000 + $$ % 20000)))
  cat >"$SLURM_CONF" <<CONF
ClusterName=lamella
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
# a requeued job begins when the credential of its last run has ended
AuthInfo=socket=$cluster/munge/socket,cred_expire=5
SlurmctldPort=$first
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd.%n.pid
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool/%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
SlurmdParameters=config_overrides
SlurmctldParameters=preempt_send_user_signal
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
KillWait=5
MailProg=/bin/true
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$(free_port $((first + 1))) CPUs=2 State=UNKNOWN
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$(free_port $((first + 2))) CPUs=2 State=UNKNOWN
PartitionName=low Nodes=n1,n2 Default=YES MaxTime=60 State=UP PriorityTier=1 GraceTime=20
PartitionName=high Nodes=n1,n2 MaxTime=60 State=UP PriorityTier=10 PreemptMode=OFF
CONF
  echo CgroupPlugin=cgroup/v1 >"$cluster/cgroup.conf" # none of its controllers is used
}

cluster_start() {
  local program
  PATH=$PATH:/usr/sbin
  for program in mpirun munged slurmctld slurmd sbatch; do
    command -v $program >/dev/null || exit 77
  done
  cluster=$work/cluster
  mkdir -p "$cluster"/{munge,state,spool,log}
  chmod 755 "$work" "$cluster" "$cluster/munge"
  export SLURM_CONF=$cluster/slurm.conf
  cluster_configure
  (umask 077 && head -c 1024 /dev/urandom >"$cluster/munge/key")
  munged --foreground --key-file="$cluster/munge/key" --socket="$cluster/munge/socket" --seed-file="$cluster/munge/seed" \
    --pid-file="$cluster/munge/pid" >"$cluster/log/munged" 2>&1 &
  daemons=$!
  for _ in $(seq 100); do [ -S "$cluster/munge/socket" ] && break || sleep 0.1; done
  slurmctld -D >"$cluster/log/slurmctld" 2>&1 &
  daemons="$daemons $!"
  for node in n1 n2; do
    slurmd -D -N $node >"$cluster/log/slurmd.$node" 2>&1 &
    daemons="$daemons $!"
  done
  for _ in $(seq 100); do
    [ "$(sinfo -h -o %D -t idle -p low 2>/dev/null)" = 2 ] && return
    sleep 0.2
  done
  fail "SLURM does not start: $(tail -n 3 "$cluster"/log/*)"
  exit 1
}

# Jobs first; then whatever has this cluster's configuration in its environment, which the daemons have, too.
cluster_stop() {
  local process
  [ -n "${daemons-}" ] || return 0
  scancel --user="$(id -un)" 2>/dev/null
  {
    for process in /proc/[0-9]*; do
      grep -qsz "^SLURM_CONF=$SLURM_CONF" "$process/environ" && kill -KILL "${process#/proc/}"
    done
    wait $daemons
  } 2>/dev/null
  daemons=
}
