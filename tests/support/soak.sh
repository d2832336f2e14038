#!/bin/bash
# Random tests of shaders with other seeds, for as long as it is asked for:
#
#   tests/support/soak.sh SECONDS BUILD [FIRST]
#
# Runs the programs below of the build, again and again, with the seeds FIRST (1), FIRST + 1 ... in TRIPTYCH_SEED. A
# failure is shown with its seed and ends the run; a program that takes more than five minutes hangs. Prints a line per
# seed and last of all how many there were.
set -uo pipefail
cd "$(dirname "$0")/../.."

seconds=$1 build=$2 seed=${3:-1}
programs=(shader/mutate draw/shader_random spec/shader_random)
output=$(mktemp)
trap 'rm -f "$output"' EXIT
first=$seed

while ((SECONDS < seconds)); do
    for program in "${programs[@]}"; do
        status=0
        TRIPTYCH_SEED=$seed timeout -k 10 300 "$build/tests/$program" >"$output" 2>&1 </dev/null || status=$?
        if ((status)); then
            tail -n 60 "$output"
            echo "FAIL $program with seed $seed, status $status"
            exit 1
        fi
    done
    echo "ok seed $seed, $SECONDS s"
    seed=$((seed + 1))
done
echo "$((seed - first)) seeds from $first on, $SECONDS s, no failure"
