#!/bin/bash
# Merges the shards of a campaign: the job that follows the array of submit.sh (docs/campaigns.md).
#
#   merge.sh FOLDER
#
# Writes FOLDER/results.json, and FOLDER/canonical.json, the normal form. Prints what is missing.
#SBATCH --job-name=triptych-merge
#SBATCH --open-mode=append
set -uo pipefail

folder=$1
mapfile -d '' -t words <"$folder/command" || exit 2
"${words[0]}" merge "$folder/results.json" "$folder"/part-*.json || exit
"${words[0]}" merge --canonical "$folder/canonical.json" "$folder"/part-*.json
