#!/bin/bash
# Runs the tests of one or more builds and prints a summary.
#
#   tests/support/scripts/run.sh FILTER BUILD...
#
# A build's tests are its Unity programs, BUILD/tests/**, one for every source tests/**/*.c outside
# tests/support/, tests/command/fuzz/targets/, tests/front/d3d9/pe/ and tests/front/egl/program/, and the
# executable scripts tests/*.sh, which print a line "ok NAME" or "FAIL NAME" for each test. Their environment
# contains TRIPTYCH (the command), BUILD (the build), SANITIZE=1 if the build is instrumented for sanitizers,
# and SLOW=1 if it is instrumented in any way. A script that uses no build has the line "# Runs once." and
# runs only for the first build. A build with the thread sanitizer has only some programs; these and
# threads.sh are run. FILTER keeps the tests whose path contains it.
#
# Prints a line when a program ends, with its seconds of processor time, the output of failing programs, and
# at the end "N passed, N failed". A program counts as one more failure if it crashes, hangs, runs no test,
# or ends with a status that contradicts its output. Exits non-zero after any failure, or if nothing ran.
set -uo pipefail
cd "$(dirname "$0")/../../.."
ulimit -c 0

filter=$1
shift

results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
export results

# Tests have a cache of their own (src/command/store/store.h).
export XDG_CACHE_HOME=$results/cache

# Unity prints FILE:LINE:NAME:PASS or FILE:LINE:NAME:FAIL: REASON, then a summary, and ends with the number of
# failures; a script ends with anything but 0 if something failed.
run_one() # NUMBER BUILD TEST : reports, and leaves "PASSED FAILED" in the results
{
    local output=$results/$1.output build=$2 test=$3 status=0 started=$SECONDS
    local good bad honest trouble= processor
    local -a program=("$build/${test%.c}")
    local limit=300
    if [[ $test == *.sh ]]; then
        program=("$test") limit=1200
        export BUILD=$(realpath "$build")
        export TRIPTYCH=$BUILD/triptych
        grep -q -e -fsanitize "$build/flags" && export SANITIZE=1 SLOW=1
        grep -q -e --coverage "$build/flags" && export SLOW=1
    fi
    # The braces redirect bash's own message about a signal.
    { timeout -k 10 "$limit" "${program[@]}" >"$output" 2>&1 </dev/null || status=$?; } 2>/dev/null
    times >"$results/$1.times"
    processor=$(awk -F '[ms ]+' 'NR == 2 { printf "%.0f", $1 * 60 + $2 + $3 * 60 + $4 }' "$results/$1.times")

    if [[ $test == *.sh ]]; then
        good=$(grep -ac '^ok ' "$output")
        bad=$(grep -ac '^FAIL ' "$output")
        honest=$(((status != 0) == (bad != 0)))
    else
        good=$(grep -acE '^[^:]+:[0-9]+:[^:]+:PASS' "$output")
        bad=$(grep -acE '^[^:]+:[0-9]+:[^:]+:FAIL' "$output")
        honest=$((status == bad))
        grep -qaE '^[0-9]+ Tests [0-9]+ Failures' "$output" || honest=0
    fi

    if ((status == 124 || status == 137)); then
        trouble=", stopped after $((SECONDS - started)) s"
    elif ((status > 128)); then
        trouble=", killed by SIG$(kill -l $((status - 128)))"
    elif ((!honest)); then
        trouble=", ended with status $status"
    elif ((good + bad == 0)); then
        trouble=', ran no test'
    fi
    [[ -z $trouble ]] || bad=$((bad + 1))
    printf '%d %d\n' "$good" "$bad" >"$results/$1.counts"

    if ((bad)); then
        printf 'FAIL  %s %s: %d passed, %d failed%s\n%s\n' "$build" "$test" "$good" "$bad" "$trouble" \
            "$(grep -avE '^ok |:PASS$' "$output" | tail -n 80 | sed 's/^/      /')"
    else
        printf 'ok    %s %s: %d passed, %s s\n' "$build" "$test" "$good" "$processor"
    fi
}
export -f run_one

# Scripts are first because the longest tests are scripts.
tests=()
while IFS= read -r test; do
    [[ $test != *"$filter"* ]] || tests+=("$test")
done < <(find tests -maxdepth 1 -name '*.sh' -perm -u+x -print | sort
    find tests \( -path tests/support -o -path tests/command/fuzz/targets -o -path tests/front/d3d9/pe -o \
        -path tests/front/egl/program \) -prune -o -name '*.c' -print | sort)

count=0
for test in "${tests[@]}"; do
    for build in "$@"; do
        if grep -q -e -fsanitize=thread "$build/flags" && [[ $test != tests/threads.sh &&
            ! -x $build/${test%.c} ]]; then
            continue
        fi
        [[ $build == "$1" || $test != *.sh ]] || ! grep -qx '# Runs once\.' "$test" || continue
        printf '%d\0%s\0%s\0' "$count" "$build" "$test" >>"$results/jobs"
        count=$((count + 1))
    done
done
((!count)) || xargs -0 -n 3 -P "$(nproc)" bash -c 'run_one "$@"' run_one <"$results/jobs"

passed=0 failed=0
for ((i = 0; i < count; i++)); do
    good=0 bad=1 # if the run wrote no result
    [[ ! -f $results/$i.counts ]] || read -r good bad <"$results/$i.counts"
    passed=$((passed + good)) failed=$((failed + bad))
done
((count)) || { printf 'FAIL  no test ran\n' && failed=1; }
printf '%d passed, %d failed\n' "$passed" "$failed"
((failed == 0))
