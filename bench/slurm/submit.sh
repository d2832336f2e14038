#!/bin/bash
# Submits a campaign to Slurm: an array of shards, and a job that merges them (docs/campaigns.md).
#
#   bench/slurm/submit.sh FOLDER SHARDS COMMAND [ARGUMENT]...
#
# COMMAND is fuzz, verify, bench or claims of triptych, with its options and streams, but without --shard,
# --resume and --json. FOLDER is new, and on a file system that all nodes share. TRIPTYCH is the program
# (build/triptych); SBATCH_OPTIONS has more options of sbatch, such as "--partition=long --time=8:00:00".
# Prints the numbers of the two jobs.
#
# Submit a shard again with: sbatch --array=I bench/slurm/shard.sh FOLDER SHARDS
set -euo pipefail

stop() # REASON
{
    printf 'submit: %s\n' "$1" >&2
    exit 2
}

(($# >= 3)) || stop 'expected FOLDER SHARDS COMMAND [ARGUMENT]...'
folder=$1 shards=$2
shift 2
[[ $shards =~ ^[1-9][0-9]*$ ]] || stop "SHARDS is \"$shards\", expected a number from 1"
[[ $1 =~ ^(fuzz|verify|bench|claims)$ ]] || stop "COMMAND is \"$1\", expected fuzz, verify, bench or claims"
here=$(cd "$(dirname "$0")" && pwd)
triptych=$(realpath -e "${TRIPTYCH:-$here/../../build/triptych}") || stop 'no build/triptych, expected TRIPTYCH'
mkdir -p "$(dirname "$folder")"
mkdir "$folder" || stop "$folder exists, expected a new folder"
folder=$(realpath "$folder")
printf '%s\0' "$triptych" "$@" >"$folder/command"

read -ra options <<<"${SBATCH_OPTIONS-}"
array=$(sbatch --parsable "${options[@]}" --array="1-$shards" --output="$folder/log-%a.txt" \
    "$here/shard.sh" "$folder" "$shards")
# After any end: what is missing is then reported.
merge=$(sbatch --parsable "${options[@]}" --dependency="afterany:${array%%;*}" \
    --output="$folder/log-merge.txt" "$here/merge.sh" "$folder")
printf 'shards: job %s, merge: job %s\n' "${array%%;*}" "${merge%%;*}"
