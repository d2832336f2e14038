#!/bin/bash
# Runs the tests of one or more builds and sums them up.
#
#   tests/support/run.sh FILTER BUILD...
#
# A build's tests are its Unity programs, BUILD/tests/**, one for every source tests/**/*.c outside
# tests/support/, and the executable scripts tests/*.sh, which print a line "ok NAME" or "FAIL NAME" per test and
# see TRIPTYCH (the command), BUILD (the build), and SANITIZE=1 when the build is the sanitizers' one.
# FILTER keeps the tests whose path contains it.
#
# Prints one line per program, what a failing one said, and last of all "N passed, N failed". A program that
# crashes, hangs, runs no test, or ends with a status that contradicts what it printed counts as one more
# failure. Exits non-zero after any failure, and when nothing ran.
set -uo pipefail
cd "$(dirname "$0")/../.."

filter=$1
shift

program_limit=300 # seconds, for a Unity program
script_limit=900  # and for a script

logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT

run_one() # BUILD TEST : leaves "status seconds" and the output in the log directory
{
    local build=$1 test=$2 limit=$program_limit log=$logs/${1//\//%}@${2//\//%} started=$SECONDS status=0
    local -a program=("$build/${test%.c}")
    if [[ $test == *.sh ]]; then
        program=("$test")
        limit=$script_limit
        export TRIPTYCH=$build/triptych BUILD=$build
        [[ ! -e $build/sanitize.mark ]] || export SANITIZE=1
    fi
    timeout -k 10 "$limit" "${program[@]}" >"$log.output" 2>&1 </dev/null || status=$?
    printf '%d %d\n' "$status" $((SECONDS - started)) >"$log.status"
}
export -f run_one
export logs program_limit script_limit

tests=()
while IFS= read -r test; do
    [[ $test != *"$filter"* ]] || tests+=("$test")
done < <(find tests -path tests/support -prune -o -name '*.c' -print | sort
    find tests -maxdepth 1 -name '*.sh' -perm -u+x -print | sort)

for build in "$@"; do
    printf '%s\0' "${tests[@]/#/$build:}"
done | xargs -0 -r -n 1 -P "$(nproc)" bash -c 'run_one "${0%%:*}" "${0#*:}"'

passed=0 failed=0
for build in "$@"; do
    for test in "${tests[@]}"; do
        log=$logs/${build//\//%}@${test//\//%}
        status=1 seconds=0
        [[ ! -f $log.status ]] || read -r status seconds <"$log.status"
        if [[ $test == *.sh ]]; then
            good=$(grep -c '^ok ' "$log.output")
            bad=$(grep -c '^FAIL ' "$log.output")
            ended=$((bad ? status != 0 : status == 0))
        else
            # Unity prints FILE:LINE:NAME:PASS or :FAIL: REASON, and exits with the number of failures.
            good=$(grep -acE '^[^:]+:[0-9]+:[^:]+:PASS' "$log.output")
            bad=$(grep -acE '^[^:]+:[0-9]+:[^:]+:FAIL' "$log.output")
            ended=$((status == bad)) 
            grep -qaE '^[0-9]+ Tests [0-9]+ Failures' "$log.output" || ended=0
        fi
        trouble=
        if ((!ended)); then
            case $status in
            124 | 137) trouble=" (stopped after $seconds s)" ;;
            *) trouble=" (ended with status $status)" ;;
            esac
        elif ((good + bad == 0)); then
            trouble=' (ran no test)'
        fi
        [[ -z $trouble ]] || bad=$((bad + 1))
        passed=$((passed + good)) failed=$((failed + bad))
        if ((bad)); then
            printf 'FAIL  %s %s: %d passed, %d failed%s\n' "$build" "$test" "$good" "$bad" "$trouble"
            grep -avE '^ok |:PASS$' "$log.output" | tail -n 60 | sed 's/^/      /'
        else
            printf 'ok    %s %s: %d passed, %d s\n' "$build" "$test" "$good" "$seconds"
        fi
    done
done

((passed + failed)) || { printf 'FAIL  no test ran\n' && failed=1; }
printf '%d passed, %d failed\n' "$passed" "$failed"
((failed == 0))
