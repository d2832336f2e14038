#!/usr/bin/env bash
# Fuzzes readers of untrusted input with libFuzzer (make fuzz-input):
#
#   COMMAND=build/triptych tests/command/fuzz/campaign.sh BUILD SECONDS JOBS TARGET...
#
# A target starts from its corpus in tests/data/corpus, the repository's files of its format (seeds.sh), and
# the inputs of earlier runs in BUILD/inputs/TARGET. It ends after SECONDS or at its first finding. A finding
# is a failed check, a report of a sanitizer, or a run that needs more than ten seconds (LIMIT=seconds, for a
# machine that is busy) or two gigabytes. Its
# input is written to BUILD/findings. Before the fault is fixed, add this input to the corpus with a name that
# describes it. Logs are BUILD/logs/TARGET.log.
#
# MERGE=1 makes a new corpus instead, the smallest with the same coverage.
#
# Prints a line for each target, and ends non-zero after a finding.
set -uo pipefail
cd "$(dirname "$0")/../../.."

build=$1 seconds=$2 jobs=$3
shift 3
export build seconds
export UBSAN_OPTIONS=print_stacktrace=1

# Print a field of libFuzzer's final statistics, and the last value of a column of its progress lines.
statistic() { sed -n "s/^stat::$2: *//p" "$1"; }
column() { grep -oE "$2: [0-9]+" "$1" | tail -n 1 | cut -d' ' -f2; }

fuzz() # TARGET
{
    local target=$1 log=$build/logs/$1.log status=0
    local corpus=tests/data/corpus/$target inputs=$build/inputs/$target seeds=$build/seeds/$target
    local -a options=(-max_total_time="$seconds" -timeout="${LIMIT:-10}" -rss_limit_mb=2048 -print_final_stats=1
        -artifact_prefix="$build/findings/$target-")
    mkdir -p "$build/logs" "$build/findings" "$corpus" "$inputs" "$seeds"
    tests/command/fuzz/seeds.sh "$target" "$seeds"
    tests/command/fuzz/dictionary.sh "$target" >"$build/seeds/$target.dictionary"
    [[ ! -s $build/seeds/$target.dictionary ]] || options+=(-dict="$build/seeds/$target.dictionary")
    nice -n 15 "$build/fuzz/$target" "${options[@]}" "$inputs" "$corpus" "$seeds" >"$log" 2>&1 </dev/null ||
        status=$?
    local verdict='no finding'
    ((!status)) || verdict="FINDING, status $status: $log"
    printf '%-10s %6d s %10d executions %7d per second %6d edges %6d inputs  %s\n' "$target" "$seconds" \
        "$(statistic "$log" number_of_executed_units)" "$(statistic "$log" average_exec_per_sec)" \
        "$(column "$log" cov)" "$(find "$inputs" -type f | wc -l)" "$verdict"
    return $status
}

# Uses inputs of up to LENGTH bytes. Regressions, whose names do not begin with a checksum, always stay.
merge() # TARGET
{
    local target=$1 corpus=tests/data/corpus/$1 small=$build/small/$1 kept=$build/kept/$1
    rm -rf "$small" "$kept"
    mkdir -p "$small" "$kept" "$corpus"
    find -L "$corpus" "$build/inputs/$target" -type f -size "-${LENGTH:-400}c" -exec cp -t "$small" {} + 2>/dev/null # some are in both
    "$build/fuzz/$target" -merge=1 -use_counters=0 -timeout=10 -rss_limit_mb=2048 "$kept" "$small" \
        >"$build/logs/$target.merge.log" 2>&1 </dev/null
    find "$corpus" -type f -regextype posix-extended -regex '.*/[0-9a-f]{40}' -delete
    cp "$kept"/* "$corpus"/
    find "$corpus" -type f -printf '%s\n' |
        awk -v target="$target" \
            '{ bytes += $1 } END { printf "%-10s %6d inputs, %d bytes\n", target, NR, bytes }'
}

export -f fuzz merge statistic column
work=fuzz
[[ -z ${MERGE-} ]] || work=merge
printf '%s\n' "$@" | xargs -P "$jobs" -I{} bash -c "$work {}"
