#!/bin/bash
# Runs random tests with one seed after another, for the requested time:
#
#   tests/support/scripts/soak.sh SECONDS BUILD INSTRUMENTED [FIRST]
#
# For each of the seeds FIRST (default 1), FIRST + 1 ... it runs a campaign of `triptych fuzz` on BUILD, at
# most a minute long; a shorter campaign on INSTRUMENTED; and the programs of INSTRUMENTED that use
# TRIPTYCH_SEED (tests/support/system/seed.h). Findings are written to INSTRUMENTED/soak: reduced streams that
# show a difference, and the output of failing programs. A failure does not end the run. A program that needs
# more than five minutes counts as hanging.
#
# Prints a line for each seed, on a terminal also the current step, and at the end or after an interrupt a
# summary. Ends non-zero if something failed.
set -uo pipefail
cd "$(dirname "$0")/../../.."

seconds=$1 build=$2 instrumented=$3 seed=${4:-1}
mapfile -t programs < <(grep -rl '^#include "tests/support/system/seed.h"' --include='*.c' tests --exclude-dir=support | sort | sed 's/\.c$//')
((${#programs[@]})) || { echo 'FAIL there are programs with seeds' && exit 1; }
found=$instrumented/soak
mkdir -p "$found"
output=$(mktemp)
trap 'rm -f "$output"' EXIT
cases=0 runs=0 failures=0 seeds=0 interrupted=

working() # WHAT : on a terminal, in place
{
    [[ ! -t 1 ]] || printf '\r\e[K%d of %d s, seed %d: %s' "$SECONDS" "$seconds" "$seed" "$1"
}

failed() # WHAT : the last output has the reason
{
    [[ ! -t 1 ]] || printf '\r\e[K'
    tail -n 60 "$output"
    printf 'FAIL %s with seed %d\n' "$1" "$seed"
    failures=$((failures + 1))
}

finish()
{
    [[ ! -t 1 ]] || printf '\r\e[K'
    printf '%d seeds from %d on, %d s%s: %d cases, %d runs of random tests, %d failures\n' "$seeds" \
        "$((seed - seeds))" \
        "$SECONDS" "${interrupted:+, interrupted}" "$cases" "$runs" "$failures"
    ((failures == 0))
    exit
}
trap 'interrupted=1; finish' INT TERM

campaign() # BUILD SECONDS : or as long as is left
{
    local status=0 drawn left=$((seconds - SECONDS))
    ((left > 0)) || return
    working "$1/triptych fuzz"
    "$1/triptych" fuzz --seed "$seed" --count 1000000 --seconds "$((left < $2 ? left : $2))" --jobs \
        "$(nproc)" --output "$found" >"$output" 2>&1 ||
        status=$?
    drawn=$(sed -nE 's/^([0-9]+) cases, .*/\1/p' "$output" | tail -n 1)
    cases=$((cases + ${drawn:-0}))
    ((!status)) || failed "$1/triptych fuzz, status $status"
}

while ((SECONDS < seconds)); do
    campaign "$build" 60
    campaign "$instrumented" 20
    for program in "${programs[@]}"; do
        ((SECONDS < seconds)) || break
        status=0
        working "$program"
        TRIPTYCH_SEED=$seed timeout -k 10 300 "$instrumented/$program" >"$output" 2>&1 </dev/null || status=$?
        runs=$((runs + 1))
        ((!status)) || failed "$program, status $status"
    done
    [[ ! -t 1 ]] || printf '\r\e[K'
    printf 'seed %d, %d s: %d cases, %d runs, %d failures\n' "$seed" "$SECONDS" "$cases" "$runs" "$failures"
    seed=$((seed + 1)) seeds=$((seeds + 1))
done
finish
