#!/bin/bash
# The measurements of `make bench`, written to results/ (RESULTS):
#
#   bench/run.sh [OPTION of triptych bench]...
#
#   bench.json, bench.csv   every stream with every engine, inside one process (triptych bench)
#   bench.svg, bench.png    the table as a chart
#   hyperfine.json          all frames of one stream with some engines, as whole processes. There are enough
#                           frames that the engines determine the time, not the start of the process
#   baselines.json, .csv    the engines that run only if named: other batch sizes and the system's compiler
#                           (docs/baselines.md)
#   builds.json             the time to build each routine, over the states of all streams of the project
#   cold.json               the times of the first frames of a new device, and of the same frames again
#   verify.json             the comparison of all pictures
#
# The last step compares the pictures of all engines. Its last line is "N streams, N engines, identical";
# otherwise the run fails.
#
# QUICK=1 takes short samples and compares one frame of each stream, for a first look. It writes to
# BUILD/bench/quick, because the pages have their figures from results/.
set -euo pipefail
cd "$(dirname "$0")/.."

build=${BUILD:-build}
samples=() process_runs=(--min-runs 3) repetitions=15 seconds=2 compared=(--frames all)
if [[ ${QUICK-} ]]; then
    samples=(--seconds 0.5 --repetitions 3) process_runs=(--runs 2) repetitions=3 seconds=0.2
    compared=(--frames 1 --threads 2)
    RESULTS=${RESULTS:-$build/bench/quick}
fi
results=${RESULTS:-results}
triptych=$build/triptych
process_stream=bench/streams/street.tri

shopt -s nullglob
streams=(bench/streams/*.tri bench/streams/pages/*.trib)
((${#streams[@]})) || { echo 'bench: no draw streams in bench/streams' >&2 && exit 1; }
mkdir -p "$results" "$build/bench"

"$triptych" bench "${streams[@]}" "${samples[@]}" --json "$results/bench.json" --csv "$results/bench.csv" \
    --chart "$results/bench.svg,$results/bench.png" "$@"

baselines=$("$triptych" list engines |
    awk '$3 == "available" && $1 ~ /^(emulate|batch.*|specialize|external)$/ { print $1 }' | paste -sd, -)
"$triptych" bench bench/streams/{teapot-bilinear,bunny,cat}.tri --frames 1 --seconds "$seconds" \
    --engines "$baselines" --json "$results/baselines.json" --csv "$results/baselines.csv"

"$triptych" bench --builds --repetitions "$repetitions" --engines stitch,specialize-thesis,specialize-8,specialize \
    --json "$results/builds.json" \
    {bench/streams,bench/streams/micro,tests/data/streams,tests/data/scenes,tests/data/shading,tests/data/regressions}/*.tri \
    bench/streams/pages/*.trib
"$triptych" bench --cold --frames 6 --engines stitch,specialize,tiered --json "$results/cold.json" \
    "$process_stream"

# The engines that can run here have a row.
mapfile -t measured < <(awk -F, '
    NR == 1 { for (i = 1; i <= NF; i++) if ($i == "engine") column = i; next }
    column && !seen[$column]++ { print $column }' "$results/bench.csv")
all_frames='--frames all --format y4m --out /dev/null'
processes=()
for engine in emulate stitch specialize; do
    if [[ " ${measured[*]} " == *" $engine "* ]]; then
        processes+=(--command-name "$engine"
            "$triptych render $process_stream $all_frames --engine $engine --threads 1")
    fi
done
((${#processes[@]})) || { echo "bench: $results/bench.csv names no engine" >&2 && exit 1; }

hyperfine --shell=none --style=basic --warmup 1 "${process_runs[@]}" --export-json "$results/hyperfine.json" \
    "${processes[@]}"

"$triptych" verify "${streams[@]}" "${compared[@]}" --json "$results/verify.json"
