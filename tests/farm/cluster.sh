# SPDX-License-Identifier: GPL-3.0-or-later
# A Slurm of one controller and two nodes on this machine, all under one folder, for farm.sh: `. cluster.sh FOLDER`. Needs root. Sets
# SLURM_CONF, and CLUSTER_PIDS. clusterDown ends all that it started.

cluster=$(mkdir -p "$1" && cd "$1" && pwd)
host=$(hostname -s)
declare -A CLUSTER_PIDS=()
export SLURM_CONF=$cluster/slurm.conf

clusterUp() {
    mkdir -p "$cluster"/{state,spool-n1,spool-n2}
    dd if=/dev/urandom of="$cluster/munge.key" bs=128 count=1 status=none
    chmod 600 "$cluster/munge.key"
    cat > "$SLURM_CONF" <<CONF
ClusterName=hairloom
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=16817
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$cluster/munge.socket,cred_expire=20
CredType=cred/munge
CryptoType=crypto/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool-%n
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd-%n.pid
SlurmctldLogFile=$cluster/slurmctld.log
SlurmdLogFile=$cluster/slurmd-%n.log
SlurmdTimeout=10
MessageTimeout=5
KillWait=5
ReturnToService=2
JobRequeue=1
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=16821 CPUs=1 State=UNKNOWN
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=16822 CPUs=1 State=UNKNOWN
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
CONF
    # Munge wants folders that only its user writes: /tmp is none.
    start munged munged --foreground --force --socket="$cluster/munge.socket" --key-file="$cluster/munge.key" \
        --pid-file="$cluster/munged.pid" --seed-file="$cluster/munged.seed" --log-file="$cluster/munged.log"
    waitFor "munged" test -S "$cluster/munge.socket"
    start slurmctld slurmctld -D -c
    start n1 slurmd -D -N n1
    start n2 slurmd -D -N n2
    waitFor "two idle nodes" nodesIdle
}

nodesIdle() { [ "$(sinfo -h -N -o '%T' 2>/dev/null | grep -c '^idle$')" -eq 2 ]; }

# start NAME PROGRAM…
start() {
    local name=$1
    shift
    "$@" > "$cluster/$name.out" 2>&1 &
    CLUSTER_PIDS[$name]=$!
}

# waitFor WHAT COMMAND…: for a minute.
waitFor() {
    local what=$1 i
    shift
    for ((i = 0; i < 120; i++)); do
        if "$@" 2>/dev/null; then return; fi
        sleep 0.5
    done
    echo "error: no $what within a minute; see $cluster" >&2
    return 1
}

# nodeDies NAME: the daemon, its steps and their tasks at once, as when the machine loses its power. A step that lived would report its
# task as failed, which is another thing: Slurm does not run that again.
nodeDies() {
    local environment task step
    kill -9 "${CLUSTER_PIDS[$1]}"
    unset "CLUSTER_PIDS[$1]"
    for environment in /proc/[0-9]*/environ; do
        { tr '\0' '\n' < "$environment" | grep -x -e "SLURMD_NODENAME=$1" -e "SLURM_CONF=$SLURM_CONF" | sort -u | wc -l | grep -qx 2; } 2>/dev/null || continue
        task=${environment#/proc/} task=${task%/environ} step=$task
        while [ "$step" -gt 1 ] && [ "$(cat "/proc/$step/comm" 2>/dev/null)" != slurmstepd ]; do
            step=$(awk '/^PPid:/ { print $2 }' "/proc/$step/status" 2>/dev/null || echo 1)
        done
        [ "$step" -le 1 ] || kill -9 "$step" 2>/dev/null || true
        kill -9 "$task" 2>/dev/null || true
    done
}

clusterDown() {
    local name
    for name in n1 n2 slurmctld munged; do
        [ -z "${CLUSTER_PIDS[$name]:-}" ] || kill "${CLUSTER_PIDS[$name]}" 2>/dev/null || true
    done
    wait 2>/dev/null || true
}
