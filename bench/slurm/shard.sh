#!/bin/bash
# One shard of a campaign: a task of the array that submit.sh submits (docs/campaigns.md).
#
#   shard.sh FOLDER SHARDS
#
# FOLDER/command has the words of the triptych command, each ended by a zero byte. The task with the number I
# draws shard I of SHARDS, and keeps its results in FOLDER/part-I.json. If the task starts again, on any node
# with the same folder, it continues from there. Before its time limit it ends and
# returns to the queue.
#SBATCH --job-name=triptych
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:TERM@60
set -uo pipefail

folder=$1 shards=$2
task=${SLURM_ARRAY_TASK_ID:?is not set, expected a task of an array}
mapfile -d '' -t words <"$folder/command" || exit 2
printf 'shard %d of %d: start %d, on %s\n' "$task" "$shards" "$((${SLURM_RESTART_COUNT-0} + 1))" \
    "${SLURMD_NODENAME-$HOSTNAME}"

# Claims are kept as the outputs of their experiments, in a folder.
part=$folder/part-$task.json
keep=(--resume "$part")
if [[ ${words[1]} == claims ]]; then
    mkdir -p "$folder/claims-$task/claims"
    keep=(--resume --results "$folder/claims-$task")
fi

"${words[@]}" --shard "$task/$shards" "${keep[@]}" &
child=$!
trap 'kill -TERM "$child"' TERM
wait "$child"
status=$?
# A signal ends the first wait. The second has the status of the command.
while kill -0 "$child" 2>/dev/null; do
    wait "$child"
    status=$?
done

[[ ${words[1]} == claims ]] && ((status <= 1)) && mv "$folder/claims-$task/claims/part-$task.json" "$part"
case $status in
    0 | 1) exit 0 ;; # complete; 1: with findings or differences, which the merged results have
    130 | 143) scontrol requeue "$SLURM_JOB_ID" ;;
    *) exit "$status" ;;
esac
