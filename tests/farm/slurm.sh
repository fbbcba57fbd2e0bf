# A private single-node Slurm for a test: own configuration, ports, key and folders, no systemd and no cgroups. Sourced.
#
# slurm_start FOLDER: starts munged, slurmctld and slurmd below FOLDER and points the client programs at them (SLURM_CONF); fails
# when the node is not idle after a minute. slurm_stop: ends what was started, and only that.

slurm_start() {
    slurm=$1
    node=$(hostname -s)
    mkdir -p "$slurm/munge" "$slurm/state" "$slurm/spool"
    chmod 755 "$slurm" && chmod 700 "$slurm/munge"
    head -c 128 /dev/urandom >"$slurm/munge/key" && chmod 400 "$slurm/munge/key"
    # Two ports of our own, beside those of a Slurm that may run here.
    port=$((20000 + $$ % 20000))
    cat >"$slurm/slurm.conf" <<CONF
ClusterName=ssdo
SlurmctldHost=$node(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$slurm/munge/socket
CredType=cred/munge
SlurmctldPort=$port
SlurmdPort=$((port + 1))
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/spool
SlurmctldPidFile=$slurm/slurmctld.pid
SlurmdPidFile=$slurm/slurmd.pid
SlurmctldLogFile=$slurm/slurmctld.log
SlurmdLogFile=$slurm/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=1,sched_interval=1
SlurmdParameters=config_overrides
ReturnToService=2
KillWait=20
MpiDefault=none
NodeName=$node NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=farm Nodes=$node Default=YES State=UP MaxTime=60
CONF
    echo "CgroupPlugin=cgroup/v1" >"$slurm/cgroup.conf"
    export SLURM_CONF="$slurm/slurm.conf"
    munged --socket="$slurm/munge/socket" --key-file="$slurm/munge/key" --pid-file="$slurm/munge/pid" \
        --log-file="$slurm/munge/log" --seed-file="$slurm/munge/seed" --force 2>"$slurm/munge/err" || return 1
    slurmctld -f "$SLURM_CONF" -i 2>>"$slurm/slurmctld.log" || return 1
    slurmd -f "$SLURM_CONF" 2>>"$slurm/slurmd.log" || return 1
    for i in $(seq 60); do
        case $(sinfo -h -o %T 2>/dev/null) in idle | mixed) return 0 ;; esac
        sleep 1
    done
    return 1
}

# By the ids in the files that the programs wrote themselves, slurmd first so that its jobs end.
slurm_stop() {
    [ -n "${slurm-}" ] || return 0
    for pidfile in "$slurm/slurmd.pid" "$slurm/slurmctld.pid" "$slurm/munge/pid"; do
        [ -s "$pidfile" ] && pid=$(cat "$pidfile") && kill "$pid" 2>/dev/null || continue
        for i in $(seq 100); do kill -0 "$pid" 2>/dev/null || break; sleep 0.1; done
        kill -9 "$pid" 2>/dev/null
    done
    slurm=
}
