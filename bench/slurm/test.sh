#!/bin/bash
# `make campaign-slurm-test`: a campaign on a Slurm of this machine. One controller and four slurmd on
# 127.0.0.1; one slurmd and its jobs are killed in the middle and started again. The merged results must be
# those of one run, byte for byte.
#
#   CASES=600 SHARDS=8 SEED=21 OPTIONS="--engines emulate,batch" TIMEOUT=1800 OUTPUT=FOLDER \
#       bench/slurm/test.sh
#
# OUTPUT keeps the merged results, results.json and canonical.json, in that folder.
# Every process that the script starts ends with it. It reads and changes no configuration of the system.
set -uo pipefail
cd "$(dirname "$0")/../.."

cases=${CASES:-600} shards=${SHARDS:-8} seed=${SEED:-21} limit=${TIMEOUT:-1800}
triptych=$(realpath "${BUILD:-build}/triptych")
read -ra options <<<"${OPTIONS-}"
nodes=4
work=$(mktemp -d /tmp/triptych-slurm-XXXXXX)
campaign=$work/campaign
controller=
declare -A daemon
export SLURM_CONF=$work/slurm.conf
unset "${!SLURM_ARRAY@}" "${!SBATCH_@}" SLURM_JOB_ID

# Processes of jobs on a node, or on all nodes, and the slurmstepd that started them.
jobs_of() # [NODE]
{
    local file pid parent
    for file in $(grep -lzsx "SLURM_CONF=$SLURM_CONF" /proc/[0-9]*/environ); do
        pid=${file//[!0-9]/}
        grep -qzsx "SLURMD_NODENAME=${1:-node[0-9]*}" "$file" || continue
        printf '%s\n' "$pid"
        parent=$(sed -n 's/^PPid:\t//p' "/proc/$pid/status" 2>/dev/null)
        [[ $(cat "/proc/$parent/comm" 2>/dev/null) == slurmstepd ]] && printf '%s\n' "$parent"
    done | sort -u
}

finish()
{
    local status=$? pids
    pids=$(jobs_of)
    # The braces redirect bash's own messages about the signals.
    { kill -KILL "${daemon[@]}" $controller $pids && wait; } 2>/dev/null
    if ((status)); then
        printf 'the files are in %s\n' "$work"
    else
        rm -rf "$work"
    fi
}
trap finish EXIT

fail() # REASON
{
    printf 'FAIL %s\n' "$1"
    tail -n 5 "$work"/*.log 2>/dev/null
    exit 1
}

configure()
{
    local first=$((20000 + RANDOM % 20000)) i
    mkdir "$work/state"
    cat >"$SLURM_CONF" <<END
ClusterName=triptych
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$first
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/none
CredType=cred/none
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
MpiDefault=none
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/linear
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=2
ReturnToService=2
SlurmctldTimeout=30
SlurmdTimeout=10
KillWait=5
MessageTimeout=5
SlurmdParameters=config_overrides
StateSaveLocation=$work/state
SlurmctldPidFile=$work/slurmctld.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdSpoolDir=$work/spool.%n
SlurmdPidFile=$work/slurmd.%n.pid
SlurmdLogFile=$work/slurmd.%n.log
END
    for ((i = 1; i <= nodes; i++)); do
        printf 'NodeName=node%d NodeHostname=%s NodeAddr=127.0.0.1 Port=%d CPUs=1\n' "$i" "$(hostname -s)" \
            "$((first + i))" >>"$SLURM_CONF"
        mkdir "$work/spool.node$i"
    done
    printf 'PartitionName=all Nodes=ALL Default=YES State=UP\n' >>"$SLURM_CONF"
}

start_node() # NUMBER
{
    slurmd -D -N "node$1" -f "$SLURM_CONF" >>"$work/node$1.out" 2>&1 &
    daemon[$1]=$!
}

idle() # COUNT : waits until that number of nodes is up
{
    local i
    for ((i = 0; i < 60; i++)); do
        (($(sinfo -h -N -o '%T' 2>/dev/null | grep -cE '^(idle|allocated|mixed|completing)$') >= $1)) && return 0
        sleep 1
    done
    return 1
}

# The running shard of a node that has results of some cases, but not of all.
shard_on() # NODE
{
    local task
    for task in $(squeue -h -r -t R -w "$1" -o '%K' 2>/dev/null); do
        grep -qs '"interrupted":.true' "$campaign/part-$task.json" && printf '%s\n' "$task" && return 0
    done
    return 1
}

# Kills the daemon and the jobs of the first node that has drawn a part of a shard, as a power failure would.
lose_node()
{
    local i node task= pid
    for ((i = 0; i < limit * 5; i++)); do
        for ((node = 1; node <= nodes; node++)); do
            task=$(shard_on "node$node") && break 2
        done
        sleep 0.2
    done
    [[ $task ]] || fail 'no shard has written a part of its results'
    kill -KILL "${daemon[$node]}"
    for pid in $(jobs_of "node$node"); do kill -KILL "$pid" 2>/dev/null; done
    wait "${daemon[$node]}" 2>/dev/null
    lost=$node lost_task=$task
    lost_done=$(sed -n 's/^\t"done":\t"\(.*\)",$/\1/p' "$campaign/part-$task.json")
    printf 'killed node%d in shard %d, which has cases %s\n' "$node" "$task" "$lost_done"
}

# A job that lost its node waits two minutes in the queue. There is no reason to wait here.
hasten()
{
    local job
    for job in $(squeue -h -r -t PD -o '%A %r' 2>/dev/null | awk '$2 == "BeginTime" { print $1 }'); do
        scontrol update "JobId=$job" StartTime=now 2>/dev/null
    done
}

await() # waits until no job is left
{
    local i
    for ((i = 0; i < limit; i++)); do
        [[ $(squeue -h 2>/dev/null || echo error) ]] || return 0
        hasten
        sleep 1
    done
    squeue
    return 1
}

configure
slurmctld -D -f "$SLURM_CONF" >"$work/slurmctld.out" 2>&1 &
controller=$!
for ((i = 1; i <= nodes; i++)); do start_node "$i"; done
idle "$nodes" || fail 'the nodes are not up'
printf '%d slurmd of %s are up\n' "$nodes" "$(slurmd -V)"

fuzz=(fuzz --seed "$seed" --count "$cases" --output "$work/findings" "${options[@]}")
TRIPTYCH=$triptych bench/slurm/submit.sh "$campaign" "$shards" "${fuzz[@]}" --checkpoint 0 || fail 'submit.sh'
lose_node
sleep 2
start_node "$lost"
await || fail 'jobs are left'
idle "$nodes" || fail 'the node is not up again'
cat "$campaign/log-$lost_task.txt" "$campaign/log-merge.txt"
grep -q "^shard $lost_task of $shards: start 2" "$campaign/log-$lost_task.txt" || fail 'the shard did not start again'
grep -q "$cases of $cases units" "$campaign/log-merge.txt" || fail 'the merged results are not complete'

"$triptych" "${fuzz[@]}" --json "$work/one.json" --jobs 2
(($? <= 1)) || fail 'the one run'
"$triptych" merge --canonical "$work/one-canonical.json" "$work/one.json" || fail 'the normal form of the one run'
cmp "$work/one-canonical.json" "$campaign/canonical.json" || fail 'the merged results are not those of one run'
[[ -z ${OUTPUT-} ]] || { mkdir -p "$OUTPUT" && cp "$campaign/results.json" "$campaign/canonical.json" "$OUTPUT"; } ||
    fail "the results are not in $OUTPUT"
printf 'ok %d cases in %d shards, one node lost: the results of one run, byte for byte\n' "$cases" "$shards"
